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
    from com.sun.star.beans import PropertyValue
    from com.sun.star.connection import NoConnectException
    from com.sun.star.lang import DisposedException
    from com.sun.star.uno import Exception as UnoException
except ImportError as error:  # told to the test session in words, which then skips or fails
    sys.stdout.write(json.dumps({"fault": f"no uno: {error}"}) + "\n")
    sys.exit()

START_SECONDS = 60
XLSX = "Calc MS Excel 2007 XML"
WITH_ERROR = 4  # com.sun.star.sheet.FormulaResult.ERROR
RUN_MACROS = 4  # com.sun.star.document.MacroExecMode.ALWAYS_EXECUTE_NO_WARN
NO_MACROS = 0  # NEVER_EXECUTE, which is also the default
SCRATCH = "scratch_of_the_tests"


def start_office(profile):
    """Start LibreOffice with a profile of its own; return the process and its desktop."""
    pipe = f"grasp_xl_{uuid.uuid4().hex}"
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
    )
    here = uno.getComponentContext()
    make = here.ServiceManager.createInstanceWithContext
    resolver = make("com.sun.star.bridge.UnoUrlResolver", here)
    address = f"uno:pipe,name={pipe};urp;StarOffice.ComponentContext"
    patience = time.monotonic() + START_SECONDS
    while True:
        try:
            there = resolver.resolve(address)
        except NoConnectException:
            if time.monotonic() > patience or process.poll() is not None:
                stop_office(process, None)
                raise
            time.sleep(0.1)
        else:
            manager = there.ServiceManager
            desktop = manager.createInstanceWithContext("com.sun.star.frame.Desktop", there)
            return process, desktop


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


def content(cell):
    """Return what a cell holds: a number, text, a formula, or None."""
    if cell.getType().value == "VALUE":
        return cell.getValue()
    return cell.getFormula() or None


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

    def __init__(self, desktop):
        self._desktop = desktop
        self._book = None
        self._typed = []

    def open(self, path, macros):
        """Open a workbook with the values that it stores, and with macros enabled or not."""
        mode = RUN_MACROS if macros else NO_MACROS
        self._book = self._desktop.loadComponentFromURL(
            url(path), "_blank", 0, properties(Hidden=True, MacroExecutionMode=mode)
        )
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
        missing = self._not_available(area)
        for part in wrong.getRangeAddresses():
            for row in range(part.StartRow, part.EndRow + 1):
                for column in range(part.StartColumn, part.EndColumn + 1):
                    at = (row - where.StartRow, column - where.StartColumn)
                    known = missing[at[0]][at[1]] == 1
                    text = "#N/A" if known else sheet.getCellByPosition(column, row).getString()
                    rows[at[0]][at[1]] = text
        return rows

    def _not_available(self, area):
        """Return 1 where cells are #N/A: one array formula, where a look at each takes seconds."""
        sheets, where = self._book.Sheets, area.getRangeAddress()
        sheets.insertNewByName(SCRATCH, sheets.Count)
        scratch = sheets.getByName(SCRATCH).getCellRangeByPosition(
            where.StartColumn, where.StartRow, where.EndColumn, where.EndRow
        )
        scratch.setArrayFormula(f"=IF(ISNA({area.AbsoluteName});1;0)")
        marks = scratch.getDataArray()
        sheets.removeByName(SCRATCH)
        return marks


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


def main(profile):
    """Tell LibreOffice's process group, then serve until the input ends."""
    try:
        process, desktop = start_office(profile)
    except (OSError, UnoException) as error:
        say({"fault": f"soffice does not start: {error}"})
        return
    session = Session(desktop)
    try:
        say({"answer": process.pid})
        for line in sys.stdin:
            say(answer(session, line))
    finally:
        with contextlib.suppress(UnoException):  # an open workbook would leave its lock file
            session.close()
        stop_office(process, desktop)


if __name__ == "__main__":
    main(sys.argv[1])
