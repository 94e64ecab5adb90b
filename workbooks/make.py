"""Make the sample workbooks: each part's input, and beside it the result of 50,000 generations.

Run ``python workbooks/make.py`` to write them anew beside this file, or name a folder.
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

from parts import SamplePart, sample_parts

from grasp_xl.commands.new import make_workbook
from grasp_xl.commands.output import Output
from grasp_xl.commands.run import run_file
from grasp_xl.commands.solve import prove_run
from grasp_xl.search.stop import Generations
from grasp_xl.task import Parameters
from grasp_xl.workbook.writing import export_workbook

PROVE_SECONDS = 10.0
"""Longest proof, as by default; every sample needs less."""


def make_input(part: SamplePart, folder: Path) -> Path:
    """Write the full workbook of a part, with the designer's grasp in it."""
    book = folder / f"{part.name}.xlsx"
    with tempfile.TemporaryDirectory() as exports:
        export = Path(exports) / f"{part.name}-export.xlsx"
        export.write_bytes(export_workbook(part.space).content)
        grasp = (part.designer_suction, part.designer_magnets)
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


def main(folder: Path) -> None:
    """Write the workbooks of all sample parts."""
    for part in sample_parts():
        book = make_input(part, folder)
        print(f"{part.title}: {book.name}, {make_result(book).name}")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parent)
