"""The fitness criteria and constraints of the thesis, each once, readable, with its equation.

Points are ``(n, 3)`` arrays of active footprint centres (mm), forces ``(n,)`` arrays (N).
``kernels.py`` has the compiled twins; a test holds the two equal to 1e-12 relative.  Sums are plain
ones, and no call goes to BLAS or libm but the square root: the same bits on every machine.
"""

from __future__ import annotations

import math
from itertools import combinations

import numpy as np

from grasp_xl.adding import plain_sum
from grasp_xl.rules import SLACK, MomentArm
from grasp_xl.space import FloatArray, IntArray


def length(vector: FloatArray) -> float:
    """Return the Euclidean length of a short vector."""
    return math.sqrt(plain_sum(part * part for part in vector.tolist()))


def lifting_force(counts: IntArray, forces_n: FloatArray) -> float:
    """Return F = n_suc F_suc + n_mag F_mag (N), eq. 11."""
    return float((counts * forces_n).sum())


def factor_of_safety(force_n: float, weight_n: float) -> float:
    """Return FoS = F / W, eq. 12."""
    return force_n / weight_n


def cost(counts: IntArray, prices: FloatArray) -> float:
    """Return the total cost of the gripper elements ($), eq. 5."""
    return float((counts * prices).sum())


def centre_of_force(points: FloatArray, forces_n: FloatArray) -> FloatArray:
    """Return the force-weighted mean of the points, ``(3,)`` (mm), eq. 2."""
    mean: FloatArray = (forces_n[:, None] * points).sum(axis=0) / forces_n.sum()
    return mean


def eccentricity(centre: FloatArray, centroid: FloatArray, arm: MomentArm) -> float:
    """Return the distance r from the centre of force to the part's centroid (mm), eq. 3.

    With the ``plan`` arm its height does not count: vertical forces make no moment over it.
    """
    offset = centre - centroid
    return length(offset[:2] if arm == "plan" else offset)


def residual_moment(eccentricity_mm: float, weight_n: float) -> float:
    """Return the residual moment r W (N-mm), eq. 4."""
    return eccentricity_mm * weight_n


def distance_to_boundary(point: FloatArray, polygon: FloatArray) -> float:
    """Return the plan-view distance from a point to the boundary of a closed polygon (mm).

    Parameters
    ----------
    point : FloatArray
        ``(3,)`` or ``(2,)`` array.
    polygon : FloatArray
        ``(n, 3)`` or ``(n, 2)`` array of vertices in order.
    """
    start = polygon[:, :2]
    edge = np.roll(start, -1, axis=0) - start
    along = ((point[:2] - start) * edge).sum(axis=1) / (edge**2).sum(axis=1)
    nearest = start + np.clip(along, 0.0, 1.0)[:, None] * edge
    return min(length(offset) for offset in nearest - point[:2])


def deviation(points: FloatArray, ideal_polygon: FloatArray) -> float:
    """Return the mean distance of the points to the ideal deflection polygon (mm), eq. 6."""
    return float(np.mean([distance_to_boundary(point, ideal_polygon) for point in points]))


def smallest_distance(points: FloatArray) -> float | None:
    """Return the smallest plan-view distance between two points (mm), None for one point."""
    return min((length((q - p)[:2]) for p, q in combinations(points, 2)), default=None)


def main_truss(points: FloatArray, density_ratio: float) -> tuple[int, int]:
    """Return the two points that the main truss joins: the farthest two in plan view.

    Among pairs within 1e-9 relative of the longest, the one with the smallest structure, so that
    the value does not depend on the order of the genes.
    """
    lengths = {
        pair: length((points[pair[1]] - points[pair[0]])[:2])
        for pair in combinations(range(len(points)), 2)
    }
    longest = max(lengths.values())
    candidates = [pair for pair, far in lengths.items() if far >= longest * (1 - SLACK)]
    return min(candidates, key=lambda pair: truss_length(points, pair, density_ratio))


def truss_length(points: FloatArray, pair: tuple[int, int], density_ratio: float) -> float:
    """Return R l_max plus all branches, with the main truss on a given pair (mm), eq. 7."""
    start = points[pair[0], :2]
    axis = points[pair[1], :2] - start
    main = length(axis)
    if main == 0.0:
        return 0.0
    others = np.delete(points[:, :2], pair, axis=0) - start
    branches = np.abs(axis[0] * others[:, 1] - axis[1] * others[:, 0]) / main
    return density_ratio * main + float(branches.sum())


def structure(points: FloatArray, density_ratio: float) -> float:
    """Return the approximated size of the gripper structure (mm), eq. 7; 0 for one point."""
    if len(points) < 2:
        return 0.0
    return truss_length(points, main_truss(points, density_ratio), density_ratio)
