"""A design as an assembly: part, elements and frame, each piece with name and colour."""

from __future__ import annotations

from dataclasses import dataclass

from grasp_xl.bill import ELEMENT_WORDS
from grasp_xl.space import FloatArray, frozen
from grasp_xl.view.scene import Scene
from grasp_xl.view.solids import Bar, Solid
from grasp_xl.workbook.styles import CYAN, MAGENTA, RED

MARK = "grasp_xl view"
"""Stands in every file that shows a design: such a file may be replaced without asking."""

PART_COLOUR = "#B4BBC4"
ELEMENT_COLOURS = (CYAN, MAGENTA)
MAIN_COLOUR, BRANCH_COLOUR, POST_COLOUR = RED, "#E0707F", "#8A929C"
PART, ELEMENTS, FRAME = "Part", ("Suction cups", "Magnets"), "Frame"
"""Groups of an assembly."""

ORIGIN = frozen([0, 0, 0])


@dataclass(frozen=True, slots=True)
class Piece:
    """A solid of an assembly.

    Parameters
    ----------
    group, name : str
    colour : str
        As ``#RRGGBB``.
    solids : tuple of Solid
        About its place.
    place_mm : FloatArray
        ``(3,)``.
    """

    group: str
    name: str
    colour: str
    solids: tuple[Solid, ...]
    place_mm: FloatArray


def pieces_of(scene: Scene) -> list[Piece]:
    """Return all pieces of the shown design but the solid of the part's file."""
    grip = scene.grip(scene.shown)
    pieces = [
        Piece(PART, f"{scene.part.name} ({number})", PART_COLOUR, (plate,), ORIGIN)
        for number, plate in enumerate(scene.part.plates, 1)
    ]
    for each in grip.elements:
        name = f"{kind_name(scene, each.kind)}, index {each.index}"
        pieces.append(
            Piece(
                ELEMENTS[each.kind],
                name,
                ELEMENT_COLOURS[each.kind],
                scene.models[each.kind].solids,
                each.place_mm,
            )
        )
    for name, bars, colour in (
        ("Main truss", grip.frame.main, MAIN_COLOUR),
        ("Branch", grip.frame.branches, BRANCH_COLOUR),
        ("Post", grip.frame.posts, POST_COLOUR),
    ):
        for number, bar in enumerate(bars, 1):
            numbered = name if name == "Main truss" else f"{name} {number}"
            pieces.append(_of_bar(numbered, bar, colour))
    return pieces


def rgb(colour: str) -> tuple[float, float, float]:
    """Return red, green and blue of a colour, from 0 to 1.

    Examples
    --------
    >>> rgb("#FF0033")
    (1.0, 0.0, 0.2)
    """
    red, green, blue = (int(colour[at : at + 2], 16) / 255 for at in (1, 3, 5))
    return red, green, blue


def kind_name(scene: Scene, kind: int) -> str:
    """Return the model of a kind, or what it is."""
    return scene.task.space.kinds[kind].model or ELEMENT_WORDS[kind]


def _of_bar(name: str, bar: Bar, colour: str) -> Piece:
    return Piece(FRAME, name, colour, (bar,), ORIGIN)
