"""A design as a STEP assembly, written with OpenCASCADE: names, colours, millimetres."""

from __future__ import annotations

import re
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
import shapely
from OCP.APIHeaderSection import APIHeaderSection_MakeHeader
from OCP.BRep import BRep_Builder
from OCP.BRepBuilderAPI import (
    BRepBuilderAPI_MakeFace,
    BRepBuilderAPI_MakePolygon,
    BRepBuilderAPI_Transform,
)
from OCP.BRepPrimAPI import (
    BRepPrimAPI_MakeBox,
    BRepPrimAPI_MakeCylinder,
    BRepPrimAPI_MakePrism,
    BRepPrimAPI_MakeRevol,
)
from OCP.gp import gp_Ax1, gp_Ax2, gp_Dir, gp_Pnt, gp_Trsf, gp_Vec
from OCP.IFSelect import IFSelect_RetDone
from OCP.Quantity import Quantity_Color, Quantity_TOC_sRGB
from OCP.STEPCAFControl import STEPCAFControl_Writer
from OCP.STEPControl import STEPControl_AsIs
from OCP.TCollection import TCollection_ExtendedString, TCollection_HAsciiString
from OCP.TDataStd import TDataStd_Name
from OCP.TDocStd import TDocStd_Document
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS_Compound
from OCP.XCAFApp import XCAFApp_Application
from OCP.XCAFDoc import XCAFDoc_ColorSurf, XCAFDoc_DocumentTool
from shapely import Polygon

from grasp_xl.errors import OutputError
from grasp_xl.fitment.occ import silence
from grasp_xl.fitment.step_file import TurnedSolid
from grasp_xl.space import FloatArray
from grasp_xl.view.assembly import MARK, PART, PART_COLOUR, pieces_of, rgb
from grasp_xl.view.scene import Scene
from grasp_xl.view.solids import Bar, Block, Plate, Solid, Turned

Shape = Any
"""A ``TopoDS_Shape``: OCP has no types."""

STRANGE = re.compile(r"[^ -\[\]-~]+")
"""Letters that a STEP file does not hold as they are."""

FORMAT = "MDTV-XCAF"
ROOT = "Grasp"


def step_of(scene: Scene) -> bytes:
    """Return the shown design as a STEP file (AP214).

    Raises
    ------
    OutputError
        If OpenCASCADE cannot write it.
    """
    silence()
    document = TDocStd_Document(TCollection_ExtendedString(FORMAT))
    XCAFApp_Application.GetApplication_s().NewDocument(TCollection_ExtendedString(FORMAT), document)
    assembly = _Assembly(document)
    if scene.part.solid:
        assembly.add(PART, scene.part.name, PART_COLOUR, _turned_part(scene.part.solid))
    for piece in pieces_of(scene):
        shape = _placed(_together([_shape(solid) for solid in piece.solids]), piece.place_mm)
        assembly.add(piece.group, piece.name, piece.colour, shape)
    return assembly.written(scene.title)


class _Assembly:
    """An assembly of groups of parts."""

    def __init__(self, document: Any) -> None:  # noqa: ANN401 (OCP has no types)
        self._document = document
        self._shapes = XCAFDoc_DocumentTool.ShapeTool_s(document.Main())
        self._colours = XCAFDoc_DocumentTool.ColorTool_s(document.Main())
        self._root = self._named(self._shapes.NewShape(), ROOT)
        self._groups: dict[str, Any] = {}

    def add(self, group: str, name: str, colour: str, shape: Shape) -> None:
        """Add a part to a group."""
        if group not in self._groups:
            self._groups[group] = self._named(self._shapes.NewShape(), group)
            self._place(self._root, self._groups[group], group)
        label = self._named(self._shapes.AddShape(shape, False), name)  # noqa: FBT003 (no assembly)
        self._colours.SetColor(label, _colour(colour), XCAFDoc_ColorSurf)
        self._place(self._groups[group], label, name)

    def written(self, title: str) -> bytes:
        """Return the assembly as a file."""
        self._shapes.UpdateAssemblies()
        writer = STEPCAFControl_Writer()
        writer.SetNameMode(True)  # noqa: FBT003 (its one parameter)
        writer.SetColorMode(True)  # noqa: FBT003 (its one parameter)
        done = writer.Transfer(self._document, STEPControl_AsIs)
        header = APIHeaderSection_MakeHeader(writer.ChangeWriter().Model())
        header.SetName(TCollection_HAsciiString(_encoded(title)))
        header.SetOriginatingSystem(TCollection_HAsciiString(MARK))
        for set_value in (header.SetAuthorValue, header.SetOrganizationValue):
            set_value(1, TCollection_HAsciiString(""))
        header.SetDescriptionValue(1, TCollection_HAsciiString("Grasp: part, elements and frame"))
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "grasp.step"
            if done and writer.Write(str(path)) == IFSelect_RetDone:
                return path.read_bytes()
        raise OutputError("OpenCASCADE could not write the assembly, so nothing was written.")

    def _place(self, group: Any, label: Any, name: str) -> None:  # noqa: ANN401 (OCP has no types)
        self._named(self._shapes.AddComponent(group, label, TopLoc_Location()), name)

    @staticmethod
    def _named(label: Any, name: str) -> Any:  # noqa: ANN401 (OCP has no types)
        TDataStd_Name.Set_s(label, TCollection_ExtendedString(_encoded(name)))
        return label


def _encoded(text: str) -> str:
    r"""Return a text as ISO 10303-21 wants it: in hexadecimal what is not ASCII, and the backslash.

    Examples
    --------
    >>> print(_encoded("SAF 40"), _encoded("Ø 40"))
    SAF 40 \X2\00D8\X0\ 40
    """

    def escape(found: re.Match[str]) -> str:
        return f"\\X2\\{found[0].encode('utf-16-be', 'surrogatepass').hex().upper()}\\X0\\"

    return STRANGE.sub(escape, text)


def _colour(colour: str) -> Any:  # noqa: ANN401 (OCP has no types)
    return Quantity_Color(*rgb(colour), Quantity_TOC_sRGB)


def _turned_part(part: TurnedSolid) -> Shape:
    move = gp_Trsf()
    rows = np.column_stack([part.turn, np.zeros(3)])
    move.SetValues(*rows.ravel().tolist())
    return BRepBuilderAPI_Transform(part.solid.shape, move, True).Shape()  # noqa: FBT003 (copy)


def _placed(shape: Shape, place_mm: FloatArray) -> Shape:
    move = gp_Trsf()
    move.SetTranslation(gp_Vec(*place_mm.tolist()))
    return BRepBuilderAPI_Transform(shape, move, True).Shape()  # noqa: FBT003 (copy)


def _together(shapes: list[Shape]) -> Shape:
    if len(shapes) == 1:
        return shapes[0]
    compound, builder = TopoDS_Compound(), BRep_Builder()
    builder.MakeCompound(compound)
    for shape in shapes:
        builder.Add(compound, shape)
    return compound


def _shape(solid: Solid) -> Shape:
    match solid:
        case Turned():
            corners = [(r, 0.0, z) for r, z in solid.profile_mm.tolist()]
            axis = gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1))
            return BRepPrimAPI_MakeRevol(_face([corners]), axis).Shape()
        case Block():
            return _block(solid)
        case Bar():
            along = solid.end_mm - solid.start_mm
            axes = gp_Ax2(gp_Pnt(*solid.start_mm.tolist()), gp_Dir(*along.tolist()))
            length = float(np.linalg.norm(along))
            return BRepPrimAPI_MakeCylinder(axes, solid.radius_mm, length).Shape()
        case Plate():
            return _plate(solid)


def _block(block: Block) -> Shape:
    corner = gp_Pnt(-block.length_mm / 2, -block.width_mm / 2, block.low_mm)
    height = block.high_mm - block.low_mm
    upright = BRepPrimAPI_MakeBox(corner, block.length_mm, block.width_mm, height).Shape()
    turn = gp_Trsf()
    turn.SetRotation(gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1)), np.radians(block.angle_deg))
    return BRepBuilderAPI_Transform(upright, turn, True).Shape()  # noqa: FBT003 (copy)


def _plate(plate: Plate) -> Shape:
    shapes = []
    for piece in shapely.get_parts(plate.area):
        if isinstance(piece, Polygon):
            outline = shapely.orient_polygons(piece)
            rings = (outline.exterior, *outline.interiors)
            face = _face([[(x, y, plate.low_mm) for x, y in ring.coords[:-1]] for ring in rings])
            height = plate.high_mm - plate.low_mm
            up = gp_Vec(0, 0, height)
            shapes.append(BRepPrimAPI_MakePrism(face, up).Shape() if height else face)
    return _together(shapes)


def _face(rings: list[list[tuple[float, float, float]]]) -> Shape:
    """Return a flat face: its outline, and its holes the other way round."""
    wires = []
    for ring in rings:
        polygon = BRepBuilderAPI_MakePolygon()
        for corner in ring:
            polygon.Add(gp_Pnt(*corner))
        polygon.Close()
        wires.append(polygon.Wire())
    face = BRepBuilderAPI_MakeFace(wires[0])
    for hole in wires[1:]:
        face.Add(hole)
    return face.Face()
