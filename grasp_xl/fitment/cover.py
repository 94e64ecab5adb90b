"""What of a part lies above a height, in plan view, and the part as a whole."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import shapely
from shapely import MultiPolygon, Polygon

from grasp_xl.fitment.seams import joined
from grasp_xl.space import FloatArray

ABOVE_MM = 1e-3
"""How far above a face material begins to cover it: walls at its edges do not."""

UPRIGHT = 1e-3
"""z of the unit normal of a triangle that stands upright, round-off included."""


def cover_above(mesh: FloatArray, height_mm: float, approach_mm: float) -> Polygon | MultiPolygon:
    """Return what lies above a height and not higher than an approach above it, in plan view.

    Above each such point is a surface of the part that looks down, so only those are asked.

    Parameters
    ----------
    mesh : FloatArray
        ``(n, 3, 3)`` triangles, counter-clockwise from outside (mm).
    height_mm, approach_mm : float
    """
    low, high = height_mm + ABOVE_MM, height_mm + approach_mm
    z = mesh[:, :, 2]
    down = mesh[(_slope(mesh) < -UPRIGHT) & (z.max(axis=1) > low) & (z.min(axis=1) < high)]
    whole = (down[:, :, 2].min(axis=1) >= low) & (down[:, :, 2].max(axis=1) <= high)
    cut = [Polygon(corners) for corners in _slices(down[~whole], low, high)]
    return joined([*shapely.polygons(down[whole][:, :, :2]), *cut])


def plan_of(mesh: FloatArray) -> Polygon | MultiPolygon:
    """Return a part in plan view: all that surfaces looking up cover."""
    up = mesh[_slope(mesh) > UPRIGHT]
    return joined(shapely.polygons(up[:, :, :2]))


def _slope(mesh: FloatArray) -> FloatArray:
    """Return z of the unit normal of each triangle, ``(n,)``; 0 where it has no area."""
    normals = np.cross(mesh[:, 1] - mesh[:, 0], mesh[:, 2] - mesh[:, 0])
    lengths = np.linalg.norm(normals, axis=1)
    return normals[:, 2] / np.where(lengths > 0, lengths, 1)


def _slices(triangles: FloatArray, low: float, high: float) -> Iterator[list[tuple[float, float]]]:
    """Yield, in plan view, what of each triangle lies between two heights."""
    for triangle in triangles.tolist():
        corners = _clipped(_clipped(triangle, low, 1), high, -1)
        if len(corners) > 2:
            yield [(x, y) for x, y, _ in corners]


def _clipped(corners: list[list[float]], height: float, side: int) -> list[list[float]]:
    """Return what of a polygon lies above a height (side 1) or below it (side -1)."""
    kept: list[list[float]] = []
    for start, end in zip(corners, [*corners[1:], *corners[:1]], strict=True):
        above = side * (start[2] - height), side * (end[2] - height)
        if above[0] >= 0:
            kept.append(start)
        if above[0] * above[1] < 0:
            part = above[0] / (above[0] - above[1])
            kept.append([a + part * (b - a) for a, b in zip(start, end, strict=True)])
    return kept
