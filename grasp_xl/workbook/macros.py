"""What a workbook with macros has besides: buttons, code names, a VBA project, its settings."""

from __future__ import annotations

import io
import re
import sys
import zipfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from grasp_xl.macros import PROJECTS, project
from grasp_xl.workbook.cells import Source
from grasp_xl.workbook.layout import BLOCK_COLUMN, CONFIGURATION, Area
from grasp_xl.workbook.package import Package, sheet_parts
from grasp_xl.workbook.pen import Pen
from grasp_xl.workbook.styles import Style

BUTTONS = {
    "Check": "CheckGrasp",
    "Run": "RunGrasp",
    "Prove": "ProveGrasp",
    "Stop": "StopGrasp",
}
"""Macro of each button, by what stands on it."""

BUTTON_WIDTH, BUTTON_HEIGHT, BUTTON_PITCH = 78, 22, 84
"""Size of a button, and how far apart two begin (pixels)."""
BUTTON_ROW_HEIGHT = 20.25
"""Of the row that they stand in (points)."""

INTERPRETERS = {"win32": "INTERPRETER_WIN", "darwin": "INTERPRETER_MAC"}
"""Setting with the path of Python, by ``sys.platform``."""

SETTINGS = {
    **dict.fromkeys(INTERPRETERS.values(), ""),
    "ADD_WORKBOOK_TO_PYTHONPATH": "false",
    **dict.fromkeys(("PYTHONPATH", "CONDA PATH", "CONDA ENV"), ""),
}
"""Settings as they are at first: also the empty ones overrule a file xlwings.conf that lies beside
the workbook, so that nothing in its folder has a say in what is run."""

SETTINGS_NOTE = (
    "Settings of the buttons (xlwings). INTERPRETER_WIN and INTERPRETER_MAC: path of the Python "
    "that has grasp_xl. On another computer: grasp-xl excel --repair BOOK."
)
NOTE_COLUMN = 3
ROOM_FOR_SETTINGS = 20
"""Rows that are printed: a person may add settings."""

_PROJECT, _SIGNATURE = "vbaProject.bin", "vbaProjectSignature.bin"
_CODE_NAME = re.compile(rb'<sheetPr\b[^>]*?\bcodeName="([^"]+)"')
_START_BYTES = 4096  # of a sheet's part: its properties come first


@dataclass(frozen=True, slots=True)
class Macros:
    """What a workbook with macros has besides.

    Parameters
    ----------
    settings : dict
        Of the sheet ``xlwings.conf``.
    project, signature : bytes or None
        The VBA project of somebody who changed or signed it, or of Excel, which writes it anew;
        None stands for ours.
    code_names : dict
        Of that project, by sheet.
    """

    settings: Mapping[str, str] = field(default_factory=lambda: dict(SETTINGS))
    project: bytes | None = None
    signature: bytes | None = None
    code_names: Mapping[str, str] = field(default_factory=dict)

    def at_home(self) -> Macros:
        """Return them with the path of this Python."""
        return replace(self, settings={**self.settings, **this_interpreter()})


def setting_here() -> str | None:
    """Return the setting with the path of Python here; None where there is no Excel."""
    return INTERPRETERS.get(sys.platform)


def this_interpreter() -> dict[str, str]:
    """Return the setting with the path of this Python; none where there is no Excel."""
    name = setting_here()
    return {name: sys.executable} if name else {}


def add_macros(book: Any, pens: Sequence[Pen], macros: Macros) -> None:  # noqa: ANN401 (untyped library)
    """Give a workbook its VBA project, and each sheet the name by which that knows it."""
    content = macros.project or project(len(pens))
    if macros.signature:
        signature = io.BytesIO(macros.signature)
        book.add_signed_vba_project(io.BytesIO(content), signature, True, True)  # noqa: FBT003 (streams)
    else:
        book.add_vba_project(io.BytesIO(content), is_stream=True)
    book.set_vba_name()
    for number, pen in enumerate(pens, 1):
        name = macros.code_names.get(pen.name) if macros.project else f"Sheet{number}"
        if name:
            pen.sheet.set_vba_name(name)


def add_buttons(pen: Pen) -> None:
    """Put the buttons in the sheet's first row, which stays when it is scrolled."""
    pen.sheet.set_row(0, BUTTON_ROW_HEIGHT)
    for number, (caption, macro) in enumerate(BUTTONS.items()):
        look = {
            "caption": caption,
            "macro": macro,
            "width": BUTTON_WIDTH,
            "height": BUTTON_HEIGHT,
            "x_offset": 2 + number * BUTTON_PITCH,
            "y_offset": 2,
        }
        pen.sheet.insert_button(0, BLOCK_COLUMN, look)


def write_settings(pen: Pen, settings: Mapping[str, str]) -> None:
    """Write the sheet as xlwings reads it: names and values from the first cell on, no gap."""
    for row, (name, value) in enumerate(settings.items()):
        pen.write(row, 0, name, Style.LABEL)
        pen.write(row, 1, value or None, Style.INPUT_TEXT)
    pen.write(0, NOTE_COLUMN, SETTINGS_NOTE, Style.NOTE)
    pen.widths(0, 34, 90, 2)
    pen.print_pages(Area(CONFIGURATION, 0, 0, ROOM_FOR_SETTINGS, 2))


def read_macros(package: Package, source: Source) -> Macros | None:
    """Read what a workbook of ours has besides; None where it has no macros or is another's."""
    if CONFIGURATION not in source.sheets:
        return None
    with zipfile.ZipFile(io.BytesIO(package.content)) as archive:
        parts = {name.rpartition("/")[2]: name for name in archive.namelist()}
        if _PROJECT not in parts:
            return None
        content = archive.read(parts[_PROJECT])
        signature = archive.read(parts[_SIGNATURE]) if _SIGNATURE in parts else None
        settings = read_settings(source)
        if signature is None and content in map(Path.read_bytes, PROJECTS.values()):
            return Macros(settings)
        return Macros(settings, content, signature, _code_names(package, archive))


def read_settings(source: Source) -> dict[str, str]:
    """Read the settings as xlwings does: up to the first empty name."""
    settings: dict[str, str] = {}
    grid = source.grid(CONFIGURATION)
    for row in range(len(grid.rows)):
        name, value = grid.at(row, 0), grid.at(row, 1)
        if name is None:
            break
        settings[str(name)] = "" if value is None else str(value)
    return settings


def _code_names(package: Package, archive: zipfile.ZipFile) -> dict[str, str]:
    """Return the code names of the sheets that have one."""
    names = {}
    for sheet, part in sheet_parts(package.name, archive).items():
        with archive.open(part or "") as file:
            found = _CODE_NAME.search(file.read(_START_BYTES))
        if found:
            names[sheet] = found[1].decode()
    return names
