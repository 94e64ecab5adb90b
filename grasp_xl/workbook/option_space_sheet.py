"""Sheet ``Option Space`` (figures 25 and 26): what CAD exports, written back as it came."""

from __future__ import annotations

import math

from xlsxwriter.utility import xl_rowcol_to_cell

from grasp_xl.space import OptionSpace
from grasp_xl.workbook import layout
from grasp_xl.workbook.layout import OPTION_SPACE, Area, KindLabels
from grasp_xl.workbook.pen import Pen
from grasp_xl.workbook.space_guidance import guide_option_space
from grasp_xl.workbook.styles import Style
from grasp_xl.workbook.written import CellValue


def write_option_space(pen: Pen, space: OptionSpace, *, live: bool) -> None:
    """Write the sheet.

    Parameters
    ----------
    pen : Pen
    space : OptionSpace
    live : bool
        True in a full workbook: the ideal polygon is then a formula on the approximation polygon,
        and every value has its defined name.  False as CAD exports it: values only.
    """
    _headers(pen)
    _sections(pen, space, live=live)
    _locations(pen, space, live=live)
    _polygon(pen, space, live=live)
    if live:
        _approximation(pen, space)
        guide_option_space(pen, space)
    if live or _knows_elements(space):
        _details(pen, space, live=live)
    _look(pen, space, live=live)


def _look(pen: Pen, space: OptionSpace, *, live: bool) -> None:
    """Set widths and pages: the lists on as many as they need, then the polygons."""
    pen.sheet.freeze_panes(layout.FIRST_LOCATION_ROW, layout.INDEX_COLUMN + 1)
    pen.widths(0, 30, *[11] * (layout.POLYGON_COLUMN - 2))
    has_overlap = any(kind.overlap is not None for kind in space.kinds)
    pen.widths(layout.OVERLAP_COLUMN, 11 if has_overlap else 3)
    pen.widths(layout.POLYGON_COLUMN, 13, 11, 11, 11, 3)
    last = layout.POLYGON_COLUMN + 3
    if live:
        pen.widths(layout.APPROXIMATION_COLUMN, 5, 11, 11, 11, 3)
    if live or _knows_elements(space):
        pen.widths(layout.DETAIL_COLUMN, 26, 24)
        last = layout.DETAIL_COLUMN + 1
    places = layout.FIRST_LOCATION_ROW + max(kind.total for kind in space.kinds)
    lists = Area(OPTION_SPACE, 0, 0, max(places, 24), layout.POLYGON_COLUMN)
    corners = layout.POLYGON_HEADER_ROW + 3 + len(space.ideal_polygon_mm)
    columns = 1 + last - layout.POLYGON_COLUMN
    pen.print_pages(lists, Area(OPTION_SPACE, 0, layout.POLYGON_COLUMN, max(corners, 6), columns))
    pen.sheet.repeat_rows(0, layout.FIRST_LOCATION_ROW - 1)


def _headers(pen: Pen) -> None:
    pen.write(0, 0, layout.TITLE, Style.TITLE)
    pen.row(1, 0, ("Attribute", "Value", layout.INDEX_LABEL), Style.HEADER)
    for labels in layout.KINDS:
        header = Area(OPTION_SPACE, layout.LOCATION_HEADER_ROW, labels.column, 1, 3)
        pen.span(header, labels.locations_label, Style.HEADER)
        pen.row(2, labels.column, ("(mm)",) * 3, Style.UNIT)
        pen.row(3, labels.column, ("X", "Y", "Z"), Style.HEADER)


def _sections(pen: Pen, space: OptionSpace, *, live: bool) -> None:
    centroid = space.part.centroid_mm.tolist()
    values: list[tuple[layout.Section, tuple[CellValue, ...]]] = [
        (layout.PART, (space.part.mass_g, *centroid))
    ]
    for labels, kind in zip(layout.KINDS, space.kinds, strict=True):
        counts = (kind.count_min, kind.count_max)
        rest = (kind.force_n, kind.price, kind.weight_g, kind.total)
        values.append((labels.section, (*counts, *rest)))
    for section, data in values:
        style = Style.INPUT_MEASURE if section is layout.PART else Style.INPUT
        pen.row(section.row, 0, (section.heading, None), Style.HEADING)
        for field, value in zip(section.fields, data, strict=True):
            row = section.row_of(field.name)
            pen.write(row, 0, field.label, Style.LABEL)
            pen.write(row, 1, value, style)
            if live:
                pen.name_area(field.name, Area(OPTION_SPACE, row, 1))


def _locations(pen: Pen, space: OptionSpace, *, live: bool) -> None:
    first = layout.FIRST_LOCATION_ROW
    longest = max(kind.total for kind in space.kinds)
    for index in range(1, longest + 1):
        pen.write(first + index - 1, layout.INDEX_COLUMN, index, Style.MARK)
    for labels, kind in zip(layout.KINDS, space.kinds, strict=True):
        for row, point in enumerate(kind.footprints_mm.tolist(), first):
            pen.row(row, labels.column, point, Style.INPUT_COORDINATE)
        if kind.overlap is not None:
            pen.write(first - 1, layout.OVERLAP_COLUMN, layout.OVERLAP_LABEL, Style.HEADER)
            for row, fraction in enumerate(kind.overlap.tolist(), first):
                known = None if math.isnan(fraction) else fraction
                pen.write(row, layout.OVERLAP_COLUMN, known, Style.RATIO)
        if live and kind.total:
            area = Area(OPTION_SPACE, first, labels.column, kind.total, 3)
            pen.name_area(labels.locations_name, area)


def _polygon(pen: Pen, space: OptionSpace, *, live: bool) -> None:
    left = layout.POLYGON_COLUMN
    pen.write(0, left, layout.SCALE_FACTOR.label, Style.LABEL)
    pen.write(0, left + 1, space.scale_factor, Style.INPUT)
    pen.row(layout.POLYGON_HEADER_ROW, left, layout.POLYGON_HEADER, Style.HEADER)
    first = layout.POLYGON_HEADER_ROW + 1
    for number, point in enumerate(space.ideal_polygon_mm.tolist()):
        row = first + number
        pen.write(row, left, number + 1, Style.MARK)
        for axis, coordinate in enumerate(point):
            formula = _scaled(row, axis) if live else None
            style = Style.COORDINATE if live else Style.INPUT_COORDINATE
            pen.write(row, left + 1 + axis, coordinate, style, formula)
    row = first + len(space.ideal_polygon_mm) + 1
    pen.write(row, left, layout.CENTROID_LABEL, Style.LABEL)
    for axis, field in enumerate(layout.PART.fields[1:]):
        centre = float(space.part.centroid_mm[axis])
        formula = field.name if live else None
        pen.write(row, left + 1 + axis, centre, Style.COORDINATE, formula)
    if live:
        pen.name_area(layout.SCALE_FACTOR.name, Area(OPTION_SPACE, 0, left + 1))
        area = Area(OPTION_SPACE, first, left + 1, len(space.ideal_polygon_mm), 3)
        pen.name_area(layout.IDEAL_POLYGON, area)


def _scaled(row: int, axis: int) -> str:
    centre = layout.PART.fields[1 + axis].name
    corner = xl_rowcol_to_cell(row, layout.APPROXIMATION_COLUMN + 1 + axis)
    scale = layout.SCALE_FACTOR.name
    return f'IF(COUNT({centre},{scale},{corner})=3,{centre}+{scale}*({corner}-{centre}),"-")'


def _approximation(pen: Pen, space: OptionSpace) -> None:
    left = layout.APPROXIMATION_COLUMN
    polygon = space.approximation_polygon_mm.tolist()
    pen.span(Area(OPTION_SPACE, 0, left, 1, 4), layout.APPROXIMATION_LABEL, Style.HEADING)
    pen.row(layout.POLYGON_HEADER_ROW, left, layout.POLYGON_HEADER, Style.HEADER)
    first = layout.POLYGON_HEADER_ROW + 1
    for row, point in enumerate(polygon, first):
        pen.write(row, left, row - first + 1, Style.MARK)
        pen.row(row, left + 1, point, Style.INPUT_COORDINATE)
    area = Area(OPTION_SPACE, first, left + 1, len(polygon), 3)
    pen.name_area(layout.APPROXIMATION_POLYGON, area)


def _knows_elements(space: OptionSpace) -> bool:
    """Tell whether there is more to say of the elements than CAD exports."""
    return any(kind.diameter_mm is not None or kind.model for kind in space.kinds)


def _details(pen: Pen, space: OptionSpace, *, live: bool) -> None:
    rows: list[tuple[layout.Field, CellValue]] = []
    for labels, kind in zip(layout.KINDS, space.kinds, strict=True):
        rows += _kind_details(labels, kind.diameter_mm, kind.model)
    for row, (field, value) in enumerate(rows):
        pen.write(row, layout.DETAIL_COLUMN, field.label, Style.LABEL)
        pen.write(row, layout.DETAIL_COLUMN + 1, value, Style.INPUT)
        if live:
            pen.name_area(field.name, Area(OPTION_SPACE, row, layout.DETAIL_COLUMN + 1))
    assumed = [
        f"{size:g} mm {labels.plural}"
        for labels, size in zip(layout.KINDS, layout.DEFAULT_DIAMETERS_MM, strict=True)
    ]
    if not live:
        return
    notes = ("Where a diameter is blank, pictures assume", f"{' and '.join(assumed)}.")
    for row, note in enumerate(notes, len(rows)):
        pen.write(row, layout.DETAIL_COLUMN, note, Style.NOTE)


def _kind_details(
    labels: KindLabels, diameter: float | None, model: str
) -> list[tuple[layout.Field, CellValue]]:
    return [(labels.diameter, diameter), (labels.model, model or None)]
