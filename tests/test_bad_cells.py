"""Wrong cells are named, all of them, each with a way out; odd ones are read."""

from __future__ import annotations

from pathlib import Path

import pytest
from bad_workbooks import (
    CELL_CASES,
    FINE_CASES,
    SHEET,
    Case,
    Raw,
    export_rows,
    ga_book,
    shifted,
    tiny_export,
    write_book,
)

from grasp_xl.errors import MAX_PROBLEMS, InputError, Problem
from grasp_xl.workbook.book import read_book


def problems_of(path: Path) -> list[Problem]:
    """Read a workbook as the command line does, which must refuse it."""
    with pytest.raises(InputError) as refusal:
        read_book(path)
    return list(refusal.value.problems)


@pytest.mark.parametrize("case", CELL_CASES, ids=lambda case: case.name)
def test_wrong_cells_are_all_named(case: Case, tmp_path: Path) -> None:
    """Each wrong cell gives one problem: place, finding, expectation, hint. Nothing else does."""
    path = case.write(tmp_path)
    problems = problems_of(path)
    assert all(problem.hint for problem in problems)
    told = sorted((problem.where, problem.found, problem.expected) for problem in problems)
    expected = sorted((p.where or str(path), p.found, p.expected) for p in case.problems)
    assert told == expected


@pytest.mark.parametrize("case", FINE_CASES, ids=lambda case: case.name)
def test_odd_cells_are_read(case: Case, tmp_path: Path) -> None:
    """A workbook that only looks odd gives neither a problem nor a warning."""
    assert read_book(case.write(tmp_path)).warnings == ()


def test_at_most_fifty_problems_are_named(tmp_path: Path) -> None:
    """Of more than fifty problems the first fifty are named and the others counted."""
    path = tmp_path / "book.xlsx"
    texts = {f"{column}{row}": "?" for column in "DEFGHI" for row in range(5, 11)}
    tiny_export(path, texts | {f"{column}{row}": "?" for column in "LMN" for row in range(3, 9)})
    *named, last = problems_of(path)
    assert len(named) == MAX_PROBLEMS
    assert {problem.found for problem in named} == {"the text '?'"}
    assert (last.where, last.found) == (str(path), "problems beyond the first 50: 1")


def test_a_label_on_another_sheet_is_none(tmp_path: Path) -> None:
    """Labels of the option space that stand on other sheets do not replace missing ones."""
    path = tmp_path / "book.xlsx"
    write_book(path, {"Notes": {"A5": "Part mass (g)"}, SHEET: export_rows() | {"A5": None}})
    assert [problem.where for problem in problems_of(path)] == [f"{SHEET}!A5"]


def test_places_shift_with_the_title(tmp_path: Path) -> None:
    """A missing label is missed where it would stand on a sheet whose blocks were moved."""
    path = tmp_path / "book.xlsx"
    moved = shifted(export_rows(), rows=20, columns=3)
    write_book(path, {SHEET: {cell: v for cell, v in moved.items() if v != "Part mass (g)"}})
    assert [problem.where for problem in problems_of(path)] == [f"{SHEET}!D25"]


@pytest.mark.parametrize("formula", ["E12", "$E$12", "e12", "GA!E12", "'GA'!$E$12"])
def test_our_goal_formula_is_no_typed_goal(formula: str, tmp_path: Path) -> None:
    """A goal cell that shows the user-defined grasp's value says nothing, stored value or not."""
    for number, stored in enumerate(("", "<v>105</v>")):
        path = tmp_path / f"{number}.xlsx"
        ga_book(path, {"B12": Raw(f"><f>{formula}</f>{stored}")})
        assert read_book(path).parameters.goals == (None, 9000, 30, 700)


def test_a_number_almost_0_is_told_the_least_one(tmp_path: Path) -> None:
    """A mass above 0 that is too small is told how large it must be."""
    path = tmp_path / "book.xlsx"
    tiny_export(path, {"B5": 1e-300})
    (problem,) = problems_of(path)
    assert (problem.found, problem.hint) == ("1e-300", "type at least 1e-09")
