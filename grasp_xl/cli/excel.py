"""The command ``excel``."""

from __future__ import annotations

from typing import Annotated

import typer

from grasp_xl.cli.options import AsJson, File, Force, Quiet


def excel(
    file: File,
    repair: Annotated[
        bool, typer.Option("--repair", help="Let the buttons find this Python.")
    ] = False,
    force: Force = False,
    as_json: AsJson = False,
    quiet: Quiet = False,
) -> None:
    """Say how the buttons of a workbook find Python; with --repair, let them find this one.

    Example: grasp-xl excel --repair bracket.xlsm
    """
    from grasp_xl.cli import reporting, show
    from grasp_xl.commands import excel as buttons

    found = buttons.repair(file, force=force) if repair else buttons.read_buttons(file)
    if as_json:
        reporting.print_json(reporting.excel_json(found))
    elif not quiet:
        show.excel(found)
    if found.name and not found.works:
        raise typer.Exit(1)
