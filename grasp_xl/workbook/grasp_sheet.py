"""Sheet ``Grasp``: live plan views to scale (figures 12, 36, 41), drawn from points beside them.

Elements are filled circles of their true diameter: an outline, and under it rings drawn so thick
that they cover the circle.  A point that is not there (no such element) is #N/A, which a chart
leaves out, and which is written in the colour of its cell.
"""

from __future__ import annotations

import io
import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from grasp_xl.grasp import Grasp
from grasp_xl.space import FloatArray, OptionSpace
from grasp_xl.workbook import layout
from grasp_xl.workbook.bill_table import ROWS as BILL_ROWS
from grasp_xl.workbook.bill_table import write_bill
from grasp_xl.workbook.calc_block import CalcBlock
from grasp_xl.workbook.calc_edges import EDGE_COLUMN, PART_POLYGON_COLUMN, closed_polygon
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
    RED,
    Style,
)

PLACE_COLOURS = ("#8CCFD8", "#E3A3C8")
"""Pale cyan and magenta: where footprints lie dense, elements stand out by lightness as well."""
FILL_COLOURS = (CYAN, MAGENTA)
OUTLINE_COLOURS = (DARK_CYAN, DARK_MAGENTA)
CORNERS = 36
"""Corners of a circle."""
RINGS = ((1.0, 18), (0.25, 6))
"""Radius, as part of the outer one's, and corners of the rings that fill a circle."""
RING_WIDTH = 0.6
"""Width of their lines, as part of the circle's radius: they overlap, and end at its outline."""
EDGE = 2.0
"""Width of an outline (points)."""
POINTS_PER_PIXEL = 0.75
PLOT_WIDTH, PLOT_HEIGHT = 600, 500
"""Most that the inner plot area of a picture takes (pixels)."""
FRAME, LEGEND = 80, 50
"""Pixels around the plot area for axes and titles, and below them for the legend's many lines."""
LEAST_STEPS, MOST_STEPS = 6, 20
"""Tick distances on the longer axis."""
ROUND_STEPS = (1.0, 2.0, 2.5, 4.0, 5.0, 6.0, 8.0)
LABEL_SIZE = 8
"""Of the axes' labels (points): so that many stand side by side."""
MARGIN = 0.01
"""Free part of the extent on each side, beyond the elements and the part."""
PICTURE_COLUMNS = 12
"""Of the default width, from one picture to the next."""
MESSAGE_ROW = 1
FIRST_POINT = 3
FIRST_END = FIRST_POINT + len(KINDS) + 2
"""Row of the first of the axes' four ends, among the points."""
NO_POINT = "#N/A"
NOT_DRAWN = "The grasp is not drawn: "
OUTSIDE = (
    "Places, corners or the centroid lie outside the picture: run grasp-xl on this workbook to "
    "draw it anew."
)
MOST_SERIES = 255
"""That a chart of Excel's may have."""

RENDERING_SCALE, RENDERING_ROWS = 0.6, 30
"""Of its pixels, and rows that it takes with its title."""
RENDERING_TEXT = "A grasp in three dimensions, drawn by grasp_xl"
"""By which it is known that a picture is ours."""

Number = float | str
Pair = tuple[Number, Number]


@dataclass(frozen=True, slots=True)
class Picture:
    """One plan view: a title, the grasp as the engine sees it, and its helper cells."""

    title: str
    grasp: Grasp
    block: CalcBlock


@dataclass(frozen=True, slots=True)
class Rendering:
    """A picture of a grasp in three dimensions: a PNG file, and which grasp it shows."""

    png: bytes
    told: str


@dataclass(frozen=True, slots=True)
class Frame:
    """What a picture shows, and its scale: the same for both axes, exactly.

    Parameters
    ----------
    low_mm, high_mm : tuple of float
        Ends of the x and of the y axis.
    step_mm : float
        Distance of the tick marks.
    pixels : tuple of int
        Width and height of the inner plot area.
    """

    low_mm: tuple[float, float]
    high_mm: tuple[float, float]
    step_mm: float
    pixels: tuple[int, int]

    @property
    def pixels_per_mm(self) -> float:
        """The scale."""
        return self.pixels[0] / (self.high_mm[0] - self.low_mm[0])

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of the picture (pixels): a narrow part's has room for its legend."""
        return PLOT_WIDTH + 2 * FRAME, self.pixels[1] + 2 * FRAME + LEGEND

    @property
    def rows(self) -> int:
        """Rows of the sheet that the picture takes, with the one above it."""
        return 3 + math.ceil(self.size[1] * POINTS_PER_PIXEL / ROW_HEIGHT)

    def line_points(self, width_mm: float) -> float:
        """Return a line's width, as a chart takes it: in quarters of a point, and no thinner."""
        return math.ceil(width_mm * self.pixels_per_mm * POINTS_PER_PIXEL * 4) / 4


@dataclass(frozen=True, slots=True)
class Stroke:
    """A line of the picture: points and the formulas that give them; x and y of each."""

    points: list[Pair]
    formulas: list[tuple[str, str]]


def write_grasp(
    pen: Pen,
    book: Any,  # noqa: ANN401 (untyped library)
    space: OptionSpace,
    pictures: list[Picture],
    rendering: Rendering | None,
) -> None:
    """Write one picture a grasp, side by side, and the points that each is drawn from.

    The first is that of the What-if card.  Below them stands its bill of material, and then the
    rendering, if there is one: that does not follow the cells.
    """
    pen.write(0, 0, "GRASP: plan view to scale (mm), live with the What-if card", Style.TITLE)
    pen.write(0, GRASP_DATA_COLUMN, "Points that the pictures are drawn from", Style.NOTE)
    column = GRASP_DATA_COLUMN
    pen.row(2, column, ("cosine", "sine"), Style.HEADER)
    for row, unit in enumerate((*OUTLINE, *FILL), FIRST_POINT):
        pen.row(row, column, unit, Style.COORDINATE)
    frame = frame_of(space)
    pen.write(2, column + 2, "inset of the filling", Style.HEADER)
    for number in range(len(KINDS)):
        cell = _inset_cell(number)
        pen.write(cell.row, cell.column, _filling(space, number, frame)[1], Style.COORDINATE)
    ends = Area(GRASP, FIRST_END, column + 2, 4)
    pen.write(ends.row - 1, ends.column, "x from, to; y from, to (mm)", Style.HEADER)
    for row, end in enumerate(zip(frame.low_mm, frame.high_mm, strict=True)):
        for side in range(2):
            pen.write(ends.row + 2 * row + side, ends.column, end[side], Style.COORDINATE)
    column += 4
    for number, picture in enumerate(pictures):
        told = _message(space, picture, ends)
        pen.write(MESSAGE_ROW, number * PICTURE_COLUMNS, "", Style.WARNING, told)
        chart = book.add_chart({"type": "scatter", "subtype": "straight"})
        strokes, column = _write_strokes(pen, space, picture, column, frame)
        _add_series(chart, _places_series(space), [*_polygon_series(space), *strokes])
        _to_scale(chart, frame, picture.title)
        pen.insert_chart(2, number * PICTURE_COLUMNS, chart)
    pen.hide_errors(Area(GRASP, FIRST_POINT, GRASP_DATA_COLUMN, CORNERS + 1, column))
    what_if = pictures[0]
    fault = what_if.block.summary("fault").reference
    write_bill(pen, frame.rows, space, what_if.grasp, fault)
    rows = frame.rows + BILL_ROWS
    pages = [Area(GRASP, 0, 0, rows, len(pictures) * PICTURE_COLUMNS)]
    if rendering:
        pages.append(_write_rendering(pen, rendering, rows + 1))
    pen.fix_row_heights()
    pen.print_pages(pictures=pages)


def _write_rendering(pen: Pen, rendering: Rendering, row: int) -> Area:
    """Insert a rendering under its title; return where both stand."""
    pen.write(row, 0, rendering.told, Style.TITLE)
    image = {
        "image_data": io.BytesIO(rendering.png),
        "x_scale": RENDERING_SCALE,
        "y_scale": RENDERING_SCALE,
        "description": RENDERING_TEXT,
    }
    pen.sheet.insert_image(row + 1, 0, "rendering.png", image)
    return Area(GRASP, row, 0, RENDERING_ROWS, PICTURE_COLUMNS)


def _series(name: str, x: Area, y: Area, look: dict[str, Any]) -> dict[str, Any]:
    return {"name": name, "categories": f"={x.reference}", "values": f"={y.reference}", **look}


def _message(space: OptionSpace, picture: Picture, ends: Area) -> str:
    """Return the formula of a sentence on what a picture cannot show, if anything."""
    lists = [
        labels.locations_name for labels, kind in zip(KINDS, space.kinds, strict=True) if kind.total
    ]
    lists += [layout.IDEAL_POLYGON, layout.APPROXIMATION_POLYGON]
    beyond = []
    for axis, centroid in enumerate(("CentroidX", "CentroidY")):
        low, high = (ends.cell(2 * axis + side, 0).absolute for side in range(2))
        for cells in (*(f"INDEX({name},0,{axis + 1})" for name in lists), centroid):
            beyond += [f'COUNTIF({cells},"<"&{low})', f'COUNTIF({cells},">"&{high})']
    fault = picture.block.summary("fault").reference
    outside = f'IF({"+".join(beyond)}>0,"{OUTSIDE}","")'
    return f'IF({fault}="",{outside},"{NOT_DRAWN}"&{fault})'


def _line(colour: str, width: float) -> dict[str, Any]:
    return {"line": {"color": colour, "width": width}, "marker": {"type": "none"}}


def _mark(shape: str, colour: str, size: int, *, filled: bool = True) -> dict[str, Any]:
    fill = {"color": colour} if filled else {"none": True}
    marker = {"type": shape, "size": size, "border": {"color": colour}, "fill": fill}
    return {"line": {"none": True}, "marker": marker}


def _places_series(space: OptionSpace) -> list[dict[str, Any]]:
    """Return a series of all footprints of each kind, straight from their cells."""
    series = []
    for labels, kind, colour in zip(KINDS, space.kinds, PLACE_COLOURS, strict=True):
        if kind.total:
            x = Area(OPTION_SPACE, layout.FIRST_LOCATION_ROW, labels.column, kind.total)
            y = Area(OPTION_SPACE, x.row, x.column + 1, x.rows)
            look = _mark("circle", colour, 2, filled=False)
            series.append(_series(f"Places for {labels.plural}", x, y, look))
    return series


def _polygon_series(space: OptionSpace) -> list[dict[str, Any]]:
    """Return both polygons, straight from their cells."""
    corners = len(space.ideal_polygon_mm)
    return [
        _series(
            name,
            closed_polygon(column, corners),
            closed_polygon(column + 1, corners),
            _line(colour, 1.5),
        )
        for name, column, colour in (
            ("Part polygon", PART_POLYGON_COLUMN, GREEN),
            ("Ideal polygon", EDGE_COLUMN + 1, BLUE),
        )
    ]


def _write_strokes(
    pen: Pen, space: OptionSpace, picture: Picture, column: int, frame: Frame
) -> tuple[list[dict[str, Any]], int]:
    """Write the points of elements, trusses and centres; return series and next free column."""
    series = []
    for name, stroke, look in _strokes(space, picture, column, frame):
        pen.write(2, column, name or "(more)", Style.HEADER)
        for row, (point, formulas) in enumerate(
            zip(stroke.points, stroke.formulas, strict=True), FIRST_POINT
        ):
            for axis in range(2):
                pen.write(row, column + axis, point[axis], Style.COORDINATE, formulas[axis])
        x = Area(GRASP, FIRST_POINT, column, len(stroke.points))
        series.append(_series(name, x, Area(GRASP, x.row, column + 1, x.rows), look))
        column += 2
    return series, column + 1


def _add_series(
    chart: Any,  # noqa: ANN401 (untyped library)
    below: list[dict[str, Any]],
    above: list[dict[str, Any]],
) -> None:
    """Draw some series below others, each of these above the one before it.

    Excel draws later series over earlier ones, LibreOffice the other way.  So what is above stands
    on both sides of what is below, mirrored, and once in the legend.  Where a chart cannot have so
    many series (a Max. above 20 of both kinds), it is right in Excel only.
    """
    mirrored = above[::-1] if 2 * len(above) + len(below) <= MOST_SERIES else []
    series = [*mirrored, *below, *above]
    for each in series:
        chart.add_series(each)
    unnamed = [number for number, each in enumerate(series) if not each["name"]]
    hidden = sorted({*range(len(mirrored)), *unnamed})
    chart.set_legend({"position": "bottom", "delete_series": hidden})


def _strokes(
    space: OptionSpace, picture: Picture, column: int, frame: Frame
) -> Iterator[tuple[str, Stroke, dict[str, Any]]]:
    """Yield name, points and look, from the bottom up; only one of a group has a name."""
    block = picture.block
    rows = [row for row in range(block.size) if space.kinds[row // block.slots].total]
    for row in rows:
        number = row // block.slots
        look = _line(FILL_COLOURS[number], _filling(space, number, frame)[0])
        yield "", _fill(space, picture, row, frame), look
    ends = Area(GRASP, FIRST_POINT, column + 2 * len(rows), 2)
    yield "Main truss", _main_truss(picture), _line(RED, 3.5)
    for row in rows:
        name = "Branch trusses" if row == rows[0] else ""
        yield name, _branch(picture, row, ends), _line(RED, 1)
    for row in rows:
        number, first = divmod(row, block.slots)
        name = "" if first else KINDS[number].plural.capitalize()
        yield name, _outline(space, picture, row), _line(OUTLINE_COLOURS[number], EDGE)
    centroid = [(float(space.part.centroid_mm[0]), float(space.part.centroid_mm[1]))]
    yield "Centroid", Stroke([*centroid], [("CentroidX", "CentroidY")]), _mark("x", BLACK, 9)
    force, usable = block.column("force (N)").reference, block.summary("usable").reference
    mean = [
        f"IF({usable}*SUM({force})=0,NA(),"
        f"SUMPRODUCT({force}*{block.column(axis).reference})/SUM({force}))"
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


def _drawn(block: CalcBlock, row: int) -> str:
    """Return the condition, 1 or 0, that an element is drawn: it is active in a usable grasp."""
    return f"{block.element('active', row).reference}*{block.summary('usable').reference}"


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
    usable = block.summary("usable").reference
    for end in ("main truss from", "main truss to"):
        row = block.summary(end).reference
        x, y = (
            f"IF({usable}*{row}=0,NA(),INDEX({block.column(axis).reference},{row}))"
            for axis in ("x", "y")
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
    on = f"{_drawn(block, row)}*({start_row}>0)*({start_row}<>{row + 1})*({end_row}<>{row + 1})=1"
    foot = (f"{x0}+{along_formula}*{dx}", f"{y0}+{along_formula}*{dy}")
    formulas = [
        (f"IF({on},{x},NA())", f"IF({on},{y},NA())"),
        (f"IF({on},{foot[0]},NA())", f"IF({on},{foot[1]},NA())"),
    ]
    return Stroke(points, formulas)


def _ring(corners: int, radius: float = 1.0) -> Iterator[Pair]:
    """Yield the points of a closed circle about 0."""
    for turn in np.linspace(0.0, 2.0 * math.pi, corners + 1).tolist():
        yield radius * math.cos(turn), radius * math.sin(turn)


OUTLINE = tuple(_ring(CORNERS))
FILL = tuple(point for radius, corners in RINGS for point in _ring(corners, radius))


def _diameter_mm(space: OptionSpace, number: int) -> float:
    return space.kinds[number].diameter_mm or DEFAULT_DIAMETERS_MM[number]


def _filling(space: OptionSpace, number: int, frame: Frame) -> tuple[float, float]:
    """Return the width of the rings' line (points), and how far inside the edge it runs (mm)."""
    width = frame.line_points(RING_WIDTH * _diameter_mm(space, number) / 2)
    return width, (width + EDGE / 2) / 2 / POINTS_PER_PIXEL / frame.pixels_per_mm


def _inset_cell(number: int) -> Area:
    """Return where a filling's inset stands: a formula with the number would not outlast a run."""
    return Area(GRASP, FIRST_POINT + number, GRASP_DATA_COLUMN + 2)


def _outline(space: OptionSpace, picture: Picture, row: int) -> Stroke:
    """Draw the edge of an element at its true diameter."""
    return _circle(space, picture, row, slice(0, len(OUTLINE)))


def _fill(space: OptionSpace, picture: Picture, row: int, frame: Frame) -> Stroke:
    """Fill an element up to its outline with rings."""
    _, inset_mm = _filling(space, row // picture.block.slots, frame)
    return _circle(space, picture, row, slice(len(OUTLINE), len(OUTLINE) + len(FILL)), inset_mm)


def _circle(
    space: OptionSpace, picture: Picture, row: int, units: slice, inset_mm: float = 0.0
) -> Stroke:
    """Draw circles about an element, so far inside its edge, from some of the unit points."""
    block, here = picture.block, _places(picture).get(row)
    number = row // block.slots
    name, assumed = KINDS[number].diameter.name, DEFAULT_DIAMETERS_MM[number]
    radius_mm = max(0.0, _diameter_mm(space, number) / 2 - inset_mm)
    radius = f"IF(ISNUMBER({name}),{name},{assumed:g})/2"
    if inset_mm:
        radius = f"MAX(0,{radius}-{_inset_cell(number).absolute})"
    drawn = _drawn(block, row)
    x, y = (block.element(axis, row).reference for axis in ("x", "y"))
    points: list[Pair] = []
    formulas = []
    for offset, unit in list(enumerate((*OUTLINE, *FILL)))[units]:
        around = radius_mm * np.array(unit)
        points.append((NO_POINT, NO_POINT) if here is None else _pair(here + around))
        cosine, sine = (
            Area(GRASP, FIRST_POINT + offset, GRASP_DATA_COLUMN + axis).absolute
            for axis in range(2)
        )
        formulas.append(
            (
                f"IF({drawn},{x}+{radius}*{cosine},NA())",
                f"IF({drawn},{y}+{radius}*{sine},NA())",
            )
        )
    return Stroke(points, formulas)


def _to_scale(chart: Any, frame: Frame, title: str) -> None:  # noqa: ANN401 (untyped library)
    for number, set_axis in enumerate((chart.set_x_axis, chart.set_y_axis)):
        set_axis(
            {
                "name": "xy"[number] + " (mm)",
                "min": frame.low_mm[number],
                "max": frame.high_mm[number],
                "major_unit": frame.step_mm,
                "num_format": "0.###",
                "num_font": {"size": LABEL_SIZE},
                "label_position": "low",
                "crossing": "min",
                "major_gridlines": {"visible": False},
            }
        )
    width, height = frame.size
    chart.set_size({"width": width, "height": height})
    chart.set_plotarea(
        {
            "layout": {
                "x": (width - frame.pixels[0]) / 2 / width,
                "y": FRAME / 2 / height,
                "width": frame.pixels[0] / width,
                "height": frame.pixels[1] / height,
            }
        }
    )
    chart.set_title({"name": title, "name_font": {"size": 11}})


def frame_of(space: OptionSpace) -> Frame:
    """Frame elements at all places, polygons and centroid, as large as the plot area takes.

    The axes begin at a multiple of their tick distance, so that they are labelled by round
    numbers, and end where the part or an element does.
    """
    corners = [space.approximation_polygon_mm[:, :2], space.ideal_polygon_mm[:, :2]]
    corners += [space.part.centroid_mm[None, :2]]
    for number, kind in enumerate(space.kinds):
        radius = _diameter_mm(space, number) / 2
        corners += [kind.footprints_mm[:, :2] + side for side in (-radius, radius)]
    everything = np.vstack(corners)
    low, high = everything.min(axis=0), everything.max(axis=0)
    margin = MARGIN * float((high - low).max())
    low, high = low - margin, high + margin
    step = _step(low, high)
    low = np.floor(low / step) * step
    extent = (high - low).tolist()
    scale = min(PLOT_WIDTH / extent[0], PLOT_HEIGHT / extent[1])
    # Whole pixels, and with them the far ends, are rounded so that both axes keep the scale.
    width, height = (math.ceil(length * scale - 1e-6) for length in extent)
    ends = (float(low[0]) + width / scale, float(low[1]) + height / scale)
    return Frame((float(low[0]), float(low[1])), ends, step, (width, height))


def _step(low: FloatArray, high: FloatArray) -> float:
    """Return the round tick distance whose multiples below the extent waste the least."""
    longest = float((high - low).max())
    power = 10.0 ** math.floor(math.log10(longest / MOST_STEPS))
    steps = [step * power * more for step in ROUND_STEPS for more in (1.0, 10.0)]
    usable = [step for step in steps if LEAST_STEPS <= longest / step <= MOST_STEPS]
    return min(usable, key=lambda step: float(np.prod(high - np.floor(low / step) * step)))
