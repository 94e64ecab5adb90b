"""Sheet ``Run Log``: what was run, on what, when, and all that ``--continue`` needs."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from datetime import datetime

from grasp_xl import __version__
from grasp_xl.chromosome import Chromosome
from grasp_xl.search.result import Result
from grasp_xl.task import Task
from grasp_xl.workbook.designs_sheet import MAX_DESIGNS
from grasp_xl.workbook.history_sheet import MAX_HISTORY
from grasp_xl.workbook.layout import RUN_LOG, Area
from grasp_xl.workbook.pen import ROW_HEIGHT, CellValue, Pen
from grasp_xl.workbook.styles import Style

INPUTS_HASH = "InputsHash"
RANDOM_STATE = "RandomState"
GENERATIONS_DONE = "GenerationsDone"
EVALUATIONS = "Evaluations"
BEST_GRASP = "BestGrasp"
BEST_FOUND_AT = "BestFoundAt"
STOP_REASON = "StopReason"
DESIGNS_FOUND = "ValidDesignsFound"
WHAT_IF_WRITTEN = "WhatIfWritten"
"""What-if genes as we wrote them, by which a designer's typing is told apart."""

ASSIGNED_WRITTEN = "AssignedWritten"
"""Benchmark that the program assigned, by which a designer's typing over it is told apart."""

VALUE_WIDTH = 90
"""Width of the column of values: at least as many characters to a line."""


@dataclass(frozen=True, slots=True)
class Origin:
    """Where a result comes from: input file name, its SHA-256, start and end of the run."""

    name: str
    sha256: str
    started: datetime
    ended: datetime


def genes_text(chromosome: Chromosome | None) -> str:
    """Return genes as one line of text, empty for none."""
    return json.dumps(chromosome.genes.tolist()) if chromosome else ""


def write_run_log(
    pen: Pen, task: Task, result: Result, origin: Origin, what_if: Chromosome
) -> None:
    """Write the sheet: a label, a value, and for some a defined name."""
    state, best = result.state, result.best
    assigned = task.benchmark.chromosome if task.assigned else None
    interrupted = " (INTERRUPTED: best so far)" if result.stop_reason == "interrupted" else ""
    rows: list[tuple[str, CellValue | datetime, str]] = [
        ("Program", f"grasp_xl {__version__}", ""),
        ("Input file", origin.name, ""),
        ("Input SHA-256", origin.sha256, ""),
        ("Hash of the inputs used", task.inputs_hash, INPUTS_HASH),
        ("Started", origin.started, ""),
        ("Ended", origin.ended, ""),
        ("Seconds of search", round(result.seconds, 3), ""),
        ("Generations done", state.generation, GENERATIONS_DONE),
        ("Evaluations", state.evaluations, EVALUATIONS),
        ("Stop reason", f"{result.stop_reason}{interrupted}", STOP_REASON),
        ("Seed", task.settings.seed, ""),
        ("Best value", best.value if best else "none found", ""),
        ("Best criterion", task.rules.criterion.name, ""),
        ("Best found at generation", state.improved_at if best else None, BEST_FOUND_AT),
        ("Best grasp (genes)", genes_text(state.best), BEST_GRASP),
        ("What-if card as written (genes)", genes_text(what_if), WHAT_IF_WRITTEN),
        ("Assigned benchmark as written (genes)", genes_text(assigned), ASSIGNED_WRITTEN),
        ("Valid designs found", state.earlier_designs + len(state.designs), DESIGNS_FOUND),
        ("Valid designs listed", min(len(state.designs), MAX_DESIGNS), ""),
        ("Changes listed in the history", min(len(state.changes), MAX_HISTORY), ""),
        ("State of the random stream", state.random_state, RANDOM_STATE),
        ("Exact bound", None, ""),
        ("Exact gap", None, ""),
    ]
    rows += [("Warning", str(warning), "") for warning in task.warnings]
    pen.write(0, 0, "RUN LOG", Style.TITLE)
    for row, (label, value, name) in enumerate(rows, 2):
        pen.write(row, 0, label, Style.LABEL)
        if isinstance(value, datetime):
            pen.date(row, 1, value)
        else:
            _write_value(pen, row, value)
        if name:
            pen.name_area(name, Area(RUN_LOG, row, 1))
    row = len(rows) + 3
    pen.write(row, 0, "Parameters", Style.HEADING)
    for label, value in parameter_rows(task):
        row += 1
        pen.write(row, 0, label, Style.LABEL)
        _write_value(pen, row, value)
    pen.widths(0, 32, VALUE_WIDTH)
    pen.print_pages(pictures=[Area(RUN_LOG, 0, 0, row + 1, 2)])


def _write_value(pen: Pen, row: int, value: CellValue) -> None:
    """Write a value, and make its row as high as its text needs."""
    pen.write(row, 1, value, Style.LOGGED)
    lines = math.ceil(len(str(value)) / VALUE_WIDTH)
    if lines > 1:  # and one more, since lines break at spaces
        pen.sheet.set_row(row, (1 + lines) * ROW_HEIGHT)


def parameter_rows(task: Task) -> list[tuple[str, CellValue]]:
    """Return the settled parameters, as label and value."""
    need, goals = task.rules.requirements, task.rules.goals
    return [
        ("User-defined start", int(task.settings.user_start)),
        ("Benchmark", "program-assigned" if task.assigned else "user-defined"),
        ("Elitism", int(task.settings.elitism)),
        ("1-in-n mutation", task.settings.one_in),
        ("Children per generation", task.settings.children),
        ("Generations asked for", task.generations),
        ("FoS goal", need.fos),
        ("Minimum distance (mm)", need.clearance_mm),
        ("Density ratio", need.density_ratio),
        ("Moment arm", need.moment_arm),
        ("Criterion", task.rules.criterion.name),
        *((f"Goal: {term}", value) for term, value in goals.base._asdict().items()),
        ("Terms left out", ", ".join(sorted(goals.dropped)) or "none"),
    ]
