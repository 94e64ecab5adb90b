"""The open workbook through xlwings: its cells to read, its cells to write, words to the person.

The only file that imports xlwings.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, replace
from decimal import Decimal
from functools import cached_property
from typing import Any

import xlwings as xw

from grasp_xl.errors import InputError, OutputError, Problem
from grasp_xl.live.words import typed
from grasp_xl.workbook.cells import Grid, Value, cells_of
from grasp_xl.workbook.layout import Area
from grasp_xl.workbook.patch import Patch, SheetPatch
from grasp_xl.workbook.written import CellValue, WrittenCell

TITLE = "grasp_xl"
"""Title of every message box."""

MAX_CELLS = 4_000_000
"""Cells of one sheet that are read: stray formats can make a sheet seem as large as it can be."""

STATUS_SECONDS = 0.2
"""Least time between two texts in the status bar."""

LOST_SECONDS = 60.0
"""A workbook that does not answer for so long was closed: somebody edits a cell for less."""

Book = xw.Book


def calling_book() -> Book:
    """Return the workbook whose button was pressed."""
    return xw.Book.caller()


# --- words ---


def tell(book: Book, text: str, *, is_error: bool = False) -> None:
    """Show a message box."""
    book.app.alert(text, title=TITLE, mode="critical" if is_error else "info")


class StatusBar:
    """Excel's status bar, written to at most five times a second.

    Parameters
    ----------
    book : Book
    """

    def __init__(self, book: Book) -> None:
        self._book, self._app = book, book.app  # that stays where the workbook is closed
        self._told_at = 0.0
        self._heard_at = time.monotonic()

    @property
    def is_lost(self) -> bool:
        """Whether the workbook, or all of Excel, seems to be gone."""
        return time.monotonic() - self._heard_at > LOST_SECONDS

    def tell(self, text: str) -> None:
        """Show a text, unless one was shown just now."""
        now = time.monotonic()
        if now - self._told_at >= STATUS_SECONDS:
            self._told_at = now
            self._show(f"{TITLE}: {text}")

    def clear(self) -> None:
        """Give the status bar back to Excel."""
        self._show(False)  # noqa: FBT003 (Excel's own word for it)

    def _show(self, text: str | bool) -> None:  # noqa: FBT001 (as Excel has it)
        with suppress(Exception):  # a busy Excel is no reason to end a search
            self._app.status_bar = text
            if self._book.name:  # a closed one has none, and raises
                self._heard_at = time.monotonic()


# --- reading ---


@dataclass(frozen=True)
class OpenCells:
    """The cells of an open workbook, each sheet read in two blocks: its values, its formulas.

    Parameters
    ----------
    book : Book
    """

    book: Book

    @property
    def name(self) -> str:
        """What Excel's title bar calls it."""
        return str(self.book.name)

    @cached_property
    def sheets(self) -> list[str]:
        """Names of all sheets, in order."""
        return [sheet.name for sheet in self.book.sheets]

    @cached_property
    def references(self) -> dict[str, str]:
        """What its defined names stand for."""
        return {name.name: str(name.refers_to).removeprefix("=") for name in self.book.names}

    @cached_property
    def _blocks(self) -> dict[tuple[str, bool], tuple[Area, list[list[Value]]]]:
        return {}

    def grid(self, sheet: str, *, formulas: bool, rows: int) -> Grid:
        """Read the values of a sheet's first rows, or its formulas alone.

        Raises
        ------
        InputError
            If the sheet is larger than any option space.
        """
        area, block = self._block(sheet, formulas=formulas)
        filled: dict[int, tuple[Value, ...]] = {}
        for number, values in enumerate(block[: max(0, rows - area.row)], area.row):
            cells: list[Value] = [None] * area.column + list(values)
            while cells and cells[-1] is None:
                cells.pop()
            if cells:
                filled[number] = tuple(cells)
        return Grid(sheet, filled)

    def _block(self, sheet: str, *, formulas: bool) -> tuple[Area, list[list[Value]]]:
        """Read all cells of a sheet that were ever used, once."""
        if (sheet, formulas) not in self._blocks:
            used = self.book.sheets[sheet].used_range
            height, width = used.shape
            if height * width > MAX_CELLS:
                hint = "delete the empty rows and columns behind the last ones that you need"
                raise InputError(
                    [
                        Problem(
                            sheet,
                            f"{height:,} rows and {width:,} columns in use",
                            f"at most {MAX_CELLS:,} cells",
                            hint,
                        )
                    ]
                )
            area = Area(sheet, used.row - 1, used.column - 1, height, width)
            values = used.options(ndim=2, err_to_str=True).value
            has_currency = any(isinstance(value, Decimal) for row in values for value in row)
            texts = _rows(used.formula) if formulas or has_currency else []
            if has_currency:
                values = _with_all_digits(values, texts)
            if formulas:
                values = _formulas_alone(texts, values)
            self._blocks[sheet, formulas] = area, values
        return self._blocks[sheet, formulas]


def _rows(block: Any) -> list[list[Any]]:  # noqa: ANN401 (what Excel gives)
    """Return what Excel gives for a range as rows; for one cell that is no sequence."""
    if not isinstance(block, list | tuple):
        return [[block]]
    return [list(row) for row in block]


def _with_all_digits(values: list[list[Value]], texts: list[list[Any]]) -> list[list[Value]]:
    """Return numbers for what Excel on Windows gives of cells with a currency format.

    It gives a decimal with four digits; the text of a constant has all of them.
    """
    return [
        [
            _number(value, text) if isinstance(value, Decimal) else value
            for value, text in zip(*row, strict=True)
        ]
        for row in zip(values, texts, strict=True)
    ]


def _number(value: Decimal, text: Any) -> float:  # noqa: ANN401 (what Excel gives)
    try:
        return float(text)
    except (TypeError, ValueError):  # a formula
        return float(value)


def _formulas_alone(texts: list[list[Any]], values: list[list[Value]]) -> list[list[Value]]:
    """Leave out constants; text that only looks like a formula has itself as its value."""
    return [
        [
            text if isinstance(text, str) and text.startswith("=") and text != value else None
            for text, value in zip(*row, strict=True)
        ]
        for row in zip(texts, values, strict=True)
    ]


# --- writing ---


def refuse_hidden_rows(book: Book, patch: Patch) -> None:
    """Refuse to write into rows that are hidden.

    Where a filter hides rows, Excel puts the first cell of a block into each visible one, and
    nothing into the others (xlwings, issues 679 and 747). It does not tell why a row is hidden.

    Raises
    ------
    OutputError
        With the first such row.
    """
    for sheet in patch.sheets:
        for area in sheet.rows():
            hidden = _first_hidden(book.sheets[sheet.sheet], area)
            if hidden is not None:
                raise OutputError(
                    f"Rows of {sheet.sheet!r} are hidden, row {1 + hidden} among them, and where a "
                    "filter hides rows, Excel mixes up what is written. Nothing was written.",
                    where=Area(sheet.sheet, hidden, 0).where,
                    hint="Show all rows (Data > Clear shows those that a filter hides)",
                )


def _first_hidden(sheet: Any, area: Area) -> int | None:  # noqa: ANN401 (an xlwings sheet)
    """Return the first row of an area that is hidden; looks into halves where heights differ."""
    height = _range(sheet, area).row_height
    if height is not None:
        return area.row if height == 0 else None
    half = area.rows // 2
    upper = replace(area, rows=half)
    lower = replace(area, row=area.row + half, rows=area.rows - half)
    hidden = _first_hidden(sheet, upper)
    return _first_hidden(sheet, lower) if hidden is None else hidden


def apply(book: Book, patch: Patch, untouched: Callable[[Area], bool]) -> None:
    """Bring an open workbook from what it shows to another result, whole or not at all.

    Parameters
    ----------
    book : Book
    patch : Patch
    untouched : callable
        Whether a cell is as we wrote it.

    Raises
    ------
    OutputError
        If rows are hidden, or Excel refuses a part of it; the sheets are then as they were.
    """
    refuse_hidden_rows(book, patch)
    with book.app.properties(screen_updating=False, calculation="manual"):
        try:
            _apply(book, patch, untouched)
            book.app.calculate()  # also where a person calculates by hand
        except Exception as error:  # whatever Excel, AppleScript or COM raise
            with suppress(Exception):
                _apply(book, patch.back, untouched)
            raise OutputError(
                f"Excel did not take the results ({_reason(error)}), so the sheets are as they "
                "were.",
                where=book.name,
                hint="Unprotect the sheets and leave the cell that you edit, then try again",
            ) from error


def _reason(error: Exception) -> str:
    """Return what Excel says; of an error of Windows, which has it inside, that alone."""
    told = error.args[2][2] if len(error.args) > 2 and isinstance(error.args[2], tuple) else error
    return (str(told) or type(error).__name__).splitlines()[0][:200]


def _apply(book: Book, patch: Patch, untouched: Callable[[Area], bool]) -> None:
    for sheet in patch.sheets:
        _apply_to_sheet(book.sheets[sheet.sheet], sheet, untouched)
    for name, area in patch.names.items():
        if name in patch.before.names:
            book.names[name].refers_to = f"={area.reference}"
        else:
            book.names.add(name, f"={area.reference}")
    for name in patch.lost_names:
        book.names[name].delete()


def _apply_to_sheet(sheet: Any, patch: SheetPatch, untouched: Callable[[Area], bool]) -> None:  # noqa: ANN401 (an xlwings sheet)
    for area in patch.unmerged:
        _range(sheet, area).unmerge()
    tables = {table.name: table for table in sheet.tables}
    for name, area in patch.tables.items():
        if name in tables:  # a person may have turned it into plain cells
            tables[name].resize(_range(sheet, area))
    looks = sorted(patch.looks().items(), key=lambda look: look[0][1] is not None)
    for (name, value), areas in looks:  # lines are taken away before others are drawn there
        for area in areas:
            FORMATS[name](_range(sheet, area), value)
    for area in patch.blocks(lambda place: untouched(Area(patch.sheet, *place))):
        _range(sheet, area).formula = [
            [_entered(patch.cell(cell.row, cell.column)) for cell in row] for row in cells_of(area)
        ]
    for area in patch.merged:
        _range(sheet, area).merge()
    if patch.before.printed != patch.after.printed:
        with suppress(Exception):  # many cards make a text that is too long; results count more
            sheet.page_setup.print_area = ",".join(area.absolute for area in patch.after.printed)


def _range(sheet: Any, area: Area) -> Any:  # noqa: ANN401 (of xlwings)
    last = (area.row + area.rows, area.column + area.columns)
    return sheet.range((area.row + 1, area.column + 1), last)


def _entered(cell: WrittenCell | None) -> CellValue:
    """Return what to enter into a cell, so that Excel takes text for text."""
    if cell is None or (cell.value is None and cell.formula is None):
        return ""
    if cell.formula is not None:
        return f"={cell.formula}"
    return typed(cell.value)


# --- looks ---


def _line(sides: str) -> Callable[[Any, Any], None]:
    """Make a function that draws a thin line, or takes it away."""

    def draw(cells: Any, colour: str | None) -> None:  # noqa: ANN401 (an xlwings range)
        if colour is None:
            cells.borders.set(sides, line_style=None)
        else:
            cells.borders.set(sides, line_style="continuous", color=colour)

    return draw


def _of_cells(name: str) -> Callable[[Any, Any], None]:
    return lambda cells, value: setattr(cells, name, value)


def _of_font(name: str) -> Callable[[Any, Any], None]:
    return lambda cells, value: setattr(cells.font, name, value)


def _valign(cells: Any, value: str) -> None:  # noqa: ANN401 (an xlwings range)
    cells.vertical_alignment = {"vcenter": "center"}.get(value, value)


FORMATS: dict[str, Callable[[Any, Any], None]] = {
    "num_format": _of_cells("number_format"),
    "bg_color": _of_cells("color"),
    "bold": _of_font("bold"),
    "italic": _of_font("italic"),
    "font_size": _of_font("size"),
    "font_color": _of_font("color"),
    "align": _of_cells("horizontal_alignment"),
    "valign": _valign,
    "text_wrap": _of_cells("wrap_text"),
    "border_color": _line("all"),
    "top_color": _line("edge_top"),
    "bottom_color": _line("edge_bottom"),
}
"""How a format property of our styles is set through xlwings."""
