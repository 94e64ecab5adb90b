"""From a part to its option space: every place where an element can stand (section 4.1)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from grasp_xl.errors import InputError, Problem, UsageError
from grasp_xl.fitment.deflection_polygon import approximation_polygon, in_sight
from grasp_xl.fitment.element import Element, Kind
from grasp_xl.fitment.face_choice import choose_faces
from grasp_xl.fitment.footprint import (
    TOLERANCE_MM,
    Footprint,
    covered,
    footprint_of,
    largest_disc_mm,
    lies_inside,
    middle_lies_inside,
)
from grasp_xl.fitment.grid import DECIMALS, grid, grid_size
from grasp_xl.fitment.part import CadPart, Face
from grasp_xl.polygon import look_at_polygon
from grasp_xl.space import MAX_FOOTPRINTS, ElementKind, FloatArray, OptionSpace, Part, frozen

MAX_GRID_POINTS = 4_000_000
"""Most points of the grids over all faces, however few of them are footprints."""

ABSENT_FORCE_N = 1.0
"""Written for a kind that has no places, as a sheet needs a force above 0; nothing uses it."""


@dataclass(frozen=True, slots=True)
class Choice:
    """What a designer chose of one kind.

    Parameters
    ----------
    element : Element
    price : float
        Of one ($).
    faces : str
        See :func:`choose_faces`.
    count_min, count_max : int
        How many a grasp may have.
    angle_deg : float
        Of the length of an element that is not round, to the x-axis.
    min_overlap : float
        Least part of a magnet that lies on its face.
    """

    element: Element
    price: float
    faces: str
    count_min: int
    count_max: int
    angle_deg: float = 0.0
    min_overlap: float = 0.0


@dataclass(frozen=True, slots=True)
class Fitment:
    """What a designer chose.

    Parameters
    ----------
    cup, magnet : Choice or None
    pitch_mm : float
    polygon : str or FloatArray
        See :func:`approximation_polygon`; or its corners, ``(n, 2)`` (mm).
    scale_factor : float
        From that polygon to the ideal one, in (0, 1].
    """

    cup: Choice | None
    magnet: Choice | None
    pitch_mm: float
    polygon: str | FloatArray
    scale_factor: float


@dataclass(frozen=True, eq=False, slots=True)
class Fitted:
    """An option space, and the faces that carry it.

    Parameters
    ----------
    space : OptionSpace
    cup_faces, magnet_faces : tuple of Face
    notes : tuple of Problem
    """

    space: OptionSpace
    cup_faces: tuple[Face, ...]
    magnet_faces: tuple[Face, ...]
    notes: tuple[Problem, ...]


def fit(part: CadPart, fitment: Fitment, mass_g: float) -> Fitted:
    """Return the option space of a part of some mass (g).

    Raises
    ------
    UsageError
        If a choice names no face, or the pitch is so small that too many places result.
    InputError
        If an element fits nowhere, saying which would.
    """
    cup_faces, cups = _cups(part, fitment.cup, fitment.pitch_mm)
    magnet_faces, magnets = _magnets(part, fitment.magnet, fitment.pitch_mm)
    centroid = frozen(np.round(part.centroid_mm, DECIMALS) + 0.0)
    polygon = _polygon(part, fitment.polygon)
    space = OptionSpace(Part(mass_g, centroid), (cups, magnets), polygon, fitment.scale_factor)
    notes = [
        *part.notes,
        *look_at_polygon(polygon, centroid, part.name),
        *_out_of_sight(part, space),
    ]
    return Fitted(space, cup_faces, magnet_faces, tuple(notes))


def _cups(
    part: CadPart, choice: Choice | None, pitch_mm: float
) -> tuple[tuple[Face, ...], ElementKind]:
    if choice is None:
        return (), _absent("suction")
    faces = choose_faces(part, choice.faces, "--cup-faces")
    footprint = footprint_of(choice.element, choice.angle_deg)
    places, grids = [], _grids(faces, pitch_mm)
    for face, points in zip(faces, grids, strict=True):
        places.append(_on(face, points[lies_inside(face.outline, points, footprint)]))
    footprints = _joined(places, pitch_mm)
    if not len(footprints):
        largest = max(
            largest_disc_mm(face.outline, points) for face, points in zip(faces, grids, strict=True)
        )
        raise InputError([_no_cup_fits(part, choice, footprint, largest)])
    return _carrying(faces, places), _kind("suction", choice, footprint, footprints, None)


def _no_cup_fits(part: CadPart, choice: Choice, footprint: Footprint, largest_mm: float) -> Problem:
    largest = np.floor(largest_mm * 100) / 100
    size = f"{footprint.diameter_mm:g} mm" if footprint.is_round else "its size"
    return Problem(
        part.name,
        f"no place where a suction cup of {size} ({choice.element.model}) lies on the faces of "
        f"--cup-faces {choice.faces}",
        f"room for one at a point of the grid; the largest round one has {largest:g} mm",
        "choose a smaller cup, other faces, or a smaller pitch",
    )


def _magnets(
    part: CadPart, choice: Choice | None, pitch_mm: float
) -> tuple[tuple[Face, ...], ElementKind]:
    if choice is None:
        return (), _absent("magnets")
    faces = choose_faces(part, choice.faces, "--magnet-faces")
    footprint = footprint_of(choice.element, choice.angle_deg)
    places, fractions = [], []
    for face, points in zip(faces, _grids(faces, pitch_mm), strict=True):
        inner = points[middle_lies_inside(face.outline, points)]
        fraction = covered(face.outline, inner, footprint)
        enough = fraction >= choice.min_overlap - TOLERANCE_MM
        places.append(_on(face, inner[enough]))
        fractions.append(fraction[enough])
    footprints = _joined(places, pitch_mm)
    if not len(footprints):
        raise InputError(
            [
                Problem(
                    part.name,
                    f"no place for a magnet ({choice.element.model}) on the faces of "
                    f"--magnet-faces {choice.faces}",
                    f"a point of the grid inside a face, covered to {choice.min_overlap:.0%}",
                    "choose other faces, a smaller pitch, or a smaller --min-overlap",
                )
            ]
        )
    overlap = frozen(np.round(np.concatenate(fractions), DECIMALS))
    return _carrying(faces, places), _kind("magnets", choice, footprint, footprints, overlap)


def _carrying(faces: Sequence[Face], places_mm: Sequence[FloatArray]) -> tuple[Face, ...]:
    """Return the faces on which there are places."""
    return tuple(face for face, on in zip(faces, places_mm, strict=True) if len(on))


def _grids(faces: Sequence[Face], pitch_mm: float) -> list[FloatArray]:
    """Return the grid over each face.

    Raises
    ------
    UsageError
        If there would be too many points.
    """
    points = sum(grid_size(face.outline, pitch_mm) for face in faces)
    if points > MAX_GRID_POINTS:
        raise UsageError(
            f"--pitch {pitch_mm:g} gives {points:,} grid points, more than {MAX_GRID_POINTS:,}.",
            hint="Give a larger pitch, or fewer faces",
        )
    return [grid(face.outline, pitch_mm) for face in faces]


def _on(face: Face, places_mm: FloatArray) -> FloatArray:
    """Lift places onto a face, ``(n, 3)`` (mm)."""
    return frozen(np.column_stack([places_mm, np.full(len(places_mm), face.height_mm)]))


def _joined(places_mm: Sequence[FloatArray], pitch_mm: float) -> FloatArray:
    """Return the places of all faces, rounded.

    Raises
    ------
    UsageError
        If there are more than a workbook lists.
    """
    footprints = np.concatenate(places_mm)
    if len(footprints) > MAX_FOOTPRINTS:
        raise UsageError(
            f"--pitch {pitch_mm:g} gives {len(footprints):,} footprints of one kind, more than "
            f"{MAX_FOOTPRINTS:,}.",
            hint="Give a larger pitch, or fewer faces",
        )
    return frozen(np.round(footprints, DECIMALS) + 0.0)


def _kind(
    name: Kind,
    choice: Choice,
    footprint: Footprint,
    footprints_mm: FloatArray,
    overlap: FloatArray | None,
) -> ElementKind:
    element = choice.element
    return ElementKind(
        name=name,
        force_n=element.force_n,
        price=choice.price,
        count_min=choice.count_min,
        count_max=choice.count_max,
        footprints_mm=footprints_mm,
        weight_g=element.weight_g,
        diameter_mm=footprint.diameter_mm,
        model=element.model,
        overlap=overlap,
    )


def _absent(name: Kind) -> ElementKind:
    return ElementKind(name, ABSENT_FORCE_N, 0.0, 0, 0, frozen(np.empty((0, 3))))


def _polygon(part: CadPart, choice: str | FloatArray) -> FloatArray:
    if isinstance(choice, str):
        corners = approximation_polygon(part, choice)
    else:
        corners = np.column_stack([choice, np.zeros(len(choice))])
    return frozen(np.round(corners, DECIMALS) + 0.0)


def _out_of_sight(part: CadPart, space: OptionSpace) -> list[Problem]:
    """Return a note of places that the outline hides from the centroid (section 3.2)."""
    hint = "the deviation says little about bending there (thesis, section 3.2)"
    if not in_sight(part, part.centroid_mm[None, :])[0]:
        found = "a centroid outside the part's outline"
        return [Problem(part.name, found, "it inside, in sight of all places", hint)]
    places = np.concatenate([kind.footprints_mm for kind in space.kinds])
    hidden = int(np.count_nonzero(~in_sight(part, places)))
    if not hidden:
        return []
    found = f"{hidden:,} of {len(places):,} places that the outline hides from the centroid"
    return [Problem(part.name, found, "a straight way inside the outline to each", hint)]
