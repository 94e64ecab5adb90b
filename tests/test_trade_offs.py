"""The sheet of trade-offs: what it shows, what is picked there, and when a run keeps it."""

from __future__ import annotations

import contextlib
import json
import shutil
from collections.abc import Iterator
from pathlib import Path

import openpyxl
import pytest
from bad_workbooks import tiny_export
from editing import edit
from office import Office

from grasp_xl.cli.program import main
from grasp_xl.search import stop
from grasp_xl.workbook.book import read_book
from grasp_xl.workbook.layout import TABLE_ROW, TRADE_OFFS, Area, area_of
from grasp_xl.workbook.picker import GENE_COLUMN, PICK_ROW
from grasp_xl.workbook.trade_offs_sheet import LEGEND, WEIGHTS

GOALS = "1000,90000,900,9000"
HINT = Area(TRADE_OFFS, PICK_ROW, 2)


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Write the workbook of a run on the tiny export, and one of its trade-offs."""
    folder = tmp_path_factory.mktemp("made")
    tiny_export(folder / "tiny.xlsx")
    run = ("run", str(folder / "tiny.xlsx"), "--generations", "300", "--quiet", "--goals", GOALS)
    assert main([*run]) == 0
    front = ("front", str(folder / "tiny-result.xlsx"), "-o", str(folder / "out.xlsx"))
    assert main([*front, "--grid", "2", "--quiet", "--time-limit", "10"]) == 0
    return folder / "out.xlsx"


@pytest.fixture
def book(made: Path, tmp_path: Path) -> Path:
    """Copy the workbook to a folder of its own."""
    return Path(shutil.copy(made, tmp_path / "out.xlsx"))


def run_in_place(book: Path, *words: str) -> int:
    """Run ten generations."""
    return main(["run", str(book), "--in-place", "--generations", "10", "--quiet", *words])


def listed(book: Path) -> list[tuple[object, ...]]:
    """Return the rows of the list."""
    sheet = openpyxl.load_workbook(book)[TRADE_OFFS]
    rows = sheet.iter_rows(min_row=TABLE_ROW + 2, max_col=29, values_only=True)
    return [row for row in rows if row[0] is not None]


def test_the_sheet_lists_what_the_json_has(made: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words = ("--grid", "2", "--json", "--time-limit", "10")
    assert main(["front", str(made.with_name("tiny-result.xlsx")), *words]) == 0
    told = json.loads(capsys.readouterr().out)
    rows = listed(made)
    assert len(rows) == len(told["designs"]) > 2
    for row, design in zip(rows, told["designs"], strict=True):
        assert row[1] == ("proved" if design["proved"] else "found")
        assert [list(row[2:8]), list(row[8:14])] == design["genes"]
        assert row[15:19] == tuple(
            pytest.approx(design[term]) for term in ("cost", "moment", "deviation", "structure")
        )
        weights = list((design["weights"] or dict.fromkeys("abcd")).values())
        assert list(row[25:29]) == pytest.approx(weights)


def test_ctrl_c_writes_what_is_known(
    made: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Interrupted as soon as it begins, front lists the benchmark, says so, and exits with 130."""

    @contextlib.contextmanager
    def interrupted() -> Iterator[stop.Interrupt]:
        yield stop.Interrupt(asked=True)

    monkeypatch.setattr(stop, "stop_on_ctrl_c", interrupted)
    book = made.with_name("interrupted.xlsx")
    sample = made.with_name("tiny-result.xlsx")
    assert main(["front", str(sample), "-o", str(book), "--json"]) == 130
    told = json.loads(capsys.readouterr().out)
    assert (told["interrupted"], told["complete"], told["proved_sums"]) == (True, False, 0)
    assert [row[1] for row in listed(book)] == ["found"] * len(told["designs"]) != []
    assert "interrupted" in str(openpyxl.load_workbook(book)[TRADE_OFFS]["A2"].value)


def test_the_weights_are_printed_on_a_page_of_their_own(made: Path) -> None:
    """With the numbers of the designs, so that no page is as wide as all of the list."""
    sheet = openpyxl.load_workbook(made)[TRADE_OFFS]
    first, weights, charts = map(area_of, sheet.print_area.split(","))
    header = [cell.value for cell in sheet[TABLE_ROW + 1]]
    assert header[weights.column : weights.column + weights.columns] == list(WEIGHTS)
    assert first.columns == weights.column < charts.column
    assert (sheet.print_title_cols, weights.row) == ("$A:$A", TABLE_ROW)


def test_the_legend_says_among_which_grasps_a_design_is_proved(made: Path) -> None:
    """Among all grasps, in words that need no other sheet."""
    sheet = openpyxl.load_workbook(made)[TRADE_OFFS]
    header = [cell.value for cell in sheet[TABLE_ROW + 1]]
    assert [header.count(name) for name in LEGEND] == [2, 2]  # above the chart, above its data


def test_a_pick_is_on_the_what_if_card_and_beats_that_of_the_designs(
    made: Path, office: Office
) -> None:
    """Nonsense counts as none, and the text beside the cell says so."""
    office.open(made)
    best = office.read("WhatIf")
    office.enter({"DesignPick": 1})
    design = office.read("WhatIf")
    for number in (1, len(listed(made))):
        office.enter({"TradeOffPick": number})
        (row,) = office.read(Area(TRADE_OFFS, TABLE_ROW + number, GENE_COLUMN, 1, 12))
        assert office.read("WhatIf") == [row[:6], row[6:]]
        assert "picked on the sheet Trade-offs" in str(
            office.value(Area("Valid Designs", PICK_ROW, 2))
        )
    for nonsense in (0, 999, "abc"):
        office.enter({"TradeOffPick": nonsense})
        assert office.read("WhatIf") == design
        assert "No such number: type a whole number from 1" in str(office.value(HINT))
    office.enter({"TradeOffPick": None, "DesignPick": None})
    assert office.read("WhatIf") == best


@pytest.mark.parametrize("saved_by", ["openpyxl", "LibreOffice"])
def test_a_run_keeps_list_and_pick(
    saved_by: str, book: Path, office: Office, tmp_path: Path
) -> None:
    """As long as its inputs are the same, whatever program saved the workbook."""
    before = listed(book)
    if saved_by == "openpyxl":
        edit(book, lambda opened: opened[TRADE_OFFS].__setitem__("B3", 2))
    else:
        office.open(book)
        office.enter({"TradeOffPick": 2})
        book = office.save(tmp_path / "saved.xlsx")
    assert run_in_place(book, "--seed", "5") == 0
    after = listed(book)
    assert [row[:14] for row in after] == [row[:14] for row in before]
    assert read_book(book).picks.trade_off == read_book(book).trade_offs.designs[1].chromosome


@pytest.mark.parametrize("by", ["LibreOffice", "openpyxl"])
def test_a_workbook_whose_sheet_was_deleted_runs_on(
    book: Path, office: Office, tmp_path: Path, by: str
) -> None:
    """Its What-if card showed a design of the list; nobody typed those genes."""
    if by == "LibreOffice":
        office.open(book)
        office.recalculate()
        office.enter({"TradeOffPick": 2.0})
        office.remove(TRADE_OFFS)
        book = office.save(tmp_path / "without.xlsx")
    else:
        edit(book, lambda opened: opened.remove(opened[TRADE_OFFS]))
    assert read_book(book).what_if is None
    assert run_in_place(book, "--force") == 0
    assert TRADE_OFFS not in openpyxl.load_workbook(book).sheetnames


def test_a_list_of_other_inputs_is_left_out_with_a_warning(
    book: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The picked design stays on the What-if card, as typed genes."""
    edit(book, lambda opened: opened[TRADE_OFFS].__setitem__("B3", 2))
    picked = read_book(book).picks.trade_off
    edit(book, lambda opened: opened["GA"].__setitem__("B12", 77))
    words = ["run", str(book), "--in-place", "--generations", "10"]
    assert main(words) == 0
    told = capsys.readouterr().err
    assert "designs of other inputs: Goal: cost 77, not 1000" in told
    assert TRADE_OFFS not in openpyxl.load_workbook(book, read_only=True).sheetnames
    assert read_book(book).what_if == picked


@pytest.mark.parametrize("cell", ["B9", "D9"])
def test_a_list_that_was_edited_is_never_kept(
    book: Path, cell: str, capsys: pytest.CaptureFixture[str]
) -> None:
    """A proof or gene that was typed proves nothing: in place the sheet is named as lost."""
    value = {
        "B9": "found",
        "D9": 3 if openpyxl.load_workbook(book)[TRADE_OFFS]["D9"].value != 3 else 2,
    }
    edit(book, lambda opened: opened[TRADE_OFFS].__setitem__(cell, value[cell]))
    assert run_in_place(book) == 3
    assert "the sheet 'Trade-offs'" in capsys.readouterr().err


def test_a_remark_on_the_sheet_is_named(book: Path, capsys: pytest.CaptureFixture[str]) -> None:
    edit(book, lambda opened: opened[TRADE_OFFS].__setitem__("AE3", "ask Eva"))
    assert run_in_place(book) == 3
    assert "Trade-offs!AE3" in capsys.readouterr().err


def test_a_new_export_keeps_it_if_nothing_changed(book: Path, tmp_path: Path) -> None:
    tiny_export(tmp_path / "same.xlsx")
    assert main(["new", str(tmp_path / "same.xlsx"), "-o", str(book), "--quiet"]) == 0
    assert listed(book)
    tiny_export(tmp_path / "other.xlsx", {"B5": 4321})
    assert main(["new", str(tmp_path / "other.xlsx"), "-o", str(book), "--quiet"]) == 0
    assert TRADE_OFFS not in openpyxl.load_workbook(book, read_only=True).sheetnames


def test_no_grasp_at_all_is_exit_code_4(book: Path) -> None:
    assert main(["front", str(book), "--fos", "9999", "--quiet"]) == 4
