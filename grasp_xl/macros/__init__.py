"""The VBA projects that workbooks with macros carry, and the sources that they are made of.

``xlwings.bas`` is xlwings' stand-alone module, unchanged, with its licence: its ``RunPython``
starts Python from Excel.  ``Dictionary.cls`` comes with it, from Tim Hall: without it the module
does not compile on a Mac.  ``GraspXL.bas`` is ours: a macro for each button.  ``build.py`` makes
projects of them, which are package data, so that a user's machine needs no tool for it.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from grasp_xl.workbook.layout import CONFIGURATION, SHEETS, TRADE_OFFS, VALID_DESIGNS

MODULES = tuple(
    Path(__file__).with_name(name) for name in ("xlwings.bas", "Dictionary.cls", "GraspXL.bas")
)
"""Sources of the modules with code, in the order in which a project has them."""

_BEHIND_DESIGNS = SHEETS.index(VALID_DESIGNS) + 1

FULL = (*SHEETS, CONFIGURATION)
WITH_TRADE_OFFS = (*SHEETS[:_BEHIND_DESIGNS], TRADE_OFFS, *SHEETS[_BEHIND_DESIGNS:], CONFIGURATION)

PROJECTS = {
    FULL: Path(__file__).with_name("full.bin"),
    WITH_TRADE_OFFS: Path(__file__).with_name("trade_offs.bin"),
}
"""The projects that there are, by the sheets of their workbook."""


def project(sheets: Sequence[str]) -> bytes:
    """Return the VBA project of a workbook with these sheets.

    Its document modules are ``ThisWorkbook`` and ``Sheet1``, ``Sheet2``, ... in the order of the
    sheets: the code names that XlsxWriter's ``set_vba_name()`` gives.

    Raises
    ------
    ValueError
        If no project is made for these sheets.
    """
    path = PROJECTS.get(tuple(sheets))
    if path is None:
        found, *known = (", ".join(names) for names in (sheets, *PROJECTS))
        raise ValueError(
            f"no VBA project for the sheets {found}; there is one for {' or '.join(known)}"
        )
    return path.read_bytes()
