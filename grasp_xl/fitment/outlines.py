"""From lines to outlines with holes: what is open or crossed is told, the rest is nested."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from shapely import LineString, Polygon, STRtree

from grasp_xl.errors import Problem, refuse
from grasp_xl.fitment.dxf_lines import Line
from grasp_xl.fitment.gaps import SAME_MM, Pieces, both_ends, groups_of, in_groups, joined
from grasp_xl.printable import quoted
from grasp_xl.space import FloatArray

THIN_MM = 0.05
"""Areas no wider hold nothing: lines that cross a little where they should end enclose some."""

TWICE_MM = 2 * THIN_MM
"""Outlines that stray no farther from each other are one, drawn twice."""


@dataclass(frozen=True, eq=False, slots=True)
class _Figure:
    """Lines that meet.

    Parameters
    ----------
    areas : list of Polygon
        That they enclose, the largest first; one, if they are an outline.
    open_chains : list of LineString
        That end somewhere.
    open_ends_mm : FloatArray
        ``(n, 2)`` array: where they do.
    links : list of LineString
        That have an area at neither side, and end nowhere.
    """

    areas: list[Polygon]
    open_chains: list[LineString]
    open_ends_mm: FloatArray
    links: list[LineString]


@dataclass(frozen=True, eq=False, slots=True)
class _Places:
    """Names places of a drawing for messages.

    Parameters
    ----------
    lines : sequence of Line
    drawn : STRtree
        Of them.
    name : str
        Of the file.
    near_mm : float
        How far from it lines can be.
    """

    lines: Sequence[Line]
    drawn: STRtree
    name: str
    near_mm: float

    def told(self, place: FloatArray) -> str:
        """Return file, layers and coordinates."""
        x, y = place
        near = self.drawn.query(shapely.points(place), "dwithin", self.near_mm)
        layers = sorted({quoted(self.lines[number].layer) for number in near})
        return f"{self.name}, layer {', '.join(layers)}, x {x:.6g} y {y:.6g} mm"


def outlines_of(
    lines: Sequence[Line], gap_mm: float, name: str
) -> tuple[list[Polygon], list[Problem]]:
    """Return the outlines of all parts, with their holes, the largest first; and notes.

    Lines that meet are one figure; figures nest by even-odd: one in none is a part, one in a part a
    hole, one in a hole a part again.  Open lines in a hole are left out with a note: whatever they
    are, no element can stand there.

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
    drawn = np.array([LineString(line.points_mm) for line in lines], dtype=object)
    pieces = joined(drawn, gap_mm)
    thin = gap_mm + THIN_MM
    figures = [_figure(group, thin) for group in _that_meet(pieces)]
    places = _Places(lines, STRtree(drawn), name, gap_mm + SAME_MM)
    closed = _once([Polygon(one.areas[0].exterior) for one in figures if one.areas])
    idle, open_ones = _by_where_they_are([one for one in figures if one.open_chains], closed)
    ends = np.concatenate([np.empty((0, 2)), *(figure.open_ends_mm for figure in open_ones)])
    told = [_open_end(number, ends, places) for number in range(len(ends))]
    refuse([*told, *_divided(figures, places)], name)
    notes = [_note(figure.open_chains[0], places) for figure in idle]
    return _nested(closed), notes


def _that_meet(pieces: Pieces) -> Iterable[Pieces]:
    """Yield the pieces of each figure."""
    if not len(pieces):
        return []
    _, nodes = np.unique(both_ends(pieces), axis=0, return_inverse=True)
    pairs = nodes.reshape(-1, 2)
    return in_groups(pieces, groups_of(1 + int(pairs.max()), pairs)[pairs[:, 0]])


def _figure(pieces: Pieces, thin: float) -> _Figure:
    """Return what lines that meet enclose.

    Areas too thin to hold anything lie between lines that are drawn twice, or that cross where they
    should end; lines as short as that stick out there.
    """
    areas, links, open_ones, _ = (
        shapely.get_parts(each) for each in shapely.polygonize_full(pieces)
    )
    if len(areas) > 1:
        areas = areas[~shapely.is_empty(shapely.buffer(areas, -thin / 2))]
    areas = areas[np.argsort(-shapely.area(areas), kind="stable")]
    chains = _long(open_ones, thin)
    return _Figure(list(areas), list(chains), _open_ends(chains, pieces), list(_long(links, thin)))


def _long(pieces: Pieces, thin: float) -> Pieces:
    if not len(pieces):
        return pieces
    chains = shapely.get_parts(shapely.line_merge(shapely.multilinestrings(pieces)))
    return np.array(chains[shapely.length(chains) > thin], dtype=object)


def _open_ends(chains: Pieces, pieces: Pieces) -> FloatArray:
    """Return the ends of chains that are ends of one piece alone."""
    if not len(chains):
        return np.empty((0, 2))
    ends, counts = np.unique(both_ends(pieces), axis=0, return_counts=True)
    single = set(map(tuple, ends[counts == 1].tolist()))
    found = [end for end in both_ends(chains).tolist() if tuple(end) in single]
    return np.array(found) if found else both_ends(chains)[:1]


def _once(figures: Sequence[Polygon]) -> list[Polygon]:
    """Return the figures, the largest first, without those that nearly are another one."""
    if not figures:
        return []
    found = np.array(sorted(figures, key=lambda one: -one.area), dtype=object)
    bounds = shapely.bounds(found).reshape(-1, 4)
    corners = shapely.points(bounds[:, :2])
    one, other = STRtree(corners).query(corners, predicate="dwithin", distance=2 * TWICE_MM)
    like = (one < other) & np.all(np.abs(bounds[one] - bounds[other]) <= TWICE_MM, axis=1)
    one, other = one[like], other[like]
    rings = shapely.get_exterior_ring(found)
    twice = other[shapely.hausdorff_distance(rings[one], rings[other]) <= TWICE_MM]
    return list(np.delete(found, twice))


def _by_where_they_are(
    figures: Sequence[_Figure], closed: Sequence[Polygon]
) -> tuple[list[_Figure], list[_Figure]]:
    """Return the open figures that lie in a hole, and the others."""
    drawn = np.array([shapely.union_all(one.open_chains) for one in figures], dtype=object)
    inside, _ = STRtree(list(closed)).query(drawn, predicate="within")
    depth = np.bincount(inside, minlength=len(figures))
    in_holes = [
        not figure.areas and depth[number] > 0 and depth[number] % 2 == 0
        for number, figure in enumerate(figures)
    ]
    return (
        [figure for figure, idle in zip(figures, in_holes, strict=True) if idle],
        [figure for figure, idle in zip(figures, in_holes, strict=True) if not idle],
    )


def _note(chain: LineString, places: _Places) -> Problem:
    return Problem(
        places.told(shapely.get_coordinates(chain)[0]),
        "an open line in a hole",
        "closed outlines",
        "it is left out",
    )


def _open_end(number: int, ends: FloatArray, places: _Places) -> Problem:
    """Return the problem of an open end, with the gap to the nearest other."""
    others = np.delete(ends, number, axis=0)
    gap = np.min(np.linalg.norm(others - ends[number], axis=1), initial=np.inf)
    told = f"{gap:.3g} mm from the next open end" if np.isfinite(gap) else "with no other"
    return Problem(
        places.told(ends[number]),
        f"an outline that ends there, {told}",
        "closed outlines",
        "close it in CAD, raise --gap, or leave its layer out with --ignore-layer",
    )


def _divided(figures: Sequence[_Figure], places: _Places) -> list[Problem]:
    """Return a problem where the lines of a figure enclose several areas, or link two.

    They may be bend lines, holes that touch an edge, or outlines that cross: nobody can tell.
    """
    problems = []
    for figure in figures:
        if figure.links:
            place = figure.links[0].interpolate(0.5, normalized=True)
            found = "a line that links others, and is no edge of an area"
        elif len(figure.areas) > 1:
            place = _edge_between(figure.areas).representative_point()
            found = f"lines that meet and enclose {len(figure.areas)} areas"
        else:
            continue
        expected = "outlines that neither touch nor cross each other"
        hint = "leave out the layer of bend lines or engravings with --ignore-layer"
        problems.append(Problem(places.told(np.array(place.coords[0])), found, expected, hint))
    return problems


def _edge_between(areas: Sequence[Polygon]) -> shapely.Geometry:
    """Return where the largest of several areas touches others, or the next one."""
    others = shapely.union_all([area.boundary for area in areas[1:]])
    edge = areas[0].boundary.intersection(others)
    return areas[1].boundary if edge.is_empty else edge


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
        size = float(f"{part.area:.5g}")  # that of equal parts is equal
        return -size, -x_low - x_high, -y_low - y_high

    return sorted(parts, key=key)
