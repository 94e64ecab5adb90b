"""Is one sample lower than another?  The Mann-Whitney U test with an effect size.

Our own, since SciPy would make every start of the program slower: numba loads it where it is there.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

EXACT_WAYS = 200_000
"""Most ways to part the ranks for which the exact distribution is counted."""

SAME = 1e-9
"""Values that differ by less, relative, are tied."""


class MannWhitney(NamedTuple):
    """Outcome of the two-sided test.

    u : pairs in which the first sample's value is the larger one, ties counted half;
    p : probability of a U as far from the middle, if both samples are of one distribution;
    effect : rank-biserial correlation, -1 where the first sample's values are all lower, 1 where
    they are all higher, 0 where neither is (Kerby 2014); exact : whether p is counted, not
    approximated.
    """

    u: float
    p: float
    effect: float
    exact: bool


def mann_whitney(first: Sequence[float], second: Sequence[float]) -> MannWhitney | None:
    """Test whether values of one sample tend to be lower than those of another.

    The distribution of U given the ties is counted where there are few ways to part the ranks, else
    it is approximated by a normal one, with corrections for ties and continuity (Mann and Whitney
    1947, Lehmann 1975).  None where a sample is empty.

    Parameters
    ----------
    first, second : sequence of float

    Examples
    --------
    >>> mann_whitney([1.0, 2.0, 3.0], [4.0, 5.0, 6.0])
    MannWhitney(u=0.0, p=0.1, effect=-1.0, exact=True)
    """
    m, n = len(first), len(second)
    if not m or not n:
        return None
    ranks, ties = midranks([*first, *second])
    u = float(sum(ranks[:m])) - m * (m + 1) / 2
    exact = math.comb(m + n, m) <= EXACT_WAYS
    p = _counted(ranks, m, u) if exact else _approximated(m, n, u, ties)
    return MannWhitney(u, p, 2 * u / (m * n) - 1, exact)


def midranks(values: Sequence[float]) -> tuple[list[float], list[int]]:
    """Return the ranks of values from 1, ties sharing their mean, and how many are tied each time.

    Examples
    --------
    >>> midranks([3.0, 1.0, 3.0])
    ([2.5, 1.0, 2.5], [1, 2])
    """
    order = sorted(range(len(values)), key=values.__getitem__)
    ranks, ties = [0.0] * len(values), []
    start = 0
    while start < len(order):
        end = start + 1
        least = values[order[start]]
        while end < len(order) and values[order[end]] - least <= SAME * max(1.0, abs(least)):
            end += 1
        for row in order[start:end]:
            ranks[row] = (start + end + 1) / 2
        ties.append(end - start)
        start = end
    return ranks, ties


def _counted(ranks: Sequence[float], m: int, u: float) -> float:
    """Count the ways to choose m ranks whose sum is as far from the middle."""
    twice = [round(2 * rank) for rank in ranks]  # whole numbers also where ranks are tied
    total = sum(twice)
    ways = np.zeros((m + 1, total + 1))  # whole numbers, exact below 2^53
    ways[0, 0] = 1.0
    for rank in twice:
        for chosen in range(m, 0, -1):
            ways[chosen, rank:] += ways[chosen - 1, : total + 1 - rank]
    sums = np.arange(total + 1)
    middle = m * total / len(ranks)
    away = abs(2 * u + m * (m + 1) - middle)
    far = ways[m, np.abs(sums - middle) >= away - 0.25].sum()
    return float(far / math.comb(len(ranks), m))


def _approximated(m: int, n: int, u: float, ties: Sequence[int]) -> float:
    total = m + n
    tied = sum(each**3 - each for each in ties) / (total * (total - 1))
    variance = m * n / 12 * (total + 1 - tied)
    if variance <= 0:
        return 1.0
    z = max(0.0, abs(u - m * n / 2) - 0.5) / math.sqrt(variance)
    return min(1.0, math.erfc(z / math.sqrt(2)))


def holm(p_values: Sequence[float]) -> list[float]:
    """Return p-values corrected for that there are several tests (Holm 1979).

    Examples
    --------
    >>> holm([0.01, 0.04, 0.03])
    [0.03, 0.06, 0.06]
    """
    order = sorted(range(len(p_values)), key=p_values.__getitem__)
    corrected, largest = [0.0] * len(p_values), 0.0
    for place, row in enumerate(order):
        largest = max(largest, min(1.0, p_values[row] * (len(p_values) - place)))
        corrected[row] = largest
    return corrected
