"""The thesis's genetic algorithm with DEAP: a toolbox, and the loop of ``eaMuPlusLambda``.

DEAP's ``varOr`` mutates each child on its own; one matrix shared by a generation asks for our own
line there.  The rest is DEAP's (1 + 4) loop: clone, mutate, evaluate, ``selBest``.
"""

from __future__ import annotations

import numpy as np
from deap import base, creator, tools

from benchmarks.peers.numpy_rules import NumpyRules
from grasp_xl.space import IntArray

creator.create("Value", base.Fitness, weights=(-1.0,))
creator.create("Grasp", np.ndarray, fitness=creator.Value)


def run(
    rules: NumpyRules, rng: np.random.Generator, start: IntArray, one_in: float, generations: int
) -> IntArray:
    """Evolve the start for some generations of five children; return the parent of the next."""
    toolbox = base.Toolbox()
    toolbox.register("matrix", rules.mutation_matrix, rng, one_in)
    toolbox.register("mutate", mutate, rules, rng)
    toolbox.register("evaluate", evaluate, rules)
    toolbox.register("select", tools.selBest, k=1)

    population = [creator.Grasp(start)]
    population[0].fitness.values = toolbox.evaluate(population[0])
    for _ in range(generations):
        marks = toolbox.matrix()
        offspring = [toolbox.clone(population[0]) for _ in range(4)]
        for child in offspring:
            toolbox.mutate(child, marks)
            del child.fitness.values
        fitnesses = toolbox.map(toolbox.evaluate, offspring)
        for child, fitness in zip(offspring, fitnesses, strict=True):
            child.fitness.values = fitness
        population = toolbox.select(population + offspring)
    return np.array(population[0])


def mutate(
    rules: NumpyRules, rng: np.random.Generator, child: IntArray, marks: IntArray
) -> tuple[IntArray]:
    """Mutate in place, as DEAP's operators do."""
    child[:] = rules.clear_child(rng, child.view(np.ndarray), marks)
    return (child,)


def evaluate(rules: NumpyRules, child: IntArray) -> tuple[float]:
    """Return the one-valued tuple that DEAP asks for."""
    return (rules.value(child.view(np.ndarray)),)
