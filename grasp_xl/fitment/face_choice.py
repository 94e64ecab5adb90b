"""Which faces of a part carry elements: what a designer may say, and what it means."""

from __future__ import annotations

import math
from contextlib import suppress

import shapely
from shapely import Polygon, box

from grasp_xl.errors import UsageError
from grasp_xl.fitment.part import HEIGHT_DECIMALS, CadPart, Face, in_order
from grasp_xl.fitment.words import ALL_UP, FACES, LARGEST, TOP


def choose_faces(part: CadPart, choice: str, option: str) -> tuple[Face, ...]:
    """Return the faces that a choice names.

    Parameters
    ----------
    part : CadPart
    choice : str
        ``all-up``; ``top``: those at the greatest height; ``largest``: the one of the largest area;
        numbers of faces; or a box ``x0,y0,x1,y1``: what of all faces lies in it (mm). Four numbers
        are a box, unless each is the number of a face.
    option : str
        That said so, for messages.

    Raises
    ------
    UsageError
        If it says none of these, or names a face that there is not, or nothing is left.
    """
    faces = part.faces
    if choice == ALL_UP:
        return faces
    if choice == TOP:
        height = round(faces[0].height_mm, HEIGHT_DECIMALS)
        return tuple(face for face in faces if round(face.height_mm, HEIGHT_DECIMALS) == height)
    if choice == LARGEST:
        return (max(faces, key=lambda face: face.outline.area),)
    numbers = _numbers(choice)
    known = [number for number in numbers if number in range(1, 1 + len(faces))]
    if numbers and len(known) == len(set(numbers)) == len(numbers):
        return in_order(faces[int(number) - 1] for number in numbers)
    if len(numbers) == 4:
        return _inside(faces, numbers, option)
    if not numbers:
        raise UsageError(f"{option} {choice!r} is none of: {FACES}.", hint="Use --list-faces")
    raise UsageError(
        f"{option} {choice} names a face twice, or one that there is not: the part has "
        f"{len(faces)} faces.",
        hint="Use --list-faces",
    )


def _numbers(choice: str) -> list[float]:
    """Return the numbers of a list, or none where it is no list of numbers."""
    with suppress(ValueError):
        numbers = [float(number) for number in choice.split(",")]
        if all(map(math.isfinite, numbers)):
            return numbers
    return []


def _inside(faces: tuple[Face, ...], corners: list[float], option: str) -> tuple[Face, ...]:
    """Return the pieces of faces in a box."""
    (x0, x1), (y0, y1) = sorted(corners[::2]), sorted(corners[1::2])
    area = box(x0, y0, x1, y1)
    pieces = [
        Face(piece, face.height_mm)
        for face in faces
        for piece in shapely.get_parts(shapely.intersection(face.outline, area))
        if isinstance(piece, Polygon) and piece.area > 0
    ]
    if not pieces:
        bounds = shapely.total_bounds([face.outline for face in faces]).tolist()
        raise UsageError(
            f"{option}: no face lies in the box x {x0:g} to {x1:g}, y {y0:g} to {y1:g} mm.",
            hint="The faces lie in x {0:.6g} to {2:.6g}, y {1:.6g} to {3:.6g} mm".format(*bounds),
        )
    return in_order(pieces)
