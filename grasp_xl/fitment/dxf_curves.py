"""The curves of a DXF drawing as chains of chords in plan view, which stray by a sag at most.

The library's own paths draw arcs as cubic splines, which stray by 0.03 % of the radius: more than
the sag on arcs of a metre.  So arcs and ellipses are drawn here, from their circles, each chord
with the point where the tangents at its ends meet.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, TypeVar, cast

import numpy as np

from grasp_xl.space import FloatArray

if TYPE_CHECKING:
    from ezdxf.entities.arc import Arc
    from ezdxf.entities.circle import Circle
    from ezdxf.entities.dxfentity import DXFEntity
    from ezdxf.entities.ellipse import Ellipse
    from ezdxf.entities.line import Line
    from ezdxf.entities.lwpolyline import LWPolyline
    from ezdxf.entities.polyline import Polyline
    from ezdxf.entities.spline import Spline
    from ezdxf.math import OCS, Vec3

T = TypeVar("T")

CURVES = {"LINE", "ARC", "CIRCLE", "ELLIPSE", "LWPOLYLINE", "POLYLINE", "SPLINE", "HELIX"}

MAX_TURN = math.pi / 4
"""Of one chord: a hole smaller than the sag is an octagon."""

MAX_CHORDS = 100_000
"""Of one arc: enough for a radius of 100 km."""

CONTROL_POINT = 16
"""Flag of a polyline's corner that only shapes it, and is not drawn."""


SPLINE_SAG = 0.2
"""Of splines, whose tangents the library does not give, as a part of that of arcs."""


@dataclass(frozen=True, eq=False, slots=True)
class Chords:
    """A chain of chords.

    Parameters
    ----------
    points : FloatArray
        ``(n + 1, 2)`` array in the drawing's unit; the last point is the first where it is closed.
    apexes : FloatArray
        ``(n, 2)`` array: where the tangents at both ends of a chord meet; NaN where it is straight.
    """

    points: FloatArray
    apexes: FloatArray

    def scaled(self, factor: float) -> Chords:
        """Return the chain in another unit."""
        return Chords(self.points * factor, self.apexes * factor)


def is_curve(entity: DXFEntity) -> bool:
    """Say whether an entity can be a piece of an outline."""
    if entity.dxftype() == "POLYLINE":
        polyline = cast("Polyline", entity)
        return polyline.is_2d_polyline or polyline.is_3d_polyline
    return entity.dxftype() in CURVES


def chords_of(entity: DXFEntity, sag: float) -> Chords:
    """Return what a curve draws, in plan view.

    Parameters
    ----------
    entity : DXFEntity
    sag : float
        In the drawing's unit.
    """
    kind = entity.dxftype()
    if kind == "LINE":
        line = cast("Line", entity)
        return _straight(_plan((line.dxf.start, line.dxf.end)))
    if kind in ("CIRCLE", "ARC"):
        return _of_circle(cast("Circle", entity), sag)
    if kind == "ELLIPSE":
        return _of_ellipse(cast("Ellipse", entity), sag)
    if kind == "LWPOLYLINE":
        flat = cast("LWPolyline", entity)
        chords = _of_corners(_round(flat.get_points("xyb"), flat.closed), sag)
        return _from_ocs(chords, flat.ocs(), flat.dxf.elevation)
    if kind == "POLYLINE":
        return _of_polyline(cast("Polyline", entity), sag)
    return _straight(_plan(cast("Spline", entity).flattening(sag * SPLINE_SAG)))


def _of_circle(entity: Circle, sag: float) -> Chords:
    start, end = 0.0, math.tau
    if entity.dxftype() == "ARC":
        arc = cast("Arc", entity)
        start = math.radians(arc.dxf.start_angle)
        end = start + (math.radians(arc.dxf.end_angle) - start) % math.tau
        end += math.tau if end == start else 0.0
    centre = entity.dxf.center
    chords = _arc((centre.x, centre.y), abs(entity.dxf.radius), start, end, sag)
    if entity.dxftype() == "CIRCLE":
        chords.points[-1] = chords.points[0]
    return _from_ocs(chords, entity.ocs(), centre.z)


def _of_ellipse(entity: Ellipse, sag: float) -> Chords:
    """Return an ellipse as the image of a circle, with as many chords as its larger one has."""
    start, end = entity.dxf.start_param, entity.dxf.end_param
    end = start + ((end - start) % math.tau or math.tau)
    shape = entity.construction_tool()
    centre, major, minor = _plan((shape.center, shape.major_axis, shape.minor_axis))
    size = float(max(shape.major_axis.magnitude, shape.minor_axis.magnitude))
    unit = _arc((0.0, 0.0), 1.0, start, end, sag / size)
    axes = np.array([major, minor])
    points, apexes = centre + unit.points @ axes, centre + unit.apexes @ axes
    if math.isclose(end - start, math.tau):
        points[-1] = points[0]
    return Chords(points, apexes)


def _of_polyline(entity: Polyline, sag: float) -> Chords:
    drawn = [one for one in entity.vertices if not one.dxf.flags & CONTROL_POINT]
    places = [one.dxf.location for one in drawn]
    if entity.is_3d_polyline:
        return _straight(_plan(_round(places, entity.is_closed)))
    bulges = [one.dxf.get("bulge", 0.0) for one in drawn]
    corners = [(place.x, place.y, bulge) for place, bulge in zip(places, bulges, strict=True)]
    height = places[0].z if places else 0.0
    return _from_ocs(_of_corners(_round(corners, entity.is_closed), sag), entity.ocs(), height)


def _round(corners: Iterable[T], is_closed: object) -> list[T]:
    """Return the corners, and the first once more where a polyline is closed."""
    found = list(corners)
    return [*found, *found[:1]] if is_closed else found


def _of_corners(corners: Sequence[Sequence[float]], sag: float) -> Chords:
    """Return the chords of a polyline whose corners are ``x, y, bulge``: an arc to the next one."""
    if not any(bulge for _, _, bulge in corners):
        return _straight(np.array([corner[:2] for corner in corners]).reshape(-1, 2))
    pieces = [
        _bulged(np.array(start[:2]), np.array(end[:2]), start[2], sag)
        for start, end in pairwise(corners)
    ]
    points = [np.array([corners[0][:2]]), *(piece.points[1:] for piece in pieces)]
    return Chords(np.concatenate(points), np.concatenate([piece.apexes for piece in pieces]))


def _bulged(start: FloatArray, end: FloatArray, bulge: float, sag: float) -> Chords:
    """Return an arc: the bulge is the tangent of a quarter of its turn, positive to the left."""
    chord = end - start
    if not bulge or not chord.any():
        return _straight(np.array([start, end]))
    turn = 4 * math.atan(bulge)
    towards = np.array([-chord[1], chord[0]]) * (1 - bulge**2) / (4 * bulge)
    centre = (start + end) / 2 + towards
    first = math.atan2(*(start - centre)[::-1])
    chords = _arc(centre, float(np.linalg.norm(start - centre)), first, first + turn, sag)
    chords.points[[0, -1]] = start, end
    return chords


def _arc(centre: Iterable[float], radius: float, start: float, end: float, sag: float) -> Chords:
    if not math.isfinite(radius):
        raise ValueError(radius)
    turn = min(MAX_TURN, 2 * math.acos(max(0.0, 1 - sag / radius))) if radius else MAX_TURN
    count = MAX_CHORDS
    if turn * MAX_CHORDS > abs(end - start):
        count = max(1, math.ceil(abs(end - start) / turn))
    if math.isclose(abs(end - start), math.tau):
        count += -count % 4  # a circle reaches as far as it does at its four sides
    angles = np.linspace(start, end, count + 1)
    middle = np.array(tuple(centre))
    between = (angles[1:] + angles[:-1]) / 2
    reach = radius / math.cos((end - start) / count / 2)
    return Chords(middle + radius * _around(angles), middle + reach * _around(between))


def _around(angles: FloatArray) -> FloatArray:
    return np.stack([np.cos(angles), np.sin(angles)], axis=1)


def _straight(points: FloatArray) -> Chords:
    return Chords(points, np.full((max(0, len(points) - 1), 2), np.nan))


def _plan(places: Iterable[Vec3]) -> FloatArray:
    return np.array([(place.x, place.y) for place in places], dtype=float).reshape(-1, 2)


def _from_ocs(chords: Chords, ocs: OCS, height: float) -> Chords:
    """Return plan view of chords in an object's own coordinate system, which may be mirrored."""
    if not ocs.transform:
        return chords
    axes = np.array([(axis.x, axis.y) for axis in (ocs.ux, ocs.uy, ocs.uz)])
    points, apexes = (each @ axes[:2] + height * axes[2] for each in (chords.points, chords.apexes))
    return Chords(points, apexes)
