"""The ``GA`` sheet: parameters and the chromosomes that a designer typed."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

from grasp_xl.chromosome import BLANK_GENE, UNSET_GENE, Chromosome
from grasp_xl.errors import UsageError
from grasp_xl.rules import Criterion, MomentArm, moment_arm
from grasp_xl.space import OptionSpace
from grasp_xl.task import Parameters
from grasp_xl.workbook import layout
from grasp_xl.workbook.cells import Source, cells_of
from grasp_xl.workbook.layout import Area, Field, xl_rowcol_to_cell

T = TypeVar("T")

MAX_CHILDREN = 50
"""Cards side by side on the sheet."""

MAX_GENERATIONS = 1_000_000_000
MAX_SEED = 2**53
"""Largest whole number that a cell holds exactly."""


def find_ga_sheet(source: Source) -> str | None:
    """Return the sheet with the parameters: by its names, else by its first label."""
    first = layout.PARAMETERS[0]
    if first.name in source.names:
        return source.names[first.name].sheet
    return next((s for s in source.sheets if source.grid(s).find(first.label)), None)


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
        self.heading = source.grid(sheet).find(layout.PARAMETERS[0].label)

    def cell(self, name: str) -> Area | None:
        field = next(field for field in layout.PARAMETERS if field.name == name)
        heading = self.heading.cell(-1, 0) if self.heading else None
        cell = self.source.locate(self.sheet, field, heading=heading)
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
        number = self.source.number(cell, expected, least=least, most=most, whole=True, limit=most)
        return None if number is None else int(number)

    def switch(self, name: str) -> bool | None:
        cell = self.cell(name)
        if cell is None:
            return None
        value = self.source.value(cell)
        if value in (0, 1):  # TRUE and FALSE too
            return bool(value)
        self.source.complain(cell.where, f"{value!r}", "1 or 0", "type 1 for yes or 0 for no")
        return None

    def criterion(self) -> Criterion | None:
        cell = self.cell("FitnessCriterion")
        return None if cell is None else self._word(cell, Criterion.parse)

    def arm(self) -> MomentArm | None:
        cell = self.cell("MomentArm")
        return None if cell is None else self._word(cell, moment_arm)

    def _word(self, cell: Area, parse: Callable[[str], T]) -> T | None:
        try:
            return parse(str(self.source.value(cell)))
        except UsageError as error:
            self.source.complain(
                cell.where, repr(self.source.value(cell)), "a word that is known", error.hint
            )
            return None

    def goal(self, number: int) -> float | None:
        """Read a typed goal; our own formula on the user-defined block says nothing."""
        cell = self.cell(layout.GOAL_NAMES[number])
        if cell is None:
            return None
        formula = self.source.formula(cell)
        block = self.source.names.get(layout.USER_BLOCK.name)
        if formula is not None and block is not None:
            ours = block.cell(3, number)  # the values two rows below the genes, cost behind FoS
            if formula.replace("$", "").upper() == xl_rowcol_to_cell(ours.row, ours.column):
                return None
        return self.source.number(cell, "a goal above 0", above=0)


def read_chromosome(source: Source, space: OptionSpace, block: Field) -> Chromosome | None:
    """Read a chromosome block; None where there is no block, or it is empty.

    What cannot be used is noted as a problem of its cell.
    """
    area = find_block(source, block)
    if area is None or all(source.blank(cell) for row in cells_of(area) for cell in row):
        return None
    before = len(source.problems)
    rows = [
        _gene_row(source, space, kind, list(cells)) for kind, cells in enumerate(cells_of(area))
    ]
    if len(source.problems) == before and not any(row[0] for row in rows):
        source.complain(
            area.where, "no element at all", "at least one element", "type a count above 0"
        )
    return Chromosome(rows) if len(source.problems) == before else None


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
    while str(grid.at(title.row + 1, title.column + 1 + columns)).startswith("Index"):
        columns += 1
    return Area(sheet, title.row + 2, title.column + 1, len(layout.KINDS), columns)


def _gene_row(source: Source, space: OptionSpace, number: int, cells: list[Area]) -> list[int]:
    kind = space.kinds[number]
    unset = UNSET_GENE if kind.total else BLANK_GENE
    genes = [0, *[unset] * space.gene_slots]
    count = source.number(
        cells[0],
        f"a whole number from {kind.count_min} to {kind.most}",
        least=kind.count_min,
        most=kind.most,
        whole=True,
    )
    if count is None:
        return genes
    genes[0] = int(count)
    seen: dict[int, Area] = {}
    for slot, cell in enumerate(cells[1 : 1 + space.gene_slots], 1):
        active = slot <= genes[0]
        if not active and source.blank(cell):
            continue
        index = source.number(
            cell,
            f"a {kind.name} index, a whole number from 1 to {kind.total}",
            least=1 if kind.total else 0,
            most=kind.total,
            whole=True,
        )
        if index is None:
            continue
        genes[slot] = int(index)
        if active and int(index) in seen:
            source.complain(
                cell.where,
                f"the index {int(index)} a second time",
                "active indices that differ",
                "two elements cannot stand at one place",
            )
        seen[int(index)] = cell
    return genes
