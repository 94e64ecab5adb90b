"""The buttons fill the open workbook: xlwings drives LibreOffice here, as it drives Excel."""

from __future__ import annotations

import os
import re
import shutil
import sys
import threading
import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from decimal import Decimal
from itertools import pairwise
from pathlib import Path
from typing import Any
from unittest.mock import Mock

import calc_engine
import openpyxl
import pytest
import xlwings as xw
from office import Office, run_office

from grasp_xl import live
from grasp_xl.cli.program import main
from grasp_xl.live import excel, running, worker
from grasp_xl.workbook import layout
from grasp_xl.workbook.book import read_book
from grasp_xl.workbook.cells import same_formula
from grasp_xl.workbook.writing import export_workbook

SAMPLES = Path(__file__).parents[1] / "workbooks"
ACCURACY = 1e-9
GENERATIONS = 3000
OF_THE_RUN = ("Input file", "Input SHA-256", "Started", "Ended", "Seconds of search")
TIMES = ("Seconds of exact search", "Time of the exact search (s)")
"""Labels of what is another each time."""


@pytest.fixture(autouse=True)
def own_marks(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Keep the marks of searches apart, and do not wait at the end of one."""
    monkeypatch.setattr(running, "user_cache_path", lambda _: tmp_path / "cache")
    monkeypatch.setattr(worker, "SHOWN_SECONDS", 0)
    monkeypatch.setattr(worker, "WAIT_SECONDS", 0)


@pytest.fixture
def log(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Note what a person sees."""
    path = tmp_path / "log.jsonl"
    monkeypatch.setenv(calc_engine.LOG, str(path))
    return path


@pytest.fixture(scope="module")
def bracket(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Make a workbook with buttons, as a designer does."""
    path = tmp_path_factory.mktemp("made") / "bracket.xlsm"
    assert main(["new", str(SAMPLES / "bracket.xlsx"), "-o", str(path), "--quiet"]) == 0
    return path


@pytest.fixture(scope="module")
def export(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Write the exported sheet of a part with few places: LibreOffice takes long for many cells."""
    space = read_book(SAMPLES / "bracket.xlsx").space
    kinds = tuple(replace(k, footprints_mm=k.footprints_mm[::4], overlap=None) for k in space.kinds)
    path = tmp_path_factory.mktemp("export") / "small.xlsx"
    path.write_bytes(export_workbook(replace(space, kinds=kinds)).content)
    return path


def run_on(export: Path, path: Path, generations: int) -> Path:
    """Make a workbook with two cards, which holds a run."""
    grasp = ("--cups", "1,7", "--magnets", "1,9,26")
    few = (*grasp, "--children", "2", "--generations", str(generations), "--no-prove", "--quiet")
    assert main(["run", str(export), "-o", str(path), *few]) == 0
    return path


@pytest.fixture(scope="module")
def made(export: Path) -> Path:
    """Make a small workbook with buttons, without a run."""
    return run_on(export, export.with_name("made.xlsm"), 0)


@pytest.fixture(scope="module")
def with_run(export: Path) -> Path:
    """Make a small workbook that holds a run."""
    return run_on(export, export.with_name("run.xlsx"), 2000)


@pytest.fixture
def sample(with_run: Path, tmp_path: Path) -> Path:
    """Copy a workbook with a run."""
    return Path(shutil.copy(with_run, tmp_path))


@pytest.fixture
def book(office: Office, made: Path) -> Iterator[xw.Book]:
    """Open it, with few generations and what a designer has besides."""
    office.open(made)
    opened = calc_engine.book_of(office)
    typed(opened, "Generations", GENERATIONS)
    yield opened
    office.do("close")


def typed(book: xw.Book, name: str, value: object) -> None:
    """Type into a named cell."""
    book.names[name].refers_to_range.value = value


def alerts(log: Path) -> list[str]:
    """Texts of the message boxes."""
    return [entry["text"] for entry in calc_engine.noted(log) if entry["kind"] == "alert"]


def contents(book: xw.Book) -> dict[str, Any]:
    """Return all constants and formulas, by sheet."""
    cells = {sheet.name: sheet.used_range for sheet in book.sheets}
    return {
        name: (used.address, [[same_formula(text) for text in row] for row in used.formula])
        for name, used in cells.items()
    }


def same(one: object, other: object) -> bool:
    """Compare two values as far as programs keep their digits."""
    numbers = int | float
    if isinstance(one, numbers) and isinstance(other, numbers):
        return abs(one - other) <= ACCURACY * max(1.0, abs(one))
    return (one or None) == (other or None)


def folded(formula: str) -> str:
    """Fold what LibreOffice changes when it saves: TRUE, and the last digits of numbers."""
    text = same_formula(formula).replace("TRUE", "1").replace("FALSE", "0")
    return re.sub(r"\d+\.\d+(e[+-]\d+)?", lambda number: f"{float(number[0]):.9g}", text)


def differences(one: Path, other: Path) -> list[str]:
    """Name the cells in which two workbooks differ: values, or formulas where there are any."""
    found = []
    books = [openpyxl.load_workbook(path) for path in (one, other)]
    values = [openpyxl.load_workbook(path, data_only=True) for path in (one, other)]
    for sheet in books[0]:
        sheets = [each[sheet.title] for each in (*books, *values)]
        last = max(each.max_row for each in sheets), max(each.max_column for each in sheets)
        for rows in zip(*(s.iter_rows(1, last[0], 1, last[1]) for s in sheets), strict=True):
            label = None
            for cells in zip(*rows, strict=True):
                texts = [str(cell.value or "") for cell in cells[:2]]
                differ = not same(cells[2].value, cells[3].value)
                if texts[0].startswith("="):
                    differ |= folded(texts[0]) != folded(texts[1])
                if differ and label not in OF_THE_RUN + TIMES:
                    found.append(f"{sheet.title}!{cells[0].coordinate} {texts}")
                label = cells[0].value
    return found


def test_a_run_equals_the_command_lines_cell_for_cell(
    office: Office, bracket: Path, tmp_path: Path, log: Path
) -> None:
    """Values, formulas, table sizes, names; own things stay, and nothing is read from disk."""
    office.open(bracket, unsaved=True)
    book = calc_engine.book_of(office)
    typed(book, "Generations", GENERATIONS)
    own = book.sheets["Run Log"].range("H2:I3")
    own.formula = [["mine", "=1+1"], [3, "=GA!$B$4"]]
    office.do("add_own", sheet="Mine")
    theirs = office.do("read_own", sheet="Mine")
    worker.work("run")
    assert office.do("read_own", sheet="Mine") == theirs
    assert alerts(log) == []
    assert book.sheets["Run Log"].range("B4").value == book.name
    office.save(tmp_path / "live.xlsx")
    told = ["--generations", str(GENERATIONS), "--quiet"]
    assert main(["run", str(bracket), "-o", str(tmp_path / "told.xlsm"), *told]) == 0
    others = differences(tmp_path / "told.xlsm", tmp_path / "live.xlsx")
    assert [text for text in others if not text.startswith(("Run Log!H", "Run Log!I"))] == []
    assert own.formula == (("mine", "=1+1"), ("3", "=GA!$B$4"))
    filled, expected = (
        openpyxl.load_workbook(tmp_path / name) for name in ("live.xlsx", "told.xlsm")
    )
    for sheet in expected:
        assert sheet.tables.items() == filled[sheet.title].tables.items()
    printed = book.sheets["Valid Designs"].page_setup.print_area
    assert printed == expected["Valid Designs"].print_area.replace("'Valid Designs'!", "")
    for name in ("ProofTitle", "RandomState", "Child1"):
        area = expected.defined_names[name].attr_text
        assert layout.area_of(book.names[name].refers_to[1:]) == layout.area_of(area)
    look = book.sheets["Fitness Table"].range("B4"), book.sheets["Fitness Table"].range("B7")
    assert look[0].number_format == look[1].number_format
    assert look[0].color == look[1].color
    lines = filled["Fitness Table"]["A3"].border.top, filled["Run Log"]["A3"].border.top
    assert [line.style for line in lines] == ["thin", "thin"]
    office.do("close")


def test_a_second_run_and_a_proof_replace_the_first(
    book: xw.Book, office: Office, sample: Path, tmp_path: Path, log: Path
) -> None:
    """Also with other inputs, a large seed, a typed What-if grasp, and fewer designs than before."""
    office.open(sample)
    typed(book, "Seed", 5e9)  # more than 32 bits
    typed(book, "MinClearance", 60)  # which some designs of the first run do not have
    typed(book, "Generations", 200)
    typed(book, "CostGoal", 80)  # below its floor: a warning more in the run log
    book.names["WhatIf"].refers_to_range.value = [[1, 5, 1, 1, 1, 1], [2, 20, 22, 1, 1, 1]]
    office.save(tmp_path / "before.xlsx")
    worker.work("run")
    worker.work("prove")
    assert alerts(log) == []
    office.save(tmp_path / "live.xlsx")
    first = ["run", str(tmp_path / "before.xlsx"), "-o", str(tmp_path / "told.xlsx"), "--quiet"]
    assert main(first) == 0
    assert main(["solve", str(tmp_path / "told.xlsx"), "-o", str(tmp_path / "all.xlsx")]) == 0
    assert differences(tmp_path / "all.xlsx", tmp_path / "live.xlsx") == []


def test_cards_follow_also_where_a_person_calculates_by_hand(
    book: xw.Book, office: Office, log: Path
) -> None:
    """The results are calculated, and Excel is left as the person has it."""
    book.app.calculation = "manual"
    worker.work("run")
    assert alerts(log) == []
    assert book.app.calculation == "manual"
    shown = book.sheets["GA"].range("D23:AX63").value
    office.recalculate()
    assert book.sheets["GA"].range("D23:AX63").value == shown


def test_wrong_inputs_are_told_and_nothing_changes(book: xw.Book, log: Path) -> None:
    """Every problem in one message box, with its cell; no sheet is touched."""
    book.sheets[layout.OPTION_SPACE].range("B5").value = "heavy"
    typed(book, "MutationOneIn", 0.5)
    before = contents(book)
    for command in ("check", "run", "prove"):
        worker.work(command)
    told = alerts(log)
    assert len(told) == 3
    for text in told:
        assert "Option Space!B5: found the text 'heavy'" in text
        assert "GA!B6" in text
        assert "Traceback" not in text
    assert contents(book) == before


def test_what_is_not_ours_is_never_replaced(
    book: xw.Book, log: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A text under the list of designs, where results would go: they wait until it is gone."""
    cell = book.sheets[layout.VALID_DESIGNS].range("C12")
    cell.value = "mine"
    before = contents(book)
    worker.work("run")
    (told,) = alerts(log)
    assert told.startswith("What stands in Valid Designs!C12 is not ours")
    assert contents(book) == before
    monkeypatch.setattr(worker, "WAIT_SECONDS", 600)
    monkeypatch.setattr(worker.time, "sleep", lambda _: cell.clear_contents())
    worker.work("run")
    assert worker.RESULTS_WAIT in alerts(log)[-1]
    assert book.names["GenerationsDone"].refers_to_range.value == GENERATIONS


def test_filters_and_selection_stay(
    office: Office, sample: Path, log: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Excel mixes up what is written where a filter hides rows: results wait until it is cleared."""
    office.open(sample)
    book = calc_engine.book_of(office)
    typed(book, "Generations", 200)
    book.sheets["Fitness Table"].activate()
    book.sheets["Fitness Table"].range("B3:D5").select()
    selected, prove = office.do("selected"), worker.prove_run

    def filter_designs(text: str | None) -> None:
        office.do("filter", table="ValidDesigns", column=0, text=text)

    def filter_and_prove(*args: Any, **options: Any) -> Any:
        filter_designs("11")
        return prove(*args, **options)

    filter_designs("1")
    before = contents(book)
    monkeypatch.setattr(worker, "prove_run", None)  # asked after the search
    worker.work("run")
    assert alerts(log)[0].startswith("Rows of 'Valid Designs' are hidden, row 10 among them")
    assert contents(book) == before
    filter_designs(None)
    monkeypatch.setattr(worker, "prove_run", filter_and_prove)
    monkeypatch.setattr(worker, "WAIT_SECONDS", 600)
    monkeypatch.setattr(worker.time, "sleep", lambda _: filter_designs(None))
    worker.work("run")
    assert alerts(log)[1].startswith("Rows of 'Valid Designs' are hidden")
    assert len(alerts(log)) == 2
    assert book.names["GenerationsDone"].refers_to_range.value == 200
    assert office.do("selected") == selected
    office.do("close")


def test_what_is_in_the_way_of_any_result_is_told_before_the_search(
    book: xw.Book, office: Office, log: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A label that was typed over, or a sheet that is gone."""
    monkeypatch.setattr(worker, "prove_run", None)  # asked after the search
    book.sheets["GA"].range("A4").value = "mine"
    worker.work("run")
    assert alerts(log)[-1].startswith("What stands in GA!A4 is not ours")
    office.do("remove", sheet="History")
    worker.work("run")
    assert alerts(log)[-1].startswith("The workbook has no sheet 'History' any more")


def test_what_a_person_did_to_names_and_inputs_does_no_harm(book: xw.Book, log: Path) -> None:
    """Names that are gone come back, and a formula in an input stays."""
    for name in ("UserChromosome", "Child1", "RandomState", "Elitism", "ProofTitle"):
        book.names[name].delete()
    book.sheets["GA"].range("B17").formula = "=2+3"
    worker.work("run")
    assert alerts(log) == []
    names = {name.name for name in book.names}
    assert {"UserChromosome", "Child1", "RandomState", "Elitism", "ProofTitle"} <= names
    assert book.sheets["GA"].range("B17").formula == "=2+3"


def test_a_deleted_sheet_of_trade_offs_leaves_nothing_in_the_way(
    office: Office, sample: Path, tmp_path: Path, log: Path
) -> None:
    """Its list may be of other inputs; without it the What-if card shows the best grasp."""
    path = tmp_path / "front.xlsm"
    front = ["front", str(sample), "-o", str(path), "--grid", "1", "--quiet"]
    assert main(front) == 0
    office.open(path)
    book = calc_engine.book_of(office)
    typed(book, "FoSGoal", 2.5)
    typed(book, "Generations", 100)
    worker.work("run")
    assert "delete the sheet 'Trade-offs' or undo the change" in alerts(log)[-1]
    office.do("remove", sheet="Trade-offs")
    worker.work("run")
    assert len(alerts(log)) == 1
    assert book.names["GenerationsDone"].refers_to_range.value == 100
    assert "#REF!" not in str(book.names["WhatIf"].refers_to_range.formula)
    office.do("close")


def test_currency_cells_keep_all_digits() -> None:
    """Excel on Windows gives decimals with four digits for them; the constant's text has all."""
    values = [[Decimal("10.1235"), Decimal("5.0000"), "x"]]
    texts = [["10.123456", "=A1/2", "x"]]
    assert excel._with_all_digits(values, texts) == [[10.123456, 5.0, "x"]]


def test_goals_that_no_grasp_meets_are_told_by_every_button(
    office: Office, sample: Path, log: Path
) -> None:
    """With what would help, also where the workbook holds a run, whose cards have no fitness then."""
    office.open(sample)
    book = calc_engine.book_of(office)
    typed(book, "FoSGoal", 50)
    before = contents(book)
    for command in ("check", "run", "prove"):
        worker.work(command)
    told = alerts(log)
    assert [text.split(":")[0] for text in told] == ["No grasp can reach FoS 50"] * 3
    assert contents(book) == before
    office.do("close")


def test_other_sizes_are_refused_before_any_search(book: xw.Book, log: Path) -> None:
    """A workbook has as many cards as it was made with."""
    typed(book, "Children", 8)
    before = contents(book)
    worker.work("run")
    (told,) = alerts(log)
    assert "found 8 children, expected 2, for which this workbook has room" in told
    assert contents(book) == before


def test_what_excel_refuses_leaves_the_sheets_as_they_were(
    book: xw.Book, office: Office, log: Path
) -> None:
    """All or nothing: also where the first sheets were filled already."""
    office.do("protect", sheet="Calc")
    before = contents(book)
    worker.work("run")
    (told,) = alerts(log)
    assert told.startswith("Excel did not take the results")
    assert contents(book) == before


def test_results_do_not_fail_for_what_is_printed(
    book: xw.Book, log: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Excel takes no print area of more than 255 characters, which a workbook of many cards has."""

    def refuse(*_: object) -> None:
        raise ValueError

    monkeypatch.setattr(calc_engine.PageSetup, "print_area", property(None, refuse))
    worker.work("run")
    assert alerts(log) == []
    assert book.names["GenerationsDone"].refers_to_range.value == GENERATIONS


def test_inputs_that_change_meanwhile_keep_the_sheets_as_they_are(
    book: xw.Book, log: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The result would be that of other inputs."""
    search = worker.prove_run

    def and_type(*args: Any, **options: Any) -> Any:
        typed(book, "FoSGoal", 2.5)
        return search(*args, **options)

    monkeypatch.setattr(worker, "prove_run", and_type)
    before = contents(book)
    worker.work("run")
    (told,) = alerts(log)
    assert "inputs that changed while the search was at work: FoS goal 2.5, not 3" in told
    assert contents(book)["Run Log"] == before["Run Log"]


def test_stop_ends_a_run_at_once_and_keeps_the_best(book: xw.Book, log: Path) -> None:
    """Within half a second the search is over; the status bar changes five times a second at most."""
    typed(book, "Generations", 1_000_000_000)
    mark = running.Running.on(book)
    moments: list[float] = []

    def press_stop() -> None:
        while len(calc_engine.noted(log)) < 6:
            time.sleep(0.05)
        moments.append(time.monotonic())
        mark.ask_to_stop()

    other = threading.Thread(target=press_stop)
    fill = worker._fill

    def then_fill(*found: Any) -> None:
        moments.append(time.monotonic())
        fill(*found)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(worker, "_fill", then_fill)
        other.start()
        worker.work("run")
        other.join()
    pressed, ended = moments
    assert ended - pressed < 0.5
    assert alerts(log) == []
    found = {row[0]: row[1] for row in book.sheets["Run Log"].range("A1:B30").value}
    assert found["Stop reason"] == "interrupted (INTERRUPTED: best so far)"
    assert found["Best value"] < 4
    times = [entry["time"] for entry in calc_engine.noted(log) if entry["text"]]
    assert min(b - a for a, b in pairwise(times[:-1])) > 0.19  # the last tells the outcome
    assert not mark.is_alive


def test_a_search_ends_when_excel_is_gone(
    book: xw.Book, log: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Nobody could stop it any more."""
    typed(book, "Generations", 1_000_000_000)
    monkeypatch.setattr(excel, "LOST_SECONDS", 1)
    monkeypatch.setattr(xw.App, "status_bar", property(lambda _: None))  # takes no text

    def ended(*_: Any) -> None:
        raise EOFError

    monkeypatch.setattr(worker, "_fill", ended)
    worker.work("run")
    assert "EOFError" in alerts(log)[-1]


def test_a_search_ends_when_its_workbook_is_closed(
    book: xw.Book, log: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Excel may have others open: nothing of the search stays in its status bar."""
    typed(book, "Generations", 1_000_000_000)
    mark = running.Running.on(book)
    name, refuse = book.name, worker._refuse_unfit
    closed: list[bool] = []

    def name_of_open(_: xw.Book) -> str:
        if closed:
            raise RuntimeError
        return name

    def then_close(*found: Any) -> None:
        refuse(*found)
        closed.append(True)

    monkeypatch.setattr(excel, "LOST_SECONDS", 1)
    monkeypatch.setattr(xw.Book, "name", property(name_of_open))
    monkeypatch.setattr(worker, "_refuse_unfit", then_close)
    monkeypatch.setattr(worker, "tell", tell := Mock(side_effect=RuntimeError))
    with pytest.raises(RuntimeError):
        worker.work("run")
    tell.assert_called_once()
    assert calc_engine.noted(log)[-1]["text"] is False
    assert not mark.is_alive


def test_of_two_searches_on_a_workbook_one_is_told_to_wait(book: xw.Book, log: Path) -> None:
    """Also where both begin before either is seen; the mark of a killed worker hinders nobody."""
    mark = running.Running.on(book)
    with mark.marked():
        worker.work("check")
    assert alerts(log) == [running.BUSY]
    mark.mark.touch()
    os.utime(mark.mark, (0, 0))
    worker.work("check")
    assert alerts(log)[-1].endswith("No problem found.")


def test_stop_counts_as_soon_as_run_was_pressed(
    book: xw.Book, log: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Also before its worker is there, which takes seconds; another press of Run has to wait."""
    typed(book, "Generations", 1_000_000_000)
    started: list[list[str]] = []
    monkeypatch.setattr(live.subprocess, "Popen", lambda words, **_: started.append(words))
    live.run()
    live.stop()
    assert alerts(log) == []
    live.run()
    assert alerts(log) == [running.BUSY]
    (words,) = started
    behind = words.index("grasp_xl.live") + 1
    worker.work(*words[behind : behind + 2])
    assert alerts(log) == [running.BUSY]
    assert book.names["StopReason"].refers_to_range.value.startswith("interrupted")
    assert not running.Running.on(book).is_alive


def test_check_tells_what_any_grasp_can_reach(book: xw.Book, log: Path) -> None:
    """In a message box, with warnings; nothing is written."""
    before = contents(book)
    worker.work("check")
    (told,) = alerts(log)
    assert "suction: 7 places" in told
    assert told.endswith("No problem found.")
    assert contents(book) == before


@pytest.mark.usefixtures("book")
def test_stop_without_a_search_says_so(log: Path) -> None:
    live.stop()
    assert alerts(log) == [live.IDLE]


# --- the buttons themselves ---

EMPTY = "Rem Attribute VBA_ModuleType=VBAModule\nOption VBASupport 1\n"
SHIM = f"""{EMPTY}
Public Function RunPython(PythonCommand As String)
    Shell "{sys.executable}", 0, "-c " & Chr(34) & PythonCommand & Chr(34)
End Function
"""
"""Stands for xlwings' modules: LibreOffice can run nothing in a project with one of them."""

CONNECT = """import calc_engine
calc_engine.connect({pipe!r}, {name!r})
"""
"""What each Python that a button starts does first, as xlwings finds Excel by itself."""


@pytest.fixture
def pressed(
    made: Path, tmp_path: Path, log: Path, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[Office]:
    """Open the workbook with its macros, in a LibreOffice that gives Python what it needs here."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("PYTHONPATH", os.pathsep.join([str(tmp_path), *filter(None, sys.path)]))
        patch.setenv(calc_engine.LOG, str(log))
        for office in run_office(tmp_path_factory.mktemp("pressed")):
            connect = CONNECT.format(pipe=office.pipe, name=made.name)
            (tmp_path / "sitecustomize.py").write_text(connect)
            office.open(made, macros=True)
            for module, source in (("xlwings", SHIM), ("Dictionary", EMPTY)):
                office.do("replace_module", library="VBAProject", module=module, source=source)
            yield office


def wait_for(truth: Callable[[], bool], seconds: float = 60) -> None:
    """Look again and again until something holds."""
    patience = time.monotonic() + seconds
    while not truth():
        assert time.monotonic() < patience
        time.sleep(0.2)


def test_a_press_of_the_button_fills_the_sheets(pressed: Office, log: Path) -> None:
    """It returns at once; a worker fills the open workbook; another press of Run is told to wait; Stop ends it."""
    pressed.enter({"Generations": 300})
    began = time.monotonic()
    pressed.do("press", sheet="GA", caption="Run")
    assert time.monotonic() - began < 5
    wait_for(lambda: pressed.value("GenerationsDone") == 300)
    wait_for(lambda: not calc_engine.noted(log)[-1]["text"])  # the outcome was shown
    pressed.enter({"Generations": 1_000_000_000})
    pressed.do("press", sheet="GA", caption="Run")
    wait_for(lambda: "generation" in str(calc_engine.noted(log)[-1]["text"]))
    pressed.do("press", sheet="GA", caption="Run")
    wait_for(lambda: alerts(log) == [running.BUSY])
    pressed.do("press", sheet="GA", caption="Stop")
    wait_for(lambda: str(pressed.value("StopReason")).startswith("interrupted"))
    assert pressed.value("GenerationsDone") > 300
