"""Writing cells: a value, its look, and where there is one the formula that gives it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from datetime import datetime
from typing import Any

import xlsxwriter
from xlsxwriter.worksheet import Worksheet

from grasp_xl.workbook.layout import Area
from grasp_xl.workbook.styles import FONT, Formats, Style

A4 = 9
"""Excel's number of the paper size."""

ROW_HEIGHT = 14.25
"""Height of every row (points)."""

MARGINS = {"left": 0.25, "right": 0.25, "top": 0.7, "bottom": 0.6}
"""Of a printed page (inches)."""
PAGE_WIDTH, PAGE_HEIGHT = 0.93 * 10.5 * 96, 0.97 * 6.9 * 96
"""What both an A4 and a Letter page in landscape hold between the margins (pixels of Excel's).

LibreOffice's columns are 6 percent wider: it does not round the width of a digit to whole pixels.
"""
LEAST_SCALE, MOST_SCALE = 60, 85
"""Scales of printed pages (percent): text of 9 points is then 5.4 to 7.7 points high."""
FIT_SCALE = 43
"""Least at which a page that is too wide is fitted to the paper; a wider one runs over."""

CellValue = str | int | float | bool | None


@dataclass(frozen=True, slots=True)
class Cell:
    """What one cell of a sheet holds: a value, or a formula with the value that it gives.

    ``rows`` and ``columns`` above 1 merge it with the cells below and beside.
    """

    row: int
    column: int
    value: CellValue
    style: Style = Style.LABEL
    formula: str | None = None
    rows: int = 1
    columns: int = 1


class ExactWorksheet(Worksheet):  # type: ignore[misc]
    """A worksheet whose numbers keep all 17 digits, so that reading gives the same doubles.

    And one that takes formulas as they are: to look for functions newer than Excel 2016, which none
    of ours has, would take as long as all the rest of the writing.
    """

    def pixels(self, area: Area) -> tuple[int, int]:
        """Return the width and height of an area as shown at 100 percent."""
        columns = range(area.column, area.column + area.columns)
        rows = range(area.row, area.row + area.rows)
        return sum(map(self._size_col, columns)), sum(map(self._size_row, rows))

    def _prepare_formula(self, formula: str, expand_future_functions: bool = False) -> str:  # noqa: ARG002, FBT001, FBT002 (signature of the base)
        return formula.removeprefix("=")

    def _xml_number_element(self, number: float, attributes: Iterable[Any] = ()) -> None:
        text = "".join(f' {key}="{self._escape_attributes(value)}"' for key, value in attributes)
        self.fh.write(f"<c{text}><v>{float(number)!r}</v></c>")


def _in_our_font(chart: Any, font: dict[str, Any] | None) -> dict[str, Any]:  # noqa: ANN401 (untyped library)
    """Return a chart's font as XlsxWriter keeps it, or its default one, with our name."""
    return {**(font or chart._convert_font_args({"name": FONT})), "name": FONT}  # noqa: SLF001 (no other way)


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
        self.sheet.set_margins(**MARGINS)
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
            if (cell.rows, cell.columns) != (1, 1):
                area = Area(self.name, cell.row, cell.column, cell.rows, cell.columns)
                self.span(area, cell.value, cell.style, cell.formula)
            else:
                self.write(cell.row, cell.column, cell.value, cell.style, cell.formula)

    def row(self, row: int, column: int, values: Iterable[CellValue], style: Style) -> None:
        """Write values side by side."""
        for offset, value in enumerate(values):
            self.write(row, column + offset, value, style)

    def span(self, area: Area, value: CellValue, style: Style, formula: str | None = None) -> None:
        """Write one value, or a formula with it, over merged cells."""
        last_row, last_column = area.row + area.rows - 1, area.column + area.columns - 1
        if (last_row, last_column) != (area.row, area.column):
            look = self.formats[style]
            self.sheet.merge_range(area.row, area.column, last_row, last_column, "", look)
        self.write(area.row, area.column, value, style, formula)

    def hide_errors(self, area: Area) -> None:
        """Write the error values of computed cells in the colour of the cells."""
        last_row, last_column = area.row + area.rows - 1, area.column + area.columns - 1
        look = {"type": "errors", "format": self.formats.over(Style.HIDDEN)}
        self.sheet.conditional_format(area.row, area.column, last_row, last_column, look)

    def note(self, row: int, column: int, text: str) -> None:
        """Put a note on a cell: it shows while the pointer is over it."""
        look = {"x_scale": 2, "font_name": FONT, "font_size": 9}
        self.sheet.write_comment(row, column, text, look)

    def insert_chart(self, row: int, column: int, chart: Any) -> None:  # noqa: ANN401 (untyped library)
        """Place a chart at its own size, whatever the cells under it, in the font of the cells."""
        for text in (chart.title, chart.x_axis["title"], chart.y_axis["title"]):
            text.font = _in_our_font(chart, text.font)
        for axis in (chart.x_axis, chart.y_axis):
            axis["num_font"] = _in_our_font(chart, axis["num_font"])
        chart.legend["font"] = _in_our_font(chart, chart.legend.get("font"))
        self.sheet.insert_chart(row, column, chart, {"object_position": 2})

    def fix_row_heights(self) -> None:
        """Give every filled row its height; LibreOffice would choose another and stretch charts."""
        for row in {row for row, _ in self.filled} - set(self.sheet.row_info):
            self.sheet.set_row(row, ROW_HEIGHT)

    def widths(self, column: int, *widths: float) -> None:
        """Set the widths of columns side by side, in digits of the default font."""
        for offset, width in enumerate(widths):
            self.sheet.set_column(column + offset, column + offset, width)

    def print_pages(self, *lists: Area, pictures: Iterable[Area] = ()) -> None:
        """Print these areas, each from a new page on, at one scale that suits A4 and Letter.

        Column widths must be set before.  Where the widest area is somewhat too wide (many place
        genes), the scale is less; if no picture is then cut, it is left to the program that prints.

        Parameters
        ----------
        lists : Area
            One page wide, and as many pages long as they need.
        pictures : iterable of Area
            What belongs on one page, behind the lists.
        """
        pages = [*lists, *pictures]
        wide = [100 * PAGE_WIDTH / self.sheet.pixels(page)[0] for page in pages]
        high = [100 * PAGE_HEIGHT / self.sheet.pixels(page)[1] for page in pages[len(lists) :]]
        too_wide = FIT_SCALE <= min(wide) < LEAST_SCALE
        # LibreOffice fits each area by itself, and enlarges none.
        widths = wide[len(lists) :]
        if too_wide and all(w <= h or h >= 100 for w, h in zip(widths, high, strict=True)):
            self.sheet.fit_to_pages(1, 0)
        else:
            least = int(min(wide)) if too_wide else LEAST_SCALE
            self.sheet.set_print_scale(max(least, min(MOST_SCALE, int(min(wide + high)))))
        self.sheet.print_area_range = ",".join(page.reference for page in pages)

    def name_area(self, name: str, area: Area) -> None:
        """Give a block of cells a workbook-level name."""
        self._book.define_name(name, f"={area.reference}")
