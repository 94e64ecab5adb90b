"""Native charts of a criterion against the generation (figures 42 to 47)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from grasp_xl.workbook.styles import BLUE, GREEN, GREY
from grasp_xl.workbook.table import GRID

COURSE = {"color": BLUE, "width": 1.75}
DASHED = {"color": GREY, "width": 1.5, "dash_type": "dash"}
PROVED_LINE = {"color": GREEN, "width": 1.75, "dash_type": "long_dash"}
"""Looks of the lines."""

CHART_WIDTH, CHART_HEIGHT = 560, 295
CHART_COLUMNS, CHART_ROWS = 18, 16
"""Columns that two charts take side by side, and rows that one takes."""


@dataclass(frozen=True, slots=True)
class Line:
    """One line of a chart: its name in the legend or the cell with it, its data, its look."""

    name: str | list[Any]
    x: list[Any]
    y: list[Any]
    look: dict[str, Any]


def course_chart(
    book: Any,  # noqa: ANN401 (untyped library)
    title: str,
    unit: str,
    lines: Sequence[Line],
) -> Any:  # noqa: ANN401 (untyped library)
    """Return a chart of a criterion against the generation, which stands on a logarithmic axis."""
    chart = book.add_chart({"type": "scatter", "subtype": "straight"})
    for line in lines:
        chart.add_series(
            {
                "name": line.name,
                "categories": line.x,
                "values": line.y,
                "line": line.look,
            }
        )
    chart.set_title({"name": f"{title} vs Generation Number", "name_font": {"size": 11}})
    chart.set_x_axis(
        {
            "name": "Generation",
            "log_base": 10,
            "min": 1,
            "major_gridlines": GRID,
            "label_position": "low",
        }
    )
    chart.set_y_axis({"name": unit, "major_gridlines": GRID})
    chart.set_legend({"position": "bottom"})
    chart.set_size({"width": CHART_WIDTH, "height": CHART_HEIGHT})
    return chart
