"""Reading a workbook as a whole: all that it says, before any default."""

from __future__ import annotations

import io
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from grasp_xl.chromosome import Chromosome, is_usable
from grasp_xl.errors import InputError, Problem
from grasp_xl.space import OptionSpace
from grasp_xl.task import Parameters
from grasp_xl.workbook import layout, run_log
from grasp_xl.workbook.carrying import SetAside, carried
from grasp_xl.workbook.cells import Source, cells_of
from grasp_xl.workbook.inputs import genes_of_text, genes_text
from grasp_xl.workbook.layout import Area, Field
from grasp_xl.workbook.macros import Macros, read_macros
from grasp_xl.workbook.package import Package, read_package
from grasp_xl.workbook.part_sheet import PartRecord
from grasp_xl.workbook.picker import DESIGN_PICK, TRADE_OFF_PICK, Picker, Picks
from grasp_xl.workbook.reading import read_option_space
from grasp_xl.workbook.reading_ga import find_block, find_ga_sheet, read_chromosome, read_parameters
from grasp_xl.workbook.reading_part import read_part_record
from grasp_xl.workbook.reading_pick import read_picks
from grasp_xl.workbook.reading_run import (
    UNREADABLE,
    SavedRun,
    genes_as_they_stand,
    read_saved_run,
    shown_run,
)
from grasp_xl.workbook.reading_trade_offs import read_trade_offs
from grasp_xl.workbook.stamp import is_untouched
from grasp_xl.workbook.stored import StoredCells
from grasp_xl.workbook.trade_offs_sheet import TradeOffs


@dataclass(frozen=True, eq=False)
class Book:
    """What a workbook says.

    Parameters
    ----------
    source : Source
    package : Package or None
        The file; None where it is open in Excel.
    space : OptionSpace
    parameters : Parameters
    user_chromosome : Chromosome or None
        None also where the program assigned it.
    assigned : Chromosome or None
        The grasp that the program assigned in its place.
    what_if : Chromosome or None
        Genes that the designer typed into the What-if card.
    picks : Picks
        Designs that the designer picked from the lists.
    trade_offs : TradeOffs or None
        The list of the sheet ``Trade-offs``, as it was written.
    set_aside : SetAside
        Genes of the designer that the option space does not have.
    part : PartRecord or None
        What the sheet ``Part`` says.
    """

    source: Source
    package: Package | None
    space: OptionSpace
    parameters: Parameters
    user_chromosome: Chromosome | None
    assigned: Chromosome | None
    what_if: Chromosome | None
    picks: Picks
    trade_offs: TradeOffs | None
    set_aside: SetAside
    part: PartRecord | None

    @property
    def warnings(self) -> tuple[Problem, ...]:
        """What is odd about it."""
        return tuple(self.source.warnings)

    @property
    def is_untouched(self) -> bool:
        """Whether it is a file just as we wrote it."""
        return self.package is not None and is_untouched(io.BytesIO(self.package.content))

    @cached_property
    def macros(self) -> Macros | None:
        """Its buttons and what belongs to them; None where it has none of ours."""
        return read_macros(self.package, self.source) if self.package else None

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
    package = read_package(path)
    return book_of(Source(StoredCells(package)), package)


def read_previous(path: Path) -> Book | None:
    """Read the full workbook that a new export goes into; None if the file is none.

    Its chromosomes may have genes that its option space does not have.

    Raises
    ------
    InputError
        With every problem found in a full workbook.
    """
    try:
        package = read_package(path)
        source = Source(StoredCells(package))
        ga_sheet = find_ga_sheet(source)
    except InputError:
        return None
    return book_of(source, package, stale_genes=True) if ga_sheet else None


def book_of(source: Source, package: Package | None = None, *, stale_genes: bool = False) -> Book:
    """Read what the cells of a workbook say.

    Parameters
    ----------
    source : Source
    package : Package, optional
        The file that it is.
    stale_genes : bool
        Whether its chromosomes may have genes that its option space does not have.

    Raises
    ------
    InputError
        With every problem found.
    """
    parameters = read_parameters(source)
    picks = read_picks(source)
    trade_offs, part = read_trade_offs(source), read_part_record(source)
    space = read_option_space(source)  # last: if it cannot be read, all problems are named

    def typed(block: Field) -> Chromosome | None:
        if stale_genes and find_block(source, block):
            with suppress(ValueError):  # then what is wrong is noted, cell by cell
                return Chromosome(genes_as_they_stand(source, block))
        return read_chromosome(source, space, block)

    assigned = _assigned(source, space)
    user = None if assigned else typed(layout.USER_BLOCK)
    what_if = typed(layout.WHAT_IF) if _is_typed(source, layout.WHAT_IF) else None
    usable = Picks(
        *(
            _usable_pick(source, space, picker, picked, stale_genes=stale_genes)
            for picker, picked in zip((DESIGN_PICK, TRADE_OFF_PICK), picks, strict=True)
        )
    )
    set_aside = SetAside(
        _set_aside(source, layout.USER_BLOCK, run_log.USER_SET_ASIDE) if user is None else None,
        _set_aside(source, layout.WHAT_IF, run_log.WHAT_IF_SET_ASIDE) if what_if is None else None,
    )
    source.finish()
    return Book(
        source,
        package,
        space,
        parameters,
        user,
        assigned,
        what_if,
        usable,
        trade_offs,
        set_aside,
        part,
    )


def _usable_pick(
    source: Source,
    space: OptionSpace,
    picker: Picker,
    picked: Chromosome | None,
    *,
    stale_genes: bool,
) -> Chromosome | None:
    """Return a picked design in the option space's number of genes; None if that has it no more."""
    if picked is None:
        return None
    fitted, _ = carried(picked, space, space, picker.sheet)
    if stale_genes or is_usable(fitted, space):
        return fitted
    source.warn(
        source.names[picker.name].where,
        "a design that the option space no longer has",
        "one of its designs",
        "the What-if card does not show it any longer; pick another",
    )
    return None


def _assigned(source: Source, space: OptionSpace) -> Chromosome | None:
    """Return the user-defined chromosome if the program chose it, and nobody typed over it.

    It has as many genes as the option space, though not all may be usable.
    """
    area = find_block(source, layout.USER_BLOCK)
    written = source.names.get(run_log.BENCHMARK_WRITTEN)
    if area is None or written is None or min(area.row - 2, area.column - 1) < 0:
        return None
    if layout.ASSIGNED_MARK not in str(source.value(area.cell(-2, -1))):
        return None
    with suppress(ValueError):
        genes = Chromosome(genes_as_they_stand(source, layout.USER_BLOCK))
        if genes_text(genes) == source.value(written):
            return carried(genes, space, space, layout.USER_BLOCK.label)[0]
    return None


def _set_aside(source: Source, block: Field, name: str) -> Chromosome | None:
    """Return genes of the designer that were set aside, and warn of them; else None."""
    with suppress(*UNREADABLE):
        genes = genes_of_text(source.value(source.names[name]))
        if genes.shape[:-1] == (len(layout.KINDS),):
            source.warn(
                source.names[name].where,
                f"genes of {block.label} that the option space did not have",
                "none",
                "type others on GA; these are kept",
            )
            return Chromosome(genes)
    return None


def _is_typed(source: Source, block: Field) -> bool:
    """Tell whether any gene of a block is somebody's, and not a formula of ours."""
    area = source.names.get(block.name)
    cells = [cell for row in cells_of(area) for cell in row] if area else []
    return any(
        not (cell in source.worked_out or source.blank(cell) or _has_lost_its_sheet(source, cell))
        for cell in cells
    )


def _has_lost_its_sheet(source: Source, cell: Area) -> bool:
    """Tell whether a cell's formula shows a design of a list whose sheet was deleted."""
    formula = source.formula(cell) or ""
    gone = layout.TRADE_OFFS not in source.sheets and layout.TRADE_OFFS in formula
    return gone or "#REF!" in formula
