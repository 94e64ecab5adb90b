"""Random option spaces, chromosomes and parameters for the proof of the living workbook.

Deterministic: a seed names its case, and its remainders choose what is special about it.
"""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime
from itertools import combinations

import numpy as np
from spaces import kind

from grasp_xl.chromosome import BLANK_GENE, Chromosome
from grasp_xl.grasp import evaluate
from grasp_xl.rules import TERMS, Criterion
from grasp_xl.search.exact import Proof, Status
from grasp_xl.search.genetic import search
from grasp_xl.search.stop import Generations
from grasp_xl.space import ElementKind, OptionSpace, Part, frozen
from grasp_xl.task import Parameters, Task, settle
from grasp_xl.workbook.proved import Proved
from grasp_xl.workbook.run_log import Origin
from grasp_xl.workbook.writing import full_workbook

ORIGIN = Origin("case.xlsx", "0" * 64, datetime(2024, 1, 1), datetime(2024, 1, 1))  # noqa: DTZ001
CRITERIA = [
    Criterion(frozenset(terms))
    for size in range(1, 1 + len(TERMS))
    for terms in combinations(TERMS, size)
]
"""All fifteen."""
PLACES = ("lattice", "twins", "scattered", "one kind", "mirrored")
"""Ties of distances; cups and magnets at the same places; no two alike; a kind without footprints;
rectangles turned by some angle, whose two diagonals are equal but for rounding."""
HEIGHTS = (0.0, 18.0)
GENERATIONS = 20


@dataclass(frozen=True, eq=False, slots=True)
class Case:
    """One workbook to be: what is special about it, its task, and the What-if genes if typed."""

    places: str
    task: Task
    what_if: Chromosome | None

    @property
    def space(self) -> OptionSpace:
        """The option space."""
        return self.task.space

    @property
    def shown(self) -> list[Chromosome]:
        """The chromosomes that were drawn for it."""
        return [self.task.benchmark.chromosome, *([self.what_if] if self.what_if else [])]

    def workbook(self, generations: int = GENERATIONS) -> bytes:
        """Run a short search and return the full workbook."""
        task = self.task
        result = search(
            task.space,
            task.rules,
            task.settings,
            task.benchmark.chromosome,
            [Generations(generations)],
        )
        proved = self.proved
        return full_workbook(task, result, ORIGIN, what_if=self.what_if, proved=proved).content

    @property
    def proved(self) -> Proved | None:
        """What an exact search might have said: a card can show any grasp."""
        if self.what_if is None:
            return None
        grasp = evaluate(self.space, self.task.rules, self.what_if)
        feasible = self.places == "scattered"
        bound = grasp.value / 2 if feasible else grasp.value
        status: Status = "feasible" if feasible else "optimal"
        return Proved(Proof(status, bound, (grasp,), 1.0, nodes=0))


def random_case(seed: int) -> Case:
    """Return the case of a seed."""
    rng = np.random.default_rng(seed)
    places = PLACES[seed % len(PLACES)]
    space = OptionSpace(
        part=Part(rng.uniform(500, 20_000), _centroid(rng, places)),
        kinds=_kinds(rng, places, wide=seed % 9 == 0),
        approximation_polygon_mm=_polygon(rng, corners=3 + seed % 10),
        scale_factor=float(rng.choice([0.35, 0.5, 0.65, 1.0])),
    )
    user, what_if = (_chromosome(rng, space) for _ in range(2))
    if places == "mirrored":
        what_if = _rectangle(rng, space)
    if seed % 7 == 0:  # one element has no structure, so that its goal is dropped
        user = _one_element(space)
    typed = rng.uniform(1, 5000, len(TERMS)).tolist()
    parameters = Parameters(
        user_start=bool(rng.integers(2)),
        elitism=bool(rng.integers(2)),
        clearance_mm=_perhaps(rng, float(rng.choice([10.0, 25.0, 46.0]))),
        density_ratio=float(rng.choice([0.0, 1.0, 2.5, 4.0])),
        criterion=CRITERIA[seed % len(CRITERIA)],
        fos=float(rng.choice([0.5, 1.5, 3.0])),
        goals=tuple(_perhaps(rng, goal) for goal in typed),
        children=2,
        seed=seed,
        moment_arm=("3d", "plan")[seed % 2],
    )
    return Case(places, settle(space, parameters, user), what_if if seed % 3 else None)


def _perhaps(rng: np.random.Generator, value: float) -> float | None:
    return value if rng.integers(2) else None


def _centroid(rng: np.random.Generator, places: str) -> np.ndarray:
    if places == "lattice" and rng.integers(2):  # the centre of force may meet it exactly
        return frozen([0.0, 0.0, HEIGHTS[1]])
    return frozen(rng.uniform([-20, -20, -10], [20, 20, 10]))


def _polygon(rng: np.random.Generator, corners: int) -> np.ndarray:
    """Corners around the origin, each in its own sector, so that no two edges cross."""
    turns = 2 * np.pi * (np.arange(corners) + rng.uniform(-0.3, 0.3, corners)) / corners
    radii = rng.uniform(90, 210, corners)
    height = np.full(corners, rng.choice(HEIGHTS))
    return frozen(np.column_stack([radii * np.cos(turns), radii * np.sin(turns), height]))


def _kinds(rng: np.random.Generator, places: str, *, wide: bool) -> tuple[ElementKind, ...]:
    points = [_points(rng, places) for _ in range(2)]
    if places == "twins":  # but for the last bit, as two CAD features may round
        shared = min(len(each) for each in points)
        points[1][:shared, :2] = points[0][:shared, :2] * rng.choice([1.0, 1.0 + 2.0**-52])
    if places == "one kind":
        points[int(rng.integers(2))] = np.zeros((0, 3))
    kinds = []
    for name, each in zip(("suction", "magnets"), points, strict=True):
        least = int(rng.integers(0, 1 + min(2, len(each))))
        most = int(rng.integers(6, 9) if wide else rng.integers(max(1, least), 6))
        most = max(4, most) if places == "mirrored" else most
        kinds.append(
            kind(
                name,
                each,
                count_min=least,
                count_max=most,
                force_n=float(rng.choice([24.0, 69.0, 130.0])),
                price=float(rng.choice([0.0, 10.0, 30.0])),
                weight_g=_perhaps(rng, float(rng.uniform(20, 400))),
                diameter_mm=_perhaps(rng, float(rng.choice([20.0, 30.0, 46.0]))),
            )
        )
    return tuple(kinds)


def _points(rng: np.random.Generator, places: str) -> np.ndarray:
    """Return one to sixteen places (or the corners of up to five rectangles) at two heights."""
    number = int(rng.integers(1, 17))
    heights = rng.choice(HEIGHTS, number)
    if places == "scattered":
        return np.column_stack([rng.uniform([-180, -120], [180, 120], (number, 2)), heights])
    if places == "mirrored":
        return _rectangles(rng, 1 + number // 4)
    lattice = [(30.0 * column, 30.0 * row) for column in range(-3, 4) for row in range(-2, 3)]
    chosen = rng.choice(lattice, number, replace=False)
    return np.column_stack([chosen, heights])


def _rectangles(rng: np.random.Generator, number: int) -> np.ndarray:
    """Return the corners of rectangles around the origin, all turned by one angle."""
    halves = rng.uniform([20, 20], [150, 90], (number, 1, 2))
    corners = (halves * [[1, 1], [-1, 1], [1, -1], [-1, -1]]).reshape(-1, 2)
    turn = rng.uniform(0, np.pi)
    cosine, sine = np.cos(turn), np.sin(turn)
    turned = corners @ np.array([[cosine, sine], [-sine, cosine]])
    return np.column_stack([turned, rng.choice(HEIGHTS, len(turned))])


def _chromosome(rng: np.random.Generator, space: OptionSpace) -> Chromosome:
    """Return random genes; those that are active differ within a kind."""
    genes = np.full((len(space.kinds), 1 + space.gene_slots), BLANK_GENE)
    for row, each in zip(genes, space.kinds, strict=True):
        row[0] = rng.integers(each.count_min, 1 + each.most)
        if each.total:
            order = rng.permutation(np.arange(1, 1 + each.total))
            row[1:] = np.resize(order, space.gene_slots)
    return Chromosome(genes) if genes[:, 0].any() else _one_element(space)


def _rectangle(rng: np.random.Generator, space: OptionSpace) -> Chromosome:
    """Return the four corners of one rectangle of the ``mirrored`` places, of one kind."""
    genes = np.array(_one_element(space).genes)
    genes[:, 0] = [each.count_min for each in space.kinds]
    genes[int(rng.integers(2)), 0] = 4
    return Chromosome(genes)


def _one_element(space: OptionSpace) -> Chromosome:
    """Return a grasp of as few elements as may be, at least one."""
    genes = np.full((len(space.kinds), 1 + space.gene_slots), BLANK_GENE)
    for row, each in zip(genes, space.kinds, strict=True):
        row[0] = each.count_min
        if each.total:
            row[1:] = np.resize(np.arange(1, 1 + each.total), space.gene_slots)
    if not genes[:, 0].any():
        genes[[each.total > 0 for each in space.kinds].index(True), 0] = 1
    return Chromosome(genes)
