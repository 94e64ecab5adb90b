"""A file that is no whole and harmless workbook is refused with one sentence that says why."""

from __future__ import annotations

import hashlib
import io
import os
import random
import warnings
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

import pytest
from bad_workbooks import (
    A_WORKBOOK,
    CELL_CASES,
    FILE_CASES,
    FINE_CASES,
    SHEET_PART,
    Case,
    Raw,
    change_part,
    changed_meanwhile,
    replaced,
    tiny_export,
)

from grasp_xl import file_content
from grasp_xl.errors import InputError, Problem
from grasp_xl.workbook import package

COLUMNS = 14


def read_to_the_end(path: Path) -> list[list[object]]:
    """Read the values of all cells, row by row."""
    opened = package.read_package(path)
    book = package.open_workbook(opened, formulas=False)
    return [
        [cell.value for cell in row]
        for sheet in book.worksheets
        for _, row in package.sheet_rows(opened, sheet, COLUMNS)
    ]


def problems_of(path: Path) -> tuple[Problem, ...]:
    """Read a workbook that must be refused."""
    with pytest.raises(InputError) as refusal:
        read_to_the_end(path)
    return refusal.value.problems


@pytest.mark.parametrize("case", FILE_CASES, ids=lambda case: case.name)
def test_a_wrong_file_is_refused_with_one_sentence(case: Case, tmp_path: Path) -> None:
    """Each wrong file gives one problem: the file, what was found, what was expected, a way out."""
    path = case.write(tmp_path)
    (expected,) = case.problems
    assert problems_of(path) == (
        Problem(str(path), expected.found, expected.expected, expected.hint),
    )


@pytest.mark.parametrize("case", FINE_CASES, ids=lambda case: case.name)
def test_a_good_file_is_read(case: Case, tmp_path: Path) -> None:
    """A workbook that is only odd passes all checks."""
    rows = read_to_the_end(case.write(tmp_path))
    assert ["Part mass (g)", 8860] in [row[:2] for row in rows]


@pytest.mark.parametrize(
    "content_type",
    [
        b"application/vnd.ms-excel.sheet.macroEnabled.main+xml",
        b"application/vnd.openxmlformats-officedocument.spreadsheetml.template.main+xml",
        b"application/vnd.ms-excel.template.macroEnabled.main+xml",
    ],
)
def test_macro_books_and_templates_are_read(content_type: bytes, tmp_path: Path) -> None:
    """.xlsm, .xltx and .xltm are workbooks, too."""
    path = tmp_path / "book.xlsx"
    tiny_export(path)
    workbook = b"application/vnd.openxmlformats-officedocument.spreadsheetml.sheet.main+xml"
    change_part(path, "[Content_Types].xml", lambda xml: replaced(xml, workbook, content_type))
    assert read_to_the_end(path)


def test_the_package_has_the_name_and_hash_of_its_file(tmp_path: Path) -> None:
    """A package keeps the name as given and hashes what was read."""
    path = tmp_path / "book.xlsx"
    tiny_export(path)
    opened = package.read_package(path)
    assert opened.name == str(path)
    assert opened.sha256 == hashlib.sha256(path.read_bytes()).hexdigest()


def test_formulas_or_values_are_read(tmp_path: Path) -> None:
    """The same package opens with its formulas and with their cached values."""
    path = tmp_path / "book.xlsx"
    tiny_export(path, {"B5": Raw("><f>1000*8.86</f><v>8860</v>")})
    opened = package.read_package(path)
    values = [
        package.open_workbook(opened, formulas=formulas)["Option Space"]["B5"].value
        for formulas in (True, False)
    ]
    assert values == ["=1000*8.86", 8860]


class BusyFile(io.FileIO):
    """A file that its own program writes while we read it."""

    def read(self, size: int | None = -1) -> bytes:
        """Read it, and let the other program be quicker."""
        content = super().read(-1 if size is None else size)
        changed_meanwhile(Path(str(self.name)))
        return content or b""


def test_a_file_that_changes_while_it_is_read_is_refused(tmp_path: Path) -> None:
    """What was read halfway between two versions is not used."""
    path = tmp_path / "book.xlsx"
    tiny_export(path)
    with BusyFile(str(path)) as file, pytest.raises(InputError) as refusal:
        file_content.read_unchanged(file, "book.xlsx", package.WORKBOOK)
    assert refusal.value.problems == (
        Problem(
            "book.xlsx",
            "a file that changed while it was read",
            "a file at rest",
            "close the program that writes it and try again",
        ),
    )


@contextmanager
def as_nobody() -> Iterator[None]:
    """Drop the rights of root for a while, since no file is closed to it."""
    root = os.geteuid() == 0
    if root:
        os.seteuid(65534)
    try:
        yield
    finally:
        if root:
            os.seteuid(0)


@pytest.mark.skipif(os.name == "nt", reason="Windows has no such permissions")
def test_a_file_without_permission_is_refused(tmp_path: Path) -> None:
    """A file that may not be read gives one sentence, too."""
    path = tmp_path / "book.xlsx"
    tiny_export(path)
    path.chmod(0)
    with as_nobody():
        problems = problems_of(path)
    assert problems == (
        Problem(
            str(path),
            "a file without permission to read it",
            "a file that you may read",
            "close it in other programs, or ask its owner for permission",
        ),
    )


@pytest.mark.skipif(os.name == "nt", reason="Windows has no named pipes in folders")
def test_a_pipe_is_refused_without_waiting_for_it(tmp_path: Path) -> None:
    """A pipe that nobody writes to does not stop the program for ever."""
    path = tmp_path / "book.xlsx"
    os.mkfifo(path)
    assert problems_of(path) == (
        Problem(
            str(path),
            "a pipe or device",
            A_WORKBOOK,
            "write its content to a file and name that",
        ),
    )


def test_openpyxl_warns_nobody(tmp_path: Path) -> None:
    """What openpyxl warns of does not reach the terminal."""
    path = tmp_path / "book.xlsx"
    tiny_export(path)
    extension = b'<extLst><ext uri="{CCE6A557-97BC-4b89-ADB6-D9C93CAAB3DF}"/></extLst></worksheet>'
    change_part(path, SHEET_PART, lambda xml: replaced(xml, b"</worksheet>", extension))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert read_to_the_end(path)


def test_cells_that_openpyxl_cannot_read_are_all_named(tmp_path: Path) -> None:
    """Each number that is none gives a problem with its cell."""
    path = tmp_path / "book.xlsx"
    tiny_export(path, {"B5": Raw("><v>NaN</v>"), "D6": Raw("><v>INF</v>")})
    assert [(problem.where, problem.found) for problem in problems_of(path)] == [
        ("Option Space!B5", "'NaN', which is no number"),
        ("Option Space!D6", "'INF', which is no number"),
    ]


def test_a_row_number_beyond_the_sheet_is_refused(tmp_path: Path) -> None:
    """A row number of twelve digits ends in a refusal, not in as many empty rows."""
    path = tmp_path / "book.xlsx"
    tiny_export(path)
    far = b'<row r="999999999999"><c><v>1</v></c></row></sheetData>'
    change_part(path, SHEET_PART, lambda xml: replaced(xml, b"</sheetData>", far))
    assert [problem.found for problem in problems_of(path)] == [
        "a row behind the last, 1,048,576, in 'Option Space'"
    ]


def test_dimensions_that_lie_lose_no_rows(tmp_path: Path) -> None:
    """A sheet that claims to be one cell is read as far as it goes."""
    path = tmp_path / "book.xlsx"
    tiny_export(path)
    good = read_to_the_end(path)
    change_part(path, SHEET_PART, lambda xml: replaced(xml, b'ref="A1:N24"', b'ref="A1"'))
    assert len(read_to_the_end(path)) == len(good)


def test_any_damage_is_refused_or_harmless(tmp_path: Path) -> None:
    """Whatever bytes change, the file is read to its end or refused; nothing else is raised."""
    path = tmp_path / "book.xlsx"
    tiny_export(path)
    content = path.read_bytes()
    chance = random.Random(1)  # noqa: S311
    for _ in range(200):
        damaged = bytearray(content)
        for _ in range(chance.randint(1, 4)):
            damaged[chance.randrange(len(damaged))] = chance.randrange(256)
        path.write_bytes(damaged[: chance.choice([None, None, chance.randrange(len(content))])])
        with suppress(InputError):
            read_to_the_end(path)


def test_wrong_cells_are_no_business_of_the_file_checks(tmp_path: Path) -> None:
    """A workbook whose cells are wrong is still a workbook."""
    for case in CELL_CASES:
        package.open_workbook(package.read_package(case.write(tmp_path)), formulas=False)


def test_all_names_are_different() -> None:
    """Each case has its own file."""
    names = [case.name for case in (*FILE_CASES, *CELL_CASES, *FINE_CASES)]
    assert len(names) == len(set(names))
