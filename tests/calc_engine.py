"""An engine that lets xlwings drive a workbook that is open in LibreOffice, as it drives Excel.

Rows and columns count from 1 where xlwings sees them, from 0 in :class:`Area`.
"""
# ruff: noqa: D102 (xlwings' own documentation says what each method does)

from __future__ import annotations

import atexit
import datetime as dt
import json
import os
import re
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import xlwings as xw
from calc_formulas import sheet_in_excel, to_calc, to_excel
from office import Office, sent
from xlsxwriter.utility import xl_rowcol_to_cell
from xlwings.base_classes import _UNSET
from xlwings.main import Engine

from grasp_xl.workbook.layout import Area, area_of

LOG = "GRASP_XL_TEST_LOG"
"""Environment variable: the file where status texts and alerts of all processes are noted."""

DATE, LOGICAL = 2, 1024  # com.sun.star.util.NumberFormat
CONTENTS, FORMATS = 1 + 2 + 4 + 16, 32 + 64  # com.sun.star.sheet.CellFlags
_CELLS = re.compile(r"\$?[A-Z]{1,3}\$?\d+(:\$?[A-Z]{1,3}\$?\d+)?", re.IGNORECASE)
_OWN_ERROR = re.compile(r"Err:\d+")
_NUMBER = re.compile(r"\s*[+-]?(\d+\.?\d*|\.\d+)(E[+-]?\d+)?\s*", re.IGNORECASE)
EPOCH = dt.datetime(1899, 12, 30)  # noqa: DTZ001 (cells know no time zone)
INT = 2**31
"""Whole numbers that Windows and appscript hand to Excel are smaller."""
ERRORS = ("#N/A", "#REF!", "#DIV/0!", "#VALUE!", "#NAME?", "#NUM!", "#NULL!")

HORIZONTAL = {
    "general": "STANDARD",
    "left": "LEFT",
    "center": "CENTER",
    "right": "RIGHT",
    "fill": "REPEAT",
    "justify": "BLOCK",
}
VERTICAL = {"top": 1, "center": 2, "bottom": 3, "justify": 4}
SIDES = {
    "edge_top": "Top",
    "edge_bottom": "Bottom",
    "edge_left": "Left",
    "edge_right": "Right",
    "inside_vertical": "Vertical",
    "inside_horizontal": "Horizontal",
}
LINE_STYLES = {
    "continuous": 0,
    "dot": 1,
    "dash": 2,
    "double": 3,
    "dash_dot": 16,
    "dash_dot_dot": 17,
}
LINE_WIDTHS = {"hairline": 2, "thin": 26, "medium": 62, "thick": 88}  # 1/100 mm


def read_typed(value: Any) -> float | bool | str | dt.datetime | None:
    """Tell what a value is once it is typed; formulas keep their ``=``.

    Examples
    --------
    >>> read_typed("1.5"), read_typed("'1.5"), read_typed("=A1"), read_typed("true")
    (1.5, "'1.5", '=A1', True)
    """
    if isinstance(value, dt.date) and not isinstance(value, dt.datetime):
        return dt.datetime.combine(value, dt.time())
    if isinstance(value, bool | dt.datetime) or value is None:
        return value
    if not isinstance(value, str | float) and not (type(value) is int and -INT <= value < INT):
        raise TypeError(f"{type(value)} {value} cannot be handed to Excel")
    if not isinstance(value, str):
        return None if value != value else float(value)  # noqa: PLR0124 (not a number)
    if _NUMBER.fullmatch(value):
        return float(value)
    if value.upper() in ("TRUE", "FALSE"):
        return value.upper() == "TRUE"
    return value or None


def _constant(value: Any) -> float | str | None:
    """Return what a cell stores for a constant."""
    if isinstance(value, dt.datetime):
        return (value.replace(tzinfo=None) - EPOCH) / dt.timedelta(days=1)
    if isinstance(value, str):
        return value.removeprefix("'")
    return value if value is None else float(value)


def _rgb(color: Any) -> int:
    """Return a colour as LibreOffice has it; -1 for none."""
    if color is None:
        return -1
    if isinstance(color, str):
        return int(color.removeprefix("#"), 16)
    if isinstance(color, int):  # Excel's own order
        color = (color & 255, color >> 8 & 255, color >> 16)
    return int.from_bytes(bytes(color))


def _tuple(color: int | None) -> tuple[int, ...] | None:
    return None if color in (None, -1) else tuple(color.to_bytes(3))


class CellError(str):
    """The text of an error, which is no text that somebody typed."""

    __slots__ = ()


def _style(name: str, there: Callable[[Any], Any], back: Callable[[Any], Any]) -> property:
    """Make an xlwings property of one of LibreOffice's; None where cells differ."""

    def read(self: Any) -> Any:
        value = self.do("style", name=name)
        return None if value is None else back(value)

    def write(self: Any, value: Any) -> None:
        self.do("set_style", name=name, value=there(value))

    return property(read, write)


def _enum(kind: str, names: dict[str, str]) -> tuple[Callable[[Any], Any], Callable[[Any], Any]]:
    values = {value: key for key, value in names.items()}
    return lambda key: [f"com.sun.star.{kind}", names[key]], values.get


class CalcEngine:
    """The engine: it knows the one application that is driven."""

    name = "calc"
    type = "desktop"

    def __init__(self) -> None:
        self.apps = Apps()

    @staticmethod
    def prepare_xl_data_element(value: Any, _options: Any) -> Any:
        return read_typed(value)

    @staticmethod
    def clean_value_data(
        rows: Any, date_of: Any, empty: Any, number_of: Any, err_to_str: Any
    ) -> list[list[Any]]:
        def clean(value: Any) -> Any:
            if isinstance(value, CellError):
                return str(value) if err_to_str else None
            if isinstance(value, dt.datetime):
                parts = ("year", "month", "day", "hour", "minute", "second", "microsecond")
                return date_of(**{part: getattr(value, part) for part in parts}, tzinfo=None)
            if number_of and isinstance(value, float):
                return number_of(value)
            return empty if value is None else value

        return [[clean(value) for value in row] for row in rows]


class Apps:
    """The one application, if there is any."""

    app: App | None = None

    def keys(self) -> list[int]:
        return [app.pid for app in self]

    def __iter__(self) -> Iterator[App]:
        return iter([self.app] if self.app else [])

    def __len__(self) -> int:
        return len(self.keys())

    def __getitem__(self, pid: int) -> App:
        return {app.pid: app for app in self}[pid]


ENGINE = CalcEngine()


class App:
    """LibreOffice with the one workbook that is driven."""

    engine = ENGINE
    api = True
    selection = None
    screen_updating = True
    display_alerts = True
    enable_events = True
    interactive = True
    visible = True
    cut_copy_mode = None

    def __init__(self, office: Office) -> None:
        self.do = office.do
        self.pid = self.hwnd = office.pid
        self.books = Books(self)
        self._status: str | bool = False

    @property
    def version(self) -> str:
        return self.do("version")

    @property
    def status_bar(self) -> str | bool:
        return self._status

    @status_bar.setter
    def status_bar(self, text: str | bool) -> None:
        self._status = text
        note("status", text=text)

    @property
    def calculation(self) -> str:
        return "automatic" if self.do("calculation", automatic=None) else "manual"

    @calculation.setter
    def calculation(self, mode: str) -> None:
        self.do("calculation", automatic=mode == "automatic")

    def calculate(self) -> None:
        self.do("calculate")

    def activate(self, steal_focus: Any = None) -> None:
        """Nothing to do: there is no other."""

    def alert(self, prompt: str, title: str, buttons: str, mode: str, _callback: Any) -> str:
        note("alert", text=prompt, title=title, buttons=buttons, mode=mode)
        return "ok"


class Books:
    """The one workbook that is driven."""

    api = True

    def __init__(self, app: App) -> None:
        self.app = app
        self.active = Book(app)

    def __iter__(self) -> Iterator[Book]:
        return iter([self.active])

    def __len__(self) -> int:
        return 1

    def __call__(self, key: int | str) -> Book:
        if key not in (1, self.active.name):
            raise KeyError(key)
        return self.active

    def __contains__(self, key: int | str) -> bool:
        return key in (1, self.active.name)


class Book:
    """The open workbook."""

    api = True

    def __init__(self, app: App) -> None:
        self.app = app
        self.do = app.do
        self.sheets = Sheets(self)
        self.names = Names(self)

    @property
    def name(self) -> str:
        return self.do("book")["name"]

    @property
    def fullname(self) -> str:
        return self.do("book")["path"] or self.name

    def save(self, path: str | None, password: str | None = None) -> None:
        if password:
            raise NotImplementedError("no passwords")
        self.do("save_as", path=path and str(Path(path).absolute()))

    def activate(self) -> None:
        """Nothing to do: there is no other."""


class _Listed:
    """A collection whose members have names."""

    api = True

    def __init__(self, parent: Any) -> None:
        self.parent = parent
        self.do = parent.do

    def __iter__(self) -> Iterator[Any]:
        return iter(self.listed())

    def __len__(self) -> int:
        return len(self.listed())

    def __call__(self, key: int | str) -> Any:
        members = self.listed()
        if isinstance(key, int):
            return members[key - 1]
        found = [one for one in members if one.name.lower() == key.lower()]
        if not found:
            raise KeyError(key)
        return found[0]

    def __contains__(self, key: int | str) -> bool:
        return key in range(1, 1 + len(self)) or key in [one.name for one in self]


class Sheets(_Listed):
    """The sheets of the workbook."""

    def listed(self) -> list[Sheet]:
        return [Sheet(self.parent, name) for name in self.do("sheets")]

    @property
    def active(self) -> Sheet:
        return Sheet(self.parent, self.do("active"))


class Sheet:
    """One sheet."""

    api = True

    def __init__(self, book: Book, name: str) -> None:
        self.book = book
        self.do = book.do
        self.name = name
        self.tables = Tables(self)
        self.page_setup = PageSetup(self)

    @property
    def index(self) -> int:
        return 1 + self.do("sheets").index(self.name)

    @property
    def used_range(self) -> Range:
        return Range(self, Area(self.name, *self.do("used", sheet=self.name)))

    @property
    def cells(self) -> Range:
        return Range(self, Area(self.name, 0, 0, 1048576, 16384))

    def range(self, first: Any, last: Any = None) -> Range:
        if isinstance(first, tuple) and len(first) == 4:  # row, column and shape
            row, column, rows, columns = first
            if not rows * columns:
                raise ValueError("a range without cells")
            return Range(self, Area(self.name, row - 1, column - 1, rows, columns))
        if isinstance(first, tuple) and isinstance(first[0], tuple):
            first, last = first
        start = self._block(first)
        end = self._block(last) if last is not None else start
        row, column = min(start.row, end.row), min(start.column, end.column)
        rows = max(start.row + start.rows, end.row + end.rows) - row
        columns = max(start.column + start.columns, end.column + end.columns) - column
        return Range(self, Area(self.name, row, column, rows, columns))

    def activate(self) -> None:
        self.do("activate", sheet=self.name)

    select = activate

    def _block(self, place: Any) -> Area:
        if isinstance(place, Range):
            return place.area
        if isinstance(place, tuple):
            return Area(self.name, place[0] - 1, place[1] - 1)
        if _CELLS.fullmatch(place):
            return area_of(f"'{self.name}'!{place.upper()}")
        return self.book.names(place).refers_to_range.area


class PageSetup:
    """How a sheet is printed."""

    api = True

    def __init__(self, sheet: Sheet) -> None:
        self.sheet = sheet

    @property
    def print_area(self) -> str | None:
        blocks = self.sheet.do("print_areas", sheet=self.sheet.name, places=None)
        return ",".join(Area(self.sheet.name, *block).absolute for block in blocks) or None

    @print_area.setter
    def print_area(self, value: str | None) -> None:
        places = [(self.sheet.name, part) for part in (value or "").split(",") if part]
        self.sheet.do("print_areas", sheet=self.sheet.name, places=places)


class Tables(_Listed):
    """The tables of a sheet."""

    def listed(self) -> list[Table]:
        tables = self.do("tables", sheet=self.parent.name)
        return [Table(self.parent, name) for name, _ in tables]


class Table:
    """One table: LibreOffice calls it a database range."""

    api = True

    def __init__(self, sheet: Sheet, name: str) -> None:
        self.parent = sheet
        self.name = name

    @property
    def range(self) -> Range:
        block = dict(self.parent.do("tables", sheet=self.parent.name))[self.name]
        return Range(self.parent, Area(self.parent.name, *block))

    def resize(self, range: xw.Range) -> None:  # noqa: A002 (xlwings' word)
        self.parent.do("resize", table=self.name, place=sent(range.impl.area))


class Names(_Listed):
    """The defined names of the workbook, and those of its sheets as ``Sheet!Name``."""

    def listed(self) -> list[Name]:
        return [Name(self.parent, name) for name in self.do("names")]

    def snapshot(self) -> list[tuple[str, Name]]:
        return [(name.name, name) for name in self.listed()]

    def contains(self, key: str) -> bool:
        return key.lower() in [name.name.lower() for name in self]

    def add(self, name: str, refers_to: str) -> Name:
        made = Name(self.parent, name)
        made.refers_to = refers_to
        return made


class Name:
    """One defined name; the key is LibreOffice's name for it."""

    api = True

    def __init__(self, book: Book, key: str) -> None:
        self.book = book
        self.key = key

    @property
    def name(self) -> str:
        sheet, _, name = self.key.rpartition("!")
        name = name.removeprefix("_xlnm.")
        return f"{sheet_in_excel(sheet)}!{name}" if sheet else name

    def delete(self) -> None:
        self.book.do("remove_name", name=self.key)

    @property
    def refers_to(self) -> str:
        return "=" + to_excel(self.book.do("name", name=self.key, content=None))

    @refers_to.setter
    def refers_to(self, value: str) -> None:
        self.book.do("name", name=self.key, content=to_calc(value.removeprefix("=")))

    @property
    def refers_to_range(self) -> Range:
        area = area_of(self.refers_to.removeprefix("="))
        return Range(self.book.sheets(area.sheet), area)


class Range:
    """A block of cells."""

    api = True
    max_cells_per_read = max_cells_per_write = None

    def __init__(self, sheet: Sheet, area: Area) -> None:
        self.sheet = sheet
        self.area = area
        self.font = Font(self)
        self.borders = Borders(self)

    def do(self, command: str, **details: Any) -> Any:
        """Have the worker do something with these cells."""
        return self.sheet.do(command, place=sent(self.area), **details)

    @property
    def row(self) -> int:
        return 1 + self.area.row

    @property
    def column(self) -> int:
        return 1 + self.area.column

    @property
    def shape(self) -> tuple[int, int]:
        return self.area.rows, self.area.columns

    @property
    def coords(self) -> tuple[str, int, int, int, int]:
        return self.sheet.name, self.row, self.column, *self.shape

    def __len__(self) -> int:
        return self.area.rows * self.area.columns

    def __call__(self, row: int, column: int | None = None) -> Range:
        if column is None:  # cells count row by row
            row, column = (1 + part for part in divmod(row - 1, self.area.columns))
        return Range(self.sheet, self.area.cell(row - 1, column - 1))

    @property
    def address(self) -> str:
        return self.area.absolute

    def get_address(self, row_absolute: Any, column_absolute: Any, external: Any) -> str:
        first, last = (self.area.row, self.area.column), (self.area.rows, self.area.columns)
        ends = dict.fromkeys([first, (first[0] + last[0] - 1, first[1] + last[1] - 1)])
        text = ":".join(xl_rowcol_to_cell(*end, row_absolute, column_absolute) for end in ends)
        return f"'[{self.sheet.book.name}]{self.sheet.name}'!{text}" if external else text

    @property
    def raw_value(self) -> Any:
        return _one_or_all(self._cells(formulas=False)[0])

    @raw_value.setter
    def raw_value(self, value: Any) -> None:
        if not isinstance(value, list | tuple):
            if len(self) > 1 and isinstance(value, str) and value.startswith("="):
                raise NotImplementedError("one formula for many cells")
            value = [[value] * self.area.columns] * self.area.rows
        elif not isinstance(value[0], list | tuple):
            value = [value]
        rows = [[read_typed(cell) for cell in row] for row in value]
        formulas = [
            [to_calc(c) if isinstance(c, str) and c.startswith("=") else "" for c in row]
            for row in rows
        ]
        kinds = {bool: LOGICAL, dt.datetime: DATE}
        self.do(
            "fill",
            constants=[
                [None if formula else _constant(cell) for cell, formula in zip(*both, strict=True)]
                for both in zip(rows, formulas, strict=True)
            ],
            formulas=formulas if any(map(any, formulas)) else None,
            kinds=[
                (row, column, kinds[type(cell)])
                for row, cells in enumerate(rows)
                for column, cell in enumerate(cells)
                if type(cell) in kinds
            ],
        )

    @property
    def formula(self) -> Any:
        values, texts = self._cells(formulas=True)
        return _one_or_all(
            [
                [
                    to_excel(text) if text.startswith(("=", "{=")) else _shown(value)
                    for text, value in zip(*both, strict=True)
                ]
                for both in zip(texts, values, strict=True)
            ]
        )

    @formula.setter
    def formula(self, value: Any) -> None:
        self.raw_value = value

    formula2 = formula

    def _cells(self, *, formulas: bool) -> tuple[list[list[Any]], list[list[str]]]:
        """Return values as Excel has them, and formulas if wanted."""
        cells = self.do("cells", formulas=formulas)
        rows = [[_value(cell) for cell in row] for row in cells["values"]]
        for kind, block in cells["kinds"]:
            where = Area("", *block)
            for row in range(where.row - self.area.row, where.row - self.area.row + where.rows):
                first = where.column - self.area.column
                for column in range(first, first + where.columns):
                    rows[row][column] = _of_kind(rows[row][column], kind)
        return rows, cells["formulas"]

    @property
    def number_format(self) -> str | None:
        return self.do("number_format", code=None)

    @number_format.setter
    def number_format(self, code: str) -> None:
        self.do("number_format", code=code)

    @property
    def row_height(self) -> float | None:
        return self.do("height")

    color = _style("CellBackColor", _rgb, _tuple)
    wrap_text = _style("IsTextWrapped", bool, bool)
    horizontal_alignment = _style("HoriJustify", *_enum("table.CellHoriJustify", HORIZONTAL))
    vertical_alignment = _style(
        "VertJustify", VERTICAL.__getitem__, {v: k for k, v in VERTICAL.items()}.get
    )

    def merge(self, across: Any) -> None:
        for rows in range(self.area.rows) if across else [slice(None)]:
            xw.Range(impl=self)[rows, :].impl.do("merge", merged=True)

    def unmerge(self) -> None:
        self.do("merge", merged=False)

    def clear_contents(self) -> None:
        self.do("clear", flags=CONTENTS)

    def clear_formats(self) -> None:
        self.do("clear", flags=FORMATS)

    def clear(self) -> None:
        self.do("clear", flags=CONTENTS + FORMATS)

    def select(self) -> None:
        self.do("select")


def _one_or_all(rows: list[list[Any]]) -> Any:
    """Return what COM does: the value of a single cell, else rows."""
    return rows[0][0] if len(rows) == len(rows[0]) == 1 else tuple(map(tuple, rows))


def _value(cell: float | str) -> Any:
    if cell in ERRORS:
        return CellError(cell)
    if isinstance(cell, str) and _OWN_ERROR.fullmatch(cell):
        return CellError("#VALUE!")
    return None if cell == "" else cell


def _of_kind(value: Any, kind: int) -> Any:
    """Return a number as what its format says."""
    if not isinstance(value, float):
        return value
    return bool(value) if kind == LOGICAL else EPOCH + dt.timedelta(days=value)


def _shown(value: Any) -> str:
    """Return a constant as Excel's formula bar has it."""
    if isinstance(value, bool | float):
        return str(value).upper().removesuffix(".0")
    if isinstance(value, dt.datetime):
        return _shown(_constant(value))
    return value or ""


class Font:
    """The font of a block of cells."""

    api = True

    def __init__(self, cells: Range) -> None:
        self.do = cells.do

    bold = _style("CharWeight", lambda on: 150.0 if on else 100.0, lambda weight: weight > 100)
    italic = _style(
        "CharPosture",
        lambda on: ["com.sun.star.awt.FontSlant", "ITALIC" if on else "NONE"],
        lambda slant: slant != "NONE",
    )
    size = _style("CharHeight", float, float)
    color = _style("CharColor", _rgb, _tuple)
    name = _style("CharFontName", str, str)


class Borders:
    """The lines around and inside a block of cells."""

    api = True

    def __init__(self, cells: Range) -> None:
        self.do = cells.do

    def __getitem__(self, side: str) -> Border:
        return Border(self, side)

    def set(
        self, sides: list[str], line_style: Any = _UNSET, weight: Any = _UNSET, color: Any = _UNSET
    ) -> None:
        changes = {}
        if line_style is None:
            changes["LineWidth"] = 0
        elif line_style is not _UNSET:
            changes["LineStyle"] = LINE_STYLES[line_style]
        if weight is not _UNSET:
            changes["LineWidth"] = LINE_WIDTHS[weight]
        if color is not _UNSET:
            changes["Color"] = _rgb(color)
        self.do("borders", sides=[SIDES[side] for side in sides if side in SIDES], changes=changes)


class Border:
    """The line at one side; it can be set, not asked."""

    api = True

    def __init__(self, borders: Borders, side: str) -> None:
        self._set = lambda **change: borders.set([side], **change)

    line_style = property(None, lambda self, value: self._set(line_style=value))
    weight = property(None, lambda self, value: self._set(weight=value))
    color = property(None, lambda self, value: self._set(color=value))


def note(kind: str, **details: Any) -> None:
    """Write down what a person would see, if somebody wants to know."""
    if path := os.environ.get(LOG):
        with Path(path).open("a", encoding="utf-8") as file:
            file.write(json.dumps({"kind": kind, "time": time.time(), **details}) + "\n")


def noted(path: Path) -> list[dict[str, Any]]:
    """Return the status texts and alerts of all processes, in order."""
    lines = path.read_text(encoding="utf-8").splitlines() if path.exists() else []
    return [json.loads(line) for line in lines]


def book_of(office: Office) -> xw.Book:
    """Return the workbook that is open, for xlwings; its caller, and the active engine, from now on."""
    ENGINE.apps.app = App(office)
    if ENGINE.name not in [engine.name for engine in xw.engines]:
        xw.engines.add(Engine(ENGINE))
    xw.engines[ENGINE.name].activate()
    book = xw.Book(impl=ENGINE.apps.app.books.active)
    book.set_mock_caller()
    return book


def connect(pipe: str, book_name: str) -> xw.Book:
    """Return a workbook that is open in the LibreOffice of another process; see :func:`book_of`."""
    office = Office(pipe=pipe)
    atexit.register(office.end)
    office.do("bind", name=book_name)
    return book_of(office)
