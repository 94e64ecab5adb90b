"""What each command does, from files to results; ``cli.py`` only speaks with the person."""

from __future__ import annotations

import re
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from datetime import datetime
from pathlib import Path

import numpy as np

from grasp_xl.chromosome import Chromosome, from_active, index_faults
from grasp_xl.errors import InfeasibleError, InputError, Problem, UsageError
from grasp_xl.grasp import Grasp, evaluate
from grasp_xl.rules import Terms
from grasp_xl.search.feasibility import any_feasible, lifting_counts, max_fos
from grasp_xl.search.floors import floors, search_space
from grasp_xl.search.genetic import OnProgress, search
from grasp_xl.search.mutation import random_chromosome
from grasp_xl.search.result import Result, State
from grasp_xl.search.stop import Generations, StopRule
from grasp_xl.space import OptionSpace
from grasp_xl.task import Parameters, Task, settle, settle_requirements
from grasp_xl.workbook import layout
from grasp_xl.workbook.book import Book, read_book, read_previous
from grasp_xl.workbook.carrying import carried, is_usable
from grasp_xl.workbook.cells import Source
from grasp_xl.workbook.package import Package
from grasp_xl.workbook.reading_run import SavedRun, refuse_other_inputs
from grasp_xl.workbook.run_log import Origin
from grasp_xl.workbook.saving import (
    check_place,
    check_target,
    filled_cells,
    refuse_edited,
    refuse_losses,
    save,
)
from grasp_xl.workbook.writing import Filled, export_workbook, full_workbook

Active = Sequence[Sequence[int] | None]
"""Indices of a grasp given by options, a list a kind; None where an option was not given."""


@dataclass(frozen=True, slots=True)
class Output:
    """Where results go, and what may be overwritten for them.

    Parameters
    ----------
    path : Path
        Workbook.
    in_place : bool
        Whether it is the input.
    force : bool
        Overwrite what was edited, lose what cannot be carried over.
    history : Path, optional
        CSV file with every change of the fittest.
    """

    path: Path
    in_place: bool = False
    force: bool = False
    history: Path | None = None


@dataclass(frozen=True, eq=False, slots=True)
class Checked:
    """What ``check`` says of a readable file.

    Parameters
    ----------
    space, warnings, search_space, max_fos
    floors : Terms or None
        None where no counts meet FoS.
    obstacle : InfeasibleError or None
        Why no grasp meets FoS and clearance.
    """

    space: OptionSpace
    warnings: tuple[Problem, ...]
    search_space: int
    max_fos: float
    floors: Terms | None
    obstacle: InfeasibleError | None


def prepare(book: Book, options: Parameters, grasp: Active = (None, None)) -> Task:
    """Settle the task of a workbook: options beat what it says.

    Raises
    ------
    UsageError
        If the grasp given by options does not exist.
    InfeasibleError
        If no grasp can serve as the benchmark.
    """
    given = given_grasp(book.space, grasp)
    task = settle(book.space, options.over(book.parameters), given or book.user_chromosome)
    return replace(task, warnings=(*book.warnings, *task.warnings))


def refuse_infeasible(task: Task) -> None:
    """Refuse a task that no grasp can fulfil, before any search.

    Raises
    ------
    InfeasibleError
        If no grasp meets FoS and clearance.
    """
    if not task.benchmark.feasible:
        any_feasible(task.space, task.rules.requirements)


def given_grasp(space: OptionSpace, grasp: Active) -> Chromosome | None:
    """Return the grasp that options name; None where they name none.

    Raises
    ------
    UsageError
        If an index has no footprint, stands twice, or there are too many.
    """
    if all(indices is None for indices in grasp):
        return None
    active = [indices or () for indices in grasp]
    faults = index_faults(space, active)
    if faults:
        option = ("--cups", "--magnets")[faults[0][0]]
        raise UsageError(
            f"{option}: found {faults[0][1]}.",
            where=option,
            hint="Give 1-based indices of the option space, separated by commas",
        )
    return from_active(space, active)


def check(path: Path, options: Parameters) -> Checked:
    """Read and validate a file, and look whether any grasp can exist.

    Raises
    ------
    InputError
        With every problem found.
    """
    book = read_book(path)
    space, warnings, obstacle = book.space, book.warnings, None
    try:
        task = prepare(book, options)
        refuse_infeasible(task)
        warnings = task.warnings
    except InfeasibleError as error:
        obstacle = error
    need = settle_requirements(space, options.over(book.parameters))
    least = floors(space, need) if lifting_counts(space, need) else None
    return Checked(space, warnings, search_space(space), max_fos(space), least, obstacle)


def evaluate_grasp(path: Path, options: Parameters, grasp: Active) -> tuple[Task, Grasp]:
    """Judge one grasp; the user-defined one where options name none."""
    book = read_book(path)
    task = prepare(book, options)
    given = given_grasp(book.space, grasp)
    return task, evaluate(task.space, task.rules, given) if given else task.benchmark


# --- new ---


def new(path: Path, options: Parameters, output: Output, grasp: Active = (None, None)) -> Task:
    """Make the full workbook from an exported sheet, ready for a designer.

    Where the output is a workbook already, its parameters and typed chromosomes stay, and all that
    is stale in them now is among the task's warnings.
    """
    began = _now()
    check_target(output.path, path, in_place=False, force=output.force)
    book = read_book(path)
    previous = _previous(output)
    stale: list[Problem] = []
    if previous:
        book, stale = _taken_over(book, previous)
    else:
        refuse_edited(output.path, force=output.force)
    usable = book.user_chromosome and is_usable(book.user_chromosome, book.space)
    task = prepare(book if usable else replace(book, user_chromosome=None), options, grasp)
    task = replace(task, warnings=(*task.warnings, *stale))
    if previous:
        _refuse_losses(output, previous)
    save(_full_workbook(task, _not_begun(task), book, began)[0], output.path)
    return task


def _previous(output: Output) -> Book | None:
    """Return the workbook that stands where the new one goes, if it is a full one."""
    try:
        return read_previous(output.path)
    except InputError as error:
        if output.force:
            return None
        name = output.path.name
        hint = "mend it, name another file with -o, or add --force to replace this one"
        problems = [replace(p, where=f"{name}, {p.where}", hint=hint) for p in error.problems]
        raise InputError(problems) from error


def _taken_over(book: Book, previous: Book) -> tuple[Book, list[Problem]]:
    """Return a new export's book with what the designer typed into the previous workbook."""
    stale: list[Problem] = []
    typed: list[Chromosome | None] = []
    for chromosome, block in (
        (previous.user_chromosome, layout.USER_BLOCK),
        (previous.what_if, layout.WHAT_IF),
    ):
        genes = None
        if chromosome:
            genes, faults = carried(chromosome, previous.space, book.space, block.label)
            stale += faults
        typed.append(genes)
    user, what_if = typed
    if what_if and not is_usable(what_if, book.space):
        what_if = None
    taken = replace(book, parameters=previous.parameters, user_chromosome=user, what_if=what_if)
    return taken, stale


def _not_begun(task: Task, state: State | None = None) -> Result:
    """Return the result of no generation at all, or of none after a state."""
    stop = [Generations(0)]
    benchmark = task.benchmark.chromosome
    return search(task.space, task.rules, task.settings, benchmark, stop, state=state)


# --- run ---


def run(
    path: Path,
    options: Parameters,
    output: Output,
    *,
    grasp: Active = (None, None),
    stop: Callable[[Task], Sequence[StopRule]],
    go_on: bool = False,
    on_progress: OnProgress | None = None,
) -> tuple[Task, Result, float]:
    """Run the genetic search on a file and write the workbook.

    Parameters
    ----------
    path, options, output
    grasp : Active
        The user-defined grasp, where options name it.
    stop : callable
        Makes the stop rules of a settled task, when the search begins.
    go_on : bool
        Go on from the run that the workbook holds.
    on_progress : callable, optional

    Returns
    -------
    Task, Result, float
        And the seconds that all took.
    """
    clock, began = time.perf_counter(), _now()
    check_target(output.path, path, in_place=output.in_place, force=output.force)
    if not output.in_place:
        refuse_edited(output.path, force=output.force)
    if output.history:
        check_place(output.history, ".csv", force=output.force, option="--history")
    book = read_book(path)
    task = prepare(book, options, grasp)
    saved = _saved_run(book, task) if go_on else None
    task = replace(task, warnings=(*task.warnings, *(_gaps(saved.state) if saved else ())))
    refuse_infeasible(task)
    if output.in_place:
        _refuse_losses(output, book)
    result = search(
        task.space,
        task.rules,
        task.settings,
        task.benchmark.chromosome,
        stop(task),
        state=saved.state if saved else None,
        on_progress=on_progress,
    )
    if saved and result.state.generation == saved.state.generation:
        result = replace(result, matrix=saved.matrix, children=saved.children)
    save(_full_workbook(task, result, book, began)[0], output.path)
    if output.history:
        save(result.history().to_csv(index=False).encode(), output.history)
    return task, result, time.perf_counter() - clock


def _gaps(state: State) -> list[Problem]:
    """Warn where the workbook could not list the whole history of its run."""
    if state.complete_from == 1:
        return []
    found = f"the changes from generation {state.complete_from:,} on"
    hint = "the workbook has no room for the earlier ones, so a --history file begins there, too"
    return [Problem(layout.HISTORY, found, "those from generation 1 on", hint)]


def _saved_run(book: Book, task: Task) -> SavedRun:
    refuse_other_inputs(book.source, task)
    return book.saved_run()


# --- writing ---


def _refuse_losses(output: Output, previous: Book) -> None:
    """Refuse to replace a workbook that holds something which is not ours, before any search."""
    if not (output.force or previous.is_untouched):
        content, ours = _as_written(previous)
        refuse_losses(output.path, previous.source, content, ours)


def _as_written(book: Book) -> tuple[bytes, Filled]:
    """Write a workbook again as it was, with its own cards and results, to know our cells."""
    names = book.source.names
    genes = names.get(layout.USER_BLOCK.name)
    if genes is None:  # an export
        content = export_workbook(book.space)
        cells = filled_cells(Source(Package("export", content)), layout.OPTION_SPACE)
        return content, {layout.OPTION_SPACE: cells}
    children = sum(re.fullmatch(r"Child\d+", name) is not None for name in names)
    slots = genes.columns - 1
    kinds = (
        replace(kind, count_min=min(kind.count_min, slots), count_max=slots)
        for kind in book.space.kinds
    )
    was = replace(
        book,
        space=replace(book.space, kinds=tuple(kinds)),
        parameters=replace(book.parameters, children=max(2, children)),
        user_chromosome=None,
        what_if=None,
    )
    any_grasp = random_chromosome(was.space, np.random.default_rng(0))
    task = settle(was.space, was.parameters, any_grasp)
    shown = was.shown_run()
    result = _not_begun(task, shown.state if shown else None)
    return _full_workbook(task, result, was, _now())


def _full_workbook(task: Task, result: Result, book: Book, began: datetime) -> tuple[bytes, Filled]:
    source = book.source.package
    name = Path(source.name).name.encode(errors="backslashreplace").decode()
    user = book.user_chromosome
    return full_workbook(
        task,
        result,
        Origin(name, source.sha256, began, _now()),
        what_if=book.what_if,
        stale_user=user if user and not is_usable(user, task.space) else None,
    )


def _now() -> datetime:
    return datetime.now()  # noqa: DTZ005 (a workbook shows local time)
