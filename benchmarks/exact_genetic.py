"""Who reaches the proved optimum in the same wall time: exact search, genetic search, frameworks.

``python -m benchmarks.exact_genetic`` prints the tables of README.md: on each sample part, every
search has the time that our proof took, and then a fixed time, a run for each seed.
"""

from __future__ import annotations

import argparse
import math
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from types import ModuleType

import numpy as np

from benchmarks.peers import deap_ga, pygad_ga, pymoo_ga
from benchmarks.peers.numpy_rules import NumpyRules
from benchmarks.samples import add_arguments, read
from grasp_xl.rules import Rules
from grasp_xl.search.exact import PROOF, ExactSettings, Proof, solve
from grasp_xl.search.genetic import search, start
from grasp_xl.search.result import load_stream
from grasp_xl.search.stop import Target, TimeLimit
from grasp_xl.search.warm import load_exact_search
from grasp_xl.space import IntArray, OptionSpace
from grasp_xl.task import Task

PEERS: dict[str, ModuleType] = {"DEAP": deap_ga, "pymoo": pymoo_ga, "PyGAD": pygad_ga}
ENDLESS = 10**9
"""Generations that no framework finishes in time."""


@dataclass(frozen=True, slots=True)
class Run:
    """The best value of a run, and when it reached the optimum (s; infinity where it did not)."""

    value: float
    reached: float


class Finished(BaseException):
    """The time is up, or the optimum reached."""


class TimedRules(NumpyRules):
    """Rules that keep the best value, and end a framework's run from within."""

    def __init__(self, space: OptionSpace, rules: Rules, target: float) -> None:
        super().__init__(space, rules)
        self.target, self.best, self.ends = target, math.inf, math.inf

    def begin(self, seconds: float) -> None:
        """Start the clock of a run."""
        self.best, self.ends = math.inf, time.perf_counter() + seconds

    def value(self, genes: IntArray) -> float:
        """Return what the search minimises.

        Raises
        ------
        Finished
            If the time is up, or the optimum reached.
        """
        value = super().value(genes)
        self.best = min(self.best, value)
        if self.best <= self.target or time.perf_counter() >= self.ends:
            raise Finished
        return value


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
    stop = [Target(target), TimeLimit(seconds)]
    result = search(task.space, task.rules, settings, task.benchmark.chromosome, stop)
    value = result.best.value if result.best else math.inf
    return Run(value, result.seconds if value <= target else math.inf)


def framework(peer: ModuleType, rules: TimedRules, task: Task, seed: int, seconds: float) -> Run:
    """Run a framework from the same start with the same stream of random numbers."""
    state = start(task.space, replace(task.settings, seed=seed), task.benchmark.chromosome)
    genes = np.array(state.parent.genes).ravel()
    began = time.perf_counter()
    rules.begin(seconds)
    try:
        peer.run(rules, load_stream(state.random_state), genes, task.settings.one_in, ENDLESS)
    except Finished:
        reached = time.perf_counter() - began
    return Run(rules.best, reached if rules.best <= rules.target else math.inf)


def report(name: str, runs: list[Run], optimum: float) -> None:
    """Print the hits, the median time to the optimum over all runs, and the gaps."""
    hits = sum(run.reached < math.inf for run in runs)
    median = float(np.median([run.reached for run in runs]))
    gaps = [run.value / optimum - 1 for run in runs]
    when = f"{median:.3f}" if median < math.inf else "-"
    cells = f"{hits} of {len(runs)} | {when} | {np.median(gaps):.2%} | {max(gaps):.2%}"
    print(f"| {name} | {cells} |", flush=True)


def part(task: Task, title: str, said: argparse.Namespace) -> None:
    """Print the tables of one part."""
    proof, found = exact(task, said.limit)
    optimum = proof.designs[0].value
    target = optimum * (1 + PROOF)
    rules = TimedRules(task.space, task.rules, target)
    searches: dict[str, Callable[[int, float], Run]] = {
        "grasp_xl, genetic": lambda seed, seconds: genetic(task, seed, seconds, target)
    }
    for name, peer in PEERS.items():
        searches[name] = lambda seed, seconds, peer=peer: framework(  # type: ignore[misc]
            peer, rules, task, seed, seconds
        )
    for seconds in (proof.seconds, said.seconds):
        print(f"\n{title}, {seconds:.2f} s for each run\n")
        print(
            "| | optimum reached | median s | median gap | largest gap |\n|---|---:|---:|---:|---:|"
        )
        end = f"proved in {proof.seconds:.2f} s" if proof.gap == 0.0 else f"{proof.gap:.1%} open"
        print(f"| grasp_xl, exact | {end} | {found:.3f} | 0.00% | 0.00% |")
        for name, run in searches.items():
            report(name, [run(seed, seconds) for seed in range(1, said.seeds + 1)], optimum)


def main() -> None:
    """Print two tables a part."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    add_arguments(parser, limit=20.0)
    parser.add_argument("--seconds", type=float, default=5.0, help="of the second table")
    parser.add_argument("--seeds", type=int, default=5)
    said = parser.parse_args()
    load_exact_search()
    for file in said.files:
        task = read(file)
        genetic(task, 1, 0.1, 0.0)  # compiled code is loaded before the clock starts
        part(task, file.stem, said)


if __name__ == "__main__":
    main()
