"""What stands in the way of a grasp is named, and what is said to help does help."""

from __future__ import annotations

from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from spaces import any_rules, every_grasp, kind, option_spaces, plate, rectangle, some_rules

from grasp_xl.chromosome import from_active
from grasp_xl.errors import InfeasibleError
from grasp_xl.grasp import evaluate
from grasp_xl.rounding import rounded_down, rounded_up
from grasp_xl.rules import SLACK, TERMS, Requirements
from grasp_xl.search.exact import ExactSettings, solve
from grasp_xl.search.floors import floors
from grasp_xl.search.obstacles import any_feasible, least_counts, smallest_changes
from grasp_xl.search.placing import place
from grasp_xl.search.proven_floors import proven_floors
from grasp_xl.search.unmet_goals import floor_warnings, why_none_meets_all
from grasp_xl.space import OptionSpace, Part, frozen

P1_CENTROID = (0.032786, 0.006258, 45.06829)


def with_kind(space: OptionSpace, number: int, **values: object) -> OptionSpace:
    """Change one kind of an option space."""
    kinds = list(space.kinds)
    kinds[number] = replace(kinds[number], **values)
    return replace(space, kinds=tuple(kinds))


def is_possible(space: OptionSpace, need: Requirements, min_elements: int = 1) -> bool:
    """Tell whether the search finds a grasp."""
    try:
        any_feasible(space, need, min_elements)
    except InfeasibleError:
        return False
    return True


def p1_space() -> OptionSpace:
    """The thesis's P1: a face at z = 100 mm with 12 cups and 12 magnets."""
    places = [(60.0 * x, 50.0 * y, 100.0) for x in range(-2, 2) for y in range(-1, 2)]
    return OptionSpace(
        Part(13796.195, frozen(P1_CENTROID)),
        (kind("suction", places), kind("magnets", places, force_n=130.0, price=30.0)),
        rectangle(360, 220),
        0.6,
    )


@settings(max_examples=60, deadline=None)
@given(data=st.data())
def test_every_suggested_number_works_and_none_is_larger_than_needed(data):
    """Any grasp exists just where brute force has one; else each change allows one, a smaller not."""
    space = data.draw(option_spaces(most=4))
    rules = data.draw(any_rules())
    need = replace(rules.requirements, fos=data.draw(st.sampled_from([1.0, 3.0, 8.0])))
    least = data.draw(st.integers(1, 3))
    rules = replace(rules, requirements=need)
    large = [g for g in every_grasp(space, rules) if len(g.points_mm) >= least]
    assert is_possible(space, need, least) == any(grasp.feasible for grasp in large)
    if any(grasp.feasible for grasp in large):
        return
    changes = smallest_changes(space, need, least)
    reach = max((grasp.fos for grasp in large if grasp.is_clear), default=None)
    assert changes.fos == (reach and pytest.approx(reach, rel=2e-3))
    if changes.fos:
        assert is_possible(space, replace(need, fos=changes.fos), least)
    apart = max((g.clearance_mm or 0.0 for g in large if g.meets_fos), default=0.0)
    assert (changes.clearance_mm or 0.0) == pytest.approx(apart, rel=0.02)
    if changes.clearance_mm:
        assert is_possible(space, replace(need, clearance_mm=changes.clearance_mm), least)
    for number, each in enumerate(space.kinds):
        most, force = changes.counts_max[number], changes.forces_n[number]
        tried = range(each.count_max + 1, each.total + 1)
        works = [
            n for n in tried if is_possible(with_kind(space, number, count_max=n), need, least)
        ]
        assert most == min(works, default=None)
        if force:
            assert force > each.force_n
            assert is_possible(with_kind(space, number, force_n=force), need, least)
            weaker = force * (1 - 1.1e-3)  # forces are told in four digits
            assert not is_possible(with_kind(space, number, force_n=weaker), need, least)
    if changes.min_elements:
        assert is_possible(space, need, changes.min_elements)
        assert not is_possible(space, need, changes.min_elements + 1)


@settings(max_examples=60, deadline=None)
@given(data=st.data())
def test_placed_elements_keep_their_distance(data):
    """Places that are found are distinct, as many as asked for, and far enough apart."""
    space = data.draw(option_spaces(most=8))
    counts = tuple(data.draw(st.integers(0, each.total)) for each in space.kinds)
    clearance = data.draw(st.sampled_from([10.0, 26.0, 46.0, 90.0]))
    if not any(counts):
        return
    placing = place(space, counts, clearance, 1.0)
    if placing.active:
        assert tuple(len(set(indices)) for indices in placing.active) == counts
        wide = replace(
            space, kinds=tuple(replace(k, count_min=0, count_max=k.total) for k in space.kinds)
        )
        rules = some_rules(clearance_mm=clearance)
        assert evaluate(wide, rules, from_active(wide, placing.active)).is_clear


def crowded_cups() -> OptionSpace:
    """49 cups on 60 x 60 mm, of which four keep 46 mm, and many magnets with room for all."""
    cups = [(10.0 * x, 10.0 * y, 0.0) for x in range(7) for y in range(7)]
    magnets = [(100.0 + 30.0 * x, 30.0 * y, 0.0) for x in range(20) for y in range(20)]
    kinds = (kind("suction", cups), kind("magnets", magnets, force_n=130.0, price=30.0))
    return replace(plate(), kinds=kinds)


def test_one_kind_without_room_is_proof_at_once():
    """Five cups find no room, so five cups with five of 400 magnets do not."""
    placing = place(crowded_cups(), (5, 5), 46.0, 0.5)
    assert (placing.active, placing.proved) == (None, True)


def test_a_search_for_any_grasp_that_is_told_to_stop_says_that_nothing_is_proved():
    """Neither does it look for changes that would help."""
    need = Requirements(fos=11.4, clearance_mm=42.0)
    assert any_feasible(crowded_cups(), need)
    with pytest.raises(InfeasibleError, match=r"No grasp that keeps 42 mm .* was found in") as told:
        any_feasible(crowded_cups(), need, stop=lambda: True)
    assert not told.value.proved
    assert (
        told.value.hint
        == "No single number that helps was found: change several, or add footprints"
    )


def test_a_goal_that_the_clearance_forbids_says_so():
    """All ten would reach FoS 11.44, but only four cups keep the clearance: 926 N against 86.9 N."""
    hint = "Lower the FoS goal to 10.65 (no places were found for more elements)"
    with pytest.raises(InfeasibleError) as told:
        any_feasible(crowded_cups(), Requirements(fos=12.0, clearance_mm=46.0))
    assert told.value.hint.startswith(hint)


def test_least_counts_lift_and_can_spare_nothing():
    """Of the counts that meet FoS 3 on the plate, only those without a spare element are listed."""
    assert least_counts(plate(), Requirements()) == [(1, 2), (2, 1)]
    assert least_counts(plate(), Requirements(), 5) == [(1, 4), (2, 3), (3, 2), (4, 1)]


def test_too_little_force_says_how_much_and_all_that_would_help():
    """One sentence names FoS and its reach; the hint names goal, Max. and force of each kind."""
    with pytest.raises(InfeasibleError) as told:
        any_feasible(plate(), Requirements(fos=12.0))
    assert told.value.where == "FoS"
    assert told.value.message == (
        "No grasp can reach FoS 12: 5 suction and 5 magnets together reach "
        "FoS 11.44 against 86.917 N."
    )
    assert told.value.hint == (
        "Lower the FoS goal to 11.44, raise # Max. of suction to 6, raise # Max. of magnets to 6, "
        "use suction of 78.6 N or use magnets of 139.6 N"
    )


def test_too_few_elements_are_named():
    """More elements asked for than Max. allows: the error says how many may be asked for."""
    with pytest.raises(InfeasibleError, match=r"11 elements: # Max\. allows 10") as told:
        any_feasible(plate(), Requirements(), 11)
    assert told.value.hint.startswith("Lower the least number of elements to 10")


def test_a_clearance_that_no_grasp_keeps_is_answered_with_one_that_works():
    """Two cups and two magnets in a row 100 mm apart: three of them keep 100 mm, not more."""
    row = [(100.0 * x, 0.0, 0.0) for x in range(3)]
    space = replace(
        plate(), kinds=(kind("suction", row), kind("magnets", row, force_n=130.0, price=30.0))
    )
    with pytest.raises(InfeasibleError, match="No grasp can keep 140 mm between") as told:
        any_feasible(space, Requirements(clearance_mm=140.0))
    assert "FoS 3 takes at least 3 of them" in told.value.message
    assert "ower the clearance to 100 mm" in told.value.hint


def test_rounded_numbers_stay_on_their_side():
    """A number rounded down is at most itself, rounded up at least, but for the slack of 1e-9."""
    for number in (1e-7, 0.99999, 3.0, 45.06831 * 135.3407, 0.1 + 0.2, 123456789.0):
        for digits in (3, 4, 6):
            assert rounded_down(number, digits) <= number * (1 + SLACK)
            assert rounded_up(number, digits) >= number * (1 - SLACK)
            assert rounded_down(number, digits) == pytest.approx(number, rel=10.0 ** (1 - digits))


# --- floors and goals ---


@settings(max_examples=40, deadline=None)
@given(data=st.data())
def test_proven_floors_are_the_least_values_of_all_grasps(data):
    """Each equals brute force over all feasible grasps, and is never below the fast floor."""
    space = data.draw(option_spaces(most=4))
    rules = data.draw(any_rules())
    feasible = [grasp for grasp in every_grasp(space, rules) if grasp.feasible]
    if not feasible:
        return
    least = [min(column) for column in zip(*(grasp.terms for grasp in feasible), strict=True)]
    proven, attained = proven_floors(space, rules, seconds=60.0)
    assert attained == set(TERMS)
    assert list(proven) == pytest.approx(least, rel=1e-8, abs=1e-8)
    for fast, exact in zip(floors(space, rules.requirements), proven, strict=True):
        assert fast <= exact * (1 + SLACK) + 1e-8


def test_floors_that_are_not_proven_in_time_are_the_fast_ones_or_better():
    """With no time at all each floor is still a true bound, and none is said to be attained."""
    space, rules = plate(), some_rules()
    fast = floors(space, rules.requirements)
    none, attained = proven_floors(space, rules, seconds=0.0)
    assert not attained
    proven = proven_floors(space, rules, seconds=0.5).least
    for low, middle, high in zip(fast, none, proven, strict=True):
        assert low <= middle <= high * (1 + SLACK)


def test_the_thesis_goal_of_p1_is_below_its_floor():
    """The benchmark moment 6099.57 N-mm is named against the floor of 7434.5 N-mm, with the arm."""
    space, rules = p1_space(), some_rules((100.0, 6099.57, 27.97, 1111.43))
    proven = proven_floors(space, rules, seconds=5.0).least
    for least in (floors(space, rules.requirements), proven):
        assert least.moment == pytest.approx(7434.5, abs=0.5)
        (warning,) = floor_warnings(rules, least)
        assert warning.where == "moment goal"
        assert "6,099.57 N-mm" in warning.found
        assert "have a moment below 7,434." in str(warning)
        assert "with the 3d arm" in str(warning)
    plan = some_rules((100.0, 6099.57, 27.97, 1111.43), moment_arm="plan")
    assert floor_warnings(plan, floors(space, plan.requirements)) == []


def test_goals_that_no_grasp_meets_are_explained():
    """The goal below its floor is named, and raised as the hint says it is met by a grasp."""
    space, rules = p1_space(), some_rules((150.0, 6099.57, 60.0, 1111.43))
    least = proven_floors(space, rules, seconds=5.0).least
    error = why_none_meets_all(space, rules, least, 1)
    assert error.message.startswith(
        "No grasp meets all goals: the moment goal of 6,099.57 N-mm is below its floor of 7,434."
    )
    assert error.hint.startswith("Raise the moment goal to 7,")
    raised = float(error.hint.split()[5].replace(",", ""))
    goals = replace(rules.goals, base=rules.goals.base._replace(moment=raised))
    met = solve(space, replace(rules, goals=goals), ExactSettings(meet_goals=True))
    assert met.status == "optimal"


def test_goals_that_only_together_are_too_low_are_explained():
    """No goal is below its floor; each single change that helps is named."""
    space, rules = p1_space(), some_rules()
    least = proven_floors(space, rules, seconds=5.0).least
    tight = some_rules(tuple(1.0001 * value for value in least))
    error = why_none_meets_all(space, tight, least, 1)
    assert "no goal is below its floor" in error.message
    assert error.hint == "No single goal that helps was found: raise several"
    loose = some_rules((2.0 * least.cost, 1.0001 * least.moment, 500.0, least.structure * 1.0001))
    assert "aise the structure goal to" in why_none_meets_all(space, loose, least, 1).hint
    two = why_none_meets_all(space, some_rules((1.0, 1.0, 500.0, 5000.0)), least, 1)
    assert two.hint == "Raise the goals of cost, moment"
