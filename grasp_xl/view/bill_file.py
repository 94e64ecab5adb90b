"""The bill of material as a CSV file."""

from __future__ import annotations

import csv
import io

from grasp_xl.bill import bill_of, whole_weight_g
from grasp_xl.view.scene import Scene

HEADER = ("Element", "Model", "Count", "Unit price ($)", "Price ($)", "Weight (g)")


def bill_csv(scene: Scene) -> bytes:
    """Return the bill of the shown design, in UTF-8 as Excel opens it, with a last line of sums."""
    lines = bill_of(scene.task.space, scene.grasp(scene.shown))
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\r\n")
    writer.writerow(HEADER)
    for line in lines:
        cells = _told(line.unit_price), _told(line.price), _told(line.weight_g)
        writer.writerow([line.element, _no_formula(line.model), line.count, *cells])
    count, price = (sum(line.count for line in lines), sum(line.price for line in lines))
    writer.writerow(["Sum", "", count, "", _told(price), _told(whole_weight_g(lines))])
    return text.getvalue().encode("utf-8-sig")


def _told(number: float | None) -> str:
    return "" if number is None else f"{number:.10g}"


def _no_formula(text: str) -> str:
    """Return a text that no spreadsheet takes for a formula.

    Examples
    --------
    >>> _no_formula("SAF 40"), _no_formula("=cmd")
    ('SAF 40', "'=cmd")
    """
    return f"'{text}" if text[:1] in ("=", "+", "-", "@", "\t", "\r") else text
