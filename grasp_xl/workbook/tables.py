"""Sheets that are tables: ``Valid Designs``, ``Fitness Table``, ``History`` with its charts."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from grasp_xl.chromosome import BLANK_GENE
from grasp_xl.grasp import Grasp, evaluate
from grasp_xl.rules import TERMS
from grasp_xl.search.result import Result, gene_columns
from grasp_xl.workbook.layout import (
    FITNESS_HEADER,
    HISTORY,
    HISTORY_ROW,
    KINDS,
    TABLE_ROW,
    VALID_DESIGNS,
    Area,
)
from grasp_xl.workbook.pen import Cell, Pen
from grasp_xl.workbook.styles import BLUE, GREY, Style

if TYPE_CHECKING:
    import pandas as pd

MAX_DESIGNS = 10_000
"""Valid designs that the sheet lists: the newest."""

MAX_HISTORY = 100_000
"""Changes that the sheet lists; beyond that, the newest and the fitness table's generations."""

PICK_NAME = "DesignPick"
TERM_LABELS = ("FoS", "Cost ($)", "Residual Moment (N-mm)", "Deviation (mm)", "Structure (mm)")
TERM_STYLES = (Style.RATIO, Style.MONEY, Style.TORQUE, Style.RATIO, Style.TORQUE)
NORMALISED_LABELS = tuple(f"Norm. {label}" for label in FITNESS_HEADER)
REPORT_LABELS = {10_000: "Gen: 10k", 50_000: "Gen: 50k"}
FITNESS_COLUMNS = (
    "Grasp",
    "FoS",
    "Cost",
    "Moment",
    "Deviation",
    "Structure",
    "Divergence",
)
DASH = "-"


def _gene_labels(result: Result) -> list[str]:
    names = {
        kind.name: labels.row_label for kind, labels in zip(result.space.kinds, KINDS, strict=True)
    }
    return [names.get(column, column) for column in gene_columns(result.space)]


def _shown(value: Any) -> float | str | None:  # noqa: ANN401 (a cell of a data frame)
    number = float(value)
    return DASH if math.isnan(number) else number


def _gene(value: Any) -> int | None:  # noqa: ANN401 (a cell of a data frame)
    return None if value == BLANK_GENE else int(value)


# --- Valid Designs ---


def write_valid_designs(pen: Pen, result: Result) -> None:
    """Write the valid-design list as an Excel table, and above it a row picked for copying."""
    designs = result.valid_designs().tail(MAX_DESIGNS)
    genes = _gene_labels(result)
    labels = [
        "Generation",
        *genes,
        *TERM_LABELS,
        *NORMALISED_LABELS,
        "Divergence",
        "Meets All Goals",
    ]
    pen.write(0, 0, "VALID DESIGNS", Style.TITLE)
    for offset, (_, design) in enumerate(designs.iterrows(), 1):
        pen.put(_design_cells(TABLE_ROW + offset, design, result))
    rows = max(1, len(designs))
    area = Area(VALID_DESIGNS, TABLE_ROW, 0, 1 + rows, len(labels))
    _table(pen, "ValidDesigns", area, labels)
    _picker(pen, result, designs, rows)
    pen.sheet.freeze_panes(TABLE_ROW + 1, 1)
    pen.sheet.set_column(0, len(labels) - 1, 11)


def _design_cells(row: int, design: pd.Series[Any], result: Result) -> list[Cell]:
    genes = gene_columns(result.space)
    cells = [Cell(row, 0, int(design["generation"]), Style.COUNT)]
    per_kind = 1 + result.space.gene_slots
    for number, name in enumerate(genes):
        style = (Style.SUCTION_GENE, Style.MAGNETS_GENE)[number // per_kind]
        value = int(design[name]) if number % per_kind == 0 else _gene(design[name])
        cells.append(Cell(row, 1 + number, value, style))
    column = 1 + len(genes)
    for name, style in zip(("fos", *TERMS), TERM_STYLES, strict=True):
        cells.append(Cell(row, column, _shown(design[name]), style))
        column += 1
    for name in ("fos", *TERMS):
        cells.append(Cell(row, column, _shown(design[f"normalised_{name}"]), Style.RATIO))
        column += 1
    cells.append(Cell(row, column, float(design["divergence"]), Style.DIVERGENCE))
    meets = "yes" if design["meets_all_goals"] else "no"
    cells.append(Cell(row, column + 1, meets, Style.CENTRED))
    return cells


def _picker(pen: Pen, result: Result, designs: pd.DataFrame, rows: int) -> None:
    """Two gene rows, side by side as figure 34 has them, of the table row that is picked."""
    slots = result.space.gene_slots
    picked = len(designs)
    pen.write(2, 0, "Row of the list:", Style.LABEL)
    pen.write(2, 1, max(1, picked), Style.INPUT)
    pen.name_area(PICK_NAME, Area(VALID_DESIGNS, 2, 1))
    pen.write(2, 2, "Type a row number, then copy the two rows below as they are.", Style.NOTE)
    for column, label in enumerate(("Total #", *(f"Index {k}" for k in range(1, slots + 1))), 1):
        pen.write(3, column, label, Style.HEADER)
    for number, labels in enumerate(KINDS):
        style = (Style.SUCTION_GENE, Style.MAGNETS_GENE)[number]
        pen.write(4 + number, 0, labels.row_label, style)
        for slot in range(1 + slots):
            column = 1 + number * (1 + slots) + slot
            listed = Area(VALID_DESIGNS, TABLE_ROW + 1, column, rows).reference
            picked_gene = f"INDEX({listed},{PICK_NAME})"
            name = gene_columns(result.space)[column - 1]
            value = int(designs[name].iloc[-1]) if picked else None
            formula = f'IF({picked_gene}="","",{picked_gene})'
            pen.write(4 + number, 1 + slot, value, style, formula)


def _table(pen: Pen, name: str, area: Area, labels: list[str]) -> None:
    pen.sheet.add_table(
        area.row,
        area.column,
        area.row + area.rows - 1,
        area.column + area.columns - 1,
        {
            "name": name,
            "style": "Table Style Light 1",
            "columns": [
                {"header": label, "header_format": pen.formats[Style.STACKED_HEADER]}
                for label in labels
            ],
        },
    )
    for column in range(area.columns):
        pen.filled.add((area.row, area.column + column))


# --- Fitness Table ---


def write_fitness_table(pen: Pen, result: Result) -> None:
    """Write the fitness of the benchmark and of the fittest at the thesis's generations."""
    pen.write(0, 0, "FITNESS TABLE", Style.TITLE)
    pen.row(2, 0, FITNESS_COLUMNS, Style.HEADER)
    rows = [("Benchmark", result.benchmark)]
    for generation in result.report_generations():
        label = REPORT_LABELS.get(generation, f"Gen: {generation}")
        grasp = evaluate(result.space, result.rules, result.at_generation(generation))
        rows.append((label, grasp))
    if result.best:
        rows.append(("Best", result.best))
    for row, (label, grasp) in enumerate(rows, 3):
        pen.write(row, 0, label, Style.LABEL)
        _fitness_row(pen, row, grasp, always=label == "Benchmark")
    pen.sheet.freeze_panes(3, 1)
    pen.sheet.set_column(0, len(FITNESS_COLUMNS) - 1, 14)


def _fitness_row(pen: Pen, row: int, grasp: Grasp, *, always: bool) -> None:
    pen.write(row, 1, grasp.fos, Style.RATIO)
    styles = (Style.MONEY, Style.TORQUE, Style.RATIO, Style.TORQUE, Style.DIVERGENCE)
    for column, (value, style) in enumerate(
        zip((*grasp.terms, grasp.divergence), styles, strict=True), 2
    ):
        if grasp.feasible or always:
            pen.write(row, column, value, style)
        else:
            pen.write(row, column, DASH, Style.CENTRED)


# --- History ---

CHART_TITLES = (
    ("fos", "FoS", "FoS"),
    ("cost", "Cost", "Cost ($)"),
    ("moment", "Residual Moment", "Residual Moment (N-mm)"),
    ("deviation", "Deviation", "Deviation (mm)"),
    ("structure", "Structure", "Structure (mm)"),
    ("divergence", "Divergence", "Divergence"),
)


def write_history(pen: Pen, book: Any, result: Result) -> None:  # noqa: ANN401 (untyped library)
    """Write the generations where the fittest changed, and the six charts of figures 42 to 47."""
    history = result.history()
    if len(history) > MAX_HISTORY:
        reported = history["generation"].isin(result.report_generations())
        newest = history.index >= len(history) - MAX_HISTORY + int(reported.sum())
        history = history[reported | newest]
    genes = gene_columns(result.space)
    labels = ["Generation", *(title for _, title, _ in CHART_TITLES), *_gene_labels(result)]
    pen.write(0, 0, "HISTORY: the generations where the fittest grasp changed", Style.TITLE)
    styles = (*TERM_STYLES, Style.DIVERGENCE)
    columns = ["generation", *(name for name, _, _ in CHART_TITLES), *genes]
    for row, values in enumerate(history[columns].itertuples(index=False), HISTORY_ROW + 1):
        pen.write(row, 0, int(values[0]), Style.COUNT)
        for number, style in enumerate(styles, 1):
            pen.write(row, number, _shown(values[number]), style)
        for number, value in enumerate(values[1 + len(styles) :], 1 + len(styles)):
            pen.write(row, number, int(value), Style.COUNT)
    rows = max(1, len(history))
    _table(pen, "History", Area(HISTORY, HISTORY_ROW, 0, 1 + rows, len(labels)), labels)
    _benchmark_line(pen, result, len(labels) + 1)
    for number, (_, title, unit) in enumerate(CHART_TITLES):
        chart = _chart(book, rows, 1 + number, title, unit, len(labels) + 1)
        left = len(labels) + 10
        pen.sheet.insert_chart(HISTORY_ROW + 18 * (number // 2), left + 9 * (number % 2), chart)
    pen.sheet.freeze_panes(HISTORY_ROW + 1, 1)
    pen.sheet.set_column(0, len(labels) + 9, 11)


def _benchmark_line(pen: Pen, result: Result, left: int) -> None:
    """Write the benchmark's values at both ends of the generation axis."""
    pen.row(HISTORY_ROW, left, ("Benchmark", *(t for _, t, _ in CHART_TITLES)), Style.HEADER)
    benchmark = result.benchmark
    values = (benchmark.fos, *benchmark.terms, benchmark.divergence)
    for offset, generation in enumerate((1, max(10, result.state.generation)), 1):
        pen.write(HISTORY_ROW + offset, left, generation, Style.COUNT)
        for number, value in enumerate(values, 1):
            pen.write(HISTORY_ROW + offset, left + number, value, Style.RATIO)


def _chart(book: Any, rows: int, column: int, title: str, unit: str, left: int) -> Any:  # noqa: ANN401
    chart = book.add_chart({"type": "scatter", "subtype": "straight"})
    first, last = HISTORY_ROW + 1, HISTORY_ROW + rows
    chart.add_series(
        {
            "name": "Fittest",
            "categories": [HISTORY, first, 0, last, 0],
            "values": [HISTORY, first, column, last, column],
            "line": {"color": BLUE, "width": 1.75},
        }
    )
    chart.add_series(
        {
            "name": "Benchmark",
            "categories": [HISTORY, first, left, first + 1, left],
            "values": [HISTORY, first, left + column, first + 1, left + column],
            "line": {"color": GREY, "width": 1.5, "dash_type": "dash"},
        }
    )
    chart.set_title({"name": f"{title} vs Generation Number", "name_font": {"size": 11}})
    chart.set_x_axis(
        {"name": "Generation", "log_base": 10, "min": 1, "major_gridlines": {"visible": True}}
    )
    chart.set_y_axis({"name": unit})
    chart.set_legend({"position": "bottom"})
    chart.set_size({"width": 560, "height": 340})
    return chart
