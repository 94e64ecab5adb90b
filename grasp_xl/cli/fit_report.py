"""What ``fit`` says: a part's faces, and what was fitted on them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from rich.box import SIMPLE
from rich.table import Table

from grasp_xl.cli import terminal
from grasp_xl.cli.reporting import print_json, problems_json
from grasp_xl.commands.fit import FittedPart
from grasp_xl.fitment.part import CadPart

Json = dict[str, Any]


def faces(part: CadPart, picture: Path, *, as_json: bool, quiet: bool) -> None:
    """Show the faces of a part, each with its number."""
    if not quiet:
        terminal.warnings(part.notes)
    if as_json:
        print_json(_faces_json(part, picture))
        return
    if quiet:
        return
    table = Table(box=SIMPLE, pad_edge=False)
    for heading in ("face", "height (mm)", "area (mm2)", "size (mm)", "middle (mm)", "holes"):
        table.add_column(heading, justify="right")
    for row in _rows(part):
        table.add_row(
            str(row["face"]),
            f"{row['height_mm']:,.6g}",
            f"{row['area_mm2']:,.0f}",
            "{:,.6g} x {:,.6g}".format(*row["size_mm"]),
            "{:,.6g}, {:,.6g}".format(*row["middle_mm"]),
            str(row["holes"]),
        )
    terminal.OUT.print(table)
    terminal.line(_about(part))
    terminal.line(f"Wrote {picture}.")


def fitted(found: FittedPart, output: Path, *, as_json: bool, quiet: bool) -> None:
    """Show what was fitted on a part."""
    if not quiet:
        terminal.warnings(found.fitted.notes)
    if as_json:
        print_json(_fitted_json(found, output))
        return
    if quiet:
        return
    space = found.fitted.space
    terminal.line(f"{_about(found.part)} Mass {space.part.mass_g:,.6g} g.")
    chosen = (found.fitted.cup_faces, found.fitted.magnet_faces)
    for kind, on in zip(space.kinds, chosen, strict=True):
        if kind.total:
            count = f"{len(on)} face{'s' if len(on) != 1 else ''}"
            terminal.line(f"{kind.model}: {kind.total:,} places on {count}.")
    terminal.line(f"Wrote {output}.")


def _about(part: CadPart) -> str:
    x_low, y_low, x_high, y_high = part.plan.bounds
    size = f"{x_high - x_low:,.6g} x {y_high - y_low:,.6g} mm"
    return f"{part.name}: {size}, {part.volume_mm3 / 1000:,.6g} cm3."


def _rows(part: CadPart) -> list[Json]:
    rows = []
    for number, face in enumerate(part.faces, 1):
        x_low, y_low, x_high, y_high = face.outline.bounds
        rows.append(
            {
                "face": number,
                "height_mm": face.height_mm,
                "area_mm2": face.outline.area,
                "size_mm": [x_high - x_low, y_high - y_low],
                "middle_mm": [(x_low + x_high) / 2, (y_low + y_high) / 2],
                "holes": len(face.outline.interiors),
            }
        )
    return rows


def _part_json(part: CadPart) -> Json:
    return {
        "part": part.name,
        "volume_mm3": part.volume_mm3,
        "centroid_mm": part.centroid_mm.tolist(),
    }


def _faces_json(part: CadPart, picture: Path) -> Json:
    return {
        **_part_json(part),
        "faces": _rows(part),
        "warnings": problems_json(part.notes),
        "picture": str(picture),
    }


def _fitted_json(found: FittedPart, output: Path) -> Json:
    space = found.fitted.space
    cups, magnets = space.kinds
    return {
        **_part_json(found.part),
        "mass_g": space.part.mass_g,
        "cups": cups.total,
        "magnets": magnets.total,
        "cup_faces": len(found.fitted.cup_faces),
        "magnet_faces": len(found.fitted.magnet_faces),
        "polygon_mm": space.approximation_polygon_mm.tolist(),
        "scale_factor": space.scale_factor,
        "warnings": problems_json(found.fitted.notes),
        "output": str(output),
    }
