"""How time and memory grow with the footprints and with the generations.

``python -m benchmarks.scaling`` prints the tables of README.md.  Everything runs in processes of
its own; peak memory is that of a whole ``grasp-xl run``: read, search, write.
"""

from __future__ import annotations

import argparse
import json
import statistics
import tempfile
from pathlib import Path

from benchmarks.processes import python

FOOTPRINTS = (100, 1_000, 10_000, 50_000)
GENERATIONS = (1_000, 10_000, 100_000, 1_000_000)
FIXED_FOOTPRINTS = 1_000


def export(folder: Path, footprints: int) -> Path:
    """Write an export of so many footprints."""
    file = folder / f"{footprints}.xlsx"
    python("-m", "benchmarks.spaces", str(footprints), str(file))
    return file


def stages(file: Path, generations: int, repeats: int) -> dict[str, float]:
    """Return the median seconds of read, settle, search and write."""
    counts = ("--generations", str(generations), "--repeats", str(repeats))
    output = python("-m", "benchmarks.stages", str(file), *counts).output
    seconds: dict[str, float] = json.loads(output.splitlines()[-1])
    return seconds


def whole_runs(file: Path, generations: int, repeats: int) -> tuple[float, float]:
    """Return the median seconds and peak memory (MB) of ``grasp-xl run``, without its proof."""
    target = file.with_suffix(".out.xlsx")
    options = ("--seed", "1", "--generations", str(generations), "--force", "--quiet", "--no-prove")
    command = ("-m", "grasp_xl", "run", str(file), "-o", str(target), *options)
    runs = [python(*command) for _ in range(repeats)]
    seconds = statistics.median(run.seconds for run in runs)
    return seconds, statistics.median(run.peak_mb for run in runs)


def by_footprints(folder: Path, generations: int, repeats: int) -> None:
    """Print one row a size of the option space."""
    print(f"\n{generations:,} generations, by footprints\n")
    print("| footprints | read s | settle s | search s | write s | whole run s | peak MB |")
    print("|---:|---:|---:|---:|---:|---:|---:|")
    for footprints in FOOTPRINTS:
        file = export(folder, footprints)
        spans = stages(file, generations, repeats)
        seconds, peak = whole_runs(file, generations, repeats)
        cells = " | ".join(f"{span:.3f}" for span in spans.values())
        print(f"| {footprints:,} | {cells} | {seconds:.2f} | {peak:.0f} |", flush=True)


def by_generations(folder: Path, repeats: int) -> None:
    """Print one row a number of generations."""
    print(f"\n{FIXED_FOOTPRINTS:,} footprints, by generations\n")
    print("| generations | search s | us a generation | write s |")
    print("|---:|---:|---:|---:|")
    file = export(folder, FIXED_FOOTPRINTS)
    for generations in GENERATIONS:
        spans = stages(file, generations, repeats)
        each = 1e6 * spans["search"] / generations
        cells = f"{spans['search']:.4f} | {each:.2f} | {spans['write']:.3f}"
        print(f"| {generations:,} | {cells} |", flush=True)


def main() -> None:
    """Measure and print both tables."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--generations", type=int, default=50_000)
    parser.add_argument("--repeats", type=int, default=5)
    said = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        whole_runs(export(Path(folder), 100), 1, 1)  # warm-up: compiled code and byte code exist
        by_footprints(Path(folder), said.generations, said.repeats)
        by_generations(Path(folder), said.repeats)


if __name__ == "__main__":
    main()
