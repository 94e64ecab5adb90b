"""``--continue`` goes on as if the run had never stopped, and refuses when it could not."""

from __future__ import annotations

import os
import shutil
import subprocess
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import openpyxl
import pytest
from bad_workbooks import tiny_export
from contents import OF_THE_PLACE, TIMES, contents
from editing import cell_of, edit, files
from spaces import plate

from grasp_xl.cli.program import main
from grasp_xl.search import stop
from grasp_xl.space import Part, frozen
from grasp_xl.workbook import run_log
from grasp_xl.workbook.book import read_book
from grasp_xl.workbook.writing import export_workbook

SAMPLES = Path(__file__).parents[1] / "workbooks"


@pytest.fixture
def bracket(tmp_path: Path) -> Path:
    """Copy the bracket's full workbook to a folder of its own."""
    return Path(shutil.copy(SAMPLES / "bracket.xlsx", tmp_path))


@pytest.fixture
def export(tmp_path: Path) -> Path:
    """Write the tiny export."""
    path = tmp_path / "tiny.xlsx"
    tiny_export(path)
    return path


@pytest.fixture
def long_numbers(tmp_path: Path) -> Path:
    """Write an export whose numbers need all their 17 digits, as those of real parts do."""
    space = plate(seed=4)
    kinds = (replace(kind, force_n=kind.force_n + 1 / 7) for kind in space.kinds)
    part = Part(1720.115897202766, frozen(space.part.centroid_mm + 1 / 3))
    long = replace(space, part=part, kinds=tuple(kinds), scale_factor=2 / 3)
    path = tmp_path / "long.xlsx"
    path.write_bytes(export_workbook(long).content)
    return path


def run(file: Path, *words: object) -> int:
    """Run without a word."""
    return main(["run", str(file), "--quiet", *map(str, words)])


def in_parts(file: Path, limits: list[int], *options: str, in_place: bool = False) -> Path:
    """Run to each of the limits, each time going on from the last workbook."""
    before = file
    for number, limit in enumerate(limits):
        part = before if in_place and number else file.with_name(f"part{number}.xlsx")
        words = ("--in-place",) if in_place and number else ("-o", part)
        words += ("--continue",) if number else options
        assert run(before, *words, "--generations", limit) == 0
        before = part
    return before


def at_once(file: Path, limit: int, *options: str) -> Path:
    """Run without a stop."""
    whole = file.with_name("whole.xlsx")
    assert run(file, "-o", whole, "--generations", limit, *options) == 0
    return whole


def content(book: Path) -> dict[str, list[list[Any]]]:
    """Read all values of a workbook but those of one call alone."""
    return contents(book, (*OF_THE_PLACE, *TIMES))


def small_lists(monkeypatch: pytest.MonkeyPatch) -> None:
    """Give the sheets room for 40 changes and 3 designs only."""
    for module in ("history_sheet", "run_log", "reading_run"):
        monkeypatch.setattr(f"grasp_xl.workbook.{module}.MAX_HISTORY", 40)
    for module in ("designs_sheet", "run_log"):
        monkeypatch.setattr(f"grasp_xl.workbook.{module}.MAX_DESIGNS", 3)


# --- the same course ---


@pytest.mark.parametrize("start", ["user", "random"])
def test_splits_change_nothing(bracket: Path, start: str) -> None:
    """History, valid designs, last cards, matrix, random state, best: every cell is the same."""
    limits = {"user": [1, 7, 4096, 4097, 20_000, 30_000], "random": [7, 4096, 9000]}[start]
    parts = in_parts(bracket, limits, "--start", start)
    assert content(parts) == content(at_once(bracket, limits[-1], "--start", start))


@pytest.mark.parametrize("start", ["user", "random"])
def test_splits_change_nothing_without_elitism(
    export: Path, monkeypatch: pytest.MonkeyPatch, start: str
) -> None:
    """Also at the very end of a chunk, here of 64 generations."""
    options = ("--no-elitism", "--start", start, "--seed", "3")
    monkeypatch.setattr(stop, "CHUNK", 64)
    parts = in_parts(export, [1, 7, 64, 65, 300], *options)
    assert content(parts) == content(at_once(export, 300, *options))


@pytest.mark.parametrize("seed", ["3", "4", "5"])
def test_lists_too_long_for_their_sheets_go_on(
    export: Path, monkeypatch: pytest.MonkeyPatch, seed: str
) -> None:
    """The newest rows are listed, and what the fitness table needs."""
    small_lists(monkeypatch)
    options = ("--no-elitism", "--seed", seed, "--goals", "1000,90000,900,9000")
    parts, whole = (
        content(book)
        for book in (in_parts(export, [90, 150, 1200], *options), at_once(export, 1200, *options))
    )
    warned = [row for row in parts["Run Log"] if row[0] == "Warning"]
    parts["Run Log"] = [row for row in parts["Run Log"] if row not in warned]
    assert ["History: found the changes from generation" in row[1] for row in warned] == [True]
    assert parts == whole


def test_a_history_that_the_workbook_could_not_list_is_a_warning(
    export: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """It names the generation from which the CSV has every change."""
    small_lists(monkeypatch)
    options = ("--no-elitism", "--goals", "1000,90000,900,9000")
    first = export.with_name("first.xlsx")
    words = ("--generations", 300, "--history", export.with_name("first.csv"), *options)
    assert run(export, "-o", first, *words) == 0
    second = ("--continue", "--generations", "310", "--history", export.with_name("second.csv"))
    assert main(["run", str(first), *map(str, second)]) == 0
    told = capsys.readouterr().err
    begin = int(told.partition("from generation ")[2].split()[0])
    before, after = (
        {int(line.split(",")[0]) for line in file.read_text().splitlines()[1:]}
        for file in (export.with_name("first.csv"), export.with_name("second.csv"))
    )
    assert "a --history file begins there, too" in told
    assert {g for g in before if g >= begin} - {300} <= after
    assert max(g for g in before if g < begin) not in after


def test_a_run_with_options_goes_on_without_them(export: Path) -> None:
    """The workbook says them."""
    options = "--goals 60,9000,40,700 --fos 2 --clearance 47 --one-in 3 --density-ratio 2 --seed 4"
    options += " --criterion cost+moment --moment-arm plan --children 3 --cups 1,4 --magnets 3"
    parts = in_parts(export, [30, 90], *options.split())
    assert content(parts) == content(at_once(export, 90, *options.split()))


def test_in_place_splits_change_nothing(bracket: Path) -> None:
    parts = in_parts(bracket, [5, 900, 2500], in_place=True)
    assert content(parts) == content(at_once(bracket, 2500))
    assert files(bracket.parent) == ["bracket.xlsx", "part0.xlsx", "whole.xlsx"]


def test_a_start_without_a_feasible_parent_goes_on_in_the_same_way(bracket: Path) -> None:
    """As long as no child passes, each generation draws a new parent."""
    options = ("--cups", "1", "--magnets", "2", "--fos", "5.5", "--seed", "2")
    assert content(in_parts(bracket, [1, 2, 40, 600], *options)) == content(
        at_once(bracket, 600, *options)
    )


def test_a_workbook_without_a_run_yet_goes_on_from_generation_0(export: Path) -> None:
    ready = export.with_name("ready.xlsx")
    assert main(["new", str(export), "-o", str(ready), "--quiet"]) == 0
    assert run(ready, "--continue", "--generations", 50) == 0
    assert content(ready.with_name("ready-result.xlsx")) == content(at_once(export, 50))


def test_nothing_more_to_do_leaves_all_as_it_was(bracket: Path) -> None:
    """The last cards and the mutation matrix, too."""
    whole = at_once(bracket, 500)
    assert run(whole, "--continue", "--generations", 500) == 0
    assert content(whole.with_name("whole-result.xlsx")) == content(whole)


@pytest.mark.parametrize(
    ("words", "where", "asked"),
    [(("--generations", "40"), "--generations", 40), ((), "GA!B7", 50)],
)
def test_no_more_generations_than_done_is_a_warning(
    export: Path, capsys: pytest.CaptureFixture[str], words: tuple[str, ...], where: str, asked: int
) -> None:
    """One sentence says where the number stands, how many are done, and what to do."""
    whole = at_once(export, 50)
    assert main(["run", str(whole), "--continue", *words]) == 0
    told = " ".join(capsys.readouterr().err.split())
    assert f"{where}: found {asked} generations, expected more than the 50 done;" in told


def test_a_run_that_the_clock_stopped_goes_on_in_the_same_way(bracket: Path) -> None:
    part = bracket.with_name("part.xlsx")
    assert run(bracket, "-o", part, "--generations", 10**9, "--time-limit", 0.05) == 0
    limit = read_book(part).saved_run().state.generation + 500
    assert run(part, "--in-place", "--continue", "--generations", limit) == 0
    assert content(part) == content(at_once(bracket, limit))


def test_only_the_generations_asked_for_may_differ(bracket: Path) -> None:
    part = in_parts(bracket, [60])
    assert run(part, "--continue", "--generations", 70, "--stall", 10**6, "--target", -1) == 0


# --- saved again by other programs ---


def test_it_goes_on_after_openpyxl_saved_the_workbook(bracket: Path) -> None:
    """All cached values of formulas are lost then."""
    part = in_parts(bracket, [400])
    edit(part, lambda _: None)
    assert run(part, "--in-place", "--continue", "--generations", 900) == 0
    assert content(part) == content(at_once(bracket, 900))


def in_15_digits(book: Path) -> Path:
    """Save all numbers of a workbook as LibreOffice does, formulas with them."""
    saved = book.with_name("digits.xlsx")
    opened = openpyxl.load_workbook(book)
    for sheet in opened:
        for row in sheet.iter_rows():
            for cell in row:
                if isinstance(cell.value, float):
                    cell.value = float(f"{cell.value:.15g}")
    opened.save(saved)
    return saved


def values_only(book: Path) -> Path:
    """Save a workbook with values where its formulas were, as pandas and others do."""
    saved = book.with_name("values.xlsx")
    openpyxl.load_workbook(book, data_only=True).save(saved)
    return saved


def by_libreoffice(book: Path) -> Path:
    """Save a workbook by LibreOffice."""
    if shutil.which("soffice") is None and "GRASP_XL_REQUIRE_ALL" not in os.environ:
        pytest.skip("LibreOffice (soffice) is not installed")
    folder = book.with_name("saved")
    profile = (book.parent / "profile").as_uri()
    subprocess.run(  # noqa: S603
        [
            *("soffice", f"-env:UserInstallation={profile}", "--headless"),
            *("--convert-to", "xlsx", "--outdir", str(folder), str(book)),
        ],
        check=True,
        capture_output=True,
        timeout=120,
    )
    return folder / book.name


def same_course(one: Path, other: Path) -> bool:
    """Tell whether two runs changed and found the same grasps, and stand at the same place."""
    states = [read_book(book).saved_run().state for book in (one, other)]
    courses = [
        [
            *(trace.generation.tolist() for trace in (state.changes, state.designs)),
            *(trace.genes.tolist() for trace in (state.changes, state.designs)),
            (state.random_state, state.best, state.evaluations),
        ]
        for state in states
    ]
    return courses[0] == courses[1]


@pytest.mark.parametrize("saved_by", [in_15_digits, values_only, by_libreoffice])
@pytest.mark.parametrize("words", [(), ("--cups", "1,2", "--magnets", "3,4", "--seed", "2")])
def test_it_goes_on_after_other_programs_saved_the_workbook(
    long_numbers: Path, saved_by: Callable[[Path], Path], words: tuple[str, ...]
) -> None:
    """Numbers have 15 digits then, or formulas became values; the course is the same."""
    saved = saved_by(in_parts(long_numbers, [400], *words))
    on = long_numbers.with_name("on.xlsx")
    assert run(saved, "-o", on, "--continue", "--generations", 900) == 0
    assert same_course(on, at_once(long_numbers, 900, *words))


def test_nothing_is_foreign_in_what_libreoffice_saved(bracket: Path) -> None:
    saved = by_libreoffice(in_parts(bracket, [400]))
    assert run(saved, "--in-place", "--generations", 5) == 0


# --- refused ---

CHANGES: dict[str, tuple[str, object, str]] = {
    "a footprint": ("SuctionLocations", 99.5, "Suction cup locations"),
    "a magnet's place": ("MagnetLocations", 100.00001, "Magnet locations"),
    "a corner": ("ApproximationPolygon", 170, "Approximation polygon"),
    "the scale factor": ("ScaleFactor", 0.7, "Scale Factor 0.7, not 0.6"),
    "the mass": ("PartMass", 8000, "Part mass (g) 8000, not 8860"),
    "the centroid": ("CentroidX", 1, "Centroid X (mm) 1, not 1.5"),
    "a force": ("SuctionForce", 70, "Suction cup data: Normal force capacity (N) 70, not 69"),
    "a price": ("MagnetPrice", 31, "Magnet data: Unit price ($) 31, not 30"),
    "a minimum": ("SuctionMin", 0, "Suction cup data: # Suction Cups (Min.) 0, not 1"),
    "a maximum": ("MagnetMax", 4, "Magnet data: # Magnets (Max.) 4, not 5"),
    "the benchmark": (
        "UserChromosome",
        1,
        "Benchmark grasp (genes) [[1, 2, 6, 1, 1, 1], [2, 3, 4, 1, 1, 1]], not [[2, 2, 6, 1, 1, 1",
    ),
    "a goal": ("CostGoal", 99, "Goal: cost 99, not 80"),
}
OPTIONS = (
    *("--seed 2", "--one-in 5", "--children 4", "--no-elitism", "--start random"),
    *("--fos 2.9", "--clearance 47", "--density-ratio 2.4", "--moment-arm plan"),
    *("--criterion cost", "--goals 1,2,3,4", "--cups 1,2 --magnets 3"),
)


@pytest.fixture(scope="module")
def part_way(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Run the tiny export part of the way, from a grasp of the designer's."""
    file = tmp_path_factory.mktemp("part") / "tiny.xlsx"
    tiny_export(file)
    part = in_parts(file, [60], "--cups", "2,6", "--magnets", "3,4")
    edit(part, lambda opened: [opened.remove(opened[name]) for name in ("Calc", "Grasp")])
    return part  # without the sheets that nobody reads: it is edited faster


@pytest.mark.parametrize("what", CHANGES)
def test_it_is_refused_where_an_input_changed(
    part_way: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], what: str
) -> None:
    """The message names the input, and not what follows from it."""
    book = Path(shutil.copy(part_way, tmp_path))
    name, value, told = CHANGES[what]
    edit(book, lambda opened: setattr(cell_of(opened, name), "value", value))
    before = book.read_bytes()
    assert run(book, "--continue", "--in-place", "--generations", 90) == 3
    message = capsys.readouterr().err
    assert f"found inputs that changed since its run: {told}" in message
    assert ";" not in message.partition(", expected")[0]
    assert book.read_bytes() == before
    assert files(tmp_path) == [book.name]


@pytest.mark.parametrize("options", OPTIONS)
def test_it_is_refused_where_an_option_changes_an_input(
    part_way: Path, capsys: pytest.CaptureFixture[str], options: str
) -> None:
    before = files(part_way.parent)
    assert run(part_way, "--continue", *options.split()) == 3
    assert "inputs that changed since its run" in capsys.readouterr().err
    assert files(part_way.parent) == before


def test_the_refusal_names_the_parameters_that_changed(
    part_way: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    options = ("--seed", 2, "--one-in", 5, "--fos", 2.5, "--criterion", "cost")
    assert run(part_way, "--continue", *options) == 3
    told = capsys.readouterr().err
    for change in ("Seed 2, not 1", "1-in-n mutation 5, not 4", "FoS goal 2.5, not 3"):
        assert change in told
    assert "Generations" not in told


def test_a_workbook_without_a_run_cannot_go_on(
    export: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(export, "--continue") == 3
    assert "no run" in capsys.readouterr().err
    assert files(export.parent) == [export.name]


def sort_history(opened: openpyxl.Workbook) -> None:
    """Put the last change first."""
    for column in range(1, 20):
        first, second = (opened["History"].cell(row, column) for row in (4, 5))
        first.value, second.value = second.value, first.value


def write(name: str, value: object) -> Callable[[openpyxl.Workbook], None]:
    """Make an edit of a named cell."""
    return lambda opened: setattr(cell_of(opened, name), "value", value)


@pytest.mark.parametrize(
    "damage",
    [
        sort_history,
        lambda opened: opened["History"].delete_rows(4),
        lambda opened: opened["Valid Designs"].delete_rows(9, 50),
        lambda opened: opened["History"].delete_cols(8),
        write("ParentChromosome", 5),
        write("Child2", "two"),
        write("MutationMatrix", 0.5),
        write(run_log.GENERATIONS_DONE, "many"),
        write(run_log.GENERATIONS_DONE, 1.5),
        write(run_log.GENERATIONS_DONE, -5),
        write(run_log.GENERATIONS_DONE, 10**10),
        write(run_log.EVALUATIONS, 1e300),
        write(run_log.EVALUATIONS, -1),
        write(run_log.BEST_FOUND_AT, -3),
        write(run_log.BEST_FOUND_AT, 61),
        write(run_log.DESIGNS_FOUND, 0),
        lambda opened: setattr(opened["Valid Designs"]["B9"], "value", -3),
        lambda opened: setattr(opened["History"]["A4"], "value", 1e300),
        lambda opened: opened.remove(opened["History"]),
        write(run_log.EVALUATIONS, None),
        write(run_log.BEST_GRASP, "[[1, 2], [3]]"),
        write(run_log.BEST_GRASP, "[[9, 1, 2, 3, 4, 5], [1, 2, 3, 4, 5, 6]]"),
        write(run_log.BEST_GRASP, "genes"),
        write(run_log.RANDOM_STATE, "state"),
        write(run_log.RANDOM_STATE, "{}"),
        write(run_log.RANDOM_STATE, "[" * 5000),
        write(
            run_log.RANDOM_STATE,
            '{"bit_generator":"PCG64","state":{"state":-1,"inc":1e999},"has_uint32":0,"uinteger":0}',
        ),
        write(run_log.BENCHMARK_WRITTEN, None),
    ],
)
def test_a_run_that_was_tampered_with_is_refused(
    part_way: Path,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    damage: Callable[[openpyxl.Workbook], object],
) -> None:
    """Each in a plain sentence: a list that was sorted or cut, no random state, negative numbers."""
    book = Path(shutil.copy(part_way, tmp_path))
    edit(book, damage)
    assert run(book, "--continue", "-o", tmp_path / "out.xlsx") == 3
    assert files(tmp_path) == [book.name]
    told = capsys.readouterr().err
    assert not [raw for raw in ("Worksheet", "array", "Expecting", "None") if raw in told]
