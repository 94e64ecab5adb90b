"""The page that shows a workbook's designs in three dimensions: one file, without a network."""

from __future__ import annotations

import base64
import hashlib
import html
import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import shapely

from grasp_xl.bill import ELEMENT_WORDS
from grasp_xl.fitment.part import rings_of
from grasp_xl.grasp import Grasp
from grasp_xl.rules import TERMS
from grasp_xl.space import FloatArray
from grasp_xl.view.assembly import ELEMENT_COLOURS
from grasp_xl.view.designs import Design
from grasp_xl.view.element_model import ElementModel
from grasp_xl.view.meshes import indexed, triangles_of
from grasp_xl.view.part_shape import PartShape
from grasp_xl.view.scene import Scene
from grasp_xl.view.solids import Block, Solid, Turned

HERE = Path(__file__).parent
TEMPLATE, STYLE, SCRIPT = HERE / "page.html", HERE / "page.css", HERE / "viewer.js"

HOLE = re.compile(r"\{\{([A-Z]+)\}\}")
"""Where a part of the page goes into its template."""

Json = dict[str, Any]


def page_of(scene: Scene) -> bytes:
    """Return the page."""
    return assembled(scene_data(scene))


def assembled(data: Json) -> bytes:
    """Put what the page is given into its template."""
    style, script = STYLE.read_text(encoding="utf-8"), SCRIPT.read_text(encoding="utf-8")
    told = json.dumps(data, allow_nan=False, separators=(",", ":"))
    parts = {
        "POLICY": _policy(style, script),
        "TITLE": html.escape(data["title"]),
        "SCENE": told.replace("<", "\\u003c"),
        "STYLE": style,
        "SCRIPT": script,
    }
    page = TEMPLATE.read_text(encoding="utf-8")
    return HOLE.sub(lambda mark: parts[mark[1]], page).encode()


def _policy(style: str, script: str) -> str:
    """Return the content security policy that lets this style and this script in, and no more."""
    styles, scripts = (
        base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()
        for text in (style, script)
    )
    return (
        f"default-src 'none'; style-src 'sha256-{styles}'; script-src 'sha256-{scripts}'; "
        "img-src data:; base-uri 'none'; form-action 'none'"
    )


def scene_data(scene: Scene) -> Json:
    """Return what the page is given, as JSON has it; lengths in mm, forces in N, weights in g."""
    task = scene.task
    space, rules = task.space, task.rules
    sizes = scene.sizes
    return {
        "title": scene.title,
        "part": {
            "name": scene.part.name,
            "mass_g": space.part.mass_g,
            "weight_n": space.part.weight_n,
            "centroid_mm": space.part.centroid_mm.tolist(),
            **_shape(scene.part),
        },
        "part_polygon_mm": space.approximation_polygon_mm.tolist(),
        "ideal_polygon_mm": space.ideal_polygon_mm.tolist(),
        "kinds": [_kind(scene, number) for number in range(len(space.kinds))],
        "frame": {
            "main_radius_mm": sizes.main_radius_mm,
            "branch_radius_mm": sizes.branch_radius_mm,
            "rise_mm": sizes.rise_mm,
        },
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
        "gene_slots": space.gene_slots,
        "designs": [_design(scene, design) for design in scene.designs],
        "shown": scene.designs.index(scene.shown),
    }


def _shape(part: PartShape) -> Json:
    """Return the triangles of a part that has a body, else the outlines of its faces."""
    solid = [plate for plate in part.plates if plate.high_mm > plate.low_mm]
    if part.solid:
        return {"mesh": _mesh(part.solid.mesh), "faces": []}
    if solid:
        return {"mesh": _mesh(triangles_of(solid[0])), "faces": []}
    return {
        "mesh": None,
        "faces": [
            {"z_mm": plate.low_mm, "rings": [ring.tolist() for ring in rings_of(plate.area)]}
            for plate in part.plates
            if not shapely.is_empty(plate.area)
        ],
    }


def _mesh(triangles_mm: FloatArray) -> Json:
    places, triangles = indexed(triangles_mm)
    return {"positions": _packed(places, "<f4"), "triangles": _packed(triangles, "<u4")}


def _packed(values: Any, form: str) -> str:  # noqa: ANN401 (any array)
    return base64.b64encode(np.ascontiguousarray(values, dtype=form).tobytes()).decode()


def _kind(scene: Scene, number: int) -> Json:
    kind, model = scene.task.space.kinds[number], scene.models[number]
    return {
        "name": kind.name,
        "label": ELEMENT_WORDS[number],
        "model": kind.model,
        "force_n": kind.force_n,
        "price": kind.price,
        "weight_g": kind.weight_g,
        "count_min": kind.count_min,
        "count_max": kind.most,
        "footprints_mm": _packed(kind.footprints_mm, "<f8"),
        "colour": ELEMENT_COLOURS[number],
        "height_mm": model.height_mm,
        "solids": _solids(model, ELEMENT_COLOURS[number]),
        "post_radius_mm": model.stem_radius_mm,
    }


def _solids(model: ElementModel, colour: str) -> list[Json]:
    return [{"colour": colour, **_solid(solid)} for solid in model.solids]


def _solid(solid: Solid) -> Json:
    if isinstance(solid, Turned):
        return {"profile_mm": solid.profile_mm.tolist()}
    if isinstance(solid, Block):
        return {
            "box_mm": [solid.length_mm, solid.width_mm],
            "angle_deg": solid.angle_deg,
            "z_mm": [solid.low_mm, solid.high_mm],
        }
    raise TypeError(solid)  # no element is of another form


def _design(scene: Scene, design: Design) -> Json:
    return {
        "group": design.group,
        "name": design.name,
        "note": f"--design {design.key}",
        "genes": design.chromosome.rows(),
        "card": _card(scene.grasp(design)),
    }


def _card(grasp: Grasp) -> Json:
    return {
        "force_n": grasp.force_n,
        "fos": grasp.fos,
        **grasp.terms._asdict(),
        "divergence": grasp.divergence,
        "clearance": grasp.clearance_mm,
        "feasible": grasp.feasible,
        "meets_all_goals": grasp.meets_all_goals,
    }
