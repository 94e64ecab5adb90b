"""Reading a workbook as a whole: all that it says, before any default."""

from __future__ import annotations

import io
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from grasp_xl.chromosome import Chromosome
from grasp_xl.errors import InputError, Problem
from grasp_xl.space import OptionSpace
from grasp_xl.task import Parameters
from grasp_xl.workbook import layout, run_log
from grasp_xl.workbook.carrying import carried, is_usable
from grasp_xl.workbook.cells import Source, cells_of
from grasp_xl.workbook.designs_sheet import PICK_NAME
from grasp_xl.workbook.inputs import genes_text
from grasp_xl.workbook.layout import VALID_DESIGNS, Field
from grasp_xl.workbook.reading import open_source, read_option_space
from grasp_xl.workbook.reading_ga import (
    find_block,
    find_ga_sheet,
    read_chromosome,
    read_parameters,
)
from grasp_xl.workbook.reading_pick import read_pick
from grasp_xl.workbook.reading_run import (
    SavedRun,
    genes_as_they_stand,
    read_saved_run,
    shown_run,
)
from grasp_xl.workbook.stamp import is_untouched


@dataclass(frozen=True, eq=False)
class Book:
    """What a workbook says.

    Parameters
    ----------
    source : Source
    space : OptionSpace
    parameters : Parameters
    user_chromosome : Chromosome or None
        None also where the program assigned it.
    what_if : Chromosome or None
        Genes that the designer typed into the What-if card.
    picked : Chromosome or None
        Design that the designer picked from the list.
    """

    source: Source
    space: OptionSpace
    parameters: Parameters
    user_chromosome: Chromosome | None
    what_if: Chromosome | None
    picked: Chromosome | None

    @property
    def warnings(self) -> tuple[Problem, ...]:
        """What is odd about it."""
        return tuple(self.source.warnings)

    @property
    def is_untouched(self) -> bool:
        """Whether it is just as we wrote it."""
        return is_untouched(io.BytesIO(self.source.package.content))

    def saved_run(self) -> SavedRun:
        """Read the state of the run that it holds.

        Raises
        ------
        InputError
            If it holds none.
        """
        return read_saved_run(self.source, self.space)

    def shown_run(self) -> SavedRun | None:
        """Read the run that it shows, though somebody may have changed it."""
        return shown_run(self.source, self.space)


def read_book(path: Path) -> Book:
    """Read an exported sheet or a full workbook.

    Raises
    ------
    InputError
        With every problem found.
    """
    return _book(open_source(path), stale_genes=False)


def read_previous(path: Path) -> Book | None:
    """Read the full workbook that a new export goes into; None if the file is none.

    Its chromosomes may have genes that its option space does not have.

    Raises
    ------
    InputError
        With every problem found in a full workbook.
    """
    try:
        source = open_source(path)
    except InputError:
        return None
    return _book(source, stale_genes=True) if find_ga_sheet(source) else None


def _book(source: Source, *, stale_genes: bool) -> Book:
    space = read_option_space(source)
    parameters = read_parameters(source)
    picked = read_pick(source)

    def typed(block: Field) -> Chromosome | None:
        if stale_genes and find_block(source, block):
            with suppress(ValueError):  # then what is wrong is noted, cell by cell
                return Chromosome(genes_as_they_stand(source, block))
        return read_chromosome(source, space, block)

    user = None if _is_assigned(source) else typed(layout.USER_BLOCK)
    what_if = typed(layout.WHAT_IF) if _is_typed(source, layout.WHAT_IF) else None
    if picked:
        picked, _ = carried(picked, space, space, VALID_DESIGNS)
        if not (stale_genes or is_usable(picked, space)):
            source.warn(
                source.names[PICK_NAME].where,
                "a design that the option space no longer has",
                "one of its designs",
                "the What-if card does not show it any longer; pick another",
            )
            picked = None
    source.finish()
    return Book(source, space, parameters, user, what_if, picked)


def _is_assigned(source: Source) -> bool:
    """Tell whether the program chose the user-defined chromosome, and nobody typed over it."""
    area = find_block(source, layout.USER_BLOCK)
    written = source.names.get(run_log.BENCHMARK_WRITTEN)
    if area is None or written is None or min(area.row - 2, area.column - 1) < 0:
        return False
    if layout.ASSIGNED_MARK not in str(source.value(area.cell(-2, -1))):
        return False
    with suppress(ValueError):
        genes = Chromosome(genes_as_they_stand(source, layout.USER_BLOCK))
        return genes_text(genes) == source.value(written)
    return False


def _is_typed(source: Source, block: Field) -> bool:
    """Tell whether any gene of a block is somebody's, and not a formula of ours."""
    area = source.names.get(block.name)
    cells = [cell for row in cells_of(area) for cell in row] if area else []
    return any(cell not in source.worked_out and not source.blank(cell) for cell in cells)
