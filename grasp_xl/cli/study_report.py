"""What ``study`` tells: progress, a table, or JSON."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from rich.box import SIMPLE
from rich.progress import BarColumn, TextColumn
from rich.progress import Progress as Bars
from rich.table import Table

from grasp_xl.cli.terminal import ERR, OUT, line
from grasp_xl.commands.study import OnRun, Studied
from grasp_xl.study.summary import Look, Value, answers, columns, rows

REFRESH_SECONDS = 0.2


@contextmanager
def progress(*, quiet: bool) -> Iterator[OnRun]:
    """Give a bar with the runs that are done, and the time left; it shows on a terminal only."""
    if quiet or not ERR.is_terminal:
        yield lambda done, planned: None  # noqa: ARG005 (nobody looks)
        return
    shown = (BarColumn(), TextColumn("{task.description}", markup=False))
    with Bars(*shown, console=ERR, auto_refresh=False, transient=True) as bars:
        began, first, last = time.perf_counter(), -1, 0.0
        task = bars.add_task("", total=None)

        def tell(done: int, planned: int) -> None:
            nonlocal first, last
            clock = time.perf_counter()
            first = done - 1 if first < 0 else first
            if clock - last < REFRESH_SECONDS and done < planned:
                return
            last = clock
            left = (clock - began) / (done - first) * (planned - done)
            told = f"{done:,} of {planned:,} runs, {left:.0f} s left"
            bars.update(task, completed=done, total=planned, description=told, refresh=True)

        yield tell


def study(studied: Studied, output: Path) -> None:
    """Print the summary of a study and the answers."""
    found = studied.study
    shown = columns(found)
    cells = [
        [
            _shown(value, column.look)
            for value, column in zip(values, shown, strict=True)
            if column.short
        ]
        for values in rows(found)
    ]
    table = Table(box=SIMPLE, pad_edge=False, collapse_padding=True)
    for number, column in enumerate(filter(lambda column: column.short, shown)):
        width = max(len(column.short), *(len(row[number]) for row in cells)) if number else None
        justify: Any = "left" if column.look == "text" else "right"
        table.add_column(column.short, justify=justify, no_wrap=True, min_width=width)
    before = ""
    for title, *others in cells:
        table.add_row("" if title == before else title, *others)
        before = title
    OUT.print(table)
    for answer in answers(found):
        told = "".join(f"\n  {each}" for each in answer.answer.splitlines())
        line(f"{answer.question}{told}")
    done = f"{found.done:,} of {len(found.plan):,} runs done"
    if studied.known:
        done += f", {studied.known:,} of them before"
    if studied.interrupted:
        done += "; interrupted, go on with --resume"
    line(f"{done} ({studied.seconds:.2f} s).")
    line(f"Wrote {output}.")


def _shown(value: Value, look: Look) -> str:
    if value is None:
        return "-"
    if isinstance(value, str):
        return value.removesuffix(" start").removesuffix("-defined")
    if look == "percent":
        return f"{100 * value:.4g} %"
    return f"{value:,.0f}" if look == "count" else f"{value:,.5g}"


def study_json(studied: Studied, output: str) -> dict[str, Any]:
    """Return a study as JSON: a case each, and the answers."""
    found = studied.study
    return {
        "complete": found.complete,
        "interrupted": studied.interrupted,
        "runs": found.done,
        "planned": len(found.plan),
        "known": studied.known,
        "seed": found.plan.seed,
        "cases": [
            {
                "label": case.case.label,
                "part": case.case.name,
                "varied": dict(case.case.varied),
                "optimum": case.optimum,
                "reached": case.reached(),
                "runs": [
                    {
                        "label": outcome.trial.label,
                        "start": outcome.trial.scenario,
                        "seed": outcome.trial.seed,
                        "value": outcome.value if outcome.best else None,
                        "suction": list(outcome.best.chromosome.active[0]) if outcome.best else [],
                        "magnets": list(outcome.best.chromosome.active[1]) if outcome.best else [],
                        "near_at": outcome.near_at,
                    }
                    for outcome in case.outcomes
                ],
                "test": case.test._asdict() if case.test else None,
            }
            for case in found.cases
        ],
        "answers": [answer.answer for answer in answers(found)],
        "seconds": studied.seconds,
        "output": output,
    }
