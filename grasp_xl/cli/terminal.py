"""The terminal of a command: lines on standard output, warnings on standard error."""

from __future__ import annotations

from collections.abc import Sequence

from rich.console import Console

from grasp_xl.errors import Problem


class Terminal(Console):
    """A console that leaves a pipe that nobody reads any more to ``cli.main``."""

    def on_broken_pipe(self) -> None:
        """Raise what was raised."""
        raise  # noqa: PLE0704 (rich calls this while it handles BrokenPipeError)


OUT = Terminal(soft_wrap=True, highlight=False)
ERR = Terminal(stderr=True, soft_wrap=True, highlight=False)


def line(text: str) -> None:
    """Print one line."""
    OUT.print(text, markup=False)


def warnings(found: Sequence[Problem]) -> None:
    """Print warnings on standard error."""
    for warning in found:
        ERR.print(f"Warning: {warning}", style="yellow", markup=False)
