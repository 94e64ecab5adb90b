"""Everything that a study's runs went through as one long table: a row a change of a fittest."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from importlib.util import find_spec
from itertools import islice
from pathlib import Path
from typing import IO, TYPE_CHECKING

import numpy as np

from grasp_xl.errors import UsageError
from grasp_xl.search.result import empty_trace, gene_columns, measured_rows
from grasp_xl.study.plan import Case, Plan, Trial
from grasp_xl.study.trial import Record
from grasp_xl.workbook.saving import replacing

if TYPE_CHECKING:
    import pandas as pd

CSV, PARQUET = ".csv", ".parquet"
SUFFIXES = (CSV, PARQUET)
"""How the name of such a file may end."""

RUN_TYPES = {
    "case": "string",
    "part": "string",
    "variant": "int64",
    "scenario": "string",
    "run": "int64",
    "label": "string",
    "seed": "int64",
}
"""Types of the columns that tell a run, so that every part of a table has the same."""
RUN_COLUMNS = tuple(RUN_TYPES)
"""What tells a run; the varied parameters follow."""

RENAMED = {"fos": "required_fos"}
"""Columns of varied parameters whose own names are those of a criterion."""

RUNS_AT_ONCE = 200
"""Runs that are written together: memory stays small whatever the size of a study."""


def check_format(path: Path) -> None:
    """Refuse a format that cannot be written here, before any work is done.

    Raises
    ------
    UsageError
        If the package is missing that writes it.
    """
    if path.suffix.lower() != PARQUET:
        return
    if find_spec("pyarrow") is None:
        raise UsageError(
            f"{path}: .parquet files need the package pyarrow, which is not installed.",
            where="--data",
            hint='Install it with pip install "grasp_xl[parquet]", or name a .csv file',
        )


def write_data(path: Path, plan: Plan, runs: Iterable[tuple[Trial, Record]]) -> None:
    """Write the runs; the file is there whole or not at all.

    Columns are ``RUN_COLUMNS``, one for each varied parameter, and what
    :func:`~grasp_xl.search.result.measured_rows` says of the fittest from a generation on; the last
    row of a run is its last generation.

    Parameters
    ----------
    path : Path
        Its name ends in ``.csv`` or ``.parquet``.
    plan : Plan
    runs : iterable of (Trial, Record)

    Raises
    ------
    OutputError
        If it cannot be written; the file that stood there is then as it was.
    """
    write = _write_parquet if path.suffix.lower() == PARQUET else _write_csv
    with replacing(path) as file:
        write(file, _parts(plan, runs))


def _parts(plan: Plan, runs: Iterable[tuple[Trial, Record]]) -> Iterator[pd.DataFrame]:
    """Give the table in parts, all with the same columns; one without rows if there is no run."""
    import pandas as pd

    varied = list(dict.fromkeys(name for case in plan.cases for name in _varied(case)))
    widest = max((case.task.space for case in plan.cases), key=lambda space: space.gene_slots)
    genes = gene_columns(widest)
    types = RUN_TYPES | dict.fromkeys(varied, "string") | dict.fromkeys(genes, "Int64")

    def part(tables: list[pd.DataFrame]) -> pd.DataFrame:
        table = pd.concat(tables, ignore_index=True)
        measured = [name for name in table if name not in types]
        table = table.reindex(columns=[*RUN_COLUMNS, *varied, *measured, *genes])
        return table.astype(types)

    waiting = iter(runs)
    some = list(islice(waiting, RUNS_AT_ONCE))
    if not some:
        yield part([_without_rows(plan.cases[0])])
    while some:
        yield part([_table(plan, *run) for run in some])
        some = list(islice(waiting, RUNS_AT_ONCE))


def _varied(case: Case) -> dict[str, str]:
    """Return the columns of the varied parameters, and their values."""
    return {RENAMED.get(name, name): value for name, value in case.varied}


def _without_rows(case: Case) -> pd.DataFrame:
    import pandas as pd

    space = case.task.space
    return pd.DataFrame(measured_rows(space, case.task.rules, empty_trace(space)))


def _table(plan: Plan, trial: Trial, record: Record) -> pd.DataFrame:
    """Return one run: a row a change, and its last generation."""
    import pandas as pd

    case = plan.cases[trial.case]
    rows = measured_rows(case.task.space, case.task.rules, record.changes)
    if len(rows) and rows["generation"][-1] != record.done:
        rows = np.append(rows, rows[-1:])
        rows["generation"][-1] = record.done
    table = pd.DataFrame(rows)
    told: tuple[str | int, ...] = (
        case.label,
        case.name,
        case.variant,
        trial.scenario,
        trial.number,
        trial.label,
        trial.seed,
    )
    for name, value in (*zip(RUN_COLUMNS, told, strict=True), *_varied(case).items()):
        table[name] = value
    return table


def _write_csv(file: IO[bytes], parts: Iterable[pd.DataFrame]) -> None:
    for number, part in enumerate(parts):
        file.write(part.to_csv(index=False, header=number == 0, lineterminator="\n").encode())


def _write_parquet(file: IO[bytes], parts: Iterable[pd.DataFrame]) -> None:
    import pyarrow as pa
    import pyarrow.parquet as pq

    writer: pq.ParquetWriter | None = None
    try:
        for part in parts:
            table = pa.Table.from_pandas(part, preserve_index=False)
            writer = writer or pq.ParquetWriter(file, table.schema)
            writer.write_table(table.cast(writer.schema))
    finally:
        if writer:
            writer.close()
