"""Cells of a workbook that is being read: values by place, name or label, and what is wrong."""

from __future__ import annotations

import datetime as dt
import math
import re
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass, field
from functools import cached_property, lru_cache
from typing import NamedTuple, Protocol

from grasp_xl.errors import Problem, refuse
from grasp_xl.workbook.layout import CONFIGURATION, OCCASIONAL, SHEETS, Area, Field, area_of
from grasp_xl.workbook.package import MAX_ROWS

MAX_NUMBER = 1e9
"""Largest magnitude of any number: no mass in g or place in mm comes near it."""

MIN_DISTANCE = 1e-9
"""How far a number must keep from a bound that it may not touch, since others are divided by it."""

LABEL_ROWS = 500
"""Rows in which labels are looked for."""

ERROR_VALUES = ("#N/A", "#REF!", "#DIV/0!", "#VALUE!", "#NAME?", "#NUM!", "#NULL!")

_PLACE = re.compile(r".+!\$?[A-Z]{1,3}\$?[1-9]\d*(:\$?[A-Z]{1,3}\$?[1-9]\d*)?")
_NUMBER = re.compile(r"(?<![A-Z0-9_.])\d+(\.\d+)?(E[+-]?\d+)?(?![A-Z0-9_.(])")
_MAX_DIGITS = 20  # of a whole number that a message shows
_FORMULAS = 2**16  # that are kept folded: each is compared a few times

Value = object


class Fault(NamedTuple):
    """Why a value is no usable number, and what to do about it."""

    found: str
    hint: str


EMPTY = Fault("an empty cell", "type a number there")
UNCALCULATED = Fault(
    "a formula without a stored value",
    "open the workbook in Excel or LibreOffice and save it, so that it stores values",
)


class Grid:
    """Values of one sheet, row by row; cells count from 0."""

    def __init__(self, sheet: str, rows: dict[int, tuple[Value, ...]]) -> None:
        self.sheet = sheet
        self.rows = rows

    def at(self, row: int, column: int) -> Value:
        """Value of a cell, None where there is none."""
        cells = self.rows.get(row, ())
        return cells[column] if column < len(cells) else None

    def places(
        self, label: str, *, rows: range = range(LABEL_ROWS), column: int | None = None
    ) -> Iterator[Area]:
        """Iterate over the cells that hold a label, row by row."""
        wanted = normal(label)
        for row in rows:
            for number, value in enumerate(self.rows.get(row, ())):
                if column not in (None, number) or not isinstance(value, str):
                    continue
                if normal(value) == wanted:
                    yield Area(self.sheet, row, number)

    def find(
        self, label: str, *, rows: range = range(LABEL_ROWS), column: int | None = None
    ) -> Area | None:
        """Find the first cell that holds a label."""
        return next(self.places(label, rows=rows, column=column), None)


def normal(text: str) -> str:
    """Fold what people change without noticing: case and white space."""
    return " ".join(text.split()).casefold()


def is_blank(value: Value) -> bool:
    """Tell whether there is nothing, or white space only."""
    return value is None or (isinstance(value, str) and not value.strip())


class Cells(Protocol):
    """A workbook whose cells can be read: a file, or one that is open in Excel."""

    @property
    def name(self) -> str:
        """What a person calls it."""

    @property
    def sheets(self) -> list[str]:
        """Names of all sheets, in order."""

    @property
    def references(self) -> dict[str, str]:
        """What its defined names stand for: ``'GA'!$B$5:$C$6``."""

    def grid(self, sheet: str, *, formulas: bool, rows: int) -> Grid:
        """Read the values of a sheet's first rows, or its formulas alone (with ``=``).

        Raises
        ------
        InputError
            If the sheet is larger than any option space.
        """


@dataclass
class Source:
    """A workbook that is being read: its sheets, its names, and the problems found so far."""

    cells: Cells
    problems: list[Problem] = field(default_factory=list)
    warnings: list[Problem] = field(default_factory=list)
    worked_out: dict[Area, Value] = field(default_factory=dict)
    """Values of cells that hold formulas of ours; what is stored there does not matter."""
    _grids: dict[tuple[str, bool, int], Grid] = field(default_factory=dict)

    @cached_property
    def names(self) -> dict[str, Area]:
        """Defined names that stand for a block of cells on a sheet that exists."""
        areas = {}
        for name, reference in self.cells.references.items():
            if not _PLACE.fullmatch(reference):  # a constant or a calculation
                continue
            with suppress(ValueError):
                area = area_of(reference)
                if area.sheet in self.sheets:
                    areas[name] = area
        return areas

    @property
    def name(self) -> str:
        """What a person calls the workbook."""
        return self.cells.name

    @property
    def sheets(self) -> list[str]:
        """Names of all sheets, in order."""
        return self.cells.sheets

    @property
    def foreign_sheets(self) -> list[str]:
        """Sheets that are none of ours."""
        return [
            sheet for sheet in self.sheets if sheet not in (*SHEETS, *OCCASIONAL, CONFIGURATION)
        ]

    def grid(self, sheet: str, *, formulas: bool = False, rows: int = MAX_ROWS) -> Grid:
        """Return the values (or formulas) of a sheet or of its first rows, read once."""
        whole = self._grids.get((sheet, formulas, MAX_ROWS))
        if whole:
            return whole
        key = (sheet, formulas, rows)
        if key not in self._grids:
            self._grids[key] = self.cells.grid(sheet, formulas=formulas, rows=rows)
        return self._grids[key]

    def sheets_with(self, label: str) -> Iterator[Area]:
        """Iterate over the label's first cell on each sheet; what stands below is not read."""
        for sheet in self.sheets:
            grid = self.cells.grid(sheet, formulas=False, rows=LABEL_ROWS)
            if found := grid.find(label):
                yield found

    def formula(self, cell: Area) -> str | None:
        """Return the formula of a cell, without ``=``; None where it holds none."""
        value = self._grid_with(cell, formulas=True).at(cell.row, cell.column)
        text = getattr(value, "text", value)  # an array formula is an object
        return text.removeprefix("=") if isinstance(text, str) else None

    def locate(
        self,
        sheet: str,
        field: Field,
        *,
        rows: range = range(LABEL_ROWS),
        column: int | None = None,
    ) -> Area | None:
        """Find an input cell: by its defined name, else right of its label."""
        if field.name in self.names:
            return self.names[field.name].cell(0, 0)
        label = self.grid(sheet).find(field.label, rows=rows, column=column)
        return label.cell(0, 1) if label else None

    def value(self, cell: Area) -> Value:
        """Return the value of a cell."""
        if cell in self.worked_out:
            return self.worked_out[cell]
        return self._grid_with(cell).at(cell.row, cell.column)

    def _grid_with(self, cell: Area, *, formulas: bool = False) -> Grid:
        """Return the first rows of a cell's sheet if it is there: long lists stand below inputs."""
        rows = LABEL_ROWS if cell.row < LABEL_ROWS else MAX_ROWS
        return self.grid(cell.sheet, formulas=formulas, rows=rows)

    def complain(self, where: str, found: str, expected: str, hint: str) -> None:
        """Note a problem; reading goes on, so that all are told at once."""
        self.problems.append(Problem(where, found, expected, hint))

    def warn(self, where: str, found: str, expected: str, hint: str) -> None:
        """Note something odd that does no harm."""
        self.warnings.append(Problem(where, found, expected, hint))

    def finish(self) -> None:
        """Raise what was found wrong.

        Raises
        ------
        InputError
            With every problem, if there is any; with a count of those after the first fifty.
        """
        refuse(self.problems, self.name)

    def blank(self, cell: Area) -> bool:
        """Tell whether a cell is empty, or holds white space only."""
        return is_blank(self.value(cell)) and self.formula(cell) is None

    def number(
        self,
        cell: Area,
        expected: str,
        *,
        above: float = -math.inf,
        least: float = -math.inf,
        most: float = math.inf,
        whole: bool = False,
        limit: float = MAX_NUMBER,
        hint: str = "correct the number",
    ) -> float | None:
        """Read a number, or note why there is none.

        Parameters
        ----------
        cell : Area
            Where it stands.
        expected : str
            Words for the message.
        above, least, most : float
            Bounds; ``above`` excluded.
        whole : bool
            Whether fractions are refused.
        limit : float
            Magnitude beyond which no number is believed.
        hint : str
            What to do about a number that is out of bounds.
        """
        number = as_number(self.value(cell), limit)
        if isinstance(number, float):
            if above < number < above + MIN_DISTANCE:
                number = Fault(shown(number), f"type at least {shown(above + MIN_DISTANCE)}")
            elif not (above < number and least <= number <= most):
                number = Fault(shown(number), hint)
            elif whole and not number.is_integer():
                number = Fault(f"the fraction {shown(number)}", "type a whole number")
            else:
                return number
        if number is EMPTY and self.formula(cell) is not None:
            number = UNCALCULATED
        self.complain(cell.where, number.found, expected, number.hint)
        return None


def as_number(value: Value, limit: float = MAX_NUMBER) -> float | Fault:
    """Turn a cell's value into a number, or say why it is no usable one."""
    if isinstance(value, int | float) and not isinstance(value, bool):
        if abs(value) <= limit:  # compares exactly, however long a whole number is
            return float(value)
        return Fault(shown(value), f"type a number of at most {limit:,.0f}")
    return EMPTY if is_blank(value) else _no_number(value)


def _no_number(value: Value) -> Fault:
    if isinstance(value, bool):
        return Fault(f"the truth value {str(value).upper()}", "type a number there")
    if isinstance(value, dt.date | dt.time | dt.timedelta):
        hint = "type the number again and give the cell a number format, not a date's"
        return Fault(f"the date or time {value}", hint)
    text = str(value)
    if text in ERROR_VALUES:
        return Fault(f"the error value {text}", "mend the formula, or type a number there")
    hint = "type it as a number; a cell formatted as text must be reformatted first"
    return Fault(f"the text {text[:40]!r}", hint)


def shown(number: float) -> str:
    """Write a number for a message: as a person would type it.

    Examples
    --------
    >>> shown(-8860.0), shown(2.5), shown(1e308), shown(10**400)
    ('-8860', '2.5', '1e+308', 'a number of 401 digits')
    """
    if isinstance(number, int):
        digits = len(str(abs(number)))
        return str(number) if digits <= _MAX_DIGITS else f"a number of {digits} digits"
    return repr(number).removesuffix(".0")


@lru_cache(maxsize=_FORMULAS)
def same_formula(text: str | None) -> str:
    """Fold what programs write in different ways; empty for no formula.

    Examples
    --------
    >>> same_formula("=Sum( $A$1 , 'GA'!B2)"), same_formula("IF(A1<1E-9,TRUE(),2.50)")
    ('SUM(A1,GA!B2)', 'IF(A1<1e-09,TRUE,2.5)')
    """
    plain = re.sub(r"[\s$']|(?<=TRUE|ALSE)\(\)", "", (text or "").upper()).removeprefix("=")
    return _NUMBER.sub(lambda number: f"{float(number[0]):.12g}", plain)


def cells_of(area: Area) -> Iterator[Iterator[Area]]:
    """Iterate over the rows of an area, and over the cells of each."""
    for row in range(area.rows):
        yield (area.cell(row, column) for column in range(area.columns))
