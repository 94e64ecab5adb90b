"""The ``GA`` sheet: parameters and the chromosomes that a designer typed."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

import numpy as np

from grasp_xl.chromosome import BLANK_GENE, UNSET_GENE, Chromosome
from grasp_xl.errors import UsageError
from grasp_xl.rules import DIVERGENCE, TERMS, Criterion, MomentArm, moment_arm
from grasp_xl.space import OptionSpace
from grasp_xl.task import Parameters
from grasp_xl.workbook import layout
from grasp_xl.workbook.cells import LABEL_ROWS, Source, as_number, cells_of, is_blank, normal, shown
from grasp_xl.workbook.layout import MAX_CHILDREN, MAX_GENERATIONS, MAX_SEED, Area, Field

T = TypeVar("T")

A_CRITERION = f"{DIVERGENCE}, one of {', '.join(TERMS)}, or some of these joined by +"
AN_ARM = "3d or plan"


def find_ga_sheet(source: Source) -> str | None:
    """Return the sheet with the parameters: by its names, else by its first label."""
    for field in layout.PARAMETERS:
        if field.name in source.names:
            return source.names[field.name].sheet
    label = next(source.sheets_with(layout.PARAMETERS[0].label), None)
    return label.sheet if label else None


def read_parameters(source: Source) -> Parameters:
    """Read the parameters; cells that are missing or empty say nothing."""
    sheet = find_ga_sheet(source)
    if sheet is None:
        return Parameters()
    reader = _ParameterReader(source, sheet)
    return Parameters(
        user_start=reader.switch("UserStart"),
        elitism=reader.switch("Elitism"),
        one_in=reader.number("MutationOneIn", "n of 1-in-n, 1 or more", least=1),
        generations=reader.whole("Generations", least=0, most=MAX_GENERATIONS),
        clearance_mm=reader.number("MinClearance", "a distance above 0 mm", above=0),
        density_ratio=reader.number("DensityRatio", "a ratio of 0 or more", least=0),
        criterion=reader.criterion(),
        fos=reader.number("FoSGoal", "a factor of safety above 0", above=0),
        goals=tuple(reader.goal(number) for number in range(len(layout.GOAL_NAMES))),
        children=reader.whole("Children", least=2, most=MAX_CHILDREN),
        seed=reader.whole("Seed", least=0, most=MAX_SEED),
        moment_arm=reader.arm(),
    )


class _ParameterReader:
    def __init__(self, source: Source, sheet: str) -> None:
        self.source = source
        self.sheet = sheet
        self.first_label = source.grid(sheet).find(layout.PARAMETERS[0].label)

    def cell(self, name: str) -> Area | None:
        field = next(field for field in layout.PARAMETERS if field.name == name)
        first = self.first_label
        rows = range(first.row if first else 0, LABEL_ROWS)
        column = first.column if first else None
        cell = self.source.locate(self.sheet, field, rows=rows, column=column)
        return None if cell is None or self.source.blank(cell) else cell

    def number(
        self, name: str, expected: str, *, above: float = -1.0, least: float = 0.0
    ) -> float | None:
        cell = self.cell(name)
        return self.source.number(cell, expected, above=above, least=least) if cell else None

    def whole(self, name: str, *, least: int, most: int) -> int | None:
        cell = self.cell(name)
        if cell is None:
            return None
        expected = f"a whole number from {least} to {most:,}"
        number = self.source.number(
            cell, expected, least=least, most=most, whole=True, limit=MAX_SEED
        )
        return None if number is None else int(number)

    def switch(self, name: str) -> bool | None:
        cell = self.cell(name)
        if cell is None:
            return None
        value = self.source.value(cell)
        if isinstance(value, bool):
            return value
        number = self.source.number(cell, "1 (yes) or 0 (no)", least=0, most=1, whole=True)
        return None if number is None else number == 1

    def criterion(self) -> Criterion | None:
        return self._word("FitnessCriterion", A_CRITERION, Criterion.parse)

    def arm(self) -> MomentArm | None:
        return self._word("MomentArm", AN_ARM, moment_arm)

    def _word(self, name: str, expected: str, parse: Callable[[str], T]) -> T | None:
        cell = self.cell(name)
        if cell is None:
            return None
        value = self.source.value(cell)
        if is_blank(value):
            self.source.number(cell, expected)  # notes a formula without a stored value
            return None
        try:
            return parse(str(value))
        except UsageError:
            hint = "correct the word, or clear the cell for the default"
            self.source.complain(cell.where, repr(value), expected, hint)
            return None

    def goal(self, number: int) -> float | None:
        """Read a typed goal; our own formula on the user-defined block says nothing."""
        name = layout.GOAL_NAMES[number]
        cell = self.cell(name)
        if cell is None or self._shows_user_block(cell, number):
            return None
        return self.number(name, "a goal above 0", above=0)

    def _shows_user_block(self, cell: Area, number: int) -> bool:
        formula = self.source.formula(cell)
        genes = find_block(self.source, layout.USER_BLOCK) if formula else None
        if formula is None or genes is None:
            return False
        shown = genes.cell(3, number)  # the values, cost behind FoS, two rows below the genes
        sheet, _, reference = formula.replace("$", "").rpartition("!")
        own_sheet = sheet.strip("'") in ("", shown.sheet)
        return own_sheet and shown.where.endswith(f"!{reference.upper()}")


def read_chromosome(source: Source, space: OptionSpace, block: Field) -> Chromosome | None:
    """Read a chromosome block; None where there is no block, or it is empty.

    What cannot be used is noted as a problem of its cell.
    """
    area = find_block(source, block)
    if area is None:
        return None
    if area.rows != len(space.kinds) or area.columns < 2:
        source.complain(
            area.where,
            f"the name {block.name} on {area.rows} rows and {area.columns} columns",
            f"{len(space.kinds)} rows of a count and indices",
            "let the name refer to the block's values, or delete the name",
        )
        return None
    if all(source.blank(cell) for row in cells_of(area) for cell in row):
        return None
    before = len(source.problems)
    rows = [
        _gene_row(source, space, kind, list(cells)) for kind, cells in enumerate(cells_of(area))
    ]
    if len(source.problems) == before and not any(row[0] for row in rows):
        source.complain(
            area.where, "no element at all", "at least one element", "type a count above 0"
        )
    return Chromosome(np.array(rows)) if len(source.problems) == before else None


def find_block(source: Source, block: Field) -> Area | None:
    """Find the genes of a chromosome block: by name, else below its title."""
    if block.name in source.names:
        return source.names[block.name]
    sheet = find_ga_sheet(source)
    if sheet is None:
        return None
    grid = source.grid(sheet)
    title = grid.find(block.label) or grid.find(f"{block.label} {layout.ASSIGNED_MARK}")
    if title is None:
        return None
    columns = 1
    while _is_index_label(grid.at(title.row + 1, title.column + 1 + columns)):
        columns += 1
    return Area(sheet, title.row + 2, title.column + 1, len(layout.KINDS), columns)


def _is_index_label(value: object) -> bool:
    return isinstance(value, str) and normal(value).startswith("index ")


def _gene_row(source: Source, space: OptionSpace, number: int, cells: list[Area]) -> list[int]:
    kind = space.kinds[number]
    genes = [0, *[UNSET_GENE if kind.total else BLANK_GENE] * space.gene_slots]
    index_cells = cells[1 : 1 + space.gene_slots]
    most = min(kind.most, len(index_cells))
    count = source.number(
        cells[0],
        f"a whole number from {kind.count_min} to {most}",
        least=kind.count_min,
        most=most,
        whole=True,
    )
    if count is None or not kind.total:
        return genes
    genes[0] = int(count)
    expected = f"a {kind.name} index, a whole number from 1 to {kind.total}"
    active: set[int] = set()
    for slot, cell in enumerate(index_cells, 1):
        if slot > genes[0]:
            genes[slot] = _inactive_gene(source, cell, expected, kind.total)
            continue
        index = source.number(cell, expected, least=1, most=kind.total, whole=True)
        if index is None:
            continue
        genes[slot] = int(index)
        if genes[slot] in active:
            source.complain(
                cell.where,
                f"the index {genes[slot]} a second time",
                "active indices that differ",
                "two elements cannot stand at one place",
            )
        active.add(genes[slot])
    return genes


def _inactive_gene(source: Source, cell: Area, expected: str, total: int) -> int:
    """Read a gene that enters no sum: where it is no index, it counts as one that nobody set."""
    index = as_number(source.value(cell))
    if isinstance(index, float) and index.is_integer() and 1 <= index <= total:
        return int(index)
    if not source.blank(cell):
        found = shown(index) if isinstance(index, float) else index.found
        source.warn(cell.where, found, expected, f"it is inactive, and counts as {UNSET_GENE}")
    return UNSET_GENE
