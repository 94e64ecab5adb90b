"""The exact search against brute force over all grasps of small option spaces."""

from __future__ import annotations

import math
from itertools import combinations, product

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from spaces import any_rules, option_spaces, plate, some_rules

from grasp_xl.chromosome import from_active
from grasp_xl.grasp import Grasp, evaluate
from grasp_xl.rules import Rules
from grasp_xl.search.exact import ExactSettings, solve
from grasp_xl.search.genetic import search
from grasp_xl.search.result import GeneticSettings
from grasp_xl.search.stop import Generations
from grasp_xl.search.symmetry import representative, symmetries
from grasp_xl.space import OptionSpace


def all_grasps(space: OptionSpace, rules: Rules) -> list[Grasp]:
    """Judge every feasible grasp of an option space, best first."""
    choices = [
        [
            chosen
            for count in range(kind.count_min, kind.most + 1)
            for chosen in combinations(range(1, kind.total + 1), count)
        ]
        for kind in space.kinds
    ]
    grasps = [
        evaluate(space, rules, from_active(space, active))
        for active in product(*choices)
        if any(active)
    ]
    return sorted((g for g in grasps if g.feasible), key=lambda grasp: grasp.value)


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
