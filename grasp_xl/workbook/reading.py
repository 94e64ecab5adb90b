"""From a sheet to an option space: what the cells say, and what is wrong with them."""

from __future__ import annotations

import math
from pathlib import Path

from grasp_xl.errors import InputError, Problem
from grasp_xl.space import MAX_COUNT, ElementKind, FloatArray, OptionSpace, Part, frozen
from grasp_xl.workbook import layout
from grasp_xl.workbook.cells import LABEL_ROWS, Grid, Source
from grasp_xl.workbook.layout import Area, Field, KindLabels, Section
from grasp_xl.workbook.package import read_package
from grasp_xl.workbook.reading_labels import A_COORDINATE, miss, usual_place
from grasp_xl.workbook.reading_places import check_lists, check_total, list_start, read_footprints
from grasp_xl.workbook.reading_polygon import read_polygon, warn_of_polygon
from grasp_xl.workbook.stored import StoredCells

SECTIONS = (layout.PART, *(labels.section for labels in layout.KINDS))

A_COUNT = f"a whole number from 0 to {MAX_COUNT}"
A_FRACTION = "a fraction from 0 to 1, or nothing"


def open_source(path: Path) -> Source:
    """Open a workbook for reading.

    Raises
    ------
    InputError
        If the file is no whole and harmless workbook.
    """
    return Source(StoredCells(read_package(path)))


def read_option_space(source: Source) -> OptionSpace:
    """Read the option space of an exported sheet or of a full workbook.

    Raises
    ------
    InputError
        If it cannot be used, with every problem found in the workbook by then.
    """
    sheet, before = find_sheet(source), len(source.problems)
    part = _part(source, sheet)
    starts = [list_start(source, sheet, labels) for labels in layout.KINDS]
    lists = [
        read_footprints(source, start, labels) if start else None
        for start, labels in zip(starts, layout.KINDS, strict=True)
    ]
    kinds = [
        _kind(source, sheet, labels, start, footprints)
        for labels, start, footprints in zip(layout.KINDS, starts, lists, strict=True)
    ]
    check_lists(source, sheet, starts, lists)
    polygon = read_polygon(source, sheet, part)
    if len(source.problems) > before:
        source.finish()
    if part is None or polygon is None or None in kinds:
        raise AssertionError("finish() has raised what is missing")
    space = OptionSpace(part, tuple(kind for kind in kinds if kind), *polygon)
    warn_of_polygon(source, sheet, space)
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
        name = source.name
        raise InputError([Problem(name, "no option-space sheet", expected, hint)])
    first, *others = titles
    found = f"an option space besides that of the sheet {first.sheet!r}"
    hint = "delete all but one, or move them to workbooks of their own"
    if others:
        raise InputError([Problem(other.where, found, expected, hint) for other in others])
    return first.sheet


# --- labels and single values ---


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
        miss(source, usual_place(source, sheet, section.row, 0), f"the heading {section.heading!r}")
    elif heading:
        for number in missing:
            label = f"the label {section.fields[number].label!r} under {section.heading!r}"
            miss(source, heading.cell(1 + number, 0), label)
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
    check_total(source, labels, cells, start, footprints)
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
