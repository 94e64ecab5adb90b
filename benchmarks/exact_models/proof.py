"""From a solver's answers for fixed counts and some tangents to a proof for the whole problem.

The moment term is the length of a sum v, and ``|v| >= u . v`` for every unit vector u.  A solver
minimises with some such u; each grasp that it returns is judged by ``grasp_xl.grasp.evaluate``, and
the direction of its v is added, until no grasp of these counts can be better than the best by more
than the tolerance.  Every answer's bound holds for the true problem, so tangents lose no accuracy.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from grasp_xl.chromosome import from_active
from grasp_xl.grasp import Grasp, evaluate
from grasp_xl.rules import Rules
from grasp_xl.space import FloatArray, OptionSpace

from .statement import Elements, Statement, statements

TOLERANCE = 1e-6
"""Accuracy of a solver's proof, relative to its grasp's value or, if that is more, the baseline."""

AZIMUTHS, ELEVATIONS = 16, (-1.2, -0.6, 0.0, 0.6, 1.2)
"""Tangents to begin with: directions about the plan, and angles above it (radians)."""


@dataclass(frozen=True, slots=True)
class Answer:
    """A solver's answer for fixed counts, in units of the baseline.

    Parameters
    ----------
    bound : float
        No grasp with these counts is below this, or below the limit that was given.
    used : list of int
        Elements of the best grasp found; empty where none is below the limit.
    """

    bound: float
    used: list[int]


Minimise = Callable[[Statement, FloatArray, float, float], Answer]
"""Given a statement, ``(m, 3)`` unit vectors, a limit on the value, and seconds."""


@dataclass(frozen=True, slots=True)
class PeerProof:
    """What a solver found within its time, and how often it was called.

    ``best`` is the optimum where ``proved``, and then None where no grasp exists.
    """

    best: Grasp | None
    seconds: float
    calls: int
    proved: bool


def prove(space: OptionSpace, rules: Rules, minimise: Minimise, seconds: float) -> PeerProof:
    """Find the best grasp with a general solver, and prove it to ``TOLERANCE``.

    Raises
    ------
    ArithmeticError
        If a grasp breaks a constraint, or comes twice: the solver's tolerances are too wide.
    """
    began = time.perf_counter()
    elements = Elements(space, rules)
    best: Grasp | None = None
    calls = 0
    for statement in statements(space, rules, elements):
        tangents, seen = first_tangents(), set[tuple[int, ...]]()
        bound = statement.constant
        while bound < (limit := _limit(best, rules)):
            left = seconds - (time.perf_counter() - began)
            if left <= 0:
                return PeerProof(best, seconds - left, calls, proved=False)
            answer = minimise(statement, tangents, limit, left)
            calls += 1
            bound = answer.bound
            if not answer.used:
                continue
            grasp = evaluate(space, rules, from_active(space, elements.active(answer.used)))
            if not grasp.feasible or tuple(answer.used) in seen:
                raise ArithmeticError(f"{answer.used} at {bound} breaks a rule, or comes twice")
            seen.add(tuple(answer.used))
            tangents = np.vstack([tangents, tangent(statement, answer.used)])
            best = min(best or grasp, grasp, key=lambda each: each.value)
    return PeerProof(best, time.perf_counter() - began, calls, proved=True)


def _limit(best: Grasp | None, rules: Rules) -> float:
    """Return the value that a grasp must be below to matter, in units of the baseline."""
    if best is None:
        return math.inf
    value = best.value / rules.baseline
    return value - TOLERANCE * max(1.0, value)


def first_tangents() -> FloatArray:
    """Return unit vectors all round, ``(m, 3)``."""
    turn, lift = np.meshgrid(2 * np.pi * np.arange(AZIMUTHS) / AZIMUTHS, ELEVATIONS)
    level = np.cos(lift.ravel())
    return np.column_stack(
        [level * np.cos(turn.ravel()), level * np.sin(turn.ravel()), np.sin(lift.ravel())]
    )


def tangent(statement: Statement, used: list[int]) -> FloatArray:
    """Return the direction of a grasp's pull, ``(3,)``; zeros where it has none."""
    pull: FloatArray = statement.pulls[used].sum(axis=0)
    return pull / max(float(np.linalg.norm(pull)), 1e-300)
