"""What we write is what others read: calamine, SheetJS, and Microsoft's own validator."""

from __future__ import annotations

import json
import zipfile
from datetime import datetime
from pathlib import Path

import openpyxl
import pytest
from live_cases import random_case
from npm import complaints, node
from python_calamine import CalamineWorkbook

from grasp_xl.commands.front import front_file
from grasp_xl.commands.new import make_workbook
from grasp_xl.commands.output import Output
from grasp_xl.commands.run import run_file
from grasp_xl.search.stop import Generations, Interrupt
from grasp_xl.task import Parameters
from grasp_xl.workbook.reading import open_source, read_option_space
from grasp_xl.workbook.writing import export_workbook

HERE = Path(__file__).parent
SAMPLES = HERE.parent / "workbooks"
BOOKS = ("export", "new", "result", "trade-offs", "one kind", "wide")
NOT_AVAILABLE = "#N/A"

Cells = dict[tuple[str, int, int], object]
"""What a reader finds: sheet, row and column, from 0, of every cell that is not blank."""

SHEETJS = """
const XLSX = require("xlsx");
const book = XLSX.readFile(process.argv[1]);
const cells = [];
for (const name of book.SheetNames)
  for (const [at, cell] of Object.entries(book.Sheets[name])) {
    if (at.startsWith("!")) continue;
    const place = XLSX.utils.decode_cell(at);
    cells.push([name, place.r, place.c, cell.t === "e" ? cell.w : cell.v]);
  }
console.log(JSON.stringify(cells));
"""


@pytest.fixture(scope="session")
def books(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """Write one workbook of each sort."""
    folder = tmp_path_factory.mktemp("books")
    paths = {name: folder / f"{name}.xlsx" for name in BOOKS}
    space = read_option_space(open_source(SAMPLES / "door_frame.xlsx"))
    paths["export"].write_bytes(export_workbook(space).content)
    make_workbook(paths["export"], Parameters(), Output(paths["new"]))
    output = Output(paths["result"])
    run_file(paths["new"], Parameters(), output, stop=lambda _: [Generations(500)])
    front = Output(paths["trade-offs"])
    sample = SAMPLES / "bracket.xlsx"
    front_file(sample, Parameters(), front, grid=2, time_limit_s=20, interrupt=Interrupt())
    for name, seed in (("one kind", 3), ("wide", 27)):
        paths[name].write_bytes(random_case(seed).workbook(generations=0))
    return paths


# --- readers ---


def read_by_openpyxl(path: Path) -> Cells:
    """Read the values with openpyxl."""
    return {
        (sheet.title, cell.row - 1, cell.column - 1): cell.value
        for sheet in openpyxl.load_workbook(path, data_only=True)
        for row in sheet.iter_rows()
        for cell in row
        if cell.value not in (None, "")
    }


def read_by_calamine(path: Path) -> Cells:
    """Read the values with calamine, the reader behind fast data frames."""
    book = CalamineWorkbook.from_path(str(path))
    return {
        (name, row, column): value
        for name in book.sheet_names
        for row, values in enumerate(book.get_sheet_by_name(name).to_python(skip_empty_area=False))
        for column, value in enumerate(values)
        if value != ""
    }


def read_by_sheetjs(path: Path) -> Cells:
    """Read the values with SheetJS, the reader of web pages."""
    cells = json.loads(node("xlsx", "-e", SHEETJS, str(path)))
    return {(sheet, row, column): value for sheet, row, column, value in cells if value != ""}


READERS = {
    read_by_calamine: (datetime, NOT_AVAILABLE),  # it shows errors as blanks
    read_by_sheetjs: (datetime,),
}
"""Readers, and what each shows in a way of its own."""


@pytest.mark.parametrize("name", BOOKS)
@pytest.mark.parametrize("read", READERS)
def test_other_readers_find_the_same_cells(read, name, books):
    """Every number, to the last bit, and every text is what openpyxl reads."""
    expected, found = read_by_openpyxl(books[name]), read(books[name])
    for place, value in expected.items():
        if type(value) in READERS[read] or value in READERS[read]:
            found.pop(place, None)
        else:
            assert (place, found.pop(place, None)) == (place, value)
    assert found == {}


# --- the validator ---


@pytest.mark.parametrize("name", BOOKS)
@pytest.mark.parametrize("version", ["Office2016", "Microsoft365"])
def test_open_xml_sdk_finds_no_error(name, version, books):
    """By Microsoft's schemas, every sort of workbook is valid, for the oldest Excel and the newest."""
    assert complaints(books[name], version) == []


def test_open_xml_sdk_finds_an_error(books, tmp_path):
    """The validator does look: it names an attribute that no sheet has."""
    wrong = tmp_path / "wrong.xlsx"
    with zipfile.ZipFile(books["export"]) as parts, zipfile.ZipFile(wrong, "w") as copy:
        for name in parts.namelist():
            content = parts.read(name)
            copy.writestr(name, content.replace(b"<sheetData>", b'<sheetData colour="red">'))
    (complaint,) = complaints(wrong)
    assert "colour" in complaint["description"]
