"""What ``evaluate`` says of a grasp."""

from pathlib import Path

from grasp_xl.commands.preparing import Active, given_grasp, prepare_to_judge
from grasp_xl.grasp import Grasp, evaluate
from grasp_xl.task import Parameters, Task
from grasp_xl.workbook.book import read_book


def evaluate_grasp(path: Path, options: Parameters, grasp: Active) -> tuple[Task, Grasp]:
    """Judge one grasp; the user-defined one where options name none."""
    book = read_book(path)
    given = given_grasp(book.space, grasp)
    task = prepare_to_judge(book, options, given)
    return task, evaluate(task.space, task.rules, given) if given else task.benchmark
