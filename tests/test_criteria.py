"""The criteria: readable and compiled twins agree, and both agree with other programs."""

from __future__ import annotations

import math
from itertools import permutations

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from spaces import any_rules, chromosomes, option_spaces

from grasp_xl import criteria
from grasp_xl.grasp import active_points, evaluate
from grasp_xl.kernels import boundary_distances, fitness, measure_rows, tabulate
from grasp_xl.rules import Rules
from grasp_xl.space import OptionSpace

RELATIVE = 1e-12


def scale_of(space: OptionSpace) -> float:
    """Length against which rounding errors of a place are seen."""
    return max(1.0, *(np.abs(kind.footprints_mm).max(initial=0) for kind in space.kinds))


@settings(max_examples=300, deadline=None)
@given(data=st.data())
def test_compiled_twins_equal_the_readable_criteria(data):
    """Every compiled term, the value and the constraints equal the readable ones to 1e-12."""
    space = data.draw(option_spaces())
    rules: Rules = data.draw(any_rules())
    chromosome = data.draw(chromosomes(space))
    grasp = evaluate(space, rules, chromosome)
    tables = tabulate(space, rules)
    measured = measure_rows(tables, chromosome.genes[None])[0]
    slack = RELATIVE * scale_of(space) * max(1.0, space.part.weight_n)
    assert measured[0] == pytest.approx(grasp.fos, rel=RELATIVE)
    assert measured[1:5] == pytest.approx(list(grasp.terms), rel=RELATIVE, abs=slack)
    assert bool(measured[5]) == grasp.feasible
    value = fitness(tables, np.array(chromosome.genes), np.zeros(99, dtype=np.int64))
    if grasp.feasible:
        assert value == pytest.approx(grasp.value, rel=RELATIVE, abs=slack)
    else:
        assert value == math.inf


@settings(max_examples=200, deadline=None)
@given(data=st.data())
def test_distance_to_the_polygon_is_shapelys(data):
    """Deviation of a point is shapely's distance to the polygon's boundary, inside and outside."""
    space = data.draw(option_spaces())
    polygon = np.array(space.ideal_polygon_mm)
    boundary = shapely.LinearRing(polygon[:, :2])
    points = space.kinds[0].footprints_mm
    expected = [boundary.distance(shapely.Point(point[:2])) for point in points]
    readable = [criteria.distance_to_boundary(point, polygon) for point in points]
    assert readable == pytest.approx(expected, abs=1e-9)
    assert boundary_distances(points, polygon) == pytest.approx(readable, rel=RELATIVE, abs=1e-12)


@settings(max_examples=100, deadline=None)
@given(data=st.data())
def test_order_of_genes_does_not_change_any_number(data):
    """A grasp is a set: permuted active genes give the same criteria, ties of the truss included."""
    space = data.draw(option_spaces(most=5))
    rules = data.draw(any_rules())
    chromosome = data.draw(chromosomes(space))
    points = active_points(space, chromosome)
    expected = criteria.structure(points, rules.requirements.density_ratio)
    for order in list(permutations(range(len(points))))[:24]:
        shuffled = points[list(order)]
        got = criteria.structure(shuffled, rules.requirements.density_ratio)
        assert got == pytest.approx(expected, rel=1e-9)


def test_structure_takes_the_better_of_equally_long_main_trusses():
    """Of the two diagonals of a kite's rectangle the one with the shorter branches counts."""
    corners = np.array([[0, 0, 0], [40, 0, 0], [40, 30, 0], [0, 30, 0], [10, 20, 0]], dtype=float)
    lengths = [criteria.truss_length(corners, pair, 2.5) for pair in ((0, 2), (1, 3))]
    assert lengths[0] != pytest.approx(lengths[1])
    assert criteria.structure(corners, 2.5) == min(lengths)


def test_structure_of_one_point_is_zero():
    """One element needs no truss, and has no clearance."""
    point = np.array([[5.0, 6.0, 7.0]])
    assert criteria.structure(point, 2.5) == 0.0
    assert criteria.smallest_distance(point) is None


def test_plan_arm_leaves_heights_out():
    """With the plan arm the moment is that of the plan-view offset alone."""
    centre, centroid = np.array([3.0, 4.0, 12.0]), np.zeros(3)
    assert criteria.eccentricity(centre, centroid, "plan") == 5.0
    assert criteria.eccentricity(centre, centroid, "3d") == 13.0
