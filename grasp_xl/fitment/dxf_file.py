"""Reading a flat part from a DXF drawing: its outline and holes, and the thickness of the sheet."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from shapely import Polygon

from grasp_xl.errors import InputError, Problem
from grasp_xl.fitment.caps import NO_CAPS, trimmed, true_area
from grasp_xl.fitment.dxf_lines import read_lines
from grasp_xl.fitment.outlines import outlines_of
from grasp_xl.fitment.part import CadPart, Face, in_order, pieces
from grasp_xl.fitment.part_choice import choose_part
from grasp_xl.space import frozen


def read_dxf(
    path: Path,
    *,
    units: str | None,
    thickness_mm: float,
    part: int | None,
    ignored_layers: Sequence[str],
    gap_mm: float,
) -> CadPart:
    """Read a flat part: its face lies at z = thickness.

    Parameters
    ----------
    path : Path
    units : str or None
        A key of :data:`UNITS`; needed where the drawing says none.
    thickness_mm : float
    part : int or None
        Which of several, from 1, the largest first.
    ignored_layers : sequence of str
    gap_mm : float
        Gaps of an outline up to this are closed.

    Raises
    ------
    InputError
        If it is no drawing of closed outlines, or of several parts and none is named.
    """
    name = str(path)
    drawing, content = read_lines(path, units, ignored_layers)
    outlines, notes = outlines_of(drawing.lines, gap_mm, name)
    outline = _chosen(outlines, part, name)
    caps = np.concatenate([NO_CAPS, *(line.caps for line in drawing.lines)])
    area_mm2, middle_mm = true_area(outline, caps)
    faces = (Face(piece, thickness_mm) for piece in pieces(trimmed(outline, caps)))
    return CadPart(
        name,
        hashlib.sha256(content).hexdigest(),
        area_mm2 * thickness_mm,
        frozen([*middle_mm, thickness_mm / 2]),
        in_order(faces),
        outline,
        (*drawing.notes, *notes, *_perhaps_a_frame(outline, name)),
    )


def _perhaps_a_frame(outline: Polygon, name: str) -> list[Problem]:
    """Return a note on a rectangle that is more hole than part: a sheet's frame looks like that."""
    holes = [Polygon(ring).area for ring in outline.interiors]
    whole = Polygon(outline.exterior)
    if whole.area < 0.999 * whole.envelope.area or max(holes, default=0) < whole.area / 2:
        return []
    found = f"a rectangle with a hole of {max(holes) / whole.area:.0%} of its area"
    hint = "if it is the frame of a sheet, leave its layer out with --ignore-layer"
    return [Problem(name, found, "a part", hint)]


def _chosen(outlines: Sequence[Polygon], part: int | None, name: str) -> Polygon:
    if not outlines:
        found, hint = "no closed outline", "draw the part's outline as lines and arcs that meet"
        raise InputError([Problem(name, found, "one", hint)])
    hint = "name one of them with --part; a frame around them is left out with --ignore-layer"
    return choose_part(outlines, part, noun="part", describe=_told, name=name, hint=hint)


def _told(outline: Polygon) -> str:
    x_low, y_low, x_high, y_high = outline.bounds
    holes = len(outline.interiors)
    return (
        f"{x_high - x_low:.5g} x {y_high - y_low:.5g} mm at x {x_low:.5g} y {y_low:.5g}, "
        f"{holes} hole{'s' if holes != 1 else ''}"
    )
