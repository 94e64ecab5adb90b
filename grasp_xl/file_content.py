"""The bytes of a file that a person names, or one sentence that says why there are none."""

from __future__ import annotations

import os
import stat
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

from grasp_xl.errors import InputError, Problem


@dataclass(frozen=True, slots=True)
class FileKind:
    """What kind of file is read, in words for messages, and how large it may be.

    Parameters
    ----------
    noun, expected : str
        ``workbook``; ``an Excel workbook (.xlsx or .xlsm)``.
    max_bytes : int
    make_smaller : str
        What to do about a larger one.
    """

    noun: str
    expected: str
    max_bytes: int
    make_smaller: str


def read_content(path: Path, kind: FileKind) -> bytes:
    """Read a whole file.

    Raises
    ------
    InputError
        With one problem: no such file, a folder, a pipe, no permission, too large, being written.
    """
    name = str(path)
    try:
        mode = path.stat().st_mode  # before opening: to open a pipe would wait for ever
        if stat.S_ISDIR(mode):
            raise _refusal(name, "a folder", kind.expected, f"name the {kind.noun} in it")
        if not stat.S_ISREG(mode):
            raise _refusal(
                name,
                "a pipe or device",
                kind.expected,
                "write its content to a file and name that",
            )
        with path.open("rb") as file:
            return read_unchanged(file, name, kind)
    except (FileNotFoundError, NotADirectoryError):
        raise _refusal(
            name, "no such file", kind.expected, "check the spelling and the folder"
        ) from None
    except PermissionError:
        raise _refusal(
            name,
            "a file without permission to read it",
            "a file that you may read",
            "close it in other programs, or ask its owner for permission",
        ) from None
    except OSError as error:
        raise _refusal(
            name,
            f"a file that cannot be read ({error.strerror})",
            "a file that can be read",
            "copy it to a folder on this computer and try again",
        ) from error


def read_unchanged(file: BinaryIO, name: str, kind: FileKind) -> bytes:
    """Read a whole open file, and refuse it if another program writes it meanwhile."""
    before = os.fstat(file.fileno())
    if before.st_size > kind.max_bytes:
        raise _refusal(
            name,
            f"a file of {megabytes(before.st_size)}",
            f"at most {megabytes(kind.max_bytes)}",
            kind.make_smaller,
        )
    content = file.read(kind.max_bytes + 1)
    after = os.fstat(file.fileno())
    stamps = [(status.st_size, status.st_mtime_ns) for status in (before, after)]
    if stamps[0] != stamps[1] or len(content) != before.st_size:
        raise _refusal(
            name,
            "a file that changed while it was read",
            "a file at rest",
            "close the program that writes it and try again",
        )
    return content


def megabytes(size: int) -> str:
    """Write a size for a message, rounded up.

    Examples
    --------
    >>> megabytes(128_000_000), megabytes(1_000_001)
    ('128 MB', '2 MB')
    """
    return f"{-(-size // 1_000_000):,} MB"


def _refusal(name: str, found: str, expected: str, hint: str) -> InputError:
    return InputError([Problem(name, found, expected, hint)])
