"""Sheet of a case: six charts with all its runs (figures 42 to 47), and in which grasps they ended.

The table below the charts has what figures 64 to 66 show: runs that ended in the same grasp, or in
a mirror image.
"""

from __future__ import annotations

from typing import Any

from grasp_xl.chromosome import BLANK_GENE
from grasp_xl.study.course_data import Courses
from grasp_xl.study.outcome import CaseOutcome, Ending
from grasp_xl.workbook.course_chart import CHART_COLUMNS, CHART_ROWS, course_chart
from grasp_xl.workbook.layout import Area
from grasp_xl.workbook.pen import Pen
from grasp_xl.workbook.styles import Style
from grasp_xl.workbook.table import CRITERIA, NO, YES, gene_labels, gene_styles, shown_gene
from grasp_xl.workbook.written import CellValue

CHART_ROW = 2
TABLE_ROW = CHART_ROW + 3 * CHART_ROWS + 2
MOST_ENDINGS = 200
"""Grasps that are listed, best first."""
MOST_LABELS = 12
"""Runs that are named beside a grasp; the others are counted."""
WIDTHS = (8.0, 14.0, 7.0, 11.0, 10.0)


def write_case(pen: Pen, book: Any, case: CaseOutcome, courses: Courses) -> None:  # noqa: ANN401 (untyped library)
    """Write the sheet."""
    pen.write(0, 0, case.case.title, Style.TITLE)
    for number, (_, title, unit, _) in enumerate(CRITERIA):
        chart = course_chart(book, title, unit, courses.lines(number))
        row = CHART_ROW + CHART_ROWS * (number // 2)
        pen.insert_chart(row, CHART_COLUMNS // 2 * (number % 2), chart)
    genes = gene_labels(case.case.task.space)
    labels = ["Grasp", "Image", "Runs", "Divergence", "Optimum", *genes, "Which runs"]
    pen.write(TABLE_ROW - 1, 0, f"CONVERGENCE: {case.convergence}", Style.TITLE)
    pen.row(TABLE_ROW, 0, labels, Style.STACKED_HEADER)
    endings = case.endings[:MOST_ENDINGS]
    for row, ending in enumerate(endings, TABLE_ROW + 1):
        _write_ending(pen, row, case, ending)
    rows = len(endings)
    if len(case.endings) > rows:
        told = f"{len(case.endings) - rows:,} more grasps are not listed here; see the sheet Runs"
        pen.write(TABLE_ROW + 1 + rows, 0, told, Style.NOTE)
        rows += 1
    pen.fix_row_heights()
    pen.widths(0, *WIDTHS, *[6.3] * len(genes), 60)
    charts = Area(pen.name, 0, 0, CHART_ROW + 3 * CHART_ROWS, CHART_COLUMNS)
    listed = Area(pen.name, TABLE_ROW - 1, 0, 2 + rows, len(labels))
    pen.print_pages(listed, pictures=[charts])


def _write_ending(pen: Pen, row: int, case: CaseOutcome, ending: Ending) -> None:
    grasp, space = ending.grasp, case.case.task.space
    optimum = (YES if ending.optimal else NO) if case.optimum is not None else "-"
    cells: list[tuple[CellValue, Style]] = [
        (ending.number, Style.MARK),
        (ending.relation or "-", Style.CENTRED),
        (len(ending.outcomes), Style.COUNT),
        (grasp.divergence, Style.DIVERGENCE),
        (optimum, Style.CENTRED),
    ]
    genes = zip(grasp.chromosome.genes.ravel().tolist(), gene_labels(space), strict=True)
    shown = [None if gene == BLANK_GENE else shown_gene(label, gene) for gene, label in genes]
    cells += list(zip(shown, gene_styles(space), strict=True))
    for column, (value, style) in enumerate([*cells, (ending.told(MOST_LABELS), Style.TEXT)]):
        pen.write(row, column, value, style)
