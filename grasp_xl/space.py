"""The option space: a part, the kinds of gripper element, and the places where each can stand.

Units: g, mm, N, $.  Arrays are read-only; nothing here knows a file format.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

GRAVITY_M_S2 = 9.81
"""Gravity of the thesis's cards: 13796.195 g weigh 135.3407 N."""

MAX_COUNT = 25
"""Largest Max. of a kind; the helper cells of a live card grow with its square."""

MAX_FOOTPRINTS = 200_000
"""Most footprints of one kind."""

MIN_GENE_SLOTS = 5
"""The thesis's chromosome has five index genes a kind (eq. 1); a larger Max. widens it."""


def frozen(array: object) -> FloatArray:
    """Return a read-only float copy of ``array``."""
    copy = np.array(array, dtype=np.float64)
    copy.setflags(write=False)
    return copy


@dataclass(frozen=True, eq=False, slots=True)
class Part:
    """The sheet-metal part: mass (g) and centroid, ``(3,)`` (mm)."""

    mass_g: float
    centroid_mm: FloatArray

    @property
    def weight_n(self) -> float:
        """Weight W of the part (N)."""
        return self.mass_g / 1000.0 * GRAVITY_M_S2


@dataclass(frozen=True, eq=False, slots=True)
class ElementKind:
    """One kind of gripper element and every place where it can stand.

    Parameters
    ----------
    name : str
        ``suction`` or ``magnets`` in the thesis's workbook; the core does not care.
    force_n, price : float
        Normal force capacity (N) and unit price ($) of one element.
    count_min, count_max : int
        How many a grasp may have, as the designer typed it (Max. may exceed the places there are).
    footprints_mm : FloatArray
        ``(n, 3)`` array of footprint centres (mm); row i has index i + 1.
    weight_g, diameter_mm : float or None
        Weight and outer diameter of one element, where known.
    model : str
        Model name, where known.
    overlap : FloatArray or None
        ``(n,)`` covered area fraction of each footprint, where known; nothing is computed from it.
    """

    name: str
    force_n: float
    price: float
    count_min: int
    count_max: int
    footprints_mm: FloatArray
    weight_g: float | None = None
    diameter_mm: float | None = None
    model: str = ""
    overlap: FloatArray | None = None

    @property
    def total(self) -> int:
        """Number of footprints."""
        return len(self.footprints_mm)

    @property
    def most(self) -> int:
        """Most elements of this kind that a grasp can have: min(Max., total)."""
        return min(self.count_max, self.total)


@dataclass(frozen=True, eq=False)
class OptionSpace:
    """All that CAD exports: part, element kinds with their footprints, ideal deflection polygon.

    Parameters
    ----------
    part : Part
    kinds : tuple of ElementKind
    approximation_polygon_mm : FloatArray
        ``(n, 3)`` array of the vertices, in order, of the polygon that stands for the part (mm).
        Where only the ideal polygon is known, :func:`unscaled_polygon` gives this one.
    scale_factor : float
        Factor s in (0, 1] from this polygon to the ideal one.
    """

    part: Part
    kinds: tuple[ElementKind, ...]
    approximation_polygon_mm: FloatArray
    scale_factor: float

    @cached_property
    def ideal_polygon_mm(self) -> FloatArray:
        """The ideal deflection polygon, ``(n, 3)`` (mm), section 4.2.3.3."""
        return scaled_polygon(
            self.approximation_polygon_mm, self.part.centroid_mm, self.scale_factor
        )

    @property
    def gene_slots(self) -> int:
        """Index genes a kind: five (eq. 1), or the largest Max. where that is more."""
        return max(MIN_GENE_SLOTS, *(kind.count_max for kind in self.kinds))

    @property
    def largest_diameter_mm(self) -> float | None:
        """Largest known element diameter (mm), the clearance of section 4.2.4.2, else None."""
        known = [kind.diameter_mm for kind in self.kinds if kind.diameter_mm is not None]
        return max(known, default=None)


def scaled_polygon(polygon_mm: FloatArray, centroid_mm: FloatArray, scale: float) -> FloatArray:
    """Scale a polygon about the part's centroid in 3-D: p' = c + s (p - c), section 5.1.

    Examples
    --------
    >>> scaled_polygon(frozen([[180, 110, 0]]), frozen([0.032786, 0.006258, 45.06829]), 0.65)
    array([[117.0114751,  71.5021903,  15.7739015]])
    """
    return frozen(centroid_mm + scale * (polygon_mm - centroid_mm))


def unscaled_polygon(polygon_mm: FloatArray, centroid_mm: FloatArray, scale: float) -> FloatArray:
    """Undo :func:`scaled_polygon`: p = c + (p' - c) / s."""
    return frozen(centroid_mm + (polygon_mm - centroid_mm) / scale)
