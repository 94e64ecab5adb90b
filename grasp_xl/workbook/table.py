"""What the sheets with tables share: Excel tables, labels of genes and criteria, their looks."""

from __future__ import annotations

import math
from typing import Any

from grasp_xl.chromosome import BLANK_GENE
from grasp_xl.rules import SLACK
from grasp_xl.search.result import gene_columns
from grasp_xl.space import OptionSpace
from grasp_xl.workbook.layout import KINDS, Area
from grasp_xl.workbook.pen import ROW_HEIGHT, Pen
from grasp_xl.workbook.styles import Style
from grasp_xl.workbook.written import WrittenCell

DASH = "-"
YES, NO = "yes", "no"
CRITERIA = (
    ("fos", "FoS", "FoS", Style.RATIO),
    ("cost", "Cost", "Cost ($)", Style.MONEY),
    ("moment", "Residual Moment", "Residual Moment (N-mm)", Style.TORQUE),
    ("deviation", "Deviation", "Deviation (mm)", Style.RATIO),
    ("structure", "Structure", "Structure (mm)", Style.TORQUE),
    ("divergence", "Divergence", "Divergence", Style.DIVERGENCE),
)
"""Column of a result's tables, title, label with unit, look."""
GENERATION_WIDTH, GENE_WIDTH = 11.0, 6.3
CRITERIA_WIDTHS = (8.0, 9.0, 14.5, 9.5, 9.5, 10.0)
"""Widths of columns, so that all of a list stands on one page's width."""
GRID = {"visible": True, "line": {"color": "#D9D9D9"}}
"""Grid lines of charts."""


def gene_labels(space: OptionSpace) -> list[str]:
    """Return the headers of all gene columns: ``Suction``, ``S1``.., ``Magnets``, ``M1``.."""
    names = {labels.kind: labels.row_label for labels in KINDS}
    return [names.get(column, column) for column in gene_columns(space)]


def gene_styles(space: OptionSpace) -> list[Style]:
    """Return the looks of all gene columns."""
    return [
        style
        for style in (Style.SUCTION_GENE, Style.MAGNETS_GENE)
        for _ in range(1 + space.gene_slots)
    ]


def shown_gene(column: str, value: Any) -> int | None:  # noqa: ANN401 (a cell of a data frame)
    """Return a gene as a cell shows it: blank where its kind has no footprints."""
    return None if value == BLANK_GENE and column[-1].isdigit() else int(value)


def shown_number(value: Any) -> float | str:  # noqa: ANN401 (a cell of a data frame)
    """Return a number as a cell shows it: a dash where the grasp has no fitness."""
    return DASH if math.isnan(value) else float(value)


def add_table(pen: Pen, name: str, area: Area, labels: list[str]) -> None:
    """Make an Excel table of an area, its first row the header."""
    pen.sheet.add_table(
        area.row,
        area.column,
        area.row + area.rows - 1,
        area.column + area.columns - 1,
        {
            "name": name,
            "style": "Table Style Light 1",
            "columns": [
                {"header": label, "header_format": pen.formats[Style.STACKED_HEADER]}
                for label in labels
            ],
        },
    )
    for column, label in enumerate(labels, area.column):
        pen.written.cells[area.row, column] = WrittenCell(label, Style.STACKED_HEADER)
    pen.written.tables[name] = area
    pen.sheet.repeat_rows(area.row)
    pen.sheet.set_row(area.row, 3 * ROW_HEIGHT)  # headers of two lines, and the filter buttons


def add_colours(pen: Pen, listed: Area, norms: Area) -> None:
    """Let normalised values above 1 stand out, and rows of a list that meet all goals.

    ``norms`` are the normalised values; the divergence and ``Meets All Goals`` follow them.
    """
    last_row, last_column = listed.row + listed.rows - 1, listed.column + listed.columns - 1
    above = f"=AND(ISNUMBER({norms.local}),{norms.local}>{1 + SLACK!r})"
    meets = f'=${norms.cell(0, norms.columns + 1).local}="{YES}"'
    for left, right, formula, style in (
        (norms.column, norms.column + norms.columns - 1, above, Style.ABOVE),
        (listed.column, last_column, meets, Style.PASSES),
    ):
        pen.sheet.conditional_format(
            listed.row,
            left,
            last_row,
            right,
            {"type": "formula", "criteria": formula, "format": pen.formats.over(style)},
        )
