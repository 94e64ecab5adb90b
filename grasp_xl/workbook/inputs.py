"""What a run depends on, as its Run Log keeps it: numbers and words by label, lists by a hash.

Other programs keep 15 digits of a number, so numbers are compared with a tolerance, and lists are
hashed in rounded digits.
"""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Mapping
from dataclasses import astuple

import numpy as np

from grasp_xl.chromosome import Chromosome
from grasp_xl.rules import TERMS
from grasp_xl.space import FloatArray, IntArray, OptionSpace
from grasp_xl.task import Task
from grasp_xl.workbook import layout
from grasp_xl.workbook.cells import shown
from grasp_xl.workbook.written import CellValue

SAME_RATIO, SAME_SIZE = 1e-12, 1e-9
"""Numbers that differ by less, relative or absolute, are the same input."""

KEPT_DIGITS = 15
"""Significant digits that every program keeps."""

PLACE_DECIMALS = 6
"""Decimals of a coordinate (mm) that tell two lists apart."""

GENERATIONS = "Generations asked for"
BENCHMARK = "Benchmark"
BENCHMARK_GENES = "Benchmark grasp (genes)"
LEFT_OUT = "Terms left out"
REQUIREMENTS = ("FoS goal", "Minimum distance (mm)", "Density ratio", "Moment arm")
GOALS = tuple(f"Goal: {term}" for term in TERMS)
LISTS = (*(labels.locations_label for labels in layout.KINDS), layout.APPROXIMATION_LABEL)
"""Labels of rows."""


def parameter_rows(task: Task) -> dict[str, CellValue]:
    """Return the settled parameters."""
    need, goals = task.rules.requirements, task.rules.goals
    return {
        "User-defined start": int(task.settings.user_start),
        BENCHMARK: "program-assigned" if task.assigned else "user-defined",
        "Elitism": int(task.settings.elitism),
        "1-in-n mutation": task.settings.one_in,
        "Children per generation": task.settings.children,
        GENERATIONS: task.generations,
        **dict(zip(REQUIREMENTS, astuple(need), strict=True)),
        "Criterion": task.rules.criterion.name,
        **dict(zip(GOALS, goals.base, strict=True)),
        LEFT_OUT: ", ".join(sorted(goals.dropped)) or "none",
    }


def space_rows(space: OptionSpace) -> dict[str, CellValue]:
    """Return the numbers of the option space that a run depends on, and a hash of each list."""
    part = (space.part.mass_g, *space.part.centroid_mm.tolist())
    rows: dict[str, CellValue] = {
        field.label: value for field, value in zip(layout.PART.fields, part, strict=True)
    }
    for labels, kind in zip(layout.KINDS, space.kinds, strict=True):
        numbers = (kind.count_min, kind.count_max, kind.force_n, kind.price)
        for field, value in zip(labels.section.fields, numbers, strict=False):
            rows[f"{labels.section.heading}: {field.label}"] = value
    rows["Scale Factor"] = space.scale_factor
    for labels, kind in zip(layout.KINDS, space.kinds, strict=True):
        rows[labels.locations_label] = _hash(kind.footprints_mm)
    rows[layout.APPROXIMATION_LABEL] = _hash(space.approximation_polygon_mm)
    return rows


def input_rows(task: Task) -> dict[str, CellValue]:
    """Return everything that a run's course depends on."""
    rows = {"Seed": task.settings.seed, **parameter_rows(task), **space_rows(task.space)}
    for label in (GENERATIONS, BENCHMARK):
        del rows[label]
    return {**rows, BENCHMARK_GENES: genes_text(task.benchmark.chromosome)}


def inputs_hash(task: Task) -> str:
    """Return a hash of everything that a run's course depends on."""
    rows = {
        label: f"{value:.12g}" if isinstance(value, float) else value
        for label, value in input_rows(task).items()
    }
    return hashlib.sha256(json.dumps(rows).encode()).hexdigest()


def trade_off_rows(task: Task) -> dict[str, CellValue]:
    """Return everything that the trade-offs depend on: what is searched, and how it is judged."""
    rows = parameter_rows(task)
    judged = {label: rows[label] for label in (*REQUIREMENTS, *GOALS, LEFT_OUT)}
    return {**judged, **space_rows(task.space)}


def changed_inputs(
    task: Task, logged: Mapping[str, object], rows: Mapping[str, CellValue] | None = None
) -> list[str]:
    """Say which inputs are others than a Run Log's; what only follows from them is left out.

    ``rows`` are the inputs that matter, by label; by default all that a run's course depends on.
    """
    changed = {
        label: label if label in LISTS else f"{label} {_told(value)}, not {_told(before)}"
        for label, value in (rows or input_rows(task)).items()
        if not _alike(value, before := logged.get(label))
    }
    follows = {LEFT_OUT, *([BENCHMARK_GENES] if task.assigned else [])}
    typed = task.parameters.goals
    follows |= {label for label, goal in zip(GOALS, typed, strict=True) if goal is None}
    causes = [told for label, told in changed.items() if label not in follows]
    return causes or list(changed.values())


def genes_text(chromosome: Chromosome | None) -> str:
    """Return genes as one line of text, empty for none."""
    return json.dumps(chromosome.genes.tolist()) if chromosome else ""


def genes_of_text(text: object) -> IntArray:
    """Return the genes that :func:`genes_text` wrote, unchecked.

    Raises
    ------
    ValueError
        If the text is empty, or no such text.
    """
    return np.array(json.loads(str(text)))


def _alike(value: CellValue, logged: object) -> bool:
    if isinstance(value, float) and isinstance(logged, int | float):
        return math.isclose(value, logged, rel_tol=SAME_RATIO, abs_tol=SAME_SIZE)
    return value == logged


def _told(value: object) -> str:
    if value is None:
        return "nothing"
    return shown(value) if isinstance(value, int | float) else str(value)


def _hash(places_mm: FloatArray) -> str:
    """Hash coordinates: the digits that every program keeps, then so many decimals of them."""
    kept = (float(f"{place:.{KEPT_DIGITS}g}") for place in places_mm.ravel().tolist())
    rounded = [round(place, PLACE_DECIMALS) + 0.0 for place in kept]  # no -0.0
    return hashlib.sha256(json.dumps(rounded).encode()).hexdigest()
