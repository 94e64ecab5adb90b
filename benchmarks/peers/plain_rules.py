"""The criteria as one writes them down first in NumPy: every distance worked out a grasp."""

from __future__ import annotations

import numpy as np

from benchmarks.peers.numpy_rules import NumpyRules
from grasp_xl.rules import Rules
from grasp_xl.space import FloatArray, IntArray, OptionSpace


class PlainRules(NumpyRules):
    """``NumpyRules`` without the tables of distances between footprints and to the polygon."""

    def __init__(self, space: OptionSpace, rules: Rules) -> None:
        super().__init__(space, rules)
        polygon = space.ideal_polygon_mm[:, :2] - space.part.centroid_mm[:2]
        self.start = polygon
        self.edge = np.roll(polygon, -1, axis=0) - polygon
        self.edge_squared = (self.edge**2).sum(axis=1)

    def squared_distances(self, places: IntArray) -> FloatArray:
        """Work out the squared plan-view distances, ``(n, n)`` (mm^2)."""
        points = self.xyz[places, :2]
        across = points[:, None, :] - points
        squared: FloatArray = (across**2).sum(axis=2)
        return squared

    def deviations(self, places: IntArray) -> FloatArray:
        """Work out the distances to the polygon's boundary, ``(n,)`` (mm)."""
        offset = self.xyz[places, None, :2] - self.start
        along = np.clip((offset * self.edge).sum(axis=2) / self.edge_squared, 0.0, 1.0)
        distances: FloatArray = np.linalg.norm(offset - along[:, :, None] * self.edge, axis=2)
        return distances.min(axis=1)
