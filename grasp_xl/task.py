"""From what a person said (file and options) to a task that a search can take: no gaps left."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, fields, replace
from typing import Any, TypeVar

from grasp_xl.chromosome import Chromosome, is_usable
from grasp_xl.errors import Problem
from grasp_xl.grasp import Grasp, evaluate
from grasp_xl.rules import (
    DEFAULT_CLEARANCE_MM,
    TERMS,
    Criterion,
    Goals,
    MomentArm,
    Requirements,
    Rules,
    Terms,
)
from grasp_xl.search.benchmark import assigned_benchmark
from grasp_xl.search.result import GeneticSettings
from grasp_xl.search.stop import Stop, never
from grasp_xl.space import OptionSpace

T = TypeVar("T")

NEGLIGIBLE_GOAL = 1e-9
"""A defaulted goal below this drops its term (one element has no structure, say)."""

NO_GOALS = (None, None, None, None)


@dataclass(frozen=True, slots=True)
class Parameters:
    """What a workbook or the options say; None where they say nothing.

    ``goals`` are cost ($), moment (N-mm), deviation (mm), structure (mm).  Other fields as in
    ``Requirements`` and ``GeneticSettings``.
    """

    user_start: bool | None = None
    elitism: bool | None = None
    one_in: float | None = None
    generations: int | None = None
    clearance_mm: float | None = None
    density_ratio: float | None = None
    criterion: Criterion | None = None
    fos: float | None = None
    goals: tuple[float | None, ...] = NO_GOALS
    children: int | None = None
    seed: int | None = None
    moment_arm: MomentArm | None = None

    def over(self, base: Parameters) -> Parameters:
        """Return these parameters, and the base's where these say nothing."""
        merged: dict[str, Any] = {
            item.name: getattr(base, item.name)
            if getattr(self, item.name) is None
            else getattr(self, item.name)
            for item in fields(self)
        }
        merged["goals"] = tuple(
            below if mine is None else mine
            for mine, below in zip(self.goals, base.goals, strict=True)
        )
        return Parameters(**merged)


DEFAULTS = Parameters(
    user_start=True,
    elitism=True,
    one_in=4.0,
    generations=50_000,
    density_ratio=2.5,
    criterion=Criterion(),
    fos=3.0,
    children=5,
    seed=1,
    moment_arm="3d",
)


@dataclass(frozen=True, eq=False, slots=True)
class Task:
    """An option space with everything settled: rules, settings, and the benchmark grasp.

    Parameters
    ----------
    space : OptionSpace
    parameters : Parameters
        What the file and the options said, defaults filled in; typed goals only.
    rules : Rules
    settings : GeneticSettings
    generations : int
    benchmark : Grasp
        The user-defined grasp, or the program's where there is none.
    assigned : bool
        Whether the program chose the benchmark.
    warnings : tuple of Problem
    """

    space: OptionSpace
    parameters: Parameters
    rules: Rules
    settings: GeneticSettings
    generations: int
    benchmark: Grasp
    assigned: bool
    warnings: tuple[Problem, ...]

    def warned(self, more: Iterable[Problem]) -> Task:
        """Return the task with more warnings behind its own."""
        return replace(self, warnings=(*self.warnings, *more))


def settle(
    space: OptionSpace,
    said: Parameters,
    user_chromosome: Chromosome | None,
    assigned: Chromosome | None = None,
    stop: Stop = never,
) -> Task:
    """Fill every gap: defaults, the clearance, the benchmark grasp, the goals.

    Parameters
    ----------
    space, said
    user_chromosome : Chromosome or None
    assigned : Chromosome, optional
        What the program assigned before in its place: it stays as long as it is feasible, so that
        goals taken from it stay what the designer sees.
    stop : callable
        True ends the search for a benchmark.

    Raises
    ------
    InfeasibleError
        If no grasp can serve as the benchmark.
    """
    known = said.over(DEFAULTS)
    requirements = settle_requirements(space, known)
    unscaled = Rules(Goals(Terms(1.0, 1.0, 1.0, 1.0)), requirements)
    kept = user_chromosome
    if not kept and assigned and _is_feasible(space, unscaled, assigned):
        kept = assigned
    chromosome = kept or assigned_benchmark(space, requirements, stop)
    benchmark = evaluate(space, unscaled, chromosome)
    goals, warnings = settle_goals(benchmark.terms, known.goals)
    rules = Rules(goals, requirements, _known(known.criterion))
    if assigned and not kept:
        warnings.append(
            Problem(
                "User-Defined Chromosome",
                "a grasp that the program assigned, and that is no longer feasible",
                "one that meets counts, FoS and clearance",
                "another is assigned now, and goals that nobody typed follow it",
            )
        )
    if not benchmark.feasible:
        warnings.append(
            Problem(
                "User-Defined Chromosome",
                f"a grasp with FoS {benchmark.fos:.4g} and clearance "
                + (
                    f"{benchmark.clearance_mm:.4g} mm"
                    if benchmark.clearance_mm is not None
                    else "-"
                ),
                f"FoS {requirements.fos:g} and {requirements.clearance_mm:g} mm",
                "a run that starts from it draws random grasps until one passes",
            )
        )
    return Task(
        space=space,
        parameters=known,
        rules=rules,
        settings=GeneticSettings(
            one_in=_known(known.one_in),
            children=_known(known.children),
            elitism=_known(known.elitism),
            user_start=_known(known.user_start),
            seed=_known(known.seed),
        ),
        generations=_known(known.generations),
        benchmark=evaluate(space, rules, chromosome),
        assigned=user_chromosome is None,
        warnings=tuple(warnings),
    )


def _is_feasible(space: OptionSpace, rules: Rules, chromosome: Chromosome) -> bool:
    return is_usable(chromosome, space) and evaluate(space, rules, chromosome).feasible


def settle_requirements(space: OptionSpace, said: Parameters) -> Requirements:
    """Return what every grasp must meet, defaults filled in."""
    known = said.over(DEFAULTS)
    return Requirements(
        fos=_known(known.fos),
        clearance_mm=known.clearance_mm or space.largest_diameter_mm or DEFAULT_CLEARANCE_MM,
        density_ratio=_known(known.density_ratio),
        moment_arm=_known(known.moment_arm),
    )


def settle_goals(benchmark: Terms, typed: tuple[float | None, ...]) -> tuple[Goals, list[Problem]]:
    """Return the goals, the benchmark's values where none is typed, and what was dropped."""
    base = Terms(
        *(value if goal is None else goal for value, goal in zip(benchmark, typed, strict=True))
    )
    dropped = frozenset(
        term
        for term, value, goal in zip(TERMS, benchmark, typed, strict=True)
        if goal is None and value < NEGLIGIBLE_GOAL
    )
    warnings = [
        Problem(
            f"{term} goal",
            f"the user-defined grasp's {term} of {getattr(benchmark, term):g}",
            "a value above 0 to divide by",
            f"{term} is left out of the sums; type a goal to count it",
        )
        for term in TERMS
        if term in dropped
    ]
    return Goals(base, dropped), warnings


def _known(value: T | None) -> T:
    if value is None:
        raise AssertionError("DEFAULTS fills this field")
    return value
