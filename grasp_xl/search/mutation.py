"""The thesis's genetic operators, readable: random chromosome, mutation matrix, one generation.

This is the plain twin of the compiled ``evolution.py``: it draws the same numbers from the same
stream in the same order, and a test holds the two equal gene for gene.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from grasp_xl.chromosome import UNSET_GENE, Chromosome
from grasp_xl.grasp import Grasp, evaluate
from grasp_xl.rules import Rules
from grasp_xl.space import IntArray, OptionSpace

TRIES_PER_MATRIX = 1000
"""Mutations of one child under one matrix before the matrix is overridden (section 5.2.3)."""


@dataclass(frozen=True, slots=True)
class Generation:
    """What one generation produced: the shared matrix, the children, and the fittest of them.

    ``fittest`` is None where no child meets FoS and clearance.
    """

    matrix: IntArray
    children: tuple[Chromosome, ...]
    fittest: Chromosome | None


def draw(rng: np.random.Generator, low: int, high: int) -> int:
    """Draw a whole number, low to high inclusive, from one double of the stream."""
    return low + int(rng.random() * (high - low + 1))


def random_chromosome(space: OptionSpace, rng: np.random.Generator) -> Chromosome:
    """Draw a random chromosome (section 5.2.1): counts, then indices, kind after kind.

    Active genes of a kind are distinct, and there is at least one element.
    """
    genes = np.zeros((len(space.kinds), 1 + space.gene_slots), dtype=np.int64)
    while not genes[:, 0].any():
        for row, kind in zip(genes, space.kinds, strict=True):
            row[0] = draw(rng, kind.count_min, kind.most) if kind.total else 0
    for row, kind in zip(genes, space.kinds, strict=True):
        if not kind.total:
            continue
        for slot in range(1, len(row)):
            row[slot] = draw(rng, UNSET_GENE, kind.total)
            while slot <= row[0] and row[slot] in row[1:slot]:
                row[slot] = draw(rng, UNSET_GENE, kind.total)
    return Chromosome(genes)


def mutation_matrix(rng: np.random.Generator, shape: tuple[int, int], one_in: float) -> IntArray:
    """Draw the mutation matrix (figure 30): each cell is 1 with probability 1-in-n."""
    return (rng.random(shape) < 1.0 / one_in).astype(np.int64)


def mutated(
    space: OptionSpace, rng: np.random.Generator, parent: Chromosome, matrix: IntArray
) -> Chromosome:
    """Return a copy of the parent with new values for the genes that the matrix marks."""
    genes = np.array(parent.genes)
    for row, marks, kind in zip(genes, matrix, space.kinds, strict=True):
        for slot in np.flatnonzero(marks) if kind.total else ():
            low, high = (kind.count_min, kind.most) if slot == 0 else (UNSET_GENE, kind.total)
            row[slot] = draw(rng, low, high)
    return Chromosome(genes)


def clear_child(
    space: OptionSpace,
    rules: Rules,
    rng: np.random.Generator,
    parent: Chromosome,
    matrix: IntArray,
) -> Chromosome:
    """Mutate the parent until the child has an element and keeps the clearance (section 5.2.3).

    After 1000 tries the counts mutate too (figure 32); after 1000 more it stays a copy.
    """
    widened = matrix.copy()
    widened[:, 0] = 1
    for marks in (matrix, widened):
        for _ in range(TRIES_PER_MATRIX):
            child = mutated(space, rng, parent, marks)
            if keeps_clearance(space, rules, child):
                return child
    return parent


def keeps_clearance(space: OptionSpace, rules: Rules, child: Chromosome) -> bool:
    """Tell whether there is an element at all, and all active ones are far enough apart."""
    return bool(child.counts.any()) and evaluate(space, rules, child).is_clear


def next_generation(
    space: OptionSpace,
    rules: Rules,
    rng: np.random.Generator,
    parent: Chromosome,
    *,
    children: int,
    one_in: float,
    elitism: bool,
) -> Generation:
    """Breed and judge one generation (section 5.2, steps 2 to 5)."""
    matrix = mutation_matrix(rng, (len(space.kinds), 1 + space.gene_slots), one_in)
    brood = tuple(
        parent if elitism and number == 0 else clear_child(space, rules, rng, parent, matrix)
        for number in range(children)
    )
    judged = [evaluate(space, rules, child) for child in brood]
    fit: list[Grasp] = [grasp for grasp in judged if grasp.feasible]
    fittest = min(fit, key=lambda grasp: grasp.value).chromosome if fit else None
    return Generation(matrix, brood, fittest)
