"""The child card (figure 33) and the chromosome blocks (figure 28), as cells."""

from __future__ import annotations

from collections.abc import Iterator

from grasp_xl.chromosome import BLANK_GENE, Chromosome
from grasp_xl.grasp import Grasp
from grasp_xl.rules import Rules
from grasp_xl.space import OptionSpace
from grasp_xl.stability import support
from grasp_xl.workbook.layout import (
    DIVERGENCE_LABEL,
    FITNESS_HEADER,
    KINDS,
    Area,
    Card,
)
from grasp_xl.workbook.pen import Cell
from grasp_xl.workbook.styles import Style

GENE_STYLES = (Style.SUCTION_GENE, Style.MAGNETS_GENE)
MOMENT_HEADER = ("i", "xi", "yi", "zi", "Fi.xi", "Fi.yi", "Fi.zi")
MOMENT_UNITS = (None, "(mm)", "(mm)", "(mm)", "(N-mm)", "(N-mm)", "(N-mm)")
AXES = ("x", "y", "z")
SWING_WARNING = "Fewer than three points out of line hold the part: it can swing."
STATIC_NOTE = "FoS is static and for the whole grasp."


def chromosome_cells(first: Area, chromosome: Chromosome | None, slots: int) -> Iterator[Cell]:
    """Yield a chromosome block without its title: header row and two gene rows."""
    yield Cell(first.row, first.column, None, Style.HEADER)
    for column, label in enumerate(("Total #", *(f"Index {k}" for k in range(1, slots + 1))), 1):
        yield Cell(first.row, first.column + column, label, Style.HEADER)
    for number, labels in enumerate(KINDS):
        row = first.row + 1 + number
        yield Cell(row, first.column, labels.row_label, GENE_STYLES[number])
        genes = chromosome.rows()[number] if chromosome else [None] * (1 + slots)
        for column, gene in enumerate(genes, 1):
            yield Cell(row, first.column + column, gene, GENE_STYLES[number])


def card_cells(
    card: Card, title: str, space: OptionSpace, rules: Rules, grasp: Grasp
) -> Iterator[Cell]:
    """Yield all cells of one card, top to bottom."""
    yield from _line(card, 0, [(0, title, Style.CARD_TITLE)])
    yield from chromosome_cells(card.at(1, 0), grasp.chromosome, card.gene_slots)
    for number in range(len(KINDS)):
        yield from _moment_table(card, space, grasp, number)
    yield from _force_cells(card, grasp)
    yield from _centre_cells(card, space, grasp)
    yield from _fitness_cells(card, rules, grasp)
    yield from _note_cells(card, space, grasp)


def fitness_cells(first: Area, grasp: Grasp | None) -> Iterator[Cell]:
    """Yield the criteria in their own units under the user-defined chromosome (figure 28)."""
    labels = (*FITNESS_HEADER, DIVERGENCE_LABEL)
    values = (None,) * 6 if grasp is None else (grasp.fos, *grasp.terms, grasp.divergence)
    for column, (label, value) in enumerate(zip(labels, values, strict=True)):
        yield Cell(first.row, first.column + column, label, Style.HEADER)
        yield Cell(first.row + 1, first.column + column, value, Style.RESULT)


def _line(
    card: Card, row: int, items: list[tuple[int, str | float | None, Style]]
) -> Iterator[Cell]:
    for column, value, style in items:
        yield Cell(card.row + row, card.column + column, value, style)


def _moment_table(card: Card, space: OptionSpace, grasp: Grasp, number: int) -> Iterator[Cell]:
    kind, labels = space.kinds[number], KINDS[number]
    row = card.table_row(number)
    yield from _line(card, row, [(0, f"Moment of forces from the {labels.plural}", Style.HEADING)])
    yield from _line(
        card, row + 1, [(column, label, Style.HEADER) for column, label in enumerate(MOMENT_HEADER)]
    )
    for slot, gene in enumerate(grasp.chromosome.genes[number, 1:].tolist(), 1):
        values: list[float | None] = [None] * 6
        if gene != BLANK_GENE:
            point = kind.footprints_mm[gene - 1].tolist()
            values = [*point, *(kind.force_n * coordinate for coordinate in point)]
        yield from _line(
            card,
            row + 1 + slot,
            [
                (0, slot, Style.MARK),
                *((1 + axis, values[axis], Style.COORDINATE) for axis in range(3)),
                *((4 + axis, values[3 + axis], Style.TORQUE) for axis in range(3)),
            ],
        )
    units = [(column, unit, Style.UNIT) for column, unit in enumerate(MOMENT_UNITS)]
    yield from _line(card, row + 2 + card.gene_slots, list(units))


def _force_cells(card: Card, grasp: Grasp) -> Iterator[Cell]:
    row = card.summary_row
    yield from _line(card, row, [(1, "Lifting force", Style.HEADER), (2, "Cost ($)", Style.HEADER)])
    yield from _line(
        card,
        row + 1,
        [
            (0, "Force from grippers (N)", Style.LABEL),
            (1, grasp.force_n, Style.FORCE),
            (2, grasp.terms.cost, Style.MONEY),
            (4, "DD Fitness", Style.STACKED_HEADER),
            (5, "Structure Fitness", Style.STACKED_HEADER),
        ],
    )
    yield from _line(
        card, row + 2, [(0, "Part weight (N)", Style.LABEL), (1, grasp.weight_n, Style.FORCE)]
    )
    yield from _line(card, row + 3, [(0, "FoS", Style.LABEL), (1, grasp.fos, Style.RESULT)])
    yield from _line(
        card,
        row + 4,
        [(4, grasp.terms.deviation, Style.RESULT), (5, grasp.terms.structure, Style.RESULT)],
    )


def _centre_cells(card: Card, space: OptionSpace, grasp: Grasp) -> Iterator[Cell]:
    row = card.summary_row + 5
    yield from _line(card, row, [(0, "Center of forces from grippers", Style.HEADING)])
    for axis, name in enumerate(AXES):
        yield from _line(
            card,
            row + 1 + axis,
            [
                (0, f"{name}_c", Style.LABEL),
                (1, float(space.part.centroid_mm[axis]), Style.COORDINATE),
                (2, f"{name}_bar", Style.LABEL),
                (3, float(grasp.centre_of_force_mm[axis]), Style.COORDINATE),
                (4, f"delta_{name}", Style.LABEL),
                (5, float(grasp.offset_mm[axis]), Style.COORDINATE),
                (6, "(mm)", Style.UNIT),
            ],
        )
    yield from _line(
        card,
        row + 4,
        [
            (0, "Center of force offset", Style.LABEL),
            (5, grasp.eccentricity_mm, Style.RESULT),
            (6, "(mm)", Style.UNIT),
        ],
    )
    yield from _line(
        card,
        row + 5,
        [
            (0, "Unbalanced moment from weight", Style.LABEL),
            (5, grasp.terms.moment, Style.RESULT),
            (6, "(N-mm)", Style.UNIT),
        ],
    )


def _fitness_cells(card: Card, rules: Rules, grasp: Grasp) -> Iterator[Cell]:
    row = card.summary_row + 11
    yield from _line(
        card,
        row,
        [(0, "Normalized Fitness Values", Style.HEADING), (5, DIVERGENCE_LABEL, Style.HEADER)],
    )
    normalised = (grasp.normalised_fos, *("-" if n is None else n for n in grasp.normalised))
    goals = (rules.requirements.fos, *rules.goals.base)
    for column, label in enumerate(FITNESS_HEADER):
        yield from _line(card, row + 1, [(column, label, Style.HEADER)])
        yield from _line(card, row + 2, [(column, normalised[column], Style.RATIO)])
        yield from _line(card, row + 3, [(column, goals[column], Style.RESULT)])
    yield from _line(card, row + 2, [(5, grasp.divergence, Style.DIVERGENCE)])
    yield from _line(card, row + 3, [(5, "<-- Fitness Goals", Style.NOTE)])


def _note_cells(card: Card, space: OptionSpace, grasp: Grasp) -> Iterator[Cell]:
    row = card.summary_row + 16
    held = support(space, grasp)
    weight = "not known" if held.element_weight_g is None else held.element_weight_g
    inside = "yes" if held.centroid_inside else "no"
    yield from _line(
        card, row, [(0, "Total element weight (g)", Style.NOTE), (5, weight, Style.TORQUE)]
    )
    yield from _line(
        card,
        row + 1,
        [
            (0, "Plan area of the elements' convex hull (mm²)", Style.NOTE),
            (5, held.hull_area_mm2, Style.TORQUE),
        ],
    )
    yield from _line(
        card, row + 2, [(0, "Centroid inside that hull", Style.NOTE), (5, inside, Style.CENTRED)]
    )
    warning = f"{SWING_WARNING} " if held.can_swing else ""
    style = Style.WARNING if held.can_swing else Style.NOTE
    yield from _line(card, row + 3, [(0, f"{warning}{STATIC_NOTE}", style)])
