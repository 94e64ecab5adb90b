"""A picture of a design for the workbook: part, elements and frame, seen from the front left."""

from __future__ import annotations

import io

import numpy as np
from PIL import Image

from grasp_xl.space import FloatArray, IntArray, frozen
from grasp_xl.view.assembly import PART_COLOUR, pieces_of, rgb
from grasp_xl.view.meshes import CREASE_DEG, Shaded, shaded, triangles_of
from grasp_xl.view.raster import NOTHING, empty, fill
from grasp_xl.view.scene import Scene
from grasp_xl.view.solids import Bar
from grasp_xl.workbook.styles import BLUE

WIDTH, HEIGHT = 1200, 900
FINER = 2
"""Pixels that one of the picture is the mean of, along each axis."""

AZIMUTH_DEG, ELEVATION_DEG = -120.0, 32.0
"""Where the camera stands, from the middle: to the front (-y) and the left, and above."""

MARGIN = 0.04
LIGHT = np.array([-0.35, -0.45, 0.82])
"""Towards the light; the camera sees surfaces that look away from it at half their brightness."""
SHADE = 0.55
EDGE_SHADE = 0.45
"""Brightness of edges."""
NEARER = 0.012
"""Step in depth, as a part of the picture's width, that is drawn as an edge."""
POLYGON_RADIUS = 0.003
"""Of the ideal polygon's line, as a part of the extent."""


def picture_of(scene: Scene) -> bytes:
    """Return the shown design as a PNG file; the same bytes for the same design."""
    shapes = _shapes(scene)
    corners = np.concatenate([shape.places_mm[shape.triangles] for shape, _ in shapes])
    normals = np.concatenate([shape.normals[shape.triangles] for shape, _ in shapes])
    counts = [len(shape.triangles) for shape, _ in shapes]
    piece = np.repeat(np.arange(len(shapes)), counts)
    colours = np.array([rgb(colour) for _, colour in shapes])
    camera = _camera()
    depth, seen, normal_at = empty(HEIGHT * FINER, WIDTH * FINER)
    fill(_on_screen(corners @ camera.T), normals, depth, seen, normal_at)
    shown = seen != NOTHING
    owner = np.where(shown, piece[seen], NOTHING)
    units = _units(normal_at)
    paint = np.ones((*seen.shape, 3))
    brightness = SHADE + (1 - SHADE) * np.abs(units @ (LIGHT / np.linalg.norm(LIGHT)))
    paint[shown] = colours[owner[shown]] * brightness[shown, None]
    paint[_edges(depth, owner, units)] *= EDGE_SHADE
    small = paint.reshape(HEIGHT, FINER, WIDTH, FINER, 3).mean(axis=(1, 3))
    file = io.BytesIO()
    Image.fromarray(np.round(small * 255).astype(np.uint8)).save(file, "PNG", optimize=True)
    return file.getvalue()


def _shapes(scene: Scene) -> list[tuple[Shaded, str]]:
    """Return what is drawn, each with its colour."""
    pieces = pieces_of(scene)
    found = [
        (shaded(frozen(triangles_of(solid) + piece.place_mm)), piece.colour)
        for piece in pieces
        for solid in piece.solids
    ]
    if scene.part.solid:
        found.append((shaded(scene.part.solid.mesh), PART_COLOUR))
    polygon = scene.task.space.ideal_polygon_mm
    radius = POLYGON_RADIUS * float(np.ptp(polygon, axis=0).max())
    for start, end in zip(polygon, np.roll(polygon, -1, axis=0), strict=True):
        found.append((shaded(triangles_of(Bar(start, end, radius))), BLUE))
    return found


def _camera() -> FloatArray:
    """Return the directions to the right, up and towards the camera, as rows."""
    azimuth, elevation = np.radians([AZIMUTH_DEG, ELEVATION_DEG])
    towards = [
        np.cos(azimuth) * np.cos(elevation),
        np.sin(azimuth) * np.cos(elevation),
        np.sin(elevation),
    ]
    right = [-np.sin(azimuth), np.cos(azimuth), 0.0]
    return frozen([right, np.cross(towards, right), towards])


def _on_screen(corners: FloatArray) -> FloatArray:
    """Return corners in pixels, all within the picture; nearness in pixels, too."""
    flat = corners.reshape(-1, 3)
    low, high = flat.min(axis=0), flat.max(axis=0)
    size = np.array([WIDTH, HEIGHT]) * FINER
    scale = ((1 - 2 * MARGIN) * size / (high - low)[:2]).min()
    middle = (low + high) / 2
    moved = (corners - middle) * scale
    return frozen(moved * [1, -1, 1] + [*(size - 1) / 2, 0])


def _units(normals: FloatArray) -> FloatArray:
    lengths = np.linalg.norm(normals, axis=2, keepdims=True)
    return normals / np.where(lengths > 0, lengths, 1)


def _edges(depth: FloatArray, owner: IntArray, units: FloatArray) -> FloatArray:
    """Tell at which pixels one piece ends before another, or a surface turns."""
    edges = np.zeros(owner.shape, dtype=bool)
    step = NEARER * WIDTH * FINER
    limit = np.cos(np.radians(CREASE_DEG))
    for axis in range(2):
        one = tuple(slice(None, -1) if each == axis else slice(None) for each in range(2))
        other = tuple(slice(1, None) if each == axis else slice(None) for each in range(2))
        turned = (units[one] * units[other]).sum(axis=2) < limit
        with np.errstate(invalid="ignore"):
            apart = np.abs(depth[one] - depth[other]) > step
        both = (owner[one] != NOTHING) & (owner[other] != NOTHING)
        found = (owner[one] != owner[other]) | (both & (turned | apart))
        edges[one] |= found & (owner[one] != NOTHING)
        edges[other] |= found & (owner[other] != NOTHING)
    return edges
