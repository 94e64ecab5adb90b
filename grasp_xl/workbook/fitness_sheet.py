"""Sheet ``Fitness Table`` (tables 4 and 5)."""

from __future__ import annotations

from grasp_xl.grasp import Grasp, evaluate
from grasp_xl.search.result import Result
from grasp_xl.workbook.layout import FITNESS_TABLE, Area
from grasp_xl.workbook.pen import Pen
from grasp_xl.workbook.styles import Style
from grasp_xl.workbook.table import DASH

LABELS = {10_000: "Gen: 10k", 50_000: "Gen: 50k"}
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


def write_fitness_table(pen: Pen, result: Result) -> None:
    """Write the fitness of the benchmark, and of the fittest at the thesis's generations."""
    pen.write(0, 0, "FITNESS TABLE", Style.TITLE)
    pen.row(2, 0, COLUMNS, Style.HEADER)
    rows = [(BENCHMARK, result.benchmark)]
    for generation in result.report_generations():
        grasp = evaluate(result.space, result.rules, result.at_generation(generation))
        rows.append((LABELS.get(generation, f"Gen: {generation}"), grasp))
    if result.best:
        rows.append(("Best", result.best))
    for row, (label, grasp) in enumerate(rows, 3):
        pen.write(row, 0, label, Style.LABEL)
        _row(pen, row, grasp, with_fitness=grasp.feasible or label == BENCHMARK)
    pen.sheet.freeze_panes(3, 1)
    pen.widths(0, *[14] * len(COLUMNS))
    pen.print_pages(Area(FITNESS_TABLE, 0, 0, 3 + len(rows), len(COLUMNS)))


def _row(pen: Pen, row: int, grasp: Grasp, *, with_fitness: bool) -> None:
    values = (grasp.fos, *grasp.terms, grasp.divergence)
    for column, (style, value) in enumerate(zip(LOOKS, values, strict=True), 1):
        if with_fitness or column == 1:
            pen.write(row, column, value, style)
        else:
            pen.write(row, column, DASH, Style.CENTRED)
