"""Everything that can go wrong because of a person or a file, told in one sentence each.

Where it is (sheet!cell), what was found, what was expected, and what to do.  Every error that a
person can cause is a ``GraspError``; the command line turns it into one line and an exit code.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

MAX_PROBLEMS = 50
"""Problems that are named; a list of all would help nobody."""


@dataclass(frozen=True, slots=True)
class Problem:
    """One thing that is wrong (or, as a warning, odd) in an input.

    Parameters
    ----------
    where : str
        Place in the person's own terms: ``Option Space!B5``, ``--goals``, a file name.
    found, expected : str
        What stands there, and what may stand there.
    hint : str
        What to do about it.
    """

    where: str
    found: str
    expected: str
    hint: str = ""

    def __str__(self) -> str:
        sentence = f"{self.where}: found {self.found}, expected {self.expected}"
        return f"{sentence}; {self.hint.removesuffix('.')}." if self.hint else f"{sentence}."


class GraspError(Exception):
    """Base of all errors that a person can cause.

    Parameters
    ----------
    message : str
        One sentence.
    where, hint : str, optional
        Place, and what to do.
    """

    exit_code = 1

    def __init__(self, message: str, *, where: str = "", hint: str = "") -> None:
        super().__init__(message)
        self.message = message
        self.where = where
        self.hint = hint


class UsageError(GraspError):
    """An option or argument that makes no sense."""

    exit_code = 2


class InputError(GraspError):
    """A file that cannot be read as an option space; carries every problem found in it.

    Parameters
    ----------
    problems : sequence of Problem
        At least one.
    """

    exit_code = 3

    def __init__(self, problems: Sequence[Problem]) -> None:
        first = problems[0]
        super().__init__(
            " ".join(str(problem) for problem in problems), where=first.where, hint=first.hint
        )
        self.problems = tuple(problems)


def refuse(problems: Sequence[Problem], name: str) -> None:
    """Raise what was found wrong in a file.

    Raises
    ------
    InputError
        With every problem, if there is any; with a count of those after the first fifty.
    """
    told = list(problems[:MAX_PROBLEMS])
    if len(problems) > MAX_PROBLEMS:
        rest = f"problems beyond the first {MAX_PROBLEMS}: {len(problems) - MAX_PROBLEMS}"
        told.append(Problem(name, rest, "none", "mend the first ones first"))
    if told:
        raise InputError(told)


class OutputError(GraspError):
    """A file that cannot be written; whatever stood there before is untouched."""

    exit_code = 3


class InfeasibleError(GraspError):
    """No grasp of this option space can meet the constraints.

    Parameters
    ----------
    message, where, hint
        As in ``GraspError``.
    proved : bool
        False where none was found in the time there was.
    """

    exit_code = 4

    def __init__(
        self, message: str, *, where: str = "", hint: str = "", proved: bool = True
    ) -> None:
        super().__init__(message, where=where, hint=hint)
        self.proved = proved
