"""How ``solve`` and ``run`` find the best grasp of all, and prove it."""

import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from grasp_xl.commands.keeping import held_run, kept_trade_offs, replaced
from grasp_xl.commands.output import Output, macros_at, now, written_book
from grasp_xl.commands.preparing import prepare, with_floor_warnings
from grasp_xl.errors import InfeasibleError, Problem
from grasp_xl.search.exact import Ending, ExactSettings, OnBound, Proof
from grasp_xl.search.exact import solve as prove
from grasp_xl.search.floors import floors
from grasp_xl.search.obstacles import any_feasible
from grasp_xl.search.proven_floors import ProvenFloors, proven_floors
from grasp_xl.search.result import Result
from grasp_xl.search.stop import Interrupt, Stop
from grasp_xl.search.unmet_goals import why_none_meets_all
from grasp_xl.search.warm import load_exact_search
from grasp_xl.task import Parameters, Task
from grasp_xl.workbook.book import Book, read_book
from grasp_xl.workbook.proved import Proved, among
from grasp_xl.workbook.saving import check_target, save

ENDINGS: dict[Ending, str] = {
    "proved": "all is proved",
    "asked": "interrupted",
    "time": "stopped at the time limit",
    "gap": "stopped at the gap asked for",
    "memory": "stopped as the memory for open branches is full",
}

FLOOR_SECONDS = 5.0
"""Longest search of ``solve`` for the floors, after the search for the best grasp."""


@dataclass(frozen=True, eq=False, slots=True)
class Solved:
    """What the exact search of a task found and proved.

    Parameters
    ----------
    task : Task
    settings : ExactSettings
    proof : Proof
    floors : ProvenFloors or None
        None where no grasp is possible.
    seconds : float
        All that it took, with reading and floors.
    interrupted : bool
    obstacle : InfeasibleError or None
        Why there is no grasp, where that is proved.
    output : Path or None
        Workbook that was written.
    """

    task: Task
    settings: ExactSettings
    proof: Proof
    floors: ProvenFloors | None
    seconds: float
    interrupted: bool
    obstacle: InfeasibleError | None = None
    output: Path | None = None

    @property
    def ended(self) -> str:
        """Why the search ended, in words."""
        return ENDINGS[self.proof.ending]

    @property
    def shown(self) -> Proved:
        """What the workbook shows of it: its best design alone."""
        proof = self.proof
        status = "optimal" if proof.is_best_proved else proof.status
        proof = replace(proof, status=status, designs=proof.designs[:1])
        return Proved(proof, among(self.settings), self.ended)


def solve_file(
    path: Path,
    options: Parameters,
    settings: ExactSettings,
    *,
    output: Output | None = None,
    interrupt: Interrupt | None = None,
    on_progress: OnBound | None = None,
) -> Solved:
    """Find the best grasps of a file, with proof, and the floors of its criteria.

    The workbook also shows the run that the file holds, if its inputs are the same.

    Parameters
    ----------
    path, options
    settings : ExactSettings
        The time limit is that of the search and of the floors together.
    output : Output, optional
        Workbook to write where there is no obstacle.
    interrupt : Interrupt, optional
        Once asked, it ends all searches with what is proved by then.
    on_progress : callable, optional

    Raises
    ------
    InfeasibleError
        If no grasp can serve as the benchmark.
    """
    clock, started = time.perf_counter(), now()
    if output:
        check_target(output.path, path, in_place=False, force=output.force)
    lost = replaced(output) if output else []
    book = read_book(path)
    solved = solve_book(
        book,
        options,
        settings,
        interrupt or Interrupt(),
        warnings=lost,
        on_progress=on_progress,
        clock=clock,
    )
    if output is None or solved.obstacle:
        return solved
    trade_offs, stale = kept_trade_offs(book, solved.task)
    task = solved.task.warned(stale)
    result, _ = held_run(book, task)
    written = written_book(
        task,
        result,
        book,
        started,
        proved=solved.shown,
        trade_offs=trade_offs,
        macros=macros_at(output.path, book),
    )
    save(written.content, output.path)
    return replace(solved, task=task, output=output.path)


def solve_book(
    book: Book,
    options: Parameters,
    settings: ExactSettings,
    ask: Interrupt,
    *,
    warnings: Sequence[Problem] = (),
    on_progress: OnBound | None = None,
    clock: float | None = None,
) -> Solved:
    """Find the best grasps of a workbook, with proof, and the floors of its criteria.

    Parameters
    ----------
    book, options, settings, on_progress
        As in :func:`solve_file`.
    ask : Interrupt
    warnings : sequence of Problem
        Of the task.
    clock : float, optional
        When the work began, on ``time.perf_counter``.

    Raises
    ------
    InfeasibleError
        If no grasp can serve as the benchmark.
    """
    clock = time.perf_counter() if clock is None else clock
    load_exact_search()
    began = time.perf_counter()

    def left() -> float:
        return settings.time_limit_s - (time.perf_counter() - began)

    def stop() -> bool:
        return ask.asked or left() <= 0

    task = prepare(book, options, stop=stop).warned(warnings)
    space, rules = task.space, task.rules
    known = [task.benchmark.chromosome] if task.benchmark.feasible else []
    limited = replace(settings, time_limit_s=max(0.0, left()))
    proof = prove(space, rules, limited, known=known, stop=ask.is_asked, on_progress=on_progress)
    obstacle = _obstacle(task, settings, stop) if proof.status == "infeasible" else None
    least = None
    if obstacle is None:
        known += [grasp.chromosome for grasp in proof.designs]
        seconds = min(FLOOR_SECONDS, left())
        least = proven_floors(space, rules, seconds=seconds, known=known, stop=stop)
        task = with_floor_warnings(task, least.least)
        if proof.status == "infeasible":
            obstacle = why_none_meets_all(space, rules, least.least, settings.min_elements, stop)
    seconds = time.perf_counter() - clock
    return Solved(task, settings, proof, least, seconds, ask.asked, obstacle)


def prove_run(
    task: Task,
    result: Result,
    output: Path | None,
    time_limit_s: float,
    *,
    interrupt: Interrupt | None = None,
    on_progress: OnBound | None = None,
) -> Solved:
    """Prove how good the best grasp of a genetic run is, and find the best of all.

    Its floors are those that need no search.

    Parameters
    ----------
    task, result
    output : Path, optional
        Workbook that will show it.
    time_limit_s : float
    interrupt : Interrupt, optional
        Once asked, it ends the search with what is proved by then.
    on_progress : callable, optional
    """
    clock = time.perf_counter()
    ask = interrupt or Interrupt()
    load_exact_search()
    settings = ExactSettings(time_limit_s)
    known = [
        grasp.chromosome for grasp in (result.best, task.benchmark) if grasp and grasp.feasible
    ]
    proof = prove(
        task.space,
        task.rules,
        settings,
        known=known,
        stop=ask.is_asked,
        on_progress=on_progress,
    )
    least = ProvenFloors(floors(task.space, task.rules.requirements), frozenset())
    seconds = time.perf_counter() - clock
    return Solved(task, settings, proof, least, seconds, ask.asked, output=output)


def _obstacle(task: Task, settings: ExactSettings, stop: Stop) -> InfeasibleError | None:
    """Return why no grasp meets the constraints; None where only the goals are in the way."""
    try:
        any_feasible(task.space, task.rules.requirements, settings.min_elements, stop)
    except InfeasibleError as error:
        return error
    return None
