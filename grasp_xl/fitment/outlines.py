"""From lines to outlines with holes: gaps closed, what is open or crossed told, parts nested."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import LineString, Point, Polygon, STRtree

from grasp_xl.errors import Problem, refuse
from grasp_xl.fitment.dxf_lines import Line
from grasp_xl.printable import quoted
from grasp_xl.space import FloatArray

SAME_MM = 1e-6
"""Ends that are nearer to each other meet: files keep so many decimals, or fewer."""


@dataclass(frozen=True, eq=False, slots=True)
class _Ends:
    """Ends of lines that meet no other.

    Parameters
    ----------
    places_mm : FloatArray
        ``(n, 2)`` array.
    layers : list of str
    """

    places_mm: FloatArray
    layers: list[str]


def outlines_of(lines: Sequence[Line], gap_mm: float, name: str) -> list[Polygon]:
    """Return the outlines of all parts, with their holes, the largest first.

    Lines that meet are one figure; figures nest by even-odd: one in none is a part, one in a part a
    hole, one in a hole a part again.

    Parameters
    ----------
    lines : sequence of Line
    gap_mm : float
        Ends up to so far apart are joined.
    name : str
        Of the file.

    Raises
    ------
    InputError
        With every outline that is open, or that other lines cross or divide.
    """
    drawn, layers = _snapped(lines)
    bridges, ends = _bridged(drawn, layers, max(gap_mm, 2 * SAME_MM))
    pieces = shapely.get_parts(shapely.union_all([*drawn, *bridges]))
    refuse(_open_ends(ends, pieces, name), name)
    figures = _figures(pieces)
    refuse([problem for figure in figures for problem in _divided(figure, lines, name)], name)
    return _nested([areas[0] for areas in figures])


def _snapped(lines: Sequence[Line]) -> tuple[NDArray[np.object_], list[str]]:
    """Return lines and their layers, all points on one fine raster: ends that meet are equal."""
    drawn = shapely.set_precision(
        [LineString(line.points_mm) for line in lines], SAME_MM, mode="pointwise"
    )
    long = shapely.length(drawn) > 0
    layers = [line.layer for line, kept in zip(lines, long, strict=True) if kept]
    return drawn[long], layers


def _bridged(
    drawn: NDArray[np.object_], layers: Sequence[str], gap_mm: float
) -> tuple[list[LineString], _Ends]:
    """Return bridges over gaps between open ends, the narrowest first, and the ends left open."""
    first, last = shapely.get_point(drawn, 0), shapely.get_point(drawn, -1)
    places = shapely.get_coordinates(np.concatenate([first, last]))
    of_layers = [*layers, *layers]
    _, inverse, counts = np.unique(places, axis=0, return_inverse=True, return_counts=True)
    (alone,) = np.nonzero(counts[inverse.ravel()] == 1)
    places, of_layers = places[alone], [of_layers[number] for number in alone]
    points = shapely.points(places)
    pairs = STRtree(points).query(points, predicate="dwithin", distance=gap_mm).T
    pairs = pairs[pairs[:, 0] < pairs[:, 1]]
    gaps = np.linalg.norm(places[pairs[:, 0]] - places[pairs[:, 1]], axis=1)
    bridges, taken = [], np.zeros(len(places), dtype=bool)
    for one, other in pairs[np.argsort(gaps, kind="stable")]:
        if not taken[one] and not taken[other]:
            taken[[one, other]] = True
            bridges.append(LineString([places[one], places[other]]))
    left = np.flatnonzero(~taken)
    return bridges, _Ends(places[left], [of_layers[number] for number in left])


def _open_ends(ends: _Ends, noded: NDArray[np.object_], name: str) -> list[Problem]:
    """Return a problem for each end that no line touches, with the gap to the nearest end."""
    if not len(ends.places_mm):
        return []
    touches = STRtree(noded).query(shapely.points(ends.places_mm), "dwithin", SAME_MM)[0]
    open_ones = np.flatnonzero(np.bincount(touches, minlength=len(ends.places_mm)) < 2)
    problems = []
    for number in open_ones:
        x, y = ends.places_mm[number]
        others = np.delete(ends.places_mm, number, axis=0)
        gap = np.min(np.linalg.norm(others - ends.places_mm[number], axis=1), initial=np.inf)
        told = f"{gap:.3g} mm from the next open end" if np.isfinite(gap) else "with no other"
        layer = ends.layers[number]
        problems.append(
            Problem(
                f"{name}, layer {quoted(layer)}, x {x:.6g} y {y:.6g} mm",
                f"an outline that ends there, {told}",
                "closed outlines",
                "close it in CAD, raise --gap, or leave its layer out with --ignore-layer",
            )
        )
    return problems


def _figures(pieces: NDArray[np.object_]) -> list[list[Polygon]]:
    """Return the areas that each figure of lines that meet encloses."""
    ends = shapely.get_coordinates(
        np.concatenate([shapely.get_point(pieces, 0), shapely.get_point(pieces, -1)])
    )
    _, nodes = np.unique(ends, axis=0, return_inverse=True)
    first, last = np.split(nodes.ravel(), 2)
    members: dict[int, list[LineString]] = defaultdict(list)
    root = _roots(first.tolist(), last.tolist())
    for piece, node in zip(pieces, first.tolist(), strict=True):
        members[root[node]].append(piece)
    found = (shapely.get_parts(shapely.polygonize(group)) for group in members.values())
    return [list(areas) for areas in found if len(areas)]


def _roots(first: Sequence[int], last: Sequence[int]) -> list[int]:
    """Return, for each node, one node that stands for all that edges join with it."""
    root = list(range(1 + max(*first, *last)))

    def find(node: int) -> int:
        while root[node] != node:
            root[node] = node = root[root[node]]
        return node

    for one, other in zip(first, last, strict=True):
        root[find(one)] = find(other)
    return [find(node) for node in range(len(root))]


def _divided(areas: Sequence[Polygon], lines: Sequence[Line], name: str) -> list[Problem]:
    """Return a problem where the lines of a figure enclose several areas.

    They may be bend lines, holes that touch an edge, or outlines that cross: nobody can tell.
    """
    if len(areas) == 1:
        return []
    edge = areas[0].boundary.intersection(shapely.union_all([a.boundary for a in areas[1:]]))
    x, y = edge.representative_point().coords[0]
    near = [line.layer for line in lines if LineString(line.points_mm).dwithin(Point(x, y), 1e-3)]
    layers = ", ".join(quoted(layer) for layer in dict.fromkeys(near))
    return [
        Problem(
            f"{name}, layer {layers}, x {x:.6g} y {y:.6g} mm",
            f"lines that meet and enclose {len(areas)} areas",
            "outlines that neither touch nor cross each other",
            "leave out the layer of bend lines or engravings with --ignore-layer",
        )
    ]


def _nested(figures: Sequence[Polygon]) -> list[Polygon]:
    """Return the figures at even depths with those in them as holes, the largest first."""
    if not figures:
        return []
    sizes = shapely.area(figures)
    points = [each.representative_point() for each in figures]
    inside, around = STRtree(figures).query(points, "within")
    larger = sizes[around] >= sizes[inside]  # the point may lie in a figure within its own
    inside, around = inside[larger], around[larger]
    depth = np.bincount(inside, minlength=len(figures)) - 1
    holes: dict[int, list[Polygon]] = defaultdict(list)
    for one, other in zip(inside, around, strict=True):
        if depth[one] % 2 and depth[other] == depth[one] - 1:
            holes[other].append(figures[one])
    parts = [
        Polygon(figure.exterior, [hole.exterior for hole in holes[number]])
        for number, figure in enumerate(figures)
        if depth[number] % 2 == 0
    ]

    def key(part: Polygon) -> tuple[float, float, float]:
        x_low, y_low, x_high, y_high = (round(each, 3) for each in part.bounds)
        return -round(part.area, 3), -x_low - x_high, -y_low - y_high

    return sorted(parts, key=key)
