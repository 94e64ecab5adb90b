"""The part as it can be shown: the solid of its file, the plate of a drawing, or its faces."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import shapely
from shapely import MultiPolygon, Polygon

from grasp_xl.errors import GraspError, InputError, Problem
from grasp_xl.fitment.part_file import STEP_SUFFIXES
from grasp_xl.fitment.words import AXES, USUAL_UP
from grasp_xl.printable import printable
from grasp_xl.space import FloatArray, OptionSpace
from grasp_xl.view.solids import Plate
from grasp_xl.workbook.part_sheet import (
    PART_OF_FILE,
    SHA_256,
    SOURCE_FILE,
    THICKNESS,
    UP_AXIS,
    WHOLE,
    PartRecord,
)

if TYPE_CHECKING:
    from grasp_xl.fitment.step_file import TurnedSolid

LONGEST_NAME = 200
"""Characters of a file's name that a sheet may say; no system has longer ones."""

SAME_CENTROID_MM = 0.05
"""How far the centroid of a part's file may lie from that of the workbook."""


@dataclass(frozen=True, eq=False, slots=True)
class PartShape:
    """What is known of a part's shape: a solid, or plates, which may be as thin as a face.

    Parameters
    ----------
    name : str
        Of its file, or ``part``.
    solid : TurnedSolid or None
    plates : tuple of Plate
        Where there is no solid.
    notes : tuple of Problem
        Why it is not shown better, or may be another part.
    file : Path or None
        That the solid was read from.
    """

    name: str
    solid: TurnedSolid | None
    plates: tuple[Plate, ...]
    notes: tuple[Problem, ...] = ()
    file: Path | None = None


def part_shape(
    space: OptionSpace, record: PartRecord | None, book: Path, file: Path | None
) -> PartShape:
    """Return the best that is known of a part's shape.

    Parameters
    ----------
    space : OptionSpace
    record : PartRecord or None
        The workbook's sheet ``Part``.
    book : Path
        The workbook: the part's file is looked for beside it.
    file : Path or None
        STEP file of the part that a person named.

    Raises
    ------
    InputError
        If the file that a person named cannot be used.
    GraspError
        If nothing reads it.
    """
    if file:
        return _of_file(space, record, file)
    if record is None or not (plates := _plates(record)):
        return PartShape("part", None, (_outline(space),))
    named = Path(str(record.fact(SOURCE_FILE) or "")).name
    if _number(record.fact(THICKNESS)) or not 0 < len(named) <= LONGEST_NAME:
        return PartShape(named[:LONGEST_NAME] or "part", None, plates)
    beside = book.parent / named
    try:
        if beside.is_file():
            return _of_file(space, record, beside)
        found = "no such file"
        hint = f"put {printable(named)} beside the workbook, or name it with --part"
    except (GraspError, OSError, ValueError) as error:
        found = f"a file that cannot be read ({str(error).rstrip('.')})"
        hint = getattr(error, "hint", "") or "export the part anew"
    where, expected = printable(str(beside)), "the part's solid; its faces alone are shown"
    return PartShape(named, None, plates, (Problem(where, found, expected, hint),))


def _of_file(space: OptionSpace, record: PartRecord | None, file: Path) -> PartShape:
    from grasp_xl.fitment.step_file import read_solid

    if file.suffix.lower() not in STEP_SUFFIXES:
        found = f"a name that ends in {file.suffix!r}"
        hint = "the outline of a drawing stands on the sheet Part, so it needs no file"
        raise InputError([Problem(str(file), found, f"one of {', '.join(STEP_SUFFIXES)}", hint)])
    up, number = (record.fact(label) if record else None for label in (UP_AXIS, PART_OF_FILE))
    turned = read_solid(
        file,
        up=str(up) if up in AXES else USUAL_UP,
        part=int(number) if isinstance(number, int | float) else None,
    )
    notes = []
    away = float(np.linalg.norm(turned.centroid_mm - space.part.centroid_mm))
    if record and record.fact(SHA_256) not in (None, turned.sha256):
        found = "another file than the one that was fitted"
        hint = "places and part may not belong together; fit it again"
        notes.append(Problem(str(file), found, "the same", hint))
    elif away > SAME_CENTROID_MM:
        found = f"a solid whose centroid lies {away:.3g} mm from the workbook's"
        hint = "places and part may not belong together"
        notes.append(Problem(str(file), found, "the part of the workbook", hint))
    return PartShape(file.name, turned, (), tuple(notes), file)


def _plates(record: PartRecord) -> tuple[Plate, ...]:
    """Return a drawing's plate, or the faces of a part."""
    whole = [outline for outline in record.outlines if outline.number == WHOLE]
    thickness = _number(record.fact(THICKNESS))
    if thickness and whole:
        return (Plate(_area(whole[0].rings), 0.0, thickness),)
    return tuple(
        Plate(_area(outline.rings), outline.height_mm, outline.height_mm)
        for outline in record.outlines
        if outline.height_mm is not None
    )


def _area(rings: tuple[FloatArray, ...]) -> Polygon | MultiPolygon:
    """Return the area of rings that nest by even-odd."""
    closed = [np.vstack([ring, ring[:1]]) for ring in rings]
    return shapely.build_area(
        shapely.multilinestrings([shapely.linestrings(ring) for ring in closed])
    )


def _outline(space: OptionSpace) -> Plate:
    """Return the approximation polygon, at the height of its corners."""
    corners = space.approximation_polygon_mm
    height = float(corners[:, 2].mean())
    return Plate(shapely.make_valid(Polygon(corners[:, :2])), height, height)


def _number(value: object) -> float:
    return float(value) if isinstance(value, int | float) else 0.0
