"""The command ``check``."""

from __future__ import annotations

import typer

from grasp_xl.cli.options import (
    Arm,
    AsJson,
    Clearance,
    CriterionName,
    Density,
    File,
    Fos,
    GoalList,
    Quiet,
    Seed,
    parameters,
)
from grasp_xl.errors import InputError


def check(
    file: File,
    goals: GoalList = None,
    fos: Fos = None,
    clearance: Clearance = None,
    density_ratio: Density = None,
    criterion: CriterionName = None,
    moment_arm: Arm = None,
    seed: Seed = None,
    as_json: AsJson = False,
    quiet: Quiet = False,
) -> None:
    """Read and validate a file; list every problem, and say what any grasp of it can reach.

    Example: grasp-xl check workbooks/bracket.xlsx
    """
    from grasp_xl.cli import reporting, show, terminal
    from grasp_xl.commands.check import check_file

    options = parameters(goals, fos, clearance, density_ratio, criterion, moment_arm, seed)
    show.compile_notice(quiet=quiet)
    try:
        checked = check_file(file, options)
    except InputError as error:
        if not as_json:
            raise
        reporting.print_json(reporting.failed_check_json(error))
        raise typer.Exit(error.exit_code) from error
    if not quiet:
        terminal.warnings(checked.warnings)
    if as_json:
        reporting.print_json(reporting.check_json(checked))
    elif not quiet:
        show.check(checked)
    if checked.obstacle and as_json:
        raise typer.Exit(checked.obstacle.exit_code)
    if checked.obstacle:
        raise checked.obstacle
