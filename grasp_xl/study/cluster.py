"""Running trials on a Dask cluster: workers may come, go and be killed.

A trial is a function of its case's ``Work``, a seed and a start: it may be repeated anywhere.  The
works are scattered once; only where all workers that held one are gone it is sent again.  Whatever
is asked of Dask is asked for a limited time: a machine that hangs must not hang the study.
"""

from __future__ import annotations

import logging
import math
import pickle
import queue
import threading
import time
import uuid
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import CancelledError, Future
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

CLOSE_SECONDS = 2
"""How long a farewell to the scheduler may take."""

SEND_SECONDS = 1
"""How long a work may take to reach the workers, before it is looked whether there are any."""

WORKERS_SECONDS = 1.0
"""How often the workers are counted."""

WAITING = 16
"""Trials a thread that are on the way: enough to take many records at once."""

MOST_KILLS = 20
"""Workers that one trial may lose before it is blamed for that."""

MOST_REFUSED = 20
"""Times in a row that a work may fail to reach the workers there are."""


UNREADABLE = "deserialization of the task graph"
"""By which Dask's own words for a scheduler without our program are known."""


ASK_VERSION = "__import__('grasp_xl').__version__"
"""What a worker evaluates, whether it has our program or not."""


class OtherVersionError(Exception):
    """A worker has another version of the program, whose runs may be others."""


def run_remotely(version: str, work: bytes, seed: int, user_start: bool) -> Record:  # noqa: FBT001 (sent by position)
    """Run one trial on a worker.

    The work comes pickled, and is read after the look at the version: another version's could not
    be read, or would be read as something else.

    Raises
    ------
    OtherVersionError
        If the worker's version of the program is not that of the study.
    """
    if version != __version__:
        raise OtherVersionError(__version__)
    return run_trial(pickle.loads(work), seed, user_start)  # noqa: S301 (Dask unpickles all it gets)


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
        If Dask distributed is not installed here, or the program is not on the scheduler's machine
        or on a worker's.
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
            client = _within(CONNECT_SECONDS, connect, address, set_as_default=False)
        except Exception as error:  # each of Dask's transports has errors of its own
            raise OutputError(
                f"No Dask scheduler answers at {address}.",
                where="--scheduler",
                hint="Start one with dask scheduler, and give the address that it tells",
            ) from error
        try:
            _Session(client, address, works, on_record).run(trials, interrupt)
        finally:
            with suppress(Exception):  # what is not done is given up with the client
                _within(CLOSE_SECONDS, client.close, CLOSE_SECONDS)


def _within(seconds: float, ask: Callable[..., Any], *words: Any, **named: Any) -> Any:  # noqa: ANN401 (untyped library)
    """Ask for something that may never be answered, and be it that its own time limit fails.

    Raises
    ------
    TimeoutError
        If there is no answer in so many seconds; the asking thread is left to itself.
    """
    answer: Future[Any] = Future()

    def run() -> None:
        try:
            answer.set_result(ask(*words, **named))
        except BaseException as error:  # noqa: BLE001 (raised where it was asked)
            answer.set_exception(error)

    threading.Thread(target=run, daemon=True).start()
    return answer.result(seconds)


@contextmanager
def _quiet() -> Iterator[None]:
    """Keep Dask's own log off the terminal: what matters of it is told in sentences."""
    names = [name for name in logging.root.manager.loggerDict if name.startswith("distributed")]
    logs = [logging.getLogger(name) for name in names]  # some have levels of their own
    levels = [log.level for log in logs]
    for log in logs:
        log.setLevel(logging.CRITICAL + 1)
    try:
        yield
    finally:
        for log, level in zip(logs, levels, strict=True):
            log.setLevel(level)


def _other_version(version: str) -> UsageError:
    return UsageError(
        f"A worker has grasp_xl {version}, and this study needs {__version__}.",
        where="--scheduler",
        hint="Install the same version on every worker",
    )


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
        self._again: deque[Trial] = deque()
        """Trials that went down with their workers."""
        self._known: set[str] = set()
        """Workers that have our version."""
        self._kills: dict[str, int] = {}
        self._room, self._counted_at, self._refused = 0, -math.inf, 0

    def run(self, trials: Iterable[Trial], interrupt: Interrupt) -> None:
        """Run trials until all are done or somebody asks to stop."""
        waiting = iter(trials)
        trial = next(waiting, None)
        while (trial or self._running) and not interrupt.asked:
            while trial and len(self._running) < self._capacity() and self._submit(trial):
                trial = self._next(waiting)
            self._take(self._take_ended(POLL_SECONDS))
            trial = trial or self._next(waiting)
        if interrupt.asked:
            done = [key for key in self._take_ended(0) if self._is_finished(key)]
            self._take(done)

    def _next(self, waiting: Iterator[Trial]) -> Trial | None:
        """Return the trial to send next, if any."""
        return self._again.popleft() if self._again else next(waiting, None)

    def _is_finished(self, key: str) -> bool:
        return bool(self._running[key].future.status == "finished")

    def _capacity(self) -> int:
        """Return how many trials may be on the way: some a thread of the workers there are now."""
        clock = time.monotonic()
        if clock - self._counted_at >= WORKERS_SECONDS:
            self._counted_at = clock
            threads = self._asked(self._client.nthreads)
            self._look_at([each for each in threads if each not in self._known])
            self._room = WAITING * sum(threads[each] for each in threads if each in self._known)
        return self._room

    def _look_at(self, workers: Sequence[str]) -> None:
        """Look whether new workers have our version; one that died meanwhile stays unknown.

        Only Python's own is asked for: a worker that cannot read a task leaves the cluster
        without a word.
        """
        if not workers:
            return
        told: dict[str, Any] = {}
        with suppress(Exception):  # they are asked again when they are counted again
            told = _within(
                *(CONNECT_SECONDS, self._client.run, eval, ASK_VERSION),
                workers=list(workers),
                on_error="return",
            )
        for worker, version in told.items():
            if isinstance(version, ImportError | AttributeError):
                raise UsageError(
                    f"The worker at {worker} cannot run grasp_xl ({version}).",
                    where="--scheduler",
                    hint=f"Install grasp_xl {__version__} on every worker",
                )
            if isinstance(version, str):
                if version != __version__:
                    raise _other_version(version)
                self._known.add(worker)

    def _submit(self, trial: Trial) -> bool:
        """Send a trial; False where no worker is there to take its work."""
        if trial.case not in self._sent and not self._send(trial.case):
            return False
        work = self._sent[trial.case]
        self._submitted += 1
        try:
            future = self._client.submit(
                *(run_remotely, __version__, work, trial.seed, trial.scenario == "user"),
                key=f"{trial.label}-{self._name}-{self._submitted}",
            )
        except RuntimeError as error:  # the client gave up
            raise self._gone() from error
        self._running[future.key] = _Running(trial, work, future)
        future.add_done_callback(lambda ended: self._ended.put(ended.key))
        return True

    def _send(self, case: int) -> bool:
        """Send a work to all workers; False where none is there, or one dies that takes it."""
        content = pickle.dumps(self._works[case])
        name = f"work-{self._works[case].fingerprint()}-{uuid.uuid4().hex}"
        try:
            sent = _within(
                SEND_SECONDS + CONNECT_SECONDS,
                self._client.scatter,
                {name: content},
                broadcast=True,
                timeout=SEND_SECONDS,
            )
        except Exception as error:  # the scheduler passes on whatever a worker's death leads to
            self._counted_at = -math.inf
            self._refused = self._refused + 1 if self._capacity() else 0
            if self._refused < MOST_REFUSED:
                return False
            raise OutputError(
                f"The Dask workers at {self._address} take no data ({error}).",
                where="--scheduler",
                hint="Look into their logs",
            ) from error
        self._sent[case], self._refused = sent[name], 0
        return True

    def _take_ended(self, seconds: float) -> list[str]:
        """Return the keys of trials that ended, waiting for one so long."""
        keys: list[str] = []
        with suppress(queue.Empty):
            keys.append(self._ended.get(timeout=seconds) if seconds else self._ended.get_nowait())
            while True:
                keys.append(self._ended.get_nowait())
        if not keys and seconds:
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
        """Let a trial be sent again, once a worker is there."""
        if self._sent.get(ended.trial.case) is ended.work:
            del self._sent[ended.trial.case]  # it may be gone with the worker
        self._counted_at = -math.inf
        self._again.append(ended.trial)

    def _records(self, ended: Sequence[_Running]) -> Iterable[Record | None]:
        """Give the records of trials: fetched at once, or one by one where something is wrong."""
        futures = [each.future for each in ended]
        if all(future.status == "finished" for future in futures):
            try:
                found: list[Record] = _within(CONNECT_SECONDS, self._client.gather, futures)
            except TimeoutError:  # they went down with their worker, and are run again
                return [None] * len(futures)
            except Exception:  # noqa: BLE001, S110 (the look at each one says what it is)
                pass
            else:
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
            raise _other_version(str(error)) from error
        except RuntimeError as error:
            if UNREADABLE not in str(error):
                raise
            raise UsageError(
                "The Dask scheduler cannot read what grasp_xl sends.",
                where="--scheduler",
                hint=f"Install grasp_xl {__version__}, and the same Dask as here, where it runs",
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
            return _within(CONNECT_SECONDS, ask, *words, **named)
        except (OSError, RuntimeError) as error:
            raise self._gone() from error

    def _gone(self) -> OutputError:
        return OutputError(
            f"The Dask scheduler at {self._address} does not answer any more.",
            where="--scheduler",
            hint="Runs that are done are kept; start it again, and go on with --resume",
        )
