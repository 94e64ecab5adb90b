"""The command ``fit``: from a file of CAD to the exported sheet that the other commands read."""

from __future__ import annotations

import hashlib
import json
from pathlib import Path
from typing import Any

import pytest
from solids import block, cut, cylinder, fused, write_step

from grasp_xl.cli.program import main
from grasp_xl.fitment.words import AXES, UNITS
from grasp_xl.workbook.book import read_book
from grasp_xl.workbook.part_sheet import WHOLE

TRAY = Path(__file__).parents[1] / "workbooks" / "tray.dxf"
CUP = ("--cup", "10.01.01.10716", "--cup-price", "10")
MAGNET = ("--magnet", "sgm-hp 30 G1/8-IG", "--magnet-price", "30")
DRAWING = ("--thickness", "2")


@pytest.fixture(scope="module")
def part(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Write a bent part: a plate with a hole, and a raised field on it."""
    plate = cut(block(0, 0, 0, 300, 200, 3), cylinder(230, 100, -1, 20, 10))
    path = tmp_path_factory.mktemp("part") / "bent.step"
    return write_step(path, fused(plate, block(0, 0, 3, 120, 200, 12)))


def fitted(path: Path, output: Path, *words: str) -> int:
    """Fit elements."""
    return main(["fit", str(path), "-o", str(output), *words])


def test_a_part_goes_all_the_way_to_a_proved_grasp(part: Path, tmp_path: Path) -> None:
    """The exported sheet has mass, centroid, places, models and polygon; every command takes it."""
    export, book = tmp_path / "export.xlsx", tmp_path / "book.xlsx"
    assert fitted(part, export, *CUP, *MAGNET, "--pitch", "20") == 0
    read = read_book(export)
    space = read.space
    volume = 300 * 200 * 3 - 3.141592653589793 * 400 * 3 + 120 * 200 * 12
    assert space.part.mass_g == pytest.approx(volume * 7.85e-3)
    cups, magnets = space.kinds
    assert (cups.model, cups.diameter_mm, cups.price) == ("SAF 40 NBR-60 M10-AG", 46, 10)
    assert (magnets.force_n, magnets.diameter_mm, magnets.price) == (130, 30, 30)
    assert set(cups.footprints_mm[:, 2]) == {15.0, 3.0}
    assert magnets.overlap is not None
    assert 0.2 < magnets.overlap.min() < magnets.overlap.max() == 1
    assert read.warnings == ()
    assert main(["run", str(export), "-o", str(book), "--generations", "500", "--quiet"]) == 0
    record = read_book(book).part
    assert record is not None
    facts = dict(record.facts)
    assert facts["SHA-256"] == hashlib.sha256(part.read_bytes()).hexdigest()
    assert facts["Source file"] == "bent.step"
    whole, *faces = record.outlines
    assert (whole.number, whole.area_mm2) == (WHOLE, pytest.approx(60_000 - 400 * 3.1416, rel=1e-3))
    assert [(face.height_mm, face.used_for) for face in faces] == [
        (15, "suction, magnets"),
        (3, "suction, magnets"),
    ]


def test_the_same_part_gives_the_same_file(part: Path, tmp_path: Path) -> None:
    """Nothing in it depends on the time."""
    one, other = tmp_path / "one.xlsx", tmp_path / "other.xlsx"
    for path in (one, other):
        assert fitted(part, path, *CUP, "--quiet") == 0
    assert one.read_bytes() == other.read_bytes()


def test_faces_can_be_chosen_for_each_kind(part: Path, tmp_path: Path) -> None:
    """Cups on the raised field, magnets on what of all faces lies in a box."""
    path = tmp_path / "export.xlsx"
    words = ("--cup-faces", "top", "--magnet-faces", "100,0,200,100")
    assert fitted(part, path, *CUP, *MAGNET, *words) == 0
    cups, magnets = read_book(path).space.kinds
    assert set(cups.footprints_mm[:, 2]) == {15.0}
    assert magnets.footprints_mm[:, 0].min() > 100
    assert magnets.footprints_mm[:, :2].max() < 200


def test_one_kind_alone_leaves_no_place_for_the_other(tmp_path: Path) -> None:
    """The sheet is read, and grasps have cups only."""
    path = tmp_path / "export.xlsx"
    assert fitted(TRAY, path, *DRAWING, *CUP, "--material", "aluminium") == 0
    cups, magnets = read_book(path).space.kinds
    assert (cups.total > 100, magnets.total, magnets.count_max) == (True, 0, 0)
    solve = ["solve", str(path), "--fos", "10", "--quiet"]
    assert main(solve) == 0


def test_mass_density_polygon_and_counts_are_taken_over(tmp_path: Path) -> None:
    """As they were said."""
    path = tmp_path / "export.xlsx"
    words = ("--mass", "4321", "--polygon=100,50;-100,50;-100,-50;100,-50", "--scale", "0.5")
    assert fitted(TRAY, path, *DRAWING, *CUP, *words, "--cup-count", "0-7") == 0
    space = read_book(path).space
    assert space.part.mass_g == 4321
    assert space.scale_factor == 0.5
    assert sorted(map(abs, space.approximation_polygon_mm[:, 0])) == pytest.approx([100] * 4)
    assert (space.kinds[0].count_min, space.kinds[0].count_max) == (0, 7)
    assert fitted(TRAY, path, *DRAWING, *CUP, "--density", "1", "--force") == 0
    assert read_book(path).space.part.mass_g == pytest.approx(234.06, abs=0.01)


def test_a_catalogue_of_ones_own_gives_prices_weights_and_elements(tmp_path: Path) -> None:
    """A row of it is named like one that is shipped."""
    own, path = tmp_path / "own.csv", tmp_path / "export.xlsx"
    own.write_text(
        "model,kind,force_n,shape,diameter_mm,length_mm,width_mm,price,weight_g\n"
        "Ours,cup,50,round,30,,,7.5,12\nBar,magnet,90,rectangular,,60,20,9,80\n"
    )
    words = ("--catalogue", str(own), "--cup", "ours", "--magnet", "bar", "--magnet-angle", "90")
    assert fitted(TRAY, path, *DRAWING, *words) == 0
    cups, magnets = read_book(path).space.kinds
    assert (cups.price, cups.weight_g, cups.force_n) == (7.5, 12, 50)
    assert magnets.diameter_mm == pytest.approx((60**2 + 20**2) ** 0.5)


def test_faces_are_listed_and_drawn(
    part: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A table with their numbers, and a picture in which they stand."""
    picture = tmp_path / "faces.svg"
    assert main(["fit", str(part), "--list-faces", "--picture", str(picture)]) == 0
    told = capsys.readouterr().out
    assert "15" in told
    assert "24,000" in told
    drawn = picture.read_text(encoding="utf-8")
    assert drawn.startswith("<svg")
    assert ">1</text>" in drawn
    assert ">2</text>" in drawn
    assert main(["fit", str(part), "--list-faces", "--picture", str(picture), "--json"]) == 0
    faces = json.loads(capsys.readouterr().out)["faces"]
    assert [face["holes"] for face in faces] == [0, 1]


@pytest.mark.parametrize(
    ("words", "code", "told"),
    [
        ([], 2, "No file to write was named"),
        (["-o", "x.xlsx"], 2, "No element was chosen"),
        (["-o", "x.xlsx", *CUP[:2]], 2, "The price of 'SAF 40 NBR-60 M10-AG' is not known"),
        (["-o", "x.xlsx", "--cup", "SAF 99", "--cup-price", "1"], 2, "No element"),
        (["-o", "x.xlsx", "--cup", "SGM-HP 30", "--cup-price", "1"], 2, "is a magnet"),
        (["-o", "x.xlsx", *CUP, "--pitch", "0"], 2, "--pitch: found '0'"),
        (["-o", "x.xlsx", *CUP, "--pitch", "0.01"], 2, "grid points, more than"),
        (["-o", "x.xlsx", *CUP, "--up", "z"], 2, "--up: found 'z'"),
        (["-o", "x.xlsx", *CUP, "--units", "mm"], 2, "--units is for a DXF file"),
        (["-o", "x.xlsx", *CUP, "--cup-faces", "9"], 2, "the part has 2 faces"),
        (["-o", "x.xlsx", *CUP, "--polygon", "0,0;1,1"], 2, "--polygon: found"),
        (["-o", "x.xlsx", *CUP, "--polygon", "0,0;9,9;9,0;0,9"], 2, "crosses itself"),
        (["-o", "x.xlsx", *CUP, "--cup-count", "5-1"], 2, "--cup-count: found '5-1'"),
        (["-o", "x.xlsx", *CUP, "--scale", "1.5"], 2, "--scale: found '1.5'"),
        (["-o", "x.xlsx", *MAGNET, "--material", "aluminium"], 2, "Magnets do not hold aluminium"),
        (["-o", "x.xlsx", *CUP, "--material", "wood"], 2, "--material: found 'wood'"),
        (["-o", "x.txt", *CUP], 2, "a name that ends in '.txt'"),
        (["-o", "none/x.xlsx", *CUP], 3, "does not exist"),
        (["-o", "x.xlsx", *CUP, "--cup-faces", "0,0,30,30"], 3, "no place where a suction cup"),
        (["-o", "x.xlsx", *CUP, "--up", "+x", "--part", "2"], 3, "expected a solid 2"),
    ],
)
def test_what_cannot_be_is_told_in_a_sentence(
    part: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    words: list[str],
    code: int,
    told: str,
) -> None:
    """With what to do, and nothing is written."""
    monkeypatch.chdir(tmp_path)
    assert main(["fit", str(part), *words]) == code
    said = capsys.readouterr()
    assert told in said.err
    assert "Traceback" not in said.err
    assert not list(tmp_path.glob("x.*"))


def test_files_of_other_kinds_are_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """By their name's ending; a drawing needs a thickness and no axis."""
    for path, words, told in (
        (tmp_path / "part.iges", CUP, "found a name that ends in '.iges'"),
        (TRAY, CUP, "does not say how thick the sheet is"),
        (TRAY, (*CUP, *DRAWING, "--up=+z"), "--up is for a STEP file"),
        (tmp_path / "none.step", CUP, "no such file"),
    ):
        assert fitted(path, tmp_path / "x.xlsx", *words) in (2, 3)
        assert told in capsys.readouterr().err


@pytest.mark.parametrize(("words", "option"), [(AXES, "--up"), (UNITS, "--units")])
def test_words_of_options_are_those_of_the_fitment(
    words: Any, option: str, capsys: pytest.CaptureFixture[str]
) -> None:
    """A wrong one is told with all that there are."""
    assert main(["fit", "part.step", option, "up", "-o", "x.xlsx"]) == 2
    told = capsys.readouterr().err
    assert all(word in told for word in words)
