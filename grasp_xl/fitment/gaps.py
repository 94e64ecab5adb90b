"""Small gaps between lines are closed by bridges; the lines themselves stay as they are drawn."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import STRtree

from grasp_xl.space import FloatArray

Pieces: TypeAlias = NDArray[np.object_]
"""Lines that meet at their ends alone."""

GRID_MM = 1e-6
"""All corners lie on this raster, so that lines that meet share a corner exactly."""

SAME_MM = 10 * GRID_MM
"""Corners so near are meant to be one: files keep so many decimals, or fewer."""


def joined(lines: Pieces, gap_mm: float) -> Pieces:
    """Return the lines cut where they meet, with bridges from each open end to all near it.

    Only open ends have bridges: a chain of lines that are shorter than the gap is not pulled
    together.  A bridge too many, as at lines that are drawn twice, encloses next to nothing.

    Parameters
    ----------
    lines : NDArray
        As drawn.
    gap_mm : float
        Longest bridge.
    """
    pieces = _cut(lines)
    bridges = _bridges(pieces, gap_mm + SAME_MM)
    return _cut(np.concatenate([pieces, bridges])) if len(bridges) else pieces


def both_ends(pieces: Pieces) -> FloatArray:
    """Return the first and the last point of each, ``(2 n, 2)``."""
    ends = np.stack([shapely.get_point(pieces, 0), shapely.get_point(pieces, -1)], axis=1)
    return np.array(shapely.get_coordinates(ends), dtype=float)


def groups_of(count: int, pairs: NDArray[np.intp]) -> NDArray[np.intp]:
    """Return, for each of so many things, the first of those that pairs join with it.

    Examples
    --------
    >>> groups_of(5, np.array([[3, 1], [4, 3]])).tolist()
    [0, 1, 2, 1, 1]
    """
    root = list(range(count))

    def find(one: int) -> int:
        while root[one] != one:
            root[one] = one = root[root[one]]
        return one

    for pair in pairs[pairs[:, 0] != pairs[:, 1]].tolist():
        low, high = sorted(map(find, pair))
        root[high] = low
    return np.array([find(one) for one in range(count)], dtype=np.intp)


def in_groups(pieces: Pieces, group: NDArray[np.intp]) -> list[Pieces]:
    """Return the pieces of each group."""
    order = np.argsort(group, kind="stable")
    return np.split(pieces[order], np.flatnonzero(np.diff(group[order])) + 1)


def _cut(lines: Pieces) -> Pieces:
    """Return lines cut where they meet; one group that touches at a time, as that is quick."""
    near = STRtree(lines).query(lines, predicate="dwithin", distance=SAME_MM).T
    groups = in_groups(lines, groups_of(len(lines), near))
    return np.array(
        shapely.get_parts([shapely.union_all(group, grid_size=GRID_MM) for group in groups]),
        dtype=object,
    )


def _bridges(pieces: Pieces, reach: float) -> Pieces:
    """Return bridges from open ends to others and to lines; and between corners that are one."""
    nodes, node, degree = np.unique(
        both_ends(pieces), axis=0, return_inverse=True, return_counts=True
    )
    node = node.reshape(-1, 2)
    alone = np.flatnonzero(degree == 1)
    pairs = np.concatenate([_near(nodes, SAME_MM), alone[_near(nodes[alone], reach)]])
    between = shapely.linestrings(nodes[pairs])
    points = shapely.points(nodes[alone])
    near, line = STRtree(pieces).query(points, predicate="dwithin", distance=reach)
    foreign = np.all(node[line] != alone[near, None], axis=1)
    to_lines = shapely.shortest_line(points[near[foreign]], pieces[line[foreign]])
    return np.concatenate([between, to_lines])


def _near(places: FloatArray, distance: float) -> NDArray[np.intp]:
    """Return the pairs of places that are near each other, ``(n, 2)``."""
    points = shapely.points(places)
    pairs = STRtree(points).query(points, predicate="dwithin", distance=distance).T
    return np.array(pairs[pairs[:, 0] < pairs[:, 1]], dtype=np.intp)
