"""Two rows of genes as a person copies them from a workbook (section 5.3, figure 34)."""

from __future__ import annotations

import re

from grasp_xl.chromosome import Chromosome, from_active, index_faults
from grasp_xl.errors import UsageError
from grasp_xl.printable import quoted
from grasp_xl.space import OptionSpace

_ROWS = re.compile(r"[\n/]|\\n")
_GENES = re.compile(r"[\s,;]+")


def pasted_grasp(text: str, space: OptionSpace, option: str) -> Chromosome:
    r"""Read rows of a count and indices: one a kind, or all in one line.

    Parameters
    ----------
    text : str
        Genes parted by tabs, spaces, commas or semicolons, rows by line ends or ``/``.
    space : OptionSpace
    option : str
        That they were given to.

    Raises
    ------
    UsageError
        If they are no grasp of this option space.
    """
    rows = [_GENES.split(row.strip()) for row in _ROWS.split(text) if row.strip()]
    kinds = len(space.kinds)
    if len(rows) == 1 and len(rows[0]) % kinds == 0:
        size = len(rows[0]) // kinds
        rows = [rows[0][start : start + size] for start in range(0, kinds * size, size)]
    if len(rows) != kinds:
        told = f"{len(rows)} row{'s' if len(rows) != 1 else ''} of genes"
        raise _refused(option, told, f"{kinds}, one a kind")
    active = []
    for kind, row in zip(space.kinds, rows, strict=True):
        strange = [gene for gene in row if not gene.isascii() or not gene.isdigit()]
        if strange:
            raise _refused(option, f"{quoted(strange[0])} as a gene", "whole numbers")
        count, *indices = map(int, row)
        if len(indices) < count:
            found = f"{count} {kind.name} and {len(indices)} indices"
            raise _refused(option, found, "as many indices as the count says, or more")
        active.append(indices[:count])
    faults = index_faults(space, active)
    if faults:
        raise _refused(option, faults[0][1], "a grasp of this option space")
    return from_active(space, active)


def _refused(option: str, found: str, expected: str) -> UsageError:
    return UsageError(
        f"{option}: found {found}, expected {expected}.",
        where=option,
        hint=f'For example {option} "1 67 / 3 195 257 216": a row of cups, a row of magnets',
    )
