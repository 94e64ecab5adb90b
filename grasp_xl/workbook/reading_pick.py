"""The designs that a designer picked, and our formulas that show them: worked out, not read."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace

import numpy as np

from grasp_xl.chromosome import BLANK_GENE, Chromosome
from grasp_xl.workbook import layout, run_log
from grasp_xl.workbook.cells import UNCALCULATED, Source, cells_of, is_blank, same_formula
from grasp_xl.workbook.inputs import genes_of_text
from grasp_xl.workbook.layout import TABLE_ROW, Area
from grasp_xl.workbook.picker import (
    DESIGN_PICK,
    GENE_COLUMN,
    NO_PICKS,
    NUMBER_COLUMN,
    TRADE_OFF_PICK,
    Formulas,
    Picker,
    Picks,
    blank_like,
    constant,
)
from grasp_xl.workbook.reading_run import DESIGNS_LISTED, UNREADABLE, logged_values, whole
from grasp_xl.workbook.reading_trade_offs import has_trade_offs, trade_offs_listed

BLOCKS = (layout.USER_BLOCK, layout.WHAT_IF)
"""Chromosome blocks that may hold our formulas: the What-if's own, and pasted ones."""


def read_picks(source: Source) -> Picks:
    """Return the picked designs; work out our formulas on the way.

    Their values are then known to ``source``, whatever the program that saved the file stored.
    """
    areas = [source.names[block.name] for block in BLOCKS if block.name in source.names]
    picks = NO_PICKS
    with suppress(*UNREADABLE):
        listed = whole(logged_values(source)[DESIGNS_LISTED])
        written = source.value(source.names[run_log.WHAT_IF_WRITTEN])
        best = Chromosome(genes_of_text(written))
        slots = best.genes.shape[1] - 1
        picked = _picked(source, DESIGN_PICK, listed, best)
        picks = Picks(picked)
        shown = picked or best
        areas.append(_picked_rows(source, DESIGN_PICK, slots))
        ours = _our_formulas(DESIGN_PICK, listed, constant(best), shown)
        if has_trade_offs(source):
            listed = trade_offs_listed(source)
            unpicked = blank_like(DESIGN_PICK.picked_genes(slots), best)
            picks = Picks(picked, _picked(source, TRADE_OFF_PICK, listed, best))
            areas.append(_picked_rows(source, TRADE_OFF_PICK, slots))
            ours |= _our_formulas(TRADE_OFF_PICK, listed, unpicked, picks.trade_off or shown)
        for cell in (cell for area in areas for row in cells_of(area) for cell in row):
            formula = same_formula(source.formula(cell))
            if formula in ours:
                source.worked_out[cell] = ours[formula]
    return picks


def _picked_rows(source: Source, picker: Picker, slots: int) -> Area:
    return replace(picker.picked_rows(slots), sheet=source.names[picker.name].sheet)


def _picked(source: Source, picker: Picker, listed: int, best: Chromosome) -> Chromosome | None:
    """Look the picked number up in a list, as our formulas do."""
    cell = source.names[picker.name]
    number = source.value(cell)
    if is_blank(number):
        if not source.blank(cell):
            source.complain(cell.where, UNCALCULATED.found, "a number", UNCALCULATED.hint)
        return None
    grid = source.grid(cell.sheet)
    for row in range(TABLE_ROW + 1, TABLE_ROW + 1 + listed):
        if grid.at(row, NUMBER_COLUMN) == number:
            columns = range(GENE_COLUMN, GENE_COLUMN + best.genes.size)
            genes = np.array([grid.at(row, column) or BLANK_GENE for column in columns])
            return Chromosome(genes.reshape(best.genes.shape))
    return None


def _our_formulas(
    picker: Picker, listed: int, unpicked: Formulas, shown: Chromosome
) -> dict[str, int | None]:
    """Return what each of our formulas gives, those of the picked rows and those on them."""
    slots = len(unpicked[0]) - 1
    on_them = [text for texts in picker.picked_genes(slots) for text in texts]
    picked = [text for texts in picker.formulas(max(1, listed), unpicked) for text in texts]
    genes = [gene for row in shown.rows() for gene in row]
    values = zip((*on_them, *picked), (*genes, *genes), strict=True)
    return {same_formula(text): gene for text, gene in values}
