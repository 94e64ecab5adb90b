"""Who reaches the proved optimum in the same wall time: exact search, genetic search, frameworks.

``python -m benchmarks.exact_genetic`` prints the table of README.md: on each sample part, every
search has the time that our proof took, or ``--seconds``, for each of some seeds.
"""

from __future__ import annotations

import argparse
import math
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from types import ModuleType

import numpy as np

from benchmarks.peers import deap_ga, own_ways, pygad_ga, pymoo_ga
from benchmarks.peers.numpy_rules import NumpyRules
from benchmarks.samples import add_arguments, read
from grasp_xl.search.exact import PROOF, ExactSettings, Proof, solve
from grasp_xl.search.genetic import search, start
from grasp_xl.search.result import load_stream
from grasp_xl.search.stop import StopRule, Target, TimeLimit
from grasp_xl.search.warm import load_exact_search
from grasp_xl.space import IntArray
from grasp_xl.task import Task

ENDLESS = 10**9
"""Generations that no framework finishes in time."""


@dataclass(frozen=True, slots=True)
class Run:
    """The best value of a run, and when it reached the optimum (s; infinity where it did not)."""

    value: float
    reached: float


Search = Callable[[Task, int, float, float], Run]
"""Given a task, a seed, seconds, and the value of the optimum."""

OwnWay = Callable[[own_ways.AnyRules, int, int], None]
"""Given rules, a seed, and a number of generations."""


class Finished(BaseException):
    """The time is up, or the optimum reached."""


class Clock:
    """Mixed into rules: keeps the best value, and ends a framework's run from within."""

    def begin(self, seconds: float, target: float) -> None:
        """Start the clock of a run."""
        self.target, self.best = target, math.inf
        self.ends = time.perf_counter() + seconds

    def value(self, genes: IntArray) -> float:
        """Return what the search minimises.

        Raises
        ------
        Finished
            If the time is up, or the optimum reached.
        """
        value: float = super().value(genes)  # type: ignore[misc]
        self.best = min(self.best, value)
        if self.best <= self.target or time.perf_counter() >= self.ends:
            raise Finished
        return value


class TimedRules(Clock, NumpyRules):
    """Rules for the thesis's algorithm, which keeps the clearance by itself."""


class TimedAnyRules(Clock, own_ways.AnyRules):
    """Rules for any grasp."""


def exact(task: Task, limit: float) -> tuple[Proof, float]:
    """Return our proof, and when its best grasp was found (s)."""
    began, met = time.perf_counter(), [(math.inf, 0.0)]

    def progress(_: float, best: float | None) -> None:
        if best is not None and best < met[-1][0] * (1 - PROOF):
            met.append((best, time.perf_counter() - began))

    settings = ExactSettings(time_limit_s=limit)
    proof = solve(task.space, task.rules, settings, on_progress=progress)
    return proof, met[-1][1]


def genetic(task: Task, seed: int, seconds: float, target: float) -> Run:
    """Run our genetic search."""
    settings = replace(task.settings, seed=seed)
    stop: list[StopRule] = [Target(target), TimeLimit(seconds)]
    result = search(task.space, task.rules, settings, task.benchmark.chromosome, stop)
    value = result.best.value if result.best else math.inf
    return Run(value, result.seconds if value <= target else math.inf)


def thesis_way(peer: ModuleType, task: Task, seed: int, seconds: float, target: float) -> Run:
    """Run the thesis's algorithm in a framework, from our start with our random numbers."""
    state = start(task.space, replace(task.settings, seed=seed), task.benchmark.chromosome)
    genes, stream = np.array(state.parent.genes).ravel(), load_stream(state.random_state)
    rules = TimedRules(task.space, task.rules)
    run = partial(peer.run, rules, stream, genes, task.settings.one_in, ENDLESS)
    return timed(rules, run, seconds, target)


def own_way(peer: OwnWay, task: Task, seed: int, seconds: float, target: float) -> Run:
    """Run a framework's own algorithm."""
    rules = TimedAnyRules(task.space, task.rules)
    return timed(rules, partial(peer, rules, seed, ENDLESS), seconds, target)


def timed(rules: Clock, run: Callable[[], object], seconds: float, target: float) -> Run:
    """Run a framework until its time is up; tables have been made before the clock starts."""
    began = time.perf_counter()
    rules.begin(seconds, target)
    try:
        run()
    except Finished:
        took = time.perf_counter() - began
    return Run(rules.best, took if rules.best <= target else math.inf)


SEARCHES: dict[str, Search] = {
    "grasp_xl, genetic": genetic,
    "DEAP, thesis's algorithm": partial(thesis_way, deap_ga),
    "pymoo, thesis's algorithm": partial(thesis_way, pymoo_ga),
    "PyGAD, thesis's algorithm": partial(thesis_way, pygad_ga),
    "DEAP, its own": partial(own_way, own_ways.deap),
    "pymoo, its own": partial(own_way, own_ways.pymoo),
    "PyGAD, its own": partial(own_way, own_ways.pygad_),
}


def cell(runs: list[Run], optimum: float) -> str:
    """Return the hits, and the median time (s) to the optimum or else the median gap."""
    hits = sum(run.reached < math.inf for run in runs)
    reached = float(np.median([run.reached for run in runs]))
    gap = float(np.median([run.value / optimum - 1 for run in runs]))
    left = f"{gap:.1%}" if gap < own_ways.WORST / optimum - 1 else "no grasp"
    middle = f"{reached:.2f} s" if reached < math.inf else left
    return f"{hits}/{len(runs)}, {middle}"


def main() -> None:
    """Print a table: a row for each search, a column for each part."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    add_arguments(parser, limit=10.0)
    parser.add_argument("--seconds", type=float, help="of each run; as our proof took by default")
    parser.add_argument("--seeds", type=int, default=5)
    said = parser.parse_args()
    load_exact_search()
    tasks = [read(file) for file in said.files]
    proofs = [exact(task, said.limit) for task in tasks]
    times = [said.seconds or proof.seconds for proof, _ in proofs]
    print(
        "| |",
        " | ".join(f"{f.stem}, {t:.2f} s" for f, t in zip(said.files, times, strict=True)),
        "|",
    )
    print("|---" * (1 + len(tasks)) + "|")
    ends = [
        f"found {found:.2f} s, "
        + (f"proved {proof.seconds:.2f} s" if proof.gap == 0.0 else f"{proof.gap:.1%} open")
        for proof, found in proofs
    ]
    print("| grasp_xl, exact |", " | ".join(ends), "|")
    for name, run in SEARCHES.items():
        run(tasks[0], 1, 0.1, 0.0)  # compiled code is loaded before the clock starts
        cells = []
        for task, (proof, _), seconds in zip(tasks, proofs, times, strict=True):
            optimum = proof.designs[0].value
            target = optimum * (1 + PROOF)
            runs = [run(task, seed, seconds, target) for seed in range(1, said.seeds + 1)]
            cells.append(cell(runs, optimum))
        print(f"| {name} |", " | ".join(cells), "|", flush=True)


if __name__ == "__main__":
    main()
