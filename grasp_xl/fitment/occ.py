"""Solids of a STEP file through OpenCASCADE, as plain numbers: the only file that imports it.

Coordinates are those of the file, in mm.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from OCP.Bnd import Bnd_Box
from OCP.BRep import BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Curve, BRepAdaptor_Surface
from OCP.BRepBndLib import BRepBndLib
from OCP.BRepGProp import BRepGProp
from OCP.BRepMesh import BRepMesh_IncrementalMesh
from OCP.BRepTools import BRepTools, BRepTools_WireExplorer
from OCP.GCPnts import GCPnts_TangentialDeflection
from OCP.GeomAbs import (
    GeomAbs_Cone,
    GeomAbs_Cylinder,
    GeomAbs_Line,
    GeomAbs_Plane,
    GeomAbs_Sphere,
    GeomAbs_Torus,
)
from OCP.GProp import GProp_GProps
from OCP.IFSelect import IFSelect_RetDone
from OCP.Message import Message
from OCP.STEPControl import STEPControl_Reader
from OCP.TopAbs import TopAbs_FACE, TopAbs_REVERSED, TopAbs_SOLID, TopAbs_WIRE
from OCP.TopExp import TopExp_Explorer
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS

from grasp_xl.space import FloatArray, frozen

MESH_MM, MESH_RAD = 0.1, 0.3
"""How far triangles may stray from a surface, and turn from one to the next."""

CHORD_RAD = 0.35
"""Most that a chord of a curve may turn from the one before."""

VOLUME_ACCURACY = 1e-9
"""Asked of the kernel for solids with free-form faces; 2e-7 of the volume was seen."""

ELEMENTARY = (GeomAbs_Plane, GeomAbs_Cylinder, GeomAbs_Cone, GeomAbs_Sphere, GeomAbs_Torus)
"""Surfaces on which the kernel's usual integration leaves nothing to be desired."""

Shape = Any
"""A ``TopoDS_Shape``: OCP has no types."""


class ReadError(Exception):
    """OpenCASCADE does not read the file."""


@dataclass(frozen=True, eq=False, slots=True)
class Solid:
    """One solid.

    Parameters
    ----------
    shape : TopoDS_Solid
        Its normals look outwards.
    volume_mm3 : float
    centroid_mm : FloatArray
        ``(3,)``.
    """

    shape: Shape
    volume_mm3: float
    centroid_mm: FloatArray


@dataclass(frozen=True, eq=False, slots=True)
class PlaneFace:
    """A flat face.

    Parameters
    ----------
    shape : TopoDS_Face
    normal : FloatArray
        ``(3,)`` unit vector that looks out of the solid.
    """

    shape: Shape
    normal: FloatArray

    def rings(self, sag_mm: float) -> list[FloatArray]:
        """Return its outline and then its holes, ``(n, 3)`` corners each, arcs as chords."""
        outer = BRepTools.OuterWire_s(self.shape)
        wires = [TopoDS.Wire(wire) for wire in _parts(self.shape, TopAbs_WIRE)]
        holes = [wire for wire in wires if not wire.IsSame(outer)]
        return [_corners(wire, self.shape, sag_mm) for wire in (outer, *holes)]


def read_solids(path: Path) -> tuple[list[Solid], int]:
    """Read the solids of a STEP file, the largest first, and count its faces.

    Raises
    ------
    ReadError
        If it cannot be read.
    """
    for printer in list(Message.DefaultMessenger_s().Printers()):
        Message.DefaultMessenger_s().RemovePrinter(printer)  # it writes to standard output
    shape = _shape_of(path)
    solids = [_solid(TopoDS.Solid(each)) for each in _parts(shape, TopAbs_SOLID)]
    solids.sort(key=lambda solid: (-solid.volume_mm3, *solid.centroid_mm.tolist()))
    return solids, sum(1 for _ in _parts(shape, TopAbs_FACE))


def _shape_of(path: Path) -> Shape:
    """Return all that a file holds as one shape, with all lengths in mm."""
    reader = STEPControl_Reader()
    try:
        if reader.ReadFile(str(path)) == IFSelect_RetDone:
            _refuse_faults(reader)
            reader.TransferRoots()
        shape = reader.OneShape()
    except ReadError:
        raise
    except Exception as error:  # of the kernel, which have no common base
        raise ReadError(str(error)) from error
    if shape.IsNull():
        raise ReadError("it holds no shape")
    return shape


def _refuse_faults(reader: Any) -> None:  # noqa: ANN401 (OCP has no types)
    """Raise the first fault of a file: the kernel crashes where it makes shapes of one."""
    checks = reader.WS().ModelCheckList(True)  # noqa: FBT003 (with names)
    checks.Start()
    while checks.More():
        if checks.Value().HasFailed():
            raise ReadError(checks.Value().CFail(1))
        checks.Next()


def reach_mm(solid: Solid) -> float:
    """Return how far a solid reaches from the origin along any axis (mm)."""
    box = Bnd_Box()
    BRepBndLib.Add_s(solid.shape, box)
    corners = box.CornerMin(), box.CornerMax()
    return float(max(abs(each) for corner in corners for each in corner.Coord()))


def plane_faces(solid: Solid) -> Iterator[PlaneFace]:
    """Yield the flat faces of a solid."""
    for shape in _parts(solid.shape, TopAbs_FACE):
        face = TopoDS.Face(shape)
        surface = BRepAdaptor_Surface(face)
        if surface.GetType() == GeomAbs_Plane:
            axes = surface.Plane().Position()
            along = [axes.XDirection(), axes.YDirection()]
            x, y = (np.array([axis.X(), axis.Y(), axis.Z()]) for axis in along)
            normal = np.cross(x, y)  # not Direction(): that of a left-handed frame looks back
            if face.Orientation() == TopAbs_REVERSED:
                normal = -normal
            yield PlaneFace(face, frozen(normal + 0.0))


def triangles(solid: Solid) -> FloatArray:
    """Return triangles on a solid, ``(n, 3, 3)`` (mm), counter-clockwise from outside."""
    BRepMesh_IncrementalMesh(solid.shape, MESH_MM, False, MESH_RAD, True)  # noqa: FBT003 (relative, parallel)
    found = [_triangles_of(TopoDS.Face(face)) for face in _parts(solid.shape, TopAbs_FACE)]
    return frozen(np.concatenate([np.empty((0, 3, 3)), *found]))


def _parts(shape: Shape, kind: Any) -> Iterator[Shape]:  # noqa: ANN401 (OCP has no types)
    explorer = TopExp_Explorer(shape, kind)
    while explorer.More():
        yield explorer.Current()
        explorer.Next()


def _solid(shape: Shape) -> Solid:
    properties = GProp_GProps()
    kinds = (
        BRepAdaptor_Surface(TopoDS.Face(face)).GetType() for face in _parts(shape, TopAbs_FACE)
    )
    if all(kind in ELEMENTARY for kind in kinds):
        BRepGProp.VolumeProperties_s(shape, properties)
    else:  # the usual integration was seen to miss by 0.9 % there
        BRepGProp.VolumeProperties_s(shape, properties, VOLUME_ACCURACY)
    volume, centre = properties.Mass(), properties.CentreOfMass()
    if volume < 0:  # it is inside out
        shape = TopoDS.Solid(shape.Reversed())
    return Solid(shape, abs(volume), frozen([centre.X(), centre.Y(), centre.Z()]))


def _corners(wire: Shape, face: Shape, sag_mm: float) -> FloatArray:
    points: list[tuple[float, float, float]] = []
    explorer = BRepTools_WireExplorer(wire, face)
    while explorer.More():
        edge = explorer.Current()
        if not BRep_Tool.Degenerated_s(edge):
            along = _points(edge, sag_mm)
            if edge.Orientation() == TopAbs_REVERSED:
                along.reverse()
            points += along[:-1]  # the last is the first of the next edge
        explorer.Next()
    return frozen(points)


def _points(edge: Shape, sag_mm: float) -> list[tuple[float, float, float]]:
    curve = BRepAdaptor_Curve(edge)
    if curve.GetType() == GeomAbs_Line:
        ends = (curve.Value(curve.FirstParameter()), curve.Value(curve.LastParameter()))
        return [(end.X(), end.Y(), end.Z()) for end in ends]
    chords = GCPnts_TangentialDeflection(curve, CHORD_RAD, sag_mm)
    values = (chords.Value(number) for number in range(1, 1 + chords.NbPoints()))
    return [(value.X(), value.Y(), value.Z()) for value in values]


def _triangles_of(face: Shape) -> FloatArray:
    place = TopLoc_Location()
    mesh = BRep_Tool.Triangulation_s(face, place)
    if mesh is None:
        return np.empty((0, 3, 3))
    move = place.Transformation()
    nodes = [mesh.Node(number).Transformed(move) for number in range(1, 1 + mesh.NbNodes())]
    places = np.array([(node.X(), node.Y(), node.Z()) for node in nodes]).reshape(-1, 3)
    corners = [mesh.Triangle(number).Get() for number in range(1, 1 + mesh.NbTriangles())]
    found = places[np.array(corners, dtype=int).reshape(-1, 3) - 1]
    return frozen(found[:, ::-1] if face.Orientation() == TopAbs_REVERSED else found)
