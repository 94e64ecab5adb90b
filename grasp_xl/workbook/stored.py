"""The cells of a workbook that is a file."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

from openpyxl import Workbook
from openpyxl.chartsheet import Chartsheet

from grasp_xl.errors import InputError, Problem
from grasp_xl.workbook.cells import Grid, Value
from grasp_xl.workbook.package import Package, open_workbook, sheet_rows

MAX_FILLED_ROWS = 250_000
"""Rows of one sheet that hold anything: the longest list of footprints, and room for more."""

MAX_CELLS = 10_000_000
"""Cells of one sheet, in each row up to the last one that the file has."""

_AS_FAR_AS_A_ROW_GOES = 0


@dataclass(frozen=True)
class StoredCells:
    """The cells of a file, with the values that the last program stored.

    Parameters
    ----------
    package : Package
    """

    package: Package

    @property
    def name(self) -> str:
        """File name as the person gave it."""
        return self.package.name

    @cached_property
    def sheets(self) -> list[str]:
        """Names of all sheets, in order."""
        return list(self._values.sheetnames)

    @cached_property
    def references(self) -> dict[str, str]:
        """What its defined names stand for."""
        names = self._values.defined_names.items()
        return {name: definition.attr_text or "" for name, definition in names}

    @cached_property
    def _values(self) -> Workbook:
        return open_workbook(self.package, formulas=False)

    @cached_property
    def _formulas(self) -> Workbook:  # opened only where a formula matters
        return open_workbook(self.package, formulas=True)

    def grid(self, sheet: str, *, formulas: bool, rows: int) -> Grid:
        """Read the values of a sheet's first rows, or its formulas alone.

        Raises
        ------
        InputError
            If the sheet is larger than any option space.
        """
        worksheet = (self._formulas if formulas else self._values)[sheet]
        filled: dict[int, tuple[Value, ...]] = {}
        if isinstance(worksheet, Chartsheet):
            return Grid(sheet, filled)
        size = 0
        for number, cells in sheet_rows(self.package, worksheet, _AS_FAR_AS_A_ROW_GOES):
            if number > rows:
                break
            size += len(cells)
            if formulas:
                values = [cell.value if cell.data_type == "f" else None for cell in cells]
            else:
                values = [cell.value for cell in cells]
            while values and values[-1] is None:
                values.pop()
            if values:
                filled[number - 1] = tuple(values)
            if len(filled) > MAX_FILLED_ROWS:
                raise _too_many(sheet, "filled rows", MAX_FILLED_ROWS)
            if size > MAX_CELLS:
                raise _too_many(sheet, "cells", MAX_CELLS)
        return Grid(sheet, filled)


def _too_many(sheet: str, what: str, limit: int) -> InputError:
    hint = "use a larger pitch, and move other data to another sheet"
    return InputError([Problem(sheet, f"more than {limit:,} {what}", f"at most {limit:,}", hint)])
