"""What the options of ``fit`` may be: their words, bounds and help."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from grasp_xl.cli.options import (
    MOST,
    a_file,
    a_number,
    a_number_above_0,
    a_whole_number,
    refused,
    with_value,
)
from grasp_xl.errors import UsageError
from grasp_xl.fitment.material import MATERIALS, USUAL, Material
from grasp_xl.fitment.words import AXES, FACES, POLYGONS, UNITS

if TYPE_CHECKING:
    from grasp_xl.space import FloatArray

MOST_PARTS = 100_000
MOST_GAP_MM = 10.0
"""Wider gaps are no slips of the pen: bridges over them would join what stands apart."""

MOST_COUNT = 25
"""As many elements of a kind as a workbook has room for; a test holds them equal."""


def _polygon(text: str) -> str | FloatArray:
    """Read a way to make the polygon, or its corners."""
    if text in POLYGONS:
        return text
    expected = f"{', '.join(POLYGONS)}, or three corners or more as X,Y;X,Y;X,Y in mm"
    corners = []
    for corner in text.strip(" ;").split(";"):
        numbers: list[float] = []
        with suppress(ValueError):
            numbers = [float(word) for word in corner.split(",")]
        if len(numbers) != 2 or not all(abs(each) <= MOST for each in numbers):
            raise refused("--polygon", text, expected)
        corners.append(numbers)
    corners = [
        one for one, before in zip(corners, corners[-1:] + corners, strict=False) if one != before
    ]
    if len(corners) < 3:
        raise refused("--polygon", text, expected)
    return _outline(text, corners)


def _outline(text: str, corners: Sequence[Sequence[float]]) -> FloatArray:
    """Return the corners of a polygon that does not cross itself."""
    import shapely

    from grasp_xl.space import frozen

    outline = shapely.Polygon(corners)
    if outline.is_valid and outline.area:
        return frozen(corners)
    raise UsageError(
        f"--polygon {text!r} crosses itself or has no area.",
        where="--polygon",
        hint="Give its corners in order around the part",
    )


def _material(text: str) -> Material:
    if text in MATERIALS:
        return MATERIALS[text]
    hint = "For another one give --density, in g/cm3"
    raise refused("--material", text, f"one of {', '.join(MATERIALS)}", hint)


def _axis(text: str) -> str:
    if text in AXES:
        return text
    raise refused("--up", text, f"one of {', '.join(AXES)}", "Write it as --up=-y")


def _unit(text: str) -> str:
    if text in UNITS:
        return text
    raise refused("--units", text, f"one of {', '.join(UNITS)}")


def _counts(name: str) -> Callable[[str], tuple[int, int]]:
    """Make a parser of the fewest and the most elements of a grasp."""

    def parse(text: str) -> tuple[int, int]:
        ends = [math.nan]
        with suppress(ValueError):
            ends = [int(end) for end in text.split("-")]
        if len(ends) > 2 or not all(0 <= end <= MOST_COUNT for end in ends) or ends != sorted(ends):
            expected = f"two whole numbers from 0 to {MOST_COUNT} as 1-5, the smaller one first"
            raise refused(name, text, expected)
        if not ends[-1]:
            kind = name.removesuffix("-count")
            raise refused(name, text, "1 or more at most", f"Without {kind} there are none")
        return int(ends[0]), int(ends[-1])

    return parse


def _faces(name: str, what: str) -> Any:  # noqa: ANN401 (as typer's own)
    return with_value(name, str, "FACES", f"Faces for {what}: {FACES} (default all-up).")


PartFile = Annotated[
    Path, typer.Argument(help="STEP file of a solid, or DXF file of a flat part.", readable=False)
]
Export = Annotated[
    Path | None,
    typer.Option(
        "-o",
        "--output",
        parser=a_file("-o"),
        metavar="FILE",
        help="Exported sheet to write; needed unless --list-faces.",
    ),
]
ListFaces = Annotated[
    bool, typer.Option("--list-faces", help="List the part's faces and draw them; fit nothing.")
]
Picture = Annotated[
    Path | None,
    with_value(
        "--picture",
        a_file("--picture"),
        "FILE.svg",
        "Where --list-faces draws them (default PART-faces.svg).",
    ),
]
Cup = Annotated[
    str | None,
    with_value("--cup", str, "MODEL", "Suction cup: model or part number, see elements."),
]
Magnet = Annotated[
    str | None, with_value("--magnet", str, "MODEL", "Magnet: model or part number, see elements.")
]
CupPrice = Annotated[
    float | None,
    with_value(
        "--cup-price",
        a_number("--cup-price", f"a number from 0 to {MOST:g}", least=0),
        "$",
        "Price of a cup, where the catalogue has none.",
    ),
]
MagnetPrice = Annotated[
    float | None,
    with_value(
        "--magnet-price",
        a_number("--magnet-price", f"a number from 0 to {MOST:g}", least=0),
        "$",
        "Price of a magnet, where the catalogue has none.",
    ),
]
CupFaces = Annotated[str, _faces("--cup-faces", "cups")]
MagnetFaces = Annotated[str, _faces("--magnet-faces", "magnets")]
CupCounts = Annotated[
    Sequence[int] | None,
    with_value("--cup-count", _counts("--cup-count"), "MIN-MAX", "Cups of a grasp (default 1-5)."),
]
MagnetCounts = Annotated[
    Sequence[int] | None,
    with_value(
        "--magnet-count", _counts("--magnet-count"), "MIN-MAX", "Magnets of a grasp (default 1-5)."
    ),
]
CupAngle = Annotated[
    float,
    with_value(
        "--cup-angle",
        a_number("--cup-angle", "an angle in degrees"),
        "DEGREES",
        "Of the length of a cup that is not round, to the x-axis (default 0).",
    ),
]
MagnetAngle = Annotated[
    float,
    with_value(
        "--magnet-angle",
        a_number("--magnet-angle", "an angle in degrees"),
        "DEGREES",
        "Of the length of a magnet that is not round, to the x-axis (default 0).",
    ),
]
MinOverlap = Annotated[
    float,
    with_value(
        "--min-overlap",
        a_number("--min-overlap", "a number from 0 to 1", least=0, most=1),
        "FRACTION",
        "Least part of a magnet that lies on its face (default 0: its middle does).",
    ),
]
Pitch = Annotated[
    float,
    with_value(
        "--pitch",
        a_number_above_0("--pitch"),
        "MM",
        "Least distance of neighbouring places (default 10).",
    ),
]
Up = Annotated[
    str | None,
    with_value("--up", _axis, "AXIS", "STEP: axis that looks up, as +y or --up=-y (default +z)."),
]
Approach = Annotated[
    float | None,
    with_value(
        "--approach",
        a_number_above_0("--approach"),
        "MM",
        "STEP: least room above a face (default 100).",
    ),
]
Units = Annotated[
    str | None,
    with_value("--units", _unit, "|".join(UNITS), "DXF: unit of length, if it says none."),
]
Thickness = Annotated[
    float | None,
    with_value("--thickness", a_number_above_0("--thickness"), "MM", "DXF: of the sheet; needed."),
]
IgnoredLayers = Annotated[
    list[str] | None,
    typer.Option("--ignore-layer", metavar="NAME", help="DXF: a layer to leave out; repeatable."),
]
LargestGap = Annotated[
    float | None,
    with_value(
        "--gap",
        a_number("--gap", f"a number from 0 to {MOST_GAP_MM:g}", least=0, most=MOST_GAP_MM),
        "MM",
        "DXF: largest gap of an outline that is closed (default 0.05).",
    ),
]
PartNumber = Annotated[
    int | None,
    with_value(
        "--part",
        a_whole_number("--part", 1, MOST_PARTS),
        "N",
        "Which of several parts in the file.",
    ),
]
MaterialName = Annotated[
    Material | None,
    with_value(
        "--material",
        _material,
        "WORD",
        f"{', '.join(MATERIALS)} (default {USUAL}); magnets hold steel alone.",
    ),
]
MaterialDensity = Annotated[
    float | None,
    with_value("--density", a_number_above_0("--density"), "G/CM3", "Instead of a material."),
]
PartMass = Annotated[
    float | None,
    with_value("--mass", a_number_above_0("--mass"), "G", "Mass of the part, if it is known."),
]
Polygon = Annotated[
    Any,  # str | FloatArray: typer knows no such choice
    with_value(
        "--polygon",
        _polygon,
        "WAY",
        "Stands for the part in the deviation: auto, hull, rectangle, or X,Y;X,Y;... "
        "(default auto).",
    ),
]
Scale = Annotated[
    float,
    with_value(
        "--scale",
        a_number("--scale", "a number above 0, at most 1", least=1e-9, most=1),
        "FACTOR",
        "From that polygon to the ideal one (default 0.6).",
    ),
]
