"""Changing one setting in a workbook with macros, and nothing else in the file."""

from __future__ import annotations

import io
import re
import zipfile
from xml.sax.saxutils import escape

from grasp_xl.errors import InputError, Problem
from grasp_xl.workbook.cells import Source
from grasp_xl.workbook.layout import CONFIGURATION, Area
from grasp_xl.workbook.macros import read_settings
from grasp_xl.workbook.package import Package, sheet_parts
from grasp_xl.workbook.stamp import is_untouched, stamped_anew

_STYLE = re.compile(rb'\bs="\d+"')


def with_setting(package: Package, source: Source, name: str, value: str) -> bytes:
    """Return a workbook in which a setting has another value.

    openpyxl would lose charts and macros, so that only the cell's bytes are replaced.

    Raises
    ------
    InputError
        If the workbook has no such setting.
    """
    names = list(read_settings(source)) if CONFIGURATION in source.sheets else []
    if name not in names:
        found = f"no setting {name}"
        hint = "make the workbook again with grasp-xl run BOOK -o OTHER.xlsm"
        expected = f"a workbook with buttons, and {name} on its sheet {CONFIGURATION}"
        raise InputError([Problem(package.name, found, expected, hint)])
    cell = Area(CONFIGURATION, names.index(name), 1)
    old = io.BytesIO(package.content)
    written = io.BytesIO()
    with zipfile.ZipFile(old) as archive, zipfile.ZipFile(written, "w") as changed:
        part = sheet_parts(package.name, archive)[CONFIGURATION]
        for info in archive.infolist():
            data = archive.read(info)
            if info.filename == part:
                data = _with_text(data, cell, value)
            changed.writestr(info, data)
    content = written.getvalue()
    return stamped_anew(content, package.content) if is_untouched(old) else content


def _with_text(sheet: bytes, cell: Area, text: str) -> bytes:
    """Return a sheet's part with another text in a cell that it has."""
    place = cell.local.encode()
    pattern = re.compile(
        rb'<(?P<tag>(?:\w+:)?c)\b(?P<rest>[^>]*\br="' + place + rb'"[^>]*?)(?:/>|>.*?</(?P=tag)>)',
        re.DOTALL,
    )

    def replaced(found: re.Match[bytes]) -> bytes:
        tag, style = found["tag"], _STYLE.search(found["rest"])
        prefix = tag.removesuffix(b"c")
        look = b" " + style[0] if style else b""
        shown = escape(text).encode()
        return b'<%b r="%b"%b t="inlineStr"><%bis><%bt>%b</%bt></%bis></%b>' % (
            tag,
            place,
            look,
            prefix,
            prefix,
            shown,
            prefix,
            prefix,
            tag,
        )

    changed, number = pattern.subn(replaced, sheet, count=1)
    if number:
        return changed
    raise AssertionError(f"{cell.where} was read, and has no cell in its part")
