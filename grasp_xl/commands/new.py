"""How ``new`` makes a workbook, or takes a new export into one."""

from dataclasses import replace
from pathlib import Path

from grasp_xl.chromosome import Chromosome, is_usable
from grasp_xl.commands.keeping import kept_trade_offs, replaced, replaced_in_place
from grasp_xl.commands.output import Output, macros_at, not_begun, now, written_book
from grasp_xl.commands.preparing import Active, prepare
from grasp_xl.errors import InputError, Problem
from grasp_xl.task import Parameters, Task
from grasp_xl.workbook import layout
from grasp_xl.workbook.book import Book, read_book, read_previous
from grasp_xl.workbook.carrying import SetAside, carried
from grasp_xl.workbook.saving import check_target, save


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
    if previous:
        book, stale = _taken_over(book, previous)
    else:
        stale = replaced(output)
    task = prepare(book, options, grasp)
    trade_offs, left_out = kept_trade_offs(previous or book, task)
    lost = replaced_in_place(output, previous) if previous else []
    task = task.warned([*stale, *left_out, *lost])
    macros = macros_at(output.path, previous or book)
    result = not_begun(task)
    written = written_book(task, result, book, began, trade_offs=trade_offs, macros=macros)
    save(written.content, output.path)
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
    fitting: list[Chromosome | None] = []
    aside: list[Chromosome | None] = []
    before = previous.set_aside
    picked = previous.picks.trade_off or previous.picks.design
    for chromosome, block in (
        (previous.user_chromosome or before.user, layout.USER_BLOCK),
        (previous.what_if or picked or before.what_if, layout.WHAT_IF),
    ):
        genes, unfit = None, None
        if chromosome:
            genes, faults = carried(chromosome, previous.space, book.space, block.label)
            stale += faults
            if not is_usable(genes, book.space):
                genes, unfit = None, chromosome
        fitting.append(genes)
        aside.append(unfit)
    user, what_if = fitting
    taken = replace(
        book,
        parameters=previous.parameters,
        user_chromosome=user,
        what_if=what_if,
        set_aside=SetAside(*aside),
    )
    return taken, stale
