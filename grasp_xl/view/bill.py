"""Bill of material of a design: what has to be bought."""

from __future__ import annotations

import csv
import io
from dataclasses import dataclass

from grasp_xl.grasp import Grasp
from grasp_xl.space import OptionSpace

HEADER = ("Element", "Model", "Count", "Unit price ($)", "Price ($)", "Weight (g)")


@dataclass(frozen=True, slots=True)
class Line:
    """A line of the bill; the weight of all its elements, None where it is not known."""

    element: str
    model: str
    count: int
    unit_price: float
    weight_g: float | None

    @property
    def price(self) -> float:
        """Of all its elements ($)."""
        return self.count * self.unit_price


def bill_of(space: OptionSpace, grasp: Grasp, words: tuple[str, ...]) -> list[Line]:
    """Return a line for each kind that a grasp has elements of.

    Parameters
    ----------
    space, grasp
    words : tuple of str
        What an element of each kind is called.
    """
    counts = grasp.chromosome.counts.tolist()
    return [
        Line(
            word,
            kind.model,
            count,
            kind.price,
            None if kind.weight_g is None else count * kind.weight_g,
        )
        for word, kind, count in zip(words, space.kinds, counts, strict=True)
        if count
    ]


def bill_csv(lines: list[Line]) -> bytes:
    """Return a bill as a CSV file that Excel opens as UTF-8, with a last line of sums."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\r\n")
    writer.writerow(HEADER)
    for line in lines:
        weight = "" if line.weight_g is None else f"{line.weight_g:.10g}"
        prices = f"{line.unit_price:.10g}", f"{line.price:.10g}"
        writer.writerow([line.element, _no_formula(line.model), line.count, *prices, weight])
    weights = [line.weight_g for line in lines if line.weight_g is not None]
    whole = f"{sum(weights):.10g}" if len(weights) == len(lines) else ""
    price = f"{sum(line.price for line in lines):.10g}"
    writer.writerow(["Sum", "", sum(line.count for line in lines), "", price, whole])
    return text.getvalue().encode("utf-8-sig")


def _no_formula(text: str) -> str:
    """Return a text that no spreadsheet takes for a formula.

    Examples
    --------
    >>> _no_formula("SAF 40"), _no_formula("=cmd")
    ('SAF 40', "'=cmd")
    """
    return f"'{text}" if text[:1] in ("=", "+", "-", "@", "\t", "\r") else text
