"""Scenes for the tests of the page: what it is given of a sample workbook, to be changed by tests."""

from __future__ import annotations

import base64
from pathlib import Path
from typing import Any

import numpy as np

import grasp_xl
from grasp_xl.chromosome import Chromosome, from_active
from grasp_xl.task import Task, settle
from grasp_xl.view.designs import Design
from grasp_xl.view.element_model import element_model
from grasp_xl.view.page import scene_data
from grasp_xl.view.part_shape import part_shape
from grasp_xl.view.scene import Scene
from grasp_xl.workbook.book import Book, read_book

VIEW = Path(grasp_xl.__file__).parent / "view"
WORKBOOKS = Path(__file__).parent.parent / "workbooks"

Data = dict[str, Any]
"""What the page is given."""

Named = tuple[str, str, Chromosome]
"""Group, name and genes of a design."""


def bracket_book() -> Book:
    """Return what the bracket's workbook says."""
    return read_book(WORKBOOKS / "bracket.xlsx")


def bracket_scene() -> Scene:
    """Return the bracket with its benchmark, two other designs, and one that meets nothing."""
    book = bracket_book()
    task = settle(book.space, book.parameters, book.user_chromosome)
    return scene_of(
        book,
        task,
        [
            ("Results", "Best of the run", from_active(task.space, [[15], [39, 50, 66]])),
            ("Results", "Fewer magnets", from_active(task.space, [[5, 22, 12], [16, 92]])),
            ("Benchmark", "User-defined (benchmark)", task.benchmark.chromosome),
            ("Valid Designs", "No. 1, generation 17", from_active(task.space, [[1, 2], [1]])),
        ],
    )


def scene_of(book: Book, task: Task, designs: list[Named]) -> Scene:
    """Return the scene of a task and some designs, the part by its faces alone."""
    nowhere = Path("bracket-result.xlsx")
    return Scene(
        nowhere.name,
        task,
        part_shape(task.space, book.part, nowhere, None),
        tuple(element_model(kind, None, 46.0, 0.0) for kind in task.space.kinds),
        found := tuple(Design(str(n), *named) for n, named in enumerate(designs)),
        found[0],
    )


def bracket_data() -> Data:
    """Return what the page is given of the bracket."""
    return scene_data(bracket_scene())


def mesh_of_size(size_mb: float) -> dict[str, str]:
    """Return a waved sheet as a mesh of so many megabytes."""
    # a corner is 12 bytes, and so is each of its two triangles
    side = int(np.sqrt(size_mb * 1e6 / 36))
    x, y = np.meshgrid(np.linspace(-170, 170, side), np.linspace(-60, 60, side))
    positions = np.stack([x, y, 100 + 4 * np.sin(x / 20)], axis=-1).reshape(-1, 3)
    corner = np.arange(side * side).reshape(side, side)
    a, b, c, d = corner[:-1, :-1], corner[:-1, 1:], corner[1:, 1:], corner[1:, :-1]
    triangles = np.stack([a, b, c, a, c, d], axis=-1).reshape(-1, 3)
    return {"positions": _packed(positions, "<f4"), "triangles": _packed(triangles, "<u4")}


def _packed(values: Any, form: str) -> str:
    return base64.b64encode(np.ascontiguousarray(values, dtype=form).tobytes()).decode()
