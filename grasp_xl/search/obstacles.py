"""What stands in the way of a grasp, and the one number whose change would clear it.

Every number that is suggested is shown to work by a grasp.  It is the smallest change where the
searches for it end in time, else the smallest that was found.
"""

from __future__ import annotations

import math
import time
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from grasp_xl import criteria
from grasp_xl.chromosome import Chromosome, from_active
from grasp_xl.errors import InfeasibleError
from grasp_xl.grasp import active_points
from grasp_xl.rounding import TOLD_DIGITS, rounded_down, rounded_up
from grasp_xl.rules import Requirements
from grasp_xl.search.feasibility import lifting_counts, lifting_force, max_fos
from grasp_xl.search.placing import Active, place
from grasp_xl.search.stop import Stop, never
from grasp_xl.search.warm import seconds_loading
from grasp_xl.space import MAX_COUNT, OptionSpace

Counts = tuple[int, ...]

SEARCH_SECONDS = 5.0
"""Longest search for any grasp, before the answer is left open."""

CLEARANCE_SECONDS = 1.5
COUNTS_SECONDS = 0.75
PLACE_SECONDS = 0.2
"""Longest search for a clearance that helps, for counts that do, and for one placing in them."""

NOTHING_SINGLE = "No single number that helps was found: change several, or add footprints"

CLEARANCE_DIGITS = 3
"""Significant digits of a suggested clearance."""

CLEARANCE_STEP = 0.005
LEAST_CLEARANCE_MM = 0.01
"""Relative accuracy of the largest clearance that works, and the least one that is looked for."""


@dataclass(frozen=True, slots=True)
class Changes:
    """Numbers of which each alone would allow a grasp; None where that number cannot.

    Parameters
    ----------
    fos : float or None
        Largest FoS goal.
    clearance_mm : float or None
        A smaller clearance, about the largest (mm).
    counts_max : tuple of int or None
        Smallest larger Max. of each kind.
    forces_n : tuple of float or None
        Smallest larger force of one element of each kind (N).
    min_elements : int or None
        Largest smaller number of elements to ask for.
    """

    fos: float | None
    clearance_mm: float | None
    counts_max: tuple[int | None, ...]
    forces_n: tuple[float | None, ...]
    min_elements: int | None

    def _lower_fos(self, space: OptionSpace) -> str:
        in_reach = rounded_down(max_fos(space), TOLD_DIGITS)
        crowded = " (no places were found for more elements)" if self.fos != in_reach else ""
        return f"lower the FoS goal to {self.fos:g}{crowded}"

    def told(self, space: OptionSpace) -> str:
        """Return all changes as an imperative sentence without its full stop."""
        ways = [
            self._lower_fos(space) if self.fos else "",
            f"lower the clearance to {self.clearance_mm:g} mm" if self.clearance_mm else "",
            f"lower the least number of elements to {self.min_elements}"
            if self.min_elements
            else "",
            *(
                f"raise # Max. of {kind.name} to {most}" if most else ""
                for kind, most in zip(space.kinds, self.counts_max, strict=True)
            ),
            *(
                f"use {kind.name} of {force:g} N" if force else ""
                for kind, force in zip(space.kinds, self.forces_n, strict=True)
            ),
        ]
        told = " or ".join(", ".join(way for way in ways if way).rsplit(", ", 1))
        return told[:1].upper() + told[1:] or NOTHING_SINGLE


def any_feasible(
    space: OptionSpace, requirements: Requirements, min_elements: int = 1, stop: Stop = never
) -> Chromosome:
    """Return some grasp that meets FoS and clearance.

    Parameters
    ----------
    space, requirements, min_elements
    stop : callable
        True ends the search, and that for changes that would help.

    Raises
    ------
    InfeasibleError
        If none exists, or none was found in ``SEARCH_SECONDS``; the message says which, and what
        would help.
    """
    least = least_counts(space, requirements, min_elements)
    began, proved = time.perf_counter(), True
    for tried, counts in enumerate(least):
        left = (began + SEARCH_SECONDS - time.perf_counter()) / (len(least) - tried)
        loading = seconds_loading()
        placing = place(space, counts, requirements.clearance_mm, left, stop)
        began += seconds_loading() - loading
        if placing.active:
            return from_active(space, placing.active)
        proved &= placing.proved
    seconds = time.perf_counter() - began
    changes = smallest_changes(space, requirements, min_elements, stop)
    hint = changes.told(space)
    if not lifting_counts(space, requirements):
        raise InfeasibleError(_too_weak(space, requirements), where="FoS", hint=hint)
    if not least:
        most = sum(kind.most for kind in space.kinds)
        message = f"No grasp can have {min_elements} elements: # Max. allows {most}."
        raise InfeasibleError(message, where="--min-elements", hint=hint)
    raise InfeasibleError(
        _too_close(
            requirements, sum(least[0]), min_elements, None if proved else math.ceil(seconds)
        ),
        where="Minimum Gripper Element Distance",
        hint=hint,
        proved=proved,
    )


def _too_weak(space: OptionSpace, requirements: Requirements) -> str:
    if not any(kind.most for kind in space.kinds):
        return "No grasp can have an element: # Max. or the places of each kind are 0."
    most = " and ".join(f"{kind.most} {kind.name}" for kind in space.kinds)
    return (
        f"No grasp can reach FoS {requirements.fos:g}: {most} together reach "
        f"FoS {rounded_down(max_fos(space), TOLD_DIGITS):g} against {space.part.weight_n:.5g} N."
    )


def _too_close(
    requirements: Requirements, fewest: int, min_elements: int, seconds: int | None
) -> str:
    distance = f"{requirements.clearance_mm:g} mm between"
    cause = f"FoS {requirements.fos:g} takes" if fewest > min_elements else "there must be"
    told = (
        f"No grasp can keep {distance} its elements"
        if seconds is None
        else f"No grasp that keeps {distance} its elements was found in {seconds} s"
    )
    return f"{told}; {cause} at least {fewest} of them."


def least_counts(
    space: OptionSpace, requirements: Requirements, min_elements: int = 1
) -> list[Counts]:
    """List the counts that lift, of which no element can be spared, fewest elements first."""
    strong = [c for c in lifting_counts(space, requirements) if sum(c) >= min_elements]
    known = set(strong)
    return [c for c in strong if not any(less in known for less in _one_less(c))]


def _one_less(counts: Counts) -> list[Counts]:
    return [(*counts[:k], counts[k] - 1, *counts[k + 1 :]) for k in range(len(counts))]


def smallest_changes(
    space: OptionSpace, requirements: Requirements, min_elements: int = 1, stop: Stop = never
) -> Changes:
    """Find the smallest change of each single number that would allow a grasp."""
    return _Explainer(space, requirements, min_elements, stop).changes()


@dataclass(eq=False)
class _Explainer:
    space: OptionSpace
    need: Requirements
    min_elements: int
    stop: Stop
    deadline: float = 0.0

    def changes(self) -> Changes:
        kinds = range(len(self.space.kinds))
        self._allow(COUNTS_SECONDS)
        crowded = self._most_placed()
        wanted = [counts for counts in crowded if sum(counts) >= self.min_elements]
        reach = max((lifting_force(self.space, counts) for counts in wanted), default=0.0)
        lifting = lifting_counts(self.space, self.need)
        placed = [c for c in lifting if any(_within(c, most) for most in crowded)]
        return Changes(
            fos=rounded_down(reach / self.space.part.weight_n, TOLD_DIGITS) if reach else None,
            clearance_mm=self._clearance(),
            counts_max=tuple(self._count_max(number) for number in kinds),
            forces_n=tuple(self._force(number, wanted) for number in kinds),
            min_elements=max(map(sum, placed), default=None) if self.min_elements > 1 else None,
        )

    def _allow(self, seconds: float) -> None:
        self.deadline = time.perf_counter() + seconds

    def _place(self, counts: Counts, clearance_mm: float) -> Active | None:
        left = self.deadline - time.perf_counter()
        if left <= 0 or self.stop():
            return None
        loading = seconds_loading()
        placing = place(self.space, counts, clearance_mm, min(left, PLACE_SECONDS), self.stop)
        self.deadline += seconds_loading() - loading
        return placing.active

    def _fits(self, counts: Counts) -> bool:
        return self._place(counts, self.need.clearance_mm) is not None

    def _most_placed(self) -> list[Counts]:
        """List the counts in range that can be placed, and to which no element can be added."""
        first, second = self.space.kinds
        corner = first.most, second.most
        if self._fits(corner):
            return [corner]
        placed: list[Counts] = []
        cups, magnets = first.most, second.count_min
        while cups >= first.count_min and magnets <= second.most:
            if cups + magnets == 0 or self._fits((cups, magnets)):
                placed.append((cups, magnets))
                magnets += 1
            else:
                cups -= 1
        return [c for c in placed if sum(c) and not any(_within(c, d) for d in placed if d != c)]

    def _clearance(self) -> float | None:
        """Find about the largest clearance that lifting counts can keep, by bisection."""
        least = least_counts(self.space, self.need, self.min_elements)
        if not least:
            return None
        corners = np.concatenate([kind.footprints_mm[:, :2] for kind in self.space.kinds])
        diagonal = float(np.hypot(*np.ptp(corners, axis=0)))
        low, high = 0.0, min(self.need.clearance_mm, diagonal)
        self._allow(CLEARANCE_SECONDS)
        while high - low > max(CLEARANCE_STEP * high, LEAST_CLEARANCE_MM):
            if time.perf_counter() > self.deadline or self.stop():
                break
            middle = (low + high) / 2
            kept = max((self._kept(counts, middle) for counts in least), default=0.0)
            low, high = (max(low, kept), high) if kept else (low, middle)
        return rounded_down(low, CLEARANCE_DIGITS) if low else None

    def _kept(self, counts: Counts, clearance_mm: float) -> float:
        """Return the clearance of a grasp that keeps at least the given one; 0 for none (mm)."""
        active = self._place(counts, clearance_mm)
        if active is None:
            return 0.0
        points = active_points(self.space, from_active(self.space, active))
        return criteria.smallest_distance(points) or 0.0

    def _count_max(self, number: int) -> int | None:
        """Find the smallest larger Max. with which the fewest elements that lift can be placed."""
        kind = self.space.kinds[number]
        self._allow(COUNTS_SECONDS)
        for most in range(kind.count_max + 1, min(kind.total, MAX_COUNT) + 1):
            kinds = list(self.space.kinds)
            kinds[number] = replace(kind, count_min=most, count_max=most)
            wider = replace(self.space, kinds=tuple(kinds))
            for counts in least_counts(wider, self.need, self.min_elements)[:1]:
                if self._fits(counts):
                    return most
        return None

    def _force(self, number: int, placed: Sequence[Counts]) -> float | None:
        """Return the least force with which some counts that can be placed lift the part (N)."""
        kind = self.space.kinds[number]
        needed = self.need.fos * self.space.part.weight_n
        forces = [
            kind.force_n + (needed - lifting_force(self.space, counts)) / counts[number]
            for counts in placed
            if counts[number]
        ]
        return rounded_up(min(forces), TOLD_DIGITS) if forces else None


def _within(counts: Counts, most: Counts) -> bool:
    return all(n <= m for n, m in zip(counts, most, strict=True))
