"""What an engineer asks first of a grasp: does it hang from three points, is the weight between.

Section 6.7.2 of the thesis names this as its limitation; these numbers are shown, not searched.
"""

from __future__ import annotations

from dataclasses import dataclass

import shapely

from grasp_xl.adding import plain_sum
from grasp_xl.grasp import Grasp
from grasp_xl.space import OptionSpace

FLAT = 1e-9
"""Area over the squared length of the grasp below which the points lie on one line."""


@dataclass(frozen=True, slots=True)
class Support:
    """How a grasp holds its part.

    Parameters
    ----------
    element_weight_g : float or None
        All active elements together; None where a kind's weight is not known.
    hull_area_mm2 : float
        Plan area of the convex hull of the active points.
    centroid_inside : bool
        Whether the part's centroid lies inside it in plan view.
    can_swing : bool
        Whether fewer than three points out of line hold the part.
    """

    element_weight_g: float | None
    hull_area_mm2: float
    centroid_inside: bool
    can_swing: bool


def support(space: OptionSpace, grasp: Grasp) -> Support:
    """Look at how a grasp holds its part."""
    hull = shapely.MultiPoint(grasp.points_mm[:, :2]).convex_hull
    longest = grasp.longest_mm
    flat = hull.area <= FLAT * longest**2
    centroid = shapely.Point(space.part.centroid_mm[:2])
    weights = [
        (int(count), kind.weight_g)
        for count, kind in zip(grasp.chromosome.counts, space.kinds, strict=True)
        if count
    ]
    known = [count * weight for count, weight in weights if weight is not None]
    return Support(
        element_weight_g=plain_sum(known) if len(known) == len(weights) else None,
        hull_area_mm2=0.0 if flat else float(hull.area),
        centroid_inside=not flat and bool(hull.distance(centroid) <= FLAT * longest),
        can_swing=flat,
    )
