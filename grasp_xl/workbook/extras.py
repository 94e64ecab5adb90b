"""What a workbook has besides the contents of its cells: notes, charts, rules, ranges, names."""

from __future__ import annotations

import io
import posixpath
import zipfile
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from xml.etree.ElementTree import Element

from openpyxl.formula.translate import Translator
from openpyxl.packaging.relationship import Relationship, get_dependents, get_rels_path
from openpyxl.utils.cell import get_column_letter, range_boundaries
from openpyxl.xml.functions import fromstring, iterparse

from grasp_xl.workbook.cells import same_formula
from grasp_xl.workbook.package import MAX_ROWS, Package, sheet_parts, workbook_part

AREA_NAMES = {"_xlnm.Print_Area": "print areas of", "_xlnm.Print_Titles": "print titles of"}
BUILT_IN = "_xlnm."
"""Start of names that programs make for themselves."""

FILTERS, CHARTS, HIDDEN_ROWS = "filters on", "charts", "hidden rows"
FORMATS, VALIDATIONS = "conditional formats on", "validations on"

COMMON_CELL = "CZ9999"
"""Formulas of conditional formats are compared as they would stand for this cell."""

MAX_COLUMNS = 16_384
"""Columns of an Excel sheet."""

Range = tuple[int, int, int, int]
"""First column and row, last column and row."""


@dataclass(frozen=True, slots=True)
class Extra:
    """One of them.

    Parameters
    ----------
    what, where : str
        As a message names it: ``notes on`` ``GA!A7``.
    key : str
        What makes it the same thing in another copy of the workbook.
    area : tuple, optional
        Cells that a rule is for; the same rule may be for more or fewer cells.
    """

    what: str
    where: str
    key: str
    area: Range | None = None


@dataclass
class Extras:
    """All of a workbook: by sheet, and of the workbook as a whole."""

    by_sheet: dict[str, list[Extra]] = field(default_factory=dict)
    of_book: list[Extra] = field(default_factory=list)


def _range(reference: str) -> Range:
    """Return the corners of a range; whole columns and rows end where a sheet does."""
    left, top, right, bottom = range_boundaries(reference)
    return left or 1, top or 1, right or MAX_COLUMNS, bottom or MAX_ROWS


def not_among(theirs: Iterable[Extra], ours: Iterable[Extra]) -> Iterator[Extra]:
    """Yield what others have beside ours; a rule of ours on fewer of its cells is still ours."""
    ours = list(ours)
    left = Counter((one.what, one.key) for one in ours if not one.area)
    for one in theirs:
        same = (one.what, one.key)
        if one.area:
            areas = [our.area for our in ours if our.area and (our.what, our.key) == same]
            if sum(_common(one.area, area) for area in set(areas)) < _common(one.area, one.area):
                yield one
        elif left[same]:
            left[same] -= 1
        else:
            yield one


def _common(one: Range, other: Range) -> int:
    """Count the cells that two ranges share."""
    columns = min(one[2], other[2]) - max(one[0], other[0]) + 1
    rows = min(one[3], other[3]) - max(one[1], other[1]) + 1
    return max(0, columns) * max(0, rows)


def read_extras(package: Package) -> Extras:
    """Read them from a workbook that was checked."""
    with zipfile.ZipFile(io.BytesIO(package.content)) as archive:
        book = fromstring(archive.read(workbook_part(package.name, archive)))
        parts = sheet_parts(package.name, archive)
        sheets = {str(sheet.get("name")): sheet for sheet in book.iter() if _tag(sheet) == "sheet"}
        found = Extras(of_book=list(_of_book(book)))
        for name, sheet in sheets.items():
            target = parts[name]
            found.by_sheet[name] = [] if target is None else list(_of_sheet(archive, name, target))
            if sheet.get("state", "visible") != "visible":
                found.by_sheet[name].append(Extra("hidden sheets", name, ""))
        for extra in _area_names(book, list(sheets)):
            found.by_sheet[extra.where].append(extra)
    return found


def _tag(element: Element) -> str:
    return str(element.tag).rpartition("}")[2]


def _children(element: Element, tag: str) -> list[Element]:
    return [child for child in element.iter() if _tag(child) == tag]


def _text(element: Element, tag: str) -> str:
    return " ".join("".join(child.text or "" for child in _children(element, tag)).split())


def _is_on(element: Element, attribute: str) -> bool:
    return element.get(attribute) in ("1", "true")


def _relations(archive: zipfile.ZipFile, part: str) -> list[Relationship]:
    path = get_rels_path(part)  # type: ignore[no-untyped-call]
    return list(get_dependents(archive, path)) if path in archive.namelist() else []


def _related(archive: zipfile.ZipFile, part: str, kind: str) -> Iterator[tuple[str, Element]]:
    """Yield the parts of a kind that a part refers to, and their content."""
    for relation in _relations(archive, part):
        known = relation.TargetMode != "External" and relation.target in archive.namelist()
        if known and posixpath.basename(str(relation.Type)) == kind:
            yield relation.target, fromstring(archive.read(relation.target))


def _of_book(book: Element) -> Iterator[Extra]:
    for element in book.iter():
        if _tag(element) == "workbookProtection" and _is_on(element, "lockStructure"):
            yield Extra("protection of", "the workbook", "")
        if _tag(element) == "definedName":
            name = str(element.get("name"))
            if not name.startswith(BUILT_IN):
                yield Extra("names", name, name.casefold())


def _area_names(book: Element, sheets: list[str]) -> Iterator[Extra]:
    for element in _children(book, "definedName"):
        what, sheet = AREA_NAMES.get(str(element.get("name"))), element.get("localSheetId")
        if what and sheet:
            areas = sorted(same_formula(element.text).split(","))
            yield Extra(what, sheets[int(sheet)], ",".join(areas))


# --- a sheet ---


def _of_sheet(archive: zipfile.ZipFile, sheet: str, part: str) -> Iterator[Extra]:
    tables = []
    for _, table in _related(archive, part, "table"):
        tables.append(_range(str(table.get("ref"))))
        name = str(table.get("displayName"))
        yield Extra("tables", f"{name} on {sheet}", name.casefold())
    for _, comments in _related(archive, part, "comments"):
        for note in _children(comments, "comment"):
            yield Extra("notes on", _at(sheet, note), f"{note.get('ref')} {_text(note, 't')}")
    for target, drawing in _related(archive, part, "drawing"):
        yield from _charts(archive, sheet, target, drawing)
    hidden = []
    with archive.open(part) as content:
        for _, element in iterparse(content):
            if _tag(element) == "row":
                if _is_on(element, "hidden") and element.get("r"):
                    hidden.append(int(str(element.get("r"))))
                element.clear()
            else:
                yield from _rules(sheet, element, tables)
    free = [row for row in hidden if not any(table[1] <= row <= table[3] for table in tables)]
    for first, last in _runs(free):
        yield Extra(HIDDEN_ROWS, f"{sheet}!{first}:{last}", f"{first}:{last}")


def _at(sheet: str, element: Element) -> str:
    return f"{sheet}!{element.get('ref')}"


def _rules(sheet: str, element: Element, tables: list[Range]) -> Iterator[Extra]:
    """Yield what one element of a sheet adds; a table's own filter is no filter of its own."""
    tag, reference = _tag(element), str(element.get("ref"))
    if tag == "autoFilter":
        area = _range(reference)
        if not any(_common(area, table) == _common(area, area) for table in tables):
            yield Extra(FILTERS, _at(sheet, element), reference)
    elif tag == "mergeCell":
        yield Extra("merged cells", _at(sheet, element), reference)
    elif tag == "hyperlink":
        yield Extra("hyperlinks on", _at(sheet, element), reference)
    elif tag == "sheetProtection" and _is_on(element, "sheet"):
        yield Extra("protection of", sheet, sheet)
    elif tag == "col" and _is_on(element, "hidden"):
        columns = [get_column_letter(int(str(element.get(end)))) for end in ("min", "max")]
        yield Extra("hidden columns", f"{sheet}!{':'.join(columns)}", ":".join(columns))
    elif tag == "dataValidation" and element.get("type", "none") != "none":
        yield from _ruled(VALIDATIONS, sheet, element, _validation_key(element))
    elif tag == "conditionalFormatting":
        for rule in _children(element, "cfRule"):
            yield from _ruled(FORMATS, sheet, element, _format_key(element, rule))


def _validation_key(element: Element) -> str:
    """Return what a validation asks for; some programs write a second bound that is not used."""
    kind, operator = str(element.get("type")), element.get("operator", "between")
    both = kind != "list" and operator in ("between", "notBetween")
    bounds = [_text(element, name) for name in ("formula1", "formula2")[: 1 + both]]
    return " ".join((kind, operator, *map(_bound, bounds)))


def _bound(text: str) -> str:
    try:
        return f"{float(text):.12g}"
    except ValueError:
        return same_formula(text)


def _ruled(what: str, sheet: str, element: Element, key: str) -> Iterator[Extra]:
    for reference in _references(element):
        yield Extra(what, f"{sheet}!{reference}", key, _range(reference))


def _references(element: Element) -> list[str]:
    return (element.get("sqref") or _text(element, "sqref")).split()


def _format_key(element: Element, rule: Element) -> str:
    """Return what a conditional format asks for, wherever its first cell is."""
    first = _references(element)[0].partition(":")[0]
    formulas = [
        Translator(f"={formula.text}", first).translate_formula(COMMON_CELL)
        for tag in ("formula", "f")
        for formula in _children(rule, tag)
    ]
    words = (rule.get("type"), rule.get("operator"), *map(same_formula, formulas))
    return " ".join(word for word in words if word)


def _charts(archive: zipfile.ZipFile, sheet: str, part: str, drawing: Element) -> Iterator[Extra]:
    """Yield the charts of a drawing, known by their titles."""
    places = {
        value: _place(anchor)
        for anchor in drawing
        for element in _children(anchor, "chart")
        for key, value in element.items()
        if key.endswith("}id")
    }
    for relation in _relations(archive, part):
        if posixpath.basename(str(relation.Type)) in ("chart", "chartEx"):
            chart = fromstring(archive.read(relation.target))
            title = next((_text(title, "t") for title in _children(chart, "title")), "")
            where = f"{title!r} at {sheet}!{places.get(str(relation.Id), '?')}"
            yield Extra(CHARTS, where, title.casefold())


def _place(anchor: Element) -> str:
    """Return the cell under an anchor's first corner."""
    for start in _children(anchor, "from"):
        column, row = (int(_text(start, tag)) + 1 for tag in ("col", "row"))
        return f"{get_column_letter(column)}{row}"
    return "?"


def _runs(rows: list[int]) -> Iterator[tuple[int, int]]:
    """Yield the first and last of rows that follow each other."""
    start = 0
    for number, row in enumerate(rows):
        if number + 1 == len(rows) or rows[number + 1] != row + 1:
            yield rows[start], row
            start = number + 1
