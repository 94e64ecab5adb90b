"""The child card (figure 33) and the chromosome blocks (figure 28), as live cells.

Every number is a formula over the gene cells, the option space and the parameters, and carries the
engine's value.  What takes more than one step is worked out on the sheet ``Calc``.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from grasp_xl.chromosome import BLANK_GENE, Chromosome
from grasp_xl.grasp import Grasp
from grasp_xl.rules import TERMS, Rules
from grasp_xl.space import OptionSpace
from grasp_xl.stability import support
from grasp_xl.workbook.calc_block import CalcBlock
from grasp_xl.workbook.calc_inputs import (
    DASH,
    GOALS_FAULT,
    GOALS_USABLE,
    INPUTS_EDITED,
    INPUTS_USABLE,
    used,
)
from grasp_xl.workbook.calc_rules import SLACK
from grasp_xl.workbook.layout import (
    DIVERGENCE_LABEL,
    FITNESS_HEADER,
    GOAL_NAMES,
    KINDS,
    Area,
    Card,
    Layout,
)
from grasp_xl.workbook.pen import Cell
from grasp_xl.workbook.styles import Style
from grasp_xl.workbook.written import CellValue

GENE_STYLES = (Style.SUCTION_GENE, Style.MAGNETS_GENE)
TYPED_GENE_STYLES = (Style.TYPED_SUCTION_GENE, Style.TYPED_MAGNETS_GENE)
MOMENT_HEADER = ("i", "xi", "yi", "zi", "Fi.xi", "Fi.yi", "Fi.zi")
MOMENT_UNITS = (None, "(mm)", "(mm)", "(mm)", "(N-mm)", "(N-mm)", "(N-mm)")
AXES = ("x", "y", "z")
GOALS = ("FoSGoal", *GOAL_NAMES)
WEAK = "FoS is below its goal. "
CLOSE = "Two elements are closer than the minimum distance. "
MEETS_ALL = "Meets FoS, distance and every goal."
MEETS_SOME = "Meets FoS and distance, not every goal."
SWING_WARNING = "Fewer than three points out of line hold the part: it can swing. "
STATIC_NOTE = "FoS is static and for the whole grasp."


def chromosome_cells(
    first: Area,
    chromosome: Chromosome | None,
    slots: int,
    formulas: Sequence[Sequence[str]] | None = None,
    *,
    typed: bool = False,
) -> Iterator[Cell]:
    """Yield a chromosome block without its title: header row and two gene rows.

    ``typed`` says whether a designer may type genes there.
    """
    yield Cell(first.row, first.column, None, Style.HEADER)
    for column, label in enumerate(("Total #", *(f"Index {k}" for k in range(1, slots + 1))), 1):
        yield Cell(first.row, first.column + column, label, Style.HEADER)
    for number, labels in enumerate(KINDS):
        row = first.row + 1 + number
        yield Cell(row, first.column, labels.row_label, GENE_STYLES[number])
        genes = chromosome.rows()[number] if chromosome else [None] * (1 + slots)
        for column, gene in enumerate(genes, 1):
            formula = formulas[number][column - 1] if formulas and gene is not None else None
            style = (TYPED_GENE_STYLES if typed else GENE_STYLES)[number]
            yield Cell(row, first.column + column, gene, style, formula)


def title_cells(card: Card, title: str, formula: str | None = None) -> Iterator[Cell]:
    """Yield the title of a card, in a band as wide as the card."""
    for column in range(card.columns):
        here = card.at(0, column)
        first = column == 0
        yield Cell(
            here.row,
            here.column,
            title if first else None,
            Style.CARD_TITLE,
            formula if first else None,
        )


@dataclass(frozen=True, slots=True)
class LiveCard:
    """One card: where it stands, where its helper cells stand, and what the engine says.

    Parameters
    ----------
    card : Card
    block : CalcBlock
    title : str
    space, rules, grasp
        The engine's numbers, stored with the formulas.
    gene_formulas : sequence of sequence of str, optional
        Formulas of the gene cells, where they are not plain numbers.
    typed : bool
        Whether a designer may type genes there.
    title_formula : str, optional
        Formula of the title, where it depends on other cells.
    """

    card: Card
    block: CalcBlock
    title: str
    space: OptionSpace
    rules: Rules
    grasp: Grasp
    gene_formulas: Sequence[Sequence[str]] | None = None
    typed: bool = False
    title_formula: str | None = None

    def cells(self) -> Iterator[Cell]:
        """Yield all cells, top to bottom."""
        slots = self.card.gene_slots
        yield from title_cells(self.card, self.title, self.title_formula)
        genes = self.card.at(1, 0)
        yield from chromosome_cells(
            genes, self.grasp.chromosome, slots, self.gene_formulas, typed=self.typed
        )
        for number in range(len(KINDS)):
            yield from self._moment_table(number)
        yield from self._force_cells()
        yield from self._centre_cells()
        yield from self._fitness_cells()
        yield from self._note_cells()
        yield from self._own_cells()

    # --- words for formulas ---

    def _cell(
        self, row: int, column: int, value: CellValue, style: Style, formula: str | None = None
    ) -> Cell:
        return Cell(self.card.row + row, self.card.column + column, value, style, formula)

    def _ref(self, row: int, column: int) -> str:
        return self.card.at(row, column).local

    def _sum(self, name: str) -> str:
        return self.block.summary(name).reference

    def _column(self, name: str) -> str:
        return self.block.column(name).reference

    @property
    def _valid(self) -> str:
        return f"{self._sum('usable')}=1"

    def _when_valid(self, formula: str) -> str:
        return f'IF({self._valid},{formula},"{DASH}")'

    def _heading(self, row: int, label: str, last: int) -> Iterator[Cell]:
        for column in range(last + 1):
            yield self._cell(row, column, None if column else label, Style.HEADING)

    def _wide_label(self, row: int, label: str) -> Cell:
        """Write a label up to the value in column 5."""
        return replace(self._cell(row, 0, label, Style.LABEL), columns=5)

    # --- the card, in its order ---

    def _moment_table(self, number: int) -> Iterator[Cell]:
        labels, kind = KINDS[number], self.space.kinds[number]
        row = self.card.table_row(number)
        yield from self._heading(row, f"Moment of forces from the {labels.plural}", 6)
        for column, label in enumerate(MOMENT_HEADER):
            yield self._cell(row + 1, column, label, Style.HEADER)
        for slot, gene in enumerate(self.grasp.chromosome.genes[number, 1:].tolist(), 1):
            here = row + 1 + slot
            yield self._cell(here, 0, slot, Style.MARK)
            for axis in range(3):
                if gene == BLANK_GENE:
                    yield self._cell(here, 1 + axis, None, Style.COORDINATE)
                    yield self._cell(here, 4 + axis, None, Style.TORQUE)
                    continue
                place = float(kind.footprints_mm[gene - 1, axis])
                element = number * self.card.gene_slots + slot - 1
                known = self.block.element("in space", element).reference
                index = self.card.genes.cell(number, slot).local
                found = f"INDEX({labels.locations_name},{index},{axis + 1})"
                formula = f'IF({known}=1,{found},"{DASH}")'
                yield self._cell(here, 1 + axis, place, Style.COORDINATE, formula)
                force = f"{labels.field('Force')}*{self._ref(here, 1 + axis)}"
                formula = f'IF({INPUTS_USABLE}*{known}=1,{force},"{DASH}")'
                yield self._cell(here, 4 + axis, kind.force_n * place, Style.TORQUE, formula)
        for column, unit in enumerate(MOMENT_UNITS):
            yield self._cell(row + 2 + self.card.gene_slots, column, unit, Style.UNIT)

    def _per_kind(self, suffix: str) -> str:
        """Sum over the kinds of the count times one of their inputs."""
        return "+".join(
            f"{self.card.genes.cell(number, 0).local}*{labels.field(suffix)}"
            for number, labels in enumerate(KINDS)
        )

    def _force_cells(self) -> Iterator[Cell]:
        row, grasp = self.card.summary_row, self.grasp
        yield self._cell(row, 1, "Lifting force", Style.HEADER)
        yield self._cell(row, 2, "Cost ($)", Style.HEADER)
        yield self._cell(row + 1, 0, "Force from grippers (N)", Style.LABEL)
        force = self._when_valid(self._per_kind("Force"))
        yield self._cell(row + 1, 1, grasp.force_n, Style.FORCE, force)
        cost = self._when_valid(self._per_kind("Price"))
        yield self._cell(row + 1, 2, grasp.terms.cost, Style.MONEY, cost)
        for column, label in ((4, "DD Fitness"), (5, "Structure Fitness")):
            header = self._cell(row + 1, column, label, Style.STACKED_HEADER)
            yield replace(header, rows=3)
        yield self._cell(row + 2, 0, "Part weight (N)", Style.LABEL)
        weight = f'IF({INPUTS_USABLE}=1,PartMass/1000*9.81,"{DASH}")'
        yield self._cell(row + 2, 1, grasp.weight_n, Style.FORCE, weight)
        yield self._cell(row + 3, 0, "FoS", Style.LABEL)
        fos = self._when_valid(f"{self._ref(row + 1, 1)}/{self._ref(row + 2, 1)}")
        yield self._cell(row + 3, 1, grasp.fos, Style.RESULT, fos)
        mean = f"SUM({self._column('to polygon')})/{self._sum('elements')}"
        yield self._cell(row + 4, 4, grasp.terms.deviation, Style.RESULT, self._when_valid(mean))
        least = self._column("least structure")
        size = f"IF({self._sum('elements')}<2,0,MIN({least}))"
        yield self._cell(row + 4, 5, grasp.terms.structure, Style.RESULT, self._when_valid(size))

    def _centre_cells(self) -> Iterator[Cell]:
        row, grasp = self.card.summary_row + 5, self.grasp
        yield from self._heading(row, "Center of forces from grippers", 6)
        force = self._column("force (N)")
        for axis, name in enumerate(AXES):
            here = row + 1 + axis
            centroid = float(self.space.part.centroid_mm[axis])
            centre = float(grasp.centre_of_force_mm[axis])
            offset = float(grasp.offset_mm[axis])
            mean = f"SUMPRODUCT({force}*{self._column(name)})/SUM({force})"
            apart = f"{self._ref(here, 1)}-{self._ref(here, 3)}"
            yield self._cell(here, 0, f"{name}_c", Style.LABEL)
            own = _number_or_dash(f"Centroid{name.upper()}")
            yield self._cell(here, 1, centroid, Style.COORDINATE, own)
            yield self._cell(here, 2, f"{name}_bar", Style.LABEL)
            yield self._cell(here, 3, centre, Style.COORDINATE, self._when_valid(mean))
            yield self._cell(here, 4, f"delta_{name}", Style.LABEL)
            yield self._cell(here, 5, offset, Style.COORDINATE, self._when_valid(apart))
            yield self._cell(here, 6, "(mm)", Style.UNIT)
        x, y, z = (self._ref(row + 1 + axis, 5) for axis in range(3))
        arm = self._when_valid(f'SQRT({x}^2+{y}^2+IF(TRIM(MomentArm)="plan",0,{z}^2))')
        yield self._wide_label(row + 4, "Center of force offset")
        yield self._cell(row + 4, 5, grasp.eccentricity_mm, Style.RESULT, arm)
        yield self._cell(row + 4, 6, "(mm)", Style.UNIT)
        weight = self._ref(self.card.summary_row + 2, 1)
        moment = self._when_valid(f"{self._ref(row + 4, 5)}*{weight}")
        yield self._wide_label(row + 5, "Unbalanced moment from weight")
        yield self._cell(row + 5, 5, grasp.terms.moment, Style.RESULT, moment)
        yield self._cell(row + 5, 6, "(N-mm)", Style.UNIT)

    def _own_units(self) -> list[str]:
        """Return references to FoS, cost, moment, deviation and structure on this card."""
        row = self.card.summary_row
        places = ((row + 3, 1), (row + 1, 2), (row + 10, 5), (row + 4, 4), (row + 4, 5))
        return [self._ref(*place) for place in places]

    def _fitness_cells(self) -> Iterator[Cell]:
        row, grasp = self.card.summary_row + 11, self.grasp
        yield from self._heading(row, "Normalized Fitness Values", 4)
        yield self._cell(row, 5, DIVERGENCE_LABEL, Style.HEADER)
        normalised = (grasp.normalised_fos, *(DASH if n is None else n for n in grasp.normalised))
        goals = (self.rules.requirements.fos, *self.rules.goals.base)
        for column, (label, value) in enumerate(
            zip(FITNESS_HEADER, self._own_units(), strict=True)
        ):
            goal = self._ref(row + 3, column)
            ratio = f"{goal}/{value}"
            if column:
                ratio = f'IF(N({goal})<{SLACK},"{DASH}",{value}/{goal})'
            yield self._cell(row + 1, column, label, Style.HEADER)
            yield self._cell(
                row + 2, column, normalised[column], Style.RATIO, self._when_valid(ratio)
            )
            counts = _number_or_dash(used(GOALS[column]))
            yield self._cell(row + 3, column, goals[column], Style.RESULT, counts)
        four = self.card.at(row + 2, 1, 1, len(TERMS)).absolute
        total = self._when_valid(f'IF({GOALS_USABLE}=1,SUM({four}),"{DASH}")')
        yield self._cell(row + 2, 5, grasp.divergence, Style.DIVERGENCE, total)
        yield self._cell(row + 3, 5, "<-- Fitness Goals", Style.NOTE)
        fos = self._ref(self.card.summary_row + 3, 1)
        missed = f"MAX({four})>1+{SLACK}"
        status = status_formula(self.block, fos, missed)
        line = self._cell(row + 4, 0, status_text(grasp), Style.STATUS, status)
        yield replace(line, columns=self.card.columns)

    def _note_cells(self) -> Iterator[Cell]:
        row = self.card.summary_row + 16
        held = support(self.space, self.grasp)
        weight = "not known" if held.element_weight_g is None else held.element_weight_g
        notes: tuple[tuple[str, CellValue, Style, str], ...] = (
            ("Total element weight (g)", weight, Style.TORQUE, self._weight_formula()),
            (
                "Plan area of the elements' convex hull (mm²)",
                held.hull_area_mm2,
                Style.TORQUE,
                self._sum("hull area"),
            ),
            (
                "Centroid inside that hull",
                "yes" if held.centroid_inside else "no",
                Style.CENTRED,
                f'IF({self._sum("centroid inside")}=1,"yes","no")',
            ),
        )
        for offset, (label, value, style, formula) in enumerate(notes):
            yield self._cell(row + offset, 0, label, Style.NOTE)
            yield self._cell(row + offset, 5, value, style, self._when_valid(formula))
        swings = f'IF({self._sum("hull area")}=0,"{SWING_WARNING}","")&"{STATIC_NOTE}"'
        text = f"{SWING_WARNING if held.can_swing else ''}{STATIC_NOTE}"
        yield self._cell(row + 3, 0, text, Style.NOTE, self._when_valid(swings))

    def _own_cells(self) -> Iterator[Cell]:
        """Yield what the thesis's card does not have, under its notes."""
        row, clearance = self.card.summary_row + 20, self.grasp.clearance_mm
        shortest = self._sum("shortest")
        lines: tuple[tuple[str, CellValue, Style, str], ...] = (
            (
                "Smallest distance of two elements (mm)",
                DASH if clearance is None else clearance,
                Style.TORQUE,
                self._when_valid(f'IF({shortest}="","{DASH}",{shortest})'),
            ),
            (
                "Value under the fitness criterion",
                self.grasp.value,
                Style.RATIO,
                self._when_valid(self._value_formula()),
            ),
            ("Difference, engine to workbook", 0, Style.DIFFERENCE, self._difference_formula()),
        )
        for offset, (label, value, style, formula) in enumerate(lines):
            yield self._cell(row + offset, 0, label, Style.NOTE)
            yield self._cell(row + offset, 5, value, style, formula)

    def _weight_formula(self) -> str:
        """Sum of known weights; not known as soon as a kind in use has none."""
        total = self._per_kind("Weight")
        unknown = "+".join(
            f'IF({labels.field("Weight")}="",{self.card.genes.cell(number, 0).local},0)'
            for number, labels in enumerate(KINDS)
        )
        return f'IF({unknown}>0,"not known",{total})'

    def _value_formula(self) -> str:
        """Return the divergence, one term in its own unit, or the sum of the named terms."""
        row = self.card.summary_row + 13
        named = [f'ISNUMBER(SEARCH("{term}",FitnessCriterion))' for term in TERMS]
        count = "+".join(f"IF({test},1,0)" for test in named)
        own = self._own_units()[1:]
        alone = "+".join(f"IF({test},{cell},0)" for test, cell in zip(named, own, strict=True))
        summed = "+".join(
            f"IF({test},N({self._ref(row, 1 + number)}),0)" for number, test in enumerate(named)
        )
        divergence = self._ref(row, 5)
        summed = f'IF({GOALS_USABLE}=1,{summed},"{DASH}")'
        return f"IF({count}=0,{divergence},IF({count}=1,{alone},{summed}))"

    def _difference_formula(self) -> str:
        """Largest relative difference to the engine, as long as nothing was typed over."""
        engine = self.block.engine
        differences = ",".join(
            f"ABS({cell}-{engine.cell(0, number).reference})"
            f"/MAX(1,ABS({engine.cell(0, number).reference}))"
            for number, cell in enumerate(self._own_units())
        )
        genes = self.card.genes
        others = f"SUMPRODUCT(({genes.absolute}<>{self.block.engine_genes.reference})*1)"
        edited = f"IF(ISERROR({others}),1,{others})"
        return (
            f'IF({edited}+{INPUTS_EDITED}>0,"edited",'
            f"{self._when_valid(f'ROUND(MAX({differences}),9)')})"
        )


def _number_or_dash(name: str) -> str:
    return f'IF(ISNUMBER({name}),{name},"{DASH}")'


def status_formula(block: CalcBlock, fos: str, missed: str) -> str:
    """Return the formula of the one-line status of a grasp: its fault, or what it meets.

    Parameters
    ----------
    block : CalcBlock
        Its helper cells.
    fos : str
        Cell of its FoS.
    missed : str
        Whether it misses a goal.
    """
    fault, shortest = (block.summary(name).reference for name in ("fault", "shortest"))
    weak = f'IF({fos}<{used("FoSGoal")}*(1-{SLACK}),"{WEAK}","")'
    too_close = f"{shortest}<{used('MinClearance')}*(1-{SLACK})"
    close = f'IF({shortest}="","",IF({too_close},"{CLOSE}",""))'
    failures = f"TRIM({weak}&{close})"
    meets = f'IF({missed},"{MEETS_SOME}","{MEETS_ALL}")'
    return (
        f'IF({fault}<>"",{fault},IF({GOALS_USABLE}=0,{GOALS_FAULT},'
        f'IF({failures}="",{meets},{failures})))'
    )


def status_text(grasp: Grasp) -> str:
    """Return what the card says of its grasp, as its formula does."""
    if grasp.feasible:
        return MEETS_ALL if grasp.meets_all_goals else MEETS_SOME
    return f"{'' if grasp.meets_fos else WEAK}{'' if grasp.is_clear else CLOSE}".strip()


def user_cells(plan: Layout, grasp: Grasp, block: CalcBlock) -> Iterator[Cell]:
    """Yield criteria in their own units and a status below the user-defined genes (figure 28)."""
    first, line = plan.user_fitness, plan.user_status
    labels = (*FITNESS_HEADER, DIVERGENCE_LABEL)
    values = (grasp.fos, *grasp.terms, grasp.divergence)
    formulas = _block_formulas(first, block)
    for column, (label, value, formula) in enumerate(zip(labels, values, formulas, strict=True)):
        yield Cell(first.row, first.column + column, label, Style.HEADER)
        yield Cell(first.row + 1, first.column + column, value, Style.RESULT, formula)
    missed = ",".join(
        f"{first.cell(1, number).local}>{used(goal)}*(1+{SLACK})"
        for number, goal in enumerate(GOAL_NAMES, 1)
    )
    status = status_formula(block, first.cell(1, 0).local, f"OR({missed})")
    text = status_text(grasp)
    yield Cell(line.row, line.column, text, Style.STATUS, status, line.rows, line.columns)


def _block_formulas(first: Area, block: CalcBlock) -> list[str]:
    """FoS, cost, moment, deviation, structure and divergence straight from the helper cells."""
    force = block.column("force (N)").reference
    weight = "(PartMass/1000*9.81)"
    cost = "+".join(
        f"{block.gene(number, 0)}*{labels.field('Price')}" for number, labels in enumerate(KINDS)
    )
    apart = [
        f"(Centroid{axis.upper()}-SUMPRODUCT({force}*{block.column(axis).reference})/SUM({force}))"
        for axis in AXES
    ]
    arm = f'SQRT({apart[0]}^2+{apart[1]}^2+IF(TRIM(MomentArm)="plan",0,{apart[2]}^2))'
    elements = block.summary("elements").reference
    divergence = "+".join(
        f"IF({used(goal)}<{SLACK},0,{first.cell(1, number).local}/{used(goal)})"
        for number, goal in enumerate(GOAL_NAMES, 1)
    )
    formulas = [
        f"SUM({force})/{weight}",
        cost,
        f"{arm}*{weight}",
        f"SUM({block.column('to polygon').reference})/{elements}",
        f"IF({elements}<2,0,MIN({block.column('least structure').reference}))",
        f'IF({GOALS_USABLE}=1,{divergence},"{DASH}")',
    ]
    usable = block.summary("usable").reference
    return [f'IF({usable}=1,{formula},"{DASH}")' for formula in formulas]
