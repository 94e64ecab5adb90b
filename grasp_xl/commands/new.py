"""How ``new`` makes a workbook, or takes a new export into one."""

from dataclasses import replace
from pathlib import Path

from grasp_xl.chromosome import Chromosome
from grasp_xl.commands.keeping import kept_trade_offs, refuse_to_lose
from grasp_xl.commands.output import Output, not_begun, now, written_book
from grasp_xl.commands.preparing import Active, prepare
from grasp_xl.errors import InputError, Problem
from grasp_xl.task import Parameters, Task
from grasp_xl.workbook import layout
from grasp_xl.workbook.book import Book, read_book, read_previous
from grasp_xl.workbook.carrying import carried, is_usable
from grasp_xl.workbook.saving import (
    check_target,
    refuse_edited,
    save,
)


def make_workbook(
    path: Path, options: Parameters, output: Output, grasp: Active = (None, None)
) -> Task:
    """Make the full workbook from an exported sheet, ready for a designer.

    Where the output is a workbook already, its parameters and typed chromosomes stay, and all that
    is stale in them now is among the task's warnings.
    """
    began = now()
    check_target(output.path, path, in_place=False, force=output.force)
    book = read_book(path)
    previous = _previous(output)
    stale: list[Problem] = []
    if previous:
        book, stale = _taken_over(book, previous)
    else:
        refuse_edited(output.path, force=output.force)
    usable = book.user_chromosome and is_usable(book.user_chromosome, book.space)
    task = prepare(book if usable else replace(book, user_chromosome=None), options, grasp)
    trade_offs, left_out = kept_trade_offs(previous or book, task)
    task = replace(task, warnings=(*task.warnings, *stale, *left_out))
    if previous:
        refuse_to_lose(output, previous)
    content, _ = written_book(task, not_begun(task), book, began, trade_offs=trade_offs)
    save(content, output.path)
    return task


def _previous(output: Output) -> Book | None:
    """Return the workbook that stands where the new one goes, if it is a full one."""
    try:
        return read_previous(output.path)
    except InputError as error:
        if output.force:
            return None
        name = output.path.name
        hint = "mend it, name another file with -o, or add --force to replace this one"
        problems = [replace(p, where=f"{name}, {p.where}", hint=hint) for p in error.problems]
        raise InputError(problems) from error


def _taken_over(book: Book, previous: Book) -> tuple[Book, list[Problem]]:
    """Return a new export's book with what the designer typed into the previous workbook."""
    stale: list[Problem] = []
    typed: list[Chromosome | None] = []
    for chromosome, block in (
        (previous.user_chromosome, layout.USER_BLOCK),
        (previous.what_if or previous.picks.trade_off or previous.picks.design, layout.WHAT_IF),
    ):
        genes = None
        if chromosome:
            genes, faults = carried(chromosome, previous.space, book.space, block.label)
            stale += faults
        typed.append(genes)
    user, what_if = typed
    if what_if and not is_usable(what_if, book.space):
        what_if = None
    taken = replace(book, parameters=previous.parameters, user_chromosome=user, what_if=what_if)
    return taken, stale
