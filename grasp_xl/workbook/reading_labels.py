"""What is said of labels that are missing, and of the numbers beside them."""

from __future__ import annotations

from grasp_xl.workbook import layout
from grasp_xl.workbook.cells import Source, is_blank
from grasp_xl.workbook.layout import Area

A_COORDINATE = "a coordinate (mm)"
RESTORE_LABEL = "restore the label, or export the option space again"


def usual_place(source: Source, sheet: str, row: int, column: int) -> Area:
    """Return where a cell stands in relation to the title."""
    title = source.grid(sheet).find(layout.TITLE) or Area(sheet, 0, 0)
    return title.cell(row, column)


def miss(source: Source, cell: Area, label: str) -> None:
    """Note that a label does not stand where it should."""
    value = source.value(cell)
    found = "an empty cell" if is_blank(value) else repr(value)
    source.complain(cell.where, found, label, RESTORE_LABEL)
