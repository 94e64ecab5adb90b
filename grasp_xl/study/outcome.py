"""What came of a study: each run measured, and what the runs of a case say together."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from statistics import median

import numpy as np

from grasp_xl.chromosome import Chromosome
from grasp_xl.grasp import Grasp, evaluate
from grasp_xl.kernels import Tables, measure_rows, tabulate
from grasp_xl.rules import SLACK, TERMS, Terms
from grasp_xl.search.exact import Proof
from grasp_xl.search.result import REPORT_GENERATIONS
from grasp_xl.search.symmetry import Symmetry, representative, symmetries
from grasp_xl.space import FloatArray, IntArray
from grasp_xl.study.plan import SCENARIOS, Case, Plan, Scenario, Trial
from grasp_xl.study.statistics import MannWhitney, mann_whitney
from grasp_xl.study.trial import Record

NEAR = 0.01
"""A run is near the best grasp once no more than this share above it."""

REACHED = 1e-9
"""A run reached the best value where it is no more than this share above it."""

FEW_RUNS = 8
FINE, COARSE = 40, 5
"""Points a decade at which the courses are drawn: of few runs of a case, and of many."""

MOST_DRAWN = 100
"""Runs of a start that are drawn: more would make one grey band of megabytes."""

Images = tuple[tuple[int, ...], ...]
"""Sorted active 1-based indices of each kind."""


@dataclass(frozen=True, eq=False, slots=True)
class Outcome:
    """One run, measured.

    Parameters
    ----------
    trial : Trial
    best : Grasp or None
    course : FloatArray
        ``(g, 6)`` FoS, terms and divergence of the fittest at the case's generations; NaN where it
        has no fitness.
    reported : FloatArray
        The same at the generations of the fitness tables.
    near_at : int or None
        First generation near the best grasp that is known of the case.
    done, evaluations, designs : int
    seconds : float
    """

    trial: Trial
    best: Grasp | None
    course: FloatArray
    reported: FloatArray
    near_at: int | None
    done: int
    evaluations: int
    designs: int
    seconds: float

    @property
    def value(self) -> float:
        """What the run minimised, at its end; infinite without a feasible grasp."""
        return self.best.value if self.best else math.inf


@dataclass(frozen=True, eq=False, slots=True)
class Ending:
    """A grasp in which runs ended, with its images.

    Parameters
    ----------
    number : int
        From 1, best first; images have the same.
    relation : str
        ``""`` for the first of its images, else how it is mapped onto that.
    grasp : Grasp
    outcomes : tuple of Outcome
        Runs that ended in it.
    optimal : bool
        Whether it has the proved optimum's value.
    """

    number: int
    relation: str
    grasp: Grasp
    outcomes: tuple[Outcome, ...]
    optimal: bool

    def told(self, most: int) -> str:
        """Name the runs, at most so many; the others are counted."""
        labels = [outcome.trial.label for outcome in self.outcomes]
        more = f" and {len(labels) - most:,} more" if len(labels) > most else ""
        return ", ".join(labels[:most]) + more


@dataclass(frozen=True, slots=True)
class Level:
    """A grasp that runs are compared with: what it is, its FoS, terms and divergence."""

    name: str
    values: tuple[float, ...]
    proved: bool

    @classmethod
    def of(cls, name: str, grasp: Grasp, *, proved: bool) -> Level:
        """Return the level of a grasp."""
        return cls(name, (grasp.fos, *grasp.terms, grasp.divergence), proved)


@dataclass(frozen=True, eq=False)
class CaseOutcome:
    """All runs of a case.

    Parameters
    ----------
    case : Case
    outcomes : tuple of Outcome
        In the order of the plan; those that were not done are missing.
    planned : int
    generations, reported : IntArray
        At which the outcomes' courses are measured.
    proof : Proof or None
    """

    case: Case
    outcomes: tuple[Outcome, ...]
    planned: int
    generations: IntArray
    reported: IntArray
    proof: Proof | None

    @property
    def optimum(self) -> float | None:
        """Value of the best grasp of all, if it is proved."""
        if self.proof and self.proof.is_best_proved:
            return self.proof.designs[0].value
        return None

    def values(self, scenario: Scenario | None = None) -> list[float]:
        """Return what the runs of a scenario, or all, ended with."""
        return [
            outcome.value for outcome in self.outcomes if scenario in (None, outcome.trial.scenario)
        ]

    def reached(self, scenario: Scenario | None = None) -> float | None:
        """Return the share of runs that reached the proved optimum; None without one, or runs."""
        values, optimum = self.values(scenario), self.optimum
        if optimum is None or not values:
            return None
        return sum(value <= optimum + REACHED * abs(optimum) for value in values) / len(values)

    def near_at(self, scenario: Scenario | None = None) -> float | None:
        """Return the median of the generations at which runs came near; None where fewer did."""
        at = [
            math.inf if outcome.near_at is None else outcome.near_at
            for outcome in self.outcomes
            if scenario in (None, outcome.trial.scenario)
        ]
        middle = median(at) if at else math.inf
        return middle if math.isfinite(middle) else None

    @cached_property
    def test(self) -> MannWhitney | None:
        """Whether runs from a random start end lower than those from the user-defined one."""
        first, second = (self.values(scenario) for scenario in SCENARIOS)
        return mann_whitney(first, second)

    @cached_property
    def endings(self) -> tuple[Ending, ...]:
        """The grasps in which runs ended, best first, images of one another together."""
        found: dict[Images, dict[Images, list[Outcome]]] = {}
        maps = symmetries(self.case.task.space)
        for outcome in self.outcomes:
            if outcome.best:
                active = _sorted(outcome.best.chromosome)
                images = found.setdefault(representative(maps, active), {})
                images.setdefault(active, []).append(outcome)
        groups = sorted(found.values(), key=_best_value)
        optimum = self.optimum
        endings = []
        for number, images in enumerate(groups, 1):
            first = next(iter(images))
            for active, outcomes in images.items():
                grasp = outcomes[0].best
                if grasp is None:
                    continue
                optimal = optimum is not None and grasp.value <= optimum + REACHED * abs(optimum)
                relation = _relation(maps, first, active)
                endings.append(Ending(number, relation, grasp, tuple(outcomes), optimal))
        return tuple(endings)

    @property
    def benchmark(self) -> Level:
        """The grasp that every run is to beat."""
        return Level.of("Benchmark", self.case.task.benchmark, proved=False)

    @property
    def levels(self) -> list[Level]:
        """The benchmark, and what the exact search found where it was asked."""
        levels = [self.benchmark]
        if self.proof and self.proof.designs:
            name = "Best known" if self.optimum is None else "Proved optimum"
            levels.append(Level.of(name, self.proof.designs[0], proved=True))
        return levels

    @property
    def convergence(self) -> str:
        """How many runs ended in the same grasp as another, in words."""
        total = len(self.outcomes)
        return f"{self.alike} of {total} runs ended in the grasp of another, or its image"

    @property
    def alike(self) -> int:
        """Runs that ended in the grasp of another run, or in an image of it."""
        sizes: dict[int, int] = {}
        for ending in self.endings:
            sizes[ending.number] = sizes.get(ending.number, 0) + len(ending.outcomes)
        return sum(size for size in sizes.values() if size > 1)


def _best_value(images: dict[Images, list[Outcome]]) -> float:
    return min(outcomes[0].value for outcomes in images.values())


def _sorted(chromosome: Chromosome) -> Images:
    return tuple(tuple(sorted(indices)) for indices in chromosome.active)


def _relation(maps: Sequence[Symmetry], first: Images, active: Images) -> str:
    if active == first:
        return ""
    return next(each.name for each in maps if each.of(first) == active)


def drawn_generations(generations: int, runs: int) -> IntArray:
    """Return the generations at which courses are drawn: evenly on a logarithmic axis, both ends.

    Examples
    --------
    >>> drawn_generations(100, 500).tolist()
    [1, 2, 3, 4, 6, 10, 16, 25, 40, 63, 100]
    """
    last = max(1, generations)
    points = FINE if runs <= FEW_RUNS else COARSE
    count = math.ceil(points * math.log10(last)) + 1 if last > 1 else 1
    return np.unique(np.rint(np.geomspace(1, last, count)).astype(np.int64))


def evenly(outcomes: Sequence[Outcome]) -> Sequence[Outcome]:
    """Return at most ``MOST_DRAWN`` of a start's runs, evenly chosen: those that are drawn."""
    return outcomes[:: max(1, math.ceil(len(outcomes) / MOST_DRAWN))]


def reported_generations(generations: int) -> IntArray:
    """Return the generations of the fitness tables, and the last one."""
    within = {each for each in REPORT_GENERATIONS if each <= generations}
    return np.array(sorted(within | ({generations} if generations else set())), dtype=np.int64)


class Measuring:
    """Measures the runs of one case.

    Parameters
    ----------
    plan, case
    """

    def __init__(self, plan: Plan, case: Case) -> None:
        self._case = case
        self._planned = len(plan.scenarios) * plan.runs
        self._tables: Tables = tabulate(case.task.space, case.task.rules)
        self._drawn = drawn_generations(case.task.generations, self._planned)
        self._reported = reported_generations(case.task.generations)

    def case_outcome(
        self, runs: Sequence[tuple[Trial, Record]], proof: Proof | None
    ) -> CaseOutcome:
        """Return what the runs of the case say."""
        bests = [self._best(record) for _, record in runs]
        values = [best.value for best in bests if best]
        if proof and proof.designs:
            values.append(proof.designs[0].value)
        near = min(values, default=math.inf)
        near += NEAR * abs(near) if math.isfinite(near) else 0.0
        outcomes = tuple(
            self._outcome(trial, record, best, near)
            for (trial, record), best in zip(runs, bests, strict=True)
        )
        return CaseOutcome(self._case, outcomes, self._planned, self._drawn, self._reported, proof)

    def _best(self, record: Record) -> Grasp | None:
        chromosome = record.best_chromosome
        task = self._case.task
        return evaluate(task.space, task.rules, chromosome) if chromosome else None

    def _outcome(self, trial: Trial, record: Record, best: Grasp | None, near: float) -> Outcome:
        measured = measure_rows(self._tables, record.changes.genes)
        feasible = measured[:, 5] == 1
        rules = self._case.task.rules
        base = np.array(rules.goals.base)
        counted = np.array([term not in rules.goals.dropped for term in TERMS])
        divergence = (measured[:, 1:5] / base)[:, counted].sum(axis=1)
        courses = np.column_stack([measured[:, :5], divergence])
        courses[~feasible, 1:] = np.nan
        values = np.array(
            [
                rules.value(Terms(*terms)) if fits else math.inf
                for terms, fits in zip(measured[:, 1:5].tolist(), feasible, strict=True)
            ]
        )
        close = np.flatnonzero(values <= near + SLACK * abs(near))
        return Outcome(
            trial,
            best,
            self._at(record, courses, self._drawn),
            self._at(record, courses, self._reported),
            int(record.generation[close[0]]) if len(close) else None,
            record.done,
            record.evaluations,
            record.designs,
            record.seconds,
        )

    @staticmethod
    def _at(record: Record, courses: FloatArray, generations: IntArray) -> FloatArray:
        """Return the rows of the fittest of these generations."""
        rows = np.searchsorted(record.generation, generations, side="right") - 1
        return courses[rows]
