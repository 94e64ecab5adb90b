"""Cells of a workbook that is being read: values by place, name or label, and what is wrong."""

from __future__ import annotations

import datetime
import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property

from openpyxl import Workbook

from grasp_xl.errors import InputError, Problem
from grasp_xl.workbook.layout import SHEETS, Area, Field, area_of, place
from grasp_xl.workbook.package import Package, open_workbook, sheet_rows

MAX_NUMBER = 1e9
"""Largest magnitude of any number: no mass in g or place in mm comes near it."""

MAX_COLUMNS = 1_000
"""Columns that are looked at on a sheet."""

MAX_PROBLEMS = 50
"""Problems that are named; a list of all would help nobody."""

LABEL_ROWS = 500
"""Rows in which labels are looked for."""

ERROR_VALUES = ("#N/A", "#REF!", "#DIV/0!", "#VALUE!", "#NAME?", "#NUM!", "#NULL!")

Value = object


class Grid:
    """Values of one sheet, row by row; cells count from 0."""

    def __init__(self, sheet: str, rows: dict[int, tuple[Value, ...]]) -> None:
        self.sheet = sheet
        self.rows = rows

    @property
    def last_row(self) -> int:
        """Last row that holds anything; -1 on an empty sheet."""
        return max(self.rows, default=-1)

    def at(self, row: int, column: int) -> Value:
        """Value of a cell, None where there is none."""
        cells = self.rows.get(row, ())
        return cells[column] if column < len(cells) else None

    def find(self, label: str, *, column: int | None = None, below: int = -1) -> Area | None:
        """Find the first cell that holds a label, among the sheet's first rows."""
        wanted = normal(label)
        for row in sorted(row for row in self.rows if below < row < LABEL_ROWS):
            for number, value in enumerate(self.rows[row]):
                if column is not None and number != column:
                    continue
                if isinstance(value, str) and normal(value) == wanted:
                    return Area(self.sheet, row, number)
        return None


def normal(text: str) -> str:
    """Fold what people change without noticing: case and white space."""
    return " ".join(text.split()).casefold()


def read_grid(package: Package, book: Workbook, sheet: str) -> Grid:
    """Read all values of a sheet."""
    rows: dict[int, tuple[Value, ...]] = {}
    for number, cells in sheet_rows(package, book[sheet], MAX_COLUMNS):  # type: ignore[arg-type]
        values = tuple(cell.value for cell in cells)
        if any(value is not None for value in values):
            rows[number - 1] = values
    return Grid(sheet, rows)


@dataclass
class Source:
    """A workbook that is being read: its sheets, its names, and the problems found so far."""

    package: Package
    problems: list[Problem] = field(default_factory=list)
    warnings: list[Problem] = field(default_factory=list)
    _grids: dict[tuple[str, bool], Grid] = field(default_factory=dict)

    @cached_property
    def values(self) -> Workbook:
        """The workbook with the values that the last program stored."""
        return open_workbook(self.package, formulas=False)

    @cached_property
    def formulas(self) -> Workbook:
        """The workbook with its formulas; opened only where a formula matters."""
        return open_workbook(self.package, formulas=True)

    @cached_property
    def names(self) -> dict[str, Area]:
        """Defined names that stand for a block of cells on a sheet that exists."""
        areas = {}
        for name, definition in self.values.defined_names.items():
            try:
                area = area_of(definition.attr_text or "")
            except ValueError:
                continue
            if area.sheet in self.values.sheetnames:
                areas[name] = area
        return areas

    @property
    def sheets(self) -> list[str]:
        """Names of all sheets, in order."""
        return list(self.values.sheetnames)

    @property
    def foreign_sheets(self) -> list[str]:
        """Sheets that are none of ours."""
        return [sheet for sheet in self.sheets if sheet not in SHEETS]

    def grid(self, sheet: str, *, formulas: bool = False) -> Grid:
        """Return the values (or formulas) of a sheet, read once."""
        key = (sheet, formulas)
        if key not in self._grids:
            book = self.formulas if formulas else self.values
            self._grids[key] = read_grid(self.package, book, sheet)
        return self._grids[key]

    def formula(self, cell: Area) -> str | None:
        """Return the formula of a cell, without ``=``; None where it holds none."""
        value = self.grid(cell.sheet, formulas=True).at(cell.row, cell.column)
        text = getattr(value, "text", value)  # an array formula is an object
        return text[1:] if isinstance(text, str) and text.startswith("=") else None

    def locate(self, sheet: str, field: Field, *, heading: Area | None = None) -> Area | None:
        """Find an input cell: by its defined name, else right of its label."""
        if field.name in self.names:
            area = self.names[field.name]
            return area.cell(0, 0)
        grid = self.grid(sheet)
        if heading is None:
            label = grid.find(field.label)
        else:
            label = grid.find(field.label, column=heading.column, below=heading.row)
        return label.cell(0, 1) if label else None

    def value(self, cell: Area) -> Value:
        """Return the value of a cell."""
        return self.grid(cell.sheet).at(cell.row, cell.column)

    def complain(self, where: str, found: str, expected: str, hint: str = "") -> None:
        """Note a problem; reading goes on, so that all are told at once."""
        self.problems.append(Problem(where, found, expected, hint))

    def warn(self, where: str, found: str, expected: str, hint: str = "") -> None:
        """Note something odd that does no harm."""
        self.warnings.append(Problem(where, found, expected, hint))

    def finish(self) -> None:
        """Raise what was found wrong.

        Raises
        ------
        InputError
            With every problem, if there is any.
        """
        if len(self.problems) > MAX_PROBLEMS:
            more = len(self.problems) - MAX_PROBLEMS
            rest = Problem(self.package.name, f"{more} more problems", "none", "mend these first")
            raise InputError([*self.problems[:MAX_PROBLEMS], rest])
        if self.problems:
            raise InputError(self.problems)

    def blank(self, cell: Area) -> bool:
        """Tell whether a cell is empty, or holds white space only."""
        value = self.value(cell)
        empty = value is None or (isinstance(value, str) and not value.strip())
        return empty and self.formula(cell) is None

    def number(
        self,
        cell: Area,
        expected: str = "a number",
        *,
        above: float = -math.inf,
        least: float = -math.inf,
        most: float = math.inf,
        whole: bool = False,
        limit: float = MAX_NUMBER,
    ) -> float | None:
        """Read a number, or note why there is none.

        Parameters
        ----------
        cell : Area
        expected : str
            Words for the message.
        above, least, most : float
            Bounds; ``above`` excluded.
        whole : bool
            Whether fractions are refused.
        limit : float
            Magnitude beyond which no number is believed.
        """
        value = self.value(cell)
        found = self.fault(cell, value, limit)
        if found is None:
            assert isinstance(value, int | float)  # noqa: S101 (fault() says so)
            if not (value > above and least <= value <= most):
                found = f"{value:g}"
            elif whole and value != round(value):
                found = f"the fraction {value:g}"
            else:
                return float(value)
        self.complain(cell.where, found, expected, _hint(found))
        return None

    def fault(self, cell: Area, value: Value, limit: float = MAX_NUMBER) -> str | None:
        """Say why a cell's value is no usable number; None if it is one."""
        if value is None or (isinstance(value, str) and not value.strip()):
            if self.formula(cell) is not None:
                return "a formula without a stored value"
            return "an empty cell"
        return number_fault(value, limit)


def number_fault(value: Value, limit: float = MAX_NUMBER) -> str | None:
    """Say why a value is no usable number; None if it is one."""
    if isinstance(value, bool):
        return f"the truth value {str(value).upper()}"
    if isinstance(value, int | float):
        if isinstance(value, float) and not math.isfinite(value):
            return f"{value}, which is not finite"
        return f"a number beyond {limit:g}" if abs(value) > limit else None
    if isinstance(value, datetime.date | datetime.time | datetime.timedelta):
        return f"the date or time {value}"
    text = str(value)
    if text in ERROR_VALUES:
        return f"the error value {text}"
    return f"the text {text[:40]!r}"


def _hint(found: str) -> str:
    if found.startswith("a formula"):
        return "open the workbook in Excel or LibreOffice and save it, so that it stores values"
    if found.startswith("the text"):
        return "type it as a number; a cell formatted as text must be reformatted first"
    return "type a number there"


def cells_of(area: Area) -> Iterator[Iterator[Area]]:
    """Iterate over the rows of an area, and over the cells of each."""
    for row in range(area.rows):
        yield (area.cell(row, column) for column in range(area.columns))


def where_column(grid: Grid, row: int, column: int) -> str:
    """Name a cell of a grid."""
    return place(grid.sheet, row, column)
