"""The compiled genetic search: many generations a call, the same stream as ``mutation.py``."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from grasp_xl.chromosome import UNSET_GENE
from grasp_xl.compiled import allocation_free, compiled
from grasp_xl.kernels import Tables, active_places, fitness, is_clear, lifting_force, value_below
from grasp_xl.search.mutation import TRIES_PER_MATRIX
from grasp_xl.space import IntArray


class Population(NamedTuple):
    """The arrays that one generation leaves for the next; ``evolve`` changes them in place.

    parent, best, last_valid ``(kinds, 1 + slots)``; matrix alike; children ``(n, kinds, 1 +
    slots)``.  ``best`` is all zero until a grasp meets FoS and clearance, ``last_valid`` until a
    design is entered in the valid-design list.
    """

    parent: IntArray
    best: IntArray
    last_valid: IntArray
    matrix: IntArray
    children: IntArray


class Room(NamedTuple):
    """Room for a record of one call: ``generation (n,)``, ``genes (n, kinds, 1 + slots)``."""

    generation: IntArray
    genes: IntArray


class Outcome(NamedTuple):
    """What one call did: generations run, children judged, records written, best improved."""

    generations: int
    evaluations: int
    changes: int
    designs: int
    improved: bool


@allocation_free
def draw(rng: np.random.Generator, low: int, high: int) -> int:
    """Twin of ``mutation.draw``."""
    return low + int(rng.random() * (high - low + 1))


@allocation_free
def is_repeated(genes: IntArray, kind: int, slot: int) -> bool:
    """Tell whether an active gene is the same as an earlier one of its kind."""
    if slot <= genes[kind, 0]:
        for earlier in range(1, slot):
            if genes[kind, earlier] == genes[kind, slot]:
                return True
    return False


@allocation_free
def draw_chromosome(t: Tables, rng: np.random.Generator, genes: IntArray) -> None:
    """Twin of ``mutation.random_chromosome``, into ``genes``."""
    elements = 0
    while elements == 0:
        for kind in range(len(genes)):
            for slot in range(genes.shape[1]):
                genes[kind, slot] = 0
            if t.kinds[kind].total:
                genes[kind, 0] = draw(rng, t.kinds[kind].count_min, t.kinds[kind].count_max)
            elements += genes[kind, 0]
    for kind in range(len(genes)):
        if t.kinds[kind].total:
            for slot in range(1, genes.shape[1]):
                genes[kind, slot] = draw(rng, UNSET_GENE, t.kinds[kind].total)
                while is_repeated(genes, kind, slot):
                    genes[kind, slot] = draw(rng, UNSET_GENE, t.kinds[kind].total)


@allocation_free
def mutate(
    t: Tables,
    rng: np.random.Generator,
    parent: IntArray,
    matrix: IntArray,
    counts_too: bool,
    child: IntArray,
) -> None:
    """Twin of ``mutation.mutated``, into ``child``."""
    for kind in range(len(parent)):
        for slot in range(parent.shape[1]):
            child[kind, slot] = parent[kind, slot]
            if t.kinds[kind].total and (matrix[kind, slot] or (counts_too and slot == 0)):
                if slot == 0:
                    child[kind, slot] = draw(rng, t.kinds[kind].count_min, t.kinds[kind].count_max)
                else:
                    child[kind, slot] = draw(rng, UNSET_GENE, t.kinds[kind].total)


@allocation_free
def breed_clear(
    t: Tables,
    rng: np.random.Generator,
    parent: IntArray,
    matrix: IntArray,
    child: IntArray,
    places: IntArray,
) -> int:
    """Twin of ``mutation.clear_child``, into ``child``; return its count of elements.

    ``places`` are then those of its active genes.  The count is 0 where the child was left a copy.
    """
    for attempt in range(2 * TRIES_PER_MATRIX):
        mutate(t, rng, parent, matrix, attempt >= TRIES_PER_MATRIX, child)
        n = active_places(t, child, places)
        if n > 0 and is_clear(t, places, n):
            return n
    copy_into(parent, child)
    return 0


@allocation_free
def copy_into(source: IntArray, target: IntArray) -> None:
    """Copy genes one by one; a slice assignment would allocate."""
    for kind in range(len(source)):
        for slot in range(source.shape[1]):
            target[kind, slot] = source[kind, slot]


@allocation_free
def same(a: IntArray, b: IntArray) -> bool:
    """Tell whether two chromosomes have the same genes."""
    for kind in range(len(a)):
        for slot in range(a.shape[1]):
            if a[kind, slot] != b[kind, slot]:
                return False
    return True


@allocation_free
def draw_matrix(rng: np.random.Generator, one_in: float, matrix: IntArray) -> None:
    """Twin of ``mutation.mutation_matrix``, into ``matrix``."""
    for kind in range(len(matrix)):
        for slot in range(matrix.shape[1]):
            matrix[kind, slot] = rng.random() < 1.0 / one_in


@allocation_free
def breed_all(
    t: Tables,
    rng: np.random.Generator,
    population: Population,
    elitism: bool,
    parent_value: float,
    places: IntArray,
) -> tuple[int, float, int]:
    """Breed and judge all children; return the fittest's number, its value, and how many judged.

    The number is -1 where none meets FoS and clearance.
    """
    parent, _, _, matrix, children = population
    fittest, fittest_value, judged = -1, np.inf, 0
    for number in range(len(children)):
        child = children[number]
        value = parent_value
        if elitism and number == 0:
            copy_into(parent, child)
        else:
            n = breed_clear(t, rng, parent, matrix, child, places)
            if n and lifting_force(t, child) < t.force_min:
                value = np.inf
            elif n:
                value = value_below(t, child, places, n, fittest_value)
                judged += 1
        if value < fittest_value:
            fittest, fittest_value = number, value
    return fittest, fittest_value, judged


@allocation_free
def enter(room: Room, row: int, generation: int, genes: IntArray) -> int:
    """Write a row of a record and return the number of the next."""
    room.generation[row] = generation
    copy_into(genes, room.genes[row])
    return row + 1


@compiled
def evolve(
    t: Tables,
    rng: np.random.Generator,
    population: Population,
    one_in: float,
    elitism: bool,
    baseline: float,
    done: int,
    budget: int,
    changes: Room,
    designs: Room,
) -> Outcome:
    """Run up to ``budget`` generations after generation ``done``; stop early when best improves.

    Parameters
    ----------
    t : Tables
    rng : numpy.random.Generator
        Its state moves on; it is the whole memory of chance.
    population : Population
        Changed in place.
    one_in, elitism : float, bool
        Mutation probability 1-in-n, and whether child 1 stays a copy of the parent.
    baseline : float
        Value below which the fittest enters the valid-design list (section 5.2.5).
    done, budget : int
    changes, designs : Room
        Room for ``budget`` rows each: the fittest where it changed, and the valid designs.
    """
    parent, best, last_valid, matrix, children = population
    places = np.empty(parent.size, dtype=np.int64)
    parent_value = fitness(t, parent, places)
    best_value = fitness(t, best, places) if best.any() else np.inf
    generation, evaluations, n_changes, n_designs = done, 0, 0, 0
    improved = False
    while generation < done + budget and not improved:
        generation += 1
        changed = generation == 1
        if generation > 1 and parent_value == np.inf:
            draw_chromosome(t, rng, parent)
            parent_value = fitness(t, parent, places)
            changed = True
        draw_matrix(rng, one_in, matrix)
        fittest, value, judged = breed_all(t, rng, population, elitism, parent_value, places)
        evaluations += judged
        if fittest >= 0:
            changed = changed or not same(parent, children[fittest])
            copy_into(children[fittest], parent)
            parent_value = value
        if changed:
            n_changes = enter(changes, n_changes, generation, parent)
        if parent_value < baseline and not same(parent, last_valid):
            n_designs = enter(designs, n_designs, generation, parent)
            copy_into(parent, last_valid)
        improved = parent_value < best_value
        if improved:
            copy_into(parent, best)
    return Outcome(generation - done, evaluations, n_changes, n_designs, improved)


@compiled
def draw_feasible(t: Tables, rng: np.random.Generator, draws: int, rows: IntArray) -> int:
    """Fill ``rows`` with random chromosomes that meet FoS and clearance; return how many fitted."""
    places = np.empty(rows.shape[1] * rows.shape[2], dtype=np.int64)
    found = 0
    for _ in range(draws):
        if found == len(rows):
            break
        draw_chromosome(t, rng, rows[found])
        n = active_places(t, rows[found], places)
        if lifting_force(t, rows[found]) >= t.force_min and is_clear(t, places, n):
            found += 1
    return found
