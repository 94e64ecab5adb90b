"""The chromosome of a grasp (thesis eq. 1): a row of genes a kind, its count and its indices.

A person sees the same two rows of six that the code works on (eq. 13, figure 34).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from grasp_xl.space import IntArray, OptionSpace

UNSET_GENE = 1
"""Value of an inactive index gene that nobody set (figure 28)."""

BLANK_GENE = 0
"""Value of every index gene of a kind that has no footprints; shown as an empty cell."""


@dataclass(frozen=True, eq=False, slots=True)
class Chromosome:
    """Genes of one grasp.

    Parameters
    ----------
    genes : IntArray
        ``(kinds, 1 + slots)`` array; column 0 the count, then 1-based footprint indices.  Only the
        first ``count`` indices of a row are active.
    """

    genes: IntArray

    def __post_init__(self) -> None:
        genes = np.array(self.genes, dtype=np.int64)
        genes.setflags(write=False)
        object.__setattr__(self, "genes", genes)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Chromosome) and np.array_equal(self.genes, other.genes)

    def __hash__(self) -> int:
        return hash(self.genes.tobytes())

    @property
    def counts(self) -> IntArray:
        """``(kinds,)`` array of how many elements of each kind are active."""
        return self.genes[:, 0]

    @property
    def active(self) -> tuple[tuple[int, ...], ...]:
        """Active 1-based indices of each kind."""
        return tuple(tuple(row[1 : 1 + row[0]].tolist()) for row in self.genes)

    def rows(self) -> list[list[int | None]]:
        """Both gene rows as a person sees them, blank genes as None."""
        return [
            [int(row[0]), *(None if gene == BLANK_GENE else int(gene) for gene in row[1:])]
            for row in self.genes
        ]


def from_active(space: OptionSpace, active: Sequence[Sequence[int]]) -> Chromosome:
    """Make a chromosome from the active 1-based indices of each kind.

    Raises
    ------
    ValueError
        If an index has no footprint, one stands twice, or there are more than the gene slots.
        Callers that take a person's indices check them first with :func:`index_faults`.
    """
    faults = index_faults(space, active)
    if faults:
        raise ValueError(faults[0][1])
    genes = np.zeros((len(space.kinds), 1 + space.gene_slots), dtype=np.int64)
    for row, kind, indices in zip(genes, space.kinds, active, strict=True):
        row[0] = len(indices)
        row[1:] = UNSET_GENE if kind.total else BLANK_GENE
        row[1 : 1 + len(indices)] = indices
    return Chromosome(genes)


def index_faults(space: OptionSpace, active: Sequence[Sequence[int]]) -> list[tuple[int, str]]:
    """List what is wrong with active indices, as (number of the kind, sentence) pairs."""
    faults: list[tuple[int, str]] = []
    for number, (kind, indices) in enumerate(zip(space.kinds, active, strict=True)):
        if len(indices) > kind.most or len(indices) < kind.count_min:
            faults.append(
                (number, f"{len(indices)} {kind.name} where {kind.count_min} to {kind.most} may be")
            )
        stray = [index for index in indices if not 1 <= index <= kind.total]
        if stray:
            faults.append(
                (number, f"{kind.name} index {stray[0]} where 1 to {kind.total} are known")
            )
        if len(set(indices)) < len(indices):
            faults.append((number, f"one {kind.name} index more than once"))
    if not any(active):
        faults.append((0, "no element at all"))
    return faults


def is_usable(chromosome: Chromosome, space: OptionSpace) -> bool:
    """Tell whether every count and index is one that the option space has."""
    return not index_faults(space, chromosome.active) and all(
        row[0] == len(active) and all(min(1, kind.total) <= gene <= kind.total for gene in row[1:])
        for row, active, kind in zip(chromosome.genes, chromosome.active, space.kinds, strict=True)
    )
