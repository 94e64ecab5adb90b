"""Makes the VBA projects from their sources: ``python -m grasp_xl.macros.build``.

For developers, after a change of a source or of the list of sheets.  Nothing in a project
depends on the time or on chance: the same sources give the same bytes.
"""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory

from xlsxwriter import Workbook

from grasp_xl.macros import MODULES, PROJECTS

NO_CACHE = bytes.fromhex("cc61 ffff 00 0000")
"""Stream ``_VBA_PROJECT`` of a project without compiled code ([MS-OVBA] 2.3.4.1).

Its version, 0xFFFF, is none of Excel's, so that every Excel compiles the sources ([MS-OVBA] 1.6).
"""


def build(sheets: int) -> bytes:
    """Return the VBA project of a workbook with so many sheets."""
    from pyopenvba import ExcelFile, VBAModuleKind  # only developers have it
    from pyopenvba.cfb import CFB

    with TemporaryDirectory() as folder:
        path = Path(folder) / "book.xlsm"  # pyOpenVBA goes by the ending, not by the content type
        _write_without_macros(path, sheets)
        with ExcelFile(path) as book:
            project = book.add_vba_project()
            for source in MODULES:
                text = source.read_bytes().decode("ascii")
                is_class = source.suffix == ".cls"
                kind = VBAModuleKind.other if is_class else VBAModuleKind.standard
                project.add_module(source.stem, text, kind=kind)
            for module in project.modules:
                module.dirty = True  # also those of the template, which have compiled code
            book.save()
            streams = CFB.from_bytes(book.vba_project_bytes())
    # pyOpenVBA leaves its template's version: an Excel of just that version would take the cache,
    # which is empty, for compiled code.
    streams.write_stream_in_storage("VBA", "_VBA_PROJECT", NO_CACHE)
    content: bytes = streams.to_bytes()
    return content


def main() -> None:
    """Write every project into this package."""
    for sheets, path in PROJECTS.items():
        path.write_bytes(build(sheets))


def _write_without_macros(path: Path, sheets: int) -> None:
    """Write a workbook of empty sheets."""
    with Workbook(path) as book:
        for _ in range(sheets):
            book.add_worksheet()


if __name__ == "__main__":
    main()
