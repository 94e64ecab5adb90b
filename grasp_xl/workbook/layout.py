"""Where everything stands in the workbook, said once for reader and writer.

Labels are the thesis's, to the letter.  Rows and columns count from 0.  The core's list of element
kinds becomes the thesis's two here: suction cups, then magnets.
"""

from __future__ import annotations

from dataclasses import dataclass

from xlsxwriter.utility import xl_cell_to_rowcol, xl_range_abs, xl_rowcol_to_cell

OPTION_SPACE = "Option Space"
GA = "GA"
VALID_DESIGNS = "Valid Designs"
FITNESS_TABLE = "Fitness Table"
HISTORY = "History"
GRASP = "Grasp"
RUN_LOG = "Run Log"
CALC = "Calc"
SHEETS = (OPTION_SPACE, GA, VALID_DESIGNS, FITNESS_TABLE, HISTORY, GRASP, RUN_LOG, CALC)
"""Of every full workbook."""

TRADE_OFFS = "Trade-offs"
"""Sheet of the workbooks that ``front`` writes, behind the valid designs."""

PART_SHEET = "Part"
"""Sheet of the workbooks whose option space ``fit`` made, behind it."""

OCCASIONAL = (PART_SHEET, TRADE_OFFS)
"""Sheets that some full workbooks have."""

CONFIGURATION = "xlwings.conf"
"""Sheet in which the buttons of a workbook with macros find their settings: its last."""

TITLE = "INPUT PARAMETERS (ALL DATA in GRAMS, MILLIMETERS, and NEWTONS)"


MAX_CHILDREN = 50
"""Child cards side by side."""

MAX_GENERATIONS = 1_000_000_000
MAX_SEED = 2**53
"""Largest whole number that a cell holds exactly."""


@dataclass(frozen=True, slots=True)
class Area:
    """A block of cells on a sheet."""

    sheet: str
    row: int
    column: int
    rows: int = 1
    columns: int = 1

    @property
    def absolute(self) -> str:
        """Reference as a formula on the same sheet has it: ``$B$5:$B$14``."""
        last_row, last_column = self.row + self.rows - 1, self.column + self.columns - 1
        return str(xl_range_abs(self.row, self.column, last_row, last_column))

    @property
    def reference(self) -> str:
        """Reference with the sheet, as other sheets and defined names have it."""
        return f"'{self.sheet}'!{self.absolute}"

    @property
    def local(self) -> str:
        """First cell as a formula on the same sheet has it: ``B5``."""
        return str(xl_rowcol_to_cell(self.row, self.column))

    @property
    def where(self) -> str:
        """First cell as a person names it: ``GA!B5``."""
        return place(self.sheet, self.row, self.column)

    def cell(self, row: int, column: int) -> Area:
        """Return one cell of the block, counted from its first."""
        return Area(self.sheet, self.row + row, self.column + column)

    def up_to(self, right: Area) -> Area:
        """Return the area from this one to another beside it."""
        columns = right.column + right.columns - self.column
        return Area(self.sheet, self.row, self.column, self.rows, columns)


def place(sheet: str, row: int, column: int) -> str:
    """Name a cell as a person does: ``Option Space!B5``."""
    return f"{sheet}!{xl_rowcol_to_cell(row, column)}"


def area_of(reference: str) -> Area:
    """Read a defined name's reference.

    Raises
    ------
    ValueError
        If it is no plain block of cells on one sheet.
    """
    sheet, _, cells = reference.rpartition("!")
    first, _, last = cells.replace("$", "").partition(":")
    try:
        row, column = xl_cell_to_rowcol(first)
        last_row, last_column = xl_cell_to_rowcol(last or first)
    except (AttributeError, ValueError) as error:
        raise ValueError(reference) from error
    name = sheet.strip("'").replace("''", "'")
    if not name or last_row < row or last_column < column:
        raise ValueError(reference)
    return Area(name, row, column, last_row - row + 1, last_column - column + 1)


@dataclass(frozen=True, slots=True)
class Field:
    """One input cell: its defined name and its label; the value stands right of the label."""

    name: str
    label: str


@dataclass(frozen=True, slots=True)
class Section:
    """Labelled input cells under a heading, in two columns."""

    heading: str
    row: int
    fields: tuple[Field, ...]

    def row_of(self, name: str) -> int:
        """Row of a field, counted from the sheet's first."""
        return self.row + 1 + [field.name for field in self.fields].index(name)


@dataclass(frozen=True, slots=True)
class KindLabels:
    """How one element kind is called in the workbook, and where its data stand."""

    kind: str
    row_label: str
    plural: str
    section: Section
    locations_name: str
    locations_label: str
    column: int
    diameter: Field
    model: Field

    def field(self, suffix: str) -> str:
        """Return the defined name of one of the kind's inputs: ``SuctionMin`` for ``Min``."""
        return self.locations_name.removesuffix("Locations") + suffix


PART = Section(
    "Part data",
    3,
    (
        Field("PartMass", "Part mass (g)"),
        Field("CentroidX", "Centroid X (mm)"),
        Field("CentroidY", "Centroid Y (mm)"),
        Field("CentroidZ", "Centroid Z (mm)"),
    ),
)
SUCTION = KindLabels(
    "suction",
    "Suction",
    "suction cups",
    Section(
        "Suction cup data",
        9,
        (
            Field("SuctionMin", "# Suction Cups (Min.)"),
            Field("SuctionMax", "# Suction Cups (Max.)"),
            Field("SuctionForce", "Normal force capacity (N)"),
            Field("SuctionPrice", "Unit price ($)"),
            Field("SuctionWeight", "Weight (g)"),
            Field("SuctionTotal", "Total #  suction cups"),
        ),
    ),
    "SuctionLocations",
    "Suction cup locations",
    3,
    Field("SuctionDiameter", "Suction cup diameter (mm)"),
    Field("SuctionModel", "Suction cup model"),
)
MAGNETS = KindLabels(
    "magnets",
    "Magnets",
    "magnets",
    Section(
        "Magnet data",
        17,
        (
            Field("MagnetMin", "# Magnets (Min.)"),
            Field("MagnetMax", "# Magnets (Max.)"),
            Field("MagnetForce", "Normal force capacity (N)"),
            Field("MagnetPrice", "Unit price ($)"),
            Field("MagnetWeight", "Weight (g)"),
            Field("MagnetTotal", "Total # magnets"),
        ),
    ),
    "MagnetLocations",
    "Magnet locations",
    6,
    Field("MagnetDiameter", "Magnet diameter (mm)"),
    Field("MagnetModel", "Magnet model"),
)
KINDS = (SUCTION, MAGNETS)
DEFAULT_DIAMETERS_MM = (46.0, 30.0)
"""Assumed where the workbook does not know them: the thesis's cup and magnet (section 6.2)."""

INDEX_LABEL = "Index"
INDEX_COLUMN = 2
FIRST_LOCATION_ROW = 4
LOCATION_HEADER_ROW = 1
OVERLAP_LABEL = "Overlap"
OVERLAP_COLUMN = 9
OVERLAP_KIND = "magnets"

SCALE_FACTOR = Field("ScaleFactor", "Scale Factor:")
POLYGON_COLUMN = 10
POLYGON_HEADER = ("i", "x", "y", "z")
POLYGON_HEADER_ROW = 1
IDEAL_POLYGON = "IdealPolygon"
APPROXIMATION_POLYGON = "ApproximationPolygon"
APPROXIMATION_LABEL = "Approximation polygon"
APPROXIMATION_COLUMN = 15
CENTROID_LABEL = "Centroid"
DETAIL_COLUMN = 20
DIAMETER_ROWS = (0, 2)
"""Rows of the diameters; the models stand below each."""

PARAMETERS = (
    Field("UserStart", "User-Defined Starting Chromosome"),
    Field("Elitism", "Elitism"),
    Field("MutationOneIn", "1-in-n Mutation Probability"),
    Field("Generations", "Number of Generations"),
    Field("MinClearance", "Minimum Gripper Element Distance (mm)"),
    Field("DensityRatio", "Structure Linear Density Ratio"),
    Field("FitnessCriterion", "Fitness Criterion"),
    Field("FoSGoal", "FoS"),
    Field("CostGoal", "Cost ($)"),
    Field("MomentGoal", "Residual Moment (N-mm)"),
    Field("DeviationGoal", "Deviation (mm)"),
    Field("StructureGoal", "Structure (mm)"),
    Field("Children", "Children per Generation"),
    Field("Seed", "Seed"),
    Field("MomentArm", "Moment Arm"),
)
GOAL_NAMES = ("CostGoal", "MomentGoal", "DeviationGoal", "StructureGoal")
PARAMETER_HEADER = ("Attribute", "Value")
PARAMETER_ROW = 2
BLOCK_COLUMN = 3

FITNESS_HEADER = ("FoS", "Cost", "Moment", "Dev.", "Struc.")
DIVERGENCE_LABEL = "Divergence"

RANDOM_BLOCK = Field("RandomChromosome", "Random Chromosome Generator")
USER_BLOCK = Field("UserChromosome", "User-Defined Chromosome")
INITIAL_BLOCK = Field("InitialChromosome", "Initial Chromosome")
PARENT_BLOCK = Field("ParentChromosome", "Parent Chromosome")
MATRIX_BLOCK = Field("MutationMatrix", "Mutation matrix")
ASSIGNED_MARK = "(program-assigned)"
WHAT_IF = Field("WhatIf", "What-if")
PROVED = Field("Proved", "Proved optimum")


@dataclass(frozen=True, slots=True)
class Layout:
    """Places that depend on the sizes at hand.

    Parameters
    ----------
    gene_slots : int
        Index genes a kind, m; 5 in the thesis.
    children : int
        Child cards side by side.
    """

    gene_slots: int
    children: int

    @property
    def genes(self) -> tuple[int, int]:
        """Rows and columns of the values of a chromosome block."""
        return len(KINDS), 1 + self.gene_slots

    @property
    def card_row(self) -> int:
        """First row of the cards."""
        return PARAMETER_ROW + len(PARAMETERS) + 3

    def block(self, block: Field) -> Area:
        """Title cell of a chromosome block."""
        left, right = BLOCK_COLUMN, self.card(1).column
        row, column = {
            RANDOM_BLOCK.name: (1, left),
            USER_BLOCK.name: (6, left),
            INITIAL_BLOCK.name: (14, left),
            PARENT_BLOCK.name: (1, right),
            MATRIX_BLOCK.name: (6, right),
        }[block.name]
        return Area(GA, row, column)

    def block_genes(self, block: Field) -> Area:
        """Values of a chromosome block."""
        title = self.block(block)
        return Area(GA, title.row + 2, title.column + 1, *self.genes)

    @property
    def user_fitness(self) -> Area:
        """First label of the user-defined chromosome's fitness; the values stand below."""
        return self.block(USER_BLOCK).cell(4, 0)

    @property
    def user_status(self) -> Area:
        """What the user-defined block says of its grasp: two lines of its own width."""
        first = self.user_fitness.cell(2, 0)
        return Area(GA, first.row, first.column, 2, self.what_if.columns)

    def user_term(self, number: int) -> Area:
        """Value of a term, cost first, of the user-defined chromosome: its goal by default."""
        return self.user_fitness.cell(1, 1 + number)

    def card(self, number: int) -> Card:
        """Return the card of a child, 0-based; the one after the last child is the What-if."""
        first = Card(self.card_row, BLOCK_COLUMN, self.gene_slots)
        return Card(first.row, first.column + number * (first.columns + 1), self.gene_slots)

    @property
    def what_if(self) -> Card:
        """Card that the designer may type into."""
        return self.card(self.children)

    @property
    def proved(self) -> Card:
        """Card of the exact search."""
        return self.card(self.children + 1)

    def parameter(self, name: str) -> Area:
        """Value cell of a parameter."""
        number = [field.name for field in PARAMETERS].index(name)
        return Area(GA, PARAMETER_ROW + 1 + number, 1)


@dataclass(frozen=True, slots=True)
class Card:
    """Places on one child card (figure 33); ``row`` and ``column`` are its first cell."""

    row: int
    column: int
    gene_slots: int

    def at(self, row: int, column: int, rows: int = 1, columns: int = 1) -> Area:
        """Return an area of the card, counted from its first cell."""
        return Area(GA, self.row + row, self.column + column, rows, columns)

    @property
    def columns(self) -> int:
        """Columns of the card: 7 in the thesis."""
        return 2 + self.gene_slots

    @property
    def area(self) -> Area:
        """The whole card, with the notes under it."""
        return self.at(0, 0, self.summary_row + 23, self.columns)

    @property
    def genes(self) -> Area:
        """The gene rows."""
        return self.at(2, 1, len(KINDS), 1 + self.gene_slots)

    def table_row(self, kind: int) -> int:
        """Row of a kind's moment heading; its header and its rows follow."""
        return 4 + kind * (3 + self.gene_slots)

    @property
    def summary_row(self) -> int:
        """Row of ``Lifting force``; 20 in the thesis."""
        return self.table_row(len(KINDS))

    @property
    def fitness(self) -> Area:
        """The five normalised values."""
        return self.at(self.summary_row + 13, 0, 1, len(FITNESS_HEADER))

    @property
    def status(self) -> Area:
        """What the card says of its grasp, in a line."""
        return self.at(self.summary_row + 15, 0, 1, self.columns)

    @property
    def divergence(self) -> Area:
        """The divergence, right of the normalised values."""
        return self.at(self.summary_row + 13, 5)

    @property
    def difference(self) -> Area:
        """How far the card's numbers are from the program's, or that something was edited."""
        return self.at(self.summary_row + 22, 5)


TABLE_ROW = 7
"""Header row of the valid-design list; a picked row stands above it."""

MAX_DESIGNS = 10_000
"""Designs that a list has room for: charts, colours and the pick reach as far."""

HISTORY_ROW = 2
"""Header row of the history."""

GRASP_DATA_COLUMN = 30
"""First column of the points that the pictures are drawn from."""
