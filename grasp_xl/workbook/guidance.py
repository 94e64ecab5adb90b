"""What guides a person who types: drop-downs, ranges, notes on labels, colours that warn."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from grasp_xl.rules import TERMS
from grasp_xl.workbook import calc_rules, layout
from grasp_xl.workbook.calc_inputs import used
from grasp_xl.workbook.calc_rules import SLACK
from grasp_xl.workbook.cells import MAX_NUMBER, MIN_DISTANCE
from grasp_xl.workbook.layout import KINDS, Area, Card, Layout
from grasp_xl.workbook.pen import Pen
from grasp_xl.workbook.styles import Style

Accepted = dict[str, Any]
"""Options of a data validation."""

NOTES = {
    "UserStart": "1: the first parent is the user-defined chromosome. 0: a random one.",
    "Elitism": "1: child 1 stays an exact copy of the parent. 0: all children mutate.",
    "MutationOneIn": "n: each gene mutates with probability 1/n in a generation; 4 in the thesis.",
    "Generations": "A run stops after this many generations; 50,000 in the thesis.",
    "MinClearance": "Least plan-view distance between two elements (mm); the largest diameter.",
    "DensityRatio": "R of equation 7: linear density of the main truss over that of a branch.",
    "FitnessCriterion": "What a run minimises: divergence, one criterion, or some joined by +.",
    "FoSGoal": "Least factor of safety: lifting force over weight (equation 12).",
    "CostGoal": "Divisor of the cost in the divergence ($), equations 5 and 8.",
    "MomentGoal": "Divisor of the residual moment (N-mm), equations 2 to 4 and 8.",
    "DeviationGoal": "Divisor of the mean distance to the ideal polygon (mm), equations 6 and 8.",
    "StructureGoal": "Divisor of the size of the structure (mm), equations 7 and 8.",
    "Children": "Children bred in each generation; 5 in the thesis.",
    "Seed": "Seed of the random stream: the same seed gives the same run.",
    "MomentArm": "3d: arm of the moment in space, as in the thesis. plan: in plan view only.",
}
"""A sentence on every parameter, shown on its label and when its cell is chosen."""

GOAL_HINT = " A formula on the user-defined chromosome until a number is typed over it."
CHOICES = {"UserStart": (1, 0), "Elitism": (1, 0), "MomentArm": ("3d", "plan")}
WHOLE = {
    "Generations": (0, layout.MAX_GENERATIONS),
    "Children": (2, layout.MAX_CHILDREN),
    "Seed": (0, layout.MAX_SEED),
}
LEAST = {"MutationOneIn": 1.0, "DensityRatio": 0.0}
"""Least values of parameters that need not just be above 0."""
CRITERIA = ("divergence", *TERMS)


CARD_NOTES = {
    (1, 0): "F: lifting force of all active elements (N), equation 11.",
    (0, 2): "Price of all active elements ($), equation 5.",
    (2, 0): "W: mass of the part times 9.81 m/s² (N).",
    (3, 0): "Factor of safety F / W, without unit, equation 12; at least its goal.",
    (1, 4): "Mean plan-view distance of the elements to the ideal polygon (mm), equation 6.",
    (1, 5): "Size of the structure (mm), equation 7: R times the main truss, and all branches.",
    (9, 0): "Distance from the centre of force to the centroid (mm), equations 2 and 3.",
    (10, 0): "Offset times W (N-mm), equation 4.",
    (11, 5): "Sum of the four normalised values, without unit, equation 8.",
    (12, 0): "FoS goal over FoS, without unit; at most 1 where the goal is met.",
    (12, 1): "Cost over its goal, without unit, equation 9; at most 1 where the goal is met.",
    (12, 2): "Residual moment over its goal, without unit, equation 9.",
    (12, 3): "Deviation (DD Fitness) over its goal, without unit, equation 9.",
    (12, 4): "Structure over its goal, without unit, equation 9.",
    (
        14,
        5,
    ): "Left: goals of FoS, cost ($), moment (N-mm), deviation (mm) and structure (mm).",
    (20, 0): "Least plan-view distance of two elements (mm); at least the minimum distance.",
    (21, 0): "What a run minimises: the divergence, a criterion in its own unit, or a sum.",
    (22, 0): "Largest relative difference between these formulas and the program.",
}
"""Meaning, unit and equation of a card's labels, by row and column from its lifting force."""
USER_NOTES = (
    "Factor of safety, without unit, equation 12.",
    "Cost ($), equation 5.",
    "Residual moment (N-mm), equations 2 to 4.",
    "Deviation: mean distance to the ideal polygon (mm), equation 6.",
    "Size of the structure (mm), equation 7.",
    "Sum of cost, moment, deviation and structure over their goals, without unit, equation 8.",
)
"""The same of the labels under the user-defined chromosome."""


def guide_parameters(pen: Pen, plan: Layout) -> None:
    """Put drop-downs, ranges and notes on the parameters."""
    for field in layout.PARAMETERS:
        note = NOTES[field.name] + (GOAL_HINT if field.name in layout.GOAL_NAMES else "")
        guide_input(pen, plan.parameter(field.name), field.label, note, _accepted(field.name))


def guide_input(pen: Pen, cell: Area, label: str, note: str, accepted: Accepted) -> None:
    """Put a note on the label left of an input cell, and on the cell what it accepts."""
    pen.note(cell.row, cell.column - 1, note)
    accept(pen, cell, accepted | {"input_title": label[:32], "input_message": note})


def accept(pen: Pen, area: Area, accepted: Accepted) -> None:
    """Put on cells what they accept."""
    last_row, last_column = area.row + area.rows - 1, area.column + area.columns - 1
    pen.sheet.data_validation(area.row, area.column, last_row, last_column, accepted)


def _accepted(name: str) -> Accepted:
    """Return what a parameter cell accepts, and what is said of anything else."""
    rule = calc_rules.PARAMETER_RULES.get(name, calc_rules.ABOVE_0)
    if name in CHOICES:
        return {"validate": "list", "source": list(CHOICES[name]), **told(rule.words)}
    if name == "FitnessCriterion":  # sums of criteria may be typed, so nothing is refused here
        return {"validate": "list", "source": list(CRITERIA), "show_error": False}
    if name in WHOLE:
        return between("integer", *WHOLE[name], rule.words)
    return between("decimal", LEAST.get(name, MIN_DISTANCE), MAX_NUMBER, rule.words)


def told(words: str) -> Accepted:
    """Return what is said of anything else."""
    return {"error_message": f"Type {words}."}


def between(kind: str, least: float | str, most: float | str, words: str) -> Accepted:
    """Return a range, ``integer`` or ``decimal``; its ends may be formulas."""
    return {
        "validate": kind,
        "criteria": "between",
        "minimum": least,
        "maximum": most,
        **told(words),
    }


def guide_blocks(pen: Pen, plan: Layout) -> None:
    """Put ranges on the genes of the user-defined chromosome, and colours on what it fails."""
    _guide_genes(pen, plan.block_genes(layout.USER_BLOCK), plan.gene_slots)
    for column, note in enumerate(USER_NOTES):
        pen.note(plan.user_fitness.row, plan.user_fitness.column + column, note)
    _colour_fos(pen, plan.user_fitness.cell(1, 0))
    _colour_status(pen, plan.user_status)


def _guide_genes(pen: Pen, genes: Area, slots: int) -> None:
    for number, labels in enumerate(KINDS):
        least, most, total = (labels.field(suffix) for suffix in ("Min", "Max", "Total"))
        words = f"a whole number from # Min. to # Max. of the {labels.plural}, at most {slots}"
        accept(
            pen,
            genes.cell(number, 0),
            between("integer", f"={least}", f"=MIN({most},{total},{slots})", words),
        )
        indices = replace(genes.cell(number, 1), columns=slots)
        words = f"an index of the {labels.plural}: a whole number from 1 to their total"
        accept(pen, indices, between("integer", f"=MIN(1,{total})", f"={total}", words))


def guide_card(pen: Pen, card: Card) -> None:
    """Put ranges on a card's genes, notes on its labels, and colours on what misses its goal."""
    _guide_genes(pen, card.genes, card.gene_slots)
    for place, note in CARD_NOTES.items():
        label = card.at(card.summary_row, 0).cell(*place)
        pen.note(label.row, label.column, note)
    row = card.summary_row
    ratios = card.at(row + 13, 1, 1, 4)
    _colour(pen, ratios, f"AND(ISNUMBER({ratios.local}),{ratios.local}>1+{SLACK})", Style.ABOVE)
    _colour_fos(pen, card.at(row + 3, 1))
    shortest = card.at(row + 20, 5)
    least = f"{used('MinClearance')}*(1-{SLACK})"
    _colour(pen, shortest, f"AND(ISNUMBER({shortest.local}),{shortest.local}<{least})", Style.FAILS)
    _colour_status(pen, card.status)


def _colour_fos(pen: Pen, fos: Area) -> None:
    least = f"{used('FoSGoal')}*(1-{SLACK})"
    _colour(pen, fos, f"AND(ISNUMBER({fos.local}),{fos.local}<{least})", Style.FAILS)


def _colour_status(pen: Pen, status: Area) -> None:
    meets = f'LEFT({status.cell(0, 0).absolute},5)="Meets"'
    _colour(pen, status, f"NOT({meets})", Style.FAILS)
    _colour(pen, status, meets, Style.PASSES)


def _colour(pen: Pen, area: Area, formula: str, style: Style) -> None:
    last_row, last_column = area.row + area.rows - 1, area.column + area.columns - 1
    pen.sheet.conditional_format(
        area.row,
        area.column,
        last_row,
        last_column,
        {"type": "formula", "criteria": f"={formula}", "format": pen.formats.over(style)},
    )
