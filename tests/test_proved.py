"""The best grasp of all in the workbook: proved after a run or by ``solve -o``, and called what it is."""

from __future__ import annotations

import contextlib
import io
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import time
import zipfile
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import openpyxl
import pytest
from bad_workbooks import tiny_export
from live_cases import random_case

from grasp_xl.cli.program import main
from grasp_xl.commands.output import not_begun, now
from grasp_xl.commands.preparing import prepare
from grasp_xl.commands.solve import solve_file
from grasp_xl.grasp import evaluate
from grasp_xl.rules import Criterion
from grasp_xl.search import stop
from grasp_xl.search.exact import ExactSettings, Proof, Status
from grasp_xl.search.stop import Interrupt
from grasp_xl.search.warm import load_exact_search
from grasp_xl.space import ElementKind, OptionSpace, Part, frozen
from grasp_xl.task import Parameters
from grasp_xl.workbook import layout
from grasp_xl.workbook.layout import Layout
from grasp_xl.workbook.proved import Proved
from grasp_xl.workbook.run_log import Origin
from grasp_xl.workbook.writing import export_workbook, full_workbook

SAMPLES = Path(__file__).parents[1] / "workbooks"
TITLE = Layout(gene_slots=5, children=5).proved.at(0, 0)
SOLVE_KEYS = {
    *("status", "bound", "gap", "designs", "floors", "floors_attained", "goals", "seconds"),
    "output",
}


@pytest.fixture
def bracket(tmp_path: Path) -> Path:
    """Copy the bracket's full workbook to a folder of its own."""
    return Path(shutil.copy(SAMPLES / "bracket.xlsx", tmp_path))


@pytest.fixture
def hard(tmp_path: Path) -> Path:
    """Write an export whose proof takes minutes: many footprints, and eight elements or more."""
    draw = np.random.default_rng(3)
    places = [frozen(np.c_[draw.uniform(0, 3000, (1500, 2)), np.zeros(1500)]) for _ in range(2)]
    kinds = (
        ElementKind("suction", 69.0, 10.0, 1, 9, places[0]),
        ElementKind("magnets", 130.0, 30.0, 1, 9, places[1]),
    )
    corners = frozen([[0, 0, 0], [3000, 0, 0], [3000, 3000, 0], [0, 3000, 0]])
    part = Part(27_000.0, frozen([1500.0, 1500.0, 10.0]))
    path = tmp_path / "hard.xlsx"
    path.write_bytes(export_workbook(OptionSpace(part, kinds, corners, 0.65)).content)
    return path


@pytest.fixture
def told(capsys: pytest.CaptureFixture[str]) -> Any:
    """Give the command line as a function that returns its JSON object and exit code."""

    def tell(*words: object) -> tuple[Any, int]:
        capsys.readouterr()
        code = main([*map(str, words), "--json"])
        return json.loads(capsys.readouterr().out), code

    return tell


def logged(book: Path) -> dict[str, Any]:
    """Return the Run Log by label."""
    rows = openpyxl.load_workbook(book)[layout.RUN_LOG].iter_rows(values_only=True)
    return {row[0]: row[1] for row in rows if row[0]}


def title(book: Path) -> str:
    """Return the stored title of the exact search's card, or of what stands in its place."""
    opened = openpyxl.load_workbook(book, data_only=True)
    genes = opened.defined_names.get("Proved")
    first = layout.area_of(genes.attr_text).cell(-2, -1) if genes else TITLE
    return str(opened[layout.GA][first.local].value)


def names(book: Path) -> set[str]:
    """Return the defined names."""
    return set(openpyxl.load_workbook(book).defined_names)


def table(book: Path) -> dict[str, list[Any]]:
    """Return the rows of the fitness table, and what stands beside it, by their labels."""
    opened = openpyxl.load_workbook(book, data_only=True)
    rows = {}
    for row in opened[layout.FITNESS_TABLE].values:
        for label, values in ((row[0], row[1:]), *[(row[n], row[n + 1 :]) for n in [8] if row[8:]]):
            if label:
                rows[str(label)] = list(values)
    return rows


# --- run ---


def test_run_proves_by_default(told: Any, bracket: Path) -> None:
    """``proved`` is the JSON of solve, with the same optimum; its floors need no search."""
    ran, code = told("run", bracket, "--generations", 300)
    solved, _ = told("solve", bracket)
    assert code == 0
    proved = ran["proved"]
    assert set(proved) == SOLVE_KEYS
    assert (proved["status"], proved["gap"]) == ("optimal", 0)
    assert proved["bound"] == proved["designs"][0]["value"] <= ran["best"]["value"]
    assert proved["designs"][0]["value"] == pytest.approx(solved["designs"][0]["value"], rel=1e-9)
    checked, _ = told("check", bracket)
    assert proved["floors"] == checked["floors"]
    assert proved["output"] == ran["output"]


def test_the_genetic_result_is_the_same_with_and_without_a_proof(told: Any, bracket: Path) -> None:
    """Bit for bit: JSON, random state, and every cell of children, designs and history."""
    books = [bracket.with_name(f"{name}.xlsx") for name in ("with", "without")]
    words = ("run", bracket, "--generations", 2000, "-o")
    ran, plain = told(*words, books[0])[0], told(*words, books[1], "--no-prove")[0]
    assert plain["proved"] is None
    for key in set(ran) - {"proved", "seconds", "output"}:
        assert ran[key] == plain[key], key
    with_proof, without = (openpyxl.load_workbook(book, data_only=True) for book in books)
    places = {layout.GA: TITLE.column, layout.VALID_DESIGNS: 40, layout.HISTORY: 40}
    for sheet, columns in places.items():
        rows = zip(
            with_proof[sheet].iter_rows(max_col=columns, values_only=True),
            without[sheet].iter_rows(max_col=columns, values_only=True),
            strict=True,
        )
        assert all(one == other for one, other in rows), sheet
    assert (
        logged(books[0])["State of the random stream"]
        == (logged(books[1])["State of the random stream"])
    )


def test_run_says_how_far_the_genetic_search_was_from_the_optimum(
    bracket: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["run", str(bracket), "--generations", "30"]) == 0
    out = capsys.readouterr().out
    assert "Proved optimum" in out
    assert re.search(
        r"Proved: no grasp has a divergence below 3\.09015 \(.* s\)\. "
        r"The best of the genetic run lies 0\.\d+, [\d.]+ % above it\.",
        out,
    )
    command = ["run", str(bracket), "--goals", "100,5500,30,900", "--criterion", "cost", "--force"]
    assert main([*command, "--generations", "3000"]) == 0
    assert "The genetic run found a grasp as good." in capsys.readouterr().out


def test_a_proof_that_does_not_end_leaves_bound_and_gap(told: Any, hard: Path) -> None:
    """Its time limit is kept; nothing calls its grasp proved or optimal."""
    ran, code = told("run", hard, "--generations", 50, "--prove-limit", 0.4)
    proved = ran["proved"]
    assert (code, proved["status"]) == (0, "feasible")
    assert 0 < proved["bound"] < proved["designs"][0]["value"] <= ran["best"]["value"] + 1e-9
    book = Path(ran["output"])
    log, rows = logged(book), table(book)
    assert log["Seconds of exact search"] < 0.4 + 0.5
    assert (log["Exact status"], log["Exact bound"]) == ("feasible", proved["bound"])
    assert log["Exact gap"] == pytest.approx(proved["gap"])
    assert rows["Ended"][0] == log["Exact search ended"] == "stopped at the time limit"
    assert rows["Bound: no grasp is below"][0] == proved["bound"]
    assert rows["Best known"][5] == proved["designs"][0]["divergence"]
    assert re.fullmatch(r"Best known \(not proved; gap [\d.]+ %\)", title(book))


def test_without_a_proof_nothing_looks_like_one(told: Any, bracket: Path) -> None:
    """Neither after ``--no-prove`` nor in a new workbook; also where a proof stood before."""
    book = bracket.with_name("out.xlsx")
    assert told("run", bracket, "-o", book, "--generations", 50)[1] == 0
    assert title(book) == "Proved optimum"
    assert told("run", book, "--in-place", "--generations", 50, "--no-prove")[1] == 0
    new = bracket.with_name("new.xlsx")
    assert told("new", bracket, "-o", new)[1] == 0
    for each in (book, new):
        assert title(each) == "Not proved"
        assert not {"Proved", "ProvedFitness", "ProvedDivergence"} & names(each)
        log = logged(each)
        assert log["Exact search"] == "Not proved"
        assert {log[name] for name in ("Exact status", "Exact bound", "Exact gap")} == {None}
        assert not [name for name in table(each) if "roved" in name or "xact" in name]
        with zipfile.ZipFile(each) as parts:
            charts = [parts.read(n).decode() for n in parts.namelist() if "charts/chart" in n]
        assert not any("Proved" in chart for chart in charts)


# --- Ctrl-C ---


def interrupted(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let Ctrl-C be there from the beginning."""

    @contextlib.contextmanager
    def asked() -> Iterator[stop.Interrupt]:
        yield stop.Interrupt(asked=True)

    monkeypatch.setattr(stop, "stop_on_ctrl_c", asked)


def test_after_ctrl_c_in_the_genetic_search_no_proof_is_made(
    told: Any, bracket: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    interrupted(monkeypatch)
    ran, code = told("run", bracket)
    assert (code, ran["stop_reason"], ran["proved"]) == (130, "interrupted", None)
    assert title(Path(ran["output"])) == "Not proved"


@pytest.mark.skipif(os.name == "nt", reason="Windows has no terminals of this kind")
def test_ctrl_c_during_the_proof_keeps_the_run_and_the_bound(hard: Path, told: Any) -> None:
    """The genetic result is whole; bound and best grasp are those by then, and the exit code is 130.

    A terminal shows bound, best value and gap meanwhile.
    """
    import pty  # not on Windows

    terminal, screen = pty.openpty()
    command = [sys.executable, "-m", "grasp_xl", "run", str(hard), "--generations", "500"]
    command += ["--prove-limit", "900", "--json"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=screen, text=True) as running:  # noqa: S603
        shown = ""
        while not ("none below" in shown and "gap" in shown):
            shown += os.read(terminal, 4096).decode(errors="replace")
        asked = time.perf_counter()
        running.send_signal(signal.SIGINT)
        out, _ = running.communicate(timeout=60)
    assert time.perf_counter() - asked < 20
    os.close(screen)
    os.close(terminal)
    ran = json.loads(out)
    plain, _ = told(
        "run", hard, "-o", hard.with_name("plain.xlsx"), "--generations", 500, "--no-prove"
    )
    assert running.returncode == 130
    assert (ran["stop_reason"], ran["best"]) == ("generations", plain["best"])
    proved = ran["proved"]
    assert proved["status"] == "feasible"
    assert 0 < proved["bound"] < proved["designs"][0]["value"] <= ran["best"]["value"] + 1e-9
    log = logged(Path(ran["output"]))
    assert (log["Exact search ended"], log["Exact bound"]) == ("interrupted", proved["bound"])
    assert log["Stop reason"] == "generations"


def test_a_slow_start_counts_once_against_the_time_limit(
    hard: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Half a second for the benchmark leaves half a second of one, and that is why it ends."""

    def slow(*words: object, **options: object) -> object:
        time.sleep(0.5)
        return prepare(*words, **options)

    monkeypatch.setattr("grasp_xl.commands.solve.prepare", slow)
    load_exact_search()
    solved = solve_file(hard, Parameters(), ExactSettings(time_limit_s=1.0))
    assert solved.ended == "stopped at the time limit"
    assert 0.3 <= solved.proof.seconds <= 0.6


def test_each_end_of_a_search_has_its_words(
    hard: Path, bracket: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Proved, the gap asked for, too many open branches, somebody's wish: none is guessed."""

    def ended(book: Path, *, asked: bool = False, **settings: float) -> str:
        interrupt = Interrupt(asked=asked)
        settings_of = ExactSettings(**{"time_limit_s": 60.0, **settings})
        return solve_file(book, Parameters(), settings_of, interrupt=interrupt).ended

    assert ended(bracket) == "all is proved"
    assert ended(hard, gap=100.0) == "stopped at the gap asked for"
    assert ended(hard, asked=True) == "interrupted"
    monkeypatch.setattr("grasp_xl.search.exact.MAX_OPEN", 50)
    assert ended(hard) == "stopped as the memory for open branches is full"


def test_a_run_is_kept_whatever_becomes_of_its_proof(
    bracket: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A fault of the exact search is not hidden, but the genetic result is written before."""

    def fails(*_: object, **__: object) -> None:
        raise MemoryError("no room for the nodes")

    monkeypatch.setattr("grasp_xl.commands.solve.prove", fails)
    book = bracket.with_name("kept.xlsx")
    with pytest.raises(MemoryError):
        main(["run", str(bracket), "-o", str(book), "--generations", "50", "--quiet"])
    assert logged(book)["Generations done"] == 50
    assert title(book) == "Not proved"


def test_a_second_ctrl_c_gives_only_the_proof_up(
    told: Any, bracket: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """While the proof cannot end at once, say as its code is compiled: the run is still written."""

    def impatient(*_: object, interrupt: stop.Interrupt, **__: object) -> None:
        interrupt.asked = True
        raise KeyboardInterrupt

    monkeypatch.setattr("grasp_xl.commands.solve.prove_run", impatient)
    ran, code = told("run", bracket, "--generations", 500)
    assert (code, ran["proved"], ran["generations"]) == (130, None, 500)
    assert title(Path(ran["output"])) == "Not proved"


# --- solve -o ---


def test_solve_writes_the_workbook(told: Any, bracket: Path) -> None:
    """With the optimum on its card and on the What-if card; without -o it writes nothing."""
    assert told("solve", bracket)[0]["output"] is None
    assert [file.name for file in bracket.parent.iterdir()] == [bracket.name]
    book = bracket.with_name("best.xlsx")
    solved, code = told("solve", bracket, "-o", book)
    assert (code, solved["output"]) == (0, str(book))
    assert title(book) == "Proved optimum"
    opened = openpyxl.load_workbook(book, data_only=True)
    for name in ("Proved", "WhatIf"):
        sheet, cells = opened.defined_names[name].attr_text.split("!")
        shown = [[cell.value for cell in row] for row in opened[sheet.strip("'")][cells]]
        assert shown == solved["designs"][0]["genes"]
    assert table(book)["Best of the genetic run above it"][0] == "-"


def test_solve_keeps_the_run_that_the_workbook_holds(told: Any, bracket: Path) -> None:
    """It can go on as if there had been no proof; a run on other inputs is not shown."""
    run, both = bracket.with_name("run.xlsx"), bracket.with_name("both.xlsx")
    ran, _ = told("run", bracket, "-o", run, "--generations", 300, "--no-prove")
    assert told("solve", run, "-o", both)[1] == 0
    assert title(both) == "Proved optimum"
    log = logged(both)
    assert (log["Generations done"], log["Best value"]) == (300, ran["best"]["value"])
    whole, _ = told("run", bracket, "-o", bracket.with_name("whole.xlsx"), "--generations", 700)
    on, _ = told("run", both, "--continue", "--in-place", "--generations", 700)
    for key in ("best", "evaluations", "generations"):
        assert on[key] == whole[key]
    other = bracket.with_name("other.xlsx")
    assert told("solve", run, "-o", other, "--seed", 9)[1] == 0
    assert logged(other)["Generations done"] == 0


def test_solve_replaces_only_what_run_would(
    bracket: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """An edited file needs --force, and where there is no grasp nothing is written."""
    book = bracket.with_name("best.xlsx")
    command = ["solve", str(bracket), "-o", str(book), "--quiet"]
    assert main([*command, "--fos", "99"]) == 4
    assert not book.exists()
    assert main(command) == 0
    assert main(command) == 0
    opened = openpyxl.load_workbook(book)
    opened[layout.GA]["A40"] = "mine"
    opened.save(book)
    assert main(command) == 3
    assert "was edited since" in capsys.readouterr().err
    assert main([*command, "--force"]) == 0


@pytest.mark.parametrize(
    ("words", "wanted"),
    [
        ("--min-elements 5", "Proved optimum among those that have 5 or more elements"),
        (
            "--goals 200,9000,90,2000 --meet-goals",
            "Proved optimum among those that meet all goals",
        ),
    ],
)
def test_a_card_says_among_which_grasps_it_is_the_best(
    told: Any, bracket: Path, words: str, wanted: str
) -> None:
    book = bracket.with_name("best.xlsx")
    assert told("solve", bracket, "-o", book, *words.split())[1] == 0
    assert title(book) == wanted
    assert table(book)["Among"][0] == wanted.removeprefix("Proved optimum among ")


# --- the pictures ---


def written(status: Status, criterion: str = "divergence") -> bytes:
    """Write a full workbook with what an exact search may have said of a random case."""
    case = random_case(1)
    rules = replace(case.task.rules, criterion=Criterion.parse(criterion))
    task = replace(case.task, rules=rules)
    grasp = evaluate(task.space, rules, task.benchmark.chromosome)
    designs = () if status == "unknown" else (grasp,)
    bound = grasp.value if status == "optimal" else 0.125
    proved = Proved(Proof(status, bound, designs, 1.0, nodes=0), ended="interrupted")
    origin = Origin("case.xlsx", "", now(), now())
    return full_workbook(task, not_begun(task), origin, proved=proved).content


def third_lines(content: bytes) -> dict[str, tuple[str, float]]:
    """Return name and first value of the third line of each chart that has one, by its title."""
    lines = {}
    history = openpyxl.load_workbook(io.BytesIO(content), data_only=True)[layout.HISTORY]
    with zipfile.ZipFile(io.BytesIO(content)) as parts:
        charts = [parts.read(name).decode() for name in parts.namelist() if "charts/chart" in name]
    for chart in charts:
        heading = re.search(r"<a:t>(.*) vs Generation Number</a:t>", chart)
        series = re.findall(r"<c:ser>.*?</c:ser>", chart)
        if heading and len(series) > 2:
            name = re.search(r"<c:tx>.*?<c:v>(.*?)</c:v>", series[2])
            y = re.search(r"<c:yVal>.*?\$([A-Z]+)\$(\d+)", series[2])
            assert name
            assert y
            lines[heading[1]] = (name[1], history[y[1] + y[2]].value)
    return lines


TITLES = ("FoS", "Cost", "Residual Moment", "Deviation", "Structure", "Divergence")


@pytest.mark.parametrize(
    ("criterion", "minimised"),
    [("divergence", "Divergence"), ("moment", "Residual Moment"), ("cost+moment", None)],
)
def test_charts_show_the_optimum_or_the_bound(criterion: str, minimised: str | None) -> None:
    """The bound stands in the chart of what is minimised, as long as nothing better is proved."""
    grasp = random_case(1).task.benchmark
    values = [round(value, 6) for value in (grasp.fos, *grasp.terms, grasp.divergence)]
    optimal, feasible, unknown = (
        third_lines(written(status, criterion)) for status in ("optimal", "feasible", "unknown")
    )
    assert optimal == {
        each: ("Proved optimum", value) for each, value in zip(TITLES, values, strict=True)
    }
    bound = {minimised: ("Proved bound", 0.125)} if minimised else {}
    assert feasible == {each: ("Best known", value) for each, (_, value) in optimal.items()} | bound
    assert unknown == dict.fromkeys(TITLES, ("Not proved", None)) | bound


def test_without_any_grasp_the_place_of_the_card_says_so(tmp_path: Path) -> None:
    book = tmp_path / "unknown.xlsx"
    book.write_bytes(written("unknown"))
    place = Layout(random_case(1).space.gene_slots, children=2).proved
    opened = openpyxl.load_workbook(book, data_only=True)[layout.GA]
    said = [opened.cell(place.row + row, place.column + 1).value for row in (1, 2, 3)]
    assert said == [
        "Not proved (no grasp found)",
        "The exact search ended before it found a grasp: interrupted.",
        "None has a value below 0.125.",
    ]
    assert "Proved" not in names(book)
    rows = table(book)
    assert (rows["Status"][0], rows["Best known (divergence)"][0]) == ("unknown", "-")


# --- writing it again ---


NOTHING_FOUND = ("--cups", "1", "--magnets", "1", "--generations", "0", "--prove-limit", "0")


@pytest.mark.parametrize(
    "words", [(), ("--prove-limit", "0"), ("--no-prove",), NOTHING_FOUND], ids=" ".join
)
@pytest.mark.parametrize(("cell", "value"), [("B10", "cost"), ("F9", 2)])
def test_what_is_proved_is_no_loss(
    told: Any, tmp_path: Path, words: tuple[str, ...], cell: str, value: object
) -> None:
    """Once the criterion or the user-defined grasp was typed over, whatever had been proved."""
    tiny_export(tmp_path / "tiny.xlsx")
    ran, _ = told("run", tmp_path / "tiny.xlsx", "--generations", 50, *words)
    book = Path(ran["output"])
    opened = openpyxl.load_workbook(book)
    opened[layout.GA][cell] = value
    opened.save(book)
    answer, code = told("run", book, "--in-place", "--generations", 50)
    assert (answer.get("error"), code) == (None, 0)


def test_what_is_typed_into_its_card_is_named(told: Any, bracket: Path) -> None:
    """Its genes are results, as those of the children are; typing belongs on the What-if card."""
    book = Path(told("run", bracket, "--generations", 50)[0]["output"])
    opened = openpyxl.load_workbook(book)
    area = layout.area_of(opened.defined_names["Proved"].attr_text)
    opened[layout.GA][area.local] = 5
    opened.save(book)
    refused, code = told("run", book, "--in-place")
    assert (code, f"the changed cells {area.where}." in refused["error"]) == (3, True)


def test_a_proof_whose_grasp_is_gone_is_no_loss(told: Any, tmp_path: Path) -> None:
    """With its place taken from the option space, the cells of its card are still known as ours."""
    tiny_export(tmp_path / "tiny.xlsx")
    goals = ("--goals", "1000,90000,900,9000")
    ran, _ = told("run", tmp_path / "tiny.xlsx", "--generations", 300, *goals)
    book = Path(ran["output"])
    opened = openpyxl.load_workbook(book)
    for cell, value in {"D10": None, "E10": None, "F10": None, "B16": 5}.items():
        opened[layout.OPTION_SPACE][cell] = value
    genes = layout.area_of(opened.defined_names["ProvedGrasp"].attr_text)
    opened[layout.RUN_LOG][genes.local] = "[[1, 99, 1, 1, 1, 1], [2, 3, 4, 1, 1, 1]]"
    opened.save(book)
    answer, code = told("run", book, "--in-place", "--generations", 50)
    assert (answer.get("error"), code) == (None, 0)
