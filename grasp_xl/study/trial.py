"""One run of a study: a pure function of the option space, the settings and a seed."""

from __future__ import annotations

import hashlib
import io
import json
from collections.abc import Sequence
from dataclasses import astuple, dataclass, replace

import numpy as np
import numpy.typing as npt

from grasp_xl import __version__
from grasp_xl.chromosome import Chromosome
from grasp_xl.rules import Rules
from grasp_xl.search.genetic import search
from grasp_xl.search.result import GeneticSettings, Result, Trace
from grasp_xl.search.stop import Generations, StopRule
from grasp_xl.space import OptionSpace
from grasp_xl.task import Task

Genes = npt.NDArray[np.int32]


@dataclass(frozen=True, eq=False, slots=True)
class Work:
    """What all runs of a case share; it is sent to every worker once.

    Parameters
    ----------
    space, rules
    settings : GeneticSettings
        Its start and seed are those of no run.
    generations : int
    benchmark : Chromosome
    """

    space: OptionSpace
    rules: Rules
    settings: GeneticSettings
    generations: int
    benchmark: Chromosome

    @classmethod
    def of(cls, task: Task) -> Work:
        """Return what the runs of a task share."""
        settings = replace(task.settings, seed=0, user_start=False)
        return cls(task.space, task.rules, settings, task.generations, task.benchmark.chromosome)

    def fingerprint(self) -> str:
        """Return a hash of all that a run's outcome depends on, but its start and seed."""
        digest = hashlib.sha256(__version__.encode())
        space = self.space
        told = [
            space.part.mass_g,
            space.scale_factor,
            [
                (kind.name, kind.force_n, kind.price, kind.count_min, kind.count_max)
                for kind in space.kinds
            ],
            astuple(self.rules.requirements),
            [sorted(self.rules.criterion.terms), sorted(self.rules.goals.dropped)],
            [list(self.rules.goals.base), list(self.rules.weights)],
            astuple(self.settings),
            self.generations,
        ]
        digest.update(json.dumps(told).encode())
        arrays = [space.part.centroid_mm, space.approximation_polygon_mm, self.benchmark.genes]
        for array in (*arrays, *(kind.footprints_mm for kind in space.kinds)):
            digest.update(repr(array.shape).encode())
            digest.update(np.ascontiguousarray(array).tobytes())
        return digest.hexdigest()


@dataclass(frozen=True, eq=False, slots=True)
class Record:
    """What is kept of a run: the fittest where it changed, and the best.

    Parameters
    ----------
    generation, genes : IntArray, Genes
        ``(n,)`` and ``(n, kinds, 1 + slots)``: as of a ``Trace``.
    best : Genes
        ``(kinds, 1 + slots)``; ``(0, 1 + slots)`` where no grasp was feasible.
    done, evaluations, designs : int
        Generations, grasps judged, valid designs found.
    seconds : float
    """

    generation: npt.NDArray[np.int64]
    genes: Genes
    best: Genes
    done: int
    evaluations: int
    designs: int
    seconds: float

    @property
    def changes(self) -> Trace:
        """The fittest where it changed."""
        return Trace(self.generation, self.genes.astype(np.int64))

    @property
    def best_chromosome(self) -> Chromosome | None:
        """The best grasp, if any was feasible."""
        return Chromosome(self.best.astype(np.int64)) if len(self.best) else None

    def to_bytes(self) -> bytes:
        """Return it as a file: NumPy's own format."""
        file = io.BytesIO()
        numbers = np.array([self.done, self.evaluations, self.designs])
        np.savez_compressed(
            file,
            generation=self.generation,
            genes=self.genes,
            best=self.best,
            numbers=numbers,
            seconds=np.array(self.seconds),
        )
        return file.getvalue()

    @classmethod
    def from_bytes(cls, content: bytes) -> Record:
        """Return what :meth:`to_bytes` wrote.

        Raises
        ------
        ValueError, KeyError, OSError, zipfile.BadZipFile
            If it is no such file.
        """
        with np.load(io.BytesIO(content), allow_pickle=False) as held:
            done, evaluations, designs = held["numbers"].tolist()
            return cls(
                held["generation"],
                held["genes"],
                held["best"],
                done,
                evaluations,
                designs,
                float(held["seconds"]),
            )


def run_search(work: Work, seed: int, *, user_start: bool, also: Sequence[StopRule] = ()) -> Result:
    """Run the genetic search of one trial; other rules may stop it earlier."""
    settings = replace(work.settings, seed=seed, user_start=user_start)
    stop = [*also, Generations(work.generations)]
    return search(work.space, work.rules, settings, work.benchmark, stop)


def record_of(result: Result) -> Record:
    """Return what is kept of a run."""
    state = result.state
    genes = state.changes.genes.astype(np.int32)
    best = state.best.genes.astype(np.int32) if state.best else genes[:0].reshape(0, genes.shape[2])
    designs = state.earlier_designs + len(state.designs)
    return Record(
        state.changes.generation,
        genes,
        best,
        state.generation,
        state.evaluations,
        designs,
        result.seconds,
    )


def run_trial(work: Work, seed: int, user_start: bool) -> Record:  # noqa: FBT001 (sent by position)
    """Run one trial, and return what is kept of it."""
    return record_of(run_search(work, seed, user_start=user_start))
