"""From a sheet to an option space: what the cells say, and what is wrong with them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from grasp_xl.errors import InputError, Problem
from grasp_xl.polygon import contains, is_star_shaped
from grasp_xl.space import (
    ElementKind,
    FloatArray,
    OptionSpace,
    Part,
    frozen,
    unscaled_polygon,
)
from grasp_xl.workbook import layout
from grasp_xl.workbook.cells import MAX_NUMBER, Grid, Source, Value, cells_of, number_fault
from grasp_xl.workbook.layout import Area, Field, KindLabels, Section, place
from grasp_xl.workbook.package import read_package

MAX_FOOTPRINTS = 200_000
"""Footprints of one kind that are read."""

MAX_COUNT = 100
"""Largest # Max. of a kind."""

MAX_VERTICES = 10_000
"""Vertices of the polygon that are read."""

CENTROID_TOLERANCE_MM = 1e-6


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
        With every problem found.
    """
    sheet = find_sheet(source)
    part = _part(source, sheet)
    kinds = [_kind(source, sheet, labels) for labels in layout.KINDS]
    for kind, labels in zip(kinds, layout.KINDS, strict=True):
        _check_counts(source, sheet, labels, kind)
    if not any(kind and kind.total for kind in kinds):
        source.complain(sheet, "no footprints at all", "cup or magnet locations", "export it again")
    polygon = _polygon(source, sheet, part)
    source.finish()
    if part is None or polygon is None or None in kinds:  # finish() has raised
        raise AssertionError
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
    titled = [sheet for sheet in source.sheets if source.grid(sheet).find(layout.TITLE)]
    if len(titled) == 1:
        return titled[0]
    found = "no option-space sheet" if not titled else f"{len(titled)}: {', '.join(titled)}"
    raise InputError(
        [
            Problem(
                source.package.name,
                found,
                f"one sheet with the title {layout.TITLE!r}",
                "export the option space from CAD into this workbook"
                if not titled
                else "delete or move all but one",
            )
        ]
    )


@dataclass(frozen=True)
class _Cells:
    """Input cells of a section that were found, by defined name."""

    found: dict[str, Area]

    def get(self, name: str) -> Area | None:
        return self.found.get(name)


def _section(source: Source, sheet: str, section: Section) -> _Cells:
    heading = source.grid(sheet).find(section.heading)
    cells: dict[str, Area] = {}
    for number, field in enumerate(section.fields):
        cell = None
        if heading or field.name in source.names:
            cell = source.locate(sheet, field, heading=heading)
        if cell:
            cells[field.name] = cell
        else:
            source.complain(
                place(sheet, section.row + 1 + number, 0),
                "no such label",
                f"{field.label!r} under {section.heading!r}",
                "restore the label, or export the option space again",
            )
    return _Cells(cells)


def _part(source: Source, sheet: str) -> Part | None:
    cells = _section(source, sheet, layout.PART)
    mass_cell = cells.get("PartMass")
    mass = source.number(mass_cell, "a mass above 0 g", above=0) if mass_cell else None
    centroid = [
        source.number(cell, "a coordinate (mm)") if (cell := cells.get(name)) else None
        for name in ("CentroidX", "CentroidY", "CentroidZ")
    ]
    if mass is None or None in centroid:
        return None
    return Part(mass, frozen(centroid))


def _kind(source: Source, sheet: str, labels: KindLabels) -> ElementKind | None:
    cells = _section(source, sheet, labels.section)

    def number(suffix: str, expected: str, **bounds: float) -> float | None:
        cell = cells.get(labels.field(suffix))
        whole = bounds.pop("whole", 0) > 0
        return source.number(cell, expected, whole=whole, **bounds) if cell else None

    bounds = {"least": 0.0, "most": float(MAX_COUNT), "whole": 1.0}
    count_min = number("Min", f"a whole number from 0 to {MAX_COUNT}", **bounds)
    count_max = number("Max", f"a whole number from 0 to {MAX_COUNT}", **bounds)
    force = number("Force", "a force above 0 N", above=0)
    price = number("Price", "a price of 0 $ or more", least=0)
    total = number("Total", "a whole number of 0 or more", least=0, whole=1)
    weight_cell = cells.get(labels.field("Weight"))
    weight = None
    if weight_cell and not source.blank(weight_cell):
        weight = source.number(weight_cell, "a weight of 0 g or more, or nothing", least=0)
    footprints = _locations(source, sheet, labels)
    total_cell = cells.get(labels.field("Total"))
    if footprints is not None and total is not None and total_cell and total != len(footprints):
        source.complain(
            total_cell.where,
            f"{total:g}",
            f"{len(footprints)}, the number of {labels.plural} listed",
            "correct the total or the list, or export the option space again",
        )
    if None in (count_min, count_max, force, price, total) or footprints is None:
        return None
    return ElementKind(
        name=labels.kind,
        force_n=force or 0.0,
        price=price or 0.0,
        count_min=int(count_min or 0),
        count_max=int(count_max or 0),
        footprints_mm=footprints,
        weight_g=weight,
        diameter_mm=_diameter(source, sheet, labels.diameter),
        model=_model(source, sheet, labels.model),
    )


def _diameter(source: Source, sheet: str, field: Field) -> float | None:
    cell = source.locate(sheet, field)
    if cell is None or source.blank(cell):
        return None
    return source.number(cell, "a diameter above 0 mm, or nothing", above=0)


def _model(source: Source, sheet: str, field: Field) -> str:
    cell = source.locate(sheet, field)
    value = source.value(cell) if cell else None
    return "" if value is None else str(value)


def _check_counts(source: Source, sheet: str, labels: KindLabels, kind: ElementKind | None) -> None:
    if kind is None:
        return
    where = place(sheet, labels.section.row_of(labels.field("Min")), 1)
    if labels.field("Min") in source.names:
        where = source.names[labels.field("Min")].where
    if kind.count_min > kind.count_max:
        source.complain(
            where,
            f"a minimum of {kind.count_min}",
            f"at most the maximum, {kind.count_max}",
            "lower Min. or raise Max.",
        )
    elif kind.count_min > kind.total:
        source.complain(
            where,
            f"a minimum of {kind.count_min} but {kind.total} {labels.plural} listed",
            f"at least {kind.count_min} footprints",
            "lower Min., or fit more footprints on the part",
        )


# --- footprints ---


def _locations(source: Source, sheet: str, labels: KindLabels) -> FloatArray | None:
    grid = source.grid(sheet)
    header = grid.find(labels.locations_label)
    if header is None:
        source.complain(
            place(sheet, layout.LOCATION_HEADER_ROW, labels.column),
            "no such label",
            repr(labels.locations_label),
            "restore the label, or export the option space again",
        )
        return None
    first = header.row + layout.FIRST_LOCATION_ROW - layout.LOCATION_HEADER_ROW
    column = header.column
    named = source.names.get(labels.locations_name)
    if named and named.sheet == sheet and named.columns == 3:
        first, column = named.row, named.column
    rows = _filled_rows(grid, first, column)
    if len(rows) > MAX_FOOTPRINTS:
        source.complain(
            place(sheet, rows[MAX_FOOTPRINTS], column),
            f"{len(rows):,} {labels.plural}",
            f"at most {MAX_FOOTPRINTS:,}",
            "use a larger pitch",
        )
        return None
    before = len(source.problems)
    points = _coordinates(source, grid, rows, first, column)
    index = grid.find(layout.INDEX_LABEL)
    if index and index.row == header.row:
        _check_index(source, grid, rows, first, index.column)
    if len(source.problems) > before:
        return None
    _check_twins(source, sheet, labels, points, first, column)
    return frozen(points.reshape(-1, 3))


def _filled_rows(grid: Grid, first: int, column: int) -> list[int]:
    """Rows from ``first`` on that hold anything in the three columns of a location."""
    return sorted(
        row
        for row, cells in grid.rows.items()
        if row >= first and any(value is not None for value in cells[column : column + 3])
    )


def _coordinates(
    source: Source, grid: Grid, rows: list[int], first: int, column: int
) -> FloatArray:
    points = np.zeros((len(rows), 3))
    for number, row in enumerate(rows):
        if row != first + number:
            source.complain(
                place(grid.sheet, first + number, column),
                "an empty row between footprints",
                "a list without gaps",
                "delete the empty rows, or export the option space again",
            )
            return points
        values = [grid.at(row, column + axis) for axis in range(3)]
        for axis, value in enumerate(values):
            if type(value) is float or type(value) is int:
                points[number, axis] = value
    bad = ~(np.abs(points) <= MAX_NUMBER).all(axis=1)
    for number, row in enumerate(rows):
        cells = [grid.at(row, column + axis) for axis in range(3)]
        if bad[number] or not all(type(value) in (int, float) for value in cells):
            _complain_of_coordinates(source, grid, row, column, cells)
    return points


def _complain_of_coordinates(
    source: Source, grid: Grid, row: int, column: int, values: list[Value]
) -> None:
    for axis, value in enumerate(values):
        cell = Area(grid.sheet, row, column + axis)
        found = source.fault(cell, value) if value is None else number_fault(value)
        if found:
            source.complain(cell.where, found, "a coordinate (mm)", "export the option space again")


def _check_index(source: Source, grid: Grid, rows: list[int], first: int, column: int) -> None:
    for number, row in enumerate(rows, 1):
        if grid.at(row, column) != number:
            value = grid.at(row, column)
            source.complain(
                place(grid.sheet, row, column),
                "an empty cell" if value is None else f"{value!r}",
                f"the index {number}",
                "number the footprints 1, 2, 3, ... without gaps",
            )
            return


def _check_twins(
    source: Source, sheet: str, labels: KindLabels, points: FloatArray, first: int, column: int
) -> None:
    seen: dict[tuple[float, ...], int] = {}
    for number, point in enumerate(map(tuple, points.tolist())):
        if point in seen:
            source.complain(
                place(sheet, first + number, column),
                f"the place of index {seen[point] + 1} again",
                f"{labels.plural} at places of their own",
                "delete one of them, or export the option space again",
            )
        else:
            seen[point] = number


# --- polygon ---


def _polygon(source: Source, sheet: str, part: Part | None) -> tuple[FloatArray, float] | None:
    scale_cell = source.locate(sheet, layout.SCALE_FACTOR)
    if scale_cell is None:
        source.complain(
            place(sheet, 0, layout.POLYGON_COLUMN),
            "no such label",
            repr(layout.SCALE_FACTOR.label),
            "restore the label, or export the option space again",
        )
        return None
    scale = source.number(scale_cell, "a scale factor above 0 and at most 1", above=0, most=1)
    ideal_area = _polygon_area(source, sheet)
    if ideal_area is None:
        source.complain(
            place(sheet, layout.POLYGON_HEADER_ROW, layout.POLYGON_COLUMN),
            "no header 'i', 'x', 'y', 'z'",
            "the ideal deflection polygon",
            "restore the header, or export the option space again",
        )
        return None
    whole_area = source.names.get(layout.APPROXIMATION_POLYGON)
    if whole_area and source.formula(ideal_area.cell(0, 0)) is not None:
        polygon = _vertices(source, whole_area)
        _check_polygon(source, whole_area, polygon)
    else:
        whole_area = None
        polygon = _vertices(source, ideal_area)
        _check_polygon(source, ideal_area, polygon)
    if polygon is None or scale is None or part is None:
        return None
    return (polygon if whole_area else unscaled_polygon(polygon, part.centroid_mm, scale)), scale


def _polygon_area(source: Source, sheet: str) -> Area | None:
    """Find the ideal polygon's x, y, z cells: by name, else below the header i, x, y, z."""
    named = source.names.get(layout.IDEAL_POLYGON)
    if named and named.columns == 3:
        return named
    grid = source.grid(sheet)
    below = -1
    while header := grid.find(layout.POLYGON_HEADER[0], below=below):
        titles = [grid.at(header.row, header.column + n) for n in range(1, 4)]
        if [str(title).strip().lower() for title in titles] == list(layout.POLYGON_HEADER[1:]):
            break
        below = header.row
    if header is None:
        return None
    rows = 0
    while rows < MAX_VERTICES and _is_vertex(grid, header.row + 1 + rows, header.column):
        rows += 1
    return Area(sheet, header.row + 1, header.column + 1, rows, 3)


def _is_vertex(grid: Grid, row: int, column: int) -> bool:
    cells = [grid.at(row, column + n) for n in range(4)]
    is_centroid = isinstance(cells[0], str) and cells[0].strip() == layout.CENTROID_LABEL
    return not is_centroid and any(cell is not None for cell in cells)


def _vertices(source: Source, area: Area) -> FloatArray | None:
    numbers = [[source.number(cell, "a coordinate (mm)") for cell in row] for row in cells_of(area)]
    if any(None in row for row in numbers):
        return None
    return frozen(np.array(numbers, dtype=np.float64).reshape(-1, 3))


def _check_polygon(source: Source, area: Area, polygon: FloatArray | None) -> None:
    if polygon is None:
        return
    import shapely

    expected = "three or more corners around an area, without crossing"
    hint = "correct the corners, or choose the polygon again in CAD"
    if len(polygon) < 3:
        source.complain(area.where, f"{len(polygon)} corners", expected, hint)
        return
    steps = np.roll(polygon[:, :2], -1, axis=0) - polygon[:, :2]
    repeated = np.flatnonzero(~steps.any(axis=1))
    if len(repeated):
        row = area.cell(int(repeated[0] + 1) % len(polygon), 0)
        source.complain(row.where, "the corner before it again", expected, "delete this corner")
        return
    outline = shapely.Polygon(polygon[:, :2])
    extent = np.ptp(polygon[:, :2], axis=0).max()
    if outline.area <= 1e-12 * extent * extent:
        source.complain(area.where, "a polygon without area", expected, hint)
    elif not outline.is_valid:
        reason = shapely.is_valid_reason(outline)
        source.complain(area.where, f"a polygon that crosses itself ({reason})", expected, hint)


def _look_at_polygon(source: Source, sheet: str, space: OptionSpace) -> None:
    """Warn of a polygon that the deviation criterion was not made for (section 3.2)."""
    area = _polygon_area(source, sheet)
    where = area.where if area else sheet
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
        cells = [source.value(repeated.cell(0, axis)) for axis in range(1, 4)]
        for axis, value in enumerate(cells):
            apart = isinstance(value, int | float) and abs(
                value - space.part.centroid_mm[axis]
            ) > CENTROID_TOLERANCE_MM * max(1.0, abs(space.part.centroid_mm[axis]))
            if apart and math.isfinite(float(str(value))):
                source.warn(
                    repeated.cell(0, 1 + axis).where,
                    f"{value:g}",
                    f"the part's centroid, {space.part.centroid_mm[axis]:g}",
                    "it is not used; export the option space again if in doubt",
                )
