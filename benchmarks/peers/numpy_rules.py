"""Our mutation and criteria in NumPy, for the peers: tables made once, a few array calls a grasp.

Genes are one flat row, kind after kind: a count, then 1-based footprint indices.  Random numbers
are drawn as ``grasp_xl.search.mutation`` draws them, so that every peer can be held to our course.
"""

from __future__ import annotations

import itertools
import math
from typing import NamedTuple

import numpy as np

from grasp_xl.criteria import distance_to_boundary
from grasp_xl.rules import SLACK, Rules
from grasp_xl.search.mutation import TRIES_PER_MATRIX
from grasp_xl.space import FloatArray, IntArray, OptionSpace


class Counts(NamedTuple):
    """All that follows from the counts alone.

    ``columns (n,)`` of the active genes, ``offsets (n,)`` from genes to places, ``forces (n,)``
    (N), their sum (N), and the cost ($).
    """

    columns: IntArray
    offsets: IntArray
    forces: FloatArray
    force: float
    cost: float


class NumpyRules:
    """The rules of an option space, laid out for NumPy."""

    def __init__(self, space: OptionSpace, rules: Rules) -> None:
        need = rules.requirements
        points = np.concatenate([kind.footprints_mm for kind in space.kinds])
        self.xyz = points - space.part.centroid_mm
        self.plan = self.xyz[:, 0] + 1j * self.xyz[:, 1]
        x, y = self.xyz[:, 0], self.xyz[:, 1]
        self.squared = np.subtract.outer(x, x) ** 2 + np.subtract.outer(y, y) ** 2
        polygon = space.ideal_polygon_mm
        self.deviation = np.array([distance_to_boundary(point, polygon) for point in points])
        self.weight, self.density_ratio = space.part.weight_n, need.density_ratio
        self.force_min = need.fos * (1 - SLACK) * self.weight
        self.clearance_squared = (need.clearance_mm * (1 - SLACK)) ** 2
        self.scales = rules.scales
        self.row = 1 + space.gene_slots
        self.counts = self._counts(space)
        self.low = np.ones(self.row * len(space.kinds), dtype=np.int64)
        self.span = np.repeat([float(kind.total) for kind in space.kinds], self.row)
        self.low[:: self.row] = [kind.count_min for kind in space.kinds]
        self.span[:: self.row] = [kind.most - kind.count_min + 1 for kind in space.kinds]

    def _counts(self, space: OptionSpace) -> dict[tuple[int, ...], Counts]:
        first = np.cumsum([0] + [kind.total for kind in space.kinds])
        table = {}
        for counts in itertools.product(*(range(kind.most + 1) for kind in space.kinds)):
            kinds = [number for number, count in enumerate(counts) for _ in range(count)]
            slots = [slot for count in counts for slot in range(1, count + 1)]
            forces = np.array([space.kinds[kind].force_n for kind in kinds])
            table[counts] = Counts(
                np.array(kinds, dtype=np.int64) * self.row + np.array(slots, dtype=np.int64),
                first[kinds] - 1,
                forces,
                float(forces.sum()),
                sum(space.kinds[kind].price for kind in kinds),
            )
        return table

    def mutation_matrix(self, rng: np.random.Generator, one_in: float) -> IntArray:
        """Draw the shared matrix: the columns that it marks."""
        return np.flatnonzero(rng.random(len(self.low)) < 1.0 / one_in)

    def mutated(self, rng: np.random.Generator, parent: IntArray, marks: IntArray) -> IntArray:
        """Return a copy of the parent with new values in the marked columns."""
        genes = parent.copy()
        drawn = rng.random(len(marks)) * self.span[marks]
        genes[marks] = self.low[marks] + drawn.astype(np.int64)
        return genes

    def clear_child(self, rng: np.random.Generator, parent: IntArray, marks: IntArray) -> IntArray:
        """Mutate the parent until the child keeps the clearance, with the two escapes."""
        for attempt in range(2 * TRIES_PER_MATRIX):
            if attempt == TRIES_PER_MATRIX:
                marks = np.union1d(marks, np.arange(0, len(parent), self.row))
            child = self.mutated(rng, parent, marks)
            if self.is_clear(child):
                return child
        return parent.copy()

    def is_clear(self, genes: IntArray) -> bool:
        """Tell whether only the diagonal of the distances is below the clearance."""
        counts = self.counts[tuple(genes[:: self.row].tolist())]
        places = genes[counts.columns] + counts.offsets
        near = self.squared_distances(places) < self.clearance_squared
        return int(np.count_nonzero(near)) == len(places)

    def value(self, genes: IntArray) -> float:
        """Return what the search minimises; infinity below the FoS goal."""
        counts = self.counts[tuple(genes[:: self.row].tolist())]
        if counts.force < self.force_min:
            return math.inf
        places = genes[counts.columns] + counts.offsets
        arm = math.hypot(*(counts.forces @ self.xyz[places]).tolist()) / counts.force
        terms = (
            counts.cost,
            arm * self.weight,
            float(self.deviations(places).sum()) / len(places),
            self.structure(places),
        )
        return sum(term / scale for term, scale in zip(terms, self.scales, strict=True))

    def squared_distances(self, places: IntArray) -> FloatArray:
        """Look up the squared plan-view distances, ``(n, n)`` (mm^2)."""
        return self.squared[places[:, None], places]

    def deviations(self, places: IntArray) -> FloatArray:
        """Look up the distances to the ideal polygon, ``(n,)`` (mm)."""
        return self.deviation[places]

    def structure(self, places: IntArray) -> float:
        """Return R l_max plus all branches, the smallest over the longest pairs (mm)."""
        squared = self.squared_distances(places)
        longest = squared.max()
        if longest == 0.0:
            return 0.0
        start, end = np.nonzero(squared >= longest * (1 - SLACK) ** 2)
        plan = self.plan[places]
        axes = plan[end] - plan[start]
        lengths = np.abs(axes)
        areas = np.abs((axes.conj()[:, None] * (plan - plan[start][:, None])).imag)
        return float((self.density_ratio * lengths + areas.sum(axis=1) / lengths).min())
