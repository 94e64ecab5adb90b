"""Time the stages of a run on one file: read, settle, search, write.  ``scaling.py`` calls this.

``python -m benchmarks.stages FILE.xlsx --generations 50000 --repeats 5`` prints the medians (s) as
one JSON object.  The first pass is a warm-up and is not counted.
"""

from __future__ import annotations

import argparse
import json
import statistics
import tempfile
import time
from datetime import datetime
from itertools import pairwise
from pathlib import Path

from grasp_xl.commands.preparing import prepare
from grasp_xl.search.genetic import search
from grasp_xl.search.stop import Generations
from grasp_xl.task import Parameters
from grasp_xl.workbook.book import read_book
from grasp_xl.workbook.run_log import Origin
from grasp_xl.workbook.saving import save
from grasp_xl.workbook.writing import full_workbook

STAGES = ("read", "settle", "search", "write")


def one_pass(file: Path, target: Path, generations: int) -> dict[str, float]:
    """Run once and return the seconds of each stage."""
    clock = [time.perf_counter()]
    book = read_book(file)
    clock.append(time.perf_counter())
    task = prepare(book, Parameters())
    clock.append(time.perf_counter())
    stop = [Generations(generations)]
    result = search(task.space, task.rules, task.settings, task.benchmark.chromosome, stop)
    clock.append(time.perf_counter())
    now = datetime.now()  # noqa: DTZ005 (as the program writes it)
    written = full_workbook(task, result, Origin(file.name, "", now, now))
    save(written.content, target)
    clock.append(time.perf_counter())
    return dict(zip(STAGES, (b - a for a, b in pairwise(clock)), strict=True))


def main() -> None:
    """Print the medians."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("file", type=Path)
    parser.add_argument("--generations", type=int, default=50_000)
    parser.add_argument("--repeats", type=int, default=5)
    said = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        target = Path(folder) / "out.xlsx"
        passes = [one_pass(said.file, target, said.generations) for _ in range(said.repeats + 1)]
    counted = passes[1:]
    print(json.dumps({name: statistics.median(p[name] for p in counted) for name in STAGES}))


if __name__ == "__main__":
    main()
