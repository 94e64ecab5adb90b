"""The frameworks' own genetic algorithms, with the operators and numbers of their first examples.

Populations of 100 random grasps with crossover and tournament, where ``deap_ga`` and its like run
the thesis's algorithm.  A grasp that breaks the clearance or FoS gets a large value.
"""

from __future__ import annotations

import random

import numpy as np
import pygad
from deap import algorithms, base, tools
from pymoo.algorithms.soo.nonconvex.ga import GA
from pymoo.operators.crossover.sbx import SBX
from pymoo.operators.mutation.pm import PM
from pymoo.operators.repair.rounding import RoundingRepair
from pymoo.operators.sampling.rnd import IntegerRandomSampling
from pymoo.optimize import minimize

from benchmarks.peers import deap_ga
from benchmarks.peers.numpy_rules import NumpyRules
from benchmarks.peers.pymoo_ga import GraspProblem
from grasp_xl.space import IntArray

POPULATION = 100
WORST = 1e9


class AnyRules(NumpyRules):
    """Rules for grasps that nobody has repaired."""

    def value(self, genes: IntArray) -> float:
        """Return what the search minimises, or a large number."""
        return min(super().value(genes), WORST) if self.is_clear(genes) else WORST


def deap(rules: AnyRules, seed: int, generations: int) -> None:
    """Run ``eaSimple``: two-point crossover, uniform mutation, tournaments of three."""
    random.seed(seed)
    high = rules.low + rules.span.astype(np.int64) - 1
    rng = np.random.default_rng(seed)
    drawn = rng.integers(rules.low, high + 1, (POPULATION, len(high)))
    toolbox = base.Toolbox()
    toolbox.register("evaluate", deap_ga.evaluate, rules)
    toolbox.register("mate", crossed)
    toolbox.register(
        "mutate", tools.mutUniformInt, low=rules.low.tolist(), up=high.tolist(), indpb=0.1
    )
    toolbox.register("select", tools.selTournament, tournsize=3)
    population = [deap_ga.creator.Grasp(genes) for genes in drawn]
    algorithms.eaSimple(population, toolbox, 0.5, 0.2, generations, verbose=False)


def crossed(first: IntArray, second: IntArray) -> tuple[IntArray, IntArray]:
    """Swap the genes between two points, as DEAP's documentation does for arrays."""
    start, end = sorted(random.sample(range(len(first) + 1), 2))
    first[start:end], second[start:end] = second[start:end].copy(), first[start:end].copy()
    return first, second


def pymoo(rules: AnyRules, seed: int, generations: int) -> None:
    """Run ``GA`` for integers: SBX, polynomial mutation, both rounded."""
    algorithm = GA(
        pop_size=POPULATION,
        sampling=IntegerRandomSampling(),
        crossover=SBX(prob=1.0, eta=3.0, vtype=float, repair=RoundingRepair()),
        mutation=PM(prob=1.0, eta=3.0, vtype=float, repair=RoundingRepair()),
        eliminate_duplicates=True,
    )
    minimize(
        GraspProblem(rules), algorithm, ("n_gen", generations), copy_algorithm=False, seed=seed
    )


def pygad_(rules: AnyRules, seed: int, generations: int) -> None:
    """Run ``GA`` with its defaults: steady-state selection, one-point crossover."""
    high = rules.low + rules.span.astype(np.int64)
    pygad.GA(
        num_generations=generations,
        num_parents_mating=POPULATION // 2,
        sol_per_pop=POPULATION,
        num_genes=len(high),
        fitness_func=lambda _, genes, __: -rules.value(genes),
        gene_space=[range(low, end) for low, end in zip(rules.low, high, strict=True)],
        gene_type=int,
        mutation_percent_genes=10,
        random_seed=seed,
        suppress_warnings=True,
    ).run()
