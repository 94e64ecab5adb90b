"""What each command does, from files to results; ``cli.py`` only speaks with the person."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from datetime import datetime
from pathlib import Path

from grasp_xl.chromosome import Chromosome, from_active, index_faults
from grasp_xl.errors import InputError, Problem, UsageError
from grasp_xl.grasp import Grasp, evaluate
from grasp_xl.rules import Requirements, Terms
from grasp_xl.search.feasibility import any_feasible, max_fos
from grasp_xl.search.floors import floors, search_space
from grasp_xl.search.genetic import OnProgress, search
from grasp_xl.search.result import Result
from grasp_xl.search.stop import Generations, StopRule
from grasp_xl.space import OptionSpace
from grasp_xl.task import Parameters, Task, settle
from grasp_xl.workbook import layout
from grasp_xl.workbook.book import Book, read_book
from grasp_xl.workbook.carrying import carried, is_usable
from grasp_xl.workbook.run_log import Origin
from grasp_xl.workbook.saving import check_target, refuse_losses, save
from grasp_xl.workbook.writing import full_workbook

Active = Sequence[Sequence[int] | None]
"""Indices of a grasp given by options, a list a kind; None where an option was not given."""


@dataclass(frozen=True, slots=True)
class Output:
    """Where a workbook goes, and what may be overwritten for it."""

    path: Path
    in_place: bool = False
    force: bool = False


@dataclass(frozen=True, eq=False, slots=True)
class Checked:
    """What ``check`` says of a readable file."""

    space: OptionSpace
    warnings: tuple[Problem, ...]
    search_space: int
    max_fos: float
    floors: Terms


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
    InfeasibleError
        If no grasp meets FoS and clearance.
    """
    book = read_book(path)
    space = book.space
    known = options.over(book.parameters)
    need = Requirements()
    need = Requirements(
        fos=known.fos or need.fos,
        clearance_mm=known.clearance_mm or space.largest_diameter_mm or need.clearance_mm,
        density_ratio=need.density_ratio if known.density_ratio is None else known.density_ratio,
        moment_arm=known.moment_arm or need.moment_arm,
    )
    any_feasible(space, need)
    return Checked(space, book.warnings, search_space(space), max_fos(space), floors(space, need))


def evaluate_grasp(path: Path, options: Parameters, grasp: Active) -> tuple[Task, Grasp]:
    """Judge one grasp; the user-defined one where options name none."""
    book = read_book(path)
    task = prepare(book, options)
    given = given_grasp(book.space, grasp)
    return task, evaluate(task.space, task.rules, given) if given else task.benchmark


def new(path: Path, options: Parameters, output: Output, grasp: Active = (None, None)) -> Task:
    """Make the full workbook from an exported sheet, ready for a designer.

    Where the output is a workbook already, its parameters and typed chromosomes stay, and every
    index that is stale now is among the task's warnings.
    """
    began = datetime.now()  # noqa: DTZ005 (a workbook shows local time)
    previous = _previous(output.path, path)
    check_target(output.path, path, in_place=previous is not None, force=output.force)
    book = read_book(path)
    stale: list[Problem] = []
    if previous:
        book, stale = _taken_over(book, previous)
    usable = book.user_chromosome and is_usable(book.user_chromosome, book.space)
    task = prepare(book if usable else replace(book, user_chromosome=None), options, grasp)
    task = replace(task, warnings=(*task.warnings, *stale))
    result = search(
        task.space, task.rules, task.settings, task.benchmark.chromosome, [Generations(0)]
    )
    _write(task, result, book, output, began, previous=previous)
    return task


def _previous(output: Path, path: Path) -> Book | None:
    """Return the workbook that stands where the new one goes, if it is one with parameters."""
    if not output.exists() or output.samefile(path):
        return None
    try:
        previous = read_book(output)
    except InputError:  # not one of ours: check_target() then asks for --force
        return None
    return previous if previous.parameters != Parameters() else None


def _taken_over(book: Book, previous: Book) -> tuple[Book, list[Problem]]:
    """Return a new export's book with what the designer typed into the previous workbook."""
    stale: list[Problem] = []
    typed: list[Chromosome | None] = []
    for chromosome, block in (
        (previous.user_chromosome, layout.USER_BLOCK),
        (previous.what_if, layout.WHAT_IF),
    ):
        if chromosome is None:
            typed.append(None)
            continue
        genes, faults = carried(chromosome, previous.space, book.space, block.label)
        typed.append(genes)
        stale += faults
    user, what_if = typed
    if what_if and not is_usable(what_if, book.space):
        what_if = None
    return (
        replace(book, parameters=previous.parameters, user_chromosome=user, what_if=what_if),
        stale,
    )


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
    clock, began = time.perf_counter(), datetime.now()  # noqa: DTZ005 (local time is shown)
    check_target(output.path, path, in_place=output.in_place, force=output.force)
    book = read_book(path)
    task = prepare(book, options, grasp)
    state = None
    if go_on:
        saved = book.saved_run()
        if saved.inputs_hash != task.inputs_hash:
            raise InputError(
                [
                    Problem(
                        book.source.package.name,
                        "other inputs or parameters than those of its run",
                        "the same, to go on from it",
                        "undo the changes, or run it without --continue",
                    )
                ]
            )
        state = saved.state
    result = search(
        task.space,
        task.rules,
        task.settings,
        task.benchmark.chromosome,
        stop(task),
        state=state,
        on_progress=on_progress,
    )
    _write(task, result, book, output, began, previous=book if output.in_place else None)
    return task, result, time.perf_counter() - clock


def _write(
    task: Task,
    result: Result,
    book: Book,
    output: Output,
    began: datetime,
    *,
    previous: Book | None,
) -> None:
    source = book.source.package
    origin = Origin(Path(source.name).name, source.sha256, began, datetime.now())  # noqa: DTZ005
    user = book.user_chromosome
    stale_user = user if user and not is_usable(user, task.space) else None
    content, filled = full_workbook(
        task, result, origin, what_if=book.what_if, stale_user=stale_user
    )
    if previous:
        refuse_losses(output.path, previous.source, content, filled, force=output.force)
    save(content, output.path)


def write_history(result: Result, path: Path) -> None:
    """Write every change of the fittest to a CSV file.

    Raises
    ------
    OutputError
        If that fails.
    """
    save(result.history().to_csv(index=False).encode(), path)
