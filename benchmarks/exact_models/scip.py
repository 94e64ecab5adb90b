"""The statement in SCIP, with the cone of the moment as it is; the tangents are valid rows."""

from __future__ import annotations

import math

from pyscipopt import Model, quicksum

from grasp_xl.space import FloatArray

from .proof import Answer
from .statement import Statement

FEASIBILITY = 1e-9


def minimise(statement: Statement, tangents: FloatArray, below: float, seconds: float) -> Answer:
    """Minimise on one core: SCIP has no parallel tree search in its wheel."""
    model = Model()
    model.hideOutput()
    model.setParam("limits/time", seconds)
    model.setParam("limits/absgap", 1e-8)
    model.setParam("numerics/feastol", FEASIBILITY)
    variables = [
        model.addVar(
            vtype="I" if whole else "C",
            lb=0.0,
            ub=None if number == statement.moment else upper,
        )
        for number, (upper, whole) in enumerate(zip(statement.upper, statement.whole, strict=True))
    ]
    for row in statement.rows:
        total = quicksum(
            factor * variables[n] for n, factor in zip(row.variables, row.coefficients, strict=True)
        )
        if row.low is not None:
            model.addCons(total >= row.low)
        if row.high is not None:
            model.addCons(total <= row.high)
    moment, places = variables[statement.moment], variables[: len(statement.pulls)]
    for pulls in (tangents @ statement.pulls.T).tolist():
        model.addCons(moment >= quicksum(p * x for p, x in zip(pulls, places, strict=True)))
    parts = [model.addVar(lb=None) for _ in range(3)]
    for part, pulls in zip(parts, statement.pulls.T.tolist(), strict=True):
        model.addCons(part == quicksum(p * x for p, x in zip(pulls, places, strict=True)))
    model.addCons(quicksum(part * part for part in parts) <= moment * moment)
    model.setObjective(
        quicksum(price * x for price, x in zip(statement.prices, variables, strict=True) if price)
        + statement.constant
    )
    if below < math.inf:
        model.setObjlimit(below)

    model.optimize()
    if model.getStatus() == "infeasible":
        return Answer(math.inf, [])
    found = model.getNSols() > 0
    used = [n for n, x in enumerate(places) if found and model.getVal(x) > 0.5]
    return Answer(model.getDualbound(), used)
