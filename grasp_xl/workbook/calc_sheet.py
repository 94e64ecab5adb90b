"""Sheet ``Calc``: the helper cells behind the live cards, laid out so that a person can audit them.

On the left the edges of the ideal polygon, then the inputs as they were written, then one block a
card.  A block has a row an element (its place, force, distance to the polygon) and three square
tables: distances, sizes of the structure with the main truss on that pair (eq. 7), and edges of the
elements' convex hull.  Everything is plain cell arithmetic that Excel 2016 and LibreOffice share.
"""

from __future__ import annotations

from grasp_xl.grasp import Grasp
from grasp_xl.space import OptionSpace
from grasp_xl.workbook.calc_block import BLOCK_COLUMN, TABLES, CalcBlock
from grasp_xl.workbook.calc_edges import write_edges
from grasp_xl.workbook.calc_grasp import block_cells
from grasp_xl.workbook.calc_inputs import COLUMNS, FIRST_ROW, INPUT_COLUMN, write_inputs
from grasp_xl.workbook.layout import CALC, Area, Layout
from grasp_xl.workbook.pen import Pen
from grasp_xl.workbook.styles import Style
from grasp_xl.workbook.written import CellValue


def write_calc(
    pen: Pen,
    space: OptionSpace,
    inputs: dict[str, CellValue],
    blocks: list[tuple[str, CalcBlock, Grasp]],
    plan: Layout,
) -> None:
    """Write the sheet.

    Parameters
    ----------
    pen : Pen
    space : OptionSpace
    inputs : dict
        Values of the inputs as written, by defined name.
    blocks : list of tuple
        Title, block, and what the engine says of its grasp.
    plan : Layout
    """
    pen.write(0, 0, "CALC: helper cells of the live cards", Style.TITLE)
    write_edges(pen, space)
    watched = write_inputs(pen, space, inputs, plan)
    ratio = float(inputs["DensityRatio"] or 0.0)
    for title, block, grasp in blocks:
        pen.put(block_cells(title, block, space, grasp, ratio))
    _widths(pen, blocks[0][1])
    pen.sheet.freeze_panes(FIRST_ROW, 0)
    edges = Area(CALC, 0, 0, FIRST_ROW + len(space.ideal_polygon_mm) + 1, INPUT_COLUMN - 1)
    shown = Area(CALC, 1, INPUT_COLUMN, FIRST_ROW + watched + 5, COLUMNS)
    pen.print_pages(edges, pictures=[shown])


def _widths(pen: Pen, block: CalcBlock) -> None:
    first, behind = block.table(0).column - 1, block.table(len(TABLES)).column - 1
    pen.sheet.set_column(0, BLOCK_COLUMN - 1, 12)
    pen.sheet.set_column(INPUT_COLUMN, INPUT_COLUMN, 19)
    pen.sheet.set_column(INPUT_COLUMN + 3, INPUT_COLUMN + 3, 44)
    pen.sheet.set_column(INPUT_COLUMN + 5, INPUT_COLUMN + 5, 44)
    pen.sheet.set_column(BLOCK_COLUMN, BLOCK_COLUMN, 22)
    pen.sheet.set_column(BLOCK_COLUMN + 1, first - 1, 14)
    pen.sheet.set_column(first, behind, 11)
    for number, title in enumerate(TABLES):
        corner = block.table(number).column - 1
        pen.sheet.set_column(corner, corner, len(title))
