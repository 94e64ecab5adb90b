"""The best grasps that an exact search has met, without images of one another."""

from __future__ import annotations

import bisect
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

from grasp_xl.search.symmetry import Symmetry, representative

Active = tuple[tuple[int, ...], ...]
"""Sorted active 1-based indices of each kind."""


class Found(NamedTuple):
    """A grasp met in the search: its value, and its sorted active indices a kind."""

    value: float
    active: Active

    @property
    def rank(self) -> tuple[float, Active]:
        """Order of the pool: values within 1e-9 are equal, and then smaller indices come first."""
        return float(f"{self.value:.9g}"), self.active


@dataclass(slots=True)
class Pool:
    """So many best grasps, best first; of those that are images of one another the first alone.

    Parameters
    ----------
    symmetries : sequence of Symmetry
    size : int
    """

    symmetries: Sequence[Symmetry]
    size: int
    grasps: list[Found] = field(default_factory=list, init=False)
    _of_class: dict[Active, Found] = field(default_factory=dict, init=False)

    @property
    def is_full(self) -> bool:
        """Whether a grasp must be better than the last to enter."""
        return len(self.grasps) >= self.size

    def take(self, found: Found) -> None:
        """Enter a grasp if it is good enough, and drop what it pushes out."""
        if self.is_full and found.rank >= self.grasps[-1].rank:
            return
        name = representative(self.symmetries, found.active)
        twin = self._of_class.get(name)
        if twin:
            if twin.rank <= found.rank:
                return
            self.grasps.remove(twin)
        self._of_class[name] = found
        bisect.insort(self.grasps, found, key=lambda each: each.rank)
        if len(self.grasps) > self.size:
            last = self.grasps.pop()
            del self._of_class[representative(self.symmetries, last.active)]
