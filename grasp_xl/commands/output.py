"""Where results go, and the workbook that is written there."""

from dataclasses import dataclass
from datetime import datetime
from pathlib import Path

from grasp_xl.search.genetic import search
from grasp_xl.search.result import Result, State
from grasp_xl.search.stop import Generations
from grasp_xl.task import Task
from grasp_xl.workbook.book import Book
from grasp_xl.workbook.grasp_sheet import Rendering
from grasp_xl.workbook.macros import Macros
from grasp_xl.workbook.proved import Proved
from grasp_xl.workbook.run_log import Origin
from grasp_xl.workbook.saving import MACRO_SUFFIX
from grasp_xl.workbook.trade_offs_sheet import TradeOffs
from grasp_xl.workbook.writing import full_workbook
from grasp_xl.workbook.written import WrittenBook


@dataclass(frozen=True, slots=True)
class Output:
    """Where results go, and what may be overwritten for them.

    Parameters
    ----------
    path : Path
        Workbook.
    in_place : bool
        Whether it is the input.
    force : bool
        Overwrite what was edited, lose what cannot be carried over.
    history : Path, optional
        CSV file with every change of the fittest.
    """

    path: Path
    in_place: bool = False
    force: bool = False
    history: Path | None = None


def not_begun(task: Task, state: State | None = None) -> Result:
    """Return the result of no generation at all, or of none after a state."""
    stop = [Generations(0)]
    benchmark = task.benchmark.chromosome
    return search(task.space, task.rules, task.settings, benchmark, stop, state=state)


def written_book(
    task: Task,
    result: Result,
    book: Book,
    began: datetime,
    *,
    proved: Proved | None = None,
    trade_offs: TradeOffs | None = None,
    macros: Macros | None = None,
    rendering: Rendering | None = None,
) -> WrittenBook:
    """Write the full workbook of a task and its result."""
    name = Path(book.source.name).name.encode(errors="backslashreplace").decode()
    return full_workbook(
        task,
        result,
        Origin(name, book.package.sha256 if book.package else "", began, now()),
        what_if=book.what_if,
        picks=book.picks,
        set_aside=book.set_aside,
        proved=proved,
        trade_offs=trade_offs,
        part=book.part,
        macros=macros,
        rendering=rendering,
    )


def macros_at(path: Path, book: Book) -> Macros | None:
    """Return the macros of a workbook to be written at a path: those of another, else ours."""
    if path.suffix.lower() != MACRO_SUFFIX:
        return None
    return (book.macros or Macros()).at_home()


def now() -> datetime:
    """Return the local time, which is what a workbook shows."""
    return datetime.now()  # noqa: DTZ005
