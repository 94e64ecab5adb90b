"""From a result to a workbook: one function that reads as the table of contents."""

from __future__ import annotations

import io
from datetime import datetime

import xlsxwriter

from grasp_xl import __version__
from grasp_xl.chromosome import Chromosome
from grasp_xl.grasp import evaluate
from grasp_xl.search.result import Result
from grasp_xl.space import OptionSpace
from grasp_xl.task import Task
from grasp_xl.workbook import layout
from grasp_xl.workbook.calc_sheet import write_calc
from grasp_xl.workbook.carrying import NOTHING_ASIDE, SetAside
from grasp_xl.workbook.designs_sheet import number_of, write_valid_designs
from grasp_xl.workbook.fitness_sheet import write_fitness_table
from grasp_xl.workbook.ga_sheet import Shown, parameter_values, user_block, write_ga
from grasp_xl.workbook.grasp_sheet import Picture, Rendering, write_grasp
from grasp_xl.workbook.history_sheet import write_history
from grasp_xl.workbook.layout import Layout
from grasp_xl.workbook.macros import Macros, add_buttons, add_macros, write_settings
from grasp_xl.workbook.option_space_sheet import write_option_space
from grasp_xl.workbook.part_sheet import PartRecord, write_part
from grasp_xl.workbook.pen import Pen
from grasp_xl.workbook.picker import DESIGN_PICK, NO_PICKS, TRADE_OFF_PICK, Picks
from grasp_xl.workbook.proved import Proved
from grasp_xl.workbook.run_log import Origin, write_run_log
from grasp_xl.workbook.stamp import PLACEHOLDER, STAMP_PROPERTY, stamped
from grasp_xl.workbook.styles import BOOK_FONT_SIZE, FIXED_FONT, Formats
from grasp_xl.workbook.trade_offs_sheet import TradeOffs, write_trade_offs
from grasp_xl.workbook.written import CellValue, WrittenBook

AT_NO_TIME = datetime(1980, 1, 1)  # noqa: DTZ001 (a workbook's times have no zone)
"""When a workbook was made that is to be the same whenever that was; ZIP's first day."""


def full_workbook(
    task: Task,
    result: Result,
    origin: Origin,
    *,
    what_if: Chromosome | None = None,
    picks: Picks = NO_PICKS,
    set_aside: SetAside = NOTHING_ASIDE,
    proved: Proved | None = None,
    trade_offs: TradeOffs | None = None,
    part: PartRecord | None = None,
    macros: Macros | None = None,
    rendering: Rendering | None = None,
) -> WrittenBook:
    """Write the full workbook of a run.

    Parameters
    ----------
    task, result : Task, Result
    origin : Origin
        Goes to the run log.
    what_if : Chromosome, optional
        Genes that the designer typed into the What-if card.
    picks : Picks
        Designs that the designer picked: the one that the What-if card shows stays there unless
        others were typed, as the pick where it is in its list, else as typed genes.  Where nothing
        was typed or picked, the card shows the best grasp: of the run, else of the exact search.
    set_aside : SetAside
        Genes of the designer that this option space does not have: named and kept.
    proved : Proved, optional
        What the exact search says.
    trade_offs : TradeOffs, optional
        Gives a sheet of its own.
    part : PartRecord, optional
        Gives a sheet of its own.
    macros : Macros, optional
        Make it a workbook with buttons.
    rendering : Rendering, optional
        A picture of a grasp for the sheet ``Grasp``.
    """
    best = result.best or (proved.grasp if proved else None) or result.benchmark
    on_card = what_if or picks.trade_off or picks.design
    picks = _still_listed(picks, result, trade_offs)
    typed = what_if is not None or on_card not in (*picks, None)
    grasp = evaluate(task.space, task.rules, on_card) if on_card else best
    picker = TRADE_OFF_PICK if trade_offs else DESIGN_PICK
    shown = Shown(grasp, typed, set_aside, proved, picker)
    plan = Layout(task.space.gene_slots, task.settings.children)

    file = io.BytesIO()
    book = new_book(file)
    formats = Formats(book)
    run = (
        f"Seed {task.settings.seed}, {result.state.generation:,} generations, "
        f"{origin.ended:%Y-%m-%d %H:%M}"
    )
    sheets = _sheet_names(part, trade_offs, macros)
    pens = {name: Pen(book, formats, name, run) for name in sheets}
    write_option_space(pens[layout.OPTION_SPACE], task.space, live=True)
    if part:
        write_part(pens[layout.PART_SHEET], part)
    cards = write_ga(pens[layout.GA], plan, task, result, shown)
    overruled = trade_offs.overrules(picks.trade_off) if trade_offs else None
    on_card = shown.what_if.chromosome
    designs = pens[layout.VALID_DESIGNS]
    write_valid_designs(designs, book, result, best.chromosome, picks.design, on_card, overruled)
    if trade_offs:
        unpicked = picks.design or best.chromosome
        place = pens[layout.TRADE_OFFS]
        write_trade_offs(place, book, task, trade_offs, unpicked, picks.trade_off, on_card)
    write_fitness_table(pens[layout.FITNESS_TABLE], result, proved)
    write_history(pens[layout.HISTORY], book, result, proved)
    benchmark = Picture("Benchmark grasp", result.benchmark, user_block(plan))
    pictures = [
        Picture("What-if grasp", shown.what_if, cards[layout.WHAT_IF.name].block),
        benchmark,
    ]
    write_grasp(pens[layout.GRASP], book, task.space, pictures, rendering)
    fingerprint = trade_offs.fingerprint if trade_offs else ""
    log = pens[layout.RUN_LOG]
    write_run_log(log, task, result, origin, best.chromosome, proved, set_aside, fingerprint)
    blocks = [(layout.USER_BLOCK.label, benchmark.block, result.benchmark)]
    blocks += [(card.title, card.block, card.grasp) for card in cards.values()]
    write_calc(pens[layout.CALC], task.space, _inputs(task), blocks, plan)
    if macros:
        add_buttons(pens[layout.GA])
        write_settings(pens[layout.CONFIGURATION], macros.settings)
        add_macros(book, list(pens.values()), macros)
    pens[layout.GA].sheet.activate()
    book.set_custom_property(STAMP_PROPERTY, PLACEHOLDER)
    book.close()
    return WrittenBook(
        stamped(file.getvalue()),
        {name: pen.written for name, pen in pens.items()},
        {name: area for pen in pens.values() for name, area in pen.names.items()},
    )


def _sheet_names(
    part: PartRecord | None, trade_offs: TradeOffs | None, macros: Macros | None
) -> list[str]:
    """Return the names of the sheets, in order."""
    names = list(layout.SHEETS)
    if trade_offs:
        names.insert(names.index(layout.VALID_DESIGNS) + 1, layout.TRADE_OFFS)
    if part:
        names.insert(names.index(layout.OPTION_SPACE) + 1, layout.PART_SHEET)
    if macros:
        names.append(layout.CONFIGURATION)
    return names


def _still_listed(picks: Picks, result: Result, trade_offs: TradeOffs | None) -> Picks:
    """Return the picks that the lists to be written have."""
    design, trade_off = picks
    if design and number_of(result, design) is None:
        design = None
    if not (trade_offs and trade_offs.number_of(trade_off)):
        trade_off = None
    return Picks(design, trade_off)


def export_workbook(space: OptionSpace, part: PartRecord | None = None) -> WrittenBook:
    """Write an option space as CAD exports it, values only; and the sheet ``Part``, if given."""
    file = io.BytesIO()
    book = new_book(file, AT_NO_TIME)
    formats = Formats(book)
    pens = [Pen(book, formats, layout.OPTION_SPACE)]
    write_option_space(pens[0], space, live=False)
    if part:
        pens.append(Pen(book, formats, layout.PART_SHEET))
        write_part(pens[-1], part)
    book.set_custom_property(STAMP_PROPERTY, PLACEHOLDER)
    book.close()
    return WrittenBook(stamped(file.getvalue()), {pen.name: pen.written for pen in pens}, {})


def new_book(file: io.BytesIO, created: datetime | None = None) -> xlsxwriter.Workbook:
    """Begin a workbook in our font and by our name, in which text is never taken for a formula.

    It says when it was made: now, unless ``created`` says otherwise.
    """
    book = xlsxwriter.Workbook(
        file,
        {
            "in_memory": True,
            # Column widths, and so the scale of charts, are counted in digits of this font.
            "default_format_properties": {**FIXED_FONT, "font_size": BOOK_FONT_SIZE},
            "strings_to_formulas": False,
            "strings_to_urls": False,
            "strings_to_numbers": False,
        },
    )
    book.set_properties({"author": f"grasp_xl {__version__}", "created": created})
    return book


def _inputs(task: Task) -> dict[str, CellValue]:
    """Return the inputs that the helper cells watch, by defined name."""
    part = task.space.part
    inputs: dict[str, CellValue] = {
        "PartMass": part.mass_g,
        **{f"Centroid{axis}": float(part.centroid_mm[n]) for n, axis in enumerate("XYZ")},
        "ScaleFactor": task.space.scale_factor,
        **parameter_values(task),
    }
    for labels, kind in zip(layout.KINDS, task.space.kinds, strict=True):
        counts = (kind.count_min, kind.count_max)
        data = (*counts, kind.force_n, kind.price, kind.weight_g, kind.total)
        suffixes = ("Min", "Max", "Force", "Price", "Weight", "Total")
        for suffix, value in zip(suffixes, data, strict=True):
            inputs[labels.field(suffix)] = value
        inputs[labels.diameter.name] = kind.diameter_mm
    return inputs
