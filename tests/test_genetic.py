"""The genetic search: the compiled one is the readable one, and keeps the thesis's rules."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from spaces import any_rules, chromosomes, option_spaces, plate, some_rules

from grasp_xl.chromosome import Chromosome, from_active
from grasp_xl.errors import InfeasibleError
from grasp_xl.grasp import evaluate
from grasp_xl.rules import SLACK
from grasp_xl.search import mutation
from grasp_xl.search.benchmark import assigned_benchmark
from grasp_xl.search.genetic import search, start
from grasp_xl.search.obstacles import any_feasible
from grasp_xl.search.result import GeneticSettings, Result
from grasp_xl.search.stop import Generations, Stall, StopRule, Target, TimeLimit

SPACE = plate()
BENCHMARK = from_active(SPACE, [(3, 9), (11, 27)])
RULES = some_rules(tuple(evaluate(SPACE, some_rules(), BENCHMARK).terms))


def evolved(stop: StopRule | list[StopRule], state=None, rules=RULES, **settings) -> Result:
    """Run on the plate."""
    stops = stop if isinstance(stop, list) else [stop]
    return search(SPACE, rules, GeneticSettings(**settings), BENCHMARK, stops, state=state)


def same_course(one: Result, other: Result) -> bool:
    """Tell whether two runs went the same way, gene for gene."""
    pairs = [
        (one.state.changes.generation, other.state.changes.generation),
        (one.state.changes.genes, other.state.changes.genes),
        (one.state.designs.generation, other.state.designs.generation),
        (one.state.designs.genes, other.state.designs.genes),
        (one.matrix, other.matrix),
    ]
    return (
        all(np.array_equal(a, b) for a, b in pairs)
        and one.children == other.children
        and one.state.random_state == other.state.random_state
        and one.state.best == other.state.best
        and one.state.evaluations == other.state.evaluations
    )


@settings(max_examples=40, deadline=None)
@given(data=st.data())
def test_compiled_generations_are_the_readable_ones(data):
    """Gene for gene, matrix for matrix: 8 generations of both twins from the same stream."""
    space = data.draw(option_spaces())
    rules = data.draw(any_rules())
    ga = GeneticSettings(
        one_in=data.draw(st.sampled_from([1.0, 2.0, 4.0])),
        children=data.draw(st.integers(2, 4)),
        elitism=data.draw(st.booleans()),
        user_start=data.draw(st.booleans()),
        seed=data.draw(st.integers(0, 1000)),
    )
    benchmark = data.draw(chromosomes(space))
    rng = np.random.default_rng(ga.seed)
    drawn = mutation.random_chromosome(space, rng)
    parent = benchmark if ga.user_start else drawn
    state = start(space, ga, benchmark)
    assert state.random_chromosome == drawn
    for generation in range(1, 9):
        if generation > 1 and not evaluate(space, rules, parent).feasible:
            parent = mutation.random_chromosome(space, rng)
        expected = mutation.next_generation(
            space,
            rules,
            rng,
            parent,
            children=ga.children,
            one_in=ga.one_in,
            elitism=ga.elitism,
        )
        parent = expected.fittest or parent
        result = search(space, rules, ga, benchmark, [Generations(generation)], state=state)
        state = result.state
        assert np.array_equal(result.matrix, expected.matrix)
        assert result.children == expected.children
        if state.parent != parent:  # the twins' criteria agree to 1e-12, not to the last bit
            values = [evaluate(space, rules, each).value for each in (parent, state.parent)]
            assert values[0] == pytest.approx(values[1], rel=1e-12)
            parent = state.parent


@pytest.mark.parametrize("elitism", [True, False])
@pytest.mark.parametrize("user_start", [True, False])
@pytest.mark.parametrize("splits", [[1], [7, 4096], [4097, 5000], [1, 2, 3, 9999]])
def test_continued_run_equals_an_uninterrupted_one(elitism, user_start, splits):
    """However often a run is stopped and continued, its whole course is the same."""
    ga = {"elitism": elitism, "user_start": user_start, "seed": 5}
    whole = evolved(Generations(10_000), **ga)
    state = None
    for limit in [*splits, 10_000]:
        part = evolved(Generations(limit), state, **ga)
        state = part.state
    assert same_course(part, whole)


def test_same_seed_same_course_and_other_seed_another():
    """A run is a function of its seed."""
    assert same_course(evolved(Generations(2000)), evolved(Generations(2000)))
    assert not same_course(evolved(Generations(2000)), evolved(Generations(2000), seed=2))


def test_elitism_never_lets_the_fittest_get_worse():
    """With elitism the divergence falls monotonically, and child 1 is the parent unmutated."""
    history = evolved(Generations(5000), user_start=True).history()["divergence"]
    assert (history.diff().dropna() <= 0).all()


def test_without_elitism_the_best_is_still_kept():
    """Without elitism the fittest may get worse; best is the best ever seen."""
    result = evolved(Generations(3000), elitism=False)
    divergence = result.history()["divergence"]
    assert (divergence.diff() > 0).any()
    assert result.best.value == pytest.approx(divergence.min(), rel=1e-12)
    found = divergence[result.history()["generation"] == result.state.improved_at].iloc[0]
    assert found == pytest.approx(divergence.min(), rel=1e-12)


def test_every_recorded_grasp_keeps_fos_and_clearance():
    """All fittest after a feasible start, and all valid designs, meet both constraints."""
    result = evolved(Generations(3000), user_start=True, elitism=False)
    for trace in (result.state.changes, result.state.designs):
        assert all(evaluate(SPACE, RULES, Chromosome(g)).feasible for g in trace.genes[::50])
    designs = result.valid_designs()
    assert (designs["divergence"] < 4).all()
    assert (designs["fos"] >= 3 * (1 - SLACK)).all()


def test_valid_designs_are_better_than_the_benchmark_and_never_repeat_in_a_row():
    """The valid-design list holds each better grasp once in a row, with its generation."""
    designs = evolved(Generations(3000), elitism=False).valid_designs()
    genes = designs.drop(columns=["generation"]).to_numpy()
    assert len(designs) > 100
    assert designs["generation"].is_monotonic_increasing
    assert all((a != b).any() for a, b in pairwise(genes))


def test_weak_random_start_is_replaced_until_a_child_passes():
    """A parent below FoS shows no fitness and gives way to new random ones (appendix D)."""
    result = evolved(Generations(300), rules=some_rules(fos=11.4), user_start=False)
    history = result.history()
    weak = history[history["divergence"].isna()]
    assert len(weak) == 2
    assert (weak["fos"] < 11.4).all()
    assert result.best is not None
    assert result.best.fos >= 11.4


def test_a_matrix_that_cannot_help_is_overridden():
    """The infinite loop of figure 32: indices alone cannot part two equal ones, counts can."""
    parent = Chromosome(np.array([[5, 3, 9, 15, 1, 1], [2, 11, 27, 1, 1, 1]]))
    matrix = np.array([[0, 1, 0, 0, 0, 0], [0, 0, 0, 0, 0, 0]])
    rng = np.random.default_rng(0)
    assert not mutation.keeps_clearance(SPACE, RULES, parent)
    child = mutation.clear_child(SPACE, RULES, rng, parent, matrix)
    assert mutation.keeps_clearance(SPACE, RULES, child)
    assert child.counts[0] < 5
    fixed = Chromosome(np.array([[2, 3, 3, 15, 1, 1], [2, 11, 27, 1, 1, 1]]))
    crowded = some_rules(clearance_mm=5000.0)
    assert mutation.clear_child(SPACE, crowded, rng, fixed, matrix) == fixed


def test_stop_rules_act_at_the_exact_generation():
    """Stall and target stop where they should, whatever the chunks; the first of several wins."""
    whole = evolved(Generations(20_000))
    last = whole.state.improved_at
    stalled = evolved([Stall(1500), Generations(10**9)])
    changes = whole.history()
    gaps = changes["generation"].diff().shift(-1)
    first_gap = changes["generation"][gaps >= 1500].iloc[0]
    assert stalled.state.generation == first_gap + 1500
    assert stalled.stop_reason == "stall"
    target = whole.best.value
    hit = evolved([Target(target), Generations(10**9)])
    assert (hit.stop_reason, hit.state.generation) == ("target", last)
    both = evolved([Generations(100), Stall(10**6), Target(0.0)])
    assert (both.stop_reason, both.state.generation) == ("generations", 100)


def test_time_limit_is_kept():
    """A run of endless generations ends within 0.3 s of its time limit."""
    result = evolved([TimeLimit(0.2), Generations(10**9)])
    assert result.stop_reason == "time"
    assert 0.2 <= result.seconds < 0.5


def test_no_generation_leaves_the_start():
    """A run of no generations shows the initial chromosome in parent and children."""
    result = evolved(Generations(0))
    assert result.state.parent == BENCHMARK
    assert result.children == (BENCHMARK,) * 5
    assert not result.matrix.any()
    assert result.history().empty
    assert result.best is None


def test_benchmark_is_the_same_for_ever_and_feasible():
    """The assigned benchmark does not depend on any seed, and meets FoS and clearance."""
    need = RULES.requirements
    first = assigned_benchmark(SPACE, need)
    assert first == assigned_benchmark(SPACE, need)
    assert evaluate(SPACE, RULES, first).feasible
    assert first.active == ((31, 39), (1,))


def test_narrow_spaces_still_get_a_benchmark():
    """Where random draws fail, the exhaustive search finds the one grasp that exists."""
    need = some_rules(fos=7.9, clearance_mm=170.0).requirements
    found = any_feasible(SPACE, need)
    assert evaluate(SPACE, some_rules(fos=7.9, clearance_mm=170.0), found).feasible


def test_impossible_force_is_said_at_once():
    """Five of each cannot reach FoS 40: the error says what they reach and what would help."""
    with pytest.raises(InfeasibleError, match=r"reach FoS 11\.44") as told:
        assigned_benchmark(SPACE, some_rules(fos=40.0).requirements)
    assert "ower the FoS goal to 11.44" in told.value.hint


def test_impossible_distance_is_said():
    """No two footprints are 5 m apart: the error says so."""
    with pytest.raises(InfeasibleError, match="No grasp can keep 5000 mm"):
        assigned_benchmark(SPACE, some_rules(clearance_mm=5000.0).requirements)


@settings(max_examples=60, deadline=None)
@given(data=st.data())
def test_random_chromosomes_are_in_range(data):
    """Counts lie in their ranges, indices in theirs, active ones are distinct, never none at all."""
    space = data.draw(option_spaces())
    rng = np.random.default_rng(data.draw(st.integers(0, 99)))
    for _ in range(20):
        drawn = mutation.random_chromosome(space, rng)
        assert drawn.counts.sum() > 0
        for row, each in zip(drawn.genes, space.kinds, strict=True):
            assert each.count_min <= row[0] <= each.most
            assert all(min(1, each.total) <= gene <= each.total for gene in row[1:])
            active = row[1 : 1 + row[0]]
            assert len(set(active.tolist())) == len(active)
