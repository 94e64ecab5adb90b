"""In place nothing that a designer added is lost silently, and nothing else is named."""

from __future__ import annotations

import re
import shutil
import zipfile
from pathlib import Path
from typing import Any

import openpyxl
import pytest
from bad_workbooks import tiny_export
from editing import Edit, edit, in_cell, typed
from office import Office
from openpyxl.chart import BarChart
from openpyxl.comments import Comment
from openpyxl.formatting.rule import CellIsRule
from openpyxl.workbook.defined_name import DefinedName
from openpyxl.worksheet.datavalidation import DataValidation
from openpyxl.worksheet.table import Table

from grasp_xl.cli.program import main


@pytest.fixture(scope="module")
def result(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Write the workbook of a run on the tiny export."""
    folder = tmp_path_factory.mktemp("result")
    tiny_export(folder / "tiny.xlsx")
    command = ("run", str(folder / "tiny.xlsx"), "--generations", "300", "--quiet")
    assert main([*command, "--goals", "1000,90000,900,9000"]) == 0
    return folder / "tiny-result.xlsx"


@pytest.fixture
def book(result: Path, tmp_path: Path) -> Path:
    """Copy the workbook of a run to a folder of its own."""
    return Path(shutil.copy(result, tmp_path / "out.xlsx"))


def run_in_place(book: Path) -> int:
    """Run ten generations."""
    return main(["run", str(book), "--in-place", "--generations", "10", "--quiet"])


@pytest.mark.parametrize(("name", "value"), [("FoSGoal", 5), ("MinClearance", 60)])
def test_a_run_replaces_one_whose_designs_the_inputs_of_now_rule_out(
    tmp_path: Path, name: str, value: float
) -> None:
    """They stand there with their numbers all the same, and nothing of them is named as lost."""
    sample = Path(__file__).parents[1] / "workbooks" / "bracket-result.xlsx"
    book = Path(shutil.copy(sample, tmp_path / "out.xlsx"))
    edit(book, typed(name, value))
    assert run_in_place(book) == 0


def set_on(sheet: str, path: str, value: object = 1) -> Edit:
    """Make an edit of a property of a sheet, such as ``auto_filter.ref``."""
    *parts, last = path.split(".")

    def change(opened: openpyxl.Workbook) -> None:
        owner: Any = opened[sheet]
        for part in parts:
            key = int(part) if part.isdigit() else part
            owner = getattr(owner, part) if hasattr(owner, part) else owner[key]
        setattr(owner, last, value)

    return change


def note(sheet: str, cell: str, text: str) -> Edit:
    """Make an edit that puts a note on a cell."""
    return lambda opened: setattr(opened[sheet][cell], "comment", Comment(text, "Ada"))


def move_note(opened: openpyxl.Workbook) -> None:
    """Move a note of ours to another label."""
    sheet = opened["GA"]
    text = sheet["A8"].comment.text
    sheet["A8"].comment = None
    sheet["A30"].comment = Comment(text, "Ada")


def another_chart(opened: openpyxl.Workbook) -> None:
    """Put a chart in the place of one of ours."""
    chart = BarChart()
    chart.title = "My costs"
    opened["History"]._charts.pop()
    opened["History"].add_chart(chart, "A60")


def validation(opened: openpyxl.Workbook) -> None:
    """Let a cell without a rule of ours take whole numbers only."""
    rule = DataValidation("whole", formula1="0", formula2="7")
    rule.add("D30")
    opened["GA"].add_data_validation(rule)


def colours(opened: openpyxl.Workbook) -> None:
    """Colour a column of the designs, where we have colours as well."""
    rule = CellIsRule(operator="lessThan", formula=["3.5"], stopIfTrue=True)
    opened["Valid Designs"].conditional_formatting.add("O9:O12", rule)


def table(opened: openpyxl.Workbook) -> None:
    """Make a table of free cells."""
    for cell, value in (("DA1", "a"), ("DA2", 1)):
        opened["History"][cell] = value
    opened["History"].add_table(Table(displayName="Mine", ref="DA1:DA2"))


LOSSES: dict[str, tuple[Edit, str]] = {
    "a filter": (set_on("Run Log", "auto_filter.ref", "A3:B20"), "the filters on Run Log!A3:B20"),
    "a conditional format": (colours, "the conditional formats on Valid Designs!O9:O12"),
    "a validation": (validation, "the validations on GA!D30"),
    "a name": (
        lambda opened: opened.defined_names.add(DefinedName("MyMass", attr_text="GA!$A$1")),
        "the names MyMass",
    ),
    "merged cells": (lambda opened: opened["GA"].merge_cells("A40:B41"), "merged cells GA!A40:B41"),
    "a protection": (set_on("Calc", "protection.sheet"), "the protection of Calc"),
    "a print area": (set_on("GA", "print_area", "A1:C20"), "the print areas of GA"),
    "hidden rows": (set_on("GA", "row_dimensions.9.hidden"), "the hidden rows GA!9:9"),
    "hidden columns": (set_on("GA", "column_dimensions.B.hidden"), "hidden columns GA!B:B"),
    "a hidden sheet": (set_on("Calc", "sheet_state", "hidden"), "the hidden sheets Calc"),
    "a note for one of ours": (note("GA", "A5", "Ask Eva."), "GA!A5"),
    "a note that was moved": (move_note, "GA!A30"),
    "a chart for one of ours": (another_chart, "the charts 'My costs' at History!A60"),
    "a table": (table, "the tables Mine on History"),
    "a label": (in_cell("GA", "A7", "How often"), "the changed cells GA!A7"),
    "a remark in a list": (in_cell("Valid Designs", "O9", "the best!"), "Valid Designs!O9"),
    "a value for a formula": (in_cell("GA", "E43", 9.5), "GA!E43"),
    "a formula for a formula": (in_cell("GA", "E44", "=B5*PI()"), "the formulas in GA!E44"),
    "a formula for a value": (in_cell("Fitness Table", "B5", "=1+1"), "Fitness Table!B5"),
    "an empty sheet": (lambda opened: opened.create_sheet("Empty"), "the sheet 'Empty'"),
}
"""What openpyxl can change in a workbook, and how it is named."""

NUMBERS: dict[str, tuple[Edit, str]] = {
    "a number of a list": (in_cell("Valid Designs", "P10", 1.5), "Valid Designs!P10"),
    "a child's gene": (in_cell("GA", "N24", 5), "GA!N24"),
    "the drawn course": (in_cell("History", "AM5", 123), "History!AM5"),
}
"""What is known to be typed over only as long as no input was changed since the run."""


def test_all_that_would_be_lost_is_named(book: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Before anything is written: its kind and its place."""
    changes = LOSSES | NUMBERS
    edit(book, *(change for change, _ in changes.values()))
    before = book.read_bytes()
    assert run_in_place(book) == 3
    told = capsys.readouterr().err
    assert [what for what, (_, words) in changes.items() if words not in told] == []
    assert book.read_bytes() == before


def test_it_is_named_also_where_inputs_changed(
    book: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """But for numbers that then could be results of the former inputs."""
    inputs = (in_cell("Option Space", "B14", 11), in_cell("GA", "B17", 2), in_cell("GA", "B5", 0))
    edit(book, *inputs, *(change for change, _ in LOSSES.values()))
    assert run_in_place(book) == 3
    told = capsys.readouterr().err
    assert [what for what, (_, words) in LOSSES.items() if words not in told] == []


INPUTS: dict[str, Edit] = {
    "B7 of Option Space": in_cell("Option Space", "B7", 3),
    "a minimum": in_cell("Option Space", "B11", 1),
    "a place": in_cell("Option Space", "D6", 7.5),
    "a diameter": in_cell("Option Space", "V1", 40),
    "a model": in_cell("Option Space", "V4", "FXC"),
    "a weight": in_cell("Option Space", "B15", 99),
    "the scale factor": in_cell("Option Space", "L1", 0.6),
    "a corner": in_cell("Option Space", "Q3", 170),
    "a seed": in_cell("GA", "B17", 5),
    "elitism": in_cell("GA", "B5", 0),
    "generations": in_cell("GA", "B7", 99),
    "a criterion": in_cell("GA", "B10", " Cost +moment"),
    "a goal that is cleared": in_cell("GA", "B12", None),
    "the moment arm": in_cell("GA", "B18", "plan"),
}
"""What may be typed without any loss."""


@pytest.mark.parametrize("what", INPUTS)
def test_no_input_is_a_loss(book: Path, what: str) -> None:
    edit(book, INPUTS[what])
    assert run_in_place(book) == 0


def rename(book: Path, sheet: str, title: str) -> None:
    """Give a sheet another name as Excel does it: all that refers to it follows."""
    with zipfile.ZipFile(book) as package:
        parts = {name: package.read(name) for name in package.namelist()}
    own = f'<sheet name="{sheet}"'.encode(), f'<sheet name="{title}"'.encode()
    referring = rf"'{sheet}'!|\b{sheet}!".encode(), f"'{title}'!".encode()
    with zipfile.ZipFile(book, "w") as package:
        for name, part in parts.items():
            package.writestr(name, re.sub(*referring, part.replace(*own)))


@pytest.mark.parametrize("sheet", ["Option Space", "GA", "History", "Run Log", "Calc"])
def test_a_renamed_sheet_is_named_and_nothing_else(
    book: Path, capsys: pytest.CaptureFixture[str], sheet: str
) -> None:
    """Without it, cells of ours could not be told from the designer's."""
    rename(book, sheet, "Mine")
    before = book.read_bytes()
    assert run_in_place(book) == 3
    told = capsys.readouterr().err
    assert f"has no sheet {sheet!r} any more" in told
    assert "holds what" not in told
    assert book.read_bytes() == before


SIZES = {
    "a place more": {"C11": 7, "D11": 20, "E11": 25, "F11": 10, "B16": 7},
    "a place less": {"D10": None, "E10": None, "F10": None, "B16": 5},
    "a larger maximum": {"B12": 7},
    "a smaller maximum": {"B20": 3},
    "a corner more": {"P7": 5, "Q7": 0, "R7": -120, "S7": 10},
    "a corner less": {"P6": None, "Q6": None, "R6": None, "S6": None},
}
"""What moves cards, and makes lists and the polygon longer or shorter: cells of the option space."""


@pytest.mark.parametrize("what", SIZES)
def test_no_other_size_is_a_loss(book: Path, capsys: pytest.CaptureFixture[str], what: str) -> None:
    """Also where designs of the list have an index that is gone."""
    edit(book, *(in_cell("Option Space", *item) for item in SIZES[what].items()))
    code = run_in_place(book)
    assert (code, capsys.readouterr().err) == (0, "")


def test_libreoffice_loses_nothing_that_would_be_named(
    book: Path, office: Office, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Saved by it as it is, and after inputs, genes and a pick were typed."""
    office.open(book)
    plain = office.save(tmp_path / "plain.xlsx")
    office.enter({"DesignPick": 2})
    picked = office.save(tmp_path / "picked.xlsx")
    office.enter({"SuctionPrice": 12.5, "CostGoal": 70, "Seed": 4, "MomentArm": "plan"})
    typed = office.save(tmp_path / "typed.xlsx")
    for saved in (plain, picked, typed):
        code = run_in_place(saved)
        assert (code, capsys.readouterr().err) == (0, "")
