"""Putting a workbook in its place: whole or not at all, and nothing of the designer's lost."""

from __future__ import annotations

import errno
import io
import math
import os
import re
import tempfile
import zipfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from grasp_xl.errors import OutputError, UsageError
from grasp_xl.workbook import layout
from grasp_xl.workbook.cells import Source, cells_of, is_blank
from grasp_xl.workbook.layout import Area, Card, place
from grasp_xl.workbook.package import Package
from grasp_xl.workbook.reading import find_sheet
from grasp_xl.workbook.reading_ga import find_ga_sheet
from grasp_xl.workbook.stamp import is_untouched
from grasp_xl.workbook.writing import Filled

MAX_NAMED = 10
"""Lost cells of a sheet that a message names."""

LOCK_FILES = ("~${name}", ".~lock.{name}#")
"""Files that Excel and LibreOffice keep beside a workbook that they hold open."""

ANOTHER_FILE = "Name another file with -o"

REASONS = {
    errno.ENOSPC: ("the disk is full", "free some space, or write to another disk"),
    errno.EDQUOT: ("the disk quota is used up", "free some space, or write to another disk"),
    errno.EROFS: ("the folder is read-only", "choose another folder"),
    errno.EACCES: ("access is denied", "close the file in Excel, or choose another folder"),
    errno.EPERM: ("access is denied", "close the file in Excel, or choose another folder"),
}


# --- may it be written ---


def check_place(target: Path, suffix: str, *, force: bool) -> None:
    """Refuse a place where no file could be put in the end, before any work is done.

    Raises
    ------
    UsageError
        If the name does not end in ``suffix``.
    OutputError
        If the folder is missing or read-only, or the file is held open or no file at all.
    """
    if target.suffix.lower() != suffix:
        raise UsageError(
            f"{target}: found a name that ends in {target.suffix!r}, expected {suffix!r}.",
            where=str(target),
            hint=f"Name a file such as {target.stem or 'result'}{suffix}",
        )
    try:
        _refuse_place(target)
        for pattern in () if force else LOCK_FILES:
            lock = target.with_name(pattern.replace("{name}", target.name))
            if lock.exists():
                raise OutputError(
                    f"{target} is open in another program, so nothing was written.",
                    where=str(target),
                    hint=f"Close it there; if it is not open, delete {lock.name} or add --force",
                )
    except OSError as error:
        raise _cannot_write(target, error) from error


def _refuse_place(target: Path) -> None:
    folder = target.resolve().parent
    if not folder.is_dir():
        raise OutputError(
            f"The folder {folder} does not exist, so nothing was written.",
            where=str(target),
            hint="Make the folder, or name another one",
        )
    if target.exists() and not target.is_file():
        what = "a folder" if target.is_dir() else "no file"
        raise OutputError(
            f"{target} is {what}, so nothing was written.", where=str(target), hint=ANOTHER_FILE
        )
    if not os.access(folder, os.W_OK):
        raise OSError(errno.EROFS, "")


def check_target(target: Path, source: Path, *, in_place: bool, force: bool) -> None:
    """Refuse a workbook that could not be written, before any work is done.

    Raises
    ------
    UsageError
        If it is the input and nobody asked for that, or its name is not that of a workbook.
    OutputError
        If it cannot be written, or is held open.
    """
    check_place(target, ".xlsx", force=force)
    if not in_place and target.exists() and source.exists() and target.samefile(source):
        raise UsageError(
            f"The output {target} is the input.",
            where=str(target),
            hint=f"{ANOTHER_FILE}; only run replaces its input, with --in-place",
        )


def refuse_edited(target: Path, *, force: bool) -> None:
    """Refuse to replace a file that is not just as we wrote it.

    Raises
    ------
    OutputError
    """
    if target.exists() and not force and not is_untouched(target):
        raise OutputError(
            f"{target} exists and was edited since grasp_xl wrote it (or never was ours), "
            "so nothing was written.",
            where=str(target),
            hint="Add --force to replace it, or name another file with -o",
        )


# --- writing it ---


def save(content: bytes, target: Path) -> None:
    """Write a complete file beside the target, then move it into place.

    Raises
    ------
    OutputError
        If that fails; the target is then as it was.
    """
    beside: Path | None = None
    try:
        target = target.resolve()  # a link stays a link
        with tempfile.NamedTemporaryFile(
            dir=target.parent, prefix=".grasp_xl-", suffix=".tmp", delete=False
        ) as file:
            beside = Path(file.name)
            file.write(content)
            file.flush()
            os.fsync(file.fileno())
        beside.chmod(_mode(target))
        beside.replace(target)
    except OSError as error:
        raise _cannot_write(target, error) from error
    finally:
        if beside:
            beside.unlink(missing_ok=True)  # still there after a failure or a second Ctrl-C


def _mode(target: Path) -> int:
    if target.exists():
        return target.stat().st_mode & 0o777
    mask = os.umask(0)
    os.umask(mask)
    return 0o666 & ~mask


def _cannot_write(target: Path, error: OSError) -> OutputError:
    unknown = (error.strerror or "an unknown failure", "choose another name or folder")
    reason, hint = REASONS.get(error.errno or 0, unknown)
    return OutputError(
        f"{target} cannot be written: {reason}; what stood there before is untouched.",
        where=str(target),
        hint=hint[0].upper() + hint[1:],
    )


# --- what would be lost ---

OBJECTS = {
    "charts": ("/charts/chart", b""),
    "pictures": ("/media/", b""),
    "shapes or text boxes": ("/drawings/drawing", b"<xdr:sp[ >]"),
    "comments or notes": ("/comments", b"<comment[ >]"),
    "threaded comments": ("/threadedComments/", b"<threadedComment "),
    "links": ("/worksheets/sheet", b"<hyperlink "),
    "macro modules": ("/vbaProject.bin", b""),
    "pivot tables": ("/pivotTables/pivotTable", b""),
    "links to other workbooks": ("/externalLinks/externalLink", b""),
    "controls": ("/ctrlProps/", b""),
}
"""Objects in a workbook: how the names of their parts begin, and what is counted in these."""

HEADER_ROWS = {
    layout.VALID_DESIGNS: layout.TABLE_ROW,
    layout.HISTORY: layout.HISTORY_ROW,
    layout.FITNESS_TABLE: 2,
}
"""Sheets that are one list, without gaps in its first column."""

REFERENCE = re.compile(r"\$?[A-Z]+\$?\d+")
"""A formula of ours in an input cell: a goal shows the user-defined chromosome's value."""


def refuse_losses(
    target: Path, source: Source, content: bytes, filled: Filled, *, force: bool
) -> None:
    """Refuse to replace a workbook that holds something which the new one would not have.

    Raises
    ------
    OutputError
        Naming everything that would be lost.
    """
    lost = [] if force else losses(source, content, filled)
    if lost:
        raise OutputError(
            f"{target} holds what the new workbook would not: {'; '.join(lost)}. "
            "Nothing was written.",
            where=str(target),
            hint="Write to another file with -o, or add --force to lose it",
        )


def losses(source: Source, content: bytes, filled: Filled) -> list[str]:
    """List what a workbook holds that the one to replace it (content, filled cells) does not."""
    if is_untouched(io.BytesIO(source.package.content)):
        return []
    new = Source(Package("the new workbook", content))
    own = {name: name for name in filled} | {find_sheet(source): layout.OPTION_SPACE}
    if ga_sheet := find_ga_sheet(source):
        own[ga_sheet] = layout.GA
    reshaped = Shape.of(source) != Shape.of(new)
    found = [
        f"the sheet {name!r}"
        for name in source.sheets
        if name not in own and (source.grid(name).rows or source.grid(name, formulas=True).rows)
    ]
    before, after = _objects(source.package.content), _objects(content)
    found += [
        f"{before[what] - after[what]} {what} more"
        for what in OBJECTS
        if before[what] > after[what]
    ]
    for sheet, ours in own.items():
        if sheet in source.sheets:
            replaced = Replaced(source, sheet, ours, filled[ours], reshaped=reshaped)
            found += _named("cells", replaced.lost_cells())
    return found + _named("formulas in", _lost_formulas(source, new, own))


def _objects(content: bytes) -> dict[str, int]:
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        names = archive.namelist()
        return {
            what: sum(
                len(re.findall(counted, archive.read(name))) if counted else 1
                for name in names
                if start in name
            )
            for what, (start, counted) in OBJECTS.items()
        }


def _named(what: str, cells: Iterator[str]) -> list[str]:
    lost = list(cells)
    more = f" and {len(lost) - MAX_NAMED} more" if len(lost) > MAX_NAMED else ""
    return [f"the {what} {', '.join(lost[:MAX_NAMED])}{more}"] if lost else []


@dataclass(frozen=True, slots=True)
class Shape:
    """Sizes that decide where our cells stand: index genes a kind, child cards, corners."""

    gene_slots: int
    children: int
    corners: int

    @classmethod
    def of(cls, source: Source) -> Shape:
        """Return the sizes of a full workbook; zeros for an export."""
        names = source.names
        genes, polygon = names.get(layout.USER_BLOCK.name), names.get(layout.IDEAL_POLYGON)
        children = sum(CHILD.fullmatch(name) is not None for name in names)
        return cls(genes.columns - 1 if genes else 0, children, polygon.rows if polygon else 0)


@dataclass(frozen=True, slots=True)
class OldSheet:
    """A sheet that is to be replaced, and what of it is ours.

    Parameters
    ----------
    source : Source
    sheet, ours : str
        Its name, and the name that it has in our workbooks.
    filled : set of (int, int)
        Rows and columns of the cells of the new sheet.
    reshaped : bool
        Whether the new workbook has another shape, so that old cells of ours stand where it has
        none.
    """

    source: Source
    sheet: str
    ours: str
    filled: set[tuple[int, int]]
    reshaped: bool

    def lost_cells(self) -> Iterator[str]:
        """Yield the places of all cells that somebody else filled."""
        list_end, last_column = self._list_end(), max(column for _, column in self.filled)
        cards = self._old_cards()
        for row, column in sorted(self._cells() - self.filled):
            listed = layout.is_in_list(self.ours, row, column) and row <= list_end
            if listed and (self.reshaped or column <= last_column):
                continue
            if not any(_holds(card, row, column) for card in cards):
                yield place(self.sheet, row, column)

    def _cells(self) -> set[tuple[int, int]]:
        grids = (self.source.grid(self.sheet, formulas=formulas) for formulas in (False, True))
        return {
            (row, column)
            for grid in grids
            for row, values in grid.rows.items()
            for column, value in enumerate(values)
            if not is_blank(value)
        }

    def _list_end(self) -> float:
        """Last row that our lists take on the sheet."""
        if self.ours == layout.OPTION_SPACE:
            areas = [self.source.names.get(name) for name in LISTS]
            return max((area.row + area.rows + 1 for area in areas if area), default=math.inf)
        if self.ours not in HEADER_ROWS:
            return math.inf
        row, grid = HEADER_ROWS[self.ours], self.source.grid(self.sheet)
        while grid.at(row + 1, 0) is not None:
            row += 1
        return row

    def _old_cards(self) -> list[Area]:
        """Places of cards and helper cells that the new workbook has elsewhere."""
        if not self.reshaped:
            return []
        if self.ours == layout.CALC:
            return [Area(self.sheet, 0, 0, MAX_ROWS, MAX_ROWS)]
        names = self.source.names.items()
        genes = [area for name, area in names if CHILD.fullmatch(name) or name in BLOCKS]
        return [
            Area(area.sheet, area.row - 2, area.column - 1, CARD_ROWS + 2 * area.columns, area.columns + 1)
            for area in genes
            if area.sheet == self.sheet
        ]


def _holds(area: Area, row: int, column: int) -> bool:
    return (
        area.row <= row < area.row + area.rows
        and area.column <= column < area.column + area.columns
    )


def _lost_formulas(source: Source, new: Source, own: dict[str, str]) -> Iterator[str]:
    """Yield the input cells whose formulas the new workbook has as values only."""
    for sheet, ours in own.items():
        if ours not in (layout.OPTION_SPACE, layout.GA) or sheet not in source.sheets:
            continue
        kept = new.grid(ours, formulas=True)
        for row, formulas in source.grid(sheet, formulas=True).rows.items():
            for column, formula in enumerate(formulas):
                cell = Area(sheet, row, column)
