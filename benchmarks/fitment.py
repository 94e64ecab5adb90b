"""Time the fitment: places on a plate, and parts of a folder from the file to the option space.

``python -m benchmarks.fitment`` times the search for places on plates of our own, beside the same
search point by point with shapely.  ``python -m benchmarks.fitment FOLDER`` also goes through the
STEP and DXF files of a folder, along every axis and unit that they take, and prints what it finds.
"""

from __future__ import annotations

import argparse
import statistics
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import shapely
from shapely import Point, Polygon, box

from grasp_xl.errors import GraspError, InputError
from grasp_xl.fitment.catalogue import find, read_catalogue
from grasp_xl.fitment.fitting import Choice, Fitment, fit
from grasp_xl.fitment.footprint import covered, footprint_of, lies_inside, middle_lies_inside
from grasp_xl.fitment.grid import grid
from grasp_xl.fitment.part_file import DXF_SUFFIX, STEP_SUFFIXES, Reading, read_part
from grasp_xl.fitment.words import AXES

REPEATS = 5
STEEL_G_MM3 = 7.85e-3
THICKNESS_MM = 2.0

ELEMENTS = read_catalogue()
CUP, MAGNET = (find(ELEMENTS, name) for name in ("SAF 40 NBR-60 M10-AG", "SGM-HP 30 G1/8-IG"))
PLATE = box(0, 0, 600, 600)
HOLES = [Point(x, y).buffer(10, 16) for x in range(40, 600, 57) for y in range(40, 600, 57)]
PLATES = {"plate": PLATE, f"plate, {len(HOLES)} holes": PLATE.difference(shapely.union_all(HOLES))}


def places(face: Polygon, pitch_mm: float) -> tuple[int, int, int]:
    """Return how many points, cups and magnets a face has."""
    cup, magnet = footprint_of(CUP), footprint_of(MAGNET)
    points = grid(face, pitch_mm)
    cups = points[lies_inside(face, points, cup)]
    magnets = points[middle_lies_inside(face, points)]
    covered(face, magnets, magnet)
    return len(points), len(cups), len(magnets)


def places_one_by_one(face: Polygon, pitch_mm: float) -> tuple[int, int, int]:
    """Return the same, as one would write it with shapely's objects."""
    points = grid(face, pitch_mm)
    cups = magnets = 0
    for x, y in points.tolist():
        point = Point(x, y)
        if face.contains(point):
            magnets += 1
            point.buffer(15).intersection(face).area  # noqa: B018 (it is timed)
            cups += face.boundary.distance(point) >= 23 - 1e-6
    return len(points), cups, magnets


def seconds(call: Callable[[], object], repeats: int = REPEATS) -> float:
    """Return the median time of a call, after one that is not counted."""
    call()
    taken = []
    for _ in range(repeats):
        began = time.perf_counter()
        call()
        taken.append(time.perf_counter() - began)
    return statistics.median(taken)


def time_plates() -> None:
    """Print the times of the plates."""
    print("face, pitch (mm), points, cups, magnets, ms, one by one (ms), ratio")
    for name, face in PLATES.items():
        for pitch in (10.0, 600 / 448):
            counts = places(face, pitch)
            ours = seconds(lambda face=face, pitch=pitch: places(face, pitch))
            told = "-"
            if counts[0] < 10_000:
                assert places_one_by_one(face, pitch) == counts
                theirs = seconds(lambda f=face, p=pitch: places_one_by_one(f, p), repeats=3)
                told = f"{theirs * 1e3:.0f}, {theirs / ours:.0f}"
            print(f"{name}, {pitch:.2f}, {counts}, {ours * 1e3:.1f}, {told}")


def readings(path: Path) -> list[Reading]:
    """Return the ways in which a file may be read."""
    if path.suffix.lower() == DXF_SUFFIX:
        plain = Reading(thickness_mm=THICKNESS_MM)
        return [plain, replace(plain, units="mm"), replace(plain, part=1)]
    return [Reading(up=axis) for axis in AXES] + [Reading(part=1)]


def go_through(folder: Path) -> None:
    """Print what each file of a folder gives: faces and places, or why it gives none."""
    fitment = Fitment(
        Choice(CUP, 10.0, "all-up", 0, 5), Choice(MAGNET, 30.0, "all-up", 0, 5), 10.0, "auto", 0.6
    )
    for path in sorted(folder.iterdir()):
        if path.suffix.lower() not in (*STEP_SUFFIXES, DXF_SUFFIX):
            continue
        for reading in readings(path):
            told = ", ".join(f"{name} {value}" for name, value in reading.given().items())
            began = time.perf_counter()
            try:
                part = read_part(path, reading)
                read = time.perf_counter() - began
                fitted = fit(part, fitment, part.volume_mm3 * STEEL_G_MM3)
            except InputError as error:
                print(f"{path.name} ({told}): {'; '.join(map(str, error.problems[:2]))}")
            except GraspError as error:
                print(f"{path.name} ({told}): {error.message}")
            else:
                cups, magnets = (kind.total for kind in fitted.space.kinds)
                taken = time.perf_counter() - began
                print(
                    f"{path.name} ({told}): {len(part.faces)} faces, {cups} cups, {magnets} "
                    f"magnets, {len(fitted.notes)} notes; read {read:.2f} s, all {taken:.2f} s"
                )


def main() -> None:
    """Time the plates, then a folder if one is named."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path, nargs="?")
    said = parser.parse_args()
    time_plates()
    if said.folder:
        go_through(said.folder)


if __name__ == "__main__":
    main()
