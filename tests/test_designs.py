"""The sheet of valid designs: all of them are drawn, numbered and coloured by what they meet."""

from __future__ import annotations

import re
import zipfile
from pathlib import Path

import openpyxl
import pytest
from bad_workbooks import tiny_export
from office import Office
from openpyxl.formula.translate import Translator
from openpyxl.worksheet.worksheet import Worksheet

from grasp_xl.cli.program import main
from grasp_xl.workbook import layout
from grasp_xl.workbook.designs_sheet import NORMALISED
from grasp_xl.workbook.layout import TABLE_ROW, VALID_DESIGNS, Area, area_of
from grasp_xl.workbook.styles import Style

SCRATCH = Area(VALID_DESIGNS, 0, 200)
"""A free cell, where a formula of a colour is tried."""
ODD_PRICES = {"B14": 7.31, "B22": 31.7}


def run(folder: Path, *words: str) -> Path:
    """Run the tiny export with prices of which no sums are the same."""
    tiny_export(folder / "tiny.xlsx", ODD_PRICES)
    command = ("run", str(folder / "tiny.xlsx"), "--generations", "3000", "--quiet")
    assert main([*command, *words]) == 0
    return folder / "tiny-result.xlsx"


@pytest.fixture(scope="module")
def many(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Find designs of many costs."""
    goals = ("--goals", "100,9000,90,900", "--fos", "1")
    return run(tmp_path_factory.mktemp("many"), "--no-elitism", *goals)


def sheet_of(path: Path) -> Worksheet:
    """Read the sheet of valid designs."""
    return openpyxl.load_workbook(path)["Valid Designs"]


def column_of(sheet: Worksheet, label: str) -> list[object]:
    """Return a column of the table."""
    labels = [cell.value for cell in sheet[TABLE_ROW + 1]]
    last = int(
        sheet.tables["ValidDesigns"].ref.rpartition(":")[2].lstrip("ABCDEFGHIJKLMNOPQRSTUVWXYZ")
    )
    return [
        sheet.cell(row, labels.index(label) + 1).value for row in range(TABLE_ROW + 2, last + 1)
    ]


def drawn(path: Path) -> dict[str, list[int]]:
    """Return what each series of the chart draws: the numbers of designs, by the legend's text.

    The legend is in the cells above the chart, in the order of the series.
    """
    sheet = sheet_of(path)
    with zipfile.ZipFile(path) as parts:
        charts = [parts.read(name).decode() for name in parts.namelist() if "/charts/" in name]
    (chart,) = [text for text in charts if "Trade-off" in text]
    series = re.findall(r"<c:tx>.*?<c:f>([^<]*)</c:f>.*?<c:yVal>.*?<c:f>([^<]*)</c:f>", chart)
    legend = [cell.value for cell in sheet[TABLE_ROW + 1] if str(cell.value).startswith("Cost $")]
    found = {}
    for title, reference in series:
        area = area_of(reference)
        column = [sheet.cell(area.row + 1 + n, area.column + 1).value for n in range(area.rows)]
        title_area = area_of(title)
        name = sheet.cell(title_area.row + 1, title_area.column + 1).value
        if name:
            found[name] = [n for n, value in enumerate(column, 1) if value is not None]
    assert legend == 2 * list(found)  # above the chart, and above its data
    return found


def test_every_design_is_drawn_however_many_costs(many: Path) -> None:
    """At most eight series, and the legend says which costs each has."""
    costs = column_of(sheet_of(many), "Cost ($)")
    assert len(set(costs)) > 8
    series = drawn(many)
    assert len(series) == 8
    assert sorted(n for numbers in series.values() for n in numbers) == list(
        range(1, 1 + len(costs))
    )
    for name, numbers in series.items():
        band = sorted({costs[n - 1] for n in numbers})
        ends = dict.fromkeys(f"${cost:.10g}" for cost in (band[0], band[-1]))
        assert name == f"Cost {' to '.join(ends)}"


def test_a_series_has_one_cost_where_there_are_few(tmp_path: Path) -> None:
    path = run(tmp_path)
    costs = column_of(sheet_of(path), "Cost ($)")
    assert list(drawn(path)) == [f"Cost ${cost:.10g}" for cost in sorted(set(costs))]


def test_designs_are_numbered_from_1(many: Path) -> None:
    numbers = column_of(sheet_of(many), "No.")
    assert numbers == list(range(1, 1 + len(numbers)))


def test_what_misses_a_goal_and_what_meets_all_have_colours(many: Path, office: Office) -> None:
    """Normalised values above 1 stand out; rows that meet all goals are green from end to end."""
    sheet = sheet_of(many)
    rules = {
        str(area.sqref): rule
        for area in sheet.conditional_formatting
        for rule in area.rules
        if ":" in str(area.sqref)  # the cells of the legend have one each
    }
    above, meets = rules.values()
    assert above.dxf.fill.bgColor.rgb.endswith(Style.ABOVE.look["bg_color"][1:])
    assert meets.dxf.fill.bgColor.rgb.endswith(Style.PASSES.look["bg_color"][1:])
    areas = [area_of(f"x!{reference}") for reference in rules]
    table = area_of(f"x!{sheet.tables['ValidDesigns'].ref}")
    labels = [cell.value for cell in sheet[TABLE_ROW + 1]][: table.columns]
    assert labels[areas[0].column :][: areas[0].columns] == list(NORMALISED)
    assert areas[1].columns == table.columns
    office.open(many)
    for area, rule, label, truth in (
        (areas[0], above, "Norm. Cost", lambda value: value > 1),
        (areas[1], meets, "Meets All Goals", lambda value: value == "yes"),
    ):
        assert (area.row, area.rows) == (TABLE_ROW + 1, layout.MAX_DESIGNS)
        column = labels.index(label)
        values = column_of(sheet, label)
        assert len(set(map(truth, values))) == 2
        for number in (0, len(values) - 1, *map(list(map(truth, values)).index, (True, False))):
            moved = Translator(f"={rule.formula[0]}", area.local).translate_formula(
                Area("x", area.row + number, column).local
            )
            office.enter({SCRATCH: moved.replace(",", ";")})
            assert bool(office.value(SCRATCH)) == truth(values[number])
