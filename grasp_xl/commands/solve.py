"""How ``solve`` finds the best grasp of all, and proves it."""

import time
from dataclasses import dataclass
from pathlib import Path

from grasp_xl.commands.preparing import prepare, with_floor_warnings
from grasp_xl.errors import InfeasibleError
from grasp_xl.rules import Terms
from grasp_xl.search.exact import ExactSettings, OnBound, Proof
from grasp_xl.search.exact import solve as prove
from grasp_xl.search.obstacles import any_feasible
from grasp_xl.search.proven_floors import proven_floors
from grasp_xl.search.stop import Interrupt
from grasp_xl.search.unmet_goals import why_none_meets_all
from grasp_xl.search.warm import load_exact_search
from grasp_xl.task import Parameters, Task
from grasp_xl.workbook.book import read_book

FLOOR_SECONDS = 5.0
"""Longest search of ``solve`` for the floors, after the search for the best grasp."""


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


def solve_file(
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
        task = with_floor_warnings(task, least)
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
