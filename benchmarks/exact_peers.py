"""Time to proof of our exact search, and of general solvers with a model of the same problem.

``python -m benchmarks.exact_peers`` prints the tables of README.md.  The instances grow; a solver
that does not prove one within the limit is not asked for larger ones.  Where a solver finishes, its
optimum must be ours.
"""

from __future__ import annotations

import argparse
import statistics
import time
from collections.abc import Callable
from dataclasses import dataclass

from benchmarks.exact_models import cp_sat, highs, scip
from benchmarks.exact_models.proof import TOLERANCE, Minimise, PeerProof, prove
from benchmarks.exact_models.small import thinned
from benchmarks.spaces import door_frame, panel, settled
from grasp_xl.search.exact import Proof, solve
from grasp_xl.search.warm import load_exact_search
from grasp_xl.space import OptionSpace
from grasp_xl.task import Task

PEERS: dict[str, Minimise] = {
    "CP-SAT": cp_sat.minimise,
    "HiGHS": highs.minimise,
    "SCIP": scip.minimise,
}
SIZES = (6, 8, 12, 16, 24, 32, 48)
"""Footprints of each kind."""

FAMILIES: dict[str, Callable[[int], OptionSpace]] = {
    "Door frame, three elements and more": lambda size: door_frame(size, size),
    "Panel, eight elements and more": lambda size: thinned(panel(40.0), size),
}
REPEATS = 5
"""Of ours, which takes milliseconds; the median counts."""


@dataclass(frozen=True, slots=True)
class Ours:
    """Our proof, and the median of its times (s)."""

    proof: Proof
    seconds: float


def ours(task: Task) -> Ours:
    """Prove the optimum a few times; the search knows no grasp when it begins."""
    proofs = [solve(task.space, task.rules) for _ in range(REPEATS)]
    return Ours(proofs[0], statistics.median(proof.seconds for proof in proofs))


def check(name: str, theirs: PeerProof, mine: Ours, task: Task) -> None:
    """Hold a solver's optimum to ours, within its tolerance."""
    value = mine.proof.designs[0].value
    accuracy = 2 * TOLERANCE * max(task.rules.baseline, value)
    if theirs.proved and (theirs.best is None or abs(theirs.best.value - value) > accuracy):
        raise AssertionError(f"{name} proved {theirs.best}, we {value}")


def cell(theirs: PeerProof, mine: Ours) -> str:
    """Return seconds and ratio, or how far from the optimum the time ended."""
    if theirs.proved:
        return f"{theirs.seconds:.2f} | {theirs.seconds / mine.seconds:,.0f}"
    value = mine.proof.designs[0].value
    far = f"{theirs.best.value / value - 1:.1%} above" if theirs.best else "no grasp"
    return f"not proved ({far}) | > {theirs.seconds / mine.seconds:,.0f}"


def family(make: Callable[[int], OptionSpace], said: argparse.Namespace) -> None:
    """Print a row for each size."""
    columns = " | ".join(f"{name} s | / ours" for name in said.peers)
    print(f"| of each kind | optimum | ours s | {columns} |")
    print("|---:" * (3 + 2 * len(said.peers)) + "|")
    able = set(said.peers)
    for size in said.sizes:
        task = settled(make(size))
        mine = ours(task)
        cells = []
        for name in said.peers:
            if name not in able:
                cells.append("- | -")
                continue
            theirs = prove(task.space, task.rules, PEERS[name], said.limit)
            check(name, theirs, mine, task)
            able -= set() if theirs.proved else {name}
            cells.append(cell(theirs, mine))
        value = mine.proof.designs[0].value
        row = " | ".join([f"{size}", f"{value:.6f}", f"{mine.seconds:.4f}", *cells])
        print(f"| {row} |", flush=True)


def main() -> None:
    """Print a table for each family of instances."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--limit", type=float, default=600.0, help="seconds a solver and instance")
    parser.add_argument("--sizes", type=int, nargs="+", default=SIZES)
    parser.add_argument("--peers", nargs="+", choices=PEERS, default=list(PEERS))
    said = parser.parse_args()
    load_exact_search()
    tiny = settled(door_frame(3, 3))
    for name in said.peers:
        prove(tiny.space, tiny.rules, PEERS[name], said.limit)
    for title, make in FAMILIES.items():
        print(f"\n{title}; limit {said.limit:g} s\n")
        began = time.perf_counter()
        family(make, said)
        print(f"\n({time.perf_counter() - began:.0f} s)", flush=True)


if __name__ == "__main__":
    main()
