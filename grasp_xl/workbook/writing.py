"""From a result to a workbook: one function that reads as the table of contents."""

from __future__ import annotations

import io

import xlsxwriter

from grasp_xl import __version__
from grasp_xl.chromosome import Chromosome
from grasp_xl.grasp import Grasp, evaluate
from grasp_xl.search.result import Result
from grasp_xl.space import OptionSpace
from grasp_xl.task import Task
from grasp_xl.workbook import layout
from grasp_xl.workbook.ga_sheet import write_ga
from grasp_xl.workbook.grasp_sheet import write_grasp
from grasp_xl.workbook.layout import Layout
from grasp_xl.workbook.option_space_sheet import write_option_space
from grasp_xl.workbook.pen import Pen
from grasp_xl.workbook.run_log import Origin, write_run_log
from grasp_xl.workbook.stamp import PLACEHOLDER, STAMP_PROPERTY, stamped
from grasp_xl.workbook.styles import Formats
from grasp_xl.workbook.tables import write_fitness_table, write_history, write_valid_designs

Filled = dict[str, set[tuple[int, int]]]
"""Cells that a workbook fills, by sheet."""


def full_workbook(
    task: Task,
    result: Result,
    origin: Origin,
    *,
    what_if: Chromosome | None = None,
    stale_user: Chromosome | None = None,
) -> tuple[bytes, Filled]:
    """Return the full workbook of a run, and the cells that it fills.

    Parameters
    ----------
    task, result : Task, Result
    origin : Origin
        Goes to the run log.
    what_if : Chromosome, optional
        Genes that the designer typed into the What-if card; the best grasp where there are none.
    stale_user : Chromosome, optional
        User-defined genes that this option space does not have: shown, not used.
    """
    shown = result.best or result.benchmark
    card = evaluate(task.space, task.rules, what_if) if what_if else shown
    plan = Layout(task.space.gene_slots, task.settings.children)

    file = io.BytesIO()
    book = _new_book(file)
    formats = Formats(book)
    pens = {name: Pen(book, formats, name) for name in layout.SHEETS}
    write_option_space(pens[layout.OPTION_SPACE], task.space, live=True)
    write_ga(pens[layout.GA], plan, task, result, card, stale_user)
    write_valid_designs(pens[layout.VALID_DESIGNS], result)
    write_fitness_table(pens[layout.FITNESS_TABLE], result)
    write_history(pens[layout.HISTORY], book, result)
    write_grasp(pens[layout.GRASP], book, task.space, _pictures(result, shown))
    write_run_log(
        pens[layout.RUN_LOG],
        task,
        result,
        origin,
        (result.best or result.benchmark).chromosome,
    )
    pens[layout.GA].sheet.activate()
    book.set_custom_property(STAMP_PROPERTY, PLACEHOLDER)
    book.close()
    return stamped(file.getvalue()), {name: pen.filled for name, pen in pens.items()}


def export_workbook(space: OptionSpace) -> bytes:
    """Return an option space as CAD exports it: one sheet, values only."""
    file = io.BytesIO()
    book = _new_book(file)
    write_option_space(Pen(book, Formats(book), layout.OPTION_SPACE), space, live=False)
    book.close()
    return file.getvalue()


def _new_book(file: io.BytesIO) -> xlsxwriter.Workbook:
    book = xlsxwriter.Workbook(
        file,
        {
            "in_memory": True,
            "strings_to_formulas": False,
            "strings_to_urls": False,
            "strings_to_numbers": False,
        },
    )
    book.set_properties({"author": f"grasp_xl {__version__}"})
    return book


def _pictures(result: Result, shown: Grasp) -> list[tuple[str, Grasp]]:
    title = "Best grasp" if result.best else "No feasible grasp yet: benchmark"
    return [(title, shown), ("Benchmark grasp", result.benchmark)]
