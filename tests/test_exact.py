"""The exact search against brute force over all grasps of small option spaces."""

from __future__ import annotations

import math
import os
import subprocess
import sys
from collections import Counter

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from spaces import all_grasps, any_rules, option_spaces, plate, some_rules

from grasp_xl.chromosome import from_active
from grasp_xl.grasp import Grasp, evaluate
from grasp_xl.rules import Rules
from grasp_xl.search import exact_model
from grasp_xl.search.exact import ExactSettings, solve
from grasp_xl.search.exact_bound import node_bound
from grasp_xl.search.exact_kernel import STEPS
from grasp_xl.search.exact_model import Model, grow_tree, locate, weigh, weigh_goals
from grasp_xl.search.exact_prices import make_room
from grasp_xl.search.genetic import search
from grasp_xl.search.result import GeneticSettings
from grasp_xl.search.stop import Generations
from grasp_xl.search.symmetry import representative, symmetries
from grasp_xl.space import ElementKind, OptionSpace, Part, frozen


def distinct(space: OptionSpace, grasps: list[Grasp]) -> list[Grasp]:
    """Keep the best of grasps that are images of one another under the space's symmetries."""
    maps = symmetries(space)
    best = {representative(maps, grasp.chromosome.active): grasp for grasp in reversed(grasps)}
    return sorted(best.values(), key=lambda grasp: grasp.value)


@settings(max_examples=150, deadline=None)
@given(data=st.data())
def test_optimum_equals_brute_force(data):
    """Status, optimum, top three (images once) and goals-only optimum are those of all grasps."""
    space = data.draw(option_spaces(most=5))
    rules = data.draw(any_rules())
    grasps = all_grasps(space, rules)
    proof = solve(space, rules, ExactSettings(top=3))
    assert proof.status == ("optimal" if grasps else "infeasible")
    values = [grasp.value for grasp in distinct(space, grasps)[:3]]
    assert [grasp.value for grasp in proof.designs] == pytest.approx(values, rel=1e-8, abs=1e-9)
    assert all(grasp.feasible for grasp in proof.designs)
    good = [grasp.value for grasp in grasps if grasp.meets_all_goals]
    goal_proof = solve(space, rules, ExactSettings(meet_goals=True, min_elements=1))
    found = [grasp.value for grasp in goal_proof.designs]
    assert found == pytest.approx(good[:1], rel=1e-8, abs=1e-9)


@settings(max_examples=60, deadline=None)
@given(data=st.data(), rows=st.sampled_from(["x", "y"]))
def test_rows_first_equals_brute_force(data, rows):
    """Telling rows of places apart first is another way to the same three best grasps."""
    space, rules = data.draw(option_spaces(most=5)), data.draw(any_rules())
    grasps = distinct(space, all_grasps(space, rules))
    proof = solve(space, rules, ExactSettings(top=3, rows=rows))
    values = [grasp.value for grasp in grasps[:3]]
    assert [grasp.value for grasp in proof.designs] == pytest.approx(values, rel=1e-8, abs=1e-9)


@settings(max_examples=20, deadline=None)
@given(data=st.data())
def test_places_at_many_heights_equal_brute_force(data):
    """Where boxes are not parted by height, as of a curved part, the optimum is the same."""
    space, rules = data.draw(option_spaces(most=5)), data.draw(any_rules())
    grasps = all_grasps(space, rules)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(exact_model, "FEW_HEIGHTS", 0)
        proof = solve(space, rules)
    found = [grasp.value for grasp in proof.designs]
    assert found == pytest.approx([g.value for g in grasps[:1]], rel=1e-8, abs=1e-9)


@settings(max_examples=40, deadline=None)
@given(data=st.data())
def test_least_number_of_elements_is_kept(data):
    """With a least number of elements, the optimum is the best of the grasps that have as many."""
    space = data.draw(option_spaces(most=5))
    rules = data.draw(any_rules())
    least = data.draw(st.integers(2, 4))
    large = [g.value for g in all_grasps(space, rules) if len(g.points_mm) >= least]
    proof = solve(space, rules, ExactSettings(min_elements=least))
    found = [grasp.value for grasp in proof.designs]
    assert found == pytest.approx(large[:1], rel=1e-8, abs=1e-9)


@st.composite
def crowded_spaces(draw: st.DrawFn) -> OptionSpace:
    """Draw a space whose grasps have four to eight elements, on a grid, so that many are equal."""
    corners = [(x, y, 0.0) for x, y in ((120, 90), (120, -90), (-120, -90), (-120, 90))]
    places = st.tuples(
        st.integers(-3, 3).map(lambda i: 50.0 * i),
        st.integers(-2, 2).map(lambda j: 40.0 * j),
        st.sampled_from([0.0, 0.0, 30.0]),
    )
    kinds = []
    for name, force in (("suction", 69.0), ("magnets", 130.0)):
        points = draw(st.lists(places, min_size=4, max_size=6, unique=True))
        kinds.append(ElementKind(name, force, 10.0, 2, draw(st.integers(2, 4)), frozen(points)))
    part = Part(5000.0, frozen([draw(st.floats(-20, 20)), draw(st.floats(-20, 20)), 10.0]))
    return OptionSpace(part, tuple(kinds), frozen(corners), 0.6)


@settings(max_examples=120, deadline=None)
@given(space=crowded_spaces(), rules=any_rules())
def test_grasps_of_many_elements_equal_brute_force(space: OptionSpace, rules: Rules) -> None:
    """From four elements on, too, the best three are those of all grasps, one by one."""
    grasps = distinct(space, all_grasps(space, rules))
    proof = solve(space, rules, ExactSettings(top=3))
    assert proof.status == ("optimal" if grasps else "infeasible")
    values = [grasp.value for grasp in grasps[:3]]
    assert [grasp.value for grasp in proof.designs] == pytest.approx(values, rel=1e-8, abs=1e-9)


@pytest.mark.parametrize("seed", range(5))
def test_multipliers_turn_towards_a_moment_that_is_left(seed):
    """Where each element has its place, the bound is soon the value: u has the moment's direction."""
    space, rules = plate(seed, cups=3, magnets=3), some_rules(criterion="moment+deviation")
    model = Model(
        locate(space, rules),
        weigh(space, rules, [(3, 3)], caps=False),
        weigh_goals(space, rules, []),
    )
    places = np.flatnonzero(model.locations.child[:, 0] < 0)
    u, room = np.array([0.0, 0.0, -1.0, 0.0]), make_room(6, 6, 1)
    bound = node_bound(model.locations, model.weights[0], places, 1e9, u, 2 * STEPS, room)
    value = evaluate(space, rules, from_active(space, [(1, 2, 3), (1, 2, 3)])).value
    assert value * 0.9999 <= bound <= value * (1 + 1e-9)


@pytest.mark.parametrize("cores", [1, 3])
def test_result_does_not_depend_on_the_number_of_cores(cores, monkeypatch):
    """One core or three: the same nodes, bounds and designs."""
    space, rules = plate(cups=40, magnets=40), some_rules(fos=9.0)

    def course() -> list[object]:
        steps: list[object] = []
        proof = solve(
            space, rules, ExactSettings(top=5), on_progress=lambda *told: steps.append(told)
        )
        return [*steps, proof.nodes, [grasp.chromosome for grasp in proof.designs]]

    usual = course()
    monkeypatch.setattr("os.cpu_count", lambda: cores)
    assert course() == usual


def test_stopped_search_tells_the_truth():
    """Stopped in the middle, a search has a true bound, and what it found is a grasp."""
    space, rules = plate(cups=60, magnets=60), some_rules(fos=9.0)
    optimum = solve(space, rules).designs[0].value
    for batches in (0, 1, 2, 5, 10):
        seen: list[float] = []
        proof = solve(
            space,
            rules,
            stop=lambda: len(seen) >= batches,  # noqa: B023 (called within this turn only)
            on_progress=lambda bound, _: seen.append(bound),  # noqa: B023
        )
        assert proof.bound <= optimum * (1 + 1e-9)
        assert all(grasp.value >= optimum * (1 - 1e-9) for grasp in proof.designs)
        assert proof.status in ("optimal", "feasible" if proof.designs else "unknown")


def test_never_worse_than_a_genetic_run_and_bounds_are_true():
    """The optimum is at most what a run finds, and every bound on the way at most the optimum."""
    space, rules = plate(cups=60, magnets=60), some_rules()
    benchmark = from_active(space, [(3, 9), (11, 27)])
    run = search(space, rules, GeneticSettings(), benchmark, [Generations(5000)])
    bounds: list[float] = []
    proof = solve(space, rules, on_progress=lambda bound, _: bounds.append(bound))
    assert proof.status == "optimal"
    assert proof.gap == 0.0
    assert proof.designs[0].value <= run.best.value * (1 + 1e-9)
    assert max(bounds) <= proof.designs[0].value * (1 + 1e-9)
    cut = solve(space, rules, ExactSettings(time_limit_s=0.0), known=[run.best.chromosome])
    assert cut.status == "feasible"
    assert cut.bound <= proof.designs[0].value * (1 + 1e-9)


def test_nothing_found_in_no_time_is_unknown():
    """A search that may not begin knows neither a grasp nor that there is none."""
    proof = solve(plate(), some_rules(), stop=lambda: True)
    assert proof.status in ("unknown", "feasible")
    assert proof.bound < math.inf


@given(
    points=st.lists(st.tuples(*[st.integers(0, 9)] * 3), min_size=1, max_size=40),
    first=st.sampled_from([(), (2,), (0,), (1,), (2, 1)]),
)
def test_tree_parts_first_axes_and_halves_other_boxes(points, first):
    """A box has the bounds of its locations; its two parts share them, lower one first."""
    xyz = np.array(points, dtype=float)
    order, corners, run, child = grow_tree(xyz, first)
    assert sorted(order) == list(range(len(xyz)))
    assert len(run) == 2 * len(xyz) - 1
    for box, (begin, end) in enumerate(run.tolist()):
        inside = xyz[order[begin:end]]
        assert corners[box].tolist() == [*inside[:, :2].min(axis=0), *inside[:, :2].max(axis=0)]
        if end - begin == 1:
            assert child[box].tolist() == [-1, -1]
            continue
        low, high = run[child[box]].tolist()
        assert [begin, low[1], end] == [low[0], high[0], high[1]]
        several = [axis for axis in first if np.ptp(inside[:, axis]) > 0]
        if several:
            along, middle = inside[:, several[0]], (end - begin) // 2
            steps = np.flatnonzero(np.diff(np.sort(along))) + 1
            assert abs(low[1] - begin - middle) == abs(steps - middle).min()
            assert along[: low[1] - begin].max() < along[low[1] - begin :].min()
            continue
        assert low[1] == (begin + end) // 2
        x, y = corners[box, 2:] - corners[box, :2]
        along = inside[:, 0 if x >= y else 1]
        assert along[: low[1] - begin].max() <= along[low[1] - begin :].min()


def test_no_kernel_is_compiled_twice(tmp_path):
    """Neither constants nor layouts of arrays make a kernel of the exact search compile again."""
    program = "from grasp_xl.search.warm import load_exact_search; load_exact_search()"
    anew = {**os.environ, "XDG_CACHE_HOME": str(tmp_path)}
    subprocess.run([sys.executable, "-c", program], check=True, env=anew)  # noqa: S603
    versions = Counter(path.name.rsplit(".", 2)[0] for path in tmp_path.rglob("exact_*.nbc"))
    assert versions
    assert set(versions.values()) == {1}
