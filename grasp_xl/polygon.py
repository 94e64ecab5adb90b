"""Exact questions about a polygon and a point: float coordinates, rational arithmetic."""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise

from grasp_xl.space import FloatArray

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


def contains(polygon: FloatArray, centre: FloatArray) -> bool:
    """Tell whether a point lies inside or on a simple polygon, exactly."""
    vertices = _exact(polygon)
    (point,) = _exact(centre[None, :])
    inside = False
    for a, b in pairwise([*vertices, vertices[0]]):
        turn = _turn(a, b, point)
        in_box = min(a[0], b[0]) <= point[0] <= max(a[0], b[0]) and (
            min(a[1], b[1]) <= point[1] <= max(a[1], b[1])
        )
        if turn == 0 and in_box:
            return True
        if (a[1] > point[1]) != (b[1] > point[1]) and (turn > 0) == (b[1] > a[1]):
            inside = not inside
    return inside
