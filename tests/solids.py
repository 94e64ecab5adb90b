"""Small solids with known answers, modelled with OpenCASCADE and written as STEP files."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from OCP.BRep import BRep_Builder
from OCP.BRepAlgoAPI import BRepAlgoAPI_Cut, BRepAlgoAPI_Fuse
from OCP.BRepBuilderAPI import (
    BRepBuilderAPI_MakeFace,
    BRepBuilderAPI_NurbsConvert,
    BRepBuilderAPI_Sewing,
    BRepBuilderAPI_Transform,
)
from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox, BRepPrimAPI_MakeCylinder
from OCP.gp import gp_Ax1, gp_Ax2, gp_Dir, gp_Pln, gp_Pnt, gp_Trsf
from OCP.Interface import Interface_Static
from OCP.STEPControl import STEPControl_AsIs, STEPControl_Writer
from OCP.TopoDS import TopoDS_Compound

Shape = Any


def block(x: float, y: float, z: float, dx: float, dy: float, dz: float) -> Shape:
    """Make a box by a corner and its size (mm)."""
    return BRepPrimAPI_MakeBox(gp_Pnt(x, y, z), dx, dy, dz).Shape()


def cylinder(x: float, y: float, z: float, radius: float, height: float) -> Shape:
    """Make an upright cylinder (mm)."""
    axes = gp_Ax2(gp_Pnt(x, y, z), gp_Dir(0, 0, 1))
    return BRepPrimAPI_MakeCylinder(axes, radius, height).Shape()


def cut(shape: Shape, *tools: Shape) -> Shape:
    """Take solids away from another."""
    for tool in tools:
        shape = BRepAlgoAPI_Cut(shape, tool).Shape()
    return shape


def fused(shape: Shape, *others: Shape) -> Shape:
    """Join solids; faces that become one plane keep the seam between them."""
    for other in others:
        shape = BRepAlgoAPI_Fuse(shape, other).Shape()
    return shape


def turned(shape: Shape, axis: Sequence[float], degrees: float) -> Shape:
    """Turn a solid about an axis through the origin."""
    move = gp_Trsf()
    move.SetRotation(gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(*axis)), math.radians(degrees))
    return BRepBuilderAPI_Transform(shape, move, True).Shape()  # noqa: FBT003 (copy)


def free_form(shape: Shape) -> Shape:
    """Say the same solid with splines alone."""
    return BRepBuilderAPI_NurbsConvert(shape).Shape()


def mirrored(shape: Shape) -> Shape:
    """Mirror a solid at x = 0: its planes get left-handed frames."""
    move = gp_Trsf()
    move.SetMirror(gp_Ax2(gp_Pnt(0, 0, 0), gp_Dir(1, 0, 0)))
    return BRepBuilderAPI_Transform(shape, move, True).Shape()  # noqa: FBT003 (copy)


def together(*shapes: Shape) -> Shape:
    """Put solids side by side into one file."""
    compound, builder = TopoDS_Compound(), BRep_Builder()
    builder.MakeCompound(compound)
    for shape in shapes:
        builder.Add(compound, shape)
    return compound


def surface(size: float) -> Shape:
    """Make a square surface, which is no solid."""
    face = BRepBuilderAPI_MakeFace(gp_Pln(), 0, size, 0, size).Shape()
    sewing = BRepBuilderAPI_Sewing()
    sewing.Add(face)
    sewing.Perform()
    return sewing.SewedShape()


def write_step(path: Path, shape: Shape, unit: str = "MM") -> Path:
    """Write a STEP file in a unit."""
    Interface_Static.SetCVal_s("write.step.unit", unit)
    writer = STEPControl_Writer()
    writer.Transfer(shape, STEPControl_AsIs)
    writer.Write(str(path))
    Interface_Static.SetCVal_s("write.step.unit", "MM")
    return path
