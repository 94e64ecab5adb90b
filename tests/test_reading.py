"""What a workbook says is read, wherever and however its program or its people wrote it."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np
import openpyxl
import pytest
from bad_workbooks import (
    CUPS,
    GA,
    MAGNETS,
    NO_CUPS,
    PLATE,
    SCALE,
    SHEET,
    Cells,
    Raw,
    Value,
    change_part,
    export_rows,
    ga_rows,
    number_text,
    polygon_rows,
    replaced,
    shifted,
    tiny_export,
    write_book,
)
from spaces import plate

from grasp_xl.errors import InputError
from grasp_xl.rules import Criterion
from grasp_xl.space import ElementKind, OptionSpace, frozen
from grasp_xl.task import Parameters
from grasp_xl.workbook import layout
from grasp_xl.workbook.book import Book, read_book
from grasp_xl.workbook.reading import open_source, read_option_space
from grasp_xl.workbook.writing import export_workbook


@pytest.fixture
def path(tmp_path: Path) -> Path:
    """A file to write to."""
    return tmp_path / "book.xlsx"


@pytest.fixture(scope="module")
def tiny_space(tmp_path_factory: pytest.TempPathFactory) -> OptionSpace:
    """The option space of the tiny export."""
    path = tmp_path_factory.mktemp("tiny") / "tiny.xlsx"
    tiny_export(path)
    return read_book(path).space


def read(path: Path, sheets: Mapping[str, Cells], names: Mapping[str, str] | None = None) -> Book:
    """Write sheets and read them, without a warning."""
    write_book(path, sheets, names)
    book = read_book(path)
    assert book.warnings == ()
    return book


def kind_values(kind: ElementKind) -> tuple[object, ...]:
    """Everything about a kind, as plain values."""
    return (
        kind.name,
        kind.force_n,
        kind.price,
        kind.count_min,
        kind.count_max,
        kind.footprints_mm.tolist(),
        kind.weight_g,
        kind.diameter_mm,
        kind.model,
    )


def space_values(space: OptionSpace) -> tuple[object, ...]:
    """Everything about an option space, as plain values."""
    return (
        space.part.mass_g,
        space.part.centroid_mm.tolist(),
        [kind_values(kind) for kind in space.kinds],
        space.approximation_polygon_mm.tolist(),
        space.scale_factor,
    )


# --- where it stands ---


def test_a_tiny_export_is_read(tiny_space: OptionSpace) -> None:
    """Each value of an export comes to its field."""
    cups, magnets = tiny_space.kinds
    assert tiny_space.part.mass_g == 8860
    assert tiny_space.part.centroid_mm.tolist() == [1.5, -0.8, 5.0]
    cup_values = ("suction", 69.0, 10.0, 1, 5, [list(cup) for cup in CUPS], 15.0, None, "")
    assert kind_values(cups) == cup_values
    magnet_values = ("magnets", 130.0, 30.0, 1, 5, [list(m) for m in MAGNETS], 110.0, None, "")
    assert kind_values(magnets) == magnet_values
    assert tiny_space.scale_factor == SCALE
    np.testing.assert_allclose(tiny_space.approximation_polygon_mm, PLATE, rtol=0, atol=1e-12)


LONG_TABLE: Cells = {f"{column}{row}": row for column in "AB" for row in range(1, 2000)}

ARRANGEMENTS: dict[str, dict[str, Cells]] = {
    "sheet_of_another_name": {"Export 7 (Ann's)": export_rows()},
    "sheets_before_it": {"Notes": {"A1": "by Ann"}, "Table": LONG_TABLE, SHEET: export_rows()},
    "sheets_behind_it": {SHEET: export_rows(), "Notes": {"B5": -1, "A5": "Part mass (g)"}},
    "rows_above": {SHEET: shifted(export_rows(), rows=30)},
    "columns_left": {SHEET: shifted(export_rows(), columns=4)},
    "rows_above_and_columns_left": {SHEET: shifted(export_rows(), rows=7, columns=30)},
    "gap_of_three_columns_before_the_index": {SHEET: shifted(export_rows(), columns=3, after=2)},
    "gap_of_three_columns_before_the_cups": {SHEET: shifted(export_rows(), columns=3, after=3)},
    "gap_of_three_columns_before_the_magnets": {SHEET: shifted(export_rows(), columns=3, after=6)},
    "gap_of_three_columns_before_the_polygon": {SHEET: shifted(export_rows(), columns=3, after=10)},
    "notes_in_free_places": {
        SHEET: export_rows() | {"A40": "Suction cups of 46 mm", "J2": "i", "T7": 3, "P1": "FoS"}
    },
}


@pytest.mark.parametrize("sheets", ARRANGEMENTS.values(), ids=ARRANGEMENTS)
def test_an_export_is_read_wherever_it_stands(
    sheets: dict[str, Cells], path: Path, tiny_space: OptionSpace
) -> None:
    """The sheet may have any name and company, and its blocks any free rows and columns around."""
    assert space_values(read(path, sheets).space) == space_values(tiny_space)


@pytest.mark.parametrize(
    "fold",
    [str.upper, str.lower, lambda text: f"  {text}\n ", lambda text: text.replace(" ", "\t \n")],
    ids=["upper", "lower", "around", "between"],
)
def test_case_and_white_space_of_labels_do_not_matter(
    fold: Callable[[str], str], path: Path, tiny_space: OptionSpace
) -> None:
    """Every label is found in other letters and with other white space, as if typed by hand."""
    labels = {cell: fold(v) for cell, v in export_rows().items() if isinstance(v, str)}
    ga_labels = {
        cell: fold(v) for cell, v in ga_rows().items() if isinstance(v, str) and cell[0] != "B"
    }
    book = read(path, {SHEET: export_rows() | labels, GA: ga_rows() | ga_labels})
    assert space_values(book.space) == space_values(tiny_space)
    assert book.parameters == GA_PARAMETERS
    assert book.user_chromosome is not None


# --- how the numbers are written ---


@pytest.mark.parametrize("text", ["8860", "8860.0", "8.86E3", "8.86e+03", "88600E-1", " 8860 "])
def test_a_number_is_read_however_it_is_written(text: str, path: Path) -> None:
    """Whole numbers, fractions and exponents of the file are the same numbers."""
    tiny_export(path, {"B5": number_text(text), "B11": number_text("2.0"), "D5": number_text("97")})
    space = read_book(path).space
    cups = space.kinds[0]
    assert (space.part.mass_g, cups.count_min, cups.footprints_mm[0, 0]) == (8860.0, 2, 97.0)
    assert (type(space.part.mass_g), type(cups.count_min)) == (float, int)
    assert cups.footprints_mm.dtype == np.float64


def test_arrays_that_were_read_cannot_be_changed(tiny_space: OptionSpace) -> None:
    """What is read is what stays: its arrays are read-only."""
    for array in (
        tiny_space.part.centroid_mm,
        tiny_space.approximation_polygon_mm,
        *(kind.footprints_mm for kind in tiny_space.kinds),
    ):
        assert not array.flags.writeable


# --- counts ---


def test_magnets_alone_are_an_option_space(path: Path) -> None:
    """A kind without footprints stays a kind, with 0 as Min. and Max."""
    tiny_export(path, NO_CUPS | {"B11": 0, "B12": 0})
    cups, magnets = read_book(path).space.kinds
    assert (cups.name, cups.total, cups.most) == ("suction", 0, 0)
    assert cups.footprints_mm.shape == (0, 3)
    assert magnets.total == 6


def test_lists_may_differ_in_length(path: Path) -> None:
    """The shorter list ends in blanks beside the longer one."""
    tiny_export(path, dict.fromkeys(("G9", "H9", "I9", "G10", "H10", "I10")) | {"B24": 4})
    assert [kind.total for kind in read_book(path).space.kinds] == [6, 4]


def test_more_than_five_elements_widen_the_chromosome(path: Path) -> None:
    """With a Max. of 8 a block has eight index columns, and all of them are read."""
    wide = {f"{column}8": f"Index {n}" for n, column in enumerate("FGHIJKLM", 1)}
    wide |= {f"{column}9": n for n, column in enumerate("FGHIJKLM", 1)} | {"E9": 6}
    book = read(
        path, {SHEET: export_rows() | {"B12": 8}, GA: ga_rows() | wide | {"L9": None, "M9": None}}
    )
    assert book.space.gene_slots == 8
    assert book.space.kinds[0].most == 6  # there are no more places
    assert book.user_chromosome is not None
    assert book.user_chromosome.genes.tolist() == [
        [6, 1, 2, 3, 4, 5, 6, 1, 1],
        [1, 3, 1, 1, 1, 1, 1, 1, 1],
    ]


# --- defined names ---


def test_names_win_over_labels(path: Path, tiny_space: OptionSpace) -> None:
    """A value is read where its defined name points, on any sheet, and not beside its label."""
    elsewhere = {"B1": 5000, "B2": 0.5, "B3": 3}
    names = {
        "PartMass": f"'{SHEET}'!$Z$1",
        "SuctionMin": "Inputs!$B$3",
        "ScaleFactor": "Inputs!$B$2",
    }
    sheets = {"Inputs": elsewhere, SHEET: export_rows() | {"Z1": 4321}}
    space = read(path, sheets, names).space
    assert space.part.mass_g == 4321
    assert space.kinds[0].count_min == 3
    assert space.scale_factor == 0.5
    assert kind_values(space.kinds[1]) == kind_values(tiny_space.kinds[1])


def test_named_values_need_no_labels(path: Path, tiny_space: OptionSpace) -> None:
    """A full workbook is read by its names alone: title and labels may be translated."""
    cells = {
        cell: value if not isinstance(value, str) else f"~{value}"
        for cell, value in export_rows().items()
    }
    rows = {layout.PART: 5, layout.SUCTION.section: 11, layout.MAGNETS.section: 19}
    names = {
        field.name: f"'{SHEET}'!$B${row + number}"
        for section, row in rows.items()
        for number, field in enumerate(section.fields)
    }
    names |= {
        "SuctionLocations": f"'{SHEET}'!$D$5:$F$10",
        "MagnetLocations": f"'{SHEET}'!$G$5:$I$10",
        "ScaleFactor": f"'{SHEET}'!$L$1",
        "IdealPolygon": f"'{SHEET}'!$L$3:$N$6",
    }
    assert space_values(read(path, {SHEET: cells}, names).space) == space_values(tiny_space)


@pytest.mark.parametrize(
    "reference", ["#REF!", "#REF!$B$5", f"'{SHEET}'!#REF!", "1+1", f"'{SHEET}'!$B$6*2", "Gone!$B$5"]
)
def test_names_that_are_no_place_are_left_alone(
    reference: str, path: Path, tiny_space: OptionSpace
) -> None:
    """A name whose cell was deleted, or that calculates, does not hide the label."""
    tiny_export(path)
    name = f'<definedName name="PartMass">{reference}</definedName>'
    end = b"</sheets>"
    names = end + f"<definedNames>{name}</definedNames>".encode()
    change_part(path, "xl/workbook.xml", lambda xml: replaced(xml, end, names))
    assert space_values(read_book(path).space) == space_values(tiny_space)


SQUARE = ((100.0, -90.0, 10.0), (100.0, 90.0, 10.0), (-100.0, 90.0, 10.0), (-100.0, -90.0, 10.0))
LIVE_NAMES = {
    "IdealPolygon": f"'{SHEET}'!$L$3:$N$6",
    "ApproximationPolygon": f"'{SHEET}'!$Q$3:$S$6",
}


def live_polygon(formula_rows: range) -> dict[str, Value]:
    """Cells of an approximation polygon, and formulas on it without stored values."""
    typed: dict[str, Value] = {
        f"{column}{row}": value
        for row, corner in enumerate(SQUARE, 3)
        for column, value in zip("QRS", corner, strict=True)
    }
    formulas = {
        f"{ideal}{row}": Raw(f"><f>B6+L1*({corner}{row}-B6)</f>")
        for row in formula_rows
        for ideal, corner in zip("LMN", "QRS", strict=True)
    }
    return typed | formulas


def test_our_polygon_formulas_are_calculated_again(path: Path) -> None:
    """The approximation polygon counts where the ideal one is our formula, without value too."""
    sheets = {SHEET: export_rows() | live_polygon(range(3, 7)) | {"L1": 0.9}}
    space = read(path, sheets, LIVE_NAMES).space
    assert space.approximation_polygon_mm.tolist() == [list(corner) for corner in SQUARE]
    assert space.scale_factor == 0.9


def test_a_typed_ideal_polygon_beats_the_approximation(path: Path) -> None:
    """Corners typed over our formulas are not lost: the ideal polygon is then what it shows."""
    sheets = {SHEET: export_rows() | live_polygon(range(0))}
    space = read(path, sheets, LIVE_NAMES).space
    np.testing.assert_allclose(space.approximation_polygon_mm, PLATE, rtol=0, atol=1e-12)


def test_lost_polygon_formulas_are_calculated_again(path: Path) -> None:
    """Some programs save neither formulas nor names; then the approximation's label is enough."""
    lost = {f"{column}{row}": None for column in "LMN" for row in range(3, 7)}
    cells = export_rows() | live_polygon(range(0)) | lost | {"P1": "Approximation polygon"}
    for names in (LIVE_NAMES, {}):
        space = read(path, {SHEET: cells}, names).space
        assert space.approximation_polygon_mm.tolist() == [list(corner) for corner in SQUARE]


@pytest.mark.parametrize("formula_rows", [range(3, 7), range(0)], ids=["live", "typed"])
def test_a_corner_may_be_added_below_a_named_polygon(path: Path, formula_rows: range) -> None:
    """It counts as a row below a list of places does, with or without its index."""
    fifth = (0.0, -95.0, 10.0)
    sheets = {SHEET: export_rows() | live_polygon(formula_rows)}
    columns = "QRS" if formula_rows else "LMN"
    sheets[SHEET] |= {f"{c}7": value for c, value in zip(columns, fifth, strict=True)}
    space = read(path, sheets, LIVE_NAMES).space
    polygon = space.approximation_polygon_mm if formula_rows else space.ideal_polygon_mm
    assert len(polygon) == 5
    np.testing.assert_allclose(polygon[4], fifth, rtol=0, atol=1e-12)


def test_the_last_corner_of_a_named_polygon_may_be_cleared(path: Path) -> None:
    """A cleared corner before the last is a gap, and named."""
    sheets = {SHEET: export_rows() | live_polygon(range(3, 7))}
    sheets[SHEET] |= dict.fromkeys(("Q6", "R6", "S6"))
    assert len(read(path, sheets, LIVE_NAMES).space.approximation_polygon_mm) == 3
    sheets[SHEET] |= live_polygon(range(3, 7)) | dict.fromkeys(("Q5", "R5", "S5"))
    write_book(path, sheets, LIVE_NAMES)
    with pytest.raises(InputError) as refusal:
        read_book(path)
    assert [problem.where for problem in refusal.value.problems] == [
        f"{SHEET}!{column}5" for column in "QRS"
    ]


def test_diameters_and_models_are_read(path: Path) -> None:
    """What a full workbook knows besides an export is found by its labels, too."""
    details = {
        "U1": "Suction cup diameter (mm)",
        "V1": 46,
        "U2": "Suction cup model",
        "V2": "=FGA 43",
        "U3": "Magnet diameter (mm)",
        "U4": "Magnet model",
        "V4": 30,
    }
    cups, magnets = read(path, {SHEET: export_rows() | details}).space.kinds
    assert (cups.diameter_mm, cups.model) == (46.0, "=FGA 43")
    assert (magnets.diameter_mm, magnets.model) == (None, "30")


# --- saved by other programs ---


def test_a_book_saved_by_openpyxl_is_the_same(path: Path, tiny_space: OptionSpace) -> None:
    """A program that loads and saves an export changes nothing of what is read."""
    tiny_export(path)
    saved = path.with_name("saved.xlsx")
    openpyxl.load_workbook(path).save(saved)
    assert space_values(read_book(saved).space) == space_values(tiny_space)


def test_the_file_is_only_read(path: Path) -> None:
    """Reading leaves the file as it was, and nothing beside it."""
    tiny_export(path)
    copy = path.with_suffix(".copy")
    shutil.copy2(path, copy)
    before = path.stat().st_mtime_ns
    read_book(path)
    assert (path.read_bytes(), path.stat().st_mtime_ns) == (copy.read_bytes(), before)
    assert sorted(path.parent.iterdir()) == sorted([path, copy])


# --- the GA sheet ---

GA_PARAMETERS = Parameters(
    user_start=True,
    elitism=False,
    one_in=3.0,
    generations=2000,
    clearance_mm=50.0,
    density_ratio=2.0,
    criterion=Criterion(frozenset({"cost", "moment"})),
    fos=2.5,
    goals=(60.0, 9000.0, 30.0, 700.0),
    children=7,
    seed=9,
    moment_arm="plan",
)


def test_parameters_and_grasp_are_read(path: Path) -> None:
    """Each parameter of a GA sheet comes to its field, and the user-defined grasp to its genes."""
    book = read(path, {SHEET: export_rows(), GA: ga_rows()})
    assert book.parameters == GA_PARAMETERS
    assert book.user_chromosome is not None
    assert book.user_chromosome.rows() == [[2, 1, 4, 1, 1, 1], [1, 3, 1, 1, 1, 1]]


def test_an_export_says_nothing_about_the_search(path: Path) -> None:
    """Without a GA sheet no parameter is known and no grasp."""
    book = read(path, {SHEET: export_rows()})
    assert (book.parameters, book.user_chromosome) == (Parameters(), None)


def test_the_ga_sheet_is_read_wherever_it_stands(path: Path) -> None:
    """The GA sheet may have any name, free rows above it and free columns beside its blocks."""
    moved = shifted(shifted(ga_rows(), rows=9, columns=2), columns=3, after=5)
    book = read(path, {"Search": moved, SHEET: export_rows()})
    assert book.parameters == GA_PARAMETERS
    assert book.user_chromosome is not None


def test_parameters_are_found_by_name(path: Path) -> None:
    """Defined names of the GA sheet win over its labels, too."""
    names = {
        "Seed": f"{GA}!$Z$1",
        "CostGoal": f"{GA}!$Z$2",
        "UserChromosome": f"{GA}!$P$30:$U$31",
    }
    cells: Cells = {"Z1": 77, "Z2": 88, "P30": 1, "Q30": 6, "P31": 1, "Q31": 5}
    book = read(path, {SHEET: export_rows(), GA: ga_rows() | cells}, names)
    assert (book.parameters.seed, book.parameters.goals[0]) == (77, 88.0)
    assert book.user_chromosome is not None
    assert book.user_chromosome.active == ((6,), (5,))


def test_a_grasp_that_the_program_assigned_is_read(path: Path) -> None:
    """The remark in the title of the program's own benchmark does not hide the block."""
    title = "User-Defined Chromosome (program-assigned)"
    assert read(path, {SHEET: export_rows(), GA: ga_rows() | {"D7": title}}).user_chromosome


def test_genes_of_a_kind_without_places_are_blank(path: Path) -> None:
    """Where there are no cups, whatever stands in their inactive genes is no index."""
    sheets = {SHEET: export_rows() | NO_CUPS | {"B11": 0}, GA: ga_rows() | {"E9": 0}}
    chromosome = read(path, sheets).user_chromosome
    assert chromosome is not None
    assert chromosome.rows()[0] == [0, None, None, None, None, None]


def test_an_inactive_gene_that_is_no_index_is_a_warning(path: Path) -> None:
    """It enters no sum: it counts as unset, and does not keep anybody from working with the file."""
    odd: Cells = {"H9": 9999, "I9": "abc", "J9": 2.5}
    write_book(path, {SHEET: export_rows(), GA: ga_rows() | odd})
    book = read_book(path)
    assert book.user_chromosome is not None
    assert book.user_chromosome.rows()[0] == [2, 1, 4, 1, 1, 1]
    told = [(warning.where, warning.found) for warning in book.warnings]
    assert told == [("GA!H9", "9999"), ("GA!I9", "the text 'abc'"), ("GA!J9", "2.5")]


# --- odd polygons ---


def warnings_of(path: Path, change: Mapping[str, Value]) -> list[tuple[str, str]]:
    """Read a changed tiny export, which must only give warnings: their places and findings."""
    tiny_export(path, change)
    return [(warning.where, warning.found) for warning in read_book(path).warnings]


def test_a_centroid_outside_the_polygon_is_a_warning(path: Path) -> None:
    """A part that hangs outside its own polygon can still be calculated with."""
    beside = tuple((x + 200, y, z) for x, y, z in PLATE)
    assert warnings_of(path, polygon_rows(beside)) == [
        (f"{SHEET}!L3", "the part's centroid outside the polygon")
    ]


def test_a_polygon_that_is_not_star_shaped_is_a_warning(path: Path) -> None:
    """Corners that the centroid does not see are told, since scaling may then leave the part."""
    notch = ((-150.0, 50.0, 10.0), (-20.0, 0.0, 10.0), (-150.0, -50.0, 10.0))
    hiding = ((-150.0, 70.0, 10.0), (-20.0, 60.0, 10.0), (-150.0, 50.0, 10.0))
    assert warnings_of(path, polygon_rows((*PLATE[:3], *notch, PLATE[3]))) == []
    assert warnings_of(path, polygon_rows((*PLATE[:3], *hiding, PLATE[3]))) == [
        (f"{SHEET}!L3", "a polygon that is not star-shaped about the part's centroid")
    ]


@pytest.mark.parametrize("value", [7, number_text("1" * 400), "?", None])
def test_the_centroid_below_the_polygon_is_not_used(
    value: Value, path: Path, tiny_space: OptionSpace
) -> None:
    """Where figure 26 repeats the centroid, another number is a warning, other things nothing."""
    told = [(f"{SHEET}!M8", "7")] if value == 7 else []
    assert warnings_of(path, {"M8": value}) == told
    assert space_values(read_book(path).space) == space_values(tiny_space)


def test_overlap_of_the_magnets_is_kept(tmp_path):
    """The optional column of covered area fractions is read, and written back as it came."""
    space = plate(cups=3, magnets=2)
    cups, magnets = space.kinds
    covered = replace(magnets, overlap=frozen([0.75, 1.0]))
    path = tmp_path / "export.xlsx"
    path.write_bytes(export_workbook(replace(space, kinds=(cups, covered))).content)
    again = read_option_space(open_source(path))
    assert again.kinds[0].overlap is None
    assert again.kinds[1].overlap.tolist() == [0.75, 1.0]
