"""The command ``view``: designs of a workbook as models, drawing, bill, and data of the page."""

from __future__ import annotations

import base64
import csv
import io
import json
import shutil
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import ezdxf
import numpy as np
import openpyxl
import pytest
import shapely
from npm import node
from OCP.collections import Sequence_TDF_Label
from OCP.Quantity import Quantity_Color, Quantity_TOC_sRGB
from OCP.STEPCAFControl import STEPCAFControl_Reader
from OCP.TCollection import TCollection_ExtendedString
from OCP.TDataStd import TDataStd_Name
from OCP.TDocStd import TDocStd_Document
from OCP.XCAFApp import XCAFApp_Application
from OCP.XCAFDoc import XCAFDoc_ColorSurf, XCAFDoc_DocumentTool, XCAFDoc_ShapeTool

from grasp_xl.bill import bill_of
from grasp_xl.cli.program import main
from grasp_xl.commands.view import Viewed, Wish, scene_of
from grasp_xl.errors import UsageError
from grasp_xl.fitment.occ import read_solids
from grasp_xl.view.drawing import LAYERS
from grasp_xl.view.element_model import HEIGHT
from grasp_xl.view.frame import RISE
from grasp_xl.view.gltf_file import gltf_of
from grasp_xl.view.meshes import SECTIONS, indexed, shaded, triangles_of
from grasp_xl.view.page import scene_data
from grasp_xl.view.pasted import pasted_grasp
from grasp_xl.view.solids import Bar, Block, Plate, Turned
from grasp_xl.workbook.book import read_book
from grasp_xl.workbook.writing import export_workbook

WORKBOOKS = Path(__file__).parents[1] / "workbooks"
RESULT = WORKBOOKS / "bracket-result.xlsx"
HOSTILE = "<script>alert(1)</script>"
CUP = ("--cup", "10.01.01.10716", "--cup-price", "10")


def viewed(path: Path = RESULT, **wish: Any) -> Viewed:
    """Return what is shown of a workbook."""
    usual = {
        "design": None,
        "grasp": (None, None),
        "genes": None,
        "part": None,
        "catalogue": None,
    }
    return scene_of(Wish(path, **{**usual, **wish}))


def view(path: Path, output: Path, *words: str) -> int:
    """Show a workbook in a file."""
    return main(["view", str(path), "-o", str(output), *words])


@pytest.fixture
def alone(tmp_path: Path) -> Path:
    """Copy a result to where its part's file is not."""
    return Path(shutil.copy(RESULT, tmp_path / "alone.xlsx"))


# --- which designs, and which grasp ---


def test_the_designs_of_a_workbook_are_all_there() -> None:
    """The proved optimum first; then the best of the run, the benchmark, and each valid design."""
    scene = viewed().scene
    run = read_book(RESULT).shown_run()
    assert run is not None
    keys = [design.key for design in scene.designs]
    assert keys[:3] == ["proved", "best", "benchmark"]
    assert keys[3:] == [f"valid-{number}" for number in range(1, 1 + len(run.state.designs))]
    assert scene.shown.key == "proved"
    assert np.array_equal(scene.designs[-1].chromosome.genes, run.state.designs.genes[-1])


def test_a_design_is_named_by_its_key() -> None:
    """One that is not there is refused with those that are."""
    assert viewed(design="valid-2").scene.shown.key == "valid-2"
    with pytest.raises(UsageError, match="expected one of proved, best, benchmark, valid-1 to"):
        viewed(design="trade-off-1")


def test_trade_offs_are_designs(tmp_path: Path) -> None:
    """With what they are the optimum of, and whether that is proved."""
    book = tmp_path / "front.xlsx"
    words = ["--grid", "1", "--time-limit", "5", "--quiet"]
    assert main(["front", str(WORKBOOKS / "bracket.xlsx"), "-o", str(book), *words]) == 0
    scene = viewed(book, design="trade-off-1").scene
    names = [design.name for design in scene.designs if design.key.startswith("trade-off-")]
    assert len(names) > 3
    assert any(name.endswith("100 % cost (proved)") for name in names)


@pytest.mark.parametrize(
    "text",
    [
        "1\t15\t1\t1\t1\t1\n3\t39\t50\t66\t1\t1",
        "1 15 / 3 39 50 66",
        "1;15;1;1;1;1;3;39;50;66;1;1",
        " 1, 15\n\n3, 39, 50, 66 \n",
    ],
)
def test_pasted_rows_are_the_grasp_that_they_say(text: str) -> None:
    """Rows of a count and indices, or one row of both; what parts the numbers does not matter."""
    grasp = pasted_grasp(text, viewed().scene.task.space, "--genes")
    assert grasp.active == ((15,), (39, 50, 66))


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("1 15 3", "found 1 row of genes, expected 2"),
        ("1 15 / 3 39 50", "found 3 magnets and 2 indices"),
        ("1 15 / 2 39 39", "one magnets index more than once"),
        ("1 999 / 1 3", "suction index 999 where 1 to 28 are known"),
        ("1 x / 1 3", "found 'x' as a gene, expected whole numbers"),
        ("1 -5 / 1 3", "found '-5' as a gene"),
        ("9 1 2 3 4 5 6 7 8 9 / 1 3", "9 suction where 1 to 5 may be"),
        ("", "found 0 rows of genes"),
    ],
)
def test_rows_that_are_no_grasp_are_told(text: str, told: str) -> None:
    """In a sentence, with an example."""
    with pytest.raises(UsageError) as caught:
        pasted_grasp(text, viewed().scene.task.space, "--genes")
    assert told in caught.value.message
    assert "For example --genes" in caught.value.hint


def test_a_given_grasp_is_shown_without_a_run() -> None:
    """By indices or as rows, of a workbook that holds no run; not both."""
    book = WORKBOOKS / "bracket.xlsx"
    by_index = viewed(book, grasp=((1, 9), (3,))).scene
    by_rows = viewed(book, genes="2 1 9 / 1 3").scene
    assert by_index.shown.key == by_rows.shown.key == "given"
    assert by_index.shown.chromosome == by_rows.shown.chromosome
    with pytest.raises(UsageError, match="Both --genes and --cups"):
        viewed(book, grasp=((1,), (3,)), genes="2 1 9 / 1 3")


# --- the part ---


def test_the_part_is_the_solid_beside_the_workbook(alone: Path) -> None:
    """Without the file its faces are shown, and a warning says where it should be."""
    solid = viewed().scene.part.solid
    assert solid is not None
    assert viewed().warnings == ()
    part, warnings = viewed(alone).scene.part, viewed(alone).warnings
    assert part.solid is None
    assert [plate.high_mm - plate.low_mm for plate in part.plates] == [0.0] * len(part.plates)
    record = read_book(RESULT).part
    assert record is not None
    areas = [outline.area_mm2 for outline in record.outlines if outline.number]
    assert [plate.area.area for plate in part.plates] == pytest.approx(areas, rel=1e-3)
    assert "put bracket.step beside the workbook" in warnings[0].hint
    named = viewed(alone, part=WORKBOOKS / "bracket.step")
    assert named.scene.part.solid is not None
    assert named.warnings == ()


def test_another_part_is_noticed(alone: Path) -> None:
    """By the hash of its file."""
    (warning,) = viewed(alone, part=WORKBOOKS / "door_frame.step").warnings
    assert "another file than the one that was fitted" in warning.found


def test_the_plate_of_a_drawing_needs_no_file(tmp_path: Path) -> None:
    """Its outline and thickness are in the workbook: its volume is the drawing's."""
    export = tmp_path / "tray.xlsx"
    drawing = str(WORKBOOKS / "tray.dxf")
    assert main(["fit", drawing, "-o", str(export), *CUP, "--thickness", "2", "--quiet"]) == 0
    found = viewed(export)
    (plate,) = found.scene.part.plates
    triangles = triangles_of(plate)
    volume = float((triangles[:, 0] * np.cross(triangles[:, 1], triangles[:, 2])).sum() / 6)
    assert found.scene.part.notes == ()
    assert volume == pytest.approx(234_045, rel=1e-3)


def test_an_export_of_another_program_shows_its_polygon(tmp_path: Path) -> None:
    """Which is all that it says of the part."""
    book = tmp_path / "export.xlsx"
    source = read_book(RESULT)
    book.write_bytes(export_workbook(source.space).content)
    (plate,) = viewed(book).scene.part.plates
    assert plate.area.area == pytest.approx(360 * 220)


# --- shapes ---


@pytest.mark.parametrize(
    ("solid", "volume"),
    [
        (Turned(np.array([[0, 0], [10, 0], [10, 20], [0, 20]])), np.pi * 100 * 20),
        (Block(40, 20, 30, 5, 15), 40 * 20 * 10),
        (Plate(shapely.box(0, 0, 40, 30).difference(shapely.box(5, 5, 15, 15)), 2, 5), 1100 * 3),
        (Bar(np.array([0, 0, 0]), np.array([30, 40, 0]), 5), np.pi * 25 * 50),
    ],
)
def test_triangles_enclose_the_solid(solid: Any, volume: float) -> None:
    """Each edge belongs to two triangles that run it opposite ways; the volume is that by hand."""
    triangles = triangles_of(solid)
    inside = float((triangles[:, 0] * np.cross(triangles[:, 1], triangles[:, 2])).sum() / 6)
    circle = SECTIONS / 2 / np.pi * np.sin(2 * np.pi / SECTIONS)
    factor = circle if isinstance(solid, Turned | Bar) else 1.0
    assert inside == pytest.approx(volume * factor, rel=1e-9)
    _, numbers = indexed(triangles)
    edges = np.concatenate([numbers[:, [a, b]] for a, b in ((0, 1), (1, 2), (2, 0))])
    assert sorted(map(tuple, edges)) == sorted(map(tuple, edges[:, ::-1]))


def test_normals_turn_on_a_cylinder_and_not_over_its_edges() -> None:
    """Round the side they are radial; on the ends they stand upright."""
    shape = shaded(triangles_of(Turned(np.array([[0, 0], [10, 0], [10, 20], [0, 20]]))))
    side = np.abs(shape.normals[:, 2]) < 1e-6
    radial = shape.places_mm[side, :2] / np.linalg.norm(shape.places_mm[side, :2], axis=1)[:, None]
    assert (shape.normals[side, :2] * radial).sum(axis=1) == pytest.approx(1, abs=1e-3)
    assert np.abs(shape.normals[~side, 2]) == pytest.approx(1)


def test_elements_stand_on_their_places_under_a_frame() -> None:
    """By eq. 7: the bars' plan-view lengths are the structure; all lie over the highest element."""
    scene = viewed().scene
    grip = scene.grip(scene.shown)
    space, ratio = scene.task.space, scene.task.rules.requirements.density_ratio
    for element in grip.elements:
        place = space.kinds[element.kind].footprints_mm[element.index - 1]
        assert np.array_equal(element.place_mm, place)
    (main_truss,) = grip.frame.main
    length = np.linalg.norm(main_truss.end_mm - main_truss.start_mm)
    branches = sum(np.linalg.norm(bar.end_mm - bar.start_mm) for bar in grip.frame.branches)
    assert ratio * length + branches == pytest.approx(grip.grasp.terms.structure)
    tops = [each.place_mm[2] + HEIGHT * scene.models[each.kind].size_mm for each in grip.elements]
    assert main_truss.start_mm[2] == pytest.approx(max(tops) + RISE * 46)
    for post, top in zip(grip.frame.posts, tops, strict=True):
        assert (post.start_mm[2], post.end_mm[2]) == pytest.approx((top, main_truss.start_mm[2]))


def test_an_element_that_is_not_round_has_its_sides_and_angle(tmp_path: Path) -> None:
    """As the catalogue says and as it was fitted."""
    own, export = tmp_path / "own.csv", tmp_path / "tray.xlsx"
    own.write_text("model,kind,force_n,length_mm,width_mm,price\nLong,magnet,100,60,20,5\n")
    words = [
        "--magnet",
        "Long",
        "--magnet-angle",
        "30",
        "--catalogue",
        str(own),
        "--thickness",
        "2",
    ]
    assert main(["fit", str(WORKBOOKS / "tray.dxf"), "-o", str(export), *words, "--quiet"]) == 0
    block, _ = viewed(export, catalogue=own).scene.models[1].solids
    assert isinstance(block, Block)
    assert (block.length_mm, block.width_mm, block.angle_deg) == (60, 20, 30)


# --- files ---


def labels(path: Path) -> dict[str, str]:
    """Return the names of an assembly's parts with their colours, read by the CAD kernel."""
    document = TDocStd_Document(TCollection_ExtendedString("MDTV-XCAF"))
    XCAFApp_Application.GetApplication_s().NewDocument(
        TCollection_ExtendedString("MDTV-XCAF"), document
    )
    reader = STEPCAFControl_Reader()
    reader.SetNameMode(True)  # noqa: FBT003 (its one parameter)
    reader.SetColorMode(True)  # noqa: FBT003 (its one parameter)
    reader.ReadFile(str(path))
    assert reader.Transfer(document)
    colours = XCAFDoc_DocumentTool.ColorTool_s(document.Main())
    found, sequence = {}, Sequence_TDF_Label()
    XCAFDoc_DocumentTool.ShapeTool_s(document.Main()).GetShapes(sequence)
    for number in range(1, 1 + sequence.Length()):
        label, name, colour = sequence.Value(number), TDataStd_Name(), Quantity_Color()
        if not XCAFDoc_ShapeTool.IsAssembly_s(label) and label.FindAttribute(
            TDataStd_Name.GetID_s(), name
        ):
            colours.GetColor(XCAFDoc_ShapeTool.GetShape_s(label), XCAFDoc_ColorSurf, colour)
            shown = [round(255 * each) for each in colour.Values(Quantity_TOC_sRGB)]
            found[name.Get().ToExtString()] = "#{:02X}{:02X}{:02X}".format(*shown)
    return found


def test_the_step_assembly_reads_back(tmp_path: Path) -> None:
    """Count, volumes and centroids of its solids, names and colours of its parts."""
    path = tmp_path / "grasp.step"
    assert view(RESULT, path, "--quiet") == 0
    solids, loose = read_solids(path)
    scene = viewed().scene
    grip = scene.grip(scene.shown)
    assert loose == 0
    bars = [*grip.frame.main, *grip.frame.branches, *grip.frame.posts]
    assert len(solids) == 1 + len(grip.elements) + len(bars)
    assert scene.part.solid is not None
    assert solids[0].volume_mm3 == pytest.approx(scene.part.solid.solid.volume_mm3)
    assert solids[0].centroid_mm == pytest.approx(scene.part.solid.centroid_mm, abs=1e-6)
    for bar in bars:
        volume = np.pi * bar.radius_mm**2 * np.linalg.norm(bar.end_mm - bar.start_mm)
        middle = (bar.start_mm + bar.end_mm) / 2
        near = [each for each in solids if np.allclose(each.centroid_mm, middle, atol=1e-6)]
        assert any(each.volume_mm3 == pytest.approx(volume) for each in near)
    for element in grip.elements:
        over = [
            each
            for each in solids
            if np.allclose(each.centroid_mm[:2], element.place_mm[:2], atol=1e-6)
        ]
        low = min(each.centroid_mm[2] for each in over)
        assert element.place_mm[2] < low < element.place_mm[2] + 23
    names = labels(path)
    assert names["SAF 40 NBR-60 M10-AG, index 15"] == "#00A0B0"
    assert names["SGM-HP 30 G1/8-IG, index 39"] == "#C2187A"
    assert {"bracket.step", "Main truss", "Branch 1", "Post 4"} <= set(names)


def test_the_glb_file_is_valid_and_in_metres_with_y_up(tmp_path: Path) -> None:
    """By Khronos's own validator; its nodes have names, and its bounds are the assembly's."""
    path = tmp_path / "grasp.glb"
    assert view(RESULT, path, "--quiet") == 0
    script = Path(__file__).with_name("validate_gltf.js")
    report = json.loads(node("gltf-validator", str(script), str(path)))
    issues = report["issues"]
    assert (issues["numErrors"], issues["numWarnings"]) == (0, 0)
    content = path.read_bytes()
    tree = json.loads(content[20 : 20 + int.from_bytes(content[12:16], "little")])
    names = {node["name"] for node in tree["nodes"]}
    assert {"Grasp", "Part", "Frame", "bracket.step", "SGM-HP 30 G1/8-IG, index 39"} <= names
    heights = [
        (tree["accessors"][primitive["attributes"]["POSITION"]]["max"][2])
        for mesh in tree["meshes"]
        for primitive in mesh["primitives"]
    ]
    scene = viewed().scene
    top = scene.grip(scene.shown).frame.main[0].start_mm[2] + scene.sizes.main_radius_mm
    assert max(heights) == pytest.approx(top, abs=1e-3)  # mm in the mesh; nodes scale and turn
    matrices = {node["name"]: node["matrix"] for node in tree["nodes"] if "matrix" in node}
    assert matrices == {"Grasp": [0.001, 0, 0, 0, 0, 0, -0.001, 0, 0, 0.001, 0, 0, 0, 0, 0, 1]}


def test_the_drawing_is_sound_and_to_scale(tmp_path: Path) -> None:
    """By the library's audit; elements are circles of their diameter at their places, in mm."""
    path = tmp_path / "grasp.dxf"
    assert view(RESULT, path, "--quiet") == 0
    drawing = ezdxf.readfile(path)
    assert not drawing.audit().errors
    assert drawing.units == ezdxf.units.MM
    paper = drawing.modelspace()
    assert {entity.dxf.layer for entity in paper} == set(LAYERS)
    scene = viewed().scene
    circles = {
        (entity.dxf.layer, *np.round(entity.dxf.center.vec2, 6), entity.dxf.radius)
        for entity in paper.query("CIRCLE")
    }
    assert circles == {
        (("CUPS", "MAGNETS")[each.kind], *np.round(each.place_mm[:2], 6), (23, 15)[each.kind])
        for each in scene.grip(scene.shown).elements
    }
    assert {entity.dxf.text for entity in paper.query("TEXT")} >= {"15", "39", "50", "66"}


def test_the_bill_counts_what_the_grasp_has(tmp_path: Path) -> None:
    """Its sums are the grasp's cost and number; a weight that is not known is left empty."""
    path = tmp_path / "bill.csv"
    assert view(RESULT, path, "--quiet") == 0
    rows = list(csv.reader(io.StringIO(path.read_text(encoding="utf-8-sig"))))
    scene = viewed().scene
    grasp = scene.grasp(scene.shown)
    assert [row[2] for row in rows[1:]] == ["1", "3", "4"]
    assert float(rows[-1][4]) == grasp.terms.cost
    assert [row[5] for row in rows[1:]] == [""] * 3
    lines = bill_of(scene.task.space, grasp)
    assert sum(line.price for line in lines) == grasp.terms.cost


def test_the_page_is_given_the_numbers_of_the_engine() -> None:
    """Genes, places and cards of each design, exactly."""
    scene = viewed().scene
    data = json.loads(json.dumps(scene_data(scene), allow_nan=False))
    for given, design in zip(data["designs"], scene.designs, strict=True):
        grasp = scene.grasp(design)
        assert given["genes"] == design.chromosome.rows()
        assert given["card"]["moment"] == grasp.terms.moment
        assert given["card"]["divergence"] == grasp.divergence
    for given, kind in zip(data["kinds"], scene.task.space.kinds, strict=True):
        places = np.frombuffer(base64.b64decode(given["footprints_mm"]), "<f8").reshape(-1, 3)
        assert np.array_equal(places, kind.footprints_mm)


def test_without_the_cad_kernel_all_but_step_is_written(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """The page, .glb, .dxf and .csv from the workbook alone; .step says what to install."""
    for name in [name for name in sys.modules if name.split(".")[0] == "OCP"]:
        monkeypatch.delitem(sys.modules, name)
    for name in ("grasp_xl.fitment.occ", "grasp_xl.view.step_assembly"):
        monkeypatch.delitem(sys.modules, name, raising=False)
    monkeypatch.setitem(sys.modules, "OCP", None)
    for suffix in (".html", ".glb", ".dxf", ".csv"):
        assert view(RESULT, tmp_path / f"grasp{suffix}", "--quiet") == 0
    assert view(RESULT, tmp_path / "grasp.step") == 1
    assert 'pip install "grasp_xl[cad]"' in capsys.readouterr().err
    assert not (tmp_path / "grasp.step").exists()


@pytest.mark.parametrize("suffix", [".html", ".step", ".glb", ".dxf", ".csv"])
def test_a_file_of_somebody_else_is_not_replaced(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], suffix: str
) -> None:
    """As the part's own STEP file beside the workbook; ours is, and theirs with --force."""
    path = tmp_path / f"part{suffix}"
    path.write_text("theirs")
    words = ("--quiet", "--cups", "15", "--magnets", "39,50,66")
    assert view(RESULT, path, *words) == 3
    assert "did not write it" in capsys.readouterr().err
    assert path.read_text() == "theirs"
    assert view(RESULT, path, *words, "--force") == 0
    assert view(RESULT, path, *words) == 0


def test_hostile_names_are_text_everywhere(tmp_path: Path) -> None:
    """A model that is a script or a formula comes back letter by letter, and runs nowhere."""
    own, export = tmp_path / "own.csv", tmp_path / "tray.xlsx"
    own.write_text(f'model,kind,force_n,diameter_mm,price\n"=cmd {HOSTILE}",cup,50,30,5\n')
    words = ["--cup", f"=cmd {HOSTILE}", "--catalogue", str(own), "--thickness", "2", "--quiet"]
    assert main(["fit", str(WORKBOOKS / "tray.dxf"), "-o", str(export), *words]) == 0
    scene = viewed(export, grasp=((1, 2), None)).scene
    for suffix in (".html", ".step", ".glb", ".dxf", ".csv"):
        path = tmp_path / f"hostile{suffix}"
        assert view(export, path, "--cups", "1,2", "--quiet") == 0
    assert HOSTILE.encode() not in (tmp_path / "hostile.html").read_bytes()
    assert any(HOSTILE in name for name in labels(tmp_path / "hostile.step"))
    assert HOSTILE.encode() in gltf_of(scene)
    bill = (tmp_path / "hostile.csv").read_text(encoding="utf-8-sig")
    assert f"'=cmd {HOSTILE}" in bill


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (("-o", "grasp.pdf"), "expected '.html' or '.step'"),
        (("-o", "grasp.html", "--cups", "999"), "--cups: found suction index 999"),
        (("-o", "grasp.html", "--part", "none.step"), "none.step: found no such file"),
        (("-o", "grasp.html", "--part", str(WORKBOOKS / "tray.dxf")), "needs no file"),
        (("-o", "none/grasp.html"), "does not exist"),
        (("-o", "grasp.html", "--genes", "x"), "--genes: found"),
    ],
)
def test_what_cannot_be_is_told_in_a_sentence(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    words: tuple[str, ...],
    told: str,
) -> None:
    """And nothing is written."""
    monkeypatch.chdir(tmp_path)
    assert main(["view", str(RESULT), *words]) in (2, 3)
    assert told in capsys.readouterr().err.replace("\n", " ")
    assert not list(tmp_path.iterdir())


# --- what people do to files ---


def test_the_parts_own_file_is_never_replaced(
    alone: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Not even with --force: neither the one beside the workbook nor one that was named."""
    step = Path(shutil.copy(WORKBOOKS / "bracket.step", alone.parent))
    content = step.read_bytes()
    for words in ((), ("--part", str(step))):
        assert view(alone, step, *words, "--force") == 2
        assert "is the part's own file" in capsys.readouterr().err
    assert step.read_bytes() == content


@pytest.mark.parametrize(
    ("cell", "value"), [("D5", -4.5), ("E5", 1e300), ("I4", "x"), ("J4", None)]
)
def test_an_edited_sheet_of_the_part_is_left_out(
    alone: Path, cell: str, value: object, capsys: pytest.CaptureFixture[str]
) -> None:
    """With a warning; the part polygon stands for the part."""
    book = openpyxl.load_workbook(alone)
    book["Part"][cell] = value
    book.save(alone)
    assert view(alone, alone.with_suffix(".glb")) == 0
    assert "a list that was edited" in capsys.readouterr().err.replace("\n", " ")


def test_a_cut_sheet_of_the_part_is_left_out(
    alone: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A face without its corners has no outline."""
    book = openpyxl.load_workbook(alone)
    book["Part"].delete_rows(30, 1000)
    book.save(alone)
    assert view(alone, alone.with_suffix(".glb")) == 0
    assert "a list that was edited" in capsys.readouterr().err.replace("\n", " ")


def test_a_run_that_was_edited_is_told(alone: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Its designs are not shown, and a warning says so."""
    book = openpyxl.load_workbook(alone)
    book["Valid Designs"]["D9"] = 99999
    book.save(alone)
    assert view(alone, alone.with_suffix(".csv")) == 0
    assert "a run whose lists were edited" in capsys.readouterr().err.replace("\n", " ")


def test_a_grasp_is_shown_also_where_none_is_feasible(tmp_path: Path) -> None:
    """As evaluate judges it."""
    book = tmp_path / "heavy.xlsx"
    source = read_book(RESULT)
    heavy = replace(source.space, part=replace(source.space.part, mass_g=1e6))
    book.write_bytes(export_workbook(heavy).content)
    words = ("--cups", "1,9", "--magnets", "3")
    assert view(book, tmp_path / "grasp.glb", *words, "--quiet") == 0
    assert main(["evaluate", str(book), *words, "--quiet"]) == 0
    assert view(book, tmp_path / "none.glb", "--quiet") == 4
    with pytest.raises(UsageError, match="Both --design and a grasp"):
        viewed(design="best", genes="1 15 / 3 39 50 66")


@pytest.mark.parametrize("name", ["Ø 40 吸盘", r"A\B", r"G1\S\8 it's", r"a\X2\00FC\X0\b"])
def test_names_that_are_not_plain_come_back_from_step(tmp_path: Path, name: str) -> None:
    """Written in ASCII as ISO 10303-21 has it, and read as they were."""
    own, export, step = (tmp_path / each for each in ("own.csv", "tray.xlsx", "grasp.step"))
    own.write_text(
        f'model,kind,force_n,diameter_mm,price\n"{name}",cup,50,30,5\n', encoding="utf-8"
    )
    words = ["--cup", name, "--catalogue", str(own), "--thickness", "2", "--quiet"]
    assert main(["fit", str(WORKBOOKS / "tray.dxf"), "-o", str(export), *words]) == 0
    assert view(export, step, "--cups", "1,2", "--quiet") == 0
    assert step.read_bytes().isascii()
    assert {f"{name}, index 1", f"{name}, index 2"} <= set(labels(step))
