"""Sheet with the fitness tables of a case in the form of tables 4 and 5: a block a run."""

from __future__ import annotations

import math
from collections.abc import Sequence

from grasp_xl.study.outcome import CaseOutcome, Outcome
from grasp_xl.study.plan import SCENARIOS
from grasp_xl.study.summary import WORDS
from grasp_xl.workbook.fitness_sheet import COLUMNS, LOOKS, generation_label
from grasp_xl.workbook.layout import Area
from grasp_xl.workbook.pen import Pen
from grasp_xl.workbook.styles import Style
from grasp_xl.workbook.table import DASH

FIRST_ROW = 2
MOST_BLOCKS = 250
"""Runs of a start that have a table: nobody reads more, and they would fill the memory."""

BESIDE = len(COLUMNS) + 1
"""Columns from one start's blocks to the other's."""


def write_fitness_blocks(pen: Pen, case: CaseOutcome) -> None:
    """Write the sheet: runs from a random start left, from the user-defined one right."""
    pen.write(0, 0, f"FITNESS TABLES: {case.case.title}", Style.TITLE)
    sides = [
        [each for each in case.outcomes if each.trial.scenario == scenario]
        for scenario in SCENARIOS
    ]
    behind = FIRST_ROW
    for side, outcomes in enumerate(filter(None, sides)):
        row = FIRST_ROW
        for outcome in outcomes[:MOST_BLOCKS]:
            row = _write_block(pen, row, side * BESIDE, case, outcome)
        if len(outcomes) > MOST_BLOCKS:
            told = f"{len(outcomes) - MOST_BLOCKS:,} more runs stand on the sheet Runs alone."
            pen.write(row, side * BESIDE, told, Style.NOTE)
            row += 1
        behind = max(behind, row)
        pen.widths(side * BESIDE, 12, *[13.5] * (len(COLUMNS) - 1), 3)
    pen.fix_row_heights()
    width = BESIDE * max(1, sum(map(bool, sides))) - 1
    pen.print_pages(Area(pen.name, 0, 0, behind, width))


def _write_block(pen: Pen, row: int, left: int, case: CaseOutcome, outcome: Outcome) -> int:
    """Write one run's table; return the row behind the empty one that follows it."""
    trial = outcome.trial
    title = f"{trial.label}: {WORDS[trial.scenario]}, run {trial.number}, seed {trial.seed}"
    pen.span(Area(pen.name, row, left, 1, len(COLUMNS)), title, Style.HEADING)
    pen.row(row + 1, left, COLUMNS, Style.HEADER)
    rows: list[tuple[str, Sequence[float]]] = [(case.benchmark.name, case.benchmark.values)]
    rows += [
        (generation_label(generation), values)
        for generation, values in zip(
            case.reported.tolist(), outcome.reported.tolist(), strict=True
        )
    ]
    for line, (label, values) in enumerate(rows, row + 2):
        pen.write(line, left, label, Style.LABEL)
        for column, (value, style) in enumerate(zip(values, LOOKS, strict=True), left + 1):
            if math.isnan(value):
                pen.write(line, column, DASH, Style.CENTRED)
            else:
                pen.write(line, column, value, style)
    return row + 3 + len(rows)
