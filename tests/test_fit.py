"""The command ``fit``: from a file of CAD to the exported sheet that the other commands read."""

from __future__ import annotations

import hashlib
import json
import time
from pathlib import Path
from typing import Any

import ezdxf
import numpy as np
import openpyxl
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
        time.sleep(1.1)  # the times of files are whole seconds
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
    assert read_book(path).space.part.mass_g == pytest.approx(234.045, abs=0.001)


@pytest.mark.parametrize("kind", ["dxf", "step"])
def test_no_cup_or_magnet_stands_over_the_true_edge_of_a_hole(tmp_path: Path, kind: str) -> None:
    """By the circles themselves, and not by their chords: to a hundred-thousandth of a millimetre."""
    holes = [
        (40 + 61.3 * column, 35 + 53.7 * row, 4 + 3 * column)
        for row in range(3)
        for column in range(4)
    ]
    path, export = tmp_path / "holes.dxf", tmp_path / "export.xlsx"
    if kind == "dxf":
        drawing = ezdxf.new("R2010", units=4)
        drawing.modelspace().add_lwpolyline([(0, 0), (280, 0), (280, 180), (0, 180)], close=True)
        for x, y, radius in holes:
            drawing.modelspace().add_circle((x, y), radius)
        drawing.saveas(path)
    else:
        path = path.with_suffix(".step")
        drills = [cylinder(x, y, -1, radius, 5) for x, y, radius in holes]
        write_step(path, cut(block(0, 0, 0, 280, 180, 2), *drills))
    words = (
        (*DRAWING, *CUP, *MAGNET, "--pitch", "3")
        if kind == "dxf"
        else (*CUP, *MAGNET, "--pitch", "3")
    )
    assert fitted(path, export, *words) == 0
    cups, magnets = read_book(export).space.kinds
    for x, y, radius in holes:
        away = np.hypot(*(cups.footprints_mm[:, :2] - (x, y)).T)
        assert away.min() >= radius + 23 - 1e-5
        assert np.hypot(*(magnets.footprints_mm[:, :2] - (x, y)).T).min() >= radius - 1e-5
    assert cups.total > 300


def test_the_size_of_a_rectangular_element_is_its_sides(tmp_path: Path) -> None:
    """Also where its row has a diameter: no half of it hangs over an edge."""
    path, export = tmp_path / "own.csv", tmp_path / "export.xlsx"
    row = "Both,cup,50,20,60,30,rectangular,1"
    path.write_text(f"model,kind,force_n,diameter_mm,length_mm,width_mm,shape,price\n{row}\n")
    assert fitted(TRAY, export, *DRAWING, "--catalogue", str(path), "--cup", "Both") == 0
    cups = read_book(export).space.kinds[0]
    assert cups.footprints_mm[:, 0].max() <= 210 - 30 + 1e-6
    assert cups.diameter_mm == pytest.approx(np.hypot(60, 30))


def test_a_price_in_another_currency_is_not_taken_for_dollars(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """It has to be given; then it is taken."""
    path, export = tmp_path / "own.csv", tmp_path / "export.xlsx"
    path.write_text("model,kind,force_n,diameter_mm,price,currency\nEuro,cup,50,20,12.5,EUR\n")
    words = (*DRAWING, "--catalogue", str(path), "--cup", "Euro")
    assert fitted(TRAY, export, *words) == 2
    assert "is in 'EUR'" in capsys.readouterr().err
    assert fitted(TRAY, export, *words, "--cup-price", "14") == 0
    assert read_book(export).space.kinds[0].price == 14


def test_what_is_somebody_elses_is_not_replaced(
    part: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """An export that nobody touched is; a workbook, a text or a picture of others only with --force."""
    export, picture = tmp_path / "export.xlsx", tmp_path / "faces.svg"
    assert fitted(part, export, *CUP) == fitted(part, export, *CUP, "--pitch", "20") == 0
    book = openpyxl.load_workbook(export)
    book.create_sheet("Designer notes")
    book.save(export)
    theirs = export.read_bytes()
    assert fitted(part, export, *CUP) == 3
    assert "'Designer notes'" in capsys.readouterr().err
    assert export.read_bytes() == theirs
    assert fitted(part, export, *CUP, "--force") == 0
    listing = ["fit", str(part), "--list-faces", "--picture", str(picture)]
    assert main(listing) == main(listing) == 0
    picture.write_text("<svg/>")
    assert main(listing) == 3
    assert picture.read_text() == "<svg/>"
    assert main([*listing, "--force"]) == 0
    assert fitted(part, tmp_path / "export.xlsm", *CUP) == 2


def test_notes_of_the_part_are_told_when_it_cannot_be_fitted(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """They may say why: inches where the file has millimetres give very many places."""
    words = (*DRAWING, *CUP, "--units", "in", "--pitch", "1")
    assert fitted(TRAY, tmp_path / "export.xlsx", *words) == 2
    assert "Warning: " in (told := capsys.readouterr().err)
    assert "a drawing in mm, expected one in in" in told


def test_a_corner_that_is_said_twice_is_one(tmp_path: Path) -> None:
    """As the closing corner of a polygon often is."""
    export = tmp_path / "export.xlsx"
    words = ("--polygon=0,0;200,0;200,0;200,150;0,150;0,0",)
    assert fitted(TRAY, export, *DRAWING, *CUP, *words) == 0
    assert len(read_book(export).space.approximation_polygon_mm) == 4


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
