"""The statement in OR-Tools CP-SAT: all numbers are integers.

The value is counted in parts of 1e-9 of the baseline.  Prices and tangents are rounded down, so the
solver's bound is a bound still; a grasp of ten elements loses less than 1e-7 of the baseline.
"""

from __future__ import annotations

import math
import os

import numpy as np
from ortools.sat.python import cp_model

from grasp_xl.space import FloatArray

from .proof import Answer
from .statement import Statement

UNITS = 1e9
MOST = 1 << 50
"""Upper limit of the moment term, in units."""


def minimise(statement: Statement, tangents: FloatArray, below: float, seconds: float) -> Answer:
    """Minimise on all cores."""
    model = cp_model.CpModel()
    variables = [
        model.new_int_var(0, MOST if number == statement.moment else upper, "")
        for number, upper in enumerate(statement.upper)
    ]

    def total(numbers: list[int], coefficients: list[int]) -> cp_model.LinearExpr:
        return cp_model.LinearExpr.weighted_sum([variables[n] for n in numbers], coefficients)

    for row in statement.rows:
        low = -MOST if row.low is None else row.low
        high = MOST if row.high is None else row.high
        model.add_linear_constraint(total(row.variables, row.coefficients), low, high)
    places = list(range(len(statement.pulls)))
    for unit in tangents:
        pulls = _units(statement.pulls @ unit)
        model.add(variables[statement.moment] >= total(places, pulls))
    prices = _units(np.array(statement.prices))
    prices[statement.moment] = 1
    value = total(list(range(len(prices))), prices)
    offset = math.floor(statement.constant * UNITS)
    if below < math.inf:
        model.add(value <= math.ceil(below * UNITS) - offset)
    model.minimize(value)

    solver = cp_model.CpSolver()
    solver.parameters.num_workers = os.cpu_count() or 1
    solver.parameters.max_time_in_seconds = seconds
    status = solver.solve(model)
    if status == cp_model.INFEASIBLE:
        return Answer(math.inf, [])
    if status == cp_model.MODEL_INVALID:
        raise ArithmeticError(model.validate())
    found = status in (cp_model.OPTIMAL, cp_model.FEASIBLE)
    used = [place for place in places if found and solver.value(variables[place])]
    return Answer((solver.best_objective_bound + offset) / UNITS, used)


def _units(values: FloatArray) -> list[int]:
    """Count in units, rounded down."""
    return [math.floor(value * UNITS) for value in values.tolist()]
