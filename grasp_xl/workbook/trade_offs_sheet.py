"""Sheet ``Trade-offs``: the designs of the trade-off front, a picked one above, charts beside."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from grasp_xl.chromosome import Chromosome
from grasp_xl.grasp import Grasp, evaluate
from grasp_xl.rules import TERMS, Terms
from grasp_xl.task import Task
from grasp_xl.workbook.designs_sheet import NORM_WIDTH, NORMALISED, NUMBER_WIDTH
from grasp_xl.workbook.layout import FITNESS_HEADER, KINDS, TABLE_ROW, TRADE_OFFS, Area
from grasp_xl.workbook.pen import Pen
from grasp_xl.workbook.picker import (
    DESIGN_PICK,
    GENE_COLUMN,
    NUMBER_COLUMN,
    TRADE_OFF_PICK,
    Overruled,
    PickHint,
    blank_like,
)
from grasp_xl.workbook.result_title import write_result_title
from grasp_xl.workbook.scatter import (
    CHART_COLUMNS,
    CHART_ROWS,
    Scatter,
    structure_against_deviation,
)
from grasp_xl.workbook.styles import Style
from grasp_xl.workbook.table import (
    CRITERIA,
    CRITERIA_WIDTHS,
    DASH,
    GENE_WIDTH,
    NO,
    YES,
    add_colours,
    add_table,
    gene_labels,
    gene_styles,
)
from grasp_xl.workbook.written import CellValue

PROVED, FOUND = "proved", "found"
LEGEND = ("proved among all grasps", "found, not proved")
PROOF_COLUMN = NUMBER_COLUMN + 1
WEIGHTS = tuple(f"Weight {label}" for label in FITNESS_HEADER[1:])
TOLD_ROW = 1
EXPLAINED_ROW = TABLE_ROW - 1
EXPLAINED = (
    "proved: no grasp of all is better in one criterion and no worse in the others.  found: no "
    "such grasp is known.  Weights: no grasp of all has a sum of weight times normalised value "
    "that is lower by more than 0.1 % of it, or of 1 if that is more."
)
HINT = PickHint(
    "Type a No. of the list: the two rows below and the What-if card show that design. Empty: the "
    "design picked on the sheet Valid Designs, else the best grasp.",
    "the design of the sheet Valid Designs",
)
OVERRULED = (
    "The What-if card shows the design picked on the sheet Trade-offs. Empty the cell there to see "
    "the one that is picked here."
)
DECIMALS = 9
"""Of weights, in the fingerprint."""


@dataclass(frozen=True, eq=False, slots=True)
class TradeOff:
    """A row of the list: number by which it is picked, genes, and what is proved of it."""

    number: int
    chromosome: Chromosome
    proved: bool
    weights: Terms | None


@dataclass(frozen=True, eq=False, slots=True)
class TradeOffs:
    """The list, in the order of its rows, and a sentence on what is proved."""

    designs: tuple[TradeOff, ...]
    told: str

    @property
    def fingerprint(self) -> str:
        """A hash of all that is read from the list, whatever the order of its rows."""
        rows = sorted(
            (
                each.number,
                each.chromosome.genes.tolist(),
                each.proved,
                [round(weight, DECIMALS) for weight in each.weights or ()],
            )
            for each in self.designs
        )
        return hashlib.sha256(json.dumps(rows).encode()).hexdigest()

    def number_of(self, chromosome: Chromosome | None) -> int | None:
        """Return the number of a design; None where it is not listed."""
        numbers = (each.number for each in self.designs if each.chromosome == chromosome)
        return next(numbers, None)

    def overrules(self, picked: Chromosome | None) -> Overruled:
        """Say when the pick of ``Valid Designs`` is not on the What-if card.

        Parameters
        ----------
        picked : Chromosome or None
            Which design of this list is picked.
        """
        condition = TRADE_OFF_PICK.usable(max(1, len(self.designs)))
        return Overruled(condition, OVERRULED, picked is not None)


def write_trade_offs(
    pen: Pen,
    book: Any,  # noqa: ANN401 (untyped library)
    task: Task,
    trade_offs: TradeOffs,
    unpicked: Chromosome,
    picked: Chromosome | None,
    on_card: Chromosome,
) -> None:
    """Write the list as an Excel table, a picked row above, two charts beside.

    ``unpicked`` are the genes that ``Valid Designs`` shows, ``picked`` the design picked here,
    ``on_card`` what the What-if card shows.
    """
    space, designs = task.space, trade_offs.designs
    grasps = [evaluate(space, task.rules, each.chromosome) for each in designs]
    own_units = [label for _, _, label, _ in CRITERIA[:-1]]
    genes = gene_labels(space)
    norms = NORMALISED[1:]
    labels = ["No.", "Proof", *genes, *own_units, *norms, "Divergence", "Meets All Goals", *WEIGHTS]
    rows = max(1, len(designs))
    write_result_title(pen, "TRADE-OFFS")
    pen.write(TOLD_ROW, 0, trade_offs.told, Style.NOTE)
    number = trade_offs.number_of(picked)
    others = blank_like(DESIGN_PICK.picked_genes(space.gene_slots), unpicked)
    TRADE_OFF_PICK.write(pen, rows, number, picked or unpicked, others, HINT, on_card)
    pen.write(EXPLAINED_ROW, 0, EXPLAINED, Style.NOTE)
    for row, (design, grasp) in enumerate(zip(designs, grasps, strict=True), TABLE_ROW + 1):
        for column, (value, style) in enumerate(_cells(task, design, grasp)):
            pen.write(row, column, value, style)
    table = Area(TRADE_OFFS, TABLE_ROW, 0, 1 + rows, len(labels))
    add_table(pen, "TradeOffs", table, labels)
    first = labels.index(norms[0])
    body = Area(TRADE_OFFS, TABLE_ROW + 1, 0, rows, len(labels))
    add_colours(pen, body, Area(TRADE_OFFS, TABLE_ROW + 1, first, rows, len(norms)))
    pen.sheet.freeze_panes(TABLE_ROW + 1, 1)
    widths = [GENE_WIDTH] * len(genes) + [*CRITERIA_WIDTHS[:-1]] + [NORM_WIDTH] * len(norms)
    pen.widths(0, NUMBER_WIDTH, 8.5, *widths, CRITERIA_WIDTHS[-1], 8.5, *[7.5] * len(WEIGHTS))
    charts = Area(TRADE_OFFS, TABLE_ROW + 1, len(labels) + 1, CHART_ROWS, 2 * CHART_COLUMNS)
    listed = Area(TRADE_OFFS, 0, 0, TABLE_ROW + 1 + rows, len(labels))
    cuts = map(labels.index, (KINDS[-1].row_label, own_units[0], WEIGHTS[0]))
    pages = pen.list_pages(listed, TABLE_ROW, cuts)
    pen.print_pages(*pages, pictures=[charts] if designs else [])
    _charts(pen, book, charts, designs, grasps)
    pen.fix_row_heights()


def _cells(task: Task, design: TradeOff, grasp: Grasp) -> list[tuple[CellValue, Style]]:
    """Return the cells of a row."""
    genes = [gene for row in design.chromosome.rows() for gene in row]
    own_units = zip((grasp.fos, *grasp.terms), (look for *_, look in CRITERIA[:-1]), strict=True)
    meets = YES if grasp.meets_all_goals else NO
    return [
        (design.number, Style.COUNT),
        (PROVED if design.proved else FOUND, Style.CENTRED),
        *zip(genes, gene_styles(task.space), strict=True),
        *own_units,
        *((DASH if value is None else value, Style.RATIO) for value in grasp.normalised),
        (grasp.divergence, Style.DIVERGENCE),
        (meets, Style.CENTRED),
        *((weight, Style.SHARE) for weight in design.weights or [None] * len(TERMS)),
    ]


def _charts(
    pen: Pen,
    book: Any,  # noqa: ANN401 (untyped library)
    place: Area,
    designs: Sequence[TradeOff],
    grasps: Sequence[Grasp],
) -> None:
    terms = [grasp.terms for grasp in grasps]
    shapes = [(each.deviation, each.structure, each.cost) for each in terms]
    proofs = [
        (each.moment, each.cost, int(not design.proved))
        for each, design in zip(terms, designs, strict=True)
    ]
    charts = (
        structure_against_deviation("Structure against deviation", shapes),
        Scatter(
            "Cost against residual moment",
            "Residual Moment (N-mm)",
            "Cost ($)",
            Style.TORQUE,
            Style.MONEY,
            LEGEND,
            proofs,
        ),
    )
    left = place.column + place.columns + 1
    for number, chart in enumerate(charts):
        left = 1 + chart.draw(pen, book, place.cell(0, number * CHART_COLUMNS), left)


def list_columns(header: list[str]) -> tuple[slice, slice]:
    """Return the columns of genes and of weights of a list with this header.

    Raises
    ------
    ValueError
        If it is no header of ours.
    """
    weights = header.index(WEIGHTS[0])
    fos = header.index(CRITERIA[0][2])
    return slice(GENE_COLUMN, fos), slice(weights, weights + len(WEIGHTS))
