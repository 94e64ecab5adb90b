"""The trade-off front: grasps of which none is better in one criterion and no worse in the others.

Every weighted sum of the criteria on a grid of weights is minimised by the exact search, and what
that and short genetic runs met on the way is kept, as far as nothing dominates it.  A second exact
search asks of each design whether any grasp dominates it at all (docs/exact.md, "The front").
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field, replace
from itertools import combinations_with_replacement

import numpy as np

from grasp_xl.chromosome import Chromosome, from_active
from grasp_xl.grasp import Grasp, evaluate
from grasp_xl.kernels import measure_rows, tabulate
from grasp_xl.rules import SLACK, TERMS, Criterion, Goals, Rules, Terms
from grasp_xl.search.exact import ExactSettings, Proof, solve
from grasp_xl.search.exact_model import Rows
from grasp_xl.search.genetic import search
from grasp_xl.search.result import GeneticSettings
from grasp_xl.search.stop import Generations, Stop, never
from grasp_xl.space import FloatArray, IntArray, OptionSpace

DEFAULT_GRID = 4
"""Steps from one criterion alone to another: 35 weighted sums of four criteria."""

GENERATIONS = 3_000
"""Of the genetic run under each weighted sum: some hundredths of a second."""

FIRST_EFFORT = 100
MORE_EFFORT = 4
"""Batches of nodes of the first search for a proof, and how many times more each next one may take.

Counted, not timed, so that the result does not depend on how fast a machine is.
"""

WAYS: tuple[Rows | None, ...] = (None, "x", "y")
"""Ways to a proof that are tried in turn where no truss counts: which one is short depends on the
part, and they differ a hundredfold."""

CLOSE = 1e-3
"""A weighted sum counts as minimised when no grasp can be better by more than this share of it, or
of what it is at the goals, if that is more: where a few elements of many places balance the part in
very many ways, some come nearer to a moment of 0 than anybody needs."""

LEAST_CAP = 1e-9
"""A criterion of 0 is capped there, since values are divided by caps."""


@dataclass(frozen=True, eq=False, slots=True)
class Design:
    """A grasp of the front.

    Parameters
    ----------
    grasp : Grasp
    proved : bool
        Whether it is proved that no grasp of all dominates it.
    weights : Terms or None
        Weights of the normalised criteria, 1 in sum, of whose weighted sum it is the proved
        optimum, to ``CLOSE``; None if no search has proved any.
    """

    grasp: Grasp
    proved: bool
    weights: Terms | None


@dataclass(frozen=True, eq=False, slots=True)
class Front:
    """What is known of the trade-off front.

    Parameters
    ----------
    designs : tuple of Design
        None dominates another; by divergence.
    sums, proved_sums : int
        Weighted sums that were to be minimised, and that are, with proof to ``CLOSE``.
    seconds : float
    """

    designs: tuple[Design, ...]
    sums: int
    proved_sums: int
    seconds: float

    @property
    def complete(self) -> bool:
        """Whether every weighted sum is minimised and every design is proved."""
        return self.proved_sums == self.sums and all(design.proved for design in self.designs)


OnFront = Callable[[int, int, int, int], None]
"""Given the weighted sums minimised and all of them, the designs proved and all of them."""


def find_front(
    space: OptionSpace,
    rules: Rules,
    settings: GeneticSettings,
    benchmark: Chromosome,
    *,
    grid: int = DEFAULT_GRID,
    seconds: float = math.inf,
    stop: Stop = never,
    on_progress: OnFront | None = None,
) -> Front:
    """Find the trade-off front over cost, moment, deviation and structure.

    Parameters
    ----------
    space, rules
        Of which a grasp meets FoS and clearance; the criterion does not matter.
    settings, benchmark
        Of the genetic runs.
    grid : int
        Divisions of each weight, >= 1.
    seconds : float
        Longest search; without a limit it goes on until all is proved.
    stop : callable
        True ends the search with what is proved by then.
    on_progress : callable, optional
    """
    began = time.perf_counter()
    deadline = began + seconds

    def halted() -> bool:
        return stop() or time.perf_counter() >= deadline

    finder = _Finder(space, rules, halted, on_progress, weightings(rules.goals, grid))
    finder.meet([benchmark])
    finder.run(settings, benchmark)
    return finder.front(time.perf_counter() - began)


def weightings(goals: Goals, grid: int) -> list[Terms]:
    """Return all weights of a grid, 1 in sum: each criterion alone first, then ever more of them.

    A criterion without a goal to divide by is minimised alone only.

    Examples
    --------
    >>> goals = Goals(Terms(1.0, 1.0, 1.0, 0.0), frozenset({"structure"}))
    >>> [tuple(weights) for weights in weightings(goals, 2)][2:5]
    [(0.0, 0.0, 1.0, 0.0), (0.0, 0.0, 0.0, 1.0), (0.5, 0.5, 0.0, 0.0)]
    """
    alone = [Terms(*(float(term == other) for other in TERMS)) for term in TERMS]
    joined = [number for number, term in enumerate(TERMS) if term not in goals.dropped]
    shares = (
        np.bincount(steps, minlength=len(TERMS)) / grid
        for steps in combinations_with_replacement(joined, grid)
    )
    mixed = [Terms(*each.tolist()) for each in shares if each.max() < 1]
    return alone + sorted(mixed, key=lambda weights: sum(map(bool, weights)))


def weighted(rules: Rules, weights: Terms) -> Rules:
    """Return rules whose value is a weighted sum; of one criterion alone, in its own unit."""
    terms = frozenset(term for term, weight in zip(TERMS, weights, strict=True) if weight)
    return replace(rules, criterion=Criterion(terms), weights=weights)


def is_close(rules: Rules, share: float, bound: float, best: float | None) -> bool:
    """Tell whether no value can be below the best by more than a share of it, or of the goals'."""
    return best is not None and best - bound <= share * max(abs(best), rules.baseline)


def no_worse_than(rules: Rules, terms: Terms) -> Rules:
    """Return rules whose goals are met by what is no worse in any criterion.

    A grasp with these criteria has the value 4, and what dominates it has less.
    """
    caps = Terms(*(max(value, LEAST_CAP) for value in terms))
    return Rules(Goals(caps), rules.requirements)


def covers(terms: FloatArray) -> IntArray:
    """Return for each row the first one that is no worse in any criterion, itself if none is.

    Parameters
    ----------
    terms : FloatArray
        ``(n, 4)`` array of criteria.

    Returns
    -------
    IntArray
        ``(n,)`` array of rows; rows that name themselves dominate all others, or equal them.

    Examples
    --------
    >>> covers(np.array([[2.0, 3, 1, 1], [2, 2, 1, 1], [1, 5, 1, 1], [2, 2, 1, 1]])).tolist()
    [1, 1, 2, 1]
    """
    found = np.arange(len(terms))
    least = np.empty_like(terms)
    rows = np.empty(len(terms), dtype=np.int64)
    kept = 0
    sums = np.round((terms / np.maximum(terms.max(axis=0, initial=0.0), 1e-300)).sum(axis=1), 9)
    for row in np.argsort(sums, kind="stable").tolist():
        bar = terms[row] + SLACK * (1 + np.abs(terms[row]))
        better = (least[:kept] <= bar).all(axis=1)
        if better.any():
            found[row] = rows[int(np.argmax(better))]
        else:
            least[kept], rows[kept] = terms[row], row
            kept += 1
    return found


@dataclass(eq=False, slots=True)
class _Met:
    """A grasp that a search met, and what is proved of it."""

    grasp: Grasp
    proved: bool = False
    optimal_for: list[Terms] = field(default_factory=list)

    def weights(self, goals: Goals) -> Terms | None:
        """Return the middle of all weights: an optimum of two sums is that of their sum, too.

        A criterion without a goal cannot be added to others.
        """
        alone = [term in goals.dropped for term in TERMS]
        added = [each for each in self.optimal_for if not np.dot(each, alone)]
        chosen = added or self.optimal_for[:1]
        return Terms(*np.mean(chosen, axis=0).tolist()) if chosen else None


class _Finder:
    """What is met and proved so far."""

    def __init__(
        self,
        space: OptionSpace,
        rules: Rules,
        halted: Stop,
        on_progress: OnFront | None,
        sums: Sequence[Terms],
    ) -> None:
        self._space, self._rules, self._halted = space, rules, halted
        self._on_progress = on_progress
        self._tables = tabulate(space, rules)
        self._sums, self._open = len(sums), list(sums)
        self._met: list[_Met] = []

    def run(self, settings: GeneticSettings, benchmark: Chromosome) -> None:
        """Search in rounds, each with more effort than the one before, until all is proved."""
        stop = [Generations(GENERATIONS)]
        for weights in self._open:
            if self._halted():
                return
            rules = weighted(self._rules, weights)
            result = search(self._space, rules, settings, benchmark, stop)
            best = [result.best.chromosome] if result.best else []
            self.meet([*map(Chromosome, self._worth_meeting(result.state.designs.genes)), *best])
        effort = FIRST_EFFORT
        while not (self._halted() or self._is_complete):
            for weights in list(self._open):
                self._minimise(weights, effort)
            behind = effort // MORE_EFFORT if self._open else effort
            self._check(behind, optimal=True)
            self._check(behind // MORE_EFFORT, optimal=False)
            effort *= MORE_EFFORT

    @property
    def _is_complete(self) -> bool:
        return not self._open and all(met.proved for met in self._met)

    def front(self, seconds: float) -> Front:
        """Return what is known."""
        designs = [
            Design(
                evaluate(self._space, self._rules, met.grasp.chromosome),
                met.proved,
                met.weights(self._rules.goals),
            )
            for met in self._met
        ]
        designs.sort(key=lambda each: (each.grasp.divergence, each.grasp.chromosome.active))
        return Front(tuple(designs), self._sums, self._sums - len(self._open), seconds)

    # --- what is met ---

    def _worth_meeting(self, genes: IntArray) -> IntArray:
        """Return the chromosomes that nothing among them dominates, ``(n, kinds, 1 + slots)``."""
        measured = measure_rows(self._tables, genes)
        feasible = measured[:, 5] == 1
        usable, terms = genes[feasible], measured[feasible, 1:5]
        first: IntArray = usable[covers(terms) == np.arange(len(terms))]
        return first

    def meet(self, chromosomes: Iterable[Chromosome]) -> None:
        """Take in grasps that a search met."""
        grasps = [self._judged(chromosome) for chromosome in chromosomes]
        self._take([_Met(grasp) for grasp in grasps if grasp.feasible])

    def _judged(self, chromosome: Chromosome) -> Grasp:
        """Judge a grasp whose genes are sorted, so that it is the same however it was found."""
        active = [sorted(indices) for indices in chromosome.active]
        return evaluate(self._space, self._rules, from_active(self._space, active))

    def _take(self, met: list[_Met]) -> None:
        """Keep what nothing dominates; a grasp no worse than another has all that is its own."""
        known = [*self._met, *met]
        rows = covers(np.array([each.grasp.terms for each in known]).reshape(-1, len(TERMS)))
        for each, row in zip(known, rows.tolist(), strict=True):
            first = known[row]
            if first is not each:
                first.optimal_for += [w for w in each.optimal_for if w not in first.optimal_for]
                first.proved = first.proved or each.proved
        self._met = [each for row, each in enumerate(known) if rows[row] == row]

    # --- what is proved ---

    def _minimise(self, weights: Terms, effort: int) -> None:
        """Search for the optimum of a weighted sum, one way after the other."""
        for rows in WAYS if weights.structure == 0 else WAYS[:1]:
            if weights in self._open and not self._halted():
                self._minimise_by(weights, effort, ExactSettings(rows=rows))

    def _minimise_by(self, weights: Terms, effort: int, settings: ExactSettings) -> None:
        rules = weighted(self._rules, weights)
        best = min(self._met, key=lambda met: rules.value(met.grasp.terms), default=None)
        known, enough = [best.grasp.chromosome] if best else [], 0.0 if all(weights) else CLOSE
        proof = self._solve(rules, known, settings, effort, enough)
        found = [_Met(self._judged(each.chromosome)) for each in proof.designs]
        if is_close(rules, CLOSE, proof.bound, proof.designs[0].value if proof.designs else None):
            self._open.remove(weights)
            for met in found:
                met.optimal_for.append(weights)
                met.proved = all(weights) and proof.status == "optimal"
        self._take(found)
        self._tell()

    def _check(self, effort: int, *, optimal: bool) -> None:
        """Ask of each design, optima or the others, whether any grasp dominates it."""
        for met in [each for each in self._met if bool(each.optimal_for) == optimal]:
            if met.proved or met not in self._met:
                continue
            if self._halted():
                return
            rules = no_worse_than(self._rules, met.grasp.terms)
            known, settings = [met.grasp.chromosome], ExactSettings(meet_goals=True)
            proof = self._solve(rules, known, settings, effort)
            better = [_Met(self._judged(each.chromosome)) for each in proof.designs]
            for each in better if proof.status == "optimal" else ():
                each.proved = True
            self._take(better)
            self._tell()

    def _solve(
        self,
        rules: Rules,
        known: list[Chromosome],
        settings: ExactSettings,
        effort: int,
        enough: float = 0.0,
    ) -> Proof:
        """Run the exact search for so many batches of nodes; fewer where it comes close enough."""
        batches, close = 0, False

        def count(bound: float, best: float | None) -> None:
            nonlocal batches, close
            batches += 1
            close = batches >= FIRST_EFFORT and is_close(rules, enough, bound, best)

        def stop() -> bool:
            return batches >= effort or close or self._halted()

        return solve(self._space, rules, settings, known=known, stop=stop, on_progress=count)

    def _tell(self) -> None:
        if self._on_progress:
            proved = sum(met.proved for met in self._met)
            done = self._sums - len(self._open)
            self._on_progress(done, self._sums, proved, len(self._met))
