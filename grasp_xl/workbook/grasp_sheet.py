"""Sheet ``Grasp``: plan views to scale (figures 12, 36, 41) of the best and the benchmark grasp."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from grasp_xl.grasp import Grasp
from grasp_xl.space import FloatArray, OptionSpace
from grasp_xl.workbook.layout import DEFAULT_DIAMETERS_MM, GRASP, GRASP_DATA_COLUMN, KINDS
from grasp_xl.workbook.pen import Pen
from grasp_xl.workbook.styles import BLACK, BLUE, CYAN, GREEN, MAGENTA, RED, Style

KIND_COLOURS = (CYAN, MAGENTA)
CIRCLE_CORNERS = 36
PLOT_WIDTH, PLOT_HEIGHT = 720, 480
"""Inner plot area of a picture (pixels); both axes get the same millimetres a pixel."""
FRAME = 90
"""Pixels around the plot area for axes, title and legend."""
MARGIN = 0.06
"""Free part of the extent on each side."""

PICTURE_ROWS = 34

Points = list[tuple[float, float] | None]


@dataclass(frozen=True, slots=True)
class Layer:
    """One series of the picture; None between points lifts the pen."""

    name: str
    points: Points
    look: dict[str, Any]


def write_grasp(pen: Pen, book: Any, space: OptionSpace, pictures: list[tuple[str, Grasp]]) -> None:  # noqa: ANN401
    """Write one picture a grasp, and the points that it is drawn from beside it."""
    pen.write(0, 0, "GRASP: plan view to scale (mm)", Style.TITLE)
    column = GRASP_DATA_COLUMN
    for number, (title, grasp) in enumerate(pictures):
        chart = book.add_chart({"type": "scatter", "subtype": "straight"})
        for layer in layers(space, grasp):
            _add(pen, chart, layer, column)
            column += 3
        _to_scale(chart, space, title)
        pen.sheet.insert_chart(2 + number * PICTURE_ROWS, 0, chart)
    pen.write(0, GRASP_DATA_COLUMN, "Points that the pictures are drawn from", Style.NOTE)


def layers(space: OptionSpace, grasp: Grasp) -> Iterator[Layer]:
    """Yield what the picture shows, from the bottom up."""
    for kind, labels, colour in zip(space.kinds, KINDS, KIND_COLOURS, strict=True):
        if kind.total:
            dot = {"type": "circle", "size": 3, "border": {"color": colour}, "fill": {"none": True}}
            look = {"line": {"none": True}, "marker": dot}
            yield Layer(f"Places for {labels.plural}", _flat(kind.footprints_mm), look)
    yield Layer("Part polygon", _closed(space.approximation_polygon_mm), _line(GREEN, 1.5))
    yield Layer("Ideal polygon", _closed(space.ideal_polygon_mm), _line(BLUE, 1.5))
    main, branches = trusses(grasp)
    yield Layer("Branch trusses", branches, _line(RED, 1))
    yield Layer("Main truss", main, _line(RED, 3))
    for number, labels in enumerate(KINDS):
        circles = _circles(space, grasp, number)
        yield Layer(labels.plural.capitalize(), circles, _line(KIND_COLOURS[number], 2.25))
    yield Layer("Centroid", _flat(space.part.centroid_mm[None, :]), _mark("x", BLACK, 8))
    yield Layer(
        "Centre of force", _flat(grasp.centre_of_force_mm[None, :]), _mark("diamond", BLACK, 8)
    )


def trusses(grasp: Grasp) -> tuple[Points, Points]:
    """Return the main truss, and from it the branches to all other elements (section 4.2.3.4)."""
    if grasp.main_truss is None:
        return [], []
    plan = grasp.points_mm[:, :2]
    start, end = plan[list(grasp.main_truss)]
    axis = end - start
    branches: Points = []
    for number, point in enumerate(plan):
        if number not in grasp.main_truss and axis.any():
            foot = start + axis * float((point - start) @ axis / (axis @ axis))
            branches += [_pair(point), _pair(foot), None]
    return [_pair(start), _pair(end)], branches


def _circles(space: OptionSpace, grasp: Grasp, number: int) -> Points:
    diameter = space.kinds[number].diameter_mm or DEFAULT_DIAMETERS_MM[number]
    turns = np.linspace(0.0, 2.0 * math.pi, CIRCLE_CORNERS + 1)
    ring = np.column_stack([np.cos(turns), np.sin(turns)]) * diameter / 2
    points: Points = []
    for index in grasp.chromosome.active[number]:
        centre = space.kinds[number].footprints_mm[index - 1, :2]
        points += [*map(_pair, centre + ring), None]
    return points


def _flat(points: FloatArray) -> Points:
    return [_pair(point) for point in points]


def _closed(polygon: FloatArray) -> Points:
    return _flat(np.vstack([polygon, polygon[:1]]))


def _pair(point: FloatArray) -> tuple[float, float]:
    return float(point[0]), float(point[1])


def _line(colour: str, width: float) -> dict[str, Any]:
    return {"line": {"color": colour, "width": width}, "marker": {"type": "none"}}


def _mark(shape: str, colour: str, size: int) -> dict[str, Any]:
    marker = {"type": shape, "size": size, "border": {"color": colour}, "fill": {"color": colour}}
    return {"line": {"none": True}, "marker": marker}


def _add(pen: Pen, chart: Any, layer: Layer, column: int) -> None:  # noqa: ANN401 (untyped library)
    pen.write(1, column, layer.name, Style.HEADER)
    pen.row(2, column, ("x", "y"), Style.UNIT)
    for row, point in enumerate(layer.points, 3):
        if point is not None:
            pen.row(row, column, point, Style.COORDINATE)
    last = max(3, 2 + len(layer.points))
    chart.add_series(
        {
            "name": layer.name,
            "categories": [GRASP, 3, column, last, column],
            "values": [GRASP, 3, column + 1, last, column + 1],
            **layer.look,
        }
    )


def _to_scale(chart: Any, space: OptionSpace, title: str) -> None:  # noqa: ANN401 (untyped library)
    points = [kind.footprints_mm for kind in space.kinds]
    everything = np.vstack([*points, space.approximation_polygon_mm, space.ideal_polygon_mm])[:, :2]
    low, high = everything.min(axis=0), everything.max(axis=0)
    middle, extent = (low + high) / 2, (high - low) * (1 + 2 * MARGIN)
    size = np.array([PLOT_WIDTH, PLOT_HEIGHT])
    half = size * max(extent / size) / 2
    for number, set_axis in enumerate((chart.set_x_axis, chart.set_y_axis)):
        set_axis(
            {
                "name": "xy"[number] + " (mm)",
                "min": float(middle[number] - half[number]),
                "max": float(middle[number] + half[number]),
                "num_format": "0",
                "label_position": "low",
                "major_gridlines": {"visible": False},
                "crossing": "min",
            }
        )
    width, height = PLOT_WIDTH + 2 * FRAME, PLOT_HEIGHT + 2 * FRAME
    chart.set_size({"width": width, "height": height})
    layout = {
        "x": FRAME / width,
        "y": FRAME / 2 / height,
        "width": PLOT_WIDTH / width,
        "height": PLOT_HEIGHT / height,
    }
    chart.set_plotarea({"layout": layout})
    chart.set_title({"name": title, "name_font": {"size": 11}})
    chart.set_legend({"position": "bottom"})
    chart.show_blanks_as("gap")
