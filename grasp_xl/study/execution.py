"""Running trials on all cores of this machine."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait

from grasp_xl.search.stop import Interrupt
from grasp_xl.study.plan import Trial
from grasp_xl.study.trial import Record, Work, record_of, run_search

OnRecord = Callable[[Trial, Record], None]
"""Told each run that is done, in the order in which they end, always from the same thread."""

Execute = Callable[[Sequence[Work], Iterable[Trial], OnRecord, Interrupt], None]
"""Runs trials until all are done or somebody asks to stop; ``works`` are one a case."""

AHEAD = 4
"""Trials a core that wait for it."""

POLL_SECONDS = 0.1
"""How often somebody's wish to stop is looked for."""


def run_here(
    works: Sequence[Work],
    trials: Iterable[Trial],
    on_record: OnRecord,
    interrupt: Interrupt,
    *,
    workers: int | None = None,
) -> None:
    """Run trials in threads: the compiled search lets all of them go on at once.

    Parameters
    ----------
    works : sequence of Work
        One a case.
    trials : iterable of Trial
    on_record : callable
    interrupt : Interrupt
        Once asked, runs that are not done are given up.
    workers : int, optional
        Threads; as many as there are cores.
    """
    workers = workers or os.cpu_count() or 1
    waiting = iter(trials)
    running: dict[Future[Record | None], Trial] = {}

    def run(trial: Trial) -> Record | None:
        user_start = trial.scenario == "user"
        result = run_search(works[trial.case], trial.seed, user_start=user_start, also=[interrupt])
        return None if result.stop_reason == "interrupted" else record_of(result)

    with ThreadPoolExecutor(workers) as threads:
        while not interrupt.asked:
            while len(running) < AHEAD * workers and (trial := next(waiting, None)):
                running[threads.submit(run, trial)] = trial
            if not running:
                return
            done, _ = wait(running, POLL_SECONDS, FIRST_COMPLETED)
            for future in done:
                _take(future, running.pop(future), on_record)
        for future in running:
            future.cancel()
        for future, trial in running.items():
            if not future.cancelled():
                _take(future, trial, on_record)


def _take(future: Future[Record | None], trial: Trial, on_record: OnRecord) -> None:
    record = future.result()
    if record is not None:
        on_record(trial, record)
