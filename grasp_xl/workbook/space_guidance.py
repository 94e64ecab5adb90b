"""What guides a person who types on the sheet ``Option Space``: ranges, and notes on labels."""

from __future__ import annotations

from grasp_xl.space import MAX_COUNT, MAX_FOOTPRINTS, OptionSpace
from grasp_xl.workbook import calc_rules, layout
from grasp_xl.workbook.cells import MAX_NUMBER, MIN_DISTANCE
from grasp_xl.workbook.guidance import Accepted, accept, between, guide_input
from grasp_xl.workbook.layout import KINDS, OPTION_SPACE, Area, KindLabels
from grasp_xl.workbook.pen import Pen

PART_NOTES = (
    "Mass of the part (g); its weight W is 9.81 m/s² times that.",
    "Centre of mass of the part (mm), in the coordinates of the places.",
    "Centre of mass of the part (mm), in the coordinates of the places.",
    "Centre of mass of the part (mm); its height enters the moment with the arm 3d.",
)
SCALE_NOTE = "s: factor from the approximation polygon to the ideal one, about the centroid."
DIAMETER_NOTE = (
    "Outer diameter (mm): of the circles in the pictures, and the default of the minimum "
    "distance; may be blank."
)
COORDINATE = between("decimal", -MAX_NUMBER, MAX_NUMBER, calc_rules.ANY.words)
ABOVE_0 = between("decimal", MIN_DISTANCE, MAX_NUMBER, calc_rules.ABOVE_0.words)
FROM_0 = between("decimal", 0, MAX_NUMBER, calc_rules.FROM_0.words)
FRACTION = between("decimal", MIN_DISTANCE, 1, calc_rules.FRACTION.words)


def guide_option_space(pen: Pen, space: OptionSpace) -> None:
    """Put ranges and notes on the inputs, and ranges on the coordinates."""
    part = (ABOVE_0, COORDINATE, COORDINATE, COORDINATE)
    _guide_section(pen, layout.PART, list(zip(PART_NOTES, part, strict=True)))
    for labels in KINDS:
        _guide_section(pen, labels.section, _kind_guides(labels))
    scale = Area(OPTION_SPACE, 0, layout.POLYGON_COLUMN + 1)
    guide_input(pen, scale, layout.SCALE_FACTOR.label, SCALE_NOTE, FRACTION)
    for labels, kind, row in zip(KINDS, space.kinds, layout.DIAMETER_ROWS, strict=True):
        diameter = Area(OPTION_SPACE, row, layout.DETAIL_COLUMN + 1)
        guide_input(pen, diameter, labels.diameter.label, DIAMETER_NOTE, ABOVE_0)
        if kind.total:
            first = layout.FIRST_LOCATION_ROW
            accept(pen, Area(OPTION_SPACE, first, labels.column, kind.total, 3), COORDINATE)
    first, corners = layout.POLYGON_HEADER_ROW + 1, len(space.approximation_polygon_mm)
    corner = Area(OPTION_SPACE, first, layout.APPROXIMATION_COLUMN + 1, corners, 3)
    accept(pen, corner, COORDINATE)


def _guide_section(pen: Pen, section: layout.Section, guides: list[tuple[str, Accepted]]) -> None:
    for field, (note, accepted) in zip(section.fields, guides, strict=True):
        cell = Area(OPTION_SPACE, section.row_of(field.name), 1)
        guide_input(pen, cell, field.label, note, accepted)


def _kind_guides(labels: KindLabels) -> list[tuple[str, Accepted]]:
    """Return note and range of every input of a kind, in their order."""
    many, most = labels.plural, f"=MIN({labels.field('Max')},{labels.field('Total')})"
    return [
        (
            f"Fewest {many} of a grasp.",
            between("integer", 0, most, "a whole number from 0 to Max. and to the total"),
        ),
        (
            f"Most {many} of a grasp. For more than the cards have columns, run grasp-xl again.",
            between("integer", 0, MAX_COUNT, calc_rules.COUNT.words),
        ),
        (f"Normal force that one of the {many} holds (N), equation 11.", ABOVE_0),
        (f"Price of one of the {many} ($), equation 5.", FROM_0),
        (f"Weight of one of the {many} (g), for a note on the cards; may be blank.", FROM_0),
        (
            f"Number of places listed for {many}.",
            between("integer", 0, MAX_FOOTPRINTS, "the number of places listed"),
        ),
    ]
