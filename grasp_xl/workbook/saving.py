"""Putting a workbook in its place: whole or not at all, and nothing of the designer's lost."""

from __future__ import annotations

import errno
import io
import os
import tempfile
import zipfile
from pathlib import Path

from grasp_xl.errors import OutputError, UsageError
from grasp_xl.workbook import layout
from grasp_xl.workbook.cells import Source
from grasp_xl.workbook.layout import place
from grasp_xl.workbook.stamp import is_untouched
from grasp_xl.workbook.writing import Filled

MAX_NAMED = 10
"""Lost cells that a message names."""

LOCK_FILES = ("~${name}", ".~lock.{name}#")
"""Files that Excel and LibreOffice keep beside a workbook that they hold open."""

OBJECTS = {
    "charts": "/charts/chart",
    "pictures": "/media/",
    "comments or notes": "/comments",
    "threaded comments": "/threadedComments",
    "macro modules": "/vbaProject.bin",
    "pivot tables": "/pivotTables/pivotTable",
    "links to other workbooks": "/externalLinks/externalLink",
    "controls": "/ctrlProps/",
}
"""Objects in a workbook, and how the names of their parts begin."""

REASONS = {
    errno.ENOSPC: ("the disk is full", "free some space, or write to another disk"),
    errno.EROFS: ("the folder is read-only", "choose another folder with -o"),
    errno.EACCES: ("access is denied", "close the file in Excel, or choose another folder with -o"),
    errno.EPERM: ("access is denied", "close the file in Excel, or choose another folder with -o"),
    errno.EDQUOT: ("the disk quota is used up", "free some space, or write to another disk"),
}


def check_target(target: Path, source: Path, *, in_place: bool, force: bool) -> None:
    """Refuse a target that could not be written in the end, before any work is done.

    Raises
    ------
    UsageError
        If the target is the input, and nobody asked for that.
    OutputError
        If it cannot be written, is held open, or holds something that is not ours.
    """
    if not in_place and target.exists() and source.exists() and target.samefile(source):
        raise UsageError(
            f"The output {target} is the input.",
            where=str(target),
            hint="Add --in-place to replace it, or name another file with -o",
        )
    folder = target.resolve().parent
    if not folder.is_dir():
        raise OutputError(
            f"The folder {folder} does not exist, so nothing was written.",
            where=str(target),
            hint="Make the folder, or name another one with -o",
        )
    if target.is_dir():
        raise OutputError(
            f"{target} is a folder, so nothing was written.",
            where=str(target),
            hint="Name a file in it with -o",
        )
    if not os.access(folder, os.W_OK):
        raise _cannot_write(target, OSError(errno.EACCES, "not writable"))
    _refuse_open_book(target, force=force)
    if target.exists() and not in_place and not force and not is_untouched(target.read_bytes()):
        raise OutputError(
            f"{target} exists and was edited since grasp_xl wrote it (or never was ours), "
            "so nothing was written.",
            where=str(target),
            hint="Add --force to replace it, or name another file with -o",
        )


def _refuse_open_book(target: Path, *, force: bool) -> None:
    for pattern in LOCK_FILES:
        lock = target.with_name(pattern.replace("{name}", target.name))
        if lock.exists() and not force:
            raise OutputError(
                f"{target} is open in another program, so nothing was written.",
                where=str(target),
                hint=f"Close it there; if it is not open, delete {lock.name} or add --force",
            )


def refuse_losses(
    target: Path, source: Source, content: bytes, filled: Filled, *, force: bool
) -> None:
    """Refuse to replace a workbook that holds something which the new one would not have.

    Raises
    ------
    OutputError
        Naming everything that would be lost.
    """
    lost = losses(source, content, filled)
    if lost and not force:
        raise OutputError(
            f"{target} holds what the new workbook would not: {'; '.join(lost)}. "
            "Nothing was written.",
            where=str(target),
            hint="Write to another file with -o, or add --force to lose it",
        )


def losses(source: Source, content: bytes, filled: Filled) -> list[str]:
    """List what a workbook holds that the one to replace it (content, filled cells) does not."""
    if is_untouched(source.package.content):
        return []
    found = [f"the sheet {name!r}" for name in source.foreign_sheets if name not in filled]
    before, after = _objects(source.package.content), _objects(content)
    found += [
        f"{before[what] - after[what]} {what} more"
        for what in OBJECTS
        if before[what] > after[what]
    ]
    for sheet in source.sheets:
        if sheet in filled:
            found += _lost_cells(source, sheet, filled[sheet])
    return found


def _objects(content: bytes) -> dict[str, int]:
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        names = archive.namelist()
    return {what: sum(start in name for name in names) for what, start in OBJECTS.items()}


def _lost_cells(source: Source, sheet: str, filled: set[tuple[int, int]]) -> list[str]:
    lost = [
        place(sheet, row, column)
        for row, values in source.grid(sheet).rows.items()
        for column, value in enumerate(values)
        if value is not None
        and (row, column) not in filled
        and not layout.is_in_list(sheet, row, column)
    ]
    if not lost:
        return []
    more = f" and {len(lost) - MAX_NAMED} more" if len(lost) > MAX_NAMED else ""
    return [f"the cells {', '.join(lost[:MAX_NAMED])}{more}"]


def save(content: bytes, target: Path) -> None:
    """Write a complete file beside the target, then move it into place.

    Raises
    ------
    OutputError
        If that fails; the target is then as it was.
    """
    target = target.resolve()  # a link stays a link
    beside = ""
    try:
        with tempfile.NamedTemporaryFile(
            dir=target.parent, prefix=f".{target.name}.", suffix=".tmp", delete=False
        ) as file:
            beside = file.name
            file.write(content)
            file.flush()
            os.fsync(file.fileno())
        Path(beside).chmod(_mode(target))
        Path(beside).replace(target)
    except OSError as error:
        if beside:
            Path(beside).unlink(missing_ok=True)
        raise _cannot_write(target, error) from error


def _mode(target: Path) -> int:
    if target.exists():
        return target.stat().st_mode & 0o777
    mask = os.umask(0)
    os.umask(mask)
    return 0o666 & ~mask


def _cannot_write(target: Path, error: OSError) -> OutputError:
    reason, hint = REASONS.get(
        error.errno or 0, (error.strerror or "an unknown failure", "choose another folder with -o")
    )
    return OutputError(
        f"{target} cannot be written: {reason}; what stood there before is untouched.",
        where=str(target),
        hint=hint[0].upper() + hint[1:],
    )
