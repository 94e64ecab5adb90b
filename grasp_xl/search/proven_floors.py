"""The least value of each criterion alone, proved by the exact search."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

from grasp_xl.chromosome import Chromosome
from grasp_xl.rules import TERMS, Criterion, Rules, Terms
from grasp_xl.search.exact import ExactSettings, solve
from grasp_xl.search.floors import floors
from grasp_xl.search.stop import Stop, never
from grasp_xl.space import OptionSpace

ATTAINED = 1e-6
"""A grasp is at a floor if the six digits that are shown agree."""


class ProvenFloors(NamedTuple):
    """What no grasp goes below, criterion by criterion.

    Parameters
    ----------
    least : Terms
    attained : frozenset of str
        Criteria of which a grasp is known that is at the floor; the floor of another may be too
        low.
    """

    least: Terms
    attained: frozenset[str]


def proven_floors(
    space: OptionSpace,
    rules: Rules,
    *,
    seconds: float,
    known: Sequence[Chromosome] = (),
    stop: Stop = never,
) -> ProvenFloors:
    """Return the least value of each criterion alone that a grasp under the constraints has.

    Where the proof does not end in time, it is the greatest number that none was proved below.

    Parameters
    ----------
    space, rules
        Of which a grasp meets FoS and clearance; the goals and the criterion do not matter.
    seconds : float
        Longest search, of all four together.
    known : sequence of Chromosome
        Grasps that are known already.
    stop : callable
        True ends the search.
    """
    least = floors(space, rules.requirements)
    deadline = time.perf_counter() + seconds
    found, attained = [], set()
    for searches, term in zip(range(len(TERMS), 0, -1), TERMS, strict=True):
        left = deadline - time.perf_counter()
        if left <= 0 or stop():
            found.append(getattr(least, term))
            continue
        alone = replace(rules, criterion=Criterion(frozenset({term})))
        settings = ExactSettings(time_limit_s=left / searches)
        proof = solve(space, alone, settings, known=known, stop=stop)
        found.append(proof.bound)
        if proof.gap is not None and proof.gap <= ATTAINED:
            attained.add(term)
    return ProvenFloors(Terms(*found), frozenset(attained))
