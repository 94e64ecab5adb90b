"""What a gripper element looks like: true in its footprint, simple above it.

Catalogues give the size of the footprint alone.  Heights are a part of it, as short bellows and
magnets have them, so that nobody takes them for those of the data sheet.
"""

from __future__ import annotations

from dataclasses import dataclass

from grasp_xl.fitment.element import Element
from grasp_xl.space import ElementKind, FloatArray, frozen
from grasp_xl.view.solids import Block, Solid, Turned

BELL = ((0.5, 0.0), (0.3, 0.3))
"""Outer edge of a cup's bell, r and z, as a part of its size."""

MAGNET = ((0.5, 0.0), (0.5, 0.5))
"""Outer edge of a magnet's body."""

STEM_RADIUS, HEIGHT = 0.15, 0.8
"""Of the stem on it, and of the whole element."""


@dataclass(frozen=True, slots=True)
class ElementModel:
    """An element that stands on its place, the face at z = 0.

    Parameters
    ----------
    solids : tuple of Solid
    size_mm : float
        Diameter, or the shorter side: what all its heights are a part of.
    """

    solids: tuple[Solid, ...]
    size_mm: float

    @property
    def height_mm(self) -> float:
        """From the face to the top of the stem."""
        return HEIGHT * self.size_mm

    @property
    def stem_radius_mm(self) -> float:
        """Of the stem, and of the post that goes on from it."""
        return STEM_RADIUS * self.size_mm


def element_model(
    kind: ElementKind, element: Element | None, default_mm: float, angle_deg: float
) -> ElementModel:
    """Return the model of a kind.

    Parameters
    ----------
    kind : ElementKind
    element : Element or None
        Of a catalogue; None where it has none of that name.
    default_mm : float
        Diameter where none is known.
    angle_deg : float
        Of the length of an element that is not round, to the x-axis.
    """
    edge = BELL if kind.name == "suction" else MAGNET
    if element and element.sides_mm:
        size = min(element.sides_mm)
        top = edge[-1][1] * size
        body = Block(*element.sides_mm, angle_deg, 0.0, top)
        return ElementModel((body, Turned(_stem(size, top))), size)
    size = kind.diameter_mm or default_mm
    return ElementModel((Turned(_profile(size, edge)),), size)


def _profile(size: float, edge: tuple[tuple[float, float], ...]) -> FloatArray:
    """Return the profile of a body with the stem on it."""
    body = [(r * size, z * size) for r, z in edge]
    return frozen([(0.0, 0.0), *body, *_stem(size, body[-1][1]).tolist()[1:]])


def _stem(size: float, low: float) -> FloatArray:
    radius, high = STEM_RADIUS * size, HEIGHT * size
    return frozen([(0.0, low), (radius, low), (radius, high), (0.0, high)])
