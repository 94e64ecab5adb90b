"""Sheet ``Runs`` of a study: a row a run, with its seed, so that ``run`` can repeat it."""

from __future__ import annotations

from collections.abc import Mapping

from grasp_xl.study.outcome import Outcome
from grasp_xl.study.summary import Study, finite
from grasp_xl.workbook.layout import Area
from grasp_xl.workbook.pen import ROW_HEIGHT, Pen
from grasp_xl.workbook.styles import Style
from grasp_xl.workbook.table import CRITERIA, DASH
from grasp_xl.workbook.written import CellValue

HEADER_ROW = 2
TABLE = "Runs"
COLUMNS: tuple[tuple[str, Style, float], ...] = (
    ("Run", Style.TEXT, 12),
    ("Case", Style.TEXT, 30),
    ("Start", Style.CENTRED, 9),
    ("Seed", Style.MARK, 19),
    ("Generations", Style.COUNT, 12),
    ("Evaluations", Style.COUNT, 12),
    ("Valid Designs", Style.COUNT, 9),
    ("Minimised Value", Style.RATIO, 12),
    *((label, style, 12.0) for _, _, label, style in CRITERIA),
    ("Cups", Style.COUNT, 7),
    ("Magnets", Style.COUNT, 8),
    ("Generations to within 1 %", Style.COUNT, 13),
    ("Seconds", Style.RATIO, 9),
)
"""Title, look and width; the seconds are the only ones that differ from machine to machine."""
LINK_WIDTH = 26.0


def write_runs(pen: Pen, study: Study, links: Mapping[str, str]) -> None:
    """Write the sheet."""
    pen.write(0, 0, "RUNS: the best grasp of each", Style.TITLE)
    titles = [title for title, _, _ in COLUMNS] + (["Workbook"] if links else [])
    row = HEADER_ROW
    for case in study.cases:
        for outcome in case.outcomes:
            row += 1
            values = _values(case.case.title, outcome)
            for column, (value, (_, style, _)) in enumerate(zip(values, COLUMNS, strict=True)):
                look = Style.CENTRED if value is None else style
                pen.write(row, column, DASH if value is None else value, look)
            link = links.get(outcome.trial.label)
            if link:
                # a formula, as other programs take no link with the backslashes of Windows
                quoted = link.replace('"', '""')
                formula = f'HYPERLINK("{quoted}","{quoted}")'
                pen.write(row, len(COLUMNS), link, Style.TEXT, formula)
    rows = max(1, row - HEADER_ROW)
    pen.row(HEADER_ROW, 0, titles, Style.STACKED_HEADER)
    pen.sheet.set_row(HEADER_ROW, 3 * ROW_HEIGHT)
    pen.sheet.autofilter(HEADER_ROW, 0, HEADER_ROW + rows, len(titles) - 1)
    pen.sheet.repeat_rows(HEADER_ROW)
    pen.fix_row_heights()
    pen.sheet.freeze_panes(HEADER_ROW + 1, 1)
    pen.widths(0, *(width for _, _, width in COLUMNS), *([LINK_WIDTH] if links else []))
    pen.print_pages(Area(pen.name, 0, 0, HEADER_ROW + 1 + rows, len(titles)))


def _values(title: str, outcome: Outcome) -> list[CellValue]:
    best, trial = outcome.best, outcome.trial
    criteria: list[CellValue] = [None] * len(CRITERIA)
    counts: list[CellValue] = [None, None]
    if best:
        criteria = [best.fos, *best.terms, best.divergence]
        counts = list(best.chromosome.counts)
    return [
        trial.label,
        title,
        trial.scenario,
        trial.seed,
        outcome.done,
        outcome.evaluations,
        outcome.designs,
        finite(outcome.value),
        *criteria,
        *counts,
        outcome.near_at,
        round(outcome.seconds, 3),
    ]
