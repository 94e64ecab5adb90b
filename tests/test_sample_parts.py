"""The sample parts are what their workbooks say: counts, footprints on the metal, fair grasps."""

from __future__ import annotations

import importlib.util
import sys
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest
import shapely

from grasp_xl.polygon import contains, is_star_shaped
from grasp_xl.space import FloatArray

GEOMETRY = Path(__file__).parents[1] / "workbooks" / "parts.py"


def load_geometry() -> ModuleType:
    """Import ``workbooks/parts.py`` by its path: ``workbooks`` is no package."""
    spec = importlib.util.spec_from_file_location("sample_part_geometry", GEOMETRY)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


geometry = load_geometry()
PARTS = {part.name: part for part in geometry.sample_parts()}
COUNTS = {
    "bracket": (28, 104),
    "door_frame": (228, 519),
    "panel": (487, 595),
    "tunnel_cover": (542, 847),
}
GRASPS = {"bracket": (4, 2), "door_frame": (2, 2), "panel": (3, 5), "tunnel_cover": (2, 2)}
SHEETS_MM = {"bracket": 10.0, "door_frame": 1.6, "panel": 3.0, "tunnel_cover": 2.5}

every_part = pytest.mark.parametrize("name", PARTS)


def on_faces(part: Any, footprints_mm: FloatArray) -> Iterator[tuple[Any, Any]]:
    """Split footprints by the face they are on: pairs of outline and points."""
    points = shapely.points(footprints_mm[:, :2])
    placed = 0
    for face in part.faces:
        mine = (footprints_mm[:, 2] == face.z_mm) & shapely.contains_properly(face.polygon, points)
        placed += int(mine.sum())
        yield face.polygon, points[mine]
    assert placed == len(footprints_mm)


def designer_points(part: Any) -> tuple[FloatArray, FloatArray]:
    """Points of the designer's grasp, ``(n, 3)`` (mm), and the force of each (N)."""
    chosen = (part.designer_suction, part.designer_magnets)
    points = [
        kind.footprints_mm[np.array(rows) - 1]
        for kind, rows in zip(part.space.kinds, chosen, strict=True)
    ]
    forces = np.repeat([kind.force_n for kind in part.space.kinds], [len(rows) for rows in chosen])
    return np.vstack(points), forces


@every_part
def test_counts_are_those_of_the_thesis_or_stay(name: str) -> None:
    """The first two parts have the footprint counts of P1 and P2; the others keep theirs."""
    assert tuple(kind.total for kind in PARTS[name].space.kinds) == COUNTS[name]


@every_part
def test_every_cup_lies_inside_its_face(name: str) -> None:
    """A cup's whole disc is on the metal, to 1e-6 mm."""
    part = PARTS[name]
    for outline, points in on_faces(part, part.space.kinds[0].footprints_mm):
        assert (shapely.distance(outline.boundary, points) >= 23.0 - 1e-6).all()


@every_part
def test_every_magnet_centre_is_strictly_inside_its_face(name: str) -> None:
    """A magnet may hang over an edge, but not its centre."""
    part = PARTS[name]
    for outline, points in on_faces(part, part.space.kinds[1].footprints_mm):
        assert (shapely.distance(outline.boundary, points) > 1e-6).all()


@every_part
def test_no_footprint_is_a_matter_of_rounding(name: str) -> None:
    """No grid point is so near a limit that another machine could decide otherwise."""
    part = PARTS[name]
    for face in part.faces:
        low_x, low_y, high_x, high_y = face.polygon.bounds
        grid = geometry.face_grid(face.polygon, part.pitch_mm)
        inner = grid[
            (np.abs(grid - [low_x, low_y]) > 1e-6).all(axis=1)
            & (np.abs(grid - [high_x, high_y]) > 1e-6).all(axis=1)
        ]
        edge = shapely.distance(face.polygon.boundary, shapely.points(inner))
        assert edge.min() > 0.02
        assert np.abs(edge - 23.0).min() > 0.02


@pytest.mark.parametrize(("length", "spacing"), [(360.0, 360 / 35), (220.0, 220 / 21)])
def test_grid_goes_from_edge_to_edge_in_the_thesis_spacing(length: float, spacing: float) -> None:
    """360 mm at pitch 10 gives 10.2857 mm, 220 mm gives 10.47619 mm."""
    line = geometry.grid_line(-length / 2, length / 2, 10.0)
    assert line[0] == length / 2
    assert line[-1] == -length / 2
    assert np.diff(line) == pytest.approx(-spacing, rel=1e-12)


def test_grid_of_the_bracket_is_that_of_figure_25() -> None:
    """The bracket's top face has the grid of the reference card: x = 180 - 360 i / 35."""
    first = PARTS["bracket"].space.kinds[1].footprints_mm[:4]
    assert first[:, 0] == pytest.approx(180 - 360 / 35)
    assert first[:, 1] == pytest.approx(110 - 220 / 21 * np.array([9, 10, 11, 12]))
    assert (first[:, 2] == 100.0).all()


def test_a_side_shorter_than_two_pitches_gets_one_point_in_the_middle() -> None:
    """A side with fewer than two points has one, centred."""
    assert geometry.grid_line(3.0, 22.9, 10.0).tolist() == [12.95]


@every_part
def test_footprints_are_numbered_face_by_face_by_descending_x_then_y(name: str) -> None:
    """Faces by descending height; on each, footprints by descending x, then descending y."""
    part = PARTS[name]
    heights = [face.z_mm for face in part.faces]
    assert heights == sorted(heights, reverse=True)
    for kind in part.space.kinds:
        rows = iter(kind.footprints_mm.tolist())
        for _, points in on_faces(part, kind.footprints_mm):
            mine = [tuple(next(rows)[:2]) for _ in points]
            assert mine == sorted(mine, reverse=True)
            assert set(mine) == {(point.x, point.y) for point in points}


@pytest.mark.parametrize("name", ["bracket", "panel", "tunnel_cover"])
def test_symmetric_parts_are_mirror_images_of_themselves_exactly(name: str) -> None:
    """Left and right differ in no bit."""
    space = PARTS[name].space
    assert space.part.centroid_mm[0] == 0.0
    for kind in space.kinds:
        places = {tuple(row) for row in kind.footprints_mm.tolist()}
        assert {(-x, y, z) for x, y, z in places} == places


@every_part
def test_designer_grasp_is_feasible(name: str) -> None:
    """The designer's grasp has the thesis's counts, FoS 3 and a clearance of 46 mm."""
    part = PARTS[name]
    points, forces = designer_points(part)
    assert (len(part.designer_suction), len(part.designer_magnets)) == GRASPS[name]
    assert forces.sum() / part.space.part.weight_n >= 3.0
    gaps = np.linalg.norm(points[:, None, :2] - points[None, :, :2], axis=2)
    assert gaps[~np.eye(len(points), dtype=bool)].min() >= 46.0


@every_part
def test_designer_grasp_pulls_near_the_centroid(name: str) -> None:
    """In plan view the centre of force is within 20 mm of the centroid."""
    part = PARTS[name]
    points, forces = designer_points(part)
    offset = forces @ points / forces.sum() - part.space.part.centroid_mm
    assert np.hypot(*offset[:2]) < 20.0


@every_part
def test_mass_follows_from_the_geometry(name: str) -> None:
    """The thickness that gives the stated mass is the nominal sheet."""
    assert PARTS[name].thickness_mm == pytest.approx(SHEETS_MM[name], abs=0.01)


def test_designer_factors_of_safety_are_those_of_tables_4_and_5() -> None:
    """Benchmarks of P1 and P2, and (3, 5) on 27 kg."""
    fos = {}
    for name, part in PARTS.items():
        _, forces = designer_points(part)
        fos[name] = round(forces.sum() / part.space.part.weight_n, 2)
    assert (fos["bracket"], fos["door_frame"], fos["panel"]) == (3.96, 4.58, 3.24)


@every_part
def test_centroid_is_inside_and_only_the_tunnel_cover_is_not_star_shaped(name: str) -> None:
    """The fourth part is the one that earns the star-shape warning."""
    space = PARTS[name].space
    polygon, centroid = space.approximation_polygon_mm, space.part.centroid_mm
    assert contains(polygon, centroid)
    assert is_star_shaped(polygon, centroid) == (name != "tunnel_cover")
