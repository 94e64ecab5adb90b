"""From a sheet to an option space: what the cells say, and what is wrong with them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from grasp_xl.errors import InputError, Problem
from grasp_xl.polygon import contains, is_star_shaped
from grasp_xl.space import (
    MAX_COUNT,
    ElementKind,
    FloatArray,
    OptionSpace,
    Part,
    frozen,
    unscaled_polygon,
)
from grasp_xl.workbook import layout
from grasp_xl.workbook.cells import (
    LABEL_ROWS,
    Fault,
    Grid,
    Source,
    as_number,
    cells_of,
    is_blank,
    normal,
    shown,
)
from grasp_xl.workbook.layout import Area, Field, KindLabels, Section, place
from grasp_xl.workbook.package import read_package

MAX_FOOTPRINTS = 200_000
"""Footprints of one kind that are read."""

MAX_VERTICES = 10_000
"""Vertices of the polygon that are read."""

CENTROID_TOLERANCE_MM = 1e-6

MIN_FATNESS = 1e-12
"""Least area of what the polygon's corners span, over its extent squared; else it is a line."""

SECTIONS = (layout.PART, *(labels.section for labels in layout.KINDS))

A_COUNT = f"a whole number from 0 to {MAX_COUNT}"
A_FRACTION = "a fraction from 0 to 1, or nothing"
A_COORDINATE = "a coordinate (mm)"
A_POLYGON = "three or more corners around an area, without crossing"
CHOOSE_CORNERS = "correct the corners, or choose the polygon again in CAD"
RESTORE_LABEL = "restore the label, or export the option space again"


def open_source(path: Path) -> Source:
    """Open a workbook for reading.

    Raises
    ------
    InputError
        If the file is no whole and harmless workbook.
    """
    return Source(read_package(path))


def read_option_space(source: Source) -> OptionSpace:
    """Read the option space of an exported sheet or of a full workbook.

    Raises
    ------
    InputError
        If it cannot be used, with every problem found in the workbook by then.
    """
    sheet, before = find_sheet(source), len(source.problems)
    part = _part(source, sheet)
    starts = [_list_start(source, sheet, labels) for labels in layout.KINDS]
    lists = [
        _footprints(source, start, labels) if start else None
        for start, labels in zip(starts, layout.KINDS, strict=True)
    ]
    kinds = [
        _kind(source, sheet, labels, start, footprints)
        for labels, start, footprints in zip(layout.KINDS, starts, lists, strict=True)
    ]
    _check_lists(source, sheet, starts, lists)
    polygon = _polygon(source, sheet, part)
    if len(source.problems) > before:
        source.finish()
    if part is None or polygon is None or None in kinds:
        raise AssertionError("finish() has raised what is missing")
    space = OptionSpace(part, tuple(kind for kind in kinds if kind), *polygon)
    _look_at_polygon(source, sheet, space)
    return space


def find_sheet(source: Source) -> str:
    """Return the name of the option-space sheet: by its names, else by its title cell.

    Raises
    ------
    InputError
        If there is none, or more than one.
    """
    mass = layout.PART.fields[0].name
    if mass in source.names:
        return source.names[mass].sheet
    titles = list(source.sheets_with(layout.TITLE))
    expected = f"one sheet with the title {layout.TITLE!r}"
    if not titles:
        hint = "export the option space from CAD into this workbook"
        name = source.package.name
        raise InputError([Problem(name, "no option-space sheet", expected, hint)])
    first, *others = titles
    found = f"an option space besides that of the sheet {first.sheet!r}"
    hint = "delete all but one, or move them to workbooks of their own"
    if others:
        raise InputError([Problem(other.where, found, expected, hint) for other in others])
    return first.sheet


# --- labels and single values ---


def _usual(source: Source, sheet: str, row: int, column: int) -> Area:
    """Return where a cell stands in relation to the title."""
    title = source.grid(sheet).find(layout.TITLE) or Area(sheet, 0, 0)
    return title.cell(row, column)


def _miss(source: Source, cell: Area, label: str) -> None:
    value = source.value(cell)
    found = "an empty cell" if is_blank(value) else repr(value)
    source.complain(cell.where, found, label, RESTORE_LABEL)


def _section(source: Source, sheet: str, section: Section) -> dict[str, Area]:
    """Find the input cells of a section, by defined name."""
    heading = source.grid(sheet).find(section.heading)
    rows = _section_rows(source.grid(sheet), heading) if heading else range(0)
    column = heading.column if heading else None
    cells = {
        field.name: source.locate(sheet, field, rows=rows, column=column)
        for field in section.fields
    }
    missing = [n for n, field in enumerate(section.fields) if cells[field.name] is None]
    if missing and heading is None:
        _miss(source, _usual(source, sheet, section.row, 0), f"the heading {section.heading!r}")
    elif heading:
        for number in missing:
            label = f"the label {section.fields[number].label!r} under {section.heading!r}"
            _miss(source, heading.cell(1 + number, 0), label)
    return {name: cell for name, cell in cells.items() if cell}


def _section_rows(grid: Grid, heading: Area) -> range:
    """Rows from a heading to the next one: both kinds have a ``Unit price ($)``, say."""
    below = range(heading.row + 1, LABEL_ROWS)
    headings = (grid.find(s.heading, rows=below, column=heading.column) for s in SECTIONS)
    return range(below.start, min((found.row for found in headings if found), default=LABEL_ROWS))


def _part(source: Source, sheet: str) -> Part | None:
    cells = _section(source, sheet, layout.PART)
    mass_cell = cells.get("PartMass")
    mass = source.number(mass_cell, "a mass above 0 g", above=0) if mass_cell else None
    centroid = [
        source.number(cell, A_COORDINATE) if (cell := cells.get(name)) else None
        for name in ("CentroidX", "CentroidY", "CentroidZ")
    ]
    if mass is None or None in centroid:
        return None
    return Part(mass, frozen(centroid))


# --- kinds ---


def _kind(
    source: Source,
    sheet: str,
    labels: KindLabels,
    start: Area | None,
    footprints: FloatArray | None,
) -> ElementKind | None:
    cells = _section(source, sheet, labels.section)

    def cell(suffix: str) -> Area | None:
        return cells.get(labels.field(suffix))

    count_min, count_max = _count(source, cell("Min")), _count(source, cell("Max"))
    force_cell, price_cell, weight_cell = cell("Force"), cell("Price"), cell("Weight")
    force = source.number(force_cell, "a force above 0 N", above=0) if force_cell else None
    price = source.number(price_cell, "a price of 0 $ or more", least=0) if price_cell else None
    weight = None
    if weight_cell and not source.blank(weight_cell):
        weight = source.number(weight_cell, "a weight of 0 g or more, or nothing", least=0)
    _check_total(source, labels, cells, start, footprints)
    if footprints is not None:
        _check_counts(source, labels, cells, count_min, count_max, len(footprints))
    diameter, model = _diameter(source, sheet, labels.diameter), _model(source, sheet, labels.model)
    if count_min is None or count_max is None or force is None or price is None:
        return None
    if footprints is None:
        return None
    return ElementKind(
        name=labels.kind,
        force_n=force,
        price=price,
        count_min=count_min,
        count_max=count_max,
        footprints_mm=footprints,
        weight_g=weight,
        diameter_mm=diameter,
        model=model,
        overlap=_overlap(source, labels, start, len(footprints)),
    )


def _count(source: Source, cell: Area | None) -> int | None:
    if cell is None:
        return None
    count = source.number(cell, A_COUNT, least=0, most=MAX_COUNT, whole=True)
    return None if count is None else int(count)


def _overlap(
    source: Source, labels: KindLabels, start: Area | None, length: int
) -> FloatArray | None:
    """Read the covered area fraction of each footprint, where the sheet has that column."""
    header = source.grid(start.sheet).find(layout.OVERLAP_LABEL) if start else None
    if header is None or start is None or labels.kind != layout.OVERLAP_KIND:
        return None
    fractions = []
    for number in range(length):
        cell = Area(start.sheet, start.row + number, header.column)
        blank = source.blank(cell)
        fraction = None if blank else source.number(cell, A_FRACTION, least=0, most=1)
        fractions.append(math.nan if fraction is None else fraction)
    return frozen(fractions)


def _diameter(source: Source, sheet: str, field: Field) -> float | None:
    cell = source.locate(sheet, field)
    if cell is None or source.blank(cell):
        return None
    return source.number(cell, "a diameter above 0 mm, or nothing", above=0)


def _model(source: Source, sheet: str, field: Field) -> str:
    cell = source.locate(sheet, field)
    value = source.value(cell) if cell else None
    return "" if value is None else str(value)


def _check_total(
    source: Source,
    labels: KindLabels,
    cells: dict[str, Area],
    start: Area | None,
    footprints: FloatArray | None,
) -> None:
    cell = cells.get(labels.field("Total"))
    if cell is None or start is None:
        return
    total = as_number(source.value(cell))
    if footprints is not None and total == len(footprints):  # no second look at long lists
        return
    rows, below = _listed_rows(source.grid(start.sheet), start)
    listed = len(rows) + len(below)
    if total in (len(rows), listed):  # a gap is told by itself
        return
    behind = start.cell(len(rows), 0)
    if source.formula(behind) is None:
        source.number(
            cell,
            f"{listed}, the number of {labels.plural} listed",
            least=listed,
            most=listed,
            hint="correct the total or the list, or export the option space again",
        )
    elif not below:
        source.number(behind, A_COORDINATE)  # the list goes on, in formulas without values


def _check_counts(
    source: Source,
    labels: KindLabels,
    cells: dict[str, Area],
    low: int | None,
    high: int | None,
    listed: int,
) -> None:
    if low is None:
        return
    where = cells[labels.field("Min")].where
    if high is not None and low > high:
        source.complain(
            where, f"a minimum of {low}", f"at most the maximum, {high}", "lower Min. or raise Max."
        )
    elif low > listed:
        source.complain(
            where,
            f"a minimum of {low}",
            f"at most {listed}, the number of {labels.plural} listed",
            "lower Min., or fit more footprints on the part",
        )


# --- footprints ---


def _list_start(source: Source, sheet: str, labels: KindLabels) -> Area | None:
    """Find the first coordinate of a kind's list: by name, else below its header."""
    named = source.names.get(labels.locations_name)
    if named and named.sheet == sheet and named.columns == 3:
        return named.cell(0, 0)
    header = source.grid(sheet).find(labels.locations_label)
    if header is None:
        usual = _usual(source, sheet, layout.LOCATION_HEADER_ROW, labels.column)
        _miss(source, usual, f"the label {labels.locations_label!r}")
        return None
    return header.cell(layout.FIRST_LOCATION_ROW - layout.LOCATION_HEADER_ROW, 0)


def _footprints(source: Source, start: Area, labels: KindLabels) -> FloatArray | None:
    grid = source.grid(start.sheet)
    rows, below = _listed_rows(grid, start)
    length = len(rows)
    gap = start.cell(length, 0)
    if below and source.formula(gap) is not None:
        source.number(gap, A_COORDINATE)
        return None
    if below:
        source.complain(
            gap.where,
            f"an empty row, and a coordinate below it in row {below[0] + 1:,}",
            f"a list of {labels.plural} without gaps",
            "delete the empty rows, or what stands below them",
        )
        return None
    if length > MAX_FOOTPRINTS:
        source.complain(
            start.cell(MAX_FOOTPRINTS, 0).where,
            f"{length:,} {labels.plural}",
            f"at most {MAX_FOOTPRINTS:,}",
            "use a larger pitch",
        )
        return None
    points = _coordinates(source, grid, start, length)
    if points is not None:
        _check_twins(source, start, labels, points)
    return points


def _listed_rows(grid: Grid, start: Area) -> tuple[list[int], list[int]]:
    """Rows of a list up to its first empty one, and those of the footprints below that."""
    columns = slice(start.column, start.column + 3)
    filled = [
        row
        for row, values in grid.rows.items()
        if row >= start.row and not all(is_blank(value) for value in values[columns])
    ]
    length = next((n for n, row in enumerate(filled) if row != start.row + n), len(filled))
    below = [row for row in filled[length:] if _has_number(grid, row, start.column)]
    return filled[:length], below


def _has_number(grid: Grid, row: int, column: int) -> bool:
    """Tell a footprint from a note, which may stand below a list."""
    return any(isinstance(grid.at(row, column + axis), int | float) for axis in range(3))


def _coordinates(source: Source, grid: Grid, start: Area, length: int) -> FloatArray | None:
    before = len(source.problems)
    points = np.zeros((length, 3))
    for number in range(length):
        for axis in range(3):
            value = as_number(grid.at(start.row + number, start.column + axis))
            if isinstance(value, Fault):
                source.number(start.cell(number, axis), A_COORDINATE)
            else:
                points[number, axis] = value
    return frozen(points) if len(source.problems) == before else None


def _check_twins(source: Source, start: Area, labels: KindLabels, points: FloatArray) -> None:
    seen: dict[tuple[float, ...], int] = {}
    for number, point in enumerate(map(tuple, points.tolist())):
        first = seen.setdefault(point, number)
        if first != number:
            source.complain(
                start.cell(number, 0).where,
                f"the place of index {first + 1} again",
                f"{labels.plural} at places of their own",
                "delete one of them, or export the option space again",
            )


def _check_lists(
    source: Source,
    sheet: str,
    starts: Sequence[Area | None],
    lists: Sequence[FloatArray | None],
) -> None:
    """Check what both lists must have together: a footprint, and an index beside each row."""
    first = starts[0]
    if first and all(footprints is not None and not len(footprints) for footprints in lists):
        hint = "choose the faces again and export the option space again"
        source.complain(first.where, "no footprint at all", "places of cups or magnets", hint)
    longest = max((len(footprints) for footprints in lists if footprints is not None), default=0)
    label = source.grid(sheet).find(layout.INDEX_LABEL)
    if label is None:
        return
    index = label.cell(layout.FIRST_LOCATION_ROW - layout.LOCATION_HEADER_ROW, 0)
    for row in range(longest):
        cell, number = index.cell(row, 0), row + 1
        if as_number(source.value(cell)) != number:
            hint = "number the footprints 1, 2, 3, ... without gaps"
            source.number(cell, f"the index {number}", least=number, most=number, hint=hint)
            return


# --- polygon ---


def _polygon(source: Source, sheet: str, part: Part | None) -> tuple[FloatArray, float] | None:
    """Read the approximation polygon and the scale factor."""
    scale = _scale_factor(source, sheet)
    ideal = _ideal_area(source, sheet)
    if ideal is None:
        usual = _usual(source, sheet, layout.POLYGON_HEADER_ROW, layout.POLYGON_COLUMN)
        header = " ".join(layout.POLYGON_HEADER)
        _miss(source, usual, f"the header {header!r} of the ideal polygon, in four cells")
        return None
    approximation = None if _is_typed(source, ideal) else _approximation_area(source, sheet)
    polygon = _vertices(source, approximation or ideal)
    if polygon is None or scale is None or part is None:
        return None
    if approximation is None:
        polygon = unscaled_polygon(polygon, part.centroid_mm, scale)
    return polygon, scale


def _scale_factor(source: Source, sheet: str) -> float | None:
    cell = source.locate(sheet, layout.SCALE_FACTOR)
    if cell is None:
        usual = _usual(source, sheet, 0, layout.POLYGON_COLUMN)
        _miss(source, usual, f"the label {layout.SCALE_FACTOR.label!r}")
        return None
    return source.number(cell, "a scale factor above 0 and at most 1", above=0, most=1)


def _ideal_area(source: Source, sheet: str) -> Area | None:
    """Find the ideal polygon's x, y, z cells: by name, else below the header i, x, y, z."""
    named = source.names.get(layout.IDEAL_POLYGON)
    if named and named.columns == 3:
        return corner_cells(source, named)
    grid = source.grid(sheet)
    for header in grid.places(layout.POLYGON_HEADER[0]):
        titles = [str(grid.at(header.row, header.column + n)) for n in range(4)]
        if tuple(map(normal, titles)) == layout.POLYGON_HEADER:
            return corner_cells(source, Area(sheet, header.row + 1, header.column + 1, 0, 3))
    return None


def _approximation_area(source: Source, sheet: str) -> Area | None:
    """Find the x, y, z cells of the polygon before scaling: by name, else below its label."""
    named = source.names.get(layout.APPROXIMATION_POLYGON)
    if named and named.columns == 3:
        return corner_cells(source, named)
    label = source.grid(sheet).find(layout.APPROXIMATION_LABEL)
    if label is None:
        return None
    return corner_cells(source, Area(sheet, label.row + 2, label.column + 1, 0, 3))


def corner_cells(source: Source, area: Area) -> Area:
    """Return the corners of a polygon, which may have grown or shrunk below its name's area."""
    if area.rows > MAX_VERTICES:  # a name of whole columns, say: refused as it is
        return area
    grid = source.grid(area.sheet)
    rows = 0
    while _is_vertex(grid, area.cell(rows, 0)):
        rows += 1
    gaps = [row for row in range(rows, area.rows) if _is_vertex(grid, area.cell(row, 0))]
    return replace(area, rows=1 + gaps[-1] if gaps else rows)


def _is_vertex(grid: Grid, cell: Area) -> bool:
    """Tell whether there is anything in a row of a polygon: in x, y, z or the index before it."""
    values = [grid.at(cell.row, cell.column + n) for n in (-1, 0, 1, 2) if cell.column + n >= 0]
    is_centroid = isinstance(values[0], str) and normal(values[0]) == normal(layout.CENTROID_LABEL)
    return not is_centroid and not all(is_blank(value) for value in values)


def _is_typed(source: Source, ideal: Area) -> bool:
    """Tell whether any cell of the ideal polygon is a value, and not a formula of ours.

    Blank cells are formulas that a program lost when it saved.
    """
    return any(
        source.formula(cell) is None and not source.blank(cell)
        for row in cells_of(ideal)
        for cell in row
    )


def _vertices(source: Source, area: Area) -> FloatArray | None:
    before = len(source.problems)
    if not 3 <= area.rows <= MAX_VERTICES:
        expected = f"3 to {MAX_VERTICES:,} corners"
        source.complain(area.where, f"{area.rows:,} corners", expected, CHOOSE_CORNERS)
        return None
    numbers = [[source.number(cell, A_COORDINATE) for cell in row] for row in cells_of(area)]
    if len(source.problems) == before:
        _check_polygon(source, area, np.array(numbers, dtype=np.float64))
    return frozen(numbers) if len(source.problems) == before else None


def _check_polygon(source: Source, area: Area, polygon: FloatArray) -> None:
    import shapely

    corners = polygon[:, :2]
    steps = np.roll(corners, -1, axis=0) - corners
    (repeated,) = np.nonzero(~steps.any(axis=1))
    if len(repeated):
        row = min(int(repeated[0]) + 1, len(polygon) - 1)  # of a closed outline, the last
        where = area.cell(row, 0).where
        source.complain(where, "the corner next to it again", A_POLYGON, "delete this corner")
        return
    outline = shapely.Polygon(corners)
    spanned = outline.convex_hull.area / float(np.ptp(corners, axis=0).max()) ** 2
    if spanned <= MIN_FATNESS:
        source.complain(area.where, "a polygon without area", A_POLYGON, CHOOSE_CORNERS)
    elif not outline.is_valid:
        found = f"a polygon that crosses itself ({shapely.is_valid_reason(outline)})"
        source.complain(area.where, found, A_POLYGON, CHOOSE_CORNERS)


def _look_at_polygon(source: Source, sheet: str, space: OptionSpace) -> None:
    """Warn of a polygon that the deviation criterion was not made for (section 3.2)."""
    area = _ideal_area(source, sheet)
    where = area.where if area else place(sheet, 0, 0)
    polygon, centroid = space.approximation_polygon_mm, space.part.centroid_mm
    if not contains(polygon, centroid):
        source.warn(
            where,
            "the part's centroid outside the polygon",
            "it inside",
            "choose the polygon's corners so that they surround the centroid",
        )
    elif not is_star_shaped(polygon, centroid):
        source.warn(
            where,
            "a polygon that is not star-shaped about the part's centroid",
            "every edge in sight of the centroid",
            "the ideal polygon may leave the part; choose fewer corners (thesis, section 3.2)",
        )
    repeated = source.grid(sheet).find(layout.CENTROID_LABEL)
    if repeated:
        _look_at_centroid(source, repeated, centroid)


def _look_at_centroid(source: Source, label: Area, centroid: FloatArray) -> None:
    """Warn where the centroid under the polygon is not the part's."""
    for axis, coordinate in enumerate(centroid.tolist()):
        cell = label.cell(0, 1 + axis)
        value = as_number(source.value(cell))
        tolerance = CENTROID_TOLERANCE_MM * max(1.0, abs(coordinate))
        if isinstance(value, float) and abs(value - coordinate) > tolerance:
            source.warn(
                cell.where,
                shown(value),
                f"the part's centroid, {shown(coordinate)}",
                "it is not used; export the option space again if in doubt",
            )
