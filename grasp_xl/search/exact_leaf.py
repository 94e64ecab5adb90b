"""Enumerating all grasps of a small node of the exact search (compiled).

Elements are chosen depth first, cell by cell, in the order of their prices; what is still to come
costs at least the next prices.  The last element is looked for in the tree: its place is nearly
given by the moment of the others.
"""

from __future__ import annotations

import numpy as np

from grasp_xl.compiled import inner
from grasp_xl.rules import SLACK
from grasp_xl.search.exact_bound import gap, shortest_truss
from grasp_xl.search.exact_model import CUPS, MAGNETS, Locations
from grasp_xl.search.exact_prices import (
    Room,
    Truss,
    Weights,
    branch,
    cheapest,
    fit_together,
    group_end,
    is_barred,
    kind_price,
    no_truss,
    price,
    squared_distance,
    truss_of,
)
from grasp_xl.space import FloatArray, IntArray

ENTRIES = 512
"""Locations and kinds that are listed for one node; a node with more is split."""

BUDGET = 10000
"""Steps spent on one node before it is split."""

BOX, COUNT, FIRST, SIZE = 0, 1, 2, 3
"""Columns of ``Room.group``: a cell, its elements, and its part of the list."""

REST, LAST_PRICE = 0, 1
"""Columns of ``Room.group_sum``: bound of all later groups; price of the dearest relaxed pick."""

FIXED = 3
"""Column of ``Room.pull_so_far``: value without the moment; before it x, y, z of the pull (mm)."""


@inner
def true_value(loc: Locations, w: Weights, n: int, room: Room) -> float:
    """Return the value of the chosen grasp, infinite if it breaks a rule; as ``grasp.evaluate``."""
    longest = 0.0
    for i in range(n):
        for j in range(i):
            squared = squared_distance(loc, room.chosen[i], room.chosen[j])
            if squared < w.clearance * w.clearance:
                return np.inf
            longest = max(longest, squared)
    x = y = z = deviation = 0.0
    for i in range(n):
        place = room.chosen[i]
        pull = w.magnet_pull if room.chosen_kind[i] == MAGNETS else w.cup_pull
        x += pull * loc.xyz[place, 0]
        y += pull * loc.xyz[place, 1]
        z += pull * loc.xyz[place, 2]
        deviation += loc.deviation[place]
    structure = 0.0 if n < 2 else np.inf
    for i in range(n):
        for j in range(i):
            p, q = room.chosen[i], room.chosen[j]
            squared = squared_distance(loc, p, q)
            if squared < longest * (1 - 2 * SLACK):
                continue
            length = np.sqrt(squared)
            dx, dy = loc.xyz[q, 0] - loc.xyz[p, 0], loc.xyz[q, 1] - loc.xyz[p, 1]
            total = w.ratio * length
            for k in range(n):
                ex = loc.xyz[room.chosen[k], 0] - loc.xyz[p, 0]
                ey = loc.xyz[room.chosen[k], 1] - loc.xyz[p, 1]
                total += abs(dx * ey - dy * ex) / length
            structure = min(structure, total)
    arm = np.sqrt(x * x + y * y + z * z)
    if arm > w.arm_cap or deviation > w.deviation_cap or structure > w.structure_cap:
        return np.inf
    value: float = w.base + w.moment * arm + w.deviation * deviation + w.structure * structure
    return value


@inner
def keep(
    loc: Locations, w: Weights, n: int, found: FloatArray, genes: IntArray, room: Room
) -> None:
    """Enter the chosen grasp into the best ones ``found (k,)``, rising; ``genes (k, n, 2)``."""
    value = true_value(loc, w, n, room)
    slot = len(found) - 1
    if value >= found[slot]:
        return
    while slot > 0 and found[slot - 1] > value:
        found[slot] = found[slot - 1]
        for i in range(n):
            genes[slot, i, 0], genes[slot, i, 1] = genes[slot - 1, i, 0], genes[slot - 1, i, 1]
        slot -= 1
    found[slot] = value
    for i in range(n):
        genes[slot, i, 0], genes[slot, i, 1] = room.chosen[i], room.chosen_kind[i]


@inner
def is_after(value: float, place: int, kind: int, price_: float, place_: int, kind_: int) -> bool:
    """Tell whether an entry stands behind another one in the order of the list."""
    if value != price_:
        return value > price_
    return place > place_ or (place == place_ and kind > kind_)


@inner
def list_entries(
    loc: Locations,
    w: Weights,
    t: Truss,
    cell: int,
    u: FloatArray,
    below: float,
    first: int,
    room: Room,
) -> int:
    """List the elements of a cell with prices below a limit, in order; -1 if they are too many."""
    n = first
    room.tag[0] = cell
    size = 1
    while size > 0:
        size -= 1
        box = room.tag[size]
        value, _ = price(loc, w, t, box, u)
        if value >= below or is_barred(loc, t, box):
            continue
        if loc.child[box, 0] >= 0:
            room.tag[size], room.tag[size + 1] = loc.child[box, 0], loc.child[box, 1]
            size += 2
            continue
        place = loc.run[box, 0]
        for kind in range(2):
            value = entry_price(loc, w, t, box, kind, u)
            if value >= below:
                continue
            if n == len(room.entry_price):
                return -1
            slot = n
            while slot > first and is_after(
                room.entry_price[slot - 1],
                room.entry_place[slot - 1],
                room.entry_kind[slot - 1],
                value,
                place,
                kind,
            ):
                room.entry_price[slot] = room.entry_price[slot - 1]
                room.entry_place[slot] = room.entry_place[slot - 1]
                room.entry_kind[slot] = room.entry_kind[slot - 1]
                slot -= 1
            room.entry_price[slot], room.entry_place[slot] = value, place
            room.entry_kind[slot] = kind
            n += 1
    return n


@inner
def entry_price(loc: Locations, w: Weights, t: Truss, box: int, kind: int, u: FloatArray) -> float:
    """Return the price of an element of a kind at one location, infinite where it cannot stand."""
    if not loc.carries[box, kind] or (w.magnets if kind == MAGNETS else w.cups) == 0:
        return np.inf
    place = loc.run[box, 0]
    reach = u[0] * loc.xyz[place, 0] + u[1] * loc.xyz[place, 1] + u[2] * loc.xyz[place, 2]
    fixed = loc.deviation[place] * w.deviation + branch(loc, t, box) * w.structure
    value: float = fixed + kind_price(w, kind, reach, u)
    return value


@inner
def try_last(
    loc: Locations,
    w: Weights,
    t: Truss,
    cell: int,
    kind: int,
    depth: int,
    behind: int,
    u: FloatArray,
    found: FloatArray,
    genes: IntArray,
    room: Room,
) -> None:
    """Try every last element of a cell; those behind entry ``behind`` of the list, if not -1."""
    pull = w.magnet_pull if kind == MAGNETS else w.cup_pull
    vx, vy, vz = room.pull_so_far[depth, 0], room.pull_so_far[depth, 1], room.pull_so_far[depth, 2]
    worst = len(found) - 1
    room.tag[0] = cell
    size = 1
    while size > 0:
        size -= 1
        box = room.tag[size]
        if not loc.carries[box, kind]:
            continue
        c = loc.corners[box]
        x = gap(vx + pull * c[0], vx + pull * c[2])
        y = gap(vy + pull * c[1], vy + pull * c[3])
        z = gap(vz + pull * loc.heights[box, 0], vz + pull * loc.heights[box, 1])
        value = room.pull_so_far[depth, FIXED] + loc.least_deviation[box] * w.deviation
        value += w.moment * np.sqrt(x * x + y * y + z * z)
        if value >= found[worst]:
            continue
        value += branch(loc, t, box) * w.structure
        if value >= found[worst] or is_barred(loc, t, box):
            continue
        if loc.child[box, 0] >= 0:
            room.tag[size], room.tag[size + 1] = loc.child[box, 0], loc.child[box, 1]
            size += 2
            continue
        place = loc.run[box, 0]
        if behind >= 0 and not is_after(
            entry_price(loc, w, t, box, kind, u),
            place,
            kind,
            room.entry_price[behind],
            room.entry_place[behind],
            room.entry_kind[behind],
        ):
            continue
        if stands_apart(loc, w, t, place, depth, room):
            room.chosen[depth], room.chosen_kind[depth] = place, kind
            keep(loc, w, depth + 1, found, genes, room)


@inner
def stands_apart(loc: Locations, w: Weights, t: Truss, place: int, chosen: int, room: Room) -> bool:
    """Tell whether a location is far enough from the chosen ones, and within the truss's reach."""
    for i in range(chosen):  # noqa: SIM110 (numba compiles no generator without references)
        if not fit_together(loc, w, t, place, room.chosen[i]):
            return False
    return True


@inner
def prepare(
    loc: Locations,
    w: Weights,
    t: Truss,
    boxes: IntArray,
    constant: float,
    upper: float,
    u: FloatArray,
    room: Room,
) -> int:
    """List the entries of all groups of a node; return how many groups.

    0 where no grasp can be below ``upper``, -1 where there are too many entries.
    """
    n = w.cups + w.magnets
    free = no_truss()
    total, groups, first = constant, 0, 0
    while first < n:
        last = group_end(w, boxes, n, first)
        limits = free if t.a >= 0 and first < 2 else t
        value = cheapest(loc, w, limits, boxes[first], first, last, u, room)
        if value == np.inf:
            return 0
        total += value
        room.group[groups, BOX], room.group[groups, COUNT] = boxes[first], last - first
        room.group_sum[groups, REST] = value
        room.group_sum[groups, LAST_PRICE] = price(loc, w, limits, room.pick[last - 1], u)[0]
        groups += 1
        first = last
    if total >= upper:
        return 0
    entries, rest = 0, 0.0
    for g in range(groups):
        limits = free if t.a >= 0 and g < 2 else t
        below = upper - total + room.group_sum[g, LAST_PRICE]
        room.group[g, FIRST] = entries
        entries = list_entries(loc, w, limits, room.group[g, BOX], u, below, entries, room)
        if entries < 0:
            return -1
        room.group[g, SIZE] = entries - room.group[g, FIRST]
    for g in range(groups - 1, -1, -1):
        value = room.group_sum[g, REST]
        room.group_sum[g, REST] = rest
        rest += value
    return groups


@inner
def lay_out(groups: int, room: Room) -> None:
    """Say of each depth which group its element belongs to, and which one of the group it is."""
    depth = 0
    for g in range(groups):
        for number in range(room.group[g, COUNT]):
            room.depth_group[depth, 0], room.depth_group[depth, 1] = g, number
            depth += 1


@inner
def least_total(depth: int, room: Room) -> float:
    """Return a bound of all grasps that go on with the entry at this depth, or a later one."""
    g, number = room.depth_group[depth, 0], room.depth_group[depth, 1]
    left = room.group[g, COUNT] - number
    if room.position[depth] + left > room.group[g, SIZE]:
        return np.inf
    total: float = room.price_so_far[depth] + room.group_sum[g, REST]
    for i in range(left):
        total += room.entry_price[room.group[g, FIRST] + room.position[depth] + i]
    return total


@inner
def choose(loc: Locations, w: Weights, t: Truss, depth: int, entry: int, room: Room) -> None:
    """Choose an entry as the element at this depth."""
    place, kind = room.entry_place[entry], room.entry_kind[entry]
    room.chosen[depth], room.chosen_kind[depth] = place, kind
    room.price_so_far[depth + 1] = room.price_so_far[depth] + room.entry_price[entry]
    pull = w.magnet_pull if kind == MAGNETS else w.cup_pull
    for axis in range(3):
        moved = room.pull_so_far[depth, axis] + pull * loc.xyz[place, axis]
        room.pull_so_far[depth + 1, axis] = moved
    away = 0.0
    if t.a >= 0:
        away = abs(t.nx * (loc.xyz[place, 0] - t.x) + t.ny * (loc.xyz[place, 1] - t.y)) - t.half
    room.pull_so_far[depth + 1, FIXED] = (
        room.pull_so_far[depth, FIXED]
        + loc.deviation[place] * w.deviation
        + max(0.0, away) * w.structure
    )


@inner
def enumerate_node(
    loc: Locations,
    w: Weights,
    boxes: IntArray,
    u: FloatArray,
    budget: int,
    found: FloatArray,
    genes: IntArray,
    room: Room,
) -> bool:
    """Look at all grasps of a node that may enter ``found``; False if that takes too long.

    Parameters
    ----------
    loc, w : Locations, Weights
    boxes : IntArray
        ``(n,)``; with a truss, the first two are single locations.
    u : FloatArray
        ``(4,)`` multipliers.
    budget : int
        Steps after which to give up.
    found, genes : FloatArray, IntArray
        ``(k,)`` values of the best grasps so far, rising, and ``(k, n, 2)`` their locations and
        kinds.
    room : Room
    """
    n = w.cups + w.magnets
    worst = len(found) - 1
    t = truss_of(loc, w, boxes)
    fixed = w.base
    if t.a >= 0:
        fixed += w.ratio * shortest_truss(loc, w, t) * w.structure
    constant = fixed + u[3] * w.magnets
    groups = prepare(loc, w, t, boxes, constant, found[worst], u, room)
    if groups <= 0:
        return groups == 0
    lay_out(groups, room)
    room.price_so_far[0] = constant
    room.pull_so_far[0, :] = 0.0
    room.pull_so_far[0, FIXED] = fixed
    room.position[0] = -1
    depth = magnets = 0
    while depth >= 0:
        g, number = room.depth_group[depth, 0], room.depth_group[depth, 1]
        limits = no_truss() if t.a >= 0 and g < 2 else t
        advanced = False
        if depth == n - 1:
            budget -= 5  # such a look takes about as long as five steps
            kind = w.magnets - magnets
            if kind in (CUPS, MAGNETS) and room.group[g, SIZE] > 0:
                cell = room.group[g, BOX]
                behind = room.group[g, FIRST] + room.position[depth - 1] if number > 0 else -1
                try_last(loc, w, limits, cell, kind, depth, behind, u, found, genes, room)
        else:
            room.position[depth] += 1
            advanced = least_total(depth, room) < found[worst]
        if not advanced:
            depth -= 1
            magnets -= room.chosen_kind[depth] if depth >= 0 else 0
            continue
        budget -= 1
        if budget < 0:
            return False
        entry = room.group[g, FIRST] + room.position[depth]
        place, kind = room.entry_place[entry], room.entry_kind[entry]
        if magnets + kind > w.magnets or depth + 1 - magnets - kind > w.cups:
            continue
        if not stands_apart(loc, w, t, place, depth, room):
            continue
        choose(loc, w, limits, depth, entry, room)
        magnets += kind
        depth += 1
        room.position[depth] = room.position[depth - 1] if room.depth_group[depth, 1] > 0 else -1
    return True
