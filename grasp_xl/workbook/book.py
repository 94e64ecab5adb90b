"""Reading a workbook as a whole: all that it says, before any default."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from grasp_xl.chromosome import Chromosome
from grasp_xl.errors import Problem
from grasp_xl.space import OptionSpace
from grasp_xl.task import Parameters
from grasp_xl.workbook import layout, run_log
from grasp_xl.workbook.cells import Source
from grasp_xl.workbook.reading import open_source, read_option_space
from grasp_xl.workbook.reading_ga import read_chromosome, read_parameters
from grasp_xl.workbook.reading_run import SavedRun, read_saved_run


@dataclass(frozen=True, eq=False)
class Book:
    """What a workbook says.

    Parameters
    ----------
    source : Source
    space : OptionSpace
    parameters : Parameters
    user_chromosome : Chromosome or None
    what_if : Chromosome or None
        Genes that the designer typed into the What-if card.
    """

    source: Source
    space: OptionSpace
    parameters: Parameters
    user_chromosome: Chromosome | None
    what_if: Chromosome | None

    @property
    def warnings(self) -> tuple[Problem, ...]:
        """What is odd about it."""
        return tuple(self.source.warnings)

    def saved_run(self) -> SavedRun:
        """Read the state of the run that it holds.

        Raises
        ------
        InputError
            If it holds none.
        """
        return read_saved_run(self.source, self.space)


def read_book(path: Path) -> Book:
    """Read an exported sheet or a full workbook.

    Raises
    ------
    InputError
        With every problem found.
    """
    source = open_source(path)
    space = read_option_space(source)
    parameters = read_parameters(source)
    user = read_chromosome(source, space, layout.USER_BLOCK)
    what_if = _typed_what_if(source, space)
    source.finish()
    return Book(source, space, parameters, user, what_if)


def _typed_what_if(source: Source, space: OptionSpace) -> Chromosome | None:
    """Return the genes of the What-if card if the designer typed them: not those we wrote."""
    if layout.WHAT_IF.name not in source.names:
        return None
    shown = read_chromosome(source, space, layout.WHAT_IF)
    logged = source.names.get(run_log.WHAT_IF_WRITTEN)
    written = str(source.value(logged)) if logged else ""
    return shown if shown and run_log.genes_text(shown) != written else None
