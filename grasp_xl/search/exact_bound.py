"""Lower bounds of the exact search (compiled).

A node says in which boxes the elements of a grasp stand: the first two boxes hold the ends of the
main truss, the others are *cells*; a cell that stands there several times holds as many elements.
docs/exact.md derives each bound; the numbers in brackets are its steps.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from grasp_xl.compiled import allocation_free, inner
from grasp_xl.rules import SLACK
from grasp_xl.search.exact_model import CUPS, MAGNETS, Locations
from grasp_xl.space import FloatArray, IntArray

Weights = Any
"""A row of ``WEIGHTS``."""

MULTIPLIERS = 4
"""u (3), the direction along which the moment is bounded, and the price of a magnet."""

CLIQUE = 64
"""Members of a clique that are kept; a larger one would bound no better."""

FEW = 5
"""Elements up to which every share of kinds is bounded directly."""


class Truss(NamedTuple):
    """Where the main truss may lie: boxes a and b of its ends, -1 where there is none.

    x, y (mm) a point of the line through the boxes' middles, nx, ny its unit normal; half (mm) is
    how far the true line may stray from it; squares of how far the elements may be from the ends
    (reach), and must be (apart).
    """

    a: int
    b: int
    x: float
    y: float
    nx: float
    ny: float
    half: float
    reach: float
    apart: float


class Room(NamedTuple):
    """Arrays that one worker needs: a heap, the picks, cliques, and the lists of ``exact_leaf``."""

    price: FloatArray
    tag: IntArray
    pick: IntArray
    difference: FloatArray
    clique_x: FloatArray
    clique_y: FloatArray
    clique_size: IntArray
    entry_price: FloatArray
    entry_place: IntArray
    entry_kind: IntArray
    group: IntArray
    group_sum: FloatArray
    depth_group: IntArray
    position: IntArray
    chosen: IntArray
    chosen_kind: IntArray
    price_so_far: FloatArray
    pull_so_far: FloatArray


def make_room(locations: int, elements: int, entries: int) -> Room:
    """Make the arrays for so many locations, elements of a grasp, and entries of a list."""
    heap, row = 2 * locations + 8, elements + 2
    return Room(
        np.empty(heap),
        np.empty(heap, dtype=np.int64),
        np.zeros(row, dtype=np.int64),
        np.empty(row),
        np.empty((row, CLIQUE)),
        np.empty((row, CLIQUE)),
        np.empty(row, dtype=np.int64),
        np.empty(entries),
        np.empty(entries, dtype=np.int64),
        np.empty(entries, dtype=np.int64),
        np.empty((row, 4), dtype=np.int64),
        np.empty((row, 2)),
        np.empty((row, 2), dtype=np.int64),
        np.empty(row, dtype=np.int64),
        np.empty(row, dtype=np.int64),
        np.empty(row, dtype=np.int64),
        np.empty(row),
        np.empty((row, 4)),
    )


# --- geometry of boxes ---


@inner
def squared_distance(loc: Locations, p: int, q: int) -> float:
    """Return the squared plan-view distance of two locations (mm^2)."""
    dx, dy = loc.xyz[p, 0] - loc.xyz[q, 0], loc.xyz[p, 1] - loc.xyz[q, 1]
    squared: float = dx * dx + dy * dy
    return squared


@inner
def box_squares(p: FloatArray, q: FloatArray) -> tuple[float, float]:
    """Return the squares of the least and the largest distance between points of two boxes."""
    dx = max(0.0, p[0] - q[2], q[0] - p[2])
    dy = max(0.0, p[1] - q[3], q[1] - p[3])
    fx = max(abs(p[2] - q[0]), abs(q[2] - p[0]))
    fy = max(abs(p[3] - q[1]), abs(q[3] - p[1]))
    return dx * dx + dy * dy, fx * fx + fy * fy


@inner
def no_truss() -> Truss:
    """Return the truss that limits nothing."""
    return Truss(-1, -1, 0.0, 0.0, 0.0, 0.0, 0.0, np.inf, 0.0)


@inner
def truss_of(loc: Locations, w: Weights, boxes: IntArray) -> Truss:
    """Return where the truss of a node may lie."""
    if w.trussed == 0:
        return no_truss()
    p, q = loc.corners[boxes[0]], loc.corners[boxes[1]]
    x, y = (p[0] + p[2]) / 2, (p[1] + p[3]) / 2
    dx, dy = (q[0] + q[2]) / 2 - x, (q[1] + q[3]) / 2 - y
    length = np.sqrt(dx * dx + dy * dy)
    nx, ny = (-dy / length, dx / length) if length > 0.0 else (0.0, 0.0)
    half_p = (abs(nx) * (p[2] - p[0]) + abs(ny) * (p[3] - p[1])) / 2
    half_q = (abs(nx) * (q[2] - q[0]) + abs(ny) * (q[3] - q[1])) / 2
    far = box_squares(p, q)[1]
    return Truss(
        boxes[0],
        boxes[1],
        x,
        y,
        nx,
        ny,
        max(half_p, half_q),
        far * (1 + 4 * SLACK),
        w.clearance * w.clearance,
    )


@inner
def is_barred(loc: Locations, t: Truss, box: int) -> bool:
    """Tell whether no location of a box may hold an element besides the truss's ends [2]."""
    if t.a < 0:
        return False
    near, far = box_squares(loc.corners[t.a], loc.corners[box])
    if near > t.reach or far < t.apart:
        return True
    near, far = box_squares(loc.corners[t.b], loc.corners[box])
    return near > t.reach or far < t.apart


@inner
def branch(loc: Locations, t: Truss, box: int) -> float:
    """Return the least length of a branch from a box to the main truss (mm) [3]."""
    if t.a < 0:
        return 0.0
    c = loc.corners[box]
    away = abs(t.nx * ((c[0] + c[2]) / 2 - t.x) + t.ny * ((c[1] + c[3]) / 2 - t.y))
    wide = (abs(t.nx) * (c[2] - c[0]) + abs(t.ny) * (c[3] - c[1])) / 2
    length: float = max(0.0, away - wide - t.half)
    return length


@inner
def group_end(w: Weights, boxes: IntArray, n: int, first: int) -> int:
    """Return the index behind the last element of the cell that begins at ``first``."""
    last = first + 1
    if w.trussed == 0 or first > 1:
        while last < n and boxes[last] == boxes[first]:
            last += 1
    return last


# --- prices of single elements ---


@inner
def along(loc: Locations, box: int, u: FloatArray) -> float:
    """Return the least u . p over a box (mm)."""
    c = loc.corners[box]
    middle = u[0] * (c[0] + c[2]) / 2 + u[1] * (c[1] + c[3]) / 2
    wide = (abs(u[0]) * (c[2] - c[0]) + abs(u[1]) * (c[3] - c[1])) / 2
    lift = min(u[2] * loc.heights[box, 0], u[2] * loc.heights[box, 1])
    least: float = middle - wide + lift
    return least


@inner
def kind_price(w: Weights, kind: int, reach: float, u: FloatArray) -> float:
    """Return the part of an element's price that depends on its kind [4]; reach is u . p (mm)."""
    part: float = w.cup_pull * w.moment * reach
    if kind == MAGNETS:
        part = w.magnet_pull * w.moment * reach - u[3]
    return part


@inner
def price(loc: Locations, w: Weights, t: Truss, box: int, u: FloatArray) -> tuple[float, int]:
    """Return the least price of an element in a box [4], and its kind; exact at one location."""
    reach = along(loc, box, u)
    best, kind = np.inf, CUPS
    if w.cups > 0 and loc.carries[box, CUPS]:
        best = kind_price(w, CUPS, reach, u)
    if w.magnets > 0 and loc.carries[box, MAGNETS]:
        magnet = kind_price(w, MAGNETS, reach, u)
        if magnet < best:
            best, kind = magnet, MAGNETS
    fixed = loc.least_deviation[box] * w.deviation + branch(loc, t, box) * w.structure
    return fixed + best, kind


# --- the Lagrangian bound ---


@inner
def push(room: Room, size: int, value: float, tag: int) -> None:
    """Put an item into the heap of ``size`` items."""
    i = size
    while i > 0:
        parent = (i - 1) // 2
        if room.price[parent] <= value:
            break
        room.price[i], room.tag[i] = room.price[parent], room.tag[parent]
        i = parent
    room.price[i], room.tag[i] = value, tag


@inner
def pop(room: Room, size: int) -> None:
    """Take the least item off the heap, which has ``size`` items afterwards."""
    value, tag = room.price[size], room.tag[size]
    i = 0
    while True:
        child = 2 * i + 1
        if child >= size:
            break
        if child + 1 < size and room.price[child + 1] < room.price[child]:
            child += 1
        if room.price[child] >= value:
            break
        room.price[i], room.tag[i] = room.price[child], room.tag[child]
        i = child
    room.price[i], room.tag[i] = value, tag


@inner
def joins_clique(loc: Locations, w: Weights, place: int, cliques: int, room: Room) -> bool:
    """Put a location into the first clique whose members are all too close to it, if any [5]."""
    x, y = loc.xyz[place, 0], loc.xyz[place, 1]
    for c in range(cliques):
        members = room.clique_size[c]
        joins = members < CLIQUE
        for m in range(members if joins else 0):
            dx, dy = x - room.clique_x[c, m], y - room.clique_y[c, m]
            if dx * dx + dy * dy >= w.clearance * w.clearance:
                joins = False
                break
        if joins:
            room.clique_x[c, members], room.clique_y[c, members] = x, y
            room.clique_size[c] = members + 1
            return True
    room.clique_x[cliques, 0], room.clique_y[cliques, 0] = x, y
    room.clique_size[cliques] = 1
    return False


@inner
def cheapest(
    loc: Locations,
    w: Weights,
    t: Truss,
    cell: int,
    first: int,
    last: int,
    u: FloatArray,
    room: Room,
) -> float:
    """Return a bound on the prices of elements ``first`` to ``last`` in one cell; writes picks.

    Locations come in the order of their prices from the tree; one that is too close to all members
    of a clique joins it, and each clique gives its cheapest location [5].
    """
    size = 0
    value, _ = price(loc, w, t, cell, u)
    if value < np.inf and not is_barred(loc, t, cell):
        push(room, 0, value, cell)
        size = 1
    total, taken = 0.0, 0
    while taken < last - first:
        if size == 0:
            return np.inf
        value, box = room.price[0], room.tag[0]
        size -= 1
        pop(room, size)
        if loc.child[box, 0] < 0:
            place = loc.run[box, 0]
            if not joins_clique(loc, w, place, taken, room):
                room.pick[first + taken] = box
                total += value
                taken += 1
            continue
        for side in range(2):
            half = loc.child[box, side]
            if is_barred(loc, t, half):
                continue
            value, _ = price(loc, w, t, half, u)
            if value < np.inf:
                push(room, size, value, half)
                size += 1
    return total


@inner
def relaxed(
    loc: Locations, w: Weights, t: Truss, boxes: IntArray, n: int, u: FloatArray, room: Room
) -> float:
    """Return the least sum of prices of a node's elements; its picks are left in the room."""
    free = no_truss()
    total: float = u[3] * w.magnets
    first = 0
    while first < n:
        last = group_end(w, boxes, n, first)
        end = t.a >= 0 and first < 2
        total += cheapest(loc, w, free if end else t, boxes[first], first, last, u, room)
        if total == np.inf:
            break
        first = last
    return total


@inner
def balance(loc: Locations, w: Weights, n: int, u: FloatArray, room: Room) -> float:
    """Return the price of a magnet at which the picks have as many as wanted [7]; nan if none."""
    sorted_to = room.difference
    for i in range(n):
        box = room.pick[i]
        value = (w.magnet_pull - w.cup_pull) * w.moment * along(loc, box, u)
        if w.magnets == 0 or not loc.carries[box, MAGNETS]:
            value = np.inf
        elif w.cups == 0 or not loc.carries[box, CUPS]:
            value = -np.inf
        slot = i
        while slot > 0 and sorted_to[slot - 1] > value:
            sorted_to[slot] = sorted_to[slot - 1]
            slot -= 1
        sorted_to[slot] = value
    low = sorted_to[w.magnets - 1] if w.magnets > 0 else -np.inf
    high = sorted_to[w.magnets] if w.magnets < n else np.inf
    if low == np.inf or high == -np.inf:
        return np.nan
    if low == -np.inf:
        return high if high < np.inf else u[3]
    return (low + high) / 2 if high < np.inf else low


@inner
def ascend(
    loc: Locations,
    w: Weights,
    t: Truss,
    boxes: IntArray,
    n: int,
    truss: float,
    upper: float,
    u: FloatArray,
    steps: int,
    room: Room,
) -> float:
    """Return the best relaxed value after some projected Polyak steps; leaves its ``u`` [7]."""
    best, least_primal = -np.inf, np.inf
    damping, jump = 1.0, 0.0
    b0, b1, b2, b3 = u[0], u[1], u[2], u[3]
    for step in range(steps):
        value = truss + relaxed(loc, w, t, boxes, n, u, room)
        if value > best:
            best = value
            b0, b1, b2, b3 = u[0], u[1], u[2], u[3]
        else:
            damping *= 0.6
        if best >= upper or step == steps - 1:
            break
        x = y = z = 0.0
        magnets = 0
        for i in range(n):
            place = loc.run[room.pick[i], 0]
            _, kind = price(loc, w, t, room.pick[i], u)
            pull = w.magnet_pull if kind == MAGNETS else w.cup_pull
            magnets += kind
            x += pull * loc.xyz[place, 0]
            y += pull * loc.xyz[place, 1]
            z += pull * loc.xyz[place, 2]
        squared = x * x + y * y + z * z
        primal = value + w.moment * (np.sqrt(squared) - u[0] * x - u[1] * y - u[2] * z)
        if magnets == w.magnets:
            least_primal = min(least_primal, primal)
        target = min(upper, least_primal)
        if target == np.inf:
            target = primal
        if squared > 0.0 and w.moment > 0.0:
            stride = damping * (target - value) / (squared * w.moment)
            u[0] += stride * x
            u[1] += stride * y
            u[2] += stride * z
            norm = np.sqrt(u[0] * u[0] + u[1] * u[1] + u[2] * u[2])
            if norm > 1.0:
                u[0] /= norm
                u[1] /= norm
                u[2] /= norm
        balanced = balance(loc, w, n, u, room)
        if balanced == balanced:  # noqa: PLR0124 (not nan)
            u[3] = balanced
        else:  # the picks cannot have as many magnets: move their price until others are picked
            jump = 2 * jump if jump > 0.0 else max(1e-3, abs(target - value))
            u[3] += jump if magnets < w.magnets else -jump
    u[0], u[1], u[2], u[3] = b0, b1, b2, b3
    return best


# --- the direct bound of few elements ---


@inner
def gap(low: float, high: float) -> float:
    """Return the distance from 0 to an interval."""
    return max(0.0, low, -high)


@inner
def last_bound(
    loc: Locations,
    w: Weights,
    t: Truss,
    cell: int,
    kind: int,
    low: tuple[float, float, float],
    high: tuple[float, float, float],
    fixed: float,
    upper: float,
    room: Room,
) -> float:
    """Return the least value with one more element in a cell, at most ``upper`` [8].

    ``low`` and ``high`` are the limits of what the others add to the centre of force (mm), and
    ``fixed`` is their part of the value.
    """
    pull = w.magnet_pull if kind == MAGNETS else w.cup_pull
    aim_x, aim_y = -(low[0] + high[0]) / (2 * pull), -(low[1] + high[1]) / (2 * pull)
    best = upper
    room.tag[0] = cell
    size = 1
    while size > 0:
        size -= 1
        box = room.tag[size]
        if not loc.carries[box, kind]:
            continue
        c = loc.corners[box]
        x = gap(low[0] + pull * c[0], high[0] + pull * c[2])
        y = gap(low[1] + pull * c[1], high[1] + pull * c[3])
        z = gap(low[2] + pull * loc.heights[box, 0], high[2] + pull * loc.heights[box, 1])
        value = fixed + loc.least_deviation[box] * w.deviation
        value += w.moment * np.sqrt(x * x + y * y + z * z)
        if value >= best:
            continue
        value += branch(loc, t, box) * w.structure
        if value >= best or is_barred(loc, t, box):
            continue
        near, far = loc.child[box, 0], loc.child[box, 1]
        if near < 0:
            best = value
            continue
        p, q = loc.corners[near], loc.corners[far]
        towards_p = (aim_x - (p[0] + p[2]) / 2) ** 2 + (aim_y - (p[1] + p[3]) / 2) ** 2
        towards_q = (aim_x - (q[0] + q[2]) / 2) ** 2 + (aim_y - (q[1] + q[3]) / 2) ** 2
        if towards_q < towards_p:
            near, far = far, near
        room.tag[size], room.tag[size + 1] = far, near  # the nearer one is looked at first
        size += 2
    return best


@inner
def direct_bound(
    loc: Locations,
    w: Weights,
    t: Truss,
    boxes: IntArray,
    n: int,
    truss: float,
    upper: float,
    room: Room,
) -> float:
    """Return a bound without multipliers, at most ``upper``: every share of kinds in turn [8].

    All elements but the last stand anywhere in their boxes; the last one is looked for in the tree.
    """
    fixed = truss
    for i in range(n - 1):
        fixed += loc.least_deviation[boxes[i]] * w.deviation
        if i > 1 or t.a < 0:
            fixed += branch(loc, t, boxes[i]) * w.structure
    best = upper
    for share in range(1 << (n - 1)):
        magnets = 0
        x0 = x1 = y0 = y1 = z0 = z1 = 0.0
        possible = fixed < best
        for i in range(n - 1):
            kind = (share >> i) & 1
            possible = possible and loc.carries[boxes[i], kind]
            magnets += kind
            pull = w.magnet_pull if kind == MAGNETS else w.cup_pull
            c = loc.corners[boxes[i]]
            x0 += pull * c[0]
            y0 += pull * c[1]
            x1 += pull * c[2]
            y1 += pull * c[3]
            z0 += pull * loc.heights[boxes[i], 0]
            z1 += pull * loc.heights[boxes[i], 1]
        last = w.magnets - magnets
        if possible and 0 <= last <= 1:
            limits = no_truss() if t.a >= 0 and n == 2 else t
            low, high = (x0, y0, z0), (x1, y1, z1)
            best = last_bound(loc, w, limits, boxes[n - 1], last, low, high, fixed, best, room)
    return best


# --- the bound of a node ---


@inner
def can_hold(loc: Locations, w: Weights, t: Truss, boxes: IntArray, n: int) -> bool:
    """Tell whether distances and room in the boxes allow any grasp at all [2]."""
    for i in range(n):
        for j in range(i):
            if boxes[i] == boxes[j]:
                continue
            near, far = box_squares(loc.corners[boxes[i]], loc.corners[boxes[j]])
            if far < w.clearance * w.clearance or near > t.reach:
                return False
    first = 2 if t.a >= 0 else 0
    while first < n:
        last = group_end(w, boxes, n, first)
        run = loc.run[boxes[first]]
        if last - first > 1 and (loc.tight[boxes[first]] or run[1] - run[0] < last - first):
            return False
        first = last
    return True


@inner
def shortest_truss(loc: Locations, w: Weights, t: Truss) -> float:
    """Return the least length of the main truss (mm), infinite where none is long enough [1]."""
    if t.a < 0:
        return 0.0
    near, far = box_squares(loc.corners[t.a], loc.corners[t.b])
    if far < w.shortest * w.shortest:
        return np.inf
    length: float = max(np.sqrt(near), w.shortest)
    return length


@allocation_free
def node_bound(
    loc: Locations,
    w: Weights,
    boxes: IntArray,
    upper: float,
    u: FloatArray,
    steps: int,
    room: Room,
) -> float:
    """Return a lower bound of every grasp of a node; improves ``u``, its multipliers."""
    n = w.cups + w.magnets
    t = truss_of(loc, w, boxes)
    length = shortest_truss(loc, w, t)
    if length == np.inf or w.ratio * length > w.structure_cap:
        return np.inf
    if not can_hold(loc, w, t, boxes, n):
        return np.inf
    truss = w.base + w.ratio * length * w.structure
    if n > FEW:
        return ascend(loc, w, t, boxes, n, truss, upper, u, steps, room)
    direct = direct_bound(loc, w, t, boxes, n, truss, upper, room)
    if n < 4 or direct >= upper:
        return direct
    return max(direct, ascend(loc, w, t, boxes, n, truss, upper, u, steps, room))
