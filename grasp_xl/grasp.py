"""One grasp, fully judged: every number of a child card (figure 33)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from grasp_xl import criteria
from grasp_xl.chromosome import Chromosome
from grasp_xl.rules import SLACK, Rules, Terms
from grasp_xl.space import FloatArray, OptionSpace


@dataclass(frozen=True, eq=False, slots=True)
class Grasp:
    """A chromosome and what the criteria say of it.

    Parameters
    ----------
    chromosome : Chromosome
    points_mm : FloatArray
        ``(n, 3)`` array of the active footprint centres, kind after kind.
    force_n, weight_n, fos : float
        Lifting force F, part weight W, and F / W.
    centre_of_force_mm, offset_mm : FloatArray
        Centre of force, and centroid minus centre of force, ``(3,)`` each.
    eccentricity_mm : float
        Length of the moment arm.
    clearance_mm : float or None
        Smallest distance between two elements; None for one element.
    main_truss : tuple of int or None
        The two rows of ``points_mm`` that the main truss joins; None for one element.
    terms : Terms
        Cost ($), residual moment (N-mm), deviation (mm), structure (mm).
    normalised : tuple of float or None
        Each term over its goal; None where the term is dropped.
    normalised_fos, divergence, value : float
        FoS goal over FoS, eq. 8, and the number that the search minimises.
    meets_fos, is_clear, meets_all_goals : bool
        Both constraints, and beyond them every goal (section 4.2.3.5).
    """

    chromosome: Chromosome
    points_mm: FloatArray
    force_n: float
    weight_n: float
    fos: float
    centre_of_force_mm: FloatArray
    offset_mm: FloatArray
    eccentricity_mm: float
    clearance_mm: float | None
    main_truss: tuple[int, int] | None
    terms: Terms
    normalised: tuple[float | None, ...]
    normalised_fos: float
    divergence: float
    value: float
    meets_fos: bool
    is_clear: bool
    meets_all_goals: bool

    @property
    def feasible(self) -> bool:
        """Whether both constraints of section 4.2.4 hold."""
        return self.meets_fos and self.is_clear

    @property
    def longest_mm(self) -> float:
        """Length of the main truss, the largest plan-view distance of two elements (mm)."""
        if self.main_truss is None:
            return 0.0
        start, end = self.points_mm[list(self.main_truss), :2]
        return criteria.length(end - start)


def active_points(space: OptionSpace, chromosome: Chromosome) -> FloatArray:
    """Return the active footprint centres, kind after kind, ``(n, 3)`` (mm)."""
    return np.concatenate(
        [
            kind.footprints_mm[np.asarray(indices, dtype=np.int64) - 1]
            for kind, indices in zip(space.kinds, chromosome.active, strict=True)
        ]
    )


def measure(space: OptionSpace, rules: Rules, chromosome: Chromosome) -> Terms:
    """Return the four criteria of a chromosome, in their own units."""
    return evaluate(space, rules, chromosome).terms


def evaluate(space: OptionSpace, rules: Rules, chromosome: Chromosome) -> Grasp:
    """Judge one chromosome by every criterion and constraint (section 5.2.4)."""
    need = rules.requirements
    points = active_points(space, chromosome)
    forces = np.array([kind.force_n for kind in space.kinds])
    prices = np.array([kind.price for kind in space.kinds])
    counts = chromosome.counts

    force = criteria.lifting_force(counts, forces)
    weight = space.part.weight_n
    fos = criteria.factor_of_safety(force, weight)
    centre = criteria.centre_of_force(points, np.repeat(forces, counts))
    arm = criteria.eccentricity(centre, space.part.centroid_mm, need.moment_arm)
    clearance = criteria.smallest_distance(points)
    terms = Terms(
        cost=criteria.cost(counts, prices),
        moment=criteria.residual_moment(arm, weight),
        deviation=criteria.deviation(points, space.ideal_polygon_mm),
        structure=criteria.structure(points, need.density_ratio),
    )
    meets_fos = fos >= need.fos * (1 - SLACK)
    is_clear = clearance is None or clearance >= need.clearance_mm * (1 - SLACK)
    return Grasp(
        chromosome=chromosome,
        points_mm=points,
        force_n=force,
        weight_n=weight,
        fos=fos,
        centre_of_force_mm=centre,
        offset_mm=space.part.centroid_mm - centre,
        eccentricity_mm=arm,
        clearance_mm=clearance,
        main_truss=criteria.main_truss(points, need.density_ratio) if len(points) > 1 else None,
        terms=terms,
        normalised=rules.goals.normalised(terms),
        normalised_fos=need.fos / fos,
        divergence=rules.goals.divergence(terms),
        value=rules.value(terms),
        meets_fos=meets_fos,
        is_clear=is_clear,
        meets_all_goals=meets_fos and is_clear and rules.goals.met_by(terms),
    )
