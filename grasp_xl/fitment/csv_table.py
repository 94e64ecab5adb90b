"""A CSV file as a table: cells by column and line, and what is wrong with the file itself."""

from __future__ import annotations

import csv
import io
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from grasp_xl.errors import InputError, Problem
from grasp_xl.file_content import FileKind, read_content
from grasp_xl.printable import quoted

MAX_ROWS = 10_000
MAX_FILE_BYTES = 16_000_000
"""Room for 10,000 rows of 1,600 bytes; the shipped rows have 450."""

CSV = FileKind(
    "file",
    "a CSV file (UTF-8, separated by , or ;)",
    MAX_FILE_BYTES,
    f"save at most {MAX_ROWS:,} elements, a line each",
)

_SEPARATORS = (",", ";")


@dataclass(frozen=True, slots=True)
class Row:
    """A row that is not blank.

    Parameters
    ----------
    line : int
        Line of the file on which it begins, from 1.
    cells : dict
        Text by column, without white space around it; no blank cells.
    """

    line: int
    cells: dict[str, str]


@dataclass(slots=True)
class CsvTable:
    """A CSV file that is being read: its rows, and the problems found so far.

    Parameters
    ----------
    name : str
        File name as the person gave it.
    separator : {",", ";"}
    columns : frozenset of str
        Those of the header that are known.
    rows, problems, warnings : list
    """

    name: str
    separator: str = ","
    columns: frozenset[str] = frozenset()
    rows: list[Row] = field(default_factory=list)
    problems: list[Problem] = field(default_factory=list)
    warnings: list[Problem] = field(default_factory=list)

    def where(self, line: int, column: str = "") -> str:
        """Say where a cell stands."""
        return f"{self.name}, line {line}" + (f", column {column}" if column else "")

    def complain(self, line: int, column: str, found: str, expected: str, hint: str) -> None:
        """Note a problem."""
        self.problems.append(Problem(self.where(line, column), found, expected, hint))


def read_table(path: Path, columns: Sequence[str], required: Sequence[str]) -> CsvTable:
    """Read a CSV file whose first row names its columns.

    Parameters
    ----------
    path : Path
    columns, required : sequence of str
        The columns that are known, and those that there must be.

    Raises
    ------
    InputError
        If it is no such file, whatever its rows say.
    """
    table = CsvTable(str(path))
    text = _decoded(read_content(path, CSV), table.name)
    blank = " \t" + "".join(_SEPARATORS)
    first = next((line for line in text.splitlines() if line.strip(blank)), None)
    if first is None:
        raise InputError([Problem(table.name, "an empty file", CSV.expected, "export it again")])
    table.separator = max(_SEPARATORS, key=lambda mark: len(_names(first, mark) & {*columns}))
    rows = _rows(text, table)
    header = next(rows, None)
    names = [cell.casefold() for cell in header[1]] if header else []
    if header and not {*names} & {*required}:
        found = f"no header, but {quoted(first.strip())}"
        hint = f"begin with a line such as {table.separator.join((*required, 'diameter_mm'))}"
        expected = f"names of columns with {' or '.join(_SEPARATORS)} between them"
        table.complain(header[0], "", found, expected, hint)
    elif header:
        _check_header(table, header[0], names, columns, required)
        _fill(table, names, rows)
    if not table.rows and not table.problems:
        hint = "write a line for each element"
        table.warnings.append(Problem(table.name, "a header alone", "rows below it", hint))
    return table


def _decoded(content: bytes, name: str) -> str:
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        found = f"bytes that are no UTF-8 (0x{content[error.start]:02x})"
        hint = 'in Excel, save it with the type "CSV UTF-8"'
        where = f"{name}, line {line}"
        raise InputError([Problem(where, found, "a CSV file in UTF-8", hint)]) from None


def _names(line: str, separator: str) -> set[str]:
    """Return the names in a header that is parted by one separator."""
    return {cell.strip().strip('"').strip().casefold() for cell in line.split(separator)}


def _rows(text: str, table: CsvTable) -> Iterator[tuple[int, list[str]]]:
    """Yield the rows that are not blank, each with its first line, up to one that is damaged."""
    reader = csv.reader(io.StringIO(text, newline=""), delimiter=table.separator, strict=True)
    while True:
        line = reader.line_num + 1
        try:
            cells = [cell.strip() for cell in next(reader)]
        except StopIteration:
            return
        except csv.Error as error:
            expected = 'cells whose quotation marks are closed, and doubled inside ("46 "" wide")'
            hint = "mend this line; what stands below it was not read"
            table.complain(line, "", f"a damaged row ({error})", expected, hint)
            return
        if any(cells):
            yield line, cells


def _check_header(
    table: CsvTable, line: int, names: list[str], columns: Sequence[str], required: Sequence[str]
) -> None:
    table.columns = frozenset(names) & frozenset(columns)
    for column in required:
        if column not in names:
            found, hint = f"no column {column}", f"add the column {column}"
            table.complain(line, "", found, f"the columns {', '.join(required)}", hint)
    for name, times in Counter(names).items():
        if name in columns and times > 1:
            table.complain(line, name, f"{times} such columns", "one", "take away the others")
        elif name and name not in columns:
            found = f"the unknown column {quoted(name)}"
            hint = "it is not read"
            table.warnings.append(Problem(table.where(line), found, ", ".join(columns), hint))


def _fill(table: CsvTable, names: list[str], rows: Iterator[tuple[int, list[str]]]) -> None:
    for line, cells in rows:
        if len(table.rows) == MAX_ROWS:
            found, hint = f"more than {MAX_ROWS:,} rows", "keep the elements that are of use"
            problem = Problem(table.where(line), found, f"at most {MAX_ROWS:,}", hint)
            raise InputError([problem])
        if any(cells[len(names) :]):
            found, expected = f"{len(cells)} cells", f"{len(names)}, as the header has"
            hint = f"put a text that holds {table.separator!r} in quotation marks"
            table.complain(line, "", found, expected, hint)
            continue
        known = {
            name: cell
            for name, cell in zip(names, cells, strict=False)
            if cell and name in table.columns
        }
        table.rows.append(Row(line, known))
