"""Option spaces for tests: the thesis's reference card, and random ones for properties."""

from __future__ import annotations

from itertools import combinations, product

import numpy as np
from hypothesis import strategies as st

from grasp_xl.chromosome import Chromosome, from_active
from grasp_xl.grasp import Grasp, evaluate
from grasp_xl.rules import Criterion, Goals, Requirements, Rules, Terms
from grasp_xl.space import ElementKind, OptionSpace, Part, frozen

ANY_CRITERION = ("divergence", "cost", "moment", "deviation", "structure", "cost+moment")


def rectangle(width: float, height: float, z: float = 0.0) -> np.ndarray:
    """Corners of a rectangle about the origin, ``(4, 3)``."""
    x, y = width / 2, height / 2
    return frozen([[-x, -y, z], [x, -y, z], [x, y, z], [-x, y, z]])


def kind(name: str, points: object, **values: object) -> ElementKind:
    """Make an element kind; cups of the thesis unless told otherwise."""
    known = {"force_n": 69.0, "price": 10.0, "count_min": 1, "count_max": 5, **values}
    return ElementKind(name=name, footprints_mm=frozen(np.reshape(points, (-1, 3))), **known)


def grid_point(column: int, row: int) -> tuple[float, float, float]:
    """Unrounded place on the thesis's 400 x 220 mm grid (figure 25), z = 100 mm."""
    return 180 - 360 * column / 35, 110 - 220 * row / 21, 100.0


def reference_space() -> OptionSpace:
    """The active elements of child 1 of figure 33, as the only footprints."""
    cups = [grid_point(23, 2), grid_point(16, 19), grid_point(31, 19)]
    magnet = [grid_point(2, 10)]
    return OptionSpace(
        part=Part(13796.195, frozen([0.032786, 0.006258, 45.06829])),
        kinds=(
            kind("suction", cups, force_n=24.0, price=5.0),
            kind("magnets", magnet, force_n=130.0, price=30.0),
        ),
        approximation_polygon_mm=rectangle(360, 220),
        scale_factor=0.65,
    )


def some_rules(
    goals: tuple[float, float, float, float] = (80.0, 2000.0, 30.0, 1500.0),
    criterion: str = "divergence",
    **requirements: object,
) -> Rules:
    """Make rules with the thesis's requirements unless told otherwise."""
    return Rules(Goals(Terms(*goals)), Requirements(**requirements), Criterion.parse(criterion))


def plate(seed: int = 0, cups: int = 40, magnets: int = 60) -> OptionSpace:
    """A 1100 x 800 mm plate of 8.86 kg with scattered footprints at two heights."""
    rng = np.random.default_rng(seed)

    def scattered(count: int) -> np.ndarray:
        heights = rng.choice([0.0, 12.0], count)
        return np.column_stack(
            [rng.uniform(-520, 520, count), rng.uniform(-370, 370, count), heights]
        )

    return OptionSpace(
        part=Part(8860.0, frozen([3.0, -5.0, 2.0])),
        kinds=(
            kind("suction", scattered(cups)),
            kind("magnets", scattered(magnets), force_n=130.0, price=30.0),
        ),
        approximation_polygon_mm=rectangle(1100, 800),
        scale_factor=0.6,
    )


@st.composite
def option_spaces(draw: st.DrawFn, most: int = 12) -> OptionSpace:
    """Random small option spaces: lattice places, so that ties and twins of kinds occur."""
    place = st.tuples(
        st.integers(-6, 6).map(lambda n: 25.0 * n),
        st.integers(-4, 4).map(lambda n: 25.0 * n),
        st.sampled_from([0.0, 18.0]),
    )
    kinds = []
    for name in ("suction", "magnets"):
        least_points = 1 if name == "suction" else 0
        points = draw(st.lists(place, min_size=least_points, max_size=most, unique=True))
        count_min = draw(st.integers(0, min(2, len(points))))
        kinds.append(
            kind(
                name,
                points,
                count_min=count_min,
                count_max=draw(st.integers(max(1, count_min), 7)),
                force_n=draw(st.sampled_from([24.0, 69.0, 130.0])),
                price=draw(st.sampled_from([0.0, 10.0, 30.0])),
            )
        )
    corners = draw(st.integers(3, 8))
    turns = 2 * np.pi * np.arange(corners) / corners
    polygon = np.column_stack([150 * np.cos(turns), 110 * np.sin(turns), np.zeros(corners)])
    centroid = [draw(st.floats(-20, 20)), draw(st.floats(-20, 20)), draw(st.floats(-10, 10))]
    return OptionSpace(
        part=Part(draw(st.floats(500, 20_000)), frozen(centroid)),
        kinds=tuple(kinds),
        approximation_polygon_mm=frozen(polygon),
        scale_factor=draw(st.sampled_from([0.5, 0.65, 1.0])),
    )


@st.composite
def chromosomes(draw: st.DrawFn, space: OptionSpace) -> Chromosome:
    """Random chromosomes of an option space, at least one element, active genes distinct."""
    genes = np.zeros((len(space.kinds), 1 + space.gene_slots), dtype=np.int64)
    for row, each in zip(genes, space.kinds, strict=True):
        if each.total:
            row[0] = draw(st.integers(each.count_min, each.most))
            order = draw(st.permutations(range(1, each.total + 1)))
            row[1:] = np.resize(order, len(row) - 1)
    if not genes[:, 0].any():
        genes[0, 0] = 1
    return Chromosome(genes)


@st.composite
def any_rules(draw: st.DrawFn) -> Rules:
    """Random rules of both moment arms and every sort of criterion."""
    goal = st.floats(1.0, 5000.0)
    return some_rules(
        goals=draw(st.tuples(goal, goal, goal, goal)),
        criterion=draw(st.sampled_from(ANY_CRITERION)),
        fos=draw(st.sampled_from([0.5, 1.5, 3.0])),
        clearance_mm=draw(st.sampled_from([10.0, 25.0, 46.0])),
        moment_arm=draw(st.sampled_from(["3d", "plan"])),
    )


def every_grasp(space: OptionSpace, rules: Rules) -> list[Grasp]:
    """Judge every grasp of an option space, feasible or not."""
    choices = [
        [
            chosen
            for count in range(each.count_min, each.most + 1)
            for chosen in combinations(range(1, each.total + 1), count)
        ]
        for each in space.kinds
    ]
    return [
        evaluate(space, rules, from_active(space, active))
        for active in product(*choices)
        if any(active)
    ]


def all_grasps(space: OptionSpace, rules: Rules) -> list[Grasp]:
    """Judge every feasible grasp of an option space, best first."""
    feasible = (grasp for grasp in every_grasp(space, rules) if grasp.feasible)
    return sorted(feasible, key=lambda grasp: grasp.value)
