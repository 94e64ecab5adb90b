"""Time and peak memory of a command.

Imports little: Linux counts the parent's size as a floor of the child's peak.
"""

from __future__ import annotations

import os
import subprocess
import sys
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
KIBIBYTES_PER_MB = 1e6 / 1024
"""Linux reports the peak in units of 1,024 bytes."""


@dataclass(frozen=True)
class Measured:
    """Wall-clock time (s), peak resident memory (MB of 1e6 bytes), and standard output."""

    seconds: float
    peak_mb: float
    output: str


def python(*arguments: str, env: Mapping[str, str] | None = None) -> Measured:
    """Run this Python with some arguments in the checkout and measure it.

    Raises
    ------
    RuntimeError
        If it fails.
    """
    command = [sys.executable, *arguments]
    return measured(command, {**environment(), **(env or {})})


def environment() -> dict[str, str]:
    """Return the usual environment, with byte code kept as in an installed package."""
    env = {key: text for key, text in os.environ.items() if key != "PYTHONDONTWRITEBYTECODE"}
    return {**env, "PYTHONPATH": str(ROOT)}


def measured(command: Sequence[str], env: Mapping[str, str]) -> Measured:
    """Run a command and measure it."""
    began = time.perf_counter()
    with subprocess.Popen(
        command, env=env, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
    ) as process:
        output = process.stdout.read() if process.stdout else ""
        _, status, used = os.wait4(process.pid, 0)
        seconds = time.perf_counter() - began
        process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        raise RuntimeError(f"{' '.join(command)} ended with {process.returncode}: {output}")
    return Measured(seconds, used.ru_maxrss / KIBIBYTES_PER_MB, output)
