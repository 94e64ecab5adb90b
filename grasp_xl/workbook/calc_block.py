"""Where the helper cells of a grasp stand on the sheet ``Calc``."""

from __future__ import annotations

from dataclasses import dataclass

from grasp_xl.workbook.calc_inputs import COLUMNS, FIRST_ROW, INPUT_COLUMN
from grasp_xl.workbook.layout import CALC, KINDS, Area

BLOCK_COLUMN = INPUT_COLUMN + COLUMNS + 1
ELEMENT_HEADER = (
    "element",
    "in space",
    "active",
    "right",
    "x",
    "y",
    "z",
    "force (N)",
    "to polygon",
    "distinct",
    "least structure",
)
SUMMARY_HEADER = (
    "usable",
    "fault",
    "first wrong",
    "elements",
    "longest",
    "shortest",
    "main truss from",
    "main truss to",
    "hull area",
    "centroid inside",
)
TABLES = ("distance (mm)", "structure if this is the main truss (mm)", "edge of the hull (mm²)")


@dataclass(frozen=True, slots=True)
class CalcBlock:
    """Helper cells of one card.

    Parameters
    ----------
    number : int
        Place among the blocks, from the top.
    slots : int
        Index genes a kind.
    genes : Area
        The gene cells that the block computes from.
    """

    number: int
    slots: int
    genes: Area

    @property
    def size(self) -> int:
        """Rows of the block: every gene of every kind."""
        return self.slots * len(KINDS)

    @property
    def row(self) -> int:
        """First row."""
        return FIRST_ROW + self.number * (self.size + 6)

    @property
    def first(self) -> int:
        """Row of the first element."""
        return self.row + 4

    def column(self, name: str) -> Area:
        """All elements' cells of a column of ``ELEMENT_HEADER``."""
        return Area(CALC, self.first, BLOCK_COLUMN + ELEMENT_HEADER.index(name), self.size)

    def element(self, name: str, row: int) -> Area:
        """One element's cell of a column."""
        return self.column(name).cell(row, 0)

    def table(self, number: int) -> Area:
        """One of the three square tables."""
        left = BLOCK_COLUMN + len(ELEMENT_HEADER) + 1 + number * (self.size + 1)
        return Area(CALC, self.first, left, self.size, self.size)

    def summary(self, name: str) -> Area:
        """Return a cell of the summary row."""
        return Area(CALC, self.row + 2, BLOCK_COLUMN + 1 + SUMMARY_HEADER.index(name))

    @property
    def engine(self) -> Area:
        """The engine's FoS and four terms for the genes as written."""
        return Area(CALC, self.row + 2, BLOCK_COLUMN + 2 + len(SUMMARY_HEADER), 1, 5)

    @property
    def engine_genes(self) -> Area:
        """The genes as written."""
        left = self.engine.column + 6
        return Area(CALC, self.row + 1, left, len(KINDS), 1 + self.slots)

    def gene(self, kind: int, slot: int) -> str:
        """Return the reference to a gene cell; slot 0 is the count."""
        return self.genes.cell(kind, slot).reference
