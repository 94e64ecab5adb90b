"""The grasp that a run is measured against where the designer gave none."""

from __future__ import annotations

import numpy as np

from grasp_xl.chromosome import Chromosome
from grasp_xl.kernels import measure_rows, tabulate
from grasp_xl.rules import Goals, Requirements, Rules, Terms
from grasp_xl.search.evolution import draw_feasible
from grasp_xl.search.feasibility import lifting_counts
from grasp_xl.search.obstacles import any_feasible
from grasp_xl.search.stop import Stop, never
from grasp_xl.space import OptionSpace

SAMPLE = 1_000
MAX_DRAWS = 1_000_000
STREAM = 20_210_501
"""Seed of this module's own stream: the same benchmark in every command, for ever."""


def assigned_benchmark(
    space: OptionSpace, requirements: Requirements, stop: Stop = never
) -> Chromosome:
    """Choose a fair random grasp: of 1,000 feasible ones, the one that is good all round.

    That is the one with the least sum of cost, moment, deviation and structure, each divided by
    its median over the sample; a zero median drops out.

    Parameters
    ----------
    space, requirements
    stop : callable
        True ends the search where no random grasp is feasible.

    Raises
    ------
    InfeasibleError
        If no grasp meets FoS and clearance.
    """
    if not lifting_counts(space, requirements):
        return any_feasible(space, requirements, stop=stop)
    tables = tabulate(space, Rules(Goals(Terms(1.0, 1.0, 1.0, 1.0)), requirements))
    rows = np.zeros((SAMPLE, len(space.kinds), 1 + space.gene_slots), dtype=np.int64)
    found = draw_feasible(tables, np.random.default_rng(STREAM), MAX_DRAWS, rows)
    if not found:
        return any_feasible(space, requirements, stop=stop)
    terms = measure_rows(tables, rows[:found])[:, 1:5]
    medians = np.median(terms, axis=0)
    counted = medians > 0
    scores = (terms[:, counted] / medians[counted]).sum(axis=1)
    return Chromosome(rows[int(np.argmin(scores))])
