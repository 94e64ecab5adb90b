"""Tiny workbooks, one for each way of being wrong: ``python tests/bad_workbooks.py FOLDER``.

``FILE_CASES`` are wrong as files, ``CELL_CASES`` in their cells, ``FINE_CASES`` only look odd.
Each case says what its message must be: word by word for files, some words of it for cells.  An
empty ``where`` stands for the file itself.
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

import xlsxwriter  # type: ignore[import-untyped, unused-ignore]

from grasp_xl.errors import Problem
from grasp_xl.workbook import package

SHEET = "Option Space"
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


def _kind(name: str, force: float, price: float, weight: float) -> tuple[tuple[str, float], ...]:
    return (
        (f"# {name} (Min.)", 1),
        (f"# {name} (Max.)", 5),
        ("Normal force capacity (N)", force),
        ("Unit price ($)", price),
        ("Weight (g)", weight),
    )


def _attributes(first_row: int, attributes: tuple[tuple[str, float], ...]) -> Cells:
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


def tiny_export(path: Path, change: Mapping[str, Value] | None = None) -> None:
    """Write the tiny export, with some of its cells changed."""
    write_book(path, {SHEET: export_rows() | dict(change or {})})


def write_book(path: Path, sheets: Mapping[str, Cells]) -> None:
    """Write sheets of cells."""
    with xlsxwriter.Workbook(path) as book:
        for name, cells in sheets.items():
            sheet = book.add_worksheet(name)
            for cell, value in cells.items():
                if isinstance(value, bool):
                    sheet.write_boolean(cell, value)
                elif isinstance(value, str):
                    sheet.write_string(cell, value)
                elif isinstance(value, date):
                    sheet.write_datetime(cell, value, book.add_format({"num_format": "yyyy-mm-dd"}))
                elif isinstance(value, Raw):
                    sheet.write_number(cell, _PLACEHOLDER)
                elif value is not None:
                    sheet.write_number(cell, value)
    for number, cells in enumerate(sheets.values(), 1):
        raw = {cell: value.xml for cell, value in cells.items() if isinstance(value, Raw)}
        if raw:
            change_part(path, f"xl/worksheets/sheet{number}.xml", partial(_put_raw, cells=raw))


_PLACEHOLDER = 987654321


def _put_raw(xml: bytes, cells: Mapping[str, str]) -> bytes:
    for cell, raw in cells.items():
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
    noise = random.Random(1).randbytes(1_000_000)  # so that the ratio is no bomb's
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


def wrong_cells(name: str, change: Mapping[str, Value], *problems: Problem) -> None:
    """Register a tiny export with some cells changed; each text is a word of the message."""
    CELL_CASES.append(Case(name, lambda path: tiny_export(path, change), problems))


def wrong_cell(name: str, cell: str, value: Value, found: str, expected: str) -> None:
    """Register a tiny export with one wrong cell."""
    wrong_cells(name, {cell: value}, Problem(f"{SHEET}!{cell}", found, expected))


def number_text(text: str) -> Raw:
    """Make a cell that claims to be a number."""
    return Raw(f"><v>{text}</v>")


# Not numbers, where one belongs.
wrong_cell("text_for_mass", "B5", "heavy", "'heavy'", "number")
wrong_cell("number_as_text", "B5", "8860", "'8860'", "number")
wrong_cell("text_for_coordinate", "E7", "left", "'left'", "number")
wrong_cell("text_for_polygon", "M4", "top", "'top'", "number")
wrong_cell("text_that_begins_with_equals", "B5", "=8860", "'=8860'", "number")
wrong_cell("text_that_looks_like_a_command", "B13", "=cmd|'/c calc'!A0", "=cmd|", "number")
wrong_cell("blank_mass", "B5", None, "blank", "number")
wrong_cell("blank_centroid", "B7", None, "blank", "number")
wrong_cell("blank_scale_factor", "L1", None, "blank", "number")
wrong_cell("spaces_for_mass", "B5", "  ", "'  '", "number")
wrong_cell("error_for_mass", "B5", Raw(' t="e"><v>#N/A</v>'), "#N/A", "number")
wrong_cell("error_of_a_formula", "B13", Raw(' t="e"><f>1/0</f><v>#DIV/0!</v>'), "#DIV/0!", "number")
wrong_cell("date_for_mass", "B5", date(2024, 3, 1), "date", "number")
wrong_cell("boolean_for_force", "B13", True, "TRUE", "number")
wrong_cell("boolean_for_coordinate", "D5", False, "FALSE", "number")
wrong_cell("formula_without_value", "B5", Raw("><f>1000*8.86</f>"), "formula", "value")
wrong_cell("formula_without_value_in_list", "G6", Raw("><f>D6</f>"), "formula", "value")

# Numbers that no one can calculate with; openpyxl fails at some, Python's float at others.
wrong_cell("nan", "B5", number_text("NaN"), "NaN", "number")
wrong_cell("infinite", "D5", number_text("INF"), "INF", "number")
wrong_cell("infinite_by_exponent", "D5", number_text("1e999"), "inf", "number")
wrong_cell("huge", "D5", 1e308, "1e+308", "at most")
wrong_cell("huge_mass", "B5", 1e308, "1e+308", "at most")
wrong_cell("huge_integer", "E5", number_text("1" + "0" * 400), "1", "at most")

# Numbers out of their range.
wrong_cell("negative_mass", "B5", -8860, "-8860", "more than 0")
wrong_cell("zero_mass", "B5", 0, "0", "more than 0")
wrong_cell("negative_force", "B13", -69, "-69", "more than 0")
wrong_cell("zero_force", "B21", 0, "0", "more than 0")
wrong_cell("negative_price", "B14", -1, "-1", "at least 0")
wrong_cell("negative_weight", "B23", -110, "-110", "at least 0")
wrong_cell("min_above_max", "B11", 6, "6", "at most 5")
wrong_cell("negative_min", "B11", -1, "-1", "at least 0")
wrong_cell("fraction_for_max", "B20", 2.5, "2.5", "whole number")
wrong_cell("zero_scale_factor", "L1", 0, "0", "more than 0")
wrong_cell("negative_scale_factor", "L1", -0.6, "-0.6", "more than 0")
wrong_cell("scale_factor_above_one", "L1", 1.5, "1.5", "at most 1")

# Lists that do not fit together.
wrong_cell("total_of_more_cups", "B16", 7, "7", "6")
wrong_cell("total_of_fewer_magnets", "B24", 5, "5", "6")
wrong_cell("fraction_for_total", "B24", 6.5, "6.5", "6")
wrong_cell("gap_in_index", "C7", 4, "4", "3")
wrong_cell("index_twice", "C8", 3, "3", "4")
wrong_cell("blank_index", "C7", None, "blank", "3")
wrong_cell("fraction_for_index", "C7", 3.5, "3.5", "3")
wrong_cell("cup_without_y", "E6", None, "blank", "number")
wrong_cell("last_magnet_without_z", "I10", None, "blank", "number")
wrong_cells(
    "gap_in_cups",
    {"D7": None, "E7": None, "F7": None, "B16": 5},
    Problem(f"{SHEET}!D7", "blank", "cup"),
)
wrong_cells(
    "two_cups_at_one_place",
    {"D8": 100, "E8": 60, "F8": 10},
    Problem(f"{SHEET}!D8", "index 1", "own place"),
)
wrong_cells(
    "two_magnets_at_one_place",
    {"G10": -50, "H10": 0, "I10": 10},
    Problem(f"{SHEET}!G10", "index 4", "own place"),
)
wrong_cells(
    "no_cups_but_one_needed",
    {f"{column}{row}": None for column in "DEF" for row in range(5, 11)} | {"B16": 0},
    Problem(f"{SHEET}!B11", "1", "at most 0"),
)
wrong_cells(
    "no_footprints",
    {f"{column}{row}": None for column in "CDEFGHI" for row in range(5, 11)}
    | {"B11": 0, "B16": 0, "B19": 0, "B24": 0},
    Problem(f"{SHEET}!D5", "no", "footprint"),
)
wrong_cell("coordinate_in_last_row", f"D{LAST_ROW}", 7.0, "7", "blank")

# Polygons.
wrong_cells(
    "polygon_of_two_points", polygon_rows(PLATE[:2]), Problem(f"{SHEET}!K3", "2", "at least 3")
)
wrong_cells("polygon_without_points", polygon_rows(()), Problem(f"{SHEET}!K3", "no", "at least 3"))
wrong_cells(
    "polygon_without_area",
    polygon_rows(((0, 0, 10), (50, 50, 10), (100, 100, 10))),
    Problem(f"{SHEET}!K3", "area", "area"),
)
wrong_cells(
    "polygon_that_crosses_itself",
    polygon_rows((PLATE[0], PLATE[2], PLATE[1], PLATE[3])),
    Problem(f"{SHEET}!K3", "cross", "cross"),
)
wrong_cell("polygon_point_without_x", "L4", None, "blank", "number")

# Labels.
wrong_cell("other_label", "A5", "Mass", "'Mass'", "Part mass (g)")
wrong_cell("missing_label", "A13", None, "blank", "Normal force capacity (N)")
wrong_cell("missing_scale_label", "K1", None, "blank", "Scale Factor:")

wrong_cells(
    "three_things_at_once",
    {"B5": -1, "C7": 4, "L1": 2},
    Problem(f"{SHEET}!B5", "-1", "more than 0"),
    Problem(f"{SHEET}!C7", "4", "3"),
    Problem(f"{SHEET}!L1", "2", "at most 1"),
)


def wrong_book(name: str, build: Builder, *problems: Problem) -> None:
    """Register a workbook that more than changed cells make wrong."""
    CELL_CASES.append(Case(name, build, problems))


def million_index_rows(path: Path) -> None:
    """Write an index into every row of the sheet; the file has 8 MB."""
    tiny_export(path, {f"C{row}": row - 4 for row in range(5, 25)})
    rows = "".join(
        f'<row r="{row}"><c r="C{row}"><v>{row - 4}</v></c></row>'
        for row in range(25, LAST_ROW + 1)
    )
    end = b"</sheetData>"
    change_part(path, SHEET_PART, lambda xml: replaced(xml, end, rows.encode() + end))


wrong_book(
    "no_option_space",
    lambda path: write_book(path, {"Sheet1": {"A1": "Shopping list", "B5": 8860}}),
    Problem("", "no sheet", "INPUT PARAMETERS"),
)
wrong_book(
    "empty_sheet",
    lambda path: write_book(path, {"Sheet1": {}}),
    Problem("", "no sheet", "INPUT PARAMETERS"),
)
wrong_book(
    "two_option_spaces",
    lambda path: write_book(path, {SHEET: export_rows(), "Old export": export_rows()}),
    Problem("Old export!A1", "second", "one"),
)
wrong_book(
    "million_index_rows",
    million_index_rows,
    Problem(f"{SHEET}!C5", "1,048,572", "at most"),
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
fine_cells("max_above_total", {"B12": 50})
FINE_CASES.append(
    Case("other_sheet_name", lambda path: write_book(path, {"Export 7": export_rows()}))
)
FINE_CASES.append(
    Case(
        "other_sheets",
        lambda path: write_book(path, {"Notes": {"A1": "by Ann"}, SHEET: export_rows()}),
    )
)


def main(folder: Path) -> None:
    """Write all cases to a folder."""
    folder.mkdir(parents=True, exist_ok=True)
    for case in (*FILE_CASES, *CELL_CASES, *FINE_CASES):
        case.write(folder)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
