"""What lies between a curve and its chords: no element may stand there, and it counts as area.

A curve runs between a chord and the tangents at the chord's ends.  The triangle of the three is the
chord's cap.  A face bounded by chords has lost or won a part of each cap; without the caps it lies
inside the true face.
"""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import MultiPolygon, Polygon

from grasp_xl.fitment.gaps import GRID_MM
from grasp_xl.space import FloatArray, frozen

Caps: TypeAlias = NDArray[np.object_]
"""``(n,)`` triangles; the first side of each is the chord."""

SAG_MM = 0.005
"""How far chords may stray from their curve: about so much of a place is lost at a curved edge."""

ON_EDGE_MM = 1e-3
"""How far the middle of a chord may lie from the edge that it is a piece of."""

LENS = 2 / 3
"""Part of a cap that lies between chord and curve: a parabola's, and nearly that of a short arc."""

NO_CAPS: Caps = np.empty(0, dtype=object)


def caps_of(points_mm: FloatArray, apexes_mm: FloatArray) -> Caps:
    """Return the caps of a chain of chords.

    Parameters
    ----------
    points_mm : FloatArray
        ``(n + 1, 2)`` ends of the chords.
    apexes_mm : FloatArray
        ``(n, 2)``: where the tangents at both ends of a chord meet; NaN where it is no curve.
    """
    corners = np.stack([points_mm[:-1], points_mm[1:], apexes_mm], axis=1)
    return shapely.polygons(corners[~np.isnan(apexes_mm).any(axis=1)])  # type: ignore[no-any-return]


def along(area: Polygon | MultiPolygon, caps: Caps) -> Caps:
    """Return the caps whose chord is a piece of an area's edge."""
    if not len(caps):
        return NO_CAPS
    corners = shapely.get_coordinates(caps).reshape(-1, 4, 2)
    middles = shapely.points(corners[:, :2].mean(axis=1))
    edges = area.boundary
    shapely.prepare(edges)
    return caps[shapely.dwithin(edges, middles, ON_EDGE_MM)]  # type: ignore[no-any-return]


def trimmed(area: Polygon | MultiPolygon, caps: Caps) -> Polygon | MultiPolygon:
    """Return an area without the caps along its edge: all of it belongs to the true area."""
    own = along(area, caps)
    if not len(own):
        return area
    whole = shapely.union_all(own, grid_size=GRID_MM)
    left = shapely.difference(area, whole, grid_size=GRID_MM)
    return left.simplify(GRID_MM)  # where a chord ends, two of its caps' sides are in line


def true_area(area: Polygon | MultiPolygon, caps: Caps) -> tuple[float, FloatArray]:
    """Return the area (mm^2) that the curves bound, and its centroid, ``(2,)`` (mm)."""
    own = shapely.union_all(along(area, caps))
    pieces = [(1.0, area), (LENS, own.difference(area)), (-LENS, own.intersection(area))]
    sizes = np.array([factor * piece.area for factor, piece in pieces])
    middles = np.array(
        [shapely.get_coordinates(piece.centroid)[0] for _, piece in pieces if piece.area]
    )
    whole = float(sizes.sum())
    return whole, frozen(sizes[sizes != 0] @ middles / whole)
