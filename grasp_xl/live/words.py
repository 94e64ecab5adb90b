"""How a value is typed into a cell, so that Excel takes it for what it is."""

from __future__ import annotations

import re
from datetime import datetime

from grasp_xl.workbook.written import CellValue

DAY_ZERO = datetime(1899, 12, 30)  # noqa: DTZ001 (Excel knows no time zones)
SECONDS_A_DAY = 86_400

MAX_NUMBER_LENGTH = 60
"""Longer text is no number and no date, in whatever language."""

_SPECIAL = re.compile(r"[=+\-@']|.*\d|(true|false)$", re.IGNORECASE | re.DOTALL)


def typed(value: CellValue | datetime) -> CellValue:
    """Return what to type for a value.

    An apostrophe in front keeps text from being taken for a formula, a number or a date.  A whole
    number is typed as a float, since Excel gets none of more than 32 bits from Python.

    Examples
    --------
    >>> typed("yes"), typed("=cmd"), typed("3-4"), typed("true"), typed("-")
    ('yes', "'=cmd", "'3-4", "'true", '-')
    >>> typed(5_000_000_000), typed(True)
    (5000000000.0, True)
    >>> typed(datetime(1900, 1, 1, 12)), typed(0.5), typed(None)
    (2.5, 0.5, '')
    """
    if value is None:
        return ""
    if isinstance(value, datetime):
        return (value - DAY_ZERO).total_seconds() / SECONDS_A_DAY
    if isinstance(value, int) and not isinstance(value, bool):
        return float(value)
    if isinstance(value, str) and value != "-":
        short = len(value) <= MAX_NUMBER_LENGTH
        special = _SPECIAL.match(value) if short else value.startswith(tuple("=+-@'"))
        return f"'{value}" if special else value
    return value
