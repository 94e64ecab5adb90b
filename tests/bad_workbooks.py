"""Tiny workbooks, one for each way of being wrong: ``python tests/bad_workbooks.py FOLDER``.

``FILE_CASES`` are wrong as files, ``CELL_CASES`` in their cells, ``FINE_CASES`` only look odd.
Each case says word by word what must be found wrong.  An empty ``where`` stands for the file
itself; an empty ``hint`` for any.
"""

from __future__ import annotations

import random
import struct
import sys
import zipfile
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from datetime import date
from functools import partial
from pathlib import Path

import xlsxwriter
from xlsxwriter.utility import xl_cell_to_rowcol, xl_rowcol_to_cell
from xlsxwriter.worksheet import Worksheet

from grasp_xl.errors import Problem
from grasp_xl.workbook import package

SHEET = "Option Space"
GA = "GA"
SHEET_PART = "xl/worksheets/sheet1.xml"
LAST_ROW = 1_048_576
SCALE = 0.6
CENTROID = (1.5, -0.8, 5.0)
CUPS = tuple((x, y, 10.0) for x in (100.0, 0.0, -100.0) for y in (60.0, -60.0))
MAGNETS = (
    (100.0, 60.0, 10.0),  # where cup 1 stands, too: every export has such places
    (100.0, -60.0, 10.0),
    (50.0, 0.0, 10.0),
    (-50.0, 0.0, 10.0),
    (-100.0, 60.0, 10.0),
    (-100.0, -60.0, 10.0),
)
PLATE = ((150.0, -100.0, 10.0), (150.0, 100.0, 10.0), (-150.0, 100.0, 10.0), (-150.0, -100.0, 10.0))


@dataclass(frozen=True, slots=True)
class Raw:
    """XML of a cell after ``<c r="B5"``, for what XlsxWriter would not write."""

    xml: str


Value = str | float | bool | date | Raw | None
_TRUE, _FALSE = True, False  # named, since ruff (FBT003) allows no bare ones as arguments
Cells = dict[str, Value]
Builder = Callable[[Path], None]


@dataclass(frozen=True, slots=True)
class Case:
    """A wrong workbook: its name, how to make it, and the problems that must be found in it."""

    name: str
    build: Builder
    problems: tuple[Problem, ...] = ()

    def write(self, folder: Path) -> Path:
        """Make the workbook in a folder; its content, not its name, says what it is."""
        path = folder / f"{self.name}.xlsx"
        self.build(path)
        return path


FILE_CASES: list[Case] = []
CELL_CASES: list[Case] = []
FINE_CASES: list[Case] = []


def wrong_file(found: str, expected: str, hint: str) -> Callable[[Builder], Builder]:
    """Register a builder of a wrong file under its own name."""

    def register(build: Builder) -> Builder:
        problem = Problem("", found, expected, hint)
        FILE_CASES.append(Case(build.__name__, build, (problem,)))
        return build

    return register


# --- a good export ---


def export_rows() -> Cells:
    """Cells of a tiny export: 6 cups and 6 magnets on a plate of 300 x 200 mm.

    It weighs 86.9 N, so at FoS 3 two magnets and a cup (329 N) can lift it, 46 mm apart.
    """
    cells: Cells = {
        "A1": "INPUT PARAMETERS (ALL DATA in GRAMS, MILLIMETERS, and NEWTONS)",
        "A2": "Attribute",
        "B2": "Value",
        "C2": "Index",
        "D2": "Suction cup locations",
        "G2": "Magnet locations",
        "A4": "Part data",
        "K1": "Scale Factor:",
        "L1": SCALE,
    }
    for column, axis in zip("DEFGHI", "XYZXYZ", strict=True):
        cells |= {f"{column}3": "(mm)", f"{column}4": axis}
    cells |= {f"{column}2": title for column, title in zip("KLMN", "ixyz", strict=True)}
    part = ("Part mass (g)", 8860), *zip(_CENTROID_LABELS, CENTROID, strict=True)
    cells |= _attributes(5, part)
    cells |= {"A10": "Suction cup data"} | _attributes(11, _kind("Suction Cups", 69, 10, 15))
    cells |= {"A16": "Total #  suction cups", "B16": len(CUPS)}
    cells |= {"A18": "Magnet data"} | _attributes(19, _kind("Magnets", 130, 30, 110))
    cells |= {"A24": "Total # magnets", "B24": len(MAGNETS)}
    cells |= {f"C{row}": row - 4 for row in range(5, 5 + len(CUPS))}
    cells |= _points("DEF", 5, CUPS) | _points("GHI", 5, MAGNETS)
    return cells | polygon_rows(PLATE)


_CENTROID_LABELS = ("Centroid X (mm)", "Centroid Y (mm)", "Centroid Z (mm)")


def _kind(
    name: str, force: float, price: float, weight: float
) -> tuple[tuple[str, str | float], ...]:
    return (
        (f"# {name} (Min.)", 1),
        (f"# {name} (Max.)", 5),
        ("Normal force capacity (N)", force),
        ("Unit price ($)", price),
        ("Weight (g)", weight),
    )


_PARAMETERS: tuple[tuple[str, str | float], ...] = (
    ("User-Defined Starting Chromosome", 1),
    ("Elitism", 0),
    ("1-in-n Mutation Probability", 3),
    ("Number of Generations", 2000),
    ("Minimum Gripper Element Distance (mm)", 50),
    ("Structure Linear Density Ratio", 2),
    ("Fitness Criterion", "cost+moment"),
    ("FoS", 2.5),
    ("Cost ($)", 60),
    ("Residual Moment (N-mm)", 9000),
    ("Deviation (mm)", 30),
    ("Structure (mm)", 700),
    ("Children per Generation", 7),
    ("Seed", 9),
    ("Moment Arm", "plan"),
)


def _attributes(first_row: int, attributes: tuple[tuple[str, str | float], ...]) -> Cells:
    cells: Cells = {}
    for row, (label, value) in enumerate(attributes, first_row):
        cells |= {f"A{row}": label, f"B{row}": value}
    return cells


def _points(columns: str, first_row: int, points: tuple[tuple[float, ...], ...]) -> Cells:
    return {
        f"{column}{row}": value
        for row, point in enumerate(points, first_row)
        for column, value in zip(columns, point, strict=True)
    }


def polygon_rows(corners: tuple[tuple[float, ...], ...]) -> Cells:
    """Cells K3.. of the ideal polygon, scaled from the part's corners, and of the centroid."""
    ideal = tuple(
        tuple(c + SCALE * (p - c) for p, c in zip(corner, CENTROID, strict=True))
        for corner in corners
    )
    cells: Cells = {f"{column}{row}": None for row in range(3, 10) for column in "KLMN"}
    cells |= {f"K{row}": row - 2 for row in range(3, 3 + len(ideal))}
    cells |= _points("LMN", 3, ideal)
    centroid_row = 4 + len(ideal)
    return cells | {f"K{centroid_row}": "Centroid"} | _points("LMN", centroid_row, (CENTROID,))


def shifted(cells: Cells, *, rows: int = 0, columns: int = 0, after: int = 0) -> Cells:
    """Insert empty rows above, and empty columns behind the first ``after`` columns."""
    moved: Cells = {}
    for cell, value in cells.items():
        row, column = xl_cell_to_rowcol(cell)
        moved[xl_rowcol_to_cell(row + rows, column + columns * (column >= after))] = value
    return moved


def ga_rows() -> Cells:
    """Cells of a GA sheet: parameters, and a designer's grasp of cups 1 and 4 and magnet 3."""
    chromosome: Cells = {"D7": "User-Defined Chromosome"}
    rows = (
        ("Total #", "Index 1", "Index 2", "Index 3", "Index 4", "Index 5"),
        (2, 1, 4, 1, 1, 1),
        (1, 3, 1, 1, 1, 1),
    )
    for number, (label, row) in enumerate(zip((None, "Suction", "Magnets"), rows, strict=True), 8):
        chromosome |= {f"D{number}": label}
        chromosome |= {f"{column}{number}": v for column, v in zip("EFGHIJ", row, strict=True)}
    return {"A3": "Attribute", "B3": "Value"} | _attributes(4, _PARAMETERS) | chromosome


def tiny_export(path: Path, change: Mapping[str, Value] | None = None) -> None:
    """Write the tiny export, with some of its cells changed."""
    write_book(path, {SHEET: export_rows() | dict(change or {})})


def write_book(
    path: Path, sheets: Mapping[str, Cells], names: Mapping[str, str] | None = None
) -> None:
    """Write sheets of cells, and defined names."""
    with xlsxwriter.Workbook(path) as book:
        for name, reference in (names or {}).items():
            book.define_name(name, f"={reference}")
        day = book.add_format({"num_format": "yyyy-mm-dd"})
        for name, content in sheets.items():
            sheet = book.add_worksheet(name)
            for cell, value in content.items():
                if isinstance(value, date):
                    sheet.write_datetime(cell, value, day)
                else:
                    _write(sheet, cell, value)
    for number, content in enumerate(sheets.values(), 1):
        raw = {cell: value.xml for cell, value in content.items() if isinstance(value, Raw)}
        if raw:
            change_part(path, f"xl/worksheets/sheet{number}.xml", partial(_put_raw, raw_cells=raw))


def _write(sheet: Worksheet, cell: str, value: str | float | Raw | None) -> None:
    if isinstance(value, bool):
        sheet.write_boolean(cell, value)
    elif isinstance(value, str):
        sheet.write_string(cell, value)
    elif isinstance(value, Raw):
        sheet.write_number(cell, _PLACEHOLDER)
    elif value is not None:
        sheet.write_number(cell, value)


_PLACEHOLDER = 987654321


def _put_raw(xml: bytes, raw_cells: Mapping[str, str]) -> bytes:
    for cell, raw in raw_cells.items():
        written = f'<c r="{cell}"><v>{_PLACEHOLDER}</v></c>'.encode()
        xml = replaced(xml, written, f'<c r="{cell}"{raw}</c>'.encode())
    return xml


def replaced(content: bytes, old: bytes, new: bytes) -> bytes:
    """Replace what must be there."""
    assert old in content, old
    return content.replace(old, new)


# --- what can be done to the parts ---


def parts_of(path: Path) -> dict[str, bytes]:
    """Read all parts of a workbook."""
    with zipfile.ZipFile(path) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def write_parts(
    path: Path, parts: Mapping[str, bytes], compression: int = zipfile.ZIP_DEFLATED
) -> None:
    """Write parts as a zip archive."""
    with zipfile.ZipFile(path, "w", compression) as archive:
        for name, content in parts.items():
            archive.writestr(name, content)


def change_part(path: Path, part: str, change: Callable[[bytes], bytes]) -> None:
    """Change one part of a workbook."""
    parts = parts_of(path)
    write_parts(path, parts | {part: change(parts[part])})


def good_parts(path: Path) -> dict[str, bytes]:
    """Write a good export and read its parts again."""
    tiny_export(path)
    return parts_of(path)


# --- wrong as files ---

# Said again word by word, so that a change of the messages is seen.
DAMAGED = ("a whole, undamaged workbook", "copy, download or export it again")
A_WORKBOOK = "an Excel workbook (.xlsx or .xlsm)"
SAVE_IN_EXCEL = 'open it in Excel, choose File > Save As and the type "Excel Workbook (*.xlsx)"'
ONE_SHEET_ONLY = "save a copy that has the option space's sheet only"
UNSAFE = (
    "plain XML, as every spreadsheet program writes it",
    "do not open it; ask for a new export from a source that you trust",
)
BOMB = (
    "at most 32 MB in a file of this size",
    "do not open it unless you trust its source; " + ONE_SHEET_ONLY,
)


@wrong_file("no such file", A_WORKBOOK, "check the spelling and the folder")
def missing_file(path: Path) -> None:
    path.unlink(missing_ok=True)


@wrong_file("a folder", A_WORKBOOK, "name the workbook in it")
def folder(path: Path) -> None:
    path.mkdir(exist_ok=True)


@wrong_file("an empty file (0 bytes)", A_WORKBOOK, "copy, download or export it again")
def empty_file(path: Path) -> None:
    path.write_bytes(b"")


@wrong_file("a file of 129 MB", "at most 128 MB", ONE_SHEET_ONLY)
def too_large(path: Path) -> None:
    with path.open("wb") as file:
        file.truncate(package.MAX_FILE_BYTES + 1)  # a sparse file: it takes no place on the disk


@wrong_file(
    "bytes that are no workbook",
    A_WORKBOOK,
    "check that this is the right file, or export it again",
)
def not_a_zip(path: Path) -> None:
    path.write_bytes(bytes(range(256)))


@wrong_file("plain text (such as .csv, .xml or .html)", A_WORKBOOK, SAVE_IN_EXCEL)
def csv(path: Path) -> None:
    path.write_bytes("Part mass (g);8860\r\nGröße;300\r\n".encode("latin-1"))


@wrong_file("plain text (such as .csv, .xml or .html)", A_WORKBOOK, SAVE_IN_EXCEL)
def csv_in_utf_16(path: Path) -> None:
    path.write_text("Part mass (g)\t8860\n", encoding="utf-16")


def ole_file(*streams: str) -> bytes:
    """Make the beginning of an OLE file: a header, and a directory entry for each stream."""
    entries = [name.encode("utf-16-le").ljust(128, b"\0") for name in ("Root Entry", *streams)]
    return b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1".ljust(512, b"\0") + b"".join(entries)


@wrong_file("an Excel 97-2003 workbook (.xls)", A_WORKBOOK, SAVE_IN_EXCEL)
def xls(path: Path) -> None:
    path.write_bytes(ole_file("Workbook"))


@wrong_file(
    "a workbook encrypted with a password",
    "a workbook without a password",
    "open it in Excel, clear the password under File > Info > Protect Workbook > Encrypt with "
    "Password, and save it",
)
def encrypted(path: Path) -> None:
    path.write_bytes(ole_file("EncryptionInfo", "EncryptedPackage"))


@wrong_file(
    "an old Office file that is no workbook",
    A_WORKBOOK,
    "check that this is the right file, or export it again",
)
def old_word_document(path: Path) -> None:
    path.write_bytes(ole_file("WordDocument"))


@wrong_file(
    "an OpenDocument spreadsheet (.ods)",
    A_WORKBOOK,
    'open it in LibreOffice, choose File > Save As and the type "Excel 2007-365 (.xlsx)"',
)
def ods(path: Path) -> None:
    kind = b"application/vnd.oasis.opendocument.spreadsheet"
    write_parts(path, {"mimetype": kind, "content.xml": b"<a/>"}, zipfile.ZIP_STORED)


@wrong_file("a binary workbook (.xlsb)", A_WORKBOOK, SAVE_IN_EXCEL)
def xlsb(path: Path) -> None:
    parts = good_parts(path)
    old = b"application/vnd.openxmlformats-officedocument.spreadsheetml.sheet.main+xml"
    new = b"application/vnd.ms-excel.sheet.binary.macroEnabled.main"
    types = replaced(parts.pop("[Content_Types].xml"), old, new)
    write_parts(path, parts | {"[Content_Types].xml": types})


@wrong_file(
    'a workbook of the type "Strict Open XML Spreadsheet (*.xlsx)"',
    'one of the type "Excel Workbook (*.xlsx)"',
    SAVE_IN_EXCEL,
)
def strict_open_xml(path: Path) -> None:
    namespaces = {
        b"http://schemas.openxmlformats.org/spreadsheetml/2006/main": b"http://purl.oclc.org/ooxml/"
        b"spreadsheetml/main",
        b"http://schemas.openxmlformats.org/officeDocument/2006/": b"http://purl.oclc.org/ooxml/"
        b"officeDocument/",
    }
    parts = good_parts(path)
    for transitional, strict in namespaces.items():
        parts = {name: xml.replace(transitional, strict) for name, xml in parts.items()}
    write_parts(path, parts)


NO_WORKBOOK_INSIDE = (
    "a zip archive that is no workbook",
    A_WORKBOOK,
    "if the workbook is inside this archive, take it out and name that",
)


@wrong_file(*NO_WORKBOOK_INSIDE)
def zipped_workbook(path: Path) -> None:
    tiny_export(path)
    write_parts(path, {"export.xlsx": path.read_bytes()})


@wrong_file(*NO_WORKBOOK_INSIDE)
def empty_archive(path: Path) -> None:
    write_parts(path, {})


@wrong_file(*NO_WORKBOOK_INSIDE)
def no_content_types(path: Path) -> None:
    parts = good_parts(path)
    del parts["[Content_Types].xml"]
    write_parts(path, parts)


@wrong_file("no part 'xl/workbook.xml'", *DAMAGED)
def no_workbook_part(path: Path) -> None:
    parts = good_parts(path)
    del parts["xl/workbook.xml"]
    write_parts(path, parts)


@wrong_file(f"no part '{SHEET_PART}'", *DAMAGED)
def no_sheet_part(path: Path) -> None:
    parts = good_parts(path)
    del parts[SHEET_PART]
    write_parts(path, parts)


@wrong_file("no part 'xl/sharedStrings.xml'", *DAMAGED)
def no_strings_part(path: Path) -> None:
    parts = good_parts(path)
    del parts["xl/sharedStrings.xml"]
    write_parts(path, parts)


@wrong_file("no sheet that can be read", "a sheet", SAVE_IN_EXCEL)
def no_sheets(path: Path) -> None:
    tiny_export(path)
    sheet = f'<sheet name="{SHEET}" sheetId="1" r:id="rId1"/>'.encode()
    change_part(path, "xl/workbook.xml", lambda xml: replaced(xml, sheet, b""))


@wrong_file("a damaged workbook (syntax error: line 1, column 0)", *DAMAGED)
def workbook_part_is_no_xml(path: Path) -> None:
    tiny_export(path)
    change_part(path, "xl/workbook.xml", lambda _: b"sheets")


@wrong_file("a damaged workbook (a value that the file format does not have there)", *DAMAGED)
def font_size_is_text(path: Path) -> None:
    tiny_export(path)
    change_part(path, "xl/styles.xml", lambda xml: replaced(xml, b'<sz val="11"', b'<sz val="big"'))


@wrong_file(f"a damaged sheet '{SHEET}' (no element found: line 2, column 405)", *DAMAGED)
def sheet_part_breaks_off(path: Path) -> None:
    tiny_export(path)
    head = b'<?xml version="1.0" encoding="UTF-8" standalone="yes"?>\n'
    change_part(path, SHEET_PART, lambda xml: xml[: len(head) + 405])


@wrong_file("a workbook that breaks off before its end", *DAMAGED)
def truncated(path: Path) -> None:
    tiny_export(path)
    content = path.read_bytes()
    path.write_bytes(content[: len(content) // 2])


@wrong_file("a damaged workbook (Bad magic number for central directory)", *DAMAGED)
def middle_missing(path: Path) -> None:
    tiny_export(path)
    content = path.read_bytes()
    path.write_bytes(content[:1000] + content[-400:])


@wrong_file(f"a damaged part '{SHEET_PART}'", *DAMAGED)
def wrong_checksum(path: Path) -> None:
    write_parts(path, good_parts(path), zipfile.ZIP_STORED)
    path.write_bytes(replaced(path.read_bytes(), b"<v>8860</v>", b"<v>8861</v>"))


@wrong_file(f"a damaged part '{SHEET_PART}'", *DAMAGED)
def wrong_compression(path: Path) -> None:
    write_parts(path, good_parts(path))
    with zipfile.ZipFile(path) as archive:
        data = archive.getinfo(SHEET_PART).header_offset + 30 + len(SHEET_PART)
    content = path.read_bytes()
    path.write_bytes(content[:data] + b"\xff" + content[data + 1 :])


@wrong_file(f"an unknown compression of the part '{SHEET_PART}'", *DAMAGED)
def other_compression(path: Path) -> None:
    parts = good_parts(path)
    sheet = parts.pop(SHEET_PART)
    write_parts(path, parts)
    with zipfile.ZipFile(path, "a", zipfile.ZIP_BZIP2) as archive:
        archive.writestr(SHEET_PART, sheet)


@wrong_file(
    "a zip archive with a password",
    "a workbook without a password",
    "take the workbook out of the archive, or save it again without a password",
)
def zip_password(path: Path) -> None:
    tiny_export(path)
    content = bytearray(path.read_bytes())
    content[content.index(b"PK\x01\x02") + 8] |= 1
    path.write_bytes(content)


def part_of_zeros(path: Path) -> None:
    """Add a part of 40 MB that takes 40 kB in the file."""
    with zipfile.ZipFile(path, "a", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("xl/media/image1.png", bytes(40_000_000))


@wrong_file("parts that unpack to more than 32 MB, as a zip bomb does", *BOMB)
def zip_bomb(path: Path) -> None:
    tiny_export(path)
    part_of_zeros(path)


def declare_size(path: Path, size: int) -> None:
    """Make the archive claim another unpacked size for its last part."""
    content = bytearray(path.read_bytes())
    struct.pack_into("<I", content, content.rindex(b"PK\x03\x04") + 22, size)
    struct.pack_into("<I", content, content.rindex(b"PK\x01\x02") + 24, size)
    path.write_bytes(content)


@wrong_file("parts that unpack to more than 32 MB, as a zip bomb does", *BOMB)
def zip_bomb_that_lies(path: Path) -> None:
    tiny_export(path)
    part_of_zeros(path)
    declare_size(path, 100)


@wrong_file("a part 'docProps/app.xml' of another size than declared", *DAMAGED)
def size_that_lies(path: Path) -> None:
    parts = good_parts(path)
    properties = parts.pop("docProps/app.xml")
    write_parts(path, parts | {"docProps/app.xml": properties})
    declare_size(path, len(properties) + 1)


@wrong_file("33 MB in the part 'xl/styles.xml'", "at most 32 MB", ONE_SHEET_ONLY)
def huge_styles(path: Path) -> None:
    parts = good_parts(path)
    noise = random.Random(1).randbytes(1_000_000)  # noqa: S311 (so that the ratio is no bomb's)
    parts |= {"xl/styles.xml": b" " * 32_500_000, "xl/media/image1.png": noise}
    write_parts(path, parts)


@wrong_file("10,001 parts", "at most 10,000", ONE_SHEET_ONLY)
def too_many_parts(path: Path) -> None:
    write_parts(path, {f"{number}.xml": b"" for number in range(package.MAX_PARTS + 1)})


BILLION_LAUGHS = (
    "<!DOCTYPE worksheet [<!ENTITY a0 'ha'>"
    + "".join(f"<!ENTITY a{n} '{f'&a{n - 1};' * 10}'>" for n in range(1, 10))
    + "]>"
)


@wrong_file(
    f"a document type or entity declaration (<!DOCTYPE) in the part '{SHEET_PART}'", *UNSAFE
)
def entity_bomb(path: Path) -> None:
    tiny_export(path)
    bomb = BILLION_LAUGHS.encode() + b"<worksheet"
    change_part(path, SHEET_PART, lambda xml: replaced(xml, b"<worksheet", bomb))


@wrong_file(
    "a document type or entity declaration (<!DOCTYPE) in the part 'xl/workbook.xml'", *UNSAFE
)
def entity_bomb_in_utf_16(path: Path) -> None:
    tiny_export(path)
    bomb = f"{BILLION_LAUGHS}<workbook>&a9;</workbook>".encode("utf-16")
    change_part(path, "xl/workbook.xml", lambda _: bomb)


@wrong_file(
    "a document type or entity declaration (<!DOCTYPE) in the part 'xl/sharedStrings.xml'", *UNSAFE
)
def outside_document_type(path: Path) -> None:
    tiny_export(path)
    outside = b'<!DOCTYPE sst SYSTEM "http://example.com/sst.dtd"><sst '
    change_part(path, "xl/sharedStrings.xml", lambda xml: replaced(xml, b"<sst ", outside))


@wrong_file(
    "a document type or entity declaration (<!DOCTYPE) in one of its parts",
    *UNSAFE,
)
def hidden_entity_bomb(path: Path) -> None:
    tiny_export(path)
    bomb = f"<!-- <a> -->{BILLION_LAUGHS}<workbook>&a9;</workbook>".encode()
    change_part(path, "xl/workbook.xml", lambda _: bomb)


def changed_meanwhile(path: Path) -> None:
    """Write to a workbook as its own program might while it is read."""
    with path.open("ab") as file:
        file.write(b"more")


# --- wrong in their cells ---


def wrong_book(name: str, build: Builder, *problems: Problem) -> None:
    """Register a workbook that is wrong somewhere."""
    CELL_CASES.append(Case(name, build, problems))


def wrong_cells(name: str, change: Mapping[str, Value], *problems: Problem) -> None:
    """Register a tiny export with some cells changed."""
    wrong_book(name, lambda path: tiny_export(path, change), *problems)


def wrong_cell(name: str, cell: str, value: Value, found: str, expected: str) -> None:
    """Register a tiny export with one wrong cell."""
    wrong_cells(name, {cell: value}, Problem(f"{SHEET}!{cell}", found, expected))


def number_text(text: str) -> Raw:
    """Make a cell that claims to be a number."""
    return Raw(f"><v>{text}</v>")


A_MASS = "a mass above 0 g"
A_FORCE = "a force above 0 N"
A_COORDINATE = "a coordinate (mm)"
A_COUNT = "a whole number from 0 to 25"
A_SCALE_FACTOR = "a scale factor above 0 and at most 1"
A_WEIGHT = "a weight of 0 g or more, or nothing"
NOTHING = "an empty cell"
NO_VALUE = "a formula without a stored value"

# Not numbers, where one belongs.
wrong_cell("text_for_mass", "B5", "heavy", "the text 'heavy'", A_MASS)
wrong_cell("number_as_text", "B5", "8860", "the text '8860'", A_MASS)
wrong_cell("text_for_coordinate", "E7", "left", "the text 'left'", A_COORDINATE)
wrong_cell("text_for_polygon", "M4", "top", "the text 'top'", A_COORDINATE)
wrong_cell("text_that_begins_with_equals", "B5", "=8860", "the text '=8860'", A_MASS)
wrong_cell(
    "text_that_looks_like_a_command",
    "B13",
    "=cmd|'/c calc'!A0",
    "the text \"=cmd|'/c calc'!A0\"",
    A_FORCE,
)
wrong_cell("blank_mass", "B5", None, NOTHING, A_MASS)
wrong_cell("blank_centroid", "B7", None, NOTHING, A_COORDINATE)
wrong_cell("blank_scale_factor", "L1", None, NOTHING, A_SCALE_FACTOR)
wrong_cell("spaces_for_mass", "B5", "  ", NOTHING, A_MASS)
wrong_cell("error_for_mass", "B5", Raw(' t="e"><v>#N/A</v>'), "the error value #N/A", A_MASS)
wrong_cell(
    "error_of_a_formula",
    "B13",
    Raw(' t="e"><f>1/0</f><v>#DIV/0!</v>'),
    "the error value #DIV/0!",
    A_FORCE,
)
wrong_cell("date_for_mass", "B5", date(2024, 3, 1), "the date or time 2024-03-01 00:00:00", A_MASS)
wrong_cell("boolean_for_force", "B13", _TRUE, "the truth value TRUE", A_FORCE)
wrong_cell("boolean_for_coordinate", "D5", _FALSE, "the truth value FALSE", A_COORDINATE)
wrong_cell("boolean_for_index", "C5", _TRUE, "the truth value TRUE", "the index 1")
wrong_cell("formula_without_value", "B5", Raw("><f>1000*8.86</f>"), NO_VALUE, A_MASS)
wrong_cell("formula_without_value_in_list", "G6", Raw("><f>D6</f>"), NO_VALUE, A_COORDINATE)
wrong_cell("formula_without_value_for_weight", "B15", Raw("><f>B13/9</f>"), NO_VALUE, A_WEIGHT)
wrong_cell("formula_without_value_for_index", "C6", Raw("><f>C5+1</f>"), NO_VALUE, "the index 2")
wrong_cells(
    "formulas_without_values_for_a_list",
    {f"{column}{row}": Raw("><f>2*50</f>") for column in "DEF" for row in range(5, 11)}
    | {"B11": 0},
    Problem(f"{SHEET}!D5", NO_VALUE, A_COORDINATE),
)

# Numbers that no one can calculate with; openpyxl fails at some, Python's float at others.
wrong_cell("nan", "B5", number_text("NaN"), "'NaN', which is no number", "a number")
wrong_cell("infinite", "D5", number_text("INF"), "'INF', which is no number", "a number")
wrong_cell("infinite_by_exponent", "D5", number_text("1e999"), "inf", A_COORDINATE)
wrong_cell("huge", "D5", 1e308, "1e+308", A_COORDINATE)
wrong_cell("huge_mass", "B5", 1e308, "1e+308", A_MASS)
wrong_cell("tiny_mass", "B5", 1e-308, "1e-308", A_MASS)
wrong_cell(
    "huge_integer", "E5", number_text("1" + "0" * 400), "a number of 401 digits", A_COORDINATE
)
wrong_cell(
    "huge_integer_for_mass", "B5", number_text("-" + "9" * 400), "a number of 400 digits", A_MASS
)
wrong_cell(
    "huge_integer_for_index", "C5", number_text("1" * 400), "a number of 400 digits", "the index 1"
)

# Numbers out of their range.
wrong_cell("negative_mass", "B5", -8860, "-8860", A_MASS)
wrong_cell("zero_mass", "B5", 0, "0", A_MASS)
wrong_cell("negative_force", "B13", -69, "-69", A_FORCE)
wrong_cell("zero_force", "B21", 0, "0", A_FORCE)
wrong_cell("negative_price", "B14", -1, "-1", "a price of 0 $ or more")
wrong_cell("negative_weight", "B23", -110, "-110", A_WEIGHT)
wrong_cell("min_above_max", "B11", 6, "a minimum of 6", "at most the maximum, 5")
wrong_cell("negative_min", "B11", -1, "-1", A_COUNT)
wrong_cell("fraction_for_max", "B20", 2.5, "the fraction 2.5", A_COUNT)
wrong_cell("max_above_its_limit", "B12", 26, "26", A_COUNT)
wrong_cell("zero_scale_factor", "L1", 0, "0", A_SCALE_FACTOR)
wrong_cell("tiny_scale_factor", "L1", 1e-300, "1e-300", A_SCALE_FACTOR)
wrong_cell("negative_scale_factor", "L1", -0.6, "-0.6", A_SCALE_FACTOR)
wrong_cell("scale_factor_above_one", "L1", 1.0000001, "1.0000001", A_SCALE_FACTOR)

# Lists that do not fit together.
SIX_CUPS = "6, the number of suction cups listed"
SIX_MAGNETS = "6, the number of magnets listed"
NO_CUPS = {f"{column}{row}": None for column in "DEF" for row in range(5, 11)} | {"B16": 0}
NO_MAGNETS = {f"{column}{row}": None for column in "GHI" for row in range(5, 11)} | {"B24": 0}
wrong_cell("total_of_more_cups", "B16", 7, "7", SIX_CUPS)
wrong_cell("total_of_fewer_magnets", "B24", 5, "5", SIX_MAGNETS)
wrong_cell("fraction_for_total", "B24", 6.5, "6.5", SIX_MAGNETS)
wrong_cell("text_for_total", "B24", "six", "the text 'six'", SIX_MAGNETS)
wrong_cell("gap_in_index", "C7", 4, "4", "the index 3")
wrong_cell("index_twice", "C8", 3, "3", "the index 4")
wrong_cell("blank_index", "C7", None, NOTHING, "the index 3")
wrong_cell("fraction_for_index", "C7", 3.5, "3.5", "the index 3")
wrong_cell("cup_without_y", "E6", None, NOTHING, A_COORDINATE)
wrong_cell("last_magnet_without_z", "I10", None, NOTHING, A_COORDINATE)
wrong_cells(
    "gap_in_cups",
    {"D7": None, "E7": None, "F7": None, "B16": 5},
    Problem(
        f"{SHEET}!D7",
        "an empty row, and a coordinate below it in row 8",
        "a list of suction cups without gaps",
    ),
)
wrong_cells(
    "gap_in_cups_and_another_total",
    {"D7": None, "E7": None, "F7": None},
    Problem(
        f"{SHEET}!D7",
        "an empty row, and a coordinate below it in row 8",
        "a list of suction cups without gaps",
    ),
    Problem(f"{SHEET}!B16", "6", "5, the number of suction cups listed"),
)
wrong_cells(
    "text_in_cups_and_another_total",
    {"D7": "left", "B16": 9},
    Problem(f"{SHEET}!D7", "the text 'left'", A_COORDINATE),
    Problem(f"{SHEET}!B16", "9", SIX_CUPS),
)
wrong_cells(
    "formulas_without_values_within_a_list",
    {f"{column}7": Raw("><f>2*50</f>") for column in "DEF"},
    Problem(f"{SHEET}!D7", NO_VALUE, A_COORDINATE),
)
wrong_cells(
    "two_cups_at_one_place",
    {"D8": 100, "E8": 60, "F8": 10},
    Problem(f"{SHEET}!D8", "the place of index 1 again", "suction cups at places of their own"),
)
wrong_cells(
    "two_magnets_at_one_place",
    {"G10": -50, "H10": 0, "I10": 10},
    Problem(f"{SHEET}!G10", "the place of index 4 again", "magnets at places of their own"),
)
wrong_cells(
    "no_cups_but_one_needed",
    NO_CUPS,
    Problem(f"{SHEET}!B11", "a minimum of 1", "at most 0, the number of suction cups listed"),
)
wrong_cells(
    "no_footprints",
    NO_CUPS | NO_MAGNETS | {f"C{row}": None for row in range(5, 11)} | {"B11": 0, "B19": 0},
    Problem(f"{SHEET}!D5", "no footprint at all", "places of cups or magnets"),
)
wrong_cells(
    "coordinate_in_last_row",
    {f"D{LAST_ROW}": 7.0},
    Problem(
        f"{SHEET}!D11",
        "an empty row, and a coordinate below it in row 1,048,576",
        "a list of suction cups without gaps",
    ),
)

# Polygons.
A_POLYGON = "three or more corners around an area, without crossing"
CORNERS = "3 to 10,000 corners"
wrong_cells(
    "polygon_of_two_points", polygon_rows(PLATE[:2]), Problem(f"{SHEET}!L3", "2 corners", CORNERS)
)
wrong_cells(
    "polygon_without_points", polygon_rows(()), Problem(f"{SHEET}!L3", "0 corners", CORNERS)
)
wrong_cells(
    "polygon_without_area",
    polygon_rows(((0, 0, 10), (50, 50, 10), (100, 100, 10))),
    Problem(f"{SHEET}!L3", "a polygon without area", A_POLYGON),
)
wrong_cells(
    "polygon_that_crosses_itself",
    polygon_rows((PLATE[0], PLATE[2], PLATE[1], PLATE[3])),
    Problem(
        f"{SHEET}!L3",
        "a polygon that crosses itself (Self-intersection[0.600000000000001 -0.319999999999997])",
        A_POLYGON,
    ),
)
wrong_cells(
    "polygon_that_goes_back_to_its_first_corner",
    polygon_rows((*PLATE, PLATE[0])),
    Problem(f"{SHEET}!L7", "the corner next to it again", A_POLYGON),
)
wrong_cells(
    "polygon_with_a_corner_twice",
    polygon_rows((PLATE[0], PLATE[1], PLATE[1], PLATE[2], PLATE[3])),
    Problem(f"{SHEET}!L5", "the corner next to it again", A_POLYGON),
)
wrong_cell("polygon_point_without_x", "L4", None, NOTHING, A_COORDINATE)

# Labels.
wrong_cells(
    "other_label",
    {"A5": "Mass"},
    Problem(f"{SHEET}!A5", "'Mass'", "the label 'Part mass (g)' under 'Part data'"),
)
wrong_cells(
    "missing_label",  # the magnets have one of the same name
    {"A13": None},
    Problem(
        f"{SHEET}!A13", NOTHING, "the label 'Normal force capacity (N)' under 'Suction cup data'"
    ),
)
wrong_cells(
    "missing_heading",
    {"A10": None},
    Problem(f"{SHEET}!A10", NOTHING, "the heading 'Suction cup data'"),
)
wrong_cells(
    "missing_list_label",
    {"G2": None},
    Problem(f"{SHEET}!G2", NOTHING, "the label 'Magnet locations'"),
)
wrong_cells(
    "missing_scale_label",
    {"K1": None},
    Problem(f"{SHEET}!K1", NOTHING, "the label 'Scale Factor:'"),
)
wrong_cells(
    "missing_polygon_header",
    {"M2": "Y (mm)"},
    Problem(f"{SHEET}!K2", "'i'", "the header 'i x y z' of the ideal polygon, in four cells"),
)

wrong_cells(
    "many_things_at_once",
    {"B5": -1, "B12": "five", "B16": 7, "C7": 4, "D6": None, "A23": None, "H8": "x", "L1": 2}
    | {"N4": None},
    Problem(f"{SHEET}!B5", "-1", A_MASS),
    Problem(f"{SHEET}!B12", "the text 'five'", A_COUNT),
    Problem(f"{SHEET}!B16", "7", SIX_CUPS),
    Problem(f"{SHEET}!D6", NOTHING, A_COORDINATE),
    Problem(f"{SHEET}!H8", "the text 'x'", A_COORDINATE),
    Problem(f"{SHEET}!A23", NOTHING, "the label 'Weight (g)' under 'Magnet data'"),
    Problem(f"{SHEET}!L1", "2", A_SCALE_FACTOR),
    Problem(f"{SHEET}!N4", NOTHING, A_COORDINATE),
)
wrong_cells(
    "index_and_total_at_once",
    {"B16": 7, "C7": 4},
    Problem(f"{SHEET}!B16", "7", SIX_CUPS),
    Problem(f"{SHEET}!C7", "4", "the index 3"),
)


def million_rows(path: Path) -> None:
    """Write a number into every row of the sheet."""
    tiny_export(path)
    rows = b"<row><c><v>7</v></c></row>" * (LAST_ROW - 24)
    end = b"</sheetData>"
    change_part(path, SHEET_PART, lambda xml: replaced(xml, end, rows + end))


def last_columns(path: Path) -> None:
    """Write empty cells to the last column of 1,000 rows; each costs as much as all before it."""
    tiny_export(path)
    rows = "".join(f'<row r="{row}"><c r="XFD{row}" s="0"/></row>' for row in range(1000, 2000))
    end = b"</sheetData>"
    change_part(path, SHEET_PART, lambda xml: replaced(xml, end, rows.encode() + end))


ONE_TITLE = (
    "one sheet with the title 'INPUT PARAMETERS (ALL DATA in GRAMS, MILLIMETERS, and NEWTONS)'"
)
wrong_book(
    "no_option_space",
    lambda path: write_book(path, {"Sheet1": {"A1": "Shopping list", "B5": 8860}}),
    Problem("", "no option-space sheet", ONE_TITLE),
)
wrong_book(
    "empty_sheet",
    lambda path: write_book(path, {"Sheet1": {}}),
    Problem("", "no option-space sheet", ONE_TITLE),
)
wrong_book(
    "two_option_spaces",
    lambda path: write_book(path, {SHEET: export_rows(), "Old export": export_rows()}),
    Problem("Old export!A1", f"an option space besides that of the sheet '{SHEET}'", ONE_TITLE),
)
wrong_book(
    "million_rows",
    million_rows,
    Problem(SHEET, "more than 250,000 filled rows", "at most 250,000"),
)
wrong_book(
    "last_columns",
    last_columns,
    Problem(SHEET, "more than 10,000,000 cells", "at most 10,000,000"),
)

# The GA sheet.
A_CRITERION = "divergence, one of cost, moment, deviation, structure, or some of these joined by +"
A_SWITCH = "1 (yes) or 0 (no)"
A_GOAL = "a goal above 0"
A_CUP = "a suction index, a whole number from 1 to 6"
ONE_TO_FIVE = "a whole number from 1 to 5"


def ga_book(path: Path, change: Mapping[str, Value]) -> None:
    """Write the tiny export with a GA sheet, some cells of which are changed."""
    write_book(path, {SHEET: export_rows(), GA: ga_rows() | dict(change)})


def wrong_ga_cells(name: str, change: Mapping[str, Value], *problems: Problem) -> None:
    """Register a tiny export with a GA sheet that is wrong in some cells."""
    wrong_book(name, lambda path: ga_book(path, change), *problems)


def wrong_ga_cell(name: str, cell: str, value: Value, found: str, expected: str) -> None:
    """Register a tiny export with a GA sheet that is wrong in one cell."""
    wrong_ga_cells(name, {cell: value}, Problem(f"{GA}!{cell}", found, expected))


wrong_ga_cell("two_for_a_switch", "B4", 2, "2", A_SWITCH)
wrong_ga_cell("text_for_a_switch", "B5", "yes", "the text 'yes'", A_SWITCH)
wrong_ga_cell("zero_mutation", "B6", 0, "0", "n of 1-in-n, 1 or more")
wrong_ga_cell("text_for_mutation", "B6", "1 in 4", "the text '1 in 4'", "n of 1-in-n, 1 or more")
wrong_ga_cell(
    "fraction_of_a_generation",
    "B7",
    0.5,
    "the fraction 0.5",
    "a whole number from 0 to 1,000,000,000",
)
wrong_ga_cell(
    "too_many_generations", "B7", 2e9, "2000000000", "a whole number from 0 to 1,000,000,000"
)
wrong_ga_cell("zero_clearance", "B8", 0, "0", "a distance above 0 mm")
wrong_ga_cell("negative_density_ratio", "B9", -1, "-1", "a ratio of 0 or more")
wrong_ga_cell("unknown_criterion", "B10", "beauty", "'beauty'", A_CRITERION)
wrong_ga_cell("criterion_by_its_number", "B10", 3, "3", A_CRITERION)
wrong_ga_cell("criterion_like_a_formula", "B10", "=cost+moment", "'=cost+moment'", A_CRITERION)
wrong_ga_cell("criterion_without_value", "B10", Raw("><f>B9</f>"), NO_VALUE, A_CRITERION)
wrong_ga_cell("zero_fos", "B11", 0, "0", "a factor of safety above 0")
wrong_ga_cell("zero_goal", "B12", 0, "0", A_GOAL)
wrong_ga_cell("negative_goal", "B13", -9000, "-9000", A_GOAL)
wrong_ga_cell("text_for_a_goal", "B14", "low", "the text 'low'", A_GOAL)
wrong_ga_cell("goal_like_a_formula", "B12", "=E12", "the text '=E12'", A_GOAL)
wrong_ga_cell("goal_formula_without_value", "B15", Raw("><f>2*350</f>"), NO_VALUE, A_GOAL)
wrong_ga_cell("goal_formula_on_another_cell", "B12", Raw("><f>F12</f>"), NO_VALUE, A_GOAL)
wrong_ga_cell("one_child", "B16", 1, "1", "a whole number from 2 to 50")
wrong_ga_cell("too_many_children", "B16", 51, "51", "a whole number from 2 to 50")
wrong_ga_cell("negative_seed", "B17", -1, "-1", "a whole number from 0 to 9,007,199,254,740,992")
wrong_ga_cell("unknown_moment_arm", "B18", "2d", "'2d'", "3d or plan")
wrong_ga_cell("index_out_of_range", "F9", 7, "7", A_CUP)
wrong_ga_cell("index_zero", "F9", 0, "0", A_CUP)
wrong_ga_cell("fraction_for_gene", "G9", 1.5, "the fraction 1.5", A_CUP)
wrong_ga_cell("text_for_gene", "G9", "two", "the text 'two'", A_CUP)
wrong_ga_cell("blank_active_gene", "G9", None, NOTHING, A_CUP)
wrong_ga_cell("gene_twice", "G9", 1, "the index 1 a second time", "active indices that differ")
wrong_ga_cell("count_above_max", "E9", 6, "6", ONE_TO_FIVE)
wrong_ga_cell("count_below_min", "E10", 0, "0", ONE_TO_FIVE)
wrong_ga_cell("fraction_for_count", "E10", 1.5, "the fraction 1.5", ONE_TO_FIVE)
wrong_ga_cell("blank_count", "E10", None, NOTHING, ONE_TO_FIVE)
wrong_ga_cells(
    "count_above_what_the_block_has",
    {"H8": None, "H9": None, "I9": None, "J9": None, "E9": 3},
    Problem(f"{GA}!E9", "3", "a whole number from 1 to 2"),
)
wrong_ga_cells(
    "many_things_at_once_on_the_ga_sheet",
    {"B4": "no", "B10": "?", "B12": 0, "F9": 99, "F10": 99, "G9": None},
    Problem(f"{GA}!B4", "the text 'no'", A_SWITCH),
    Problem(f"{GA}!B10", "'?'", A_CRITERION),
    Problem(f"{GA}!B12", "0", A_GOAL),
    Problem(f"{GA}!F9", "99", A_CUP),
    Problem(f"{GA}!G9", NOTHING, A_CUP),
    Problem(f"{GA}!F10", "99", "a magnets index, a whole number from 1 to 6"),
)
wrong_book(
    "no_element_in_the_grasp",
    lambda path: write_book(
        path,
        {
            SHEET: export_rows() | {"B11": 0, "B19": 0},
            GA: ga_rows() | {"E9": 0, "E10": 0},
        },
    ),
    Problem(f"{GA}!E9", "no element at all", "at least one element"),
)
wrong_book(
    "name_of_another_shape",
    lambda path: write_book(
        path, {SHEET: export_rows(), GA: ga_rows()}, {"UserChromosome": f"{GA}!$A$1:$XFD$1048576"}
    ),
    Problem(
        f"{GA}!A1",
        "the name UserChromosome on 1048576 rows and 16384 columns",
        "2 rows of a count and indices",
    ),
)
wrong_book(
    "polygon_name_of_whole_columns",
    lambda path: write_book(
        path, {SHEET: export_rows()}, {"IdealPolygon": f"'{SHEET}'!$L$1:$N$1048576"}
    ),
    Problem(f"{SHEET}!L1", "1,048,576 corners", CORNERS),
)


# --- odd, but fine ---


def fine_cells(name: str, change: Mapping[str, Value]) -> None:
    """Register a tiny export whose changed cells must not disturb."""
    FINE_CASES.append(Case(name, lambda path: tiny_export(path, change)))


fine_cells("good", {})
fine_cells("note_in_last_row", {f"A{LAST_ROW}": "Exported on Monday", f"XFD{LAST_ROW}": 1})
fine_cells("note_that_begins_with_equals", {"A30": "=HYPERLINK(1)", "P1": "+note", "P2": "@note"})
fine_cells("formula_with_value", {"B5": Raw("><f>1000*8.86</f><v>8860</v>")})
fine_cells("blank_weights", {"B15": None, "B23": None})
fine_cells("free_cups", {"B14": 0})
fine_cells("max_above_total", {"B12": 25})
fine_cells("no_index", {"C2": None} | {f"C{row}": None for row in range(5, 11)})
fine_cells("longer_index", {f"C{row}": row - 4 for row in range(5, 40)})
fine_cells("note_below_a_list", {"D13": "checked by Ann", "G12": " "})
fine_cells(
    "formulas_without_values_below_a_list",
    {f"{column}{row}": Raw('><f>""</f>') for column in "DEF" for row in range(11, 15)},
)
fine_cells("no_cups", NO_CUPS | {"B11": 0})
fine_cells("no_magnets_wanted", NO_MAGNETS | {"B19": 0, "B20": 0})
fine_cells("scale_factor_of_one", {"L1": 1})
FINE_CASES.append(
    Case("other_sheet_name", lambda path: write_book(path, {"Export 7": export_rows()}))
)
FINE_CASES.append(
    Case(
        "other_sheets",
        lambda path: write_book(path, {"Notes": {"A1": "by Ann"}, SHEET: export_rows()}),
    )
)


def fine_ga_cells(name: str, change: Mapping[str, Value]) -> None:
    """Register a tiny export with a GA sheet whose changed cells must not disturb."""
    FINE_CASES.append(Case(name, lambda path: ga_book(path, change)))


fine_ga_cells("good_ga_sheet", {})
fine_ga_cells(
    "goals_that_are_our_formulas", {"B12": Raw("><f>E12</f>"), "B13": Raw("><f>GA!$F$12</f>")}
)
fine_ga_cells("goal_formula_with_value", {"B12": Raw("><f>2*30</f><v>60</v>")})
fine_ga_cells("switches_as_booleans", {"B4": _TRUE, "B5": _FALSE})
fine_ga_cells("words_in_other_letters", {"B10": " Moment + COST", "B18": "3D "})
fine_ga_cells("no_parameters", {f"B{row}": None for row in range(4, 19)})
fine_ga_cells("no_grasp", {f"{column}{row}": None for column in "EFGHIJ" for row in (9, 10)})
fine_ga_cells("blank_inactive_genes", {"H9": None, "I9": " ", "J9": None, "G10": None})


def with_chart_sheet(path: Path) -> None:
    """Write the tiny export behind a sheet that is a chart and has no cells."""
    with xlsxwriter.Workbook(path) as book:
        chart = book.add_chart({"type": "line"})
        chart.add_series({"values": f"='{SHEET}'!$E$5:$E$10"})
        book.add_chartsheet("Plan").set_chart(chart)
        sheet = book.add_worksheet(SHEET)
        for cell, value in export_rows().items():
            sheet.write(cell, value)


FINE_CASES.append(Case("chart_sheet", with_chart_sheet))


def main(folder: Path) -> None:
    """Write all cases to a folder."""
    folder.mkdir(parents=True, exist_ok=True)
    for case in (*FILE_CASES, *CELL_CASES, *FINE_CASES):
        case.write(folder)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
