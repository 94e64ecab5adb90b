"""Native charts of designs: a point each, a colour a series; their data stand beside them.

A chart has all its series, and ranges as long as the longest list, whatever it draws: so a run in
an open workbook need not touch it.  The legend is in cells above it, coloured where they say
something, since a chart's own would show the empty series.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import accumulate, pairwise
from typing import Any

from grasp_xl.workbook.layout import MAX_DESIGNS, TABLE_ROW, Area
from grasp_xl.workbook.pen import Pen
from grasp_xl.workbook.styles import SEQUENCE, Style
from grasp_xl.workbook.table import GRID

WIDTH, HEIGHT = 640, 420
CHART_ROWS, CHART_COLUMNS = 24, 10
"""Rows and columns that a chart takes."""


@dataclass(frozen=True, slots=True)
class Scatter:
    """A chart of one criterion against another.

    Parameters
    ----------
    title, x_label, y_label : str
    x_style, y_style : Style
        Looks of the data.
    names : sequence of str
        The series, as the legend shows them: as many as ``SEQUENCE`` has colours at most.
    points : sequence of (float, float, int)
        x, y, and number of the series of each design.
    """

    title: str
    x_label: str
    y_label: str
    x_style: Style
    y_style: Style
    names: Sequence[str]
    points: Sequence[tuple[float, float, int]]

    def draw(self, pen: Pen, book: Any, place: Area, left: int) -> int:  # noqa: ANN401 (untyped library)
        """Insert the chart at a place, its data from a column on; return the column behind them."""
        pen.row(TABLE_ROW, left, (self.x_label, *self.names), Style.HEADER)
        pen.row(TABLE_ROW, place.column + 1, self.names, Style.LEGEND)
        for row, (x, y, number) in enumerate(self.points, TABLE_ROW + 1):
            pen.write(row, left, x, self.x_style)
            pen.write(row, left + 1 + number, y, self.y_style)
        first, last = TABLE_ROW + 1, TABLE_ROW + MAX_DESIGNS
        chart = book.add_chart({"type": "scatter"})
        for number, colour in enumerate(SEQUENCE, left + 1):
            fill = {"color": colour}
            pen.fill_if_used(Area(pen.name, TABLE_ROW, place.column + number - left), colour)
            chart.add_series(
                {
                    "name": [pen.name, TABLE_ROW, number],
                    "categories": [pen.name, first, left, last, left],
                    "values": [pen.name, first, number, last, number],
                    "marker": {"type": "circle", "size": 6, "border": fill, "fill": fill},
                }
            )
        chart.set_title({"name": self.title, "name_font": {"size": 11}})
        chart.set_x_axis({"name": self.x_label, "major_gridlines": GRID, "label_position": "low"})
        chart.set_y_axis({"name": self.y_label, "major_gridlines": GRID})
        chart.set_legend({"none": True})
        chart.set_size({"width": WIDTH, "height": HEIGHT})
        pen.insert_chart(place.row, place.column, chart)
        return left + 1 + len(SEQUENCE)


def structure_against_deviation(
    title: str, records: Sequence[tuple[float, float, float]]
) -> Scatter:
    """Return the chart of ``(deviation, structure, cost)`` records, a series a band of costs."""
    bands = cost_bands(cost for _, _, cost in records)
    told = [" to ".join(dict.fromkeys(f"${cost:,.10g}" for cost in band)) for band in bands]
    lowest = [low for low, _ in bands]
    return Scatter(
        title,
        "Deviation (mm)",
        "Structure (mm)",
        Style.RATIO,
        Style.TORQUE,
        [f"Cost {band}" for band in told],
        [(x, y, bisect_right(lowest, cost) - 1) for x, y, cost in records],
    )


def cost_bands(costs: Iterable[float]) -> list[tuple[float, float]]:
    """Return the lowest and highest cost of each series: a cost each, or neighbours together.

    Examples
    --------
    >>> cost_bands([30, 10, 30])
    [(10, 10), (30, 30)]
    >>> cost_bands(range(10))[:3]
    [(0, 1), (2, 3), (4, 4)]
    >>> cost_bands([])
    []
    """
    different = sorted(set(costs))
    each, more = divmod(len(different), len(SEQUENCE))
    sizes = [each + (number < more) for number in range(len(SEQUENCE))]
    ends = [end for size, end in zip(sizes, accumulate(sizes), strict=True) if size]
    return [(different[start], different[end - 1]) for start, end in pairwise((0, *ends))]
