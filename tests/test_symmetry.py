"""Symmetries of the footprints: what they map, and that twins are known as twins."""

from __future__ import annotations

import time
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from spaces import chromosomes, kind, option_spaces, plate, rectangle, some_rules

from grasp_xl.chromosome import from_active
from grasp_xl.grasp import evaluate
from grasp_xl.search.exact_pool import Found, Pool
from grasp_xl.search.symmetry import SIGNS, representative, symmetries
from grasp_xl.space import OptionSpace, Part, frozen


def grid(columns: int, rows: int, pitch: float = 30.0, z: float = 5.0) -> np.ndarray:
    """Places of a grid about (7, -3), with rounding errors as CAD leaves them, ``(n, 3)``."""
    x, y = np.meshgrid(np.arange(columns) - (columns - 1) / 2, np.arange(rows) - (rows - 1) / 2)
    points = np.column_stack([7 + pitch * x.ravel(), -3 + pitch * y.ravel(), np.full(x.size, z)])
    return points + np.random.default_rng(1).uniform(-2e-7, 2e-7, points.shape)


def space_of(*places: np.ndarray, centroid: tuple[float, float, float] = (7, -3, 0)) -> OptionSpace:
    """An option space of cups and magnets about a rectangle whose middle is the centroid."""
    names = ("suction", "magnets")
    kinds = tuple(kind(name, points) for name, points in zip(names, places, strict=True))
    polygon = rectangle(400, 300) + np.array(centroid)
    return OptionSpace(Part(5000.0, frozen(centroid)), kinds, frozen(polygon), 0.6)


@pytest.fixture(scope="module")
def square() -> OptionSpace:
    """Two shuffled grids with all three symmetries."""
    rng = np.random.default_rng(2)
    return space_of(rng.permutation(grid(5, 4)), rng.permutation(grid(8, 6, pitch=17.0)))


def test_a_grid_has_all_three_symmetries(square):
    """Rounding errors below the tolerance do not hide them, nor does the order of the places."""
    assert [found.name for found in symmetries(square)] == list(SIGNS)


def test_each_symmetry_undoes_itself_and_lands_on_the_image(square):
    """Applied twice it is the identity; each image stands where the map says, heights kept."""
    middle = np.array([7.0, -3.0, 0.0])
    for found in symmetries(square):
        for image, each in zip(found.images, square.kinds, strict=True):
            assert (image[image] == np.arange(each.total)).all()
            expected = (each.footprints_mm - middle) * SIGNS[found.name] + middle
            assert each.footprints_mm[image] == pytest.approx(expected, abs=2e-6)


def test_twins_have_equal_values_and_equal_representatives(square):
    """With polygon and centroid symmetric too, all images of a grasp are judged alike."""
    rules = some_rules(fos=0.1, clearance_mm=1.0)
    rng = np.random.default_rng(3)
    for _ in range(30):
        active = [
            tuple((1 + rng.choice(each.total, rng.integers(1, 5), replace=False)).tolist())
            for each in square.kinds
        ]
        value = evaluate(square, rules, from_active(square, active)).value
        least = representative(symmetries(square), active)
        for found in symmetries(square):
            twin = found.of(active)
            assert evaluate(square, rules, from_active(square, twin)).value == pytest.approx(
                value, rel=1e-6
            )
            assert representative(symmetries(square), twin) == least
        assert least in [tuple(map(tuple, map(sorted, active)))] + [
            found.of(active) for found in symmetries(square)
        ]


def test_one_place_out_of_order_breaks_the_symmetry(square):
    """A place moved by a hundredth of a millimetre, or lifted, leaves no symmetry of its grid."""
    for axis in (0, 1, 2):
        points = square.kinds[0].footprints_mm.copy()
        corner = points[:, :2].sum(axis=1).argmax()
        points[corner, axis] -= 0.01
        moved = replace(square, kinds=(kind("suction", points), square.kinds[1]))
        assert not symmetries(moved)


def test_scattered_places_have_no_symmetry():
    """Then every grasp is its own representative, with its indices sorted."""
    space = plate()
    assert symmetries(space) == ()
    assert representative((), [(4, 2), (9,)]) == ((2, 4), (9,))


def test_a_part_with_one_mirror_axis():
    """A U-shaped layout is symmetric in x only; magnets count like cups."""
    cups = [(-50, 0, 0), (50, 0, 0), (-50, 40, 0), (50, 40, 0)]
    magnets = [(0, 0, 0)]
    space = space_of(np.array(cups, dtype=float), np.array(magnets, dtype=float))
    (found,) = symmetries(space)
    assert found.name == "mirror in x"
    assert [image.tolist() for image in found.images] == [[1, 0, 3, 2], [0]]


def test_a_kind_without_places_is_no_obstacle():
    """Only cups: their grid's symmetries are found; no places at all have none."""
    nothing = np.zeros((0, 3))
    assert len(symmetries(space_of(grid(3, 2), nothing))) == 3
    assert symmetries(space_of(nothing, nothing)) == ()


def test_places_in_one_line_have_no_identity_among_their_symmetries():
    """Mirrored in its own line each place stays: that is no symmetry to report."""
    space = space_of(grid(1, 5), np.zeros((0, 3)))
    assert "mirror in x" not in [found.name for found in symmetries(space)]


@settings(max_examples=100, deadline=None)
@given(data=st.data())
def test_twins_of_random_spaces_are_twins(data):
    """On lattices with ties, an image of a grasp is a grasp and has the same representative."""
    space = data.draw(option_spaces(most=4))
    active = data.draw(chromosomes(space)).active
    found = symmetries(space)
    for symmetry in found:
        twin = symmetry.of(active)
        assert [len(set(indices)) for indices in twin] == [len(indices) for indices in active]
        assert representative(found, twin) == representative(found, active)


def test_large_spaces_take_no_time():
    """15,000 footprints take less than 50 ms (five times that is allowed on a busy machine)."""
    space = space_of(grid(100, 100, pitch=8.0), grid(100, 50, pitch=8.0))
    began = time.perf_counter()
    assert len(symmetries(space)) == 3
    assert time.perf_counter() - began < 0.25


@given(data=st.data())
def test_a_pool_has_the_best_of_all_classes(data, square):
    """Whatever order grasps come in: what sorting all and dropping images would leave."""
    indices = st.lists(st.integers(1, square.kinds[0].total), min_size=1, max_size=2, unique=True)
    active = indices.map(lambda chosen: (tuple(sorted(chosen)), ()))
    met = data.draw(st.lists(st.builds(Found, st.sampled_from([1.0, 1 + 1e-12, 2, 3]), active)))
    size = data.draw(st.integers(1, 5))
    pool, firsts = Pool(symmetries(square), size), {}
    for found in met:
        pool.take(found)
    for found in sorted(met, key=lambda each: each.rank):
        firsts.setdefault(representative(pool.symmetries, found.active), found)
    ranks = [found.rank for found in firsts.values()]
    assert [found.rank for found in pool.grasps] == ranks[:size]
