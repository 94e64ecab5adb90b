"""What we wrote into a workbook, cell by cell: to tell what is ours, and to change an open one."""

from __future__ import annotations

from dataclasses import dataclass, field
from datetime import datetime
from typing import NamedTuple

from grasp_xl.workbook.layout import Area
from grasp_xl.workbook.styles import Style

CellValue = str | int | float | bool | None


class WrittenCell(NamedTuple):
    """What a cell holds: a value, its look, and where there is one the formula that gives it.

    The look of a cell that somebody else may have changed is None.
    """

    value: CellValue | datetime
    style: Style | None
    formula: str | None = None


@dataclass(slots=True)
class WrittenSheet:
    """One sheet, as far as it was written.

    Parameters
    ----------
    cells : dict
        By row and column, counted from 0.
    merged : set of Area
    tables : dict
        Excel tables with their headers, by name.
    printed : tuple of Area
        What is printed, a page or more each.
    """

    cells: dict[tuple[int, int], WrittenCell] = field(default_factory=dict)
    merged: set[Area] = field(default_factory=set)
    tables: dict[str, Area] = field(default_factory=dict)
    printed: tuple[Area, ...] = ()


@dataclass(frozen=True, slots=True)
class WrittenBook:
    """A workbook: the file, its sheets by name, and the cells of its defined names."""

    content: bytes
    sheets: dict[str, WrittenSheet]
    names: dict[str, Area]
