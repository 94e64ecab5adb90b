"""Edges of the ideal polygon on the sheet ``Calc``, and both polygons for the pictures."""

from __future__ import annotations

import numpy as np

from grasp_xl.space import OptionSpace
from grasp_xl.workbook import layout
from grasp_xl.workbook.calc_inputs import FIRST_ROW
from grasp_xl.workbook.calc_rules import MAX_CHECKED_CORNERS
from grasp_xl.workbook.layout import CALC, Area
from grasp_xl.workbook.pen import Pen
from grasp_xl.workbook.styles import Style

EDGE_COLUMN = 0
EDGE_NAMES = ("EdgeStartX", "EdgeStartY", "EdgeX", "EdgeY", "EdgeSquared")
EDGE_HEADER = ("i", "start x", "start y", "edge x", "edge y", "squared length")
PART_POLYGON_COLUMN = 6
CROSSINGS_COLUMN = 8
CROSSINGS_NAME = "EdgeCrossings"


def write_edges(pen: Pen, space: OptionSpace) -> None:
    """Write the ideal polygon's edges, and both polygons closed for the pictures."""
    ideal, part = space.ideal_polygon_mm[:, :2], space.approximation_polygon_mm[:, :2]
    corners = len(ideal)
    pen.write(1, EDGE_COLUMN, "Edges of the ideal polygon", Style.HEADING)
    pen.row(2, EDGE_COLUMN, (*EDGE_HEADER, "part x", "part y"), Style.HEADER)
    edges = np.roll(ideal, -1, axis=0) - ideal
    for number in range(corners + 1):
        row, corner = FIRST_ROW + number, number % corners
        pen.write(row, EDGE_COLUMN, corner + 1, Style.MARK)
        for axis in range(2):
            for left, name, points in (
                (EDGE_COLUMN + 1, layout.IDEAL_POLYGON, ideal),
                (PART_POLYGON_COLUMN, layout.APPROXIMATION_POLYGON, part),
            ):
                formula = f"N(INDEX({name},{corner + 1},{axis + 1}))"
                value = float(points[corner, axis])
                pen.write(row, left + axis, value, Style.COORDINATE, formula)
        if number == corners:
            break
        for axis in range(2):
            here = Area(CALC, row, EDGE_COLUMN + 1 + axis)
            formula = f"{here.cell(1, 0).local}-{here.local}"
            value = float(edges[corner, axis])
            pen.write(row, EDGE_COLUMN + 3 + axis, value, Style.COORDINATE, formula)
        x, y = (Area(CALC, row, EDGE_COLUMN + 3 + axis).local for axis in range(2))
        squared = float(edges[corner] @ edges[corner])
        pen.write(row, EDGE_COLUMN + 5, squared, Style.COORDINATE, f"{x}^2+{y}^2")
    for offset, name in enumerate(EDGE_NAMES):
        pen.name_area(name, Area(CALC, FIRST_ROW, EDGE_COLUMN + 1 + offset, corners))
    if corners <= MAX_CHECKED_CORNERS:
        _crossings(pen, corners)


def _crossings(pen: Pen, corners: int) -> None:
    """Write how many edges cross each edge: those whose ends, and its own, lie on either side.

    Edges that share a corner never count: one of the products is exactly 0.
    """
    pen.write(2, CROSSINGS_COLUMN, "crossings", Style.HEADER)
    for row in range(FIRST_ROW, FIRST_ROW + corners):
        x, y, dx, dy = (Area(CALC, row, EDGE_COLUMN + offset).local for offset in range(1, 5))
        ends = (
            f"({dx}*(EdgeStartY-{y})-{dy}*(EdgeStartX-{x}))",
            f"({dx}*(EdgeStartY+EdgeY-{y})-{dy}*(EdgeStartX+EdgeX-{x}))",
            f"(EdgeX*({y}-EdgeStartY)-EdgeY*({x}-EdgeStartX))",
            f"(EdgeX*({y}+{dy}-EdgeStartY)-EdgeY*({x}+{dx}-EdgeStartX))",
        )
        formula = f"SUMPRODUCT(({ends[0]}*{ends[1]}<0)*({ends[2]}*{ends[3]}<0))"
        pen.write(row, CROSSINGS_COLUMN, 0, Style.MARK, formula)
    pen.name_area(CROSSINGS_NAME, Area(CALC, FIRST_ROW, CROSSINGS_COLUMN, corners))


def closed_polygon(column: int, corners: int) -> Area:
    """X cells of a closed polygon; y stands right of it."""
    return Area(CALC, FIRST_ROW, column, corners + 1)
