"""The list of the sheet ``Trade-offs``, read back so that a run can keep it."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress

import numpy as np

from grasp_xl.chromosome import BLANK_GENE, Chromosome
from grasp_xl.rules import Terms
from grasp_xl.workbook import run_log
from grasp_xl.workbook.cells import Source, is_blank
from grasp_xl.workbook.layout import KINDS, TABLE_ROW, TRADE_OFFS
from grasp_xl.workbook.picker import NUMBER_COLUMN, TRADE_OFF_PICK
from grasp_xl.workbook.reading_run import UNREADABLE, EditedError, whole
from grasp_xl.workbook.trade_offs_sheet import (
    FOUND,
    PROOF_COLUMN,
    PROVED,
    TOLD_ROW,
    TradeOff,
    TradeOffs,
    list_columns,
)


def has_trade_offs(source: Source) -> bool:
    """Tell whether a workbook has the sheet, as ``front`` writes it."""
    cell = source.names.get(TRADE_OFF_PICK.name)
    return cell is not None and cell.sheet == TRADE_OFFS


def read_trade_offs(source: Source) -> TradeOffs | None:
    """Read the list; None, and a warning, where somebody edited it: it would prove nothing."""
    if not has_trade_offs(source):
        return None
    with suppress(*UNREADABLE):
        found = TradeOffs(tuple(_rows(source)), str(source.grid(TRADE_OFFS).at(TOLD_ROW, 0) or ""))
        if found.fingerprint == source.value(source.names[run_log.TRADE_OFFS_HASH]):
            return found
    source.warn(
        f"sheet {TRADE_OFFS!r}",
        "a list that was edited",
        "the rows as they were written",
        "it is not carried over; make it anew with grasp-xl front",
    )
    return None


def trade_offs_listed(source: Source) -> int:
    """Return the number of rows of the list."""
    if not has_trade_offs(source):
        return 0
    grid, row = source.grid(TRADE_OFFS), TABLE_ROW + 1
    while not is_blank(grid.at(row, NUMBER_COLUMN)):
        row += 1
    return row - TABLE_ROW - 1


def _rows(source: Source) -> Iterator[TradeOff]:
    grid = source.grid(TRADE_OFFS)
    header = [str(label) for label in grid.rows[TABLE_ROW]]
    gene_columns, weight_columns = list_columns(header)
    for row in range(TABLE_ROW + 1, TABLE_ROW + 1 + trade_offs_listed(source)):
        values = [grid.at(row, column) for column in range(weight_columns.stop)]
        proof = values[PROOF_COLUMN]
        if proof not in (PROVED, FOUND):
            raise EditedError(f"{proof!r} is neither {PROVED} nor {FOUND}")
        genes = [BLANK_GENE if gene is None else whole(gene) for gene in values[gene_columns]]
        weights = [weight for weight in values[weight_columns] if isinstance(weight, int | float)]
        yield TradeOff(
            whole(values[NUMBER_COLUMN]),
            Chromosome(np.array(genes).reshape(len(KINDS), -1)),
            proof == PROVED,
            Terms(*map(float, weights)) if weights else None,
        )
