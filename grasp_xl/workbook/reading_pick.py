"""The valid design that a designer picked, and our formulas that show it: worked out, not read."""

from __future__ import annotations

import json
from contextlib import suppress

import numpy as np

from grasp_xl.chromosome import BLANK_GENE, Chromosome
from grasp_xl.workbook import layout, run_log
from grasp_xl.workbook.cells import UNCALCULATED, Source, cells_of, is_blank, same_formula
from grasp_xl.workbook.designs_sheet import (
    GENE_COLUMN,
    NUMBER_COLUMN,
    PICK_NAME,
    PICKED_ROWS,
    pick_formulas,
    picked_genes,
)
from grasp_xl.workbook.layout import TABLE_ROW, Area
from grasp_xl.workbook.reading_run import DESIGNS_LISTED, UNREADABLE, logged_values, whole

BLOCKS = (layout.USER_BLOCK, layout.WHAT_IF)
"""Chromosome blocks that may hold our formulas: the What-if's own, and pasted ones."""


def read_pick(source: Source) -> Chromosome | None:
    """Return the picked design, None if there is none; work out our formulas on the way.

    Their values are then known to ``source``, whatever the program that saved the file stored.
    """
    areas = [source.names[block.name] for block in BLOCKS if block.name in source.names]
    picked = None
    with suppress(*UNREADABLE):
        logged = logged_values(source)
        listed = whole(logged[DESIGNS_LISTED])
        written = source.value(source.names[run_log.WHAT_IF_WRITTEN])
        unpicked = Chromosome(np.array(json.loads(str(written))))
        slots = unpicked.genes.shape[1] - 1
        picked = _picked(source, listed, unpicked)
        ours = _our_formulas(slots, max(1, listed), unpicked, picked or unpicked)
        areas.append(
            Area(source.names[PICK_NAME].sheet, *PICKED_ROWS, len(layout.KINDS), 1 + slots)
        )
        for cell in (cell for area in areas for row in cells_of(area) for cell in row):
            formula = same_formula(source.formula(cell))
            if formula in ours:
                source.worked_out[cell] = ours[formula]
    return picked


def _picked(source: Source, listed: int, unpicked: Chromosome) -> Chromosome | None:
    """Look the picked number up in the list, as our formulas do."""
    cell = source.names[PICK_NAME]
    number, grid = source.value(cell), source.grid(cell.sheet)
    if is_blank(number):
        if not source.blank(cell):
            source.complain(cell.where, UNCALCULATED.found, "a number", UNCALCULATED.hint)
        return None
    for row in range(TABLE_ROW + 1, TABLE_ROW + 1 + listed):
        if grid.at(row, NUMBER_COLUMN) == number:
            columns = range(GENE_COLUMN, GENE_COLUMN + unpicked.genes.size)
            genes = np.array([grid.at(row, column) or BLANK_GENE for column in columns])
            return Chromosome(genes.reshape(unpicked.genes.shape))
    return None


def _our_formulas(
    slots: int, rows: int, unpicked: Chromosome, shown: Chromosome
) -> dict[str, int | None]:
    """Return what each of our formulas gives, those of the picked rows and those on them."""
    on_them = [text for texts in picked_genes(slots) for text in texts]
    picked = [text for texts in pick_formulas(slots, rows, unpicked) for text in texts]
    genes = [gene for row in shown.rows() for gene in row]
    values = zip((*on_them, *picked), (*genes, *genes), strict=True)
    return {same_formula(text): gene for text, gene in values}
