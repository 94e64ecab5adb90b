"""How often the genetic search reaches the proved optimum, and how far from it the others end.

``python -m benchmarks.genetic_hits`` prints the table of docs/exact.md: 100 runs of 50,000
generations for each sample part and each start, with the seeds 1 to 100.
"""

from __future__ import annotations

import argparse
from dataclasses import replace

import numpy as np

from benchmarks.samples import add_arguments, proved, read
from grasp_xl.search.exact import PROOF
from grasp_xl.search.genetic import search
from grasp_xl.search.stop import Generations
from grasp_xl.search.warm import load_exact_search
from grasp_xl.space import FloatArray
from grasp_xl.task import Task

STARTS = {"designer's": True, "random": False}
QUARTERS = (0, 25, 50, 75, 100)


def runs(task: Task, seeds: int, generations: int, *, user_start: bool) -> FloatArray:
    """Return the best value of each run, ``(seeds,)``."""
    values = []
    for seed in range(1, seeds + 1):
        settings = replace(task.settings, seed=seed, user_start=user_start)
        stop = [Generations(generations)]
        run = search(task.space, task.rules, settings, task.benchmark.chromosome, stop)
        values.append(run.best.value if run.best else np.inf)
    return np.array(values)


def main() -> None:
    """Print a row for each part and start."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    add_arguments(parser, limit=60.0)
    parser.add_argument("--seeds", type=int, default=100)
    parser.add_argument("--generations", type=int, default=50_000)
    said = parser.parse_args()
    load_exact_search()
    print("| part | proof | value | start | hits | least | quartile | median | quartile | most |")
    print("|---|---|---:|---|---:|---:|---:|---:|---:|---:|")
    for file in said.files:
        task = read(file)
        proof = proved(task, said.limit)
        value = proof.designs[0].value
        for start, user_start in STARTS.items():
            values = runs(task, said.seeds, said.generations, user_start=user_start)
            hits = int((values <= value * (1 + PROOF)).sum())
            gaps = " | ".join(f"{gap:.2%}" for gap in np.percentile(values / value - 1, QUARTERS))
            state = "proved" if proof.status == "optimal" else f"bound {proof.bound:.6f}"
            print(
                f"| {file.stem} | {state} | {value:.6f} | {start} | {hits} | {gaps} |", flush=True
            )


if __name__ == "__main__":
    main()
