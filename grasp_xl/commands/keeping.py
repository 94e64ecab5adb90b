"""What a workbook that is replaced holds of the designer's, and of its own run."""

import re
from contextlib import suppress
from dataclasses import replace
from pathlib import Path

import numpy as np

from grasp_xl.chromosome import is_usable
from grasp_xl.commands.output import Output, not_begun, now, written_book
from grasp_xl.errors import InfeasibleError, InputError, OutputError, Problem
from grasp_xl.search.mutation import random_chromosome
from grasp_xl.search.result import Result
from grasp_xl.space import ElementKind, FloatArray
from grasp_xl.task import Task, settle
from grasp_xl.workbook import layout
from grasp_xl.workbook.book import Book
from grasp_xl.workbook.inputs import changed_inputs, trade_off_rows
from grasp_xl.workbook.losses import Written, losses, sheet_gone
from grasp_xl.workbook.picker import NO_PICKS
from grasp_xl.workbook.proved import Proved
from grasp_xl.workbook.reading import open_source
from grasp_xl.workbook.reading_ga import find_block, find_ga_sheet
from grasp_xl.workbook.reading_run import (
    SavedRun,
    largest_listed,
    logged_values,
    refuse_other_inputs,
    shown_proof,
    written_children,
)
from grasp_xl.workbook.saving import MACRO_SUFFIX
from grasp_xl.workbook.stamp import is_untouched
from grasp_xl.workbook.trade_offs_sheet import TradeOffs
from grasp_xl.workbook.writing import export_workbook

ALMOST_NONE = 1e-9
"""A factor of safety and a clearance that every grasp has."""


def replaced_in_place(output: Output, previous: Book) -> list[Problem]:
    """Refuse to replace a workbook that holds something which is not ours, before any search.

    Returns
    -------
    list of Problem
        What is lost, where the person wants that.

    Raises
    ------
    OutputError
        Naming everything that would be lost, or the sheet without which that cannot be told.
    """
    target = output.path
    keeps_macros = target.suffix.lower() == MACRO_SUFFIX
    macros = ["the buttons and macros"] if previous.macros and not keeps_macros else []
    if previous.package is None or (previous.is_untouched and not macros):
        return []
    written = as_written(previous)
    gone = sheet_gone(previous.source, written)
    if gone and not output.force:
        raise OutputError(
            f"{target} has no sheet {gone!r} any more, so it cannot be told what else in it is "
            "not of the last run. Nothing was written.",
            where=str(target),
            hint=f"Give that sheet the name {gone!r} again, write to another file with -o, "
            "or add --force to lose what a run does not write",
        )
    lost = [] if gone else [*losses(previous.package, previous.source, written), *macros]
    if lost and not output.force:
        raise OutputError(
            f"{target} holds what the new workbook would not: {'; '.join(lost)}. "
            "Nothing was written.",
            where=str(target),
            hint="Write to another file with -o, or add --force to lose it",
        )
    return _lost(target, lost)


def replaced(output: Output) -> list[Problem]:
    """Refuse to replace another file than the input that is not just as we wrote it.

    Returns
    -------
    list of Problem
        Which sheets of others are lost, where the person wants that.

    Raises
    ------
    OutputError
        Naming the sheets.
    """
    target = output.path
    if not target.exists() or is_untouched(target):
        return []
    sheets: list[str] = []
    with suppress(InputError):
        sheets = [f"the sheet {name!r}" for name in open_source(target).foreign_sheets]
    if output.force:
        return _lost(target, sheets)
    with_sheets = f", with {', '.join(sheets)}" if sheets else ""
    raise OutputError(
        f"{target} exists{with_sheets} and was edited since grasp_xl wrote it (or never was ours), "
        "so nothing was written.",
        where=str(target),
        hint="Add --force to replace it, or name another file with -o",
    )


def _lost(target: Path, lost: list[str]) -> list[Problem]:
    """Warn of what a file held that is gone."""
    found = f"{'; '.join(lost)} before it was replaced"
    hint = "as --force was given, that is lost"
    return [Problem(str(target), found, "only what grasp_xl writes", hint)] if lost else []


def as_written(book: Book) -> Written:
    """Write a workbook again as it was, with its own cards and results, to know what is ours."""
    if find_ga_sheet(book.source) is None:  # an export
        return Written(export_workbook(book.space, book.part), same_inputs=False)
    task = _task_of_its_run(book)
    same_inputs = task is not None
    was = replace(book, what_if=None) if task else _of_its_sizes(book)
    if task is None:
        any_grasp = random_chromosome(was.space, np.random.default_rng(0))
        task = settle(was.space, was.parameters, any_grasp)
    shown = was.shown_run()
    result = not_begun(task, shown.state if shown else None)
    if shown:
        children = written_children(book.source, task.space) or shown.children
        result = replace(result, matrix=shown.matrix, children=children)
    proved = shown_proof(book.source, task)
    written = written_book(
        task, result, was, now(), proved=proved, trade_offs=was.trade_offs, macros=book.macros
    )
    return Written(written, same_inputs)


def _task_of_its_run(book: Book) -> Task | None:
    """Return the task of the run that a workbook holds; None if inputs or lists changed since."""
    user = book.user_chromosome
    if user is None or is_usable(user, book.space):
        with suppress(InfeasibleError, InputError):
            task = settle(book.space, book.parameters, user, book.assigned)
            saved_run_of(book, task)
            return task
    return None


def cards(book: Book) -> int:
    """Return the number of child cards; the names of some may be gone."""
    found = (re.fullmatch(r"Child(\d+)", name) for name in book.source.names)
    return max((int(each[1]) for each in found if each), default=0)


def _of_its_sizes(book: Book) -> Book:
    """Return a book with the sizes of its cards and lists, whatever it asks for now.

    Its designs met FoS and clearance of their run, and have no numbers where those of now fail.
    """
    names = book.source.names
    children = cards(book)
    block, corners = find_block(book.source, layout.USER_BLOCK), names.get(layout.IDEAL_POLYGON)
    slots = block.columns - 1 if block else book.space.gene_slots
    kinds = (
        replace(
            _with_places(kind, largest_listed(book.source, kind.name)),
            count_min=min(kind.count_min, slots),
            count_max=slots,
        )
        for kind in book.space.kinds
    )
    return replace(
        book,
        space=replace(
            book.space,
            kinds=tuple(kinds),
            approximation_polygon_mm=_any_polygon(
                corners.rows if corners else len(book.space.approximation_polygon_mm)
            ),
        ),
        parameters=replace(
            book.parameters, children=max(2, children), fos=ALMOST_NONE, clearance_mm=ALMOST_NONE
        ),
        user_chromosome=None,
        assigned=None,
        what_if=None,
        picks=NO_PICKS,
    )


def _any_polygon(corners: int) -> FloatArray:
    angles = np.linspace(0, 2 * np.pi, corners, endpoint=False)
    return np.column_stack([np.cos(angles), np.sin(angles), np.zeros(corners)])


def _with_places(kind: ElementKind, number: int) -> ElementKind:
    """Return a kind with so many places at least, as it had when its lists were written."""
    gone = np.zeros((max(0, number - kind.total), 3))
    overlap = kind.overlap
    if overlap is not None:
        overlap = np.concatenate([overlap, np.full(len(gone), np.nan)])
    footprints = np.vstack([kind.footprints_mm, gone])
    return replace(kind, footprints_mm=footprints, overlap=overlap)


def kept_trade_offs(book: Book, task: Task) -> tuple[TradeOffs | None, list[Problem]]:
    """Return the trade-offs of a workbook; none, and a warning, where they are of other inputs."""
    if book.trade_offs is None:
        return None, []
    changed = changed_inputs(task, logged_values(book.source), trade_off_rows(task))
    if not changed:
        return book.trade_offs, []
    found = f"designs of other inputs: {'; '.join(changed)}"
    hint = "the sheet is left out; make it anew with grasp-xl front"
    return None, [Problem(f"sheet {layout.TRADE_OFFS!r}", found, "those of the workbook", hint)]


def held_run(book: Book, task: Task) -> tuple[Result, Proved | None]:
    """Return the run and the proof of this task that a workbook holds, else a run not begun."""
    with suppress(InputError):
        saved = saved_run_of(book, task)
        result = not_begun(task, saved.state)
        result = replace(result, matrix=saved.matrix, children=saved.children)
        return result, shown_proof(book.source, task)
    return not_begun(task), None


def saved_run_of(book: Book, task: Task) -> SavedRun:
    """Return the run that a workbook holds.

    Raises
    ------
    InputError
        If it is not a run of this task.
    """
    refuse_other_inputs(book.source, task)
    return book.saved_run()
