"""Simple solids that stand for elements, frame and flat parts, as plain numbers (mm)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

from shapely import MultiPolygon, Polygon

from grasp_xl.space import FloatArray


@dataclass(frozen=True, eq=False, slots=True)
class Turned:
    """A profile turned about an upright axis.

    Parameters
    ----------
    profile_mm : FloatArray
        ``(n, 2)`` corners r, z of a closed polygon that begins and ends on the axis.
    """

    profile_mm: FloatArray


@dataclass(frozen=True, slots=True)
class Block:
    """An upright block about an axis.

    Parameters
    ----------
    length_mm, width_mm : float
    angle_deg : float
        Of its length to the x-axis.
    low_mm, high_mm : float
    """

    length_mm: float
    width_mm: float
    angle_deg: float
    low_mm: float
    high_mm: float


@dataclass(frozen=True, slots=True)
class Plate:
    """An area between two heights; of one height, a surface."""

    area: Polygon | MultiPolygon
    low_mm: float
    high_mm: float


@dataclass(frozen=True, eq=False, slots=True)
class Bar:
    """A round bar from one point to another, ``(3,)`` each."""

    start_mm: FloatArray
    end_mm: FloatArray
    radius_mm: float


Solid: TypeAlias = Turned | Block | Plate | Bar
