"""Sheet ``Summary`` of a study: what was run, a row a case, and the answers."""

from __future__ import annotations

from collections.abc import Iterator

from grasp_xl.study.plan import SCENARIOS
from grasp_xl.study.summary import WORDS, Look, Study, answers, columns, rows
from grasp_xl.workbook.layout import Area
from grasp_xl.workbook.pen import ROW_HEIGHT, Pen
from grasp_xl.workbook.styles import Style
from grasp_xl.workbook.table import DASH
from grasp_xl.workbook.written import CellValue

FIRST_ROW = 2
STYLES: dict[Look, Style] = {
    "text": Style.TEXT,
    "count": Style.COUNT,
    "value": Style.RATIO,
    "percent": Style.PERCENT,
    "ratio": Style.RATIO,
}
CASE_WIDTH, WIDTH = 34, 13
LINE_LETTERS = 150
"""Letters that a line of an answer holds, over all columns."""
MOST_HEIGHT = 409.0
"""Of a row, in Excel (points)."""


def write_summary(pen: Pen, study: Study) -> None:
    """Write the sheet."""
    pen.write(0, 0, "STUDY", Style.TITLE)
    row = FIRST_ROW
    for label, value in _facts(study):
        pen.write(row, 0, label, Style.LABEL)
        pen.write(row, 1, value, Style.LOGGED)
        row += 1
    row += 1
    shown = columns(study)
    pen.row(row, 0, [column.title for column in shown], Style.STACKED_HEADER)
    pen.sheet.set_row(row, 3 * ROW_HEIGHT)
    for values in rows(study):
        row += 1
        for number, (column, value) in enumerate(zip(shown, values, strict=True)):
            look = Style.CENTRED if value is None else STYLES[column.look]
            pen.write(row, number, DASH if value is None else value, look)
    row += 2
    for answer in answers(study):
        place = Area(pen.name, row, 0, 1, len(shown))
        pen.span(place, answer.question, Style.HEADING)
        told = Area(pen.name, row + 1, 0, 1, len(shown))
        pen.span(told, answer.answer, Style.LOGGED)
        lines = sum(1 + len(line) // LINE_LETTERS for line in answer.answer.splitlines())
        pen.sheet.set_row(row + 1, min(MOST_HEIGHT, (1 + lines) * ROW_HEIGHT))
        row += 3
    pen.fix_row_heights()
    pen.widths(0, CASE_WIDTH, 19, *[WIDTH] * (len(shown) - 2))
    pen.print_pages(Area(pen.name, 0, 0, row, len(shown)))


def _facts(study: Study) -> Iterator[tuple[str, CellValue]]:
    """Give what was run."""
    plan = study.plan
    yield "Cases", len(plan.cases)
    for number, scenario in enumerate(SCENARIOS, 1):
        if scenario in plan.scenarios:
            yield f"S{number}", WORDS[scenario]
    yield "Runs of each start", plan.runs
    yield "Seed", plan.seed
    generations = sorted({case.task.generations for case in plan.cases})
    yield "Generations", ", ".join(f"{each:,}" for each in generations)
    if not study.complete:
        yield "Not done", f"{len(plan) - study.done:,} of {len(plan):,} runs; see --resume"
