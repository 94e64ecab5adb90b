"""The thesis's genetic search, from an option space to a result (sections 4.2 and 5.2)."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from grasp_xl.chromosome import Chromosome
from grasp_xl.grasp import evaluate
from grasp_xl.kernels import tabulate
from grasp_xl.rules import Rules
from grasp_xl.search.evolution import Population, Room, evolve
from grasp_xl.search.mutation import random_chromosome
from grasp_xl.search.result import (
    GeneticSettings,
    Result,
    State,
    Trace,
    dump_stream,
    empty_trace,
    load_stream,
)
from grasp_xl.search.stop import CHUNK, Progress, StopRule, first_to_stop
from grasp_xl.space import OptionSpace

OnProgress = Callable[[Progress], None]


def start(space: OptionSpace, settings: GeneticSettings, benchmark: Chromosome) -> State:
    """Return the state before generation 1 (section 5.2.1).

    The randomizer draws in any case, so that both scenarios show it and use the same stream.
    """
    rng = np.random.default_rng(settings.seed)
    drawn = random_chromosome(space, rng)
    initial = benchmark if settings.user_start else drawn
    return State(
        generation=0,
        evaluations=0,
        parent=initial,
        random_state=dump_stream(rng),
        random_chromosome=drawn,
        initial=initial,
        changes=empty_trace(space),
        designs=empty_trace(space),
        best=None,
        improved_at=0,
    )


def search(
    space: OptionSpace,
    rules: Rules,
    settings: GeneticSettings,
    benchmark: Chromosome,
    stop: Sequence[StopRule],
    *,
    state: State | None = None,
    on_progress: OnProgress | None = None,
) -> Result:
    """Evolve grasps until the first rule stops.

    Parameters
    ----------
    space, rules, settings
        What to search, how to judge, how to evolve.
    benchmark : Chromosome
        The designer's grasp; also the start where ``settings.user_start`` is set.
    stop : sequence of StopRule
        At least one.
    state : State, optional
        Go on from here instead of starting: the same result as one uninterrupted run.
    on_progress : callable, optional
        Called every few milliseconds.

    Returns
    -------
    Result
    """
    began = time.perf_counter()
    state = state or start(space, settings, benchmark)
    tables = tabulate(space, rules)
    rng = load_stream(state.random_state)
    population = _population(state, settings.children)
    changes, designs = _room(state), _room(state)
    seen_changes, seen_designs = [state.changes], [state.designs]

    done, evaluations, improved_at = state.generation, state.evaluations, state.improved_at
    while True:
        progress = Progress(done, improved_at, _best_value(space, rules, population))
        if on_progress:
            on_progress(progress)
        budget, reason = first_to_stop(stop, progress)
        if reason:
            break
        outcome = evolve(
            tables,
            rng,
            population,
            settings.one_in,
            settings.elitism,
            rules.baseline,
            done,
            budget,
            changes,
            designs,
        )
        done += outcome.generations
        evaluations += outcome.evaluations
        improved_at = done if outcome.improved else improved_at
        seen_changes.append(_copied(changes, outcome.changes))
        seen_designs.append(_copied(designs, outcome.designs))

    best = Chromosome(population.best) if population.best.any() else None
    return Result(
        space=space,
        rules=rules,
        settings=settings,
        benchmark=evaluate(space, rules, benchmark),
        state=replace(
            state,
            generation=done,
            evaluations=evaluations,
            parent=Chromosome(population.parent),
            random_state=dump_stream(rng),
            changes=_joined(seen_changes),
            designs=_joined(seen_designs),
            best=best,
            improved_at=improved_at,
        ),
        matrix=population.matrix,
        children=tuple(Chromosome(genes) for genes in population.children),
        best=evaluate(space, rules, best) if best else None,
        stop_reason=reason,
        seconds=time.perf_counter() - began,
    )


def _population(state: State, children: int) -> Population:
    parent = np.array(state.parent.genes)
    designs = state.designs.genes
    return Population(
        parent=parent,
        best=np.array(state.best.genes) if state.best else np.zeros_like(parent),
        last_valid=np.array(designs[-1]) if len(designs) else np.zeros_like(parent),
        matrix=np.zeros_like(parent),
        children=np.tile(parent, (children, 1, 1)),
    )


def _best_value(space: OptionSpace, rules: Rules, population: Population) -> float:
    if not population.best.any():
        return float("inf")
    return evaluate(space, rules, Chromosome(population.best)).value


def _room(state: State) -> Room:
    shape = state.parent.genes.shape
    return Room(np.zeros(CHUNK, dtype=np.int64), np.zeros((CHUNK, *shape), dtype=np.int64))


def _copied(room: Room, rows: int) -> Trace:
    return Trace(room.generation[:rows].copy(), room.genes[:rows].copy())


def _joined(traces: list[Trace]) -> Trace:
    return Trace(
        np.concatenate([trace.generation for trace in traces]),
        np.concatenate([trace.genes for trace in traces]),
    )
