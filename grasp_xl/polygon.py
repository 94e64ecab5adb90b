"""Exact questions about a polygon and a point: float coordinates, rational arithmetic."""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise
from typing import Literal

from grasp_xl.errors import Problem
from grasp_xl.space import FloatArray

Side = Literal["inside", "edge", "outside"]
ExactPoint = tuple[Fraction, Fraction]


def _exact(points: FloatArray) -> list[ExactPoint]:
    return [(Fraction(float(x)), Fraction(float(y))) for x, y in points[:, :2]]


def _turn(a: ExactPoint, b: ExactPoint, c: ExactPoint) -> Fraction:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def is_star_shaped(polygon: FloatArray, centre: FloatArray) -> bool:
    """Tell whether every point of a simple polygon is seen from ``centre`` (section 3.2).

    Exactly so when the centre lies on the inner side of, or on, the line of every edge.

    Parameters
    ----------
    polygon : FloatArray
        ``(n, 2)`` or ``(n, 3)`` array of vertices in order.
    centre : FloatArray
        ``(2,)`` or ``(3,)`` array.

    Examples
    --------
    >>> import numpy as np
    >>> square = np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]])
    >>> is_star_shaped(square, np.array([1.0, 1.0])), is_star_shaped(square, np.array([3.0, 1.0]))
    (True, False)
    """
    vertices = _exact(polygon)
    (point,) = _exact(centre[None, :])
    turns = [_turn(a, b, point) for a, b in pairwise([*vertices, vertices[0]])]
    return all(turn >= 0 for turn in turns) or all(turn <= 0 for turn in turns)


def side_of(polygon: FloatArray, point: FloatArray) -> Side:
    """Tell exactly whether a point lies inside a simple polygon, on its edge, or outside.

    Examples
    --------
    >>> import numpy as np
    >>> square = np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]])
    >>> [side_of(square, np.array([x, 1.0])) for x in (1.0, 2.0, 3.0)]
    ['inside', 'edge', 'outside']
    """
    vertices = _exact(polygon)
    (place,) = _exact(point[None, :])
    inside = False
    for a, b in pairwise([*vertices, vertices[0]]):
        turn = _turn(a, b, place)
        in_box = min(a[0], b[0]) <= place[0] <= max(a[0], b[0]) and (
            min(a[1], b[1]) <= place[1] <= max(a[1], b[1])
        )
        if turn == 0 and in_box:
            return "edge"
        if (a[1] > place[1]) != (b[1] > place[1]) and (turn > 0) == (b[1] > a[1]):
            inside = not inside
    return "inside" if inside else "outside"


def contains(polygon: FloatArray, point: FloatArray) -> bool:
    """Tell whether a point lies inside or on a simple polygon, exactly."""
    return side_of(polygon, point) != "outside"


def look_at_polygon(polygon: FloatArray, centroid_mm: FloatArray, where: str) -> list[Problem]:
    """Return what is wrong with a polygon for the deviation criterion (section 3.2)."""
    side = side_of(polygon, centroid_mm)
    if side != "inside":
        found = (
            f"the part's centroid {'on an edge of' if side == 'edge' else 'outside'} the polygon"
        )
        hint = "choose corners that surround the centroid"
        return [Problem(where, found, "it inside", hint)]
    if not is_star_shaped(polygon, centroid_mm):
        found = "a polygon that is not star-shaped about the part's centroid"
        hint = "the ideal polygon may leave the part; choose fewer corners, or the hull"
        return [Problem(where, found, "every edge in sight of the centroid", hint)]
    return []
