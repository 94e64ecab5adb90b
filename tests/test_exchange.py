"""Good grasps by exchange: they exist, are as good as said, and the same on every machine."""

from __future__ import annotations

from itertools import combinations_with_replacement
from math import hypot

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from spaces import any_rules, kind, option_spaces, plate, rectangle, some_rules

from grasp_xl.chromosome import from_active
from grasp_xl.grasp import evaluate
from grasp_xl.kernels import tabulate
from grasp_xl.rules import Requirements
from grasp_xl.search.exact import solve
from grasp_xl.search.exchange import STREAMS, Exchange, lay_cells
from grasp_xl.search.feasibility import lifting_counts
from grasp_xl.search.floors import floors_by_counts
from grasp_xl.search.obstacles import any_feasible
from grasp_xl.space import OptionSpace, Part, frozen

GO = np.zeros(1, dtype=np.int64)
"""Nobody says halt."""


def searched(space, rules, judged):
    """Return what all streams find."""
    exchange = Exchange(space, rules, lifting_counts(space, rules.requirements))
    for stream in range(STREAMS):
        exchange.search(stream, judged, GO)
    return exchange.found()


@settings(max_examples=60, deadline=None)
@given(data=st.data())
def test_what_exchange_finds_is_a_grasp_and_never_better_than_the_optimum(data):
    """Each is feasible, its indices are distinct and sorted, and the exact search finds no worse."""
    space, rules = data.draw(option_spaces(most=6)), data.draw(any_rules())
    if not lifting_counts(space, rules.requirements):
        return
    found = searched(space, rules, 20_000)
    best = solve(space, rules).designs
    assert bool(best) or not found
    for active in found:
        grasp = evaluate(space, rules, from_active(space, active))
        assert grasp.feasible
        assert all(list(indices) == sorted(set(indices)) for indices in active)
        assert grasp.value >= best[0].value * (1 - 1e-9)


@pytest.mark.parametrize("criterion", ["divergence", "moment+structure", "moment+deviation"])
def test_exchange_comes_near_the_optimum_of_the_plate(criterion):
    """Of 40 cups and 60 magnets at two heights: within 2 %."""
    rules = some_rules(criterion=criterion)
    best = solve(plate(), rules).designs[0].value
    found = searched(plate(), rules, 3_000_000)
    values = [evaluate(plate(), rules, from_active(plate(), active)).value for active in found]
    assert min(values) <= 1.02 * best


def test_exchange_is_the_same_every_time_however_it_is_cut():
    """Streams have their own random numbers, and go on where they stopped."""
    rules = some_rules()
    assert searched(plate(), rules, 200_000) == searched(plate(), rules, 200_000)


def test_exchange_goes_on_from_what_is_known_and_stops_when_told():
    """A grasp that it is given is not lost; told to halt, it judges none."""
    rules = some_rules()
    start = any_feasible(plate(), rules.requirements)
    value = evaluate(plate(), rules, start).value
    exchange = Exchange(plate(), rules, lifting_counts(plate(), rules.requirements))
    exchange.search(0, 1_000_000, np.ones(1, dtype=np.int64))
    assert exchange.found() == []
    exchange.know(start.active, value)
    assert exchange.found() == [tuple(map(tuple, map(sorted, start.active)))] * STREAMS
    exchange.search(0, 10_000, GO)
    assert evaluate(plate(), rules, from_active(plate(), exchange.found()[0])).value <= value


@settings(max_examples=40, deadline=None)
@given(data=st.data())
def test_every_place_lies_in_its_cell(data):
    """Cells hold each place of a kind once, and each place is within its cell."""
    space = data.draw(option_spaces(most=12))
    tables = tabulate(space, some_rules())
    cells = lay_cells(tables)
    assert sorted(cells.order.tolist()) == list(range(len(tables.footprints)))
    for k, shape in enumerate(cells.shape.tolist()):
        for cell in range(shape[0] * shape[1]):
            begin = cells.first[k] + cell
            corner = cells.low[k] + cells.size[k] * np.array(divmod(cell, shape[1]))
            for place in cells.order[cells.start[begin] : cells.start[begin + 1]].tolist():
                at = tables.footprints[place]
                inside = np.array([at["x"], at["y"]]) - corner
                assert (inside >= -1e-9).all()
                assert (inside <= cells.size[k] * (1 + 1e-9)).all()


@pytest.mark.parametrize("levels", [(0.0,), (0.0, 15.0), (0.0, 15.0, 40.0)])
@pytest.mark.parametrize("arm", ["3d", "plan"])
def test_the_floor_of_the_moment_knows_what_heights_can_balance(levels, arm):
    """It is that of the best heights of all for these counts, whichever places they take."""
    places = [(60.0 * x, 60.0 * y, z) for x in range(-2, 3) for y in range(3) for z in levels[:1]]
    places += [(60.0 * x, -60.0, z) for x, z in enumerate(levels[1:])]
    part, need = Part(9000.0, frozen([0.0, 20.0, 7.3])), Requirements(moment_arm=arm)
    kinds = (kind("suction", places), kind("magnets", places, force_n=130.0, price=30.0))
    space = OptionSpace(part, kinds, rectangle(300, 200), 0.6)
    for (cups, magnets), floor in floors_by_counts(space, need).items():
        force = 69.0 * cups + 130.0 * magnets
        least = min(
            abs(69.0 * sum(above) + 130.0 * sum(over)) / force
            for above in combinations_with_replacement([z - 7.3 for z in levels], cups)
            for over in combinations_with_replacement([z - 7.3 for z in levels], magnets)
        )
        wanted = hypot(0.0, least if arm == "3d" else 0.0) * part.weight_n
        assert floor.moment == pytest.approx(wanted, rel=1e-12, abs=1e-9)
