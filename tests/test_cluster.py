"""Studies on a real Dask cluster: a scheduler and workers, each a process of its own."""

from __future__ import annotations

import os
import signal
import socket
import sqlite3
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import closing, contextmanager, suppress
from functools import partial
from pathlib import Path

import pytest
from distributed import Client
from test_study import BRACKET, DOOR_FRAME, all_runs, cells, plan_of, same

from grasp_xl.cli.program import main
from grasp_xl.errors import OutputError, UsageError
from grasp_xl.search.stop import Interrupt
from grasp_xl.study import cluster
from grasp_xl.study.cluster import run_on_cluster
from grasp_xl.study.plan import Plan, Trial
from grasp_xl.study.trial import Record, Work


class Cluster:
    """A scheduler on this machine, and the workers that a test starts and kills."""

    def __init__(self, folder: Path, env: Mapping[str, Mapping[str, str]] | None = None) -> None:
        self.env = env or {}
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            self.address = f"tcp://127.0.0.1:{free.getsockname()[1]}"
        self.folder, self.workers = folder, []
        self.scheduler = self._started("scheduler", "--host", self.address, "--no-dashboard")

    def add_worker(self) -> subprocess.Popen[bytes]:
        """Start a worker without a nanny: killed, it stays dead."""
        words = (self.address, "--no-nanny", "--nthreads", "1", "--no-dashboard")
        worker = self._started("worker", *words, "--local-directory", str(self.folder))
        self.workers.append(worker)
        return worker

    def wait_for(self, count: int) -> None:
        """Wait until so many workers are there."""
        with Client(self.address, timeout=30, set_as_default=False) as client:
            client.wait_for_workers(count, timeout=60)

    def kill(self, process: subprocess.Popen[bytes]) -> None:
        """End a process without a word."""
        process.send_signal(signal.SIGKILL)
        process.wait()

    def close(self) -> None:
        """End all that is left."""
        for process in (*self.workers, self.scheduler):
            self.kill(process)

    def _started(self, what: str, *words: str) -> subprocess.Popen[bytes]:
        program = [sys.executable, "-m", "dask", what, *words]
        quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
        env = {**os.environ, **self.env.get(what, {})}
        return subprocess.Popen(program, **quiet, cwd=self.folder, env=env)  # noqa: S603


@contextmanager
def a_cluster(
    folder: Path, workers: int, env: Mapping[str, Mapping[str, str]] | None = None
) -> Iterator[Cluster]:
    made = Cluster(folder, env)
    try:
        for _ in range(workers):
            made.add_worker()
        if workers:
            made.wait_for(workers)
        yield made
    finally:
        made.close()


@pytest.fixture(scope="module")
def two_workers(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Cluster]:
    with a_cluster(tmp_path_factory.mktemp("cluster"), 2) as made:
        yield made


def runs_on(
    made: Cluster,
    plan: Plan,
    then: Callable[[dict[str, Record]], None] = lambda _: None,
    interrupt: Interrupt | None = None,
) -> dict[str, Record]:
    """Run a plan on a cluster; ``then`` is called after each run.  No run is told twice."""
    records: dict[str, Record] = {}

    def take(trial: Trial, record: Record) -> None:
        assert trial.label not in records
        records[trial.label] = record
        then(records)

    works = [Work.of(case.task) for case in plan.cases]
    run_on_cluster(made.address, works, plan.trials(), take, interrupt or Interrupt())
    return records


def test_runs_on_a_cluster_are_those_of_this_machine(two_workers):
    """Two parts, both starts: every record is equal, to the last gene."""
    plan = plan_of(BRACKET, DOOR_FRAME, runs=3)
    here, there = all_runs(plan), runs_on(two_workers, plan)
    assert here.keys() == there.keys()
    assert all(same(here[label], there[label]) for label in here)


def test_the_command_writes_the_same_study(two_workers, tmp_path):
    """Study --scheduler gives the workbook that study gives, but for the seconds."""
    words = [str(BRACKET), "--generations", "300", "--quiet", "-o"]
    assert main(["study", *words, str(tmp_path / "a.xlsx")]) == 0
    more = ["--scheduler", two_workers.address]
    assert main(["study", *words, str(tmp_path / "b.xlsx"), *more]) == 0
    assert cells(tmp_path / "a.xlsx") == cells(tmp_path / "b.xlsx")


def test_an_interrupt_keeps_what_is_done(two_workers):
    """After the wish to stop no further run is waited for, and no half run is told."""
    plan, interrupt = plan_of(BRACKET, runs=500, generations=20_000), Interrupt()

    def ask(records: dict[str, Record]) -> None:
        interrupt.asked = len(records) >= 3

    records = runs_on(two_workers, plan, ask, interrupt)
    assert 3 <= len(records) < len(plan)
    assert {record.done for record in records.values()} == {20_000}


def test_killing_workers_loses_nothing_and_changes_nothing(tmp_path):
    """One of two workers is killed, then the other, the last that held the parts; others come."""
    plan = plan_of(BRACKET, DOOR_FRAME, runs=10, generations=5_000)
    with a_cluster(tmp_path, 2) as made:

        def kill(records: dict[str, Record]) -> None:
            if len(records) == 5:
                made.kill(made.workers[0])
            if len(records) == 15:
                made.kill(made.workers[1])
                made.add_worker()
            if len(records) == 25:
                made.add_worker()
                made.kill(made.workers[2])

        there = runs_on(made, plan, kill)
        assert [worker.poll() for worker in made.workers] == [-9, -9, -9, None]
    here = all_runs(plan)
    assert here.keys() == there.keys()
    assert all(same(here[label], there[label]) for label in here)


def test_a_scheduler_that_goes_is_told_in_a_sentence(tmp_path):
    """When the scheduler is killed, runs that were done stay, and the error says what to do."""
    plan = plan_of(BRACKET, runs=500, generations=20_000)
    with a_cluster(tmp_path, 1) as made:
        done: dict[str, Record] = {}

        def kill(records: dict[str, Record]) -> None:
            done.update(records)
            if len(records) == 3:
                made.kill(made.scheduler)

        with pytest.raises(OutputError, match="does not answer any more"):
            runs_on(made, plan, kill)
    assert len(done) >= 3


@pytest.mark.parametrize(
    "address", ["tcp://127.0.0.1:1", "nonsense://x", "127.0.0.1:x", "tls://127.0.0.1:1"]
)
def test_an_address_without_a_scheduler_is_told_in_a_sentence(address, monkeypatch):
    """Nobody waits for ever for a scheduler that is not there."""
    monkeypatch.setattr(cluster, "CONNECT_SECONDS", 1)
    began = time.monotonic()
    run = partial(run_on_cluster, address, [], [], {}.__setitem__)
    with pytest.raises(OutputError, match="No Dask scheduler answers"):
        run(Interrupt())
    assert time.monotonic() - began < 20


def test_workers_of_another_version_are_refused(two_workers, monkeypatch):
    """A run of another version may be another run: the study ends with a sentence."""
    monkeypatch.setattr(cluster, "__version__", "0.0.0")
    with pytest.raises(UsageError, match=r"needs 0\.0\.0"):
        runs_on(two_workers, plan_of(BRACKET, runs=1))


def test_an_interrupt_is_heard_when_no_worker_is_left(tmp_path):
    """The only worker is killed: the study waits for another one, but not for somebody's wish to stop."""
    plan, interrupt = plan_of(BRACKET, runs=500, generations=20_000), Interrupt()
    later = threading.Timer(3, setattr, (interrupt, "asked", True))
    with a_cluster(tmp_path, 1) as made:

        def kill(records: dict[str, Record]) -> None:
            if len(records) == 3:
                made.kill(made.workers[0])
                later.start()

        began = time.monotonic()
        records = runs_on(made, plan, kill, interrupt)
    assert 3 <= len(records) < len(plan)
    assert time.monotonic() - began < 20


@pytest.mark.parametrize(
    ("what", "sentence"), [("worker", "cannot run grasp_xl"), ("scheduler", "cannot read")]
)
def test_a_machine_without_the_program_is_told_in_a_sentence(what, sentence, tmp_path):
    """Dask alone is not enough, neither on a worker nor where the scheduler runs."""
    missing = "raise ModuleNotFoundError('No module named grasp_xl')"
    (tmp_path / "first").mkdir()
    (tmp_path / "first" / "grasp_xl.py").write_text(missing, encoding="utf-8")
    env = {what: {"PYTHONPATH": str(tmp_path / "first")}}
    with a_cluster(tmp_path, 1, env) as made, pytest.raises(UsageError, match=sentence):
        runs_on(made, plan_of(BRACKET, runs=1))


def test_something_else_that_listens_is_told_in_a_sentence(monkeypatch):
    """A port where somebody accepts connections and says nothing is waited for no longer than any."""
    monkeypatch.setattr(cluster, "CONNECT_SECONDS", 1)
    began = time.monotonic()
    with socket.socket() as silent:
        silent.bind(("127.0.0.1", 0))
        silent.listen()
        address = f"tcp://127.0.0.1:{silent.getsockname()[1]}"
        with pytest.raises(OutputError, match="No Dask scheduler answers"):
            run_on_cluster(address, [], [], {}.__setitem__, Interrupt())
    assert time.monotonic() - began < 20


def test_dask_says_nothing_of_its_own_when_the_scheduler_goes(tmp_path):
    """A person at the terminal reads one sentence, and no traceback of Dask's."""
    with a_cluster(tmp_path, 1) as made:
        words = [str(BRACKET), "--quiet", "--runs", "2000", "-o", str(tmp_path / "s.xlsx")]
        program = [sys.executable, "-m", "grasp_xl", "study", *words, "--scheduler", made.address]
        with subprocess.Popen(program, stderr=subprocess.PIPE, text=True) as study:  # noqa: S603
            while study.poll() is None and not some_runs(tmp_path / "s.runs"):
                time.sleep(0.05)
            made.kill(made.scheduler)
            _, said = study.communicate(timeout=60)
    assert study.returncode == 3
    assert "does not answer any more" in said
    assert "Traceback" not in said
    assert "distributed" not in said


def some_runs(file: Path) -> bool:
    """Tell whether a study has kept runs by now."""
    if not file.exists():
        return False
    with closing(sqlite3.connect(file)) as base, suppress(sqlite3.OperationalError):
        return bool(base.execute("SELECT COUNT(*) FROM runs").fetchone()[0])
    return False
