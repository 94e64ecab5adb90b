"""A designer's chromosome, carried from an old option space to a new one (section 5.2)."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from grasp_xl.chromosome import BLANK_GENE, UNSET_GENE, Chromosome
from grasp_xl.errors import Problem
from grasp_xl.space import ElementKind, IntArray, OptionSpace

SAME_PLACE_MM = 1e-6
"""Footprints nearer than this are the same place."""

HINT = "choose another before the next run"


def carried(
    chromosome: Chromosome, old: OptionSpace, new: OptionSpace, what: str
) -> tuple[Chromosome, list[Problem]]:
    """Fit a chromosome to a new option space, and name all that is now stale in it.

    Parameters
    ----------
    chromosome : Chromosome
        As the designer typed it for the old option space, or for one before it.
    old, new : OptionSpace
    what : str
        Name of its block, for messages.

    Returns
    -------
    Chromosome, list of Problem
        The same genes, as far as there is room for them, and a problem for each count that is out
        of range and for each active index whose footprint is gone or has moved.
    """
    genes = np.zeros((len(new.kinds), 1 + new.gene_slots), dtype=np.int64)
    stale: list[Problem] = []
    for row, before, kind, old_kind in zip(
        genes, chromosome.genes, new.kinds, old.kinds, strict=True
    ):
        unset = UNSET_GENE if kind.total else BLANK_GENE
        row[1:] = unset
        room = min(len(row), len(before))
        row[:room] = before[:room]
        inactive = row[1 + max(0, int(row[0])) :]
        inactive[(inactive < unset) | (inactive > kind.total)] = unset
        stale += _faults(before, old_kind, kind, what)
    return Chromosome(genes), stale


def is_usable(chromosome: Chromosome, space: OptionSpace) -> bool:
    """Tell whether every count and index is one that the option space has."""
    return any(chromosome.counts) and all(
        kind.count_min <= row[0] <= kind.most
        and all(min(1, kind.total) <= gene <= kind.total for gene in row[1:])
        and len(set(active)) == len(active)
        for row, active, kind in zip(chromosome.genes, chromosome.active, space.kinds, strict=True)
    )


def _faults(genes: IntArray, old: ElementKind, new: ElementKind, what: str) -> Iterator[Problem]:
    count = int(genes[0])
    if not new.count_min <= count <= new.most:
        expected = f"a whole number from {new.count_min} to {new.most}"
        yield Problem(f"{what}, {new.name} Total #", str(count), expected, HINT)
    for slot, index in enumerate(genes[1 : 1 + max(0, count)].tolist(), 1):
        fault = _fault(index, old, new)
        if fault:
            expected = f"a place of 1 to {new.total}"
            yield Problem(f"{what}, {new.name} Index {slot}", fault, expected, HINT)


def _fault(index: int, old: ElementKind, new: ElementKind) -> str:
    if not 1 <= index <= new.total:
        return f"index {index}, which is gone"
    if index > old.total:
        return f"index {index}, which was stale already"
    before, after = old.footprints_mm[index - 1], new.footprints_mm[index - 1]
    if np.abs(before - after).max() <= SAME_PLACE_MM:
        return ""
    moved = [", ".join(f"{value:.6g}" for value in point) for point in (before, after)]
    return f"index {index}, which was at ({moved[0]}) and is at ({moved[1]}) now"
