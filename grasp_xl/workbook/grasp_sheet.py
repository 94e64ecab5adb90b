"""Sheet ``Grasp``: live plan views to scale (figures 12, 36, 41), drawn from points beside them.

Elements are circles of their true diameter.  A point that is not there (no such element) is #N/A,
which a chart leaves out, and which is written in the colour of its cell.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from grasp_xl.grasp import Grasp
from grasp_xl.space import FloatArray, OptionSpace
from grasp_xl.workbook import layout
from grasp_xl.workbook.calc_sheet import (
    EDGE_COLUMN,
    PART_POLYGON_COLUMN,
    CalcBlock,
    closed_polygon,
)
from grasp_xl.workbook.calc_values import truss_ends
from grasp_xl.workbook.layout import (
    DEFAULT_DIAMETERS_MM,
    GRASP,
    GRASP_DATA_COLUMN,
    KINDS,
    OPTION_SPACE,
    Area,
)
from grasp_xl.workbook.pen import ROW_HEIGHT, Pen
from grasp_xl.workbook.styles import (
    BLACK,
    BLUE,
    CYAN,
    DARK_CYAN,
    DARK_MAGENTA,
    GREEN,
    MAGENTA,
    PALE_CYAN,
    PALE_MAGENTA,
    RED,
    Style,
)

PLACE_COLOURS = (PALE_CYAN, PALE_MAGENTA)
"""Pale, since LibreOffice draws places over the marks that fill elements; Excel, under them."""
FILLS = (CYAN, MAGENTA)
ELEMENT_COLOURS = (DARK_CYAN, DARK_MAGENTA)
CORNERS = 36
"""Corners of a circle."""
PLOT_WIDTH, PLOT_HEIGHT = 640, 460
"""Most that the inner plot area of a picture takes (pixels)."""
LEFT, TOP, BOTTOM, RIGHT = 70, 44, 136, 20
"""Pixels around the plot area: for axis and title, and below for the legend's many lines too."""
LEAST_WIDTH = 480
"""Of a picture (pixels), for the legend's sake."""
MARGIN = 0.02
"""Free part of the extent on each side."""
TICKS = 10
"""Most intervals between labels of the longer axis; axes end at quarters of one."""
ROUND_STEPS = (1.0, 2.0, 5.0, 10.0)
POINTS = 0.75
"""Points of a pixel."""
LARGEST_MARKER = 72
"""Points of Excel's largest marker: of still larger elements only the middle is filled."""
COLUMN_WIDTH = 64
"""Pixels of a column of the default width."""

FIRST_POINT = 3
NO_POINT = "#N/A"

Number = float | str
Pair = tuple[Number, Number]


@dataclass(frozen=True, slots=True)
class Picture:
    """One plan view: a title, the grasp as the engine sees it, and its helper cells."""

    title: str
    grasp: Grasp
    block: CalcBlock


@dataclass(frozen=True, slots=True)
class Stroke:
    """A line of the picture: points and the formulas that give them; x and y of each."""

    points: list[Pair]
    formulas: list[tuple[str, str]]


def write_grasp(pen: Pen, book: Any, space: OptionSpace, pictures: list[Picture]) -> None:  # noqa: ANN401 (untyped library)
    """Write one picture a grasp, side by side, and the points that each is drawn from."""
    pen.write(0, 0, "GRASP: plan view to scale (mm), live with the What-if card", Style.TITLE)
    pen.write(0, GRASP_DATA_COLUMN, "Points that the pictures are drawn from", Style.NOTE)
    column = GRASP_DATA_COLUMN
    turns = np.linspace(0.0, 2.0 * math.pi, CORNERS + 1)
    pen.row(2, column, ("cosine", "sine"), Style.HEADER)
    for row, turn in enumerate(turns.tolist(), FIRST_POINT):
        pen.row(row, column, (math.cos(turn), math.sin(turn)), Style.COORDINATE)
    column += 3
    frame = Frame.of(space)
    columns = 1 + math.ceil(frame.width / COLUMN_WIDTH)
    for number, picture in enumerate(pictures):
        chart = book.add_chart({"type": "scatter", "subtype": "straight"})
        _add_background(chart, space)
        column = _add_strokes(pen, chart, space, picture, column, frame)
        frame.put_on(chart, picture.title)
        pen.insert_chart(2, number * columns, chart)
    pen.hide_errors(Area(GRASP, FIRST_POINT, GRASP_DATA_COLUMN, CORNERS + 1, column))
    pen.fix_row_heights()
    rows = 3 + math.ceil(frame.height * POINTS / ROW_HEIGHT)
    pen.print_pages(pictures=[Area(GRASP, 0, 0, rows, len(pictures) * columns)])


def _series(name: str, x: Area, y: Area, look: dict[str, Any]) -> dict[str, Any]:
    return {"name": name, "categories": f"={x.reference}", "values": f"={y.reference}", **look}


def _line(colour: str, width: float) -> dict[str, Any]:
    return {"line": {"color": colour, "width": width}, "marker": {"type": "none"}}


def _mark(shape: str, colour: str, size: int, *, filled: bool = True) -> dict[str, Any]:
    fill = {"color": colour} if filled else {"none": True}
    marker = {"type": shape, "size": size, "border": {"color": colour}, "fill": fill}
    return {"line": {"none": True}, "marker": marker}


def _add_background(chart: Any, space: OptionSpace) -> None:  # noqa: ANN401 (untyped library)
    """Draw all footprints and both polygons, straight from their cells."""
    for labels, kind, colour in zip(KINDS, space.kinds, PLACE_COLOURS, strict=True):
        if kind.total:
            x = Area(OPTION_SPACE, layout.FIRST_LOCATION_ROW, labels.column, kind.total)
            y = Area(OPTION_SPACE, x.row, x.column + 1, x.rows)
            look = _mark("circle", colour, 2, filled=False)
            chart.add_series(_series(f"Places for {labels.plural}", x, y, look))
    corners = len(space.ideal_polygon_mm)
    for name, column, colour in (
        ("Part polygon", PART_POLYGON_COLUMN, GREEN),
        ("Ideal polygon", EDGE_COLUMN + 1, BLUE),
    ):
        x, y = closed_polygon(column, corners), closed_polygon(column + 1, corners)
        chart.add_series(_series(name, x, y, _line(colour, 1.5)))


def _add_strokes(
    pen: Pen,
    chart: Any,  # noqa: ANN401 (untyped library)
    space: OptionSpace,
    picture: Picture,
    column: int,
    frame: Frame,
) -> int:
    """Draw trusses, elements and centres; return the next free column."""
    unnamed = []
    for name, stroke, look in _strokes(space, picture, column, frame):
        pen.write(2, column, name or "(more)", Style.HEADER)
        for row, (point, formulas) in enumerate(
            zip(stroke.points, stroke.formulas, strict=True), FIRST_POINT
        ):
            for axis in range(2):
                pen.write(row, column + axis, point[axis], Style.COORDINATE, formulas[axis])
        x = Area(GRASP, FIRST_POINT, column, len(stroke.points))
        chart.add_series(_series(name, x, Area(GRASP, x.row, column + 1, x.rows), look))
        if not name:
            unnamed.append(len(chart.series) - 1)
        column += 2
    chart.set_legend({"position": "bottom", "delete_series": unnamed})
    return column + 1


def _strokes(
    space: OptionSpace, picture: Picture, column: int, frame: Frame
) -> Iterator[tuple[str, Stroke, dict[str, Any]]]:
    """Yield name, points and look, from the bottom up; only one of a group has a name."""
    block = picture.block
    ends = Area(GRASP, FIRST_POINT, column, 2)
    yield "Main truss", _main_truss(picture), _line(RED, 3.5)
    rows = {kind: kind * block.slots for kind in range(len(KINDS))}
    named = False
    for row in range(block.size):
        if space.kinds[row // block.slots].total:
            yield "" if named else "Branch trusses", _branch(picture, row, ends), _line(RED, 1)
            named = True
    for number, kind in enumerate(space.kinds):
        if kind.total:
            look = _mark("circle", FILLS[number], frame.marker(_diameter(space, number)))
            yield "", _middles(picture, number), look
    for row in range(block.size):
        number = row // block.slots
        if space.kinds[number].total:
            name = KINDS[number].plural.capitalize() if row == rows[number] else ""
            yield name, _circle(space, picture, row), _line(ELEMENT_COLOURS[number], 3)
    centroid = [(float(space.part.centroid_mm[0]), float(space.part.centroid_mm[1]))]
    yield "Centroid", Stroke([*centroid], [("CentroidX", "CentroidY")]), _mark("x", BLACK, 9)
    force = block.column("force (N)").reference
    mean = [
        f"IF(SUM({force})=0,NA(),SUMPRODUCT({force}*{block.column(axis).reference})/SUM({force}))"
        for axis in ("x", "y")
    ]
    centre = picture.grasp.centre_of_force_mm
    stroke = Stroke([(float(centre[0]), float(centre[1]))], [(mean[0], mean[1])])
    yield "Centre of force", stroke, _mark("diamond", BLACK, 8)


def _places(picture: Picture) -> dict[int, FloatArray]:
    """Plan-view place of each active row of the helper cells."""
    slots, counts = picture.block.slots, picture.grasp.chromosome.counts.tolist()
    rows = [kind * slots + slot for kind, count in enumerate(counts) for slot in range(count)]
    return dict(zip(rows, picture.grasp.points_mm[:, :2], strict=True))


def _pair(point: FloatArray) -> Pair:
    return float(point[0]), float(point[1])


def _truss_rows(picture: Picture) -> list[int]:
    """Rows of the helper cells that the main truss joins."""
    rows = list(_places(picture))
    return [rows[end] for end in truss_ends(picture.grasp.points_mm) or ()]


def _main_truss(picture: Picture) -> Stroke:
    block, places = picture.block, _places(picture)
    points: list[Pair] = [_pair(places[row]) for row in _truss_rows(picture)]
    formulas = []
    for end in ("main truss from", "main truss to"):
        row = block.summary(end).reference
        x, y = (
            f"IF({row}=0,NA(),INDEX({block.column(axis).reference},{row}))" for axis in ("x", "y")
        )
        formulas.append((x, y))
    return Stroke(points or [(NO_POINT, NO_POINT)] * 2, formulas)


def _branch(picture: Picture, row: int, ends: Area) -> Stroke:
    """Draw an element's branch: from it at right angles to the main truss."""
    block, places = picture.block, _places(picture)
    truss = _truss_rows(picture)
    points: list[Pair] = [(NO_POINT, NO_POINT)] * 2
    if row in places and truss and row not in truss:
        start, end = (places[number] for number in truss)
        axis = end - start
        along = float((places[row] - start) @ axis / (axis @ axis)) if axis.any() else 0.0
        points = [_pair(places[row]), _pair(start + along * axis)]
    x, y = (block.element(axis, row).reference for axis in ("x", "y"))
    x0, x1, y0, y1 = (ends.cell(end, axis).absolute for axis in range(2) for end in range(2))
    dx, dy = f"({x1}-{x0})", f"({y1}-{y0})"
    along_formula = f"((({x}-{x0})*{dx}+({y}-{y0})*{dy})/MAX({dx}^2+{dy}^2,1E-99))"
    start_row, end_row = (
        block.summary(end).reference for end in ("main truss from", "main truss to")
    )
    active = block.element("active", row).reference
    on = f"({active}=1)*({start_row}>0)*({start_row}<>{row + 1})*({end_row}<>{row + 1})=1"
    foot = (f"{x0}+{along_formula}*{dx}", f"{y0}+{along_formula}*{dy}")
    formulas = [
        (f"IF({on},{x},NA())", f"IF({on},{y},NA())"),
        (f"IF({on},{foot[0]},NA())", f"IF({on},{foot[1]},NA())"),
    ]
    return Stroke(points, formulas)


def _diameter(space: OptionSpace, number: int) -> float:
    return space.kinds[number].diameter_mm or DEFAULT_DIAMETERS_MM[number]


def _middles(picture: Picture, number: int) -> Stroke:
    """Return where the elements of a kind stand, for the marks that fill their circles."""
    block, places = picture.block, _places(picture)
    points: list[Pair] = []
    formulas = []
    for row in range(number * block.slots, (number + 1) * block.slots):
        active, x, y = (block.element(name, row).reference for name in ("active", "x", "y"))
        points.append(_pair(places[row]) if row in places else (NO_POINT, NO_POINT))
        formulas.append((f"IF({active}=1,{x},NA())", f"IF({active}=1,{y},NA())"))
    return Stroke(points, formulas)


def _circle(space: OptionSpace, picture: Picture, row: int) -> Stroke:
    """Draw an element at its true diameter."""
    block, places = picture.block, _places(picture)
    number = row // block.slots
    labels, assumed = KINDS[number], DEFAULT_DIAMETERS_MM[number]
    diameter = _diameter(space, number)
    name = labels.diameter.name
    radius = f"IF(ISNUMBER({name}),{name},{assumed:g})/2"
    active = block.element("active", row).reference
    x, y = (block.element(axis, row).reference for axis in ("x", "y"))
    points: list[Pair] = []
    formulas = []
    for corner in range(CORNERS + 1):
        turn = 2.0 * math.pi * corner / CORNERS
        unit = np.array([math.cos(turn), math.sin(turn)])
        here = places.get(row)
        points.append((NO_POINT, NO_POINT) if here is None else _pair(here + unit * diameter / 2))
        cosine, sine = (
            Area(GRASP, FIRST_POINT + corner, GRASP_DATA_COLUMN + axis).absolute
            for axis in range(2)
        )
        formulas.append(
            (
                f"IF({active}=1,{x}+{radius}*{cosine},NA())",
                f"IF({active}=1,{y}+{radius}*{sine},NA())",
            )
        )
    return Stroke(points, formulas)


@dataclass(frozen=True, slots=True)
class Frame:
    """What a picture shows, and its size: as many pixels a millimetre in x as in y.

    Parameters
    ----------
    low_mm, high_mm : tuple of float
        Ends of both axes.
    tick_mm : float
        Distance of labels.
    scale : float
        Pixels of a millimetre.
    """

    low_mm: tuple[float, float]
    high_mm: tuple[float, float]
    tick_mm: float
    scale: float

    @classmethod
    def of(cls, space: OptionSpace) -> Frame:
        """Return the smallest frame around all places, elements and polygons."""
        points = [space.approximation_polygon_mm[:, :2], space.ideal_polygon_mm[:, :2]]
        for number, kind in enumerate(space.kinds):
            radius = _diameter(space, number) / 2
            points += [kind.footprints_mm[:, :2] - radius, kind.footprints_mm[:, :2] + radius]
        everything = np.vstack(points)
        low, high = everything.min(axis=0), everything.max(axis=0)
        free = MARGIN * float((high - low).max())
        low, high = low - free, high + free
        needed = float((high - low).max()) / TICKS
        power = 10.0 ** math.floor(math.log10(needed))
        tick = next(step * power for step in ROUND_STEPS if step * power >= needed)
        step = tick / 4
        low, high = np.floor(low / step) * step, np.ceil(high / step) * step
        scale = float(min(np.array([PLOT_WIDTH, PLOT_HEIGHT]) / (high - low)))
        (left, bottom), (right, top) = low.tolist(), high.tolist()
        return cls((left, bottom), (right, top), tick, scale)

    @property
    def plot(self) -> tuple[float, float]:
        """Width and height of the plot area (pixels)."""
        (left, bottom), (right, top) = self.low_mm, self.high_mm
        return self.scale * (right - left), self.scale * (top - bottom)

    @property
    def width(self) -> int:
        """Of the whole picture (pixels)."""
        return max(LEAST_WIDTH, math.ceil(LEFT + self.plot[0] + RIGHT))

    @property
    def height(self) -> int:
        """Of the whole picture (pixels)."""
        return math.ceil(TOP + self.plot[1] + BOTTOM)

    def marker(self, diameter_mm: float) -> int:
        """Return the size of a marker that fills a circle (points), within its line."""
        return max(2, min(LARGEST_MARKER, int(self.scale * diameter_mm * POINTS)))

    def put_on(self, chart: Any, title: str) -> None:  # noqa: ANN401 (untyped library)
        """Give a chart this size, these axes, and its plot area within them."""
        for number, set_axis in enumerate((chart.set_x_axis, chart.set_y_axis)):
            set_axis(
                {
                    "name": "xy"[number] + " (mm)",
                    "min": self.low_mm[number],
                    "max": self.high_mm[number],
                    "major_unit": self.tick_mm,
                    "num_format": "0.###",
                    "label_position": "low",
                    "crossing": "min",
                    "major_gridlines": {"visible": False},
                }
            )
        width, height = self.plot
        left = (self.width - width + LEFT - RIGHT) / 2
        chart.set_size({"width": self.width, "height": self.height})
        chart.set_plotarea(
            {
                "layout": {
                    "x": left / self.width,
                    "y": TOP / self.height,
                    "width": width / self.width,
                    "height": height / self.height,
                }
            }
        )
        chart.set_title({"name": title, "name_font": {"size": 11}})
