"""What ``check`` says of a file."""

from dataclasses import dataclass
from pathlib import Path

from grasp_xl.commands.preparing import prepare, refuse_infeasible, with_floor_warnings
from grasp_xl.errors import InfeasibleError, Problem
from grasp_xl.rules import Terms
from grasp_xl.search.feasibility import lifting_counts, max_fos
from grasp_xl.search.floors import floors, search_space
from grasp_xl.space import OptionSpace
from grasp_xl.task import Parameters, settle_requirements
from grasp_xl.workbook.book import Book, read_book


@dataclass(frozen=True, eq=False, slots=True)
class Checked:
    """What ``check`` says of a readable file.

    Parameters
    ----------
    space, warnings, search_space, max_fos
    floors : Terms or None
        None where no counts meet FoS.
    obstacle : InfeasibleError or None
        Why no grasp meets FoS and clearance.
    """

    space: OptionSpace
    warnings: tuple[Problem, ...]
    search_space: int
    max_fos: float
    floors: Terms | None
    obstacle: InfeasibleError | None


def check_file(path: Path, options: Parameters) -> Checked:
    """Read and validate a file, and look whether any grasp can exist.

    Raises
    ------
    InputError
        With every problem found.
    """
    return check_book(read_book(path), options)


def check_book(book: Book, options: Parameters) -> Checked:
    """Look whether any grasp of a workbook can exist, and what it can reach."""
    space, warnings, obstacle = book.space, book.warnings, None
    need = settle_requirements(space, options.over(book.parameters))
    least = floors(space, need) if lifting_counts(space, need) else None
    try:
        task = prepare(book, options)
        refuse_infeasible(task)
        warnings = (with_floor_warnings(task, least) if least else task).warnings
    except InfeasibleError as error:
        obstacle = error
    return Checked(space, warnings, search_space(space), max_fos(space), least, obstacle)
