"""The runs of a study that are done, in one file: each is there whole or not at all."""

from __future__ import annotations

import sqlite3
import zipfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Self

from grasp_xl.errors import InputError, OutputError, Problem
from grasp_xl.study.trial import Record

SUFFIX = ".runs"
"""What the file's name has in place of the study's ``.xlsx``."""

APPLICATION_ID = 0x67727370
"""By which our file is known from other SQLite databases."""

MAGIC = b"SQLite format 3\0"
SCHEMA = "CREATE TABLE IF NOT EXISTS runs (key TEXT PRIMARY KEY, record BLOB NOT NULL)"


def records_path(study: Path) -> Path:
    """Return where the runs of a study are kept: beside its workbook."""
    return study.with_suffix(SUFFIX)


def run_key(fingerprint: str, seed: int, scenario: str) -> str:
    """Return the key of a run: two runs with the same one have the same outcome."""
    return f"{fingerprint}/{scenario}/{seed}"


def _is_database(path: Path) -> bool:
    with path.open("rb") as file:
        return file.read(len(MAGIC)) == MAGIC


class Records:
    """The file, an SQLite database: its transactions survive a kill at any moment.

    Parameters
    ----------
    path : Path

    Raises
    ------
    InputError
        If it is some other file.
    OutputError
        If it cannot be written.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        with self._told():
            if path.exists() and path.stat().st_size and not _is_database(path):
                raise sqlite3.DatabaseError  # SQLite takes a short file for an empty one
            self._base = sqlite3.connect(path, isolation_level=None)
            (found,) = self._base.execute("PRAGMA application_id").fetchone()
            tables = self._base.execute("SELECT name FROM sqlite_master").fetchall()
            if tables and found != APPLICATION_ID:
                raise sqlite3.DatabaseError
            self._base.execute(f"PRAGMA application_id = {APPLICATION_ID}")
            self._base.execute("PRAGMA journal_mode = WAL")
            self._base.execute("PRAGMA synchronous = NORMAL")
            self._base.execute(SCHEMA)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Close the file, and take it away if it holds nothing."""
        empty = len(self) == 0
        self._base.close()
        if empty:
            self._path.unlink(missing_ok=True)

    def clear(self) -> None:
        """Forget all runs."""
        with self._told():
            self._base.execute("DELETE FROM runs")

    def __len__(self) -> int:
        with self._told():
            (count,) = self._base.execute("SELECT COUNT(*) FROM runs").fetchone()
        return int(count)

    def get(self, key: str) -> Record | None:
        """Return a run that is done; None if it is not."""
        with self._told():
            row = self._base.execute("SELECT record FROM runs WHERE key = ?", (key,)).fetchone()
            return Record.from_bytes(row[0]) if row else None

    def has(self, key: str) -> bool:
        """Tell whether a run is done."""
        with self._told():
            found = self._base.execute("SELECT 1 FROM runs WHERE key = ?", (key,)).fetchone()
        return found is not None

    def put(self, key: str, record: Record) -> None:
        """Keep a run."""
        with self._told():
            content = record.to_bytes()
            self._base.execute("INSERT OR REPLACE INTO runs VALUES (?, ?)", (key, content))

    @contextmanager
    def _told(self) -> Iterator[None]:
        """Tell what is wrong with the file in a sentence."""
        name = str(self._path)
        try:
            yield
        except sqlite3.OperationalError as error:
            raise OutputError(
                f"{name} cannot be read or written ({error}).",
                where=name,
                hint="Look whether the disk is full or another study is using the file",
            ) from error
        except (sqlite3.DatabaseError, ValueError, KeyError, zipfile.BadZipFile) as error:
            hint = "move it elsewhere, or name another study with -o"
            problem = Problem(name, "a file that holds no runs", "those of this study", hint)
            raise InputError([problem]) from error
