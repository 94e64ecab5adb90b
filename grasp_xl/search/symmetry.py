"""Mirror images and half turns that map an option space's footprints onto themselves.

Grasps that are images of one another are twins: the thesis's runs found many.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from grasp_xl.space import FloatArray, IntArray, OptionSpace

TOLERANCE_MM = 1e-6
"""Largest difference of a coordinate between a footprint's image and the footprint there."""

SIGNS = {
    "mirror in x": (-1.0, 1.0, 1.0),
    "mirror in y": (1.0, -1.0, 1.0),
    "half turn": (-1.0, -1.0, 1.0),
}
"""Factors of x, y and z about the middle of all footprints; heights stay."""


@dataclass(frozen=True, eq=False, slots=True)
class Symmetry:
    """A map of the footprints onto themselves.

    Parameters
    ----------
    name : str
        ``mirror in x``, ``mirror in y`` or ``half turn``.
    images : tuple of IntArray
        For each kind, ``(total,)`` array: the 0-based footprint that each footprint maps to.
    """

    name: str
    images: tuple[IntArray, ...]

    def of(self, active: Sequence[Iterable[int]]) -> tuple[tuple[int, ...], ...]:
        """Return the image of a grasp: its sorted active 1-based indices of each kind."""
        return tuple(
            tuple(sorted(int(image[index - 1]) + 1 for index in indices))
            for image, indices in zip(self.images, active, strict=True)
        )


def symmetries(space: OptionSpace) -> tuple[Symmetry, ...]:
    """Find the symmetries of the footprints about the middle of their bounding box in plan view.

    The identity is not among them.  Part and polygon are not looked at.
    """
    kinds = [kind.footprints_mm for kind in space.kinds]
    points = np.concatenate(kinds)
    if not len(points):
        return ()
    twice_middle = (points.min(axis=0) + points.max(axis=0)) * (1.0, 1.0, 0.0)
    found: list[Symmetry] = []
    for name, signs in SIGNS.items():
        images = []
        for own in kinds:
            image = _matching(own * signs + np.where(np.less(signs, 0), twice_middle, 0.0), own)
            if image is None:
                break
            images.append(image)
        else:
            found.append(Symmetry(name, tuple(images)))
    return tuple(
        each for each in found if any((np.diff(image) != 1).any() for image in each.images)
    )


def representative(
    symmetries: Sequence[Symmetry], active: Sequence[Iterable[int]]
) -> tuple[tuple[int, ...], ...]:
    """Return the least of a grasp and its images, so that twins have equal representatives.

    Parameters
    ----------
    symmetries : sequence of Symmetry
        All of an option space.
    active : sequence of iterable of int
        Active 1-based indices of each kind.
    """
    own = tuple(tuple(sorted(indices)) for indices in active)
    return min([own, *(symmetry.of(own) for symmetry in symmetries)])


def _matching(moved: FloatArray, points: FloatArray) -> IntArray | None:
    """Return the point where each moved one lands, ``(n,)``; None where one lands beside all.

    Coordinates that are equal within the tolerance get equal numbers, axis by axis, and rows of
    numbers are sorted: no search for neighbours is needed.
    """
    n = len(points)
    numbers = [_numbered(axis) for axis in np.concatenate([moved, points]).T]
    order_moved, order = (
        np.lexsort([axis[part] for axis in numbers]) for part in (slice(n), slice(n, None))
    )
    if (np.abs(moved[order_moved] - points[order]) > TOLERANCE_MM).any():
        return None
    image = np.empty(n, dtype=np.int64)
    image[order_moved] = order
    return image


def _numbered(values: FloatArray) -> IntArray:
    """Give values numbers in ascending order, equal ones the same, ``(n,)``."""
    order = np.argsort(values, kind="stable")
    steps = np.diff(values[order], prepend=values[order[:1]]) > TOLERANCE_MM
    numbers = np.empty(len(values), dtype=np.int64)
    numbers[order] = np.cumsum(steps)
    return numbers
