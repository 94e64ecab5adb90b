"""The lines of a DXF drawing in plan view, whatever curves and blocks they are drawn with."""

from __future__ import annotations

import io
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from grasp_xl.errors import InputError, Problem
from grasp_xl.file_content import FileKind, read_content
from grasp_xl.fitment.words import UNITS
from grasp_xl.printable import quoted
from grasp_xl.space import FloatArray

if TYPE_CHECKING:
    from ezdxf.document import Drawing
    from ezdxf.entities.dxfentity import DXFEntity
    from ezdxf.entities.insert import Insert

SAG_MM = 0.05
"""How far the chords of an arc may stray from it."""

MAX_FILE_BYTES = 128_000_000
DXF = FileKind("drawing", "a DXF drawing", MAX_FILE_BYTES, "export the part's outlines alone")

CURVES = {"LINE", "ARC", "CIRCLE", "ELLIPSE", "LWPOLYLINE", "POLYLINE", "SPLINE", "HELIX"}
ANNOTATION = {
    *("TEXT", "MTEXT", "ATTRIB", "ATTDEF", "DIMENSION", "ARC_DIMENSION", "LARGE_RADIAL_DIMENSION"),
    *("LEADER", "MULTILEADER", "MLEADER", "TOLERANCE", "HATCH", "MPOLYGON", "POINT", "VIEWPORT"),
    *("IMAGE", "WIPEOUT", "XLINE", "RAY", "ACAD_TABLE"),
}
"""Kinds of entity that nobody takes for an outline."""

UNIT_CODES = {1: "in", 2: "ft", 4: "mm", 5: "cm", 6: "m"}
"""What ``$INSUNITS`` says; 0 is no unit, and nobody draws parts in the others."""

BINARY = b"AutoCAD Binary DXF"
"""How the binary form begins."""

MAX_NESTING = 32
"""Blocks in blocks."""


@dataclass(frozen=True, eq=False, slots=True)
class Line:
    """A line or a chain of chords.

    Parameters
    ----------
    points_mm : FloatArray
        ``(n, 2)`` array, n at least 2; the last is the first where it is closed.
    layer : str
    """

    points_mm: FloatArray
    layer: str


@dataclass(slots=True)
class Drawing2D:
    """What a drawing holds.

    Parameters
    ----------
    lines : list of Line
    layers : list of str
        Of its curves, also of those that are left out.
    notes : list of Problem
    """

    lines: list[Line] = field(default_factory=list)
    layers: list[str] = field(default_factory=list)
    notes: list[Problem] = field(default_factory=list)


def read_lines(
    path: Path, units: str | None, ignored_layers: Sequence[str]
) -> tuple[Drawing2D, bytes]:
    """Read the lines of a drawing's model space, and the bytes of its file.

    Parameters
    ----------
    path : Path
    units : str or None
        Where the drawing says none; else it is overruled.
    ignored_layers : sequence of str

    Raises
    ------
    InputError
        If it is no drawing, has no curves or says no unit, or a layer is not in it.
    """
    content = read_content(path, DXF)
    drawing = _opened(content, path)
    entities = list(_curves_and_rest(drawing.modelspace(), "", 0))
    found = Drawing2D(layers=sorted({layer for entity, layer in entities if _is_curve(entity)}))
    _check_layers(found, ignored_layers, str(path))
    hidden = {layer.dxf.name for layer in drawing.layers if layer.is_off() or layer.is_frozen()}
    left_out = {name.casefold() for name in (*hidden, *ignored_layers)}
    shown = [(e, layer) for e, layer in entities if layer.casefold() not in left_out]
    if not any(_is_curve(entity) for entity, _ in shown):
        raise InputError([_no_curves(entities, str(path))])
    mm = _unit_mm(drawing, units, [e for e, _ in shown if _is_curve(e)], found, str(path))
    for entity, layer in shown:
        if _is_curve(entity):
            found.lines += _lines_of(entity, layer, mm)
    _note_left_out(found, entities, hidden & set(found.layers), str(path))
    return found, content


def _opened(content: bytes, path: Path) -> Drawing:
    """Open a drawing; one with small faults as far as it can be."""
    import ezdxf
    from ezdxf import recover
    from ezdxf.lldxf.const import DXFError

    name, hint = str(path), "export it again as DXF (R2000 or later)"
    _refuse_other_files(content, name)
    try:
        if content.startswith(BINARY):
            drawing = ezdxf.readfile(path)  # type: ignore[attr-defined]
            auditor = drawing.audit()
        else:
            drawing, auditor = recover.read(io.BytesIO(content))
    except (OSError, DXFError, ValueError, KeyError, IndexError, AttributeError) as error:
        reason = (str(error) or type(error).__name__).splitlines()[0][:100]
        found = f"a file that is no DXF drawing ({reason})"
        raise InputError([Problem(name, found, DXF.expected, hint)]) from None
    if auditor.has_errors:
        found = f"a damaged drawing ({auditor.errors[0].message[:100]})"
        raise InputError([Problem(name, found, DXF.expected, hint)])
    return drawing


def _refuse_other_files(content: bytes, name: str) -> None:
    """Refuse what the library would take for a drawing, and find nothing in."""
    hint = "export it as DXF (R2000 or later)"
    if not content.strip():
        raise InputError([Problem(name, "an empty file", DXF.expected, hint)])
    if content.startswith(b"AC10"):
        raise InputError([Problem(name, "a DWG drawing", DXF.expected, hint)])
    if not content.startswith(BINARY) and b"SECTION" not in content:
        raise InputError([Problem(name, "a file that is no DXF drawing", DXF.expected, hint)])
    if not content.rstrip(b"\0 \r\n\t\x1a").endswith(b"EOF"):
        raise InputError([Problem(name, "a drawing that breaks off", DXF.expected, hint)])


def _curves_and_rest(
    entities: Iterable[DXFEntity], parent_layer: str, depth: int
) -> Iterator[tuple[DXFEntity, str]]:
    """Yield all entities with their layers; those of blocks where they are inserted."""
    for entity in entities:
        layer = str(entity.dxf.get("layer", "0"))
        if parent_layer and layer == "0":  # in a block: that of the insertion
            layer = parent_layer
        if entity.dxftype() != "INSERT":
            yield entity, layer
        elif depth < MAX_NESTING:
            insert: Insert = entity  # type: ignore[assignment]
            for one in insert.multi_insert() if insert.mcount > 1 else (insert,):
                yield from _curves_and_rest(one.virtual_entities(), layer, depth + 1)


def _is_curve(entity: DXFEntity) -> bool:
    if entity.dxftype() == "POLYLINE":
        return bool(entity.is_2d_polyline or entity.is_3d_polyline)  # type: ignore[attr-defined]
    return entity.dxftype() in CURVES


def _check_layers(found: Drawing2D, ignored: Sequence[str], name: str) -> None:
    known = {layer.casefold() for layer in found.layers}
    problems = [
        Problem(
            name,
            f"no layer {quoted(layer)} with lines",
            f"one of {', '.join(map(quoted, found.layers[:20]))}",
            "check --ignore-layer",
        )
        for layer in ignored
        if layer.casefold() not in known
    ]
    if problems:
        raise InputError(problems)


def _no_curves(entities: Sequence[tuple[DXFEntity, str]], name: str) -> Problem:
    kinds = Counter(entity.dxftype() for entity, _ in entities)
    told = ", ".join(f"{count} {kind}" for kind, count in kinds.most_common(5)) or "nothing"
    hint = "export the flat pattern's outlines as lines and arcs, on layers that are shown"
    return Problem(name, f"a drawing without lines that are shown ({told})", "outlines", hint)


def _unit_mm(
    drawing: Drawing, units: str | None, curves: Sequence[DXFEntity], found: Drawing2D, name: str
) -> float:
    """Return the length of the drawing's unit (mm)."""
    said = UNIT_CODES.get(int(drawing.header.get("$INSUNITS", 0)))
    if units and said and units != said:
        hint = f"it is read in {units}, as --units says"
        found.notes.append(Problem(name, f"a drawing in {said}", f"one in {units}", hint))
    if units or said:
        return UNITS[units or said or ""]
    raise InputError([_no_unit(curves, name)])


def _no_unit(curves: Sequence[DXFEntity], name: str) -> Problem:
    from ezdxf import bbox

    size = bbox.extents(curves, fast=True).size
    drawn, in_inches = (f"{size[0] * mm:.6g} x {size[1] * mm:.6g}" for mm in (1, UNITS["in"]))
    hint = f"give --units mm, or --units in if it is {in_inches} mm large"
    return Problem(name, f"a drawing of {drawn} that says no unit", "a unit of length", hint)


def _lines_of(entity: DXFEntity, layer: str, mm: float) -> Iterator[Line]:
    """Yield what an entity draws, in plan view."""
    from ezdxf import path

    curve = path.make_path(entity)
    for piece in curve.sub_paths() if curve.has_sub_paths else (curve,):
        points = np.array([(p.x, p.y) for p in piece.flattening(SAG_MM / mm)]) * mm
        if len(points) > 1 and np.all(np.isfinite(points)):
            if piece.is_closed:
                points[-1] = points[0]
            moved = np.any(np.diff(points, axis=0) != 0, axis=1)
            points = points[np.concatenate([[True], moved])]
        if len(points) > 1:
            yield Line(points, layer)


def _note_left_out(
    found: Drawing2D, entities: Sequence[tuple[DXFEntity, str]], hidden: set[str], name: str
) -> None:
    kinds = Counter(
        entity.dxftype()
        for entity, _ in entities
        if not _is_curve(entity) and entity.dxftype() not in ANNOTATION
    )
    if kinds:
        told = ", ".join(f"{count} {kind}" for kind, count in sorted(kinds.items()))
        hint = "they are left out"
        found.notes.append(Problem(name, f"entities that are no curves ({told})", "none", hint))
    if hidden:
        told = f"layers with lines that are switched off ({', '.join(map(quoted, sorted(hidden)))})"
        found.notes.append(Problem(name, told, "none", "they are left out"))
