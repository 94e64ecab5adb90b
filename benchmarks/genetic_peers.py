"""Generations a second of our compiled genetic search, and of DEAP, pymoo and PyGAD.

All run the same algorithm on the same option space: the script first holds every peer's criteria to
ours (1e-9) and every peer's course to ours (gene for gene), then times all of them in turn.
``python -m benchmarks.genetic_peers`` prints the tables of README.md.
"""

from __future__ import annotations

import argparse
import statistics
import time
from collections.abc import Callable
from types import ModuleType

import numpy as np

from benchmarks.peers import deap_ga, pygad_ga, pymoo_ga
from benchmarks.peers.numpy_rules import NumpyRules
from benchmarks.peers.plain_rules import PlainRules
from benchmarks.spaces import DOOR_FRAME, door_frame, settled
from grasp_xl.grasp import evaluate
from grasp_xl.search.genetic import search, start
from grasp_xl.search.mutation import random_chromosome
from grasp_xl.search.result import Result, load_stream
from grasp_xl.search.stop import Generations
from grasp_xl.space import IntArray
from grasp_xl.task import Task

PEERS: dict[str, ModuleType] = {"DEAP": deap_ga, "pymoo": pymoo_ga, "PyGAD": pygad_ga}
EVALUATIONS = {"tabulated": NumpyRules, "plain": PlainRules}
TOLERANCE = 1e-9
CHECKED_GRASPS = 500
CHECKED_GENERATIONS = 1_000


def ours(task: Task, generations: int) -> Result:
    """Run our genetic search."""
    stop = [Generations(generations)]
    return search(task.space, task.rules, task.settings, task.benchmark.chromosome, stop)


def theirs(peer: ModuleType, rules: NumpyRules, task: Task, generations: int) -> IntArray:
    """Run a peer from the same start with the same stream; return its last parent."""
    state = start(task.space, task.settings, task.benchmark.chromosome)
    stream = load_stream(state.random_state)
    genes = np.array(state.parent.genes).ravel()
    parent: IntArray = peer.run(rules, stream, genes, task.settings.one_in, generations)
    return parent


def check_criteria(rules: NumpyRules, task: Task) -> None:
    """Hold NumPy's clearance, FoS and value to ours on random grasps."""
    rng = np.random.default_rng(2024)
    for _ in range(CHECKED_GRASPS):
        grasp = evaluate(task.space, task.rules, random_chromosome(task.space, rng))
        genes = grasp.chromosome.genes.ravel()
        value = rules.value(genes)
        if (rules.is_clear(genes) and np.isfinite(value)) != grasp.feasible:
            raise AssertionError(f"feasibility of {genes} differs")
        if np.isfinite(value) and abs(value - grasp.value) > TOLERANCE * grasp.value:
            raise AssertionError(f"{value} is not {grasp.value} for {genes}")


def check_course(name: str, rules: NumpyRules, task: Task) -> None:
    """Hold a peer's parent after some generations to ours, gene for gene."""
    expected = ours(task, CHECKED_GENERATIONS).state.parent.genes.ravel()
    found = theirs(PEERS[name], rules, task, CHECKED_GENERATIONS)
    if not np.array_equal(found, expected):
        raise AssertionError(f"{name} went elsewhere: {found} instead of {expected}")


def rate(run: Callable[[], object], generations: int) -> float:
    """Return the generations a second of a run."""
    began = time.perf_counter()
    run()
    return generations / (time.perf_counter() - began)


def one_round(task: Task, rules: NumpyRules, said: argparse.Namespace) -> dict[str, float]:
    """Time all, one after another."""
    rates = {"grasp_xl": rate(lambda: ours(task, said.ours), said.ours)}
    for name, peer in PEERS.items():
        run = lambda peer=peer: theirs(peer, rules, task, said.theirs)  # noqa: E731
        rates[name] = rate(run, said.theirs)
    return rates


def evaluation_us(rules: NumpyRules, task: Task) -> float:
    """Return the time of one NumPy evaluation of the benchmark grasp (microseconds)."""
    genes = np.array(task.benchmark.chromosome.genes).ravel()
    return 1e6 / rate(lambda: [rules.value(genes) for _ in range(2_000)], 2_000)


def report(title: str, rounds: list[dict[str, float]]) -> None:
    """Print medians, ranges and the median of the ratios within each round."""
    print(f"\n{title}\n\n| | generations/s, median | lowest to highest | grasp_xl / it |")
    print("|---|---:|---:|---:|")
    for name in rounds[0]:
        rates = [rates[name] for rates in rounds]
        ratio = statistics.median(rates["grasp_xl"] / rates[name] for rates in rounds)
        spread = f"{min(rates):,.0f} to {max(rates):,.0f}"
        print(f"| {name} | {statistics.median(rates):,.0f} | {spread} | {ratio:,.0f} |")


def main() -> None:
    """Check, then measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--ours", type=int, default=500_000, help="our generations a repeat")
    parser.add_argument("--theirs", type=int, default=3_000, help="a peer's generations a repeat")
    parser.add_argument("--repeats", type=int, default=7)
    said = parser.parse_args()
    task = settled(door_frame(*DOOR_FRAME))
    for title, layout in EVALUATIONS.items():
        rules = layout(task.space, task.rules)
        check_criteria(rules, task)
        for name in PEERS:
            check_course(name, rules, task)
        cost = evaluation_us(rules, task)
        rounds = [one_round(task, rules, said) for _ in range(said.repeats)]
        report(f"Peers with the {title} NumPy evaluation ({cost:.0f} us a grasp)", rounds)


if __name__ == "__main__":
    main()
