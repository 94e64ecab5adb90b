"""An earlier run's state, read back from its workbook for ``--continue``."""

from __future__ import annotations

import json
from contextlib import suppress
from dataclasses import dataclass

import numpy as np

from grasp_xl.chromosome import BLANK_GENE, Chromosome
from grasp_xl.errors import InputError, Problem
from grasp_xl.search.result import State, Trace, gene_columns, load_stream
from grasp_xl.space import IntArray, OptionSpace
from grasp_xl.task import Task
from grasp_xl.workbook import layout, run_log
from grasp_xl.workbook.cells import Source, Value
from grasp_xl.workbook.history_sheet import MAX_HISTORY
from grasp_xl.workbook.inputs import changed_inputs
from grasp_xl.workbook.layout import Area, Field
from grasp_xl.workbook.reading_ga import find_block

DESIGNS_LISTED = "Valid designs listed"
CHANGES_LISTED = "Changes listed in the history"
"""Labels of the run log."""

UNREADABLE = (ValueError, TypeError, IndexError, KeyError, OverflowError, RecursionError)
"""What reading a run raises where somebody changed it."""


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
        found = f"a run log, history or list of designs that was edited ({error})"
        raise _no_run(source, found, "run it without --continue") from error
    return saved


def shown_run(source: Source, space: OptionSpace) -> SavedRun | None:
    """Read a run as a workbook shows it, though somebody may have sorted or cut its lists."""
    with suppress(*UNREADABLE):
        return _saved_run(source, space, logged_values(source))
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
        raise ValueError(f"no block {block.label!r}")
    return _genes(source, area)


def _no_run(source: Source, found: str, hint: str) -> InputError:
    expected = "a workbook with a run to go on from"
    return InputError([Problem(source.package.name, found, expected, hint)])


def _saved_run(source: Source, space: OptionSpace, logged: dict[str, Value]) -> SavedRun:
    children = [
        source.names[name]
        for number in range(1, 1 + len(source.names))
        if (name := f"Child{number}") in source.names
    ]
    return SavedRun(
        state=_state(source, space, logged),
        matrix=genes_as_they_stand(source, layout.MATRIX_BLOCK),
        children=tuple(_checked(space, _genes(source, area)) for area in children),
    )


def _state(source: Source, space: OptionSpace, logged: dict[str, Value]) -> State:
    def named(name: str) -> Value:
        return source.value(source.names[name])

    random_state, best_text = str(named(run_log.RANDOM_STATE)), named(run_log.BEST_GRASP)
    load_stream(random_state)
    best = _checked(space, np.array(json.loads(str(best_text)))) if best_text else None
    listed = logged[CHANGES_LISTED]
    changes = _trace(source, space, layout.HISTORY, layout.HISTORY_ROW, listed)
    if _whole(listed) >= MAX_HISTORY:
        changes = _without_repeat(changes)
    generation = _whole(named(run_log.GENERATIONS_DONE))
    if generation and not len(changes):
        raise ValueError("an empty history")
    designs = _trace(source, space, layout.VALID_DESIGNS, layout.TABLE_ROW, logged[DESIGNS_LISTED])
    parent = _checked(space, genes_as_they_stand(source, layout.PARENT_BLOCK))
    return State(
        generation=generation,
        evaluations=_whole(named(run_log.EVALUATIONS)),
        parent=parent,
        random_state=random_state,
        random_chromosome=_checked(space, genes_as_they_stand(source, layout.RANDOM_BLOCK)),
        initial=_checked(space, genes_as_they_stand(source, layout.INITIAL_BLOCK)),
        changes=changes,
        designs=designs,
        best=best,
        improved_at=_whole(named(run_log.BEST_FOUND_AT)) if best else 0,
        earlier_designs=_whole(named(run_log.DESIGNS_FOUND)) - len(designs),
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
    changes, parent = state.changes, state.parent.genes
    n = len(changes)
    gaps = _whole(logged[CHANGES_LISTED]) >= MAX_HISTORY
    repeated = state.best and n > 1 and np.array_equal(changes.genes[-2], parent)
    faults = {
        "a row of the designs is missing": len(state.designs) != logged[DESIGNS_LISTED],
        "a row of the history is missing": not gaps and (repeated or n != logged[CHANGES_LISTED]),
        "the history does not begin": n and not gaps and changes.generation[0] != 1,
        "the history does not end with the parent": n and (changes.genes[-1] != parent).any(),
        "a list was sorted": any(
            (np.diff(trace.generation) <= 0).any() for trace in (changes, state.designs)
        ),
    }
    for fault, found in faults.items():
        if found:
            raise ValueError(fault)


def _whole(value: Value) -> int:
    if isinstance(value, bool) or not isinstance(value, int | float) or value != int(value):
        raise ValueError(f"{value!r} is no whole number")
    return int(value)


def _gene(value: Value) -> int:
    return BLANK_GENE if value is None else _whole(value)


def _genes(source: Source, area: Area) -> IntArray:
    return np.array(
        [
            [_gene(source.value(area.cell(row, column))) for column in range(area.columns)]
            for row in range(area.rows)
        ]
    )


def _checked(space: OptionSpace, genes: IntArray) -> Chromosome:
    """Make a chromosome, sure that the option space has all its genes: the kernels trust it."""
    shape = (len(space.kinds), 1 + space.gene_slots)
    if genes.shape != shape:
        raise ValueError(f"genes of shape {genes.shape}, not {shape}")
    for row, kind in zip(genes, space.kinds, strict=True):
        low = 1 if kind.total else BLANK_GENE
        if not (0 <= row[0] <= kind.most and ((low <= row[1:]) & (row[1:] <= kind.total)).all()):
            raise ValueError(f"{kind.name} genes {row.tolist()} out of range")
    return Chromosome(genes)


def _trace(source: Source, space: OptionSpace, sheet: str, header_row: int, listed: Value) -> Trace:
    """Read generations and genes from a table; its gene columns are found by their labels."""
    grid = source.grid(sheet)
    header = [str(value) for value in grid.rows[header_row]]
    names = {labels.kind: labels.row_label for labels in layout.KINDS}
    columns = [header.index(names.get(name, name)) for name in gene_columns(space)]
    generations, genes = [], []
    for row in range(header_row + 1, header_row + 1 + _whole(listed)):
        if grid.at(row, 0) is not None:
            generations.append(_whole(grid.at(row, 0)))
            genes.append([_gene(grid.at(row, column)) for column in columns])
    shape = (len(genes), len(space.kinds), 1 + space.gene_slots)
    chromosomes = np.array(genes, dtype=np.int64).reshape(shape)
    for chromosome in chromosomes:
        _checked(space, chromosome)
    return Trace(np.array(generations, dtype=np.int64), chromosomes)
