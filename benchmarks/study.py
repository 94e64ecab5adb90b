"""How a study's time grows with its workers, what a Dask scheduler costs, and its memory.

``python -m benchmarks.study`` prints the tables of README.md: the thesis's protocol on the four
sample parts as a whole command, the runs alone on one and two threads and on a Dask cluster of one
and two processes on this machine, what the scheduler adds to a run, and the peak memory of a study
of many runs (``--many``).
"""

from __future__ import annotations

import argparse
import dataclasses
import statistics
import tempfile
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path

from benchmarks.processes import python
from benchmarks.samples import SAMPLES, read
from grasp_xl.search.stop import Interrupt
from grasp_xl.study.cluster import run_on_cluster
from grasp_xl.study.execution import Execute, run_here
from grasp_xl.study.plan import SCENARIOS, Case, Plan
from grasp_xl.study.trial import Work

SHORT_GENERATIONS, SHORT_RUNS = 1, 250
"""Of the runs that show what the scheduler adds to each."""


def plan_of(runs: int) -> Plan:
    """Return a study of the sample parts with the thesis's parameters."""
    cases = [Case(row, 0, file.stem, (), read(file)) for row, file in enumerate(SAMPLES, 1)]
    return Plan(tuple(cases), SCENARIOS, runs, 1)


def seconds_of(execute: Execute, plan: Plan, generations: int | None = None) -> float:
    """Return how long the runs of a plan take."""
    works = [Work.of(case.task) for case in plan.cases]
    if generations is not None:
        works = [dataclasses.replace(work, generations=generations) for work in works]
    done: dict[str, float] = {}
    began = time.perf_counter()
    execute(
        works,
        plan.trials(),
        lambda trial, record: done.__setitem__(trial.label, record.seconds),
        Interrupt(),
    )
    if len(done) < len(plan):
        raise RuntimeError(f"{len(done)} of {len(plan)} runs are done")
    return time.perf_counter() - began


def on_cluster(workers: int, measure: Callable[[Execute], float]) -> float:
    """Measure on a Dask cluster of so many processes, one thread each; compiled code is loaded."""
    from distributed import LocalCluster

    with LocalCluster(
        n_workers=workers, threads_per_worker=1, processes=True, dashboard_address=None
    ) as cluster:
        execute = partial(run_on_cluster, cluster.scheduler_address)
        seconds_of(execute, plan_of(2 * workers), 100)
        return measure(execute)


def scaling(runs: int) -> None:
    """Print how long the runs take on one and two workers."""
    plan = plan_of(runs)
    seconds_of(run_here, plan_of(1), 100)
    print(f"\n{len(plan)} runs of 50,000 generations\n")
    print("| where | workers | s | one thread / it |\n|---|---:|---:|---:|")
    one = 0.0
    for workers in (1, 2):
        taken = seconds_of(partial(run_here, workers=workers), plan)
        one = one or taken
        print(f"| threads | {workers} | {taken:.2f} | {one / taken:.2f} |", flush=True)
    for workers in (1, 2):
        taken = on_cluster(workers, lambda execute: seconds_of(execute, plan))
        print(f"| Dask processes | {workers} | {taken:.2f} | {one / taken:.2f} |", flush=True)


def overhead() -> None:
    """Print what the scheduler adds to a run: runs of one generation, on one process."""
    plan = plan_of(SHORT_RUNS)
    here = seconds_of(partial(run_here, workers=1), plan, SHORT_GENERATIONS)
    there = on_cluster(1, lambda execute: seconds_of(execute, plan, SHORT_GENERATIONS))
    added = 1000 * (there - here) / len(plan)
    print(f"\nA run of one generation: {1000 * here / len(plan):.2f} ms in a thread here, ", end="")
    print(f"{1000 * there / len(plan):.2f} ms on one Dask process: {added:.2f} ms more.")


def whole(repeats: int) -> None:
    """Print how long the thesis's protocol takes as a command, proofs and workbook included."""
    with tempfile.TemporaryDirectory() as folder:
        words = ("-m", "grasp_xl", "study", *map(str, SAMPLES), "--force", "--quiet")
        for more in ((), ("--no-prove",)):
            runs = [
                python(*words, *more, "-o", str(Path(folder) / "s.xlsx")) for _ in range(repeats)
            ]
            taken = statistics.median(run.seconds for run in runs)
            print(f"4 parts x 2 x 2 runs{' ' + more[0] if more else ''}: {taken:.2f} s", flush=True)


def memory(runs: int) -> None:
    """Print the peak memory of a study of many runs, written workbook included."""
    with tempfile.TemporaryDirectory() as folder:
        each = str(runs // 2)
        words = (
            "-m",
            "grasp_xl",
            "study",
            str(SAMPLES[-1]),
            "--quiet",
            "--no-prove",
            "--runs",
            each,
        )
        run = python(*words, "-o", str(Path(folder) / "s.xlsx"))
    print(f"{runs:,} runs of one part: {run.seconds:.0f} s, {run.peak_mb:.0f} MB", flush=True)


def main() -> None:
    """Print all tables."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--runs", type=int, default=25, help="of each part and start")
    parser.add_argument("--many", type=int, default=10_000, help="runs whose memory is measured")
    said = parser.parse_args()
    whole(3)
    scaling(said.runs)
    overhead()
    if said.many:
        memory(said.many)


if __name__ == "__main__":
    main()
