"""Why no grasp meets all goals, and the one goal whose change would allow it."""

from __future__ import annotations

import time
from dataclasses import replace

from grasp_xl.errors import InfeasibleError, Problem
from grasp_xl.rounding import rounded_up
from grasp_xl.rules import SLACK, TERMS, UNITS, Criterion, Goals, Requirements, Rules, Terms
from grasp_xl.search.exact import ExactSettings, solve
from grasp_xl.search.stop import Stop, never
from grasp_xl.space import OptionSpace

DIGITS = 6

EXPLAIN_SECONDS = 15.0
"""Longest search for the goal changes that would help."""


def below_floor(goals: Goals, floors: Terms) -> list[str]:
    """List the terms whose goal no grasp can meet, as it is below the term's floor."""
    return [
        term
        for term, goal, floor in zip(TERMS, goals.base, floors, strict=True)
        if term not in goals.dropped and goal * (1 + SLACK) < floor
    ]


def floor_warnings(rules: Rules, floors: Terms) -> list[Problem]:
    """Name every goal that is below its floor."""
    return [
        Problem(
            f"{term} goal",
            _told(term, getattr(rules.goals.base, term)),
            f"at least the floor: no grasp of this part can have a {term} "
            f"below {_floor(term, floors)}{_arm(term, rules.requirements)}",
            "raise the goal",
        )
        for term in below_floor(rules.goals, floors)
    ]


def why_none_meets_all(
    space: OptionSpace,
    rules: Rules,
    floors: Terms,
    min_elements: int,
    stop: Stop = never,
) -> InfeasibleError:
    """Say which goals are below their floors, and which single goal change would be enough.

    Parameters
    ----------
    space, rules
        A task of which no grasp meets all goals.
    floors : Terms
        Lower bounds of the four criteria.
    min_elements : int
    stop : callable
        True ends the search for changes.
    """
    below = below_floor(rules.goals, floors)
    causes = [
        f"the {term} goal of {_told(term, getattr(rules.goals.base, term))} is below its floor "
        f"of {_floor(term, floors)}{_arm(term, rules.requirements)}"
        for term in below
    ]
    cause = ", ".join(causes) or "no goal is below its floor, but together they are too low"
    if len(below) > 1:
        told = f"Raise the goals of {', '.join(below)}"
    else:
        movable = below or [term for term in TERMS if term not in rules.goals.dropped]
        changes = _single_changes(space, rules, movable, min_elements, stop)
        told = " or ".join(changes) or "no single goal that helps was found: raise several"
    return InfeasibleError(
        f"No grasp meets all goals: {cause}.", where="goals", hint=told[:1].upper() + told[1:]
    )


def _single_changes(
    space: OptionSpace,
    rules: Rules,
    movable: list[str],
    min_elements: int,
    stop: Stop,
) -> list[str]:
    """Minimise each term while all other goals are met."""
    changes = []
    deadline = time.perf_counter() + EXPLAIN_SECONDS
    for left, term in zip(range(len(movable), 0, -1), movable, strict=True):
        others = replace(rules.goals, dropped=rules.goals.dropped | {term})
        alone = replace(rules, goals=others, criterion=Criterion(frozenset({term})))
        settings = ExactSettings(
            time_limit_s=(deadline - time.perf_counter()) / left,
            meet_goals=True,
            min_elements=min_elements,
        )
        designs = solve(space, alone, settings, stop=stop).designs
        if designs and designs[0].value > 0:
            goal = rounded_up(designs[0].value, DIGITS)
            changes.append(f"raise the {term} goal to {_told(term, goal)}")
    return changes


def _told(term: str, value: float) -> str:
    return f"{value:,.8g} {UNITS[term]}"


def _floor(term: str, floors: Terms) -> str:
    return f"{getattr(floors, term):,.6g} {UNITS[term]}"


def _arm(term: str, requirements: Requirements) -> str:
    return f" with the {requirements.moment_arm} arm" if term == "moment" else ""
