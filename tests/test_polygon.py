"""Both exact questions about a polygon, against oracles that know nothing of turns."""

from __future__ import annotations

import itertools
from fractions import Fraction

import numpy as np
import pytest
import shapely
from hypothesis import assume, example, given
from hypothesis import strategies as st

from grasp_xl.polygon import contains, is_star_shaped, look_at_polygon

Point = tuple[float, float]

GRID = st.integers(0, 8)
GRID_POINTS = st.tuples(GRID, GRID)
HALVES = st.tuples(*[st.integers(-2, 18).map(lambda n: n / 2)] * 2)
FLOATS = st.floats(-1e3, 1e3, allow_subnormal=False).map(lambda value: round(value, 12))

SHORTEST = 1e-7
"""Below what a segment between half grid points can be outside a polygon on the grid."""


def crossing(a: Point, b: Point, c: Point, d: Point) -> bool:
    """Tell whether two edges have more than an end in common."""
    shared = {a, b} & {c, d}
    common = shapely.LineString([a, b]).intersection(shapely.LineString([c, d]))
    return not common.is_empty and not (len(shared) == 1 and common.geom_type == "Point")


def untangled(corners: list[Point]) -> list[Point]:
    """Reverse runs of corners until no two edges cross: a simple polygon, mostly not convex."""
    for _ in range(100):
        for i, j in itertools.combinations(range(len(corners)), 2):
            a, b = corners[i], corners[i + 1]
            c, d = corners[j], corners[(j + 1) % len(corners)]
            if crossing(a, b, c, d):
                corners[i + 1 : j + 1] = corners[i + 1 : j + 1][::-1]
                break
        else:
            return corners
    return corners


@st.composite
def simple_polygons(draw: st.DrawFn, points: st.SearchStrategy[Point] = GRID_POINTS) -> np.ndarray:
    """Draw a simple polygon, in either direction."""
    corners = untangled(draw(st.lists(points, min_size=3, max_size=9, unique=True)))
    assume(shapely.Polygon(corners).is_valid)
    return np.array(corners, dtype=np.float64)


def sees_everything(polygon: np.ndarray, centre: Point) -> bool:
    """Tell whether each segment from the centre to a corner or an edge's middle stays inside.

    The middles suffice: behind an edge that shows its outside, its middle is not seen.
    """
    shape = shapely.Polygon(polygon)
    middles = (polygon + np.roll(polygon, -1, axis=0)) / 2
    sights = [shapely.LineString([centre, end]) for end in (*polygon, *middles)]
    return all(sight.difference(shape).length < SHORTEST for sight in sights)


def with_height(points: np.ndarray) -> np.ndarray:
    """Give points a third coordinate, each another one."""
    return np.column_stack([points, np.arange(len(points), dtype=np.float64)])


SQUARE = np.array([(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)])
NOTCHED = np.array([(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (2.0, 1.0), (0.0, 4.0)])
C_SHAPE = np.array(
    [(0.0, 0.0), (6.0, 0.0), (6.0, 2.0), (2.0, 2.0), (2.0, 4.0), (6.0, 4.0), (6.0, 6.0), (0.0, 6.0)]
)
L_SHAPE = np.array([(0.0, 0.0), (6.0, 0.0), (6.0, 2.0), (2.0, 2.0), (2.0, 6.0), (0.0, 6.0)])


@given(simple_polygons(), HALVES)
@example(SQUARE, (0.0, 0.0))
@example(NOTCHED, (2.0, 1.0))
@example(C_SHAPE, (2.0, 2.0))
def test_star_shaped_is_to_see_everything(polygon: np.ndarray, centre: Point) -> None:
    """A polygon is star-shaped about a point if and only if no line of sight leaves it."""
    assert is_star_shaped(polygon, np.array(centre)) == sees_everything(polygon, centre)


@given(simple_polygons(), st.data())
def test_star_shaped_about_a_point_of_its_own(polygon: np.ndarray, data: st.DataObject) -> None:
    """The same holds about corners, and about middles of edges and diagonals."""
    first, second = (data.draw(st.integers(0, len(polygon) - 1)) for _ in range(2))
    centre = (polygon[first] + polygon[second]) / 2
    assert is_star_shaped(polygon, centre) == sees_everything(polygon, tuple(centre))


@given(simple_polygons(st.tuples(FLOATS, FLOATS)), st.tuples(FLOATS, FLOATS))
def test_contains_is_shapelys_covers(polygon: np.ndarray, point: Point) -> None:
    """A point is in a polygon where shapely's exact predicate says so."""
    assert contains(polygon, np.array(point)) == shapely.Polygon(polygon).covers(
        shapely.Point(point)
    )


@given(simple_polygons(st.tuples(FLOATS, FLOATS)), st.data())
def test_contains_near_the_boundary(polygon: np.ndarray, data: st.DataObject) -> None:
    """The same holds for points beside an edge by no more than their last binary digit.

    Shares have twelve decimals: shapely's own arithmetic, of 106 bits, does not resolve 1e-35.
    """
    edge = data.draw(st.integers(0, len(polygon) - 1))
    share = round(data.draw(st.floats(0, 1)), 12)
    point = polygon[edge - 1] + share * (polygon[edge] - polygon[edge - 1])
    expected = shapely.Polygon(polygon).covers(shapely.Point(point))
    assert contains(polygon, point) == expected


@given(simple_polygons(), HALVES)
def test_direction_start_and_height_do_not_matter(polygon: np.ndarray, point: Point) -> None:
    """Both answers are about the shape: not about where or how its corners begin, nor about z."""
    centre = np.array(point)
    turned = np.roll(polygon, 1, axis=0)[::-1]
    for question in (contains, is_star_shaped):
        answer = question(polygon, centre)
        assert question(turned, centre) == answer
        assert question(with_height(polygon), np.array([*point, 7.0])) == answer


@given(simple_polygons(), HALVES)
def test_a_star_shaped_polygon_contains_its_centre(polygon: np.ndarray, point: Point) -> None:
    """No polygon is star-shaped about a point outside."""
    centre = np.array(point)
    assert contains(polygon, centre) or not is_star_shaped(polygon, centre)


@pytest.mark.parametrize("polygon", [SQUARE, NOTCHED, C_SHAPE], ids=["square", "notched", "c"])
def test_a_polygon_contains_its_boundary(polygon: np.ndarray) -> None:
    """Corners and points on edges belong to the polygon, exactly."""
    middles = (polygon + np.roll(polygon, -1, axis=0)) / 2
    assert all(contains(polygon, point) for point in (*polygon, *middles))


def test_one_binary_digit_decides() -> None:
    """Points next to an edge, as near as numbers allow, are inside or outside."""
    below, above = np.nextafter(4.0, 0.0), np.nextafter(4.0, 5.0)
    assert contains(SQUARE, np.array([below, 2.0]))
    assert contains(SQUARE, np.array([4.0, 2.0]))
    assert not contains(SQUARE, np.array([above, 2.0]))
    assert is_star_shaped(SQUARE, np.array([4.0, 2.0]))
    assert not is_star_shaped(SQUARE, np.array([above, 2.0]))


def test_three_tenths_are_not_three_times_a_tenth() -> None:
    """Coordinates are the binary numbers that they are: (0.1, 0.3) is not on the line y = 3x."""
    triangle = np.array([(0.0, 0.0), (1.0, 3.0), (0.0, 3.0)])
    assert Fraction(0.3) < 3 * Fraction(0.1)
    assert not contains(triangle, np.array([0.1, 0.3]))
    assert contains(triangle, np.array([0.125, 0.375]))


@pytest.mark.parametrize("centre", [(1.0, 3.0), (2.0, 2.0), (2.0, 4.0), (5.0, 1.0), (6.0, 2.0)])
def test_a_c_shape_is_seen_as_a_whole_from_nowhere(centre: Point) -> None:
    """A C-shaped bracket is star-shaped about none of its points: each arm hides the other."""
    assert contains(C_SHAPE, np.array(centre))
    assert not is_star_shaped(C_SHAPE, np.array(centre))


@pytest.mark.parametrize("centre", [(0.0, 0.0), (1.0, 1.0), (2.0, 2.0), (2.0, 0.5)])
def test_an_l_shape_is_seen_as_a_whole_from_its_bend(centre: Point) -> None:
    """An L-shape is star-shaped about the square that both arms share, its border included."""
    assert is_star_shaped(L_SHAPE, np.array(centre))
    assert not is_star_shaped(L_SHAPE, np.array([np.nextafter(2.0, 3.0), centre[1]]))


def test_a_ray_through_corners_counts_once() -> None:
    """Points level with a corner are told apart, inside and outside."""
    diamond = np.array([(2.0, 0.0), (4.0, 2.0), (2.0, 4.0), (0.0, 2.0)])
    assert contains(diamond, np.array([1.0, 2.0]))
    assert not contains(diamond, np.array([-1.0, 2.0]))
    assert not contains(diamond, np.array([5.0, 2.0]))
    assert not contains(diamond, np.array([1.0, 0.0]))
    assert not contains(diamond, np.array([3.0, 4.0]))


def test_a_centroid_on_an_edge_is_told():
    """It would lie on the ideal polygon at any scale."""
    square = np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]])
    (told,) = look_at_polygon(square, np.array([4.0, 2.0]), "part.dxf")
    assert told.found == "the part's centroid on an edge of the polygon"
    assert look_at_polygon(square, np.array([2.0, 2.0]), "part.dxf") == []
