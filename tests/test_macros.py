"""The VBA projects that we ship hold our sources and xlwings', and nothing else."""

from __future__ import annotations

import hashlib
import re
import tomllib
import warnings
import zipfile
from pathlib import Path
from typing import Any

import pytest
import xlwings
from npm import complaints
from office import Office

from grasp_xl.cli.program import main
from grasp_xl.macros import MODULES, PROJECTS, project
from grasp_xl.macros.build import build
from grasp_xl.workbook.book import read_book
from grasp_xl.workbook.layout import SHEETS
from grasp_xl.workbook.writing import export_workbook

ROOT = Path(__file__).parent.parent
PYPROJECT, SAMPLE = ROOT / "pyproject.toml", ROOT / "workbooks" / "bracket.xlsx"
SOURCES = {path.stem: path.read_bytes().decode("ascii") for path in MODULES}
FULL = len(SHEETS) + 1
"""Sheets of a workbook with macros and without an occasional one."""
DIGESTS = {
    FULL: "4fbc2ea98d167880321e2f75a73f3bc9adb02abc53d795791442a344f76d09b5",
    FULL + 1: "8717f09f95b2a2e122ed7dc5e1f7855391d9c660604017c8968cc4ed9d9c9f46",
    FULL + 2: "ec2dc306ce3b137cb9ef09219f0293a356b4422cb661b1028cdc6ffbe3c89890",
}
MACROS = {"CheckGrasp": "check", "RunGrasp": "run", "ProveGrasp": "prove", "StopGrasp": "stop"}

LIBRARY = "VBAProject"
DECLARED = {"xlwings": "Module", "Dictionary": "Class", "GraspXL": "Module"}
ABOVE = {
    "Document": "Rem Attribute VBA_ModuleType=VBADocumentModule\nOption VBASupport 1\n",
    "Module": "Rem Attribute VBA_ModuleType=VBAModule\nOption VBASupport 1\n",
    "Class": "Rem Attribute VBA_ModuleType=VBAClassModule\nOption VBASupport 1\nOption ClassModule\n",
}
"""What LibreOffice writes above a module's source, in place of its attributes."""
CLASS_FILE = re.compile(r"VERSION 1\.0 CLASS\r\nBEGIN\r\n.*?\r\nEND\r\n", re.DOTALL)
"""What the file of a class has above the source."""
CLASS_BASE = 'Attribute VB_Base = "0{FCFB3D2A-A0FA-1068-A738-08002B3371B5}"\r\n'
"""What the source of a class has in a project and not in a file."""

every_project = pytest.mark.parametrize("sheets", PROJECTS, ids=str)


def opened(content: bytes) -> Any:
    """Open a VBA project with olevba."""
    with warnings.catch_warnings():
        # It calls pyparsing by names that pyparsing no longer likes.
        warnings.simplefilter("ignore", DeprecationWarning)
        from oletools.olevba import VBA_Parser
    return VBA_Parser(LIBRARY, data=content)


def documents(sheets: int) -> list[str]:
    """Names of the modules that belong to the workbook and to its sheets."""
    return ["ThisWorkbook", *(f"Sheet{number + 1}" for number in range(sheets))]


def without_attributes(source: str) -> list[str]:
    """Lines of a source that a person sees in an editor."""
    lines = CLASS_FILE.sub("", source).splitlines()
    return [line for line in lines if not line.startswith("Attribute ")]


@pytest.fixture(scope="module")
def books(tmp_path_factory: pytest.TempPathFactory) -> dict[int, Path]:
    """Make a workbook with macros for each project, as a person does: plain, fitted, with front."""
    folder = tmp_path_factory.mktemp("macros")
    full, fitted, front = (folder / f"{name}.xlsm" for name in ("full", "fitted", "front"))
    export = folder / "export.xlsx"
    export.write_bytes(export_workbook(read_book(SAMPLE).space).content)
    for made, source in ((full, export), (fitted, SAMPLE)):
        assert main(["new", str(source), "-o", str(made), "--quiet"]) == 0
    assert main(["front", str(fitted), "-o", str(front), "--grid", "1", "--quiet"]) == 0
    return {FULL: full, FULL + 1: fitted, FULL + 2: front}


@pytest.fixture
def book(sheets: int, books: dict[int, Path]) -> Path:
    """Return the workbook with these sheets."""
    return books[sheets]


# --- the sources ---


def test_modules_of_xlwings_are_those_of_the_pinned_one():
    """The modules that we ship are, byte for byte, those of the xlwings that the extra installs."""
    installed = Path(xlwings.__file__).parent
    assert SOURCES["xlwings"].encode() == (installed / "xlwings.bas").read_bytes()
    assert SOURCES["Dictionary"].encode() == (installed / "addin" / "Dictionary.cls").read_bytes()
    (version,) = re.findall(r"^'Version: (.+)\r$", SOURCES["xlwings"], re.MULTILINE)
    extras = tomllib.loads(PYPROJECT.read_text(encoding="utf-8"))["project"]
    assert f"xlwings=={version}" in extras["optional-dependencies"]["excel"]


def test_sources_keep_their_licences():
    """What others wrote says who they are, and on which terms it is shipped."""
    assert "BSD 3-clause license" in SOURCES["xlwings"]
    assert "Zoomer Analytics LLC" in SOURCES["xlwings"]
    assert "License: MIT" in SOURCES["Dictionary"]
    assert "Tim Hall" in SOURCES["Dictionary"]


def test_each_macro_calls_one_python_function():
    """A macro is one line, which runs the function of its name; there is no other code."""
    subs = [
        f'Public Sub {macro}()\r\n    RunPython "import grasp_xl.live; grasp_xl.live.{call}()"\r\nEnd Sub'
        for macro, call in MACROS.items()
    ]
    code = [line for line in without_attributes(SOURCES["GraspXL"]) if not line.startswith("'")]
    expected = "\n".join(["Option Explicit", *subs]).splitlines()
    assert [line for line in code if line] == expected


# --- the projects ---


@every_project
def test_projects_are_those_that_we_know(sheets):
    """A project never changes unnoticed."""
    assert hashlib.sha256(project(sheets)).hexdigest() == DIGESTS[sheets]


@every_project
def test_building_again_gives_the_same_bytes(sheets):
    """What we ship is what the sources beside it give."""
    assert build(sheets) == project(sheets)


@every_project
def test_olevba_finds_the_sources_and_no_other_code(sheets):
    """The modules hold the sources, byte for byte, and those of workbook and sheets no code."""
    found = [(name, code) for _, _, name, code in opened(project(sheets)).extract_macros()]
    names = [f"{name}.cls" for name in documents(sheets)]
    assert [name for name, _ in found] == names + [path.name for path in MODULES]
    codes = dict(found)
    assert [without_attributes(codes[name]) for name in names] == [[]] * len(names)
    code = {path.stem: codes[path.name].replace(CLASS_BASE, "") for path in MODULES}
    assert code == {name: CLASS_FILE.sub("", source) for name, source in SOURCES.items()}


@every_project
def test_each_sheet_has_a_document_module(sheets):
    """Workbook and sheets are declared as documents, the others as modules and a class."""
    text = opened(project(sheets)).ole_file.openstream("PROJECT").read().decode("ascii")
    declared = [line for line in text.splitlines() if re.match("Document|Module|Class|Base", line)]
    expected = [f"Document={name}/&H00000000" for name in documents(sheets)]
    assert declared == expected + [f"{kind}={name}" for name, kind in DECLARED.items()]


@every_project
def test_project_has_no_compiled_code(sheets):
    """Each Excel compiles the sources: the project's version is none's, and its cache is empty."""
    stream = opened(project(sheets)).ole_file.openstream("VBA/_VBA_PROJECT").read()
    assert stream == b"\xcc\x61\xff\xff\x00\x00\x00"


@pytest.mark.parametrize("sheets", [0, FULL - 1, FULL + 3])
def test_another_number_of_sheets_has_no_project(sheets):
    """A project is for so many sheets; for fewer or more there is none."""
    with pytest.raises(ValueError, match=f"no VBA project for {sheets} sheets"):
        project(sheets)


# --- workbooks with them ---


@every_project
def test_code_names_are_those_of_the_documents(sheets, book):
    """Workbook and sheets have the names that the document modules have."""
    with zipfile.ZipFile(book) as parts:
        assert parts.read("xl/vbaProject.bin") == project(sheets)
        names = ["workbook", *(f"worksheets/sheet{number + 1}" for number in range(sheets))]
        texts = [parts.read(f"xl/{name}.xml").decode() for name in names]
    found = [re.findall('<(?:workbook|sheet)Pr [^>]*codeName="(.+?)"', text) for text in texts]
    assert found == [[name] for name in documents(sheets)]


@every_project
def test_libreoffice_finds_the_same_modules(sheets, book, office: Office):
    """LibreOffice opens the workbook with macros enabled, and lists the same sources."""
    office.open(book, macros=True)
    expected = dict.fromkeys(documents(sheets), ABOVE["Document"] + "\n")
    for name, source in SOURCES.items():
        body = "\n".join(without_attributes(source))
        expected[name] = f"{ABOVE[DECLARED[name]]}{body}\n\n"
    assert office.modules(LIBRARY) == expected


@every_project
@pytest.mark.parametrize("version", ["Office2016", "Microsoft365"])
def test_open_xml_sdk_finds_no_error(version, book):
    """By Microsoft's schemas, a workbook with macros and buttons is valid."""
    assert complaints(book, version) == []
