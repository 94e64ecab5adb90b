"""What single elements of a node add to its bound (compiled).

A node says in which boxes the elements of a grasp stand: the first two boxes hold the ends of the
main truss, the others are *cells*; a cell that stands there several times holds as many elements.
docs/exact.md derives each bound; the numbers in brackets are its steps.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from grasp_xl.compiled import inner
from grasp_xl.rules import SLACK
from grasp_xl.search.exact_cuts import Cuts, make_cuts
from grasp_xl.search.exact_model import CUPS, MAGNETS, Locations
from grasp_xl.space import FloatArray, IntArray

Weights = Any
"""A row of ``WEIGHTS``."""

LEAN_FROM = 0.7
"""The price of a truss's length is split between its ends where that bounds it by at least this
share of what the distance of their boxes does."""

CLIQUE = 64
"""Members of a clique that are kept; a larger one would bound no better."""


class Truss(NamedTuple):
    """Where the main truss may lie: boxes a and b of its ends, -1 where there is none.

    x, y (mm) a point of the line through the boxes' middles, nx, ny its unit normal; half (mm) is
    how far the true line may stray from it; squares of how far the elements may be from the ends
    (reach), and must be (apart).  Seen from one end alone, lean_x and lean_y are what its place
    adds to the price of the truss's length (1/mm).
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
    lean_x: float
    lean_y: float


class Room(NamedTuple):
    """Arrays that one worker needs: a heap, picks, cuts, cliques, the lists of ``exact_leaf``."""

    price: FloatArray
    tag: IntArray
    pick: IntArray
    cuts: Cuts
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
        make_cuts(),
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
    return Truss(-1, -1, 0.0, 0.0, 0.0, 0.0, 0.0, np.inf, 0.0, 0.0, 0.0)


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
        0.0,
        0.0,
    )


@inner
def seen_from(w: Weights, t: Truss, end: int) -> Truss:
    """Return the truss as one of its ends sees it: nothing limits it but the truss's length [1]."""
    weight = (-w.ratio if end == 0 else w.ratio) * w.structure
    return Truss(-1, -1, 0.0, 0.0, 0.0, 0.0, 0.0, np.inf, 0.0, weight * t.ny, -weight * t.nx)


@inner
def lean(loc: Locations, t: Truss, box: int) -> float:
    """Return the least that an end in a box adds to the price of the truss's length [1]."""
    c = loc.corners[box]
    middle = t.lean_x * (c[0] + c[2]) / 2 + t.lean_y * (c[1] + c[3]) / 2
    wide = (abs(t.lean_x) * (c[2] - c[0]) + abs(t.lean_y) * (c[3] - c[1])) / 2
    least: float = middle - wide
    return least


@inner
def leans(loc: Locations, w: Weights, t: Truss, length: float) -> bool:
    """Tell whether the ends' boxes are so far apart that the truss's length is a price of each."""
    if t.a < 0:
        return False
    least = lean(loc, seen_from(w, t, 0), t.a) + lean(loc, seen_from(w, t, 1), t.b)
    far: bool = least > LEAN_FROM * length * w.ratio * w.structure
    return far


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
def fit_together(loc: Locations, w: Weights, t: Truss, p: int, q: int) -> bool:
    """Tell whether two locations keep the clearance, and are no farther apart than the truss."""
    squared = squared_distance(loc, p, q)
    fits: bool = w.clearance * w.clearance <= squared <= t.reach
    return fits


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
    fixed = loc.least_deviation[box] * w.deviation
    if t.a >= 0:
        fixed += branch(loc, t, box) * w.structure
    elif t.lean_x != 0.0 or t.lean_y != 0.0:
        fixed += lean(loc, t, box)
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
    loc: Locations,
    w: Weights,
    t: Truss,
    leaning: bool,
    boxes: IntArray,
    n: int,
    u: FloatArray,
    room: Room,
) -> float:
    """Return the least sum of prices of a node's elements; its picks are left in the room."""
    total: float = u[3] * w.magnets
    first = 0
    while first < n:
        last = group_end(w, boxes, n, first)
        seen = t
        if t.a >= 0 and first < 2:
            seen = seen_from(w, t, first) if leaning else no_truss()
        total += cheapest(loc, w, seen, boxes[first], first, last, u, room)
        if total == np.inf:
            break
        first = last
    return total
