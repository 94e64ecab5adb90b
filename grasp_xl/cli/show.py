"""What a person sees on the terminal: tables and progress."""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING

from rich.box import SIMPLE
from rich.progress import BarColumn, SpinnerColumn, TextColumn
from rich.progress import Progress as Bars
from rich.table import Table

from grasp_xl.cli.terminal import ERR, OUT, line
from grasp_xl.commands import sentences
from grasp_xl.compiled import is_compiled
from grasp_xl.grasp import Grasp
from grasp_xl.rounding import percent
from grasp_xl.rules import DIVERGENCE, TERMS, UNITS, Rules
from grasp_xl.search.stop import Progress

if TYPE_CHECKING:
    from grasp_xl.commands.check import Checked
    from grasp_xl.commands.excel import Buttons
    from grasp_xl.commands.front import FoundFront
    from grasp_xl.commands.run import Ran
    from grasp_xl.commands.solve import Solved
    from grasp_xl.search.proven_floors import ProvenFloors
    from grasp_xl.task import Task

REFRESH_SECONDS = 0.2


def compile_notice(
    *, quiet: bool, module: str = "", what: str = "search", seconds: int = 10
) -> None:
    """Say why the first run on a machine takes longer, where a module's code is not there yet."""
    with suppress(OSError):  # a cache that may not be read is no reason to fail
        if not quiet and not is_compiled(module):
            ERR.print(f"Compiling the {what} for this machine, once: about {seconds} seconds ...")


class SearchBar:
    """A progress bar of a search, once the search says how far it goes.

    Parameters
    ----------
    bars : rich.progress.Progress or None
        None shows nothing.
    """

    def __init__(self, bars: Bars | None) -> None:
        self._bars = bars
        self._limits: tuple[int, float] = (0, float("inf"))
        self._first: tuple[float, int] | None = None
        self._shown = 0.0

    def begin(self, generations: int, seconds: float | None) -> None:
        """Note where the search ends at the latest."""
        self._limits = (generations, float("inf") if seconds is None else seconds)

    def __call__(self, now: Progress) -> None:
        """Show how far the search is."""
        clock = time.perf_counter()
        if self._bars is None or clock - self._shown < REFRESH_SECONDS:
            return
        self._shown = clock
        if self._first is None:
            self._first = (clock, now.generation)
            self._bars.add_task("Searching", total=self._limits[0], completed=now.generation)
        seconds, done = clock - self._first[0], now.generation - self._first[1]
        self._bars.update(
            self._bars.task_ids[0],
            completed=now.generation,
            description=self._told(now, seconds, done),
            refresh=True,
        )

    def end(self) -> None:
        """Take the bar away, so that another can be shown."""
        if self._bars:
            self._bars.stop()

    def _told(self, now: Progress, seconds: float, done: int) -> str:
        told = f"Generation {now.generation:,}, best {now.best_value:.6g}"
        if not done:
            return told
        rate = done / seconds
        left = min((self._limits[0] - now.generation) / rate, self._limits[1] - seconds)
        return f"{told}, {rate:,.0f}/s, {max(0.0, left):,.0f} s left"


@contextmanager
def progress(*, quiet: bool) -> Iterator[SearchBar]:
    """Give a bar with generation, best value, rate and time left; it shows on a terminal only."""
    if quiet or not ERR.is_terminal:
        yield SearchBar(None)
        return
    columns = (BarColumn(), TextColumn("{task.description}", markup=False))
    with Bars(*columns, console=ERR, auto_refresh=False, transient=True) as bars:
        yield SearchBar(bars)


class ProofLine:
    """A line with bound, best value, gap and time of an exact search.

    Parameters
    ----------
    bars : rich.progress.Progress or None
        None shows nothing.
    """

    def __init__(self, bars: Bars | None) -> None:
        self._bars = bars
        self._began = self._shown = time.perf_counter()

    def __call__(self, bound: float, best: float | None) -> None:
        """Show how far the search is."""
        clock = time.perf_counter()
        if self._bars is None or clock - self._shown < REFRESH_SECONDS:
            return
        self._shown = clock
        if not self._bars.task_ids:
            self._bars.add_task("Proving", total=None)
        told = f"none below {bound:.6g}, "
        if best is not None:
            gap = percent((best - bound) / best if best > 0 else 0.0)
            told += f"best {best:.6g}, gap {gap}, "
        told += f"{clock - self._began:.0f} s"
        self._bars.update(self._bars.task_ids[0], description=told, refresh=True)


@contextmanager
def proof_progress(*, quiet: bool) -> Iterator[ProofLine]:
    """Give a line of an exact search; it shows on a terminal only."""
    with _spinner(quiet=quiet) as bars:
        yield ProofLine(bars)


@contextmanager
def _spinner(*, quiet: bool) -> Iterator[Bars | None]:
    if quiet or not ERR.is_terminal:
        yield None
        return
    columns = (SpinnerColumn(), TextColumn("{task.description}", markup=False))
    with Bars(*columns, console=ERR, auto_refresh=False, transient=True) as bars:
        yield bars


class FrontLine:
    """A line with what is proved of a trade-off front, and the time.

    Parameters
    ----------
    bars : rich.progress.Progress or None
        None shows nothing.
    """

    def __init__(self, bars: Bars | None) -> None:
        self._bars = bars
        self._began = time.perf_counter()

    def __call__(self, sums: int, all_sums: int, proved: int, designs: int) -> None:
        """Show how far the search is."""
        if self._bars is None:
            return
        if not self._bars.task_ids:
            self._bars.add_task("Proving", total=None)
        told = f"{sums} of {all_sums} weighted sums and {proved} of {designs} designs proved, "
        told += f"{time.perf_counter() - self._began:.0f} s"
        self._bars.update(self._bars.task_ids[0], description=told, refresh=True)


@contextmanager
def front_progress(*, quiet: bool) -> Iterator[FrontLine]:
    """Give a line of the search for a trade-off front; it shows on a terminal only."""
    with _spinner(quiet=quiet) as bars:
        yield FrontLine(bars)


def grasps(columns: Sequence[tuple[str, Grasp]], rules: Rules) -> None:
    """Print grasps side by side, a row a criterion, with the goals."""
    table = Table("", *(label for label, _ in columns), "Goal")
    shown = [grasp for _, grasp in columns]
    for number, name in enumerate(("suction", "magnets")):
        indices = (" ".join(map(str, grasp.chromosome.active[number])) or "-" for grasp in shown)
        table.add_row(name, *indices, "")
    table.add_row("FoS", *(f"{grasp.fos:.3f}" for grasp in shown), f"{rules.requirements.fos:.3f}")
    for number, (term, goal) in enumerate(zip(TERMS, rules.goals.base, strict=True)):
        told = "left out" if term in rules.goals.dropped else f"{goal:,.3f}"
        values = (f"{grasp.terms[number]:,.3f}" for grasp in shown)
        table.add_row(f"{term} ({UNITS[term]})", *values, told)
    table.add_row("divergence", *(f"{grasp.divergence:.3f}" for grasp in shown), "")
    distances = ("-" if g.clearance_mm is None else f"{g.clearance_mm:.1f}" for g in shown)
    table.add_row("clearance (mm)", *distances, f"{rules.requirements.clearance_mm:.1f}")
    table.add_row("feasible", *("yes" if grasp.feasible else "no" for grasp in shown), "")
    table.add_row("meets all goals", *("yes" if g.meets_all_goals else "no" for g in shown), "")
    OUT.print(table)


def run(ran: Ran, path: Path) -> None:
    """Print the outcome of a genetic run, and of the proof after it."""
    task, result, solved = ran.task, ran.result, ran.solved
    rows = [("Benchmark", result.benchmark)]
    if result.best:
        rows.append(("Best", result.best))
    if solved and solved.shown.grasp:
        rows.append((solved.shown.label, solved.shown.grasp))
    grasps(rows, task.rules)
    *told, last = sentences.run(ran)
    for sentence in told:
        line(sentence)
    line(f"{last} Wrote {path}.")


def solve(solved: Solved) -> None:
    """Print the outcome of an exact search: its designs, goals and floors, and what is proved."""
    rules = solved.task.rules
    criterion = rules.criterion
    value = f"value\n({UNITS[criterion.single]})" if criterion.single else criterion.name
    table = _ranking(solved.task, value)
    for rank, grasp in enumerate(solved.proof.designs, 1):
        table.add_row(str(rank), *_shown(grasp), f"{grasp.value:,.6g}")
    table.add_row("goal", "", "", *_shown_goals(rules), "")
    if solved.floors:
        table.add_row("floor", "", "", *_shown_floors(solved.floors), "")
    OUT.print(table)
    line(sentences.proof(solved))
    if solved.output:
        line(f"Wrote {solved.output}.")


def front(found: FoundFront, path: Path | None) -> None:
    """Print a trade-off front: its designs, and what is proved of them."""
    table = _ranking(found.task, DIVERGENCE, "proof")
    for number, design in enumerate(found.front.designs, 1):
        proof = "proved" if design.proved else "found"
        divergence = f"{design.grasp.divergence:,.6g}"
        table.add_row(str(number), *_shown(design.grasp), divergence, proof)
    table.add_row("goal", "", "", *_shown_goals(found.task.rules), "", "")
    OUT.print(table)
    line(found.told)
    if path:
        line(f"Wrote {path}.")


def _ranking(task: Task, *more: str) -> Table:
    """Make a table of grasps: a row each, genes, the four criteria, and more columns."""
    table = Table("", box=SIMPLE, pad_edge=False, collapse_padding=True)
    for kind in task.space.kinds:
        table.add_column(kind.name, min_width=len(kind.name))
    for heading in (*(f"{term}\n({UNITS[term]})" for term in TERMS), *more):
        table.add_column(heading, justify="right", no_wrap=True)
    return table


def _shown(grasp: Grasp) -> list[str]:
    genes = (" ".join(map(str, indices)) or "-" for indices in grasp.chromosome.active)
    return [*genes, *(f"{number:,.6g}" for number in grasp.terms)]


def _shown_goals(rules: Rules) -> list[str]:
    return [
        "left out" if term in rules.goals.dropped else f"{goal:,.6g}"
        for term, goal in zip(TERMS, rules.goals.base, strict=True)
    ]


def _shown_floors(floors: ProvenFloors) -> list[str]:
    """Return the floors; one that no known grasp attains is marked, as the truth may be higher."""
    return [
        f"{'' if term in floors.attained else '>= '}{floor:,.6g}"
        for term, floor in zip(TERMS, floors.least, strict=True)
    ]


def check(checked: Checked) -> None:
    """Print what ``check`` found."""
    for sentence in sentences.check(checked):
        line(sentence)


def excel(found: Buttons) -> None:
    """Print how the buttons of a workbook find Python."""
    for name, value in found.settings.items():
        line(f"{name}: {value or '-'}")
    if found.name is None:
        line("There is no Excel for this computer, so its path cannot be checked here.")
    elif found.works:
        line(f"{found.name} is there: the buttons find Python on this computer.")
    else:
        line(f"{found.name} is not there; grasp-xl excel --repair BOOK mends that.")
