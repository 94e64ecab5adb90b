"""Gripper elements on the terminal: a row each, and the conditions of their forces below."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rich.box import SIMPLE
from rich.table import Table
from rich.text import Text

from grasp_xl.cli.options import KIND_WORDS
from grasp_xl.cli.terminal import OUT, Terminal, line
from grasp_xl.printable import printable

if TYPE_CHECKING:
    from grasp_xl.commands.elements import Listed
    from grasp_xl.fitment.element import Element

WIDE = 1_000
"""Columns of an output that is no terminal: each element has one line."""

UNKNOWN = "-"
HEADINGS = {
    "kind": False,
    "brand": False,
    "model": False,
    "part no.": False,
    "size\n(mm)": True,
    "force\n(N)": True,
    "condi-\ntion": True,
    "weight\n(g)": True,
    "price": True,
    "trust": False,
}
"""Columns, and whether numbers stand in them."""

FOLDABLE = ("model", "part no.")
"""Columns that take two lines where a terminal is narrow."""
KIND_NAMES = {kind: word for word, kind in KIND_WORDS.items()}


def show(listed: Listed) -> None:
    """Print the elements that were asked for."""
    total = len(listed.catalogue.elements)
    if not listed.elements:
        line(f"None of the {total:,} elements of the catalogue fits.")
        return
    conditions = dict.fromkeys(
        element.force_condition for element in listed.elements if element.force_condition
    )
    numbers = {condition: number for number, condition in enumerate(conditions, 1)}
    out = OUT if OUT.is_terminal else Terminal(width=WIDE, highlight=False)
    out.print(_table(listed, numbers), soft_wrap=False)
    if numbers:
        line("Conditions of the forces:")
    for condition, number in numbers.items():
        line(f"{number:>3}: {printable(condition)}")
    line(f"{len(listed.elements):,} of {total:,} elements. Trust is explained in docs/elements.md.")


def _table(listed: Listed, conditions: dict[str, int]) -> Table:
    table = Table(box=SIMPLE, pad_edge=False, padding=0)
    for heading, numeric in HEADINGS.items():
        foldable = heading in FOLDABLE
        table.add_column(
            heading,
            justify="right" if numeric else "left",
            no_wrap=not foldable,
            overflow="fold",
        )
    for element in listed.elements:
        condition = conditions.get(element.force_condition or "")
        texts = (
            KIND_NAMES[element.kind],
            element.brand,
            element.model,
            element.part_no,
            size(element),
            f"{element.force_n:,.6g}",
            condition and str(condition),
            element.weight_g and f"{element.weight_g:,.6g}",
            _price(element),
            element.trust,
        )
        table.add_row(*(Text(printable(text or UNKNOWN)) for text in texts))
    return table


def size(element: Element) -> str:
    """Return the diameter, else length x width."""
    if element.diameter_mm is not None:
        return f"{element.diameter_mm:,.6g}"
    return f"{element.length_mm:,.6g} x {element.width_mm:,.6g}"


def _price(element: Element) -> str | None:
    if element.price is None:
        return None
    return f"{element.price:,.2f} {element.currency or ''}".rstrip()
