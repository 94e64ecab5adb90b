"""From a study to its workbook: one function that reads as the table of contents."""

from __future__ import annotations

import io
from collections.abc import Mapping

from grasp_xl.study.case_sheet import write_case
from grasp_xl.study.course_data import write_courses
from grasp_xl.study.fitness_blocks import write_fitness_blocks
from grasp_xl.study.runs_sheet import write_runs
from grasp_xl.study.summary import Study
from grasp_xl.study.summary_sheet import write_summary
from grasp_xl.workbook.pen import Pen
from grasp_xl.workbook.stamp import PLACEHOLDER, STAMP_PROPERTY, stamped
from grasp_xl.workbook.styles import Formats
from grasp_xl.workbook.writing import AT_NO_TIME, new_book

SUMMARY, RUNS = "Summary", "Runs"


def study_workbook(study: Study, links: Mapping[str, str] | None = None) -> bytes:
    """Write the workbook of a study.

    Parameters
    ----------
    study : Study
    links : mapping of str to str, optional
        Label of a run to its own workbook, seen from the study's folder.

    Returns
    -------
    bytes
        The file; but for the seconds of runs and proofs it is the same for the same study.
    """
    file = io.BytesIO()
    book = new_book(file, AT_NO_TIME)
    formats = Formats(book)
    told = f"Seed {study.plan.seed}, {study.done:,} of {len(study.plan):,} runs"

    def pen(name: str) -> Pen:
        return Pen(book, formats, name, told)

    write_summary(pen(SUMMARY), study)
    for case in study.cases:
        label = case.case.label
        charts, fitness, data = pen(label), pen(f"{label} Fitness"), pen(f"{label} Courses")
        courses = write_courses(data, case)
        write_case(charts, book, case, courses)
        write_fitness_blocks(fitness, case)
    write_runs(pen(RUNS), study, links or {})
    book.set_custom_property(STAMP_PROPERTY, PLACEHOLDER)
    book.close()
    return stamped(file.getvalue())
