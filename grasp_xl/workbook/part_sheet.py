"""Sheet ``Part``: what a part's option space was fitted from, and the outlines of its faces."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from grasp_xl.space import FloatArray
from grasp_xl.workbook.layout import PART_SHEET, Area
from grasp_xl.workbook.pen import Pen
from grasp_xl.workbook.styles import Style
from grasp_xl.workbook.written import CellValue

PART_TITLE = "PART AND FACES (ALL DATA in GRAMS and MILLIMETERS)"
HEADER_ROW = 2
FIRST_ROW = HEADER_ROW + 1
FACT_HEADER = ("Attribute", "Value")
FACE_COLUMN = 3
FACE_HEADER = ("Face", "Z", "Area (mm2)", "Used for")
OUTLINE_COLUMN = 8
OUTLINE_HEADER = ("Face", "Ring", "X", "Y")
WHOLE = 0
"""Number of the outline of the whole part in plan view, which is at no height."""

SOURCE_FILE = "Source file"
SHA_256 = "SHA-256"
PART_OF_FILE = "Part of the file"
UP_AXIS = "Axis that looks up"
THICKNESS = "Sheet thickness (mm)"
CUP_ANGLE, MAGNET_ANGLE = "Cup angle (deg)", "Magnet angle (deg)"
"""Labels of the facts that programs read."""

Facts = tuple[tuple[str, CellValue], ...]
"""What is said of a part: label and value."""


@dataclass(frozen=True, eq=False, slots=True)
class FaceOutline:
    """A face, or the whole part in plan view.

    Parameters
    ----------
    number : int
        From 1; 0 for the whole part.
    height_mm : float or None
    area_mm2 : float
    used_for : str
    rings : tuple of FloatArray
        ``(n, 2)`` corners (mm) of each: outlines and holes, by even-odd nesting.
    """

    number: int
    height_mm: float | None
    area_mm2: float
    used_for: str
    rings: tuple[FloatArray, ...]


@dataclass(frozen=True, eq=False, slots=True)
class PartRecord:
    """What the sheet says."""

    facts: Facts
    outlines: tuple[FaceOutline, ...]

    def fact(self, label: str) -> CellValue:
        """Return what is said under a label; None where nothing is."""
        return dict(self.facts).get(label)


def write_part(pen: Pen, record: PartRecord) -> None:
    """Write the sheet: facts, then a row a face, then a row a corner of its rings."""
    pen.write(0, 0, PART_TITLE, Style.TITLE)
    _table(pen, 0, FACT_HEADER, record.facts, (Style.LABEL, Style.TEXT))
    styles = (Style.MARK, Style.COORDINATE, Style.TORQUE, Style.TEXT)
    faces = [
        (face.number, face.height_mm, face.area_mm2, face.used_for) for face in record.outlines
    ]
    _table(pen, FACE_COLUMN, FACE_HEADER, faces, styles)
    styles = (Style.MARK, Style.MARK, Style.COORDINATE, Style.COORDINATE)
    corners = list(_corners(record))
    _table(pen, OUTLINE_COLUMN, OUTLINE_HEADER, corners, styles)
    pen.sheet.freeze_panes(FIRST_ROW, 0)
    pen.widths(0, 26, 66, 3, 8, 11, 14, 24, 3, 8, 8, 11, 11)
    rows = FIRST_ROW + max(len(record.facts), len(faces))
    outlines = Area(PART_SHEET, HEADER_ROW, OUTLINE_COLUMN, 1 + len(corners), len(OUTLINE_HEADER))
    pen.print_pages(Area(PART_SHEET, 0, 0, rows, OUTLINE_COLUMN - 1), outlines)


def _table(
    pen: Pen,
    column: int,
    header: tuple[str, ...],
    rows: Iterable[tuple[CellValue, ...]],
    styles: tuple[Style, ...],
) -> None:
    pen.row(HEADER_ROW, column, header, Style.HEADER)
    for row, values in enumerate(rows, FIRST_ROW):
        for offset, (value, style) in enumerate(zip(values, styles, strict=True)):
            pen.write(row, column + offset, value, style)


def _corners(record: PartRecord) -> Iterator[tuple[CellValue, ...]]:
    for face in record.outlines:
        for ring, corners in enumerate(face.rings, 1):
            for x, y in corners.tolist():
                yield face.number, ring, x, y
