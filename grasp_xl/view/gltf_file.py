"""A design as binary glTF 2.0, for viewers and game engines: metres, y up."""

from __future__ import annotations

from typing import Any

import numpy as np
import trimesh

from grasp_xl.space import FloatArray, frozen
from grasp_xl.view.assembly import MARK, PART, PART_COLOUR, pieces_of, rgb
from grasp_xl.view.meshes import Shaded, shaded, triangles_of
from grasp_xl.view.scene import Scene

ROOT = "Grasp"
METRES = 0.001
Y_UP = np.array([[1, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]], dtype=float)
"""glTF's up is y: x stays, z becomes y, y becomes -z."""

ROUGHNESS, METAL = 0.6, 0.1


def gltf_of(scene: Scene) -> bytes:
    """Return the shown design as a ``.glb`` file, its pieces grouped under nodes with names."""
    found = trimesh.Scene()
    found.graph.update(frame_to=ROOT, matrix=Y_UP @ np.diag([METRES, METRES, METRES, 1.0]))
    solid = scene.part.solid
    groups: set[str] = set()

    def add(triangles_mm: FloatArray, group: str, name: str, colour: str) -> None:
        if group not in groups:
            groups.add(group)
            found.graph.update(frame_from=ROOT, frame_to=group)
        mesh = _mesh(shaded(triangles_mm), colour)
        found.add_geometry(mesh, node_name=name, geom_name=name, parent_node_name=group)

    if solid:
        add(solid.mesh, PART, scene.part.name, PART_COLOUR)
    for piece in pieces_of(scene):
        triangles = np.concatenate([triangles_of(each) for each in piece.solids])
        add(frozen(triangles + piece.place_mm), piece.group, piece.name, piece.colour)
    return bytes(found.export(file_type="glb", include_normals=True, tree_postprocessor=_marked))


def _mesh(shape: Shaded, colour: str) -> trimesh.Trimesh:
    return trimesh.Trimesh(
        shape.places_mm,
        shape.triangles,
        vertex_normals=shape.normals,
        visual=trimesh.visual.TextureVisuals(material=_material(colour)),
        process=False,
    )


def _marked(tree: dict[str, Any]) -> None:
    tree["asset"]["generator"] = MARK


def _material(colour: str) -> trimesh.visual.material.PBRMaterial:
    return trimesh.visual.material.PBRMaterial(
        baseColorFactor=[*(round(255 * part) for part in rgb(colour)), 255],
        metallicFactor=METAL,
        roughnessFactor=ROUGHNESS,
        doubleSided=True,
    )
