"""All pairs of some locations, looked up by what they add to the centre of force (compiled).

Where many elements stand on one main truss, the moment decides which of them balance each other.
The last two are not tried one by one: for what the others pull, the pairs that balance it lie in a
few cells of a grid.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from grasp_xl.compiled import inner
from grasp_xl.search.exact_model import MAGNETS, Locations
from grasp_xl.search.exact_prices import Truss, Weights, fit_together
from grasp_xl.space import FloatArray, IntArray

GRID = 128
"""Cells along each side of a grid; there is one grid for none, one and two magnets in a pair."""

PAIRS = 1 << 20
"""Pairs that fit into the grids; where there are more, they are tried one by one."""


class Listed(NamedTuple):
    """Locations of a cell, by rising price.

    price, fixed ``(m,)`` price, and its part without the moment; place ``(m,)`` location; size
    ``(1,)`` how many.
    """

    price: FloatArray
    fixed: FloatArray
    place: IntArray
    size: IntArray


class Pairs(NamedTuple):
    """The grids.

    frame ``(4,)`` least x and y of the grid (mm), cells a mm along x and y; start ``(cells + 1,)``
    first pair of each cell; pull ``(m, 3)`` what a pair adds to the centre of force (mm); fixed
    ``(m,)`` its price without the moment; member ``(m, 3)`` ranks of both in the list, and a bit
    for the kind of each.
    """

    frame: FloatArray
    start: IntArray
    pull: FloatArray
    fixed: FloatArray
    member: IntArray


def make_pairs(most: int) -> Pairs:
    """Make grids for so many pairs."""
    return Pairs(
        np.empty(4),
        np.empty(3 * GRID * GRID + 1, dtype=np.int64),
        np.empty((most, 3)),
        np.empty(most),
        np.empty((most, 3), dtype=np.int64),
    )


@inner
def pull_of(w: Weights, kind: int) -> float:
    """Return an element's share of the lifting force."""
    pull: float = w.magnet_pull if kind == MAGNETS else w.cup_pull
    return pull


@inner
def lay_frame(loc: Locations, w: Weights, listed: Listed, pairs: Pairs) -> None:
    """Lay the grid over all that two of the listed locations can pull."""
    least, most = min(w.cup_pull, w.magnet_pull), max(w.cup_pull, w.magnet_pull)
    for axis in range(2):
        low, high = np.inf, -np.inf
        for rank in range(listed.size[0]):
            at = loc.xyz[listed.place[rank], axis]
            low = min(low, 2 * least * at, 2 * most * at)
            high = max(high, 2 * least * at, 2 * most * at)
        pairs.frame[axis] = low
        pairs.frame[2 + axis] = GRID / max(high - low, 1e-9)


@inner
def cell_of(pairs: Pairs, magnets: int, x: float, y: float) -> int:
    """Return the cell of a pair with so many magnets that pulls to x, y."""
    i = int(min(max((x - pairs.frame[0]) * pairs.frame[2], 0.0), GRID - 1.0))
    j = int(min(max((y - pairs.frame[1]) * pairs.frame[3], 0.0), GRID - 1.0))
    return (magnets * GRID + j) * GRID + i


@inner
def tabulate_pairs(
    loc: Locations, w: Weights, t: Truss, listed: Listed, below: float, pairs: Pairs
) -> bool:
    """Put all pairs with prices below a limit into the grids; False if they are too many."""
    lay_frame(loc, w, listed, pairs)
    start, cells = pairs.start, len(pairs.start) - 1
    for cell in range(cells + 1):
        start[cell] = 0
    put_pairs(loc, w, t, listed, below, False, pairs)
    for cell in range(cells):
        start[cell + 1] += start[cell]
    if start[cells] > len(pairs.fixed):
        return False
    put_pairs(loc, w, t, listed, below, True, pairs)
    for cell in range(cells, 0, -1):  # each start was moved behind its cell's pairs
        start[cell] = start[cell - 1]
    start[0] = 0
    return True


@inner
def put_pairs(
    loc: Locations, w: Weights, t: Truss, listed: Listed, below: float, filling: bool, pairs: Pairs
) -> None:
    """Count the pairs of each cell behind its start, or put them in and move the starts."""
    for p in range(listed.size[0]):
        for q in range(p + 1, listed.size[0]):
            if listed.price[p] + listed.price[q] >= below:
                break
            if fit_together(loc, w, t, listed.place[p], listed.place[q]):
                put_pair(loc, w, listed, p, q, filling, pairs)


@inner
def put_pair(
    loc: Locations, w: Weights, listed: Listed, p: int, q: int, filling: bool, pairs: Pairs
) -> None:
    """Count a pair, or put it into its cell, once for each choice of its kinds."""
    a, b = listed.place[p], listed.place[q]
    for code in range(4):
        kind_a, kind_b = code >> 1, code & 1
        if loc.footprint[a, kind_a] < 0 or loc.footprint[b, kind_b] < 0:
            continue
        pull_a, pull_b = pull_of(w, kind_a), pull_of(w, kind_b)
        x = pull_a * loc.xyz[a, 0] + pull_b * loc.xyz[b, 0]
        y = pull_a * loc.xyz[a, 1] + pull_b * loc.xyz[b, 1]
        cell = cell_of(pairs, kind_a + kind_b, x, y)
        if not filling:
            pairs.start[cell + 1] += 1
            continue
        row = pairs.start[cell]
        pairs.start[cell] += 1
        pairs.pull[row, 0], pairs.pull[row, 1] = x, y
        pairs.pull[row, 2] = pull_a * loc.xyz[a, 2] + pull_b * loc.xyz[b, 2]
        pairs.fixed[row] = listed.fixed[p] + listed.fixed[q]
        pairs.member[row, 0], pairs.member[row, 1], pairs.member[row, 2] = p, q, code
