"""Putting a workbook in its place: whole or not at all."""

from __future__ import annotations

import errno
import os
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import IO

from grasp_xl.errors import OutputError, UsageError

LOCK_FILES = ("~${name}", ".~lock.{name}#")
"""Files that Excel and LibreOffice keep beside a workbook that they hold open."""

MACRO_SUFFIX = ".xlsm"
"""How the name of a workbook with macros ends."""
WORKBOOK_SUFFIXES = (".xlsx", MACRO_SUFFIX)
"""How the name of a workbook may end."""

REASONS = {
    errno.ENOSPC: ("the disk is full", "free some space, or write to another disk"),
    errno.EDQUOT: ("the disk quota is used up", "free some space, or write to another disk"),
    errno.EROFS: ("the folder is read-only", "choose another folder"),
    errno.EACCES: ("access is denied", "close the file in Excel, or choose another folder"),
    errno.EPERM: ("access is denied", "close the file in Excel, or choose another folder"),
}


# --- may it be written ---


def check_place(target: Path, suffixes: Sequence[str], *, force: bool, option: str = "-o") -> None:
    """Refuse a place where no file could be put in the end, before any work is done.

    Parameters
    ----------
    target : Path
    suffixes : sequence of str
        What its name may end in.
    force : bool
        Put it there though another program holds it open.
    option : str
        Which option names it.

    Raises
    ------
    UsageError
        If the name does not end in one of ``suffixes``.
    OutputError
        If the folder is missing or read-only, or the file is held open or no file at all.
    """
    try:
        _refuse_place(target, option)
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
    if target.suffix.lower() not in suffixes:
        expected = " or ".join(map(repr, suffixes))
        raise UsageError(
            f"{target}: found a name that ends in {target.suffix!r}, expected {expected}.",
            where=str(target),
            hint=f"Name a file such as {target.stem or 'result'}{suffixes[0]}",
        )


def _refuse_place(target: Path, option: str) -> None:
    folder = _resolved(target).parent
    if not folder.is_dir():
        raise OutputError(
            f"The folder {folder} does not exist, so nothing was written.",
            where=str(target),
            hint="Make the folder, or name another one",
        )
    if target.exists() and not target.is_file():
        what = "a folder" if target.is_dir() else "no file"
        raise OutputError(
            f"{target} is {what}, so nothing was written.",
            where=str(target),
            hint=f"Name another file with {option}",
        )
    if not os.access(folder, os.W_OK):
        raise OSError(errno.EROFS, "")


def refuse_theirs(
    target: Path, marks: Sequence[str], command: str, *, force: bool, option: str = "-o"
) -> None:
    """Refuse to replace a file in which none of our marks stands, such as the part's own.

    Parameters
    ----------
    target : Path
    marks : sequence of str
    command : str
        That writes such files.
    force : bool
        Replace it all the same.
    option : str
        Which option names it.

    Raises
    ------
    OutputError
        If it is somebody else's.
    """
    if force or not target.exists():
        return
    try:
        content = target.read_bytes()
    except OSError as error:
        raise _cannot_write(target, error) from error
    if not any(mark.encode() in content for mark in marks):
        raise OutputError(
            f"{target} exists and grasp-xl {command} did not write it, so nothing was written.",
            where=str(target),
            hint=f"Name another file with {option}, or add --force to replace it",
        )


def check_target(
    target: Path,
    source: Path,
    *,
    in_place: bool,
    force: bool,
    suffixes: Sequence[str] = WORKBOOK_SUFFIXES,
) -> None:
    """Refuse a workbook that could not be written, before any work is done.

    Raises
    ------
    UsageError
        If it is the input and nobody asked for that, or its name is not that of a workbook.
    OutputError
        If it cannot be written, or is held open.
    """
    check_place(target, suffixes, force=force)
    if not in_place and target.exists() and source.exists() and target.samefile(source):
        raise UsageError(
            f"The output {target} is the input.",
            where=str(target),
            hint="Name another file with -o; only run replaces its input, with --in-place",
        )


# --- writing it ---


def save(content: bytes, target: Path) -> None:
    """Write a complete file beside the target, then move it into place.

    Raises
    ------
    OutputError
        If that fails; the target is then as it was.
    """
    with replacing(target) as file:
        file.write(content)


@contextmanager
def replacing(target: Path) -> Iterator[IO[bytes]]:
    """Give a new file beside the target to write to; move it into place once it is whole.

    Raises
    ------
    OutputError
        If that fails; the target is then as it was.
    """
    beside: Path | None = None
    try:
        target = _resolved(target)  # a link stays a link
        with tempfile.NamedTemporaryFile(
            dir=target.parent, prefix=".grasp_xl-", suffix=".tmp", delete=False
        ) as file:
            beside = Path(file.name)
            yield file
            file.flush()
            os.fsync(file.fileno())
        beside.chmod(_mode(target))
        beside.replace(target)
    except OSError as error:
        raise _cannot_write(target, error) from error
    finally:
        if beside:
            beside.unlink(missing_ok=True)  # still there after a failure or a second Ctrl-C


def _resolved(target: Path) -> Path:
    """Follow links.

    Raises
    ------
    OSError
        If a link leads to itself, which ``Path.resolve`` says in other ways in each Python.
    """
    try:
        return target.resolve(strict=True)
    except (FileNotFoundError, NotADirectoryError):
        return target.resolve()
    except RuntimeError as error:
        raise OSError(errno.ELOOP, "a link that leads to itself") from error


def _mode(target: Path) -> int:
    if target.exists():
        return target.stat().st_mode & 0o777
    mask = os.umask(0)
    os.umask(mask)
    return 0o666 & ~mask


def _cannot_write(target: Path, error: OSError) -> OutputError:
    told = error.strerror or str(error) or "an unknown failure"
    unknown = (told, "choose another name or folder")
    reason, hint = REASONS.get(error.errno or 0, unknown)
    return OutputError(
        f"{target} cannot be written: {reason}; what stood there before is untouched.",
        where=str(target),
        hint=hint[0].upper() + hint[1:],
    )
