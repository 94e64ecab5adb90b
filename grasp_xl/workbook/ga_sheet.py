"""Sheet ``GA`` (figures 27 to 34): parameters, chromosome blocks, child cards."""

from __future__ import annotations

from grasp_xl.chromosome import Chromosome
from grasp_xl.grasp import Grasp, evaluate
from grasp_xl.search.result import Result
from grasp_xl.task import Task
from grasp_xl.workbook import layout
from grasp_xl.workbook.cards import GENE_STYLES, card_cells, chromosome_cells, fitness_cells
from grasp_xl.workbook.layout import Card, Field, Layout
from grasp_xl.workbook.pen import CellValue, Pen
from grasp_xl.workbook.styles import Style


def write_ga(
    pen: Pen,
    plan: Layout,
    task: Task,
    result: Result,
    what_if: Grasp,
    stale_user: Chromosome | None,
) -> None:
    """Write the sheet as the last generation left it.

    ``stale_user`` are user-defined genes that the option space does not have: shown, not used.
    """
    pen.write(0, 0, "GENETIC ALGORITHM", Style.TITLE)
    _parameters(pen, plan, task)
    _blocks(pen, plan, task, result, stale_user)
    _cards(pen, plan, task, result, what_if)
    pen.sheet.freeze_panes(1, 0)
    pen.sheet.set_column(0, 0, 36)
    pen.sheet.set_column(1, 1, 12)
    pen.sheet.set_column(2, 2, 3)
    for number in range(plan.children + 1):
        column = plan.card(number).column
        pen.sheet.set_column(column, column, 23)
        pen.sheet.set_column(column + 1, column + plan.card_columns - 1, 11)
        pen.sheet.set_column(column + plan.card_columns, column + plan.card_columns, 3)


def _parameters(pen: Pen, plan: Layout, task: Task) -> None:
    known = task.parameters
    need = task.rules.requirements
    values: dict[str, CellValue] = {
        "UserStart": int(task.settings.user_start),
        "Elitism": int(task.settings.elitism),
        "MutationOneIn": task.settings.one_in,
        "Generations": task.generations,
        "MinClearance": need.clearance_mm,
        "DensityRatio": need.density_ratio,
        "FitnessCriterion": task.rules.criterion.name,
        "FoSGoal": need.fos,
        "Children": task.settings.children,
        "Seed": task.settings.seed,
        "MomentArm": need.moment_arm,
    }
    pen.row(layout.PARAMETER_ROW, 0, layout.PARAMETER_HEADER, Style.HEADER)
    user = plan.block_genes(layout.USER_BLOCK)
    for field in layout.PARAMETERS:
        cell = plan.parameter(field.name)
        pen.write(cell.row, 0, field.label, Style.LABEL)
        pen.name_area(field.name, cell)
        if field.name in layout.GOAL_NAMES:
            number = layout.GOAL_NAMES.index(field.name)
            source = user.cell(3, number)
            typed = known.goals[number] is not None
            formula = None if typed else source.local
            goal = task.rules.goals.base[number]
            pen.write(cell.row, cell.column, goal, Style.GOAL, formula)
        else:
            value = values[field.name]
            style = Style.INPUT_TEXT if isinstance(value, str) else Style.INPUT
            pen.write(cell.row, cell.column, value, style)


def _blocks(
    pen: Pen, plan: Layout, task: Task, result: Result, stale_user: Chromosome | None
) -> None:
    state = result.state
    remark = f" {layout.ASSIGNED_MARK}" if task.assigned else ""
    if stale_user:
        remark = " (stale: choose other indices)"
    shown = stale_user or task.benchmark.chromosome
    blocks: tuple[tuple[Field, str, Chromosome], ...] = (
        (layout.RANDOM_BLOCK, f" (seed {task.settings.seed})", state.random_chromosome),
        (layout.USER_BLOCK, remark, shown),
        (layout.INITIAL_BLOCK, "", state.initial),
        (layout.PARENT_BLOCK, "", state.parent),
        (layout.MATRIX_BLOCK, "", Chromosome(result.matrix)),
    )
    for block, addition, chromosome in blocks:
        title = plan.block(block)
        pen.write(title.row, title.column, f"{block.label}{addition}", Style.HEADING)
        header = title.cell(1, 0)
        pen.put(chromosome_cells(header, chromosome, plan.gene_slots))
        pen.name_area(block.name, plan.block_genes(block))
    _matrix_zeros(pen, plan, result)
    judged = None if stale_user else task.benchmark
    pen.put(fitness_cells(plan.block(layout.USER_BLOCK).cell(4, 0), judged))


def _matrix_zeros(pen: Pen, plan: Layout, result: Result) -> None:
    """Write zeros as zeros: in a matrix they are no blank genes."""
    area = plan.block_genes(layout.MATRIX_BLOCK)
    for row, marks in enumerate(result.matrix.tolist()):
        pen.row(area.row + row, area.column, marks, GENE_STYLES[row])


def _cards(pen: Pen, plan: Layout, task: Task, result: Result, what_if: Grasp) -> None:
    for number, child in enumerate(result.children):
        elite = " (Elite)" if number == 0 and task.settings.elitism else ""
        name = f"Child{number + 1}"
        grasp = evaluate(task.space, task.rules, child)
        _card(pen, plan.card(number), name, f"Child {number + 1}{elite}", task, grasp)
    _card(pen, plan.what_if, layout.WHAT_IF.name, layout.WHAT_IF.label, task, what_if)


def _card(pen: Pen, card: Card, name: str, title: str, task: Task, grasp: Grasp) -> None:
    pen.put(card_cells(card, title, task.space, task.rules, grasp))
    pen.name_area(name, card.genes)
    pen.name_area(f"{name}Fitness", card.fitness)
    pen.name_area(f"{name}Divergence", card.divergence)
