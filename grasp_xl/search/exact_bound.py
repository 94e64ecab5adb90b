"""Lower bounds of the nodes of the exact search (compiled).

docs/exact.md derives each bound; the numbers in brackets are its steps.
"""

from __future__ import annotations

import numpy as np

from grasp_xl.compiled import allocation_free, inner
from grasp_xl.search.exact_model import CUPS, MAGNETS, Locations
from grasp_xl.search.exact_multipliers import ascend
from grasp_xl.search.exact_prices import (
    Room,
    Truss,
    Weights,
    box_squares,
    branch,
    group_end,
    is_barred,
    leans,
    no_truss,
    truss_of,
)
from grasp_xl.space import FloatArray, IntArray

FEW = 5
"""Elements up to which every share of kinds is bounded directly."""


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
    cups = magnets = 0
    for i in range(n):
        cups += not loc.carries[boxes[i], MAGNETS]
        magnets += not loc.carries[boxes[i], CUPS]
    if cups > w.cups or magnets > w.magnets:
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
    direct = -np.inf
    if n <= FEW:
        direct = direct_bound(loc, w, t, boxes, n, truss, upper, room)
        if n < 4 or direct >= upper:
            return direct
    leaning = leans(loc, w, t, length)
    if leaning:
        truss = w.base
    return max(direct, ascend(loc, w, t, leaning, boxes, n, truss, upper, u, steps, room))
