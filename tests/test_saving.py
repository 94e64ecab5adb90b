"""Results are put in their place whole or not at all, and nothing of the designer's is lost."""

from __future__ import annotations

import errno
import io
import os
import shutil
import tempfile
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import openpyxl
import pytest
from bad_workbooks import Raw, tiny_export
from editing import Edit, edit, files, in_cell, typed
from openpyxl.chart import BarChart
from openpyxl.comments import Comment

from grasp_xl.cli.program import main
from grasp_xl.errors import OutputError
from grasp_xl.workbook.saving import save
from grasp_xl.workbook.stamp import is_untouched


@pytest.fixture
def export(tmp_path: Path) -> Path:
    """Write the tiny export."""
    path = tmp_path / "tiny.xlsx"
    tiny_export(path)
    return path


@pytest.fixture(scope="module")
def result(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Write the workbook of a run on the tiny export."""
    folder = tmp_path_factory.mktemp("result")
    tiny_export(folder / "tiny.xlsx")
    assert run(folder / "tiny.xlsx", "--generations", "300") == 0
    return folder / "tiny-result.xlsx"


@pytest.fixture
def book(result: Path, tmp_path: Path) -> Path:
    """Copy the workbook of a run to a folder of its own."""
    return Path(shutil.copy(result, tmp_path / "out.xlsx"))


def run(file: Path, *words: object) -> int:
    """Run ten generations."""
    return main(["run", str(file), "--generations", "10", "--quiet", *map(str, words)])


# --- targets ---


def test_a_result_is_written_beside_the_input_and_nothing_else(export: Path) -> None:
    before = export.read_bytes()
    assert run(export) == 0
    assert files(export.parent) == ["tiny-result.xlsx", "tiny.xlsx"]
    assert export.read_bytes() == before
    assert is_untouched(export.with_name("tiny-result.xlsx"))


@pytest.mark.parametrize(
    ("target", "found"),
    [
        ("nowhere/x.xlsx", "does not exist"),
        ("tiny.xlsx/x.xlsx", "does not exist"),
        (".", "is a folder"),
        ("folder.xlsx", "is a folder"),
        ("pipe.xlsx", "is no file"),
        ("x" * 300 + ".xlsx", "cannot be written"),
        ("readonly/x.xlsx", "read-only"),
    ],
)
@pytest.mark.parametrize("command", ["run", "new"])
def test_a_place_that_cannot_hold_a_file_is_refused_before_any_work(
    export: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
    command: str,
    target: str,
    found: str,
) -> None:
    folder = export.parent
    (folder / "folder.xlsx").mkdir()
    os.mkfifo(folder / "pipe.xlsx")
    (folder / "readonly").mkdir()
    monkeypatch.setattr(os, "access", lambda path, _: Path(path).name != "readonly")
    monkeypatch.setattr(f"grasp_xl.commands.{command}.read_book", None)  # nobody may ask for it
    before = files(folder)
    assert main([command, str(export), "-o", str(folder / target)]) == 3
    told = capsys.readouterr()
    assert found in told.err
    assert "Traceback" not in told.err
    assert files(folder) == before


@pytest.mark.parametrize("name", ["x", "x.csv", "x.xls", "x.xltm"])
def test_a_workbook_is_called_xlsx(export: Path, name: str) -> None:
    """Excel would not open it under another name."""
    assert run(export, "-o", export.with_name(name)) == 2
    assert files(export.parent) == [export.name]


def test_a_history_never_replaces_a_workbook(export: Path) -> None:
    for name, code in (("tiny.xlsx", 2), ("history", 2), ("nowhere/h.csv", 3)):
        assert run(export, "--history", export.parent / name) == code
    assert files(export.parent) == [export.name]


def test_a_link_to_the_input_is_the_input(export: Path) -> None:
    link = export.with_name("link.xlsx")
    link.symlink_to(export)
    assert run(export, "-o", link) == 2
    assert run(link, "-o", export) == 2


def test_a_link_that_leads_to_itself_is_no_place(export: Path) -> None:
    link = export.with_name("link.xlsx")
    link.symlink_to(link)
    assert run(export, "-o", link) == 3
    assert link.is_symlink()


def test_a_link_stays_a_link(export: Path) -> None:
    """What it points to is replaced."""
    link, file = export.with_name("link.xlsx"), export.with_name("file.xlsx")
    link.symlink_to(file)
    assert run(export, "-o", link) == 0
    assert link.is_symlink()
    assert is_untouched(file)


@pytest.mark.parametrize("lock", ["~$out.xlsx", ".~lock.out.xlsx#"])
def test_a_workbook_that_is_open_elsewhere_is_left_alone(
    export: Path, book: Path, lock: str
) -> None:
    """Excel and LibreOffice say so by a file beside it."""
    before = book.read_bytes()
    book.with_name(lock).touch()
    assert run(export, "-o", book) == 3
    assert run(book, "--in-place") == 3
    assert book.read_bytes() == before
    assert run(export, "-o", book, "--force") == 0


# --- failures ---


def failing(kind: int) -> Callable[..., Any]:
    """Make a temporary file that fails when it is written to."""
    make = tempfile.NamedTemporaryFile

    def broken(*words: Any, **settings: Any) -> Any:
        file = make(*words, **settings)

        def write(_: bytes) -> int:
            raise OSError(kind, os.strerror(kind))

        file.write = write  # type: ignore[method-assign]
        return file

    return broken


@pytest.mark.parametrize(
    ("kind", "reason"),
    [(errno.ENOSPC, "disk is full"), (errno.EDQUOT, "quota"), (errno.EIO, "Input/output error")],
)
def test_a_failing_disk_leaves_the_old_file_and_nothing_beside_it(
    export: Path,
    book: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
    kind: int,
    reason: str,
) -> None:
    before, names = book.read_bytes(), files(book.parent)
    monkeypatch.setattr(tempfile, "NamedTemporaryFile", failing(kind))
    assert run(export, "-o", book, "--seed", "2") == 3
    assert run(book, "--in-place") == 3
    told = capsys.readouterr().err
    assert told.count(reason) == 2
    assert "Traceback" not in told
    assert book.read_bytes() == before
    assert files(book.parent) == names


@pytest.mark.parametrize("error", [PermissionError(errno.EACCES, "denied"), KeyboardInterrupt()])
def test_a_file_that_cannot_be_moved_into_place_is_taken_away(
    export: Path, monkeypatch: pytest.MonkeyPatch, error: BaseException
) -> None:
    """As on Windows where Excel holds the old one open, or at a second Ctrl-C."""

    def refused(*_: object) -> None:
        raise error

    monkeypatch.setattr(Path, "replace", refused)
    assert run(export) == (3 if isinstance(error, OSError) else 130)
    assert files(export.parent) == [export.name]


def test_a_bug_in_the_writer_leaves_the_old_file(
    export: Path, book: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    before = book.read_bytes()
    monkeypatch.setattr("grasp_xl.commands.output.full_workbook", None)
    with pytest.raises(TypeError):
        run(export, "-o", book, "--seed", "2")
    assert book.read_bytes() == before


def test_a_replaced_file_keeps_its_permissions(export: Path, book: Path) -> None:
    book.chmod(0o640)
    assert run(export, "-o", book) == 0
    assert book.stat().st_mode & 0o777 == 0o640


# --- edited outputs ---


def test_an_untouched_output_is_replaced_and_an_edited_one_needs_force(
    export: Path, book: Path
) -> None:
    assert run(export, "-o", book) == 0
    edit(book, typed("Seed", 2))
    before = book.read_bytes()
    assert run(export, "-o", book) == 3
    assert book.read_bytes() == before
    assert run(export, "-o", book, "--force") == 0
    assert is_untouched(book)


@pytest.mark.parametrize("content", [b"", b"letters", b"PK\x03\x04 no archive"])
def test_a_file_that_was_never_ours_needs_force(export: Path, content: bytes) -> None:
    output = export.with_name("out.xlsx")
    output.write_bytes(content)
    assert run(export, "-o", output) == 3
    assert main(["new", str(export), "-o", str(output)]) == 3
    assert output.read_bytes() == content
    assert run(export, "-o", output, "--force") == 0


def test_sheets_of_others_are_named_before_and_after_they_are_replaced(
    export: Path, book: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Refused with their names; with --force a warning says that they are lost, also in place."""
    assert run(export, "-o", book) == 0
    capsys.readouterr()
    edit(book, lambda opened: opened.create_sheet("My notes"))
    edited = book.read_bytes()
    for words in ((export, "-o", book), (book, "--in-place")):
        book.write_bytes(edited)
        assert run(*words) == 3
        assert "the sheet 'My notes'" in capsys.readouterr().err
        assert book.read_bytes() == edited
        assert main(["run", *map(str, words), "--force", "--generations", "9", "--no-prove"]) == 0
        told = capsys.readouterr().err
        assert "found the sheet 'My notes' before it was replaced" in told
        assert "as --force was given, that is lost" in told


def test_a_history_that_cannot_be_written_does_not_hide_the_workbook(
    export: Path, book: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """The workbook is complete by then, and the message says so."""
    history = export.with_name("history.csv")

    def full(content: bytes, target: Path) -> None:
        if target == history:
            raise OutputError(f"{target} cannot be written: the disk is full.")
        save(content, target)

    monkeypatch.setattr("grasp_xl.commands.run.save", full)
    assert run(export, "-o", book, "--history", history) == 3
    assert f"The workbook {book} is written." in capsys.readouterr().err
    assert is_untouched(book)


def test_any_changed_part_breaks_the_mark(book: Path) -> None:
    """Each part but the one that bears it, and also a part more or less."""
    parts = {}
    with zipfile.ZipFile(book) as archive:
        parts = {name: archive.read(name) for name in archive.namelist()}
    for name in parts:
        for changed in (parts | {name: parts[name] + b" "}, {**parts, "more": b""}):
            file = io.BytesIO()
            with zipfile.ZipFile(file, "w") as archive:
                for part, content in changed.items():
                    archive.writestr(part, content)
            assert is_untouched(file) == (name == "docProps/custom.xml" and "more" not in changed)


# --- in place ---

GENES = ((2, 5, 6, 1, 1, 1), (3, 2, 4, 5, 1, 1))
"""A grasp that no search would choose."""


def type_genes(name: str) -> Edit:
    """Make an edit of all genes of a block."""

    def change(opened: openpyxl.Workbook) -> None:
        for row, genes in enumerate(GENES):
            for column, gene in enumerate(genes):
                typed(name, gene, row, column)(opened)

    return change


def named(book: Path, *names: str) -> list[tuple[tuple[Any, ...], ...]]:
    """Read named areas."""
    opened = openpyxl.load_workbook(book, data_only=True)
    areas = []
    for name in names:
        sheet, cells = opened.defined_names[name].attr_text.replace("$", "").split("!")
        first, _, last = cells.partition(":")
        rows = opened[sheet.strip("'")][f"{first}:{last or first}"]
        areas.append(tuple(tuple(cell.value for cell in row) for row in rows))
    return areas


def test_in_place_nothing_is_named_in_what_was_only_saved_again(book: Path) -> None:
    """As it is, and also where another program lost all cached values."""
    assert run(book, "--in-place") == 0
    edit(book, lambda _: None)
    assert not is_untouched(book)
    assert run(book, "--in-place") == 0
    assert is_untouched(book)
    assert files(book.parent) == [book.name]


def test_in_place_a_sorted_list_is_still_ours(book: Path) -> None:
    def sort(opened: openpyxl.Workbook) -> None:
        for first, second in zip(*opened["History"].iter_rows(4, 5, 1, 20), strict=True):
            first.value, second.value = second.value, first.value

    edit(book, sort)
    assert run(book, "--in-place") == 0


def test_in_place_a_list_that_was_emptied_is_no_traceback(book: Path) -> None:
    """What was listed beside it is named then, since we no longer know it as ours."""
    edit(book, lambda opened: opened["History"].delete_rows(4, 1000))
    assert run(book, "--in-place") in (0, 3)
    assert run(book, "--in-place", "--force") == 0


@pytest.mark.parametrize(
    "values",
    [
        {"CostGoal": 105, "SuctionPrice": 12, "PartMass": 8000, "FoSGoal": 2, "SuctionWeight": 5},
        {"Children": 3},
        {"Children": 9, "SuctionMax": 7},
    ],
)
def test_in_place_inputs_are_carried_and_not_named(book: Path, values: dict[str, float]) -> None:
    """Also where other sizes move the cards."""
    edit(book, lambda opened: [typed(*item)(opened) for item in values.items()])
    assert run(book, "--in-place") == 0
    assert named(book, *values) == [((value,),) for value in values.values()]


def test_in_place_typed_genes_are_carried_and_not_named(book: Path) -> None:
    edit(book, lambda opened: [type_genes(n)(opened) for n in ("UserChromosome", "WhatIf")])
    for _ in range(2):
        assert run(book, "--in-place") == 0
        assert named(book, "UserChromosome", "WhatIf") == [GENES, GENES]
    edit(book, typed("SuctionMax", 6))
    assert run(book, "--in-place") == 0
    wider = tuple((*genes, 1) for genes in GENES)
    assert named(book, "UserChromosome", "WhatIf") == [wider, wider]


def add_charts(opened: openpyxl.Workbook) -> None:
    """Put more charts on a sheet than openpyxl lost."""
    for row in range(90, 110):
        opened["GA"].add_chart(BarChart(), f"A{row}")


def add_comment(opened: openpyxl.Workbook) -> None:
    """Comment on a cell of ours."""
    opened["Run Log"]["A3"].comment = Comment("Ask Eva.", "Ada")


LOSSES: dict[str, tuple[Edit, str]] = {
    "a sheet": (lambda opened: opened.create_sheet("Notes").append(["x"]), "the sheet 'Notes'"),
    "a sheet of formulas": (
        lambda opened: opened.create_sheet("Sums").append(["=1+1"]),
        "the sheet 'Sums'",
    ),
    "a note below the cards": (in_cell("GA", "A90", "Note"), "the cells GA!A90"),
    "a formula without a value": (in_cell("GA", "B90", "=1+1"), "GA!B90"),
    "a note below a list": (in_cell("Option Space", "M60", "Note"), "cells Option Space!M60"),
    "a note beside the designs": (in_cell("Valid Designs", "CZ9", 1), "Valid Designs!CZ9"),
    "a note below the designs": (in_cell("Valid Designs", "B9999", 1), "Valid Designs!B9999"),
    "a note in the log": (in_cell("Run Log", "C5", "Note"), "cells Run Log!C5"),
    "a link": (
        lambda opened: setattr(opened["Run Log"]["A3"], "hyperlink", "https://example.org"),
        "the hyperlinks on Run Log!A3",
    ),
    "a comment": (add_comment, "the notes on Run Log!A3"),
    "charts": (add_charts, "the charts '' at GA!A90, '' at GA!A91"),
}
"""What openpyxl can add, and how it is named."""

PARTS = {
    "xl/media/image1.png": (b"", "pictures (1 more"),
    "xl/drawings/drawing9.xml": (b'<a><xdr:sp macro=""/><xdr:sp/></a>', "boxes (2 more"),
    "xl/threadedComments/threadedComment1.xml": (b"<threadedComment />", "threaded comments (1"),
    "xl/vbaProject.bin": (b"", "macro modules (1"),
    "xl/pivotTables/pivotTable1.xml": (b"<a/>", "pivot tables (1"),
    "xl/externalLinks/externalLink1.xml": (b"<a/>", "links to other workbooks (1"),
    "xl/drawings/vmlDrawing9.vml": (
        b'<x:ClientData ObjectType="Drop"/><x:ClientData ObjectType="Note"/>',
        "controls (1",
    ),
}
"""What Excel can add, and how it is named."""


def test_in_place_all_that_would_be_lost_is_named_before_any_search(
    book: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """At once; it is lost by --force only, or kept by another output."""
    edit(book, lambda opened: [change(opened) for change, _ in LOSSES.values()])
    with zipfile.ZipFile(book, "a") as archive:
        for part, (content, _) in PARTS.items():
            archive.writestr(part, content)
    before = book.read_bytes()
    with monkeypatch.context() as patch:
        patch.setattr("grasp_xl.cli.run._stop_rules", None)  # asked for when the search begins
        assert run(book, "--in-place") == 3
    found = capsys.readouterr().err
    for _, told in (*LOSSES.values(), *PARTS.values()):
        assert told in found
    assert book.read_bytes() == before
    assert files(book.parent) == [book.name]
    assert run(book, "--in-place", "--force") == 0
    assert is_untouched(book)


def test_in_place_a_formula_in_an_input_cell_is_named(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Only its value would be left."""
    export = tmp_path / "tiny.xlsx"
    tiny_export(export, {"B5": Raw("><f>1000*8.86</f><v>8860</v>")})
    assert run(export, "--in-place") == 3
    assert "the formulas in Option Space!B5" in capsys.readouterr().err
    assert run(export) == 0


def test_in_place_an_export_becomes_the_full_workbook(tmp_path: Path) -> None:
    """Whatever its sheet is called."""
    export = tmp_path / "tiny.xlsx"
    tiny_export(export)
    edit(export, lambda opened: setattr(opened["Option Space"], "title", "Sheet1"))
    assert run(export, "--in-place") == 0
    assert "GA" in openpyxl.load_workbook(export, read_only=True).sheetnames
