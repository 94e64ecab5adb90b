"""xlwings drives a workbook in LibreOffice: the engine with which the tests stand in for Excel."""

from __future__ import annotations

import datetime as dt
import os
import subprocess
import sys
from pathlib import Path

import calc_engine
import openpyxl
import pytest
import xlsxwriter
from office import OfficeError

from grasp_xl.workbook.cells import same_formula

WORKBOOKS = Path(__file__).parents[1] / "workbooks"


@pytest.fixture
def book(office, tmp_path):
    """Open a small workbook: two sheets, a table, a name, an error."""
    path = tmp_path / "small.xlsx"
    with xlsxwriter.Workbook(path) as made:
        sheet = made.add_worksheet("My Sheet")
        sheet.write_row(0, 0, ["Number", "Text"])
        sheet.write_row(1, 0, [1.5, "one"])
        sheet.add_table(
            "A1:B2", {"name": "Parts", "columns": [{"header": "Number"}, {"header": "Text"}]}
        )
        sheet.write_formula("D1", "=1/0", None, "#DIV/0!")
        sheet.write_formula("D2", "=NA()", None, "#N/A")
        made.add_worksheet("GA")
        made.define_name("Two", "='My Sheet'!$A$1:$B$2")
    office.open(path)
    return calc_engine.book_of(office)


def test_a_block_comes_back_as_it_was_written(book):
    """Numbers, texts, truths, dates and blanks of a block come back as they were written."""
    block = [[0.1 + 0.2, "text", None], [True, dt.datetime(2024, 2, 29, 12), "=not"]]  # noqa: DTZ001
    block[1][2] = "'=text"
    cells = book.sheets["GA"].range("B2:D3")
    cells.value = block
    block[1][2] = "=text"
    assert cells.value == block
    cells.value = [[1, "2.5", "'2.5"], [None, "", 0]]
    assert cells.value == [[1, 2.5, "2.5"], [None, None, 0]]


def test_whole_numbers_of_more_than_32_bits_are_refused(book):
    """As appscript's are by Excel on a Mac, so that no test passes which would fail there."""
    with pytest.raises(TypeError):
        book.sheets["GA"].range("A1").formula = 2**31


def folded(rows):
    return [[same_formula(text) for text in row] for row in rows]


def test_formulas_of_every_sheet_read_as_in_the_file(office):
    """Formulas of every sheet of a full workbook read in Excel's syntax, and survive being written back."""
    path = WORKBOOKS / "bracket-result.xlsx"
    office.open(path)
    book = calc_engine.book_of(office)
    stored = openpyxl.load_workbook(path)
    assert [sheet.name for sheet in book.sheets] == stored.sheetnames
    for sheet in book.sheets:
        cells = sheet.used_range
        read = cells.formula
        for row in stored[sheet.name].iter_rows():
            for cell in row:
                if cell.data_type == "f":
                    text = read[cell.row - cells.row][cell.column - cells.column]
                    assert same_formula(text) == same_formula(cell.value)
        cells.formula = read
        assert folded(cells.formula) == folded(read)  # LibreOffice writes long numbers anew


def test_errors_read_as_text_or_as_nothing(book):
    """Errors are read as their text where it is asked for, else as nothing."""
    cells = book.sheets["My Sheet"].range("D1:D2")
    assert cells.options(err_to_str=True).value == ["#DIV/0!", "#N/A"]
    assert cells.value == [None, None]


def test_formulas_are_typed_in_excels_words(book):
    """Formulas with commas, other sheets and constant arrays are typed and calculated, beside constants."""
    cells = book.sheets["GA"].range("A1:C1")
    cells.formula = [["=SUM('My Sheet'!$A$2,{1,2;3,4},TRUE)&\"a,b;'c'!d\"", "'=text", 1e-05]]
    assert cells.value == ["12.5a,b;'c'!d", "=text", 1e-05]
    assert cells.formula == (
        ("=SUM('My Sheet'!$A$2,{1,2;3,4},TRUE)&\"a,b;'c'!d\"", "=text", "1E-05"),
    )


def test_nothing_is_calculated_while_calculation_is_manual(book):
    """With manual calculation nothing follows what is typed until it is told to."""
    one, two = book.sheets["GA"].range("A1"), book.sheets["GA"].range("A2")
    one.value, two.formula = 1, "=A1+1"
    with book.app.properties(calculation="manual", screen_updating=False):
        one.value = 5
        assert two.value == 2
        book.app.calculate()
        assert two.value == 6
    assert book.app.calculation == "automatic"


def test_names_are_read_changed_added_and_deleted(book):
    """Defined names are read in Excel's words, changed, added and deleted."""
    assert [(name.name, name.refers_to) for name in book.names] == [
        ("Two", "='My Sheet'!$A$1:$B$2")
    ]
    book.names["Two"].refers_to = "=GA!$B$5:$C$6"
    book.names.add("Three", "='My Sheet'!$A$3")
    assert book.names["Two"].refers_to_range.address == "$B$5:$C$6"
    assert "Three" in book.names
    book.names["Three"].delete()
    assert [(name.name, name.refers_to) for name in book.names] == [("Two", "=GA!$B$5:$C$6")]


def test_a_table_grows_in_the_saved_file(book, tmp_path):
    """A table that was given more rows has them in the file, as print areas and formats have."""
    sheet = book.sheets["My Sheet"]
    table = sheet.tables["Parts"]
    sheet.range("A3:B4").value = [[2, "two"], [3, "three"]]
    table.resize(sheet.range("A1").resize(4, 2))
    assert table.range.address == "$A$1:$B$4"
    sheet.page_setup.print_area = "$A$1:$B$4,$D$1:$D$2"
    cells = sheet.range((3, 1), (4, 2))
    cells.number_format, cells.color, cells.font.bold = "0.00", "#FFCC00", True
    cells.horizontal_alignment, cells.vertical_alignment, cells.wrap_text = "center", "top", True
    cells.borders.set("edge_bottom", line_style="continuous", weight="medium", color="#112233")
    assert (cells.number_format, cells.color) == ("0.00", (255, 204, 0))
    sheet.range("F1:G2").merge()
    book.save(tmp_path / "saved.xlsx")
    assert book.name == "saved.xlsx"
    saved = openpyxl.load_workbook(tmp_path / "saved.xlsx")["My Sheet"]
    assert saved.tables["Parts"].ref == "A1:B4"
    assert saved.print_area == "'My Sheet'!$A$1:$B$4,'My Sheet'!$D$1:$D$2"
    assert str(saved.merged_cells) == "F1:G2"
    cell = saved["B4"]
    assert (cell.number_format, cell.font.b, cell.fill.fgColor.rgb) == ("0.00", True, "FFFFCC00")
    assert (cell.alignment.horizontal, cell.alignment.vertical) == ("center", "top")
    assert (cell.border.bottom.style, saved["B3"].border.bottom.style) == ("medium", None)


def test_a_protected_sheet_refuses_what_is_written(book, office):
    """Nothing can be written to the locked cells of a protected sheet."""
    office.do("protect", sheet="GA")
    cells = book.sheets["GA"].range("A1:B1")
    with pytest.raises(OfficeError, match="protected"):
        cells.value = 1
    with pytest.raises(OfficeError, match="protected"):
        cells.color = "#112233"
    assert cells.value == [None, None]


def test_another_process_writes_into_the_same_workbook(book, office, tmp_path, monkeypatch):
    """Another process finds the open workbook as its caller; what it says is noted, and LibreOffice lives on."""
    log = tmp_path / "log.jsonl"
    monkeypatch.setenv(calc_engine.LOG, str(log))
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join(sys.path))
    book.app.status_bar = "here"
    script = (
        "import sys, calc_engine, xlwings; calc_engine.connect(*sys.argv[1:]);"
        "book = xlwings.Book.caller(); book.sheets['GA'].range('C3').value = book.app.pid;"
        "book.app.status_bar = 'there'; print(book.app.alert('Done.', title='Grasp'))"
    )
    there = [sys.executable, "-c", script, office.pipe, book.name]
    said = subprocess.check_output(there, text=True)  # noqa: S603 (our own script)
    assert said == "ok\n"
    assert book.sheets["GA"].range("C3").value == book.app.pid
    noted = [(entry["kind"], entry["text"]) for entry in calc_engine.noted(log)]
    assert noted == [("status", "here"), ("status", "there"), ("alert", "Done.")]


def test_an_unsaved_workbook_has_no_folder(book, office):
    """The full name of a workbook that was never saved is its name."""
    assert book.fullname == str(office.path)
    office.open(office.path, unsaved=True)
    assert book.fullname == book.name
    assert book.sheets["My Sheet"].range("A2").value == 1.5


def test_a_filter_hides_rows_from_a_block_that_is_written(book, office):
    """As in Excel: the first cell goes into each visible row, hidden ones stay, and have no height."""
    cells = book.sheets["My Sheet"].range("A2:A4")
    cells.value = [[1], [2], [3]]
    book.sheets["My Sheet"].tables["Parts"].resize(book.sheets["My Sheet"].range("A1:B4"))
    assert cells.row_height > 0
    office.do("filter", table="Parts", column=0, text="2")
    assert [cell.row_height > 0 for cell in cells] == [False, True, False]
    assert cells.row_height is None
    cells.value = [[5], [6], [7]]
    office.do("filter", table="Parts", column=0, text=None)
    assert cells.row_height > 0
    assert cells.value == [1, 5, 3]
