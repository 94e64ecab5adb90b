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

CUTS = 16
"""Cuts that are kept; of more, the newest."""

SWEEPS = 40
"""How often all cuts are looked at for one step."""

SHORT = 0.05
"""A step may miss a level by this share of the way to it."""


class Cuts(NamedTuple):
    """Cuts as seen from the best point so far.

    met ``(1,)`` how many were met; value ``(c,)`` there, slope ``(c, 4)``, force ``(c,)`` by which
    each pushes the step; step, scale, trial ``(4,)`` in units of scale, the units, and the point
    that is tried.
    """

    met: IntArray
    value: FloatArray
    slope: FloatArray
    force: FloatArray
    step: FloatArray
    scale: FloatArray
    trial: FloatArray


def make_cuts() -> Cuts:
    """Make room for the cuts."""
    return Cuts(
        np.zeros(1, dtype=np.int64),
        np.empty(CUTS),
        np.empty((CUTS, MULTIPLIERS)),
        np.empty(CUTS),
        np.empty(MULTIPLIERS),
        np.empty(MULTIPLIERS),
        np.empty(MULTIPLIERS),
    )


@inner
def add_cut(
    cuts: Cuts, value: float, slope: tuple[float, float, float, float], best: FloatArray
) -> None:
    """Add the cut that was met at the point tried."""
    row = cuts.met[0] % CUTS
    cuts.met[0] += 1
    cuts.value[row] = value
    for axis in range(MULTIPLIERS):
        cuts.slope[row, axis] = slope[axis]
        cuts.value[row] += slope[axis] * (best[axis] - cuts.trial[axis])


@inner
def move_best(cuts: Cuts, best: FloatArray) -> None:
    """Make the point tried the best one, and see all cuts from there."""
    for row in range(min(cuts.met[0], CUTS)):
        for axis in range(MULTIPLIERS):
            cuts.value[row] += cuts.slope[row, axis] * (cuts.trial[axis] - best[axis])
    for axis in range(MULTIPLIERS):
        best[axis] = cuts.trial[axis]


@inner
def lift(cuts: Cuts, row: int, level: float) -> float:
    """Move the step as far as one cut needs, or no longer needs; return what was missing there."""
    squared, reached = 0.0, cuts.value[row]
    for axis in range(MULTIPLIERS):
        slope = cuts.slope[row, axis] * cuts.scale[axis]
        squared += slope * slope
        reached += slope * cuts.step[axis]
    force = max(-cuts.force[row], (level - reached) / squared) if squared > 0.0 else 0.0
    cuts.force[row] += force
    for axis in range(MULTIPLIERS):
        cuts.step[axis] += force * cuts.slope[row, axis] * cuts.scale[axis]
    missing: float = level - reached
    return missing


@inner
def step_to(level: float, cuts: Cuts) -> bool:
    """Find the shortest step after which no cut is below a level (Hildreth's projections).

    False if there seems to be none.
    """
    rows = min(cuts.met[0], CUTS)
    lowest = np.inf
    for row in range(rows):
        cuts.force[row] = 0.0
        lowest = min(lowest, cuts.value[row])
    for axis in range(MULTIPLIERS):
        cuts.step[axis] = 0.0
    for _ in range(SWEEPS):
        missing = 0.0
        for row in range(rows):
            missing = max(missing, lift(cuts, row, level))
        if missing <= 0.0:
            return True
    return missing <= SHORT * (level - lowest)
