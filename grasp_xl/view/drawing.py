"""A design as a 2-D drawing: plan view in millimetres, a layer for each sort of thing."""

from __future__ import annotations

import io
from typing import Any

import numpy as np
from ezdxf import colors, filemanagement, units
from ezdxf.enums import TextEntityAlignment
from shapely import MultiPolygon, Polygon, affinity, box

from grasp_xl.fitment.cover import plan_of
from grasp_xl.fitment.part import rings_of
from grasp_xl.space import FloatArray
from grasp_xl.view.assembly import ELEMENT_COLOURS, MAIN_COLOUR, MARK, PART_COLOUR
from grasp_xl.view.scene import Scene
from grasp_xl.view.solids import Bar, Block
from grasp_xl.workbook.styles import BLUE, GREEN

VERSION = "R2010"
PART, PLACES = "PART", ("CUP_PLACES", "MAGNET_PLACES")
ELEMENTS, LABELS = ("CUPS", "MAGNETS"), "LABELS"
MAIN_TRUSS, BRANCHES = "MAIN_TRUSS", "BRANCHES"
PART_POLYGON, IDEAL_POLYGON, CENTRES = "PART_POLYGON", "IDEAL_POLYGON", "CENTRES"
LAYERS = {  # without a colour, black or white: whatever the ground is not
    PART: PART_COLOUR,
    PART_POLYGON: GREEN,
    IDEAL_POLYGON: BLUE,
    **dict(zip(PLACES, ELEMENT_COLOURS, strict=True)),
    **dict(zip(ELEMENTS, ELEMENT_COLOURS, strict=True)),
    MAIN_TRUSS: MAIN_COLOUR,
    BRANCHES: MAIN_COLOUR,
    CENTRES: "",
    LABELS: "",
}
MAIN_WIDTH, BRANCH_WIDTH = 70, 35
"""Widths of lines (0.01 mm)."""
TEXT, CROSS = 0.35, 0.3
"""Height of texts and half length of crosses, as a part of the largest element."""


def drawing_of(scene: Scene) -> bytes:
    """Return the shown design as a DXF file."""
    drawing = filemanagement.new(VERSION, units=units.MM)
    drawing.header.custom_vars.append("Program", MARK)
    for name, colour in LAYERS.items():
        layer = drawing.layers.add(name)
        if colour:
            layer.rgb = colors.RGB.from_hex(colour)
    drawing.layers.get(MAIN_TRUSS).dxf.lineweight = MAIN_WIDTH
    drawing.layers.get(BRANCHES).dxf.lineweight = BRANCH_WIDTH
    _draw(scene, drawing.modelspace())
    text = io.StringIO()
    drawing.write(text)
    return text.getvalue().encode("utf-8")


def _draw(scene: Scene, paper: Any) -> None:  # noqa: ANN401 (ezdxf's layout)
    space, grip = scene.task.space, scene.grip(scene.shown)
    size = max(model.size_mm for model in scene.models)
    for ring in rings_of(_plan(scene)):
        _closed(paper, ring, PART)
    _closed(paper, space.approximation_polygon_mm, PART_POLYGON)
    _closed(paper, space.ideal_polygon_mm, IDEAL_POLYGON)
    for kind, layer in zip(space.kinds, PLACES, strict=True):
        for place in kind.footprints_mm.tolist():
            paper.add_point(place[:2], dxfattribs={"layer": layer})
    for each in grip.elements:
        middle = each.place_mm[:2].tolist()
        outlines = _outlines(scene, each.kind, middle)
        for ring in outlines:
            _closed(paper, ring, ELEMENTS[each.kind])
        if not outlines:
            radius = scene.models[each.kind].size_mm / 2
            paper.add_circle(middle, radius, dxfattribs={"layer": ELEMENTS[each.kind]})
        _label(paper, str(each.index), middle, TEXT * size)
    for bars, layer in ((grip.frame.main, MAIN_TRUSS), (grip.frame.branches, BRANCHES)):
        for bar in bars:
            _line(paper, bar, layer)
    for name, point in (
        ("centroid", space.part.centroid_mm),
        ("centre of force", grip.grasp.centre_of_force_mm),
    ):
        _cross(paper, point[:2], CROSS * size)
        above = [point[0], point[1] + (CROSS + TEXT) * size * (1 if name == "centroid" else -1)]
        _label(paper, name, above, TEXT * size)


def _plan(scene: Scene) -> Polygon | MultiPolygon:
    """Return the part as seen from above."""
    if scene.part.solid:
        return plan_of(scene.part.solid.mesh)
    pieces = [piece for plate in scene.part.plates for piece in _polygons(plate.area)]
    return MultiPolygon(pieces)


def _polygons(area: Polygon | MultiPolygon) -> list[Polygon]:
    return [area] if isinstance(area, Polygon) else list(area.geoms)


def _outlines(scene: Scene, kind: int, middle: list[float]) -> list[FloatArray]:
    """Return the outlines of an element that is not round."""
    found = []
    for solid in scene.models[kind].solids:
        if isinstance(solid, Block):
            half = solid.length_mm / 2, solid.width_mm / 2
            flat = box(-half[0], -half[1], *half)
            turned = affinity.rotate(flat, solid.angle_deg, origin=(0, 0))
            found += list(rings_of(affinity.translate(turned, *middle)))
    return found


def _closed(paper: Any, ring: FloatArray, layer: str) -> None:  # noqa: ANN401
    corners = np.asarray(ring)[:, :2].tolist()
    paper.add_lwpolyline(corners, close=True, dxfattribs={"layer": layer})


def _line(paper: Any, bar: Bar, layer: str) -> None:  # noqa: ANN401
    ends = bar.start_mm[:2].tolist(), bar.end_mm[:2].tolist()
    paper.add_line(*ends, dxfattribs={"layer": layer})


def _cross(paper: Any, point: FloatArray, half: float) -> None:  # noqa: ANN401
    x, y = point.tolist()
    attributes = {"layer": CENTRES}
    paper.add_line((x - half, y), (x + half, y), dxfattribs=attributes)
    paper.add_line((x, y - half), (x, y + half), dxfattribs=attributes)


def _label(paper: Any, text: str, place: list[float], height: float) -> None:  # noqa: ANN401
    words = paper.add_text(text, height=height, dxfattribs={"layer": LABELS})
    words.set_placement(place, align=TextEntityAlignment.MIDDLE_CENTER)
