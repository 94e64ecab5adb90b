"""The sample parts are what their files say: solids, counts, footprints on the metal, fair grasps."""

from __future__ import annotations

import dataclasses
import doctest
import re
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import figures
import numpy as np
import pytest
import shapely
from make import make_step
from parts import SAMPLE_PARTS, SamplePart
from shapely import Polygon

from grasp_xl.commands.fit import fit_file
from grasp_xl.fitment.grid import grid
from grasp_xl.fitment.material import MATERIALS
from grasp_xl.fitment.part import CadPart, Face
from grasp_xl.polygon import contains, is_star_shaped
from grasp_xl.space import FloatArray, OptionSpace
from grasp_xl.workbook.book import Book, read_book

WORKBOOKS = Path(__file__).parents[1] / "workbooks"
PARTS = {part.name: part for part in SAMPLE_PARTS}
COUNTS = {
    "bracket": (28, 104),
    "door_frame": (228, 519),
    "panel": (487, 595),
    "tunnel_cover": (542, 847),
}
GRASPS = {"bracket": (4, 2), "door_frame": (2, 2), "panel": (3, 5), "tunnel_cover": (2, 2)}
SIZES_MM = {
    "bracket": (400, 220),
    "door_frame": (1100, 800),
    "panel": (1400, 900),
    "tunnel_cover": (900, 560),
}
HEIGHTS_MM = {
    "bracket": [100, *4 * [94], 80, *4 * [10]],
    "door_frame": [24, 24, 24, 18, 18, 18, 12, 12, 8, 0],
    "panel": [15, 0],
    "tunnel_cover": [60, 0, -40, -40],
}
GRIPPED = {"bracket": 1, "door_frame": 9, "panel": 2, "tunnel_cover": 2}
MAX_STEP_BYTES = 400_000
NUMBER = re.compile(r"-?\d+\.\d*(?:E[+-]?\d+)?")

every_part = pytest.mark.parametrize("name", PARTS)


@dataclass(frozen=True)
class Sample:
    """A part, what was read of its STEP file, and the exported sheet that was fitted on it."""

    part: SamplePart
    cad: CadPart
    faces: tuple[Face, ...]
    space: OptionSpace
    export: Book
    grasp: tuple[tuple[int, ...], tuple[int, ...]]


@cache
def sample(name: str) -> Sample:
    """Fit the elements on a part, from its STEP file in the repository."""
    part = PARTS[name]
    with tempfile.TemporaryDirectory() as folder:
        export = Path(folder) / "export.xlsx"
        done = fit_file(part.request(WORKBOOKS / f"{name}.step"), export, force=True)
        book = read_book(export)
    fitted = done.fitted
    assert fitted.cup_faces == fitted.magnet_faces
    grasp = part.designer_grasp(fitted.space)
    return Sample(part, done.part, fitted.cup_faces, fitted.space, book, grasp)


def assert_alike(one: Any, other: Any) -> None:
    """Compare two values: all that is in them, numbers but for a round-off of another machine."""
    if dataclasses.is_dataclass(one):
        one, other = vars_of(one), vars_of(other)
    if isinstance(one, (list, tuple)):
        for ours, theirs in zip(one, other, strict=True):
            assert_alike(ours, theirs)
    elif isinstance(one, (float, np.ndarray)):
        np.testing.assert_allclose(one, other, rtol=1e-9, atol=1e-8)
    else:
        assert one == other


def vars_of(value: Any) -> list[Any]:
    """Return the values of a dataclass's fields."""
    return [getattr(value, field.name) for field in dataclasses.fields(value)]


def on_faces(one: Sample, footprints_mm: FloatArray) -> Iterator[tuple[Polygon, Any]]:
    """Split footprints by the face they are on: pairs of outline and points."""
    points = shapely.points(footprints_mm[:, :2])
    placed = 0
    for face in one.faces:
        level = footprints_mm[:, 2] == face.height_mm
        mine = level & shapely.contains_properly(face.outline, points)
        placed += int(mine.sum())
        yield face.outline, points[mine]
    assert placed == len(footprints_mm)


def designer_points(one: Sample) -> tuple[FloatArray, FloatArray]:
    """Points of the designer's grasp, ``(n, 3)`` (mm), and the force of each (N)."""
    pairs = list(zip(one.space.kinds, one.grasp, strict=True))
    points = [kind.footprints_mm[np.array(rows) - 1] for kind, rows in pairs]
    forces = [kind.force_n for kind, rows in pairs for _ in rows]
    return np.vstack(points), np.array(forces)


# --- the solids ---


@every_part
def test_the_step_file_is_what_the_script_models(name: str, tmp_path: Path) -> None:
    """Word for word, and number for number but for a round-off of another machine."""
    ours = (WORKBOOKS / f"{name}.step").read_text(encoding="ascii")
    made = make_step(PARTS[name], tmp_path).read_text(encoding="ascii")
    assert NUMBER.sub("#", ours).split() == NUMBER.sub("#", made).split()
    numbers = [np.array(NUMBER.findall(text), dtype=float) for text in (ours, made)]
    np.testing.assert_allclose(*numbers, atol=1e-9)
    assert len(ours) < MAX_STEP_BYTES


@every_part
def test_a_solid_that_is_modelled_again_gives_the_same_file(name: str, tmp_path: Path) -> None:
    """Nothing in it depends on the time, the computer, or what was modelled before."""
    contents = [make_step(PARTS[name], tmp_path).read_bytes() for _ in range(2)]
    assert contents[0] == contents[1]


@every_part
def test_a_part_has_its_size_and_faces(name: str) -> None:
    """The first two parts have the sizes of P1 and P2; faces lie at the modelled heights."""
    cad = sample(name).cad
    x_low, y_low, x_high, y_high = cad.plan.bounds
    assert (x_high - x_low, y_high - y_low) == pytest.approx(SIZES_MM[name], abs=1e-6)
    assert [face.height_mm for face in cad.faces] == HEIGHTS_MM[name]
    assert len(sample(name).faces) == GRIPPED[name]


@every_part
def test_mass_is_that_of_the_solid_in_steel(name: str) -> None:
    """The mass that is given is that of the sheet, to 0.2 %."""
    mass_g = sample(name).cad.volume_mm3 * MATERIALS["steel"].density_g_cm3 / 1000
    assert PARTS[name].mass_g == pytest.approx(mass_g, rel=2e-3)


def test_top_face_of_the_bracket_lies_on_a_grid_of_360_by_220() -> None:
    """It is one face, in the size of the thesis's figure 25."""
    assert sample("bracket").faces[0].outline.bounds == pytest.approx((-180, -110, 180, 110))


def test_examples_of_the_figures_hold() -> None:
    """Every example in their docstrings gives what it says."""
    assert doctest.testmod(figures).failed == 0


# --- the workbooks ---


@every_part
@pytest.mark.parametrize("ending", ["", "-result"])
def test_workbooks_hold_what_is_fitted_on_the_solid(name: str, ending: str) -> None:
    """Option space and sheet Part are those of the STEP file, and the designer's grasp is in it."""
    one, book = sample(name), read_book(WORKBOOKS / f"{name}{ending}.xlsx")
    assert_alike(book.space, one.export.space)
    assert_alike(book.part, one.export.part)
    assert book.user_chromosome is not None
    assert book.user_chromosome.active == one.grasp


@every_part
def test_counts_are_those_of_the_thesis_or_stay(name: str) -> None:
    """The first two parts have the footprint counts of P1 and P2; the others keep theirs."""
    assert tuple(kind.total for kind in sample(name).space.kinds) == COUNTS[name]


@every_part
def test_every_cup_lies_inside_its_face(name: str) -> None:
    """A cup's whole disc is on the metal, to 1e-6 mm."""
    one = sample(name)
    for outline, points in on_faces(one, one.space.kinds[0].footprints_mm):
        assert (shapely.distance(outline.boundary, points) >= 23.0 - 1e-6).all()


@every_part
def test_every_magnet_centre_is_strictly_inside_its_face(name: str) -> None:
    """A magnet may hang over an edge, but not its centre."""
    one = sample(name)
    for outline, points in on_faces(one, one.space.kinds[1].footprints_mm):
        assert (shapely.distance(outline.boundary, points) > 1e-6).all()


@every_part
def test_no_footprint_is_a_matter_of_rounding(name: str) -> None:
    """No grid point is so near a limit that another machine could decide otherwise."""
    one = sample(name)
    for face in one.faces:
        low_x, low_y, high_x, high_y = face.outline.bounds
        points = grid(face.outline, one.part.pitch_mm)
        inner = points[
            (np.abs(points - [low_x, low_y]) > 1e-6).all(axis=1)
            & (np.abs(points - [high_x, high_y]) > 1e-6).all(axis=1)
        ]
        edge = shapely.distance(face.outline.boundary, shapely.points(inner))
        assert edge.min() > 0.02
        assert np.abs(edge - 23.0).min() > 0.02


def test_grid_of_the_bracket_is_that_of_figure_25() -> None:
    """The bracket's top face has the grid of the reference card: x = 180 - 360 i / 35."""
    first = sample("bracket").space.kinds[1].footprints_mm[:4]
    assert first[:, 0] == pytest.approx(180 - 360 / 35)
    assert first[:, 1] == pytest.approx(110 - 220 / 21 * np.array([9, 10, 11, 12]))
    assert (first[:, 2] == 100.0).all()


@every_part
def test_footprints_are_numbered_face_by_face_by_descending_x_then_y(name: str) -> None:
    """Faces by descending height; on each, footprints by descending x, then descending y."""
    one = sample(name)
    heights = [face.height_mm for face in one.faces]
    assert heights == sorted(heights, reverse=True)
    for kind in one.space.kinds:
        rows = iter(kind.footprints_mm.tolist())
        for _, points in on_faces(one, kind.footprints_mm):
            mine = [tuple(next(rows)[:2]) for _ in points]
            assert mine == sorted(mine, reverse=True)
            assert set(mine) == {(point.x, point.y) for point in points}


@pytest.mark.parametrize("name", ["bracket", "panel", "tunnel_cover"])
def test_symmetric_parts_are_mirror_images_of_themselves_exactly(name: str) -> None:
    """Left and right differ in no bit."""
    space = sample(name).space
    assert space.part.centroid_mm[0] == 0.0
    for kind in space.kinds:
        places = {tuple(row) for row in kind.footprints_mm.tolist()}
        assert {(-x, y, z) for x, y, z in places} == places


@every_part
def test_designer_grasp_is_feasible(name: str) -> None:
    """The designer's grasp has the thesis's counts, FoS 3 and a clearance of 46 mm."""
    one = sample(name)
    points, forces = designer_points(one)
    assert tuple(map(len, one.grasp)) == GRASPS[name]
    assert forces.sum() / one.space.part.weight_n >= 3.0
    gaps = np.linalg.norm(points[:, None, :2] - points[None, :, :2], axis=2)
    assert gaps[~np.eye(len(points), dtype=bool)].min() >= 46.0


@every_part
def test_designer_grasp_pulls_near_the_centroid(name: str) -> None:
    """In plan view the centre of force is within 20 mm of the centroid."""
    one = sample(name)
    points, forces = designer_points(one)
    offset = forces @ points / forces.sum() - one.space.part.centroid_mm
    assert np.hypot(*offset[:2]) < 20.0


def test_designer_factors_of_safety_are_those_of_tables_4_and_5() -> None:
    """Benchmarks of P1 and P2, and (3, 5) on 27 kg."""
    fos = {}
    for name in PARTS:
        _, forces = designer_points(sample(name))
        fos[name] = round(forces.sum() / sample(name).space.part.weight_n, 2)
    assert (fos["bracket"], fos["door_frame"], fos["panel"]) == (3.96, 4.58, 3.24)


@every_part
def test_centroid_is_inside_and_only_the_tunnel_cover_is_not_star_shaped(name: str) -> None:
    """The fourth part is the one that earns the star-shape warning."""
    space = sample(name).space
    polygon, centroid = space.approximation_polygon_mm, space.part.centroid_mm
    assert contains(polygon, centroid)
    assert is_star_shaped(polygon, centroid) == (name != "tunnel_cover")
