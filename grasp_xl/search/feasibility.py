"""Is there any grasp at all?  Lifting force from counts alone, clearance by a short search."""

from __future__ import annotations

import itertools
import time

import numpy as np

from grasp_xl.chromosome import Chromosome, from_active
from grasp_xl.errors import InfeasibleError
from grasp_xl.rules import SLACK, Requirements
from grasp_xl.space import FloatArray, OptionSpace

SEARCH_SECONDS = 5.0
"""Longest search for footprints that are far enough apart, before the answer is left open."""


def max_fos(space: OptionSpace) -> float:
    """Return the factor of safety of the most elements that a grasp can have."""
    force = sum(kind.most * kind.force_n for kind in space.kinds)
    return force / space.part.weight_n


def lifting_counts(space: OptionSpace, requirements: Requirements) -> list[tuple[int, ...]]:
    """List the counts of each kind that meet FoS, fewest elements first."""
    ranges = (range(kind.count_min, kind.most + 1) for kind in space.kinds)
    force_min = requirements.fos * (1 - SLACK) * space.part.weight_n
    strong = [
        counts
        for counts in itertools.product(*ranges)
        if sum(counts)
        and sum(n * kind.force_n for n, kind in zip(counts, space.kinds, strict=True)) >= force_min
    ]
    return sorted(strong, key=lambda counts: (sum(counts), counts))


def any_feasible(space: OptionSpace, requirements: Requirements) -> Chromosome:
    """Return some grasp that meets FoS and clearance.

    Raises
    ------
    InfeasibleError
        If none exists, or none was found in ``SEARCH_SECONDS``; the message says which, and what
        would help.
    """
    choices = lifting_counts(space, requirements)
    if not choices:
        raise _too_weak(space, requirements)
    deadline = time.perf_counter() + SEARCH_SECONDS
    clearance = requirements.clearance_mm * (1 - SLACK)
    kinds = [kind.footprints_mm[:, :2] for kind in space.kinds]
    for counts in choices:
        found = _far_apart(kinds, counts, clearance, deadline)
        if found is not None:
            return from_active(space, found)
    raise _too_close(space, requirements, choices[0], proved=time.perf_counter() < deadline)


def _far_apart(
    kinds: list[FloatArray], counts: tuple[int, ...], clearance: float, deadline: float
) -> list[list[int]] | None:
    """Find footprints of each kind with all distances >= clearance: depth first, exhaustive."""
    wanted = [number for number, count in enumerate(counts) for _ in range(count)]
    chosen: list[int] = []

    def extend(free: list[np.ndarray[tuple[int], np.dtype[np.bool_]]]) -> bool:
        if len(chosen) == len(wanted):
            return True
        number = wanted[len(chosen)]
        repeats = chosen and wanted[len(chosen) - 1] == number
        for place in np.flatnonzero(free[number]):
            if repeats and place < chosen[-1]:
                continue
            if time.perf_counter() > deadline:
                return False
            spot = kinds[number][place]
            chosen.append(int(place))
            still_free = [
                kept & (np.hypot(*(points - spot).T) >= clearance)
                for kept, points in zip(free, kinds, strict=True)
            ]
            if extend(still_free):
                return True
            chosen.pop()
        return False

    if not extend([np.ones(len(points), dtype=bool) for points in kinds]):
        return None
    indices: list[list[int]] = [[] for _ in kinds]
    for number, place in zip(wanted, chosen, strict=True):
        indices[number].append(place + 1)
    return indices


def _too_weak(space: OptionSpace, requirements: Requirements) -> InfeasibleError:
    reach = max_fos(space)
    most = " and ".join(f"{kind.most} {kind.name}" for kind in space.kinds)
    factor = requirements.fos / reach if reach else float("inf")
    return InfeasibleError(
        f"No grasp can meet FoS {requirements.fos:g}: {most} together reach "
        f"FoS {reach:.4g} against {space.part.weight_n:.5g} N.",
        where="FoS",
        hint=f"Lower the FoS goal to {reach:.4g}, use elements {factor:.3g} times as strong, "
        "or raise # Max. of a kind",
    )


def _too_close(
    space: OptionSpace, requirements: Requirements, fewest: tuple[int, ...], *, proved: bool
) -> InfeasibleError:
    elements = " and ".join(
        f"{n} {kind.name}" for n, kind in zip(fewest, space.kinds, strict=True) if n
    )
    distance = f"{requirements.clearance_mm:g} mm"
    told = (
        f"No grasp can keep {distance} between its elements"
        if proved
        else f"No grasp that keeps {distance} between its elements was found "
        f"in {SEARCH_SECONDS:g} s"
    )
    return InfeasibleError(
        f"{told}; meeting FoS {requirements.fos:g} takes at least {elements}.",
        where="Minimum Gripper Element Distance",
        hint="Lower the distance, or add footprints that are farther apart",
    )
