"""Compiled twins of ``criteria.py``, on arrays, for the searches.

A kernel never sees an option space: :func:`tabulate` lays it out once as ``Tables``.  Active
footprints are given by their *places*, 0-based rows of ``Tables.xyz`` (kind after kind).
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from grasp_xl.compiled import allocation_free, compiled
from grasp_xl.rules import SLACK, Rules, Terms
from grasp_xl.space import FloatArray, IntArray, OptionSpace

RecordArray = NDArray[Any]

FOOTPRINT = np.dtype([("x", "f8"), ("y", "f8"), ("z", "f8"), ("deviation", "f8")])
"""A footprint, seen from the part's centroid (mm), and its distance to the ideal polygon (mm).

With the ``plan`` moment arm every z is 0.
"""

KIND = np.dtype(
    [
        ("first", "i8"),
        ("total", "i8"),
        ("count_min", "i8"),
        ("count_max", "i8"),
        ("force", "f8"),
        ("price", "f8"),
    ]
)
"""An element kind: row of its first footprint, how many it has, its count range, N, $."""


class Tables(NamedTuple):
    """An option space and the rules, laid out for the kernels.

    ``footprints (n,)`` of ``FOOTPRINT``, kind after kind; ``kinds (k,)`` of ``KIND``; the part's
    weight (N); R of eq. 7; the four divisors of the terms, infinity for those left out.  The slack
    of comparisons is already in ``force_min`` and ``clearance_squared``.
    """

    footprints: RecordArray
    kinds: RecordArray
    weight: float
    density_ratio: float
    force_min: float
    clearance_squared: float
    cost_scale: float
    moment_scale: float
    deviation_scale: float
    structure_scale: float


def tabulate(space: OptionSpace, rules: Rules) -> Tables:
    """Lay out an option space and the rules for the kernels."""
    need = rules.requirements
    centres = np.concatenate([kind.footprints_mm for kind in space.kinds])
    footprints = np.zeros(len(centres), dtype=FOOTPRINT)
    footprints["x"], footprints["y"], footprints["z"] = (centres - space.part.centroid_mm).T
    if need.moment_arm == "plan":
        footprints["z"] = 0.0
    footprints["deviation"] = boundary_distances(centres, np.array(space.ideal_polygon_mm))
    kinds = np.zeros(len(space.kinds), dtype=KIND)
    first = 0
    for row, kind in zip(kinds, space.kinds, strict=True):
        row["first"], row["total"] = first, kind.total
        row["count_min"], row["count_max"] = kind.count_min, kind.most
        row["force"], row["price"] = kind.force_n, kind.price
        first += kind.total
    return Tables(
        footprints,
        kinds,
        space.part.weight_n,
        float(need.density_ratio),
        need.fos * (1 - SLACK) * space.part.weight_n,
        (need.clearance_mm * (1 - SLACK)) ** 2,
        *map(float, rules.scales),
    )


@compiled
def boundary_distances(points: FloatArray, polygon: FloatArray) -> FloatArray:
    """Twin of ``criteria.distance_to_boundary`` for ``(n, 3)`` points at once, ``(n,)`` (mm)."""
    distances = np.empty(len(points))
    for i in range(len(points)):
        nearest = np.inf
        for j in range(len(polygon)):
            start, end = polygon[j], polygon[(j + 1) % len(polygon)]
            ex, ey = end[0] - start[0], end[1] - start[1]
            px, py = points[i, 0] - start[0], points[i, 1] - start[1]
            along = min(1.0, max(0.0, (px * ex + py * ey) / (ex * ex + ey * ey)))
            dx, dy = px - along * ex, py - along * ey
            nearest = min(nearest, dx * dx + dy * dy)
        distances[i] = np.sqrt(nearest)
    return distances


@allocation_free
def active_places(t: Tables, genes: IntArray, places: IntArray) -> int:
    """Write the places of the active genes into ``places`` and return how many there are."""
    n = 0
    for kind in range(len(genes)):
        for slot in range(1, genes[kind, 0] + 1):
            places[n] = t.kinds[kind].first + genes[kind, slot] - 1
            n += 1
    return n


@allocation_free
def lifting_force(t: Tables, genes: IntArray) -> float:
    """Twin of ``criteria.lifting_force`` (N), eq. 11."""
    force: float = 0.0
    for kind in range(len(genes)):
        force += genes[kind, 0] * t.kinds[kind].force
    return force


@allocation_free
def squared_distance(t: Tables, a: int, b: int) -> float:
    """Squared plan-view distance between two places (mm^2)."""
    p, q = t.footprints[a], t.footprints[b]
    dx, dy = p.x - q.x, p.y - q.y
    return dx * dx + dy * dy


@allocation_free
def is_clear(t: Tables, places: IntArray, n: int) -> bool:
    """Tell whether the first n places keep the clearance (section 4.2.4.2)."""
    for i in range(1, n):
        for j in range(i):
            if squared_distance(t, places[i], places[j]) < t.clearance_squared:
                return False
    return True


@allocation_free
def total_cost(t: Tables, genes: IntArray) -> float:
    """Twin of ``criteria.cost`` ($), eq. 5."""
    cost = 0.0
    for kind in range(len(genes)):
        cost += genes[kind, 0] * t.kinds[kind].price
    return cost


@allocation_free
def residual_moment(t: Tables, genes: IntArray, places: IntArray) -> float:
    """Twin of eq. 2-4 (N-mm); ``places`` are the active ones, kind after kind."""
    x = y = z = force = 0.0
    n = 0
    for kind in range(len(genes)):
        f = t.kinds[kind].force
        for _ in range(genes[kind, 0]):
            p = t.footprints[places[n]]
            x += f * p.x
            y += f * p.y
            z += f * p.z
            force += f
            n += 1
    return np.sqrt(x * x + y * y + z * z) / force * t.weight


@allocation_free
def mean_deviation(t: Tables, places: IntArray, n: int) -> float:
    """Twin of ``criteria.deviation`` (mm), eq. 6."""
    total = 0.0
    for i in range(n):
        total += t.footprints[places[i]].deviation
    return total / n


@allocation_free
def truss_length(t: Tables, places: IntArray, n: int, i: int, j: int) -> float:
    """Twin of ``criteria.truss_length`` (mm), eq. 7, with the main truss from i to j."""
    p, q = t.footprints[places[i]], t.footprints[places[j]]
    ax, ay = q.x - p.x, q.y - p.y
    length = np.sqrt(ax * ax + ay * ay)
    if length == 0.0:
        return 0.0
    doubled_areas = 0.0
    for k in range(n):
        if k not in (i, j):
            other = t.footprints[places[k]]
            doubled_areas += abs(ax * (other.y - p.y) - ay * (other.x - p.x))
    return t.density_ratio * length + doubled_areas / length


@allocation_free
def structure(t: Tables, places: IntArray, n: int) -> float:
    """Twin of ``criteria.structure`` (mm), eq. 7."""
    longest = 0.0
    for i in range(1, n):
        for j in range(i):
            longest = max(longest, squared_distance(t, places[i], places[j]))
    if longest == 0.0:
        return 0.0
    shortest = np.inf
    bar = longest * (1 - SLACK) ** 2
    for i in range(1, n):
        for j in range(i):
            if squared_distance(t, places[i], places[j]) >= bar:
                shortest = min(shortest, truss_length(t, places, n, i, j))
    return shortest


@allocation_free
def value_below(t: Tables, genes: IntArray, places: IntArray, n: int, bar: float) -> float:
    """Twin of ``Rules.value``: the number that the search minimises, infinity from ``bar`` on.

    The terms are added from the cheapest to the dearest, and no term is negative, so that most
    children are turned down before their structure is worked out.
    """
    total = 0.0
    if np.isfinite(t.cost_scale):
        total += total_cost(t, genes) / t.cost_scale
    if np.isfinite(t.moment_scale) and total < bar:
        total += residual_moment(t, genes, places) / t.moment_scale
    if np.isfinite(t.deviation_scale) and total < bar:
        total += mean_deviation(t, places, n) / t.deviation_scale
    if np.isfinite(t.structure_scale) and total < bar:
        total += structure(t, places, n) / t.structure_scale
    return total if total < bar else np.inf


@allocation_free
def fitness(t: Tables, genes: IntArray, places: IntArray) -> float:
    """Return the value of a chromosome, infinity where it fails FoS or clearance."""
    n = active_places(t, genes, places)
    if lifting_force(t, genes) < t.force_min or not is_clear(t, places, n):
        return np.inf
    return value_below(t, genes, places, n, np.inf)


@compiled
def measure_rows(t: Tables, rows: IntArray) -> FloatArray:
    """Measure many chromosomes.

    Parameters
    ----------
    t : Tables
    rows : IntArray
        ``(n, kinds, 1 + slots)`` array of genes.

    Returns
    -------
    FloatArray
        ``(n, 6)``: FoS, cost, moment, deviation, structure, and 1 where FoS and clearance hold.
    """
    measured = np.empty((len(rows), 6))
    places = np.empty(rows.shape[1] * rows.shape[2], dtype=np.int64)
    for i in range(len(rows)):
        n = active_places(t, rows[i], places)
        force = lifting_force(t, rows[i])
        measured[i, 0] = force / t.weight
        measured[i, 1] = total_cost(t, rows[i])
        measured[i, 2] = residual_moment(t, rows[i], places)
        measured[i, 3] = mean_deviation(t, places, n)
        measured[i, 4] = structure(t, places, n)
        measured[i, 5] = force >= t.force_min and is_clear(t, places, n)
    return measured


def terms_of(measured: FloatArray) -> Terms:
    """Return the criteria of one row of :func:`measure_rows`."""
    return Terms(*measured[1:5].tolist())
