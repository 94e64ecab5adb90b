"""What a designer picks from the list, pastes and types on the What-if card is read and kept."""

from __future__ import annotations

import shutil
import zipfile
from pathlib import Path

import openpyxl
import pytest
from bad_workbooks import tiny_export
from editing import cell_of, edit, typed

from grasp_xl.cli.program import main
from grasp_xl.workbook.book import Book, read_book
from grasp_xl.workbook.layout import TABLE_ROW
from grasp_xl.workbook.picker import GENE_COLUMN, PICK_ROW

Genes = list[list[int]]


@pytest.fixture(scope="module")
def result(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Write the workbook of a run on the tiny export."""
    folder = tmp_path_factory.mktemp("result")
    tiny_export(folder / "tiny.xlsx")
    assert run(folder / "tiny.xlsx", "--goals", "1000,90000,900,9000") == 0
    return folder / "tiny-result.xlsx"


@pytest.fixture
def book(result: Path, tmp_path: Path) -> Path:
    """Copy the workbook of a run to a folder of its own."""
    return Path(shutil.copy(result, tmp_path / "out.xlsx"))


def run(file: Path, *words: object) -> int:
    """Run three hundred generations."""
    return main(["run", str(file), "--generations", "300", "--quiet", *map(str, words)])


def design(book: Path, number: int) -> Genes:
    """Return the genes of a design of the list."""
    sheet = openpyxl.load_workbook(book)["Valid Designs"]
    row, first = TABLE_ROW + 1 + number, GENE_COLUMN + 1
    genes = [sheet.cell(row, column).value for column in range(first, first + 12)]
    return [genes[:6], genes[6:]]


def shown_what_if(book: Path) -> Genes:
    """Return the What-if genes that a reader sees who does not calculate."""
    opened = openpyxl.load_workbook(book, data_only=True)
    return [[cell_of(opened, "WhatIf", row, column).value for column in range(6)] for row in (0, 1)]


def what_if(book: Book) -> Genes | None:
    """Return the typed What-if genes."""
    return book.what_if.genes.tolist() if book.what_if else None


def with_cup_3(genes: Genes) -> Genes:
    """Return genes whose last, inactive cup index is 3."""
    return [[*genes[0][:-1], 3], genes[1]]


# --- our formulas have no stored value ---


def test_one_typed_gene_among_our_formulas_is_read(book: Path) -> None:
    """Though openpyxl lost all stored values: the others are those that our formulas show."""
    best = shown_what_if(book)
    edit(book, typed("WhatIf", 3, 0, 5))
    assert what_if(read_book(book)) == with_cup_3(best)
    edit(book, typed("DesignPick", 2))
    assert what_if(read_book(book)) == with_cup_3(design(book, 2))


@pytest.mark.parametrize("command", ["run", "new"])
def test_one_typed_gene_among_our_formulas_is_carried(
    result: Path, book: Path, command: str
) -> None:
    wanted = with_cup_3(shown_what_if(book))
    edit(book, typed("WhatIf", 3, 0, 5))
    export = str(result.with_name("tiny.xlsx"))
    assert (run(book, "--in-place") if command == "run" else new(export, book)) == 0
    assert shown_what_if(book) == wanted
    assert what_if(read_book(book)) == wanted


def new(export: str, book: Path) -> int:
    """Make a workbook of an export, into one that exists."""
    return main(["new", export, "-o", str(book), "--quiet"])


def test_the_picked_rows_may_be_pasted_as_formulas(book: Path) -> None:
    """Without stored values the user-defined grasp is still the picked design."""

    def paste(opened: openpyxl.Workbook) -> None:
        for row in range(2):
            for column in range(6):
                picked = opened["Valid Designs"].cell(PICK_ROW + 3 + row, 2 + column)
                cell_of(opened, "UserChromosome", row, column).value = picked.value
        cell_of(opened, "DesignPick").value = 2

    edit(book, paste)
    user = read_book(book).user_chromosome
    assert user is not None
    assert user.genes.tolist() == design(book, 2)
    assert run(book, "--in-place") == 0  # and it is no stranger's formula that would be lost


def test_nothing_is_typed_where_all_genes_are_ours(book: Path) -> None:
    """Whatever is picked, and whoever saved the workbook."""
    assert what_if(read_book(book)) is None
    for number in (None, 1, 9999, "abc"):
        edit(book, typed("DesignPick", number))
        assert what_if(read_book(book)) is None


def test_somebodys_formula_on_the_card_is_read_by_its_value(
    result: Path, book: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """If it has none, that is an error, also where an export goes into the workbook."""
    edit(book, typed("WhatIf", "=1+2", 0, 1))
    export = str(result.with_name("tiny.xlsx"))
    for command in (lambda: run(book, "--in-place"), lambda: new(export, book)):
        assert command() == 3
        assert "a formula without a stored value" in capsys.readouterr().err


def test_somebodys_formula_on_the_card_is_named_before_it_is_lost(
    book: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Its value would stay, but not the formula; ours may be replaced by ours."""
    opened = openpyxl.load_workbook(book)
    cell = cell_of(opened, "WhatIf")
    where = f"GA!{cell.coordinate}"
    edit(book, typed("WhatIf", "=$E$9"))
    with zipfile.ZipFile(book) as parts:
        content = {name: parts.read(name) for name in parts.namelist()}
    sheet = next(name for name, data in content.items() if b"<f>$E$9</f>" in data)
    content[sheet] = content[sheet].replace(b"<f>$E$9</f><v></v>", b"<f>$E$9</f><v>2</v>")
    content[sheet] = content[sheet].replace(b"<f>$E$9</f><v />", b"<f>$E$9</f><v>2</v>")
    with zipfile.ZipFile(book, "w") as parts:
        for name, data in content.items():
            parts.writestr(name, data)
    assert run(book, "--in-place") == 3
    assert f"the formulas in {where}" in capsys.readouterr().err


# --- the pick ---


def picked_number(book: Path) -> object:
    """Return the number that is picked."""
    return cell_of(openpyxl.load_workbook(book), "DesignPick").value


def test_a_picked_design_stays_picked_where_the_list_still_has_it(book: Path) -> None:
    """The What-if card shows it, and still follows another pick."""
    wanted = design(book, 2)
    edit(book, typed("DesignPick", 2))
    assert run(book, "--in-place") == 0
    number = picked_number(book)
    assert design(book, number) == shown_what_if(book) == wanted
    assert what_if(read_book(book)) is None


def test_a_picked_design_that_the_list_no_longer_has_stays_on_the_card(
    result: Path, book: Path
) -> None:
    """As typed genes: after a run of another course, and after a new export."""
    wanted = design(book, 2)
    edit(book, typed("DesignPick", 2))
    again = Path(shutil.copy(book, book.with_name("again.xlsx")))
    assert run(book, "--in-place", "--seed", 77, "--start", "random") == 0
    assert wanted not in designs(book)
    assert new(str(result.with_name("tiny.xlsx")), again) == 0
    for path in (book, again):
        assert picked_number(path) is None
        assert what_if(read_book(path)) == shown_what_if(path) == wanted


def designs(book: Path) -> list[Genes]:
    """Return all designs of the list."""
    rows = openpyxl.load_workbook(book)["Valid Designs"].tables["ValidDesigns"].ref
    return [design(book, number) for number in range(1, int(rows.rpartition("Z")[2]) - TABLE_ROW)]


def test_a_pick_beside_typed_genes_stays_and_so_do_they(book: Path) -> None:
    edit(book, typed("DesignPick", 2))
    wanted = with_cup_3(design(book, 2))
    edit(book, typed("WhatIf", 3, 0, 5))
    assert run(book, "--in-place") == 0
    assert (picked_number(book), shown_what_if(book)) == (2, wanted)


def test_a_picked_design_with_a_place_that_is_gone_is_named(
    tmp_path: Path, book: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    edit(book, typed("DesignPick", 2))
    least = tmp_path / "least.xlsx"
    gone = {f"{c}{r}": None for c in "DEF" for r in range(6, 11)}
    tiny_export(least, {"B16": 1, "B11": 0} | gone)  # one cup
    assert main(["new", str(least), "-o", str(book)]) == 0
    assert "What-if, suction Index 1: found index" in capsys.readouterr().err


def test_a_picked_design_that_cannot_be_any_more_is_told(
    book: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    edits = (typed("DesignPick", 2), typed("SuctionMax", 1), typed("UserChromosome", 1))
    edit(book, lambda opened: [change(opened) for change in edits])
    assert main(["check", str(book)]) == 0
    assert "a design that the option space no longer has" in capsys.readouterr().err
