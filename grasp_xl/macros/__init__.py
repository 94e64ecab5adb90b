"""The VBA projects that workbooks with macros carry, and the sources that they are made of.

``xlwings.bas`` is xlwings' stand-alone module, unchanged, with its licence: its ``RunPython``
starts Python from Excel.  ``Dictionary.cls`` comes with it, from Tim Hall: without it the module
does not compile on a Mac.  ``GraspXL.bas`` is ours: a macro for each button.  ``build.py`` makes
projects of them, which are package data, so that a user's machine needs no tool for it.
"""

from __future__ import annotations

from pathlib import Path

from grasp_xl.workbook.layout import OCCASIONAL, SHEETS

MODULES = tuple(
    Path(__file__).with_name(name) for name in ("xlwings.bas", "Dictionary.cls", "GraspXL.bas")
)
"""Sources of the modules with code, in the order in which a project has them."""

PROJECTS = {
    count: Path(__file__).with_name(f"sheets{count}.bin")
    for count in range(len(SHEETS) + 1, len((*SHEETS, *OCCASIONAL)) + 2)
}
"""The projects that there are, by the number of sheets: with settings, and with each other one."""


def project(sheets: int) -> bytes:
    """Return the VBA project of a workbook with so many sheets.

    Its document modules are ``ThisWorkbook`` and ``Sheet1``, ``Sheet2``, ... in the order of the
    sheets: the code names that XlsxWriter's ``set_vba_name()`` gives.

    Raises
    ------
    ValueError
        If no project is made for so many.
    """
    path = PROJECTS.get(sheets)
    if path is None:
        known = " or ".join(map(str, PROJECTS))
        raise ValueError(f"no VBA project for {sheets} sheets; there is one for {known}")
    return path.read_bytes()
