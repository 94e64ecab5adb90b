"""Solids from STEP files: level faces with their true normals, what is reached, volume, units."""

from __future__ import annotations

import math
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import shapely
from shapely import Point, box
from solids import (
    block,
    cut,
    cylinder,
    free_form,
    fused,
    mirrored,
    surface,
    together,
    turned,
    write_step,
)

from grasp_xl.errors import GraspError, InputError
from grasp_xl.fitment.caps import SAG_MM
from grasp_xl.fitment.orientation import rotation
from grasp_xl.fitment.part import CadPart
from grasp_xl.fitment.part_file import APPROACH_MM
from grasp_xl.fitment.step_file import read_step
from grasp_xl.fitment.words import AXES


def read(path: Path, **options: Any) -> CadPart:
    """Read a part that looks up along z."""
    return read_step(path, **{"up": "+z", "part": None, "approach_mm": APPROACH_MM, **options})


def problem(path: Path, **options: Any) -> str:
    """Return what is told of a file that is refused."""
    with pytest.raises(InputError) as caught:
        read(path, **options)
    (told,) = caught.value.problems
    return str(told)


@pytest.fixture
def step(tmp_path: Path) -> Any:
    """Write a solid."""
    return lambda shape, **options: write_step(tmp_path / "part.step", shape, **options)


PLATE = cut(block(0, 0, 0, 200, 100, 5), cylinder(60, 50, -1, 15, 10))


def test_a_plate_with_a_hole(step: Any) -> None:
    """Face, volume and centroid by hand; the hole's chords stray by the sag at most."""
    part = read(step(PLATE))
    (face,) = part.faces
    area = 200 * 100 - math.pi * 15**2
    assert face.height_mm == pytest.approx(5)
    assert face.outline.area == pytest.approx(area, abs=2 * math.pi * 15 * SAG_MM)
    assert part.volume_mm3 == pytest.approx(5 * area)
    assert part.centroid_mm == pytest.approx([(2e4 * 100 - math.pi * 225 * 60) / area, 50, 2.5])
    (hole,) = face.outline.interiors
    assert Point(60, 50).distance(hole) >= 15 - 1e-5  # no element stands over the true edge
    assert Point(60, 50).hausdorff_distance(hole) <= 15 + SAG_MM
    assert part.plan.symmetric_difference(face.outline).area < 20
    assert part.notes == ()


def test_the_volume_of_a_solid_of_splines_is_that_of_the_same_solid_without(step: Any) -> None:
    """A disc whose wall is a spline surface: by hand, to a hundred-thousandth, as is its centroid."""
    part = read(step(fused(block(-30, -30, 0, 60, 60, 5), free_form(cylinder(0, 0, 5, 20, 30)))))
    block_mm3, disc_mm3 = 60 * 60 * 5, math.pi * 20**2 * 30
    assert part.volume_mm3 == pytest.approx(block_mm3 + disc_mm3, rel=1e-5)
    z_mm = (block_mm3 * 2.5 + disc_mm3 * 20) / (block_mm3 + disc_mm3)
    assert part.centroid_mm == pytest.approx([0, 0, z_mm], abs=1e-4)


@pytest.mark.parametrize("x_mm", [-1e12, 1e12])
def test_a_part_far_from_the_origin_is_refused(step: Any, x_mm: float) -> None:
    """Its places could not be exact."""
    told = problem(step(block(x_mm, 0, 0, 100, 100, 5)))
    assert "reaches 1e+12 mm from the origin, expected 1e+06 mm at most" in told


def test_a_file_that_says_no_unit_of_length_is_read_in_millimetres_with_a_note(step: Any) -> None:
    """The unit is never guessed in silence."""
    path = step(PLATE)
    text = path.read_text()
    for unit, none in (("UNCERTAINTY", ""), ("UNIT", "PARAMETRIC_REPRESENTATION_CONTEXT()")):
        text = re.sub(rf"GLOBAL_{unit}_ASSIGNED_CONTEXT\s*\(\([^)]*\)\)", none, text)
    path.write_text(re.sub(r"#\d+ = [^;]*LENGTH_(UNIT|MEASURE)[^;]*;", "", text))
    part = read(path)
    (note,) = part.notes
    assert part.plan.bounds == pytest.approx((0, 0, 200, 100))
    assert "no unit of length" in str(note)


def test_faces_at_several_heights_are_numbered_from_the_highest(step: Any) -> None:
    """A step and two islands of one height: three faces, by height and then by x."""
    base = block(0, 0, 0, 300, 100, 5)
    islands = (block(10, 20, 5, 40, 40, 20), block(200, 20, 5, 50, 40, 20))
    part = read(step(fused(base, *islands)))
    assert [face.height_mm for face in part.faces] == pytest.approx([25, 25, 5])
    assert [face.outline.area for face in part.faces] == pytest.approx([2000, 1600, 30000 - 3600])
    assert part.faces[0].outline.equals_exact(box(200, 20, 250, 60), 1e-6, normalize=True)
    assert len(part.faces[2].outline.interiors) == 2


def test_flat_faces_that_are_splines_by_name_are_flat(step: Any) -> None:
    """A plate all of whose surfaces are splines has the face of the same plate without."""
    (one,), (other,) = read(step(free_form(PLATE))).faces, read(step(PLATE)).faces
    assert one.outline.symmetric_difference(other.outline).area < 5  # other chords
    assert one.height_mm == pytest.approx(other.height_mm)


def test_a_curved_seam_is_no_edge(step: Any) -> None:
    """A round post of the height of the plate around it, with a circle between them, is one face."""
    plate, post = (
        cut(block(0, 0, 0, 200, 100, 5), cylinder(60, 50, -1, 15, 10)),
        cylinder(60, 50, -3, 15, 8),
    )
    (face,) = read(step(fused(plate, post))).faces
    assert face.outline.area == pytest.approx(2e4, abs=0.1)


def test_a_leaning_face_with_a_seam_is_one_and_is_noted(step: Any) -> None:
    """Its places stand at its mean height: 0.3 degrees are 0.52 mm over a half of 100 mm."""
    halves = fused(block(0, 0, 0, 100, 200, 5), block(100, 0, -5, 100, 200, 10))
    part = read(step(turned(halves, (0, 1, 0), 0.3)))
    (face,) = part.faces
    assert face.outline.area == pytest.approx(4e4, rel=1e-4)
    assert face.height_mm == pytest.approx(5 - 100 * math.sin(math.radians(0.3)), abs=0.02)
    (note,) = part.notes
    assert "up to 0.52 mm off" in note.found


def test_faces_under_a_far_roof_are_noted(step: Any) -> None:
    """They count as reachable, as --approach says, but not in silence."""
    hollow = cut(block(0, 0, 0, 200, 200, 200), block(5, 5, 5, 190, 190, 190))
    part = read(step(hollow))
    assert [face.height_mm for face in part.faces] == pytest.approx([200, 5])
    (note,) = part.notes
    assert "36,100 mm2 of the faces under material more than 100 mm above" in note.found
    assert len(read(step(hollow), approach_mm=300).faces) == 1


def test_surfaces_beside_a_solid_are_noted(step: Any) -> None:
    """They are left out."""
    (note,) = read(step(together(PLATE, surface(50)))).notes
    assert "1 surfaces beside the solids" in note.found


def test_a_tiny_part_is_told_to_be_tiny(step: Any) -> None:
    """And not to lean."""
    assert "all of them smaller than 1 mm2" in problem(step(block(0, 0, 0, 0.3, 0.3, 0.1)))


def test_seams_between_coplanar_faces_are_no_edges(step: Any) -> None:
    """Two blocks joined, whose tops stay two faces in the file, are one face here."""
    part = read(step(fused(block(0, 0, 0, 100, 50, 5), block(100, 0, 0, 80, 30, 5))))
    (face,) = part.faces
    assert face.outline.area == pytest.approx(5000 + 2400)
    assert not list(face.outline.interiors)
    corners = shapely.MultiPoint(shapely.get_coordinates(face.outline.simplify(1e-4)))
    expected = shapely.MultiPoint([(0, 0), (180, 0), (180, 30), (100, 30), (100, 50), (0, 50)])
    assert corners.hausdorff_distance(expected) < 1e-4


def test_what_lies_under_a_flange_is_left_out(step: Any) -> None:
    """Wholly or in part, with a note; more room than the approach counts as free."""
    base = block(0, 0, 0, 200, 100, 5)
    post, roof = block(0, 0, 5, 10, 100, 40), block(0, 0, 45, 120, 100, 5)
    path = step(fused(base, post, roof))
    part = read(path)
    top, low = part.faces
    assert top.height_mm == pytest.approx(50)
    assert low.outline.area == pytest.approx(80 * 100, abs=1)
    (note,) = part.notes
    assert "11,000 of 19,000 mm2 of the face at z 5" in note.found
    assert read(path, approach_mm=39).faces[1].outline.area == pytest.approx(19_000)
    covered = fused(base, post, block(0, 0, 45, 200, 100, 5))
    assert [face.height_mm for face in read(step(covered)).faces] == pytest.approx([50])


def test_a_boss_or_a_countersink_hides_nothing_beside_it(step: Any) -> None:
    """Walls that stand upright or lean outwards do not cover the face at their foot."""
    boss = fused(PLATE, cylinder(150, 50, 5, 10, 30))
    part = read(step(boss))
    assert part.notes == ()
    assert part.faces[1].outline.area == pytest.approx(2e4 - math.pi * 325, abs=10)


@pytest.mark.parametrize(
    "change", [mirrored, lambda shape: shape.Reversed()], ids=["mirror", "inside-out"]
)
def test_left_handed_frames_and_reversed_solids_look_the_same_way(step: Any, change: Any) -> None:
    """Mirrored, or with all faces turned inside out: the same faces look up."""
    stepped = fused(block(0, 0, 0, 100, 60, 5), block(0, 0, 5, 30, 60, 10))
    part, plain = read(step(change(stepped))), read(step(stepped))
    assert [face.height_mm for face in part.faces] == pytest.approx([15, 5])
    assert part.volume_mm3 == pytest.approx(plain.volume_mm3)
    for one, other in zip(part.faces, plain.faces, strict=True):
        assert one.outline.area == pytest.approx(other.outline.area)


@pytest.mark.parametrize("unit", ["INCH", "M", "CM"])
def test_files_in_other_units_are_read_in_mm(step: Any, unit: str) -> None:
    """The same plate, whatever the file's unit."""
    part = read(step(PLATE, unit=unit))
    assert part.volume_mm3 == pytest.approx(5 * (2e4 - math.pi * 225), rel=1e-6)
    assert part.plan.bounds == pytest.approx((0, 0, 200, 100), abs=1e-3)


def test_a_face_that_leans_is_level_up_to_half_a_degree(step: Any) -> None:
    """Beyond, the part is refused with how far it leans, and how it may be turned."""
    assert len(read(step(turned(PLATE, (0, 1, 0), 0.4))).faces) == 1
    told = problem(step(turned(PLATE, (1, 1, 0), 1)))
    assert "the nearest leans by 1 degrees" in told
    assert "0.5 at most" in told


@pytest.mark.parametrize("up", AXES)
def test_any_axis_of_the_file_may_look_up(step: Any, up: str) -> None:
    """A stepped part, turned in its file: the same faces, no mirror image."""
    stepped = fused(block(0, 0, 0, 100, 60, 5), block(0, 0, 5, 30, 20, 10))
    turns = {
        "+z": ((1, 0, 0), 0),
        "-z": ((1, 0, 0), 180),
        "+y": ((1, 0, 0), -90),
        "-y": ((1, 0, 0), 90),
        "+x": ((0, 1, 0), 90),
        "-x": ((0, 1, 0), -90),
    }
    part = read(step(turned(stepped, *turns[up])), up=up)
    assert [round(face.outline.area) for face in part.faces] == [600, 5400]
    assert part.faces[0].height_mm - part.faces[1].height_mm == pytest.approx(10)
    assert np.linalg.det(rotation(up)) == pytest.approx(1)
    assert rotation(up)[2].tolist() == [float(up[0] + "1") * (axis == up[1]) for axis in "xyz"]


def test_a_hint_names_the_axes_along_which_faces_look(step: Any) -> None:
    """A wedge has no level top, but upright sides."""
    leaning = cut(
        block(0, 0, 0, 100, 60, 30), turned(block(-200, -10, 20, 500, 100, 100), (0, 1, 0), 10)
    )
    told = problem(step(leaning))
    assert "no flat face that looks along +z" in told
    assert "--up=" in told


def test_several_solids_are_listed_and_one_is_named(step: Any) -> None:
    """The largest first."""
    path = step(together(block(0, 0, 0, 10, 10, 10), block(100, 0, 0, 20, 20, 20)))
    told = problem(path)
    assert "2 solids (1: 8 cm3 about 110, 10, 10; 2: 1 cm3 about 5, 5, 5)" in told
    assert read(path, part=2).volume_mm3 == pytest.approx(1000)
    assert "expected a solid 3" in problem(path, part=3)


def test_surfaces_have_no_mass(step: Any) -> None:
    """A surface model is refused, though its volume could be computed."""
    assert "1 surfaces and no solid" in problem(step(surface(100)))


@pytest.mark.parametrize(
    ("content", "told"),
    [
        (b"", "an empty file"),
        (b"hello", "a file that is no STEP file"),
        (b"ISO-10303-21;\nHEADER;\nENDSEC;\n", "a STEP file that breaks off"),
        (b"ISO-10303-21;\nHEADER;\nENDSEC;\nEND-ISO-10303-21;\n", "cannot read"),
        (b"ISO-10303-21;\nrubbish;;\nEND-ISO-10303-21;\n", "cannot read"),
    ],
    ids=["empty", "text", "cut off", "no data", "rubbish"],
)
def test_what_is_no_step_file_is_told(tmp_path: Path, content: bytes, told: str) -> None:
    """In one sentence, and nothing else is printed."""
    path = tmp_path / "part.step"
    path.write_bytes(content)
    assert told in problem(path)


def test_a_damaged_file_is_told_before_the_library_crashes(step: Any) -> None:
    """A reference to nothing, or to an entity of another kind, is a fault of the file."""
    path = step(PLATE)
    text = path.read_text(encoding="utf-8")
    for wrong in (
        re.sub(r"(ADVANCED_FACE\('',\(#\d+\),#)\d+", r"\g<1>999999", text, count=1),
        re.sub(r"(VERTEX_POINT\('',#)\d+", r"\g<1>1", text, count=1),
    ):
        assert wrong != text
        path.write_text(wrong, encoding="utf-8")
        assert "that OpenCASCADE cannot read (" in problem(path)


def test_nothing_is_printed_by_the_library(tmp_path: Path) -> None:
    """Standard output is the program's: a broken file must not spoil its JSON."""
    path = tmp_path / "part.step"
    path.write_bytes(b"ISO-10303-21;\nrubbish;;\nEND-ISO-10303-21;\n")
    command = [sys.executable, "-m", "grasp_xl", "fit", str(path), "--list-faces", "--quiet"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)  # noqa: S603
    assert (done.returncode, done.stdout) == (3, "")


def test_other_commands_do_not_load_the_library() -> None:
    """OpenCASCADE takes a second to load and 400 MB of disk: only STEP files need it."""
    code = "import sys, grasp_xl.cli.program, grasp_xl.commands.fit; print('OCP' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)  # noqa: S603
    assert done.stdout.strip() == "False"


def test_without_the_library_the_message_says_what_to_install(
    step: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    """In one sentence."""
    path = step(PLATE)
    monkeypatch.setitem(sys.modules, "grasp_xl.fitment.occ", None)
    with pytest.raises(GraspError, match="STEP files need OpenCASCADE") as caught:
        read(path)
    assert 'pip install "grasp_xl[cad]"' in caught.value.hint
