"""A gripper element that can be bought, and how a row of a CSV file becomes one."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Literal, get_args

from grasp_xl.fitment.csv_table import CsvTable, Row
from grasp_xl.printable import quoted

Kind = Literal["suction", "magnets"]
Shape = Literal["round", "rectangular", "oval"]

REQUIRED = ("model", "kind", "force_n")
"""Columns that every catalogue has; a size is needed, too."""

SIZES = {"diameter_mm", "length_mm", "width_mm"}

KINDS: dict[str, Kind] = {
    "suction_cup": "suction",
    "suction": "suction",
    "cup": "suction",
    "magnet": "magnets",
    "magnets": "magnets",
}
"""What the column ``kind`` may say, and the names that option spaces have for it."""

LEAST_ABOVE_0, MOST = 1e-9, 1e9
"""Bounds of a number, as in a workbook; a test holds them equal."""

MAX_TEXT = 1_000
"""Characters of a text; the longest that is shipped has about 400."""

_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?", re.ASCII | re.IGNORECASE)
_THOUSANDS = re.compile(r"[+-]?[1-9]\d{0,2}(\.\d{3})+", re.ASCII)
_NO_THOUSANDS = "write no dot for thousands and a decimal comma, as this can be two numbers"
_NO_COMMA = "write a decimal point, or separate the cells of the file by ;"
_NUMBER_ALONE = "write it in digits, without a unit"


@dataclass(frozen=True, slots=True)
class Element:
    """A suction cup or magnet of a catalogue; None where a value is not known.

    Parameters
    ----------
    model : str
    kind : {"suction", "magnets"}
        As the kinds of an option space are named.
    force_n : float
        Normal force (N) under ``force_condition``.
    brand, part_no : str or None
    shape : {"round", "rectangular", "oval"} or None
    diameter_mm, length_mm, width_mm : float or None
        The diameter is known, or length and width are.
    diameter_basis : str or None
        What the size is the size of: the actuated outer diameter, a nominal one, ...
    force_condition : str or None
        For which the force holds: vacuum, sheet thickness, ...
    weight_g, price : float or None
    currency, material, source_url : str or None
    trust : str or None
        How the numbers are known: a letter, see docs/elements.md.
    note : str or None
    """

    model: str
    kind: Kind
    force_n: float
    brand: str | None = None
    part_no: str | None = None
    shape: Shape | None = None
    diameter_mm: float | None = None
    diameter_basis: str | None = None
    length_mm: float | None = None
    width_mm: float | None = None
    force_condition: str | None = None
    weight_g: float | None = None
    price: float | None = None
    currency: str | None = None
    material: str | None = None
    source_url: str | None = None
    trust: str | None = None
    note: str | None = None

    @property
    def sides_mm(self) -> tuple[float, float] | None:
        """Length and width of one that is not round; None for one that is."""
        if self.shape == "round" or (self.shape is None and self.diameter_mm is not None):
            return None
        return (self.length_mm, self.width_mm) if self.length_mm and self.width_mm else None


COLUMNS = tuple(Element.__dataclass_fields__)
"""A column for each field."""


def element_of(row: Row, table: CsvTable) -> Element | None:
    """Return the element of a row, or None where the table has got a problem of it."""
    before = len(table.problems)
    reader = _RowReader(row, table)
    model, kind, shape = reader.text("model"), reader.kind(), reader.shape()
    force_n = reader.number("force_n")
    diameter_mm, length_mm, width_mm = map(reader.number, ("diameter_mm", "length_mm", "width_mm"))
    reader.require_size(shape)
    element = Element(
        model=model or "",
        kind=kind or "suction",
        force_n=force_n or 0.0,
        brand=reader.text("brand"),
        part_no=reader.text("part_no"),
        shape=shape,
        diameter_mm=diameter_mm,
        diameter_basis=reader.text("diameter_basis"),
        length_mm=length_mm,
        width_mm=width_mm,
        force_condition=reader.text("force_condition"),
        weight_g=reader.number("weight_g"),
        price=reader.number("price", above_0=False),
        currency=reader.text("currency"),
        material=reader.text("material"),
        source_url=reader.text("source_url"),
        trust=reader.text("trust"),
        note=reader.text("note"),
    )
    whole = len(table.problems) == before and model and kind and force_n
    return element if whole else None


@dataclass(frozen=True, slots=True)
class _RowReader:
    row: Row
    table: CsvTable

    def _complain(self, column: str, found: str, expected: str, hint: str) -> None:
        self.table.complain(self.row.line, column, found, expected, hint)

    def _cell(self, column: str, expected: str) -> str | None:
        """Return what stands in a cell; of a required one that is blank, note it."""
        cell = self.row.cells.get(column)
        if cell is None and column in REQUIRED and column in self.table.columns:
            self._complain(column, "an empty cell", expected, "fill it, or take the row away")
        return cell

    def text(self, column: str) -> str | None:
        expected = f"a text of at most {MAX_TEXT:,} characters"
        cell = self._cell(column, expected)
        if cell is None or len(cell) <= MAX_TEXT:
            return cell
        self._complain(column, f"{len(cell):,} characters", expected, "shorten it")
        return None

    def kind(self) -> Kind | None:
        expected = "suction_cup or magnet"
        cell = self._cell("kind", expected)
        if cell is None:
            return None
        kind = KINDS.get(re.sub(r"[\s-]+", "_", cell.casefold()))
        if kind is None:
            self._complain("kind", quoted(cell), expected, "write one of them")
        return kind

    def shape(self) -> Shape | None:
        cell = self.row.cells.get("shape")
        for shape in get_args(Shape):
            if cell and cell.casefold() == shape:
                return shape  # type: ignore[no-any-return]
        if cell:
            expected = f"one of {', '.join(get_args(Shape))}"
            self._complain("shape", quoted(cell), expected, "write one of them, or leave it empty")
        return None

    def number(self, column: str, *, above_0: bool = True) -> float | None:
        expected = f"a number {'above 0' if above_0 else 'of 0 or more'}, at most {MOST:,.0f}"
        cell = self._cell(column, expected)
        if cell is None:
            return None
        least = LEAST_ABOVE_0 if above_0 else 0.0
        number = number_of(cell, decimal_comma=self.table.separator == ";")
        if isinstance(number, str):
            self._complain(column, quoted(cell), expected, number)
        elif least <= number <= MOST:
            return number
        else:
            hint = "correct the number" if column in REQUIRED else "correct it, or leave it empty"
            self._complain(column, quoted(cell), expected, hint)
        return None

    def require_size(self, shape: Shape | None) -> None:
        """Note a size that is missing; one that is wrong has been noted."""
        cells = self.row.cells
        if not SIZES & self.table.columns:  # told of the file, and not of each row
            return
        by_diameter, by_sides = "diameter_mm" in cells, {"length_mm", "width_mm"} <= {*cells}
        sides = next((side for side in ("length_mm", "width_mm") if side not in cells), "")
        found, hint = "an empty cell", "type the size from the data sheet"
        if shape == "round" and not by_diameter:
            self._complain("diameter_mm", found, "the diameter of a round element", hint)
        elif shape in ("rectangular", "oval") and not by_sides:
            self._complain(sides, found, f"length and width of a shape that is {shape}", hint)
        elif not (by_diameter or by_sides):
            self._complain("diameter_mm", found, "a diameter, or length_mm and width_mm", hint)


def number_of(text: str, *, decimal_comma: bool) -> float | str:
    """Read a number, or say what to do about a text that is none.

    Examples
    --------
    >>> number_of("69.5", decimal_comma=False), number_of("69,5", decimal_comma=True)
    (69.5, 69.5)
    >>> number_of("69 N", decimal_comma=False)
    'write it in digits, without a unit'
    >>> number_of("69,5", decimal_comma=False)
    'write a decimal point, or separate the cells of the file by ;'
    >>> number_of("1.070", decimal_comma=True)
    'write no dot for thousands and a decimal comma, as this can be two numbers'
    """
    if decimal_comma and _THOUSANDS.fullmatch(text):
        return _NO_THOUSANDS
    plain = text.replace(",", ".") if decimal_comma else text
    if _NUMBER.fullmatch(plain):
        return float(plain)
    if not decimal_comma and _NUMBER.fullmatch(text.replace(",", ".")):
        return _NO_COMMA
    return _NUMBER_ALONE
