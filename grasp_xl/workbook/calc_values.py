"""What the helper cells of a card hold: computed here as well, so that the file shows numbers."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations, permutations

import numpy as np

from grasp_xl import criteria
from grasp_xl.chromosome import BLANK_GENE
from grasp_xl.grasp import Grasp
from grasp_xl.rules import SLACK
from grasp_xl.space import FloatArray, OptionSpace
from grasp_xl.stability import support

SAME_PLACE_MM = 1e-9
"""Coordinates nearer than this are the same place: another's rounding."""

Table = list[list[float | str]]


@dataclass(frozen=True, slots=True)
class CalcValues:
    """Values of one block of helper cells, a row a gene, active or not."""

    points: FloatArray
    active: list[bool]
    known: list[bool]
    force: list[float]
    to_polygon: list[float]
    distinct: list[bool]
    distance: Table
    structure: Table
    hull: Table
    shortest: float | None
    hull_area: float
    centroid_inside: bool

    @classmethod
    def of(cls, space: OptionSpace, grasp: Grasp, slots: int, density_ratio: float) -> CalcValues:
        """Compute the values of a grasp."""
        genes = grasp.chromosome.genes
        points, known, force = [], [], []
        for row, kind in zip(genes, space.kinds, strict=True):
            for slot, gene in enumerate(row[1 : 1 + slots].tolist(), 1):
                here = gene != BLANK_GENE
                points.append(kind.footprints_mm[gene - 1] if here else np.zeros(3))
                known.append(here)
                force.append(kind.force_n if slot <= row[0] else 0.0)
        active = [slot < row[0] for row in genes for slot in range(slots)]
        places = np.array(points)
        held = support(space, grasp)
        distance = _distances(places, active)
        distinct = _distinct(places, active)
        ideal = np.array(space.ideal_polygon_mm)
        return cls(
            points=places,
            active=active,
            known=known,
            force=force,
            to_polygon=[
                criteria.distance_to_boundary(point, ideal) if on else 0.0
                for point, on in zip(places, active, strict=True)
            ],
            distinct=distinct,
            distance=distance,
            structure=_structures(places, active, distance, density_ratio),
            hull=_hull(places, distinct, grasp.longest_mm, space.part.centroid_mm),
            shortest=grasp.clearance_mm,
            hull_area=held.hull_area_mm2,
            centroid_inside=held.centroid_inside,
        )

    def element(self, title: str, row: int) -> float | str:
        """Value of an element's cell."""
        numbers: dict[str, float | str] = {
            "in space": int(self.known[row]),
            "active": int(self.active[row]),
            "right": 1,
            "x": float(self.points[row, 0]),
            "y": float(self.points[row, 1]),
            "z": float(self.points[row, 2]),
            "force (N)": self.force[row],
            "to polygon": self.to_polygon[row],
            "distinct": int(self.distinct[row]),
            "least structure": _least(self.structure[row]),
        }
        return numbers[title]

    def summary(self, title: str) -> float | str:
        """Value of a cell of the summary."""
        rows = np.flatnonzero(self.active)
        ends = truss_ends(self.points[rows])
        start, end = (int(rows[end]) + 1 for end in ends) if ends else (0, 0)
        numbers: dict[str, float | str] = {
            "usable": 1,
            "fault": "",
            "first wrong": 0,
            "elements": sum(self.active),
            "longest": max(_numbers(self.distance), default=0.0),
            "shortest": "" if self.shortest is None else self.shortest,
            "main truss from": start,
            "main truss to": end,
            "hull area": self.hull_area,
            "centroid inside": int(self.centroid_inside),
        }
        return numbers[title]


def truss_ends(points: FloatArray) -> tuple[int, int] | None:
    """Return the two points that the workbook's main truss joins, None for one point.

    Of trusses that are equal but for rounding, say the diagonals of a rectangle, it is the first;
    the engine's is any of them.
    """
    pairs = list(combinations(range(len(points)), 2))
    lengths = {(i, j): float(np.linalg.norm((points[j] - points[i])[:2])) for i, j in pairs}
    longest = max(lengths.values(), default=0.0)
    branches = {
        pair: criteria.truss_length(points, pair, density_ratio=0.0)
        for pair, length in lengths.items()
        if length >= longest * (1 - SLACK)
    }
    bound = min(branches.values(), default=0.0) + SLACK * longest
    return next((pair for pair, size in branches.items() if size <= bound), None)


def _numbers(table: Table) -> list[float]:
    return [value for row in table for value in row if not isinstance(value, str)]


def _least(cells: list[float | str]) -> float | str:
    return min((value for value in cells if not isinstance(value, str)), default="")


def _blank(size: int) -> Table:
    return [["" for _ in range(size)] for _ in range(size)]


def _distances(points: FloatArray, active: list[bool]) -> Table:
    table = _blank(len(points))
    for i, j in combinations(np.flatnonzero(active).tolist(), 2):
        table[i][j] = float(np.linalg.norm((points[j] - points[i])[:2]))
    return table


def _structures(
    points: FloatArray, active: list[bool], distance: Table, density_ratio: float
) -> Table:
    table = _blank(len(points))
    numbers = np.flatnonzero(active).tolist()
    longest = max(_numbers(distance), default=0.0)
    for i, j in combinations(numbers, 2):
        length = distance[i][j]
        if not isinstance(length, str) and length >= longest * (1 - SLACK):
            pair = (numbers.index(i), numbers.index(j))
            table[i][j] = criteria.truss_length(points[numbers], pair, density_ratio)
    return table


def _distinct(points: FloatArray, active: list[bool]) -> list[bool]:
    flags = []
    for row, point in enumerate(points[:, :2]):
        before = points[:row, :2][active[:row]]
        twins = (np.abs(before - point) < SAME_PLACE_MM).all(axis=1)
        flags.append(active[row] and not twins.any())
    return flags


def _hull(points: FloatArray, distinct: list[bool], longest: float, centroid: FloatArray) -> Table:
    """Twice the area between the centroid and each edge of the convex hull."""
    table = _blank(len(points))
    numbers = np.flatnonzero(distinct).tolist()
    slack = SLACK * longest**2
    plan = points[:, :2]
    for i, j in permutations(numbers, 2):
        edge = plan[j] - plan[i]
        others = plan[numbers] - plan[i]
        cross = edge[0] * others[:, 1] - edge[1] * others[:, 0]
        along = others @ edge
        beyond = (along < -slack) | (along > edge @ edge + slack)
        if not ((cross < -slack) | ((np.abs(cross) <= slack) & beyond)).any():
            a, b = plan[i] - centroid[:2], plan[j] - centroid[:2]
            table[i][j] = float(a[0] * b[1] - b[0] * a[1])
    return table
