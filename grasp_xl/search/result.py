"""What a genetic run found, and everything that is needed to go on from it."""

from __future__ import annotations

import json
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from grasp_xl.chromosome import Chromosome
from grasp_xl.grasp import Grasp
from grasp_xl.kernels import measure_rows, tabulate
from grasp_xl.rules import SLACK, TERMS, Rules
from grasp_xl.search.stop import StopReason
from grasp_xl.space import IntArray, OptionSpace

if TYPE_CHECKING:
    import pandas as pd

Rows = npt.NDArray[np.void]
"""A structured array: a row a grasp, a field a column."""

REPORT_GENERATIONS = (1, 10, 100, 1_000, 10_000, 50_000)
"""Generations of the thesis's fitness tables (tables 4 and 5)."""


@dataclass(frozen=True, slots=True)
class GeneticSettings:
    """Parameters of the genetic algorithm (figures 27 and 39).

    Parameters
    ----------
    one_in : float
        n of the 1-in-n mutation probability, >= 1.
    children : int
        Children a generation, >= 2.
    elitism, user_start : bool
        Keep the parent as child 1; start from the user-defined chromosome.
    seed : int
        Seed of the run's one random stream, >= 0.
    """

    one_in: float = 4.0
    children: int = 5
    elitism: bool = True
    user_start: bool = True
    seed: int = 1


@dataclass(frozen=True, eq=False, slots=True)
class Trace:
    """Chromosomes and the generations at which they appeared.

    ``generation (n,)``, rising; ``genes (n, kinds, 1 + slots)``.
    """

    generation: IntArray
    genes: IntArray

    def __len__(self) -> int:
        return len(self.generation)


def empty_trace(space: OptionSpace) -> Trace:
    """Return a trace of nothing."""
    shape = (0, len(space.kinds), 1 + space.gene_slots)
    return Trace(np.zeros(0, dtype=np.int64), np.zeros(shape, dtype=np.int64))


@dataclass(frozen=True, eq=False, slots=True)
class State:
    """Where a run stands; another call goes on from here as if it had never stopped.

    Parameters
    ----------
    generation, evaluations : int
        Done so far.
    parent : Chromosome
        Fittest of the last generation.
    random_state : str
        State of the random stream, JSON.
    random_chromosome, initial : Chromosome
        What the randomizer drew, and what the run began with (figure 28).
    changes, designs : Trace
        The fittest where it changed, and the valid designs.
    best : Chromosome or None
        Best grasp ever seen.
    improved_at : int
        Generation at which it was.
    earlier_designs : int
        Valid designs found before those in ``designs``, which a workbook no longer listed.
    complete_from : int
        Generation from which ``changes`` has all; a workbook may not have listed earlier ones.
    """

    generation: int
    evaluations: int
    parent: Chromosome
    random_state: str
    random_chromosome: Chromosome
    initial: Chromosome
    changes: Trace
    designs: Trace
    best: Chromosome | None
    improved_at: int
    earlier_designs: int = 0
    complete_from: int = 1


@dataclass(frozen=True, eq=False)
class Result:
    """A finished (or interrupted) genetic run."""

    space: OptionSpace
    rules: Rules
    settings: GeneticSettings
    benchmark: Grasp
    state: State
    matrix: IntArray
    children: tuple[Chromosome, ...]
    best: Grasp | None
    stop_reason: StopReason
    seconds: float

    @cached_property
    def history_rows(self) -> Rows:
        """The generations where the fittest changed, and the last one."""
        rows = measured_rows(self.space, self.rules, self.state.changes)
        if not len(rows) or rows["generation"][-1] == self.state.generation:
            return rows
        rows = np.append(rows, rows[-1:])
        rows["generation"][-1] = self.state.generation
        return rows

    @cached_property
    def design_rows(self) -> Rows:
        """The valid-design list (section 5.2.5), oldest first."""
        return measured_rows(self.space, self.rules, self.state.designs)

    def history(self) -> pd.DataFrame:
        """Return ``history_rows`` as a table: one row a change, columns as of `measured_rows`."""
        return _table(self.history_rows)

    def valid_designs(self) -> pd.DataFrame:
        """Return ``design_rows`` as a table: one row a design, columns as of `measured_rows`."""
        return _table(self.design_rows)

    def at_generation(self, generation: int) -> Chromosome:
        """Return the fittest of a generation that the run has done."""
        changes = self.state.changes
        row = int(np.searchsorted(changes.generation, generation, side="right")) - 1
        return Chromosome(changes.genes[row])

    def report_generations(self) -> list[int]:
        """Return the generations of the fitness table that the run reached, and the last."""
        done = self.state.generation
        return sorted({g for g in REPORT_GENERATIONS if g <= done} | ({done} if done else set()))


def gene_columns(space: OptionSpace) -> list[str]:
    """Column names of all genes: ``suction``, ``S1``.., ``magnets``, ``M1``.."""
    return [
        name
        for kind in space.kinds
        for name in (
            kind.name,
            *(f"{kind.name[0].upper()}{slot}" for slot in range(1, 1 + space.gene_slots)),
        )
    ]


def measured_rows(space: OptionSpace, rules: Rules, trace: Trace) -> Rows:
    """Measure a trace: what the criteria say of its genes.

    Returns
    -------
    Rows
        ``(n,)``, fields ``generation``, ``fos``, the four terms, ``divergence``, what is normalised
        of FoS and of each term (NaN where FoS or clearance fails), ``meets_all_goals``, and the
        genes.
    """
    measured = measure_rows(tabulate(space, rules), trace.genes)
    terms = measured[:, 1:5]
    goals = rules.goals
    base = [np.nan if term in goals.dropped else getattr(goals.base, term) for term in TERMS]
    normalised = terms / np.array(base)
    divergence = np.nansum(normalised, axis=1)
    feasible = measured[:, 5] == 1
    meets = feasible & ~(normalised > 1 + SLACK).any(axis=1)
    columns: dict[str, Any] = {"generation": trace.generation, "fos": measured[:, 0]}
    columns |= dict(zip(TERMS, np.where(feasible[:, None], terms, np.nan).T, strict=True))
    columns["divergence"] = np.where(feasible, divergence, np.nan)
    columns["normalised_fos"] = rules.requirements.fos / measured[:, 0]
    for number, term in enumerate(TERMS):
        columns[f"normalised_{term}"] = np.where(feasible, normalised[:, number], np.nan)
    columns["meets_all_goals"] = meets
    genes = trace.genes.reshape(len(trace), len(gene_columns(space)))
    columns |= dict(zip(gene_columns(space), genes.T, strict=True))
    rows = np.empty(len(trace), [(name, column.dtype) for name, column in columns.items()])
    for name, column in columns.items():
        rows[name] = column
    return rows


def _table(rows: Rows) -> pd.DataFrame:
    import pandas as pd  # takes long to load, and a run needs no table

    return pd.DataFrame(rows)


def dump_stream(rng: np.random.Generator) -> str:
    """Return the state of a random stream as text that :func:`load_stream` reads."""
    return json.dumps(rng.bit_generator.state, separators=(",", ":"))


def load_stream(text: str) -> np.random.Generator:
    """Return the random stream whose state :func:`dump_stream` wrote.

    Raises
    ------
    ValueError
        If the text is no such state.
    """
    rng = np.random.default_rng()
    try:
        rng.bit_generator.state = json.loads(text)
    except (TypeError, KeyError, AttributeError) as error:
        raise ValueError("no state of a random stream") from error
    return rng
