"""How ``front`` finds the trade-offs of a file, and writes them into a workbook."""

import time
from dataclasses import dataclass, replace
from pathlib import Path

from grasp_xl.commands.keeping import held_run, replaced
from grasp_xl.commands.output import Output, macros_at, now, written_book
from grasp_xl.commands.preparing import prepare, refuse_infeasible
from grasp_xl.rounding import percent
from grasp_xl.search.front import CLOSE, Front, OnFront, find_front
from grasp_xl.search.stop import Interrupt
from grasp_xl.search.warm import load_exact_search
from grasp_xl.task import Parameters, Task
from grasp_xl.workbook.book import read_book
from grasp_xl.workbook.saving import check_target, save
from grasp_xl.workbook.trade_offs_sheet import TradeOff, TradeOffs


@dataclass(frozen=True, eq=False, slots=True)
class FoundFront:
    """What ``front`` found.

    Parameters
    ----------
    task : Task
    front : Front
    seconds : float
        All that it took, with reading and writing.
    time_limit_s : float
    interrupted : bool
    """

    task: Task
    front: Front
    seconds: float
    time_limit_s: float
    interrupted: bool

    @property
    def told(self) -> str:
        """A sentence on what is proved."""
        front = self.front
        proved = sum(design.proved for design in front.designs)
        told = (
            f"{front.proved_sums} of {front.sums} weighted sums minimised to {percent(CLOSE)} "
            f"with proof, {proved} of {len(front.designs)} designs proved"
        )
        if front.complete:
            return f"{told} ({front.seconds:.2f} s)."
        why = "interrupted" if self.interrupted else "stopped at the time limit"
        return f"{told}; {why} ({front.seconds:.2f} s)."


def front_file(
    path: Path,
    options: Parameters,
    output: Output | None,
    *,
    grid: int,
    time_limit_s: float,
    interrupt: Interrupt,
    on_progress: OnFront | None = None,
) -> FoundFront:
    """Find the trade-off front of a file, and write the workbook if one is wanted.

    Parameters
    ----------
    path, options
    output : Output or None
    grid : int
        Divisions of the weights.
    time_limit_s : float
        Longest search.
    interrupt : Interrupt
        Once asked, it ends the search with what is proved by then.
    on_progress : callable, optional

    Raises
    ------
    InfeasibleError
        If no grasp meets FoS and clearance.
    """
    clock, began = time.perf_counter(), now()
    if output:
        check_target(output.path, path, in_place=False, force=output.force)
    lost = replaced(output) if output else []
    book = read_book(path)
    task = prepare(book, options, stop=interrupt.is_asked).warned(lost)
    refuse_infeasible(task, interrupt.is_asked)
    load_exact_search()
    front = find_front(
        task.space,
        task.rules,
        task.settings,
        task.benchmark.chromosome,
        grid=grid,
        seconds=time_limit_s,
        stop=interrupt.is_asked,
        on_progress=on_progress,
    )
    found = FoundFront(task, front, 0.0, time_limit_s, interrupt.asked)
    if output:
        result, proved = held_run(book, task)
        written = written_book(
            task,
            result,
            book,
            began,
            proved=proved,
            trade_offs=listed(found),
            macros=macros_at(output.path, book),
        )
        save(written.content, output.path)
    return replace(found, seconds=time.perf_counter() - clock)


def listed(found: FoundFront) -> TradeOffs:
    """Return the front as a sheet lists it."""
    designs = (
        TradeOff(number, design.grasp.chromosome, design.proved, design.weights)
        for number, design in enumerate(found.front.designs, 1)
    )
    return TradeOffs(tuple(designs), found.told)
