"""The polygon that stands for a part in the deviation criterion (sections 3.2, 4.2.3.3 and 5.1)."""

from __future__ import annotations

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import Polygon

from grasp_xl.fitment.part import CadPart
from grasp_xl.fitment.words import AUTO, RECTANGLE
from grasp_xl.polygon import contains, is_star_shaped
from grasp_xl.space import FloatArray, frozen

SIMPLER = 0.02
"""How far a polygon may stray from the outline it stands for, as a part of the outline's size."""


def approximation_polygon(part: CadPart, choice: str) -> FloatArray:
    """Return the corners of the polygon that stands for a part, ``(n, 3)`` (mm), at z = 0.

    Parameters
    ----------
    part : CadPart
    choice : {"auto", "hull", "rectangle"}
        ``rectangle`` is the bounding box; ``hull`` the convex hull with its small steps left out;
        ``auto`` the outline with its small steps left out if that is star-shaped about the
        centroid, as section 3.2 wants it, else the hull.
    """
    if choice == RECTANGLE:
        return _corners(shapely.box(*part.plan.bounds))
    if choice == AUTO:
        outline = _simpler(outer_outline(part))
        corners = _corners(outline)
        if outline.is_valid and _suits(corners, part.centroid_mm):
            return corners
    return _corners(_simpler(part.plan.convex_hull))


def outer_outline(part: CadPart) -> Polygon:
    """Return the largest outline of a part, without its holes."""
    pieces = [Polygon(piece.exterior) for piece in shapely.get_parts(part.plan)]
    return max(pieces, key=lambda piece: piece.area)


def in_sight(part: CadPart, places_mm: FloatArray) -> NDArray[np.bool_]:
    """Tell to which places the straight way from the centroid stays inside the outline.

    Stricter than a star-shaped polygon: each place is asked, and the true outline.

    Parameters
    ----------
    part : CadPart
    places_mm : FloatArray
        ``(n, 2)`` or ``(n, 3)`` array.
    """
    outline = outer_outline(part)
    shapely.prepare(outline)
    centre = np.broadcast_to(part.centroid_mm[:2], (len(places_mm), 2))
    ways = shapely.linestrings(np.stack([centre, places_mm[:, :2]], axis=1))
    return shapely.covers(outline, ways)  # type: ignore[no-any-return]


def _suits(corners: FloatArray, centroid_mm: FloatArray) -> bool:
    return contains(corners, centroid_mm) and is_star_shaped(corners, centroid_mm)


def _simpler(outline: Polygon) -> Polygon:
    x_low, y_low, x_high, y_high = outline.bounds
    return outline.simplify(SIMPLER * max(x_high - x_low, y_high - y_low))


def _corners(polygon: Polygon) -> FloatArray:
    """Return the corners, clockwise from the one at the greatest x and then y, at z = 0."""
    corners = shapely.get_coordinates(shapely.normalize(polygon).exterior)[:-1]
    first = max(range(len(corners)), key=lambda number: tuple(corners[number]))
    turned = np.roll(corners, -first, axis=0)
    return frozen(np.column_stack([turned, np.zeros(len(turned))]))
