"""From a sheet to the lists of places: what the cells say, and what is wrong with them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from grasp_xl.space import MAX_FOOTPRINTS, FloatArray, frozen
from grasp_xl.workbook import layout
from grasp_xl.workbook.cells import Fault, Grid, Source, as_number, is_blank
from grasp_xl.workbook.layout import Area, KindLabels
from grasp_xl.workbook.reading_labels import A_COORDINATE, miss, usual_place


def list_start(source: Source, sheet: str, labels: KindLabels) -> Area | None:
    """Find the first coordinate of a kind's list: by name, else below its header."""
    named = source.names.get(labels.locations_name)
    if named and named.sheet == sheet and named.columns == 3:
        return named.cell(0, 0)
    header = source.grid(sheet).find(labels.locations_label)
    if header is None:
        usual = usual_place(source, sheet, layout.LOCATION_HEADER_ROW, labels.column)
        miss(source, usual, f"the label {labels.locations_label!r}")
        return None
    return header.cell(layout.FIRST_LOCATION_ROW - layout.LOCATION_HEADER_ROW, 0)


def read_footprints(source: Source, start: Area, labels: KindLabels) -> FloatArray | None:
    """Read the places of a kind, ``(n, 3)`` (mm); None where one of them cannot be used."""
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


def check_total(
    source: Source,
    labels: KindLabels,
    cells: dict[str, Area],
    start: Area | None,
    footprints: FloatArray | None,
) -> None:
    """Check that the total of a kind agrees with its list, which may go on or have gaps."""
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


def check_lists(
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
