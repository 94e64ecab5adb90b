"""What a person sees on the terminal: tables, progress, warnings."""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from rich.console import Console
from rich.table import Table

from grasp_xl.compiled import is_compiled
from grasp_xl.errors import Problem
from grasp_xl.grasp import Grasp
from grasp_xl.rules import TERMS, Rules
from grasp_xl.search.stop import Progress

if TYPE_CHECKING:
    from grasp_xl.commands import Checked
    from grasp_xl.search.genetic import OnProgress
    from grasp_xl.search.result import Result
    from grasp_xl.task import Task

UNITS = {"cost": "$", "moment": "N-mm", "deviation": "mm", "structure": "mm"}
REFRESH_SECONDS = 0.2

_out = Console(soft_wrap=True, highlight=False)
_err = Console(stderr=True, soft_wrap=True, highlight=False)


def line(text: str) -> None:
    """Print one line."""
    _out.print(text, markup=False)


def warnings(found: Sequence[Problem]) -> None:
    """Print warnings on standard error."""
    for warning in found:
        _err.print(f"Warning: {warning}", style="yellow", markup=False)


def compile_notice(*, quiet: bool) -> None:
    """Say why the first run on a machine takes longer."""
    if not quiet and not is_compiled():
        _err.print("Compiling the search for this machine, once: about 10 seconds ...")


@contextmanager
def progress(*, quiet: bool) -> Iterator[OnProgress | None]:
    """Give a callback that shows generation, best value and rate, on a terminal only."""
    if quiet or not _err.is_terminal:
        yield None
        return
    began = time.perf_counter()
    shown = 0.0
    with _err.status("Reading ...") as status:

        def report(now: Progress) -> None:
            nonlocal shown
            elapsed = time.perf_counter() - began
            if elapsed - shown >= REFRESH_SECONDS:
                shown = elapsed
                rate = now.generation / elapsed
                status.update(
                    f"Generation {now.generation:,}, best {now.best_value:.4f}, {rate:,.0f}/s"
                )

        yield report


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
    _out.print(table)


def run(task: Task, result: Result, seconds: float, path: Path) -> None:
    """Print the outcome of a genetic run."""
    warnings(task.warnings)
    rows = [("Benchmark", result.benchmark)]
    if result.best:
        rows.append(("Best", result.best))
    grasps(rows, task.rules)
    state = result.state
    if result.best:
        line(
            f"Best {task.rules.criterion.name} {result.best.value:.6g}, "
            f"found at generation {state.improved_at:,}."
        )
    else:
        line("No grasp met FoS and clearance yet: run more generations, or another seed.")
    line(
        f"{state.generation:,} generations in {result.seconds:.2f} s "
        f"({seconds:.2f} s in all), stopped by {result.stop_reason}. Wrote {path}."
    )


def check(checked: Checked) -> None:
    """Print what ``check`` found."""
    warnings(checked.warnings)
    space = checked.space
    for kind in space.kinds:
        line(
            f"{kind.name}: {kind.total} places, {kind.count_min} to {kind.most} a grasp, "
            f"{kind.force_n:g} N, ${kind.price:g} each"
        )
    line(f"part: {space.part.mass_g:,.6g} g, {space.part.weight_n:,.6g} N")
    line(f"different grasps: {checked.search_space:.4e}")
    line(f"FoS of the most elements: {checked.max_fos:.4g}")
    for term, floor in checked.floors._asdict().items():
        line(f"no {term} below {floor:,.6g} {UNITS[term]}")
    line("No problem found.")
