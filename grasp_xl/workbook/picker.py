"""A cell into which the number of a listed design is typed, and the two gene rows that show it.

Lists with such a cell have their numbers and genes in the same columns, on whatever sheet.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

from grasp_xl.chromosome import Chromosome
from grasp_xl.workbook.layout import (
    KINDS,
    MAX_DESIGNS,
    TABLE_ROW,
    TRADE_OFFS,
    VALID_DESIGNS,
    WHAT_IF,
    Area,
)
from grasp_xl.workbook.pen import Pen
from grasp_xl.workbook.styles import Style

PICK_ROW = 2
PICKED_ROWS = (PICK_ROW + 2, 1)
"""First cell of the picked design's two gene rows."""
NUMBER_COLUMN, GENE_COLUMN = 0, 2
"""Columns of the table: a design's number, by which it is picked, and its first gene."""
GENE_ROW_STYLES = (Style.SUCTION_GENE, Style.MAGNETS_GENE)

TYPED = (
    "The What-if card shows genes that were typed there, not these. Empty its genes and run "
    "grasp-xl on this workbook to see here and there what is picked."
)

Formulas = list[list[str | None]]
"""A formula for each gene of both rows; None for a gene that is blank."""


@dataclass(frozen=True, slots=True)
class Picker:
    """The cell of one list.

    Parameters
    ----------
    sheet : str
    name : str
        Defined name of the cell.
    """

    sheet: str
    name: str

    def picked_rows(self, slots: int) -> Area:
        """Return the cells of the two gene rows of the picked design."""
        return Area(self.sheet, *PICKED_ROWS, len(KINDS), 1 + slots)

    def picked_genes(self, slots: int) -> list[list[str]]:
        """Return references to the gene rows of the picked design."""
        rows = self.picked_rows(slots)
        return [
            [rows.cell(kind, slot).reference for slot in range(rows.columns)]
            for kind in range(rows.rows)
        ]

    def formulas(self, rows: int, unpicked: Formulas) -> Formulas:
        """Return the formulas of the picked design's genes: right wherever they are pasted.

        Parameters
        ----------
        rows : int
            Rows of the list.
        unpicked : list of list of str
            What gives the genes that are shown while no row is picked.
        """
        row, usable = f"MATCH({self.name},{self._column(NUMBER_COLUMN, rows)},0)", self.usable(rows)
        left = GENE_COLUMN
        found: Formulas = []
        for genes in unpicked:
            listed = (self._column(left + slot, rows) for slot in range(len(genes)))
            found.append(
                [
                    None if gene is None else f"IF({usable},INDEX({column},{row}),{gene})"
                    for column, gene in zip(listed, genes, strict=True)
                ]
            )
            left += len(genes)
        return found

    def usable(self, rows: int) -> str:
        """Return the condition that a number of the list was typed."""
        numbers = self._column(NUMBER_COLUMN, rows)
        return f"AND(ISNUMBER({self.name}),ISNUMBER(MATCH({self.name},{numbers},0)))"

    def other_genes_on_card(self, slots: int) -> str:
        """Return the condition that the What-if card shows other genes than the two rows."""
        genes = self.picked_rows(slots).absolute
        differ = f'SUMPRODUCT(1*({WHAT_IF.name}&""<>{genes}&""))'
        return f"IF(ISERROR({differ}),TRUE,{differ}>0)"

    def _column(self, column: int, rows: int) -> str:
        return Area(self.sheet, TABLE_ROW + 1, column, rows).reference

    def write(
        self,
        pen: Pen,
        rows: int,
        number: int | None,
        shown: Chromosome,
        unpicked: Formulas,
        hint: PickHint,
        on_card: Chromosome,
    ) -> None:
        """Write the cell, and two gene rows as figure 34 has them: of what is picked, or not.

        Parameters
        ----------
        pen : Pen
        rows : int
            Rows of the list.
        number : int or None
            What is picked.
        shown : Chromosome
            Whose genes stand in the two rows then.
        unpicked : list of list of str
        hint : PickHint
        on_card : Chromosome
            What the What-if card shows.
        """
        slots = len(unpicked[0]) - 1
        typed = Overruled(self.other_genes_on_card(slots), TYPED, on_card.rows() != shown.rows())
        told = hint.told(self, rows, typed)
        pen.write(PICK_ROW, 0, "No. to show", Style.LABEL)
        pen.note(PICK_ROW, 0, hint.text)
        pen.write(PICK_ROW, 1, number, Style.INPUT)
        pen.write(PICK_ROW, 2, told[0], Style.NOTE, told[1])
        pen.name_area(self.name, Area(self.sheet, PICK_ROW, 1))
        pen.sheet.data_validation(
            PICK_ROW,
            1,
            PICK_ROW,
            1,
            {
                "validate": "integer",
                "criteria": "between",
                "minimum": 1,
                "maximum": f"=MAX(1,{self._column(NUMBER_COLUMN, MAX_DESIGNS)})",
                "error_message": "Type a number of the list.",
            },
        )
        pen.row(PICK_ROW + 1, 1, slot_labels(slots), Style.HEADER)
        formulas = self.formulas(rows, unpicked)
        for kind, (labels, genes) in enumerate(zip(KINDS, shown.rows(), strict=True)):
            row, style = PICK_ROW + 2 + kind, GENE_ROW_STYLES[kind]
            pen.write(row, 0, labels.row_label, style)
            for slot, (gene, formula) in enumerate(zip(genes, formulas[kind], strict=True)):
                pen.write(row, 1 + slot, gene, style, formula)


class Overruled(NamedTuple):
    """Why the What-if card shows something else than what is picked.

    Parameters
    ----------
    condition : str
        Formula that is true where it does.
    told : str
        What is said then.
    now : bool
        Whether it does, as written.
    """

    condition: str
    told: str
    now: bool


@dataclass(frozen=True, slots=True)
class PickHint:
    """What stands beside a cell.

    Parameters
    ----------
    text : str
        What it is for.
    otherwise : str
        What is shown where no number can be used.
    overruled : Overruled, optional
        By another cell.
    """

    text: str
    otherwise: str
    overruled: Overruled | None = None

    def told(self, picker: Picker, rows: int, typed: Overruled) -> tuple[str, str]:
        """Return the sentence as it is now, and its formula.

        Parameters
        ----------
        picker : Picker
        rows : int
            Rows of the list.
        typed : Overruled
            By genes on the What-if card itself.
        """
        wrong = f"No such number: type a whole number from 1 to {rows}; {self.otherwise} is shown."
        empty = f'IF(ISERROR({picker.name}),FALSE,{picker.name}="")'
        formula = f'IF(OR({empty},{picker.usable(rows)}),"{self.text}","{wrong}")'
        value = self.text
        for each in (typed, self.overruled):
            if each:
                formula = f'IF({each.condition},"{each.told}",{formula})'
                value = each.told if each.now else value
        return value, formula


DESIGN_PICK = Picker(VALID_DESIGNS, "DesignPick")
TRADE_OFF_PICK = Picker(TRADE_OFFS, "TradeOffPick")
"""The cells of the two lists; what is picked of the second is on the What-if card."""


class Picks(NamedTuple):
    """The designs that are picked of the two lists, None where none is."""

    design: Chromosome | None = None
    trade_off: Chromosome | None = None


NO_PICKS = Picks()


def constant(chromosome: Chromosome) -> Formulas:
    """Return genes as what formulas give."""
    return [[None if gene is None else str(gene) for gene in row] for row in chromosome.rows()]


def blank_like(references: Sequence[Sequence[str]], chromosome: Chromosome) -> Formulas:
    """Return references to genes, none where a chromosome's gene is blank."""
    return [
        [None if gene is None else reference for reference, gene in zip(*row, strict=True)]
        for row in zip(references, chromosome.rows(), strict=True)
    ]


def slot_labels(slots: int) -> tuple[str, ...]:
    """Return the header of two gene rows."""
    return ("Total #", *(f"Index {slot}" for slot in range(1, slots + 1)))
