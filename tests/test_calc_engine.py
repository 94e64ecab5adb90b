"""xlwings drives a workbook in LibreOffice: the engine with which the tests stand in for Excel."""

from __future__ import annotations

import datetime as dt

import calc_engine
import pytest
import xlsxwriter


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
