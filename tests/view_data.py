"""Scenes for the tests of the page: what it is given, made from a sample workbook."""

from __future__ import annotations

import base64
import hashlib
import html
import json
import re
from pathlib import Path
from typing import Any

import numpy as np

import grasp_xl
from grasp_xl.chromosome import Chromosome, from_active
from grasp_xl.grasp import evaluate
from grasp_xl.rules import TERMS
from grasp_xl.task import Task, settle
from grasp_xl.workbook.book import Book, read_book

VIEW = Path(grasp_xl.__file__).parent / "view"
WORKBOOKS = Path(__file__).parent.parent / "workbooks"

Scene = dict[str, Any]

SIZE_MM = 46.0
CUP = [[0, 0], [23, 0], [14, 14], [7, 14], [7, 37], [0, 37]]
MAGNET = [[0, 0], [23, 0], [23, 23], [7, 23], [7, 37], [0, 37]]
COLOURS = ("#00b8d4", "#d6249f")


def packed(values: Any, form: str) -> str:
    """Pack numbers as the page reads them."""
    return base64.b64encode(np.ascontiguousarray(values, dtype=form).tobytes()).decode()


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
        task,
        faces_of(book),
        [
            ("Results", "Best of the run", from_active(task.space, [[15], [39, 50, 66]])),
            ("Results", "Fewer magnets", from_active(task.space, [[5, 22, 12], [16, 92]])),
            ("Benchmark", "User-defined (benchmark)", task.benchmark.chromosome),
            ("Valid Designs", "No. 1, generation 17", from_active(task.space, [[1, 2], [1]])),
        ],
    )


def scene_of(task: Task, faces: list[dict[str, Any]], designs: list[Named]) -> Scene:
    """Return the scene of a task and some designs."""
    rules = task.rules
    return {
        "title": "bracket-result.xlsx",
        "part": {
            "name": "bracket.step",
            "mass_g": task.space.part.mass_g,
            "weight_n": task.space.part.weight_n,
            "centroid_mm": task.space.part.centroid_mm.tolist(),
            "mesh": None,
            "faces": faces,
        },
        "part_polygon_mm": task.space.approximation_polygon_mm.tolist(),
        "ideal_polygon_mm": task.space.ideal_polygon_mm.tolist(),
        "kinds": [kind_of(task, number) for number in range(2)],
        "frame": {"main_radius_mm": 9.2, "branch_radius_mm": 5.5, "rise_mm": 23},
        "rules": {
            "fos": rules.requirements.fos,
            "clearance_mm": rules.requirements.clearance_mm,
            "density_ratio": rules.requirements.density_ratio,
            "moment_arm": rules.requirements.moment_arm,
            "goals": {
                term: None if term in rules.goals.dropped else goal
                for term, goal in zip(TERMS, rules.goals.base, strict=True)
            },
            "criterion": rules.criterion.name,
        },
        "gene_slots": task.space.gene_slots,
        "designs": [design_of(task, *named) for named in designs],
        "shown": 0,
    }


def faces_of(book: Book) -> list[dict[str, Any]]:
    """Return the level faces of the sheet Part."""
    return [
        {"z_mm": face.height_mm, "rings": [ring.tolist() for ring in face.rings]}
        for face in (book.part.outlines if book.part else ())
        if face.height_mm is not None
    ]


def kind_of(task: Task, number: int) -> dict[str, Any]:
    """Return one kind of element."""
    kind = task.space.kinds[number]
    return {
        "name": kind.name,
        "label": ("Suction cup", "Magnet")[number],
        "model": kind.model,
        "force_n": kind.force_n,
        "price": kind.price,
        "weight_g": kind.weight_g,
        "count_min": kind.count_min,
        "count_max": kind.most,
        "footprints_mm": packed(kind.footprints_mm, "<f8"),
        "colour": COLOURS[number],
        "height_mm": 0.8 * SIZE_MM,
        "solids": [{"colour": COLOURS[number], "profile_mm": (CUP, MAGNET)[number]}],
        "post_radius_mm": 0.15 * SIZE_MM,
    }


def design_of(task: Task, group: str, name: str, chromosome: Chromosome) -> dict[str, Any]:
    """Return one design with its card."""
    grasp = evaluate(task.space, task.rules, chromosome)
    return {
        "group": group,
        "name": name,
        "note": "",
        "genes": chromosome.rows(),
        "card": {
            "force_n": grasp.force_n,
            "fos": grasp.fos,
            **grasp.terms._asdict(),
            "divergence": grasp.divergence,
            "clearance": grasp.clearance_mm,
            "feasible": grasp.feasible,
            "meets_all_goals": grasp.meets_all_goals,
        },
    }


def mesh_of_size(size_mb: float) -> dict[str, str]:
    """Return a waved sheet as a mesh of so many megabytes."""
    # a corner is 12 bytes, and so is each of its two triangles
    side = int(np.sqrt(size_mb * 1e6 / 36))
    x, y = np.meshgrid(np.linspace(-170, 170, side), np.linspace(-60, 60, side))
    positions = np.stack([x, y, 100 + 4 * np.sin(x / 20)], axis=-1).reshape(-1, 3)
    corner = np.arange(side * side).reshape(side, side)
    a, b, c, d = corner[:-1, :-1], corner[:-1, 1:], corner[1:, 1:], corner[1:, :-1]
    triangles = np.stack([a, b, c, a, c, d], axis=-1).reshape(-1, 3)
    return {"positions": packed(positions, "<f4"), "triangles": packed(triangles, "<u4")}


def assembled(scene: Scene) -> bytes:
    """Put a scene into the page's template."""
    style = (VIEW / "page.css").read_text(encoding="utf-8")
    script = (VIEW / "viewer.js").read_text(encoding="utf-8")
    parts = {
        "TITLE": html.escape(scene["title"]),
        "SCENE": json.dumps(scene).replace("<", "\\u003c"),
        "STYLE": style,
        "SCRIPT": script,
        "POLICY": policy(style, script),
    }
    template = (VIEW / "page.html").read_text(encoding="utf-8")
    return re.sub(r"\{\{([A-Z]+)\}\}", lambda mark: parts[mark[1]], template).encode()


def policy(style: str, script: str) -> str:
    """Return the content security policy that lets this style and this script in, and no more."""
    hashes = [
        base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()
        for text in (style, script)
    ]
    return (
        f"default-src 'none'; style-src 'sha256-{hashes[0]}'; script-src 'sha256-{hashes[1]}'; "
        "img-src data:; base-uri 'none'; form-action 'none'"
    )
