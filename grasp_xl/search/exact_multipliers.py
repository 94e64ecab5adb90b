"""Better multipliers for the bound of a node (compiled); docs/exact.md, step [7]."""

from __future__ import annotations

import numpy as np

from grasp_xl.compiled import inner
from grasp_xl.search.exact_cuts import (
    MULTIPLIERS,
    Cuts,
    add_cut,
    limit_length,
    move_best,
    step_to,
)
from grasp_xl.search.exact_model import MAGNETS, Locations
from grasp_xl.search.exact_prices import Room, Truss, Weights, price, relaxed
from grasp_xl.space import FloatArray, IntArray

FIRST_SHARE, FIRST_SHARE_OF_HEIGHTS, MOST_SHARE = 0.1, 1.0, 1.01
"""Share of the way to the limit that the first step aims at, also where there is a main truss and
places have several heights, so that a child's multipliers are far from its parent's; and the
largest share: a bit more than all, so that rounding does not keep the bound below the limit."""

GAINED = 0.3
LARGER, SMALLER = 3.0, 0.25
"""A step that gains this share of what it aimed at makes the next aim so much larger, else so much
smaller."""

MOST = 1e4
"""Largest multiplier that is tried, over the value."""

LEAST_HEIGHT = 1e-3
"""Least height that the scale of a step assumes, over the width: a plate's is 0."""

TRIES = 8
"""How often a level is halved that no step can reach."""


@inner
def slope_of(
    loc: Locations, w: Weights, t: Truss, n: int, u: FloatArray, room: Room
) -> tuple[float, float, float, float]:
    """Return how the sum of the picks' prices changes with each multiplier."""
    x = y = z = 0.0
    magnets = 0
    for i in range(n):
        place = loc.run[room.pick[i], 0]
        _, kind = price(loc, w, t, room.pick[i], u)
        pull = w.magnet_pull if kind == MAGNETS else w.cup_pull
        magnets += kind
        x += pull * loc.xyz[place, 0]
        y += pull * loc.xyz[place, 1]
        z += pull * loc.xyz[place, 2]
    return w.moment * x, w.moment * y, w.moment * z, float(w.magnets - magnets)


@inner
def set_scale(loc: Locations, w: Weights, scale: FloatArray) -> None:
    """Set the units of a step: each changes the value by about as much."""
    wide = 1e-9
    for side in range(4):
        wide = max(wide, abs(loc.corners[0, side]))
    high = LEAST_HEIGHT * wide
    for end in range(2):
        high = max(high, abs(loc.heights[0, end]))
    scale[0] = scale[1] = 1.0 / max(w.moment * wide, 1e-12)
    scale[2] = 1.0 / max(w.moment * high, 1e-12)
    scale[3] = 1.0


@inner
def go(best: float, limit: float, share: float, u: FloatArray, cuts: Cuts) -> float:
    """Go from ``u`` to where no cut is below a share of the way to the limit; return the share.

    It is halved where no step reaches it.  The direction stays no longer than 1.
    """
    for _ in range(TRIES):
        level = best + share * (limit - best)
        limit_length(level, u, cuts)
        if step_to(level, cuts):
            break
        share /= 2
    trial = cuts.trial
    for axis in range(MULTIPLIERS):
        trial[axis] = u[axis] + cuts.step[axis] * cuts.scale[axis]
    norm = np.sqrt(trial[0] * trial[0] + trial[1] * trial[1] + trial[2] * trial[2])
    for axis in range(3 if norm > 1.0 else 0):
        trial[axis] /= norm
    for axis in range(MULTIPLIERS):
        if not abs(trial[axis]) < MOST * (
            1.0 + abs(limit)
        ):  # not a number, or rounding would spoil the bound
            trial[axis] = u[axis]
    return share


@inner
def ascend(
    loc: Locations,
    w: Weights,
    t: Truss,
    leaning: bool,
    boxes: IntArray,
    n: int,
    truss: float,
    upper: float,
    u: FloatArray,
    steps: int,
    room: Room,
) -> float:
    """Return the best bound after some steps of the multipliers ``u``, which become the best ones.

    A step aims at a level between the best bound and the limit ``upper``: it goes to the nearest
    multipliers at which none of the picks met so far is below that level (a level bundle method).
    """
    cuts = room.cuts
    set_scale(loc, w, cuts.scale)
    cuts.met[0] = 0
    for axis in range(MULTIPLIERS):
        cuts.trial[axis] = u[axis]
    best, level, least = -np.inf, -np.inf, np.inf
    turns = t.a >= 0 and loc.heights[0, 0] < loc.heights[0, 1]
    share = FIRST_SHARE_OF_HEIGHTS if turns else FIRST_SHARE
    for step in range(steps):
        value = truss + relaxed(loc, w, t, leaning, boxes, n, cuts.trial, room)
        if value == np.inf:
            return value
        slope = slope_of(loc, w, t, n, cuts.trial, room)
        x, y, z, missing = slope
        along = x * cuts.trial[0] + y * cuts.trial[1] + z * cuts.trial[2]
        relaxed_value = value + np.sqrt(x * x + y * y + z * z) - along
        if missing == 0.0:  # no multipliers have a larger bound than the value of these picks
            least = min(least, relaxed_value)
        gained = step == 0 or value > best + GAINED * (level - best)
        if step > 0:
            share = min(MOST_SHARE, LARGER * share) if gained else SMALLER * share
        if value > best:
            move_best(cuts, u)
            best = value
        if best >= upper or step == steps - 1:
            break
        add_cut(cuts, value, slope, u)
        limit = min(upper, least)
        if limit == np.inf:
            limit = relaxed_value
        share = go(best, limit, share, u, cuts)
        level = best + share * (limit - best)
    return best
