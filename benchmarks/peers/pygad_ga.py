"""The thesis's genetic algorithm with PyGAD: one mating parent that is kept, and custom operators.

PyGAD maximises and refuses infinities, so the fitness is the value with its sign changed and a
large finite number below the FoS goal.  Its own selection takes the last of equal grasps and its
elitism has no choice in that, so the parent is chosen by an operator of ours (the first of equal
ones) and kept by ``keep_parents=-1``.  Without a crossover PyGAD would mutate the whole population;
the crossover operator here copies the parent.
"""

from __future__ import annotations

import numpy as np
import pygad

from benchmarks.peers.numpy_rules import NumpyRules
from grasp_xl.space import FloatArray, IntArray

WORST = -1e300


def run(
    rules: NumpyRules, rng: np.random.Generator, start: IntArray, one_in: float, generations: int
) -> IntArray:
    """Evolve the start for some generations of five children; return the parent of the next."""

    def fitness(_: pygad.GA, genes: IntArray, __: int) -> float:
        return max(-rules.value(genes), WORST)

    def mutation(offspring: IntArray, _: pygad.GA) -> IntArray:
        marks = rules.mutation_matrix(rng, one_in)
        return np.array([rules.clear_child(rng, row, marks) for row in offspring])

    algorithm = pygad.GA(
        num_generations=generations,
        num_parents_mating=1,
        fitness_func=fitness,
        initial_population=np.tile(start, (5, 1)),
        gene_type=int,
        parent_selection_type=first_best,
        keep_elitism=0,
        keep_parents=-1,
        crossover_type=copied_parent,
        mutation_type=mutation,
        suppress_warnings=True,
    )
    algorithm.run()
    return algorithm.last_generation_parents[0].astype(np.int64)


def first_best(fitness: FloatArray, _: int, ga: pygad.GA) -> tuple[IntArray, IntArray]:
    """Select the fittest of the population, the first of equal ones."""
    best = np.argmax(fitness)
    return ga.population[[best]].copy(), np.array([best])


def copied_parent(parents: IntArray, shape: tuple[int, int], _: pygad.GA) -> IntArray:
    """Return as many copies of the parent as there are offspring."""
    return np.tile(parents[0], (shape[0], 1))
