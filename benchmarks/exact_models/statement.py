"""The problem as a linear model with one cone, written from the equations of docs/algorithm.md.

For fixed counts, cost and lifting force are constants.  A binary variable says whether an element
(a kind at one of its footprints) is used, another one which pair of elements is the main truss.
A share in [0, 1] of each further element and pair says whether it hangs on that truss, so that its
branch is a constant.  The moment is at least the length of a sum of one vector an element: a cone,
which a solver takes as it is or through tangents.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np
from shapely import LinearRing, Point

from grasp_xl.rules import Requirements, Rules
from grasp_xl.space import FloatArray, IntArray, OptionSpace

SLACK = 1e-9
"""Relative slack of the comparisons with FoS, clearance and the longest pair (section 4.2.4)."""


@dataclass(frozen=True, slots=True)
class Row:
    """``low <= sum of coefficients x variables <= high``; all numbers are integers."""

    variables: list[int]
    coefficients: list[int]
    low: int | None
    high: int | None


@dataclass(eq=False, slots=True)
class Statement:
    """Minimise ``constant + prices . variables`` for fixed counts, in units of the baseline.

    Parameters
    ----------
    counts : tuple of int
        Elements of each kind.
    constant : float
        The cost term.
    pulls : FloatArray
        ``(elements, 3)`` array; the moment term is the length of the sum over the used elements.
    prices : list of float
        One for each variable; the elements' variables come first.
    upper : list of int
        Largest value of each variable; the least is 0.
    whole : list of bool
        Whether a variable must be an integer.
    rows : list of Row
    moment : int
        The variable that is at least the moment term; it has no upper limit.
    """

    counts: tuple[int, ...]
    constant: float
    pulls: FloatArray
    prices: list[float] = field(default_factory=list)
    upper: list[int] = field(default_factory=list)
    whole: list[bool] = field(default_factory=list)
    rows: list[Row] = field(default_factory=list)
    moment: int = -1

    def variable(self, price: float, upper: int = 1, *, whole: bool = True) -> int:
        """Add a variable and return its number."""
        self.prices.append(price)
        self.upper.append(upper)
        self.whole.append(whole)
        return len(self.prices) - 1

    def row(
        self,
        variables: list[int],
        coefficients: list[int] | None = None,
        low: int | None = None,
        high: int | None = None,
    ) -> None:
        """Add a row; all coefficients are 1 unless told otherwise."""
        self.rows.append(Row(variables, coefficients or [1] * len(variables), low, high))


class Elements:
    """All elements that a grasp may have, kind after kind.

    Parameters
    ----------
    space, rules
        From here: ``kinds``, their number; ``kind (n,)``; ``footprint (n,)``, 1-based; ``arm
        (n, 3)`` from the centroid (mm, z = 0 with the plan arm); ``deviation (n,)`` (mm); ``plan
        (n, 2)`` (mm); ``distance (n, n)`` in plan view (mm).
    """

    def __init__(self, space: OptionSpace, rules: Rules) -> None:
        totals = [len(kind.footprints_mm) for kind in space.kinds]
        self.kinds = len(totals)
        self.kind: IntArray = np.repeat(np.arange(len(totals)), totals)
        self.footprint: IntArray = np.concatenate([np.arange(1, n + 1) for n in totals])
        points = np.concatenate([kind.footprints_mm for kind in space.kinds])
        self.arm = points - space.part.centroid_mm
        if rules.requirements.moment_arm == "plan":
            self.arm[:, 2] = 0.0
        boundary = LinearRing(space.ideal_polygon_mm[:, :2])
        self.plan = points[:, :2]
        self.deviation = np.array([boundary.distance(Point(place)) for place in self.plan])
        self.distance: FloatArray = np.linalg.norm(self.plan[:, None] - self.plan, axis=2)

    def active(self, used: list[int]) -> list[list[int]]:
        """Return the 1-based footprints of each kind of the used elements."""
        return [
            [int(self.footprint[e]) for e in used if self.kind[e] == kind]
            for kind in range(self.kinds)
        ]


def statements(space: OptionSpace, rules: Rules, elements: Elements) -> Iterator[Statement]:
    """Yield a statement for each pair of counts that meets FoS, the cheapest counts first."""
    need = rules.requirements
    ranges = [
        range(kind.count_min, min(kind.count_max, len(kind.footprints_mm)) + 1)
        for kind in space.kinds
    ]
    forces, prices = (
        [getattr(kind, name) for kind in space.kinds] for name in ("force_n", "price")
    )
    lifting = [
        counts
        for counts in itertools.product(*ranges)
        if any(counts) and np.dot(counts, forces) / space.part.weight_n >= need.fos * (1 - SLACK)
    ]
    for counts in sorted(lifting, key=lambda counts: float(np.dot(counts, prices))):
        yield statement(space, rules, elements, counts)


def statement(
    space: OptionSpace, rules: Rules, elements: Elements, counts: tuple[int, ...]
) -> Statement:
    """State the problem for fixed counts."""
    scales, weight = [scale * rules.baseline for scale in rules.scales], space.part.weight_n
    forces = np.array([kind.force_n for kind in space.kinds])
    shares = forces[elements.kind] / float(np.dot(counts, forces))
    cost = float(np.dot(counts, [kind.price for kind in space.kinds]))
    result = Statement(
        counts, cost / scales[0], shares[:, None] * elements.arm * weight / scales[1]
    )
    for deviation in elements.deviation:
        result.variable(deviation / sum(counts) / scales[2])
    for kind, count in enumerate(counts):
        result.row(np.flatnonzero(elements.kind == kind).tolist(), low=count, high=count)
    near = np.triu(elements.distance < rules.requirements.clearance_mm * (1 - SLACK), 1)
    for pair in np.argwhere(near).tolist():
        result.row(pair, high=1)
    if sum(counts) > 1 and np.isfinite(scales[3]):
        _state_structure(result, elements, rules.requirements, scales[3])
    result.moment = result.variable(1.0, upper=0, whole=False)
    return result


def _state_structure(
    result: Statement, elements: Elements, need: Requirements, scale: float
) -> None:
    """Add the choice of the main truss, and the branch of every other element to it (eq. 7)."""
    distance, near = elements.distance, need.clearance_mm * (1 - SLACK)
    trusses: list[int] = []
    uses: list[list[int]] = [[] for _ in elements.kind]
    ranks: list[int] = []
    rank = _ranks(distance)
    for pair in np.argwhere(np.triu(distance >= near, 1)).tolist():
        start, end = pair
        length = distance[start, end]
        between = (distance[pair] >= near) & (distance[pair] <= length * (1 + SLACK))
        others = np.flatnonzero(between.all(axis=0))
        left = [
            count - int((elements.kind[pair] == kind).sum())
            for kind, count in enumerate(result.counts)
        ]
        places = [others[elements.kind[others] == kind].tolist() for kind in range(len(left))]
        if any(not 0 <= n <= len(there) for n, there in zip(left, places, strict=True)):
            continue
        truss = result.variable(need.density_ratio * length / scale)
        trusses.append(truss)
        ranks.append(int(rank[start, end]))
        uses[start].append(truss)
        uses[end].append(truss)
        branch = _branches(elements.plan, start, end) / scale
        for n, there in zip(left, places, strict=True):
            if n == 0:
                continue
            hangs = [result.variable(branch[e], whole=False) for e in there]
            for e, share in zip(there, hangs, strict=True):
                uses[e].append(share)
            result.row([*hangs, truss], [1] * len(hangs) + [-n], low=0, high=0)
    result.row(trusses, low=1, high=1)
    for e, roles in enumerate(uses):
        result.row([*roles, e], [1] * len(roles) + [-1], low=0, high=0)
    chosen = result.variable(0.0, upper=int(rank.max()), whole=False)
    result.row([*trusses, chosen], [*ranks, -1], low=0, high=0)
    for a, b in np.argwhere(np.triu(distance >= near, 1)).tolist():
        far = int(rank[a, b])
        result.row([chosen, a, b], [1, -far, -far], low=-far)


def _branches(plan: FloatArray, start: int, end: int) -> FloatArray:
    """Return the distance of each element to the line of a main truss, ``(n,)`` (mm)."""
    x, y = (plan[end] - plan[start]) / np.linalg.norm(plan[end] - plan[start])
    offset = plan - plan[start]
    across: FloatArray = np.abs(x * offset[:, 1] - y * offset[:, 0])
    return across


def _ranks(distance: FloatArray) -> IntArray:
    """Return the rank of each length, ``(n, n)``; lengths within the slack have the same one."""
    lengths, inverse = np.unique(distance, return_inverse=True)
    steps = lengths[1:] > lengths[:-1] * (1 + SLACK)
    return np.concatenate([[0], np.cumsum(steps)])[inverse].reshape(distance.shape)
