"""Drives a headless LibreOffice for ``office.py``: a JSON line in, a JSON line out.

Runs under the Python that has LibreOffice's ``uno`` (Debian: /usr/bin/python3, package python3-uno).
"""

import contextlib
import json
import os
import shutil
import signal
import subprocess
import sys
import time
import uuid
from pathlib import Path

try:
    import uno
    from com.sun.star.awt import Rectangle
    from com.sun.star.beans import PropertyValue
    from com.sun.star.connection import NoConnectException
    from com.sun.star.lang import DisposedException, Locale
    from com.sun.star.sheet import TableFilterField
    from com.sun.star.sheet.FilterConnection import AND
    from com.sun.star.sheet.FilterOperator import EQUAL
    from com.sun.star.table import CellAddress
    from com.sun.star.uno import Exception as UnoException
except ImportError as error:  # told to the test session in words, which then skips or fails
    sys.stdout.write(json.dumps({"fault": f"no uno: {error}"}) + "\n")
    sys.exit()

START_SECONDS = 60
XLSX = "Calc MS Excel 2007 XML"
XLSM = "Calc MS Excel 2007 VBA XML"
WITH_ERROR = 4  # com.sun.star.sheet.FormulaResult.ERROR
RUN_MACROS = 4  # com.sun.star.document.MacroExecMode.ALWAYS_EXECUTE_NO_WARN
NO_MACROS = 0  # NEVER_EXECUTE, which is also the default
DATE, LOGICAL = 2, 1024  # com.sun.star.util.NumberFormat
POINTS = 72 / 2540  # of 1/100 mm
THIN, SOLID = 26, 0  # 1/100 mm; com.sun.star.table.BorderLineStyle


def start_office(profile, pipe):
    """Start LibreOffice with a profile of its own; return the process and its context."""
    process = subprocess.Popen(  # noqa: S603 (our own arguments)
        [
            shutil.which("soffice") or "soffice",
            "--headless",
            "--norestore",
            "--nologo",
            "--nodefault",
            f"-env:UserInstallation={Path(profile).as_uri()}",
            f"--accept=pipe,name={pipe};urp;",
        ],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        start_new_session=True,
        env={**os.environ, "LC_ALL": "C.UTF-8"},  # number formats in English
    )
    patience = time.monotonic() + START_SECONDS
    while True:
        try:
            return process, connect(pipe)
        except NoConnectException:
            if time.monotonic() > patience or process.poll() is not None:
                stop_office(process, None)
                raise
            time.sleep(0.1)


def connect(pipe):
    """Return the context of the LibreOffice that listens at a pipe."""
    here = uno.getComponentContext()
    resolver = here.ServiceManager.createInstanceWithContext(
        "com.sun.star.bridge.UnoUrlResolver", here
    )
    return resolver.resolve(f"uno:pipe,name={pipe};urp;StarOffice.ComponentContext")


def process_at(pipe):
    """Return the process that listens at a pipe; soffice itself is only its starter."""
    for process in Path("/proc").glob("[0-9]*"):
        with contextlib.suppress(OSError):
            command = (process / "cmdline").read_text(errors="replace")
            if "soffice.bin" in command and pipe in command:
                return int(process.name)
    return 0


def stop_office(process, desktop):
    """End LibreOffice politely, and after ten seconds at once."""
    if desktop is not None:
        with contextlib.suppress(UnoException):  # the connection breaks while it ends
            desktop.terminate()
    try:
        process.wait(10 if desktop is not None else 0)
    except subprocess.TimeoutExpired:
        with contextlib.suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
        process.wait()


def properties(**values):
    """Make a sequence of UNO's properties."""
    made = []
    for name, value in values.items():
        item = PropertyValue()
        item.Name, item.Value = name, value
        made.append(item)
    return tuple(made)


def url(path):
    """Turn a path into the URL that UNO takes."""
    return Path(path).as_uri()


def block(sheet, where):
    """Return the cells of a sheet that an address names."""
    return sheet.getCellRangeByPosition(
        where.StartColumn, where.StartRow, where.EndColumn, where.EndRow
    )


def is_filtered(area):
    """Return whether a filter hides rows of cells."""
    if numbers(area.RangeAddress) in map(numbers, area.queryVisibleCells().RangeAddresses):
        return False  # looking at each of many rows takes long
    return any(row.IsFiltered for row in area.Rows)


def content(cell):
    """Return what a cell holds: a number, text, a formula, or None."""
    if cell.getType().value == "VALUE":
        return cell.getValue()
    return cell.getFormula() or None


def typed(value):
    """Return what is typed for a constant: text behind an apostrophe stays text."""
    if value is None:
        return ""
    return f"'{value}" if isinstance(value, str) else repr(value)


def put_constant(cell, value):
    """Store a number or a text as it is."""
    if isinstance(value, str):
        cell.setString(value)
    else:
        cell.setValue(value)


def numbers(where):
    """Return row, column, rows and columns of an address."""
    rows, columns = where.EndRow - where.StartRow, where.EndColumn - where.StartColumn
    return where.StartRow, where.StartColumn, 1 + rows, 1 + columns


def put(cell, value):
    """Type into a cell."""
    if isinstance(value, int | float):
        cell.setValue(value)
    elif value is None or value.startswith("="):
        cell.setFormula(value or "")
    else:
        cell.setString(value)


class Session:
    """LibreOffice with at most one workbook open; each method is a command."""

    def __init__(self, context):
        make = context.ServiceManager.createInstanceWithContext
        self.desktop = make("com.sun.star.frame.Desktop", context)
        self._functions = make("com.sun.star.sheet.FunctionAccess", context)
        self._configuration = make("com.sun.star.configuration.ConfigurationProvider", context)
        self._book = None
        self._typed = []

    def open(self, path, macros, unsaved):
        """Open a workbook with the values that it stores, and with macros enabled or not."""
        mode = RUN_MACROS if macros else NO_MACROS
        how = properties(Hidden=True, MacroExecutionMode=mode, AsTemplate=unsaved)
        self._book = self.desktop.loadComponentFromURL(url(path), "_blank", 0, how)
        if self._book is None:
            raise ValueError(f"{path} does not open")

    def recalculate(self):
        """Calculate every formula of the workbook from scratch."""
        self._book.calculateAll()

    def formulas(self):
        """Return sheet, row, column and value of every formula cell."""
        cells = []
        for sheet in self._book.Sheets:
            name = sheet.Name  # a question to LibreOffice: once, not for every cell
            used = sheet.createCursor()
            used.gotoEndOfUsedArea(True)  # noqa: FBT003 (UNO has no names)
            values = self._values(sheet, used)
            for row, texts in enumerate(used.getFormulaArray()):
                for column, text in enumerate(texts):
                    if text.startswith("="):
                        cells.append((name, row, column, values[row][column]))
        return cells

    def read(self, places):
        """Return the values of many areas, each as rows."""
        answers = []
        for place in places:
            area = self._area(place)
            answers.append(self._values(area.Spreadsheet, area))
        return answers

    def write(self, cells):
        """Type into cells: numbers, formulas (``=...``), text; None empties a cell."""
        for place, value in cells:
            cell = self._area(place).getCellByPosition(0, 0)
            self._typed.append((cell, content(cell)))
            put(cell, value)

    def paste(self, source, target):
        """Copy cells and paste them whole, as a person does by Ctrl+C and Ctrl+V."""
        area, first = self._area(source), self._area(target).getCellByPosition(0, 0)
        first.Spreadsheet.copyRange(first.CellAddress, area.RangeAddress)

    def modules(self, library):
        """Return the source of every module of a library of macros, by its name."""
        modules = self._book.BasicLibraries.getByName(library)
        return {name: modules.getByName(name) for name in modules.ElementNames}

    def remove(self, sheet):
        """Delete a sheet."""
        self._book.Sheets.removeByName(sheet)

    def undo(self):
        """Put back what was typed over since the workbook was opened.

        Nobody looks at the cells in between, so LibreOffice must be told to calculate them: cells
        that were errors else stay what they were when the next thing is typed.
        """
        while self._typed:
            put(*self._typed.pop())
        if self._book is not None:
            self._book.calculate()

    def save(self, path):
        """Save the workbook as .xlsx."""
        self._book.storeToURL(url(path), properties(FilterName=XLSX))

    def pages(self, width, height):
        """Return how many pages a print of all sheets has on a paper (mm)."""
        for style in self._book.StyleFamilies.getByName("PageStyles"):
            style.Width, style.Height = round(100 * width), round(100 * height)
        return self._book.getRendererCount(self._book, ())

    def close(self):
        """Close the workbook without saving it."""
        if self._book is not None:
            self._book.close(True)  # noqa: FBT003 (UNO has no names)
            self._book, self._typed = None, []

    def _area(self, place):
        """Return cells by ``[sheet, "B5:C6"]`` or by a defined name."""
        if isinstance(place, str):
            return self._book.NamedRanges.getByName(place).getReferredCells()
        sheet, cells = place
        return self._book.Sheets.getByName(sheet).getCellRangeByName(cells)

    def _values(self, sheet, area):
        """Return the values of cells in bulk; errors, which UNO leaves out, as their text."""
        rows = [list(row) for row in area.getDataArray()]
        where = area.getRangeAddress()
        wrong = area.queryFormulaCells(WITH_ERROR)
        if not wrong.getCount():
            return rows
        for part in wrong.getRangeAddresses():
            missing = self._not_available(sheet, part)
            for row in range(part.StartRow, part.EndRow + 1):
                for column in range(part.StartColumn, part.EndColumn + 1):
                    known = missing[row - part.StartRow][column - part.StartColumn]
                    text = "#N/A" if known else sheet.getCellByPosition(column, row).getString()
                    rows[row - where.StartRow][column - where.StartColumn] = text
        return rows

    def _not_available(self, sheet, part):
        """Return 1 where cells are #N/A: one call, where a look at each takes seconds."""
        marks = self._functions.callFunction("ISNA", (block(sheet, part),))
        return marks if isinstance(marks, tuple) else ((marks,),)


class Live(Session):
    """What the engine for xlwings needs besides; rows and columns count from 0."""

    def bind(self, name):
        """Take an open workbook by its name."""
        for book in self.desktop.Components:
            self._book = book
            if self.book()["name"] == name:
                return
        raise ValueError(f"no open workbook is called {name}")

    def book(self):
        """Return the workbook's name, and its path if it was ever saved."""
        if not self._book.URL:
            return {"name": self._book.Title, "path": None}
        path = Path(uno.fileUrlToSystemPath(self._book.URL))
        return {"name": path.name, "path": str(path)}

    def version(self):
        """Return LibreOffice's version."""
        node = properties(nodepath="/org.openoffice.Setup/Product")
        view = "com.sun.star.configuration.ConfigurationAccess"
        product = self._configuration.createInstanceWithArguments(view, node)
        return product.getByName("ooSetupVersionAboutBox")

    def save_as(self, path):
        """Save the workbook under a new name, or under its own."""
        if path is None:
            self._book.store()
            return
        name = XLSM if path.endswith(".xlsm") else XLSX
        self._book.storeAsURL(url(path), properties(FilterName=name))

    def calculation(self, automatic):
        """Switch automatic calculation on or off; None asks only."""
        if automatic is not None:
            self._book.enableAutomaticCalculation(automatic)
        return self._book.isAutomaticCalculationEnabled()

    def calculate(self):
        """Calculate what has changed."""
        self._book.calculate()

    def sheets(self):
        """Return the names of the sheets."""
        return self._book.Sheets.ElementNames

    def active(self):
        """Return the name of the sheet that is in front."""
        return self._book.CurrentController.ActiveSheet.Name

    def activate(self, sheet):
        """Bring a sheet to the front."""
        self._book.CurrentController.setActiveSheet(self._book.Sheets.getByName(sheet))

    def select(self, place):
        """Select cells."""
        self._book.CurrentController.select(self._area(place))

    def selected(self):
        """Return the cells that are selected."""
        return self._book.CurrentController.Selection.AbsoluteName

    def height(self, place):
        """Return the height of rows in points: 0 for hidden ones, None where they differ."""
        rows = self._area(place).Rows
        heights = {row.Height * POINTS if row.IsVisible else 0 for row in rows}
        return heights.pop() if len(heights) == 1 else None

    def filter(self, table, column, text):
        """Show the rows of a table alone that have a text in a column, or all if it is None."""
        cells = self._book.DatabaseRanges.getByName(table).ReferredCells
        descriptor = cells.createFilterDescriptor(True)  # noqa: FBT003 (UNO has no names)
        if text:
            descriptor.FilterFields = (TableFilterField(AND, column, EQUAL, False, 0, text),)  # noqa: FBT003
        descriptor.ContainsHeader = True
        cells.filter(descriptor)

    def used(self, sheet):
        """Return the block of a sheet that holds something."""
        cursor = self._book.Sheets.getByName(sheet).createCursor()
        cursor.gotoStartOfUsedArea(False)  # noqa: FBT003 (UNO has no names)
        cursor.gotoEndOfUsedArea(True)  # noqa: FBT003
        return numbers(cursor.RangeAddress)

    def cells(self, place, formulas):
        """Return values of cells, and formulas, or else where dates and truths are."""
        area = self._area(place)
        values = self._values(area.Spreadsheet, area)
        if formulas:
            return {"values": values, "formulas": area.getFormulaArray(), "kinds": []}
        return {"values": values, "formulas": None, "kinds": list(self._kinds(area))}

    def fill(self, place, constants, formulas, kinds):
        """Write a block: constants, and formulas where there are any."""
        area = self._writable(place)
        if is_filtered(area):
            self._fill_filtered(area, formulas[0][0] if formulas else constants[0][0])
            return
        for where in self._formatted(area, LOGICAL):  # what is written decides what it is
            block(area.Spreadsheet, where).NumberFormat = 0
        if formulas is None:
            area.setDataArray(tuple(tuple("" if x is None else x for x in y) for y in constants))
        else:
            self._fill_mixed(area, constants, formulas)
        for row, column, kind in kinds:
            cell = area.getCellByPosition(column, row)
            if self._format(cell).FormatString == "General":
                cell.NumberFormat = self._book.NumberFormats.getStandardFormat(kind, Locale())

    def add_own(self, sheet):
        """Add what a designer adds: a sheet with formula, chart and filter, a note on another."""
        self._book.Sheets.insertNewByName(sheet, 0)
        own = self._book.Sheets.getByName(sheet)
        own.getCellByPosition(0, 0).setFormula("=$GA.B4+1")
        cells = own.getCellRangeByName("A1:A3").RangeAddress
        own.Charts.addNewByName("Mine", Rectangle(1000, 1000, 8000, 6000), (cells,), False, False)  # noqa: FBT003 (UNO has no names)
        listed = own.getCellRangeByName("A11:A14")
        listed.setDataArray((("Kind",), ("a",), ("b",), ("a",)))
        self._book.DatabaseRanges.addNewByName(sheet, listed.RangeAddress)
        self.filter(sheet, 0, "a")
        noted = self._book.Sheets.getByName("GA")
        noted.Annotations.insertNew(noted.getCellByPosition(0, 60).CellAddress, "my note")

    def read_own(self, sheet):
        """Return what is there of it, the notes, and how many charts each sheet has."""
        own = self._book.Sheets.getByName(sheet)
        notes = [note.String for note in self._book.Sheets.getByName("GA").Annotations]
        charts = {each.Name: each.Charts.Count for each in self._book.Sheets}
        listed = own.getCellRangeByName("A11:A14").queryVisibleCells().RangeAddressesAsString
        return own.getCellByPosition(0, 0).Formula, listed, sorted(notes), charts

    def replace_module(self, library, module, source):
        """Give a macro module another source."""
        self._book.BasicLibraries.getByName(library).replaceByName(module, source)

    def press(self, sheet, caption):
        """Do what a click on a button does."""
        for form in self._book.Sheets.getByName(sheet).DrawPage.Forms:
            for number, button in enumerate(form):
                if button.Label == caption:
                    (event,) = form.getScriptEvents(number)
                    script = self._book.ScriptProvider.getScript(event.ScriptCode)
                    script.invoke((), (), ())
                    return
        raise ValueError(f"no button {caption} on {sheet}")

    def protect(self, sheet):
        """Protect a sheet, without a password."""
        self._book.Sheets.getByName(sheet).protect("")

    def names(self):
        """Return all defined names; those of one sheet as ``Sheet!Name``."""
        own = [(s.Name, name) for s in self._book.Sheets for name in s.NamedRanges.ElementNames]
        return [*self._book.NamedRanges.ElementNames, *(f"{sheet}!{name}" for sheet, name in own)]

    def name(self, name, content):
        """Return what a defined name stands for, after changing it unless None is given."""
        where, plain = self._scope(name)
        if content is not None:
            if not where.hasByName(plain):
                where.addNewByName(plain, content, CellAddress(), 0)
            where.getByName(plain).setContent(content)
        return where.getByName(plain).Content

    def remove_name(self, name):
        """Delete a defined name."""
        where, plain = self._scope(name)
        where.removeByName(plain)

    def tables(self, sheet):
        """Return names and cells of a sheet's tables."""
        index = self._book.Sheets.ElementNames.index(sheet)
        tables = [(table.Name, table.DataArea) for table in self._book.DatabaseRanges]
        return [(name, numbers(where)) for name, where in tables if where.Sheet == index]

    def resize(self, table, place):
        """Give a table other cells."""
        self._book.DatabaseRanges.getByName(table).DataArea = self._writable(place).RangeAddress

    def print_areas(self, sheet, places):
        """Return the areas that are printed, after changing them unless None is given."""
        cells = self._book.Sheets.getByName(sheet)
        if places is not None:
            cells.setPrintAreas(tuple(self._area(place).RangeAddress for place in places))
        return [numbers(where) for where in cells.getPrintAreas()]

    def style(self, place, name):
        """Return a property of cells, None where they differ."""
        value = self._area(place).getPropertyValue(name)
        return value.value if isinstance(value, uno.Enum) else value

    def set_style(self, place, name, value):
        """Give cells a property; an enum's value comes as its type and its name."""
        value = uno.Enum(*value) if isinstance(value, list) else value
        self._writable(place).setPropertyValue(name, value)

    def number_format(self, place, code):
        """Return the number format of cells, after changing it unless None is given."""
        if code is not None:
            formats, where = self._book.NumberFormats, Locale()
            key = formats.queryKey(code, where, False)  # noqa: FBT003 (UNO has no names)
            key = formats.addNew(code, where) if key == -1 else key
            self._writable(place).NumberFormat = key
        area = self._area(place)
        return None if area.NumberFormat is None else self._format(area).FormatString

    def borders(self, place, sides, changes):
        """Change lines around and inside cells; what is not given stays."""
        area = self._writable(place)
        border = area.TableBorder2
        for side in sides:
            line = getattr(border, f"{side}Line")
            if not line.LineWidth:
                line.LineWidth, line.LineStyle = THIN, SOLID
            for name, value in changes.items():
                setattr(line, name, value)
            line.OuterLineWidth = line.LineWidth
            setattr(border, f"{side}Line", line)
            setattr(border, f"Is{side}LineValid", True)
        for side in {"Top", "Bottom", "Left", "Right", "Horizontal", "Vertical"}.difference(sides):
            setattr(border, f"Is{side}LineValid", False)
        area.TableBorder2 = border

    def merge(self, place, merged):
        """Merge cells, or take them apart."""
        self._writable(place).merge(merged)

    def clear(self, place, flags):
        """Take away contents, formats, or both."""
        self._writable(place).clearContents(flags)

    def _writable(self, place):
        """Return cells that may be changed: Excel refuses others, LibreOffice may keep silent."""
        area = self._area(place)
        if area.Spreadsheet.isProtected():
            protection = area.CellProtection
            if protection is None or protection.IsLocked:
                raise ValueError(f"the sheet of {area.AbsoluteName} is protected")
        return area

    def _fill_filtered(self, area, first):
        """Do what Excel does where a filter hides rows (xlwings, issues 679 and 747).

        The first cell of what is written goes into each visible one; hidden ones stay.
        """
        for cells in area.queryVisibleCells():
            cells.setFormulaArray([[typed(first)] * len(row) for row in cells.getFormulaArray()])

    def _fill_mixed(self, area, constants, formulas):
        """Write constants and formulas at once; what was read in another way, once more."""
        area.setFormulaArray(
            tuple(
                tuple(formula or typed(value) for value, formula in zip(*rows, strict=True))
                for rows in zip(constants, formulas, strict=True)
            )
        )
        for row, values in enumerate(area.getDataArray()):
            for column, value in enumerate(values):
                meant = constants[row][column]
                if meant is not None and value != meant:
                    put_constant(area.getCellByPosition(column, row), meant)

    def _kinds(self, area):
        """Iterate over the parts of an area that hold dates or truths: their kind and place."""
        for cells in area.getUniqueCellFormatRanges():  # takes longer than all values
            for kind in (DATE, LOGICAL):
                if self._format(cells).Type & kind:
                    yield from ((kind, numbers(where)) for where in cells.getRangeAddresses())

    def _formatted(self, area, kind):
        """Iterate over the parts of an area whose number format is of a kind."""
        for cells in area.getUniqueCellFormatRanges():
            if self._format(cells).Type & kind:
                yield from cells.getRangeAddresses()

    def _format(self, cells):
        return self._book.NumberFormats.getByKey(cells.NumberFormat)

    def _scope(self, name):
        """Return the names of the workbook or of one sheet, and the name without its sheet."""
        sheet, _, plain = name.rpartition("!")
        owner = self._book.Sheets.getByName(sheet) if sheet else self._book
        return owner.NamedRanges, plain


def answer(session, line):
    """Carry out one command."""
    command = json.loads(line)
    try:
        return {"answer": getattr(session, command.pop("do"))(**command)}
    except DisposedException:
        raise
    except (UnoException, ValueError) as error:
        return {"fault": f"{type(error).__name__}: {error}"}


def say(message):
    """Write one line."""
    sys.stdout.write(json.dumps(message) + "\n")
    sys.stdout.flush()


def serve(session):
    """Answer until the input ends."""
    for line in sys.stdin:
        say(answer(session, line))


def join(pipe):
    """Serve a LibreOffice that somebody else started, and leave it as it is."""
    try:
        session = Live(connect(pipe))
    except UnoException as error:
        say({"fault": f"no LibreOffice at {pipe}: {error}"})
        return
    say({"answer": {"group": None, "pid": process_at(pipe), "pipe": pipe}})
    serve(session)


def main(profile):
    """Tell LibreOffice's process group, then serve until the input ends."""
    pipe = f"grasp_xl_{uuid.uuid4().hex}"
    try:
        process, context = start_office(profile, pipe)
    except (OSError, UnoException) as error:
        say({"fault": f"soffice does not start: {error}"})
        return
    session = Live(context)
    try:
        say({"answer": {"group": process.pid, "pid": process_at(pipe), "pipe": pipe}})
        serve(session)
    finally:
        with contextlib.suppress(UnoException):  # an open workbook would leave its lock file
            session.close()
        stop_office(process, session.desktop)


if __name__ == "__main__":
    if sys.argv[1] == "--connect":
        join(sys.argv[2])
    else:
        main(sys.argv[1])
