"""Everything that a study's runs went through as one long table: a row a change of a fittest."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterable, Iterator
from importlib.util import find_spec
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from grasp_xl.errors import OutputError, UsageError
from grasp_xl.search.result import gene_columns, measured_rows
from grasp_xl.study.plan import Plan, Trial
from grasp_xl.study.trial import Record

if TYPE_CHECKING:
    import pandas as pd

CSV, PARQUET = ".csv", ".parquet"
SUFFIXES = (CSV, PARQUET)
"""How the name of such a file may end."""

RUN_COLUMNS = ("case", "part", "variant", "scenario", "run", "label", "seed")
"""What tells a run; the varied parameters follow."""

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
    beside: Path | None = None
    try:
        with tempfile.NamedTemporaryFile(
            dir=path.parent, prefix=".grasp_xl-", suffix=".tmp", delete=False
        ) as file:
            beside = Path(file.name)
        write(beside, _parts(plan, runs))
        os.chmod(beside, 0o644)  # noqa: PTH101 (a temporary file is private)
        beside.replace(path)
    except OSError as error:
        raise OutputError(
            f"{path} cannot be written ({error.strerror}).",
            where=str(path),
            hint="Free some space, or name another folder with --data",
        ) from error
    finally:
        if beside:
            beside.unlink(missing_ok=True)


def _parts(plan: Plan, runs: Iterable[tuple[Trial, Record]]) -> Iterator[pd.DataFrame]:
    """Give the table in parts, all with the same columns."""
    import pandas as pd

    varied = list(dict.fromkeys(name for case in plan.cases for name, _ in case.varied))
    widest = max((case.task.space for case in plan.cases), key=lambda space: space.gene_slots)
    genes = gene_columns(widest)
    waiting = iter(runs)
    while some := list(islice(waiting, RUNS_AT_ONCE)):
        table = pd.concat([_table(plan, *run) for run in some], ignore_index=True)
        measured = [name for name in table if name not in (*RUN_COLUMNS, *varied, *genes)]
        table = table.reindex(columns=[*RUN_COLUMNS, *varied, *measured, *genes])
        yield table.astype(dict.fromkeys(genes, "Int64") | dict.fromkeys(varied, "string"))


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
    for name, value in (*zip(RUN_COLUMNS, told, strict=True), *case.varied):
        table[name] = value
    return table


def _write_csv(path: Path, parts: Iterable[pd.DataFrame]) -> None:
    with path.open("w", encoding="utf-8", newline="") as file:
        for number, part in enumerate(parts):
            part.to_csv(file, index=False, header=number == 0, lineterminator="\n")


def _write_parquet(path: Path, parts: Iterable[pd.DataFrame]) -> None:
    import pyarrow as pa
    import pyarrow.parquet as pq

    writer: pq.ParquetWriter | None = None
    try:
        for part in parts:
            table = pa.Table.from_pandas(part, preserve_index=False)
            writer = writer or pq.ParquetWriter(path, table.schema)
            writer.write_table(table.cast(writer.schema))
    finally:
        if writer:
            writer.close()
