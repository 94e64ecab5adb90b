"""What a study says: a row a case, and answers to the thesis's research questions (section 1.3)."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from statistics import median
from typing import Literal

import numpy as np

from grasp_xl.rounding import percent
from grasp_xl.search.front import covers
from grasp_xl.study.outcome import CaseOutcome
from grasp_xl.study.plan import SCENARIOS, Plan, Scenario
from grasp_xl.study.statistics import holm

ALPHA = 0.05
"""Level of the tests, over all cases of a study."""

SMALL, MEDIUM, LARGE = 0.12, 0.28, 0.42
"""Effect sizes from which on one is called small, medium or large (Vargha and Delaney 2000)."""

Look = Literal["text", "count", "value", "percent", "ratio"]
"""How a column's numbers are shown."""

Value = str | float | int | None


@dataclass(frozen=True, slots=True)
class Column:
    """A column of the summary: its title, how its values are shown, a short title.

    Columns without a short title are left out where there is little room.
    """

    title: str
    look: Look
    short: str


@dataclass(frozen=True, eq=False, slots=True)
class Study:
    """All that a study found.

    Parameters
    ----------
    plan : Plan
    cases : tuple of CaseOutcome
    """

    plan: Plan
    cases: tuple[CaseOutcome, ...]

    @property
    def done(self) -> int:
        """Runs that are done."""
        return sum(len(case.outcomes) for case in self.cases)

    @property
    def complete(self) -> bool:
        """Whether all runs are done."""
        return self.done == len(self.plan)

    @property
    def proves(self) -> bool:
        """Whether the exact search was asked."""
        return any(case.proof for case in self.cases)


@dataclass(frozen=True, slots=True)
class Answer:
    """A research question, and what the study says of it: a line a case."""

    question: str
    answer: str


WORDS: dict[Scenario, str] = {"random": "random start", "user": "user-defined start"}


def columns(study: Study) -> list[Column]:
    """Return the columns of the summary."""
    proved = [
        Column("Proved optimum", "value", "optimum"),
        Column("Reached it", "percent", "reached"),
    ]
    return [
        Column("Case", "text", "case"),
        Column("Start", "text", "start"),
        Column("Runs", "count", "runs"),
        Column("Benchmark", "value", ""),
        Column("Best", "value", "best"),
        Column("Median", "value", "median"),
        Column("Worst", "value", "worst"),
        *(proved if study.proves else []),
        Column("Generations to within 1 %", "count", "near at"),
        Column("p (Holm)", "ratio", ""),
        Column("Effect size", "ratio", ""),
    ]


def rows(study: Study) -> Iterator[list[Value]]:
    """Give the rows of the summary: each case, as a whole and by its start."""
    corrected = dict(zip(_tested(study.cases), _corrected(study.cases), strict=True))
    for number, case in enumerate(study.cases):
        parts: list[Scenario | None] = [None]
        parts += study.plan.scenarios if len(study.plan.scenarios) > 1 else []
        for scenario in parts:
            values = case.values(scenario)
            proved: list[Value] = [case.optimum, case.reached(scenario)] if study.proves else []
            test = case.test if scenario is None else None
            yield [
                case.case.title,
                WORDS[scenario]
                if scenario
                else "all"
                if len(parts) > 1
                else WORDS[study.plan.scenarios[0]],
                len(values),
                finite(case.case.task.benchmark.value),
                finite(min(values, default=math.inf)),
                finite(median(values) if values else math.inf),
                finite(max(values, default=math.inf)),
                *proved,
                case.near_at(scenario),
                corrected.get(number) if test else None,
                test.effect if test else None,
            ]


def finite(value: float) -> float | None:
    """Return a number; None for infinity, where no grasp was feasible."""
    return value if math.isfinite(value) else None


def _tested(cases: Sequence[CaseOutcome]) -> list[int]:
    return [number for number, case in enumerate(cases) if case.test]


def _corrected(cases: Sequence[CaseOutcome]) -> list[float]:
    return holm([case.test.p for case in cases if case.test])


def answers(study: Study) -> list[Answer]:
    """Answer the three research questions of the thesis, as far as the study's runs can."""
    return [
        Answer(
            "RQ1: Does an evolutionary search find viable grasps with grippers of several types?",
            _viable(study),
        ),
        Answer("RQ2: How does it behave with all criteria in one sum?", _behaviour(study)),
        Answer(
            "RQ3: How do runs from a random grasp compare with runs from the user-defined one?",
            _starts(study),
        ),
    ]


def _viable(study: Study) -> str:
    outcomes = [(case, each) for case in study.cases for each in case.outcomes]
    if not outcomes:
        return "No run is done."
    feasible = sum(each.best is not None for _, each in outcomes)
    better = sum(each.value < case.case.task.benchmark.value for case, each in outcomes)
    return (
        f"{feasible:,} of {len(outcomes):,} runs ended in a grasp that meets FoS and clearance; "
        f"{better:,} in one that is better than the benchmark."
    )


def _behaviour(study: Study) -> str:
    sentences = []
    for case in study.cases:
        values = sorted(value for value in case.values() if math.isfinite(value))
        if not values:
            continue
        spread = values[-1] / values[0] - 1 if values[0] > 0 else 0.0
        terms = np.array([each.best.terms for each in case.outcomes if each.best])
        rows_ = covers(terms)
        best = int((rows_ == np.arange(len(terms))).sum())
        told = (
            f"{case.case.label}: the worst run is {percent(spread)} above the best; "
            f"{case.alike} of {len(case.outcomes)} runs ended in the grasp of another one or in "
            f"its mirror image; grasps that no other run's dominates: {best}"
        )
        reached = case.reached()
        if reached is not None:
            told += f"; {percent(reached)} reached the proved optimum"
        sentences.append(told + ".")
    return "\n".join(sentences) or "No run ended in a feasible grasp."


def _starts(study: Study) -> str:
    if any(scenario not in study.plan.scenarios for scenario in SCENARIOS):
        return "The study has runs from one kind of start only."
    sentences = []
    corrected = dict(zip(_tested(study.cases), _corrected(study.cases), strict=True))
    for number, case in enumerate(study.cases):
        if not case.test:
            continue
        p, effect = corrected[number], case.test.effect
        told = f"{case.case.label}: p = {p:.3g}, effect size {effect:+.2f}"
        if p >= ALPHA:
            sentences.append(f"{told}: no difference is shown.")
        else:
            lower = WORDS["random" if effect < 0 else "user"]
            sentences.append(
                f"{told}: runs from the {lower} end lower, a {_size(effect)} difference."
            )
    return "\n".join(
        [
            (
                "Mann-Whitney U test of what the runs ended with, two-sided, p-values corrected "
                "for the number of cases (Holm); the effect size is the rank-biserial "
                "correlation, negative where the random start ends lower."
            ),
            *sentences,
        ]
    )


def _size(effect: float) -> str:
    size = abs(effect)
    if size >= LARGE:
        return "large"
    if size >= MEDIUM:
        return "medium"
    return "small" if size >= SMALL else "negligible"
