"""What the next writing of a workbook would lose: it is compared with what we would write as it is.

All that we read from a workbook we also write into it again.  So whatever is in the workbook and
not in that copy, would be gone.
"""

from __future__ import annotations

import io
import math
import re
import zipfile
from collections.abc import Iterator
from dataclasses import dataclass, replace

from grasp_xl.workbook import layout
from grasp_xl.workbook.cells import Source, Value, cells_of, is_blank, normal, same_formula
from grasp_xl.workbook.extras import AREA_NAMES, VALIDATIONS, Extra, not_among, read_extras
from grasp_xl.workbook.grasp_sheet import RENDERING_TEXT
from grasp_xl.workbook.layout import CALC, FITNESS_TABLE, GA, GRASP, OPTION_SPACE, RUN_LOG, Area
from grasp_xl.workbook.macros import BUTTONS
from grasp_xl.workbook.package import Package
from grasp_xl.workbook.patch import FREE_COLUMNS
from grasp_xl.workbook.picker import DESIGN_PICK, TRADE_OFF_PICK
from grasp_xl.workbook.proved import LEGENDS
from grasp_xl.workbook.reading import find_sheet
from grasp_xl.workbook.reading_polygon import corner_cells
from grasp_xl.workbook.styles import Style
from grasp_xl.workbook.table import DASH, NO, YES
from grasp_xl.workbook.written import WrittenBook, WrittenCell

MAX_NAMED = 10
"""Things of a kind, on a sheet, that a message names."""

PICTURES = "pictures"
OUR_PICTURE = b'descr="%s"' % RENDERING_TEXT.encode()
"""A run makes it anew, or leaves it out."""

OBJECTS = {
    PICTURES: ("/media/", b""),
    "shapes or text boxes": (
        "/drawings/drawing",
        b'<xdr:sp(?=[ />])(?![^>]*macro="[^"]*(?:%s)")'
        b'(?![^>]*>[^<]*<xdr:nvSpPr>[^<]*<xdr:cNvPr[^>]* descr="(?:%s)")'
        % ("|".join(BUTTONS.values()).encode(), "|".join(BUTTONS).encode()),
    ),  # Excel and LibreOffice keep a second picture of each button there
    "threaded comments": ("/threadedComments/", b"<threadedComment "),
    "macro modules": ("/vbaProject.bin", b""),
    "pivot tables": ("/pivotTables/pivotTable", b""),
    "links to other workbooks": ("/externalLinks/externalLink", b""),
    "controls": ("/drawings/vmlDrawing", b'ObjectType="(?!Note)'),
    "sparklines": ("/worksheets/sheet", b"<x14:sparkline>"),
}
"""Objects of which we have none, or none in another place: what the names of their parts hold, and
what is counted in these."""

KINDS = layout.KINDS
INPUT_NAMES = (
    *(one.name for one in (*layout.PARAMETERS, *layout.PART.fields, layout.SCALE_FACTOR)),
    *(one.name for kind in KINDS for one in (*kind.section.fields, kind.diameter, kind.model)),
    *(kind.locations_name for kind in KINDS),
    *(layout.IDEAL_POLYGON, layout.APPROXIMATION_POLYGON),
    *(layout.USER_BLOCK.name, layout.WHAT_IF.name),
    *(DESIGN_PICK.name, TRADE_OFF_PICK.name),
)
"""Cells whose values are read: what is typed there is kept."""

HELPER_SHEETS = (GRASP, CALC)
"""What is no formula there is a copy of inputs, for pictures and cards."""

PICKED_LISTS = (layout.VALID_DESIGNS, layout.TRADE_OFFS)
"""Sheets with formulas on a list, which is as long as its run made it."""

CELLS, FORMULAS, CHANGED = "cells", "formulas in", "changed cells"
ACCURACY = 1e-9
"""Programs store numbers with 15 digits or 17."""


@dataclass(frozen=True, slots=True)
class Written:
    """A workbook written again as it was.

    Parameters
    ----------
    book : WrittenBook
    same_inputs : bool
        Whether its results are those of the inputs that it has now: else numbers and what depends
        on sizes are different though nobody typed over them.
    """

    book: WrittenBook
    same_inputs: bool


def sheet_gone(source: Source, written: Written) -> str | None:
    """Return a sheet of ours without which it cannot be told what else of a workbook is not."""
    ours = written.book.sheets
    gone = (name for name in ours if name not in source.sheets)
    return next(gone, None) if GA in ours else None  # an export's may have any name


def losses(package: Package, source: Source, written: Written) -> list[str]:
    """List what a workbook holds beside what we wrote."""
    copy = Package("the workbook as we wrote it", written.book.content)
    own = {name: name for name in written.book.sheets} | {find_sheet(source): OPTION_SPACE}
    found = [f"the sheet {name!r}" for name in source.sheets if name not in own]
    now, then = _objects(package), _objects(copy)
    found += [
        f"{what} ({now[what] - then[what]} more than ours)"
        for what in OBJECTS
        if now[what] > then[what]
    ]
    theirs, ours = read_extras(package), read_extras(copy)
    found += _extras(theirs.of_book, ours.of_book)
    cells = Comparison(source, written)
    for sheet, our_name in own.items():
        if sheet in source.sheets:
            changes = list(cells.changes(sheet, our_name))
            for what in (CELLS, FORMULAS, CHANGED):
                found += _named(what, [cell.where for kind, cell in changes if kind == what])
            same_sizes = written.same_inputs and our_name != RUN_LOG
            extras = (theirs.by_sheet[sheet], ours.by_sheet[our_name])
            found += _extras(*extras, same_sizes=same_sizes)
    return found


def filled_cells(source: Source, sheet: str) -> set[tuple[int, int]]:
    """Return the rows and columns of all cells that hold anything."""
    grids = (source.grid(sheet, formulas=formulas) for formulas in (False, True))
    return {
        (row, column)
        for grid in grids
        for row, values in grid.rows.items()
        for column, value in enumerate(values)
        if not is_blank(value)
    }


def _objects(package: Package) -> dict[str, int]:
    with zipfile.ZipFile(io.BytesIO(package.content)) as archive:
        names = archive.namelist()
        found = {
            what: sum(
                len(re.findall(counted, archive.read(name))) if counted else 1
                for name in names
                if part in name
            )
            for what, (part, counted) in OBJECTS.items()
        }
        drawings = (archive.read(name) for name in names if "/drawings/drawing" in name)
        found[PICTURES] -= sum(OUR_PICTURE in drawing for drawing in drawings)
        return found


def _extras(theirs: list[Extra], ours: list[Extra], *, same_sizes: bool = True) -> list[str]:
    if not same_sizes:
        theirs, ours = ([_without_sizes(one) for one in extras] for extras in (theirs, ours))
    lost: dict[str, list[str]] = {}
    for one in not_among(theirs, ours):
        lost.setdefault(one.what, []).append(one.where)
    return [text for what, places in lost.items() for text in _named(what, places)]


def _without_sizes(extra: Extra) -> Extra:
    if extra.what in (VALIDATIONS, *AREA_NAMES.values()):
        return replace(extra, key=_without_digits(extra.key))
    return extra


def _named(what: str, places: list[str]) -> list[str]:
    return [f"the {what} {first_named(list(dict.fromkeys(places)))}"] if places else []


def first_named(places: list[str]) -> str:
    """Name the first places, and how many more there are."""
    more = f" and {len(places) - MAX_NAMED} more" if len(places) > MAX_NAMED else ""
    return f"{', '.join(places[:MAX_NAMED])}{more}"


class Comparison:
    """Compares the cells of a workbook with what we would write into it as it is."""

    def __init__(self, source: Source, written: Written) -> None:
        self._source = source
        self._written = written
        areas = [source.names[name] for name in INPUT_NAMES if name in source.names]
        if layout.APPROXIMATION_POLYGON in source.names:
            corners = corner_cells(source, source.names[layout.APPROXIMATION_POLYGON])
            areas.append(replace(corners, column=corners.column - 1, columns=1 + corners.columns))
        self.inputs = {cell for area in areas for row in cells_of(area) for cell in row}

    def changes(self, sheet: str, our_name: str) -> Iterator[tuple[str, Area]]:
        """Yield what would be lost of a sheet, and the cell where it stands."""
        ours = self._written.book.sheets[our_name].cells
        for row, column in sorted(filled_cells(self._source, sheet)):
            cell = Area(sheet, row, column)
            if self._is_free(cell, our_name):
                continue
            if (row, column) in ours:
                what = self._change(cell, our_name, ours[row, column])
            else:
                what = "" if cell in self.inputs else CELLS
            if what:
                yield what, cell

    def _is_free(self, cell: Area, our_name: str) -> bool:
        """Tell whether a run says in a cell what it likes: in the log; of other inputs, values."""
        if our_name == FITNESS_TABLE and (self._written.same_inputs or self._formula(cell)):
            return False
        return cell.column < FREE_COLUMNS.get(our_name, 0)

    def _change(self, cell: Area, our_name: str, ours: WrittenCell) -> str:
        """Return what is lost of a cell where we have one, too; nothing if it is empty."""
        formula, our_formula = self._formula(cell), same_formula(ours.formula)
        if cell in self._source.worked_out or (cell in self.inputs and not formula):
            return ""
        if formula:
            lists_changed = our_name in PICKED_LISTS and not self._written.same_inputs
            sizes_only = cell in self.inputs or lists_changed
            same = our_formula == formula or (sizes_only and _alike(formula, our_formula))
            of_gone_sheet = "#REF!" in formula and our_formula
            return "" if same or of_gone_sheet else FORMULAS
        value = self._source.value(cell)
        if our_formula:
            kept = _same(value, ours.value)
        else:
            kept = our_name in HELPER_SHEETS or self._same_value(value, ours)
        return "" if kept else CHANGED

    def _formula(self, cell: Area) -> str:
        text = self._source.grid(cell.sheet, formulas=True).at(cell.row, cell.column)
        return same_formula(str(getattr(text, "text", text) or ""))

    def _same_value(self, value: Value, ours: WrittenCell) -> bool:
        """Compare values; where inputs changed, a result may be another one."""
        our_value, drawn = ours.value, ours.style is Style.DRAWN  # which may be empty
        if not self._written.same_inputs and _is_result(value) and (drawn or _is_result(our_value)):
            return True
        if isinstance(value, str) and isinstance(our_value, str):
            return self._same_text(normal(value), normal(our_value))
        return _same(value, our_value)

    def _same_text(self, text: str, our_text: str) -> bool:
        """Compare text; where inputs changed, without what they say in it: ``(seed 2)``, ``5``."""
        if not self._written.same_inputs:
            text, our_text = (re.sub(r"\(.*\)|\d", "", one) for one in (text, our_text))
        return text.strip() == our_text.strip()


def _alike(formula: str, our_formula: str) -> bool:
    """Tell whether formulas differ at most in rows and sizes."""
    return _without_digits(formula) == _without_digits(our_formula)


def _without_digits(text: str) -> str:
    return re.sub(r"\d", "", text)


def _is_result(value: Value) -> bool:
    return isinstance(value, int | float) or value in (DASH, YES, NO, *LEGENDS)


def _same(value: Value, our_value: Value) -> bool:
    """Compare values as far as programs keep their digits."""
    if isinstance(value, int | float) and isinstance(our_value, int | float):
        return math.isclose(value, our_value, rel_tol=ACCURACY, abs_tol=ACCURACY)
    return value == our_value
