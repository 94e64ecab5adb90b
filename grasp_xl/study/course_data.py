"""Sheet with the courses that a case's charts draw: run below run, an empty row between them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import groupby
from typing import Any

from grasp_xl.study.outcome import FEW_RUNS, CaseOutcome, Level, Outcome, evenly
from grasp_xl.study.summary import WORDS
from grasp_xl.workbook.course_chart import DASHED, PROVED_LINE, Line
from grasp_xl.workbook.layout import Area
from grasp_xl.workbook.pen import Pen
from grasp_xl.workbook.styles import SEQUENCE, Style
from grasp_xl.workbook.table import CRITERIA

HEADER_ROW = 2
RUN_COLUMN, GENERATION_COLUMN, FIRST_COLUMN = 0, 1, 2
COLUMNS = FIRST_COLUMN + len(CRITERIA)
WIDE, NARROW = 1.5, 0.75
"""Widths of lines: of few runs, and of many."""
LEVEL_ROWS = 3
"""Rows of a level: both ends of the axis, and an empty one."""


@dataclass(frozen=True, slots=True)
class _Block:
    """Rows of the sheet that are one line of each chart."""

    name: str
    first: int
    last: int
    look: dict[str, Any]


@dataclass(frozen=True, slots=True)
class Courses:
    """The lines of a case's charts.

    Parameters
    ----------
    sheet : str
    blocks : tuple of _Block
    """

    sheet: str
    blocks: tuple[_Block, ...]

    def lines(self, criterion: int) -> list[Line]:
        """Return the lines of one of ``CRITERIA``."""
        column = FIRST_COLUMN + criterion
        return [
            Line(
                block.name,
                [self.sheet, block.first, GENERATION_COLUMN, block.last, GENERATION_COLUMN],
                [self.sheet, block.first, column, block.last, column],
                block.look,
            )
            for block in self.blocks
        ]


def write_courses(pen: Pen, case: CaseOutcome) -> Courses:
    """Write the sheet, and return where its lines stand: one a run, or one a start if many."""
    pen.write(0, 0, f"{case.case.title}: the fittest of the runs that are drawn", Style.TITLE)
    labels = ["Run", "Generation", *(label for _, _, label, _ in CRITERIA)]
    pen.row(HEADER_ROW, 0, labels, Style.HEADER)
    row = HEADER_ROW + 1
    blocks = []
    few = len(case.outcomes) <= FEW_RUNS
    colours = iter(SEQUENCE)
    for name, outcomes in _lines(case.outcomes, few=few):
        first = row
        for outcome in outcomes:
            row = _write_course(pen, row, case, outcome)
        look = {"color": next(colours), "width": WIDE if few else NARROW}
        blocks.append(_Block(name, first, row - 2, look))
    for level in case.levels:
        _write_level(pen, row, level, case)
        look = PROVED_LINE if level.proved else DASHED
        blocks.append(_Block(level.name, row, row + 1, look))
        row += LEVEL_ROWS
    pen.sheet.freeze_panes(HEADER_ROW + 1, 1)
    pen.widths(0, 14, *[12] * (COLUMNS - 1))
    pen.print_pages(Area(pen.name, 0, 0, row, COLUMNS))
    return Courses(pen.name, tuple(blocks))


def _lines(outcomes: Sequence[Outcome], *, few: bool) -> list[tuple[str, list[Outcome]]]:
    if few:
        return [(outcome.trial.label, [outcome]) for outcome in outcomes]
    return [
        (WORDS[scenario].capitalize(), list(evenly(list(group))))
        for scenario, group in groupby(outcomes, key=lambda outcome: outcome.trial.scenario)
    ]


def _write_course(pen: Pen, row: int, case: CaseOutcome, outcome: Outcome) -> int:
    """Write a run's course; return the row behind the empty one that follows it."""
    for generation, values in zip(case.generations.tolist(), outcome.course.tolist(), strict=True):
        if generation > outcome.done:
            break
        pen.write(row, RUN_COLUMN, outcome.trial.label, Style.TEXT)
        _write_row(pen, row, generation, values)
        row += 1
    return row + 1


def _write_level(pen: Pen, row: int, level: Level, case: CaseOutcome) -> None:
    for offset, generation in enumerate((1, max(10, case.case.task.generations))):
        pen.write(row + offset, RUN_COLUMN, level.name, Style.TEXT)
        _write_row(pen, row + offset, generation, level.values)


def _write_row(pen: Pen, row: int, generation: int, values: Sequence[float]) -> None:
    """Write a generation and its values; where there is no fitness, nothing, so that lines end."""
    pen.write(row, GENERATION_COLUMN, generation, Style.COUNT)
    for column, (value, (_, _, _, style)) in enumerate(
        zip(values, CRITERIA, strict=True), FIRST_COLUMN
    ):
        if not math.isnan(value):
            pen.write(row, column, value, style)
