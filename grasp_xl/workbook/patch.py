"""What must be done to an open workbook so that it shows another result.

A workbook is written as it shall be, and compared with what stands in the open one.  Only what is
different is changed, in blocks, so that all else, formulas and a designer's own things, stays.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Collection, Container, Iterable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

from grasp_xl.workbook import fitness_sheet, run_log
from grasp_xl.workbook.cells import Source, same_formula
from grasp_xl.workbook.layout import FITNESS_TABLE, RUN_LOG, Area
from grasp_xl.workbook.styles import UNFORMATTED, formats_of
from grasp_xl.workbook.written import WrittenBook, WrittenCell, WrittenSheet

Place = tuple[int, int]
"""Row and column of a cell."""

FREE_COLUMNS = {RUN_LOG: run_log.WIDTH, FITNESS_TABLE: fitness_sheet.WIDTH}
"""Columns that are ours on sheets whose rows differ from run to run, whatever stands there."""


@dataclass(frozen=True)
class SheetPatch:
    """What changes on one sheet.

    Parameters
    ----------
    sheet : str
    before, after : WrittenSheet
    """

    sheet: str
    before: WrittenSheet
    after: WrittenSheet

    @cached_property
    def changed(self) -> frozenset[Place]:
        """Cells that shall hold something else."""
        old, new = self.before.cells, self.after.cells
        return frozenset(
            place
            for place in old.keys() | new.keys()
            if _content(old.get(place)) != _content(new.get(place))
        )

    def blocks(self, untouched: Callable[[Place], bool]) -> list[Area]:
        """Return the blocks of cells to write, few and large.

        Parameters
        ----------
        untouched : callable
            Whether a cell that does not change is as we wrote it: writing it again does no harm.
        """
        changed = self.changed
        kept = self.after.cells.keys() - changed
        return [*_blocks(self.sheet, changed, lambda place: place in kept and untouched(place))]

    def rows(self) -> list[Area]:
        """Return the first cells of the rows in which a cell changes, in runs."""
        return [*_blocks(self.sheet, {(row, 0) for row, _ in self.changed})]

    def cell(self, row: int, column: int) -> WrittenCell | None:
        """Return what a cell shall hold."""
        return self.after.cells.get((row, column))

    def looks(self) -> dict[tuple[str, Any], list[Area]]:
        """Return the blocks of cells that get another format property, by property and value.

        By property and not by style, since neighbours of different styles share most of them.
        """
        old, new = self.before.cells, self.after.cells
        places: dict[tuple[str, Any], set[Place]] = defaultdict(set)
        for place in old.keys() | new.keys():
            was, shall = _formats(old.get(place)), _formats(new.get(place))
            for name, value in shall.items():
                if name not in was or was[name] != value:
                    places[name, value].add(place)
        return {what: [*_blocks(self.sheet, cells)] for what, cells in places.items()}

    @property
    def unmerged(self) -> set[Area]:
        """Cells that are merged no longer."""
        return self.before.merged - self.after.merged

    @property
    def merged(self) -> set[Area]:
        """Cells that are merged from now on."""
        return self.after.merged - self.before.merged

    @property
    def tables(self) -> dict[str, Area]:
        """Tables that have another size."""
        old = self.before.tables
        return {name: area for name, area in self.after.tables.items() if old.get(name) != area}


@dataclass(frozen=True)
class Patch:
    """What changes in a workbook: its sheets, and the cells of its defined names.

    Parameters
    ----------
    before, after : WrittenBook
    """

    before: WrittenBook
    after: WrittenBook

    @cached_property
    def sheets(self) -> list[SheetPatch]:
        """Changes by sheet, for the sheets that both have."""
        return [
            SheetPatch(name, self.before.sheets[name], sheet)
            for name, sheet in self.after.sheets.items()
            if name in self.before.sheets
        ]

    @property
    def names(self) -> dict[str, Area]:
        """Defined names that stand for other cells from now on."""
        old = self.before.names
        return {name: area for name, area in self.after.names.items() if old.get(name) != area}

    @property
    def lost_names(self) -> list[str]:
        """Defined names that are gone."""
        return [name for name in self.before.names if name not in self.after.names]

    @property
    def back(self) -> Patch:
        """The way back."""
        return Patch(self.after, self.before)


def as_seen(
    source: Source, written: WrittenBook, after: WrittenBook, inputs: Container[Area]
) -> WrittenBook:
    """Return a workbook as it was written, but with what stands in its cells now.

    Parameters
    ----------
    source : Source
        The open workbook.
    written : WrittenBook
        What we would write into it as it is: gives looks and tables.
    after : WrittenBook
        What shall be written: cells of it that are new were seen, too.
    inputs : container of Area
        Cells that a person types into: a formula there is only a way to say its value.
    """
    sheets = {
        name: replace(sheet, cells=_seen(source, name, sheet, after.sheets[name], inputs))
        for name, sheet in written.sheets.items()
        if name in source.sheets and name in after.sheets
    }
    names = {name: source.names[name] for name in written.names if name in source.names}
    return replace(written, sheets=sheets, names=names)


def _seen(
    source: Source,
    name: str,
    sheet: WrittenSheet,
    after: WrittenSheet,
    inputs: Container[Area],
) -> dict[Place, WrittenCell]:
    values, formulas = source.grid(name), source.grid(name, formulas=True)
    ours: dict[Place, WrittenCell | None] = {**after.cells, **sheet.cells}
    free = FREE_COLUMNS.get(name, 0)
    for row, shown in values.rows.items():
        ours.update({(row, column): None for column in range(min(free, len(shown)))})
    cells = {}
    for place, cell in ours.items():
        value, formula = values.at(*place), formulas.at(*place)
        if place in sheet.cells or value is not None or formula is not None:
            ours_too = cell is not None and cell.formula is not None
            counts = ours_too or Area(name, *place) not in inputs
            text = str(formula).removeprefix("=") if formula is not None and counts else None
            cells[place] = WrittenCell(value, cell.style if cell else None, text)  # type: ignore[arg-type]
    return cells


def _formats(cell: WrittenCell | None) -> dict[str, Any]:
    """Return the format properties of a cell, as far as they are known."""
    if cell is None:
        return UNFORMATTED
    return formats_of(cell.style) if cell.style else {}


def _content(cell: WrittenCell | None) -> object:
    """Return what makes a cell another one: its formula, else its value, empty or not there."""
    if cell is None:
        return None
    return f"={same_formula(cell.formula)}" if cell.formula is not None else cell.value


def _blocks(
    sheet: str, places: Collection[Place], harmless: Callable[[Place], bool] = lambda _: False
) -> Iterator[Area]:
    """Cover cells with rectangles, row by row; they may hold harmless cells besides."""
    spans = sorted(
        (row, left, right)
        for row, columns in _by_row(places).items()
        for left, right in _spans(row, columns, harmless)
    )
    open_blocks: dict[Place, int] = {}  # first row, by the left and right column
    last_row: dict[Place, int] = {}
    for row, left, right in spans:
        here = (left, right)
        if here in open_blocks and last_row[here] == row - 1:
            last_row[here] = row
            continue
        if here in open_blocks:
            yield _area(sheet, open_blocks[here], last_row[here], here)
        open_blocks[here] = last_row[here] = row
    for here, first in open_blocks.items():
        yield _area(sheet, first, last_row[here], here)


def _area(sheet: str, first: int, last: int, columns: Place) -> Area:
    left, right = columns
    return Area(sheet, first, left, last - first + 1, right - left + 1)


def _by_row(places: Iterable[Place]) -> dict[int, list[int]]:
    rows: dict[int, list[int]] = defaultdict(list)
    for row, column in places:
        rows[row].append(column)
    return rows


def _spans(
    row: int, columns: list[int], harmless: Callable[[Place], bool]
) -> Iterator[tuple[int, int]]:
    """Join the columns of a row to spans; all that lies between two joined ones is harmless."""
    left, *rest = sorted(columns)
    right = left
    for column in rest:
        if all(harmless((row, between)) for between in range(right + 1, column)):
            right = column
        else:
            yield left, right
            left = right = column
    yield left, right
