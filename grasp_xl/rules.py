"""The rules by which a grasp is judged: constraints, goals, and the criterion to minimise."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Literal, NamedTuple

from grasp_xl.adding import plain_sum
from grasp_xl.errors import UsageError

MomentArm = Literal["3d", "plan"]
"""Arm of the residual moment: the thesis's 3-D offset, or its plan-view part."""

SLACK = 1e-9
"""Relative slack of every comparison with FoS, clearance and goals."""

DEFAULT_CLEARANCE_MM = 46.0
"""Clearance where no element diameter is known: the thesis's largest element (section 6.3)."""


class Terms(NamedTuple):
    """One value for each fitness criterion, in the order of the thesis's fitness vector (eq. 9)."""

    cost: float
    moment: float
    deviation: float
    structure: float


TERMS = Terms._fields
EQUAL_WEIGHTS = Terms(1.0, 1.0, 1.0, 1.0)
UNITS = {"cost": "$", "moment": "N-mm", "deviation": "mm", "structure": "mm"}
DIVERGENCE = "divergence"


@dataclass(frozen=True, slots=True)
class Requirements:
    """Constraints of section 4.2.4 and the two constants that the criteria need.

    Parameters
    ----------
    fos : float
        Least factor of safety against the part's weight.
    clearance_mm : float
        Least plan-view distance between two elements (mm), > 0.
    density_ratio : float
        R of eq. 7: linear density of the main truss over that of a branch.
    moment_arm : {"3d", "plan"}
    """

    fos: float = 3.0
    clearance_mm: float = DEFAULT_CLEARANCE_MM
    density_ratio: float = 2.5
    moment_arm: MomentArm = "3d"


@dataclass(frozen=True, slots=True)
class Criterion:
    """What is minimised: one term in its own unit, or a sum of normalised terms."""

    terms: frozenset[str] = frozenset(TERMS)

    @classmethod
    def parse(cls, text: str) -> Criterion:
        """Read ``divergence``, one term, or terms joined by ``+``.

        Raises
        ------
        UsageError
            If a word is no criterion.

        Examples
        --------
        >>> Criterion.parse("moment + cost").name
        'cost+moment'
        """
        words = [word.strip().lower() for word in text.split("+")]
        if words == [DIVERGENCE]:
            return cls()
        unknown = [word for word in words if word not in TERMS]
        if unknown:
            raise UsageError(
                f"The criterion {text!r} is not known: {unknown[0]!r} is no criterion.",
                where="criterion",
                hint=f"Use {DIVERGENCE}, one of {', '.join(TERMS)}, or some joined by +",
            )
        return cls(frozenset(words))

    @property
    def single(self) -> str | None:
        """The term that is minimised alone, in its own unit; None for a sum."""
        return next(iter(self.terms)) if len(self.terms) == 1 else None

    @property
    def name(self) -> str:
        """Canonical text: ``divergence``, ``cost``, ``cost+moment``."""
        if len(self.terms) == len(TERMS):
            return DIVERGENCE
        return "+".join(term for term in TERMS if term in self.terms)


@dataclass(frozen=True, slots=True)
class Goals:
    """Baseline values of the normalised terms (eq. 8).

    Parameters
    ----------
    base : Terms
        Goal of each term, > 0 except for dropped ones.
    dropped : frozenset of str
        Terms left out of every sum, because their defaulted goal is (nearly) zero.
    """

    base: Terms
    dropped: frozenset[str] = frozenset()

    def normalised(self, values: Terms) -> tuple[float | None, ...]:
        """Each value over its goal (eq. 9), None for a dropped term."""
        return tuple(
            None if term in self.dropped else value / goal
            for term, value, goal in zip(TERMS, values, self.base, strict=True)
        )

    def divergence(self, values: Terms) -> float:
        """Overall divergence from the benchmark grasp (eq. 8)."""
        return math.fsum(ratio for ratio in self.normalised(values) if ratio is not None)

    def met_by(self, values: Terms) -> bool:
        """Tell whether no normalised value exceeds 1 (section 4.2.3.5)."""
        return all(ratio is None or ratio <= 1 + SLACK for ratio in self.normalised(values))


@dataclass(frozen=True, slots=True)
class Rules:
    """Everything by which a grasp is judged.

    Parameters
    ----------
    goals : Goals
    requirements : Requirements
    criterion : Criterion
    weights : Terms
        Factor of each term in the minimised sum, >= 0; 0 leaves a term out.
    """

    goals: Goals
    requirements: Requirements = field(default_factory=Requirements)
    criterion: Criterion = field(default_factory=Criterion)
    weights: Terms = EQUAL_WEIGHTS

    @property
    def scales(self) -> Terms:
        """Divisor of each term in the minimised sum; infinity leaves a term out."""
        single, included = self.criterion.single, self.criterion.terms
        if not single:
            included -= self.goals.dropped
        return Terms(
            *(
                (1.0 if single else goal) / weight if weight and term in included else math.inf
                for term, goal, weight in zip(TERMS, self.goals.base, self.weights, strict=True)
            )
        )

    def value(self, values: Terms) -> float:
        """Return the number that the search minimises."""
        return plain_sum(value / scale for value, scale in zip(values, self.scales, strict=True))

    @property
    def baseline(self) -> float:
        """Value that a grasp exactly at every goal would have: 4 for the divergence."""
        return self.value(self.goals.base)


def moment_arm(text: str) -> MomentArm:
    """Read a moment arm.

    Raises
    ------
    UsageError
        If it is neither ``3d`` nor ``plan``.
    """
    arms: dict[str, MomentArm] = {"3d": "3d", "plan": "plan"}
    word = text.strip().lower()
    if word in arms:
        return arms[word]
    raise UsageError(
        f"The moment arm {text!r} is not known.", where="moment arm", hint="Use 3d or plan"
    )
