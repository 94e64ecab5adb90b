"""How a workbook looks, whatever fonts a computer has: fonts, sizes of charts, pages."""

from __future__ import annotations

import io
import re
import zipfile
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import openpyxl
import pytest
from live_cases import Case, random_case
from openpyxl.cell.cell import Cell
from openpyxl.utils.cell import coordinate_to_tuple, range_boundaries
from openpyxl.worksheet.worksheet import Worksheet
from xlsxwriter.utility import xl_pixel_width

from grasp_xl.space import MAX_COUNT
from grasp_xl.task import Parameters, settle
from grasp_xl.workbook import layout
from grasp_xl.workbook.layout import GA
from grasp_xl.workbook.pen import LEAST_SCALE, PAGE_WIDTH


@pytest.fixture(scope="module")
def path(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Write a full workbook."""
    path = tmp_path_factory.mktemp("look") / "case.xlsx"
    path.write_bytes(random_case(1).workbook())
    return path


@pytest.fixture(scope="module")
def parts(path: Path) -> dict[str, str]:
    """Return the text of every part of it."""
    with zipfile.ZipFile(path) as book:
        return {name: book.read(name).decode() for name in book.namelist()}


def charts(parts: dict[str, str]) -> Iterator[str]:
    """Iterate over the charts."""
    return (text for name, text in parts.items() if name.startswith("xl/charts/chart"))


def test_no_cell_follows_the_themes_font(parts):
    """Every font is Arial by name: with a scheme, Excel would show the theme's Calibri."""
    fonts = re.search(r"<fonts .*</fonts>", parts["xl/styles.xml"]).group()
    names = set(re.findall(r'<name val="([^"]*)"', fonts))
    assert names - {"Tahoma"} == {"Arial"}  # XlsxWriter lists it for notes, and uses it nowhere
    assert "<scheme" not in fonts


def test_every_text_of_a_chart_names_its_font(parts):
    """Titles, axes and the legend, if it has one: a chart's own default is the theme's font."""
    for chart in charts(parts):
        texts = re.findall(r"<c:(?:title|txPr)>.*?</c:(?:title|txPr)>", chart)
        assert len(texts) == 5 + ("<c:legend>" in chart)  # three titles, two axes, legend
        assert all('<a:latin typeface="Arial"' in text for text in texts)


def test_missing_points_are_not_seen(parts):
    """The points of the pictures show no black #N/A: where there is none it has the cell's colour."""
    sheet = parts[f"xl/worksheets/sheet{layout.SHEETS.index(layout.GRASP) + 1}.xml"]
    assert "#N/A" in sheet
    rule = re.search(r'<conditionalFormatting sqref="([^"]*)">.*?</conditionalFormatting>', sheet)
    assert 'type="containsErrors"' in rule.group()
    left, top, right, bottom = range_boundaries(rule.group(1))
    missing = re.findall(r'<c r="([A-Z]+\d+)"[^>]*><f>[^<]*</f><v>#N/A', sheet)
    cells = [coordinate_to_tuple(cell) for cell in missing]
    assert all(left <= column <= right and top <= row <= bottom for row, column in cells)


@pytest.fixture(scope="module")
def book(path: Path) -> openpyxl.Workbook:
    """Open it with openpyxl."""
    return openpyxl.load_workbook(path)


def named_cell(book: openpyxl.Workbook, name: str) -> Cell:
    """Return the first cell of a defined name."""
    area = layout.area_of(book.defined_names[name].attr_text)
    return book[area.sheet].cell(area.row + 1, area.column + 1)


def test_results_have_their_units(book):
    """In the fitness table by the format of each number, in the history by the label."""
    row = book[layout.FITNESS_TABLE][4]
    units = [re.sub("[^$A-Za-z-]", "", cell.number_format) for cell in row[1:7]]
    assert units == ["", "$", "N-mm", "mm", "mm", ""]
    labels = [cell.value for cell in book[layout.HISTORY][layout.HISTORY_ROW + 1][1:7]]
    assert labels[1:5] == ["Cost ($)", "Residual Moment (N-mm)", "Deviation (mm)", "Structure (mm)"]


def test_part_data_show_no_round_off(book):
    """Up to six decimals, whatever the value: 0.00, not 5.136E-14."""
    cells = [named_cell(book, field.name) for field in layout.PART.fields]
    assert {cell.number_format for cell in cells} == {"#,##0.00####"}


def test_every_input_has_a_range_and_its_label_a_note(book):
    """Also on the option-space sheet; models are free text, and a list of words refuses by itself."""
    fields = [field for labels in layout.KINDS for field in labels.section.fields]
    fields += [*layout.PART.fields, *layout.PARAMETERS, layout.SCALE_FACTOR]
    fields += [labels.diameter for labels in layout.KINDS]
    names = [*(field.name for field in fields), "DesignPick"]
    for name in names:
        area = layout.area_of(book.defined_names[name].attr_text)
        sheet = book[area.sheet]
        ranges = [str(each.sqref) for each in sheet.data_validations.dataValidation]
        assert area.local in ranges, name
        assert sheet.cell(area.row + 1, area.column).comment, name


def test_every_number_of_a_card_is_explained(book):
    """Each label of a criterion or a sum has a note with meaning and unit, on cards and on the user's block."""
    plan = layout.Layout(gene_slots=5, children=2)
    for first in (plan.what_if.at(plan.what_if.summary_row + 12, 0), plan.user_fitness):
        for column in range(5):
            assert book[GA].cell(first.row + 1, first.column + column + 1).comment.text
    texts = [cell.comment.text for row in book[GA].iter_rows() for cell in row if cell.comment]
    assert all(text.endswith(".") for text in texts)


def test_ranges_of_genes_follow_what_is_typed(book):
    """They are names, not the numbers as written: a new Max. counts at once."""
    found = {
        (each.formula1, each.formula2)
        for each in book[GA].data_validations.dataValidation
        if each.type == "whole"
    }
    assert ("SuctionMin", "MIN(SuctionMax,SuctionTotal,5)") in found
    assert ("MIN(1,MagnetTotal)", "MagnetTotal") in found


def test_the_user_defined_blocks_message_is_as_wide_as_its_block(book):
    """And stands in two lines between its criteria and the next block, whatever the Max."""
    genes = layout.area_of(book.defined_names[layout.USER_BLOCK.name].attr_text)
    plan = layout.Layout(gene_slots=genes.columns - 1, children=2)
    status, below = plan.user_status, plan.block(layout.INITIAL_BLOCK)
    assert status.reference.split("!")[1].replace("$", "") in map(str, book[GA].merged_cells.ranges)
    assert (status.column, status.columns) == (genes.column - 1, genes.columns + 1)
    assert status.row + status.rows == below.row
    assert book[GA].cell(below.row + 1, below.column + 1).value == layout.INITIAL_BLOCK.label


def test_a_chart_has_its_size_whatever_the_cells_under_it(parts):
    """Each is anchored at one cell, with a size: columns of other widths cannot stretch it."""
    drawings = [text for name, text in parts.items() if name.startswith("xl/drawings/drawing")]
    anchors = [anchor for text in drawings for anchor in re.findall(r"<xdr:\w+Anchor[ >]", text)]
    assert anchors == ["<xdr:oneCellAnchor>"] * len(list(charts(parts)))
    assert all(text.count("<xdr:ext ") == text.count("<xdr:oneCellAnchor>") for text in drawings)


@pytest.mark.parametrize("seed", [1, 18])
def test_every_sheet_is_one_page_wide(seed):
    """By a scale that the program finds when it prints, with any font; also with a Max. above 5."""
    with zipfile.ZipFile(io.BytesIO(random_case(seed).workbook())) as book:
        for number in range(1, len(layout.SHEETS) + 1):
            sheet = book.read(f"xl/worksheets/sheet{number}.xml").decode()
            assert '<pageSetUpPr fitToPage="1"/>' in sheet
            (setup,) = re.findall("<pageSetup [^>]*>", sheet)
            assert "scale=" not in setup
            assert "fitToWidth" not in setup  # 1, unless it says otherwise


def test_elements_and_trusses_are_painted_above_the_places(parts):
    """In Excel, where later series lie above, and in LibreOffice, where earlier ones do."""
    pictures = [text for text in charts(parts) if " grasp</a:t>" in text]
    assert len(pictures) == 2
    for picture in pictures:
        drawn = re.findall(r"<c:yVal>.*?<c:f>(.*?)</c:f>", picture)
        places = [number for number, cells in enumerate(drawn) if layout.OPTION_SPACE in cells]
        assert places == list(range(places[0], places[-1] + 1))
        before, after = drawn[: places[0]], drawn[places[-1] + 1 :]
        assert before == after[::-1]
        deleted = re.findall(r'<c:legendEntry><c:idx val="(\d+)"/><c:delete val="1"/>', picture)
        assert set(map(str, range(len(before)))) <= set(deleted)


@pytest.fixture(scope="module")
def widest() -> bytes:
    """Write a workbook with the largest Max. of both kinds."""
    case = random_case(1)
    kinds = tuple(replace(each, count_max=MAX_COUNT) for each in case.space.kinds)
    task = settle(replace(case.space, kinds=kinds), Parameters(children=2), None)
    return Case(case.places, task, None).workbook()


def test_no_chart_has_more_series_than_excel_takes(parts, widest):
    """255, also with 25 cups and 25 magnets: their pictures draw nothing twice."""
    with zipfile.ZipFile(io.BytesIO(widest)) as book:
        wide = {name: book.read(name).decode() for name in book.namelist() if "/charts/" in name}
    counts = [chart.count("<c:ser>") for each in (parts, wide) for chart in charts(each)]
    assert 100 < max(counts) <= 255


def pixels(sheet: Worksheet, first: int, last: int) -> float:
    """Return the width of some columns of a sheet."""
    known = [each for each in sheet.column_dimensions.values() if each.width]
    widths = {column: each.width for each in known for column in range(each.min, each.max + 1)}
    return sum(7 * widths.get(column, 9.14) for column in range(first, last + 1))


@pytest.mark.parametrize("name", [layout.VALID_DESIGNS, layout.HISTORY])
def test_a_wide_list_is_printed_side_by_side_in_readable_pages(book, widest, name):
    """Each with the list's first column, and with a heading in its first row or above it."""
    wide = openpyxl.load_workbook(io.BytesIO(widest))
    header = {layout.VALID_DESIGNS: layout.TABLE_ROW, layout.HISTORY: layout.HISTORY_ROW}[name]
    for opened, abreast in ((book, 1), (wide, 3)):
        sheet = opened[name]
        areas = map(layout.area_of, sheet.print_area.split(","))
        pages = [area for area in areas if area.row in (0, header)]
        assert len(pages) == abreast
        assert sheet.print_title_cols == (None if abreast == 1 else "$A:$A")
        for page in pages:
            repeated = pixels(sheet, 1, 1) if page.column else 0
            width = repeated + pixels(sheet, page.column + 1, page.column + page.columns)
            assert PAGE_WIDTH / width >= LEAST_SCALE / 100


def test_no_label_of_the_run_log_is_cut(book):
    """The value right of it would hide its end: by the widths of Calibri 11, which is wider."""
    sheet = book[layout.RUN_LOG]
    labels = [str(cell.value) for cell in sheet["A"][2:] if cell.value]
    assert max(map(xl_pixel_width, labels)) < pixels(sheet, 1, 1)
