"""A designer's chromosome, carried from an old option space to a new one (section 5.2)."""

from __future__ import annotations

import numpy as np

from grasp_xl.chromosome import BLANK_GENE, UNSET_GENE, Chromosome
from grasp_xl.errors import Problem
from grasp_xl.space import ElementKind, OptionSpace

SAME_PLACE_MM = 1e-6
"""Footprints nearer than this are the same place."""


def carried(
    chromosome: Chromosome, old: OptionSpace, new: OptionSpace, what: str
) -> tuple[Chromosome, list[Problem]]:
    """Fit a chromosome to a new option space, and name every index that is now stale.

    Parameters
    ----------
    chromosome : Chromosome
        Of the old option space.
    old, new : OptionSpace
    what : str
        Name of its block, for messages.

    Returns
    -------
    Chromosome, list of Problem
        The same genes, as far as there is room for them, and a problem for each active index
        whose footprint is gone or has moved.
    """
    genes = np.zeros((len(new.kinds), 1 + new.gene_slots), dtype=np.int64)
    stale: list[Problem] = []
    for row, before, kind, old_kind in zip(
        genes, chromosome.genes, new.kinds, old.kinds, strict=True
    ):
        row[1:] = UNSET_GENE if kind.total else BLANK_GENE
        room = min(len(row), len(before))
        row[:room] = before[:room]
        for slot in range(1, 1 + int(before[0])):
            fault = _fault(int(before[slot]), old_kind, kind)
            if fault:
                where = f"{what}, {kind.name} Index {slot}"
                hint = "choose another index before the next run"
                stale.append(Problem(where, fault, f"a place of 1 to {kind.total}", hint))
        inactive = row[1 + int(row[0]) :]
        inactive[inactive > kind.total] = UNSET_GENE if kind.total else BLANK_GENE
    return Chromosome(genes), stale


def is_usable(chromosome: Chromosome, space: OptionSpace) -> bool:
    """Tell whether every count and index is one that the option space has."""
    return all(
        kind.count_min <= row[0] <= kind.most
        and all(min(1, kind.total) <= gene <= kind.total for gene in row[1:])
        for row, kind in zip(chromosome.genes, space.kinds, strict=True)
    )


def _fault(index: int, old: ElementKind, new: ElementKind) -> str:
    if index > new.total:
        return f"index {index}, which is gone"
    before, after = old.footprints_mm[index - 1], new.footprints_mm[index - 1]
    if np.abs(before - after).max() <= SAME_PLACE_MM:
        return ""
    moved = [", ".join(f"{value:.6g}" for value in point) for point in (before, after)]
    return f"index {index}, which was at ({moved[0]}) and is at ({moved[1]}) now"
