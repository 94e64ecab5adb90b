"""Sheet ``Valid Designs`` (section 5.2.5): the list, gene rows to copy, the trade-off."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from grasp_xl.chromosome import Chromosome
from grasp_xl.rules import TERMS
from grasp_xl.search.result import Result, Rows, gene_columns
from grasp_xl.workbook.layout import (
    FITNESS_HEADER,
    KINDS,
    MAX_DESIGNS,
    TABLE_ROW,
    VALID_DESIGNS,
    Area,
)
from grasp_xl.workbook.pen import Pen
from grasp_xl.workbook.picker import (
    DESIGN_PICK,
    GENE_COLUMN,
    GENE_ROW_STYLES,
    NUMBER_COLUMN,
    Overruled,
    PickHint,
    constant,
    slot_labels,
)
from grasp_xl.workbook.result_title import write_result_title
from grasp_xl.workbook.scatter import CHART_COLUMNS, CHART_ROWS, structure_against_deviation
from grasp_xl.workbook.styles import Style
from grasp_xl.workbook.table import (
    CRITERIA,
    CRITERIA_WIDTHS,
    GENE_WIDTH,
    GENERATION_WIDTH,
    NO,
    YES,
    add_colours,
    add_table,
    gene_labels,
    gene_styles,
    shown_gene,
    shown_number,
)

PICK_HINT = (
    "Type a No. of the list: the two rows below and the What-if card show that design. Empty: the "
    "best grasp. The rows of every design stand below the list, ready to copy."
)
COPY_TITLE = (
    "GENES TO COPY: drag over the two rows of a design, copy, and paste on the two rows of the "
    "User-Defined Chromosome"
)
NUMBER_WIDTH, NORM_WIDTH = 10.5, 7.5
NORMALISED = tuple(f"Norm. {label}" for label in FITNESS_HEADER)


def number_of(result: Result, chromosome: Chromosome) -> int | None:
    """Return the number that a design has in the list; None where it has none."""
    genes = result.state.designs.genes[-MAX_DESIGNS:]
    numbers = np.flatnonzero((genes == chromosome.genes).all(axis=(1, 2)))
    return int(numbers[0]) + 1 if len(numbers) else None


def write_valid_designs(
    pen: Pen,
    book: Any,  # noqa: ANN401 (untyped library)
    result: Result,
    unpicked: Chromosome,
    picked: Chromosome | None,
    on_card: Chromosome,
    overruled: Overruled | None = None,
) -> None:
    """Write the list as an Excel table, a picked row above, all gene rows below, a chart beside.

    ``unpicked`` are the genes shown while no row is picked, ``picked`` the design picked before,
    ``on_card`` what the What-if card shows, ``overruled`` why that may be something else.
    """
    designs = result.design_rows[-MAX_DESIGNS:]
    own_units = [label for _, _, label, _ in CRITERIA[:-1]]
    genes = gene_labels(result.space)
    labels = ["No.", "Generation", *genes, *own_units, *NORMALISED, "Divergence", "Meets All Goals"]
    rows = max(1, len(designs))
    write_result_title(pen, "VALID DESIGNS")
    number = number_of(result, picked) if picked else None
    shown = picked if picked and number else unpicked
    hint = PickHint(PICK_HINT, "the best grasp", overruled)
    DESIGN_PICK.write(pen, rows, number, shown, constant(unpicked), hint, on_card)
    _rows(pen, result, designs)
    _rows_to_copy(pen, result, designs, TABLE_ROW + rows + 3)
    add_table(pen, "ValidDesigns", Area(VALID_DESIGNS, TABLE_ROW, 0, 1 + rows, len(labels)), labels)
    body = Area(VALID_DESIGNS, TABLE_ROW + 1, 0, MAX_DESIGNS, len(labels))
    norms = replace(body, column=labels.index(NORMALISED[0]), columns=len(NORMALISED))
    add_colours(pen, body, norms)
    pen.sheet.freeze_panes(TABLE_ROW + 1, 1)
    widths = [GENE_WIDTH] * len(genes) + [*CRITERIA_WIDTHS[:-1]] + [NORM_WIDTH] * len(NORMALISED)
    pen.widths(0, NUMBER_WIDTH, GENERATION_WIDTH, *widths, CRITERIA_WIDTHS[-1], 8.5)
    listed = Area(VALID_DESIGNS, 0, 0, TABLE_ROW + 1 + rows, len(labels))
    chart = Area(VALID_DESIGNS, TABLE_ROW + 1, len(labels) + 1, CHART_ROWS, CHART_COLUMNS)
    cuts = map(labels.index, (KINDS[-1].row_label, own_units[0]))
    pages = pen.list_pages(listed, TABLE_ROW, cuts)
    pen.print_pages(*pages, pictures=[chart] if len(designs) else [])
    records = designs[["deviation", "structure", "cost"]].tolist()
    scatter = structure_against_deviation("Trade-off of the valid designs", records)
    scatter.draw(pen, book, chart, chart.column + chart.columns + 1)
    pen.fix_row_heights()


def _rows(pen: Pen, result: Result, designs: Rows) -> None:
    genes = gene_columns(result.space)
    styles = gene_styles(result.space)
    names = [name for name, _, _, _ in CRITERIA[:-1]]
    looks = [style for _, _, _, style in CRITERIA[:-1]]
    for row, values in enumerate(designs.tolist(), TABLE_ROW + 1):
        design = dict(zip(designs.dtype.names or (), values, strict=True))
        pen.write(row, NUMBER_COLUMN, row - TABLE_ROW, Style.COUNT)
        pen.write(row, NUMBER_COLUMN + 1, int(design["generation"]), Style.COUNT)
        for column, (name, style) in enumerate(zip(genes, styles, strict=True), GENE_COLUMN):
            pen.write(row, column, shown_gene(name, design[name]), style)
        left = GENE_COLUMN + len(genes)
        for column, (name, style) in enumerate(zip(names, looks, strict=True), left):
            pen.write(row, column, shown_number(design[name]), style)
        left += len(names)
        for column, name in enumerate(("fos", *TERMS), left):
            pen.write(row, column, shown_number(design[f"normalised_{name}"]), Style.RATIO)
        left += 1 + len(TERMS)
        pen.write(row, left, float(design["divergence"]), Style.DIVERGENCE)
        pen.write(row, left + 1, YES if design["meets_all_goals"] else NO, Style.CENTRED)


def _rows_to_copy(pen: Pen, result: Result, designs: Rows, top: int) -> None:
    """Write both gene rows of every design as values, below all that a filter or sort touches."""
    if not len(designs):
        return
    slots, columns = result.space.gene_slots, gene_columns(result.space)
    pen.write(top, 0, COPY_TITLE, Style.TITLE)
    pen.row(top + 1, 0, ("No.", None, *slot_labels(slots)), Style.HEADER)
    first = top + 2
    for number, design in enumerate(designs[columns].tolist(), 1):
        genes = list(map(shown_gene, columns, design))
        for kind, (labels, style) in enumerate(zip(KINDS, GENE_ROW_STYLES, strict=True)):
            row, left = first + len(KINDS) * (number - 1) + kind, kind * (1 + slots)
            pen.write(row, 0, number, Style.COUNT)
            pen.write(row, 1, labels.row_label, style)
            pen.row(row, GENE_COLUMN, genes[left : left + 1 + slots], style)
