"""Workbooks with buttons: what they carry, what is kept when they are written again, their repair."""

from __future__ import annotations

import re
import sys
import zipfile
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace

import openpyxl
import pytest
from office import Office

from grasp_xl.cli.program import main
from grasp_xl.macros import project
from grasp_xl.workbook.book import read_book
from grasp_xl.workbook.layout import CONFIGURATION, SHEETS
from grasp_xl.workbook.macros import BUTTONS, SETTINGS
from grasp_xl.workbook.stamp import is_untouched

SAMPLE = Path(__file__).parents[1] / "workbooks" / "bracket.xlsx"
SHORT = ("--generations", "20", "--no-prove", "--quiet")
FULL = len(SHEETS) + 2
"""Sheets of the sample with buttons: it was fitted, so it has the sheet Part."""
PART = f"xl/worksheets/sheet{FULL}.xml"
"""Of the sheet with the settings."""


@pytest.fixture
def book(tmp_path: Path) -> Path:
    """Make a workbook with buttons."""
    path = tmp_path / "book.xlsm"
    assert main(["new", str(SAMPLE), "-o", str(path), "--quiet"]) == 0
    return path


def pretend(patch: pytest.MonkeyPatch, platform: str, python: str = sys.executable) -> None:
    """Let the program think that it is somewhere else."""
    system = SimpleNamespace(platform=platform, executable=python)
    patch.setattr("grasp_xl.workbook.macros.sys", system)
    patch.setattr("grasp_xl.commands.excel.sys", system)


def parts(path: Path) -> dict[str, bytes]:
    """Return the parts of a workbook."""
    with zipfile.ZipFile(path) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def change(path: Path, changes: dict[str, Callable[[bytes], bytes]]) -> None:
    """Change or add parts of a workbook."""
    content = parts(path)
    for name, changed in changes.items():
        content[name] = changed(content.get(name, b""))
    with zipfile.ZipFile(path, "w") as archive:
        for name, data in content.items():
            archive.writestr(name, data)


def settings(path: Path) -> dict[str, str]:
    """Return the settings as another reader finds them."""
    sheet = openpyxl.load_workbook(path, keep_vba=True)[CONFIGURATION]
    rows = sheet.iter_rows(max_col=2, values_only=True)
    return {str(name): value or "" for name, value in rows}


def test_each_button_calls_its_macro(book: Path) -> None:
    drawing = parts(book)["xl/drawings/vmlDrawing2.vml"].decode()
    buttons = re.findall(
        r'<font[^>]*>([^<]*)</font>.*?ObjectType="Button".*?<x:FmlaMacro>\[0\]!([^<]*)<',
        drawing,
        re.DOTALL,
    )
    assert dict(buttons) == BUTTONS


@pytest.mark.parametrize(
    ("platform", "name"), [("win32", "INTERPRETER_WIN"), ("darwin", "INTERPRETER_MAC")]
)
def test_the_buttons_find_the_python_that_made_them(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, platform: str, name: str
) -> None:
    """On a computer that has Excel; no Python file beside the workbook is ever run."""
    path = tmp_path / "book.xlsm"
    with monkeypatch.context() as patch:
        pretend(patch, platform)
        assert main(["new", str(SAMPLE), "-o", str(path), "--quiet"]) == 0
    found = settings(path)
    assert found[name] == sys.executable
    assert {key: value for key, value in found.items() if key != name and value} == {
        "ADD_WORKBOOK_TO_PYTHONPATH": "false"
    }


def test_a_run_keeps_the_kind_of_workbook(book: Path) -> None:
    """Beside an .xlsm the result is one, too; an .xlsx has no macros."""
    assert main(["run", str(book), *SHORT]) == 0
    result = book.with_name("book-result.xlsm")
    assert parts(result)["xl/vbaProject.bin"] == project(FULL)
    assert main(["run", str(book), "-o", str(book.with_name("plain.xlsx")), *SHORT]) == 0
    assert "xl/vbaProject.bin" not in parts(book.with_name("plain.xlsx"))


def test_in_place_macros_signatures_and_settings_of_others_are_kept(book: Path) -> None:
    """Byte for byte, with the code names that the project knows its sheets by."""
    theirs = project(FULL) + b"signed and changed"
    relation = (
        b'<Relationship Id="rId1" Type="http://schemas.microsoft.com/office/2006/relationships/'
        b'vbaProjectSignature" Target="vbaProjectSignature.bin"/>'
    )
    head = b'<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">'
    change(
        book,
        {
            "xl/vbaProject.bin": lambda _: theirs,
            "xl/vbaProjectSignature.bin": lambda _: b"signature",
            "xl/_rels/vbaProject.bin.rels": lambda _: head + relation + b"</Relationships>",
            "xl/worksheets/sheet3.xml": lambda old: old.replace(b'"Sheet3"', b'"TheirGA"'),
            PART: lambda old: old.replace(b"</sheetData>", _THEIR_SETTING + b"</sheetData>"),
        },
    )
    assert main(["run", str(book), "--in-place", *SHORT]) == 0
    kept = parts(book)
    assert kept["xl/vbaProject.bin"] == theirs
    assert kept["xl/vbaProjectSignature.bin"] == b"signature"
    assert b'codeName="TheirGA"' in kept["xl/worksheets/sheet3.xml"]
    assert settings(book)["SHOW CONSOLE"] == "true"
    assert is_untouched(book)


_THEIR_SETTING = (
    b'<row r="7"><c r="A7" t="inlineStr"><is><t>SHOW CONSOLE</t></is></c>'
    b'<c r="B7" t="inlineStr"><is><t>true</t></is></c></row>'
)


def test_macros_of_a_workbook_that_is_not_ours_are_not_taken_over(tmp_path: Path) -> None:
    """An export with macros gives a workbook with our buttons; in place it is refused."""
    export = tmp_path / "export.xlsm"
    export.write_bytes(SAMPLE.read_bytes())
    change(export, {"xl/vbaProject.bin": lambda _: b"theirs"})
    assert read_book(export).macros is None
    assert main(["run", str(export), "--in-place", *SHORT]) == 3
    assert main(["run", str(export), *SHORT]) == 0
    assert parts(tmp_path / "export-result.xlsm")["xl/vbaProject.bin"] == project(FULL)


# --- repair ---


def test_a_repair_puts_in_this_python(book: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """One cell changes and nothing else; the workbook counts as untouched if it did before."""
    before = parts(book)
    with monkeypatch.context() as patch:
        pretend(patch, "win32")
        assert main(["excel", str(book)]) == 1
        assert main(["excel", "--repair", str(book), "--quiet"]) == 0
        assert main(["excel", str(book), "--quiet"]) == 0
    after = parts(book)
    changed = {name for name in before if before[name] != after[name]}
    assert changed == {PART, "docProps/custom.xml"}
    assert list(before) == list(after)
    assert settings(book) == {**SETTINGS, "INTERPRETER_WIN": sys.executable}
    assert is_untouched(book)


def test_a_workbook_that_another_program_saved_is_repaired(
    book: Path, office: Office, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its texts stand elsewhere in the file; an edited workbook does not become untouched."""
    office.open(book)
    saved = office.save(book.with_name("saved.xlsx")).rename(book.with_name("saved.xlsm"))
    with monkeypatch.context() as patch:
        pretend(patch, "darwin", "/a & b/<python>")
        assert main(["excel", "--repair", str(saved), "--quiet"]) == 1  # no such file
    assert settings(saved)["INTERPRETER_MAC"] == "/a & b/<python>"
    assert not is_untouched(saved)


@pytest.mark.parametrize(
    ("name", "platform", "code", "told"),
    [
        ("book.xlsm", "linux", 2, "found linux, expected Windows or macOS"),
        ("export.xlsx", "win32", 2, "found a name that ends in '.xlsx', expected '.xlsm'"),
        ("export.xlsm", "win32", 3, "found no setting INTERPRETER_WIN"),
    ],
)
def test_what_cannot_be_repaired_is_told(
    book: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
    name: str,
    platform: str,
    code: int,
    told: str,
) -> None:
    """In one sentence, and the file stays as it is."""
    for export in ("export.xlsx", "export.xlsm"):
        book.with_name(export).write_bytes(SAMPLE.read_bytes())
    path = book.with_name(name)
    before = path.read_bytes()
    with monkeypatch.context() as patch:
        pretend(patch, platform)
        assert main(["excel", "--repair", str(path)]) == code
    assert told in capsys.readouterr().err
    assert path.read_bytes() == before
