"""Which designs a workbook holds, and how a person names one of them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from grasp_xl.chromosome import Chromosome, is_usable
from grasp_xl.errors import UsageError
from grasp_xl.printable import quoted
from grasp_xl.rounding import percent
from grasp_xl.rules import TERMS, Terms
from grasp_xl.space import OptionSpace
from grasp_xl.task import Task
from grasp_xl.workbook.book import Book
from grasp_xl.workbook.layout import TRADE_OFFS, VALID_DESIGNS
from grasp_xl.workbook.reading_run import SavedRun, shown_proof
from grasp_xl.workbook.trade_offs_sheet import TradeOff

GIVEN, PROVED, BEST, WHAT_IF, BENCHMARK = "given", "proved", "best", "what-if", "benchmark"
VALID, TRADE_OFF = "valid", "trade-off"
"""Keys of designs; those of a list have a number behind them: ``valid-3``."""

FIRST_SHOWN = (GIVEN, PROVED, BEST, WHAT_IF, f"{TRADE_OFF}-1", BENCHMARK)
"""Of these keys the first that is there names the design that is shown unless one is asked for."""


@dataclass(frozen=True, slots=True)
class Design:
    """A grasp with a name.

    Parameters
    ----------
    key : str
        How options name it.
    group, name : str
        Where it stands in a list, and what it is called there.
    chromosome : Chromosome
    """

    key: str
    group: str
    name: str
    chromosome: Chromosome


def designs_of(
    book: Book, run: SavedRun | None, task: Task, given: Chromosome | None = None
) -> tuple[Design, ...]:
    """Return the designs of a workbook that its option space still has.

    Parameters
    ----------
    book : Book
    run : SavedRun or None
        That it shows.
    task : Task
    given : Chromosome, optional
        A grasp that a person asked for beside them.
    """
    found = [*_single(book, run, task, given), *_valid(run), *_trade_offs(book)]
    return tuple(design for design in found if _is_of(design.chromosome, task.space))


def chosen(designs: Sequence[Design], key: str | None) -> Design:
    """Return the design of a key; without one, that which says most.

    Raises
    ------
    UsageError
        If there is none, naming those there are.
    """
    by_key = {design.key: design for design in designs}
    if key is None:
        return next(by_key[first] for first in FIRST_SHOWN if first in by_key)
    if key in by_key:
        return by_key[key]
    listed = [each for each in by_key if not each[-1].isdigit()]
    for word in (VALID, TRADE_OFF):
        numbered = [key for key in by_key if key.startswith(f"{word}-")]
        listed += [f"{numbered[0]} to {numbered[-1]}"] if numbered else []
    raise UsageError(
        f"--design: found {quoted(key)}, expected one of {', '.join(listed)}.",
        where="--design",
        hint="Name a design that the workbook has",
    )


def _single(
    book: Book, run: SavedRun | None, task: Task, given: Chromosome | None
) -> Iterator[Design]:
    if given:
        yield Design(GIVEN, "Given", "Given grasp", given)
    proof = shown_proof(book.source, task)
    if proof and proof.grasp:
        yield Design(PROVED, "Results", proof.title, proof.grasp.chromosome)
    if run and run.state.best:
        yield Design(BEST, "Results", "Best of the run", run.state.best)
    if book.what_if:
        yield Design(WHAT_IF, "Results", "What-if card", book.what_if)
    who = "Program-assigned" if task.assigned else "User-defined"
    yield Design(BENCHMARK, "Benchmark", f"{who} (benchmark)", task.benchmark.chromosome)


def _valid(run: SavedRun | None) -> Iterator[Design]:
    if run is None:
        return
    designs = run.state.designs
    for number, (generation, genes) in enumerate(
        zip(designs.generation.tolist(), designs.genes, strict=True), 1
    ):
        name = f"No. {number}, generation {generation:,}"
        yield Design(f"{VALID}-{number}", VALID_DESIGNS, name, Chromosome(genes))


def _trade_offs(book: Book) -> Iterator[Design]:
    for design in book.trade_offs.designs if book.trade_offs else ():
        key = f"{TRADE_OFF}-{design.number}"
        yield Design(key, TRADE_OFFS, _trade_off_name(design), design.chromosome)


def _trade_off_name(design: TradeOff) -> str:
    return f"No. {design.number}, {_weights(design.weights) or 'met on the way'}" + (
        " (proved)" if design.proved else ""
    )


def _weights(weights: Terms | None) -> str:
    """Name the sum of which a design is the optimum.

    Examples
    --------
    >>> _weights(Terms(0.25, 0.75, 0.0, 0.0)), _weights(None)
    ('25 % cost, 75 % moment', '')
    """
    shares = zip(weights or (), TERMS, strict=False)
    return ", ".join(f"{percent(weight)} {term}" for weight, term in shares if weight)


def _is_of(chromosome: Chromosome, space: OptionSpace) -> bool:
    shape = (len(space.kinds), 1 + space.gene_slots)
    return chromosome.genes.shape == shape and is_usable(chromosome, space)
