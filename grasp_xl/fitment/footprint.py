"""What an element covers of a face, and at which places of a grid it can stand (section 4.1)."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import LineString, Point, Polygon, affinity, box
from shapely.geometry.base import BaseGeometry

from grasp_xl.fitment.element import Element
from grasp_xl.space import FloatArray, frozen

TOLERANCE_MM = 1e-6
"""Distances to an edge are compared with this slack: turned or shifted, a face keeps its places."""

QUARTER_SEGMENTS = 16
"""Chords of a quarter circle, where the covered area of a round element is measured."""

FEW_PLACES = 64
"""Places whose footprints are cut with a face one by one."""


@dataclass(frozen=True, eq=False, slots=True)
class Footprint:
    """What an element covers.

    Parameters
    ----------
    outline : Polygon
        About the element's middle (mm); a circle as a polygon.
    radius_mm : float
        From the middle to the farthest point.
    is_round : bool
    """

    outline: Polygon
    radius_mm: float
    is_round: bool

    @property
    def diameter_mm(self) -> float:
        """Two elements whose middles are so far apart never touch, however they are turned."""
        return 2 * self.radius_mm

    def at(self, places_mm: FloatArray) -> NDArray[np.object_]:
        """Return the outlines at places, ``(n,)`` polygons for ``(n, 2)`` places (mm)."""
        corners = shapely.get_coordinates(self.outline)
        return shapely.polygons(places_mm[:, None, :] + corners[None, :, :])  # type: ignore[no-any-return]


def footprint_of(element: Element, angle_deg: float = 0.0) -> Footprint:
    """Return what an element covers; its length lies at an angle to the x-axis.

    Examples
    --------
    >>> from grasp_xl.fitment.element import Element
    >>> footprint_of(Element("M", "magnets", 255.0, length_mm=40.0, width_mm=30.0)).radius_mm
    25.0
    """
    if element.sides_mm is None:
        radius = (element.diameter_mm or 0.0) / 2
        return Footprint(Point(0, 0).buffer(radius, QUARTER_SEGMENTS), radius, is_round=True)
    length, width = element.sides_mm
    if element.shape == "oval":
        half = abs(length - width) / 2
        ends = [(-half, 0), (half, 0)] if length >= width else [(0, -half), (0, half)]
        outline = LineString(ends).buffer(min(length, width) / 2, QUARTER_SEGMENTS)
        radius = max(length, width) / 2
    else:
        outline = box(-length / 2, -width / 2, length / 2, width / 2)
        radius = math.hypot(length, width) / 2
    return Footprint(affinity.rotate(outline, angle_deg, (0, 0)), radius, is_round=False)


def lies_inside(face: Polygon, places_mm: FloatArray, footprint: Footprint) -> NDArray[np.bool_]:
    """Tell at which places all of a footprint lies inside a face, ``(n,)`` for ``(n, 2)`` (mm).

    That of a suction cup must, or it would leak.
    """
    if footprint.is_round:
        return _is_inner(face, places_mm, footprint.radius_mm - TOLERANCE_MM)
    inner = _is_inner(face, places_mm, TOLERANCE_MM)
    shrunk = footprint.outline.buffer(-TOLERANCE_MM, join_style="mitre")
    smaller = Footprint(shrunk, footprint.radius_mm, is_round=False)
    shapely.prepare(face)
    inner[inner] = shapely.covers(face, smaller.at(places_mm[inner]))
    return inner


def middle_lies_inside(face: Polygon, places_mm: FloatArray) -> NDArray[np.bool_]:
    """Tell which places lie inside a face and not on its edge, ``(n,)`` for ``(n, 2)`` (mm).

    That is enough for a magnet: it may hang over.
    """
    return _is_inner(face, places_mm, TOLERANCE_MM)


def covered(face: Polygon, places_mm: FloatArray, footprint: Footprint) -> FloatArray:
    """Return which part of a footprint lies on a face at each place, ``(n,)`` in [0, 1]."""
    fractions = np.ones(len(places_mm))
    edges = face.boundary
    shapely.prepare(edges)
    near = shapely.dwithin(edges, shapely.points(places_mm), footprint.radius_mm)
    fractions[near] = _covered_area(face, places_mm[near], footprint) / footprint.outline.area
    return frozen(np.clip(fractions, 0, 1))


def _covered_area(
    face: BaseGeometry, places_mm: FloatArray, footprint: Footprint
) -> NDArray[np.float64]:
    """Return the covered area at each place, ``(n,)`` (mm^2).

    Half of the places need only their part of the face, which may have very many edges.
    """
    if len(places_mm) <= FEW_PLACES:
        return shapely.area(shapely.intersection(footprint.at(places_mm), face))  # type: ignore[no-any-return]
    axis = int(np.argmax(np.ptp(places_mm, axis=0)))
    order = np.argsort(places_mm[:, axis], kind="stable")
    areas = np.empty(len(places_mm))
    for half in np.array_split(order, 2):
        places = places_mm[half]
        low, high = (
            places.min(axis=0) - footprint.radius_mm,
            places.max(axis=0) + footprint.radius_mm,
        )
        areas[half] = _covered_area(face.intersection(box(*low, *high)), places, footprint)
    return areas


def largest_disc_mm(face: Polygon, places_mm: FloatArray) -> float:
    """Return the diameter of the largest disc about any of the places that a face holds (mm)."""
    points = shapely.points(places_mm[_is_inner(face, places_mm, TOLERANCE_MM)])
    return 2 * float(np.max(shapely.distance(face.boundary, points), initial=0))


def _is_inner(face: Polygon, places_mm: FloatArray, distance_mm: float) -> NDArray[np.bool_]:
    """Tell which places lie inside a face, and farther from its edges than a distance."""
    points, edges = shapely.points(places_mm), face.boundary
    shapely.prepare(face)
    shapely.prepare(edges)
    inside = shapely.contains_properly(face, points)
    inside[inside] = ~shapely.dwithin(edges, points[inside], distance_mm)
    return inside  # type: ignore[no-any-return]
