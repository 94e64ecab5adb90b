"""How ``run`` searches, and what it writes."""

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from grasp_xl.commands.keeping import kept_trade_offs, replaced, replaced_in_place, saved_run_of
from grasp_xl.commands.output import Output, macros_at, now, written_book
from grasp_xl.commands.preparing import Active, prepare, refuse_infeasible, with_floor_warnings
from grasp_xl.commands.solve import Solved
from grasp_xl.commands.view import rendered
from grasp_xl.errors import OutputError, Problem
from grasp_xl.search.floors import floors
from grasp_xl.search.genetic import OnProgress, search
from grasp_xl.search.result import Result, State
from grasp_xl.search.stop import Interrupt, StopRule
from grasp_xl.task import Parameters, Task
from grasp_xl.view.designs import BENCHMARK, BEST, PROVED, Design
from grasp_xl.workbook import layout
from grasp_xl.workbook.book import Book, read_book
from grasp_xl.workbook.grasp_sheet import Rendering
from grasp_xl.workbook.reading_run import SavedRun
from grasp_xl.workbook.saving import check_place, check_target, save
from grasp_xl.workbook.trade_offs_sheet import TradeOffs


@dataclass(frozen=True, eq=False, slots=True)
class Ran:
    """What ``run`` did.

    Parameters
    ----------
    task : Task
    result : Result
        Of the genetic search.
    solved : Solved or None
        What the exact search proved afterwards; None where it was not asked.
    seconds : float
        All that it took.
    """

    task: Task
    result: Result
    solved: Solved | None
    seconds: float


@dataclass(frozen=True, eq=False, slots=True)
class Ready:
    """A workbook whose run may begin.

    Parameters
    ----------
    book : Book
    task : Task
    saved : SavedRun or None
        The run that goes on.
    trade_offs : TradeOffs or None
        Kept in the workbook.
    """

    book: Book
    task: Task
    saved: SavedRun | None
    trade_offs: TradeOffs | None

    def search(self, rules: Sequence[StopRule], on_progress: OnProgress | None = None) -> Result:
        """Run the genetic search."""
        task, saved = self.task, self.saved
        result = search(
            task.space,
            task.rules,
            task.settings,
            task.benchmark.chromosome,
            rules,
            state=saved.state if saved else None,
            on_progress=on_progress,
        )
        if saved and result.state.generation == saved.state.generation:
            result = replace(result, matrix=saved.matrix, children=saved.children)
        return result


def get_ready(
    book: Book,
    options: Parameters,
    ask: Interrupt,
    *,
    grasp: Active = (None, None),
    go_on: bool = False,
) -> Ready:
    """Settle what a run of a workbook does, and refuse one that can find nothing.

    Parameters
    ----------
    book, options
    ask : Interrupt
        Once asked, it ends what is looked for.
    grasp : Active
        The user-defined grasp, where options name it.
    go_on : bool
        Go on from the run that the workbook holds.

    Raises
    ------
    InfeasibleError
        If no grasp meets FoS and clearance.
    InputError
        If there is no run to go on from.
    """
    task = prepare(book, options, grasp, ask.is_asked)
    saved = saved_run_of(book, task) if go_on else None
    task = task.warned(_gaps(saved.state) if saved else ())
    trade_offs, stale = kept_trade_offs(book, task)
    task = task.warned(stale)
    refuse_infeasible(task, ask.is_asked)
    task = with_floor_warnings(task, floors(task.space, task.rules.requirements))
    return Ready(book, task, saved, trade_offs)


def run_file(
    path: Path,
    options: Parameters,
    output: Output,
    *,
    grasp: Active = (None, None),
    stop: Callable[[Task], Sequence[StopRule]],
    interrupt: Interrupt | None = None,
    go_on: bool = False,
    on_progress: OnProgress | None = None,
    prove: Callable[[Task, Result], Solved | None] | None = None,
    picture: bool = False,
) -> Ran:
    """Run the genetic search on a file, prove how good it is, and write the workbook.

    Parameters
    ----------
    path, options, output
    grasp : Active
        The user-defined grasp, where options name it.
    stop : callable
        Makes the stop rules of a settled task, when the search begins.
    interrupt : Interrupt, optional
        Once asked, it ends all searches with what is found by then.
    go_on : bool
        Go on from the run that the workbook holds.
    on_progress : callable, optional
    prove : callable, optional
        Given the run, says what the exact search proved; None where it was not asked.
    picture : bool
        Draw the best grasp in three dimensions.
    """
    clock, began = time.perf_counter(), now()
    ask = interrupt or Interrupt()
    check_target(output.path, path, in_place=output.in_place, force=output.force)
    lost = [] if output.in_place else replaced(output)
    if output.history:
        check_place(output.history, (".csv",), force=output.force, option="--history")
    ready = get_ready(read_book(path), options, ask, grasp=grasp, go_on=go_on)
    lost += replaced_in_place(output, ready.book) if output.in_place else []
    ready = replace(ready, task=ready.task.warned(lost))
    book, task, saved = ready.book, ready.task, ready.saved
    result = ready.search([ask, *stop(task)], on_progress)
    solved = None
    try:
        solved = prove(task, result) if prove else None
    finally:  # what the run found is kept, whatever becomes of the proof
        rendering: Rendering | None = None
        notes: tuple[Problem, ...] = ()
        if picture:
            rendering, notes = rendered(book, task, _best_known(task, result, solved))
        written = written_book(
            task,
            result,
            book,
            began,
            proved=solved.shown if solved else None,
            trade_offs=ready.trade_offs,
            macros=macros_at(output.path, book),
            rendering=rendering,
        )
        save(written.content, output.path)
        _save_history(result, output)
    if saved:
        idle = _nothing_asked(book, options, task.generations, saved.state.generation)
        task = task.warned(idle)
    task = task.warned(notes)
    return Ran(task, result, solved, time.perf_counter() - clock)


def _best_known(task: Task, result: Result, solved: Solved | None) -> Design:
    """Return the best grasp that is known after a run."""
    proved = solved.shown if solved else None
    if proved and proved.grasp:
        return Design(PROVED, "", proved.title, proved.grasp.chromosome)
    if result.best:
        return Design(BEST, "", "Best of the run", result.best.chromosome)
    return Design(BENCHMARK, "", "Benchmark", task.benchmark.chromosome)


def _save_history(result: Result, output: Output) -> None:
    """Write the history where one is wanted; an error says that the workbook is written already."""
    if output.history is None:
        return
    try:
        save(result.history().to_csv(index=False).encode(), output.history)
    except OutputError as error:
        message = f"{error.message} The workbook {output.path} is written."
        raise OutputError(message, where=error.where, hint=error.hint) from error


def _nothing_asked(book: Book, options: Parameters, asked: int, done: int) -> list[Problem]:
    """Warn where a run that goes on was asked for no more generations than it has done."""
    if asked > done or not done:
        return []
    cell = book.source.names.get("Generations")
    where = "--generations" if options.generations is not None or cell is None else cell.where
    hint = "no generation was added; give --generations a larger number to go on"
    return [Problem(where, f"{asked:,} generations", f"more than the {done:,} done", hint)]


def _gaps(state: State) -> list[Problem]:
    """Warn where the workbook could not list the whole history of its run."""
    if state.complete_from == 1:
        return []
    found = f"the changes from generation {state.complete_from:,} on"
    hint = "the workbook has no room for the earlier ones, so a --history file begins there, too"
    return [Problem(layout.HISTORY, found, "those from generation 1 on", hint)]
