"""Flat parts from DXF drawings: what is drawn, in which unit, what is open, crossed or nested."""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from typing import Any

import ezdxf
import numpy as np
import pytest
import shapely
from ezdxf.document import Drawing
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely import Point, box

from grasp_xl.errors import InputError
from grasp_xl.fitment.caps import SAG_MM
from grasp_xl.fitment.dxf_file import read_dxf
from grasp_xl.fitment.part import CadPart
from grasp_xl.fitment.part_file import GAP_MM
from grasp_xl.fitment.words import UNITS

Draw = Callable[[Any], object]
CODES = {"mm": 4, "in": 1, "cm": 5, "m": 6, "ft": 2, "none": 0}


@pytest.fixture
def drawn(tmp_path: Path) -> Callable[..., Path]:
    """Save a drawing."""

    def save(
        *draw: Draw, unit: str = "mm", change: Callable[[Drawing], object] | None = None
    ) -> Path:
        drawing = ezdxf.new("R2010", units=CODES[unit])
        for one in draw:
            one(drawing.modelspace())
        if change:
            change(drawing)
        path = tmp_path / "part.dxf"
        drawing.saveas(path)
        return path

    return save


def read(path: Path, **options: Any) -> CadPart:
    """Read a part of 2 mm sheet."""
    usual = {
        "units": None,
        "thickness_mm": 2.0,
        "part": None,
        "ignored_layers": (),
        "gap_mm": GAP_MM,
    }
    return read_dxf(path, **{**usual, **options})


def problems(path: Path, **options: Any) -> list[str]:
    """Return what is told of a drawing that is refused."""
    with pytest.raises(InputError) as caught:
        read(path, **options)
    return [str(problem) for problem in caught.value.problems]


def rectangle(x: float, y: float, width: float, height: float, **attributes: Any) -> Draw:
    """Draw a closed polyline."""
    corners = [(x, y), (x + width, y), (x + width, y + height), (x, y + height)]
    return lambda space: space.add_lwpolyline(corners, close=True, dxfattribs=attributes)


def circle(x: float, y: float, radius: float, **attributes: Any) -> Draw:
    return lambda space: space.add_circle((x, y), radius, dxfattribs=attributes)


def lines(*corners: tuple[float, float], **attributes: Any) -> Draw:
    """Draw lines from corner to corner."""

    def draw(space: Any) -> None:
        for start, end in pairwise(corners):
            space.add_line(start, end, dxfattribs=attributes)

    return draw


PLATE = rectangle(10, 20, 200, 100)
HOLE = circle(60, 70, 15)


def test_a_plate_with_a_hole(drawn: Callable[..., Path]) -> None:
    """Area, volume, centroid and height by hand; the hole's chords stray by the sag at most."""
    part = read(drawn(PLATE, HOLE))
    hole = math.pi * 15**2
    area = 200 * 100 - hole
    assert part.plan.area == pytest.approx(area, abs=2 * math.pi * 15 * SAG_MM)
    assert part.volume_mm3 == pytest.approx(2 * area, rel=1e-6)
    assert part.centroid_mm == pytest.approx([(2e4 * 110 - hole * 60) / area, 70, 1], abs=1e-5)
    (face,) = part.faces
    assert face.height_mm == 2
    (ring,) = face.outline.interiors
    assert shapely.Polygon(ring).symmetric_difference(Point(60, 70).buffer(15, 256)).area < 5
    assert Point(60, 70).distance(ring) >= 15 - 1e-5  # no element stands over the true edge
    assert Point(60, 70).hausdorff_distance(ring) <= 15 + SAG_MM


@pytest.mark.parametrize("radius", [1.0, 5.0, 50.0])
def test_the_area_of_arcs_is_that_of_their_circles(
    drawn: Callable[..., Path], radius: float
) -> None:
    """A disc; a ring of two half circles by bulges; an ellipse: to two thousandths at a radius of 1 mm, and better at larger ones."""
    x, across = 3 * radius, {"major_axis": (2 * radius, 0), "ratio": 0.5}
    bulged = [(-radius, 0, 1), (radius, 0, 1)]
    for draw, factor in (
        (circle(x, 0, radius), 1),
        (lambda space: space.add_lwpolyline(bulged, "xyb", close=True), 1),
        (lambda space: space.add_ellipse((x, 0), **across), 2),
    ):
        volume = read(drawn(draw)).volume_mm3
        assert volume == pytest.approx(2 * factor * math.pi * radius**2, rel=2e-3 / radius)


def test_rising_polylines_are_noted(drawn: Callable[..., Path]) -> None:
    """A flat part has none."""
    corners = [(0, 0, 0), (300, 0, 0), (300, 200, 80), (0, 200, 80)]
    part = read(drawn(lambda space: space.add_polyline3d(corners, close=True)))
    (note,) = part.notes
    assert "corners at z 0 to 80 mm" in note.found


def test_a_unit_that_is_not_usual_is_named(drawn: Callable[..., Path]) -> None:
    """Not called missing; --units beats it, with a note."""

    def in_kilometres(drawing: Drawing) -> None:
        drawing.header["$INSUNITS"] = 7

    path = drawn(PLATE, change=in_kilometres)
    assert "a drawing in kilometers" in problems(path)[0]
    (note,) = read(path, units="mm").notes
    assert note.found == "a drawing in kilometers"


@pytest.mark.parametrize("unit", UNITS)
def test_units_of_the_file_are_converted(drawn: Callable[..., Path], unit: str) -> None:
    """A plate of 2 x 1 units, with the sag still in mm."""
    part = read(drawn(rectangle(0, 0, 2, 1), circle(1, 0.5, 0.25), unit=unit))
    mm = UNITS[unit]
    area = (2 - math.pi * 0.25**2) * mm**2
    assert part.plan.area == pytest.approx(area, abs=2 * math.pi * 0.25 * mm * SAG_MM)


def test_a_drawing_without_a_unit_asks_for_it(drawn: Callable[..., Path]) -> None:
    """Nothing is guessed; the size in either unit helps; a person's word beats the file's."""
    path = drawn(PLATE, unit="none")
    (told,) = problems(path)
    assert "a drawing of 200 x 100 that says no unit" in told
    assert "--units in if it is 5080 x 2540 mm large" in told
    assert read(path, units="in").plan.area == pytest.approx(2e4 * 25.4**2)
    part = read(drawn(PLATE, unit="mm"), units="in")
    assert part.plan.area == pytest.approx(2e4 * 25.4**2)
    assert part.notes[0].found == "a drawing in mm"


def test_every_kind_of_curve_makes_an_outline(drawn: Callable[..., Path]) -> None:
    """Lines, arcs, bulges, ellipses and splines; area by their formulas."""

    def curves(space: Any) -> None:
        space.add_line((0, 0), (400, 0))
        space.add_arc((400, 100), 100, -90, 90)
        space.add_line((400, 200), (0, 200))
        space.add_lwpolyline([(0, 200, 0, 0, 1), (0, 0)])  # a half circle by its bulge
        space.add_ellipse((100, 100), (50, 0), 0.5)
        space.add_spline([(300, 50), (350, 100), (300, 150), (250, 100), (300, 50)])

    part = read(drawn(curves))
    assert len(part.plan.interiors) == 2
    outer = 400 * 200 + math.pi * 100**2
    assert shapely.Polygon(part.plan.exterior).area == pytest.approx(outer, rel=1e-3)
    areas = sorted(shapely.Polygon(ring).area for ring in part.plan.interiors)
    assert areas[0] == pytest.approx(math.pi * 50 * 25, rel=5e-3)


def test_blocks_are_drawn_where_they_are_inserted(drawn: Callable[..., Path]) -> None:
    """Scaled, turned, mirrored, nested, in rows and columns."""

    def insert(space: Any) -> None:
        hole = space.doc.blocks.new("HOLE")
        hole.add_circle((1, 0), 2)
        pair = space.doc.blocks.new("PAIR")
        pair.add_blockref("HOLE", (0, 0))
        pair.add_blockref("HOLE", (20, 0), {"xscale": -1})
        space.add_blockref("PAIR", (40, 40), {"rotation": 90})
        space.add_blockref("HOLE", (100, 50), {"xscale": 2, "yscale": 2})
        grid = {"row_count": 2, "column_count": 3, "row_spacing": 10, "column_spacing": 10}
        space.add_blockref("HOLE", (150, 50), grid)

    part = read(drawn(PLATE, insert))
    middles = sorted(
        (round(ring.centroid.x, 3) + 0.0, round(ring.centroid.y, 3)) for ring in part.plan.interiors
    )
    rows = [(151 + 10 * column, 50 + 10 * row) for column in range(3) for row in range(2)]
    assert middles == sorted([(40, 41), (40, 59), (102, 50), *rows])


def test_mirrored_entities_stand_where_a_viewer_shows_them(drawn: Callable[..., Path]) -> None:
    """A circle whose extrusion looks down has its x mirrored (the object coordinate system)."""
    part = read(drawn(PLATE, circle(-60, 70, 15, extrusion=(0, 0, -1))))
    (ring,) = part.plan.interiors
    assert (ring.centroid.x, ring.centroid.y) == pytest.approx((60, 70), abs=1e-6)


def test_annotation_is_no_outline(drawn: Callable[..., Path]) -> None:
    """Texts, dimensions, points and hatches do not count, and nothing is said of them."""

    def annotate(space: Any) -> None:
        space.add_text("R15").set_placement((50, 50))
        space.add_mtext("2 mm steel")
        space.add_point((0, 0))
        space.add_hatch().paths.add_polyline_path([(0, 0), (10, 0), (10, 10)])
        space.add_linear_dim(base=(0, -20), p1=(10, 20), p2=(210, 20)).render()

    part = read(drawn(PLATE, HOLE, annotate))
    assert len(part.plan.interiors) == 1
    assert part.notes == ()


def test_entities_that_are_no_curves_are_told(drawn: Callable[..., Path]) -> None:
    """A solid fill or a 3-D face beside the outline is left out with a note."""
    part = read(drawn(PLATE, lambda space: space.add_3dface([(0, 0, 0), (1, 0, 0), (1, 1, 0)])))
    assert part.notes[0].found == "entities that are no curves (1 3DFACE)"


def test_layers_that_are_off_frozen_or_ignored_are_left_out(drawn: Callable[..., Path]) -> None:
    """The first two with a note, the last as it was asked for."""

    def switch(drawing: Drawing) -> None:
        for name in ("OFF", "FROZEN", "BEND"):
            drawing.layers.add(name)
        drawing.layers.get("OFF").off()
        drawing.layers.get("FROZEN").freeze()

    extra = [circle(50, 50, 5, layer="OFF"), circle(80, 50, 5, layer="FROZEN")]
    bend = lines((10, 70), (210, 70), layer="BEND")
    path = drawn(PLATE, *extra, bend, change=switch)
    part = read(path, ignored_layers=("bend",))
    assert len(part.plan.interiors) == 0
    assert part.notes[0].found == "layers with lines that are switched off ('FROZEN', 'OFF')"
    (told,) = problems(path, ignored_layers=("BENDS",))
    assert "no layer 'BENDS' with lines, expected one of '0', 'BEND', 'FROZEN', 'OFF'" in told


def test_what_divides_a_part_is_told(drawn: Callable[..., Path]) -> None:
    """A bend line from edge to edge, a hole that touches an edge, outlines that cross."""
    bend = lines((10, 70), (210, 70), layer="BEND")
    (told,) = problems(drawn(PLATE, bend))
    assert "lines that meet and enclose 2 areas" in told
    assert "layer '0', 'BEND'" in told or "layer 'BEND'" in told
    assert "--ignore-layer" in told
    for other in (circle(25, 70, 15), circle(10, 70, 15), rectangle(100, 50, 300, 10)):
        (told,) = problems(drawn(PLATE, other))
        assert "lines that meet and enclose" in told


@pytest.mark.parametrize("gap", [0.0, 1e-7, 0.02, 0.05])
def test_small_gaps_are_closed(drawn: Callable[..., Path], gap: float) -> None:
    """Up to the tolerance, wherever they are; the area stays but for them."""
    outline = lines((0, 0), (100, 0), (100, 50), (0, 50), (0, gap))
    assert read(drawn(outline)).plan.area == pytest.approx(5000, abs=0.1)


def test_larger_gaps_are_told_with_place_and_size(drawn: Callable[..., Path]) -> None:
    """All of them at once, with the layer; a larger tolerance closes them."""
    one = lines((0, 0), (100, 0), (100, 50), (0, 50), (0, 0.3), layer="CUT")
    other = lines((200, 0), (300, 0), (300, 50), (200, 50), (200, 0.2))
    path = drawn(one, other)
    told = problems(path)
    assert len(told) == 4
    assert "layer 'CUT', x 0 y 0.3 mm: found an outline that ends there, 0.3 mm from" in "".join(
        told
    )
    assert "raise --gap" in told[0]
    assert read(path, gap_mm=0.3, part=1).plan.area == pytest.approx(5000, abs=0.1)


def test_a_chain_of_tiny_lines_is_not_pulled_together(drawn: Callable[..., Path]) -> None:
    """Lines shorter than the tolerance keep their places, as their ends meet others."""
    around = [
        (20 * math.cos(2 * math.pi * k / 4000), 20 * math.sin(2 * math.pi * k / 4000))
        for k in range(4000)
    ]
    part = read(drawn(lines(*around, around[0])))
    assert part.plan.area == pytest.approx(math.pi * 400, rel=1e-4)


def test_lines_that_are_drawn_twice_do_no_harm(drawn: Callable[..., Path]) -> None:
    """Also where one lies on a part of another."""
    twice = lines((10, 20), (210, 20))
    part = read(drawn(PLATE, twice, lines((50, 120), (80, 120)), HOLE, HOLE))
    assert len(part.plan.interiors) == 1
    assert shapely.Polygon(part.plan.exterior).equals(box(10, 20, 210, 120))


def test_several_parts_are_listed_and_one_is_named(drawn: Callable[..., Path]) -> None:
    """The largest first; an island in a hole is a part of its own."""
    path = drawn(PLATE, circle(110, 70, 40), circle(110, 70, 10), rectangle(500, 0, 50, 50))
    (told,) = problems(path)
    assert "found 3 parts (1: 200 x 100 mm at x 10 y 20, 1 hole; 2: 50 x 50 mm" in told
    assert "--part" in told
    assert read(path, part=2).plan.equals(box(500, 0, 550, 50))
    assert read(path, part=3).plan.area == pytest.approx(math.pi * 100, rel=0.02)
    (told,) = problems(path, part=4)
    assert "expected a part 4" in told


@settings(deadline=None, max_examples=25, derandomize=True)
@given(
    order=st.permutations(range(6)),
    backwards=st.sets(st.integers(0, 5)),
    shift=st.floats(-1e4, 1e4),
    turn=st.sampled_from([0, 90, 180]),
)
def test_order_direction_and_place_of_lines_do_not_matter(
    tmp_path_factory: pytest.TempPathFactory,
    order: list[int],
    backwards: set[int],
    shift: float,
    turn: int,
) -> None:
    """The same part, moved."""
    corners = [(0, 0), (90, 0), (120, 40), (100, 80), (40, 100), (0, 60)]
    turned = [
        (x * c - y * s + shift, x * s + y * c - shift)
        for c, s in [(round(math.cos(math.radians(turn))), round(math.sin(math.radians(turn))))]
        for x, y in corners
    ]
    drawing = ezdxf.new("R2010", units=4)
    for number in order:
        ends = (turned[number], turned[(number + 1) % 6])
        drawing.modelspace().add_line(*(ends[::-1] if number in backwards else ends))
    path = tmp_path_factory.mktemp("dxf") / "part.dxf"
    drawing.saveas(path)
    found = read(path).plan
    assert found.symmetric_difference(shapely.Polygon(turned)).area < 1e-3


@pytest.mark.parametrize(
    ("content", "told"),
    [
        (b"", "an empty file"),
        (b"ISO-10303-21;\nHEADER;\nENDSEC;\n", "a file that is no DXF drawing"),
        (b"AC1032\0\0\0\0" + bytes(200), "a DWG drawing"),
        (b"hello\n" * 100, "a file that is no DXF drawing"),
    ],
    ids=["empty", "step", "dwg", "text"],
)
def test_what_is_no_drawing_is_told(tmp_path: Path, content: bytes, told: str) -> None:
    """In one sentence."""
    path = tmp_path / "part.dxf"
    path.write_bytes(content)
    (problem,) = problems(path)
    assert told in problem


def test_drawings_without_outlines_are_told(drawn: Callable[..., Path], tmp_path: Path) -> None:
    """Nothing in it, or texts and 3-D bodies alone, or lines that enclose nothing; a folder."""
    (told,) = problems(drawn())
    assert "a drawing without lines that are shown (nothing)" in told
    (told,) = problems(drawn(lambda space: space.add_3dface([(0, 0, 0), (1, 0, 0), (1, 1, 0)])))
    assert "(1 3DFACE)" in told
    assert len(problems(drawn(lines((0, 0), (10, 0))))) == 2
    assert len(problems(drawn(lines((0, 0), (10, 0), (0, 0))))) == 2
    thin = [lines((0, y), (10, 0.01 - y)) for y in (0, 0.01)]  # cross, and are bridged at the ends
    (told,) = problems(drawn(*thin))
    assert "no closed outline" in told
    (told,) = problems(tmp_path)
    assert "found a folder" in told


def test_a_binary_drawing_is_read(drawn: Callable[..., Path]) -> None:
    """DXF has a binary form, too."""
    path = drawn(PLATE, HOLE)
    ezdxf.readfile(path).saveas(path, fmt="bin")
    assert len(read(path).plan.interiors) == 1
    path.write_bytes(path.read_bytes()[:-500])
    (told,) = problems(path)
    assert "a drawing that breaks off" in told


def test_half_a_file_is_told(drawn: Callable[..., Path]) -> None:
    """A drawing that was cut off is no drawing, whatever is left of it."""
    path = drawn(PLATE, *[circle(x, 70, 2) for x in range(20, 200, 8)])
    content = path.read_bytes()
    for part in (0.3, 0.6, 0.9):
        path.write_bytes(content[: int(part * len(content))])
        (told,) = problems(path)
        assert "a drawing that breaks off" in told


@pytest.mark.parametrize("radius", [0.02, 15, 200, 5000])
def test_chords_stray_by_the_sag_at_most(drawn: Callable[..., Path], radius: float) -> None:
    """On circles and bulges of any size; an ellipse's area by its formula."""
    half = [(radius, 0, 0, 0, 1), (-radius, 0, 0, 0, 1)]
    for draw in (circle(0, 0, radius), lambda space: space.add_lwpolyline(half, close=True)):
        ring = read(drawn(draw)).plan.exterior
        middles = shapely.get_coordinates(shapely.segmentize(ring, radius / 1000))
        strays = radius - shapely.distance(shapely.points(0, 0), shapely.points(middles))
        assert -1e-6 <= strays.min() <= strays.max() <= SAG_MM + 1e-6
    ellipse = read(drawn(lambda space: space.add_ellipse((0, 0), (0, radius), 0.5))).plan
    assert ellipse.area == pytest.approx(math.pi * radius**2 / 2, abs=5 * radius * SAG_MM)


def test_polylines_of_old_drawings_are_read(drawn: Callable[..., Path]) -> None:
    """POLYLINE with bulges to either side; mirrored, it lies on the other side."""

    def draw(space: Any) -> None:
        corners = [(0, 0, 0), (100, 0, 1), (100, 40, 0), (0, 40, -1)]
        space.add_polyline2d(corners, format="xyb", close=True)
        mirrored = space.add_polyline2d(corners, format="xyb", close=True)
        mirrored.dxf.extrusion = (0, 0, -1)
        mirrored.translate(-300, 0, 0)

    one, other = (read(drawn(draw), part=number).plan for number in (1, 2))
    assert one.area == pytest.approx(4000, abs=0.01)  # one half circle more, one less
    left, right = sorted([one.bounds, other.bounds])
    assert left == pytest.approx((-420, 0, -300, 40), abs=0.05)
    assert right == pytest.approx((0, 0, 120, 40), abs=0.05)


def test_what_a_viewer_hides_is_left_out(drawn: Callable[..., Path]) -> None:
    """Invisible entities, and all that is inserted on a frozen or ignored layer."""

    def insert(space: Any) -> None:
        hole = space.doc.blocks.new("HOLE")
        hole.add_circle((0, 0), 2, dxfattribs={"layer": "CUT"})
        space.add_blockref("HOLE", (40, 40), {"layer": "FROZEN"})
        space.add_blockref("HOLE", (60, 40), {"layer": "TOOLS"})
        space.add_blockref("HOLE", (80, 40))

    path = drawn(
        PLATE,
        insert,
        circle(100, 70, 5, invisible=1),
        change=lambda drawing: drawing.layers.add("FROZEN").freeze(),
    )
    assert len(read(path).plan.interiors) == 2
    (ring,) = read(path, ignored_layers=("TOOLS",)).plan.interiors
    assert ring.centroid.x == pytest.approx(80)


def test_blocks_that_cannot_be_drawn_are_told(
    drawn: Callable[..., Path], monkeypatch: pytest.MonkeyPatch
) -> None:
    """A reference to another file is left out with a note; insertions without end are refused."""

    def refer(drawing: Drawing) -> None:
        drawing.add_xref_def("other.dxf", "OTHER")
        drawing.modelspace().add_blockref("OTHER", (0, 0))

    part = read(drawn(PLATE, change=refer))
    assert part.notes[0].found == "entities that are no curves (1 INSERT)"

    def fill(space: Any) -> None:
        space.doc.blocks.new("DOT").add_circle((0, 0), 1)
        counts = {"row_count": 32000, "column_count": 32000, "row_spacing": 3, "column_spacing": 3}
        space.add_blockref("DOT", (0, 0), counts)

    monkeypatch.setattr("grasp_xl.fitment.dxf_lines.MAX_ENTITIES", 1000)
    (told,) = problems(drawn(PLATE, fill))
    assert "more than 1,000 entities" in told


@pytest.mark.parametrize("noise", [1e-9, 1e-7, 1e-6, 1e-5, 1e-3, 0.015])
@pytest.mark.parametrize("times", [1, 2])
def test_rounded_ends_do_no_harm(drawn: Callable[..., Path], noise: float, times: int) -> None:
    """Lines that end a little too early or late, drawn once or twice, are one outline."""
    corners = [(0, 0), (100, 10), (120, 80), (50, 100), (-10, 60)]
    for seed in range(4):
        rng = np.random.default_rng(seed)

        def draw(space: Any, rng: np.random.Generator = rng) -> None:
            for start, end in times * list(pairwise([*corners, corners[0]])):
                space.add_line(*(np.array([start, end]) + rng.uniform(-noise, noise, (2, 2))))

        assert read(drawn(draw)).plan.area == pytest.approx(9400, abs=1e-4 + 400 * noise)


def test_outlines_that_are_nearly_equal_are_one(drawn: Callable[..., Path]) -> None:
    """A hole drawn twice is no hole with an island, and a plate drawn twice no frame."""
    inner = rectangle(10.001, 20.001, 199.998, 99.998)
    crossing = rectangle(10.001, 20.001, 200, 100)
    for twice in (inner, crossing):
        part = read(drawn(PLATE, twice, HOLE, circle(60, 70, 15.002)))
        assert part.plan.area == pytest.approx(2e4 - math.pi * 15**2, abs=10)
        assert len(part.plan.interiors) == 1


def test_lines_that_end_on_slanted_ones_divide(drawn: Callable[..., Path]) -> None:
    """A notch drawn from edge to edge is told, wherever its ends lie: not left out in silence."""
    start, end = np.array([100.0, 0]), np.array([130.0, 77])
    for one in (0.1, 0.31, 1 / 3):
        ends = [tuple(start + share * (end - start)) for share in (one, one + 0.37)]
        outline = [(0, 0), (100, 0), (130, 77), (0, 90), (0, 0)]
        (told,) = problems(drawn(lines(*outline), lines(ends[0], (80, 30), (85, 40), ends[1])))
        assert "lines that meet and enclose 2 areas" in told


def test_links_between_outlines_are_told(drawn: Callable[..., Path]) -> None:
    """A line from an outline to another one is an edge of none."""
    link = lines((210, 50), (300, 50), layer="LINK")
    (told,) = problems(drawn(PLATE, rectangle(300, 0, 50, 100), link))
    assert "a line that links others" in told
    assert "layer 'LINK'" in told


def test_open_lines_in_a_hole_are_left_out(drawn: Callable[..., Path]) -> None:
    """With a note, as no element can stand there; on the part or beside it they are told."""
    stroke = lines((59, 70), (60, 70))
    part = read(drawn(PLATE, HOLE, stroke))
    assert len(part.plan.interiors) == 1
    assert part.notes[0].found == "an open line in a hole"
    assert len(problems(drawn(PLATE, HOLE, lines((100, 70), (101, 70))))) == 2
    assert len(problems(drawn(PLATE, HOLE, lines((300, 70), (301, 70))))) == 2


@pytest.mark.parametrize("value", [math.nan, math.inf, 1e300])
def test_damaged_curves_are_told(drawn: Callable[..., Path], value: float) -> None:
    """Coordinates that are no numbers, or of another world; a hole is not left out in silence."""
    draw = [lines((0, 0), (value, 3)), circle(60, 70, value), circle(value, 70, 2)]
    for one in draw:
        told = problems(drawn(PLATE, one))
        assert "damaged" in told[0] or "no DXF drawing" in told[0]


def test_a_frame_around_a_part_is_noted(drawn: Callable[..., Path]) -> None:
    """A rectangle that is more hole than part; without its layer the part is found, and no note."""
    frame = rectangle(0, 0, 250, 150, layer="FRAME")
    path = drawn(frame, PLATE)
    part = read(path)
    assert part.notes[0].found == "a rectangle with a hole of 53% of its area"
    assert "--ignore-layer" in part.notes[0].hint
    part = read(path, ignored_layers=("FRAME",))
    assert part.plan.equals(box(10, 20, 210, 120))
    assert part.notes == ()
    (told,) = problems(drawn(frame, PLATE, HOLE))
    assert "a frame around them is left out with --ignore-layer" in told
