"""Sheet ``Valid Designs`` (section 5.2.5): the list, gene rows to copy, the trade-off."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterable
from itertools import accumulate, pairwise
from typing import Any

import numpy as np

from grasp_xl.chromosome import Chromosome
from grasp_xl.rules import SLACK, TERMS
from grasp_xl.search.result import Result, Rows, gene_columns
from grasp_xl.workbook.layout import (
    FITNESS_HEADER,
    KINDS,
    TABLE_ROW,
    VALID_DESIGNS,
    Area,
)
from grasp_xl.workbook.pen import Pen
from grasp_xl.workbook.styles import SEQUENCE, Style
from grasp_xl.workbook.table import (
    CRITERIA,
    CRITERIA_WIDTHS,
    GENE_WIDTH,
    GENERATION_WIDTH,
    GRID,
    NO,
    YES,
    add_table,
    gene_labels,
    gene_styles,
    shown_gene,
    shown_number,
)

MAX_DESIGNS = 10_000
"""Valid designs that the sheet lists: the newest."""

PICK_NAME = "DesignPick"
PICK_ROW = 2
PICKED_ROWS = (PICK_ROW + 2, 1)
"""First cell of the picked design's two gene rows."""
PICK_HINT = (
    "Type a No. of the list: the two rows below and the What-if card show that design. Empty: the "
    "best grasp. The rows of every design stand below the list, ready to copy."
)
NUMBER_COLUMN, GENE_COLUMN = 0, 2
"""Columns of the table: a design's number, by which it is picked, and its first gene."""
COPY_TITLE = (
    "GENES TO COPY: drag over the two rows of a design, copy, and paste on the two rows of the "
    "User-Defined Chromosome"
)
CHART_ROWS, CHART_COLUMNS = 24, 10
"""Rows and columns that the chart takes."""
NUMBER_WIDTH = 10.5
GENE_ROW_STYLES = (Style.SUCTION_GENE, Style.MAGNETS_GENE)
NORMALISED = tuple(f"Norm. {label}" for label in FITNESS_HEADER)


def picked_genes(slots: int) -> list[list[str]]:
    """Return references to the gene rows of the picked design."""
    return [
        [
            Area(VALID_DESIGNS, PICK_ROW + 2 + number, 1 + slot).reference
            for slot in range(1 + slots)
        ]
        for number in range(len(KINDS))
    ]


def pick_formulas(slots: int, rows: int, unpicked: Chromosome) -> list[list[str | None]]:
    """Return the formulas of the picked design's genes: right wherever they are pasted.

    Parameters
    ----------
    slots : int
        Index genes a kind.
    rows : int
        Rows of the list.
    unpicked : Chromosome
        Genes that are shown while no row is picked.
    """
    row, usable = f"MATCH({PICK_NAME},{_numbers(rows)},0)", _usable(rows)
    return [
        [
            None if gene is None else f"IF({usable},INDEX({listed},{row}),{gene})"
            for listed, gene in zip(_listed_genes(slots, rows, number), genes, strict=True)
        ]
        for number, genes in enumerate(unpicked.rows())
    ]


def _listed_genes(slots: int, rows: int, kind: int) -> list[str]:
    """Return references to a kind's gene columns of the list."""
    left = GENE_COLUMN + kind * (1 + slots)
    columns = range(left, left + 1 + slots)
    return [Area(VALID_DESIGNS, TABLE_ROW + 1, column, rows).reference for column in columns]


def _numbers(rows: int) -> str:
    return Area(VALID_DESIGNS, TABLE_ROW + 1, NUMBER_COLUMN, rows).reference


def _usable(rows: int) -> str:
    return f"AND(ISNUMBER({PICK_NAME}),ISNUMBER(MATCH({PICK_NAME},{_numbers(rows)},0)))"


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
) -> None:
    """Write the list as an Excel table, a picked row above, all gene rows below, a chart beside.

    ``unpicked`` are the genes shown while no row is picked, ``picked`` the design picked before.
    """
    designs = result.design_rows[-MAX_DESIGNS:]
    own_units = [label for _, _, label, _ in CRITERIA[:-1]]
    genes = gene_labels(result.space)
    labels = ["No.", "Generation", *genes, *own_units, *NORMALISED, "Divergence", "Meets All Goals"]
    rows = max(1, len(designs))
    pen.write(0, 0, "VALID DESIGNS", Style.TITLE)
    _picker(pen, result, rows, unpicked, picked)
    _rows(pen, result, designs)
    _rows_to_copy(pen, result, designs, TABLE_ROW + rows + 3)
    add_table(pen, "ValidDesigns", Area(VALID_DESIGNS, TABLE_ROW, 0, 1 + rows, len(labels)), labels)
    _colours(pen, Area(VALID_DESIGNS, TABLE_ROW + 1, 0, rows, len(labels)))
    pen.sheet.freeze_panes(TABLE_ROW + 1, 1)
    norms, rest = [8.2] * len(NORMALISED), (CRITERIA_WIDTHS[-1], 8.5)
    gene_widths = [GENE_WIDTH] * len(genes)
    pen.widths(
        0, NUMBER_WIDTH, GENERATION_WIDTH, *gene_widths, *CRITERIA_WIDTHS[:-1], *norms, *rest
    )
    listed = Area(VALID_DESIGNS, 0, 0, TABLE_ROW + 1 + rows, len(labels))
    chart = Area(VALID_DESIGNS, TABLE_ROW + 1, len(labels) + 1, CHART_ROWS, CHART_COLUMNS)
    pen.print_pages(listed, pictures=[chart] if len(designs) else [])
    _trade_off(pen, book, designs, chart)


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


def _colours(pen: Pen, listed: Area) -> None:
    """Let normalised values above 1 stand out, and rows that meet all goals."""
    width = len(NORMALISED)
    norms = listed.cell(0, listed.columns - 2 - width)
    last_row, last_column = listed.row + listed.rows - 1, listed.column + listed.columns - 1
    above = f"=AND(ISNUMBER({norms.local}),{norms.local}>{1 + SLACK!r})"
    meets = f'=${listed.cell(0, listed.columns - 1).local}="{YES}"'
    for left, right, formula, style in (
        (norms.column, norms.column + width - 1, above, Style.ABOVE),
        (listed.column, last_column, meets, Style.PASSES),
    ):
        pen.sheet.conditional_format(
            listed.row,
            left,
            last_row,
            right,
            {"type": "formula", "criteria": formula, "format": pen.formats.over(style)},
        )


def _picker(
    pen: Pen, result: Result, rows: int, unpicked: Chromosome, picked: Chromosome | None
) -> None:
    """Write two gene rows as figure 34 has them: of the picked row, or of the best grasp."""
    slots = result.space.gene_slots
    number = number_of(result, picked) if picked else None
    shown = picked if picked and number else unpicked
    pick = Area(VALID_DESIGNS, PICK_ROW, 1)
    pen.write(PICK_ROW, 0, "No. to show", Style.LABEL)
    pen.note(PICK_ROW, 0, PICK_HINT)
    pen.write(PICK_ROW, 1, number, Style.INPUT)
    wrong = f"No such number: type a whole number from 1 to {rows}; the best grasp is shown."
    hint = f'IF(OR({PICK_NAME}="",{_usable(rows)}),"{PICK_HINT}","{wrong}")'
    pen.write(PICK_ROW, 2, PICK_HINT, Style.NOTE, hint)
    pen.name_area(PICK_NAME, pick)
    pen.sheet.data_validation(
        PICK_ROW,
        1,
        PICK_ROW,
        1,
        {
            "validate": "integer",
            "criteria": "between",
            "minimum": 1,
            "maximum": rows,
            "error_message": f"The list has the numbers 1 to {rows}.",
        },
    )
    pen.row(PICK_ROW + 1, 1, _slot_labels(slots), Style.HEADER)
    formulas = pick_formulas(slots, rows, unpicked)
    for kind, (labels, genes) in enumerate(zip(KINDS, shown.rows(), strict=True)):
        row, style = PICK_ROW + 2 + kind, GENE_ROW_STYLES[kind]
        pen.write(row, 0, labels.row_label, style)
        for slot, (gene, formula) in enumerate(zip(genes, formulas[kind], strict=True)):
            pen.write(row, 1 + slot, gene, style, formula)


def _slot_labels(slots: int) -> tuple[str, ...]:
    return ("Total #", *(f"Index {slot}" for slot in range(1, slots + 1)))


def _rows_to_copy(pen: Pen, result: Result, designs: Rows, top: int) -> None:
    """Write both gene rows of every design as values, below all that a filter or sort touches."""
    if not len(designs):
        return
    slots, columns = result.space.gene_slots, gene_columns(result.space)
    pen.write(top, 0, COPY_TITLE, Style.TITLE)
    pen.row(top + 1, 0, ("No.", None, *_slot_labels(slots)), Style.HEADER)
    first = top + 2
    for number, design in enumerate(designs[columns].tolist(), 1):
        genes = list(map(shown_gene, columns, design))
        for kind, (labels, style) in enumerate(zip(KINDS, GENE_ROW_STYLES, strict=True)):
            row, left = first + len(KINDS) * (number - 1) + kind, kind * (1 + slots)
            pen.write(row, 0, number, Style.COUNT)
            pen.write(row, 1, labels.row_label, style)
            pen.row(row, GENE_COLUMN, genes[left : left + 1 + slots], style)


def cost_bands(costs: Iterable[float]) -> list[tuple[float, float]]:
    """Return the lowest and highest cost of each series: a cost each, or neighbours together.

    Examples
    --------
    >>> cost_bands([30, 10, 30])
    [(10, 10), (30, 30)]
    >>> cost_bands(range(10))[:3]
    [(0, 1), (2, 3), (4, 4)]
    >>> cost_bands([])
    []
    """
    different = sorted(set(costs))
    each, more = divmod(len(different), len(SEQUENCE))
    sizes = [each + (number < more) for number in range(len(SEQUENCE))]
    ends = [end for size, end in zip(sizes, accumulate(sizes), strict=True) if size]
    return [(different[start], different[end - 1]) for start, end in pairwise((0, *ends))]


def _trade_off(pen: Pen, book: Any, designs: Rows, place: Area) -> None:  # noqa: ANN401 (untyped library)
    """Chart structure against deviation, a series a band of costs; its data stand beside it."""
    bands = cost_bands(designs["cost"].tolist())
    if not bands:
        return
    left = place.column + place.columns + 1
    chart = book.add_chart({"type": "scatter"})
    names = [" to ".join(dict.fromkeys(f"${cost:,.10g}" for cost in band)) for band in bands]
    pen.row(TABLE_ROW, left, ("Deviation (mm)", *names), Style.HEADER)
    lowest = [low for low, _ in bands]
    records = designs[["deviation", "structure", "cost"]].tolist()
    for row, (deviation, structure, cost) in enumerate(records, TABLE_ROW + 1):
        pen.write(row, left, deviation, Style.RATIO)
        pen.write(row, left + bisect_right(lowest, cost), structure, Style.TORQUE)
    first, last = TABLE_ROW + 1, TABLE_ROW + len(designs)
    for number, (name, colour) in enumerate(zip(names, SEQUENCE, strict=False), left + 1):
        marker = {
            "type": "circle",
            "size": 6,
            "border": {"color": colour},
            "fill": {"color": colour},
        }
        chart.add_series(
            {
                "name": f"Cost {name}",
                "categories": [VALID_DESIGNS, first, left, last, left],
                "values": [VALID_DESIGNS, first, number, last, number],
                "marker": marker,
            }
        )
    chart.set_title({"name": "Trade-off of the valid designs", "name_font": {"size": 11}})
    chart.set_x_axis({"name": "Deviation (mm)", "major_gridlines": GRID, "label_position": "low"})
    chart.set_y_axis({"name": "Structure (mm)", "major_gridlines": GRID})
    chart.set_legend({"position": "bottom"})
    chart.set_size({"width": 640, "height": 420})
    pen.insert_chart(place.row, place.column, chart)
    pen.fix_row_heights()
