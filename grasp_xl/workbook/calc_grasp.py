"""Helper cells of one grasp on the sheet ``Calc``: elements, their pairs, what is wrong."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import permutations

from grasp_xl.chromosome import BLANK_GENE
from grasp_xl.grasp import Grasp
from grasp_xl.space import OptionSpace
from grasp_xl.workbook.calc_block import (
    BLOCK_COLUMN,
    ELEMENT_HEADER,
    SUMMARY_HEADER,
    TABLES,
    CalcBlock,
)
from grasp_xl.workbook.calc_inputs import INPUTS_FAULT, INPUTS_USABLE, used
from grasp_xl.workbook.calc_rules import SLACK, listed
from grasp_xl.workbook.calc_values import CalcValues
from grasp_xl.workbook.layout import CALC, KINDS, Area
from grasp_xl.workbook.pen import Cell
from grasp_xl.workbook.styles import Style
from grasp_xl.workbook.written import CellValue

MEASURED = ("longest", "shortest", "hull area")
SAME_PLACE = "1E-9"
"""Coordinates nearer than this are the same place (mm)."""
FAR = "1E9"
"""Beyond every row and column."""
NO_GENES = "There are no genes: type a grasp, or run grasp-xl on this workbook to fill them in."
NO_ELEMENT = "There is no element: type a Total # above 0."
TWICE = ": this index a second time; type another, two elements cannot stand at one place."


def block_cells(
    title: str, block: CalcBlock, space: OptionSpace, grasp: Grasp, density_ratio: float
) -> Iterator[Cell]:
    """Yield all cells of one block."""
    values = CalcValues.of(space, grasp, block.slots, density_ratio)
    yield Cell(block.row, BLOCK_COLUMN, title, Style.CARD_TITLE)
    for offset, label in enumerate(SUMMARY_HEADER, 1):
        yield Cell(block.row + 1, BLOCK_COLUMN + offset, label, Style.HEADER)
    for offset, label in enumerate(ELEMENT_HEADER):
        yield Cell(block.first - 1, BLOCK_COLUMN + offset, label, Style.HEADER)
    for row in range(block.size):
        yield from _element_cells(block, space, values, row)
    for number in range(len(TABLES)):
        yield from _table_labels(block, number)
    yield from _distance_cells(block, values)
    yield from _structure_cells(block, values)
    yield from _hull_cells(block, values)
    yield from _summary_cells(block, space, values)
    yield from _engine_cells(block, grasp)


def _table_labels(block: CalcBlock, number: int) -> Iterator[Cell]:
    """Yield a square table's title in its corner, and the elements along two of its sides."""
    table = block.table(number)
    yield Cell(table.row - 1, table.column - 1, TABLES[number], Style.HEADER)
    for row in range(block.size):
        name = _element_name(block, row)
        yield Cell(table.row + row, table.column - 1, name, Style.LABEL)
        yield Cell(table.row - 1, table.column + row, name, Style.HEADER)


def _element_name(block: CalcBlock, row: int) -> str:
    number, slot = divmod(row, block.slots)
    return f"{KINDS[number].row_label} {slot + 1}"


def _at(area: Area, value: CellValue, style: Style, formula: str | None) -> Cell:
    return Cell(area.row, area.column, value, style, formula)


def _element_cells(
    block: CalcBlock, space: OptionSpace, values: CalcValues, row: int
) -> Iterator[Cell]:
    number, slot = divmod(row, block.slots)
    labels = KINDS[number]
    yield Cell(block.first + row, BLOCK_COLUMN, _element_name(block, row), Style.LABEL)
    if space.kinds[number].total == 0:
        for title in ELEMENT_HEADER[1:-1]:
            yield _at(block.element(title, row), int(title == "right"), Style.MARK, None)
        yield _at(block.element("least structure", row), "", Style.COORDINATE, None)
        return
    gene, count = block.gene(number, slot + 1), block.gene(number, 0)
    in_range = f"AND({gene}>=1,{gene}<={listed(space, number)},{gene}=INT({gene}))"
    placed = f"IF(COUNT(INDEX({labels.locations_name},{gene},0))=3,1,0)"
    formulas = {
        "in space": f"IF(ISNUMBER({gene}),IF({in_range},{placed},0),0)",
        "active": f"IF(ISNUMBER({count}),IF({slot + 1}<={count},{INPUTS_USABLE},0),0)",
        "right": _right(block, row),
        **{
            axis: f"IF({block.element('in space', row).local}=1,"
            f"INDEX({labels.locations_name},{gene},{position}),0)"
            for position, axis in enumerate(("x", "y", "z"), 1)
        },
        "force (N)": f"IF({block.element('active', row).local}=1,{labels.field('Force')},0)",
        "to polygon": _polygon_distance(block, row),
        "distinct": _distinct(block, row),
        "least structure": _row_least(block, row),
    }
    for title, formula in formulas.items():
        style = (
            Style.MARK if title in ("in space", "active", "right", "distinct") else Style.COORDINATE
        )
        yield _at(block.element(title, row), values.element(title, row), style, formula)


def _right(block: CalcBlock, row: int) -> str:
    """1 where an active index has a place, and no active one before it of its kind is the same."""
    number, slot = divmod(row, block.slots)
    active, in_space = (block.element(name, row).local for name in ("active", "in space"))
    if slot == 0:
        return f"IF({active}=1,{in_space},1)"
    before = replace(block.genes.cell(number, 1), columns=slot).reference
    twice = f"COUNTIF({before},{block.gene(number, slot + 1)})>0"
    return f"IF({active}=1,IF({in_space}=0,0,IF({twice},0,1)),1)"


def _polygon_distance(block: CalcBlock, row: int) -> str:
    """Distance to the nearest edge: ``t``, held between 0 and 1, is how far along it."""
    x, y = (block.element(axis, row).local for axis in ("x", "y"))
    raw = f"((({x}-EdgeStartX)*EdgeX+({y}-EdgeStartY)*EdgeY)/EdgeSquared)"
    t = f"({raw}*({raw}>0)*({raw}<1)+({raw}>=1))"
    apart = f"({x}-EdgeStartX-{t}*EdgeX)^2+({y}-EdgeStartY-{t}*EdgeY)^2"
    active = block.element("active", row).local
    return f"IF({active}=1,SQRT(SUMPRODUCT(MIN({apart}))),0)"


def _distinct(block: CalcBlock, row: int) -> str:
    """1 for an active element at whose place no active one stands before it."""
    active = block.element("active", row).local
    if row == 0:
        return active
    before = {
        name: Area(CALC, block.first, block.column(name).column, row).absolute
        for name in ("active", "x", "y")
    }
    at_its_place = "*".join(
        f"(ABS({before[axis]}-{block.element(axis, row).local})<{SAME_PLACE})"
        for axis in ("x", "y")
    )
    twins = f"SUMPRODUCT({before['active']}*{at_its_place})"
    return f"IF({active}=1,IF({twins}=0,1,0),0)"


def _row_least(block: CalcBlock, row: int) -> str:
    table = block.table(1)
    cells = Area(CALC, table.row + row, table.column, 1, table.columns).absolute
    return f'IF(COUNT({cells})=0,"",MIN({cells}))'


@dataclass(frozen=True, slots=True)
class _Pair:
    """References of two elements, i and j, for formulas over the pair and all elements."""

    xi: str
    yi: str
    xj: str
    yj: str
    all_x: str
    all_y: str

    @property
    def dx(self) -> str:
        return f"({self.xj}-{self.xi})"

    @property
    def dy(self) -> str:
        return f"({self.yj}-{self.yi})"

    @property
    def cross(self) -> str:
        """Cross product of the line from i to j with that to each element."""
        return f"({self.dx}*({self.all_y}-{self.yi})-{self.dy}*({self.all_x}-{self.xi}))"

    @property
    def along(self) -> str:
        """Dot product of the same."""
        return f"({self.dx}*({self.all_x}-{self.xi})+{self.dy}*({self.all_y}-{self.yi}))"


def _pairs(block: CalcBlock) -> dict[tuple[int, int], _Pair]:
    """Return all pairs of different elements, in both directions, row by row."""
    columns = [block.column(axis) for axis in ("x", "y")]
    places = [tuple(column.cell(row, 0).local for column in columns) for row in range(block.size)]
    everything = [column.absolute for column in columns]
    return {
        (i, j): _Pair(*places[i], *places[j], *everything)
        for i, j in permutations(range(block.size), 2)
    }


def _distance_cells(block: CalcBlock, values: CalcValues) -> Iterator[Cell]:
    table, active = block.table(0), block.column("active")
    for (i, j), pair in _pairs(block).items():
        if i < j:
            both = f"{active.cell(i, 0).local}*{active.cell(j, 0).local}"
            formula = f'IF({both}=1,SQRT({pair.dx}^2+{pair.dy}^2),"")'
            yield _at(table.cell(i, j), values.distance[i][j], Style.COORDINATE, formula)


def _structure_cells(block: CalcBlock, values: CalcValues) -> Iterator[Cell]:
    table, distances = block.table(1), block.table(0)
    active, longest = block.column("active").absolute, block.summary("longest").absolute
    for (i, j), pair in _pairs(block).items():
        if i < j:
            length = distances.cell(i, j).local
            branches = f"SUMPRODUCT({active}*ABS({pair.cross}))/{length}"
            formula = (
                f'IF({length}="","",IF({length}<{longest}*(1-{SLACK}),"",'
                f"IF({length}=0,0,{used('DensityRatio')}*{length}+{branches})))"
            )
            yield _at(table.cell(i, j), values.structure[i][j], Style.COORDINATE, formula)


def _hull_cells(block: CalcBlock, values: CalcValues) -> Iterator[Cell]:
    """Twice the area between the centroid and each edge of the hull, counter-clockwise.

    A pair is an edge when no element lies right of it, nor on its line beyond its ends.
    """
    table, distinct = block.table(2), block.column("distinct")
    slack = f"{SLACK}*{block.summary('longest').absolute}^2"
    for (i, j), pair in _pairs(block).items():
        length = f"{pair.dx}^2+{pair.dy}^2"
        beyond = f"(({pair.along}<-{slack})+({pair.along}>{length}+{slack}))"
        outside = (
            f"SUMPRODUCT({distinct.absolute}*(({pair.cross}<-{slack})"
            f"+(ABS({pair.cross})<={slack})*{beyond}))"
        )
        both = f"{distinct.cell(i, 0).local}*{distinct.cell(j, 0).local}"
        area = (
            f"({pair.xi}-CentroidX)*({pair.yj}-CentroidY)"
            f"-({pair.xj}-CentroidX)*({pair.yi}-CentroidY)"
        )
        formula = f'IF({both}=1,IF({outside}=0,{area},""),"")'
        yield _at(table.cell(i, j), values.hull[i][j], Style.COORDINATE, formula)


def _summary_cells(block: CalcBlock, space: OptionSpace, values: CalcValues) -> Iterator[Cell]:
    active, right = block.column("active").absolute, block.column("right").absolute
    distances, structures, hull = (block.table(number).absolute for number in range(3))
    least = block.column("least structure").absolute
    longest = block.summary("longest").local
    truss = block.summary("main truss from").local
    row_of_truss = f"INDEX({structures},{truss},0)"
    nearly_least = f"MIN({least})+{SLACK}*{longest}"
    twice_area = f"SUM({hull})"
    formulas = {
        "usable": f'IF({block.summary("fault").local}="",1,0)',
        "fault": _fault(block, space),
        "first wrong": f"IF(MIN({right})=1,0,MATCH(0,{right},0))",
        "elements": f"SUM({active})",
        "longest": f"IF(COUNT({distances})=0,0,MAX({distances}))",
        "shortest": f'IF(COUNT({distances})=0,"",MIN({distances}))',
        # Of trusses that are equal but for rounding (the diagonals of a rectangle), the first.
        "main truss from": f"IF(COUNT({least})=0,0,{_first_below('ROW', least, nearly_least)})",
        "main truss to": f"IF({truss}=0,0,{_first_below('COLUMN', row_of_truss, nearly_least)})",
        "hull area": f"IF({twice_area}/2<={SLACK}*{longest}^2,0,{twice_area}/2)",
        "centroid inside": f"IF({block.summary('hull area').local}=0,0,"
        f"IF(MIN({hull})>=-{SLACK}*{longest}^2,1,0))",
    }
    for title, formula in formulas.items():
        style = Style.COORDINATE if title in MEASURED else Style.MARK
        yield _at(block.summary(title), values.summary(title), style, formula)


def _first_below(axis: str, cells: str, bound: str) -> str:
    """Place, from 1, of the first number of a row or column of cells that is not above a bound."""
    place = f"{axis}({cells})-MIN({axis}({cells}))+1"
    return f"SUMPRODUCT(MIN({place}+{FAR}*(1-ISNUMBER({cells})*({cells}<={bound}))))"


def _fault(block: CalcBlock, space: OptionSpace) -> str:
    """Return the sentence that says what keeps a card from computing; nothing where it computes."""
    total = "+".join(block.gene(number, 0) for number in range(len(KINDS)))
    formula = f'IF({total}=0,"{NO_ELEMENT}",{_index_fault(block, space)})'
    for number in reversed(range(len(KINDS))):
        formula = _count_fault(block, space, number, otherwise=formula)
    formula = f'IF(COUNTA({block.genes.reference})=0,"{NO_GENES}",{formula})'
    return f"IF({INPUTS_USABLE}=0,{INPUTS_FAULT},{formula})"


def _count_fault(block: CalcBlock, space: OptionSpace, number: int, otherwise: str) -> str:
    labels, count = KINDS[number], block.gene(number, 0)
    least, most = labels.field("Min"), f"MIN({labels.field('Max')},{listed(space, number)})"
    name = f"{labels.row_label} Total #"
    told = f'"{name}: type a whole number from "&{least}&" to "&MIN({most},{block.slots})&"."'
    few = f'"{name}: the card has {block.slots} columns; for more run grasp-xl on this workbook."'
    whole = f"{count}=INT({count})"
    fits = f"AND({count}>={least},{count}<=MIN({most},{block.slots}),{whole})"
    beyond = f"AND({count}>{block.slots},{count}<={most},{whole})"
    return f"IF(ISNUMBER({count}),IF({fits},{otherwise},IF({beyond},{few},{told})),{told})"


def _index_fault(block: CalcBlock, space: OptionSpace) -> str:
    wrong = block.summary("first wrong").local
    name, in_space = (
        f"INDEX({block.column(title).absolute},{wrong})" for title in ("element", "in space")
    )
    most = f"IF({wrong}<={block.slots},{','.join(listed(space, n) for n in range(len(KINDS)))})"
    told = f'": type a whole number from 1 to "&{most}&"."'
    called = f'SUBSTITUTE({name}," "," Index ")'
    return f'IF({wrong}=0,"",{called}&IF({in_space}=1,"{TWICE}",{told}))'


def _engine_cells(block: CalcBlock, grasp: Grasp) -> Iterator[Cell]:
    yield Cell(block.row, block.engine.column, "engine: FoS, cost, ...", Style.NOTE)
    for offset, value in enumerate((grasp.fos, *grasp.terms)):
        yield _at(block.engine.cell(0, offset), value, Style.COORDINATE, None)
    yield Cell(block.row, block.engine_genes.column, "engine: genes", Style.NOTE)
    for number, row in enumerate(grasp.chromosome.genes.tolist()):
        for slot, gene in enumerate(row):
            shown = None if slot and gene == BLANK_GENE else gene
            yield _at(block.engine_genes.cell(number, slot), shown, Style.MARK, None)
