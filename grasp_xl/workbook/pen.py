"""Writing cells: a value, its look, and where there is one the formula that gives it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from datetime import datetime
from typing import Any

import xlsxwriter
from xlsxwriter.worksheet import Worksheet

from grasp_xl.workbook.layout import Area
from grasp_xl.workbook.styles import Formats, Style

A4 = 9
"""Excel's number of the paper size."""

ROW_HEIGHT = 14.25
"""Height of every row (points)."""

CellValue = str | int | float | bool | None


@dataclass(frozen=True, slots=True)
class Cell:
    """What one cell of a sheet holds: a value, or a formula with the value that it gives.

    ``rows`` above 1 merge it with the cells below, for a label only.
    """

    row: int
    column: int
    value: CellValue
    style: Style = Style.LABEL
    formula: str | None = None
    rows: int = 1


class ExactWorksheet(Worksheet):  # type: ignore[misc]
    """A worksheet whose numbers keep all 17 digits, so that reading gives the same doubles.

    And one that takes formulas as they are: to look for functions newer than Excel 2016, which none
    of ours has, would take as long as all the rest of the writing.
    """

    def _prepare_formula(self, formula: str, expand_future_functions: bool = False) -> str:  # noqa: ARG002, FBT001, FBT002 (signature of the base)
        return formula.removeprefix("=")

    def _xml_number_element(self, number: float, attributes: Iterable[Any] = ()) -> None:
        text = "".join(f' {key}="{self._escape_attributes(value)}"' for key, value in attributes)
        self.fh.write(f"<c{text}><v>{float(number)!r}</v></c>")


class Pen:
    """Writes one sheet, and remembers which cells it filled."""

    def __init__(
        self, book: xlsxwriter.Workbook, formats: Formats, name: str, run: str = ""
    ) -> None:
        self.name = name
        self.sheet = book.add_worksheet(name, ExactWorksheet)
        self.formats = formats
        self.filled: set[tuple[int, int]] = set()
        self._book = book
        self.sheet.hide_gridlines(2)
        self.sheet.set_default_row(ROW_HEIGHT)
        self.sheet.set_landscape()
        self.sheet.set_paper(A4)
        self.sheet.fit_to_pages(1, 0)
        self.sheet.set_header(f"&L&F&C&A&R{run}")
        self.sheet.set_footer("&RPage &P of &N")

    def write(
        self,
        row: int,
        column: int,
        value: CellValue,
        style: Style = Style.LABEL,
        formula: str | None = None,
    ) -> None:
        """Write one cell; text is never taken for a formula."""
        look = self.formats[style]
        self.filled.add((row, column))
        if formula is not None:
            shown = "" if value is None else value
            self.sheet.write_formula(row, column, f"={formula}", look, shown)
        elif value is None:
            self.sheet.write_blank(row, column, None, look)
        elif isinstance(value, bool):
            self.sheet.write_boolean(row, column, value, look)
        elif isinstance(value, str):
            self.sheet.write_string(row, column, value, look)
        else:
            self.sheet.write_number(row, column, value, look)

    def date(self, row: int, column: int, moment: datetime) -> None:
        """Write a date and time."""
        self.filled.add((row, column))
        self.sheet.write_datetime(row, column, moment, self.formats[Style.DATE])

    def put(self, cells: Iterable[Cell]) -> None:
        """Write many cells."""
        for cell in cells:
            if cell.rows > 1:
                area = Area(self.name, cell.row, cell.column, cell.rows)
                self.span(area, cell.value, cell.style)
            else:
                self.write(cell.row, cell.column, cell.value, cell.style, cell.formula)

    def row(self, row: int, column: int, values: Iterable[CellValue], style: Style) -> None:
        """Write values side by side."""
        for offset, value in enumerate(values):
            self.write(row, column + offset, value, style)

    def span(self, area: Area, value: CellValue, style: Style) -> None:
        """Write one value over merged cells."""
        last_row, last_column = area.row + area.rows - 1, area.column + area.columns - 1
        if (last_row, last_column) == (area.row, area.column):
            self.write(area.row, area.column, value, style)
            return
        self.filled.add((area.row, area.column))
        self.sheet.merge_range(
            area.row, area.column, last_row, last_column, value, self.formats[style]
        )

    def insert_chart(self, row: int, column: int, chart: Any) -> None:  # noqa: ANN401 (untyped library)
        """Place a chart at its own size, whatever the cells under it."""
        self.sheet.insert_chart(row, column, chart, {"object_position": 2})

    def fix_row_heights(self) -> None:
        """Give every filled row its height; LibreOffice would choose another and stretch charts."""
        for row in {row for row, _ in self.filled} - set(self.sheet.row_info):
            self.sheet.set_row(row, ROW_HEIGHT)

    def name_area(self, name: str, area: Area) -> None:
        """Give a block of cells a workbook-level name."""
        self._book.define_name(name, f"={area.reference}")
