"""The exact search: the best grasp of all, with proof (branch and bound).

Best first over nodes (counts, box, box); a fixed number of nodes is expanded at once, on all cores,
and their outcomes are taken up in order, so that the result does not depend on thread timing.
"""

from __future__ import annotations

import heapq
import itertools
import math
import os
import time
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Any, Literal, NamedTuple

import numpy as np

from grasp_xl.chromosome import Chromosome, from_active
from grasp_xl.grasp import Grasp, evaluate
from grasp_xl.kernels import RecordArray, boundary_distances
from grasp_xl.rules import SLACK, Rules
from grasp_xl.search.exact_kernel import (
    NODE,
    PAIR_BUDGET,
    WEIGHTS,
    Locations,
    Scratch,
    expand,
    grow_tree,
)
from grasp_xl.search.feasibility import lifting_counts
from grasp_xl.space import FloatArray, IntArray, OptionSpace

Status = Literal["optimal", "feasible", "infeasible", "unknown"]

BATCH = 64
"""Nodes that are expanded at once; the same on every machine, so that results are."""

PROOF = 1e-9
"""Relative accuracy of the proof: no grasp is better by more than that."""


@dataclass(frozen=True, slots=True)
class ExactSettings:
    """What is asked of the exact search.

    Parameters
    ----------
    time_limit_s : float
    gap : float
        Relative gap at which the search may stop.
    top : int
        Number of best grasps wanted, >= 1.
    meet_goals : bool
        Only grasps whose every normalised value is at most 1.
    min_elements : int
    """

    time_limit_s: float = math.inf
    gap: float = 0.0
    top: int = 1
    meet_goals: bool = False
    min_elements: int = 1


@dataclass(frozen=True, eq=False, slots=True)
class Proof:
    """What the exact search found and proved.

    Parameters
    ----------
    status : {"optimal", "feasible", "infeasible", "unknown"}
    bound : float
        No grasp has a value below this; infinity where none exists.
    designs : tuple of Grasp
        Best grasps found, best first.
    seconds : float
    nodes : int
        Nodes expanded.
    """

    status: Status
    bound: float
    designs: tuple[Grasp, ...]
    seconds: float
    nodes: int

    @property
    def gap(self) -> float | None:
        """Relative distance from the bound to the best grasp; None without one."""
        if not self.designs:
            return None
        best = self.designs[0].value
        return max(0.0, (best - self.bound) / max(abs(best), 1e-300))


NodeRow = tuple[Any, ...]
"""The fields of a ``NODE``, as Python numbers."""


class Found(NamedTuple):
    """A grasp met in the search: its value, and its sorted active indices a kind."""

    value: float
    active: tuple[tuple[int, ...], ...]


class _Outcome(NamedTuple):
    """What expanding some nodes gave; rows as in ``exact_kernel.expand``."""

    children: RecordArray
    found: FloatArray
    genes: IntArray
    nodes: RecordArray


def locate(space: OptionSpace, rules: Rules) -> Locations:
    """Merge footprints at one place into locations, and lay a kd-tree over them."""
    places: dict[tuple[float, ...], list[int]] = {}
    for number, kind in enumerate(space.kinds):
        for index, point in enumerate(kind.footprints_mm.tolist()):
            places.setdefault(tuple(point), [-1, -1])[number] = index
    points = np.array(list(places), dtype=np.float64).reshape(-1, 3)
    footprint = np.array(list(places.values()), dtype=np.int64).reshape(-1, 2)
    order, box, run, child = grow_tree(points[:, :2] - space.part.centroid_mm[:2])
    deviation = boundary_distances(points, np.array(space.ideal_polygon_mm))
    xyz = points - space.part.centroid_mm
    if rules.requirements.moment_arm == "plan":
        xyz[:, 2] = 0.0
    return Locations(
        np.ascontiguousarray(xyz[order]), deviation[order], footprint[order], box, run, child
    )


def weigh(
    space: OptionSpace, rules: Rules, choices: Sequence[tuple[int, ...]], *, caps: bool
) -> RecordArray:
    """Return the weights of the terms, a row for each choice of counts."""
    scales, goals, weight = rules.scales, rules.goals, space.part.weight_n
    prices = [kind.price for kind in space.kinds]
    forces = [kind.force_n for kind in space.kinds]

    def cap(term: str, unit: float) -> float:
        return getattr(goals.base, term) / unit if caps and term not in goals.dropped else math.inf

    rows = np.zeros(len(choices), dtype=WEIGHTS)
    for row, counts in zip(rows, choices, strict=True):
        elements, force = sum(counts), _dot(counts, forces)
        row["cups"], row["magnets"] = counts
        row["base"] = _dot(counts, prices) / scales.cost
        row["moment"] = weight / scales.moment
        row["deviation"] = 1.0 / (elements * scales.deviation)
        row["structure"] = 1.0 / scales.structure
        row["cup_pull"], row["magnet_pull"] = (each / force for each in forces)
        row["ratio"] = rules.requirements.density_ratio
        row["clearance"] = rules.requirements.clearance_mm
        row["arm_cap"] = cap("moment", weight)
        row["deviation_cap"] = cap("deviation", 1.0 / elements)
        row["structure_cap"] = cap("structure", 1.0)
    return rows


def solve(
    space: OptionSpace,
    rules: Rules,
    settings: ExactSettings | None = None,
    *,
    known: Sequence[Chromosome] = (),
    stop: Callable[[], bool] = lambda: False,
    on_progress: Callable[[float, float | None], None] | None = None,
) -> Proof:
    """Find the best grasp of all, and prove that there is no better one.

    Parameters
    ----------
    space, rules
        What to search, how to judge; exactly two element kinds.
    settings : ExactSettings, optional
    known : sequence of Chromosome
        Feasible grasps that are known already; better ones are looked for.
    stop : callable
        Asked a few times a second; True ends the search with what is proved by then.
    on_progress : callable, optional
        Given the bound and the best value so far.

    Returns
    -------
    Proof
    """
    return _Search(space, rules, settings or ExactSettings(), known).run(stop, on_progress)


class _Search:
    def __init__(
        self,
        space: OptionSpace,
        rules: Rules,
        settings: ExactSettings,
        known: Sequence[Chromosome],
    ) -> None:
        self.space, self.rules, self.settings = space, rules, settings
        self.began = time.perf_counter()
        self.locations = locate(space, rules)
        self.numbers = itertools.count()
        self.heap: list[tuple[float, int, NodeRow]] = []
        self.pool: list[Found] = []
        self.expanded = 0
        caps = settings.meet_goals
        self.counts = [
            counts
            for counts in lifting_counts(space, rules.requirements)
            if sum(counts) >= settings.min_elements and self._affordable(counts)
        ]
        self.weights = weigh(space, rules, self.counts, caps=caps)
        for chromosome in known:
            self._take_known(chromosome)

    def _affordable(self, counts: tuple[int, ...]) -> bool:
        if not self.settings.meet_goals or "cost" in self.rules.goals.dropped:
            return True
        cost = sum(n * kind.price for n, kind in zip(counts, self.space.kinds, strict=True))
        return cost <= self.rules.goals.base.cost * (1 + SLACK)

    def _take_known(self, chromosome: Chromosome) -> None:
        grasp = evaluate(self.space, self.rules, chromosome)
        wanted = grasp.meets_all_goals if self.settings.meet_goals else grasp.feasible
        if wanted and len(grasp.points_mm) >= self.settings.min_elements:
            active = tuple(tuple(sorted(indices)) for indices in chromosome.active)
            self._take(Found(grasp.value, active))

    # --- the pool of best grasps ---

    @property
    def upper(self) -> float:
        """Value that a grasp must beat to enter the pool."""
        full = len(self.pool) >= self.settings.top
        return self.pool[-1].value if full else math.inf

    def _take(self, found: Found) -> None:
        """Enter a grasp: values within 1e-9 are equal, and then the smaller indices come first."""
        if any(other.active == found.active for other in self.pool):
            return
        self.pool.append(found)
        self.pool.sort(key=lambda item: (_rounded(item.value), item.active))
        del self.pool[self.settings.top :]

    # --- the search ---

    def run(
        self,
        stop: Callable[[], bool],
        on_progress: Callable[[float, float | None], None] | None,
    ) -> Proof:
        """Expand nodes until none is left that could hold a better grasp, or somebody stops."""
        workers = os.cpu_count() or 1
        rooms = [self._room() for _ in range(workers)]
        self._start()
        stopped = False
        with ThreadPoolExecutor(workers) as threads:
            while self._worth_while() and not stopped:
                batch = [heapq.heappop(self.heap)[2] for _ in range(min(BATCH, len(self.heap)))]
                shares = [batch[number::workers] for number in range(workers)]
                outcomes = list(threads.map(self._expand, shares, rooms))
                for number in range(len(batch)):
                    self._absorb(outcomes[number % workers], number // workers)
                self.expanded += len(batch)
                if on_progress:
                    on_progress(self.bound, self.pool[0].value if self.pool else None)
                stopped = stop() or self._out_of_time() or self._close_enough()
        return self._proof()

    def _worth_while(self) -> bool:
        if self.heap and self.heap[0][0] >= self.upper - self._slack():
            self.heap.clear()
        return bool(self.heap)

    def _slack(self) -> float:
        return PROOF * abs(self.upper) if self.upper < math.inf else 0.0

    def _expand(self, share: list[NodeRow], room: Scratch) -> _Outcome:
        """Expand some nodes; runs beside other threads, and changes nothing of the search."""
        top, elements = self.settings.top, max(map(sum, self.counts))
        outcome = _Outcome(
            np.zeros((len(share), 3), dtype=NODE),
            np.zeros((len(share), top)),
            np.zeros((len(share), top, elements, 2), dtype=np.int64),
            np.array(share, dtype=NODE),
        )
        expand(
            self.locations,
            self.weights,
            outcome.nodes,
            self.upper,
            self._slack(),
            outcome.children,
            outcome.found,
            outcome.genes,
            room,
        )
        return outcome

    def _absorb(self, outcome: _Outcome, row: int) -> None:
        """Take up what one node gave."""
        elements = sum(self.counts[int(outcome.nodes[row]["counts"])])
        upper = self.upper
        for value, genes in zip(outcome.found[row], outcome.genes[row], strict=True):
            if value < upper:
                self._take(Found(float(value), self._active(genes[:elements])))
        for child in outcome.children[row].tolist():
            if child[0] < self.upper - self._slack():
                self._push(child)

    def _push(self, node: NodeRow) -> None:
        heapq.heappush(self.heap, (node[0], next(self.numbers), node))

    @property
    def bound(self) -> float:
        """Value below which there is no grasp, as far as proved."""
        best = self.pool[0].value if self.pool else math.inf
        return min(best, self.heap[0][0]) if self.heap else best

    def _out_of_time(self) -> bool:
        return time.perf_counter() - self.began >= self.settings.time_limit_s

    def _close_enough(self) -> bool:
        if self.settings.gap <= 0 or len(self.pool) < self.settings.top:
            return False
        last = self.pool[-1].value
        return last - self.bound <= self.settings.gap * abs(last)

    def _proof(self) -> Proof:
        done = not self.heap
        status: Status
        if self.pool:
            status = "optimal" if done else "feasible"
        else:
            status = "infeasible" if done else "unknown"
        designs = tuple(
            evaluate(self.space, self.rules, from_active(self.space, found.active))
            for found in self.pool
        )
        bound = designs[0].value if done and designs else self.bound
        seconds = time.perf_counter() - self.began
        return Proof(status, bound, designs, seconds, self.expanded)

    def _room(self) -> Scratch:
        n = len(self.locations.xyz)
        return Scratch(
            np.empty(n, dtype=np.int64), np.empty(n), np.empty(n), np.empty(n, dtype=np.int64)
        )

    def _start(self) -> None:
        for number, counts in enumerate(self.counts):
            if sum(counts) == 1:
                self._single_elements(number)
            else:
                self._push((-math.inf, number, 0, 0, 0.0, 0.0, 0.0, 0.0, PAIR_BUDGET))

    def _single_elements(self, number: int) -> None:
        """Judge every grasp of one element."""
        kind = self.counts[number].index(1)
        weights, loc = self.weights[number], self.locations
        arm = np.sqrt((loc.xyz**2).sum(axis=1))
        value = weights["base"] + weights["moment"] * arm + weights["deviation"] * loc.deviation
        usable = loc.footprint[:, kind] >= 0
        usable &= arm <= weights["arm_cap"] * (1 + SLACK)
        usable &= loc.deviation <= weights["deviation_cap"] * (1 + SLACK)
        places = np.flatnonzero(usable)
        for place in places[np.argsort(value[places], kind="stable")][: self.settings.top]:
            active: list[tuple[int, ...]] = [()] * len(self.space.kinds)
            active[kind] = (int(loc.footprint[place, kind]) + 1,)
            self._take(Found(float(value[place]), tuple(active)))

    def _active(self, rows: IntArray) -> tuple[tuple[int, ...], ...]:
        active: list[list[int]] = [[] for _ in self.space.kinds]
        for place, kind in rows.tolist():
            active[kind].append(int(self.locations.footprint[place, kind]) + 1)
        return tuple(tuple(sorted(indices)) for indices in active)


def _rounded(value: float) -> float:
    """Round to nine significant digits, so that equal values sort by their grasps."""
    return float(f"{value:.9g}")


def _dot(counts: Sequence[int], numbers: Sequence[float]) -> float:
    return sum(count * number for count, number in zip(counts, numbers, strict=True))
