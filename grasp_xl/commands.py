"""What each command does, from files to results; ``cli.py`` only speaks with the person."""

from __future__ import annotations

import re
import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from datetime import datetime
from pathlib import Path

import numpy as np

from grasp_xl.chromosome import Chromosome, from_active, index_faults
from grasp_xl.errors import InfeasibleError, InputError, Problem, UsageError
from grasp_xl.grasp import Grasp, evaluate
from grasp_xl.rules import Terms
from grasp_xl.search.exact import ExactSettings, OnBound, Proof
from grasp_xl.search.exact import solve as prove
from grasp_xl.search.feasibility import lifting_counts, max_fos
from grasp_xl.search.floors import floors, search_space
from grasp_xl.search.genetic import OnProgress, search
from grasp_xl.search.mutation import random_chromosome
from grasp_xl.search.obstacles import any_feasible
from grasp_xl.search.proven_floors import proven_floors
from grasp_xl.search.result import Result, State
from grasp_xl.search.stop import Generations, Interrupt, StopRule
from grasp_xl.search.unmet_goals import floor_warnings, why_none_meets_all
from grasp_xl.search.warm import load_exact_search
from grasp_xl.space import ElementKind, OptionSpace
from grasp_xl.task import Parameters, Task, settle, settle_requirements
from grasp_xl.workbook import layout
from grasp_xl.workbook.book import Book, read_book, read_previous
from grasp_xl.workbook.carrying import carried, is_usable
from grasp_xl.workbook.cells import Source
from grasp_xl.workbook.losses import Written, filled_cells, refuse_losses
from grasp_xl.workbook.package import Package
from grasp_xl.workbook.reading_run import (
    SavedRun,
    largest_listed,
    refuse_other_inputs,
    written_children,
)
from grasp_xl.workbook.run_log import Origin
from grasp_xl.workbook.saving import (
    check_place,
    check_target,
    refuse_edited,
    save,
)
from grasp_xl.workbook.writing import Filled, export_workbook, full_workbook

FLOOR_SECONDS = 5.0
"""Longest search of ``solve`` for the floors, after the search for the best grasp."""

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


@dataclass(frozen=True, eq=False, slots=True)
class Solved:
    """What ``solve`` found and proved.

    Parameters
    ----------
    task : Task
    settings : ExactSettings
    proof : Proof
    floors : Terms or None
        Least value of each criterion alone, as far as proved; None where no grasp is possible.
    seconds : float
        All that it took, with reading and floors.
    interrupted : bool
    obstacle : InfeasibleError or None
        Why there is no grasp, where that is proved.
    """

    task: Task
    settings: ExactSettings
    proof: Proof
    floors: Terms | None
    seconds: float
    interrupted: bool
    obstacle: InfeasibleError | None = None


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
    need = settle_requirements(space, options.over(book.parameters))
    least = floors(space, need) if lifting_counts(space, need) else None
    try:
        task = prepare(book, options)
        refuse_infeasible(task)
        warnings = (_with_floor_warnings(task, least) if least else task).warnings
    except InfeasibleError as error:
        obstacle = error
    return Checked(space, warnings, search_space(space), max_fos(space), least, obstacle)


def _with_floor_warnings(task: Task, least: Terms) -> Task:
    return replace(task, warnings=(*task.warnings, *floor_warnings(task.rules, least)))


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
        (previous.what_if or previous.picked, layout.WHAT_IF),
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
    task = _with_floor_warnings(task, floors(task.space, task.rules.requirements))
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


# --- solve ---


def solve(
    path: Path,
    options: Parameters,
    settings: ExactSettings,
    *,
    interrupt: Interrupt | None = None,
    on_progress: OnBound | None = None,
) -> Solved:
    """Find the best grasps of a file, with proof, and the floors of its criteria.

    Parameters
    ----------
    path, options
    settings : ExactSettings
        The time limit is that of the search and of the floors together.
    interrupt : Interrupt, optional
        Once asked, it ends all searches with what is proved by then.
    on_progress : callable, optional

    Raises
    ------
    InfeasibleError
        If no grasp can serve as the benchmark.
    """
    clock = time.perf_counter()
    ask = interrupt or Interrupt()
    task = prepare(read_book(path), options)
    space, rules = task.space, task.rules
    known = [task.benchmark.chromosome] if task.benchmark.feasible else []
    load_exact_search()

    def stop() -> bool:
        return ask.asked

    began = time.perf_counter()
    proof = prove(space, rules, settings, known=known, stop=stop, on_progress=on_progress)
    obstacle = _obstacle(task, settings) if proof.status == "infeasible" else None
    least = None
    if obstacle is None:
        left = settings.time_limit_s - (time.perf_counter() - began)
        known += [grasp.chromosome for grasp in proof.designs]
        seconds = min(FLOOR_SECONDS, left)
        least = proven_floors(space, rules, seconds=seconds, known=known, stop=stop)
        task = _with_floor_warnings(task, least)
        if proof.status == "infeasible":
            obstacle = why_none_meets_all(space, rules, least, settings.min_elements, stop)
    return Solved(task, settings, proof, least, time.perf_counter() - clock, ask.asked, obstacle)


def _obstacle(task: Task, settings: ExactSettings) -> InfeasibleError | None:
    """Return why no grasp meets the constraints; None where only the goals are in the way."""
    try:
        any_feasible(task.space, task.rules.requirements, settings.min_elements)
    except InfeasibleError as error:
        return error
    return None


# --- writing ---


def _refuse_losses(output: Output, previous: Book) -> None:
    """Refuse to replace a workbook that holds something which is not ours, before any search."""
    if not (output.force or previous.is_untouched):
        refuse_losses(output.path, previous.source, _as_written(previous))


def _as_written(book: Book) -> Written:
    """Write a workbook again as it was, with its own cards and results, to know what is ours."""
    if layout.USER_BLOCK.name not in book.source.names:  # an export
        content = export_workbook(book.space)
        cells = filled_cells(Source(Package("export", content)), layout.OPTION_SPACE)
        return Written(content, {layout.OPTION_SPACE: cells}, same_inputs=False)
    task = _task_of_its_run(book)
    same_inputs = task is not None
    was = replace(book, what_if=None) if task else _of_its_sizes(book)
    if task is None:
        any_grasp = random_chromosome(was.space, np.random.default_rng(0))
        task = settle(was.space, was.parameters, any_grasp)
    shown = was.shown_run()
    result = _not_begun(task, shown.state if shown else None)
    if shown:
        children = written_children(book.source, task.space) or shown.children
        result = replace(result, matrix=shown.matrix, children=children)
    return Written(*_full_workbook(task, result, was, _now()), same_inputs)


def _task_of_its_run(book: Book) -> Task | None:
    """Return the task of the run that a workbook holds; None if inputs or lists changed since."""
    user = book.user_chromosome
    if user is None or is_usable(user, book.space):
        with suppress(InfeasibleError, InputError):
            task = settle(book.space, book.parameters, user)
            _saved_run(book, task)
            return task
    return None


def _of_its_sizes(book: Book) -> Book:
    """Return a book with the sizes of its cards and lists, whatever sizes it asks for now."""
    names = book.source.names
    children = sum(re.fullmatch(r"Child\d+", name) is not None for name in names)
    slots = names[layout.USER_BLOCK.name].columns - 1
    kinds = (
        replace(
            _with_places(kind, largest_listed(book.source, kind.name)),
            count_min=min(kind.count_min, slots),
            count_max=slots,
        )
        for kind in book.space.kinds
    )
    return replace(
        book,
        space=replace(book.space, kinds=tuple(kinds)),
        parameters=replace(book.parameters, children=max(2, children)),
        user_chromosome=None,
        what_if=None,
        picked=None,
    )


def _with_places(kind: ElementKind, number: int) -> ElementKind:
    """Return a kind with so many places at least, as it had when its lists were written."""
    gone = np.zeros((max(0, number - kind.total), 3))
    overlap = kind.overlap
    if overlap is not None:
        overlap = np.concatenate([overlap, np.full(len(gone), np.nan)])
    footprints = np.vstack([kind.footprints_mm, gone])
    return replace(kind, footprints_mm=footprints, overlap=overlap)


def _full_workbook(task: Task, result: Result, book: Book, began: datetime) -> tuple[bytes, Filled]:
    source = book.source.package
    name = Path(source.name).name.encode(errors="backslashreplace").decode()
    user = book.user_chromosome
    return full_workbook(
        task,
        result,
        Origin(name, source.sha256, began, _now()),
        what_if=book.what_if,
        picked=book.picked,
        stale_user=user if user and not is_usable(user, task.space) else None,
    )


def _now() -> datetime:
    return datetime.now()  # noqa: DTZ005 (a workbook shows local time)
