"""What guides a person who types: drop-downs, ranges, notes on labels, colours that warn."""

from __future__ import annotations

from typing import Any

from grasp_xl.rules import TERMS
from grasp_xl.space import OptionSpace
from grasp_xl.workbook import layout
from grasp_xl.workbook.calc_inputs import used
from grasp_xl.workbook.calc_rules import SLACK
from grasp_xl.workbook.layout import KINDS, Area, Card, Layout
from grasp_xl.workbook.pen import Pen
from grasp_xl.workbook.styles import Style

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
LEAST = {"MutationOneIn": (">=", 1, "of 1 or more"), "DensityRatio": (">=", 0, "of 0 or more")}
"""Bounds of numbers that need not just be above 0."""
CRITERIA = ("divergence", *TERMS)


def guide_parameters(pen: Pen, plan: Layout) -> None:
    """Put drop-downs, ranges and notes on the parameters."""
    for field in layout.PARAMETERS:
        cell = plan.parameter(field.name)
        note = NOTES[field.name] + (GOAL_HINT if field.name in layout.GOAL_NAMES else "")
        pen.note(cell.row, 0, note)
        options = _accepted(field.name) | {"input_title": field.label[:32], "input_message": note}
        pen.sheet.data_validation(cell.row, cell.column, cell.row, cell.column, options)


def _accepted(name: str) -> dict[str, Any]:
    """Return what a parameter cell accepts, and what is said of anything else."""
    if name in CHOICES:
        return {"validate": "list", "source": list(CHOICES[name])} | _told(
            f"Type {' or '.join(map(str, CHOICES[name]))}."
        )
    if name == "FitnessCriterion":  # sums of criteria may be typed, so nothing is refused here
        return {"validate": "list", "source": list(CRITERIA), "show_error": False}
    if name in WHOLE:
        least, most = WHOLE[name]
        told = _told(f"Type a whole number from {least:,} to {most:,}.")
        return _between("integer", least, most) | told
    criteria, bound, words = LEAST.get(name, (">", 0, "above 0"))
    return {"validate": "decimal", "criteria": criteria, "value": bound} | _told(
        f"Type a number {words}."
    )


def _told(message: str) -> dict[str, Any]:
    return {"error_message": message}


def _between(kind: str, least: float, most: float) -> dict[str, Any]:
    return {"validate": kind, "criteria": "between", "minimum": least, "maximum": most}


def guide_blocks(pen: Pen, plan: Layout, space: OptionSpace) -> None:
    """Put ranges on the genes of the user-defined chromosome, and colours on what it fails."""
    _guide_genes(pen, plan.block_genes(layout.USER_BLOCK), space)
    _colour_fos(pen, plan.user_fitness.cell(1, 0))
    _colour_status(pen, plan.user_status)


def _guide_genes(pen: Pen, genes: Area, space: OptionSpace) -> None:
    for number, (labels, kind) in enumerate(zip(KINDS, space.kinds, strict=True)):
        row = genes.row + number
        ranges = (
            (0, 0, kind.count_min, kind.most, f"count of {labels.plural}"),
            (1, genes.columns - 1, min(1, kind.total), kind.total, f"index of the {labels.plural}"),
        )
        for first, last, least, most, what in ranges:
            options = _between("integer", least, most) | {
                "error_title": f"No such {what}"[:32],
                "error_message": f"The {what} is a whole number from {least} to {most}.",
            }
            pen.sheet.data_validation(row, genes.column + first, row, genes.column + last, options)


def guide_card(pen: Pen, card: Card, space: OptionSpace) -> None:
    """Put ranges on a card's genes, and colours on what misses its goal."""
    _guide_genes(pen, card.genes, space)
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
