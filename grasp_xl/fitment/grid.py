"""The grid of places over a face: from edge to edge of its bounding box (sections 4.1 and 5.1)."""

from __future__ import annotations

import math

import numpy as np
from shapely import Polygon

from grasp_xl.space import FloatArray, frozen

DECIMALS = 9
"""Coordinates are rounded to so many decimals of a mm, so that every machine writes the same."""

ROUND_OFF = 1e-9
"""Part of a pitch by which a side may be too short for its last point."""


def points_along(length_mm: float, pitch_mm: float) -> int:
    """Return how many grid points a side has: at least one.

    Examples
    --------
    >>> points_along(360, 10), points_along(15, 10), points_along(0.1 * 3, 0.1)
    (36, 1, 3)
    """
    return max(1, math.floor(length_mm / pitch_mm + ROUND_OFF))


def grid_line(low_mm: float, high_mm: float, pitch_mm: float) -> FloatArray:
    """Return grid coordinates (mm) from edge to edge of a face, descending.

    A side of length L has floor(L / pitch) points; one, in the middle, where that is less than 2.

    Examples
    --------
    >>> grid_line(-180, 180, 10)[:2]
    array([180.        , 169.71428571])
    >>> grid_line(0, 15, 10)
    array([7.5])
    """
    middle, half = (low_mm + high_mm) / 2, (high_mm - low_mm) / 2
    count = points_along(high_mm - low_mm, pitch_mm)
    if count < 2:
        return frozen([middle])
    steps = (count - 1 - 2 * np.arange(count)) / (count - 1)  # odd about 0: a mirrored face's
    return frozen(middle + half * steps)  # grid is the mirror image, to the last bit


def grid_size(outline: Polygon, pitch_mm: float) -> int:
    """Return how many points the grid over a face has."""
    x_low, y_low, x_high, y_high = outline.bounds
    return points_along(x_high - x_low, pitch_mm) * points_along(y_high - y_low, pitch_mm)


def grid(outline: Polygon, pitch_mm: float) -> FloatArray:
    """Return the grid over a face, ``(n, 2)`` (mm), by descending x, then descending y.

    Parameters
    ----------
    outline : Polygon
        Of the face (mm).
    pitch_mm : float
        Wanted distance of neighbours; the true one is a little larger, as ends fall on edges.
    """
    x_low, y_low, x_high, y_high = np.round(outline.bounds, DECIMALS)
    xs, ys = grid_line(x_low, x_high, pitch_mm), grid_line(y_low, y_high, pitch_mm)
    return frozen(np.column_stack([np.repeat(xs, len(ys)), np.tile(ys, len(xs))]))
