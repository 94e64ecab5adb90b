"""A headless LibreOffice for tests: opens a workbook, recalculates it, types into it, saves it."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
from collections.abc import Iterator
from pathlib import Path
from select import select
from typing import Any, NoReturn

import pytest

from grasp_xl.workbook.layout import Area

WORKER = Path(__file__).with_name("office_worker.py")
PYTHON_WITH_UNO = "/usr/bin/python3"
SECONDS = 120
"""Time that one command may take; after that LibreOffice hangs, and the session ends."""
REQUIRE_ALL = "GRASP_XL_REQUIRE_ALL"
INSTALL = "install libreoffice-calc and python3-uno (Debian packages)"

CellValue = float | str
Place = Area | str
"""Cells on a sheet, or a defined name."""


def lack(reason: str) -> NoReturn:
    """Skip a test whose tool is missing, or fail it where every tool must be there (CI)."""
    if os.environ.get(REQUIRE_ALL):
        pytest.fail(f"{reason} ({REQUIRE_ALL} is set)")
    pytest.skip(reason)


def need_arial() -> None:
    """Skip or fail a test of page breaks where no font has the widths of the workbook's Arial."""
    match = shutil.which("fc-match")
    found = match and subprocess.check_output([match, "Arial"], text=True)  # noqa: S603
    if not found or not any(name in found for name in ("Arial", "Liberation Sans")):
        lack("no font is as wide as Arial; install fontconfig and fonts-liberation")


class OfficeError(RuntimeError):
    """LibreOffice could not do what it was told, or ended."""


class Office:
    """LibreOffice with one workbook open at a time.

    Parameters
    ----------
    profile : Path | None
        Folder for its user profile, so that it neither reads nor writes a person's.
    pipe : str
        Instead of a profile: the pipe of a LibreOffice that runs already, and that will run on.
    """

    def __init__(self, profile: Path | None = None, *, pipe: str = "") -> None:
        start = ["--connect", pipe] if pipe else [str(profile)]
        self._worker = subprocess.Popen(  # noqa: S603 (our own script)
            [PYTHON_WITH_UNO, "-I", str(WORKER), *start],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )
        self._group: int | None = None
        self.path: Path | None = None
        """The workbook that is open."""
        try:
            started = self._answer()
        except OfficeError:
            self.end()
            raise
        self._group = None if pipe else started["group"]
        self.pid: int = started["pid"]
        """LibreOffice's process."""
        self.pipe: str = started["pipe"]
        """By this another process connects to it."""

    def end(self) -> None:
        """End LibreOffice, or the connection to one that was not started here."""
        self._worker.communicate(timeout=SECONDS)

    def open(self, path: Path, *, macros: bool = False, unsaved: bool = False) -> None:
        """Open a workbook with the values that it stores; close the one before.

        Its macros are enabled or not; an unsaved one is a new workbook with the same content.
        """
        self.do("close")
        self.do("open", path=str(path), macros=macros, unsaved=unsaved)
        self.path = path

    def recalculate(self) -> None:
        """Calculate every formula from scratch."""
        self.do("recalculate")

    def formulas(self) -> dict[Area, CellValue]:
        """Return the value of every formula cell of every sheet; errors as their text."""
        cells = self.do("formulas")
        return {Area(sheet, row, column): value for sheet, row, column, value in cells}

    def read(self, place: Place) -> list[list[CellValue]]:
        """Return the values of an area, row by row; errors as their text, no value as ''."""
        rows: list[list[CellValue]] = self.do("read", places=[sent(place)])[0]
        return rows

    def value(self, place: Place) -> CellValue:
        """Return the value of one cell."""
        return self.read(place)[0][0]

    def values(self, places: list[Area]) -> list[CellValue]:
        """Return the values of many cells."""
        answers = self.do("read", places=[sent(place) for place in places])
        return [rows[0][0] for rows in answers]

    def enter(self, cells: dict[Place, float | str | None]) -> None:
        """Type into cells, as a person does: what depends on them follows; None empties a cell."""
        self.do("write", cells=[(sent(place), value) for place, value in cells.items()])

    def paste(self, source: Place, target: Place) -> None:
        """Copy cells and paste them whole elsewhere; :meth:`undo` does not put this back."""
        self.do("paste", source=sent(source), target=sent(target))

    def modules(self, library: str) -> dict[str, str]:
        """Return the source of every module of a library of macros, by its name."""
        sources: dict[str, str] = self.do("modules", library=library)
        return sources

    def remove(self, sheet: str) -> None:
        """Delete a sheet; :meth:`undo` does not put it back."""
        self.do("remove", sheet=sheet)

    def undo(self) -> None:
        """Put back what was typed over since the workbook was opened."""
        self.do("undo")

    def pages(self, width_mm: float, height_mm: float) -> int:
        """Return how many pages a print of all sheets has on a paper."""
        pages: int = self.do("pages", width=width_mm, height=height_mm)
        return pages

    def save(self, path: Path) -> Path:
        """Save the workbook as .xlsx."""
        self.do("save", path=str(path))
        return path

    def do(self, command: str, **details: Any) -> Any:
        """Have the worker carry out one command."""
        if self._worker.stdin is None:
            raise AssertionError("started with a pipe")
        self._worker.stdin.write(json.dumps({"do": command, **details}) + "\n")
        self._worker.stdin.flush()
        return self._answer()

    def _answer(self) -> Any:
        if self._worker.stdout is None:
            raise AssertionError("started with a pipe")
        if not select([self._worker.stdout], [], [], SECONDS)[0]:
            self._kill()
        line = self._worker.stdout.readline()
        answer = json.loads(line) if line else {"fault": "the worker ended"}
        if "fault" in answer:
            raise OfficeError(answer["fault"])
        return answer["answer"]

    def _kill(self) -> None:
        if self._group is not None:
            os.killpg(self._group, signal.SIGKILL)
        else:
            self._worker.kill()


def sent(place: Place) -> str | tuple[str, str]:
    """Put a place into the worker's words."""
    return place if isinstance(place, str) else (place.sheet, place.absolute)


def run_office(profile: Path) -> Iterator[Office]:
    """Start LibreOffice, or lack it; end it when its user is done (a fixture's body)."""
    if not shutil.which("soffice") or not Path(PYTHON_WITH_UNO).exists():
        lack(f"LibreOffice is not here: {INSTALL}")
    try:
        office = Office(profile)
    except OfficeError as error:
        lack(f"LibreOffice does not run ({error}): {INSTALL}")
    yield office
    office.end()
