"""Bill of material of a grasp: what has to be bought."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from grasp_xl.grasp import Grasp
from grasp_xl.space import OptionSpace

ELEMENT_WORDS = ("Suction cup", "Magnet")
"""What an element of each kind is called."""


@dataclass(frozen=True, slots=True)
class Line:
    """A line of the bill; the weight of all its elements (g) is None where it is not known."""

    element: str
    model: str
    count: int
    unit_price: float
    weight_g: float | None

    @property
    def price(self) -> float:
        """Of all its elements ($)."""
        return self.count * self.unit_price


def bill_of(space: OptionSpace, grasp: Grasp) -> list[Line]:
    """Return a line for each kind, also of a kind that the grasp has no elements of."""
    counts = grasp.chromosome.counts.tolist()
    return [
        Line(word, kind.model, count, kind.price, _weight_g(kind.weight_g, count))
        for word, kind, count in zip(ELEMENT_WORDS, space.kinds, counts, strict=True)
    ]


def whole_weight_g(lines: Sequence[Line]) -> float | None:
    """Return the weight of all elements (g), None where one is not known."""
    weights = [line.weight_g for line in lines if line.weight_g is not None]
    return sum(weights) if len(weights) == len(lines) else None


def _weight_g(one_g: float | None, count: int) -> float | None:
    if not count:
        return 0.0
    return None if one_g is None else count * one_g
