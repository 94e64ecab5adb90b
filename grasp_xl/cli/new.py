"""The command ``new``."""

from __future__ import annotations

from grasp_xl.cli.options import (
    Arm,
    AsJson,
    Book,
    Clearance,
    CriterionName,
    Cups,
    Density,
    File,
    Force,
    Fos,
    GoalList,
    Magnets,
    Quiet,
    Seed,
    parameters,
)


def new(
    file: File,
    output: Book,
    cups: Cups = None,
    magnets: Magnets = None,
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
    """Make the full workbook from an exported sheet, ready for a designer; no run.

    Into a workbook that exists, it keeps the designer's parameters and names stale indices.

    Example: grasp-xl new export.xlsx -o bracket.xlsx
    """
    from grasp_xl.cli import reporting, show, terminal
    from grasp_xl.commands.new import make_workbook
    from grasp_xl.commands.output import Output

    options = parameters(goals, fos, clearance, density_ratio, criterion, moment_arm, seed)
    show.compile_notice(quiet=quiet)
    place = Output(output, force=force)
    task = make_workbook(file, options, place, (cups, magnets))
    if not quiet:
        terminal.warnings(task.warnings)
    if as_json:
        reporting.print_json(reporting.new_json(task, str(output)))
    elif not quiet:
        terminal.line(f"Wrote {output}.")
