"""Whether a search is at work on an open workbook, and the wish to end it: two small files.

They lie in the user's cache folder and are named by Excel's process and the workbook's name, so
that nothing is written into the workbook for it.
"""

from __future__ import annotations

import hashlib
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from uuid import uuid4

from platformdirs import user_cache_path

from grasp_xl.errors import GraspError
from grasp_xl.search.stop import Interrupt

LOOK_SECONDS = 0.1
"""Time between two looks for the wish to stop."""

DEAD_AFTER_SECONDS = 10.0
"""A mark that nobody renewed for so long was left by a worker that was killed."""


BUSY = "A search is at work on this workbook. Press Stop to end it, then try again."


class BusyError(GraspError):
    """A search is at work on the workbook."""


@dataclass(frozen=True, slots=True)
class Running:
    """The mark of a search at work.

    Parameters
    ----------
    mark : Path
        Exists, and is renewed, as long as the search is at work.
    """

    mark: Path

    @classmethod
    def on(cls, book: Any) -> Running:  # noqa: ANN401 (an xlwings book)
        """Return the mark that belongs to an open workbook.

        That of a search which began before the workbook got its present name is its own, too: it
        has the name of no open workbook of this Excel.
        """
        folder, excel = user_cache_path("grasp_xl") / "running", str(book.app.pid)
        own = cls(folder / f"{excel}-{_digest(book.name)}")
        if not own.is_alive:
            named = {f"{excel}-{_digest(other.name)}" for other in book.app.books}
            for mark in folder.glob(f"{excel}-*"):
                if mark.name not in named and mark.suffix == "" and cls(mark).is_alive:
                    return cls(mark)
        return own

    @property
    def wish(self) -> Path:
        """Exists once somebody wants the search to end."""
        return self.mark.with_suffix(".stop")

    @property
    def is_alive(self) -> bool:
        """Whether a search is at work."""
        with suppress(OSError):
            return time.time() - self.mark.stat().st_mtime < DEAD_AFTER_SECONDS
        return False

    def ask_to_stop(self) -> None:
        """Want the search to end."""
        self.wish.touch()

    def forget_wish(self, ask: Interrupt) -> None:
        """Take back the wish to end: it was fulfilled."""
        self.wish.unlink(missing_ok=True)
        ask.asked = False

    def claim(self) -> str:
        """Mark a search that is about to begin: from now on Stop ends it.

        Returns
        -------
        str
            By this the worker that begins it proves that the mark is meant for it.

        Raises
        ------
        BusyError
            If another one is at work: of two that begin at once, one gets the mark.
        """
        self.mark.parent.mkdir(parents=True, exist_ok=True)
        if not self.is_alive:
            self.mark.unlink(missing_ok=True)
        claim = uuid4().hex
        try:
            with self.mark.open("x", encoding="ascii") as mark:
                self.wish.unlink(missing_ok=True)
                mark.write(claim)
        except FileExistsError:
            raise BusyError(BUSY) from None
        return claim

    @contextmanager
    def marked(self, claim: str | None = None) -> Iterator[Interrupt]:
        """Mark a search as at work, and give the rule that the wish to stop trips.

        Parameters
        ----------
        claim : str, optional
            That of the button which began it.

        Raises
        ------
        BusyError
            If another one is at work.
        """
        if not (claim and self._has(claim)):
            self.claim()
        self.mark.touch()
        ask, done = Interrupt(), threading.Event()

        def watch() -> None:
            while not done.wait(LOOK_SECONDS):
                with suppress(OSError):
                    self.mark.touch()
                if self.wish.exists():
                    ask.asked = True

        watcher = threading.Thread(target=watch, daemon=True)
        watcher.start()
        try:
            yield ask
        finally:
            done.set()
            watcher.join()
            self.mark.unlink(missing_ok=True)
            self.wish.unlink(missing_ok=True)

    def _has(self, claim: str) -> bool:
        """Whether the mark is that of a claim."""
        with suppress(OSError):
            return self.mark.read_text(encoding="ascii") == claim
        return False


def _digest(name: str) -> str:
    return hashlib.sha256(name.encode()).hexdigest()[:16]
