"""An earlier run's state, read back from its workbook for ``--continue``."""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from typing import get_args

import numpy as np

from grasp_xl.chromosome import BLANK_GENE, Chromosome
from grasp_xl.errors import InputError, Problem
from grasp_xl.grasp import evaluate
from grasp_xl.search.exact import Proof, Status
from grasp_xl.search.result import State, Trace, gene_columns, load_stream
from grasp_xl.space import IntArray, OptionSpace
from grasp_xl.task import Task
from grasp_xl.workbook import layout, run_log
from grasp_xl.workbook.calc_block import CalcBlock
from grasp_xl.workbook.cells import Source, Value, cells_of, is_blank
from grasp_xl.workbook.history_sheet import MAX_HISTORY
from grasp_xl.workbook.inputs import changed_inputs, genes_of_text
from grasp_xl.workbook.layout import Area, Field
from grasp_xl.workbook.proved import Proved
from grasp_xl.workbook.reading_ga import find_block

DESIGNS_LISTED = "Valid designs listed"
CHANGES_LISTED = "Changes listed in the history"
"""Labels of the run log."""

GENERATION = "Generation"
"""Header of the lists' column that says when."""

LISTS = {
    layout.VALID_DESIGNS: layout.TABLE_ROW,
    layout.TRADE_OFFS: layout.TABLE_ROW,
    layout.HISTORY: layout.HISTORY_ROW,
}
"""Sheets of the lists with genes, and their header rows."""

UNREADABLE = (ValueError, TypeError, IndexError, KeyError, OverflowError, RecursionError)
"""What reading a run raises where somebody changed it."""


class EditedError(ValueError):
    """What no run has written, in words for a person."""


@contextmanager
def _reading(part: str) -> Iterator[None]:
    """Name the part of a workbook that cannot be read."""
    try:
        yield
    except EditedError as error:
        raise EditedError(f"{part}: {error}") from error
    except UNREADABLE as error:
        raise EditedError(f"{part} cannot be read") from error


@dataclass(frozen=True, eq=False, slots=True)
class SavedRun:
    """Where an earlier run stands.

    Parameters
    ----------
    state : State
    matrix : IntArray
        Mutation matrix of its last generation.
    children : tuple of Chromosome
        Children of its last generation.
    """

    state: State
    matrix: IntArray
    children: tuple[Chromosome, ...]


def logged_values(source: Source) -> dict[str, Value]:
    """Read all values of the run log, by label; none where there is no run log."""
    if run_log.RANDOM_STATE not in source.names:
        return {}
    rows = source.grid(source.names[run_log.RANDOM_STATE].sheet).rows.values()
    return {str(values[0]): values[1] for values in rows if len(values) > 1}


def refuse_other_inputs(source: Source, task: Task) -> None:
    """Refuse to go on from a run that was on other inputs than those of a task.

    Raises
    ------
    InputError
        Naming the inputs that differ.
    """
    logged = logged_values(source)
    changed = changed_inputs(task, logged) if logged else []
    if changed:
        found = f"inputs that changed since its run: {'; '.join(changed)}"
        raise _no_run(source, found, "undo the changes, or run it without --continue")


def read_saved_run(source: Source, space: OptionSpace) -> SavedRun:
    """Read the state of the run that a workbook holds.

    Raises
    ------
    InputError
        If it holds none, or its parts do not fit together.
    """
    logged = logged_values(source)
    if not logged:
        raise _no_run(source, "no run", "run it once without --continue")
    try:
        saved = _saved_run(source, space, logged)
        _check(saved.state, logged)
    except UNREADABLE as error:
        told = f" ({error})" if isinstance(error, EditedError) else ""
        found = f"a run log, history or list of designs that was edited{told}"
        raise _no_run(source, found, "run it without --continue") from error
    return saved


def shown_run(source: Source, space: OptionSpace) -> SavedRun | None:
    """Read a run as a workbook shows it, though somebody may have sorted or cut its lists."""
    with suppress(*UNREADABLE):
        return _saved_run(source, space, logged_values(source))
    return None


def shown_proof(source: Source, task: Task) -> Proved | None:
    """Read what a workbook shows of the exact search; None where it shows nothing.

    Where the option space no longer has its grasp, the benchmark stands for it.
    """

    def logged(name: str) -> Value:
        return source.value(source.names[name])

    with suppress(*UNREADABLE):
        text, grasp = logged(run_log.PROVED_GRASP), None
        if text:
            grasp = task.benchmark
            with suppress(*UNREADABLE):
                genes = _checked(task.space, genes_of_text(text))
                grasp = evaluate(task.space, task.rules, genes)
        status = {str(status): status for status in get_args(Status)}[
            str(logged(run_log.PROOF_STATUS))
        ]
        bound, seconds = (
            float(str(logged(name))) for name in (run_log.PROOF_BOUND, run_log.PROOF_SECONDS)
        )
        proof = Proof(status, bound, (grasp,) if grasp else (), seconds, nodes=0)
        return Proved(proof, str(logged(run_log.PROOF_AMONG)), str(logged(run_log.PROOF_ENDED)))
    return None


def genes_as_they_stand(source: Source, block: Field) -> IntArray:
    """Read the genes of a chromosome block, also those that no option space has.

    Raises
    ------
    ValueError
        If there is no such block, or something else than whole numbers in it.
    """
    area = find_block(source, block)
    if area is None:
        raise EditedError(f"no block {block.label!r}")
    cells = (cell for row in cells_of(area) for cell in row)
    if any(is_blank(source.value(cell)) and not source.blank(cell) for cell in cells):
        raise EditedError("a formula without a stored value")
    return _genes(source, area)


def largest_listed(source: Source, kind: str) -> int:
    """Return the largest index of a kind among the genes of the lists, also one that is gone."""
    found = [0]
    for sheet, header_row in LISTS.items():
        rows = source.grid(sheet).rows if sheet in source.sheets else {}
        genes = re.compile(rf"{kind[0].upper()}\d+")
        for column, label in enumerate(rows.get(header_row, ())):
            if genes.fullmatch(str(label)):
                cells = [row[column] for row in rows.values() if column < len(row)]
                found += [int(cell) for cell in cells if isinstance(cell, int | float)]
    return max(found)


def written_children(source: Source, space: OptionSpace) -> tuple[Chromosome, ...]:
    """Return the children as we wrote them, though somebody may have typed over their cards.

    There are none of them where the helper sheet is not as it was.
    """
    with suppress(*UNREADABLE):
        blocks = [CalcBlock(1 + n, space.gene_slots, area) for n, area in enumerate(_cards(source))]
        return tuple(_checked(space, _genes(source, block.engine_genes)) for block in blocks)
    return ()


def _cards(source: Source) -> list[Area]:
    """Return the genes of the child cards.

    Raises
    ------
    ValueError
        If the name of one is gone.
    """
    named = [f"Child{number}" for number in range(1, 1 + layout.MAX_CHILDREN)]
    cards = [source.names.get(name) for name in named]
    while cards and cards[-1] is None:
        cards.pop()
    found = [card for card in cards if card]
    if len(found) < len(cards):
        raise EditedError(f"the name {named[cards.index(None)]} is missing")
    return found


def _no_run(source: Source, found: str, hint: str) -> InputError:
    expected = "a workbook with a run to go on from"
    return InputError([Problem(source.name, found, expected, hint)])


def _saved_run(source: Source, space: OptionSpace, logged: dict[str, Value]) -> SavedRun:
    return SavedRun(
        state=_state(source, space, logged),
        matrix=genes_as_they_stand(source, layout.MATRIX_BLOCK),
        children=tuple(_checked(space, _genes(source, area)) for area in _cards(source)),
    )


def _state(source: Source, space: OptionSpace, logged: dict[str, Value]) -> State:
    def cell(name: str) -> Area:
        if name not in source.names:
            raise EditedError(f"the name {name} is missing")
        return source.names[name]

    def number(name: str) -> int:
        with _reading(cell(name).where):
            return whole(source.value(cell(name)))

    random_state = str(source.value(cell(run_log.RANDOM_STATE)))
    with _reading(cell(run_log.RANDOM_STATE).where):
        load_stream(random_state)
    best_text = source.value(cell(run_log.BEST_GRASP))
    with _reading(cell(run_log.BEST_GRASP).where):
        best = _checked(space, genes_of_text(best_text)) if best_text else None
    listed = logged[CHANGES_LISTED]
    changes = _trace(source, space, layout.HISTORY, layout.HISTORY_ROW, listed)
    if whole(listed) >= MAX_HISTORY:
        changes = _without_repeat(changes)
    generation = number(run_log.GENERATIONS_DONE)
    if generation and not len(changes):
        raise EditedError("an empty history")
    designs = _trace(source, space, layout.VALID_DESIGNS, layout.TABLE_ROW, logged[DESIGNS_LISTED])
    parent = _checked(space, genes_as_they_stand(source, layout.PARENT_BLOCK))
    return State(
        generation=generation,
        evaluations=number(run_log.EVALUATIONS),
        parent=parent,
        random_state=random_state,
        random_chromosome=_checked(space, genes_as_they_stand(source, layout.RANDOM_BLOCK)),
        initial=_checked(space, genes_as_they_stand(source, layout.INITIAL_BLOCK)),
        changes=changes,
        designs=designs,
        best=best,
        improved_at=number(run_log.BEST_FOUND_AT) if best else 0,
        earlier_designs=number(run_log.DESIGNS_FOUND) - len(designs),
        complete_from=number(run_log.HISTORY_FROM),
    )


def _without_repeat(changes: Trace) -> Trace:
    """Drop a last row that only says that the fittest did not change up to the last generation."""
    if len(changes) > 1 and np.array_equal(changes.genes[-1], changes.genes[-2]):
        return Trace(changes.generation[:-1], changes.genes[:-1])
    return changes


def _check(state: State, logged: dict[str, Value]) -> None:
    """Check that the lists are whole, and that the history goes from generation 1 to the parent.

    A history that was too long for its sheet has gaps.
    """
    changes, parent, generation = state.changes, state.parent.genes, state.generation
    n = len(changes)
    gaps = state.complete_from > 1
    repeated = state.best and n > 1 and np.array_equal(changes.genes[-2], parent)
    faults = {
        "a row of the designs is missing": len(state.designs) != logged[DESIGNS_LISTED],
        "a row of the history is missing": not gaps and (repeated or n != logged[CHANGES_LISTED]),
        "the history does not begin": n and not gaps and changes.generation[0] != 1,
        "the history does not end with the parent": n and (changes.genes[-1] != parent).any(),
        "a list was sorted": any(
            (np.diff(trace.generation) <= 0).any() for trace in (changes, state.designs)
        ),
        "a list goes beyond the generations done": any(
            len(trace) and not 1 <= trace.generation[0] <= trace.generation[-1] <= generation
            for trace in (changes, state.designs)
        ),
        "other generations than a run can have": not 0 <= generation <= layout.MAX_GENERATIONS,
        "more evaluations than children, or less than none": not (
            0 <= state.evaluations <= generation * layout.MAX_CHILDREN
        ),
        "a best grasp of a generation that was not done": not (
            0 <= state.improved_at <= generation
        ),
        "a history from a generation that it does not have": not (
            state.complete_from == 1 or state.complete_from in changes.generation
        ),
        "less valid designs found than listed": state.earlier_designs < 0,
    }
    for fault, found in faults.items():
        if found:
            raise EditedError(fault)


def whole(value: Value) -> int:
    """Return a cell's value as a whole number.

    Raises
    ------
    ValueError
        If it is none.
    """
    if isinstance(value, bool) or not isinstance(value, int | float) or value != int(value):
        found = "an empty cell" if value is None else repr(value)
        raise EditedError(f"{found} is no whole number")
    return int(value)


def _gene(value: Value) -> int:
    return BLANK_GENE if value is None else whole(value)


def _genes(source: Source, area: Area) -> IntArray:
    with _reading(area.where):
        rows = [[_gene(source.value(cell)) for cell in row] for row in cells_of(area)]
    return np.array(rows)


def _checked(space: OptionSpace, genes: IntArray) -> Chromosome:
    """Make a chromosome, sure that the option space has all its genes: the kernels trust it."""
    shape = (len(space.kinds), 1 + space.gene_slots)
    if genes.shape != shape:
        raise EditedError(f"a grasp of other genes than {shape[0]} rows of {shape[1]}")
    _check_genes(space, genes[None])
    return Chromosome(genes)


def _check_genes(space: OptionSpace, grasps: IntArray) -> None:
    """Check the genes of many grasps, ``(n, kinds, 1 + slots)``."""
    for number, kind in enumerate(space.kinds):
        counts, indices = grasps[:, number, 0], grasps[:, number, 1:]
        low = 1 if kind.total else BLANK_GENE
        usable = (counts >= 0) & (counts <= kind.most)
        usable &= ((indices >= low) & (indices <= kind.total)).all(axis=1)
        if not usable.all():
            genes = grasps[int(np.argmin(usable)), number].tolist()
            raise EditedError(f"{kind.name} genes {genes} out of range")


def _trace(source: Source, space: OptionSpace, sheet: str, header_row: int, listed: Value) -> Trace:
    """Read generations and genes from a table; its gene columns are found by their labels."""
    if sheet not in source.sheets:
        raise EditedError(f"there is no sheet {sheet!r}")
    with _reading(f"sheet {sheet!r}"):
        grid = source.grid(sheet)
        header = [str(value) for value in grid.rows[header_row]]
        names = {labels.kind: labels.row_label for labels in layout.KINDS}
        columns = [header.index(names.get(name, name)) for name in gene_columns(space)]
        when = header.index(GENERATION)
        generations, genes = [], []
        for row in range(header_row + 1, header_row + 1 + whole(listed)):
            if grid.at(row, when) is not None:
                generations.append(whole(grid.at(row, when)))
                genes.append([_gene(grid.at(row, column)) for column in columns])
        shape = (len(genes), len(space.kinds), 1 + space.gene_slots)
        chromosomes = np.array(genes, dtype=np.int64).reshape(shape)
        _check_genes(space, chromosomes)
        return Trace(np.array(generations, dtype=np.int64), chromosomes)
