"""Sums that are the same in every Python, bit for bit, and the same as in the kernels."""

from __future__ import annotations

from collections.abc import Iterable


def plain_sum(numbers: Iterable[float]) -> float:
    """Add numbers from left to right; ``sum`` corrects its rounding from Python 3.12 on.

    Examples
    --------
    >>> plain_sum([0.1] * 10)
    0.9999999999999999
    """
    total = 0.0
    for number in numbers:
        total += number
    return total
