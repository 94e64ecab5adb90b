"""The lines of a DXF drawing in plan view, whatever curves and blocks they are drawn with."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from collections.abc import Set as AbstractSet
from dataclasses import dataclass, field
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING, cast

import numpy as np

from grasp_xl.errors import InputError, Problem, refuse
from grasp_xl.file_content import read_content
from grasp_xl.fitment.caps import SAG_MM, Caps, caps_of
from grasp_xl.fitment.dxf_curves import chords_of, is_curve
from grasp_xl.fitment.dxf_opening import DXF, opened
from grasp_xl.fitment.words import UNITS
from grasp_xl.printable import quoted
from grasp_xl.space import FloatArray

if TYPE_CHECKING:
    from ezdxf.document import Drawing
    from ezdxf.entities.dxfentity import DXFEntity
    from ezdxf.entities.insert import Insert
    from ezdxf.entities.polyline import Polyline

ANNOTATION = {
    *("TEXT", "MTEXT", "ATTRIB", "ATTDEF", "DIMENSION", "ARC_DIMENSION", "LARGE_RADIAL_DIMENSION"),
    *("LEADER", "MULTILEADER", "MLEADER", "TOLERANCE", "HATCH", "MPOLYGON", "POINT", "VIEWPORT"),
    *("IMAGE", "WIPEOUT", "XLINE", "RAY", "ACAD_TABLE"),
}
"""Kinds of entity that nobody takes for an outline."""

UNIT_CODES = {1: "in", 2: "ft", 4: "mm", 5: "cm", 6: "m"}
"""What ``$INSUNITS`` says; 0 is no unit, and nobody draws parts in the others."""

FLAT_MM = 0.05
"""How much the corners of a flat outline may differ in height."""

MAX_NESTING = 32
"""Blocks in blocks."""

MAX_ENTITIES = 1_000_000
"""Also those of blocks, each time that they are inserted."""

MAX_MM = 1e8
"""Coordinates: farther out, numbers no longer tell a thousandth of a gap."""


@dataclass(frozen=True, eq=False, slots=True)
class Line:
    """A line or a chain of chords.

    Parameters
    ----------
    points_mm : FloatArray
        ``(n, 2)`` array, n at least 2; the last is the first where it is closed.
    caps : Caps
        Of its curves.
    layer : str
    """

    points_mm: FloatArray
    caps: Caps
    layer: str


@dataclass(slots=True)
class Drawing2D:
    """What a drawing holds.

    Parameters
    ----------
    layers : list of str
        Of its curves, also of those that are left out.
    notes : list of Problem
    lines : list of Line
    """

    layers: list[str]
    notes: list[Problem]
    lines: list[Line] = field(default_factory=list)


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
    name, content = str(path), read_content(path, DXF)
    drawing, notes = opened(content, path)
    hidden = {folded(one.dxf.name) for one in drawing.layers if one.is_off() or one.is_frozen()}
    frozen = {folded(one.dxf.name) for one in drawing.layers if one.is_frozen()}
    ignored = {folded(layer) for layer in ignored_layers}
    entities = _entities(drawing, frozen | ignored, name)
    found = Drawing2D(sorted({layer for entity, layer in entities if is_curve(entity)}), notes)
    _check_layers(found, ignored_layers, name)
    shown = [(e, layer) for e, layer in entities if folded(layer) not in hidden | ignored]
    curves = [(entity, layer) for entity, layer in shown if is_curve(entity)]
    if not curves:
        raise InputError([_no_curves(entities, name)])
    mm = _unit_mm(drawing, units, [entity for entity, _ in curves], found, name)
    found.lines = _lines(curves, mm, name)
    _note_left_out(found, shown, hidden, name)
    _note_heights(found, curves, mm, name)
    return found, content


def folded(layer: str) -> str:
    """Return what the names of one layer have in common: case does not matter."""
    return layer.casefold()


def _entities(
    drawing: Drawing, blocking: AbstractSet[str], name: str
) -> list[tuple[DXFEntity, str]]:
    walk = _drawn(drawing.modelspace(), "", blocking, 0)
    entities = list(islice(walk, MAX_ENTITIES + 1))
    if len(entities) > MAX_ENTITIES:
        found, expected = f"more than {MAX_ENTITIES:,} entities in its blocks", "fewer"
        raise InputError([Problem(name, found, expected, DXF.make_smaller)])
    return entities


def _drawn(
    entities: Iterable[DXFEntity], parent: str, blocking: AbstractSet[str], depth: int
) -> Iterator[tuple[DXFEntity, str]]:
    """Yield what is drawn, with its layer; the entities of blocks where they are inserted.

    What a block holds on layer 0 is on that of the insertion; all of it is, if that is one of those
    which hide all that is inserted on them.
    """
    for entity in entities:
        if entity.dxf.get("invisible", 0):  # other states of a dynamic block, for example
            continue
        layer = str(entity.dxf.get("layer", "0"))
        if parent and (layer == "0" or folded(parent) in blocking):
            layer = parent
        if not _can_be_resolved(entity, depth):
            yield entity, layer
            continue
        insert = cast("Insert", entity)
        for one in insert.multi_insert() if insert.mcount > 1 else (insert,):
            yield from _drawn(one.virtual_entities(), layer, blocking, depth + 1)


def _can_be_resolved(entity: DXFEntity, depth: int) -> bool:
    """Say whether an entity is a block whose content is in the file."""
    if entity.dxftype() != "INSERT" or depth >= MAX_NESTING:
        return False
    definition = cast("Insert", entity).block()
    return definition is not None and not (definition.block and definition.block.is_xref)


def _check_layers(found: Drawing2D, ignored: Sequence[str], name: str) -> None:
    known = {folded(layer) for layer in found.layers}
    problems = [
        Problem(
            name,
            f"no layer {quoted(layer)} with lines",
            f"one of {', '.join(map(quoted, found.layers[:20]))}",
            "check --ignore-layer",
        )
        for layer in ignored
        if folded(layer) not in known
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
    code = drawing.header.get("$INSUNITS", 0)
    said = UNIT_CODES.get(code) or _unusual_unit(code)
    if units and said and units != said:
        hint = f"it is read in {units}, as --units says"
        found.notes.append(Problem(name, f"a drawing in {said}", f"one in {units}", hint))
    if units:
        return UNITS[units]
    if not said:
        raise InputError([_no_unit(curves, name)])
    if said not in UNITS:
        hint = "give the unit that is meant with --units"
        raise InputError([Problem(name, f"a drawing in {said}", ", ".join(UNITS), hint)])
    return UNITS[said]


def _unusual_unit(code: int) -> str | None:
    from ezdxf.units import unit_name

    return unit_name(code).lower() if code else None


def _no_unit(curves: Sequence[DXFEntity], name: str) -> Problem:
    from ezdxf import bbox

    size = bbox.extents(curves, fast=True).size
    drawn, in_inches = (f"{size[0] * mm:.6g} x {size[1] * mm:.6g}" for mm in (1, UNITS["in"]))
    hint = f"give --units mm, or --units in if it is {in_inches} mm large"
    return Problem(name, f"a drawing of {drawn} that says no unit", "a unit of length", hint)


def _lines(curves: Sequence[tuple[DXFEntity, str]], mm: float, name: str) -> list[Line]:
    """Return what the curves draw.

    Raises
    ------
    InputError
        With each that cannot be drawn: a hole that is left out would be covered by a cup.
    """
    lines, problems = [], []
    for entity, layer in curves:
        try:
            chords = chords_of(entity, SAG_MM / mm).scaled(mm)
            sound = bool(np.all(np.abs(chords.points) < MAX_MM))  # also no NaN
        except (ValueError, TypeError, ArithmeticError, LookupError, AttributeError):
            sound = False
        if not sound:
            hint = "draw it anew in CAD, or leave its layer out with --ignore-layer"
            where, found = f"{name}, layer {quoted(layer)}", f"a damaged {entity.dxftype()}"
            handle = entity.dxf.get("handle")
            found += f" (handle {handle})" if handle else ""
            problems.append(Problem(where, found, "one with sound coordinates", hint))
        elif len(chords.points) > 1 and np.ptp(chords.points, axis=0).any():
            lines.append(Line(chords.points, caps_of(chords.points, chords.apexes), layer))
    refuse(problems, name)
    return lines


def _note_heights(
    found: Drawing2D, curves: Sequence[tuple[DXFEntity, str]], mm: float, name: str
) -> None:
    """Note lines that rise: a flat part has none."""
    heights = [
        vertex.dxf.location.z * mm
        for entity, _ in curves
        if entity.dxftype() == "POLYLINE" and cast("Polyline", entity).is_3d_polyline
        for vertex in cast("Polyline", entity).vertices
    ]
    if heights and max(heights) - min(heights) > FLAT_MM:
        told = f"3-D polylines with corners at z {min(heights):.6g} to {max(heights):.6g} mm"
        found.notes.append(Problem(name, told, "a flat outline", "it is seen from above"))


def _note_left_out(
    found: Drawing2D, shown: Sequence[tuple[DXFEntity, str]], hidden: AbstractSet[str], name: str
) -> None:
    kinds = Counter(
        entity.dxftype()
        for entity, _ in shown
        if not is_curve(entity) and entity.dxftype() not in ANNOTATION
    )
    if kinds:
        told = ", ".join(f"{count} {kind}" for kind, count in sorted(kinds.items()))
        hint = "they are left out"
        found.notes.append(Problem(name, f"entities that are no curves ({told})", "none", hint))
    layers = ", ".join(quoted(layer) for layer in found.layers if folded(layer) in hidden)
    if layers:
        told = f"layers with lines that are switched off ({layers})"
        found.notes.append(Problem(name, told, "none", "they are left out"))
