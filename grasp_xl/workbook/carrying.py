"""A designer's chromosome, carried from an old option space to a new one (section 5.2)."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from grasp_xl.chromosome import BLANK_GENE, UNSET_GENE, Chromosome, index_faults, is_usable
from grasp_xl.errors import Problem
from grasp_xl.space import ElementKind, FloatArray, IntArray, OptionSpace

SAME_PLACE_MM = 1e-6
"""Footprints nearer than this are the same place."""

HINT = "choose others; these are kept in the Run Log"
MOVED_HINT = "look whether it still suits"


@dataclass(frozen=True, slots=True)
class SetAside:
    """Genes of a designer that the option space does not have: kept for a later one, not used."""

    user: Chromosome | None = None
    what_if: Chromosome | None = None


NOTHING_ASIDE = SetAside()


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
        of range and for each active index whose footprint is gone or has moved; one at least where
        the genes are not usable.
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
    fitted = Chromosome(genes)
    if not stale and not is_usable(fitted, new):
        found = index_faults(new, fitted.active)[0][1]
        stale.append(Problem(what, found, "a grasp that may be", HINT))
    return fitted, stale


def _faults(genes: IntArray, old: ElementKind, new: ElementKind, what: str) -> Iterator[Problem]:
    count = int(genes[0])
    if not new.count_min <= count <= new.most:
        expected = f"a whole number from {new.count_min} to {new.most}"
        yield Problem(f"{what}, {new.name} Total #", str(count), expected, HINT)
    for slot, index in enumerate(genes[1 : 1 + max(0, count)].tolist(), 1):
        where = f"{what}, {new.name} Index {slot}"
        if not 1 <= index <= new.total:
            expected = f"a place of 1 to {new.total}"
            yield Problem(where, f"index {index}, which is gone", expected, HINT)
        elif index > old.total:
            found = f"index {index}, which the option space before this one did not have"
            yield Problem(where, found, "a place that is known from before", MOVED_HINT)
        else:
            before, after = old.footprints_mm[index - 1], new.footprints_mm[index - 1]
            if np.abs(before - after).max() > SAME_PLACE_MM:
                found = f"index {index}, which is at ({_told(after)}) now"
                yield Problem(where, found, f"its place of before, ({_told(before)})", MOVED_HINT)


def _told(point_mm: FloatArray) -> str:
    return ", ".join(f"{value:.6g}" for value in point_mm)
