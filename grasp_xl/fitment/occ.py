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
from OCP.GeomLib import GeomLib_IsPlanarSurface
from OCP.gp import gp_Pnt, gp_Vec
from OCP.GProp import GProp_GProps
from OCP.IFSelect import IFSelect_RetDone
from OCP.Message import Message
from OCP.STEPControl import STEPControl_Reader
from OCP.TopAbs import TopAbs_FACE, TopAbs_REVERSED, TopAbs_SHAPE, TopAbs_SOLID, TopAbs_WIRE
from OCP.TopExp import TopExp_Explorer
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS

from grasp_xl.space import FloatArray, frozen

MESH_MM, MESH_RAD = 0.1, 0.3
"""How far triangles may stray from a surface, and turn from one to the next."""

CHORD_RAD = 0.35
"""Most that a chord of a curve may turn from the one before."""

VOLUME_ACCURACY = 1e-9
"""Asked of the kernel for solids with free-form faces; 1e-6 of the volume was seen."""

ELEMENTARY = (GeomAbs_Plane, GeomAbs_Cylinder, GeomAbs_Cone, GeomAbs_Sphere, GeomAbs_Torus)
"""Surfaces on which the kernel's usual integration leaves nothing to be desired."""

FLAT_MM = 1e-3
"""How far a flat face may stray from a plane."""

NO_TURN = 1e-6
"""Turn of a chord's tangents (rad) below which it is straight."""

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
class Ring:
    """An edge of a face all around, curves as chords.

    Parameters
    ----------
    corners : FloatArray
        ``(n, 3)``; the last is the first.
    apexes : FloatArray
        ``(n - 1, 3)``: where the tangents at both ends of a chord meet; NaN where it is straight.
    """

    corners: FloatArray
    apexes: FloatArray

    def turned(self, turn: FloatArray) -> Ring:
        """Return it after a rotation."""
        return Ring(self.corners @ turn.T, self.apexes @ turn.T)


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

    def rings(self, sag_mm: float) -> list[Ring]:
        """Return its outline and then its holes."""
        outer = BRepTools.OuterWire_s(self.shape)
        wires = [TopoDS.Wire(wire) for wire in _parts(self.shape, TopAbs_WIRE)]
        holes = [wire for wire in wires if not wire.IsSame(outer)]
        return [_ring(wire, self.shape, sag_mm) for wire in (outer, *holes)]


def silence() -> None:
    """Keep the kernel from writing to standard output."""
    for printer in list(Message.DefaultMessenger_s().Printers()):
        Message.DefaultMessenger_s().RemovePrinter(printer)


def read_solids(path: Path) -> tuple[list[Solid], int]:
    """Read the solids of a STEP file, the largest first, and count the faces of none of them.

    Raises
    ------
    ReadError
        If it cannot be read.
    """
    silence()
    shape = _shape_of(path)
    solids = [_solid(TopoDS.Solid(each)) for each in _parts(shape, TopAbs_SOLID)]
    solids.sort(key=lambda solid: (-solid.volume_mm3, *solid.centroid_mm.tolist()))
    return solids, sum(1 for _ in _parts(shape, TopAbs_FACE, TopAbs_SOLID))


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
    """Yield the flat faces of a solid, also those that are splines by name."""
    for shape in _parts(solid.shape, TopAbs_FACE):
        face = TopoDS.Face(shape)
        if GeomLib_IsPlanarSurface(BRep_Tool.Surface_s(face), FLAT_MM).IsPlanar():
            yield PlaneFace(face, _normal(face))


def _normal(face: Shape) -> FloatArray:
    """Return the outward unit normal in the middle of a face, from its tangents there.

    The direction of a plane's own frame would look inwards where that is left-handed.
    """
    surface = BRepAdaptor_Surface(face)
    u = (surface.FirstUParameter() + surface.LastUParameter()) / 2
    v = (surface.FirstVParameter() + surface.LastVParameter()) / 2
    place, along_u, along_v = gp_Pnt(), gp_Vec(), gp_Vec()
    surface.D1(u, v, place, along_u, along_v)
    normal = np.cross(along_u.Coord(), along_v.Coord())
    normal /= np.linalg.norm(normal)
    return frozen((-normal if face.Orientation() == TopAbs_REVERSED else normal) + 0.0)


def triangles(solid: Solid) -> FloatArray:
    """Return triangles on a solid, ``(n, 3, 3)`` (mm), counter-clockwise from outside."""
    BRepMesh_IncrementalMesh(solid.shape, MESH_MM, False, MESH_RAD, True)  # noqa: FBT003 (relative, parallel)
    found = [_triangles_of(TopoDS.Face(face)) for face in _parts(solid.shape, TopAbs_FACE)]
    return frozen(np.concatenate([np.empty((0, 3, 3)), *found]))


def _parts(shape: Shape, kind: Any, outside: Any = TopAbs_SHAPE) -> Iterator[Shape]:  # noqa: ANN401 (OCP has no types)
    explorer = TopExp_Explorer(shape, kind, outside)
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


def _ring(wire: Shape, face: Shape, sag_mm: float) -> Ring:
    corners, apexes = [], []
    explorer = BRepTools_WireExplorer(wire, face)
    while explorer.More():
        edge = explorer.Current()
        if not BRep_Tool.Degenerated_s(edge):
            along, tips = _chords(edge, sag_mm)
            if edge.Orientation() == TopAbs_REVERSED:
                along, tips = along[::-1], tips[::-1]
            corners.append(along[:-1])  # the last is the first of the next edge
            apexes.append(tips)
        explorer.Next()
    if not corners:
        return Ring(frozen(np.empty((0, 3))), frozen(np.empty((0, 3))))
    return Ring(frozen(np.concatenate([*corners, corners[0][:1]])), frozen(np.concatenate(apexes)))


def _chords(edge: Shape, sag_mm: float) -> tuple[FloatArray, FloatArray]:
    """Return the ends of an edge's chords, and their apexes."""
    curve = BRepAdaptor_Curve(edge)
    first, last = curve.FirstParameter(), curve.LastParameter()
    if curve.GetType() == GeomAbs_Line:
        ends = [curve.Value(parameter).Coord() for parameter in (first, last)]
        return np.array(ends), np.full((1, 3), np.nan)
    chords = GCPnts_TangentialDeflection(curve, CHORD_RAD, sag_mm)
    points, tangents = [], []
    for number in range(1, 1 + chords.NbPoints()):
        place, tangent = gp_Pnt(), gp_Vec()
        curve.D1(chords.Parameter(number), place, tangent)
        points.append(place.Coord())
        tangents.append(tangent.Coord())
    return np.array(points), _apexes(np.array(points), np.array(tangents))


def _apexes(points: FloatArray, tangents: FloatArray) -> FloatArray:
    """Return where the tangents at both ends of each chord meet; NaN where they do not."""
    start, chord = tangents[:-1], np.diff(points, axis=0)
    across = np.cross(start, tangents[1:])
    size = (across**2).sum(axis=1)
    bent = size > NO_TURN**2 * (start**2).sum(axis=1) * (tangents[1:] ** 2).sum(axis=1)
    way = (np.cross(chord, tangents[1:]) * across).sum(axis=1) / np.where(bent, size, np.nan)
    return frozen(points[:-1] + way[:, None] * start)


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
