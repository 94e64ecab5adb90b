"""Plane faces for the tests of the fitment: some named, some drawn at random."""

from __future__ import annotations

import numpy as np
import shapely
from shapely import Point, Polygon, affinity, box

from grasp_xl.fitment.element import Element
from grasp_xl.fitment.part import CadPart, Face, in_order
from grasp_xl.space import frozen

CUP = Element("Cup 46", "suction", 69.0, diameter_mm=46.0, price=10.0)
MAGNET = Element("Magnet 30", "magnets", 130.0, diameter_mm=30.0, price=30.0)
BAR = Element("Bar", "magnets", 255.0, shape="rectangular", length_mm=60.0, width_mm=20.0)
OVAL = Element("Oval", "suction", 40.0, shape="oval", length_mm=60.0, width_mm=20.0)


def flat_part(*faces: Face, plan: Polygon | None = None, thickness_mm: float = 2.0) -> CadPart:
    """Make a part of faces alone, each of a sheet of some thickness."""
    area = sum(face.outline.area for face in faces)
    middle = sum(
        face.outline.area * np.array([*face.outline.centroid.coords[0], face.height_mm])
        for face in faces
    )
    whole = shapely.union_all([face.outline for face in faces])
    centroid = frozen(middle / area)
    return CadPart(
        "part.step", "0" * 64, area * thickness_mm, centroid, in_order(faces), plan or whole
    )


def random_face(seed: int) -> Polygon:
    """Draw an outline with holes: rectangles that overlap, some cut out, some turned, discs."""
    rng = np.random.default_rng(seed)
    outline: Polygon = box(0, 0, *rng.uniform(60, 300, 2))
    for _ in range(rng.integers(0, 4)):
        corner, size = rng.uniform(-50, 250, 2), rng.uniform(20, 150, 2)
        piece = affinity.rotate(box(*corner, *(corner + size)), float(rng.choice([0, 0, 33])))
        outline = outline.union(piece) if rng.integers(2) else outline.difference(piece)
    for _ in range(rng.integers(0, 4)):
        outline = outline.difference(Point(rng.uniform(0, 250, 2)).buffer(rng.uniform(3, 30), 16))
    return max(shapely.get_parts(outline), key=lambda piece: piece.area)
