"""The step of a level method: the nearest point where no cut is below a level (compiled).

A concave function that is the least of many linear ones is at most each of those that were met: the
*cuts*.  Where one of them is below a level, the function is, too.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from grasp_xl.compiled import inner
from grasp_xl.space import FloatArray, IntArray

MULTIPLIERS = 4
"""u (3), the direction along which the moment is bounded, and the price of a magnet."""

CUTS = 17
"""Cuts that are kept; of more, the newest.  The first is not met: it limits the length of u."""

RAISES = 32
"""How often a cut is raised for one step, at most."""

NEARLY = 1e-6
"""A step may miss a level by this share of the way to it."""

DEPENDENT = 1e-8
"""A slope of which this share (squared) is left, is a sum of others."""


class Cuts(NamedTuple):
    """Cuts as seen from the best point so far.

    met ``(1,)`` how many were met; value ``(c,)`` there, and slope ``(c, 4)``; step, scale, trial
    ``(4,)`` in units of scale, the units, and the point that is tried.  Of a step: active ``(4,)``
    the cuts that hold it where it is, and force ``(4,)`` of each; the others are for
    :func:`split_off`.
    """

    met: IntArray
    value: FloatArray
    slope: FloatArray
    step: FloatArray
    scale: FloatArray
    trial: FloatArray
    active: IntArray
    force: FloatArray
    base: FloatArray
    along: FloatArray
    share: FloatArray


def make_cuts() -> Cuts:
    """Make room for the cuts."""
    return Cuts(
        np.zeros(1, dtype=np.int64),
        np.empty(CUTS),
        np.empty((CUTS, MULTIPLIERS)),
        np.empty(MULTIPLIERS),
        np.empty(MULTIPLIERS),
        np.empty(MULTIPLIERS),
        np.empty(MULTIPLIERS + 1, dtype=np.int64),
        np.empty(MULTIPLIERS + 1),
        np.empty((MULTIPLIERS + 1, MULTIPLIERS)),
        np.empty((MULTIPLIERS + 1, MULTIPLIERS + 1)),
        np.empty(MULTIPLIERS + 1),
    )


@inner
def add_cut(
    cuts: Cuts, value: float, slope: tuple[float, float, float, float], best: FloatArray
) -> None:
    """Add the cut that was met at the point tried."""
    row = 1 + cuts.met[0] % (CUTS - 1)
    cuts.met[0] += 1
    cuts.value[row] = value
    for axis in range(MULTIPLIERS):
        cuts.slope[row, axis] = slope[axis]
        cuts.value[row] += slope[axis] * (best[axis] - cuts.trial[axis])


@inner
def move_best(cuts: Cuts, best: FloatArray) -> None:
    """Make the point tried the best one, and see all cuts from there."""
    for row in range(1, 1 + min(cuts.met[0], CUTS - 1)):
        for axis in range(MULTIPLIERS):
            cuts.value[row] += cuts.slope[row, axis] * (cuts.trial[axis] - best[axis])
    for axis in range(MULTIPLIERS):
        best[axis] = cuts.trial[axis]


@inner
def limit_length(level: float, best: FloatArray, cuts: Cuts) -> None:
    """Make the first cut be below a level where a direction is longer than 1.

    That is, beyond the plane that touches the unit ball in the best point's direction.
    """
    unit = 1.0 / cuts.scale[0]
    length = np.sqrt(best[0] * best[0] + best[1] * best[1] + best[2] * best[2])
    cuts.value[0] = level + unit * (1.0 - length)
    for axis in range(MULTIPLIERS):
        cuts.slope[0, axis] = -unit * best[axis] / length if length > 0.0 and axis < 3 else 0.0


@inner
def reached(cuts: Cuts, row: int) -> float:
    """Return a cut's value behind the step."""
    value: float = cuts.value[row]
    for axis in range(MULTIPLIERS):
        value += cuts.slope[row, axis] * cuts.scale[axis] * cuts.step[axis]
    return value


@inner
def lowest_behind(cuts: Cuts) -> tuple[int, float]:
    """Return the cut that is lowest behind the step, and its value there."""
    lowest, least = 0, np.inf
    for row in range(1 + min(cuts.met[0], CUTS - 1)):
        value = reached(cuts, row)
        if value < least:
            lowest, least = row, value
    return lowest, least


@inner
def lay_base(cuts: Cuts, row: int, k: int) -> float:
    """Write into ``base[k]`` what a cut's slope has beside ``base[:k]``; return its square."""
    squared = 0.0
    for axis in range(MULTIPLIERS):
        cuts.base[k, axis] = cuts.slope[row, axis] * cuts.scale[axis]
    for j in range(k):
        cuts.along[j, k] = 0.0
        for axis in range(MULTIPLIERS):
            cuts.along[j, k] += cuts.base[j, axis] * cuts.base[k, axis]
        for axis in range(MULTIPLIERS):
            cuts.base[k, axis] -= cuts.along[j, k] * cuts.base[j, axis]
    for axis in range(MULTIPLIERS):
        squared += cuts.base[k, axis] ** 2
    return squared


@inner
def split_off(cuts: Cuts, row: int, size: int) -> float:
    """Split a cut's slope into ``share`` of each active one, and the rest, ``base[size]``.

    Returns the square of the rest (Gram and Schmidt's way).
    """
    for k in range(size):
        cuts.along[k, k] = np.sqrt(lay_base(cuts, cuts.active[k], k))
        for axis in range(MULTIPLIERS):
            cuts.base[k, axis] /= cuts.along[k, k]
    squared: float = lay_base(cuts, row, size)
    for j in range(size - 1, -1, -1):
        share = cuts.along[j, size]
        for k in range(j + 1, size):
            share -= cuts.along[j, k] * cuts.share[k]
        cuts.share[j] = share / cuts.along[j, j]
    return squared


@inner
def raise_cut(cuts: Cuts, row: int, level: float, size: int) -> int:
    """Move the step until a cut is at a level, too; return how many are active, -1 if impossible.

    Active cuts stay at the level, or are let go where they would hold the step back.
    """
    force = 0.0
    while True:
        missing = level - reached(cuts, row)
        squared = split_off(cuts, row, size)
        whole = 0.0
        for axis in range(MULTIPLIERS):
            whole += (cuts.slope[row, axis] * cuts.scale[axis]) ** 2
        independent = size < MULTIPLIERS and squared > DEPENDENT * whole
        stride = missing / squared if independent else np.inf
        leaving = -1
        for j in range(size):
            if cuts.share[j] > 0.0 and cuts.force[j] < stride * cuts.share[j]:
                stride, leaving = cuts.force[j] / cuts.share[j], j
        if stride == np.inf:
            return -1
        force += stride
        for j in range(size):
            cuts.force[j] -= stride * cuts.share[j]
        for axis in range(MULTIPLIERS if independent else 0):
            cuts.step[axis] += stride * cuts.base[size, axis]
        if leaving < 0:
            cuts.active[size], cuts.force[size] = row, force
            return size + 1
        size -= 1
        for j in range(leaving, size):
            cuts.active[j], cuts.force[j] = cuts.active[j + 1], cuts.force[j + 1]


@inner
def step_to(level: float, cuts: Cuts) -> bool:
    """Find the shortest step behind which no cut is below a level; False if there is none.

    A dual active-set method (Goldfarb and Idnani, 1983): the lowest cut is raised to the level,
    until none is below it.
    """
    for axis in range(MULTIPLIERS):
        cuts.step[axis] = 0.0
    size = 0
    row, least = lowest_behind(cuts)
    slack = NEARLY * (level - least)
    for _ in range(RAISES):
        if least >= level - slack:
            return True
        size = raise_cut(cuts, row, level, size)
        if size < 0:
            return False
        row, least = lowest_behind(cuts)
    return False
