"""Size of the full workbook, and the time that writing, opening and recalculating it take.

``python -m benchmarks.workbook`` prints the table of README.md; opening needs LibreOffice.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

from benchmarks.scaling import export
from benchmarks.spaces import DOOR_FRAME
from benchmarks.stages import one_pass
from tests.office import Office

FOOTPRINTS = (sum(DOOR_FRAME), 10_000)
GENERATIONS = 50_000


def seconds(work: Callable[[], object]) -> float:
    """Return how long some work takes."""
    began = time.perf_counter()
    work()
    return time.perf_counter() - began


def measure(office: Office, folder: Path, footprints: int, repeats: int) -> str:
    """Return one row of the table; times are the least of all repeats."""
    file, target = export(folder, footprints), folder / f"{footprints}.out.xlsx"
    passes = [one_pass(file, target, GENERATIONS) for _ in range(1 + repeats)]  # one to warm up
    opened, calculated = [], []
    for _ in range(repeats):
        opened.append(seconds(lambda: office.open(target)))
        calculated.append(seconds(office.recalculate))
    times = (min(each["write"] for each in passes), min(opened), min(calculated))
    cells = " | ".join(f"{least:.2f}" for least in times)
    return f"| {footprints:,} | {target.stat().st_size / 1000:,.0f} | {cells} |"


def main() -> None:
    """Measure and print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--repeats", type=int, default=5)
    said = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        office = Office(folder / "profile")
        try:
            print("| footprints | size kB | write s | open s | recalculate s |")
            print("|---:|---:|---:|---:|---:|")
            for footprints in FOOTPRINTS:
                print(measure(office, folder, footprints, said.repeats), flush=True)
        finally:
            office.end()


if __name__ == "__main__":
    main()
