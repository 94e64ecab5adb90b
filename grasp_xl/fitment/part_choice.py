"""Which of several parts in a file is meant: one, or that which a number names."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TypeVar

from grasp_xl.errors import InputError, Problem

T = TypeVar("T")

MAX_LISTED = 20
"""Parts of a file that a message lists."""


def choose_part(
    found: Sequence[T],
    number: int | None,
    *,
    noun: str,
    describe: Callable[[T], str],
    name: str,
    hint: str = "name one of them with --part",
) -> T:
    """Return the only part of a file, or the one that a number from 1 names.

    Raises
    ------
    InputError
        If there are several and none is named, or the named one is not there; with a list.
    """
    if number is None and len(found) == 1:
        return found[0]
    if number is not None and 1 <= number <= len(found):
        return found[number - 1]
    listed = [f"{place}: {describe(one)}" for place, one in enumerate(found[:MAX_LISTED], 1)]
    if len(found) > MAX_LISTED:
        listed.append(f"and {len(found) - MAX_LISTED} more")
    told = f"{len(found)} {noun}{'s' if len(found) > 1 else ''} ({'; '.join(listed)})"
    expected = "one" if number is None else f"a {noun} {number}"
    raise InputError([Problem(name, told, expected, hint)])
