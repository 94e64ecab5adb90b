"""Sheet ``Valid Designs`` (section 5.2.5): the list, one design to copy, the trade-off."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from grasp_xl.chromosome import Chromosome
from grasp_xl.rules import TERMS
from grasp_xl.search.result import Result, gene_columns
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
    add_table,
    gene_labels,
    gene_styles,
    shown_gene,
    shown_number,
)

if TYPE_CHECKING:
    import pandas as pd

MAX_DESIGNS = 10_000
"""Valid designs that the sheet lists: the newest."""

PICK_NAME = "DesignPick"
PICK_ROW = 2
PICK_HINT = (
    "Type a row number of the list: its two gene rows below can be copied as they are, and the "
    "What-if card shows it. Empty: the best grasp."
)
CHART_ROWS, CHART_COLUMNS = 24, 10
"""Rows and columns that the chart takes."""
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


def write_valid_designs(pen: Pen, book: Any, result: Result, unpicked: Chromosome) -> None:  # noqa: ANN401 (untyped library)
    """Write the list as an Excel table, with a picked row above and the trade-off beside it.

    ``unpicked`` are the genes shown while no row is picked.
    """
    designs = result.valid_designs().tail(MAX_DESIGNS)
    own_units = [label for _, _, label, _ in CRITERIA[:-1]]
    genes = gene_labels(result.space)
    labels = ["Generation", *genes, *own_units, *NORMALISED, "Divergence", "Meets All Goals"]
    rows = max(1, len(designs))
    pen.write(0, 0, "VALID DESIGNS", Style.TITLE)
    _picker(pen, result, rows, unpicked)
    _rows(pen, result, designs)
    add_table(pen, "ValidDesigns", Area(VALID_DESIGNS, TABLE_ROW, 0, 1 + rows, len(labels)), labels)
    pen.sheet.conditional_format(
        TABLE_ROW + 1,
        len(labels) - 1,
        TABLE_ROW + rows,
        len(labels) - 1,
        {
            "type": "cell",
            "criteria": "==",
            "value": '"yes"',
            "format": pen.formats.over(Style.PASSES),
        },
    )
    pen.sheet.freeze_panes(TABLE_ROW + 1, 1)
    norms, rest = [8.2] * len(NORMALISED), (CRITERIA_WIDTHS[-1], 8.5)
    gene_widths = [GENE_WIDTH] * len(genes)
    pen.widths(0, GENERATION_WIDTH, *gene_widths, *CRITERIA_WIDTHS[:-1], *norms, *rest)
    listed = Area(VALID_DESIGNS, 0, 0, TABLE_ROW + 1 + rows, len(labels))
    chart = Area(VALID_DESIGNS, TABLE_ROW + 1, len(labels) + 1, CHART_ROWS, CHART_COLUMNS)
    pen.print_pages(listed, pictures=[chart] if len(designs) else [])
    _trade_off(pen, book, designs, chart)


def _rows(pen: Pen, result: Result, designs: pd.DataFrame) -> None:
    genes = gene_columns(result.space)
    styles = gene_styles(result.space)
    names = [name for name, _, _, _ in CRITERIA[:-1]]
    looks = [style for _, _, _, style in CRITERIA[:-1]]
    for row, design in enumerate(designs.to_dict("records"), TABLE_ROW + 1):
        pen.write(row, 0, int(design["generation"]), Style.COUNT)
        for column, (name, style) in enumerate(zip(genes, styles, strict=True), 1):
            pen.write(row, column, shown_gene(name, design[name]), style)
        left = 1 + len(genes)
        for column, (name, style) in enumerate(zip(names, looks, strict=True), left):
            pen.write(row, column, shown_number(design[name]), style)
        left += len(names)
        for column, name in enumerate(("fos", *TERMS), left):
            pen.write(row, column, shown_number(design[f"normalised_{name}"]), Style.RATIO)
        left += 1 + len(TERMS)
        pen.write(row, left, float(design["divergence"]), Style.DIVERGENCE)
        pen.write(row, left + 1, "yes" if design["meets_all_goals"] else "no", Style.CENTRED)


def _picker(pen: Pen, result: Result, rows: int, unpicked: Chromosome) -> None:
    """Write two gene rows as figure 34 has them: of the picked row, or of the best grasp."""
    slots = result.space.gene_slots
    pick = Area(VALID_DESIGNS, PICK_ROW, 1)
    pen.write(PICK_ROW, 0, "Row to show", Style.LABEL)
    pen.note(PICK_ROW, 0, PICK_HINT)
    pen.write(PICK_ROW, 1, None, Style.INPUT)
    in_list = f"AND({PICK_NAME}>=1,{PICK_NAME}<={rows},{PICK_NAME}=INT({PICK_NAME}))"
    usable = f"IF(ISNUMBER({PICK_NAME}),IF({in_list},1,0),0)"
    wrong = f"No such row: type a whole number from 1 to {rows}; the best grasp is shown."
    hint = f'IF(OR({PICK_NAME}="",{usable}=1),"{PICK_HINT}","{wrong}")'
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
            "error_message": f"The list has rows 1 to {rows}.",
        },
    )
    labels = ("Total #", *(f"Index {slot}" for slot in range(1, slots + 1)))
    pen.row(PICK_ROW + 1, 1, labels, Style.HEADER)
    for number, kind in enumerate(KINDS):
        style = (Style.SUCTION_GENE, Style.MAGNETS_GENE)[number]
        row = PICK_ROW + 2 + number
        pen.write(row, 0, kind.row_label, style)
        for slot, gene in enumerate(unpicked.rows()[number]):
            column = 1 + number * (1 + slots) + slot
            listed = Area(VALID_DESIGNS, TABLE_ROW + 1, column, rows).absolute
            formula = f"IF({usable}=1,INDEX({listed},{PICK_NAME}),{gene})"
            pen.write(row, 1 + slot, gene, style, None if gene is None else formula)


def _trade_off(pen: Pen, book: Any, designs: pd.DataFrame, place: Area) -> None:  # noqa: ANN401 (untyped library)
    """Chart structure against deviation, a series a cost, from columns beside the chart."""
    costs = sorted(designs["cost"].unique())[: len(SEQUENCE)]
    if not costs:
        return
    left = place.column + place.columns + 1
    chart = book.add_chart({"type": "scatter"})
    pen.row(TABLE_ROW, left, ("Deviation (mm)", *(f"${cost:g}" for cost in costs)), Style.HEADER)
    records = zip(designs["deviation"], designs["structure"], designs["cost"], strict=True)
    for row, (deviation, structure, cost) in enumerate(records, TABLE_ROW + 1):
        pen.write(row, left, float(deviation), Style.RATIO)
        if cost in costs:
            pen.write(row, left + 1 + costs.index(cost), float(structure), Style.TORQUE)
    first, last = TABLE_ROW + 1, TABLE_ROW + len(designs)
    for number, (cost, colour) in enumerate(zip(costs, SEQUENCE, strict=False), left + 1):
        marker = {
            "type": "circle",
            "size": 6,
            "border": {"color": colour},
            "fill": {"color": colour},
        }
        chart.add_series(
            {
                "name": f"Cost ${cost:g}",
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
