"""The thesis's genetic algorithm with pymoo: its ``GA`` with one parent and four offspring.

A generation is one call of the mutation operator with all four offspring, so the shared matrix fits
pymoo as it is.  ``FitnessSurvival`` keeps the best of parent and offspring; duplicates are kept.
pymoo's ``NoCrossover`` does not copy: it hands on the parent itself, four times the same object, to
be mutated in place.  The base crossover with probability 0 copies.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from pymoo.algorithms.soo.nonconvex.ga import GA
from pymoo.core.crossover import Crossover
from pymoo.core.mutation import Mutation
from pymoo.core.problem import ElementwiseProblem
from pymoo.core.sampling import Sampling
from pymoo.operators.selection.rnd import RandomSelection
from pymoo.optimize import minimize

from benchmarks.peers.numpy_rules import NumpyRules
from grasp_xl.space import IntArray


class GraspProblem(ElementwiseProblem):
    """Our criteria as a pymoo problem of one objective, one grasp a call."""

    def __init__(self, rules: NumpyRules) -> None:
        upper = rules.low + rules.span.astype(np.int64) - 1
        super().__init__(n_var=len(rules.low), n_obj=1, xl=rules.low, xu=upper, vtype=int)
        self.rules = rules

    def _evaluate(self, x: IntArray, out: dict[str, Any], *_: object, **__: object) -> None:
        out["F"] = self.rules.value(x)


class Start(Sampling):
    """The one parent of generation 1."""

    def __init__(self, start: IntArray) -> None:
        super().__init__()
        self.start = start

    def _do(self, *_: object, **__: object) -> IntArray:
        return self.start[None, :].copy()


class SharedMatrixMutation(Mutation):
    """One matrix for all offspring of a generation."""

    def __init__(self, rules: NumpyRules, rng: np.random.Generator, one_in: float) -> None:
        super().__init__()
        self.rules, self.rng, self.one_in = rules, rng, one_in

    def _do(self, _: object, parents: IntArray, **__: object) -> IntArray:
        marks = self.rules.mutation_matrix(self.rng, self.one_in)
        return np.array([self.rules.clear_child(self.rng, row, marks) for row in parents])


def run(
    rules: NumpyRules, rng: np.random.Generator, start: IntArray, one_in: float, generations: int
) -> IntArray:
    """Evolve the start for some generations of five children; return the parent of the next."""
    algorithm = GA(
        pop_size=1,
        n_offsprings=4,
        sampling=Start(start),
        selection=RandomSelection(),
        crossover=Crossover(n_parents=1, n_offsprings=1, prob=0.0),
        mutation=SharedMatrixMutation(rules, rng, one_in),
        eliminate_duplicates=False,
        output=None,
    )
    # pymoo counts the evaluation of the start as its first generation
    result = minimize(
        GraspProblem(rules), algorithm, ("n_gen", generations + 1), copy_algorithm=False, seed=1
    )
    return np.array(result.X)
