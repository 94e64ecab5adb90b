"""Time to the proved optimum of the panel, by footprints and by elements per grasp.

``python -m benchmarks.exact_scaling`` prints the three tables of README.md: pitches (mm) with the
panel's own weight; numbers of elements at one pitch, half of them cups; and the pitches again where
five cups and five magnets are needed and ten of each allowed.  An option without a word after it
leaves its table out: ``--pitches 40 30 --elements --ten``.
"""

from __future__ import annotations

import argparse

from benchmarks.spaces import PANEL_PITCHES_MM, needing, panel, settled, with_counts
from grasp_xl.search.exact import ExactSettings, solve
from grasp_xl.search.warm import load_exact_search
from grasp_xl.task import Task

ELEMENTS = (2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12)
ELEMENTS_PITCH_MM = 40.0

TEN_PITCHES_MM = (40.0, 30.0, 20.0)
TEN = 10


def row(first: str, task: Task, limit: float) -> None:
    """Prove one optimum and print its row; the search knows no grasp when it begins."""
    proof = solve(task.space, task.rules, ExactSettings(time_limit_s=limit))
    cups, magnets = (kind.total for kind in task.space.kinds)
    best = proof.designs[0] if proof.designs else None
    value = f"{best.value:.6f}" if best else "-"
    counts = " + ".join(str(count) for count in best.chromosome.counts) if best else "-"
    print(
        f"| {first} | {cups} | {magnets} | {proof.status} | {proof.seconds:.2f} "
        f"| {proof.nodes:,} | {value} | {counts} | {proof.gap or 0.0:.2%} |",
        flush=True,
    )


def header(first: str) -> None:
    """Print the first two lines of a table."""
    print(f"\n| {first} | cups | magnets | status | seconds | nodes | best | its elements | gap |")
    print("|---:|---:|---:|---|---:|---:|---:|---:|---:|")


def main() -> None:
    """Print both tables."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--pitches", type=float, nargs="*", default=PANEL_PITCHES_MM)
    parser.add_argument("--elements", type=int, nargs="*", default=ELEMENTS)
    parser.add_argument("--ten", type=float, nargs="*", default=TEN_PITCHES_MM)
    parser.add_argument("--limit", type=float, default=60.0, help="seconds of a proof")
    said = parser.parse_args()
    load_exact_search()
    if said.pitches:
        header("pitch mm")
    for pitch in said.pitches:
        row(f"{pitch:g}", settled(panel(pitch)), said.limit)
    if said.elements:
        header("elements")
    for elements in said.elements:
        cups = (elements + 1) // 2
        task = with_counts(panel(ELEMENTS_PITCH_MM), cups, elements - cups)
        row(f"{elements}", task, said.limit)
    if said.ten:
        header("ten of twenty, pitch mm")
    for pitch in said.ten:
        row(f"{pitch:g}", needing(panel(pitch, TEN), TEN // 2, TEN // 2), said.limit)


if __name__ == "__main__":
    main()
