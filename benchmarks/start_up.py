"""How long the program takes to start, against importing the libraries that it stands on.

``python -m benchmarks.start_up`` prints the tables of README.md: ``--help``, a whole run of 50,000
generations with its workbook, without and with the proof that follows it by default, and the first
run of all, with nothing compiled and without the proof.
"""

from __future__ import annotations

import argparse
import os
import statistics
import tempfile
from collections.abc import Sequence
from pathlib import Path

from benchmarks.processes import ROOT, python

IMPORTS = "import numpy, pandas, openpyxl, xlsxwriter, numba, shapely"
HIDE_SCIPY = "import sys; sys.modules['scipy'] = None"
"""Start-up code for an environment like a user's: scipy is here for pymoo alone, and numba imports
a part of it where it finds it."""

FOOTPRINTS = 747
"""As many as the door frame of 228 x 519 has."""


def run_command(folder: Path) -> list[str]:
    """Return the arguments of a whole run, after writing its export."""
    file = folder / "door_frame.xlsx"
    python("-m", "benchmarks.spaces", str(FOOTPRINTS), str(file))
    target = str(folder / "out.xlsx")
    options = ["--seed", "1", "--generations", "50000", "--force", "--quiet"]
    return ["-m", "grasp_xl", "run", str(file), "-o", target, *options]


def without_scipy(folder: Path) -> dict[str, str]:
    """Return environment variables under which Python finds no scipy."""
    (folder / "sitecustomize.py").write_text(HIDE_SCIPY)
    return {"PYTHONPATH": os.pathsep.join((str(folder), str(ROOT)))}


def interleaved(
    commands: dict[str, Sequence[str]], env: dict[str, str], repeats: int
) -> dict[str, list[float]]:
    """Time the commands in turn, so that a busy moment of the machine hits all of them."""
    for arguments in commands.values():
        python(*arguments, env=env)
    seconds: dict[str, list[float]] = {name: [] for name in commands}
    for _ in range(repeats):
        for name, arguments in commands.items():
            seconds[name].append(python(*arguments, env=env).seconds)
    return seconds


def first_runs(run: Sequence[str], env: dict[str, str], repeats: int) -> list[float]:
    """Time runs with an empty cache each: the kernels are compiled first."""
    seconds = []
    for _ in range(repeats):
        with tempfile.TemporaryDirectory() as cache:
            seconds.append(python(*run, env={**env, "XDG_CACHE_HOME": cache}).seconds)
    return seconds


def report(seconds: dict[str, list[float]], base: str) -> None:
    """Print medians, ranges, and the median ratio to the base within each round."""
    print("| command | median s | lowest to highest | ratio to the imports |")
    print("|---|---:|---:|---:|")
    for name, times in seconds.items():
        ratio = statistics.median(t / b for t, b in zip(times, seconds[base], strict=True))
        spread = f"{min(times):.2f} to {max(times):.2f}"
        print(f"| {name} | {statistics.median(times):.2f} | {spread} | {ratio:.2f} |")


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--repeats", type=int, default=11)
    parser.add_argument("--first-runs", type=int, default=3)
    said = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        proved = run_command(Path(folder))
        run = [*proved, "--no-prove"]
        commands: dict[str, Sequence[str]] = {
            "the imports": ("-c", IMPORTS),
            "grasp-xl --help": ("-m", "grasp_xl", "--help"),
            "grasp-xl run --no-prove": run,
            "grasp-xl run": proved,
        }
        hidden = without_scipy(Path(folder))
        for title, env in (("As a user has it, without scipy", hidden), ("With scipy", {})):
            print(f"\n{title}\n")
            report(interleaved(commands, env, said.repeats), "the imports")
        firsts = first_runs(run, hidden, said.first_runs)
    spread = f"{min(firsts):.1f} to {max(firsts):.1f}"
    print(f"\nFirst run, nothing compiled: median {statistics.median(firsts):.1f} s ({spread}).")


if __name__ == "__main__":
    main()
