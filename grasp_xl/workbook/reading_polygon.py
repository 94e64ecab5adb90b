"""From a sheet to the polygons: what the cells say, and what is wrong with them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from grasp_xl.polygon import look_at_polygon
from grasp_xl.space import FloatArray, OptionSpace, Part, frozen, unscaled_polygon
from grasp_xl.workbook import layout
from grasp_xl.workbook.cells import Grid, Source, as_number, cells_of, is_blank, normal, shown
from grasp_xl.workbook.layout import Area, place
from grasp_xl.workbook.reading_labels import A_COORDINATE, miss, usual_place

MAX_VERTICES = 10_000
"""Vertices of the polygon that are read."""

CENTROID_TOLERANCE_MM = 1e-6

MIN_FATNESS = 1e-12
"""Least area of what the polygon's corners span, over its extent squared; else it is a line."""

A_POLYGON = "three or more corners around an area, without crossing"
CHOOSE_CORNERS = "correct the corners, or choose the polygon again in CAD"


def read_polygon(source: Source, sheet: str, part: Part | None) -> tuple[FloatArray, float] | None:
    """Read the approximation polygon and the scale factor."""
    scale = _scale_factor(source, sheet)
    ideal = _ideal_area(source, sheet)
    if ideal is None:
        usual = usual_place(source, sheet, layout.POLYGON_HEADER_ROW, layout.POLYGON_COLUMN)
        header = " ".join(layout.POLYGON_HEADER)
        miss(source, usual, f"the header {header!r} of the ideal polygon, in four cells")
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
        usual = usual_place(source, sheet, 0, layout.POLYGON_COLUMN)
        miss(source, usual, f"the label {layout.SCALE_FACTOR.label!r}")
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


def warn_of_polygon(source: Source, sheet: str, space: OptionSpace) -> None:
    """Warn of a polygon that the deviation criterion was not made for (section 3.2)."""
    area = _ideal_area(source, sheet)
    where = area.where if area else place(sheet, 0, 0)
    centroid = space.part.centroid_mm
    source.warnings += look_at_polygon(space.approximation_polygon_mm, centroid, where)
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
