"""The exact search's view of a task: places in a kd-tree, and the criteria as weights.

A *location* is a place with the footprint of each kind that it has.  A *box* is a node of the
kd-tree over all locations.  For fixed counts the value of a grasp is a weighted sum of its centre
of force's arm, its elements' deviations and its truss (algorithm.md, "Exact search").
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from grasp_xl.adding import plain_sum
from grasp_xl.kernels import RecordArray, boundary_distances
from grasp_xl.rules import SLACK, Rules
from grasp_xl.space import FloatArray, IntArray, OptionSpace

CUPS, MAGNETS = 0, 1
"""The two kinds, by their number; the names are the thesis's."""

WEIGHTS = np.dtype(
    [
        ("cups", "i8"),
        ("magnets", "i8"),
        ("trussed", "i8"),
        ("base", "f8"),
        ("moment", "f8"),
        ("deviation", "f8"),
        ("structure", "f8"),
        ("cup_pull", "f8"),
        ("magnet_pull", "f8"),
        ("ratio", "f8"),
        ("clearance", "f8"),
        ("shortest", "f8"),
        ("arm_cap", "f8"),
        ("deviation_cap", "f8"),
        ("structure_cap", "f8"),
        ("limit", "f8"),
    ]
)
"""The value of a grasp of fixed counts, as weights of its terms.

trussed is 1 where the main truss matters; base is the cost term; moment, deviation and structure
weigh a millimetre (of the centre of force's arm, of one element's deviation, of truss); pull is
force over total force of one element; ratio is R of eq. 7; clearance is the least distance of two
elements and shortest the least main truss (mm); the caps limit the arm, the summed deviation and
the structure (mm), infinite where goals need not be met; a grasp with a value above limit is of no
use.
"""


Rows = Literal["x", "y"]
"""Places of a grid with the same x, or the same y, make a row."""

FEW_HEIGHTS = 8
"""Of parts with flat faces; where places lie at more, boxes are not parted by height: those of a
curved part would be parted by nothing else."""


class Locations(NamedTuple):
    """All places, in the order of a kd-tree, so that a box is a run of them.

    The tree is there three times: with both kinds, with cups alone, with magnets alone.

    xyz ``(n, 3)`` seen from the part's centroid (mm), z = 0 with the plan arm; deviation ``(n,)``;
    footprint ``(n, 2)`` 0-based footprint of each kind, -1 for none.  Of each box: corners
    ``(m, 4)`` xmin, ymin, xmax, ymax; run ``(m, 2)`` its first and behind its last location; child
    ``(m, 2)`` boxes, -1 at a single location; heights ``(m, 2)`` least and largest z;
    least_deviation ``(m,)``; carries ``(m, 2)`` whether it has a footprint of each kind; tight
    ``(m,)`` whether no two of its locations keep the clearance; width ``(m,)`` by which the box to
    split is chosen: its larger side (mm), -1 at a single location.  by_height: whether boxes of
    several heights are parted first.
    """

    xyz: FloatArray
    deviation: FloatArray
    footprint: IntArray
    corners: FloatArray
    run: IntArray
    child: IntArray
    heights: FloatArray
    least_deviation: FloatArray
    carries: NDArray[np.bool_]
    tight: NDArray[np.bool_]
    width: FloatArray
    by_height: bool


class Model(NamedTuple):
    """A task as the exact search sees it.

    locations; weights ``(choices,)`` and goal_weights ``(choices,)`` or ``(0,)`` of ``WEIGHTS``:
    the value, and the sum of the goals where all are to be met, of each choice of counts.
    """

    locations: Locations
    weights: RecordArray
    goal_weights: RecordArray


def locate(
    space: OptionSpace, rules: Rules, *, caps: bool = False, rows: Rows | None = None
) -> Locations:
    """Merge footprints at one place into locations, and lay a kd-tree over them, once a kind.

    With ``caps``, the moment counts in any case.  Boxes of several ``rows`` are parted before all
    others: where the moment can be balanced along the rows in very many ways, but hardly across
    them, they show that soon.
    """
    places: dict[tuple[float, ...], list[int]] = {}
    for number, kind in enumerate(space.kinds):
        for index, point in enumerate(kind.footprints_mm.tolist()):
            places.setdefault(tuple(point), [-1, -1])[number] = index
    points = np.array(list(places), dtype=np.float64).reshape(-1, 3)
    footprint = np.array(list(places.values()), dtype=np.int64).reshape(-1, 2)
    deviation = boundary_distances(points, np.array(space.ideal_polygon_mm))
    xyz = points - space.part.centroid_mm
    level = math.isinf(rules.scales.moment) and not caps
    if level or rules.requirements.moment_arm == "plan":
        xyz[:, 2] = 0.0
    by_height = len(np.unique(xyz[:, 2])) <= FEW_HEIGHTS
    across = [] if rows is None else ["xy".index(rows)]
    order, corners, run, child = grow_tree(xyz, [2, *across] if by_height else across)
    xyz, deviation, footprint = np.ascontiguousarray(xyz[order]), deviation[order], footprint[order]
    summed = [slice(first, last) for first, last in run.tolist()]
    clearance = rules.requirements.clearance_mm * (1 - SLACK)
    sides = corners[:, 2:] - corners[:, :2]
    width = sides.max(axis=1, initial=0.0)
    for axis in across:
        width[sides[:, axis] > 0] += width.max()
    width[child[:, 0] < 0] = -1.0
    carries = np.array([(footprint[part] >= 0).any(axis=0) for part in summed]).reshape(-1, 2)
    boxes = len(run)
    return Locations(
        xyz,
        deviation,
        footprint,
        np.tile(corners, (3, 1)),
        np.tile(run, (3, 1)),
        np.concatenate([np.where(child < 0, -1, child + tree * boxes) for tree in range(3)]),
        np.tile(
            np.array([[xyz[part, 2].min(), xyz[part, 2].max()] for part in summed]).reshape(-1, 2),
            (3, 1),
        ),
        np.tile([deviation[part].min() for part in summed], 3),
        np.concatenate([carries, carries & [True, False], carries & [False, True]]),
        np.tile((sides**2).sum(axis=1) < clearance**2, 3),
        np.tile(width, 3),
        by_height,
    )


def grow_tree(
    xyz: FloatArray, first_axes: Sequence[int]
) -> tuple[IntArray, FloatArray, IntArray, IntArray]:
    """Build a kd-tree down to single points: point order, plan-view corners, runs, children.

    A box with several values on one of the first axes, in their order, is parted between two of
    them, as near to its middle as may be; others are halved across their longer side.  All boxes of
    a level at once, in NumPy: compiling takes longer than it will ever save.
    """
    order = np.arange(len(xyz))
    level, boxes = np.array([[0, len(xyz)]]), 1
    corners, run, child = [], [], []
    while len(level):
        first, last = level.T
        size = last - first
        begin = np.cumsum(size) - size
        box = np.repeat(np.arange(len(level)), size)
        row = np.arange(len(box))
        place = row + (first - begin)[box]
        points = xyz[order[place]]
        low, high = np.minimum.reduceat(points, begin), np.maximum.reduceat(points, begin)
        wide = high - low
        across = np.where(wide[:, 0] >= wide[:, 1], 0, 1)
        between = np.zeros(len(level), dtype=bool)
        for each in reversed(first_axes):
            across[wide[:, each] > 0] = each
            between |= wide[:, each] > 0
        axis = across[box]
        sort = np.lexsort((points[row, axis], box))
        order[place] = order[place][sort]
        half = size // 2
        away = row - (begin + half)[box]
        value = points[sort, axis]
        inseparable = between[box] & (value == np.roll(value, 1)) | (row == begin[box])
        steps = np.where(inseparable, 2 * len(xyz), 2 * np.abs(away) + (away < 0))
        nearest = np.minimum.reduceat(steps, begin)
        half += np.where(nearest % 2, -1, 1) * (nearest // 2)
        halved = level[size > 1]
        halves = np.full(level.shape, -1)
        halves[size > 1] = boxes + np.arange(halved.size).reshape(-1, 2)
        corners.append(np.hstack([low[:, :2], high[:, :2]]))
        run.append(level)
        child.append(halves)
        boxes += halved.size
        middle = (first + half)[size > 1]
        level = np.column_stack([halved[:, 0], middle, middle, halved[:, 1]]).reshape(-1, 2)
    return order, np.concatenate(corners), np.concatenate(run), np.concatenate(child)


def weigh(
    space: OptionSpace, rules: Rules, choices: Sequence[tuple[int, ...]], *, caps: bool
) -> RecordArray:
    """Return the value to minimise as weights, ``(len(choices),)`` of ``WEIGHTS``.

    With ``caps``, only grasps that meet every goal are of use.
    """
    scales = rules.scales
    rows = np.zeros(len(choices), dtype=WEIGHTS)
    for row, counts in zip(rows, choices, strict=True):
        _fill(row, space, rules, counts, caps=caps)
        row["base"] = _dot(counts, [kind.price for kind in space.kinds]) / scales.cost
        row["moment"] = space.part.weight_n / scales.moment
        row["deviation"] = 1.0 / (sum(counts) * scales.deviation)
        row["structure"] = 1.0 / scales.structure
        row["trussed"] = sum(counts) > 1 and (
            row["structure"] > 0 or row["structure_cap"] < math.inf
        )
    return rows


def weigh_goals(
    space: OptionSpace, rules: Rules, choices: Sequence[tuple[int, ...]]
) -> RecordArray:
    """Return the sum of all criteria over their goals, as weights.

    A grasp that meets every goal has at most as much as there are goals: a bound above that limit
    shows that no grasp of a node meets them.
    """
    goals = rules.goals
    rows = np.zeros(len(choices), dtype=WEIGHTS)
    for row, counts in zip(rows, choices, strict=True):
        _fill(row, space, rules, counts, caps=True)
        per_goal = {
            "moment": space.part.weight_n,
            "deviation": 1.0 / sum(counts),
            "structure": 1.0,
        }
        for term, unit in per_goal.items():
            if term not in goals.dropped:
                row[term] = unit / getattr(goals.base, term)
                row["limit"] += 1.0
        row["limit"] *= 1 + 2 * SLACK
        row["trussed"] = sum(counts) > 1 and row["structure_cap"] < math.inf
    return rows


def _fill(
    row: np.void, space: OptionSpace, rules: Rules, counts: tuple[int, ...], *, caps: bool
) -> None:
    """Fill what does not depend on the criterion."""
    goals, elements = rules.goals, sum(counts)
    forces = [kind.force_n for kind in space.kinds]

    def cap(term: str, unit: float) -> float:
        return getattr(goals.base, term) / unit if caps and term not in goals.dropped else math.inf

    row["cups"], row["magnets"] = counts
    row["cup_pull"], row["magnet_pull"] = (each / _dot(counts, forces) for each in forces)
    row["ratio"] = rules.requirements.density_ratio
    row["clearance"] = rules.requirements.clearance_mm * (1 - SLACK)
    row["shortest"] = row["clearance"] * least_spread(elements)
    row["arm_cap"] = cap("moment", space.part.weight_n) * (1 + SLACK)
    row["deviation_cap"] = cap("deviation", 1.0 / elements) * (1 + SLACK)
    row["structure_cap"] = cap("structure", 1.0) * (1 + SLACK)
    if not caps:
        row["limit"] = math.inf


def least_spread(points: int) -> float:
    """Return a lower bound on the diameter of a set of points at least 1 apart.

    Exact up to seven points (Bateman and Erdos, 1951); beyond, the convex hull has at least the
    area and perimeter of Oler's inequality (1961), and a set of diameter d at most those of a disc.

    Examples
    --------
    >>> [round(least_spread(points), 3) for points in (1, 2, 4, 5, 7, 10)]
    [0.0, 1.0, 1.414, 1.618, 2.0, 2.401]
    """
    exact = [0.0, 0.0, 1.0, 1.0, math.sqrt(2), (1 + math.sqrt(5)) / 2, 2 * math.sin(0.4 * math.pi)]
    if points < len(exact):
        return exact[points]
    a, b = math.pi / (2 * math.sqrt(3)), math.pi / 2
    return max(2.0, (math.sqrt(b * b + 4 * a * (points - 1)) - b) / (2 * a))


def _dot(counts: Sequence[int], numbers: Sequence[float]) -> float:
    return plain_sum(count * number for count, number in zip(counts, numbers, strict=True))
