"""Triangles of simple solids, ``(n, 3, 3)`` arrays of corners (mm), and how they are shaded."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import shapely
import trimesh

from grasp_xl.space import FloatArray, IntArray, frozen
from grasp_xl.view.solids import Bar, Block, Plate, Solid, Turned

SECTIONS = 48
"""Corners of a circle: those of a cup of 46 mm stray by 0.05 mm."""

CREASE_DEG = 30.0
"""Triangles that lean more to each other meet in an edge; others are one curved surface."""

DECIMALS = 5
"""Corners that agree to so many decimals of a millimetre are one."""


class Shaded(NamedTuple):
    """Corners with the normal of the surface there, ``(n, 3)`` each, and ``(m, 3)`` triangles."""

    places_mm: FloatArray
    normals: FloatArray
    triangles: IntArray


def triangles_of(solid: Solid) -> FloatArray:
    """Return the triangles of a solid, counter-clockwise from outside."""
    match solid:
        case Turned():
            mesh = trimesh.creation.revolve(solid.profile_mm, sections=SECTIONS)
        case Block():
            mesh = _block(solid)
        case Bar():
            ends = np.array([solid.start_mm, solid.end_mm])
            mesh = trimesh.creation.cylinder(solid.radius_mm, segment=ends, sections=SECTIONS)
        case Plate():
            return _plate(solid)
    return frozen(mesh.triangles)


def indexed(triangles_mm: FloatArray) -> tuple[FloatArray, IntArray]:
    """Return the different corners, ``(n, 3)``, and the triangles by their numbers, ``(m, 3)``."""
    corners = np.round(triangles_mm.reshape(-1, 3), DECIMALS) + 0.0
    places, numbers = np.unique(corners, axis=0, return_inverse=True)
    return places, numbers.reshape(-1, 3)


def shaded(triangles_mm: FloatArray) -> Shaded:
    """Return triangles with normals that turn on curved surfaces, and not over edges."""
    places, triangles = indexed(triangles_mm)
    edges = np.diff(places[triangles], axis=1)
    areas = np.cross(edges[:, 0], edges[:, 1])
    sizes = np.linalg.norm(areas, axis=1)
    real = sizes > 0
    triangles, areas = triangles[real], areas[real]
    units = areas / sizes[real, None]
    one, other = _meetings(triangles.ravel())
    smooth = (units[one // 3] * units[other // 3]).sum(axis=1) >= np.cos(np.radians(CREASE_DEG))
    sums = np.zeros((triangles.size, 3))
    np.add.at(sums, one[smooth], areas[other[smooth] // 3])
    normals = sums / np.linalg.norm(sums, axis=1, keepdims=True)
    corners = np.column_stack([places[triangles.ravel()], np.round(normals, DECIMALS) + 0.0])
    found, numbers = np.unique(corners, axis=0, return_inverse=True)
    return Shaded(found[:, :3], found[:, 3:], numbers.reshape(-1, 3))


def _meetings(places: IntArray) -> tuple[IntArray, IntArray]:
    """Return all pairs of corners, one with itself too, that are at the same place."""
    order = np.argsort(places, kind="stable")
    counts = np.bincount(places)[places[order]]
    first = np.searchsorted(places[order], places[order])
    one = np.repeat(order, counts)
    step = np.arange(len(one)) - np.repeat(np.cumsum(counts) - counts, counts)
    return one, order[np.repeat(first, counts) + step]


def _block(block: Block) -> trimesh.Trimesh:
    mesh = trimesh.creation.box((block.length_mm, block.width_mm, block.high_mm - block.low_mm))
    turn = trimesh.transformations.rotation_matrix(np.radians(block.angle_deg), [0, 0, 1])
    mesh.apply_transform(turn)
    mesh.apply_translation([0, 0, (block.low_mm + block.high_mm) / 2])
    return mesh


def _plate(plate: Plate) -> FloatArray:
    """Return a plate's triangles, those of its upper face first; of a surface they are all."""
    pieces = shapely.get_parts(shapely.constrained_delaunay_triangles(plate.area))
    corners = shapely.get_coordinates(shapely.orient_polygons(pieces)).reshape(-1, 4, 2)[:, :3]
    upper = np.concatenate([corners, np.full((*corners.shape[:2], 1), plate.high_mm)], axis=2)
    if plate.high_mm == plate.low_mm:
        return frozen(upper)
    lower = upper[:, ::-1] - [0, 0, plate.high_mm - plate.low_mm]
    return frozen(np.concatenate([upper, lower, *_walls(plate)]))


def _walls(plate: Plate) -> list[FloatArray]:
    """Return the triangles of a plate's walls, ring by ring."""
    walls = []
    for piece in shapely.get_parts(shapely.orient_polygons(plate.area)):
        for ring in (piece.exterior, *piece.interiors):
            corners = shapely.get_coordinates(ring)
            low, high = (
                np.column_stack([corners, np.full(len(corners), height)])
                for height in (plate.low_mm, plate.high_mm)
            )
            a, b, c, d = low[:-1], low[1:], high[1:], high[:-1]
            walls += [np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)]
    return walls
