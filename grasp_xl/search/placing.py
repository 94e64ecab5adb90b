"""Places for so many elements of each kind that keep the clearance: first fit, then exact."""

from __future__ import annotations

import sys
import time
from collections.abc import Sequence
from dataclasses import replace
from itertools import permutations, product
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from grasp_xl.rules import SLACK, Criterion, Goals, Requirements, Rules, Terms
from grasp_xl.search.exact import ExactSettings, solve
from grasp_xl.search.stop import Stop, never
from grasp_xl.search.warm import load_exact_search
from grasp_xl.space import FloatArray, OptionSpace

Active = tuple[tuple[int, ...], ...]
"""Sorted active 1-based indices of each kind."""

SWEEPS = ((1.0, 0.0), (0.0, 1.0), (1.0, 1.0), (1.0, -1.0))
"""Directions in plan view along which first fit goes over the footprints."""

ANY_GAP = sys.float_info.max
"""Relative gap at which the exact search is content with the first grasp it meets."""

KIND_SHARE = 0.2
"""Share of the time for the look whether the elements of one kind alone find no room."""


class Placing(NamedTuple):
    """Places that were found; None with ``proved`` where there are none, else none found yet."""

    active: Active | None
    proved: bool = True


def place(
    space: OptionSpace,
    counts: tuple[int, ...],
    clearance_mm: float,
    seconds: float,
    stop: Stop = never,
) -> Placing:
    """Look for footprints of which no two are closer than the clearance.

    Parameters
    ----------
    space : OptionSpace
        Its Min. and Max. do not matter.
    counts : tuple of int
        Elements of each kind, at most as many as there are footprints; at least one in all.
    clearance_mm : float
    seconds : float
        Longest exact search, where first fit finds nothing.
    stop : callable
        True ends it.
    """
    none: Active = ((),) * len(counts)
    active = _first_fits(space, counts, clearance_mm, none)
    if active:
        return Placing(active)
    load_exact_search()
    deadline = time.perf_counter() + seconds
    for number, count in enumerate(counts):
        alone = tuple(count * (number == other) for other in range(len(counts)))
        if count and alone != counts:
            placing = place(space, alone, clearance_mm, seconds * KIND_SHARE, stop)
            if placing.active:
                active = _first_fits(space, counts, clearance_mm, placing.active)
                if active:
                    return Placing(active)
            elif placing.proved:
                return placing
    return _search(space, counts, clearance_mm, deadline - time.perf_counter(), stop)


def _search(
    space: OptionSpace,
    counts: tuple[int, ...],
    clearance_mm: float,
    seconds: float,
    stop: Stop,
) -> Placing:
    kinds = tuple(
        replace(kind, count_min=count, count_max=count)
        for kind, count in zip(space.kinds, counts, strict=True)
    )
    rules = Rules(
        Goals(Terms(1.0, 1.0, 1.0, 1.0)),
        Requirements(fos=0.0, clearance_mm=clearance_mm),
        Criterion(frozenset({"cost"})),
    )
    settings = ExactSettings(time_limit_s=seconds, gap=ANY_GAP)
    proof = solve(replace(space, kinds=kinds), rules, settings, stop=stop)
    if proof.designs:
        return Placing(proof.designs[0].chromosome.active)
    return Placing(None, proof.status == "infeasible")


def _first_fits(
    space: OptionSpace, counts: tuple[int, ...], clearance_mm: float, placed: Active
) -> Active | None:
    """Try each order of the kinds that are not placed yet, and each sweep."""
    missing = [number for number, count in enumerate(counts) if len(placed[number]) < count]
    for order, sweep in product(permutations(missing), SWEEPS):
        active = _first_fit(space, counts, clearance_mm * (1 - SLACK), placed, order, sweep)
        if active:
            return active
    return None


def _first_fit(
    space: OptionSpace,
    counts: tuple[int, ...],
    clearance_mm: float,
    placed: Active,
    order: Sequence[int],
    sweep: tuple[float, float],
) -> Active | None:
    """Take the first free footprint along the sweep, again and again, kind after kind."""
    active = list(placed)
    taken = [
        kind.footprints_mm[index - 1, :2]
        for kind, indices in zip(space.kinds, placed, strict=True)
        for index in indices
    ]
    for number in order:
        points = space.kinds[number].footprints_mm[:, :2]
        free = np.ones(len(points), dtype=bool)
        for spot in taken:
            free &= _away(points, spot, clearance_mm)
        ranks = np.lexsort([points @ (-sweep[1], sweep[0]), points @ sweep])
        chosen: list[int] = []
        while len(chosen) < counts[number]:
            left = ranks[free[ranks]]
            if not len(left):
                return None
            chosen.append(int(left[0]))
            taken.append(points[left[0]])
            free &= _away(points, points[left[0]], clearance_mm)
        active[number] = tuple(sorted(place + 1 for place in chosen))
    return tuple(active)


def _away(points: FloatArray, spot: FloatArray, clearance_mm: float) -> NDArray[np.bool_]:
    offset = points - spot
    return np.hypot(offset[:, 0], offset[:, 1]) >= clearance_mm
