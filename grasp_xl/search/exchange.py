"""Good grasps at once: of a grasp one element moves, or two that keep the moment balanced.

A heuristic beside the proof: the sooner a good grasp is known, the fewer nodes are looked at.  An
iterated local search with streams of its own, so that it finds the same on every machine.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from grasp_xl.compiled import allocation_free, inner
from grasp_xl.kernels import Tables, is_clear, squared_distance, tabulate, value_below
from grasp_xl.rules import Rules
from grasp_xl.space import FloatArray, IntArray, OptionSpace

STREAMS = 2
"""Independent searches: a number that does not depend on the machine."""
SEED = 20_261_126

FRESH_START = 0.15
"""How often a descent begins anew, and not from the best grasp of its counts."""
MOST_KICKED = 3
TRIES = 300
"""Draws of a start before it is given up."""
GAIN = 1e-12
"""Relative gain that counts as one."""


class Cells(NamedTuple):
    """The places of each kind in square cells of a grid in plan view.

    low ``(k, 2)`` corner (mm); size ``(k,)`` side (mm); shape ``(k, 2)``; first ``(k,)`` where a
    kind's cells begin in start; start ``(cells + k,)`` where the places of a cell begin in order;
    order ``(n,)`` places, cell after cell.
    """

    low: FloatArray
    size: FloatArray
    shape: IntArray
    first: IntArray
    start: IntArray
    order: IntArray


class Kept(NamedTuple):
    """What one stream knows: the best grasp of each choice of counts.

    counts ``(c, 2)``; values ``(c,)``, infinity where there is none; places ``(c, elements)``, kind
    after kind; round ``(1,)``; work ``(4, elements)``.
    """

    counts: IntArray
    values: FloatArray
    places: IntArray
    round: IntArray
    work: IntArray


def lay_cells(t: Tables) -> Cells:
    """Lay the grids: about one place a cell."""
    kinds = len(t.kinds)
    low, size = np.zeros((kinds, 2)), np.ones(kinds)
    shape, first = np.ones((kinds, 2), dtype=np.int64), np.zeros(kinds, dtype=np.int64)
    starts: list[IntArray] = []
    orders: list[IntArray] = []
    begun = 0
    for k, kind in enumerate(t.kinds):
        places = kind["first"] + np.arange(kind["total"])
        points = np.column_stack([t.footprints[axis][places] for axis in ("x", "y")])
        if len(points):
            low[k], extent = points.min(axis=0), np.maximum(np.ptp(points, axis=0), 1.0)
            size[k] = np.sqrt(extent.prod() / len(points))
            size[k] = max(size[k], extent.max() / len(points))
            shape[k] = (extent / size[k]).astype(np.int64) + 1
        cell = np.minimum(((points - low[k]) / size[k]).astype(np.int64), shape[k] - 1)
        key = cell[:, 0] * shape[k, 1] + cell[:, 1]
        order = np.argsort(key, kind="stable")
        ends = np.searchsorted(key[order], np.arange(shape[k].prod() + 1))
        first[k] = sum(len(each) for each in starts)
        starts.append(begun + ends)
        orders.append(places[order])
        begun += len(points)
    return Cells(low, size, shape, first, np.concatenate(starts), np.concatenate(orders))


@inner
def is_free(t: Tables, places: IntArray, n: int, i: int, j: int, place: int) -> bool:
    """Tell whether a place keeps the clearance from all elements but i and j."""
    for m in range(n):
        if m not in (i, j) and squared_distance(t, places[m], place) < t.clearance_squared:
            return False
    return True


@inner
def move_one(
    t: Tables, genes: IntArray, kinds: IntArray, places: IntArray, n: int, i: int, value: float
) -> tuple[float, int]:
    """Move element i to the best of all its places; return the value and how many were judged."""
    best, kind = places[i], t.kinds[kinds[i]]
    for place in range(kind.first, kind.first + kind.total):
        places[i] = place
        found = value_below(t, genes, places, n, value)
        if found < value and is_free(t, places, n, i, i, place):
            value, best = found, place
    places[i] = best
    return value, kind.total


@inner
def move_two(
    t: Tables,
    cells: Cells,
    genes: IntArray,
    kinds: IntArray,
    places: IntArray,
    n: int,
    i: int,
    j: int,
    value: float,
) -> tuple[float, int]:
    """Move i to each of its places, and j to near where it would balance the moment."""
    x = y = 0.0
    for m in range(n):
        if m not in (i, j):
            force, at = t.kinds[kinds[m]].force, t.footprints[places[m]]
            x += force * at.x
            y += force * at.y
    best_i, best_j, judged = places[i], places[j], 0
    kind, other = t.kinds[kinds[i]], kinds[j]
    pull = t.kinds[other].force
    side, rows, columns = cells.size[other], cells.shape[other, 0], cells.shape[other, 1]
    for place in range(kind.first, kind.first + kind.total):
        at = t.footprints[place]
        row = (-(x + kind.force * at.x) / pull - cells.low[other, 0]) / side
        column = (-(y + kind.force * at.y) / pull - cells.low[other, 1]) / side
        if not (-1.0 < row < rows + 1 and -1.0 < column < columns + 1):
            continue
        if not is_free(t, places, n, i, j, place):
            continue
        places[i] = place
        near, far = max(0, int(column) - 1), min(columns - 1, int(column) + 1)
        for line in range(max(0, int(row) - 1), min(rows - 1, int(row) + 1) + 1):
            begin = cells.first[other] + line * columns
            for k in range(cells.start[begin + near], cells.start[begin + far + 1]):
                places[j] = cells.order[k]
                judged += 1
                found = value_below(t, genes, places, n, value)
                if found < value and is_free(t, places, n, j, j, places[j]):
                    value, best_i, best_j = found, place, places[j]
    places[i], places[j] = best_i, best_j
    return value, judged


@inner
def descend(
    t: Tables,
    cells: Cells,
    genes: IntArray,
    kinds: IntArray,
    places: IntArray,
    n: int,
    value: float,
    most: int,
    halt: IntArray,
) -> tuple[float, int]:
    """Move elements, and pairs of them in turn, until no move gains anything.

    It ends as well once so many grasps are judged, or told to halt.
    """
    judged = idle = turn = 0
    while idle < n * n and judged < most and not halt[0]:
        i, j = turn // n % n, turn % n
        turn += 1
        if i == j:
            found, more = move_one(t, genes, kinds, places, n, i, value)
        else:
            found, more = move_two(t, cells, genes, kinds, places, n, i, j, value)
        judged += more + t.kinds[kinds[i]].total
        idle = 0 if found < value - GAIN * abs(value) else idle + 1
        value = found
    return value, judged


@inner
def below(rng: np.random.Generator, number: int) -> int:
    """Draw a whole number from 0 to below a number."""
    return int(rng.random() * number)


@inner
def draw(t: Tables, rng: np.random.Generator, kind: int) -> int:
    """Draw a place of a kind."""
    first: int = t.kinds[kind].first
    return first + below(rng, t.kinds[kind].total)


@inner
def start(
    t: Tables, kept: Kept, choice: int, kinds: IntArray, places: IntArray, rng: np.random.Generator
) -> bool:
    """Write a grasp to begin from: a random one, or the best of its counts with some moved."""
    n = kept.counts[choice, 0] + kept.counts[choice, 1]
    fresh = kept.values[choice] == np.inf or rng.random() < FRESH_START
    for _ in range(TRIES):
        for m in range(n):
            places[m] = draw(t, rng, kinds[m]) if fresh else kept.places[choice, m]
        for _ in range(0 if fresh else 1 + below(rng, MOST_KICKED)):
            moved = below(rng, n)
            places[moved] = draw(t, rng, kinds[moved])
        if is_clear(t, places, n):
            return True
    return False


@allocation_free
def exchange(
    t: Tables,
    cells: Cells,
    kept: Kept,
    rng: np.random.Generator,
    judged: int,
    halt: IntArray,
) -> None:
    """Search on until so many grasps are judged, or told to halt; better ones are kept."""
    kinds, places, genes = kept.work[0], kept.work[1], kept.work[2:4]
    while judged > 0 and not halt[0]:
        choice = kept.round[0] % len(kept.counts)
        if kept.round[0] % 2:  # every other round goes to the counts of the best
            for other in range(len(kept.counts)):
                if kept.values[other] < kept.values[choice]:
                    choice = other
        kept.round[0] += 1
        n = 0
        for kind in range(2):
            genes[kind, 0] = kept.counts[choice, kind]
            for _ in range(genes[kind, 0]):
                kinds[n] = kind
                n += 1
        judged -= TRIES  # also where nothing is found to begin from
        if not start(t, kept, choice, kinds, places, rng):
            continue
        value = value_below(t, genes, places, n, np.inf)
        value, more = descend(t, cells, genes, kinds, places, n, value, judged, halt)
        judged -= more
        if value < kept.values[choice]:
            kept.values[choice] = value
            for m in range(n):
                kept.places[choice, m] = places[m]


class Exchange:
    """The streams of one task.

    Parameters
    ----------
    space, rules
    counts : sequence of tuple of int
        Choices of counts, of two kinds, that lift the part.
    """

    def __init__(self, space: OptionSpace, rules: Rules, counts: Sequence[tuple[int, ...]]) -> None:
        self._tables = tabulate(space, rules)
        self._cells = lay_cells(self._tables)
        self._rngs = [np.random.default_rng((SEED, stream)) for stream in range(STREAMS)]
        elements, choices = max(map(sum, counts)), len(counts)
        self._kept = [
            Kept(
                np.array(counts, dtype=np.int64),
                np.full(choices, np.inf),
                np.zeros((choices, elements), dtype=np.int64),
                np.array([stream], dtype=np.int64),
                np.zeros((4, elements), dtype=np.int64),
            )
            for stream in range(STREAMS)
        ]

    def search(self, stream: int, judged: int, halt: IntArray) -> None:
        """Let a stream go on until so many grasps are judged, or until told to halt."""
        tables, cells, kept = self._tables, self._cells, self._kept[stream]
        exchange(tables, cells, kept, self._rngs[stream], judged, halt)

    def know(self, active: tuple[tuple[int, ...], ...], value: float) -> None:
        """Take a grasp into every stream, to go on from it."""
        counts = tuple(map(len, active))
        first = self._tables.kinds["first"]
        places = [first[k] + index - 1 for k, indices in enumerate(active) for index in indices]
        for kept in self._kept:
            for choice in np.flatnonzero((kept.counts == counts).all(axis=1)).tolist():
                if value < kept.values[choice]:
                    kept.values[choice] = value
                    kept.places[choice, : len(places)] = places

    def found(self) -> list[tuple[tuple[int, ...], ...]]:
        """Return the active indices of the best grasp of each stream."""
        best = []
        for kept in self._kept:
            choice = int(np.argmin(kept.values))
            if kept.values[choice] == np.inf:
                continue
            ends = np.cumsum(kept.counts[choice]).tolist()
            parts = np.split(kept.places[choice, : ends[-1]], ends[:-1])
            first = self._tables.kinds["first"].tolist()
            best.append(
                tuple(
                    tuple(sorted((part - begin + 1).tolist()))
                    for part, begin in zip(parts, first, strict=True)
                )
            )
        return best
