"""The command ``view``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from grasp_xl.cli.options import (
    AsJson,
    CatalogueFile,
    Cups,
    File,
    Force,
    Magnets,
    Quiet,
    a_file,
)

Shown = Annotated[
    Path,
    typer.Option(
        "-o",
        "--output",
        parser=a_file("-o"),
        metavar="FILE",
        help="File to write: a page .html, an assembly .step or .glb, a drawing .dxf, a bill .csv.",
    ),
]
DesignKey = Annotated[
    str | None,
    typer.Option(
        "--design",
        metavar="NAME",
        help="Design that is shown: proved, best, what-if, benchmark, valid-3, trade-off-2.",
    ),
]
Genes = Annotated[
    str | None,
    typer.Option(
        "--genes",
        metavar="ROWS",
        help="Another grasp, as two rows of genes copied from a workbook: '1 67 / 3 195 257 216'.",
    ),
]
PartOf = Annotated[
    Path | None,
    typer.Option(
        "--part",
        parser=a_file("--part"),
        metavar="FILE",
        help="STEP file of the part (default: the one that was fitted, beside the workbook).",
    ),
]


def view(
    file: File,
    output: Shown,
    design: DesignKey = None,
    cups: Cups = None,
    magnets: Magnets = None,
    genes: Genes = None,
    part: PartOf = None,
    catalogue: CatalogueFile = None,
    force: Force = False,
    as_json: AsJson = False,
    quiet: Quiet = False,
) -> None:
    """Show the designs of a workbook in three dimensions: a page, or a model for CAD.

    Example: grasp-xl view workbooks/bracket-result.xlsx -o bracket.html
    """
    from grasp_xl.cli import reporting, terminal
    from grasp_xl.commands.view import Wish, view_file

    wish = Wish(file, design, (cups, magnets), genes, part, catalogue)
    viewed = view_file(wish, output, force=force)
    if not quiet:
        terminal.warnings(viewed.warnings)
    if as_json:
        reporting.print_json(reporting.view_json(viewed, str(output)))
    elif not quiet:
        shown = viewed.scene.shown
        count = len(viewed.scene.designs)
        designs = f", of {count} designs" if count > 1 else ""
        terminal.line(f"Wrote {output}: {shown.name}{designs}.")
