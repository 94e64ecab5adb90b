"""Sheet ``Fitness Table`` (tables 4 and 5)."""

from __future__ import annotations

from grasp_xl.grasp import Grasp, evaluate
from grasp_xl.search.result import Result
from grasp_xl.workbook.layout import FITNESS_TABLE, Area
from grasp_xl.workbook.pen import Pen
from grasp_xl.workbook.proved import ALL_GRASPS, Proved
from grasp_xl.workbook.result_title import write_result_title
from grasp_xl.workbook.styles import Style
from grasp_xl.workbook.table import DASH
from grasp_xl.workbook.written import CellValue

SHORT = {10_000: "Gen: 10k", 50_000: "Gen: 50k"}
COLUMNS = ("Grasp", "FoS", "Cost", "Moment", "Deviation", "Structure", "Divergence")
LOOKS = (
    Style.RATIO,
    Style.DOLLARS,
    Style.NEWTON_MM,
    Style.FINE_MM,
    Style.MM,
    Style.DIVERGENCE,
)
"""Numbers with their units: the labels are the thesis's, and have none."""
BENCHMARK = "Benchmark"


PROOF_COLUMN = len(COLUMNS) + 1
"""First of the two columns of what is proved: beside the table, so that its place is always one."""
WIDTH = PROOF_COLUMN + 2
"""Columns that the sheet fills."""


def write_fitness_table(pen: Pen, result: Result, proved: Proved | None) -> None:
    """Write the fitness of the benchmark, of the fittest at the thesis's generations, of the best.

    Beside it what the exact search says, where somebody asked it.
    """
    write_result_title(pen, "FITNESS TABLE")
    pen.row(2, 0, COLUMNS, Style.HEADER)
    rows = [(BENCHMARK, result.benchmark)]
    for generation in result.report_generations():
        grasp = evaluate(result.space, result.rules, result.at_generation(generation))
        rows.append((generation_label(generation), grasp))
    if result.best:
        rows.append(("Best", result.best))
    if proved and proved.grasp:
        rows.append((proved.label, proved.grasp))
    for row, (label, grasp) in enumerate(rows, 3):
        pen.write(row, 0, label, Style.LABEL)
        _row(pen, row, grasp, with_fitness=grasp.feasible or label == BENCHMARK)
    lines = _write_proof(pen, result, proved) if proved else 0
    pen.sheet.freeze_panes(3, 1)
    pen.widths(0, 17, *[14] * (len(COLUMNS) - 1), 3, 34, 28)
    columns = WIDTH if proved else len(COLUMNS)
    pen.print_pages(Area(FITNESS_TABLE, 0, 0, 3 + max(len(rows), lines), columns))


def generation_label(generation: int) -> str:
    """Return what a row of the table is called."""
    return SHORT.get(generation, f"Gen: {generation}")


def _write_proof(pen: Pen, result: Result, proved: Proved) -> int:
    """Write what is proved, a line each, and return how many they are."""
    proof, best = proved.proof, result.best
    value = proof.designs[0].value if proof.designs else None
    above = None
    if best and value and proved.among == ALL_GRASPS:
        above = max(0.0, best.value / value - 1)
    lines: list[tuple[str, CellValue, Style]] = [
        ("Status", proof.status, Style.RATIO),
        ("Among", proved.among, Style.RATIO),
        ("Ended", proved.ended, Style.RATIO),
        (f"{proved.label} ({result.rules.criterion.name})", value, Style.RESULT),
        ("Bound: no grasp is below", proof.bound, Style.RESULT),
        ("Gap", proof.gap, Style.PERCENT),
        ("Best of the genetic run above it", above, Style.PERCENT),
        ("Time of the exact search (s)", round(proof.seconds, 3), Style.TORQUE),
    ]
    pen.row(2, PROOF_COLUMN, ("Exact search", None), Style.HEADING)
    for row, (label, told, style) in enumerate(lines, 3):
        pen.write(row, PROOF_COLUMN, label, Style.LABEL)
        pen.write(row, PROOF_COLUMN + 1, DASH if told is None else told, style)
    return len(lines)


def _row(pen: Pen, row: int, grasp: Grasp, *, with_fitness: bool) -> None:
    values = (grasp.fos, *grasp.terms, grasp.divergence)
    for column, (style, value) in enumerate(zip(LOOKS, values, strict=True), 1):
        if with_fitness or column == 1:
            pen.write(row, column, value, style)
        else:
            pen.write(row, column, DASH, Style.CENTRED)
