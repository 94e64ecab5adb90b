"""Make the sample parts: of each the solid, the workbook, and the result of 50,000 generations.

And the study of all of them (docs/study.md).  Run ``python workbooks/make.py`` to write them anew
beside this file, or name a folder.
"""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

from parts import SAMPLE_PARTS, SamplePart
from shapes import write_step

from grasp_xl.commands.fit import fit_file
from grasp_xl.commands.new import make_workbook
from grasp_xl.commands.output import Output
from grasp_xl.commands.run import run_file
from grasp_xl.commands.solve import prove_run
from grasp_xl.commands.study import StudyOutput, study_files
from grasp_xl.search.stop import Generations, Interrupt
from grasp_xl.study.description import Description
from grasp_xl.study.execution import run_here
from grasp_xl.study.records import records_path
from grasp_xl.task import Parameters

STUDY, STUDY_RUNS = "study.xlsx", 100
"""The study of all parts, and its runs of each start."""

PROVE_SECONDS = 10.0
"""Longest proof, as by default; every sample needs less."""


def make_step(part: SamplePart, folder: Path) -> Path:
    """Model a part and write its solid."""
    step = folder / f"{part.name}.step"
    write_step(part.model(), part.name, step)
    return step


def make_input(part: SamplePart, step: Path) -> Path:
    """Fit the elements on a solid, and write its full workbook with the designer's grasp in it."""
    book = step.with_suffix(".xlsx")
    with tempfile.TemporaryDirectory() as exports:
        export = Path(exports) / f"{part.name}-export.xlsx"
        fitted = fit_file(part.request(step), export, force=True).fitted
        grasp = part.designer_grasp(fitted.space)
        make_workbook(export, Parameters(), Output(book, force=True), grasp)
    return book


def make_result(book: Path) -> Path:
    """Run the thesis's protocol on a workbook and write the result beside it."""
    result = book.with_name(f"{book.stem}-result.xlsx")
    run_file(
        book,
        Parameters(),
        Output(result, force=True),
        stop=lambda task: [Generations(task.generations)],
        prove=lambda task, found: prove_run(task, found, result, PROVE_SECONDS),
    )
    return result


def make_study(books: Sequence[Path]) -> Path:
    """Run the parts many times and write the study beside them; its runs are not kept."""
    output = books[0].with_name(STUDY)
    described = Description(workbooks=tuple(books), runs=STUDY_RUNS)
    study_files(described, Parameters(), StudyOutput(output, force=True), run_here, Interrupt())
    records_path(output).unlink()
    return output


def main(folder: Path) -> None:
    """Write the files of all sample parts, and the study."""
    books = []
    for part in SAMPLE_PARTS:
        step = make_step(part, folder)
        book = make_input(part, step)
        books.append(book)
        print(f"{part.title}: {step.name}, {book.name}, {make_result(book).name}")
    print(make_study(books).name)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parent)
