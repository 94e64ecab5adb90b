"""The command ``study``."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from grasp_xl.cli.options import (
    MOST,
    Arm,
    AsJson,
    Children,
    Clearance,
    CriterionName,
    Density,
    Force,
    Fos,
    GenerationCount,
    GoalList,
    NoElitism,
    OneIn,
    Quiet,
    Seed,
    a_file,
    a_number,
    a_start,
    a_whole_number,
    parameters,
    with_value,
)
from grasp_xl.errors import UsageError

if TYPE_CHECKING:
    from grasp_xl.study.description import Description
    from grasp_xl.study.execution import Execute

MOST_RUNS = 100_000
MOST_WORKERS = 1_000

Sources = Annotated[
    list[Path],
    typer.Argument(
        help="Workbooks, a part each; or a TOML file that describes a study.",
        readable=False,
    ),
]
StudyBook = Annotated[
    Path,
    typer.Option(
        "-o",
        "--output",
        parser=a_file("-o"),
        metavar="FILE",
        help="Workbook of the study to write.",
    ),
]
OneStart = Annotated[
    str | None,
    with_value("--start", a_start, "user|random", "Runs from this start alone (default: both)."),
]
RunCount = Annotated[
    int | None,
    with_value(
        "--runs", a_whole_number("--runs", 1, MOST_RUNS), "N", "Runs of each start (default 2)."
    ),
]
Page = Annotated[
    Path | None,
    with_value("--html", a_file("--html"), "FILE", "Write the same as a page, too."),
]
Data = Annotated[
    Path | None,
    with_value(
        "--data",
        a_file("--data"),
        "FILE",
        "Write every change of every run to this .csv or .parquet file.",
    ),
]
OwnBooks = Annotated[
    Path | None,
    with_value(
        "--workbooks", a_file("--workbooks"), "FOLDER", "Write each run's own workbook, too."
    ),
]
MaybeProve = Annotated[
    bool | None,
    typer.Option(
        "--prove/--no-prove", help="Prove the best grasp of all of each part (default: prove)."
    ),
]
ProofLimit = Annotated[
    float | None,
    with_value(
        "--prove-limit",
        a_number("--prove-limit", f"a number from 0 to {MOST:g}", least=0),
        "SECONDS",
        "Longest search for a proof (default 10).",
    ),
]
WorkerCount = Annotated[
    int | None,
    with_value(
        "--workers",
        a_whole_number("--workers", 1, MOST_WORKERS),
        "N",
        "Runs at once on this machine (default: one a core).",
    ),
]
Scheduler = Annotated[
    str | None,
    typer.Option(
        "--scheduler",
        metavar="ADDRESS",
        help="Run on this Dask cluster instead: tcp://HOST:8786.",
    ),
]
Resume = Annotated[bool, typer.Option("--resume", help="Go on with the runs that are done.")]


def study(
    sources: Sources,
    output: StudyBook,
    runs: RunCount = None,
    start: OneStart = None,
    generations: GenerationCount = None,
    children: Children = None,
    one_in: OneIn = None,
    no_elitism: NoElitism = False,
    goals: GoalList = None,
    fos: Fos = None,
    clearance: Clearance = None,
    density_ratio: Density = None,
    criterion: CriterionName = None,
    moment_arm: Arm = None,
    seed: Seed = None,
    prove: MaybeProve = None,
    prove_limit: ProofLimit = None,
    html: Page = None,
    data: Data = None,
    workbooks: OwnBooks = None,
    workers: WorkerCount = None,
    scheduler: Scheduler = None,
    resume: Resume = False,
    force: Force = False,
    as_json: AsJson = False,
    quiet: Quiet = False,
) -> None:
    """Run many parts many times, from random and user-defined grasps, and compare what comes of it.

    Example: grasp-xl study workbooks/bracket.xlsx workbooks/panel.xlsx -o study.xlsx --runs 10
    """
    from grasp_xl.cli import reporting, show, study_report, terminal
    from grasp_xl.commands.study import StudyOutput, study_files
    from grasp_xl.search.stop import stop_on_ctrl_c

    options = parameters(
        goals,
        fos,
        clearance,
        density_ratio,
        criterion,
        moment_arm,
        None,
        generations=generations,
        children=children,
        one_in=one_in,
        elitism=False if no_elitism else None,
    )
    said: dict[str, Any] = {
        "runs": runs,
        "seed": seed,
        "prove": prove,
        "prove_limit_s": prove_limit,
        "scenarios": (start,) if start else None,
    }
    given = {name: value for name, value in said.items() if value is not None}
    described = replace(_described(sources), **given)
    show.compile_notice(quiet=quiet, module="evolution")
    with stop_on_ctrl_c() as interrupt, study_report.progress(quiet=quiet) as bar:
        studied = study_files(
            described,
            options,
            StudyOutput(output, html, data, workbooks, force, resume),
            _execute(scheduler, workers),
            interrupt,
            bar,
        )
    if not quiet:
        terminal.warnings(studied.warnings)
    if as_json:
        reporting.print_json(study_report.study_json(studied, str(output)))
    elif not quiet:
        study_report.study(studied, output)
    if studied.interrupted:
        raise typer.Exit(130)


def _described(sources: Sequence[Path]) -> Description:
    """Return what is to be run, from workbooks or from the one file that describes it."""
    from grasp_xl.study.description import SUFFIX, Description, read_description

    files = [source for source in sources if source.suffix.lower() == SUFFIX]
    if not files:
        return Description(workbooks=tuple(sources))
    if len(sources) > 1:
        raise UsageError(
            f"{files[0]}: found other files beside it, expected it alone.",
            where=str(files[0]),
            hint="Name the workbooks in it",
        )
    return read_description(files[0])


def _execute(scheduler: str | None, workers: int | None) -> Execute:
    """Return how trials are run."""
    from grasp_xl.study.execution import run_here

    if scheduler is None:
        return partial(run_here, workers=workers)
    if workers is not None:
        raise UsageError(
            "Both --scheduler and --workers were given.",
            where="--workers",
            hint="Start as many workers as are wanted on the cluster",
        )
    from grasp_xl.study.cluster import run_on_cluster

    return partial(run_on_cluster, scheduler)
