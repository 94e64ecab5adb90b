"""What no grasp can go below: a lower bound of each criterion, and the size of the search."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import shapely

from grasp_xl.adding import plain_sum
from grasp_xl.kernels import boundary_distances
from grasp_xl.rules import Requirements, Terms
from grasp_xl.search.feasibility import lifting_counts
from grasp_xl.space import FloatArray, OptionSpace

MOST_SUMS = 100_000
"""Sums of heights that are looked at; of more heights only the least and the largest count."""


def search_space(space: OptionSpace) -> int:
    """Return the number of different grasps (section 4.1): sets of footprints in range.

    Examples
    --------
    The thesis's figure 12, 141 cups and 84 magnets, one to five of each, has 1.4757e16.
    """
    return math.prod(
        sum(math.comb(kind.total, n) for n in range(kind.count_min, kind.most + 1))
        for kind in space.kinds
    ) - int(all(kind.count_min == 0 for kind in space.kinds))


def floors(space: OptionSpace, requirements: Requirements) -> Terms:
    """Return a number for each criterion that no grasp with enough force can be below.

    Raises
    ------
    ValueError
        If no counts meet FoS.
    """
    by_counts = floors_by_counts(space, requirements)
    if not by_counts:
        raise ValueError("no counts meet FoS")
    return Terms(*map(min, zip(*by_counts.values(), strict=True)))


def floors_by_counts(
    space: OptionSpace, requirements: Requirements
) -> dict[tuple[int, ...], Terms]:
    """Return the floors of each choice of counts that meets FoS.

    Cost: that of the counts.  Deviation: the mean of the nearest footprints.  Moment: the centre
    of force stays within the hull of the footprints in plan view, and is no nearer to the centroid
    in height than the elements' heights allow, whichever places they take.  Structure: the main
    truss is no shorter than the clearance.  The clearance is otherwise not looked at, so a floor
    may lie below the best grasp; never above it.
    """
    points = np.concatenate([kind.footprints_mm[:, :2] for kind in space.kinds])
    centroid = shapely.Point(*space.part.centroid_mm[:2].tolist())
    in_plan = float(shapely.MultiPoint(points).convex_hull.distance(centroid))
    ideal = np.array(space.ideal_polygon_mm)
    nearest = [
        np.cumsum(np.sort(boundary_distances(np.array(kind.footprints_mm), ideal)))
        for kind in space.kinds
    ]
    heights = None if requirements.moment_arm == "plan" else _Heights(space)
    structure = requirements.density_ratio * requirements.clearance_mm

    def floor(counts: tuple[int, ...]) -> Terms:
        in_height = heights.least(counts) if heights else 0.0
        apart = (float(sums[n - 1]) for n, sums in zip(counts, nearest, strict=True) if n)
        return Terms(
            cost=plain_sum(n * kind.price for n, kind in zip(counts, space.kinds, strict=True)),
            moment=math.hypot(in_plan, in_height) * space.part.weight_n,
            deviation=plain_sum(apart) / sum(counts),
            structure=structure if sum(counts) > 1 else 0.0,
        )

    return {counts: floor(counts) for counts in lifting_counts(space, requirements)}


class _Heights:
    """How near in height a centre of force can come to the centroid."""

    def __init__(self, space: OptionSpace) -> None:
        self._forces = [kind.force_n for kind in space.kinds]
        z = float(space.part.centroid_mm[2])
        self._levels = [np.unique(kind.footprints_mm[:, 2]) - z for kind in space.kinds]
        self._sums: list[list[FloatArray | None]] = [[np.zeros(1)] for _ in space.kinds]

    def least(self, counts: tuple[int, ...]) -> float:
        """Return the least distance (mm) of so many elements, at any of their kinds' heights."""
        pulls = [n * force for n, force in zip(counts, self._forces, strict=True)]
        taken = [(levels, pull) for levels, pull in zip(self._levels, pulls, strict=True) if pull]
        low = plain_sum(pull * float(levels[0]) for levels, pull in taken)
        high = plain_sum(pull * float(levels[-1]) for levels, pull in taken)
        least = max(0.0, low, -high)
        sums = [self._sums_of(kind, n) for kind, n in enumerate(counts)]
        if all(each is not None for each in sums):
            parts = [
                force * each
                for force, each in zip(self._forces, sums, strict=True)
                if each is not None
            ]
            least = max(least, _nearest_to_0(parts))
        return least / plain_sum(pulls)

    def _sums_of(self, kind: int, n: int) -> FloatArray | None:
        """Return all sums of n heights, in order; None where there are too many."""
        known = self._sums[kind]
        while len(known) <= n:
            last, levels = known[-1], self._levels[kind]
            if last is None or len(last) * len(levels) > MOST_SUMS:
                known.append(None)
            else:
                known.append(np.unique(np.add.outer(last, levels)))
        return known[n]


def _nearest_to_0(parts: Sequence[FloatArray]) -> float:
    """Return the least size of a sum of one number of each of two sorted arrays."""
    first, second = parts
    behind = np.searchsorted(second, -first)
    after = second[np.minimum(behind, len(second) - 1)]
    before = second[np.maximum(behind - 1, 0)]
    return float(min(np.abs(first + after).min(), np.abs(first + before).min()))
