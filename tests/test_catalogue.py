"""The catalogue of gripper elements: what is shipped, what a user adds, and what is refused."""

from __future__ import annotations

import csv
import io
import json
import os
import subprocess
import sys
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import pytest
from rich.console import Console

from grasp_xl.cli import element_table, options
from grasp_xl.cli.program import main
from grasp_xl.errors import MAX_PROBLEMS, InputError, UsageError
from grasp_xl.fitment import csv_table, element
from grasp_xl.fitment.catalogue import SHIPPED, Catalogue, Diameters, Wanted, find, read_catalogue
from grasp_xl.workbook import cells, layout

HEADER = "model,kind,force_n,diameter_mm\n"
CUP = "Cup 50,suction_cup,80,50\n"

Content = str | bytes | int
"""Of a file: its text, its bytes, or how many bytes of one endless line it has."""


@pytest.fixture(scope="module")
def shipped() -> Catalogue:
    """Read the shipped catalogue once."""
    return read_catalogue()


@pytest.fixture
def own(tmp_path: Path) -> Callable[[Content], Path]:
    """Write a user's file."""

    def write(content: Content) -> Path:
        path = tmp_path / "mine.csv"
        if isinstance(content, int):
            with path.open("wb") as file:
                file.truncate(content)  # a sparse file: it takes no place on the disk
        else:
            path.write_bytes(content.encode() if isinstance(content, str) else content)
        return path

    return write


class Told(NamedTuple):
    """What a command printed, and its exit code."""

    code: int
    out: str
    err: str


@pytest.fixture
def gx(capsys: pytest.CaptureFixture[str]) -> Callable[..., Told]:
    """Run ``grasp-xl elements``."""

    def run(*words: object) -> Told:
        capsys.readouterr()
        code = main(["elements", *map(str, words)])
        return Told(code, *capsys.readouterr())

    return run


# --- what is shipped ---


def test_the_shipped_elements_are_those_of_the_file(shipped: Catalogue) -> None:
    """Every cell arrives, as a number where it is one; an empty one is None, and nothing is added."""
    with SHIPPED.open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert set(rows[0]) == set(element.COLUMNS)
    for row, one in zip(rows, shipped.elements, strict=True):
        for column, cell in row.items():
            value = getattr(one, column)
            if column == "kind":
                assert value == {"suction_cup": "suction", "magnet": "magnets"}[cell]
            elif isinstance(value, float):
                assert value == float(cell)
            else:
                assert value == (cell or None)


def test_the_shipped_file_has_64_elements(shipped: Catalogue) -> None:
    assert Counter(one.kind for one in shipped.elements) == {"suction": 47, "magnets": 17}
    assert (shipped.replaced, shipped.warnings) == ((), ())


def test_kinds_are_named_as_in_an_option_space() -> None:
    names = {kind.kind for kind in layout.KINDS}
    assert set(element.KINDS.values()) == set(options.KIND_WORDS.values()) == names


def test_bounds_of_numbers_are_those_of_a_workbook() -> None:
    assert (element.LEAST_ABOVE_0, element.MOST) == (cells.MIN_DISTANCE, cells.MAX_NUMBER)


@pytest.mark.parametrize(
    ("model", "kind", "diameter_mm", "force_n"),
    [
        ("SAF 40 NBR-60 M10-AG", "suction", 46.0, 69.0),
        ("SGM-HP 30 G1/8-IG", "magnets", 30.0, 130.0),
        ("SGM-HP 30", "magnets", 30.0, 130.0),
    ],
)
def test_the_elements_of_the_thesis(
    shipped: Catalogue, model: str, kind: str, diameter_mm: float, force_n: float
) -> None:
    """Section 6.2: 46 mm and 69 N, 30 mm and 130 N; they are the defaults of a workbook, too."""
    one = find(shipped, model)
    assert (one.brand, one.kind, one.diameter_mm, one.force_n) == (
        "Schmalz",
        kind,
        diameter_mm,
        force_n,
    )
    number = [labels.kind for labels in layout.KINDS].index(kind)
    assert layout.DEFAULT_DIAMETERS_MM[number] == diameter_mm


# --- finding ---


@pytest.mark.parametrize(
    "name",
    ["SPB1 40", " spb1  40 ", "SPB140", "10.01.06.03499", "10.01.06. 03499"],
)
def test_an_element_is_found_by_model_or_part_number(shipped: Catalogue, name: str) -> None:
    assert find(shipped, name).model == "SPB1 40"


def test_an_unknown_name_gives_the_closest_three(shipped: Catalogue) -> None:
    with pytest.raises(UsageError) as refusal:
        find(shipped, "SAF 40 NBR-60")
    assert refusal.value.message == (
        "No element of the catalogue is named 'SAF 40 NBR-60'; the closest are "
        "'SAF 40 NBR-60 M10-AG' (10.01.01.10716), 'SUF 80 NBR', "
        "'SUF 90 NBR-55' (10.01.01.13956)."
    )
    assert "grasp-xl elements" in refusal.value.hint


@pytest.mark.parametrize("name", ["", " ", "\x1b", "?" * 10_000])
def test_a_name_that_is_none_is_unknown(shipped: Catalogue, name: str) -> None:
    with pytest.raises(UsageError, match="the closest are") as refusal:
        find(shipped, name)
    assert refusal.value.message.isprintable()


def test_a_part_number_of_two_elements_names_both(shipped: Catalogue) -> None:
    with pytest.raises(UsageError) as refusal:
        find(shipped, "10.01.17.00316")
    assert refusal.value.message == (
        "'10.01.17.00316' is the name of several elements: "
        "'SGM-HP 30 G1/8-IG' (10.01.17.00316), 'SGM-HP 30' (10.01.17.00316)."
    )


def test_a_model_beats_a_part_number(own: Callable[[Content], Path]) -> None:
    header, rows = "model,part_no,kind,force_n,diameter_mm\n", "A,B,cup,1,1\nB,C,cup,2,2\n"
    assert find(read_catalogue(own(header + rows)), "b").force_n == 2


def test_models_that_differ_in_spaces_alone_are_two(own: Callable[[Content], Path]) -> None:
    """SPB 110 does not replace SPB1 10; a name without spaces stands for both."""
    catalogue = read_catalogue(own(HEADER + "SPB 110,cup,9,110\n"))
    assert (len(catalogue.elements), catalogue.replaced) == (65, ())
    assert find(catalogue, "SPB 110").force_n == 9
    with pytest.raises(UsageError, match="several elements: 'SPB1 10', 'SPB 110'"):
        find(catalogue, "SPB110")


# --- a user's file ---


def test_an_own_file_adds_and_replaces(own: Callable[[Content], Path]) -> None:
    path = own(HEADER + CUP + "\n,,,\nsgm-hp  30,Magnet,131,31\n")
    catalogue = read_catalogue(path)
    assert len(catalogue.elements) == 65
    added = find(catalogue, "cup 50")
    assert (added.force_n, added.diameter_mm) == (80, 50)
    known = {"model", "kind", "force_n", "diameter_mm"}
    assert all(getattr(added, name) is None for name in element.COLUMNS if name not in known)
    assert find(catalogue, "SGM-HP 30").force_n == 131
    assert catalogue.replaced == ("SGM-HP 30",)
    assert [str(warning) for warning in catalogue.warnings] == [
        f"{path}, line 5, column model: found 'sgm-hp  30', a model of the shipped catalogue, expected a model that it does not have; the element of this file replaces the shipped one."
    ]


GOOD = {
    "bom": "\ufeff" + HEADER + CUP,
    "windows_lines": (HEADER + CUP).replace("\n", "\r\n"),
    "blank_lines_first_in_german": ";;;\nmodel;kind;force_n;diameter_mm\nCup 50;cup;80;50\n",
    "old_mac_lines": (HEADER + CUP).replace("\n", "\r"),
    "no_last_line_end": (HEADER + CUP).strip(),
    "blank_lines_first": "\n , \n" + HEADER + CUP,
    "german_excel": "\ufeffmodel;kind;force_n;diameter_mm;note\r\nCup 50;suction_cup;80,0;5,0E1;a, b\r\n",
    "semicolon_and_points": "model;kind;force_n;diameter_mm\nCup 50;cup;80.0;50.00\n",
    "semicolon_in_a_comma_file": 'model,kind,force_n,diameter_mm,note\nCup 50,cup,80,50,"a;b;c;d;e;f"\n',
    "quoted_header": '"Model","KIND"," Force_N ","diameter_mm"\nCup 50,Suction Cup,+80,.5e2\n',
    "columns_in_another_order": "diameter_mm,force_n,kind,model\n50,80,suction,Cup 50\n",
    "short_row": "model,kind,force_n,diameter_mm,price,note\nCup 50,cup,80,50\n",
    "long_row_of_blanks": HEADER + "Cup 50,cup,80,50,,,\n",
    "spaces_around": HEADER + " Cup 50 , cup , 80 , 50 \n",
}


@pytest.mark.parametrize("content", GOOD.values(), ids=GOOD)
def test_files_as_programs_write_them_are_understood(
    own: Callable[[Content], Path], content: str
) -> None:
    catalogue = read_catalogue(own(content))
    one = find(catalogue, "Cup 50")
    assert (one.kind, one.force_n, one.diameter_mm) == ("suction", 80.0, 50.0)
    assert (one.price, catalogue.warnings) == (None, ())


def test_length_and_width_are_a_size_and_a_price_may_be_0(own: Callable[[Content], Path]) -> None:
    header = "model;kind;shape;force_n;length_mm;width_mm;price\n"
    one = find(read_catalogue(own(header + "M;magnet;Oval;9,5;80;40,5;0\n")), "M")
    assert (one.shape, one.force_n, one.length_mm, one.width_mm) == ("oval", 9.5, 80.0, 40.5)
    assert (one.price, one.diameter_mm) == (0.0, None)


def test_a_column_that_is_not_known_is_told(own: Callable[[Content], Path]) -> None:
    path = own("model,kind,force_n,diameter_mm,wieght_g\nA,cup,1,1,5\n")
    (warning,) = read_catalogue(path).warnings
    assert (warning.where, warning.found) == (f"{path}, line 1", "the unknown column 'wieght_g'")


def test_a_header_alone_is_told(own: Callable[[Content], Path]) -> None:
    catalogue = read_catalogue(own(HEADER))
    assert len(catalogue.elements) == 64
    assert [warning.found for warning in catalogue.warnings] == ["a header alone"]


def test_ten_thousand_rows_are_read(own: Callable[[Content], Path]) -> None:
    rows = "".join(f"E{number},cup,1,1\n" for number in range(csv_table.MAX_ROWS))
    assert len(read_catalogue(own(HEADER + rows)).elements) == 64 + csv_table.MAX_ROWS


# --- what is refused ---

ABOVE_0 = "a number above 0, at most 1,000,000,000"
UNIT = "write it in digits, without a unit"

BAD: dict[str, tuple[Content, list[str]]] = {
    "empty": (b"", [": found an empty file, expected a CSV file (UTF-8, separated by , or ;)"]),
    "blank": ("\ufeff \n\n", [": found an empty file"]),
    "separators_alone": (";;;\n", [": found an empty file"]),
    "no_header": (CUP, [", line 1: found no header, but 'Cup 50,suction_cup,80,50', expected"]),
    "tabs": (HEADER.replace(",", "\t"), [r", line 1: found no header, but 'model\tkind"]),
    "not_utf_8": (
        (HEADER + "Größe,cup,1,1\n").encode("cp1252"),
        [", line 2: found bytes that are no UTF-8 (0xf6), expected a CSV file in UTF-8; in Excel"],
    ),
    "utf_16": ((HEADER + CUP).encode("utf-16"), [", line 1: found bytes that are no UTF-8 (0xff)"]),
    "columns_missing": (
        "kind,diameter_mm\ncup,1\n",
        [", line 1: found no column model,", ", line 1: found no column force_n,"],
    ),
    "no_size_column": (
        "model,kind,force_n\nA,cup,1\nB,cup,1\n",
        [": found no column of a size, expected diameter_mm, or length_mm and width_mm; add"],
    ),
    "column_twice": (
        "model,kind,force_n,diameter_mm,Model\nA,cup,1,1,B\n",
        [", line 1, column model: found 2 such columns, expected one"],
    ),
    "unknown_kind": (
        HEADER + "A,gripper,1,1\n",
        [", line 2, column kind: found 'gripper', expected suction_cup or magnet; write one"],
    ),
    "unknown_shape": (
        "model,kind,force_n,diameter_mm,shape\nA,cup,1,1,rund\n",
        [", line 2, column shape: found 'rund', expected one of round, rectangular, oval; write"],
    ),
    "force_with_unit": (
        HEADER + "A,cup,69 N,1\n",
        [f", line 2, column force_n: found '69 N', expected {ABOVE_0}; {UNIT}."],
    ),
    "force_negative": (HEADER + "A,cup,-1,1\n", [f"force_n: found '-1', expected {ABOVE_0}; corr"]),
    "force_0": (HEADER + "A,cup,0,1\n", [f"force_n: found '0', expected {ABOVE_0}; correct"]),
    "force_infinite": (HEADER + "A,cup,inf,1\n", ["force_n: found 'inf', expected a number"]),
    "force_overflows": (HEADER + "A,cup,1e999,1\n", ["force_n: found '1e999', expected a number"]),
    "force_nan": (HEADER + "A,cup,NaN,1\n", ["force_n: found 'NaN', expected a number"]),
    "force_underlined": (HEADER + "A,cup,1_0,1\n", ["force_n: found '1_0', expected a number"]),
    "force_in_other_digits": (HEADER + "A,cup,٦٩,1\n", ["force_n: found '٦٩', expected a number"]),
    "comma_in_a_comma_file": (
        HEADER + 'A,cup,"69,5",1\n',
        [
            "force_n: found '69,5', expected a number above 0, at most 1,000,000,000; write a decimal"
        ],
    ),
    "dot_for_thousands": (
        "model;kind;force_n;diameter_mm\nA;cup;1.070;1\n",
        ["force_n: found '1.070', expected a number above 0, at most 1,000,000,000; write no dot"],
    ),
    "dot_and_comma": (
        "model;kind;force_n;diameter_mm\nA;cup;1.070,5;1\n",
        ["force_n: found '1.070,5', expected a number above 0"],
    ),
    "price_negative": (
        "model,kind,force_n,diameter_mm,price\nA,cup,1,1,-0.5\n",
        ["column price: found '-0.5', expected a number of 0 or more, at most"],
    ),
    "weight_0": (
        "model,kind,force_n,diameter_mm,weight_g\nA,cup,1,1,0\n",
        [f"column weight_g: found '0', expected {ABOVE_0}; correct it, or leave it empty."],
    ),
    "no_size": (
        "model,kind,force_n,diameter_mm,length_mm,width_mm\nA,cup,1,,,\nB,cup,1,,1,\n",
        [
            ", line 2, column diameter_mm: found an empty cell, expected a diameter, or length_mm",
            ", line 3, column diameter_mm: found an empty cell, expected a diameter, or length_mm",
        ],
    ),
    "size_of_another_shape": (
        "model,kind,force_n,diameter_mm,length_mm,width_mm,shape\nA,cup,1,,1,1,round\nB,cup,1,1,1,,rectangular\n",
        [
            ", line 2, column diameter_mm: found an empty cell, expected the diameter of a round",
            ", line 3, column width_mm: found an empty cell, expected length and width of a shape",
        ],
    ),
    "same_model": (
        HEADER + CUP + "A,cup,1,1\n CUP  50 ,magnet,1,1\n",
        [", line 4, column model: found 'CUP  50', as on line 2, expected a model once; take"],
    ),
    "cells_missing": (
        HEADER + ",,,1\n",
        [f", line 2, column {name}: found an empty cell" for name in ("model", "kind", "force_n")],
    ),
    "too_many_cells": (
        HEADER + "A,cup,69,5,1\n",
        [", line 2: found 5 cells, expected 4, as the header has; put a text that holds ','"],
    ),
    "open_quote": (
        HEADER + 'A,cup,-1,1\n"B,cup,1,1\nC,cup,1,1\n',
        [", line 3: found a damaged row (unexpected end of data)", ", line 2, column force_n"],
    ),
    "quote_inside": (HEADER + '"46" mm",cup,1,1\n', [", line 2: found a damaged row ("]),
    "line_after_a_long_cell": (
        HEADER + '"A\n\nB",cup,1,1\nC,cup,x,1\n',
        [", line 5, column force_n: found 'x'"],
    ),
    "long_text": (HEADER + "A" * 1001 + ",cup,1,1\n", ["column model: found 1,001 characters"]),
    "very_long_text": (HEADER + "A" * 200_000 + ",cup,1,1\n", [", line 2: found a damaged row (f"]),
    "control_characters": (HEADER + "A,\x1b[31m\x00,1,1\n", [r"kind: found '\x1b[31m\x00', exp"]),
    "a_workbook": (b"PK\x03\x04\xff\xfe", [", line 1: found bytes that are no UTF-8"]),
    "too_many_rows": (
        HEADER + "".join(f"E{number},cup,0,1\n" for number in range(10_001)),
        [", line 10002: found more than 10,000 rows, expected at most 10,000; keep"],
    ),
    "a_line_of_100_mb": (
        100_000_000,
        [": found a file of 100 MB, expected at most 16 MB; save at most 10,000 elements"],
    ),
    "several": (
        HEADER + "A,cap,-1,1\nB,magnet,1,\n",
        [
            ", line 2, column kind: found 'cap'",
            ", line 2, column force_n: found '-1'",
            ", line 3, column diameter_mm: found an empty cell",
        ],
    ),
}


@pytest.mark.parametrize(("content", "told"), BAD.values(), ids=BAD)
def test_a_bad_file_is_refused_with_every_problem(
    own: Callable[[Content], Path], content: Content, told: list[str]
) -> None:
    """Each problem begins with its file, line and column, and can be printed."""
    path = own(content)
    with pytest.raises(InputError) as refusal:
        read_catalogue(path)
    problems = [str(problem) for problem in refusal.value.problems]
    assert len(problems) == len(told)
    for problem, part in zip(problems, told, strict=True):
        assert problem.startswith(f"{path}{part}" if part[0] in ",:" else str(path))
        assert part in problem
        assert problem.isprintable()
        assert len(problem) < 400 + len(str(path))


def test_fifty_problems_are_named_and_the_rest_counted(own: Callable[[Content], Path]) -> None:
    with pytest.raises(InputError) as refusal:
        read_catalogue(own(HEADER + "".join(f"E{number},cup,0,1\n" for number in range(60))))
    assert len(refusal.value.problems) == MAX_PROBLEMS + 1
    assert "problems beyond the first 50: 10" in refusal.value.message


def test_what_is_no_file_is_refused(tmp_path: Path) -> None:
    for path, found in ((tmp_path, "a folder"), (tmp_path / "none.csv", "no such file")):
        with pytest.raises(InputError, match=f"found {found}, expected a CSV file"):
            read_catalogue(path)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="Windows has no such pipes")
def test_a_pipe_is_refused_and_not_waited_for(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe.csv")
    with pytest.raises(InputError, match="found a pipe or device, expected a CSV file"):
        read_catalogue(tmp_path / "pipe.csv")


# --- the command ---


def listed(told: Told) -> list[list[str]]:
    """Return the cells of the rows of a table."""
    lines = told.out.partition("─ \n")[2].partition("\n   ")[0].splitlines()
    return [line.split() for line in lines]


def test_the_table_has_a_line_for_each_element(gx: Callable[..., Told]) -> None:
    told = gx()
    rows = listed(told)
    assert Counter(row[0] for row in rows) == {"cup": 47, "magnet": 17}
    wanted = "cup Schmalz SAF 40 NBR-60 M10-AG 10.01.01.10716 46 69 1 - - A"
    assert rows[0] == wanted.split()
    assert "  1: normal direction, 60 kPa vacuum\n" in told.out
    assert "64 of 64 elements" in told.out
    assert (told.code, told.err) == (0, "")


@pytest.mark.parametrize(
    ("words", "wanted"),
    [
        (["--kind", "cup"], Wanted("suction")),
        (["--kind", "magnet", "--min-force", "130"], Wanted("magnets", 130.0)),
        (["--diameter", "46"], Wanted(diameters=Diameters(45.5, 46.5))),
        (["--diameter", "45"], Wanted(diameters=Diameters(44.5, 45.5))),
        (["--diameter", "30-50"], Wanted(diameters=Diameters(30.0, 50.0))),
        (["--diameter", "31.8"], Wanted(diameters=Diameters(31.3, 32.3))),
        (["--diameter", "46-46", "--kind", "cup"], Wanted("suction", None, Diameters(46, 46))),
    ],
    ids=str,
)
def test_filters(
    gx: Callable[..., Told], shipped: Catalogue, words: list[str], wanted: Wanted
) -> None:
    """What is listed has what was asked for, and what is not listed lacks it."""
    told = json.loads(gx(*words, "--json").out)
    models = [one["model"] for one in told["elements"]]
    expected = [
        one.model
        for one in shipped.elements
        if (wanted.kind is None or one.kind == wanted.kind)
        and one.force_n >= (wanted.min_force_n or 0)
        and (
            wanted.diameters is None
            or (
                one.diameter_mm is not None
                and wanted.diameters.least_mm <= one.diameter_mm <= wanted.diameters.most_mm
            )
        )
    ]
    assert models == expected
    assert 0 < len(models) < told["catalogue_size"] == 64


def test_a_diameter_at_the_end_of_a_tolerance_is_found() -> None:
    """46.6 + 0.5 and the like are not exact in binary."""
    for tenths in range(100, 1_000):
        one = element.Element("A", "suction", 1.0, diameter_mm=tenths / 10 + 0.5)
        diameters = options._diameters(f"{tenths / 10}")
        assert Wanted(diameters=diameters).fits(one)
        assert not Wanted(diameters=Diameters(1.0, tenths / 10 + 0.49)).fits(one)


def test_nothing_that_fits_is_no_error(gx: Callable[..., Told]) -> None:
    told = gx("--min-force", "1e6")
    assert (told.code, told.out) == (0, "None of the 64 elements of the catalogue fits.\n")
    assert json.loads(gx("--min-force", "1e6", "--json").out)["elements"] == []


@pytest.mark.parametrize(
    "words",
    [
        *(["--kind", word] for word in ("", "gripper", "Cup")),
        *(["--min-force", word] for word in ("0", "-1", "nan", "inf", "x", "")),
        *(["--diameter", word] for word in ("0", "-46", "50-30", "30-40-50", "x", "", "-", "nan")),
        ["--catalogue", ""],
    ],
    ids=str,
)
def test_values_that_make_no_sense_are_wrong_usage(
    gx: Callable[..., Told], words: list[str]
) -> None:
    told = gx(*words)
    assert (told.code, told.out) == (2, "")
    assert told.err.startswith(f"{words[0]}: found {words[1]!r}, expected ")


def test_json_and_quiet(gx: Callable[..., Told], own: Callable[[Content], Path]) -> None:
    path = own(HEADER + CUP + "SGM-HP 30,magnet,131,30\n")
    told = gx("--catalogue", path, "--json")
    answer = json.loads(told.out)
    assert told.err.startswith("Warning: ")
    assert answer["replaced"] == ["SGM-HP 30"]
    assert answer["catalogue_size"] == len(answer["elements"]) == 65
    assert answer["warnings"][0]["where"] == f"{path}, line 3, column model"
    assert set(answer["elements"][0]) == set(element.COLUMNS)
    assert gx("--catalogue", path, "--quiet") == (0, "", "")
    quiet = gx("--catalogue", path, "--quiet", "--json")
    assert (quiet.out, quiet.err) == (told.out, "")


def test_a_bad_file_is_told_and_an_object_with_json(
    gx: Callable[..., Told], own: Callable[[Content], Path]
) -> None:
    path = own(HEADER + "A,cap,-1,1\n")
    told = gx("--catalogue", path)
    assert (told.code, told.out, len(told.err.splitlines())) == (3, "", 2)
    told = gx("--catalogue", path, "--json")
    assert (told.code, told.err) == (3, "")
    assert json.loads(told.out)["where"] == f"{path}, line 2, column kind"


def test_text_of_a_file_is_printed_as_text(
    gx: Callable[..., Told], own: Callable[[Content], Path]
) -> None:
    """No markup is obeyed, and no control character reaches the terminal, also in errors."""
    evil = "[red]x[/] \x1b]0;t\x07\u202e"
    shown = r"[red]x[/] \x1b]0;t\x07\u202e"
    header = "model,kind,force_n,diameter_mm,brand,force_condition,currency,price\n"
    told = gx("--catalogue", own(header + f"{evil},cup,7,7,{evil},{evil},{evil},1\n"))
    assert told.out.count(shown) == 4
    assert told.out.replace("\n", "").isprintable()
    told = gx("--catalogue", own(HEADER + f"A,{evil},7,7\n"))
    assert shown in told.err
    assert told.err.replace("\n", "").isprintable()


@pytest.mark.parametrize("width", [80, 100, 160])
def test_no_number_is_cut_on_a_terminal(
    gx: Callable[..., Told], monkeypatch: pytest.MonkeyPatch, width: int
) -> None:
    """Models and part numbers take more lines where it is narrow; forces and sizes do not."""
    screen = io.StringIO()
    terminal = Console(file=screen, force_terminal=True, width=width, no_color=True)
    monkeypatch.setattr(element_table, "OUT", terminal)
    assert gx("--min-force", 1000).code == 0
    lines = screen.getvalue().splitlines()
    for number in ("121 x 40", "1,176.8", "5,295.6", "103 x 120", "11,000", "MRP-170"):
        assert any(number in line for line in lines)
    assert all(len(line) <= width for line in lines if "\x1b" not in line)


def test_the_command_loads_no_heavy_module() -> None:
    heavy = ("numba", "pandas", "openpyxl", "xlsxwriter", "scipy", "shapely")
    code = (
        "import sys; from grasp_xl.cli.program import main; main(['elements', '--quiet']); "
        f"print([m for m in {heavy} if m in sys.modules])"
    )
    found = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True)  # noqa: S603
    assert found.stdout.strip() == "[]"
