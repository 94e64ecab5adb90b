"""The command ``front``."""

from __future__ import annotations

import typer

from grasp_xl.cli.options import (
    Arm,
    AsJson,
    BookIfAny,
    Clearance,
    CriterionName,
    Density,
    File,
    Force,
    Fos,
    FrontSeconds,
    GoalList,
    Grid,
    Quiet,
    Seed,
    parameters,
)


def front(
    file: File,
    output: BookIfAny = None,
    grid: Grid = 4,
    time_limit: FrontSeconds = 30.0,
    goals: GoalList = None,
    fos: Fos = None,
    clearance: Clearance = None,
    density_ratio: Density = None,
    criterion: CriterionName = None,
    moment_arm: Arm = None,
    seed: Seed = None,
    force: Force = False,
    as_json: AsJson = False,
    quiet: Quiet = False,
) -> None:
    """Find the grasps that trade cost, moment, deviation and structure against one another.

    Example: grasp-xl front workbooks/bracket.xlsx -o trade-offs.xlsx
    """
    from grasp_xl.cli import reporting, show, terminal
    from grasp_xl.commands.front import front_file
    from grasp_xl.commands.output import Output
    from grasp_xl.search.stop import stop_on_ctrl_c

    options = parameters(goals, fos, clearance, density_ratio, criterion, moment_arm, seed)
    show.compile_notice(quiet=quiet, module="exact", seconds=15)
    with stop_on_ctrl_c() as interrupt, show.front_progress(quiet=quiet) as shown:
        found = front_file(
            file,
            options,
            Output(output, force=force) if output else None,
            grid=grid,
            time_limit_s=time_limit,
            interrupt=interrupt,
            on_progress=shown,
        )
    if not quiet:
        terminal.warnings(found.task.warnings)
    if as_json:
        reporting.print_json(reporting.front_json(found, str(output) if output else None))
    elif not quiet:
        show.front(found, output)
    if found.interrupted:
        raise typer.Exit(130)
