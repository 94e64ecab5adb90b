"""From a workbook and options to a task that is settled."""

from collections.abc import Sequence
from dataclasses import replace

from grasp_xl.chromosome import Chromosome, from_active, index_faults
from grasp_xl.errors import InfeasibleError, UsageError
from grasp_xl.rules import Terms
from grasp_xl.search.obstacles import any_feasible
from grasp_xl.search.stop import Stop, never
from grasp_xl.search.unmet_goals import floor_warnings
from grasp_xl.space import OptionSpace
from grasp_xl.task import Parameters, Task, settle
from grasp_xl.workbook.book import Book

Active = Sequence[Sequence[int] | None]
"""Indices of a grasp given by options, a list a kind; None where an option was not given."""


def prepare(
    book: Book, options: Parameters, grasp: Active = (None, None), stop: Stop = never
) -> Task:
    """Settle the task of a workbook: options beat what it says.

    Parameters
    ----------
    book, options, grasp
    stop : callable
        True ends the search for a benchmark.

    Raises
    ------
    UsageError
        If the grasp given by options does not exist.
    InfeasibleError
        If no grasp can serve as the benchmark.
    """
    given = given_grasp(book.space, grasp)
    user = given or book.user_chromosome
    task = settle(book.space, options.over(book.parameters), user, book.assigned, stop)
    return replace(task, warnings=(*book.warnings, *task.warnings))


def prepare_to_judge(book: Book, options: Parameters, given: Chromosome | None) -> Task:
    """Settle the task of a workbook in which a grasp is only looked at.

    Where no grasp can serve as the benchmark, the one that is looked at is measured by itself.

    Raises
    ------
    InfeasibleError
        If there is no such grasp either.
    """
    try:
        return prepare(book, options)
    except InfeasibleError:
        if given is None:
            raise
        return prepare(book, options, given.active)


def refuse_infeasible(task: Task, stop: Stop = never) -> None:
    """Refuse a task that no grasp can fulfil, before any search.

    Raises
    ------
    InfeasibleError
        If no grasp meets FoS and clearance.
    """
    if not task.benchmark.feasible:
        any_feasible(task.space, task.rules.requirements, stop=stop)


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


def with_floor_warnings(task: Task, least: Terms) -> Task:
    """Warn of goals that lie below what any grasp can have."""
    return task.warned(floor_warnings(task.rules, least))
