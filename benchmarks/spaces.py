"""Synthetic option spaces of any size: a door frame of 1100 x 800 mm, the same on every machine.

``python -m benchmarks.spaces 1000 FILE.xlsx`` writes the one of 1,000 footprints as CAD exports it.
"""

from __future__ import annotations

import argparse
from dataclasses import replace
from pathlib import Path

import numpy as np

from grasp_xl.space import ElementKind, FloatArray, OptionSpace, Part, frozen
from grasp_xl.task import Parameters, Task, settle
from grasp_xl.workbook.writing import export_workbook

DOOR_FRAME = (228, 519)
"""Cups and magnets of the issue's door frame."""

HALF_WIDTH_MM, HALF_HEIGHT_MM = 550.0, 400.0
RIM_MM = 110.0
"""Width of the frame's four sides and of its middle bar."""

LEVELS_MM = (0.0, 12.0, 25.0)
"""Heights of the upper side, of the other sides, and of the middle bar."""


def door_frame(cups: int, magnets: int) -> OptionSpace:
    """Return the door frame, 8.86 kg, with so many footprints of each kind.

    The cups keep 23 mm (their radius) from the edges; the magnets may touch them.
    """
    corners = [(x, y, 0.0) for x, y in ((500, 350), (500, -350), (-500, -350), (-500, 350))]
    return OptionSpace(
        part=Part(8860.0, frozen([12.4, -8.7, 3.2])),
        kinds=(
            ElementKind("suction", 69.0, 10.0, 1, 5, frame_places(cups, 23.0), 15.0, 46.0),
            ElementKind("magnets", 130.0, 30.0, 1, 5, frame_places(magnets, 0.0), 110.0, 30.0),
        ),
        approximation_polygon_mm=frozen(corners),
        scale_factor=0.65,
    )


def door_frame_of(footprints: int) -> OptionSpace:
    """Return the door frame with so many footprints in all, cups and magnets as 228 to 519."""
    cups = round(footprints * DOOR_FRAME[0] / sum(DOOR_FRAME))
    return door_frame(cups, footprints - cups)


def frame_places(count: int, margin_mm: float) -> FloatArray:
    """Spread places evenly over the frame, ``(count, 3)`` (mm), by descending x, descending y.

    The pitch is the largest that gives enough grid points; surplus ones are left out evenly.
    """
    pitch = 100.0
    grid = frame_grid(pitch, margin_mm)
    while len(grid) < count:
        pitch *= 0.98
        grid = frame_grid(pitch, margin_mm)
    kept = np.linspace(0, len(grid) - 1, count).round().astype(np.int64)
    return frozen(grid[kept])


def frame_grid(pitch_mm: float, margin_mm: float) -> FloatArray:
    """Grid points of the frame at least so far from its edges, ``(n, 3)`` (mm)."""
    x_far, y_far = HALF_WIDTH_MM - margin_mm, HALF_HEIGHT_MM - margin_mm
    xs = np.linspace(x_far, -x_far, int(2 * x_far / pitch_mm) + 1)
    ys = np.linspace(y_far, -y_far, int(2 * y_far / pitch_mm) + 1)
    x, y = np.repeat(xs, len(ys)), np.tile(ys, len(xs))
    inner = RIM_MM - margin_mm
    upper = y >= HALF_HEIGHT_MM - inner
    rim = upper | (y <= -HALF_HEIGHT_MM + inner) | (np.abs(x) >= HALF_WIDTH_MM - inner)
    bar = ~rim & (np.abs(x) <= RIM_MM / 2 - margin_mm)
    z = np.select([upper, rim, bar], LEVELS_MM, np.nan)
    kept = ~np.isnan(z)
    return frozen(np.round(np.column_stack([x, y, z])[kept], 6))


PANEL_PITCHES_MM = (40.0, 30.0, 20.0, 15.0, 10.0, 7.0)
"""Pitches that the exact search is measured at."""

WINDOWS_MM = ((-350.0, 0.0), (350.0, 0.0))
WINDOW_HALF_MM = 250.0
HOLES_MM = tuple((x, 350.0) for x in range(-600, 601, 100))
HOLE_RADIUS_MM = 20.0


def panel(pitch_mm: float, most: int = 5) -> OptionSpace:
    """Return a panel of 1400 x 900 mm and 27 kg, with two windows and a row of holes.

    Its weight needs four cups and four magnets, or more; ``most`` is the largest count of a kind.
    """
    corners = [(x, y, 0.0) for x, y in ((650, 400), (650, -400), (-650, -400), (-650, 400))]
    return OptionSpace(
        part=Part(27000.0, frozen([6.3, -11.9, 2.5])),
        kinds=(
            ElementKind("suction", 69.0, 10.0, 1, most, panel_places(pitch_mm, 23.0), 15.0, 46.0),
            ElementKind("magnets", 130.0, 30.0, 1, most, panel_places(pitch_mm, 0.0), 110.0, 30.0),
        ),
        approximation_polygon_mm=frozen(corners),
        scale_factor=0.65,
    )


def panel_places(pitch_mm: float, margin_mm: float) -> FloatArray:
    """Grid points of the panel at least so far from its edges, ``(n, 3)`` (mm)."""
    xs, ys = (np.linspace(half, -half, int(2 * half / pitch_mm + 1e-9)) for half in (700.0, 450.0))
    x, y = np.repeat(xs, len(ys)), np.tile(ys, len(xs))
    kept = (np.abs(x) <= 700.0 - margin_mm) & (np.abs(y) <= 450.0 - margin_mm)
    for middle_x, middle_y in WINDOWS_MM:
        away = np.hypot(
            np.maximum(0.0, np.abs(x - middle_x) - WINDOW_HALF_MM),
            np.maximum(0.0, np.abs(y - middle_y) - WINDOW_HALF_MM),
        )
        kept &= away > margin_mm
    for middle_x, middle_y in HOLES_MM:
        kept &= np.hypot(x - middle_x, y - middle_y) > HOLE_RADIUS_MM + margin_mm
    return frozen(np.round(np.column_stack([x, y, np.zeros(len(x))])[kept], 6))


def settled(space: OptionSpace) -> Task:
    """Return the space with every default filled in and the program's benchmark grasp."""
    return settle(space, Parameters(), None)


def with_counts(space: OptionSpace, cups: int, magnets: int) -> Task:
    """Return the space with just so many elements, and the FoS goal that they just meet."""
    kinds = tuple(
        replace(kind, count_min=count, count_max=count)
        for kind, count in zip(space.kinds, (cups, magnets), strict=True)
    )
    return needing(replace(space, kinds=kinds), cups, magnets)


def needing(space: OptionSpace, cups: int, magnets: int) -> Task:
    """Return the space with the FoS goal that so many elements just meet."""
    force = cups * space.kinds[0].force_n + magnets * space.kinds[1].force_n
    return settle(space, Parameters(fos=force / space.part.weight_n), None)


def main() -> None:
    """Write one export."""
    parser = argparse.ArgumentParser(description="Write an option space as CAD exports it.")
    parser.add_argument("footprints", type=int)
    parser.add_argument("file", type=Path)
    said = parser.parse_args()
    said.file.write_bytes(export_workbook(door_frame_of(said.footprints)).content)


if __name__ == "__main__":
    main()
