"""Sheet ``History`` with its six charts (figures 42 to 47)."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import numpy as np

from grasp_xl.search.result import Result, Rows, gene_columns
from grasp_xl.workbook.course_chart import (
    CHART_COLUMNS,
    CHART_ROWS,
    COURSE,
    DASHED,
    PROVED_LINE,
    Line,
    course_chart,
)
from grasp_xl.workbook.layout import HISTORY, HISTORY_ROW, KINDS, Area
from grasp_xl.workbook.pen import Pen
from grasp_xl.workbook.proved import NOT_PROVED, PROVED_BOUND, Proved, charted
from grasp_xl.workbook.result_title import write_result_title
from grasp_xl.workbook.styles import Style
from grasp_xl.workbook.table import (
    CRITERIA,
    CRITERIA_WIDTHS,
    GENE_WIDTH,
    GENERATION_WIDTH,
    add_table,
    gene_labels,
    gene_styles,
    shown_gene,
    shown_number,
)

MAX_HISTORY = 100_000
"""Changes that the sheet lists; beyond that, the newest and the fitness table's generations."""

MAX_STEPS = 1_000
"""Changes that the charts draw: evenly chosen on their logarithmic axis.

The charts' ranges have room for as many, so that a run in an open workbook need not touch them.
"""

DRAWN_DIGITS = 6
"""Decimals of what charts draw: else an axis might show only the rounding of equal values."""


def write_history(
    pen: Pen,
    book: Any,  # noqa: ANN401 (untyped library)
    result: Result,
    proved: Proved | None,
) -> None:
    """Write the generations where the fittest changed, the first and the last, and the charts."""
    history = _listed(result)
    genes = gene_columns(result.space)
    labels = ["Generation", *(label for _, _, label, _ in CRITERIA), *gene_labels(result.space)]
    write_result_title(pen, "HISTORY: the generations where the fittest grasp changed")
    looks = (Style.COUNT, *(style for _, _, _, style in CRITERIA), *gene_styles(result.space))
    columns = ["generation", *(name for name, _, _, _ in CRITERIA), *genes]
    for row, values in enumerate(history[columns].tolist(), HISTORY_ROW + 1):
        for number, (name, value, style) in enumerate(zip(columns, values, looks, strict=True)):
            shown = shown_gene(name, value) if name in genes else shown_number(value)
            pen.write(row, number, shown, style)
    rows = max(1, len(history))
    add_table(pen, "History", Area(HISTORY, HISTORY_ROW, 0, 1 + rows, len(labels)), labels)
    left = len(labels) + CHART_COLUMNS + 2
    steps = _steps(pen, history, left)
    grasp = result.benchmark
    own = [grasp.fos, *grasp.terms, grasp.divergence]
    benchmark = _level(pen, "Benchmark", own, left + steps.columns + 1, result)
    best = _proved_lines(pen, result, proved, benchmark.column + benchmark.columns + 1)
    for number, (_, title, unit, _) in enumerate(CRITERIA, 1):
        lines = [
            Line("Fittest", *_column(steps, number), COURSE),
            Line("Benchmark", *_column(benchmark, number), DASHED),
        ]
        chart = course_chart(book, title, unit, [*lines, best[number - 1]])
        row = HISTORY_ROW + 1 + CHART_ROWS * ((number - 1) // 2)
        column = len(labels) + 1 + CHART_COLUMNS // 2 * ((number - 1) % 2)
        pen.insert_chart(row, column, chart)
    pen.fix_row_heights()
    pen.sheet.freeze_panes(HISTORY_ROW + 1, 1)
    pen.widths(0, GENERATION_WIDTH, *CRITERIA_WIDTHS, *[GENE_WIDTH] * len(genes))
    listed = Area(HISTORY, 0, 0, HISTORY_ROW + 1 + rows, len(labels))
    charts = Area(HISTORY, HISTORY_ROW + 1, len(labels) + 1, 3 * CHART_ROWS, CHART_COLUMNS)
    pages = pen.list_pages(listed, HISTORY_ROW, [labels.index(each.row_label) for each in KINDS])
    pen.print_pages(*pages, pictures=[charts])


def _listed(result: Result) -> Rows:
    """Return the newest rows of the history, and those of the fittest of a reported generation."""
    history = result.history_rows
    if len(history) <= MAX_HISTORY:
        return history
    generations, reported = history["generation"], result.report_generations()
    needed = np.searchsorted(generations, reported, side="right") - 1
    newest = np.arange(_first_newest(result), len(history))
    return history[np.union1d(needed, newest)]


def _first_newest(result: Result) -> int:
    """Return the row of the history from which on the sheet lists all."""
    room = MAX_HISTORY - len(result.report_generations())
    rows = len(result.history_rows)
    return rows - room if rows > MAX_HISTORY else 0


def listed_from(result: Result) -> int:
    """Return the generation from which the sheet lists every change."""
    first = _first_newest(result)
    generations = result.history_rows["generation"]
    return max(result.state.complete_from, int(generations[first]) if first else 1)


def _steps(pen: Pen, history: Rows, left: int) -> Area:
    """Write the course as steps: each value also at the generation before the next change."""
    shown = history
    if len(history) > MAX_STEPS:
        logs = np.log(history["generation"])
        wanted = np.linspace(logs[0], logs[-1], MAX_STEPS)
        shown = history[np.unique(np.searchsorted(logs, wanted))]
    names = [name for name, _, _, _ in CRITERIA]
    rows = np.column_stack([shown[name] for name in ("generation", *names)])
    points = [rows[0]] if len(rows) else []
    for before, after in pairwise(rows):
        points += [np.array([after[0], *before[1:]]), after]
    header = ("Course", *(title for _, title, _, _ in CRITERIA))
    pen.row(HISTORY_ROW, left, header, Style.HEADER)
    for row, point in enumerate(points, HISTORY_ROW + 1):
        for number, value in enumerate(point.tolist()):
            if value == value:  # noqa: PLR0124 (no cell where the grasp has no fitness)
                pen.write(row, left + number, round(value, DRAWN_DIGITS), Style.DRAWN)
    return Area(HISTORY, HISTORY_ROW + 1, left, 2 * MAX_STEPS, len(header))


def _level(pen: Pen, label: str, values: Sequence[float | None], left: int, result: Result) -> Area:
    """Write values that no generation changes, at both ends of the generation axis."""
    drawn = [None if value is None else round(value, DRAWN_DIGITS) for value in values]
    header = (label, *(title for _, title, _, _ in CRITERIA))
    pen.row(HISTORY_ROW, left, header, Style.HEADER)
    for offset, generation in enumerate((1, max(10, result.state.generation)), 1):
        pen.row(HISTORY_ROW + offset, left, (generation, *drawn), Style.DRAWN)
    return Area(HISTORY, HISTORY_ROW + 1, left, 2, len(header))


def _proved_lines(pen: Pen, result: Result, proved: Proved | None, left: int) -> list[Line]:
    """Write what the exact search says, and return its line for each chart.

    That is the value of its grasp; of what is minimised, as long as the grasp is not proved to be
    the best, the bound.  Without a grasp there is a line without points.
    """
    grasp = proved.grasp if proved else None
    label = proved.label if proved else NOT_PROVED
    values: list[float | None] = [None] * len(CRITERIA)
    names = [label if grasp else NOT_PROVED] * len(CRITERIA)
    if grasp:
        values = [grasp.fos, *grasp.terms, grasp.divergence]
    minimised = charted(result.rules.criterion)
    if proved and minimised is not None and proved.proof.status != "optimal":
        values[minimised], names[minimised] = proved.proof.bound, PROVED_BOUND
    area = _level(pen, label, values, left, result)
    behind = area.row + area.rows
    pen.row(behind, left, ("Legend", *names), Style.CENTRED)
    return [
        Line([HISTORY, behind, left + number], *_column(area, number), PROVED_LINE)
        for number in range(1, 1 + len(CRITERIA))
    ]


def _column(area: Area, number: int) -> tuple[list[Any], list[Any]]:
    """Return the generations and one column of an area, as a chart takes them."""
    last = area.row + area.rows - 1
    return (
        [area.sheet, area.row, area.column, last, area.column],
        [area.sheet, area.row, area.column + number, last, area.column + number],
    )
