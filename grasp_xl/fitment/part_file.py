"""Reading a part from a file of CAD, whatever its kind."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from grasp_xl.errors import UsageError
from grasp_xl.fitment.part import CadPart
from grasp_xl.fitment.words import USUAL_UP

STEP_SUFFIXES = (".step", ".stp", ".p21")
DXF_SUFFIX = ".dxf"

OF_STEP = ("--up", "--approach")
OF_DXF = ("--units", "--thickness", "--ignore-layer", "--gap")
"""Options for one kind of file alone."""

APPROACH_MM = 100.0
"""Room that an element with its fitting needs above a face."""

GAP_MM = 0.05
"""Gaps of an outline up to this are closed: the sag with which its arcs are drawn."""


@dataclass(frozen=True, slots=True)
class Reading:
    """How a file is to be read; what its kind does not need is None.

    Parameters
    ----------
    up : str or None
        STEP: axis that looks up, as ``+z``, which is the default.
    approach_mm : float or None
        STEP: least room above a face.
    units : str or None
        DXF: unit of length where the file says none.
    thickness_mm : float or None
        DXF: of the sheet; needed.
    ignored_layers : tuple of str
        DXF
    gap_mm : float or None
        DXF: largest gap of an outline that is closed.
    part : int or None
        Which of several in the file, from 1.
    """

    up: str | None = None
    approach_mm: float | None = None
    units: str | None = None
    thickness_mm: float | None = None
    ignored_layers: tuple[str, ...] = ()
    gap_mm: float | None = None
    part: int | None = None

    def given(self) -> dict[str, object]:
        """Return the options that were given, by name."""
        options = {
            "--up": self.up,
            "--approach": self.approach_mm,
            "--units": self.units,
            "--thickness": self.thickness_mm,
            "--ignore-layer": self.ignored_layers or None,
            "--gap": self.gap_mm,
            "--part": self.part,
        }
        return {name: value for name, value in options.items() if value is not None}


def read_part(path: Path, reading: Reading) -> CadPart:
    """Read a part from a STEP or DXF file.

    Raises
    ------
    UsageError
        If the name is that of neither, or an option is for the other kind.
    InputError
        If it cannot be used, with every problem found.
    """
    suffix = path.suffix.lower()
    if suffix in STEP_SUFFIXES:
        _refuse(reading, OF_DXF, path, "a DXF file")
        from grasp_xl.fitment.step_file import read_step

        return read_step(
            path,
            up=reading.up or USUAL_UP,
            part=reading.part,
            approach_mm=APPROACH_MM if reading.approach_mm is None else reading.approach_mm,
        )
    if suffix == DXF_SUFFIX:
        _refuse(reading, OF_STEP, path, "a STEP file")
        if reading.thickness_mm is None:
            raise UsageError(
                f"{path}: a DXF file does not say how thick the sheet is.",
                where="--thickness",
                hint="Give it in mm, for example --thickness 1.5",
            )
        from grasp_xl.fitment.dxf_file import read_dxf

        return read_dxf(
            path,
            units=reading.units,
            thickness_mm=reading.thickness_mm,
            part=reading.part,
            ignored_layers=reading.ignored_layers,
            gap_mm=GAP_MM if reading.gap_mm is None else reading.gap_mm,
        )
    raise UsageError(
        f"{path}: found a name that ends in {path.suffix!r}, expected one of "
        f"{', '.join((*STEP_SUFFIXES, DXF_SUFFIX))}.",
        where=str(path),
        hint="Export the part as STEP (AP214 or AP242), or its flat pattern as DXF",
    )


def _refuse(reading: Reading, options: Sequence[str], path: Path, kind: str) -> None:
    """Refuse options that are for the other kind of file."""
    for name in reading.given():
        if name in options:
            raise UsageError(
                f"{name} is for {kind}, and {path} is none.", where=name, hint="Leave it out"
            )
