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
from grasp_xl.fitment.caps import NO_CAPS, SAG_MM, Caps, caps_of, trimmed
from grasp_xl.fitment.cover import cover_above, plan_of
from grasp_xl.fitment.orientation import rotation
from grasp_xl.fitment.part import HEIGHT_DECIMALS, LEAST_AREA_MM2, CadPart, Face, in_order, pieces
from grasp_xl.fitment.part_choice import choose_part
from grasp_xl.fitment.seams import joined
from grasp_xl.fitment.words import AXES
from grasp_xl.space import FloatArray, frozen

if TYPE_CHECKING:
    from grasp_xl.fitment.occ import PlaneFace, Ring, Solid

LEVEL_DEG = 0.5
"""How far a face may lean and still be level."""

ROUND_OFF_DEG = 1e-6
NORMAL_DECIMALS = 7
"""Normals that agree so far are one: a plane of 10 m strays by a thousandth of a millimetre."""

LEANING_MM = 0.01
"""How far the edges of a face may lie above and below its height without a note."""

MOST_REACH_MM = 1e6
"""How far from the origin a part may lie: beyond, places are no longer exact."""

MOST_TOLD = 3
"""Faces that notes name, the largest first."""

LEFT_OUT = "that is left out; see --approach"

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
    loose_faces : int
        Of the file, that belong to no solid.
    """

    solid: Solid
    turn: FloatArray
    mesh: FloatArray
    content: bytes
    loose_faces: int

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
    solids, loose_faces = _read(path)
    solid = choose_part(solids, part, noun="solid", describe=_told, name=name)
    from grasp_xl.fitment.occ import reach_mm, triangles

    if (reach := reach_mm(solid)) > MOST_REACH_MM:
        found = f"a solid that reaches {reach:.3g} mm from the origin"
        hint = "see whether the unit of length is right, and move the part to the origin in CAD"
        raise InputError([Problem(name, found, f"{MOST_REACH_MM:g} mm at most", hint)])
    turn = rotation(up)
    mesh = frozen(triangles(solid) @ turn.T)
    return TurnedSolid(solid, turn, mesh, content, loose_faces)


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
    facing = [face for face in flat if _tilt_deg(face, turn) <= LEVEL_DEG + ROUND_OFF_DEG]
    if not facing:
        raise InputError([_no_level_face(flat, up, name)])
    level, leaning = _level_faces(facing, turn, name)
    if not level:
        found = f"faces that look along {up}, all of them smaller than {LEAST_AREA_MM2:g} mm2"
        hint = "see whether the unit of length is right"
        raise InputError([Problem(name, found, "a larger one", hint)])
    faces, notes = _reachable(level, turned.mesh, approach_mm, name)
    if not faces:
        found = f"no face that can be reached: all {len(level)} lie under other material"
        hint = "turn the part with --up, or give a smaller --approach"
        raise InputError([Problem(name, found, "a level face with room above it", hint)])
    notes += leaning
    if UNIT not in turned.content:
        notes.append(Problem(name, "no unit of length", "one", "its numbers are taken as mm"))
    if turned.loose_faces:
        found = f"{turned.loose_faces} surfaces beside the solids"
        notes.append(Problem(name, found, "solids alone", "the surfaces are left out"))
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


def _read(path: Path) -> tuple[list[Solid], int]:
    """Read the solids of a file, and count the faces of none of them.

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
    return solids, faces


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


def _level_faces(
    flat: Iterable[PlaneFace], turn: FloatArray, name: str
) -> tuple[tuple[Face, ...], list[Problem]]:
    """Return faces in plan view, one where they touch in a plane; and notes of leaning ones."""
    planes: dict[tuple[float, ...], list[list[Ring]]] = {}
    for face in flat:
        rings = [ring.turned(turn) for ring in face.rings(SAG_MM)]
        if len(rings[0].corners):
            normal = turn @ face.normal
            away = float(np.mean(rings[0].corners[:-1] @ normal))
            plane = (*np.round(normal, NORMAL_DECIMALS) + 0.0, round(away, HEIGHT_DECIMALS))
            planes.setdefault(plane, []).append(rings)
    faces, notes = [], []
    for (x, y, z, away), several in planes.items():
        slope = frozen([-x / z, -y / z])
        for outline in _joined([_outline(rings) for rings in several]):
            for piece in pieces(trimmed(outline, _caps(several))):
                middle = shapely.get_coordinates(piece.centroid)[0]
                height = round(float(away / z + slope @ middle), HEIGHT_DECIMALS)
                faces.append(Face(piece, height))
                most = float(np.ptp(shapely.get_coordinates(piece) @ slope)) / 2
                if most > LEANING_MM:
                    notes.append(_leaning(name, height, most))
    return in_order(faces), notes


def _leaning(name: str, height_mm: float, most_mm: float) -> Problem:
    found = f"a face about z {height_mm:.6g} that leans: its edges are up to {most_mm:.2g} mm off"
    hint = "all places on it stand at its mean height"
    return Problem(name, found, "a level face", hint)


def _outline(rings: Sequence[Ring]) -> Polygon:
    outer, *holes = (ring.corners[:, :2] for ring in rings)
    return Polygon(outer, holes)


def _caps(faces: Sequence[Sequence[Ring]]) -> Caps:
    caps = [caps_of(ring.corners[:, :2], ring.apexes[:, :2]) for rings in faces for ring in rings]
    return np.concatenate([NO_CAPS, *caps])


def _joined(outlines: Sequence[Polygon]) -> list[Polygon]:
    """Join faces in one plane that touch."""
    valid = shapely.make_valid(np.array(outlines, dtype=object))
    return pieces(joined(valid) if len(outlines) > 1 else valid)


def _reachable(
    level: Sequence[Face], mesh: FloatArray, approach_mm: float, name: str
) -> tuple[tuple[Face, ...], list[Problem]]:
    """Return what of the faces has room above it, and notes of what has not."""
    covers: dict[float, Polygon | MultiPolygon] = {}
    faces: list[Face] = []
    hidden: list[tuple[float, Face]] = []
    for face in level:
        if face.height_mm not in covers:
            covers[face.height_mm] = cover_above(mesh, face.height_mm, approach_mm)
        cover = covers[face.height_mm]
        area = face.outline.intersection(cover).area
        if area < LEAST_AREA_MM2:
            faces.append(face)
            continue
        left = pieces(face.outline.difference(cover))
        faces += [Face(piece, face.height_mm) for piece in left]
        hidden.append((area, face))
    hidden.sort(key=lambda one: -one[0])
    notes = [_hidden(area, face, approach_mm, name) for area, face in hidden[:MOST_TOLD]]
    if rest := hidden[MOST_TOLD:]:
        found = f"{sum(area for area, _ in rest):,.0f} mm2 of {len(rest)} more faces"
        found += " under other material"
        notes.append(Problem(name, found, f"{approach_mm:g} mm of room above", LEFT_OUT))
    return in_order(faces), notes + _under_a_roof(faces, mesh, approach_mm, name)


def _hidden(area: float, face: Face, approach_mm: float, name: str) -> Problem:
    x, y = face.outline.representative_point().coords[0]
    found = (
        f"{area:,.0f} of {face.outline.area:,.0f} mm2 of the face at z {face.height_mm:.6g}, "
        f"x {x:.6g} y {y:.6g} under other material"
    )
    return Problem(name, found, f"{approach_mm:g} mm of room above", LEFT_OUT)


def _under_a_roof(
    faces: Sequence[Face], mesh: FloatArray, approach_mm: float, name: str
) -> list[Problem]:
    """Return a note of places under material that is farther up than the approach."""
    roofs = {face.height_mm: cover_above(mesh, face.height_mm, np.inf) for face in faces}
    area = sum(face.outline.intersection(roofs[face.height_mm]).area for face in faces)
    if area < LEAST_AREA_MM2:
        return []
    found = f"{area:,.0f} mm2 of the faces under material more than {approach_mm:g} mm above"
    hint = "places there count as reachable; a larger --approach leaves them out"
    return [Problem(name, found, "nothing above", hint)]
