"""How a workbook looks, whatever fonts a computer has: fonts, sizes of charts, pages."""

from __future__ import annotations

import re
import zipfile
from collections.abc import Iterator

import pytest
from live_cases import random_case
from openpyxl.utils.cell import coordinate_to_tuple, range_boundaries

from grasp_xl.workbook import layout


@pytest.fixture(scope="module")
def parts(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """Return the text of every part of a full workbook."""
    path = tmp_path_factory.mktemp("look") / "case.xlsx"
    path.write_bytes(random_case(1).workbook())
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
    """Titles, axes and legends are in Arial too: a chart's own default is the theme's font."""
    for chart in charts(parts):
        texts = re.findall(r"<c:(?:title|txPr)>.*?</c:(?:title|txPr)>", chart)
        assert len(texts) == 6  # chart title, two axis titles, two axes, legend
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
