"""Stop rules: small objects that say how many generations may run before they are asked again.

Several combine by :func:`first_to_stop`.  The search also asks after every improvement of the best
grasp, so that rules on the best value act at the exact generation.
"""

from __future__ import annotations

import signal
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from types import FrameType
from typing import Literal, Protocol

StopReason = Literal["generations", "stall", "target", "time", "interrupted"]

Stop = Callable[[], bool]
"""Asked many times a second; True ends a search with what it knows by then."""


def never() -> bool:
    """Let a search go on to its end."""
    return False


CHUNK = 4096
"""Most generations between two looks at the clock: a few milliseconds."""


@dataclass(frozen=True, slots=True)
class Progress:
    """How far a run is: generations done, the last that improved the best, the best value."""

    generation: int
    improved_at: int
    best_value: float


class StopRule(Protocol):
    """A rule that ends a run."""

    @property
    def reason(self) -> StopReason:
        """Word for the result's ``stop_reason``."""

    def generations_left(self, progress: Progress) -> int:
        """Return how many generations may run before the rule is asked again; 0 stops the run."""


@dataclass(frozen=True, slots=True)
class Generations:
    """Stop at a generation number (section 6.3: 50,000)."""

    limit: int
    reason: StopReason = field(default="generations", init=False)

    def generations_left(self, progress: Progress) -> int:
        """Count down to the limit."""
        return max(0, self.limit - progress.generation)


@dataclass(frozen=True, slots=True)
class Stall:
    """Stop when the best grasp has not improved for some generations."""

    patience: int
    reason: StopReason = field(default="stall", init=False)

    def generations_left(self, progress: Progress) -> int:
        """Count down from the last improvement."""
        return max(0, progress.improved_at + self.patience - progress.generation)


@dataclass(frozen=True, slots=True)
class Target:
    """Stop when the best value is at or below a number."""

    value: float
    reason: StopReason = field(default="target", init=False)

    def generations_left(self, progress: Progress) -> int:
        """Go on until the value is reached."""
        return 0 if progress.best_value <= self.value else CHUNK


@dataclass(frozen=True, slots=True)
class TimeLimit:
    """Stop some seconds after the rule was made."""

    seconds: float
    reason: StopReason = field(default="time", init=False)
    started: float = field(default_factory=time.perf_counter, init=False)

    def generations_left(self, progress: Progress) -> int:  # noqa: ARG002 (the clock decides)
        """Go on, a few milliseconds at a time, until the time is up."""
        return 0 if time.perf_counter() - self.started >= self.seconds else CHUNK


@dataclass(slots=True)
class Interrupt:
    """Stop when somebody asked for it (Ctrl-C)."""

    asked: bool = False
    reason: StopReason = field(default="interrupted", init=False)

    def generations_left(self, progress: Progress) -> int:  # noqa: ARG002 (the person decides)
        """Go on, a few milliseconds at a time, until asked to stop."""
        return 0 if self.asked else CHUNK

    def is_asked(self) -> bool:
        """Tell a search whether to end."""
        return self.asked


def first_to_stop(rules: Sequence[StopRule], progress: Progress) -> tuple[int, StopReason | None]:
    """Ask all rules: generations until the first must be asked again, and who stops the run now."""
    left = CHUNK
    for rule in rules:
        allowed = rule.generations_left(progress)
        if allowed == 0:
            return 0, rule.reason
        left = min(left, allowed)
    return left, None


SAME_PRESS_S = 2.0
"""A Ctrl-C so soon after the first is the same wish."""


@contextmanager
def stop_on_ctrl_c() -> Iterator[Interrupt]:
    """Give a rule that Ctrl-C trips; another one acts as usual, but not at once.

    An impatient person presses twice, and some programs pass a signal on twice.
    """
    rule = Interrupt()
    usual_from = 0.0

    def ask(number: int, frame: FrameType | None) -> None:
        nonlocal usual_from
        if not rule.asked:
            rule.asked, usual_from = True, time.monotonic() + SAME_PRESS_S
        elif time.monotonic() >= usual_from and callable(usual):
            usual(number, frame)

    usual = signal.signal(signal.SIGINT, ask)
    try:
        yield rule
    finally:
        signal.signal(signal.SIGINT, usual)
