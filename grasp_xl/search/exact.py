"""The exact search: the best grasp of all, with proof (branch and bound, docs/exact.md).

Best first over nodes (counts, a box for each element); a fixed number of nodes is expanded at once,
on all cores, and their outcomes are taken up in order, so that the result does not depend on thread
timing.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from grasp_xl.adding import plain_sum
from grasp_xl.chromosome import Chromosome, from_active
from grasp_xl.grasp import Grasp, evaluate
from grasp_xl.rules import SLACK, Rules
from grasp_xl.search.exact_bound import node_bound
from grasp_xl.search.exact_frontier import Frontier
from grasp_xl.search.exact_kernel import Nodes, make_nodes
from grasp_xl.search.exact_model import Model, Rows, locate, weigh, weigh_goals
from grasp_xl.search.exact_pool import Found, Pool
from grasp_xl.search.exact_prices import make_room
from grasp_xl.search.exact_workers import Workers
from grasp_xl.search.exchange import Exchange
from grasp_xl.search.feasibility import lifting_counts
from grasp_xl.search.floors import floors_by_counts
from grasp_xl.search.stop import Stop, never
from grasp_xl.search.symmetry import symmetries
from grasp_xl.space import FloatArray, IntArray, OptionSpace

Status = Literal["optimal", "feasible", "infeasible", "unknown"]
Ending = Literal["proved", "gap", "time", "memory", "asked"]
"""Why a search ended: all is proved, the gap is small enough, time or memory is used up, or
somebody asked it to stop."""

PROOF = 1e-9
"""Relative accuracy of the proof: no grasp is better by more than that."""

FEW_ELEMENTS = 3
FEW_BATCHES = 64
"""The first batches look at grasps of few elements only: a good one is found there at once."""

ROOT_STEPS = 60
"""Steps of the multipliers where they begin."""

FIRST_EXCHANGE = 64
JUDGED_PER_BATCH = 10_000
GAINED, IN_VAIN = 2, 4
"""Batches before good grasps are looked for by exchange; how many grasps each stream may judge for
each of these; and how many times more batches go by before the next look."""

MAX_OPEN = 4_000_000
"""Open nodes that are kept, about 0.7 GB; a search that needs more stops with a true bound."""


@dataclass(frozen=True, slots=True)
class ExactSettings:
    """What is asked of the exact search.

    Parameters
    ----------
    time_limit_s : float
    gap : float
        Relative gap at which the search may stop.
    top : int
        Number of best grasps wanted, >= 1; images of one another count once.
    meet_goals : bool
        Only grasps whose every normalised value is at most 1.
    min_elements : int
    rows : {"x", "y"}, optional
        Rows of places that are told apart first: another way to the same proof.
    """

    time_limit_s: float = math.inf
    gap: float = 0.0
    top: int = 1
    meet_goals: bool = False
    min_elements: int = 1
    rows: Rows | None = None


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
    ending : {"proved", "gap", "time", "memory", "asked"}
    """

    status: Status
    bound: float
    designs: tuple[Grasp, ...]
    seconds: float
    nodes: int
    ending: Ending = "proved"

    @property
    def gap(self) -> float | None:
        """Relative distance from the bound to the best grasp; None without one."""
        if not self.designs:
            return None
        best = self.designs[0].value
        return max(0.0, (best - self.bound) / max(abs(best), 1e-300))

    @property
    def is_best_proved(self) -> bool:
        """Whether the first design is the best of all, even if the order of others is open."""
        return self.gap is not None and self.gap <= PROOF


OnBound = Callable[[float, float | None], None]
"""Given the bound and the best value so far."""


def solve(
    space: OptionSpace,
    rules: Rules,
    settings: ExactSettings | None = None,
    *,
    known: Sequence[Chromosome] = (),
    stop: Stop = never,
    on_progress: OnBound | None = None,
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
        Asked many times a second; True ends the search with what is proved by then.
    on_progress : callable, optional

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
        self.pool = Pool(symmetries(space) if settings.top > 1 else (), settings.top)
        self.expanded = self.batches = 0
        self.counts = [
            counts
            for counts in lifting_counts(space, rules.requirements)
            if sum(counts) >= settings.min_elements and self._affordable(counts)
        ]
        self.elements = max(map(sum, self.counts), default=1)
        for chromosome in known:
            self._take_known(chromosome)
        self.model = Model(
            locate(space, rules, caps=settings.meet_goals, rows=settings.rows),
            weigh(space, rules, self.counts, caps=settings.meet_goals),
            weigh_goals(space, rules, self.counts if settings.meet_goals else []),
        )
        self.few, self.many = Frontier(self.elements), Frontier(self.elements)
        scales = rules.scales
        self.exchanges = (
            not settings.meet_goals
            and math.isfinite(scales.moment)
            and math.isinf(max(scales.deviation, scales.structure))
        )
        """Exchange keeps no goal and balances the moment; where both deviation and structure
        count, the nodes give good grasps as soon."""
        self.exchange: Exchange | None = None
        self.next_exchange = FIRST_EXCHANGE

    def _affordable(self, counts: tuple[int, ...]) -> bool:
        if not self.settings.meet_goals or "cost" in self.rules.goals.dropped:
            return True
        cost = plain_sum(n * kind.price for n, kind in zip(counts, self.space.kinds, strict=True))
        return cost <= self.rules.goals.base.cost * (1 + SLACK)

    def _take_known(self, chromosome: Chromosome) -> None:
        grasp = evaluate(self.space, self.rules, chromosome)
        wanted = grasp.meets_all_goals if self.settings.meet_goals else grasp.feasible
        if wanted and len(grasp.points_mm) >= self.settings.min_elements:
            active = tuple(tuple(sorted(indices)) for indices in chromosome.active)
            self.pool.take(Found(grasp.value, active))

    # --- the pool of best grasps ---

    @property
    def best(self) -> float | None:
        """Value of the best grasp so far."""
        return self.pool.grasps[0].value if self.pool.grasps else None

    @property
    def upper(self) -> float:
        """Value that a grasp must beat to enter the pool."""
        return self.pool.grasps[-1].value if self.pool.is_full else math.inf

    @property
    def slack(self) -> float:
        """Nodes whose bound is within this of the upper value are not expanded."""
        return PROOF * abs(self.upper) if self.upper < math.inf else 0.0

    # --- the search ---

    def run(self, stop: Stop, on_progress: OnBound | None) -> Proof:
        """Expand nodes until none is left that could hold a better grasp, or somebody stops."""

        def asked_to_stop() -> bool:
            return self._ending(stop) is not None

        self._start()
        with self._workers() as workers:
            while not (asked_to_stop() or self._close_enough()):
                if self.exchanges and self.batches == self.next_exchange:
                    self._look_for_good_ones(workers, asked_to_stop)
                upper, slack = self.upper, self.slack
                taken, frontier = self._take_batch(workers.batch, upper - slack)
                if taken == 0:
                    break
                workers.expand(taken, upper, slack, asked_to_stop)
                for i in range(taken):
                    elements = sum(self.counts[workers.batch.choice[i]])
                    self._take_all(workers.found[i], workers.genes[i], elements, upper)
                frontier.put(workers.children, workers.born[:taken], self.upper - self.slack)
                self.expanded += taken
                self.batches += 1
                if on_progress:
                    on_progress(self.bound, self.best)
        return self._proof(self._ending(stop) or "gap")

    def _workers(self) -> Workers:
        return Workers(
            self.model, self.elements, self.settings.top * (1 + len(self.pool.symmetries))
        )

    def _start(self) -> None:
        """Open the root nodes: one for each choice of counts, with all elements in the root box."""
        room = make_room(len(self.model.locations.xyz), self.elements, 1)
        floors = floors_by_counts(self.space, self.rules.requirements)
        for number, counts in enumerate(self.counts):
            root = make_nodes((1, 1), self.elements)
            root.choice[:] = number
            bound = node_bound(
                *(self.model.locations, self.model.weights[number], root.boxes[0, 0], self.upper),
                *(root.u[0, 0, 0], ROOT_STEPS, room),
            )
            root.bound[:] = max(bound, self.rules.value(floors[counts]))
            frontier = self.few if sum(counts) <= FEW_ELEMENTS else self.many
            frontier.put(root, np.ones(1, dtype=np.int64), self.upper - self.slack)

    def _look_for_good_ones(self, workers: Workers, asked_to_stop: Stop) -> None:
        """Look for better grasps than those that the nodes have given so far."""
        judged = JUDGED_PER_BATCH * self.batches
        self.next_exchange = IN_VAIN * self.batches
        if self.exchange is None:
            self.exchange = Exchange(self.space, self.rules, self.counts)
        if self.pool.grasps:
            best = self.pool.grasps[0]
            self.exchange.know(best.active, best.value)
        workers.exchange(self.exchange, judged, asked_to_stop)
        for active in self.exchange.found():
            value = evaluate(self.space, self.rules, from_active(self.space, active)).value
            if value < self.upper:
                self.pool.take(Found(value, active))
                self.next_exchange = GAINED * self.batches

    def _take_batch(self, batch: Nodes, below: float) -> tuple[int, Frontier]:
        first = self.batches < FEW_BATCHES or self.few.key < self.many.key
        frontier, other = (self.few, self.many) if first else (self.many, self.few)
        taken = frontier.take(batch, below)
        return (taken, frontier) if taken else (other.take(batch, below), other)

    def _take_all(self, values: FloatArray, genes: IntArray, elements: int, upper: float) -> None:
        for value, rows in zip(values.tolist(), genes, strict=True):
            if value < upper:
                self.pool.take(Found(value, self._active(rows[:elements])))

    @property
    def bound(self) -> float:
        """Value below which there is no grasp, as far as proved."""
        best = math.inf if self.best is None else self.best
        return min(best, self.few.bound, self.many.bound)

    def _ending(self, stop: Stop) -> Ending | None:
        """Return why the search must end, if it must."""
        if stop():
            return "asked"
        if time.perf_counter() - self.began >= self.settings.time_limit_s:
            return "time"
        return "memory" if len(self.few) + len(self.many) > MAX_OPEN else None

    def _close_enough(self) -> bool:
        if self.settings.gap <= 0 or not self.pool.is_full:
            return False
        last = self.pool.grasps[-1].value
        return last - self.bound <= self.settings.gap * abs(last)

    def _proof(self, ending: Ending) -> Proof:
        done = not self.few and not self.many
        status: Status
        if self.pool.grasps:
            status = "optimal" if done else "feasible"
        else:
            status = "infeasible" if done else "unknown"
        designs = tuple(
            evaluate(self.space, self.rules, from_active(self.space, found.active))
            for found in self.pool.grasps
        )
        bound = designs[0].value if done and designs else self.bound
        seconds = time.perf_counter() - self.began
        return Proof(status, bound, designs, seconds, self.expanded, "proved" if done else ending)

    def _active(self, rows: IntArray) -> tuple[tuple[int, ...], ...]:
        active: list[list[int]] = [[] for _ in self.space.kinds]
        for place, kind in rows.tolist():
            active[kind].append(int(self.model.locations.footprint[place, kind]) + 1)
        return tuple(tuple(sorted(indices)) for indices in active)
