"""The gripper's frame over a grasp: main truss, branches and posts (eq. 7, figures 19 and 35).

Eq. 7 sees it from above.  Here it lies level over the highest element.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from grasp_xl.grasp import Grasp
from grasp_xl.space import FloatArray, OptionSpace, frozen
from grasp_xl.view.element_model import ElementModel
from grasp_xl.view.solids import Bar

MAIN_RADIUS, BRANCH_RADIUS, RISE = 0.2, 0.12, 0.5
"""Radii of the bars, and height of their axes over the elements, as a part of the largest one."""


@dataclass(frozen=True, slots=True)
class FrameSizes:
    """Sizes of the frame's bars (mm)."""

    main_radius_mm: float
    branch_radius_mm: float
    rise_mm: float


@dataclass(frozen=True, slots=True)
class Standing:
    """An element of a grasp: its kind (from 0), index and place, ``(3,)`` (mm)."""

    kind: int
    index: int
    place_mm: FloatArray


@dataclass(frozen=True, slots=True)
class Frame:
    """The bars over a grasp; no main truss over a single element."""

    main: tuple[Bar, ...]
    branches: tuple[Bar, ...]
    posts: tuple[Bar, ...]


def frame_sizes(models: Sequence[ElementModel]) -> FrameSizes:
    """Return sizes that look right beside the elements."""
    size = max(model.size_mm for model in models)
    return FrameSizes(MAIN_RADIUS * size, BRANCH_RADIUS * size, RISE * size)


def standing(space: OptionSpace, grasp: Grasp) -> tuple[Standing, ...]:
    """Return the elements of a grasp, in the order of its points."""
    return tuple(
        Standing(kind, index, space.kinds[kind].footprints_mm[index - 1])
        for kind, indices in enumerate(grasp.chromosome.active)
        for index in indices
    )


def frame_over(
    grasp: Grasp, elements: Sequence[Standing], models: Sequence[ElementModel], sizes: FrameSizes
) -> Frame:
    """Return the bars of the frame."""
    tops = [each.place_mm[2] + models[each.kind].height_mm for each in elements]
    height = max(tops) + sizes.rise_mm

    def lifted(point: FloatArray) -> FloatArray:
        return frozen([point[0], point[1], height])

    posts = tuple(
        Bar(
            frozen([*each.place_mm[:2], top]),
            lifted(each.place_mm),
            models[each.kind].stem_radius_mm,
        )
        for each, top in zip(elements, tops, strict=True)
    )
    if grasp.main_truss is None or grasp.longest_mm == 0:  # two at one place have no direction
        return Frame((), (), posts)
    start, end = (lifted(grasp.points_mm[row]) for row in grasp.main_truss)
    main = Bar(start, end, sizes.main_radius_mm)
    others = np.delete(grasp.points_mm, grasp.main_truss, axis=0)
    feet = [(lifted(point), _foot(lifted(point), start, end)) for point in others]
    branches = (
        Bar(point, foot, sizes.branch_radius_mm) for point, foot in feet if (point != foot).any()
    )
    return Frame((main,), tuple(branches), posts)


def _foot(point: FloatArray, start: FloatArray, end: FloatArray) -> FloatArray:
    """Return the nearest point of the main truss's line: no element lies beyond its ends."""
    axis = end - start
    return frozen(start + ((point - start) @ axis) / (axis @ axis) * axis)
