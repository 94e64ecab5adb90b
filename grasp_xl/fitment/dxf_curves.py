"""The curves of a DXF drawing as chains of chords in plan view, which stray by a sag at most.

The library's own paths draw arcs as cubic splines, which stray by 0.03 % of the radius: more than
the sag on arcs of a metre. So arcs are drawn here, from their circles.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
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


def is_curve(entity: DXFEntity) -> bool:
    """Say whether an entity can be a piece of an outline."""
    if entity.dxftype() == "POLYLINE":
        polyline = cast("Polyline", entity)
        return polyline.is_2d_polyline or polyline.is_3d_polyline
    return entity.dxftype() in CURVES


def chords_of(entity: DXFEntity, sag: float) -> FloatArray:
    """Return what a curve draws, in plan view.

    Parameters
    ----------
    entity : DXFEntity
    sag : float
        In the drawing's unit.

    Returns
    -------
    FloatArray
        ``(n, 2)`` array in the drawing's unit; the last point is the first where it is closed.
    """
    kind = entity.dxftype()
    if kind == "LINE":
        line = cast("Line", entity)
        return _plan((line.dxf.start, line.dxf.end))
    if kind in ("CIRCLE", "ARC"):
        return _of_circle(cast("Circle", entity), sag)
    if kind == "LWPOLYLINE":
        flat = cast("LWPolyline", entity)
        points = _of_corners(_round(flat.get_points("xyb"), flat.closed), sag)
        return _from_ocs(points, flat.ocs(), flat.dxf.elevation)
    if kind == "POLYLINE":
        return _of_polyline(cast("Polyline", entity), sag)
    return _plan(cast("Ellipse | Spline", entity).flattening(sag))


def _of_circle(entity: Circle, sag: float) -> FloatArray:
    start, end = 0.0, math.tau
    if entity.dxftype() == "ARC":
        arc = cast("Arc", entity)
        start = math.radians(arc.dxf.start_angle)
        end = start + (math.radians(arc.dxf.end_angle) - start) % math.tau
        end += math.tau if end == start else 0.0
    centre = entity.dxf.center
    points = _arc((centre.x, centre.y), abs(entity.dxf.radius), start, end, sag)
    if entity.dxftype() == "CIRCLE":
        points[-1] = points[0]
    return _from_ocs(points, entity.ocs(), centre.z)


def _of_polyline(entity: Polyline, sag: float) -> FloatArray:
    drawn = [one for one in entity.vertices if not one.dxf.flags & CONTROL_POINT]
    places = [one.dxf.location for one in drawn]
    if entity.is_3d_polyline:
        return _plan(_round(places, entity.is_closed))
    bulges = [one.dxf.get("bulge", 0.0) for one in drawn]
    corners = [(place.x, place.y, bulge) for place, bulge in zip(places, bulges, strict=True)]
    height = places[0].z if places else 0.0
    return _from_ocs(_of_corners(_round(corners, entity.is_closed), sag), entity.ocs(), height)


def _round(corners: Iterable[T], is_closed: object) -> list[T]:
    """Return the corners, and the first once more where a polyline is closed."""
    found = list(corners)
    return [*found, *found[:1]] if is_closed else found


def _of_corners(corners: Sequence[Sequence[float]], sag: float) -> FloatArray:
    """Return the chords of a polyline whose corners are ``x, y, bulge``: an arc to the next one."""
    if not any(bulge for _, _, bulge in corners):
        return np.array([corner[:2] for corner in corners]).reshape(-1, 2)
    pieces = [np.array([corners[0][:2]])]
    for start, end in pairwise(corners):
        pieces.append(_bulged(np.array(start[:2]), np.array(end[:2]), start[2], sag)[1:])
    return np.concatenate(pieces)


def _bulged(start: FloatArray, end: FloatArray, bulge: float, sag: float) -> FloatArray:
    """Return an arc: the bulge is the tangent of a quarter of its turn, positive to the left."""
    chord = end - start
    if not bulge or not chord.any():
        return np.array([start, end])
    turn = 4 * math.atan(bulge)
    towards = np.array([-chord[1], chord[0]]) * (1 - bulge**2) / (4 * bulge)
    centre = (start + end) / 2 + towards
    first = math.atan2(*(start - centre)[::-1])
    points = _arc(centre, float(np.linalg.norm(start - centre)), first, first + turn, sag)
    points[[0, -1]] = start, end
    return points


def _arc(
    centre: Iterable[float], radius: float, start: float, end: float, sag: float
) -> FloatArray:
    if not math.isfinite(radius):
        raise ValueError(radius)
    turn = min(MAX_TURN, 2 * math.acos(max(0.0, 1 - sag / radius))) if radius else MAX_TURN
    count = MAX_CHORDS
    if turn * MAX_CHORDS > abs(end - start):
        count = max(1, math.ceil(abs(end - start) / turn))
    if math.isclose(abs(end - start), math.tau):
        count += -count % 4  # a circle reaches as far as it does at its four sides
    angles = np.linspace(start, end, count + 1)
    around = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    points: FloatArray = np.array(tuple(centre)) + radius * around
    return points


def _plan(places: Iterable[Vec3]) -> FloatArray:
    return np.array([(place.x, place.y) for place in places], dtype=float).reshape(-1, 2)


def _from_ocs(points: FloatArray, ocs: OCS, height: float) -> FloatArray:
    """Return plan view of points in an object's own coordinate system, which may be mirrored."""
    if not ocs.transform:
        return points
    axes = np.array([(axis.x, axis.y) for axis in (ocs.ux, ocs.uy, ocs.uz)])
    placed: FloatArray = points @ axes[:2] + height * axes[2]
    return placed
