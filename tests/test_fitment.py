"""From a face to the places where elements can stand: by hand, by property, by the thesis."""

from __future__ import annotations

import math

import numpy as np
import pytest
import shapely
from faces import BAR, CUP, MAGNET, OVAL, flat_part, random_face
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely import Point, Polygon, affinity, box

from grasp_xl.cli.fit_options import MOST_COUNT
from grasp_xl.errors import InputError, UsageError
from grasp_xl.fitment.deflection_polygon import approximation_polygon, in_sight
from grasp_xl.fitment.element import Element
from grasp_xl.fitment.face_choice import choose_faces
from grasp_xl.fitment.fitting import MAX_FOOTPRINTS, Choice, Fitment, fit
from grasp_xl.fitment.footprint import (
    TOLERANCE_MM,
    covered,
    footprint_of,
    largest_disc_mm,
    lies_inside,
    middle_lies_inside,
)
from grasp_xl.fitment.grid import grid, grid_line, grid_size
from grasp_xl.fitment.part import CadPart, Face
from grasp_xl.polygon import contains, is_star_shaped
from grasp_xl.space import MAX_COUNT, OptionSpace
from grasp_xl.workbook import reading_places

SEEDS = st.integers(0, 100_000)
OFTEN = settings(deadline=None, max_examples=60, derandomize=True)
PLATE = box(-50, -50, 50, 50)
CHOSEN = Choice(MAGNET, 30.0, "all-up", 1, 5)


def fitted(
    part: CadPart,
    *,
    cup: Element | None = CUP,
    magnet: Element | None = MAGNET,
    pitch: float = 10.0,
    faces: str = "all-up",
    min_overlap: float = 0.0,
) -> OptionSpace:
    """Fit elements on a part."""
    cups = Choice(cup, 10.0, faces, 1, 5) if cup else None
    magnets = Choice(magnet, 30.0, faces, 1, 5, 0.0, min_overlap) if magnet else None
    return fit(part, Fitment(cups, magnets, pitch, "auto", 0.6), 1000.0).space


# --- the grid ---


def test_the_grid_of_figure_25() -> None:
    """360 x 220 mm at pitch 10: 36 x 22 points, 10.2857 and 10.47619 mm apart, from edge to edge."""
    points = grid(box(-180, -110, 180, 110), 10)
    assert len(points) == 36 * 22 == grid_size(box(-180, -110, 180, 110), 10)
    assert points[0].tolist() == [180, 110]
    assert points[-1].tolist() == [-180, -110]
    assert points[1] == pytest.approx([180, 110 - 10.47619], abs=1e-5)
    assert points[22] == pytest.approx([180 - 10.2857, 110], abs=1e-4)


def test_a_side_of_a_whole_number_of_pitches_has_as_many_points() -> None:
    """Also where round-off makes it a little shorter; a short side has one point, in its middle."""
    for count in range(2, 200):
        assert len(grid_line(0, 0.1 * count, 0.1)) == count
    assert grid_line(4, 4.19, 0.1) == pytest.approx([4.095])


@OFTEN
@given(SEEDS, st.floats(3, 80))
def test_neighbours_are_a_pitch_apart_or_more(seed: int, pitch: float) -> None:
    """So that a low pitch gives dense footprints, and a clearance of the pitch excludes none."""
    x_low, _, x_high, _ = random_face(seed).bounds
    xs = grid_line(x_low, x_high, pitch)
    assert np.all(-np.diff(xs) >= pitch * (1 - 1e-9))
    assert len(xs) == max(1, math.floor((x_high - x_low) / pitch + 1e-9))


# --- footprints by hand ---


def test_a_plate_with_one_hole_counted_by_hand() -> None:
    """Grid points at +-50 (on the edges) and +-16.67: four inner ones, 13.57 mm from the hole."""
    part = flat_part(Face(PLATE.difference(Point(0, 0).buffer(10, 64)), 5.0))
    space = fitted(part, cup=Element("C", "suction", 1.0, diameter_mm=27.0), pitch=25)
    inner = [[50 / 3, 50 / 3], [50 / 3, -50 / 3], [-50 / 3, 50 / 3], [-50 / 3, -50 / 3]]
    for kind in space.kinds:
        assert kind.footprints_mm[:, :2] == pytest.approx(np.array(inner))
        assert kind.footprints_mm[:, 2].tolist() == [5.0] * 4
    with pytest.raises(InputError, match=r"the largest round one has 27\.14 mm"):
        fitted(part, cup=Element("C", "suction", 1.0, diameter_mm=27.2), pitch=25)


def test_the_covered_part_of_a_magnet_is_what_lies_on_the_face() -> None:
    """A magnet of 30 mm beside a hole of 20 mm: all but the lens of both circles."""
    face = PLATE.difference(Point(0, 0).buffer(10, 256))
    r, hole, apart = 15.0, 10.0, 20.0
    ours = (apart**2 + r**2 - hole**2) / (2 * apart)  # from the magnet's middle to the chord
    half = math.sqrt(r**2 - ours**2)
    lens = r**2 * math.acos(ours / r) + hole**2 * math.acos((apart - ours) / hole) - apart * half
    places = np.array([[apart, 0], [50, 20], [50, 50], [30, 30]])
    found = covered(face, places, footprint_of(MAGNET))
    assert found == pytest.approx([1 - lens / (math.pi * r**2), 0.5, 0.25, 1], abs=2e-3)


def test_islands_of_one_height_have_a_grid_each() -> None:
    """Two plates: each has its own grid, the one at greater x is numbered first."""
    left, right = Face(box(0, 0, 100, 100), 7.0), Face(box(150, 0, 250, 100), 7.0)
    space = fitted(flat_part(left, right), pitch=25)
    xs = space.kinds[1].footprints_mm[:, 0]
    assert len(xs) == 2 * 4
    assert np.all(xs[:4] > 150)
    assert np.all(xs[4:] < 100)


def test_faces_are_numbered_from_the_highest() -> None:
    """By descending height, then x, whatever their order in the file."""
    low, high = Face(box(0, 0, 100, 100), 1.0), Face(box(-300, 0, -200, 100), 9.0)
    for faces in ((low, high), (high, low)):
        heights = fitted(flat_part(*faces), pitch=25).kinds[1].footprints_mm[:, 2]
        assert heights.tolist() == [9.0] * 4 + [1.0] * 4


def test_elements_that_are_not_round() -> None:
    """A bar of 60 x 20 mm stands where its corners do; turned by 90 degrees, elsewhere."""
    strip = box(0, 0, 200, 21)
    middle = np.array([[100.0, 10.5], [31.0, 10.5], [29.0, 10.5]])
    assert lies_inside(strip, middle, footprint_of(BAR)).tolist() == [True, True, False]
    assert lies_inside(strip, middle, footprint_of(BAR, 90)).tolist() == [False] * 3
    assert covered(strip, middle, footprint_of(BAR, 90)) == pytest.approx(21 / 60)
    rounded = strip.buffer(-10).buffer(10, 64)
    assert lies_inside(rounded, middle[1:2], footprint_of(OVAL))[0]
    assert not lies_inside(rounded, middle[1:2] - [0.9, 0], footprint_of(BAR))[0]
    assert footprint_of(BAR).diameter_mm == pytest.approx(math.hypot(60, 20))


def test_a_least_overlap_leaves_out_magnets_that_hang_over() -> None:
    """What is kept is covered so far, and only those are kept."""
    part = flat_part(Face(PLATE, 5.0))
    free, kept = fitted(part).kinds[1], fitted(part, min_overlap=0.95).kinds[1]
    assert free.overlap is not None
    assert kept.overlap is not None
    assert kept.total == np.count_nonzero(free.overlap >= 0.95) < free.total
    assert kept.overlap.min() >= 0.95


# --- footprints by property ---


@OFTEN
@given(SEEDS, st.sampled_from([CUP, OVAL, BAR]), st.floats(5, 25), st.floats(0, 180))
def test_all_of_a_cup_lies_on_its_face(
    seed: int, element: Element, pitch: float, angle: float
) -> None:
    """To 1e-6 mm; and a place that is left out has an edge under its footprint."""
    face, footprint = random_face(seed), footprint_of(element, angle)
    places = grid(face, pitch)
    fits = lies_inside(face, places, footprint)
    grown = face.buffer(TOLERANCE_MM)
    for place, outline, inside in zip(places, footprint.at(places), fits, strict=True):
        if inside:
            assert grown.covers(outline)
        elif footprint.is_round:
            distance = face.exterior.distance(Point(place)) if face.covers(Point(place)) else 0
            holes = [hole.distance(Point(place)) for hole in face.interiors]
            assert min(distance, *holes, math.inf) < footprint.radius_mm
        else:
            assert not face.buffer(-2 * TOLERANCE_MM).covers(outline)


@OFTEN
@given(SEEDS, st.floats(5, 25))
def test_the_middle_of_a_magnet_lies_inside_its_face(seed: int, pitch: float) -> None:
    """And not on an edge; its covered part is that of its polygon, cut with the whole face."""
    face, footprint = random_face(seed), footprint_of(MAGNET)
    places = grid(face, pitch)
    inside = middle_lies_inside(face, places)
    points = shapely.points(places)
    assert np.all(shapely.contains_properly(face, points[inside]))
    assert np.all(face.boundary.distance(points[~inside & shapely.covers(face, points)]) < 2e-6)
    cut = shapely.area(shapely.intersection(footprint.at(places[inside]), face))
    fractions = covered(face, places[inside], footprint)
    assert fractions == pytest.approx(cut / footprint.outline.area, abs=1e-9)


@OFTEN
@given(SEEDS, st.floats(0.01, 20))
def test_no_cup_is_lost_where_the_face_grows(seed: int, wider: float) -> None:
    """Holes that shrink and edges that move outwards only add places."""
    face, footprint = random_face(seed), footprint_of(CUP)
    places = grid(face.buffer(30), 7)
    before = lies_inside(face, places, footprint)
    after = lies_inside(face.buffer(wider), places, footprint)
    assert np.all(after[before])


@OFTEN
@given(SEEDS, st.floats(-1e4, 1e4), st.floats(-1e4, 1e4))
def test_a_shifted_or_turned_part_keeps_its_places(seed: int, dx: float, dy: float) -> None:
    """Shifted, turned by 90 degrees, mirrored: the same places, moved likewise."""
    face = random_face(seed)
    moves = (
        (1, 0, 0, 1, dx, dy),  # shifted
        (0, -1, 1, 0, dx, dy),  # turned
        (-1, 0, 0, 1, dx, dy),  # mirrored
    )
    for element, keep in ((CUP, lies_inside), (MAGNET, lambda f, p, _: middle_lies_inside(f, p))):
        footprint, places = footprint_of(element), grid(face, 9)
        kept = shapely.points(places[keep(face, places, footprint)])
        for move in moves:
            moved = affinity.affine_transform(face, move)
            points = grid(moved, 9)
            found = shapely.points(points[keep(moved, points, footprint)])
            assert len(found) == len(kept)
            if len(found):
                same = affinity.affine_transform(shapely.multipoints(kept), move)
                assert same.hausdorff_distance(shapely.multipoints(found)) < 1e-6


@OFTEN
@given(SEEDS)
def test_a_part_in_inches_gives_the_same_places(seed: int) -> None:
    """Drawn in inches and read in mm, a face keeps them."""
    face, footprint = random_face(seed), footprint_of(CUP)
    again = affinity.scale(
        affinity.scale(face, 1 / 25.4, 1 / 25.4, origin=(0, 0)), 25.4, 25.4, origin=(0, 0)
    )
    one, other = (
        f[lies_inside(f_, f, footprint)]
        for f_, f in ((face, grid(face, 9)), (again, grid(again, 9)))
    )
    assert one == pytest.approx(other, abs=1e-9)


@OFTEN
@given(SEEDS)
def test_the_largest_disc_fits_and_no_larger_one(seed: int) -> None:
    """What the message of a cup that fits nowhere names."""
    face = random_face(seed)
    places = grid(face, 9)
    largest = largest_disc_mm(face, places)
    assert np.any(
        lies_inside(face, places, footprint_of(Element("C", "suction", 1, diameter_mm=largest)))
    )
    larger = Element("C", "suction", 1, diameter_mm=largest + 1e-4)
    assert not np.any(lies_inside(face, places, footprint_of(larger)))


# --- which faces ---

THREE = flat_part(
    Face(box(0, 0, 100, 100), 9.0),
    Face(box(200, 0, 500, 100), 9.0),
    Face(box(0, 200, 50, 250), 3.0),
)


@pytest.mark.parametrize(
    ("choice", "areas"),
    [
        ("all-up", [30_000, 10_000, 2_500]),
        ("top", [30_000, 10_000]),
        ("largest", [30_000]),
        ("3,1", [30_000, 2_500]),
        ("2", [10_000]),
        ("-10,-10,300,50", [5_000, 5_000]),
        ("300,50,-10,-10", [5_000, 5_000]),
        ("25,50,25.5,300", [25, 25]),
    ],
)
def test_faces_are_chosen_by_word_number_or_box(choice: str, areas: list[float]) -> None:
    """A box cuts faces; they keep their order whatever the order of the numbers."""
    chosen = choose_faces(THREE, choice, "--cup-faces")
    assert [face.outline.area for face in chosen] == pytest.approx(areas)


@pytest.mark.parametrize(
    ("choice", "told"),
    [
        ("up", "--cup-faces 'up' is none of: all-up"),
        ("", "is none of"),
        ("4", "the part has 3 faces"),
        ("1,1", "names a face twice"),
        ("1.5", "names a face twice, or one that there is not"),
        ("1,2,nan", "is none of"),
        ("1000,1000,1100,1100", "no face lies in the box x 1000 to 1100"),
    ],
)
def test_a_choice_of_no_face_is_told(choice: str, told: str) -> None:
    """In one sentence, with what there is."""
    with pytest.raises(UsageError, match=told):
        choose_faces(THREE, choice, "--cup-faces")


# --- the polygon ---


@OFTEN
@given(SEEDS)
def test_the_automatic_polygon_suits_the_deviation(seed: int) -> None:
    """It holds the centroid, and each of its edges is in sight of it."""
    part = flat_part(Face(random_face(seed), 2.0))
    for choice in ("auto", "hull", "rectangle"):
        corners = approximation_polygon(part, choice)
        assert contains(corners, part.centroid_mm)
        assert is_star_shaped(corners, part.centroid_mm)
        assert 3 <= len(corners) <= 60
    assert Polygon(corners[:, :2]).equals(box(*part.plan.bounds))


def test_the_automatic_polygon_follows_a_star_shaped_outline() -> None:
    """An L stays an L; a U, of which the centroid does not see all, becomes its hull."""
    shape = Polygon([(0, 0), (300, 0), (300, 160), (160, 160), (160, 300), (0, 300)])
    corners = approximation_polygon(flat_part(Face(shape, 2.0)), "auto")
    assert Polygon(corners[:, :2]).equals(shape)
    bent = box(0, 0, 300, 300).difference(box(50, 100, 250, 300))
    corners = approximation_polygon(flat_part(Face(bent, 2.0)), "auto")
    assert Polygon(corners[:, :2]).equals(box(0, 0, 300, 300))


def test_places_out_of_sight_of_the_centroid_are_counted() -> None:
    """In a U, the tips of both legs are hidden by the notch; holes hide nothing."""
    bent = box(0, 0, 300, 300).difference(box(50, 150, 250, 300))
    part = flat_part(Face(bent, 2.0))
    places = np.array([[25.0, 290], [150, 50], [275, 290], [25, 60]])
    assert in_sight(part, places).tolist() == [False, True, False, True]
    plate = flat_part(Face(PLATE.difference(Point(20, 0).buffer(10)), 2.0))
    assert in_sight(plate, np.array([[45.0, 0.0]]))[0]


def test_a_centroid_outside_the_outline_is_told() -> None:
    """In a deep U no place is in sight of it, which is no fault of the places."""
    bent = box(0, 0, 300, 300).difference(box(50, 60, 250, 300))
    (note,) = fit(flat_part(Face(bent, 2.0)), Fitment(None, CHOSEN, 10, "auto", 0.6), 1e3).notes
    assert note.found == "a centroid outside the part's outline"
    shallow = box(0, 0, 300, 300).difference(box(50, 150, 250, 300))
    (note,) = fit(flat_part(Face(shallow, 2.0)), Fitment(None, CHOSEN, 10, "auto", 0.6), 1e3).notes
    assert note.found.endswith("places that the outline hides from the centroid")


# --- too much ---


def test_too_many_places_are_refused() -> None:
    """With the number, and before anything is written; the bounds are those of a workbook."""
    part = flat_part(Face(box(0, 0, 600, 600), 2.0))
    with pytest.raises(UsageError, match="footprints of one kind, more than 200,000"):
        fitted(part, cup=None, pitch=1.3)
    with pytest.raises(UsageError, match="36,000,000 grid points"):
        fitted(part, cup=None, pitch=0.1)
    assert MAX_FOOTPRINTS == reading_places.MAX_FOOTPRINTS
    assert MOST_COUNT == MAX_COUNT
