"""What a worker does: read the open workbook, search, and fill its sheets."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace

from grasp_xl.commands import sentences
from grasp_xl.commands.check import check_book
from grasp_xl.commands.keeping import as_written, cards, held_run, kept_trade_offs
from grasp_xl.commands.output import not_begun, now, written_book
from grasp_xl.commands.preparing import prepare
from grasp_xl.commands.run import Ran, get_ready
from grasp_xl.commands.solve import prove_run, solve_book
from grasp_xl.compiled import is_compiled
from grasp_xl.errors import GraspError, InputError, OutputError, Problem
from grasp_xl.live.excel import (
    Book,
    OpenCells,
    StatusBar,
    apply,
    calling_book,
    refuse_hidden_rows,
    tell,
)
from grasp_xl.live.running import Running
from grasp_xl.search.exact import ExactSettings
from grasp_xl.search.result import Result
from grasp_xl.search.stop import Generations, Interrupt, Progress
from grasp_xl.task import Parameters, Task
from grasp_xl.workbook import layout
from grasp_xl.workbook.book import Book as Said
from grasp_xl.workbook.book import book_of
from grasp_xl.workbook.cells import Source
from grasp_xl.workbook.inputs import changed_inputs, input_rows
from grasp_xl.workbook.layout import Area
from grasp_xl.workbook.losses import MAX_NAMED, Comparison, first_named, sheet_gone
from grasp_xl.workbook.patch import Patch, as_seen
from grasp_xl.workbook.proved import Proved
from grasp_xl.workbook.reading_ga import find_block, find_ga_sheet

RESULTS_WAIT = "The results wait for that, ten minutes at most."
AS_THE_WORKBOOK_SAYS = Parameters()
RUN_PROOF_SECONDS = 10.0
"""Longest proof after a run, as on the command line."""
PROVE_SECONDS = 60.0
"""Longest search of the button ``Prove``."""
SHOWN_SECONDS = 5.0
"""How long the status bar shows the outcome."""
WAIT_SECONDS, AGAIN_SECONDS = 600.0, 3.0
"""How long results wait until they can be written, and how often that is tried."""


def work(command: str, claim: str | None = None) -> None:
    """Do what a button says on the workbook that has it; whatever goes wrong is told there.

    Parameters
    ----------
    command : str
        What stands in :data:`COMMANDS`.
    claim : str, optional
        By which the button marked the workbook.
    """
    book = calling_book()
    status = StatusBar(book)
    try:
        with Running.on(book).marked(claim) as ask:
            outcome = COMMANDS[command](book, ask)
    except InputError as error:
        told = "\n".join(map(str, error.problems[:MAX_NAMED]))
    except GraspError as error:
        told = f"{error.message}\n{error.hint}." if error.hint else error.message
    except Exception as error:  # noqa: BLE001 (no traceback for a person)
        told = f"grasp_xl failed ({type(error).__name__}: {error}); the sheets are as they were."
    else:
        _show_for_a_while(book, outcome)
        return
    status.clear()  # before the box, which a workbook that was closed cannot show
    tell(book, told, is_error=True)


def _show_for_a_while(book: Book, outcome: str) -> None:
    status = StatusBar(book)
    status.tell(outcome)
    time.sleep(SHOWN_SECONDS)
    if not Running.on(book).is_alive:
        status.clear()


def check(book: Book, ask: Interrupt) -> str:  # noqa: ARG001 (it is quick)
    """Validate the workbook, and show in a message box what any grasp of it can reach."""
    checked = check_book(_read(book), AS_THE_WORKBOOK_SAYS)
    if checked.obstacle:
        raise checked.obstacle
    warnings = [f"Warning: {warning}" for warning in checked.warnings]
    tell(book, "\n".join([*warnings, *sentences.check(checked)]))
    return "checked"


def run(book: Book, ask: Interrupt) -> str:
    """Run the genetic search, prove how good its best grasp is, and fill the sheets."""
    clock, status = time.perf_counter(), StatusBar(book)
    _say_if_it_compiles(status, "evolution")
    ready = get_ready(_read(book), AS_THE_WORKBOOK_SAYS, ask)
    _refuse_unfit(book, ready.book, ready.task)

    def generation(progress: Progress) -> None:
        best = f"best {ready.task.rules.criterion.name} {progress.best_value:.6g}"
        status.tell(f"generation {progress.generation:,} of {ready.task.generations:,}, {best}")
        ask.asked = ask.asked or status.is_lost

    result = ready.search([ask, Generations(ready.task.generations)], generation)
    solved = None
    if not ask.asked:
        _say_if_it_compiles(status, "exact")
        solved = prove_run(
            ready.task,
            result,
            None,
            RUN_PROOF_SECONDS,
            interrupt=ask,
            on_progress=_bound(status),
        )
    _fill_when_possible(book, ask, ready.task, result, solved.shown if solved else None)
    ran = Ran(ready.task, result, solved, time.perf_counter() - clock)
    return " ".join(sentences.run(ran))


def prove(book: Book, ask: Interrupt) -> str:
    """Find the best grasp of all, prove it, and show it beside the run that the workbook holds."""
    status = StatusBar(book)
    _say_if_it_compiles(status, "exact")
    said = _read(book)
    _refuse_unfit(book, said, prepare(said, AS_THE_WORKBOOK_SAYS, stop=ask.is_asked))
    settings = ExactSettings(PROVE_SECONDS)
    solved = solve_book(said, AS_THE_WORKBOOK_SAYS, settings, ask, on_progress=_bound(status))
    if solved.obstacle:
        raise solved.obstacle
    result, _ = held_run(said, solved.task)
    _fill_when_possible(book, ask, solved.task, result, solved.shown)
    return sentences.proof(solved)


COMMANDS: dict[str, Callable[[Book, Interrupt], str]] = {"check": check, "run": run, "prove": prove}


def _read(book: Book) -> Said:
    """Read the open workbook.

    Raises
    ------
    InputError
        If it is no full workbook, or cannot be used, with every problem found.
    """
    source = Source(OpenCells(book))
    if find_ga_sheet(source) is None:
        hint = "make a full workbook of it: grasp-xl new EXPORT -o BOOK.xlsm"
        raise InputError([Problem(book.name, "no sheet GA", "a full workbook", hint)])
    return book_of(source)


def _say_if_it_compiles(status: StatusBar, module: str) -> None:
    if not is_compiled(module):
        status.tell("compiling the search for this machine, once ...")


def _bound(status: StatusBar) -> Callable[[float, float | None], None]:
    def tell_bound(bound: float, best: float | None) -> None:
        known = "no grasp yet" if best is None else f"best {best:.6g}"
        status.tell(f"proving: {known}, none below {bound:.6g}")

    return tell_bound


def _refuse_unfit(book: Book, said: Said, task: Task) -> None:
    """Refuse, before any search, what the sheets could not show in the end.

    That is inputs for which the workbook has too many or too few cards or genes, trade-offs of
    other inputs, a sheet that is gone, or something in the way of what each result has: cells that
    are not ours, hidden rows.

    Raises
    ------
    InputError, OutputError
    """
    block = find_block(said.source, layout.USER_BLOCK)
    slots = block.columns - 1 if block else task.space.gene_slots
    hint = "make a workbook of that size with grasp-xl run BOOK -o OTHER.xlsm, or undo the change"
    problems = [
        Problem(where, f"{found} {what}", f"{has}, for which this workbook has room", hint)
        for where, found, what, has in (
            (_where(said, "Children"), task.settings.children, "children", cards(said)),
            (_where(said, "SuctionMax"), task.space.gene_slots, "index genes a kind", slots),
        )
        if found != has
    ]
    _, stale = kept_trade_offs(said, task)
    hint = f"delete the sheet {layout.TRADE_OFFS!r} or undo the change"
    problems += [replace(problem, hint=hint) for problem in stale]
    if problems:
        raise InputError(problems)
    patch, _ = _patch(said, task, not_begun(task), None)
    refuse_hidden_rows(book, patch)


def _where(said: Said, name: str) -> str:
    cell = said.source.names.get(name)
    return cell.where if cell else name


def _fill_when_possible(
    book: Book, ask: Interrupt, task: Task, result: Result, proved: Proved | None
) -> None:
    """Fill the sheets; where something is in the way, tell it once, and wait until it is gone.

    Raises
    ------
    InputError, OutputError
        If it stays there, or the person presses Stop.
    """
    status, patience = StatusBar(book), time.monotonic() + WAIT_SECONDS
    Running.on(book).forget_wish(ask)  # that was for the search
    told = False
    while True:
        try:
            _fill(book, task, result, proved)
        except OutputError as error:
            if ask.asked or time.monotonic() > patience:
                raise
            if not told:
                tell(book, f"{error.message}\n{error.hint}. {RESULTS_WAIT}", is_error=True)
            told = True
            status.tell("the results wait to be written; Stop gives them up")
            time.sleep(AGAIN_SECONDS)
        else:
            return


def _fill(book: Book, task: Task, result: Result, proved: Proved | None) -> None:
    """Bring the sheets to a result; what a designer typed meanwhile stays.

    Raises
    ------
    InputError
        If the inputs are others now.
    OutputError
        If something is in the way, or Excel does not take the result.
    """
    said = _read(book)
    changed = changed_inputs(prepare(said, AS_THE_WORKBOOK_SAYS), input_rows(task))
    if changed:
        found = f"inputs that changed while the search was at work: {'; '.join(changed)}"
        expected = "those that the search began with"
        hint = "nothing was written; press the button again"
        raise InputError([Problem(book.name, found, expected, hint)])
    patch, touched = _patch(said, task, result, proved)
    apply(book, patch, lambda cell: cell not in touched)


def _patch(
    said: Said, task: Task, result: Result, proved: Proved | None
) -> tuple[Patch, set[Area]]:
    """Return what changes in the workbook, and the cells that are not as we wrote them.

    Raises
    ------
    OutputError
        If a sheet is gone, or something that is not ours is in the way.
    """
    before = as_written(said)
    gone = sheet_gone(said.source, before)
    if gone:
        raise OutputError(
            f"The workbook has no sheet {gone!r} any more. Nothing was written.",
            where=said.source.name,
            hint=f"Give that sheet the name {gone!r} again, or run grasp-xl on the saved workbook",
        )
    after = written_book(task, result, said, now(), proved=proved, trade_offs=said.trade_offs)
    comparison = Comparison(said.source, before)
    patch = Patch(as_seen(said.source, before.book, after, comparison.inputs), after)
    touched = {
        cell for sheet in patch.sheets for _, cell in comparison.changes(sheet.sheet, sheet.sheet)
    }
    in_the_way = [
        cell.where
        for sheet in patch.sheets
        for cell in (Area(sheet.sheet, *place) for place in sorted(sheet.changed))
        if cell in touched
    ]
    if in_the_way:
        raise OutputError(
            f"What stands in {first_named(in_the_way)} is not ours, and the results "
            "would replace it. Nothing was written.",
            where=in_the_way[0],
            hint="Move it to another sheet, or undo the change, and try again",
        )
    return patch, touched
