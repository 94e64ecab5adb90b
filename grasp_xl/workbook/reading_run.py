"""An earlier run's state, read back from its workbook for ``--continue``."""

from __future__ import annotations

import json
from dataclasses import dataclass

import numpy as np

from grasp_xl.chromosome import BLANK_GENE, Chromosome
from grasp_xl.errors import InputError, Problem
from grasp_xl.search.result import State, Trace, gene_columns, load_stream
from grasp_xl.space import OptionSpace
from grasp_xl.workbook import layout, run_log
from grasp_xl.workbook.cells import Source
from grasp_xl.workbook.reading_ga import find_block


@dataclass(frozen=True, eq=False, slots=True)
class SavedRun:
    """Where an earlier run stands, and the hash of what it was run on."""

    state: State
    inputs_hash: str


def read_saved_run(source: Source, space: OptionSpace) -> SavedRun:
    """Read the state of the run that a workbook holds.

    Raises
    ------
    InputError
        If it holds none, or its parts do not fit together.
    """
    if run_log.RANDOM_STATE not in source.names:
        raise _no_run(source, "no run", "run it once without --continue")
    try:
        state = _state(source, space)
    except (ValueError, TypeError, IndexError, KeyError) as error:
        raise _no_run(
            source, f"a damaged run log or history ({error})", "run it without --continue"
        ) from error
    return SavedRun(state, str(source.value(source.names[run_log.INPUTS_HASH])))


def _no_run(source: Source, found: str, hint: str) -> InputError:
    expected = "a workbook with a run to go on from"
    return InputError([Problem(source.package.name, found, expected, hint)])


def _state(source: Source, space: OptionSpace) -> State:
    def logged(name: str) -> object:
        return source.value(source.names[name])

    random_state = str(logged(run_log.RANDOM_STATE))
    load_stream(random_state)
    generation = _whole(logged(run_log.GENERATIONS_DONE))
    best_text = logged(run_log.BEST_GRASP)
    best = _checked(space, np.array(json.loads(str(best_text)))) if best_text else None
    designs = _trace(source, space, layout.VALID_DESIGNS, layout.TABLE_ROW)
    return State(
        generation=generation,
        evaluations=_whole(logged(run_log.EVALUATIONS)),
        parent=_block(source, space, layout.PARENT_BLOCK),
        random_state=random_state,
        random_chromosome=_block(source, space, layout.RANDOM_BLOCK),
        initial=_block(source, space, layout.INITIAL_BLOCK),
        changes=_real_changes(_trace(source, space, layout.HISTORY, layout.HISTORY_ROW)),
        designs=designs,
        best=best,
        improved_at=_whole(logged(run_log.BEST_FOUND_AT)) if best else 0,
        earlier_designs=_whole(logged(run_log.DESIGNS_FOUND)) - len(designs),
    )


def _whole(value: object) -> int:
    if isinstance(value, bool) or not isinstance(value, int | float) or value != int(value):
        raise ValueError(f"{value!r} is no whole number")
    return int(value)


def _block(source: Source, space: OptionSpace, block: layout.Field) -> Chromosome:
    area = find_block(source, block)
    if area is None:
        raise ValueError(f"no block {block.label!r}")
    values = [
        [source.value(area.cell(row, column)) for column in range(area.columns)]
        for row in range(area.rows)
    ]
    return _checked(space, np.array([[_gene(value) for value in row] for row in values]))


def _gene(value: object) -> int:
    return BLANK_GENE if value is None else _whole(value)


def _checked(
    space: OptionSpace, genes: np.ndarray[tuple[int, ...], np.dtype[np.int64]]
) -> Chromosome:
    """Make a chromosome, sure that the option space has all its genes: the kernels trust it."""
    shape = (len(space.kinds), 1 + space.gene_slots)
    if genes.shape != shape:
        raise ValueError(f"genes of shape {genes.shape}, not {shape}")
    for row, kind in zip(genes, space.kinds, strict=True):
        low = 1 if kind.total else BLANK_GENE
        if not (0 <= row[0] <= kind.most and ((low <= row[1:]) & (row[1:] <= kind.total)).all()):
            raise ValueError(f"{kind.name} genes {row.tolist()} out of range")
    return Chromosome(genes)


def _trace(source: Source, space: OptionSpace, sheet: str, header_row: int) -> Trace:
    """Read generations and genes from a table; its gene columns are found by their labels."""
    grid = source.grid(sheet)
    header = [str(value) for value in grid.rows[header_row]]
    names = {labels.kind: labels.row_label for labels in layout.KINDS}
    columns = [header.index(names.get(name, name)) for name in gene_columns(space)]
    generations, genes = [], []
    row = header_row + 1
    while (value := grid.at(row, 0)) is not None:
        generations.append(_whole(value))
        genes.append([_gene(grid.at(row, column)) for column in columns])
        row += 1
    shape = (len(genes), len(space.kinds), 1 + space.gene_slots)
    rows = np.array(genes, dtype=np.int64).reshape(shape)
    for chromosome in rows:
        _checked(space, chromosome)
    return Trace(np.array(generations, dtype=np.int64), rows)


def _real_changes(history: Trace) -> Trace:
    """Drop the last row of a history where it only repeats the fittest for the last generation."""
    if len(history) > 1 and np.array_equal(history.genes[-1], history.genes[-2]):
        return Trace(history.generation[:-1], history.genes[:-1])
    return history
