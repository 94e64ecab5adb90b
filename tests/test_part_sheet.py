"""The sheet ``Part`` goes from the exported sheet through every workbook that is made of it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import openpyxl
import pytest
from shapely import Point, box

from grasp_xl.cli.program import main
from grasp_xl.errors import OutputError
from grasp_xl.fitment.part import rings_of
from grasp_xl.workbook.book import Book, read_book
from grasp_xl.workbook.layout import PART_SHEET, SHEETS
from grasp_xl.workbook.part_sheet import FaceOutline, PartRecord
from grasp_xl.workbook.writing import export_workbook

SAMPLE = Path(__file__).parents[1] / "workbooks" / "bracket.xlsx"
RUN = ("--generations", "20", "--no-prove", "--quiet")
PLATE = box(0, 0, 100, 50).difference(Point(30, 20).buffer(5, 2))
RECORD = PartRecord(
    (("Source file", "part.step"), ("Pitch (mm)", 12.5), ("Cup faces", "all-up")),
    (
        FaceOutline(0, None, PLATE.area, "", rings_of(PLATE)),
        FaceOutline(1, 7.25, PLATE.area, "suction, magnets", rings_of(PLATE)),
        FaceOutline(2, -1.0, 25.0, "magnets", rings_of(box(0, 0, 5, 5))),
    ),
)


def same(one: PartRecord | None, other: PartRecord) -> bool:
    """Compare what two sheets say."""
    if one is None or one.facts != other.facts:
        return False
    for ours, theirs in zip(one.outlines, other.outlines, strict=True):
        if (ours.number, ours.height_mm, ours.used_for) != (
            theirs.number,
            theirs.height_mm,
            theirs.used_for,
        ):
            return False
        pairs = zip(ours.rings, theirs.rings, strict=True)
        if not all(np.array_equal(a, b) for a, b in pairs):
            return False
    return True


@pytest.fixture
def export(tmp_path: Path) -> Path:
    """Write an exported sheet with the record."""
    path = tmp_path / "export.xlsx"
    path.write_bytes(export_workbook(read_book(SAMPLE).space, RECORD).content)
    return path


def test_every_workbook_keeps_it(export: Path, tmp_path: Path) -> None:
    """As it was written, number for number: through new, run, in place, and a trade-off front."""
    made, result = tmp_path / "made.xlsx", tmp_path / "result.xlsx"
    assert same(read_book(export).part, RECORD)
    assert main(["new", str(export), "-o", str(made), "--quiet"]) == 0
    assert main(["run", str(made), "-o", str(result), *RUN]) == 0
    assert main(["run", str(result), "--in-place", *RUN]) == 0
    assert main(["front", str(result), "-o", str(tmp_path / "front.xlsx"), "--grid", "1"]) == 0
    for path in (made, result, tmp_path / "front.xlsx"):
        assert same(read_book(path).part, RECORD)
    opened = openpyxl.load_workbook(result)
    assert opened.sheetnames == [SHEETS[0], PART_SHEET, *SHEETS[1:]]


def test_an_exported_sheet_is_replaced_in_place_without_loss(export: Path) -> None:
    """All that ``fit`` wrote is known as the program's own: also models and diameters."""
    book = read_book(export)
    assert main(["run", str(export), "--in-place", *RUN]) == 0
    again = read_book(export)
    for was, now in zip(book.space.kinds, again.space.kinds, strict=True):
        assert (was.model, was.diameter_mm) == (now.model, now.diameter_mm)


def edited(path: Path, cell: str, value: object) -> Book:
    """Type into a cell of the sheet, and read the workbook."""
    opened = openpyxl.load_workbook(path)
    opened[PART_SHEET][cell] = value
    opened.save(path)
    return read_book(path)


def test_an_edited_fact_stays_as_it_is(export: Path) -> None:
    """A designer may write another name there."""
    book = edited(export, "B4", "door.step, rev. C")
    assert book.part is not None
    assert book.part.facts[0] == ("Source file", "door.step, rev. C")
    assert book.warnings == ()


@pytest.mark.parametrize(("cell", "value"), [("K4", "x"), ("D3", "Number"), ("F5", None)])
def test_a_list_that_says_no_outlines_is_told(export: Path, cell: str, value: object) -> None:
    """It is not carried over, and a warning says so."""
    book = edited(export, cell, value)
    assert book.part is None
    (warning,) = book.warnings
    assert warning.where == f"sheet {PART_SHEET!r}"


def test_somebodys_own_sheet_of_that_name_is_theirs(tmp_path: Path) -> None:
    """It is not ours by its name alone: replacing the workbook names it as a loss."""
    path = tmp_path / "own.xlsx"
    opened = openpyxl.load_workbook(SAMPLE)
    del opened[PART_SHEET]
    opened.create_sheet(PART_SHEET)["A1"] = "my notes"
    opened.save(path)
    assert read_book(path).part is None
    with pytest.raises(OutputError, match=f"the sheet '{PART_SHEET}'"):
        main(["run", str(path), "--in-place", *RUN, "--debug"])
