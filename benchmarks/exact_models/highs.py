"""The statement in HiGHS: a mixed-integer linear model."""

from __future__ import annotations

import math
import os
from collections.abc import Sequence

import highspy
import numpy as np

from grasp_xl.space import FloatArray

from .proof import Answer
from .statement import Statement

FEASIBILITY = 1e-9


def minimise(statement: Statement, tangents: FloatArray, below: float, seconds: float) -> Answer:
    """Minimise on all cores."""
    solver = highspy.Highs()
    for name, value in (
        ("output_flag", False),
        ("threads", os.cpu_count() or 1),
        ("time_limit", seconds),
        ("mip_rel_gap", 0.0),
        ("mip_abs_gap", 1e-8),
        ("mip_feasibility_tolerance", FEASIBILITY),
        ("primal_feasibility_tolerance", FEASIBILITY),
    ):
        solver.setOptionValue(name, value)
    solver.passModel(_model(statement, tangents, below))
    solver.run()
    status, info = solver.getModelStatus(), solver.getInfo()
    if status == highspy.HighsModelStatus.kInfeasible:
        return Answer(math.inf, [])
    if status not in (highspy.HighsModelStatus.kOptimal, highspy.HighsModelStatus.kTimeLimit):
        raise ArithmeticError(f"HiGHS ended with {status}")
    used: list[int] = []
    if info.primal_solution_status == highspy.SolutionStatus.kSolutionStatusFeasible:
        values = np.array(solver.getSolution().col_value[: len(statement.pulls)])
        used = np.flatnonzero(values > 0.5).tolist()
    return Answer(info.mip_dual_bound, used)


def _model(statement: Statement, tangents: FloatArray, below: float) -> highspy.HighsLp:
    places = range(len(statement.pulls))
    offset, prices = statement.constant, np.array(statement.prices)
    rows: list[tuple[Sequence[int], Sequence[float], float | None, float | None]] = [
        (row.variables, row.coefficients, row.low, row.high) for row in statement.rows
    ]
    rows += [
        ([statement.moment, *places], [1.0, *(-pull for pull in pulls)], 0.0, None)
        for pulls in (tangents @ statement.pulls.T).tolist()
    ]
    if below < math.inf:
        rows.append((range(len(prices)), prices.tolist(), None, below - offset))
    upper = np.array(statement.upper, dtype=np.float64)
    upper[statement.moment] = math.inf
    model = highspy.HighsLp()
    model.num_col_, model.num_row_ = len(prices), len(rows)
    model.offset_ = offset
    model.col_cost_ = prices
    model.col_lower_ = np.zeros(len(prices))
    model.col_upper_ = upper
    model.integrality_ = [
        highspy.HighsVarType.kInteger if whole else highspy.HighsVarType.kContinuous
        for whole in statement.whole
    ]
    model.row_lower_ = np.array([-math.inf if row[2] is None else row[2] for row in rows])
    model.row_upper_ = np.array([math.inf if row[3] is None else row[3] for row in rows])
    model.a_matrix_.format_ = highspy.MatrixFormat.kRowwise
    model.a_matrix_.start_ = np.cumsum([0] + [len(row[0]) for row in rows])
    model.a_matrix_.index_ = np.concatenate([row[0] for row in rows]).astype(np.int32)
    model.a_matrix_.value_ = np.concatenate([row[1] for row in rows]).astype(np.float64)
    return model
