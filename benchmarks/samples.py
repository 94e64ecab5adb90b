"""The sample parts in ``workbooks/``, each with its designer's grasp and its proof."""

from __future__ import annotations

import argparse
from pathlib import Path

from benchmarks.processes import ROOT
from grasp_xl.commands.preparing import prepare
from grasp_xl.search.exact import ExactSettings, Proof, solve
from grasp_xl.task import Parameters, Task
from grasp_xl.workbook.book import read_book

SAMPLES = [
    ROOT / "workbooks" / f"{part}.xlsx"
    for part in ("bracket", "door_frame", "panel", "tunnel_cover")
]


def add_arguments(parser: argparse.ArgumentParser, limit: float) -> None:
    """Let a person name other workbooks, and how long a proof may take (s)."""
    parser.add_argument("files", type=Path, nargs="*", default=SAMPLES, help="workbooks")
    parser.add_argument("--limit", type=float, default=limit, help="seconds of a proof")


def read(file: Path) -> Task:
    """Read a workbook as the commands do."""
    return prepare(read_book(file), Parameters())


def proved(task: Task, limit: float) -> Proof:
    """Prove the optimum within a limit (s); the search knows no grasp when it begins."""
    return solve(task.space, task.rules, ExactSettings(time_limit_s=limit))
