"""How ``fit`` makes the exported sheet of a part."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from shapely import MultiPolygon, Polygon

from grasp_xl.commands.keeping import replaced
from grasp_xl.commands.output import Output
from grasp_xl.errors import GraspError, UsageError
from grasp_xl.fitment.catalogue import Catalogue, find, read_catalogue
from grasp_xl.fitment.element import Element, Kind
from grasp_xl.fitment.face_picture import MARK, face_picture
from grasp_xl.fitment.fitting import Choice, Fitment, Fitted, fit
from grasp_xl.fitment.material import MATERIALS, USUAL, Material
from grasp_xl.fitment.part import CadPart, in_order, rings_of
from grasp_xl.fitment.part_file import Reading, read_part
from grasp_xl.printable import quoted
from grasp_xl.space import FloatArray, frozen
from grasp_xl.workbook.part_sheet import (
    CUP_ANGLE,
    MAGNET_ANGLE,
    PART_OF_FILE,
    SHA_256,
    SOURCE_FILE,
    THICKNESS,
    UP_AXIS,
    WHOLE,
    FaceOutline,
    PartRecord,
)
from grasp_xl.workbook.saving import check_place, check_target, refuse_theirs, save
from grasp_xl.workbook.writing import export_workbook
from grasp_xl.workbook.written import CellValue

EXPORT_SUFFIX, PICTURE_SUFFIX = ".xlsx", ".svg"

DOLLAR = "USD"

CUP, MAGNET = "cup", "magnet"
"""How options begin that are about one kind."""

PLACE_DECIMALS, AREA_DECIMALS = 6, 3
"""Lengths (mm), areas and volumes of the sheet ``Part`` are rounded: any program keeps them so."""

SHOWN_MM = 0.05
"""How far the outlines of the sheet ``Part``, which are only looked at, stray from those in use."""

USUAL_PITCH_MM = 10.0
USUAL_COUNT = (1, 5)
"""Fewest and most elements of a kind (section 4.1)."""


@dataclass(frozen=True, slots=True)
class Wanted:
    """What a designer asked for of one kind.

    Parameters
    ----------
    name : str
        Model or part number.
    price : float or None
        Of one ($); None: as the catalogue says.
    faces : str
    count : sequence of int
        Fewest and most of a grasp.
    angle_deg : float
    """

    name: str
    price: float | None
    faces: str
    count: Sequence[int]
    angle_deg: float


@dataclass(frozen=True, slots=True)
class Mass:
    """How the mass of a part is known: itself (g), else a density (g/cm^3), else its material."""

    material: Material | None
    density_g_cm3: float | None = None
    mass_g: float | None = None

    def of(self, part: CadPart) -> float:
        """Return the mass of a part (g)."""
        if self.mass_g is not None:
            return self.mass_g
        density = self.density_g_cm3 or (self.material or MATERIALS[USUAL]).density_g_cm3
        return part.volume_mm3 * density / 1000


@dataclass(frozen=True, slots=True)
class Request:
    """All that a designer says to ``fit``.

    Parameters
    ----------
    path : Path
        STEP or DXF file.
    reading : Reading
    mass : Mass
    cup, magnet : Wanted or None
    catalogue : Path or None
        The designer's own elements.
    pitch_mm : float
    polygon : str or FloatArray
    scale_factor : float
    min_overlap : float
        Of magnets.
    """

    path: Path
    reading: Reading
    mass: Mass
    cup: Wanted | None
    magnet: Wanted | None
    catalogue: Path | None
    pitch_mm: float
    polygon: str | FloatArray
    scale_factor: float
    min_overlap: float


@dataclass(frozen=True, slots=True)
class FittedPart:
    """What was fitted, and from what."""

    part: CadPart
    fitted: Fitted


def fit_file(request: Request, output: Path, *, force: bool) -> FittedPart:
    """Fit elements on a part, and write its exported sheet.

    Raises
    ------
    UsageError, InputError
        If something that was asked for cannot be.
    OutputError
        If the sheet cannot be written.
    """
    suffixes = [EXPORT_SUFFIX]
    check_target(output, request.path, in_place=False, force=force, suffixes=suffixes)
    lost = replaced(Output(output, force=force))
    part, fitted = fit_part(request)
    fitted = replace(fitted, notes=(*lost, *fitted.notes))
    save(export_workbook(fitted.space, _record(request, part, fitted)).content, output)
    return FittedPart(part, fitted)


def fit_part(request: Request) -> tuple[CadPart, Fitted]:
    """Fit elements on a part.

    Raises
    ------
    UsageError, InputError
        If something that was asked for cannot be.
    """
    fitment = _fitment(request)
    part = read_part(request.path, request.reading)
    try:
        return part, fit(part, fitment, request.mass.of(part))
    except GraspError as error:
        for note in part.notes:  # they may say why
            error.add_note(str(note))
        raise


def _record(request: Request, part: CadPart, fitted: Fitted) -> PartRecord:
    """Return what the sheet ``Part`` says: nothing that depends on the time or the computer."""
    mass, reading = request.mass, request.reading
    material = mass.material or (None if mass.density_g_cm3 or mass.mass_g else MATERIALS[USUAL])
    facts: list[tuple[str, CellValue]] = [
        (SOURCE_FILE, request.path.name),
        (SHA_256, part.sha256),
        (PART_OF_FILE, reading.part),
        (UP_AXIS, reading.up),
        ("Units", reading.units),
        (THICKNESS, reading.thickness_mm),
        ("Volume (mm3)", round(part.volume_mm3, AREA_DECIMALS)),
        ("Material", material.name if material else None),
        ("Density (g/cm3)", mass.density_g_cm3),
        ("Mass given (g)", mass.mass_g),
        ("Pitch (mm)", request.pitch_mm),
        ("Polygon", request.polygon if isinstance(request.polygon, str) else "given"),
    ]
    for word, angle, wanted in (
        (CUP, CUP_ANGLE, request.cup),
        (MAGNET, MAGNET_ANGLE, request.magnet),
    ):
        if wanted:
            facts.append((f"{word.capitalize()} faces", wanted.faces))
            facts.append((angle, wanted.angle_deg or None))
    if request.min_overlap:
        facts.append(("Least overlap of a magnet", request.min_overlap))
    faces = dict.fromkeys((*fitted.cup_faces, *fitted.magnet_faces))
    outlines = [_outline(WHOLE, None, "", part.plan)]
    for number, face in enumerate(in_order(faces), 1):
        uses = [
            kind.name
            for kind, on in zip(
                fitted.space.kinds, (fitted.cup_faces, fitted.magnet_faces), strict=True
            )
            if face in on
        ]
        outlines.append(_outline(number, face.height_mm, ", ".join(uses), face.outline))
    known = ((label, value) for label, value in facts if value is not None)
    return PartRecord(tuple(known), tuple(outlines))


def _outline(
    number: int, height_mm: float | None, used_for: str, area: Polygon | MultiPolygon
) -> FaceOutline:
    shown = rings_of(area.simplify(SHOWN_MM))
    rings = tuple(frozen(np.round(ring, PLACE_DECIMALS) + 0.0) for ring in shown)
    return FaceOutline(number, height_mm, round(area.area, AREA_DECIMALS), used_for, rings)


def list_faces(path: Path, reading: Reading, picture: Path, *, force: bool) -> CadPart:
    """Read a part, and draw its faces.

    Raises
    ------
    UsageError, InputError, OutputError
        If it cannot be read, or the picture not written.
    """
    check_place(picture, [PICTURE_SUFFIX], force=force, option="--picture")
    refuse_theirs(picture, [MARK], "fit", force=force, option="--picture")
    part = read_part(path, reading)
    save(face_picture(part).encode(), picture)
    return part


def _fitment(request: Request) -> Fitment:
    """Look up the elements, before the part is read.

    Raises
    ------
    UsageError
        If there is no such element, it is of the other kind, cannot hold the part, or its price
        is not known.
    """
    catalogue = read_catalogue(request.catalogue)
    if request.cup is None and request.magnet is None:
        raise UsageError(
            "No element was chosen.",
            hint="Name one with --cup or --magnet, or one with each; see grasp-xl elements",
        )
    material = request.mass.material
    if request.magnet and material and not material.is_magnetic:
        holding = [name for name, each in MATERIALS.items() if each.is_magnetic]
        raise UsageError(
            f"Magnets do not hold {material.name}.",
            where="--magnet",
            hint=f"Leave --magnet out, or give --material {' or '.join(holding)}",
        )
    cup = _choice(catalogue, request.cup, "suction", 0.0)
    magnet = _choice(catalogue, request.magnet, "magnets", request.min_overlap)
    return Fitment(cup, magnet, request.pitch_mm, request.polygon, request.scale_factor)


def _choice(
    catalogue: Catalogue, wanted: Wanted | None, kind: Kind, min_overlap: float
) -> Choice | None:
    if wanted is None:
        return None
    word, other = (CUP, MAGNET) if kind == "suction" else (MAGNET, CUP)
    element = find(catalogue, wanted.name, kind)
    if element.kind != kind:
        raise UsageError(
            f"--{word}: {element.model!r} is a {other}.",
            where=f"--{word}",
            hint=f"See grasp-xl elements --kind {word}",
        )
    return Choice(
        element,
        _price(element, wanted, word),
        wanted.faces,
        wanted.count[0],
        wanted.count[-1],
        wanted.angle_deg,
        min_overlap,
    )


def _price(element: Element, wanted: Wanted, word: str) -> float:
    if wanted.price is not None:
        return wanted.price
    if element.price is None:
        raise UsageError(
            f"The price of {element.model!r} is not known.",
            where=f"--{word}-price",
            hint=f"Give it, for example --{word}-price 10",
        )
    if (element.currency or DOLLAR).upper() not in (DOLLAR, "$"):
        raise UsageError(
            f"The price of {quoted(element.model)} is in {quoted(element.currency or '')}, and a "
            "workbook counts in $.",
            where=f"--{word}-price",
            hint=f"Give it in $ with --{word}-price",
        )
    return element.price
