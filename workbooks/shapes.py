"""Solids of the sample parts in OpenCASCADE: prisms of plane figures, joined and cut; STEP files.

Lengths are in mm, volumes in mm^3.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any, Literal

from figures import Figure, Place, arcs
from OCP.APIHeaderSection import APIHeaderSection_MakeHeader
from OCP.BRepAlgoAPI import BRepAlgoAPI_Common, BRepAlgoAPI_Cut, BRepAlgoAPI_Fuse
from OCP.BRepBuilderAPI import (
    BRepBuilderAPI_MakeEdge,
    BRepBuilderAPI_MakeFace,
    BRepBuilderAPI_MakeWire,
)
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.BRepOffsetAPI import BRepOffsetAPI_MakeOffset
from OCP.BRepPrimAPI import BRepPrimAPI_MakePrism
from OCP.collections import List_TopoDS_Shape
from OCP.GC import GC_MakeArcOfCircle
from OCP.GeomAbs import GeomAbs_Arc
from OCP.gp import gp_Pnt, gp_Vec
from OCP.IFSelect import IFSelect_RetDone
from OCP.Interface import Interface_Static
from OCP.Message import Message
from OCP.ShapeUpgrade import ShapeUpgrade_UnifySameDomain
from OCP.StepBasic import StepBasic_Product
from OCP.STEPControl import STEPControl_AsIs, STEPControl_Writer
from OCP.TCollection import TCollection_HAsciiString
from OCP.TopAbs import TopAbs_SOLID
from OCP.TopExp import TopExp_Explorer
from OCP.TopoDS import TopoDS

Shape = Any
"""A ``TopoDS_Shape``: OCP has no types."""

Axis = Literal["x", "y", "z"]

TIME_STAMP = "2026-01-01T00:00:00"
"""Of every file, so that a model that did not change gives the same file."""

SURFACE_CURVES = "write.surfacecurve.mode"
"""OpenCASCADE's setting whether edges are also written as curves on their faces."""

SHORTEST_MM = 1e-7
"""Sides between two arcs that are shorter are none."""


def prism(figure: Figure, axis: Axis, low: float, high: float, wider: float = 0.0) -> Shape:
    """Return a figure drawn along an axis, from one coordinate to another (mm).

    Parameters
    ----------
    figure : Figure
        In the other two axes, in the order x, y, z.
    axis : {"x", "y", "z"}
    low, high : float
    wider : float
        By how much the figure is made larger on all sides; smaller if it is negative.
    """
    outline = _wire(figure, axis, low)
    if wider:
        offset = BRepOffsetAPI_MakeOffset(outline, GeomAbs_Arc, False)  # noqa: FBT003 (open)
        offset.Perform(wider)
        outline = TopoDS.Wire(offset.Shape())
    face = BRepBuilderAPI_MakeFace(outline, True).Face()  # noqa: FBT003 (plane)
    return BRepPrimAPI_MakePrism(face, gp_Vec(*_in_space((0, 0), axis, high - low))).Shape()


def fuse(shapes: Sequence[Shape]) -> Shape:
    """Join shapes."""
    return _boolean(BRepAlgoAPI_Fuse(), shapes[:1], shapes[1:])


def cut(shape: Shape, cuts: Iterable[Shape]) -> Shape:
    """Cut shapes out of a shape."""
    return _boolean(BRepAlgoAPI_Cut(), [shape], cuts)


def common(shape: Shape, other: Shape) -> Shape:
    """Return what two shapes have in common."""
    return _boolean(BRepAlgoAPI_Common(), [shape], [other])


def one_solid(shape: Shape) -> Shape:
    """Return the one valid solid that a shape is, without seams between faces of one surface."""
    unify = ShapeUpgrade_UnifySameDomain(shape)
    unify.Build()
    explorer = TopExp_Explorer(unify.Shape(), TopAbs_SOLID)
    solid = TopoDS.Solid(explorer.Current())
    explorer.Next()
    if explorer.More() or not BRepCheck_Analyzer(solid).IsValid():
        raise ValueError("the model is not one valid solid")
    return solid


def write_step(solid: Shape, name: str, path: Path) -> None:
    """Write a solid as a STEP file that does not say when, where and by whom it was written."""
    for printer in list(Message.DefaultMessenger_s().Printers()):
        Message.DefaultMessenger_s().RemovePrinter(printer)  # it writes to standard output
    writer = STEPControl_Writer()
    usual = Interface_Static.IVal_s(SURFACE_CURVES)  # a setting of the whole program
    Interface_Static.SetIVal_s(SURFACE_CURVES, 0)  # curves in space are enough
    writer.Transfer(solid, STEPControl_AsIs)
    Interface_Static.SetIVal_s(SURFACE_CURVES, usual)
    model = writer.Model()
    entities = (model.Value(number) for number in range(1, 1 + model.NbEntities()))
    product = next(entity for entity in entities if isinstance(entity, StepBasic_Product))
    product.SetId(_text(name))  # without the number of the solid in this session
    product.SetName(_text(name))
    header = APIHeaderSection_MakeHeader(model)
    header.SetName(_text(path.name))
    header.SetTimeStamp(_text(TIME_STAMP))
    header.SetAuthorValue(1, _text(""))
    header.SetOrganizationValue(1, _text(""))
    header.SetAuthorisation(_text(""))
    if writer.Write(str(path)) != IFSelect_RetDone:
        raise OSError(f"{path} was not written")


def _wire(figure: Figure, axis: Axis, level: float) -> Shape:
    """Return the outline of a figure in the plane across an axis at a coordinate (mm)."""
    found = arcs(figure)
    wire = BRepBuilderAPI_MakeWire()
    for corner, arc, following in zip(figure, found, [*found[1:], found[0]], strict=True):
        points = [gp_Pnt(*_in_space(place, axis, level)) for place in (*arc, following.begin)]
        if corner.radius:
            circle = GC_MakeArcOfCircle(*points[:3]).Value()
            wire.Add(BRepBuilderAPI_MakeEdge(circle).Edge())
        if points[2].Distance(points[3]) > SHORTEST_MM:
            wire.Add(BRepBuilderAPI_MakeEdge(points[2], points[3]).Edge())
    return wire.Wire()


def _in_space(place: Place, axis: Axis, level: float) -> list[float]:
    """Return the point of space whose coordinate along an axis is the level."""
    coordinates = list(place)
    coordinates.insert("xyz".index(axis), level)
    return coordinates


def _boolean(operation: Any, shapes: Iterable[Shape], tools: Iterable[Shape]) -> Shape:  # noqa: ANN401
    operation.SetArguments(_list(shapes))
    operation.SetTools(_list(tools))
    operation.Build()
    if not operation.IsDone():
        raise ValueError("the shapes cannot be joined or cut")
    return operation.Shape()


def _text(text: str) -> Any:  # noqa: ANN401
    return TCollection_HAsciiString(text)


def _list(shapes: Iterable[Shape]) -> Any:  # noqa: ANN401
    found = List_TopoDS_Shape()
    for shape in shapes:
        found.Append(shape)
    return found
