"""The catalogue of gripper elements: those that are shipped, and a user's own."""

from __future__ import annotations

from dataclasses import dataclass
from difflib import SequenceMatcher
from heapq import nlargest
from pathlib import Path

from grasp_xl.errors import Problem, UsageError, refuse
from grasp_xl.fitment.csv_table import CsvTable, read_table
from grasp_xl.fitment.element import COLUMNS, REQUIRED, SIZES, Element, Kind, element_of
from grasp_xl.printable import printable, quoted

SHIPPED = Path(__file__).with_name("elements.csv")

DIAMETER_TOLERANCE_MM = 0.5
"""How far a diameter may be from one that is asked for."""

ROUND_OFF_MM = 1e-9

CLOSEST = 3
"""Elements that are named where none has the name that is asked for."""


@dataclass(frozen=True, slots=True)
class Catalogue:
    """Elements to choose from; no two of them have the same model.

    Parameters
    ----------
    elements : tuple of Element
    replaced : tuple of str
        Models of shipped elements in whose place one of the user's stands.
    warnings : tuple of Problem
    """

    elements: tuple[Element, ...]
    replaced: tuple[str, ...] = ()
    warnings: tuple[Problem, ...] = ()


@dataclass(frozen=True, slots=True)
class Diameters:
    """A range of diameters (mm), its ends included."""

    least_mm: float
    most_mm: float

    def hold(self, diameter_mm: float) -> bool:
        """Tell whether a diameter lies in the range; a round-off does not matter."""
        return self.least_mm - ROUND_OFF_MM <= diameter_mm <= self.most_mm + ROUND_OFF_MM


@dataclass(frozen=True, slots=True)
class Wanted:
    """What elements must have; None asks for nothing.

    Parameters
    ----------
    kind : {"suction", "magnets"} or None
    min_force_n : float or None
    diameters : Diameters or None
        Elements without a diameter have none of them.
    """

    kind: Kind | None = None
    min_force_n: float | None = None
    diameters: Diameters | None = None

    def fits(self, element: Element) -> bool:
        """Tell whether an element has all that is asked for."""
        if self.kind not in (None, element.kind):
            return False
        if self.min_force_n is not None and element.force_n < self.min_force_n:
            return False
        if self.diameters is None:
            return True
        return element.diameter_mm is not None and self.diameters.hold(element.diameter_mm)


def read_catalogue(own: Path | None = None) -> Catalogue:
    """Read the shipped elements, and those of a user's file.

    Raises
    ------
    InputError
        With every problem found in the file.
    """
    shipped, _ = _read_elements(SHIPPED)
    if own is None:
        return Catalogue(tuple(shipped.values()))
    added, table = _read_elements(own)
    replaced = [model for model in added if model in shipped]
    warnings = [
        Problem(
            table.where(line, "model"),
            f"{quoted(added[model].model)}, a model of the shipped catalogue",
            "a model that it does not have",
            "the element of this file replaces the shipped one",
        )
        for model, line in _lines(table).items()
        if model in shipped
    ]
    kept = [element for model, element in shipped.items() if model not in added]
    return Catalogue(
        (*kept, *added.values()),
        tuple(shipped[model].model for model in replaced),
        (*table.warnings, *warnings),
    )


def find(catalogue: Catalogue, name: str, kind: Kind | None = None) -> Element:
    """Find an element by its model or part number; case and spaces do not matter.

    One of another kind than the wanted one is found, too, where only that has the name.

    Raises
    ------
    UsageError
        If there is none, naming the closest; or if there are several, naming them.
    """
    for fold in (_folded, _without_spaces):
        wanted = fold(name)
        for names in (
            [fold(element.model) for element in catalogue.elements],
            [fold(element.part_no or "") for element in catalogue.elements],
        ):
            found = [
                element
                for element, own in zip(catalogue.elements, names, strict=True)
                if own and own == wanted
            ]
            found = [element for element in found if element.kind == kind] or found
            if len(found) == 1:
                return found[0]
            if found:
                raise UsageError(
                    f"{quoted(name)} is the name of several elements: {_told(found)}.",
                    hint="Give the model of one of them",
                )
    of_kind = [element for element in catalogue.elements if kind in (None, element.kind)]
    closest = nlargest(CLOSEST, of_kind, key=lambda one: _closeness(one, name))
    raise UsageError(
        f"No element of the catalogue is named {quoted(name)}; the closest are {_told(closest)}.",
        hint="Give a model or part number that grasp-xl elements lists",
    )


def _read_elements(path: Path) -> tuple[dict[str, Element], CsvTable]:
    """Return the elements of a file by their folded model."""
    table = read_table(path, COLUMNS, REQUIRED)
    if table.columns and not SIZES & table.columns:
        hint = "add the columns that the elements need"
        found, expected = "no column of a size", "diameter_mm, or length_mm and width_mm"
        table.problems.append(Problem(table.name, found, expected, hint))
    elements: dict[str, Element] = {}
    lines = _lines(table)
    for row in table.rows:
        element = element_of(row, table)
        model = _folded(row.cells.get("model", ""))
        if model and lines[model] != row.line:
            found = f"{quoted(row.cells['model'])}, as on line {lines[model]}"
            hint = "take one of the two rows away, or rename it"
            table.complain(row.line, "model", found, "a model once", hint)
        elif element:
            elements[model] = element
    refuse(table.problems, table.name)
    return elements, table


def _lines(table: CsvTable) -> dict[str, int]:
    """Return the first line of each folded model."""
    lines: dict[str, int] = {}
    for row in table.rows:
        lines.setdefault(_folded(row.cells.get("model", "")), row.line)
    return lines


def _folded(text: str) -> str:
    return " ".join(text.split()).casefold()


def _without_spaces(text: str) -> str:
    return "".join(text.split()).casefold()


def _closeness(element: Element, name: str) -> tuple[bool, float]:
    """Rate an element: whether a name of it holds what is asked for, and how alike they are."""
    wanted = _folded(name)
    names = [_folded(own) for own in (element.model, element.part_no) if own]
    alike = max(SequenceMatcher(None, own, wanted).ratio() for own in names)
    return any(wanted in own for own in names), alike


def _told(elements: list[Element]) -> str:
    return ", ".join(
        f"{quoted(element.model)}" + (f" ({printable(element.part_no)})" if element.part_no else "")
        for element in elements
    )
