"""All values of a workbook, as another reader finds them, but those that are of one call alone."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from python_calamine import CalamineWorkbook

OF_THE_PLACE = ("Input file", "Input SHA-256")
TIMES = (
    *("Started", "Ended", "Seconds of search"),
    *("Seconds of exact search", "Time of the exact search (s)"),
)
"""Labels of what run log and fitness table say of one call of the program."""


def contents(book: Path, left_out: tuple[str, ...] = TIMES) -> dict[str, list[list[Any]]]:
    """Read all values by sheet, but those right of a label that is left out."""
    opened = CalamineWorkbook.from_path(book)
    sheets = {name: opened.get_sheet_by_name(name).to_python() for name in opened.sheet_names}
    for name in ("Run Log", "Fitness Table"):
        sheets[name] = [
            [
                value
                for before, value in zip([None, *row], row, strict=False)
                if before not in left_out
            ]
            for row in sheets[name]
        ]
    return sheets
