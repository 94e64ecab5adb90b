"""How much a grasp can lift: the factor of safety from counts alone."""

from __future__ import annotations

import itertools

from grasp_xl.adding import plain_sum
from grasp_xl.rules import SLACK, Requirements
from grasp_xl.space import OptionSpace


def lifting_force(space: OptionSpace, counts: tuple[int, ...]) -> float:
    """Return the force of so many elements of each kind (N), eq. 11."""
    return plain_sum(n * kind.force_n for n, kind in zip(counts, space.kinds, strict=True))


def max_fos(space: OptionSpace) -> float:
    """Return the factor of safety of the most elements that a grasp can have."""
    return lifting_force(space, tuple(kind.most for kind in space.kinds)) / space.part.weight_n


def lifting_counts(space: OptionSpace, requirements: Requirements) -> list[tuple[int, ...]]:
    """List the counts of each kind that meet FoS, fewest elements first."""
    ranges = (range(kind.count_min, kind.most + 1) for kind in space.kinds)
    force_min = requirements.fos * (1 - SLACK) * space.part.weight_n
    strong = [
        counts
        for counts in itertools.product(*ranges)
        if sum(counts) and lifting_force(space, counts) >= force_min
    ]
    return sorted(strong, key=lambda counts: (sum(counts), counts))
