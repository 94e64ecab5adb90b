"""Inputs on the sheet ``Calc``: whether they are as written, and whether the cards can use them.

A row an input: its value as written, whether it changed, what it may be, and whether it is that.
The reader demands the same; here it is said again as formulas, since a designer types without it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from grasp_xl.rules import DIVERGENCE, TERMS
from grasp_xl.space import FloatArray, OptionSpace
from grasp_xl.workbook import layout
from grasp_xl.workbook.layout import CALC, KINDS, Area, Field, Layout
from grasp_xl.workbook.pen import CellValue, Pen
from grasp_xl.workbook.styles import Style

INPUT_COLUMN = 9
HEADER = ("input", "as written", "changed", "may be", "usable", "called")
COLUMNS = len(HEADER)
INPUTS_EDITED = "InputsEdited"
INPUTS_USABLE = "InputsUsable"
INPUTS_FAULT = "InputsFault"
GOALS_USABLE = "GoalsUsable"
SLACK = "1E-9"
"""Relative slack of a comparison, and the least number that counts as above 0."""
FIRST_ROW = 3
STEP = 0.618034
"""The golden section: its multiples modulo 1 differ for all cells of a list, neighbours too."""


@dataclass(frozen=True, slots=True)
class Rule:
    """What an input may be: in words, and as a formula on ``{x}`` that gives 1 or 0."""

    words: str
    formula: str


def _number(words: str, test: str) -> Rule:
    return Rule(words, f"IF(ISNUMBER({{x}}),IF({test},1,0),0)")


def _criterion_test() -> str:
    """Test for a text that is nothing but known terms, each once and behind a +."""
    words = 'SUBSTITUTE(SUBSTITUTE("+"&TRIM(LOWER({x}))," +","+"),"+ ","+")'
    for term in TERMS:
        words = f'SUBSTITUTE({words},"+{term}"," ",1)'
    return f'TRIM({words})=""'


ANY = _number("a number", "TRUE")
ABOVE_0 = _number("a number above 0", f"{{x}}>={SLACK}")
FROM_0 = _number("a number of 0 or more", "{x}>=0")
WHOLE = _number("a whole number of 0 or more", "AND({x}>=0,{x}=INT({x}))")
FRACTION = _number("a number above 0, at most 1", f"AND({{x}}>={SLACK},{{x}}<=1)")
WEIGHT = Rule("a number of 0 or more, or blank", f'IF({{x}}&""="",1,{FROM_0.formula})')
ARM = Rule("3d or plan", 'IF(OR(TRIM({x})="",TRIM({x})="3d",TRIM({x})="plan"),1,0)')
CRITERION = Rule(
    f"{DIVERGENCE}, one criterion, or some joined by +",
    f'IF(OR(TRIM({{x}})="",LOWER(TRIM({{x}}))="{DIVERGENCE}",{_criterion_test()}),1,0)',
)
POLYGON = Rule(
    "numbers, and no corner twice in a row",
    "IF(COUNT({x})=3*ROWS({x}),IF(MIN(EdgeSquared)>0,1,0),0)",
)
KIND_RULES = {"Min": WHOLE, "Max": WHOLE, "Force": ABOVE_0, "Price": FROM_0, "Weight": WEIGHT}
PARAMETER_RULES = {
    "MinClearance": ABOVE_0,
    "DensityRatio": FROM_0,
    "FitnessCriterion": CRITERION,
    "FoSGoal": ABOVE_0,
    "MomentArm": ARM,
}


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
    rule : Rule or None
        None where the cards look themselves, as at the places of their elements.
    """

    title: str
    now: str
    written: CellValue
    label: str = ""
    rule: Rule | None = None


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
    needed = [*_fields(inputs), _polygon(space)]
    goals = _goals(inputs, plan)
    watched = [*needed, *goals, *_places(space)]
    pen.write(1, INPUT_COLUMN, "Inputs", Style.HEADING)
    pen.row(FIRST_ROW - 1, INPUT_COLUMN, HEADER, Style.HEADER)
    for row, each in enumerate(watched, FIRST_ROW):
        _write_row(pen, row, each)
    flags = Area(CALC, FIRST_ROW, INPUT_COLUMN + 2, len(watched))
    usable = Area(CALC, FIRST_ROW, INPUT_COLUMN + 4, len(needed))
    goals_usable = Area(CALC, FIRST_ROW + len(needed), INPUT_COLUMN + 4, len(goals))
    wrong = f"MATCH(0,{usable.absolute},0)"
    words = Area(CALC, FIRST_ROW, INPUT_COLUMN + 3, len(needed)).absolute
    labels = Area(CALC, FIRST_ROW, INPUT_COLUMN + 5, len(needed)).absolute
    fault = f'INDEX({labels},{wrong})&" cannot be used: type "&INDEX({words},{wrong})&"."'
    verdicts: tuple[tuple[str, str, CellValue, str], ...] = (
        (INPUTS_EDITED, "inputs changed", 0, f"SUM({flags.absolute})"),
        (INPUTS_USABLE, "all are usable", 1, f"IF(SUM({usable.absolute})={len(needed)},1,0)"),
        (GOALS_USABLE, "goals are usable", 1, f"IF(SUM({goals_usable.absolute})={len(goals)},1,0)"),
        (INPUTS_FAULT, "first that is not", "", f'IF({INPUTS_USABLE}=1,"",{fault})'),
    )
    for row, (name, label, value, formula) in enumerate(verdicts, FIRST_ROW + len(watched) + 1):
        cell = Area(CALC, row, INPUT_COLUMN + 2)
        pen.write(row, INPUT_COLUMN, label, Style.LABEL)
        pen.write(row, cell.column, value, Style.TEXT if value == "" else Style.MARK, formula)
        pen.name_area(name, cell)
    return len(watched)


def _write_row(pen: Pen, row: int, each: Watched) -> None:
    pen.write(row, INPUT_COLUMN, each.title, Style.LABEL)
    pen.write(row, INPUT_COLUMN + 1, each.written, Style.TEXT)
    written = Area(CALC, row, INPUT_COLUMN + 1).local
    differs = (
        f"IF(ISNUMBER({each.now}),IF(ISNUMBER({written}),"
        f"IF(ABS({each.now}-{written})>{SLACK}*ABS({written}),1,0),1),"
        f'IF({each.now}&""={written}&"",0,1))'
    )
    pen.write(row, INPUT_COLUMN + 2, 0, Style.MARK, differs)
    if each.rule:
        pen.write(row, INPUT_COLUMN + 3, each.rule.words, Style.TEXT)
        pen.write(row, INPUT_COLUMN + 4, 1, Style.MARK, each.rule.formula.format(x=each.title))
        pen.write(row, INPUT_COLUMN + 5, each.label, Style.TEXT)


def _fields(inputs: dict[str, CellValue]) -> list[Watched]:
    """Return the single inputs without which no card has a meaning."""
    part, parameters = layout.PART, {field.name: field for field in layout.PARAMETERS}
    rules = [(part.fields[0], part.heading, ABOVE_0)]
    rules += [(field, part.heading, ANY) for field in part.fields[1:]]
    for labels in KINDS:
        fields = {field.name: field for field in labels.section.fields}
        rules += [
            (fields[labels.field(suffix)], labels.section.heading, rule)
            for suffix, rule in KIND_RULES.items()
        ]
    rules.append((layout.SCALE_FACTOR, layout.OPTION_SPACE, FRACTION))
    rules += [(parameters[name], layout.GA, rule) for name, rule in PARAMETER_RULES.items()]
    return [_field(inputs, *rule) for rule in rules]


def _field(inputs: dict[str, CellValue], field: Field, heading: str, rule: Rule) -> Watched:
    label = f"{heading}, {field.label.rstrip(':')}"
    return Watched(field.name, field.name, inputs[field.name], label, rule)


def _polygon(space: OptionSpace) -> Watched:
    name = layout.IDEAL_POLYGON
    return Watched(name, *_checksum(name, space.ideal_polygon_mm), "The polygon", POLYGON)


def _goals(inputs: dict[str, CellValue], plan: Layout) -> list[Watched]:
    """Return the goals; that of a term that is left out is 0, as the user-defined grasp's value."""
    watched = []
    for number, name in enumerate(layout.GOAL_NAMES):
        own = plan.user_term(number).reference
        rule = _number(ABOVE_0.words, f"OR({{x}}>={SLACK},{{x}}={own})")
        watched.append(Watched(name, name, inputs[name], "", rule))
    return watched


def _places(space: OptionSpace) -> list[Watched]:
    return [
        Watched(labels.locations_name, *_checksum(labels.locations_name, kind.footprints_mm))
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
