"""The sheet ``Part``, read back so that a workbook keeps it."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator

from grasp_xl.space import frozen
from grasp_xl.workbook.cells import Source, Value, is_blank
from grasp_xl.workbook.layout import PART_SHEET
from grasp_xl.workbook.part_sheet import (
    FACE_COLUMN,
    FACE_HEADER,
    FACT_HEADER,
    FIRST_ROW,
    HEADER_ROW,
    OUTLINE_COLUMN,
    OUTLINE_HEADER,
    PART_TITLE,
    FaceOutline,
    PartRecord,
)
from grasp_xl.workbook.written import CellValue

LEAST_CORNERS = 3
MOST = 1e9
"""Bounds of a ring's corners, and of every number."""


def has_part(source: Source) -> bool:
    """Tell whether a workbook has the sheet, and not somebody's own of that name."""
    return PART_SHEET in source.sheets and source.grid(PART_SHEET).at(0, 0) == PART_TITLE


def read_part_record(source: Source) -> PartRecord | None:
    """Read the sheet; None, and a warning, where somebody edited it so that it says no outlines."""
    if not has_part(source):
        return None
    try:
        return _record(source)
    except (TypeError, ValueError, KeyError):
        source.warn(
            f"sheet {PART_SHEET!r}",
            "a list that was edited",
            "the rows as they were written",
            "it is not carried over; make it anew with grasp-xl fit",
        )
        return None


def _record(source: Source) -> PartRecord:
    facts = tuple((str(label), _fact(value)) for label, value in _rows(source, 0, FACT_HEADER))
    rings: dict[int, dict[int, list[tuple[float, float]]]] = defaultdict(lambda: defaultdict(list))
    for face, ring, x, y in _rows(source, OUTLINE_COLUMN, OUTLINE_HEADER):
        rings[int(_number(face))][int(_number(ring))].append((_number(x), _number(y)))
    for numbers in rings.values():
        if any(len(corners) < LEAST_CORNERS for corners in numbers.values()):
            raise ValueError(numbers)
    outlines = [
        FaceOutline(
            int(_number(number)),
            None if is_blank(height) else _number(height),
            _number(area),
            "" if is_blank(used) else str(used),
            tuple(frozen(corners) for corners in _rings_of(rings, int(_number(number)))),
        )
        for number, height, area, used in _rows(source, FACE_COLUMN, FACE_HEADER)
    ]
    return PartRecord(facts, tuple(outlines))


def _rings_of(
    rings: dict[int, dict[int, list[tuple[float, float]]]], number: int
) -> list[list[tuple[float, float]]]:
    """Return the rings of a face.

    Raises
    ------
    KeyError
        If it has none.
    """
    if number not in rings:
        raise KeyError(number)
    return list(rings[number].values())


def _rows(source: Source, column: int, header: tuple[str, ...]) -> Iterator[tuple[Value, ...]]:
    """Yield the rows of a list, up to the first whose first cell is blank.

    Raises
    ------
    ValueError
        If the list is not where it was written.
    """
    grid = source.grid(PART_SHEET)
    columns = range(column, column + len(header))
    if tuple(grid.at(HEADER_ROW, each) for each in columns) != header:
        raise ValueError(header)
    row = FIRST_ROW
    while not is_blank(grid.at(row, column)):
        yield tuple(grid.at(row, each) for each in columns)
        row += 1


def _fact(value: Value) -> CellValue:
    return value if isinstance(value, int | float | None) else str(value)


def _number(value: Value) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise TypeError(value)
    if not abs(value) <= MOST:
        raise ValueError(value)
    return float(value)
