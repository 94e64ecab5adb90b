"""The command ``solve``."""

from __future__ import annotations

import math

import typer

from grasp_xl.cli.options import (
    Arm,
    AsJson,
    Clearance,
    CriterionName,
    Density,
    DesignCount,
    File,
    Force,
    Fos,
    Gap,
    GoalList,
    LeastElements,
    MaybeSolved,
    MeetGoals,
    Quiet,
    Seconds,
    Seed,
    parameters,
)
from grasp_xl.errors import InfeasibleError


def solve(
    file: File,
    output: MaybeSolved = None,
    time_limit: Seconds = None,
    top: DesignCount = 1,
    gap: Gap = 0.0,
    meet_goals: MeetGoals = False,
    min_elements: LeastElements = 1,
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
    """Find the best grasp of all, and prove that there is no better one.

    With -o, the workbook shows it on a card of its own; without, no file is written.

    Example: grasp-xl solve workbooks/door_frame.xlsx --top 3
    """
    from grasp_xl.cli import reporting, show, terminal
    from grasp_xl.commands.output import Output
    from grasp_xl.commands.solve import solve_file
    from grasp_xl.search.exact import ExactSettings
    from grasp_xl.search.stop import stop_on_ctrl_c

    options = parameters(goals, fos, clearance, density_ratio, criterion, moment_arm, seed)
    limit = math.inf if time_limit is None else time_limit
    settings = ExactSettings(limit, gap, top, meet_goals, min_elements)
    show.compile_notice(quiet=quiet, module="exact", what="exact search", seconds=15)
    try:
        with stop_on_ctrl_c() as interrupt, show.proof_progress(quiet=quiet) as shown:
            solved = solve_file(
                file,
                options,
                settings,
                output=Output(output, force=force) if output else None,
                interrupt=interrupt,
                on_progress=shown,
            )
    except InfeasibleError as error:
        if not as_json:
            raise
        reporting.print_json(reporting.failed_solve_json(error))
        raise typer.Exit(error.exit_code) from error
    if not quiet:
        terminal.warnings(solved.task.warnings)
    if as_json:
        reporting.print_json(reporting.solve_json(solved))
    elif solved.obstacle:
        raise solved.obstacle
    elif not quiet:
        show.solve(solved)
    if solved.obstacle:
        raise typer.Exit(solved.obstacle.exit_code)
    if solved.interrupted:
        raise typer.Exit(130)
