"""What ``excel`` says of a workbook's buttons, and how it mends them."""

from __future__ import annotations

import sys
from dataclasses import dataclass
from pathlib import Path

from grasp_xl.errors import InputError, Problem, UsageError
from grasp_xl.workbook.cells import Source
from grasp_xl.workbook.layout import CONFIGURATION
from grasp_xl.workbook.macros import read_settings, setting_here, this_interpreter
from grasp_xl.workbook.package import read_package
from grasp_xl.workbook.reading import open_source
from grasp_xl.workbook.saving import MACRO_SUFFIX, check_place, save
from grasp_xl.workbook.setting import with_setting
from grasp_xl.workbook.stored import StoredCells


@dataclass(frozen=True, slots=True)
class Buttons:
    """How the buttons of a workbook find Python.

    Parameters
    ----------
    settings : dict
        Of the sheet ``xlwings.conf``.
    name : str or None
        The setting with the path for this computer; None where there is no Excel for it.
    """

    settings: dict[str, str]
    name: str | None

    @property
    def works(self) -> bool:
        """Whether the path for this computer is that of a file."""
        return self.name is not None and Path(self.settings.get(self.name, "")).is_file()


def read_buttons(path: Path) -> Buttons:
    """Read how the buttons of a workbook find Python.

    Raises
    ------
    InputError
        If it has no buttons.
    """
    source = open_source(path)
    if CONFIGURATION not in source.sheets:
        expected = f"a workbook with buttons, that is with a sheet {CONFIGURATION}"
        hint = "make one with grasp-xl run BOOK -o OTHER.xlsm"
        raise InputError([Problem(str(path), f"no sheet {CONFIGURATION}", expected, hint)])
    return Buttons(read_settings(source), setting_here())


def repair(path: Path, *, force: bool = False) -> Buttons:
    """Let the buttons of a workbook find this Python; nothing else in the file changes.

    Raises
    ------
    UsageError
        If there is no Excel for this computer.
    InputError, OutputError
        If the file has no buttons, or cannot be written.
    """
    check_place(path, (MACRO_SUFFIX,), force=force, option="--repair")
    here = this_interpreter()
    if not here:
        raise UsageError(
            f"--repair: found {sys.platform}, expected Windows or macOS, where Excel is.",
            where="--repair",
            hint="Repair the workbook on the computer on which its buttons are pressed",
        )
    package = read_package(path)
    for name, value in here.items():
        save(with_setting(package, Source(StoredCells(package)), name, value), path)
    return read_buttons(path)
