"""A workbook as a file: is it one, is it whole, is it safe; then openpyxl may have it.

The bytes are read once, so that the checks, the hash and every later load see the same content.
"""

from __future__ import annotations

import hashlib
import io
import re
import sys
import warnings
import zipfile
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from copy import copy
from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from typing import Any, cast
from xml.etree.ElementTree import Element

import openpyxl
from defusedxml import DefusedXmlException  # type: ignore[import-untyped, unused-ignore]
from openpyxl.cell.read_only import EMPTY_CELL, EmptyCell, ReadOnlyCell
from openpyxl.packaging.relationship import get_dependents, get_rels_path
from openpyxl.worksheet._read_only import ReadOnlyWorksheet
from openpyxl.worksheet._reader import CELL_TAG, ROW_TAG, VALUE_TAG, WorkSheetParser
from openpyxl.xml.constants import ARC_CONTENT_TYPES, ARC_WORKBOOK, XLSM, XLSX, XLTM, XLTX
from openpyxl.xml.functions import fromstring, iterparse

from grasp_xl.errors import InputError, Problem
from grasp_xl.file_content import FileKind, megabytes, read_content

MAX_FILE_BYTES = 128_000_000
"""An export of 200,000 cups and 200,000 magnets has 18 MB."""

MAX_UNPACKED_BYTES = 512_000_000
"""The same export unpacks to 62 MB; the rest is room for results, charts and other sheets."""

MAX_UNPACKED_RATIO = 100
"""Numbers unpack to 4 times their size, sheets of blanks or zeros to 14, a bomb to 1,000."""

ALWAYS_ALLOWED_BYTES = 32_000_000
"""So little does no harm, whatever the ratio."""

MAX_WHOLE_PART_BYTES = 32_000_000
"""Limit of a part that openpyxl holds in memory as a whole, at 16 times its size."""

MAX_PARTS = 10_000

MAX_UNREADABLE_CELLS = 100
"""As many are named; a list of all would help nobody."""

MAX_ROWS = 1_048_576
"""Rows of an Excel sheet."""

A_WORKBOOK = "an Excel workbook (.xlsx or .xlsm)"
A_WHOLE_WORKBOOK = "a whole, undamaged workbook"
SAVE_AS = 'choose File > Save As and the type "Excel Workbook (*.xlsx)"'
SAVE_IN_EXCEL = f"open it in Excel, {SAVE_AS}"
GET_ANOTHER_COPY = "copy, download or export it again"
WORKBOOK = FileKind(
    "workbook", A_WORKBOOK, MAX_FILE_BYTES, "save a copy that has the option space's sheet only"
)

_ZIP_STARTS = (b"PK\x03\x04", b"PK\x05\x06")
_ZIP_ENTRY = b"PK\x01\x02"
_ZIP_END = b"PK\x05\x06"
_MAX_ZIP_END_BYTES = 22 + 65_535  # the end record and the longest comment behind it
_OLE_START = b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1"
_TEXT = re.compile(rb"[^\x00-\x08\x0e-\x1f]*\Z")
_UTF_16_MARKS = (b"\xff\xfe", b"\xfe\xff")
_FIRST_ELEMENT = re.compile(rb"<[A-Za-z_:]")
_WHOLE_PART = re.compile(
    r"\.rels$|(content_types\]|workbook|sharedstrings|styles|core|custom)\.xml$"
)
_WORKBOOK_TYPES = (XLSX, XLSM, XLTX, XLTM)
_XLSB_TYPE = b"ms-excel.sheet.binary.macroEnabled"
_STRICT_NAMESPACE = b"http://purl.oclc.org/ooxml/spreadsheetml/main"
_CHUNK_BYTES = 256 * 1024
_ROWS_AT_ONCE = 64  # to silence warnings costs time, so not for every row


@dataclass(frozen=True, slots=True)
class Package:
    """The bytes of a workbook, read once.

    Parameters
    ----------
    name : str
        File name as the person gave it.
    content : bytes
    """

    name: str
    content: bytes

    @property
    def sha256(self) -> str:
        """Hash of the file, in hexadecimal digits."""
        return hashlib.sha256(self.content).hexdigest()

    @property
    def allowed_unpacked_bytes(self) -> int:
        """Most bytes that all parts together may unpack to."""
        by_ratio = MAX_UNPACKED_RATIO * len(self.content)
        return min(MAX_UNPACKED_BYTES, max(ALWAYS_ALLOWED_BYTES, by_ratio))


def read_package(path: Path) -> Package:
    """Read a file and check that it is a whole and harmless workbook.

    Raises
    ------
    InputError
        With one problem, whatever is wrong with the file.
    """
    package = Package(str(path), read_content(path, WORKBOOK))
    _refuse_other_files(package)
    with _failures_told(package.name):
        _refuse_too_many_parts(package)
        with zipfile.ZipFile(io.BytesIO(package.content)) as archive:
            _check_directory(package, archive)
            _unpack_once(package, archive)
            _check_workbook(package, archive)
    return package


def open_workbook(package: Package, *, formulas: bool) -> openpyxl.Workbook:
    """Open a package for reading: the formulas of its cells, or the values that were cached.

    openpyxl reads the cells only when they are asked for: do that by :func:`sheet_rows`.
    """
    with _failures_told(package.name):
        book = openpyxl.load_workbook(
            io.BytesIO(package.content), read_only=True, data_only=not formulas, keep_links=False
        )
    if not book.sheetnames:
        raise _refusal(package.name, "no sheet that can be read", "a sheet", SAVE_IN_EXCEL)
    return book


def sheet_rows(
    package: Package, sheet: ReadOnlyWorksheet, columns: int
) -> Iterator[tuple[int, tuple[ReadOnlyCell | EmptyCell, ...]]]:
    """Iterate over the row numbers and first cells of all rows that have any there.

    Raises
    ------
    InputError
        With a problem for every cell that openpyxl cannot read, such as one with ``NaN`` in it.
    """
    sheet.reset_dimensions()  # some programs write too small ones, and rows would be lost
    rows = cast("Any", sheet).iter_rows(min_row=1, max_col=columns)  # typed as Worksheet's only
    for before in range(0, MAX_ROWS + 1, _ROWS_AT_ONCE):
        with _failures_told(package.name, f"sheet {sheet.title!r}"):
            try:
                some = list(islice(rows, _ROWS_AT_ONCE))
            except (ValueError, LookupError) as error:
                problems = _unreadable_cells(sheet)
                if problems:
                    raise InputError(problems) from error
                raise
        if before + len(some) > MAX_ROWS:
            raise _damaged(package.name, f"a row behind the last, {MAX_ROWS:,}, in {sheet.title!r}")
        for row, cells in enumerate(some, before + 1):
            if any(cell is not EMPTY_CELL for cell in cells):
                yield row, cells
        if len(some) < _ROWS_AT_ONCE:
            return


def _refusal(name: str, found: str, expected: str, hint: str) -> InputError:
    return InputError([Problem(name, found, expected, hint)])


def _damaged(name: str, found: str) -> InputError:
    return _refusal(name, found, A_WHOLE_WORKBOOK, GET_ANOTHER_COPY)


# --- the kind of file ---


def _refuse_other_files(package: Package) -> None:
    content = package.content
    if content.startswith(_ZIP_STARTS):
        return
    if not content:
        raise _refusal(package.name, "an empty file (0 bytes)", A_WORKBOOK, GET_ANOTHER_COPY)
    if content.startswith(_OLE_START):
        found, expected, hint = _old_office_file(content)
    elif content.startswith(_UTF_16_MARKS) or _TEXT.match(content[:4096]):
        found, expected = "plain text (such as .csv, .xml or .html)", A_WORKBOOK
        hint = SAVE_IN_EXCEL
    else:
        found, expected = "bytes that are no workbook", A_WORKBOOK
        hint = "check that this is the right file, or export it again"
    raise _refusal(package.name, found, expected, hint)


def _old_office_file(content: bytes) -> tuple[str, str, str]:
    """Found, expected and hint; the streams of an OLE file bear their names in UTF-16."""
    if "EncryptedPackage".encode("utf-16-le") in content:
        hint = (
            "open it in Excel, clear the password under File > Info > Protect Workbook > "
            "Encrypt with Password, and save it"
        )
        return "a workbook encrypted with a password", "a workbook without a password", hint
    if any(stream.encode("utf-16-le") in content for stream in ("Workbook", "Book\0")):
        return "an Excel 97-2003 workbook (.xls)", A_WORKBOOK, SAVE_IN_EXCEL
    hint = "check that this is the right file, or export it again"
    return "an old Office file that is no workbook", A_WORKBOOK, hint


# --- the archive ---


@contextmanager
def _failures_told(name: str, what: str = "workbook") -> Iterator[None]:
    """Turn all that zipfile, zlib, the XML parser and openpyxl raise or warn into InputError."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            yield
        except InputError:
            raise
        except Exception as error:  # they raise whatever their parsing trips over
            cause = error.__cause__ or error  # openpyxl wraps a ValueError in one that says less
            if isinstance(cause, DefusedXmlException):
                raise _document_type(name) from error
            raise _damaged(name, f"a damaged {what} ({_reason(cause)})") from error


def _reason(error: BaseException) -> str:
    """Return what a reader's exception says, unless it speaks of Python's types."""
    if isinstance(error, TypeError | AttributeError):
        return "a value that the file format does not have there"
    return (str(error) or type(error).__name__).splitlines()[0][:200]


def _document_type(name: str, part: str = "") -> InputError:
    place = f"the part {part!r}" if part else "one of its parts"
    return _refusal(
        name,
        f"a document type or entity declaration (<!DOCTYPE) in {place}",
        "plain XML, as every spreadsheet program writes it",
        "do not open it; ask for a new export from a source that you trust",
    )


def _bomb(package: Package) -> InputError:
    allowed = megabytes(package.allowed_unpacked_bytes)
    return _refusal(
        package.name,
        f"parts that unpack to more than {allowed}, as a zip bomb does",
        f"at most {allowed} in a file of this size",
        "do not open it unless you trust its source; save a copy that has the option space's "
        "sheet only",
    )


def _refuse_too_many_parts(package: Package) -> None:
    # Counted in the bytes, since zipfile would build an object for each one first.
    parts = package.content.count(_ZIP_ENTRY)
    if parts > MAX_PARTS:
        raise _refusal(
            package.name,
            f"{parts:,} parts",
            f"at most {MAX_PARTS:,}",
            "save a copy that has the option space's sheet only",
        )
    if _ZIP_END not in package.content[-_MAX_ZIP_END_BYTES:]:
        raise _damaged(package.name, "a workbook that breaks off before its end")


def _check_directory(package: Package, archive: zipfile.ZipFile) -> None:
    """Check what the archive declares about its parts."""
    parts = archive.infolist()
    declared = sum(part.file_size for part in parts)
    if declared > package.allowed_unpacked_bytes:
        raise _bomb(package)
    for part in parts:
        if part.flag_bits & 1:
            raise _refusal(
                package.name,
                "a zip archive with a password",
                "a workbook without a password",
                "take the workbook out of the archive, or save it again without a password",
            )
        # zipfile unpacks other methods without any bound.
        if part.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
            raise _damaged(package.name, f"an unknown compression of the part {part.filename!r}")
        if part.file_size > MAX_WHOLE_PART_BYTES and _WHOLE_PART.search(part.filename.lower()):
            raise _refusal(
                package.name,
                f"{megabytes(part.file_size)} in the part {part.filename!r}",
                f"at most {megabytes(MAX_WHOLE_PART_BYTES)}",
                "save a copy that has the option space's sheet only",
            )


def _unpack_once(package: Package, archive: zipfile.ZipFile) -> None:
    """Unpack every part in small pieces: is it as long as declared, undamaged, without DOCTYPE."""
    left = package.allowed_unpacked_bytes
    for part in archive.infolist():
        # zipfile stops at the declared size, which may be a lie; openpyxl unpacks all behind it.
        unbounded = copy(part)
        unbounded.file_size = sys.maxsize
        size = 0
        try:
            with archive.open(unbounded) as file:
                while piece := file.read(_CHUNK_BYTES):
                    if size == 0:
                        _refuse_document_type(package.name, part.filename, piece)
                    size += len(piece)
                    if size > left:
                        raise _bomb(package)
        except (zipfile.BadZipFile, zlib.error, EOFError) as error:
            raise _damaged(package.name, f"a damaged part {part.filename!r}") from error
        if size != part.file_size:
            raise _damaged(package.name, f"a part {part.filename!r} of another size than declared")
        left -= size


def _refuse_document_type(name: str, part: str, start: bytes) -> None:
    if not part.lower().endswith((".xml", ".rels")):
        return
    ascii_start = start.replace(b"\0", b"") if b"\0" in start else start  # UTF-16 looks so
    first_element = _FIRST_ELEMENT.search(ascii_start)
    prolog = ascii_start[: first_element.start()] if first_element else ascii_start
    if b"<!DOCTYPE" in prolog:
        raise _document_type(name, part)


# --- the workbook ---


def _check_workbook(package: Package, archive: zipfile.ZipFile) -> None:
    """Find the workbook part and its sheets; openpyxl would leave out sheets without a word."""
    parts = set(archive.namelist())
    if "mimetype" in parts and b"opendocument" in archive.read("mimetype"):
        hint = 'open it in LibreOffice, choose File > Save As and the type "Excel 2007-365 (.xlsx)"'
        raise _refusal(package.name, "an OpenDocument spreadsheet (.ods)", A_WORKBOOK, hint)
    workbook = workbook_part(package.name, archive) if ARC_CONTENT_TYPES in parts else ""
    if not workbook:
        hint = "if the workbook is inside this archive, take it out and name that"
        raise _refusal(package.name, "a zip archive that is no workbook", A_WORKBOOK, hint)
    if workbook not in parts:
        raise _damaged(package.name, f"no part {workbook!r}")
    if _STRICT_NAMESPACE in archive.read(workbook):
        found = 'a workbook of the type "Strict Open XML Spreadsheet (*.xlsx)"'
        expected = 'one of the type "Excel Workbook (*.xlsx)"'
        raise _refusal(package.name, found, expected, SAVE_IN_EXCEL)
    relations_part = get_rels_path(workbook)  # type: ignore[no-untyped-call]
    for relation in get_dependents(archive, relations_part):
        needed = str(relation.Type).endswith(("/worksheet", "/sharedStrings"))
        if needed and relation.TargetMode != "External" and relation.target not in parts:
            raise _damaged(package.name, f"no part {relation.target!r}")


def workbook_part(name: str, archive: zipfile.ZipFile) -> str:
    """Return the name of the part that lists the sheets; empty if there is none."""
    types = archive.read(ARC_CONTENT_TYPES)
    if _XLSB_TYPE in types:
        raise _refusal(name, "a binary workbook (.xlsb)", A_WORKBOOK, SAVE_IN_EXCEL)
    for entry in fromstring(types):
        if entry.get("ContentType") in _WORKBOOK_TYPES:
            part_name = entry.get("PartName")  # a default for a file ending has none
            return part_name.removeprefix("/") if part_name else ARC_WORKBOOK
    return ""


def sheet_parts(name: str, archive: zipfile.ZipFile) -> dict[str, str | None]:
    """Return the part of each sheet, by the sheet's name; None where the relation is missing."""
    book = workbook_part(name, archive)
    relations = get_dependents(archive, get_rels_path(book))  # type: ignore[no-untyped-call]
    targets = {str(relation.Id): relation.target for relation in relations}
    return {
        str(sheet.get("name")): next(
            targets.get(value) for key, value in sheet.items() if key.endswith("}id")
        )
        for sheet in fromstring(archive.read(book)).iter()
        if str(sheet.tag).rpartition("}")[2] == "sheet"
    }


def _unreadable_cells(sheet: ReadOnlyWorksheet) -> list[Problem]:
    problems = []
    strings = sheet._shared_strings  # type: ignore[attr-defined]  # noqa: SLF001
    with sheet._get_source() as source:  # type: ignore[attr-defined]  # noqa: SLF001
        parser = WorkSheetParser(source, strings, data_only=sheet.parent.data_only)
        for _, element in iterparse(source):
            if element.tag == ROW_TAG:
                element.clear()
            if element.tag != CELL_TAG:
                continue
            try:
                parser.parse_cell(element)
            except (ValueError, LookupError):
                problems.append(_unreadable(sheet.title, element))
            if len(problems) == MAX_UNREADABLE_CELLS:
                break
    return problems


def _unreadable(sheet: str, cell: Element) -> Problem:
    is_number = cell.get("t", "n") == "n"
    return Problem(
        f"{sheet}!{cell.get('r', '?')}",
        f"{cell.findtext(VALUE_TAG, '')[:40]!r}, which is no {'number' if is_number else 'value'}",
        "a number" if is_number else "a value of the cell's type",
        "type a number or clear the cell",
    )
