"""Running trials on a Dask cluster: workers may come, go and be killed.

A trial is a function of its case's ``Work``, a seed and a start: it may be repeated anywhere.  The
works are scattered once; only where all workers that held one are gone it is sent again.
"""

from __future__ import annotations

import logging
import math
import queue
import time
import uuid
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import CancelledError
from contextlib import contextmanager, suppress
from importlib.util import find_spec
from typing import Any, NamedTuple

from grasp_xl import __version__
from grasp_xl.errors import OutputError, UsageError
from grasp_xl.search.stop import Interrupt
from grasp_xl.study.execution import POLL_SECONDS, OnRecord
from grasp_xl.study.plan import Trial
from grasp_xl.study.trial import Record, Work, run_trial

CONNECT_SECONDS = 10
"""How long the scheduler may take to answer."""

SEND_SECONDS = 5
"""How long a work may take to reach the workers, before it is looked whether there are any."""

WORKERS_SECONDS = 1.0
"""How often the workers are counted."""

WAITING = 16
"""Trials a thread that are on the way: enough to take many records at once."""

MOST_KILLS = 20
"""Workers that one trial may lose before it is blamed for that."""


class OtherVersionError(Exception):
    """A worker has another version of the program, whose runs may be others."""


def run_remotely(version: str, work: Work, seed: int, user_start: bool) -> Record:  # noqa: FBT001 (sent by position)
    """Run one trial on a worker.

    Raises
    ------
    OtherVersionError
        If the worker's version of the program is not that of the study.
    """
    if version != __version__:
        raise OtherVersionError(__version__)
    return run_trial(work, seed, user_start)


def run_on_cluster(
    address: str,
    works: Sequence[Work],
    trials: Iterable[Trial],
    on_record: OnRecord,
    interrupt: Interrupt,
) -> None:
    """Run trials on the cluster of a Dask scheduler; as ``run_here`` does on this machine.

    Parameters
    ----------
    address : str
        Of the scheduler: ``tcp://HOST:8786``.
    works, trials, on_record, interrupt
        As of :func:`~grasp_xl.study.execution.run_here`.

    Raises
    ------
    UsageError
        If Dask distributed is not installed here, or the program is not on the workers.
    OutputError
        If the scheduler does not answer, or not any more.
    """
    if find_spec("distributed") is None:
        raise UsageError(
            "--scheduler needs the package distributed, which is not installed.",
            where="--scheduler",
            hint='Install it with pip install "grasp_xl[cluster]"',
        )
    from distributed import Client

    connect: Any = Client
    with _quiet():
        try:
            client = connect(address, timeout=CONNECT_SECONDS, set_as_default=False)
        except (OSError, ValueError) as error:
            raise OutputError(
                f"No Dask scheduler answers at {address}.",
                where="--scheduler",
                hint="Start one with dask scheduler, and give the address that it tells",
            ) from error
        try:
            _Session(client, address, works, on_record).run(trials, interrupt)
        finally:
            client.close(timeout=CONNECT_SECONDS)


@contextmanager
def _quiet() -> Iterator[None]:
    """Keep Dask's own log off the terminal: what matters of it is told in sentences."""
    log = logging.getLogger("distributed")
    level = log.level
    log.setLevel(logging.CRITICAL + 1)
    try:
        yield
    finally:
        log.setLevel(level)


class _Running(NamedTuple):
    """A trial on the cluster: the future of its work there, and of its record."""

    trial: Trial
    work: Any
    future: Any


class _Session:
    """The trials of one study on one cluster."""

    def __init__(
        self,
        client: Any,  # noqa: ANN401 (untyped library)
        address: str,
        works: Sequence[Work],
        on_record: OnRecord,
    ) -> None:
        self._client, self._address = client, address
        self._works, self._on_record = works, on_record
        self._name, self._submitted = uuid.uuid4().hex, 0
        self._sent: dict[int, Any] = {}
        """Works on the cluster, by case."""
        self._running: dict[str, _Running] = {}
        self._ended: queue.SimpleQueue[str] = queue.SimpleQueue()
        """Keys of what is not running any more."""
        self._kills: dict[str, int] = {}
        self._room, self._counted_at = 0, -math.inf

    def run(self, trials: Iterable[Trial], interrupt: Interrupt) -> None:
        """Run trials until all are done or somebody asks to stop."""
        waiting = iter(trials)
        trial = next(waiting, None)
        while (trial or self._running) and not interrupt.asked:
            while trial and len(self._running) < self._capacity() and self._submit(trial):
                trial = next(waiting, None)
            self._take(self._take_ended())
        self._asked(self._client.cancel, [each.future for each in self._running.values()])

    def _capacity(self) -> int:
        """Return how many trials may be on the way: some a thread of the workers there are now."""
        clock = time.monotonic()
        if clock - self._counted_at >= WORKERS_SECONDS:
            self._counted_at = clock
            self._room = WAITING * sum(self._asked(self._client.nthreads).values())
        return self._room

    def _submit(self, trial: Trial) -> bool:
        """Send a trial; False where no worker is there to take its work."""
        if trial.case not in self._sent:
            try:
                self._sent[trial.case] = self._client.scatter(
                    self._works[trial.case], broadcast=True, hash=False, timeout=SEND_SECONDS
                )
            except TimeoutError:
                self._counted_at = -math.inf
                return False
            except (OSError, RuntimeError) as error:
                raise self._gone() from error
        work = self._sent[trial.case]
        self._submitted += 1
        future = self._asked(
            self._client.submit,
            *(run_remotely, __version__, work, trial.seed, trial.scenario == "user"),
            key=f"{trial.label}-{self._name}-{self._submitted}",
        )
        self._running[future.key] = _Running(trial, work, future)
        future.add_done_callback(lambda ended: self._ended.put(ended.key))
        return True

    def _take_ended(self) -> list[str]:
        """Return the keys of trials that ended, waiting for one a moment."""
        keys: list[str] = []
        with suppress(queue.Empty):
            keys.append(self._ended.get(timeout=POLL_SECONDS))
            while True:
                keys.append(self._ended.get_nowait())
        if not keys:
            self._capacity()  # says so if the scheduler is gone
        return [key for key in dict.fromkeys(keys) if key in self._running]

    def _take(self, keys: Sequence[str]) -> None:
        """Take the records of trials that ended, or send these trials again."""
        ended = [self._running.pop(key) for key in keys]
        for each, record in zip(ended, self._records(ended), strict=True):
            if record is None:
                self._send_again(each)
            else:
                self._on_record(each.trial, record)

    def _send_again(self, ended: _Running) -> None:
        """Send a trial again, once a worker is there."""
        if self._sent.get(ended.trial.case) is ended.work:
            del self._sent[ended.trial.case]  # it may be gone with the worker
        while not self._submit(ended.trial):
            if self._capacity() == 0:
                time.sleep(POLL_SECONDS)

    def _records(self, ended: Sequence[_Running]) -> Iterable[Record | None]:
        """Give the records of trials: fetched at once, or one by one where something is wrong."""
        futures = [each.future for each in ended]
        if all(future.status == "finished" for future in futures):
            with suppress(Exception):  # the look at each one says what it is
                found: list[Record] = self._client.gather(futures)
                return found
        return map(self._record, ended)

    def _record(self, ended: _Running) -> Record | None:
        """Return the record of a trial; None where it went down with its worker."""
        from distributed import KilledWorker

        future = ended.future
        if future.status in ("cancelled", "lost", "pending"):
            return None
        try:
            record: Record = future.result(timeout=CONNECT_SECONDS)
        except (TimeoutError, CancelledError):
            return None
        except KilledWorker as error:
            label = ended.trial.label
            self._kills[label] = self._kills.get(label, 0) + 1
            if self._kills[label] < MOST_KILLS:
                return None
            raise OutputError(
                f"Workers die whenever they run {label}.",
                where="--scheduler",
                hint="Look into their logs; they may lack memory",
            ) from error
        except OtherVersionError as error:
            raise UsageError(
                f"A worker has grasp_xl {error}, and this study needs {__version__}.",
                where="--scheduler",
                hint="Install the same version on every worker",
            ) from error
        except (ImportError, AttributeError) as error:
            raise UsageError(
                f"A worker cannot run grasp_xl ({error}).",
                where="--scheduler",
                hint=f"Install grasp_xl {__version__} on every worker",
            ) from error
        return record

    def _asked(self, ask: Callable[..., Any], *words: Any, **named: Any) -> Any:  # noqa: ANN401 (untyped library)
        """Ask the scheduler for something.

        Raises
        ------
        OutputError
            If it does not answer any more.
        """
        try:
            return ask(*words, **named)
        except (OSError, RuntimeError) as error:
            raise self._gone() from error

    def _gone(self) -> OutputError:
        return OutputError(
            f"The Dask scheduler at {self._address} does not answer any more.",
            where="--scheduler",
            hint="Runs that are done are kept; start it again, and go on with --resume",
        )
