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
from grasp_xl.space import OptionSpace


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

    Cost: the cheapest counts.  Deviation: the mean of the nearest footprints.  Moment: the centre
    of force stays within the hull of the footprints and between their heights.  Structure: the
    main truss is no shorter than the clearance.  The clearance is otherwise not looked at, so a
    floor may lie below the best grasp; never above it.

    Raises
    ------
    ValueError
        If no counts meet FoS.
    """
    choices = lifting_counts(space, requirements)
    if not choices:
        raise ValueError("no counts meet FoS")
    structure = requirements.density_ratio * requirements.clearance_mm
    return Terms(
        cost=min(
            plain_sum(n * kind.price for n, kind in zip(counts, space.kinds, strict=True))
            for counts in choices
        ),
        moment=_moment_floor(space, requirements),
        deviation=_deviation_floor(space, choices),
        structure=structure if min(map(sum, choices)) > 1 else 0.0,
    )


def _moment_floor(space: OptionSpace, requirements: Requirements) -> float:
    points = np.concatenate([kind.footprints_mm for kind in space.kinds])
    x, y, z = space.part.centroid_mm.tolist()
    in_plan = shapely.MultiPoint(points[:, :2]).convex_hull.distance(shapely.Point(x, y))
    if requirements.moment_arm == "plan":
        return float(in_plan) * space.part.weight_n
    in_height = max(0.0, points[:, 2].min() - z, z - points[:, 2].max())
    return math.hypot(in_plan, in_height) * space.part.weight_n


def _deviation_floor(space: OptionSpace, choices: Sequence[tuple[int, ...]]) -> float:
    ideal = np.array(space.ideal_polygon_mm)
    nearest = [
        np.cumsum(np.sort(boundary_distances(np.array(kind.footprints_mm), ideal)))
        for kind in space.kinds
    ]
    return min(
        plain_sum(float(sums[n - 1]) for n, sums in zip(counts, nearest, strict=True) if n)
        / sum(counts)
        for counts in choices
    )
