"""What a study runs: parts with their parameters, scenarios, and runs with a seed each."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from grasp_xl.task import Task

Scenario = Literal["random", "user"]
"""Which chromosome a run starts from."""

SCENARIOS: tuple[Scenario, ...] = ("random", "user")
"""S1 and S2 of the thesis (section 6.1)."""

SEED_BITS = 53
"""Seeds are whole numbers that a cell of a workbook holds exactly."""


@dataclass(frozen=True, eq=False, slots=True)
class Case:
    """One part with one set of parameters.

    Parameters
    ----------
    part : int
        Number of the part, from 1.
    variant : int
        Number of the set of parameters, from 1; 0 where there is one only.
    name : str
        Of the part.
    varied : tuple of (str, str)
        Parameters that the study varies, and their values here.
    task : Task
    """

    part: int
    variant: int
    name: str
    varied: tuple[tuple[str, str], ...]
    task: Task

    @property
    def label(self) -> str:
        """``P1``, or ``P1V2`` where parameters are varied."""
        return f"P{self.part}V{self.variant}" if self.variant else f"P{self.part}"

    @property
    def title(self) -> str:
        """Label, part and varied parameters in one line."""
        varied = ", ".join(f"{name} {value}" for name, value in self.varied)
        return f"{self.label} {self.name}" + (f" ({varied})" if varied else "")


@dataclass(frozen=True, slots=True)
class Trial:
    """One run of a case.

    Parameters
    ----------
    case : int
        Its row in the plan.
    scenario : {"random", "user"}
    number : int
        From 1.
    label : str
        ``P1S2R3`` as in the thesis: part 1, scenario 2, run 3.
    seed : int
    """

    case: int
    scenario: Scenario
    number: int
    label: str
    seed: int


@dataclass(frozen=True, eq=False, slots=True)
class Plan:
    """A whole study.

    Parameters
    ----------
    cases : tuple of Case
    scenarios : tuple of {"random", "user"}
    runs : int
        Of each case and scenario, >= 1.
    seed : int
        From which every run's own is derived.
    """

    cases: tuple[Case, ...]
    scenarios: tuple[Scenario, ...]
    runs: int
    seed: int

    def __len__(self) -> int:
        return len(self.cases) * len(self.scenarios) * self.runs

    def trials(self) -> Iterator[Trial]:
        """Give all runs, in the order of their labels."""
        for row, case in enumerate(self.cases):
            for scenario in self.scenarios:
                place = 1 + SCENARIOS.index(scenario)
                for number in range(1, 1 + self.runs):
                    seed = spawned_seed(self.seed, (case.part, case.variant, place, number))
                    yield Trial(row, scenario, number, f"{case.label}S{place}R{number}", seed)


def spawned_seed(root: int, key: Sequence[int]) -> int:
    """Return the seed of one run: it depends on its own place in the study and on nothing else.

    Examples
    --------
    >>> spawned_seed(1, (1, 0, 1, 1)) == spawned_seed(1, (1, 0, 1, 1))
    True
    >>> spawned_seed(1, (1, 0, 1, 1)) == spawned_seed(1, (1, 0, 1, 2))
    False
    """
    sequence = np.random.SeedSequence(root, spawn_key=tuple(key))
    return int(sequence.generate_state(1, np.uint64)[0]) >> (64 - SEED_BITS)
