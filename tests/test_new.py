"""``new`` makes a workbook for a designer, and a new export keeps what the designer typed."""

from __future__ import annotations

import json
import shutil
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import openpyxl
import pytest
from bad_workbooks import Value, tiny_export
from editing import cell_of, edit, typed

from grasp_xl.chromosome import Chromosome, is_usable
from grasp_xl.cli.program import main
from grasp_xl.task import Parameters
from grasp_xl.workbook import layout
from grasp_xl.workbook.book import Book, read_book
from grasp_xl.workbook.carrying import carried
from grasp_xl.workbook.writing import export_workbook

GENES = ((2, 3, 6, 1, 1, 1), (2, 1, 5, 1, 1, 1))
PARAMETERS = {
    "UserStart": 0,
    "Elitism": 0,
    "MutationOneIn": 3,
    "Generations": 99,
    "MinClearance": 47,
    "DensityRatio": 2,
    "FitnessCriterion": "cost+moment",
    "FoSGoal": 2.5,
    "CostGoal": 90,
    "StructureGoal": 444,
    "Children": 4,
    "Seed": 8,
    "MomentArm": "plan",
}
FOUR_CUPS: dict[str, Value] = {"B16": 4} | {f"{c}{r}": None for c in "DEF" for r in (9, 10)}
"""Change of the export: cups 5 and 6 are gone."""

MOVED: dict[str, Value] = {"D7": 1.0, "G9": -99.0}
"""Change of the export: cup 3 and magnet 5 moved; cup 4 and the others did not."""


def export(path: Path, change: Mapping[str, Value] | None = None) -> Path:
    """Write the tiny export to a file."""
    tiny_export(path, change)
    return path


def new(file: Path, book: Path, *words: str) -> int:
    """Make a workbook."""
    return main(["new", str(file), "-o", str(book), *words])


def type_into(book: Path, values: Mapping[str, object]) -> None:
    """Type values into named cells, and genes into blocks."""
    blocks = {
        name: value if isinstance(value, tuple) else ((value,),) for name, value in values.items()
    }
    edit(
        book,
        *(
            typed(name, cell, row, column)
            for name, rows in blocks.items()
            for row, cells in enumerate(rows)
            for column, cell in enumerate(cells)
        ),
    )


def shown(book: Path, name: str, row: int = 0, column: int = 0) -> Any:
    """Read a named cell, a formula as it is."""
    return cell_of(openpyxl.load_workbook(book), name, row, column).value


def all_shown(book: Path, names: Iterable[str]) -> dict[str, Any]:
    """Read many named cells."""
    opened = openpyxl.load_workbook(book)
    return {name: cell_of(opened, name).value for name in names}


@pytest.fixture(scope="module")
def filled_in(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Make a workbook from the tiny export, with a designer's parameters and grasps."""
    folder = tmp_path_factory.mktemp("filled")
    path = folder / "book.xlsx"
    assert new(export(folder / "first.xlsx"), path, "--quiet") == 0
    type_into(path, {**PARAMETERS, "UserChromosome": GENES, "WhatIf": GENES})
    return path


@pytest.fixture
def book(filled_in: Path, tmp_path: Path) -> Path:
    """Copy the designer's workbook."""
    return Path(shutil.copy(filled_in, tmp_path))


def genes(chromosome: Chromosome | None) -> tuple[tuple[int, ...], ...] | None:
    """Return genes as GENES has them."""
    return tuple(map(tuple, chromosome.genes.tolist())) if chromosome else None


def said(book: Book) -> Parameters:
    """Return the parameters of a workbook, sure that it has none of the defaults."""
    parameters = book.parameters
    assert (parameters.fos, parameters.seed, parameters.children) == (2.5, 8, 4)
    return parameters


# --- a workbook from an export ---


def test_a_new_workbook_is_ready_for_a_designer_without_a_run(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """It has every sheet and no generation, and the program's benchmark says whose it is."""
    path = tmp_path / "book.xlsx"
    assert new(export(tmp_path / "tiny.xlsx"), path, "--json") == 0
    told = json.loads(capsys.readouterr().out)
    assert set(told) == {"benchmark", "goals", "warnings", "output"}
    assert told["output"] == str(path)
    opened = openpyxl.load_workbook(path)
    assert tuple(opened.sheetnames) == layout.SHEETS
    assert cell_of(opened, "UserChromosome", -2, -1).value.endswith("(program-assigned)")
    assert read_book(path).saved_run().state.generation == 0
    assert main(["check", str(path), "--quiet"]) == 0


def test_a_program_assigned_grasp_is_nobodys(tmp_path: Path) -> None:
    """It is assigned anew for another FoS, and is the designer's once another is typed."""
    path = tmp_path / "book.xlsx"
    assert new(export(tmp_path / "tiny.xlsx"), path, "--quiet") == 0
    assert read_book(path).user_chromosome is None
    type_into(path, {"FoSGoal": 5})
    assert read_book(path).user_chromosome is None
    assert main(["run", str(path), "--in-place", "--generations", "3", "--quiet"]) == 0
    assert shown(path, "UserChromosome", -2, -1).endswith("(program-assigned)")
    assert genes(read_book(path).user_chromosome) is None
    type_into(path, {"UserChromosome": GENES})
    assert genes(read_book(path).user_chromosome) == GENES


@pytest.mark.parametrize("edit", [{"SuctionPrice": 450}, {"MomentArm": "plan"}, {"FoSGoal": 2}])
def test_a_program_assigned_grasp_stays_while_it_is_feasible(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], edit: dict[str, object]
) -> None:
    """So that goals which nobody typed are those that the workbook shows after the edit."""
    path = tmp_path / "book.xlsx"
    assert new(export(tmp_path / "tiny.xlsx"), path, "--quiet") == 0
    before = read_book(path).assigned
    type_into(path, edit)
    assert main(["evaluate", str(path), "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert Chromosome([[gene or 0 for gene in row] for row in told["genes"]]) == before
    assert main(["run", str(path), "--in-place", "--generations", "3", "--quiet"]) == 0
    assert read_book(path).assigned == before


@pytest.mark.parametrize("edit", [{"SuctionMin": 1, "SuctionMax": 1}, {"MinClearance": 130}])
def test_a_program_assigned_grasp_that_is_infeasible_now_is_assigned_anew(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], edit: dict[str, object]
) -> None:
    """A warning says so, and the benchmark is what an export of the same inputs gets."""
    path, fresh = tmp_path / "book.xlsx", tmp_path / "fresh.xlsx"
    assert new(export(tmp_path / "tiny.xlsx"), path, "--quiet") == 0
    type_into(path, edit)
    book = read_book(path)
    fresh.write_bytes(export_workbook(book.space).content)
    benchmarks = []
    for file in (path, fresh):
        clearance = str(book.parameters.clearance_mm)
        assert main(["evaluate", str(file), "--json", "--clearance", clearance]) == 0
        told = capsys.readouterr()
        benchmarks.append(json.loads(told.out)["genes"])
        assert ("no longer feasible" in told.err) == (file == path)
    assert benchmarks[0] == benchmarks[1]
    assert main(["run", str(path), "--in-place", "--generations", "3", "--quiet"]) == 0
    assert shown(path, "UserChromosome", -2, -1).endswith("(program-assigned)")


def test_a_program_assigned_grasp_that_is_typed_over_stays_after_edits(tmp_path: Path) -> None:
    path = tmp_path / "book.xlsx"
    assert new(export(tmp_path / "tiny.xlsx"), path, "--quiet") == 0
    type_into(path, {"PartMass": 6000, "UserChromosome": GENES})
    assert genes(read_book(path).user_chromosome) == GENES


def test_an_infeasible_export_makes_no_workbook(tmp_path: Path) -> None:
    heavy = export(tmp_path / "heavy.xlsx", {"B5": 200_000})
    assert new(heavy, tmp_path / "book.xlsx") == 4
    assert not (tmp_path / "book.xlsx").exists()


# --- a new export into a workbook ---


def test_parameters_typed_goals_and_genes_stay(tmp_path: Path, book: Path) -> None:
    """Goals that nobody typed go on showing the user-defined grasp; the option space is new."""
    before = said(read_book(book))
    assert new(export(tmp_path / "second.xlsx", {"B5": 9000}), book, "--quiet") == 0
    after = read_book(book)
    assert said(after) == before
    assert before.goals == (90, None, None, 444)
    assert genes(after.user_chromosome) == genes(after.what_if) == GENES
    assert after.space.part.mass_g == 9000
    assert all_shown(book, PARAMETERS) == PARAMETERS
    assert str(shown(book, "MomentGoal")).startswith("=")


def test_options_beat_what_stays(tmp_path: Path, book: Path) -> None:
    words = ("--seed", "9", "--cups", "1", "--magnets", "2,3", "--quiet")
    assert new(export(tmp_path / "second.xlsx"), book, *words) == 0
    assert all_shown(book, ("Seed", "FoSGoal")) == {"Seed": 9, "FoSGoal": 2.5}
    assert genes(read_book(book).user_chromosome) == ((1, *[1] * 5), (2, 2, 3, *[1] * 3))


def test_nothing_is_stale_where_no_place_changed(
    tmp_path: Path, book: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert new(export(tmp_path / "second.xlsx", {"B14": 11}), book, "--json") == 0
    warnings = json.loads(capsys.readouterr().out)["warnings"]
    assert not [w for w in warnings if "Index" in w["where"]]


def test_every_stale_index_is_named(
    tmp_path: Path, book: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Gone and moved ones, of the user-defined grasp and of the What-if card."""
    second = export(tmp_path / "second.xlsx", FOUR_CUPS | MOVED)
    assert new(second, book, "--json") == 0
    told = capsys.readouterr()
    warnings = json.loads(told.out)["warnings"]
    named = {warning["where"]: warning["found"] for warning in warnings}
    for block in ("User-Defined Chromosome", "What-if"):
        assert named[f"{block}, suction Index 1"] == "index 3, which is at (1, 60, 10) now"
        assert named[f"{block}, suction Index 2"] == "index 6, which is gone"
        assert "is at (-99, 60, 10)" in named[f"{block}, magnets Index 2"]
        assert f"{block}, magnets Index 1" not in named
    assert "index 6, which is gone" in told.err


def test_genes_that_an_export_does_not_have_are_set_aside(tmp_path: Path, book: Path) -> None:
    """The workbook shows a grasp that it has, says where the designer's genes are, and keeps them."""
    assert new(export(tmp_path / "second.xlsx", FOUR_CUPS), book, "--quiet") == 0
    for block in ("UserChromosome", "WhatIf"):
        assert "see Run Log" in shown(book, block, -2, -1)
    assert main(["run", str(book), "--in-place", "--generations", "3", "--quiet"]) == 0
    again = read_book(book)
    assert again.user_chromosome is None
    assert again.what_if is None
    for kept in (again.set_aside.user, again.set_aside.what_if):
        assert genes(kept) == GENES
    assert [str(warning) for warning in again.warnings if "did not have" in str(warning)]


@pytest.mark.parametrize("block", ["UserChromosome", "WhatIf"])
def test_typed_genes_take_the_place_of_those_set_aside(
    tmp_path: Path, book: Path, block: str
) -> None:
    assert new(export(tmp_path / "second.xlsx", FOUR_CUPS), book, "--quiet") == 0
    type_into(book, {block: ((1, 1, 1, 1, 1, 1), (2, 1, 2, 1, 1, 1))})
    aside = read_book(book).set_aside
    assert (aside.user is None, aside.what_if is None) == (
        block == "UserChromosome",
        block == "WhatIf",
    )


def test_a_stale_workbook_takes_the_next_export(
    tmp_path: Path, book: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """No parameter is lost on the way, and genes that fit again are the designer's again."""
    assert new(export(tmp_path / "second.xlsx", FOUR_CUPS), book, "--quiet") == 0
    assert new(export(tmp_path / "third.xlsx", FOUR_CUPS | {"B5": 9001}), book) == 0
    assert "index 6, which is gone" in capsys.readouterr().err
    assert new(export(tmp_path / "fourth.xlsx"), book) == 0
    assert "index 6, which the option space before this one" in capsys.readouterr().err
    again = read_book(book)
    assert said(again).goals == (90, None, None, 444)
    assert genes(again.user_chromosome) == GENES


def test_stale_genes_on_a_card_that_was_edited_are_no_traceback(tmp_path: Path, book: Path) -> None:
    type_into(book, {"WhatIf": ((5, 99, 99, 0, -1, 7), (2, 1, 1, 1, 1, 1))})
    assert new(export(tmp_path / "second.xlsx"), book, "--quiet") == 0
    assert said(read_book(book)).seed == 8


def test_a_program_assigned_grasp_is_never_stale(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "book.xlsx"
    assert new(export(tmp_path / "first.xlsx"), path) == 0
    type_into(path, {"Seed": 5})
    assert new(export(tmp_path / "second.xlsx", FOUR_CUPS | MOVED), path) == 0
    assert "Index" not in capsys.readouterr().err
    assert shown(path, "Seed") == 5
    assert shown(path, "UserChromosome", -2, -1).endswith("(program-assigned)")


def test_a_count_that_is_out_of_range_is_named(
    tmp_path: Path, book: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    second = export(tmp_path / "second.xlsx", {"B12": 1})  # at most one cup
    assert new(second, book) == 0
    told = capsys.readouterr().err
    assert "suction Total #: found 2, expected a whole number from 1 to 1" in told


def test_what_a_designer_added_is_named_and_needs_force(
    tmp_path: Path, book: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    opened = openpyxl.load_workbook(book)
    opened.create_sheet("Notes").append(["Call Eva."])
    opened["GA"]["A90"] = "Note"
    opened.save(book)
    before, second = book.read_bytes(), export(tmp_path / "second.xlsx", FOUR_CUPS)
    assert new(second, book) == 3
    told = capsys.readouterr().err
    assert "the sheet 'Notes'" in told
    assert "GA!A90" in told
    assert book.read_bytes() == before
    assert new(second, book, "--force", "--quiet") == 0
    assert all_shown(book, ("Seed", "FoSGoal")) == {"Seed": 8, "FoSGoal": 2.5}


def test_a_workbook_that_cannot_be_read_is_not_replaced(
    tmp_path: Path, book: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The message names its cell and the file; --force gives it up."""
    type_into(book, {"Children": "many"})
    before, second = book.read_bytes(), export(tmp_path / "second.xlsx")
    assert new(second, book) == 3
    told = capsys.readouterr().err
    assert told.startswith("book.xlsx, GA!B")
    assert "'many'" in told
    assert book.read_bytes() == before
    assert new(second, book, "--force", "--quiet") == 0
    assert shown(book, "Children") == 5


def test_another_export_is_not_replaced(tmp_path: Path) -> None:
    """It holds no parameters, and it was never ours."""
    first, second = export(tmp_path / "first.xlsx"), export(tmp_path / "second.xlsx")
    before = second.read_bytes()
    assert new(first, second) == 3
    assert second.read_bytes() == before
    assert new(first, second, "--force", "--quiet") == 0


# --- genes, carried ---


def test_genes_find_their_room_where_the_slots_change(tmp_path: Path) -> None:
    """A larger Max. widens the rows; a smaller one cuts them, and says so."""
    narrow, wide = (
        read_book(export(tmp_path / f"{most}.xlsx", {"B12": most, "B20": most})).space
        for most in (5, 6)
    )
    small = Chromosome([[2, 3, 6, 1, 1, 1], [5, 1, 2, 3, 4, 5]])
    widened, stale = carried(small, narrow, wide, "Block")
    assert (genes(widened), stale) == (((2, 3, 6, 1, 1, 1, 1), (5, 1, 2, 3, 4, 5, 1)), [])
    full = Chromosome([[6, 1, 2, 3, 4, 5, 6], [1, *[1] * 6]])
    assert is_usable(full, wide)
    cut, stale = carried(full, wide, narrow, "Block")
    assert cut.genes.shape == (2, 6)
    assert [problem.where for problem in stale] == ["Block, suction Total #"]
    assert not is_usable(cut, narrow)


def test_unusable_genes_are_told_from_usable_ones(tmp_path: Path) -> None:
    space = read_book(export(tmp_path / "tiny.xlsx")).space
    assert is_usable(Chromosome(GENES), space)
    for row in ((0, 1, 1, 1, 1, 1), (6, 1, 2, 3, 4, 5), (2, 3, 3, 1, 1, 1), (1, 7, 1, 1, 1, 1)):
        assert not is_usable(Chromosome((row, GENES[1])), space)
