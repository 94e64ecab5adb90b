"""The exact search against a second model of the same problem, proved by a general solver.

``benchmarks/exact_models`` states the problem from the equations of ``docs/algorithm.md`` as a
linear model and has HiGHS solve it; it shares no code with our search.
"""

from __future__ import annotations

from pathlib import Path

import pytest
from exact_models.highs import minimise
from exact_models.proof import TOLERANCE, prove
from exact_models.small import thinned
from hypothesis import given, settings
from hypothesis import strategies as st
from spaces import any_rules, option_spaces, plate, some_rules

from grasp_xl.commands.preparing import prepare
from grasp_xl.rules import Rules
from grasp_xl.search.exact import solve
from grasp_xl.space import OptionSpace
from grasp_xl.task import Parameters
from grasp_xl.workbook.book import read_book

WORKBOOKS = Path(__file__).parents[1] / "workbooks"
SECONDS = 60.0


def compare(space: OptionSpace, rules: Rules) -> None:
    """Hold our optimum, and whether there is a grasp at all, to the solver's."""
    theirs = prove(space, rules, minimise, SECONDS)
    ours = solve(space, rules)
    assert theirs.proved
    assert ours.status == ("optimal" if theirs.best else "infeasible")
    if theirs.best:
        accuracy = 2 * TOLERANCE * max(rules.baseline, theirs.best.value)
        assert ours.designs[0].value == pytest.approx(theirs.best.value, rel=0, abs=accuracy)
        assert ours.designs[0].feasible


@settings(max_examples=60, deadline=None)
@given(data=st.data())
def test_optimum_of_random_spaces_is_that_of_a_general_solver(data):
    """Every criterion, both arms, ties, two heights: both prove one optimum, or that none exists."""
    compare(data.draw(option_spaces(most=6)), data.draw(any_rules()))


@pytest.mark.parametrize("part", ["bracket", "door_frame", "panel", "tunnel_cover"])
def test_optimum_of_sample_parts_is_that_of_a_general_solver(part):
    """Some footprints of a sample part, its own goals and constraints: both prove one optimum."""
    task = prepare(read_book(WORKBOOKS / f"{part}.xlsx"), Parameters())
    compare(thinned(task.space, 8), task.rules)


@pytest.mark.parametrize("arm", ["3d", "plan"])
def test_optimum_of_many_elements_is_that_of_a_general_solver(arm):
    """Grasps of six elements and more on a plate of two heights."""
    compare(plate(cups=8, magnets=8), some_rules(fos=6.0, moment_arm=arm))
