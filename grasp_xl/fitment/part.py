"""A part as CAD gives it: how much of it there is, and the faces on which elements can stand.

Whatever the file says, the grasp plane is X-Y, grippers come down from +z, and lengths are in mm.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

import shapely
from shapely import MultiPolygon, Polygon

from grasp_xl.errors import Problem
from grasp_xl.space import FloatArray, frozen

HEIGHT_DECIMALS = 6
"""Faces whose heights agree to so many decimals of a millimetre are level with each other."""


LEAST_AREA_MM2 = 1.0
"""Pieces of a face that are smaller are no faces, and covers that are smaller cover nothing."""


@dataclass(frozen=True, eq=False, slots=True)
class Face:
    """A flat, level face that looks up; faces that touch at the same height are one.

    Parameters
    ----------
    outline : Polygon
        In plan view, with its holes (mm).
    height_mm : float
    """

    outline: Polygon
    height_mm: float


@dataclass(frozen=True, eq=False, slots=True)
class CadPart:
    """One solid part, or one flat part with its thickness.

    Parameters
    ----------
    name : str
        Of its file.
    sha256 : str
        Of its file.
    volume_mm3 : float
    centroid_mm : FloatArray
        ``(3,)`` centroid of the solid.
    faces : tuple of Face
        Those that can be reached, in the order of :func:`in_order`: the first has number 1.
    plan : Polygon or MultiPolygon
        All of the part in plan view, with what one can see through.
    notes : tuple of Problem
        What was left out or changed, and why.
    """

    name: str
    sha256: str
    volume_mm3: float
    centroid_mm: FloatArray
    faces: tuple[Face, ...]
    plan: Polygon | MultiPolygon
    notes: tuple[Problem, ...] = field(default=())


def in_order(faces: Iterable[Face]) -> tuple[Face, ...]:
    """Sort faces by descending height, then descending x, then descending y of their middle."""

    def key(face: Face) -> tuple[float, float, float]:
        x_low, y_low, x_high, y_high = face.outline.bounds
        middle = (round(x_low + x_high, HEIGHT_DECIMALS), round(y_low + y_high, HEIGHT_DECIMALS))
        return -round(face.height_mm, HEIGHT_DECIMALS), -middle[0], -middle[1]

    return tuple(sorted(faces, key=key))


def pieces(area: Polygon | MultiPolygon) -> list[Polygon]:
    """Return the polygons of an area that are worth the name."""
    parts = shapely.get_parts(area)
    return [part for part in parts if isinstance(part, Polygon) and part.area >= LEAST_AREA_MM2]


def rings_of(area: Polygon | MultiPolygon) -> tuple[FloatArray, ...]:
    """Return the corners of all outlines and holes, ``(n, 2)`` (mm) each."""
    return tuple(
        frozen(shapely.get_coordinates(ring)[:-1])
        for piece in shapely.get_parts(area)
        for ring in (piece.exterior, *piece.interiors)
    )
