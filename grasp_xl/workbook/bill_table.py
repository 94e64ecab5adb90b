"""The bill of material of a live grasp, below its picture on the sheet ``Grasp``."""

from __future__ import annotations

from grasp_xl.bill import Line, bill_of, whole_weight_g
from grasp_xl.grasp import Grasp
from grasp_xl.space import OptionSpace
from grasp_xl.workbook import layout
from grasp_xl.workbook.layout import KINDS, Area
from grasp_xl.workbook.pen import Pen
from grasp_xl.workbook.styles import Style
from grasp_xl.workbook.table import DASH

TITLE = "BILL OF MATERIAL, live with the What-if card"
NOT_KNOWN = "not known"
HEADER = (
    ("Element", 2),
    ("Count", 1),
    ("Unit price ($)", 2),
    ("Price ($)", 1),
    ("Weight (g)", 2),
    ("Model", 4),
)
"""Headings, and how many columns each is wide."""

ROWS = 3 + len(KINDS)
"""Title, header, a row a kind, sums."""


def write_bill(pen: Pen, row: int, space: OptionSpace, grasp: Grasp, fault: str) -> None:
    """Write the bill.

    Parameters
    ----------
    pen : Pen
    row : int
        Of its title.
    space : OptionSpace
    grasp : Grasp
        That the What-if card shows.
    fault : str
        Cell that says why its genes make no grasp; empty where they do.
    """
    lines = bill_of(space, grasp)
    pen.write(row, 0, TITLE, Style.TITLE)
    spots = _spots(pen.name, row + 1)
    for (heading, _), spot in zip(HEADER, spots, strict=True):
        pen.span(spot, heading, Style.HEADER)
    for number, line in enumerate(lines):
        _write_line(pen, row + 2 + number, number, line, fault)
    _write_sums(pen, row + 2 + len(lines), lines)


def _write_sums(pen: Pen, row: int, lines: list[Line]) -> None:
    element, count, unit, price, weight, model = _spots(pen.name, row)
    whole = whole_weight_g(lines)
    pen.span(element, "Sum", Style.LABEL)
    for spot in (unit, model):
        pen.span(spot, "", Style.TEXT)
    for spot, value, style, missing in (
        (count, sum(line.count for line in lines), Style.COUNT, f'"{DASH}"'),
        (price, sum(line.price for line in lines), Style.MONEY, f'"{DASH}"'),
        (weight, NOT_KNOWN if whole is None else whole, Style.TORQUE, ""),
    ):
        above = Area(pen.name, row - len(lines), spot.column, len(lines)).absolute
        no_grasp = f'COUNTIF({above},"{DASH}")>0'
        told = missing or f'IF({no_grasp},"{DASH}","{NOT_KNOWN}")'
        pen.span(spot, value, style, f"IF(COUNT({above})={len(lines)},SUM({above}),{told})")


def _write_line(pen: Pen, row: int, number: int, line: Line, fault: str) -> None:
    labels = KINDS[number]
    element, count, unit, price, weight, model = _spots(pen.name, row)
    price_name, weight_name = labels.field("Price"), labels.field("Weight")
    here = count.local
    pen.span(element, line.element, Style.LABEL)
    counted = f'IF({fault}="",INDEX({layout.WHAT_IF.name},{number + 1},1),"{DASH}")'
    pen.span(count, line.count, Style.COUNT, counted)
    pen.span(unit, line.unit_price, Style.MONEY, price_name)
    pen.span(price, line.price, Style.MONEY, f'IF(ISNUMBER({here}),{here}*{price_name},"{DASH}")')
    known = f'IF({here}=0,0,IF({weight_name}="","{NOT_KNOWN}",{here}*{weight_name}))'
    weighed = f'IF(ISNUMBER({here}),{known},"{DASH}")'
    shown = NOT_KNOWN if line.weight_g is None else line.weight_g
    pen.span(weight, shown, Style.TORQUE, weighed)
    pen.span(model, line.model, Style.TEXT, f'IF({labels.model.name}="","",{labels.model.name})')


def _spots(sheet: str, row: int) -> list[Area]:
    """Return the cells of a row, side by side."""
    spots, column = [], 0
    for _, columns in HEADER:
        spots.append(Area(sheet, row, column, 1, columns))
        column += columns
    return spots
