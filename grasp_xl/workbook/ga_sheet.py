"""Sheet ``GA`` (figures 27 to 34): parameters, chromosome blocks, live cards."""

from __future__ import annotations

from dataclasses import dataclass, replace

from grasp_xl.grasp import Grasp, evaluate
from grasp_xl.search.result import Result
from grasp_xl.task import Task
from grasp_xl.workbook import layout
from grasp_xl.workbook.calc_block import CalcBlock
from grasp_xl.workbook.cards import GENE_STYLES, LiveCard, chromosome_cells, title_cells, user_cells
from grasp_xl.workbook.carrying import SetAside
from grasp_xl.workbook.guidance import guide_blocks, guide_card, guide_parameters
from grasp_xl.workbook.layout import GA, Area, Card, Layout
from grasp_xl.workbook.pen import ROW_HEIGHT, Pen
from grasp_xl.workbook.picker import DESIGN_PICK, Picker
from grasp_xl.workbook.proved import NO_PROOF, NOT_PROVED, Proved
from grasp_xl.workbook.run_log import PROOF_TITLE
from grasp_xl.workbook.styles import Style
from grasp_xl.workbook.written import CellValue

EDITED = "Edited since the search for the optimum"
"""Title of the exact search's card once genes or inputs are others than those of its proof."""

SEE_LOG = "; yours do not fit: see Run Log"
"""Addition to a title where genes of the designer were set aside."""

USER_CALC = 0
"""Place of the user-defined block's helper cells on ``Calc``; the cards' follow."""


@dataclass(frozen=True, slots=True)
class Shown:
    """What the sheet shows beside the result.

    Parameters
    ----------
    what_if : Grasp
        Grasp of the What-if card.
    typed_what_if : bool
        Whether the designer typed it; else its genes follow the picked design.
    set_aside : SetAside
        Genes of the designer that the option space does not have.
    proved : Proved or None
        What the exact search says; None where nobody asked it.
    picker : Picker
        Cell by which designs are picked.
    """

    what_if: Grasp
    typed_what_if: bool
    set_aside: SetAside
    proved: Proved | None
    picker: Picker = DESIGN_PICK


def write_ga(
    pen: Pen, plan: Layout, task: Task, result: Result, shown: Shown
) -> dict[str, LiveCard]:
    """Write the sheet as the last generation left it, and return its cards by name."""
    pen.write(0, 0, "GENETIC ALGORITHM", Style.TITLE)
    _parameters(pen, plan, task)
    _blocks(pen, plan, task, result, shown)
    cards = _cards(plan, task, result, shown)
    pen.sheet.set_row(plan.what_if.status.row, 2 * ROW_HEIGHT)  # its sentences may take two lines
    for name, live in cards.items():
        pen.put(live.cells())
        pen.name_area(name, live.card.genes)
        pen.name_area(f"{name}Fitness", live.card.fitness)
        pen.name_area(f"{name}Divergence", live.card.divergence)
        guide_card(pen, live.card)
    if layout.PROVED.name not in cards:
        _say_what_is_not_proved(pen, plan.proved, shown.proved)
    _look(pen, plan, len(cards))
    return cards


def _say_what_is_not_proved(pen: Pen, card: Card, proved: Proved | None) -> None:
    """Write in the place of the exact search's card why there is none."""
    pen.put(title_cells(card, proved.title if proved else NOT_PROVED))
    told = NO_PROOF
    if proved:
        told = (
            f"The exact search ended before it found a grasp: {proved.ended}.",
            f"None has a value below {proved.proof.bound:.6g}.",
        )
    for row, text in enumerate(told, 1):
        pen.write(card.row + row, card.column, text, Style.NOTE)


def _look(pen: Pen, plan: Layout, printed: int) -> None:
    """Set widths and pages: parameters and blocks, then two cards a page; less where wide."""
    pen.sheet.freeze_panes(1, 0)
    pen.widths(0, 32, 12, 2)
    cards = [plan.card(number) for number in range(plan.children + 2)]
    for card in cards:
        pen.widths(card.column, 19, *[9] * (card.columns - 1), 2)
    areas = [card.area for card in cards[:printed]]
    left = Area(GA, 0, 0, plan.card_row - 1, areas[0].column + areas[0].columns)
    right = Area(GA, 0, areas[1].column, left.rows, areas[1].columns)
    pen.print_pages(pictures=[*pen.abreast(left, right), *pen.abreast(*areas)])


def parameter_values(task: Task) -> dict[str, CellValue]:
    """Return the value of every parameter cell, by defined name."""
    need = task.rules.requirements
    return {
        "UserStart": int(task.settings.user_start),
        "Elitism": int(task.settings.elitism),
        "MutationOneIn": task.settings.one_in,
        "Generations": task.generations,
        "MinClearance": need.clearance_mm,
        "DensityRatio": need.density_ratio,
        "FitnessCriterion": task.rules.criterion.name,
        "FoSGoal": need.fos,
        **dict(zip(layout.GOAL_NAMES, task.rules.goals.base, strict=True)),
        "Children": task.settings.children,
        "Seed": task.settings.seed,
        "MomentArm": need.moment_arm,
    }


def _parameters(pen: Pen, plan: Layout, task: Task) -> None:
    pen.row(layout.PARAMETER_ROW, 0, layout.PARAMETER_HEADER, Style.HEADER)
    for field, value in zip(layout.PARAMETERS, parameter_values(task).values(), strict=True):
        cell = plan.parameter(field.name)
        pen.write(cell.row, 0, field.label, Style.LABEL)
        pen.name_area(field.name, cell)
        formula, style = None, Style.INPUT_TEXT if isinstance(value, str) else Style.INPUT
        if field.name in layout.GOAL_NAMES:
            number = layout.GOAL_NAMES.index(field.name)
            typed = task.parameters.goals[number] is not None
            formula = None if typed else plan.user_term(number).local
            style = Style.INPUT_MEASURE
        pen.write(cell.row, cell.column, value, style, formula)
    guide_parameters(pen, plan)


def _blocks(pen: Pen, plan: Layout, task: Task, result: Result, shown: Shown) -> None:
    state = result.state
    remark = f" {layout.ASSIGNED_MARK}" if task.assigned else ""
    if remark and shown.set_aside.user:
        remark += SEE_LOG
    blocks = (
        (layout.RANDOM_BLOCK, f" (seed {task.settings.seed})", state.random_chromosome),
        (layout.USER_BLOCK, remark, task.benchmark.chromosome),
        (layout.INITIAL_BLOCK, "", state.initial),
        (layout.PARENT_BLOCK, "", state.parent),
        (layout.MATRIX_BLOCK, "", None),
    )
    for block, addition, chromosome in blocks:
        title = plan.block(block)
        for column in range(plan.what_if.columns):
            text = None if column else f"{block.label}{addition}"
            pen.write(title.row, title.column + column, text, Style.HEADING)
        typed = block is layout.USER_BLOCK
        pen.put(chromosome_cells(title.cell(1, 0), chromosome, plan.gene_slots, typed=typed))
        pen.name_area(block.name, plan.block_genes(block))
    matrix = plan.block_genes(layout.MATRIX_BLOCK)
    for row, marks in enumerate(result.matrix.tolist()):
        pen.row(matrix.row + row, matrix.column, marks, GENE_STYLES[row])
    pen.put(user_cells(plan, task.benchmark, user_block(plan)))
    guide_blocks(pen, plan)


def user_block(plan: Layout) -> CalcBlock:
    """Return the helper cells of the user-defined chromosome."""
    return CalcBlock(USER_CALC, plan.gene_slots, plan.block_genes(layout.USER_BLOCK))


def _cards(plan: Layout, task: Task, result: Result, shown: Shown) -> dict[str, LiveCard]:
    def live(number: int, card: Card, title: str, grasp: Grasp) -> LiveCard:
        block = CalcBlock(USER_CALC + 1 + number, plan.gene_slots, card.genes)
        return LiveCard(card, block, title, task.space, task.rules, grasp)

    cards = {}
    for number, child in enumerate(result.children):
        elite = " (Elite)" if number == 0 and task.settings.elitism else ""
        grasp = evaluate(task.space, task.rules, child)
        title = f"Child {number + 1}{elite}"
        cards[f"Child{number + 1}"] = live(number, plan.card(number), title, grasp)
    aside = SEE_LOG if shown.set_aside.what_if and not shown.typed_what_if else ""
    what_if = live(len(cards), plan.what_if, f"{layout.WHAT_IF.label}{aside}", shown.what_if)
    what_if = replace(what_if, typed=True)
    if not shown.typed_what_if:
        what_if = replace(what_if, gene_formulas=shown.picker.picked_genes(plan.gene_slots))
    cards[layout.WHAT_IF.name] = what_if
    if shown.proved and shown.proved.grasp:
        proved = live(len(cards), plan.proved, shown.proved.title, shown.proved.grasp)
        cards[layout.PROVED.name] = replace(proved, title_formula=_proved_title(plan.proved))
    return cards


def _proved_title(card: Card) -> str:
    """Return the formula of a title that no longer claims a proof once anything was edited."""
    return f'IF({card.difference.local}="edited","{EDITED}",{PROOF_TITLE})'
