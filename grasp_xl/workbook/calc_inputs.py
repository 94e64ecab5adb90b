"""Inputs on the sheet ``Calc``: whether they are as written, and whether the cards can use them.

A row an input: its value as written, whether it changed, what it may be, whether it is that, what a
person calls it, and the value that counts: the default where the cell is blank.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from grasp_xl.rules import DEFAULT_CLEARANCE_MM
from grasp_xl.space import FloatArray, OptionSpace
from grasp_xl.task import DEFAULTS
from grasp_xl.workbook import calc_rules, layout
from grasp_xl.workbook.calc_rules import SLACK, Rule
from grasp_xl.workbook.layout import CALC, KINDS, Area, Layout
from grasp_xl.workbook.pen import Pen
from grasp_xl.workbook.styles import Style
from grasp_xl.workbook.written import CellValue

INPUT_COLUMN = 10
HEADER = ("input", "as written", "changed", "may be", "usable", "called", "counts")
COLUMNS = len(HEADER)
INPUTS_EDITED = "InputsEdited"
INPUTS_USABLE = "InputsUsable"
INPUTS_FAULT = "InputsFault"
GOALS_USABLE = "GoalsUsable"
GOALS_FAULT = "GoalsFault"
FIRST_ROW = 3
STEP = 0.618034
"""The golden section: its multiples modulo 1 differ for all cells of a list, neighbours too."""
DASH = "-"
NO_VALUE = "?"
"""What an error value counts as."""
NO_BENCHMARK = "no user-defined grasp to take it from; mend that chromosome, or type a goal."
_DIAMETERS = ",".join(labels.diameter.name for labels in KINDS)
DEFAULT_FORMULAS = {
    "MinClearance": f"IF(COUNT({_DIAMETERS})=0,{DEFAULT_CLEARANCE_MM:g},MAX({_DIAMETERS}))",
    "DensityRatio": f"{DEFAULTS.density_ratio:g}",
    "FoSGoal": f"{DEFAULTS.fos:g}",
}
"""What a blank parameter counts as; goals have the user-defined grasp's own value."""


def used(name: str) -> str:
    """Return the name of the value that counts for a parameter: its default where it is blank."""
    return f"{name}Used"


@dataclass(frozen=True, slots=True)
class Watched:
    """An input, or a list of them.

    Parameters
    ----------
    title : str
        Its name.
    now : str
        Formula of the value that is compared with the one as written.
    written : str, float or None
        That value.
    label : str
        What a person calls it.
    rule : Rule
    default : str
        Formula of the value that counts where the input is blank.
    """

    title: str
    now: str
    written: CellValue
    label: str
    rule: Rule
    default: str = ""


def write_inputs(pen: Pen, space: OptionSpace, inputs: dict[str, CellValue], plan: Layout) -> int:
    """Write the table of inputs and its verdicts, and return the number of inputs.

    Parameters
    ----------
    pen : Pen
    space : OptionSpace
    inputs : dict
        Values as written, by defined name.
    plan : Layout
    """
    needed = [*_fields(space, inputs), *_places(space), _polygon(space)]
    goals = _goals(inputs, plan)
    watched = [*needed, *goals]
    pen.write(1, INPUT_COLUMN, "Inputs", Style.HEADING)
    pen.row(FIRST_ROW - 1, INPUT_COLUMN, HEADER, Style.HEADER)
    for row, each in enumerate(watched, FIRST_ROW):
        _write_row(pen, row, each)
    flags = Area(CALC, FIRST_ROW, INPUT_COLUMN + 2, len(watched))
    verdicts: tuple[tuple[str, str, CellValue, str], ...] = (
        (INPUTS_EDITED, "inputs changed", 0, f"SUM({flags.absolute})"),
        (INPUTS_USABLE, "all are usable", 1, f"IF(SUM({_usable(needed)})={len(needed)},1,0)"),
        (INPUTS_FAULT, "first that is not", "", _fault(needed, INPUTS_USABLE)),
        (GOALS_USABLE, "goals are usable", 1, f"IF(SUM({_usable(watched)})={len(watched)},1,0)"),
        (GOALS_FAULT, "first that is not", "", _fault(watched, GOALS_USABLE)),
    )
    for row, (name, label, value, formula) in enumerate(verdicts, FIRST_ROW + len(watched) + 1):
        cell = Area(CALC, row, INPUT_COLUMN + 2)
        pen.write(row, INPUT_COLUMN, label, Style.LABEL)
        pen.write(row, cell.column, value, Style.TEXT if value == "" else Style.MARK, formula)
        pen.name_area(name, cell)
    return len(watched)


def _usable(watched: list[Watched]) -> str:
    return Area(CALC, FIRST_ROW, INPUT_COLUMN + 4, len(watched)).absolute


def _fault(watched: list[Watched], verdict: str) -> str:
    """Return the sentence that names the first input that cannot be used, and what to type."""
    wrong = f"MATCH(0,{_usable(watched)},0)"
    words, labels, counts = (
        f"INDEX({Area(CALC, FIRST_ROW, INPUT_COLUMN + offset, len(watched)).absolute},{wrong})"
        for offset in (3, 5, 6)
    )
    told = f'IF({counts}="{DASH}",": {NO_BENCHMARK}"," cannot be used: type "&{words}&".")'
    return f'IF({verdict}=1,"",{labels}&{told})'


def _write_row(pen: Pen, row: int, each: Watched) -> None:
    pen.write(row, INPUT_COLUMN, each.title, Style.LABEL)
    pen.write(row, INPUT_COLUMN + 1, each.written, Style.TEXT)
    written = Area(CALC, row, INPUT_COLUMN + 1).local
    differs = (
        f"IF(ISERROR({each.now}),1,IF(ISNUMBER({each.now}),IF(ISNUMBER({written}),"
        f"IF(ABS({each.now}-{written})>{SLACK}*ABS({written}),1,0),1),"
        f'IF({each.now}&""={written}&"",0,1)))'
    )
    pen.write(row, INPUT_COLUMN + 2, 0, Style.MARK, differs)
    pen.write(row, INPUT_COLUMN + 3, each.rule.words, Style.TEXT, each.rule.words_formula or None)
    counts = Area(CALC, row, INPUT_COLUMN + 6)
    tested = counts.local if each.default else each.title
    pen.write(row, INPUT_COLUMN + 4, 1, Style.MARK, each.rule.formula.format(x=tested))
    pen.write(row, INPUT_COLUMN + 5, each.label, Style.TEXT)
    if each.default:
        blank = calc_rules.blank(each.title)
        formula = f'IF(ISERROR({each.title}),"{NO_VALUE}",IF({blank},{each.default},{each.title}))'
        pen.write(row, counts.column, each.written, Style.TEXT, formula)
        pen.name_area(used(each.title), counts)


def _fields(space: OptionSpace, inputs: dict[str, CellValue]) -> list[Watched]:
    """Return the single inputs without which the program takes no file."""
    part = layout.PART
    rules = [(part.fields[0], part.heading, calc_rules.ABOVE_0)]
    rules += [(field, part.heading, calc_rules.ANY) for field in part.fields[1:]]
    for number, labels in enumerate(KINDS):
        fields = {field.name: field for field in labels.section.fields}
        kind_rules = {
            "Min": calc_rules.least_count(space, number),
            **calc_rules.KIND_RULES,
            "Total": calc_rules.total(space, number),
        }
        rules += [
            (fields[labels.field(suffix)], labels.section.heading, rule)
            for suffix, rule in kind_rules.items()
        ]
        rules.append((labels.diameter, layout.OPTION_SPACE, calc_rules.DIAMETER))
    rules.append((layout.SCALE_FACTOR, layout.OPTION_SPACE, calc_rules.FRACTION))
    parameters = [f for f in layout.PARAMETERS if f.name in calc_rules.PARAMETER_RULES]
    rules += [(field, layout.GA, calc_rules.PARAMETER_RULES[field.name]) for field in parameters]
    return [
        Watched(
            field.name,
            field.name,
            inputs[field.name],
            f"{heading}, {' '.join(field.label.rstrip(':').split())}",
            rule,
            DEFAULT_FORMULAS.get(field.name, ""),
        )
        for field, heading, rule in rules
    ]


def _polygon(space: OptionSpace) -> Watched:
    name, rule = layout.IDEAL_POLYGON, calc_rules.polygon(len(space.ideal_polygon_mm))
    return Watched(name, *_checksum(name, space.ideal_polygon_mm), "The polygon", rule)


def _goals(inputs: dict[str, CellValue], plan: Layout) -> list[Watched]:
    """Return the goals; that of a term that is left out is 0, as the user-defined grasp's value."""
    watched = []
    for number, name in enumerate(layout.GOAL_NAMES):
        own = plan.user_term(number).reference
        label = next(field.label for field in layout.PARAMETERS if field.name == name)
        rule = calc_rules.goal(own)
        watched.append(Watched(name, name, inputs[name], f"{layout.GA}, {label}", rule, own))
    return watched


def _places(space: OptionSpace) -> list[Watched]:
    return [
        Watched(
            labels.locations_name,
            *_checksum(labels.locations_name, kind.footprints_mm),
            f"{layout.OPTION_SPACE}, {labels.locations_label}",
            calc_rules.places(labels.locations_name),
        )
        for labels, kind in zip(KINDS, space.kinds, strict=True)
        if kind.total
    ]


def _checksum(name: str, points: FloatArray) -> tuple[str, float]:
    """Return formula and value of a number that changes when a coordinate does, or its place."""
    count = np.arange(points.size).reshape(points.shape)
    value = float((points**2).sum() + (points * np.mod(STEP * count, 1.0)).sum())
    row, column = f"(ROW({name})-MIN(ROW({name})))", f"(COLUMN({name})-MIN(COLUMN({name})))"
    weight = f"MOD({STEP}*({points.shape[1]}*{row}+{column}),1)"
    return f"(SUMSQ({name})+SUMPRODUCT({name},{weight}))", value
