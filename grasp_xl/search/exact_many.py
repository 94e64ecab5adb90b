"""Enumerating all grasps of many elements of a small node of the exact search (compiled).

Which kinds stand at the chosen locations is left open until all are chosen: a location has the
price of its cheaper kind.  After each choice the locations that are too close to it are struck
off, and cliques of what is left bound the elements to come.
"""

from __future__ import annotations

import numpy as np

from grasp_xl.compiled import allocation_free
from grasp_xl.search.exact_bound import (
    Room,
    Truss,
    Weights,
    cheapest,
    group_end,
    is_barred,
    joins_clique,
    no_truss,
    pop,
    price,
    push,
    shortest_truss,
    truss_of,
)
from grasp_xl.search.exact_leaf import BOX, COUNT, LAST_PRICE, REST, keep, squared_distance, true_value
from grasp_xl.search.exact_model import CUPS, MAGNETS, Locations
from grasp_xl.space import FloatArray, IntArray


@allocation_free
def list_locations(
    loc: Locations,
    w: Weights,
    t: Truss,
    cell: int,
    u: FloatArray,
    below: float,
    row: int,
    room: Room,
) -> bool:
    """List the locations of a cell with prices below a limit, rising; False if too many."""
    size, n = 0, 0
    value, _ = price(loc, w, t, cell, u)
    if value < below and not is_barred(loc, t, cell):
        push(room, 0, value, cell)
        size = 1
    while size > 0:
        value, box = room.price[0], room.tag[0]
        size -= 1
        pop(room, size)
        if loc.child[box, 0] < 0:
            if n == room.list_price.shape[1]:
                return False
            room.list_price[row, n], room.list_place[row, n] = value, loc.run[box, 0]
            n += 1
            continue
        for side in range(2):
            half = loc.child[box, side]
            value, _ = price(loc, w, t, half, u)
            if value < below and not is_barred(loc, t, half):
                push(room, size, value, half)
                size += 1
    room.list_size[row] = n
    return True


@allocation_free
def narrow(
    loc: Locations, w: Weights, t: Truss, source: int, first: int, fresh: int, depth: int, room: Room
) -> None:
    """List, for this depth, the entries of a list from ``first`` on that may stand.

    They keep their distance from the elements chosen from ``fresh`` on.
    """
    n = 0
    for e in range(first, room.list_size[source]):
        place = room.list_place[source, e]
        fits = True
        for i in range(fresh, depth):
            squared = squared_distance(loc, place, room.chosen[i])
            if squared < w.clearance * w.clearance or squared > t.reach:
                fits = False
                break
        if fits:
            room.list_price[depth, n] = room.list_price[source, e]
            room.list_place[depth, n] = place
            n += 1
    room.list_size[depth] = n


@allocation_free
def clique_prices(loc: Locations, w: Weights, row: int, wanted: int, room: Room) -> float:
    """Return a bound on the prices of so many elements from a list; writes each one's [5]."""
    taken, total = 0, 0.0
    for e in range(room.list_size[row]):
        if not joins_clique(loc, w, room.list_place[row, e], taken, room):
            room.least[row, taken] = room.list_price[row, e]
            total += room.list_price[row, e]
            taken += 1
            if taken == wanted:
                return total
    return np.inf


@allocation_free
def least_from(row: int, left: int, room: Room) -> float:
    """Return a bound on ``left`` elements of a list of which none stands before its position."""
    own = room.list_price[row, room.position[row]]
    total: float = own
    for i in range(1, left):
        total += max(own, room.least[row, i])
    return total


@allocation_free
def assign_kinds(
    loc: Locations, w: Weights, n: int, found: FloatArray, genes: IntArray, room: Room
) -> None:
    """Try every share of the kinds among the chosen locations."""
    fixed = unpulled_value(loc, w, n, room)
    worst = len(found) - 1
    if fixed >= found[worst]:
        return
    magnets = 0
    for i in range(n):  # the first share: magnets as late as possible
        room.chosen_kind[i] = MAGNETS if i >= w.cups else CUPS
    while True:
        x = y = z = 0.0
        possible = True
        for i in range(n):
            place, kind = room.chosen[i], room.chosen_kind[i]
            possible = possible and loc.footprint[place, kind] >= 0
            pull = w.magnet_pull if kind == MAGNETS else w.cup_pull
            x += pull * loc.xyz[place, 0]
            y += pull * loc.xyz[place, 1]
            z += pull * loc.xyz[place, 2]
        if possible and fixed + w.moment * np.sqrt(x * x + y * y + z * z) < found[worst]:
            keep(loc, w, n, found, genes, room)
        # the next share: the last cup before a magnet moves behind it, and all after it go back
        i = n - 1
        magnets = 0
        while i > 0 and not (room.chosen_kind[i] == MAGNETS and room.chosen_kind[i - 1] == CUPS):
            magnets += room.chosen_kind[i]
            i -= 1
        if i == 0:
            return
        room.chosen_kind[i - 1], room.chosen_kind[i] = MAGNETS, CUPS
        for k in range(i + 1, n):
            room.chosen_kind[k] = MAGNETS if k >= n - magnets else CUPS


@allocation_free
def unpulled_value(loc: Locations, w: Weights, n: int, room: Room) -> float:
    """Return a bound on the value of the chosen locations without their moment."""
    for i in range(n):
        room.chosen_kind[i] = CUPS
    deviation = 0.0
    for i in range(n):
        deviation += loc.deviation[room.chosen[i]]
    value: float = w.base + w.deviation * deviation
    if w.trussed:
        longest, a, b = 0.0, 0, 1
        for i in range(n):
            for j in range(i):
                squared = squared_distance(loc, room.chosen[i], room.chosen[j])
                if squared > longest:
                    longest, a, b = squared, j, i
        length = np.sqrt(longest)
        value += w.structure * w.ratio * length
    return value


@allocation_free
def enumerate_many(
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

    Parameters as of :func:`grasp_xl.search.exact_leaf.enumerate_node`.
    """
    n = w.cups + w.magnets
    worst = len(found) - 1
    t = truss_of(loc, w, boxes)
    total = w.base + u[3] * w.magnets
    first = 0
    if t.a >= 0:
        total += w.ratio * shortest_truss(loc, w, t) * w.structure
        first = 2
        for i in range(2):
            room.chosen[i] = loc.run[boxes[i], 0]
            total += price(loc, w, no_truss(), boxes[i], u)[0]
    room.price_so_far[first] = total
    # lists of all groups, in rows behind those of the depths
    groups, depth = 0, first
    while depth < n:
        last = group_end(w, boxes, n, depth)
        value = cheapest(loc, w, t, boxes[depth], depth, last, u, room)
        if value == np.inf:
            return True
        total += value
        room.group[groups, BOX], room.group[groups, COUNT] = boxes[depth], last - depth
        room.group_sum[groups, REST] = value
        room.group_sum[groups, LAST_PRICE] = price(loc, w, t, room.pick[last - 1], u)[0]
        for number in range(last - depth):
            room.depth_group[depth + number, 0] = groups
            room.depth_group[depth + number, 1] = number
        groups += 1
        depth = last
    if total >= found[worst]:
        return True
    for g in range(groups):
        below = found[worst] - total + room.group_sum[g, LAST_PRICE]
        if not list_locations(loc, w, t, room.group[g, BOX], u, below, n + g, room):
            return False
        budget -= room.list_size[n + g] // 8
    rest = 0.0
    for g in range(groups - 1, -1, -1):
        value = room.group_sum[g, REST]
        room.group_sum[g, REST] = rest
        rest += value
    depth = first
    enter = True
    while depth >= first:
        g, number = room.depth_group[depth, 0], room.depth_group[depth, 1]
        left = room.group[g, COUNT] - number
        if enter:
            if number == 0:
                narrow(loc, w, t, n + g, 0, 0, depth, room)
                budget -= room.list_size[n + g] // 8
            else:
                narrow(loc, w, t, depth - 1, room.position[depth - 1] + 1, depth - 1, depth, room)
                budget -= room.list_size[depth - 1] // 8
            so_far = room.price_so_far[depth] + room.group_sum[g, REST]
            enter = False
            room.position[depth] = -1
            if so_far + clique_prices(loc, w, depth, left, room) >= found[worst]:
                depth -= 1
                continue
        room.position[depth] += 1
        if room.position[depth] + left > room.list_size[depth]:
            depth -= 1
            continue
        so_far = room.price_so_far[depth] + room.group_sum[g, REST]
        if so_far + least_from(depth, left, room) >= found[worst]:
            depth -= 1
            continue
        budget -= 1
        if budget < 0:
            return False
        entry = room.position[depth]
        room.chosen[depth] = room.list_place[depth, entry]
        if depth == n - 1:
            budget -= 2
            assign_kinds(loc, w, n, found, genes, room)
            continue
        room.price_so_far[depth + 1] = room.price_so_far[depth] + room.list_price[depth, entry]
        depth += 1
        enter = True
    return True
