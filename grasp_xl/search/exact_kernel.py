"""One step of the exact search (compiled): nodes are enumerated, or split and bounded.

The open nodes, and their order, are kept in arrays here too.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from grasp_xl.compiled import allocation_free, inner
from grasp_xl.kernels import RecordArray
from grasp_xl.search.exact_bound import node_bound
from grasp_xl.search.exact_cuts import MULTIPLIERS
from grasp_xl.search.exact_leaf import BUDGET, ENTRIES, enumerate_node
from grasp_xl.search.exact_model import CUPS, MAGNETS, Locations
from grasp_xl.search.exact_prices import Room, Truss, Weights, group_end, is_barred, truss_of
from grasp_xl.space import FloatArray, IntArray

STEPS = 6
"""Steps of the multipliers at a node; they go on from its parent's."""

STEPS_OF_HEIGHTS = 24
"""Steps where a box was parted by height: u turns towards the height that is left."""

STEPS_OF_TRUSS = 16
"""Steps before the grasps on one main truss are enumerated."""

MANY = 4
"""Elements from which on multipliers give the better bound."""

SIDES = 2
"""Sets of multipliers of a node: one for the value, one for the sum of the goals."""


class Nodes(NamedTuple):
    """Nodes of the search.

    bound ``(n,)``; u ``(n, SIDES, MULTIPLIERS)``; choice ``(n,)`` row of the weights; boxes
    ``(n, elements)``, behind a node's own elements 0.
    """

    bound: FloatArray
    u: FloatArray
    choice: IntArray
    boxes: IntArray


def make_nodes(shape: int | tuple[int, ...], elements: int) -> Nodes:
    """Make room for nodes of at most so many elements."""
    shape = (shape,) if isinstance(shape, int) else shape
    return Nodes(
        np.empty(shape),
        np.zeros((*shape, SIDES, MULTIPLIERS)),
        np.zeros(shape, dtype=np.int64),
        np.zeros((*shape, elements), dtype=np.int64),
    )


# Nodes are copied number by number: numba broadcasts a row that is given to a row, which takes
# several times as long to compile.


@inner
def of_one(children: Nodes, i: int) -> Nodes:
    """Return the children of one node, of the children of many."""
    return Nodes(children.bound[i], children.u[i], children.choice[i], children.boxes[i])


@inner
def copy_node(nodes: Nodes, row: int, to: Nodes, at: int) -> None:
    """Copy a node to a row of others."""
    to.bound[at], to.choice[at] = nodes.bound[row], nodes.choice[row]
    for side in range(SIDES):
        for axis in range(MULTIPLIERS):
            to.u[at, side, axis] = nodes.u[row, side, axis]
    for i in range(nodes.boxes.shape[1]):
        to.boxes[at, i] = nodes.boxes[row, i]


# --- open nodes, best first ---


@inner
def comes_first(key: FloatArray, age: IntArray, p: int, q: int) -> bool:
    """Tell whether node p is expanded before q: the lower key, then the newer one."""
    return key[p] < key[q] or (key[p] == key[q] and age[p] > age[q])


@inner
def sift_up(order: IntArray, size: int, key: FloatArray, age: IntArray) -> None:
    """Move the last of ``size`` nodes to its place in the heap ``order``."""
    i = size - 1
    row = order[i]
    while i > 0 and comes_first(key, age, row, order[(i - 1) // 2]):
        order[i] = order[(i - 1) // 2]
        i = (i - 1) // 2
    order[i] = row


@inner
def take_first(order: IntArray, size: int, key: FloatArray, age: IntArray) -> int:
    """Take the first node off the heap of ``size`` nodes; its slot goes behind the others."""
    first, row = order[0], order[size - 1]
    i = 0
    while True:
        child = 2 * i + 1
        if child >= size - 1:
            break
        if child + 1 < size - 1 and comes_first(key, age, order[child + 1], order[child]):
            child += 1
        if not comes_first(key, age, order[child], row):
            break
        order[i] = order[child]
        i = child
    order[i] = row
    order[size - 1] = first
    return int(first)


@allocation_free
def take_batch(
    nodes: Nodes,
    order: IntArray,
    key: FloatArray,
    age: IntArray,
    size: int,
    batch: Nodes,
    below: float,
) -> tuple[int, int]:
    """Move the first nodes with a bound below a limit into a batch; the others are dropped.

    Returns how many were moved, and how many are left open.
    """
    taken = 0
    while taken < len(batch.bound) and size > 0:
        row = take_first(order, size, key, age)
        size -= 1
        if nodes.bound[row] >= below:
            continue
        copy_node(nodes, row, batch, taken)
        taken += 1
    return taken, size


@allocation_free
def put_children(
    nodes: Nodes,
    order: IntArray,
    key: FloatArray,
    age: IntArray,
    size: int,
    oldest: int,
    children: Nodes,
    born: IntArray,
    below: float,
) -> int:
    """Put the children with a bound below a limit among the open nodes; return how many are open.

    ``order`` holds the rows of the open nodes as a heap, and behind them the free rows.
    """
    for i in range(len(born)):
        mine = of_one(children, i)
        for c in range(born[i]):
            if mine.bound[c] >= below:
                continue
            row = order[size]
            copy_node(mine, c, nodes, row)
            key[row], age[row] = mine.bound[c], oldest
            oldest += 1
            size += 1
            sift_up(order, size, key, age)
    return size


# --- splitting ---


@inner
def has_truss(loc: Locations, boxes: IntArray) -> bool:
    """Tell whether both ends of the main truss are single locations."""
    ends: bool = loc.child[boxes[0], 0] < 0 and loc.child[boxes[1], 0] < 0
    return ends


@inner
def of_heights(loc: Locations, box: int) -> bool:
    """Tell whether a box has locations of several heights, and is to be parted by them."""
    several: bool = loc.heights[box, 0] < loc.heights[box, 1]
    return loc.by_height and several


@inner
def of_two_kinds(loc: Locations, w: Weights, box: int) -> bool:
    """Tell whether an element of a box may be a cup or a magnet, and is to be one of them.

    On a flat part the multipliers tell the kinds apart as well, and in fewer nodes.
    """
    several: bool = loc.heights[0, 0] < loc.heights[0, 1]
    both: bool = loc.carries[box, CUPS] and loc.carries[box, MAGNETS]
    return several and both and w.cups > 0 and w.magnets > 0


@inner
def to_split(loc: Locations, w: Weights, boxes: IntArray, n: int) -> int:
    """Return which box to split; -1 if none.

    One of several heights; then the wider end of the truss; then one of two kinds, and the widest.
    """
    for i in range(n):
        if of_heights(loc, boxes[i]):
            return i
    if w.trussed and not has_truss(loc, boxes):
        return int(loc.width[boxes[1]] > loc.width[boxes[0]])
    widest, at = -1.0, -1
    for i in range(n):
        if of_two_kinds(loc, w, boxes[i]):
            return i
        if loc.width[boxes[i]] > widest:
            widest, at = loc.width[boxes[i]], i
    return at


@inner
def halves(loc: Locations, w: Weights, boxes: IntArray, at: int) -> tuple[int, int]:
    """Return the boxes that one is split into: its parts in the tree, or those of the two kinds."""
    box = boxes[at]
    kinds = of_two_kinds(loc, w, box) and not of_heights(loc, box)
    if kinds and (w.trussed == 0 or has_truss(loc, boxes)):
        tree = len(loc.child) // 3
        return box + tree, box + 2 * tree
    return loc.child[box, 0], loc.child[box, 1]


@inner
def tighten(loc: Locations, t: Truss, box: int) -> int:
    """Return the smallest box that holds all locations of a cell that are not barred."""
    while loc.child[box, 0] >= 0:
        low, high = loc.child[box, 0], loc.child[box, 1]
        if is_barred(loc, t, low):
            box = high
        elif is_barred(loc, t, high):
            box = low
        else:
            break
    return box


@inner
def split(loc: Locations, w: Weights, boxes: IntArray, at: int, out: IntArray) -> int:
    """Make rows of ``out (m, n)``, copies of a node's boxes, its children's; return how many."""
    n = w.cups + w.magnets
    low, high = halves(loc, w, boxes, at)
    last = group_end(w, boxes, n, at)
    pair = bool(w.trussed) and at < 2 and boxes[0] == boxes[1]
    if pair:
        last = at + 2
    born = last - at + 1
    for c in range(born):
        for i in range(at, last):
            out[c, i] = low if i - at < c else high
        if w.trussed and n > 2:
            t = truss_of(loc, w, out[c])
            first = 2
            while first < n:
                behind = group_end(w, out[c], n, first)
                tight = tighten(loc, t, out[c, first])
                for i in range(first, behind):
                    out[c, i] = tight
                first = behind
    return born


@allocation_free
def expand(
    loc: Locations,
    weights: RecordArray,
    goal_weights: RecordArray,
    batch: Nodes,
    first: int,
    behind: int,
    upper: float,
    slack: float,
    children: Nodes,
    born: IntArray,
    found: FloatArray,
    genes: IntArray,
    room: Room,
    halt: IntArray,
) -> None:
    """Enumerate nodes, or split them and bound their children.

    Parameters
    ----------
    loc : Locations
    weights, goal_weights : RecordArray
        ``(c,)`` of ``WEIGHTS``: the value, and the sum of the goals; no goals, no rows.
    batch : Nodes
        Of these, ``first`` up to ``behind`` are expanded.
    upper, slack : float
        Grasps at ``upper`` or above are of no use; nodes within ``slack`` of it are pruned.
    children, born : Nodes, IntArray
        ``(m, k)`` children of each node, and how many there are; none where
        all its grasps were looked at.
    found, genes : FloatArray, IntArray
        ``(m, k)`` values of grasps found, rising, ``upper`` where there is none; ``(m, k, n, 2)``
        their locations and kinds.
    room : Room
    halt : IntArray
        ``(1,)``; set from outside where the worker shall stop: a node that was not looked at is its
        own only child.
    """
    for i in range(first, behind):
        w = weights[batch.choice[i]]
        n = w.cups + w.magnets
        boxes, mine = batch.boxes[i], of_one(children, i)
        for slot in range(found.shape[1]):
            found[i, slot] = upper
        born[i] = 0
        at = to_split(loc, w, boxes, n)
        if halt[0]:
            born[i] = 1
            copy_node(batch, i, mine, 0)
            continue
        if w.trussed and n >= MANY and has_truss(loc, boxes):
            u = batch.u[i, 0]
            bound = node_bound(loc, w, boxes, upper - slack, u, STEPS_OF_TRUSS, room)
            if bound >= upper - slack:
                continue
            batch.bound[i] = max(batch.bound[i], bound)
        if is_small(loc, w, boxes, n):
            budget = BUDGET if at >= 0 else np.iinfo(np.int64).max
            if enumerate_node(loc, w, boxes, batch.u[i, 0], budget, found[i], genes[i], room):
                continue
        steps = STEPS_OF_HEIGHTS if of_heights(loc, boxes[at]) else STEPS
        for c in range(n + 1):
            copy_node(batch, i, mine, c)
        born[i] = split(loc, w, boxes, at, mine.boxes)
        for c in range(born[i]):
            child, u = mine.boxes[c], mine.u[c]
            bound = node_bound(loc, w, child, upper - slack, u[0], steps, room)
            mine.bound[c] = max(bound, batch.bound[i])
            if bound < upper - slack and len(goal_weights) > 0:
                goals = goal_weights[batch.choice[i]]
                if node_bound(loc, goals, child, goals.limit, u[1], steps, room) > goals.limit:
                    mine.bound[c] = np.inf


@inner
def is_small(loc: Locations, w: Weights, boxes: IntArray, n: int) -> bool:
    """Tell whether it is worth trying to enumerate a node."""
    if w.trussed:
        return has_truss(loc, boxes)
    locations = 0
    for i in range(n):
        locations += loc.run[boxes[i], 1] - loc.run[boxes[i], 0]
    return locations <= 2 * ENTRIES
