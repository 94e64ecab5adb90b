"""Writing cells: a value, its look, and where there is one the formula that gives it."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace
from datetime import datetime
from typing import Any

import xlsxwriter
from xlsxwriter.drawing import Drawing, DrawingInfo, DrawingTypes
from xlsxwriter.worksheet import Worksheet

from grasp_xl.workbook.layout import Area
from grasp_xl.workbook.styles import FONT, Formats, Style
from grasp_xl.workbook.written import CellValue, WrittenCell, WrittenSheet

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
A4_ASPECT = 11.2 / 6.7
"""Width over height of an A4 page, the wider of the two, with a reserve of height."""
LEAST_SCALE, MOST_SCALE = 60, 75
"""Scales of printed pages (percent) that read well: 9 points become 5.4 to 6.7."""
FIT_SCALE = 43
"""Least scale at which a picture is kept whole."""
EMU = 9525
"""English metric units of a pixel."""


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


class SizedDrawing(Drawing):  # type: ignore[misc]
    """The charts and images of a sheet, each at a cell and with a size of its own.

    XlsxWriter anchors both corners of each at cells: where a computer has other fonts, columns
    have other widths, and a chart would be stretched, and so would be the scale of its picture.
    """

    def _write_two_cell_anchor(self, index: int, drawing: DrawingInfo) -> None:
        dimensions = drawing._dimensions  # noqa: SLF001 (a hook into the base)
        size = drawing._width, drawing._height  # noqa: SLF001 (the same)
        self._xml_start_tag("xdr:oneCellAnchor")
        self._write_from(*dimensions[:4])
        if drawing._drawing_type == DrawingTypes.IMAGE:  # noqa: SLF001 (the same)
            self._write_xdr_ext(*size)
            self._write_pic(index, *dimensions[8:10], drawing)
        else:
            self._write_xdr_ext(*(EMU * pixels for pixels in size))
            self._write_graphic_frame(index, drawing)
        self._write_client_data()
        self._xml_end_tag("xdr:oneCellAnchor")


class ExactWorksheet(Worksheet):  # type: ignore[misc]
    """A worksheet whose numbers keep all 17 digits, so that reading gives the same doubles.

    Its charts keep their size.  And it takes formulas as they are: to look for functions newer than
    Excel 2016, which none of ours has, would take as long as all the rest of the writing.
    """

    drawing: Drawing

    def pixels(self, area: Area) -> tuple[int, int]:
        """Return the width and height of an area as shown at 100 percent."""
        columns = range(area.column, area.column + area.columns)
        rows = range(area.row, area.row + area.rows)
        return sum(map(self._size_col, columns)), sum(map(self._size_row, rows))

    def _prepare_chart(self, index: int, chart_id: int, drawing_id: int) -> None:
        super()._prepare_chart(index, chart_id, drawing_id)
        if not isinstance(self.drawing, SizedDrawing):
            made, self.drawing = self.drawing, SizedDrawing()
            self.drawing.embedded, self.drawing.drawings = made.embedded, made.drawings

    def _prepare_formula(self, formula: str, expand_future_functions: bool = False) -> str:  # noqa: ARG002, FBT001, FBT002 (signature of the base)
        return formula.removeprefix("=")

    def _xml_number_element(self, number: float, attributes: Iterable[Any] = ()) -> None:
        text = "".join(f' {key}="{self._escape_attributes(value)}"' for key, value in attributes)
        self.fh.write(f"<c{text}><v>{float(number)!r}</v></c>")


def _in_our_font(chart: Any, font: dict[str, Any] | None) -> dict[str, Any]:  # noqa: ANN401 (untyped library)
    """Return a chart's font as XlsxWriter keeps it, or its default one, with our name."""
    return {**(font or chart._convert_font_args({"name": FONT})), "name": FONT}  # noqa: SLF001 (no other way)


class Pen:
    """Writes one sheet, and remembers what it wrote."""

    def __init__(
        self, book: xlsxwriter.Workbook, formats: Formats, name: str, run: str = ""
    ) -> None:
        self.name = name
        self.sheet = book.add_worksheet(name, ExactWorksheet)
        self.formats = formats
        self.written = WrittenSheet()
        self.names: dict[str, Area] = {}
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
        self.written.cells[row, column] = WrittenCell(value, style, formula)
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
        self.written.cells[row, column] = WrittenCell(moment, Style.DATE)
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
            self.written.merged.add(area)
        self.write(area.row, area.column, value, style, formula)

    def hide_errors(self, area: Area) -> None:
        """Write the error values of computed cells in the colour of the cells."""
        last_row, last_column = area.row + area.rows - 1, area.column + area.columns - 1
        look = {"type": "errors", "format": self.formats.over(Style.HIDDEN)}
        self.sheet.conditional_format(area.row, area.column, last_row, last_column, look)

    def fill_if_used(self, cell: Area, colour: str) -> None:
        """Give a cell a colour as long as it holds anything."""
        criteria = f'={cell.absolute}<>""'
        look = {"type": "formula", "criteria": criteria, "format": self.formats.filled(colour)}
        self.sheet.conditional_format(cell.row, cell.column, cell.row, cell.column, look)

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
        self.sheet.insert_chart(row, column, chart)

    def fix_row_heights(self) -> None:
        """Give every filled row its height; LibreOffice would choose another and stretch charts."""
        for row in {row for row, _ in self.written.cells} - set(self.sheet.row_info):
            self.sheet.set_row(row, ROW_HEIGHT)

    def widths(self, column: int, *widths: float) -> None:
        """Set the widths of columns side by side, in digits of the default font."""
        for offset, width in enumerate(widths):
            self.sheet.set_column(column + offset, column + offset, width)

    def print_pages(self, *lists: Area, pictures: Iterable[Area] = ()) -> None:
        """Print these areas, each from a new page on and one page wide, on A4 or Letter.

        Where all of them are legible so, each is also one page tall.  The program that prints finds
        the scale, for its own fonts.  Column widths must be set before.

        Parameters
        ----------
        lists : Area
            As many pages long as they need.
        pictures : iterable of Area
            What belongs on one page, behind the lists.
        """
        pages = [*lists, *pictures]
        sizes = [self.sheet.pixels(page) for page in pages]
        scale = min(MOST_SCALE / 100, *(PAGE_WIDTH / width for width, _ in sizes))
        whole = [100 * min(scale, PAGE_HEIGHT / height) for _, height in sizes]
        least = [LEAST_SCALE] * len(lists) + [FIT_SCALE] * (len(pages) - len(lists))
        legible = all(fit >= bound for fit, bound in zip(whole, least, strict=True))
        tall = max(math.ceil(scale * height / PAGE_HEIGHT) for _, height in sizes)
        self.sheet.fit_to_pages(1, 1 if legible else tall)
        self.sheet.print_area_range = ",".join(page.reference for page in pages)
        self.written.printed = tuple(pages)
        if lists and not legible:
            for picture in pages[len(lists) :]:
                self._widen(picture)

    def abreast(self, *areas: Area, repeated: float = 0.0) -> list[Area]:
        """Join areas that stand side by side, as long as a page of both is legible.

        ``repeated`` is the width of the columns that every page but the first repeats (pixels).
        """
        pages = [areas[0]]
        for area in areas[1:]:
            joined = pages[-1].up_to(area)
            width = self.sheet.pixels(joined)[0] + (repeated if len(pages) > 1 else 0)
            if width * LEAST_SCALE <= PAGE_WIDTH * 100:
                pages[-1] = joined
            else:
                pages.append(area)
        return pages

    def list_pages(self, listed: Area, header: int, cuts: Iterable[int]) -> list[Area]:
        """Return the pages of a list, one beside the other where it is too wide to be legible.

        Parameters
        ----------
        listed : Area
            Its first column is repeated on every page.
        header : int
            Row of the headings, with which all pages but the first begin.
        cuts : iterable of int
            Columns before which a page may end.
        """
        starts = [listed.column, *cuts]
        ends = [*starts[1:], listed.column + listed.columns]
        parts = [
            Area(listed.sheet, listed.row, start, listed.rows, end - start)
            for start, end in zip(starts, ends, strict=True)
        ]
        repeated, _ = self.sheet.pixels(listed.cell(0, 0))
        first, *others = self.abreast(*parts, repeated=repeated)
        if others:
            self.sheet.repeat_columns(listed.column)
        rows = listed.row + listed.rows - header
        return [first, *(replace(page, row=header, rows=rows) for page in others)]

    def _widen(self, picture: Area) -> None:
        """Make a picture's last column so wide that a page of its width has its height as well."""
        width, height = self.sheet.pixels(picture)
        missing = int(A4_ASPECT * height) - width
        if height > PAGE_HEIGHT and missing > 0:
            last = picture.cell(0, picture.columns - 1)
            own, _ = self.sheet.pixels(last)
            self.sheet.set_column_pixels(last.column, last.column, own + missing)

    def name_area(self, name: str, area: Area) -> None:
        """Give a block of cells a workbook-level name."""
        self._book.define_name(name, f"={area.reference}")
        self.names[name] = area
