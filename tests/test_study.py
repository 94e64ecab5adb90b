"""Studies: their runs, what they say together, and the workbook that holds it."""

from __future__ import annotations

import dataclasses
import itertools
import json
import math
import re
import signal
import sqlite3
import subprocess
import sys
import time
import zipfile
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from openpyxl import load_workbook
from python_calamine import CalamineWorkbook

from grasp_xl.chromosome import from_active
from grasp_xl.cli.program import main
from grasp_xl.commands.preparing import prepare
from grasp_xl.commands.study import StudyOutput, study_files
from grasp_xl.errors import InputError, UsageError
from grasp_xl.grasp import evaluate
from grasp_xl.search.genetic import search
from grasp_xl.search.stop import Generations, Interrupt
from grasp_xl.search.symmetry import symmetries
from grasp_xl.study.description import Description, read_description
from grasp_xl.study.execution import run_here
from grasp_xl.study.outcome import Measuring
from grasp_xl.study.plan import SCENARIOS, Case, Plan, spawned_seed
from grasp_xl.study.records import Records, records_path
from grasp_xl.study.statistics import holm, mann_whitney
from grasp_xl.study.trial import Record, Work, run_trial
from grasp_xl.task import Parameters, Task
from grasp_xl.workbook.book import read_book

WORKBOOKS = Path(__file__).parent.parent / "workbooks"
BRACKET, DOOR_FRAME = WORKBOOKS / "bracket.xlsx", WORKBOOKS / "door_frame.xlsx"


def task_of(book: Path, generations: int = 500) -> Task:
    return prepare(read_book(book), Parameters(generations=generations))


def plan_of(*books: Path, runs: int = 2, generations: int = 500, seed: int = 1) -> Plan:
    cases = tuple(
        Case(number, 0, book.stem, (), task_of(book, generations))
        for number, book in enumerate(books, 1)
    )
    return Plan(cases, SCENARIOS, runs, seed)


def all_runs(plan: Plan, workers: int = 2) -> dict[str, Record]:
    records: dict[str, Record] = {}
    works = [Work.of(case.task) for case in plan.cases]
    run_here(
        works,
        plan.trials(),
        lambda trial, record: records.__setitem__(trial.label, record),
        Interrupt(),
        workers=workers,
    )
    return records


def same(first: Record, second: Record) -> bool:
    """Whether two records are equal but for their seconds."""
    return all(
        np.array_equal(getattr(first, item.name), getattr(second, item.name))
        for item in dataclasses.fields(Record)
        if item.name != "seconds"
    )


# --- plan ---


def test_labels_are_those_of_the_thesis_and_every_run_has_its_own_seed():
    """Runs are called P1S1R1 and so on; a larger study has the runs of a smaller one."""
    plan = plan_of(BRACKET, DOOR_FRAME, runs=2)
    trials = list(plan.trials())
    parts = itertools.product("12", "12", "12")
    assert [trial.label for trial in trials] == [f"P{p}S{s}R{r}" for p, s, r in parts]
    assert len({trial.seed for trial in trials}) == len(trials) == len(plan)
    more = {t.label: t.seed for t in dataclasses.replace(plan, runs=5).trials()}
    assert all(more[trial.label] == trial.seed for trial in trials)
    other = {t.seed for t in dataclasses.replace(plan, seed=2).trials()}
    assert not other & {trial.seed for trial in trials}


@given(st.integers(0, 2**53), st.lists(st.integers(0, 1000), min_size=4, max_size=4))
def test_seeds_are_whole_numbers_that_a_cell_holds(root, key):
    """A spawned seed is from 0 to below 2^53, so that --seed takes it."""
    seed = spawned_seed(root, key)
    assert 0 <= seed < 2**53
    assert float(seed) == seed


# --- runs ---


def test_a_trial_is_the_run_of_the_same_seed():
    """What a study keeps of a run is what the genetic search finds with that seed and start."""
    task = task_of(BRACKET)
    record = run_trial(Work.of(task), 77, user_start=True)
    settings_ = dataclasses.replace(task.settings, seed=77, user_start=True)
    stop = [Generations(task.generations)]
    state = search(task.space, task.rules, settings_, task.benchmark.chromosome, stop).state
    assert np.array_equal(record.generation, state.changes.generation)
    assert np.array_equal(record.genes, state.changes.genes)
    assert state.best is not None
    assert np.array_equal(record.best, state.best.genes)
    assert (record.done, record.evaluations) == (500, state.evaluations)


def test_runs_do_not_depend_on_the_number_of_workers():
    """One thread and three give the same records."""
    plan = plan_of(BRACKET, DOOR_FRAME)
    one, three = all_runs(plan, 1), all_runs(plan, 3)
    assert one.keys() == three.keys() == {trial.label for trial in plan.trials()}
    assert all(same(one[label], three[label]) for label in one)


def test_an_interrupt_keeps_what_is_done_and_nothing_else():
    """After the wish to stop only whole runs are told."""
    plan = plan_of(BRACKET, runs=50, generations=20_000)
    interrupt, told = Interrupt(), []

    def take(trial, record):
        told.append((trial.label, record.done))
        interrupt.asked = len(told) >= 3

    run_here([Work.of(plan.cases[0].task)], plan.trials(), take, interrupt, workers=2)
    assert 3 <= len(told) < len(plan)
    assert {done for _, done in told} == {20_000}


# --- the file with the runs ---


def test_records_come_back_as_they_were(tmp_path):
    """A record that is read again is the one that was put, to the last bit."""
    record = run_trial(Work.of(task_of(BRACKET)), 5, user_start=False)
    with Records(tmp_path / "a.runs") as records:
        records.put("key", record)
    with Records(tmp_path / "a.runs") as records:
        back = records.get("key")
        assert records.has("key")
        assert records.get("other") is None
    assert back is not None
    assert same(back, record)
    assert back.seconds == record.seconds


@pytest.mark.parametrize("content", [b"no database at all, but long enough to be one" * 40, b"\0"])
def test_another_file_is_refused_and_left_alone(tmp_path, content):
    """A file of that name that is not ours is neither read nor changed."""
    path = tmp_path / "a.runs"
    path.write_bytes(content)
    with pytest.raises(InputError, match="holds no runs"):
        Records(path)
    assert path.read_bytes() == content


def test_the_database_of_another_program_is_refused(tmp_path):
    """An SQLite file with tables of others is left alone."""
    path = tmp_path / "a.runs"
    with sqlite3.connect(path) as base:
        base.execute("CREATE TABLE theirs (x)")
    before = path.read_bytes()
    with pytest.raises(InputError, match="holds no runs"):
        Records(path)
    assert path.read_bytes() == before


def test_other_inputs_make_other_runs():
    """The key of a run changes with every input that its outcome depends on."""
    work = Work.of(task_of(BRACKET))
    space, rules = work.space, work.rules
    others = [
        dataclasses.replace(work, generations=501),
        dataclasses.replace(work, settings=dataclasses.replace(work.settings, one_in=5.0)),
        dataclasses.replace(work, settings=dataclasses.replace(work.settings, children=6)),
        dataclasses.replace(
            work,
            rules=dataclasses.replace(
                rules, requirements=dataclasses.replace(rules.requirements, fos=3.1)
            ),
        ),
        dataclasses.replace(
            work,
            space=dataclasses.replace(
                space, part=dataclasses.replace(space.part, mass_g=space.part.mass_g + 1)
            ),
        ),
        dataclasses.replace(work, benchmark=from_active(space, [(1,), (2, 3)])),
    ]
    prints = {each.fingerprint() for each in [work, *others]}
    assert len(prints) == 1 + len(others)
    assert work.fingerprint() == Work.of(task_of(BRACKET)).fingerprint()


# --- statistics ---

SAMPLES = st.lists(st.integers(0, 6).map(float), min_size=1, max_size=5)


def reference_p(first: list[float], second: list[float]) -> float:
    """Go through every way to deal the values out, and count U as far from the middle."""
    values = [*first, *second]
    middle = len(first) * len(second) / 2

    def u(chosen: tuple[int, ...]) -> float:
        rest = [values[i] for i in range(len(values)) if i not in chosen]
        pairs = itertools.product([values[i] for i in chosen], rest)
        return sum((a > b) + (a == b) / 2 for a, b in pairs)

    own = abs(u(tuple(range(len(first)))) - middle)
    ways = list(itertools.combinations(range(len(values)), len(first)))
    return sum(abs(u(way) - middle) >= own - 1e-9 for way in ways) / len(ways)


@settings(max_examples=60, deadline=None)
@given(SAMPLES, SAMPLES)
def test_mann_whitney_equals_every_way_to_deal_the_values_out(first, second):
    """The exact p-value, with ties, is the share of ways with a U as far from the middle."""
    test = mann_whitney(first, second)
    assert test is not None
    assert test.exact
    assert test.p == pytest.approx(reference_p(first, second))
    pairs = list(itertools.product(first, second))
    higher = sum((a > b) - (a < b) for a, b in pairs) / len(pairs)
    assert test.effect == pytest.approx(higher)


def test_mann_whitney_of_many_values_is_close_to_chance():
    """The approximated p-value of two samples of one distribution is even from 0 to 1."""
    rng = np.random.default_rng(1)
    tests = [mann_whitney(rng.normal(size=40), rng.normal(size=50)) for _ in range(400)]
    assert not any(test.exact for test in tests if test)
    p = np.sort([test.p for test in tests if test])
    even = (np.arange(400) + 0.5) / 400
    assert np.abs(p - even).max() < 1.63 / math.sqrt(400)  # Kolmogorov-Smirnov at 1 %


def test_mann_whitney_of_the_same_values_shows_nothing():
    """All values equal: no effect, p = 1, however many there are."""
    for count in (2, 200):
        test = mann_whitney([1.0] * count, [1.0] * count)
        assert test is not None
        assert (test.p, test.effect) == (1.0, 0.0)
    assert mann_whitney([], [1.0]) is None


@given(st.lists(st.floats(0, 1), min_size=1, max_size=8))
def test_holm_is_between_the_p_values_and_bonferroni(p_values):
    """A corrected p-value is no less than its own, no more than Bonferroni's, in the same order."""
    corrected = holm(p_values)
    for p, held in zip(p_values, corrected, strict=True):
        assert p <= held <= min(1.0, p * len(p_values)) + 1e-12
    order = sorted(range(len(p_values)), key=p_values.__getitem__)
    assert sorted(corrected) == [corrected[row] for row in order]


# --- outcomes ---


def test_courses_are_what_evaluate_says_of_the_fittest():
    """Each number of a course is that of the grasp which was the fittest at that generation."""
    plan = plan_of(DOOR_FRAME, runs=1)
    runs = all_runs(plan)
    trials = [(trial, runs[trial.label]) for trial in plan.trials()]
    case = Measuring(plan, plan.cases[0]).case_outcome(trials, None)
    task = plan.cases[0].task
    for outcome, (_, record) in zip(case.outcomes, trials, strict=True):
        for generation, row in zip(case.generations.tolist(), outcome.course, strict=True):
            held = record.changes.genes[record.generation <= generation][-1]
            grasp = evaluate(task.space, task.rules, type(task.benchmark.chromosome)(held))
            assert row[0] == pytest.approx(grasp.fos)
            if grasp.feasible:
                assert row[1:] == pytest.approx([*grasp.terms, grasp.divergence])
            else:
                assert np.isnan(row[1:]).all()


def test_images_are_one_ending():
    """Runs that ended in a grasp and in its mirror image stand together."""
    plan = plan_of(BRACKET, runs=2, generations=50)
    task = plan.cases[0].task
    record = next(iter(all_runs(plan).values()))
    maps = symmetries(task.space)
    assert maps
    active = task.benchmark.chromosome.active
    grasps = [active, *(each.of(active) for each in maps)]
    trials = list(plan.trials())
    runs = [
        (
            trial,
            dataclasses.replace(
                record, best=from_active(task.space, chosen).genes.astype(np.int32)
            ),
        )
        for trial, chosen in zip(trials, grasps, strict=False)
    ]
    case = Measuring(plan, plan.cases[0]).case_outcome(runs, None)
    assert {ending.number for ending in case.endings} == {1}
    assert case.alike == len(runs)
    for ending in case.endings[1:]:
        assert ending.relation in {each.name for each in maps}


# --- the command ---


def cells(path: Path) -> dict[str, list[list[object]]]:
    """Return all cells of a study's workbook but the seconds of its runs."""
    book = CalamineWorkbook.from_path(path)
    held = {name: book.get_sheet_by_name(name).to_python() for name in book.sheet_names}
    header = next(row for row in held["Runs"] if "Seconds" in row)
    column = header.index("Seconds")
    held["Runs"] = [[*row[:column], *row[column + 1 :]] for row in held["Runs"]]
    return held


def run_study(output: Path, *more: str, books: tuple[Path, ...] = (BRACKET, DOOR_FRAME)) -> int:
    words = ["study", *map(str, books), "-o", str(output), "--generations", "300", "--quiet"]
    return main([*words, *more])


def test_the_same_study_gives_the_same_file(tmp_path):
    """One worker or many, at once or resumed: every cell but the seconds is the same."""
    assert run_study(tmp_path / "a.xlsx", "--workers", "1") == 0
    assert run_study(tmp_path / "b.xlsx", "--workers", "4") == 0
    assert run_study(tmp_path / "c.xlsx", "--runs", "1") == 0
    assert run_study(tmp_path / "c.xlsx", "--resume") == 0
    first = cells(tmp_path / "a.xlsx")
    assert first == cells(tmp_path / "b.xlsx")
    assert first == cells(tmp_path / "c.xlsx")


@pytest.mark.parametrize("runs", [2, 5])
def test_charts_show_all_runs_and_the_benchmark(tmp_path, runs):
    """A case has six charts with a logarithmic axis: a line a run, of more than eight one a start."""
    run_study(tmp_path / "a.xlsx", "--runs", str(runs))
    if runs == 2:
        own = [[f"P{p}S{s}R{r}" for s in (1, 2) for r in (1, 2)] for p in (1, 2)]
    else:
        own = [["Random start", "User-defined start"]] * 2
    expected = [sorted([*names, "Benchmark", "Proved optimum"]) for names in own for _ in range(6)]
    found = []
    with zipfile.ZipFile(tmp_path / "a.xlsx") as book:
        charts = [name for name in book.namelist() if name.startswith("xl/charts/chart")]
        for name in charts:
            text = book.read(name).decode()
            assert '<c:logBase val="10"/>' in text
            found.append(sorted(re.findall(r"<c:ser>.*?<c:tx><c:v>(.*?)</c:v>", text)))
    assert sorted(found) == sorted(expected)


def test_finished_runs_are_not_repeated(tmp_path, capsys):
    """--resume takes the runs that are kept, and only the missing ones are run."""
    run_study(tmp_path / "a.xlsx", "--runs", "1")
    capsys.readouterr()
    words = ["study", str(BRACKET), str(DOOR_FRAME), "-o", str(tmp_path / "a.xlsx")]
    assert main([*words, "--generations", "300", "--resume", "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert (told["known"], told["runs"], told["planned"]) == (4, 8, 8)


def test_kept_runs_are_not_lost_unasked(tmp_path):
    """A second study of that name is refused unless it is to go on or to begin anew."""
    assert run_study(tmp_path / "a.xlsx") == 0
    before = (tmp_path / "a.xlsx").read_bytes()
    assert run_study(tmp_path / "a.xlsx") == 2
    assert (tmp_path / "a.xlsx").read_bytes() == before
    assert run_study(tmp_path / "a.xlsx", "--force", "--seed", "2") == 0
    with Records(records_path(tmp_path / "a.xlsx")) as records:
        assert len(records) == 8


def test_a_seed_of_the_study_repeats_its_run(tmp_path, capsys):
    """Run with the seed and start that the sheet Runs names ends in the same grasp."""
    run_study(tmp_path / "a.xlsx", "--no-prove", books=(BRACKET,))
    sheet = load_workbook(tmp_path / "a.xlsx")["Runs"]
    header = {cell.value: number for number, cell in enumerate(sheet[3])}
    for row in sheet.iter_rows(min_row=4, values_only=True):
        capsys.readouterr()
        words = ["run", str(BRACKET), "-o", str(tmp_path / "r.xlsx"), "--generations", "300"]
        words += ["--seed", str(row[header["Seed"]]), "--start", row[header["Start"]], "--json"]
        assert main([*words, "--no-prove"]) == 0
        best = json.loads(capsys.readouterr().out)["best"]
        assert best["divergence"] == pytest.approx(row[header["Divergence"]], abs=0)


def test_own_workbooks_are_written_and_linked(tmp_path):
    """Each run's workbook holds that run; the sheet Runs links to it."""
    run_study(
        *(tmp_path / "a.xlsx", "--workbooks", str(tmp_path / "own"), "--no-prove"),
        books=(BRACKET,),
    )
    sheet = load_workbook(tmp_path / "a.xlsx")["Runs"]
    formulas = [cell.value for (cell,) in sheet.iter_rows(min_row=4, min_col=19, max_col=19)]
    links = [f"own/P1S{s}R{r}.xlsx" for s in (1, 2) for r in (1, 2)]
    assert formulas == [f'=HYPERLINK("{link}","{link}")' for link in links]
    for row, link in zip(sheet.iter_rows(min_row=4, values_only=True), links, strict=True):
        book = read_book(tmp_path / link)
        assert book.parameters.seed == row[3]
        saved = book.shown_run()
        assert saved is not None
        assert saved.state.generation == 300


def test_a_study_with_sweeps_has_a_case_for_each_combination(tmp_path):
    """Lists in a description make cases P1V1.., each with its own parameters."""
    described = tmp_path / "study.toml"
    described.write_text(
        f"workbooks = [{str(BRACKET)!r}]\nruns = 1\nscenarios = ['random']\nprove = false\n"
        "generations = 200\none_in = [2, 4]\nchildren = [3, 5]\n"
    )
    studied = study_files(
        *(read_description(described), Parameters(), StudyOutput(tmp_path / "s.xlsx")),
        *(run_here, Interrupt()),
    )
    found = [
        (case.case.label, case.case.task.settings.one_in, case.case.task.settings.children)
        for case in studied.study.cases
    ]
    ways = itertools.product((2.0, 4.0), (3, 5))
    assert found == [(f"P1V{number}", *way) for number, way in enumerate(ways, 1)]
    assert {len(case.outcomes) for case in studied.study.cases} == {1}


def test_a_sweep_of_the_pitch_fits_the_part_anew(tmp_path):
    """A finer pitch of a fitted part gives more places; its runs have workbooks of their own, too."""
    described = tmp_path / "study.toml"
    described.write_text(
        "runs = 1\nprove = false\ngenerations = 50\npitch = [20, 40]\n[[fit]]\n"
        f"file = {str(WORKBOOKS / 'bracket.step')!r}\ncup = 'SAF 40 NBR-60 M10-AG'\ncup_price = 10\n"
        "magnet = 'SGM-HP 30 G1/8-IG'\nmagnet_price = 30\n"
    )
    output = StudyOutput(tmp_path / "s.xlsx", workbooks=tmp_path / "own")
    studied = study_files(
        *(read_description(described), Parameters(fos=1.0), output),
        *(run_here, Interrupt()),
    )
    own = sorted(path.name for path in (tmp_path / "own").iterdir())
    assert own == [f"P1V{v}S{s}R1.xlsx" for v in (1, 2) for s in (1, 2)]
    assert read_book(tmp_path / "own" / own[0]).space.kinds[0].total > 0
    fine, coarse = (
        [kind.total for kind in case.case.task.space.kinds] for case in studied.study.cases
    )
    assert all(more > fewer for more, fewer in zip(fine, coarse, strict=True))


def test_everything_wrong_in_a_description_is_named_at_once(tmp_path):
    """Unknown names, bad values and missing files are told in one go, and nothing is written."""
    described = tmp_path / "bad.toml"
    described.write_text(
        "runs = 0\nfoo = 1\none_in = [0, 'a']\nscenarios = ['x']\n[[fit]]\ncup = 3\n"
    )
    with pytest.raises(InputError) as caught:
        read_description(described)
    told = str(caught.value)
    for word in ("runs", "foo", "one_in", "scenarios", "fit 1, cup", "no file"):
        assert word in told
    with pytest.raises(UsageError):
        study_files(
            *(Description(), Parameters(), StudyOutput(tmp_path / "s.xlsx")),
            *(run_here, Interrupt()),
        )
    assert [path.name for path in tmp_path.iterdir()] == ["bad.toml"]


def test_a_study_that_cannot_run_leaves_nothing(tmp_path, capsys):
    """No generations, a scheduler that is not there: a sentence, and no file."""
    for words in (["--generations", "0"], ["--scheduler", "nonsense://x"]):
        assert main(["study", str(BRACKET), "-o", str(tmp_path / "a.xlsx"), *words]) in (2, 3)
        assert "Traceback" not in capsys.readouterr().err
        assert not list(tmp_path.iterdir())


def test_ctrl_c_writes_what_is_done_and_a_resume_completes_it(tmp_path):
    """An interrupted study exits with 130 and its runs; resumed, it is as if never stopped."""
    words = [str(BRACKET), "-o", str(tmp_path / "a.xlsx"), "--runs", "40"]
    words += ["--generations", "10000", "--no-prove", "--quiet"]
    program = [sys.executable, "-m", "grasp_xl", "study", *words]
    started = subprocess.Popen(program)  # noqa: S603
    deadline = time.monotonic() + 60
    while time.monotonic() < deadline and _runs_in(tmp_path / "a.runs") < 3:
        time.sleep(0.05)
    started.send_signal(signal.SIGINT)
    assert started.wait(60) == 130
    done = _runs_in(tmp_path / "a.runs")
    assert 3 <= done < 80
    assert len(cells(tmp_path / "a.xlsx")["Runs"]) == 3 + done
    assert main(["study", *words, "--resume"]) == 0
    words[2] = str(tmp_path / "b.xlsx")
    assert main(["study", *words]) == 0
    assert cells(tmp_path / "a.xlsx") == cells(tmp_path / "b.xlsx")


def _runs_in(path: Path) -> int:
    if not path.exists():
        return 0
    try:
        with sqlite3.connect(f"file:{path}?mode=ro", uri=True) as base:
            return base.execute("SELECT COUNT(*) FROM runs").fetchone()[0]
    except sqlite3.Error:
        return 0


# --- the shipped study ---


def test_the_shipped_study_is_that_of_the_program_and_the_page_quotes_it():
    """Its first and last runs come out again with their seeds; docs/study.md has its numbers."""
    held = CalamineWorkbook.from_path(WORKBOOKS / "study.xlsx")
    rows = held.get_sheet_by_name("Runs").to_python()
    first = next(number for number, row in enumerate(rows) if row[0] == "Run")
    header = {name: number for number, name in enumerate(rows[first])}
    listed = {row[0]: row for row in rows[first + 1 :]}
    names = ("bracket", "door_frame", "panel", "tunnel_cover")
    books = [WORKBOOKS / f"{name}.xlsx" for name in names]
    plan = plan_of(*books, runs=100, generations=50_000)
    assert [trial.label for trial in plan.trials()] == list(listed)
    some = [trial for trial in plan.trials() if trial.number in (1, 100)]
    records: dict[str, Record] = {}
    run_here(
        [Work.of(case.task) for case in plan.cases],
        some,
        lambda trial, record: records.__setitem__(trial.label, record),
        Interrupt(),
    )
    for trial in some:
        task, best = plan.cases[trial.case].task, records[trial.label].best_chromosome
        assert best is not None
        row = listed[trial.label]
        assert row[header["Seed"]] == trial.seed
        value = evaluate(task.space, task.rules, best).divergence
        assert row[header["Divergence"]] == pytest.approx(value, rel=1e-12)
    text = (WORKBOOKS.parent / "docs" / "study.md").read_text()
    for row in held.get_sheet_by_name("Summary").to_python():
        if row[0].startswith("P") and row[1].endswith("start"):
            name, start = row[0].split()[1], row[1].split("-")[0].split()[0]
            numbers = [f"{value:.4f}" for value in row[4:8]]
            assert (
                f"| {name} | {start} | {' | '.join(numbers)} | {row[8]:.0%}".replace("%", " %")
                in text
            )
