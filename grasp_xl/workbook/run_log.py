"""Sheet ``Run Log``: what was run, on what, when, and all that ``--continue`` needs."""

from __future__ import annotations

import math
from dataclasses import dataclass
from datetime import datetime

from grasp_xl import __version__
from grasp_xl.chromosome import Chromosome
from grasp_xl.search.result import Result
from grasp_xl.task import Task
from grasp_xl.workbook.carrying import NOTHING_ASIDE, SetAside
from grasp_xl.workbook.history_sheet import MAX_HISTORY, listed_from
from grasp_xl.workbook.inputs import (
    BENCHMARK_GENES,
    genes_text,
    inputs_hash,
    parameter_rows,
    space_rows,
)
from grasp_xl.workbook.layout import MAX_DESIGNS, RUN_LOG, Area
from grasp_xl.workbook.pen import ROW_HEIGHT, Pen
from grasp_xl.workbook.proved import NOT_PROVED, Proved
from grasp_xl.workbook.styles import Style
from grasp_xl.workbook.written import CellValue

INPUTS_HASH = "InputsHash"
RANDOM_STATE = "RandomState"
GENERATIONS_DONE = "GenerationsDone"
EVALUATIONS = "Evaluations"
BEST_GRASP = "BestGrasp"
BEST_FOUND_AT = "BestFoundAt"
STOP_REASON = "StopReason"
DESIGNS_FOUND = "ValidDesignsFound"
HISTORY_FROM = "HistoryFrom"
WHAT_IF_WRITTEN = "WhatIfWritten"
"""Genes that our formulas on the What-if card show while no design is picked."""

BENCHMARK_WRITTEN = "BenchmarkWritten"
"""The benchmark's genes as we wrote them, by which typing over an assigned one is told apart."""

USER_SET_ASIDE = "UserSetAside"
WHAT_IF_SET_ASIDE = "WhatIfSetAside"
"""Genes of a designer that the option space does not have, by which a later one gets them back."""

PROOF_STATUS = "ProofStatus"
PROOF_BOUND = "ProofBound"
PROOF_SECONDS = "ProofSeconds"
PROOF_AMONG = "ProofAmong"
PROOF_ENDED = "ProofEnded"
PROVED_GRASP = "ProvedGrasp"
PROOF_TITLE = "ProofTitle"
"""Title of the exact search's card."""
TRADE_OFFS_HASH = "TradeOffsHash"
"""Hash of the trade-offs as we wrote them, by which edited ones are told apart."""

WIDTH = 2
"""Columns that the sheet fills: labels and values."""

LABEL_WIDTH = 40
"""Width of the column of labels: as much as the longest takes."""
VALUE_WIDTH = 90
"""Width of the column of values: at least as many characters to a line."""


@dataclass(frozen=True, slots=True)
class Origin:
    """Where a result comes from: input file name, its SHA-256, start and end of the run."""

    name: str
    sha256: str
    started: datetime
    ended: datetime


Row = tuple[str, CellValue | datetime, str]
"""Label, value, and defined name of the value if it has one."""


def write_run_log(
    pen: Pen,
    task: Task,
    result: Result,
    origin: Origin,
    what_if: Chromosome,
    proved: Proved | None,
    set_aside: SetAside = NOTHING_ASIDE,
    trade_offs: str = "",
) -> None:
    """Write the sheet: a label, a value, and for some a defined name.

    ``trade_offs`` is the hash of the list of trade-offs, where there is one.
    """
    state, best = result.state, result.best
    interrupted = " (INTERRUPTED: best so far)" if result.stop_reason == "interrupted" else ""
    rows: list[Row] = [
        ("Program", f"grasp_xl {__version__}", ""),
        ("Input file", origin.name, ""),
        ("Input SHA-256", origin.sha256, ""),
        ("Hash of the inputs used", inputs_hash(task), INPUTS_HASH),
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
        (BENCHMARK_GENES, genes_text(task.benchmark.chromosome), BENCHMARK_WRITTEN),
        ("User-defined genes set aside", genes_text(set_aside.user), USER_SET_ASIDE),
        ("What-if genes set aside", genes_text(set_aside.what_if), WHAT_IF_SET_ASIDE),
        ("Valid designs found", state.earlier_designs + len(state.designs), DESIGNS_FOUND),
        ("Valid designs listed", min(len(state.designs), MAX_DESIGNS), ""),
        ("Changes listed in the history", min(len(state.changes), MAX_HISTORY), ""),
        ("History lists all from generation", listed_from(result), HISTORY_FROM),
        ("State of the random stream", state.random_state, RANDOM_STATE),
        *_proof_rows(proved),
    ]
    if trade_offs:
        rows.append(("Hash of the trade-offs", trade_offs, TRADE_OFFS_HASH))
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
    inputs = len(rows) + 3
    pen.write(inputs, 0, "Parameters", Style.HEADING)
    row = _write_inputs(pen, inputs + 1, parameter_rows(task)) + 1
    pen.write(row, 0, "Option space (lists: hashes)", Style.HEADING)
    row = _write_inputs(pen, row + 1, space_rows(task.space))
    pen.widths(0, LABEL_WIDTH, VALUE_WIDTH)
    pages = [Area(RUN_LOG, 0, 0, inputs - 1, WIDTH), Area(RUN_LOG, inputs, 0, row - inputs, WIDTH)]
    pen.print_pages(pictures=pages)


def _proof_rows(proved: Proved | None) -> list[Row]:
    """Return what the exact search says; empty values where nobody asked it."""
    proof = proved.proof if proved else None
    grasp = proved.grasp if proved else None
    return [
        ("Exact search", proved.title if proved else NOT_PROVED, PROOF_TITLE),
        ("Exact status", proof.status if proof else None, PROOF_STATUS),
        ("Exact search among", proved.among if proved else None, PROOF_AMONG),
        ("Exact search ended", proved.ended if proved else None, PROOF_ENDED),
        ("Exact grasp (genes)", genes_text(grasp.chromosome) if grasp else None, PROVED_GRASP),
        ("Exact value", grasp.value if grasp else None, ""),
        ("Exact bound", proof.bound if proof else None, PROOF_BOUND),
        ("Exact gap", proof.gap if proof else None, ""),
        ("Seconds of exact search", round(proof.seconds, 3) if proof else None, PROOF_SECONDS),
    ]


def _write_inputs(pen: Pen, row: int, inputs: dict[str, CellValue]) -> int:
    """Write labels and values from a row on, and return the row behind them."""
    for label, value in inputs.items():
        pen.write(row, 0, label, Style.LABEL)
        _write_value(pen, row, value)
        row += 1
    return row


def _write_value(pen: Pen, row: int, value: CellValue) -> None:
    """Write a value, and make its row as high as its text needs."""
    pen.write(row, 1, value, Style.LOGGED)
    lines = math.ceil(len(str(value)) / VALUE_WIDTH)
    if lines > 1:  # and one more, since lines break at spaces
        pen.sheet.set_row(row, (1 + lines) * ROW_HEIGHT)
