"""What a designer does to a workbook, with openpyxl, which loses the cached values of formulas."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import openpyxl

Edit = Callable[[openpyxl.Workbook], object]
"""A change of an opened workbook."""


def edit(book: Path, *changes: Edit) -> None:
    """Change a workbook and save it."""
    opened = openpyxl.load_workbook(book)
    for change in changes:
        change(opened)
    opened.save(book)


def cell_of(opened: openpyxl.Workbook, name: str, row: int = 0, column: int = 0) -> Any:
    """Return a cell of a named area, counted from its first."""
    sheet, cells = opened.defined_names[name].attr_text.replace("$", "").split("!")
    return opened[sheet.strip("'")][cells.split(":")[0]].offset(row, column)


def typed(name: str, value: object, row: int = 0, column: int = 0) -> Edit:
    """Type into a cell of a named area."""
    return lambda opened: setattr(cell_of(opened, name, row, column), "value", value)


def in_cell(sheet: str, cell: str, value: object) -> Edit:
    """Type into a cell."""
    return lambda opened: opened[sheet].__setitem__(cell, value)


def files(folder: Path) -> list[str]:
    """Names of all files in a folder."""
    return sorted(file.name for file in folder.iterdir())
