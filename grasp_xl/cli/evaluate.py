"""The command ``evaluate``."""

from __future__ import annotations

from grasp_xl.cli.options import (
    Arm,
    AsJson,
    Clearance,
    CriterionName,
    Cups,
    Density,
    File,
    Fos,
    GoalList,
    Magnets,
    Quiet,
    Seed,
    parameters,
)


def evaluate(
    file: File,
    cups: Cups = None,
    magnets: Magnets = None,
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
    """Judge one grasp: its card, against the goals.  The user-defined grasp where none is named.

    Example: grasp-xl evaluate workbooks/bracket.xlsx --cups 1,9,20 --magnets 3
    """
    from grasp_xl.cli import reporting, show, terminal
    from grasp_xl.commands.evaluate import evaluate_grasp

    options = parameters(goals, fos, clearance, density_ratio, criterion, moment_arm, seed)
    show.compile_notice(quiet=quiet)
    task, grasp = evaluate_grasp(file, options, (cups, magnets))
    if not quiet:
        terminal.warnings(task.warnings)
    if as_json:
        reporting.print_json(reporting.grasp_json(grasp, task.rules))
    elif not quiet:
        show.grasps([("Grasp", grasp), ("Benchmark", task.benchmark)], task.rules)
