"""The trade-off front against brute force over all grasps of small option spaces."""

from __future__ import annotations

import time
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from spaces import all_grasps, any_rules, option_spaces, plate, some_rules

from grasp_xl.chromosome import from_active
from grasp_xl.grasp import Grasp
from grasp_xl.rules import TERMS, Goals, Rules, Terms
from grasp_xl.search.front import CLOSE, Front, find_front, is_close, weighted, weightings
from grasp_xl.search.result import GeneticSettings
from grasp_xl.space import OptionSpace

ACCURACY = 1e-7


def front_of(space: OptionSpace, rules: Rules, grasps: list[Grasp], **settings: object) -> Front:
    """Find a front from the worst of all grasps."""
    return find_front(space, rules, GeneticSettings(), grasps[-1].chromosome, **settings)


def dominating(terms: Terms, grasps: list[Grasp]) -> list[Grasp]:
    """Return the grasps that dominate one with these criteria."""
    slack = ACCURACY * (1 + np.abs(terms))
    others = np.array([grasp.terms for grasp in grasps])
    better = (others <= terms + slack).all(axis=1) & (others < terms - slack).any(axis=1)
    return [grasps[row] for row in np.flatnonzero(better)]


def least(grasps: list[Grasp], rules: Rules) -> float:
    """Return the least value of all grasps under some rules."""
    return min(rules.value(grasp.terms) for grasp in grasps)


def check_truth(front: Front, rules: Rules, grasps: list[Grasp]) -> None:
    """Check that all that a front says is true of all grasps."""
    listed = [design.grasp for design in front.designs]
    for design in front.designs:
        assert design.grasp.feasible
        assert dominating(design.grasp.terms, grasps if design.proved else listed) == []
        if design.weights:
            assert sum(design.weights) == pytest.approx(1.0)
            by_weight = weighted(rules, design.weights)
            value = by_weight.value(design.grasp.terms)
            assert value == pytest.approx(least(grasps, by_weight), rel=ACCURACY, abs=ACCURACY)
    rounded = {tuple(f"{value:.7g}" for value in grasp.terms) for grasp in listed}
    assert len(rounded) == len(listed)


@settings(max_examples=25, deadline=None)
@given(data=st.data())
def test_front_is_true_of_all_grasps(data):
    """Nothing dominates a proved design, and the optimum of every weighted sum is listed."""
    space = data.draw(option_spaces(most=5))
    rules = data.draw(any_rules())
    grasps = all_grasps(space, rules)
    if not grasps:
        return
    front = front_of(space, rules, grasps, grid=2)
    assert front.complete
    check_truth(front, rules, grasps)
    sums = weightings(rules.goals, 2)
    assert (front.sums, front.proved_sums) == (len(sums), len(sums))
    for weights in sums:
        by_weight = weighted(rules, weights)
        best = min(by_weight.value(design.grasp.terms) for design in front.designs)
        assert best == pytest.approx(least(grasps, by_weight), rel=ACCURACY, abs=ACCURACY)


@pytest.mark.parametrize("calls", [0, 1, 4, 12])
def test_a_stopped_front_is_true(calls):
    """Stopped anywhere, it says of nothing that it is proved unless it is."""
    space, rules = plate(cups=5, magnets=5), some_rules(fos=2.0)
    grasps = all_grasps(space, rules)
    seen: list[object] = []
    front = front_of(
        space,
        rules,
        grasps,
        grid=2,
        stop=lambda: len(seen) >= calls,
        on_progress=lambda *told: seen.append(told),
    )
    assert not front.complete
    check_truth(front, rules, grasps)


def test_a_criterion_without_a_goal_is_minimised_alone():
    """It is in no sum, and a design that is the least in it is listed all the same."""
    space = plate(cups=5, magnets=5)
    rules = some_rules(fos=2.0)
    rules = replace(rules, goals=Goals(rules.goals.base, frozenset({"structure"})))
    grasps = all_grasps(space, rules)
    front = front_of(space, rules, grasps, grid=2)
    assert front.complete
    check_truth(front, rules, grasps)
    assert front.sums == len(TERMS) + 3
    lowest = min(design.grasp.terms.structure for design in front.designs)
    assert lowest == pytest.approx(min(grasp.terms.structure for grasp in grasps))
    assert all(design.weights.structure in (0.0, 1.0) for design in front.designs if design.weights)


@pytest.mark.parametrize("cores", [1, 3])
def test_a_front_does_not_depend_on_the_number_of_cores(cores, monkeypatch):
    space, rules = plate(cups=9, magnets=9), some_rules(fos=4.0)
    benchmark = from_active(space, [(1, 5, 9), (2, 8)])

    def told() -> list[object]:
        front = find_front(space, rules, GeneticSettings(), benchmark, grid=2)
        assert front.complete
        return [(each.grasp.chromosome, each.proved, each.weights) for each in front.designs]

    usual = told()
    monkeypatch.setattr("os.cpu_count", lambda: cores)
    assert told() == usual


def test_the_time_limit_is_kept():
    """To within half a second, however hard a sum is; nothing listed then dominates another."""
    space, rules = plate(cups=200, magnets=200), some_rules(fos=9.0)
    benchmark = from_active(space, [(1, 50, 90), (2, 110, 150)])
    for seconds in (0.0, 2.0):
        began = time.perf_counter()
        front = find_front(space, rules, GeneticSettings(), benchmark, seconds=seconds)
        assert time.perf_counter() - began < seconds + 0.5
        assert not front.complete
    listed = [design.grasp for design in front.designs]
    assert listed
    assert all(dominating(grasp.terms, listed) == [] for grasp in listed)


@pytest.mark.parametrize(
    ("best", "bound", "close"),
    [(2.0, 1.9981, True), (2.0, 1.9979, False), (0.1, 0.0991, True), (0.1, 0.0989, False)],
)
def test_a_sum_is_minimised_to_a_share_of_it_or_of_the_goals(best, bound, close):
    """Whichever is more; a sum at the goals is 1, a criterion alone is its goal there."""
    rules = some_rules(goals=(5.0, 7.0, 9.0, 11.0))
    mixed, alone = (weighted(rules, Terms(0.0, 1 - share, share, 0.0)) for share in (0.25, 1.0))
    assert is_close(mixed, CLOSE, bound, best) == close
    assert is_close(alone, CLOSE, 9 * bound, 9 * best) == close
    assert not is_close(mixed, CLOSE, bound, None)


@pytest.mark.parametrize(("grid", "count"), [(1, 4), (2, 10), (4, 35), (10, 286)])
def test_the_grid_has_every_share_once(grid, count):
    """The corners first, and in each sum the weights are 1 together."""
    sums = weightings(some_rules().goals, grid)
    assert len(set(sums)) == len(sums) == count
    assert [max(weights) for weights in sums[:4]] == [1.0] * 4
    assert all(sum(weights) == pytest.approx(1.0) for weights in sums)
    assert all(weight * grid == round(weight * grid) for weights in sums for weight in weights)
