"""The buttons of an open workbook.

Excel waits for the Python that a button starts, and could show no progress and press no other
button meanwhile.  So each button but ``Stop`` starts a worker, a process of its own, and returns.
"""

from __future__ import annotations

import os
import subprocess
import sys

from grasp_xl.live.excel import calling_book, tell
from grasp_xl.live.running import BusyError, Running

IDLE = "No search is at work on this workbook."


def check() -> None:
    """Validate the open workbook, and say what any grasp of it can reach."""
    _start("check")


def run() -> None:
    """Run the genetic search on the open workbook, prove how good it is, fill its sheets."""
    _start("run")


def prove() -> None:
    """Find the best grasp of all, prove it, and show it in the open workbook."""
    _start("prove")


def stop() -> None:
    """End the search at work on the open workbook; the best so far is kept."""
    book = calling_book()
    running = Running.on(book)
    if running.is_alive:
        running.ask_to_stop()
    else:
        tell(book, IDLE)


main = run
"""What xlwings' "Run main" looks for."""


def _start(command: str) -> None:
    """Start a worker that finds the workbook as this process did: by the same arguments."""
    book = calling_book()
    try:
        claim = Running.on(book).claim()
    except BusyError as busy:
        tell(book, busy.message)
        return
    # -P: nothing is imported from the folder that Excel starts in
    words = [sys.executable, "-P", "-m", "grasp_xl.live", command, claim, *sys.argv[1:]]
    nothing = subprocess.DEVNULL
    apart = {"creationflags": _APART} if os.name == "nt" else {"start_new_session": True}
    subprocess.Popen(words, stdin=nothing, stdout=nothing, stderr=nothing, **apart)  # noqa: S603 (ourselves)


_APART = getattr(subprocess, "CREATE_NO_WINDOW", 0) | getattr(
    subprocess, "CREATE_NEW_PROCESS_GROUP", 0
)
