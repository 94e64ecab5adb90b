"""Reading a solid part from a STEP file: its level faces that can be reached from above."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import shapely
from shapely import MultiPolygon, Polygon

from grasp_xl.errors import GraspError, InputError, Problem
from grasp_xl.file_content import FileKind, read_content
from grasp_xl.fitment.cover import cover_above, plan_of
from grasp_xl.fitment.orientation import rotation
from grasp_xl.fitment.part import HEIGHT_DECIMALS, CadPart, Face, in_order
from grasp_xl.fitment.part_choice import choose_part
from grasp_xl.fitment.words import AXES
from grasp_xl.space import FloatArray, frozen

if TYPE_CHECKING:
    from grasp_xl.fitment.occ import PlaneFace, Solid

SAG_MM = 0.05
"""How far the chords of an arc may stray from it: an edge may lie nearer by so much."""

LEVEL_DEG = 0.5
"""How far a face may lean and still be level."""

SEAM_MM = 1e-3
"""Half the width of a crack between faces at one height that is closed."""

LEAST_AREA_MM2 = 1.0
"""Pieces of a face that are smaller are no faces, and covers that are smaller cover nothing."""

MOST_REACH_MM = 1e6
"""How far from the origin a part may lie: beyond, places are no longer exact."""

MAX_FILE_BYTES = 512_000_000
STEP = FileKind("file", "a STEP file", MAX_FILE_BYTES, "export the part alone")
EXPORT = "export the part as STEP (AP214 or AP242), as a solid"
START, END = b"ISO-10303-21", b"END-ISO-10303-21"
UNIT = b"LENGTH_UNIT"


@dataclass(frozen=True, eq=False, slots=True)
class TurnedSolid:
    """A solid of a file, and how it is turned so that an axis of the file looks up.

    Parameters
    ----------
    solid : Solid
        As in the file.
    turn : FloatArray
        ``(3, 3)`` rotation.
    mesh : FloatArray
        ``(n, 3, 3)`` triangles after it (mm), counter-clockwise from outside.
    content : bytes
        Of the file.
    """

    solid: Solid
    turn: FloatArray
    mesh: FloatArray
    content: bytes

    @property
    def sha256(self) -> str:
        """Of the file."""
        return hashlib.sha256(self.content).hexdigest()

    @property
    def centroid_mm(self) -> FloatArray:
        """Centroid after the turn, ``(3,)``."""
        return frozen(self.turn @ self.solid.centroid_mm)


def read_solid(path: Path, *, up: str, part: int | None) -> TurnedSolid:
    """Read one solid of a STEP file.

    Parameters
    ----------
    path : Path
    up : str
        One of :data:`AXES`.
    part : int or None
        Which of several solids, from 1, the largest first.

    Raises
    ------
    InputError
        If there is no solid, several and none is named, or it is too far from the origin.
    GraspError
        If OpenCASCADE is not installed.
    """
    name = str(path)
    content = read_content(path, STEP)
    _refuse_other_files(content, name)
    solid = choose_part(_read(path), part, noun="solid", describe=_told, name=name)
    from grasp_xl.fitment.occ import reach_mm, triangles

    if (reach := reach_mm(solid)) > MOST_REACH_MM:
        found = f"a solid that reaches {reach:.3g} mm from the origin"
        hint = "see whether the unit of length is right, and move the part to the origin in CAD"
        raise InputError([Problem(name, found, f"{MOST_REACH_MM:g} mm at most", hint)])
    turn = rotation(up)
    return TurnedSolid(solid, turn, frozen(triangles(solid) @ turn.T), content)


def read_step(path: Path, *, up: str, part: int | None, approach_mm: float) -> CadPart:
    """Read a solid part: its level faces, seen from an axis of the file that looks up.

    Parameters
    ----------
    path, up, part
        See :func:`read_solid`.
    approach_mm : float
        Least room above a face: what lies nearer under other material cannot be reached.

    Raises
    ------
    InputError, GraspError
        As :func:`read_solid`, or if there is no level face.
    """
    name = str(path)
    turned = read_solid(path, up=up, part=part)
    from grasp_xl.fitment.occ import plane_faces

    turn = turned.turn
    flat = list(plane_faces(turned.solid))
    level = _level_faces([face for face in flat if _tilt_deg(face, turn) <= LEVEL_DEG], turn)
    if not level:
        raise InputError([_no_level_face(flat, up, name)])
    faces, notes = _reachable(level, turned.mesh, approach_mm, name)
    if not faces:
        found = f"no face that can be reached: all {len(level)} lie under other material"
        hint = "turn the part with --up, or give a smaller --approach"
        raise InputError([Problem(name, found, "a level face with room above it", hint)])
    if UNIT not in turned.content:
        notes.append(Problem(name, "no unit of length", "one", "its numbers are taken as mm"))
    return CadPart(
        name,
        turned.sha256,
        turned.solid.volume_mm3,
        turned.centroid_mm,
        faces,
        plan_of(turned.mesh),
        tuple(notes),
    )


def _refuse_other_files(content: bytes, name: str) -> None:
    found = ""
    if not content.strip():
        found = "an empty file"
    elif not content.lstrip().startswith(START):
        found = "a file that is no STEP file"
    elif not content.rstrip(b"\0 \r\n\t").endswith((END + b";", END)):
        found = "a STEP file that breaks off"
    if found:
        raise InputError([Problem(name, found, STEP.expected, EXPORT)])


def _read(path: Path) -> list[Solid]:
    """Read the solids of a file.

    Raises
    ------
    InputError, GraspError
        If there are none, or nothing reads them.
    """
    try:
        from grasp_xl.fitment.occ import ReadError, read_solids
    except ImportError as error:
        raise not_installed(error, "export the outline as DXF") from error
    name = str(path)
    try:
        solids, faces = read_solids(path)
    except ReadError as error:
        reason = " ".join(str(error).split())[:100]
        found = f"a STEP file that OpenCASCADE cannot read ({reason})"
        raise InputError([Problem(name, found, STEP.expected, EXPORT)]) from error
    if not solids:
        found = f"{faces} surfaces and no solid" if faces else "nothing that has a shape"
        hint = "give the sheet its thickness in CAD: a surface has no mass"
        raise InputError([Problem(name, found, "one solid", hint)])
    return solids


def not_installed(error: ImportError, instead: str) -> GraspError:
    """Return what is told of a missing OpenCASCADE, and what can be done instead."""
    return GraspError(
        f"STEP files need OpenCASCADE, which is not installed ({error}).",
        hint=f'Install it with pip install "grasp_xl[cad]", or {instead}',
    )


def _told(solid: Solid) -> str:
    x, y, z = solid.centroid_mm
    return f"{solid.volume_mm3 / 1000:,.4g} cm3 about {x:.5g}, {y:.5g}, {z:.5g}"


def _tilt_deg(face: PlaneFace, turn: FloatArray) -> float:
    """Return how far a face's normal is from z after the part was turned (degrees)."""
    normal = turn @ face.normal
    return math.degrees(math.atan2(math.hypot(normal[0], normal[1]), normal[2]))


def _no_level_face(flat: Sequence[PlaneFace], up: str, name: str) -> Problem:
    others = [
        axis for axis in AXES if any(_tilt_deg(face, rotation(axis)) <= LEVEL_DEG for face in flat)
    ]
    least = min((_tilt_deg(face, rotation(up)) for face in flat), default=180.0)
    hint = "turn the part in CAD so that the faces to grip are level"
    if others:
        hint = f"say which axis looks up, as --up={others[0]}; faces look along {', '.join(others)}"
    found = f"no flat face that looks along {up}; the nearest leans by {least:.3g} degrees"
    return Problem(name, found, f"one that leans by {LEVEL_DEG} at most", hint)


def _level_faces(flat: Iterable[PlaneFace], turn: FloatArray) -> tuple[Face, ...]:
    """Return faces in plan view; those that touch at one height are one."""
    by_height: dict[float, list[Polygon]] = {}
    for face in flat:
        rings = [ring @ turn.T for ring in face.rings(SAG_MM)]
        outline = Polygon(rings[0][:, :2], [ring[:, :2] for ring in rings[1:]])
        height = round(float(np.mean(rings[0][:, 2])), HEIGHT_DECIMALS)
        by_height.setdefault(height, []).append(outline)
    return in_order(
        Face(outline, height)
        for height, outlines in by_height.items()
        for outline in _joined(outlines)
    )


def _joined(outlines: Sequence[Polygon]) -> list[Polygon]:
    """Join faces at one height that touch: seams are no edges."""
    valid = shapely.make_valid(np.array(outlines, dtype=object))
    if len(outlines) > 1:
        wider = shapely.buffer(valid, SEAM_MM, join_style="mitre", mitre_limit=10)
        valid = shapely.union_all(wider).buffer(-SEAM_MM, join_style="mitre", mitre_limit=10)
    return _pieces(valid)


def _pieces(areas: object) -> list[Polygon]:
    """Return the polygons of areas that are worth the name."""
    parts = shapely.get_parts(areas)
    return [part for part in parts if isinstance(part, Polygon) and part.area >= LEAST_AREA_MM2]


def _reachable(
    level: Sequence[Face], mesh: FloatArray, approach_mm: float, name: str
) -> tuple[tuple[Face, ...], list[Problem]]:
    """Return what of the faces has room above it, and notes of what has not."""
    covers: dict[float, Polygon | MultiPolygon] = {}
    faces: list[Face] = []
    notes: list[Problem] = []
    for face in level:
        if face.height_mm not in covers:
            covers[face.height_mm] = cover_above(mesh, face.height_mm, approach_mm)
        cover = covers[face.height_mm]
        hidden = face.outline.intersection(cover).area
        if hidden < LEAST_AREA_MM2:
            faces.append(face)
            continue
        pieces = _pieces(face.outline.difference(cover))
        faces += [Face(piece, face.height_mm) for piece in pieces]
        x, y = face.outline.representative_point().coords[0]
        found = (
            f"{hidden:,.0f} of {face.outline.area:,.0f} mm2 of the face at z {face.height_mm:.6g}, "
            f"x {x:.6g} y {y:.6g} under other material"
        )
        expected = f"{approach_mm:g} mm of room above"
        notes.append(Problem(name, found, expected, "that is left out; see --approach"))
    return in_order(faces), notes
