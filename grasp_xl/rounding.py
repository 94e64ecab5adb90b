"""Numbers with few digits that are still at most, or at least, what they stand for."""

from __future__ import annotations

import math
from collections.abc import Callable

RELATIVE = 1e-10
"""A number so close to a round one is that one; comparisons of grasps allow ten times as much."""


TOLD_DIGITS = 4
"""Significant digits of suggested FoS and forces, and of the FoS that they are compared with."""


def rounded_down(number: float, digits: int) -> float:
    """Round a number above 0 down to significant digits.

    Examples
    --------
    >>> rounded_down(0.73764, 4), rounded_down(151.9, 3), rounded_down(0.3 - 1e-17, 3)
    (0.7376, 151.0, 0.3)
    """
    return _rounded(number * (1 + RELATIVE), digits, math.floor)


def rounded_up(number: float, digits: int) -> float:
    """Round a number above 0 up to significant digits.

    Examples
    --------
    >>> rounded_up(0.73761, 4), rounded_up(7434.4, 4), rounded_up(99.95, 3)
    (0.7377, 7435.0, 100.0)
    """
    return _rounded(number * (1 - RELATIVE), digits, math.ceil)


def percent(fraction: float) -> str:
    """Return a fraction as text, with three significant digits.

    Examples
    --------
    >>> percent(0.03141), percent(0.0), percent(1.5)
    ('3.14 %', '0 %', '150 %')
    """
    return f"{100 * fraction:.3g} %"


def _rounded(number: float, digits: int, whole: Callable[[float], int]) -> float:
    if number == 0:
        return 0.0
    places = digits - 1 - math.floor(math.log10(number))
    unit = 10.0**-places
    return round(whole(number / unit) * unit, places)
