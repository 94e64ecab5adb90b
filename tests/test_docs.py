"""The pages in ``docs/`` say what the program does: no more, no less, and with the right numbers."""

from __future__ import annotations

import dataclasses
import json
import math
import re
import shlex
import shutil
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import openpyxl
import pytest
import typer

from grasp_xl import criteria
from grasp_xl.chromosome import Chromosome
from grasp_xl.cli.program import app, main
from grasp_xl.commands.check import check_file
from grasp_xl.commands.preparing import given_grasp, prepare
from grasp_xl.errors import MAX_PROBLEMS, GraspError
from grasp_xl.fitment import csv_table, element
from grasp_xl.fitment.catalogue import find, read_catalogue
from grasp_xl.fitment.deflection_polygon import SIMPLER
from grasp_xl.fitment.footprint import TOLERANCE_MM
from grasp_xl.fitment.material import MATERIALS
from grasp_xl.grasp import evaluate
from grasp_xl.rules import Goals, Requirements, Rules, Terms
from grasp_xl.search import stop
from grasp_xl.search.floors import search_space
from grasp_xl.space import (
    GRAVITY_M_S2,
    MAX_COUNT,
    MAX_FOOTPRINTS,
    ElementKind,
    OptionSpace,
    Part,
    frozen,
    scaled_polygon,
)
from grasp_xl.task import DEFAULTS, Parameters
from grasp_xl.workbook import (
    cells,
    layout,
    package,
    part_sheet,
    reading_places,
    reading_polygon,
    run_log,
    stored,
)
from grasp_xl.workbook.book import read_book

ROOT = Path(__file__).parents[1]
DOCS = ROOT / "docs"
ALGORITHM, COMMANDS, ELEMENTS, FITMENT, WORKBOOK = (
    (DOCS / f"{name}.md").read_text(encoding="utf-8")
    for name in ("algorithm", "commands", "elements", "fitment", "workbook")
)

OTHER_SECTIONS = {"Options", "Exit codes", "JSON"}
"""Sections of the page of commands that are about all of them."""

NO_COMMAND = ("before the command", "anywhere")
"""What the option table says of options that belong to no command."""

TASK_FIELDS = {
    "UserStart": DEFAULTS.user_start,
    "Elitism": DEFAULTS.elitism,
    "MutationOneIn": DEFAULTS.one_in,
    "Generations": DEFAULTS.generations,
    "DensityRatio": DEFAULTS.density_ratio,
    "FoSGoal": DEFAULTS.fos,
    "Children": DEFAULTS.children,
    "Seed": DEFAULTS.seed,
}

Row = dict[str, str]


def rows(text: str, *columns: str) -> Iterator[Row]:
    """Yield the rows of all tables that have these columns, as column: cell."""
    header: list[str] = []
    for line in text.splitlines():
        if not line.startswith("|"):
            header = []
            continue
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if not header:
            header = cells
        elif set(line) - set("|-: ") and set(columns) <= set(header):
            yield dict(zip(header, cells, strict=True))


def section(text: str, heading: str) -> str:
    """Return what stands below a heading, up to the next one."""
    return re.split(r"^#+ ", text.partition(f"{heading}\n")[2], flags=re.MULTILINE)[0]


def literals(cell: str) -> list[str]:
    """Return what a cell has between backticks."""
    return re.findall(r"`([^`]+)`", cell)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with copies of the sample workbooks and parts."""
    copies = tmp_path_factory.mktemp("samples")
    for sample in (ROOT / "workbooks").iterdir():
        if sample.suffix in (".xlsx", ".step", ".dxf"):
            shutil.copy(sample, copies)
    return copies


# --- commands ---

GROUP = typer.main.get_command(app)
SUBCOMMANDS = GROUP.commands  # type: ignore[attr-defined]
GLOBAL_OPTIONS = {name for option in GROUP.params for name in option.opts} | {"--help"}
OPTIONS = {
    (command, name)
    for command, parser in SUBCOMMANDS.items()
    for option in parser.params
    if option.param_type_name == "option"
    for name in (*option.opts, *option.secondary_opts)
}


def test_every_command_has_a_section_and_nothing_else_has() -> None:
    headings = set(re.findall(r"^## (.+)$", COMMANDS, flags=re.MULTILINE))
    assert headings - OTHER_SECTIONS == set(SUBCOMMANDS)


def test_the_option_table_is_that_of_the_program() -> None:
    documented, documented_global = set(), set()
    for row in rows(COMMANDS, "Option", "Commands"):
        if row["Commands"] in NO_COMMAND:
            documented_global |= set(literals(row["Option"]))
        else:
            documented |= {
                (command, option)
                for command in row["Commands"].split(", ")
                for option in literals(row["Option"])
            }
    assert documented == OPTIONS
    assert documented_global == GLOBAL_OPTIONS


@pytest.mark.parametrize("text", [ALGORITHM, COMMANDS, ELEMENTS, FITMENT, WORKBOOK])
def test_no_page_speaks_of_an_unknown_option(text: str) -> None:
    known = {name for _, name in OPTIONS} | GLOBAL_OPTIONS
    assert set(re.findall(r"(?<![\w-])--[a-z][a-z-]*", text)) <= known


def test_exit_codes_are_all_documented() -> None:
    documented = {int(row["Code"]) for row in rows(COMMANDS, "Code")}
    raised = {error.exit_code for error in (GraspError, *GraspError.__subclasses__())}
    assert documented == raised | {0, 130}


def test_stop_reasons_are_all_documented() -> None:
    rules = (stop.Generations(1), stop.Stall(1), stop.Target(1.0), stop.TimeLimit(1.0))
    reasons = {rule.reason for rule in (*rules, stop.Interrupt())}
    documented = {row["`stop_reason`"].strip("`") for row in rows(ALGORITHM, "`stop_reason`")}
    assert documented == reasons
    row = next(row for row in rows(COMMANDS, "Key") if row["Key"] == "`stop_reason`")
    assert set(literals(row["Value"])) == reasons


def test_every_example_runs(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(folder)
    blocks = re.findall(r"^```\n(.*?)^```$", COMMANDS, flags=re.MULTILINE | re.DOTALL)
    examples = [line for block in blocks for line in block.splitlines()]
    assert {shlex.split(line)[1] for line in examples} == set(SUBCOMMANDS)
    for example in examples:
        program, *words = shlex.split(example)
        assert program == "grasp-xl"
        assert main(words) == 0, example


def keys_of(heading: str) -> set[str]:
    """Return the documented keys of one kind of JSON object."""
    keys = [literals(row["Key"])[0] for row in rows(section(COMMANDS, f"### {heading}"), "Key")]
    assert len(keys) == len(set(keys))
    return set(keys)


def test_json_has_the_documented_keys(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    book, output = str(folder / "bracket.xlsx"), str(folder / "json.xlsx")

    def told(*words: str) -> dict[str, object]:
        main([*words, "--json"])
        answer: dict[str, object] = json.loads(capsys.readouterr().out)
        return answer

    assert set(told("evaluate", book)) == keys_of("JSON of a grasp")
    assert set(told("new", book, "-o", output)) == keys_of("JSON of new")
    assert set(told("run", book, "-o", output, "--generations", "9")) == keys_of("JSON of run")
    assert set(told("check", book)) == keys_of("JSON of check")
    assert set(told("solve", book)) == keys_of("JSON of solve")
    assert set(told("elements")) == keys_of("JSON of elements")
    fit = ("fit", str(folder / "tray.dxf"), "--thickness", "2")
    cup = ("--cup", "SAF 40 NBR-60 M10-AG", "--cup-price", "10")
    assert set(told(*fit, "-o", output, *cup)) == keys_of("JSON of fit")
    assert set(told(*fit, "--list-faces")) == keys_of("JSON of fit --list-faces")
    front = told("front", book, "--time-limit", "0")
    assert set(front) == keys_of("JSON of front")
    study = ("study", book, "-o", str(folder / "study-json.xlsx"), "--runs", "1")
    assert set(told(*study, "--generations", "9")) == keys_of("JSON of study")
    added = {"error", "where", "hint"}
    assert set(told("check", book, "--fos", "99")) == keys_of("JSON of check") | added
    assert set(told("solve", book, "--fos", "99")) == keys_of("JSON of solve") | added
    assert set(told("evaluate", str(folder / "none.xlsx"))) == keys_of("JSON of an error")


# --- fitment ---


def test_materials_and_bounds_of_the_fitment_are_right() -> None:
    table = {
        literals(row["Material"])[0]: (
            float(row["Density (g/cm3)"]),
            row["Magnets hold it"] == "yes",
        )
        for row in rows(FITMENT, "Material")
    }
    assert table == {
        name: (material.density_g_cm3, material.is_magnetic) for name, material in MATERIALS.items()
    }
    text = " ".join(FITMENT.split())
    assert f"compared to {TOLERANCE_MM:f} mm" in text
    assert f"At most {MAX_FOOTPRINTS:,} places" in text
    assert f"({SIMPLER:.0%}".replace("%", " %") in text
    material = next(row for row in rows(COMMANDS, "Option") if "`--material`" in row["Option"])
    assert set(literals(material["Value"])) == set(MATERIALS)


# --- elements ---


def test_every_column_of_the_catalogue_is_documented() -> None:
    columns = list(rows(ELEMENTS, "Column", "Needed"))
    assert {literals(row["Column"])[0] for row in columns} == set(element.COLUMNS)
    needed = {
        need: {literals(r["Column"])[0] for r in columns if r["Needed"] == need}
        for need in ("yes", "a size")
    }
    assert needed == {"yes": set(element.REQUIRED), "a size": element.SIZES}
    kinds = next(row for row in columns if row["Column"] == "`kind`")
    assert set(literals(kinds["Value"])) == set(element.KINDS)


def test_numbers_of_the_catalogue_are_right() -> None:
    elements = read_catalogue().elements
    kinds = Counter(one.kind for one in elements)
    text = " ".join(ELEMENTS.split())
    assert (
        f"a file of {len(elements)}, {kinds['suction']} cups and {kinds['magnets']} magnets" in text
    )
    assert f"no weight of {sum(one.weight_g is None for one in elements)} of them" in text
    assert all(one.price is None for one in elements)
    trust = Counter(one.trust for one in elements)
    assert {r["Trust"]: int(r["Elements"]) for r in rows(ELEMENTS, "Trust")} == trust
    rows_and_size = f"{csv_table.MAX_ROWS:,} rows and {csv_table.MAX_FILE_BYTES // 1_000_000} MB"
    assert rows_and_size in text
    assert f"texts at most {element.MAX_TEXT:,} characters" in text
    assert f"at most {element.MOST:,.0f}, texts" in text
    assert f"up to {MAX_PROBLEMS} problems" in text


def test_the_example_of_an_own_catalogue_is_read(tmp_path: Path) -> None:
    block = next(
        b for b in re.findall(r"^```\n(.*?)^```$", ELEMENTS, re.MULTILINE | re.DOTALL) if "," in b
    )
    path = tmp_path / "mine.csv"
    path.write_text(block, encoding="utf-8")
    catalogue = read_catalogue(path)
    assert catalogue.replaced == ("SGM-HP 40",)
    assert find(catalogue, "cup 50").price == 12.5


# --- workbook ---


def fields_in(value: object) -> Iterator[layout.Field]:
    """Yield the fields that a value of ``layout.py`` holds, however deep."""
    if isinstance(value, layout.Field):
        yield value
    elif isinstance(value, tuple):
        for item in value:
            yield from fields_in(item)
    elif isinstance(value, layout.Section | layout.KindLabels):
        for item in dataclasses.fields(value):
            yield from fields_in(getattr(value, item.name))


FIELDS = {field for value in vars(layout).values() for field in fields_in(value)}
NAMES_IN_CODE = (
    {field.name for field in FIELDS}
    | {labels.locations_name for labels in layout.KINDS}
    | {layout.IDEAL_POLYGON, layout.APPROXIMATION_POLYGON}
    | {
        value
        for name, value in vars(run_log).items()
        if name.isupper() and isinstance(value, str) and value.isalpha()
    }
)


def documented_names() -> list[str]:
    """Return the names of all tables of names; the first card stands for all."""
    return [name for row in rows(WORKBOOK, "Name") for name in literals(row["Name"])]


@pytest.fixture(scope="module")
def written_names(folder: Path) -> dict[str, layout.Area]:
    """Return the names of a full workbook with a proof, written now, and their cells."""
    book = folder / "names.xlsx"
    command = ["front", str(folder / "bracket.xlsx"), "-o", str(book), "--time-limit", "0"]
    assert main([*command, "--quiet"]) == 0
    in_place = ["run", str(book), "--in-place", "--generations", "10", "--quiet"]
    assert main(in_place) == 0
    names = openpyxl.load_workbook(book).defined_names
    return {name: layout.area_of(str(names[name].attr_text)) for name in names}


def test_every_defined_name_is_documented_and_no_other(
    written_names: dict[str, layout.Area],
) -> None:
    written = {re.sub(r"^Child\d+", "Child1", name) for name in written_names}
    assert written >= NAMES_IN_CODE
    documented = documented_names()
    assert set(documented) == written
    assert len(documented) == len(set(documented))


def test_every_label_and_sheet_is_documented() -> None:
    documented = literals(WORKBOOK)
    labels = {field.label for field in FIELDS} | {layout.TITLE, layout.ASSIGNED_MARK}
    assert labels | {*layout.SHEETS, *layout.OCCASIONAL, part_sheet.PART_TITLE} <= set(documented)


def test_cells_are_where_the_page_says(written_names: dict[str, layout.Area]) -> None:
    for row in rows(WORKBOOK, "Cell", "Name"):
        area = written_names[literals(row["Name"])[0]]
        assert area.local == row["Cell"].removesuffix("..")


def test_defaults_of_the_parameters_are_right() -> None:
    documented = {row["Name"].strip("`"): row["Default"] for row in rows(WORKBOOK, "Default")}
    assert {name: float(documented[name]) for name in TASK_FIELDS} == TASK_FIELDS
    assert documented["FitnessCriterion"] == DEFAULTS.criterion.name  # type: ignore[union-attr]
    assert documented["MomentArm"] == DEFAULTS.moment_arm


@pytest.mark.parametrize(
    "limit",
    [
        f"0 to {MAX_COUNT}",
        f"{reading_places.MAX_FOOTPRINTS:,}",
        f"{reading_polygon.MAX_VERTICES:,}",
        f"2 to {layout.MAX_CHILDREN}",
        f"0 to {layout.MAX_GENERATIONS:,}",
        f"0 to {layout.MAX_SEED:,}",
        f"{package.MAX_FILE_BYTES // 1_000_000} MB",
        f"{package.MAX_UNPACKED_BYTES // 1_000_000} MB",
        f"{package.ALWAYS_ALLOWED_BYTES // 1_000_000} MB",
        f"at most {package.MAX_UNPACKED_RATIO} times",
        f"{package.MAX_PARTS:,}; {package.MAX_WHOLE_PART_BYTES // 1_000_000} MB",
        f"{stored.MAX_FILLED_ROWS:,}; {stored.MAX_CELLS:,}",
        f"first {cells.LABEL_ROWS} rows",
        f"at once, up to {MAX_PROBLEMS},",
        f"at most {run_log.MAX_DESIGNS:,}",
        f"at most {run_log.MAX_HISTORY:,}",
    ],
)
def test_limits_are_right(limit: str) -> None:
    assert limit in " ".join(WORKBOOK.split())


# --- numbers of the page on the algorithm ---

CENTROID = frozen([0.032786, 0.006258, 45.06829])
CARD_WEIGHT_N = 135.3407
BENCHMARK_MOMENT = 6099.57
TABLE_4_GOALS = Terms(100.0, BENCHMARK_MOMENT, 27.97, 1111.43)
FINAL_GRASPS = {
    "1 + 3": Terms(100.0, 7575.71, 2.10, 534.04),
    "3 + 2": Terms(90.0, 7619.85, 2.09, 661.54),
}
CUP_N, MAGNET_N = 69.0, 130.0
WHOLE_TEXT = " ".join(ALGORITHM.split())


def kind(name: str, footprints_mm: object, force_n: float) -> ElementKind:
    """Return an element kind, one to five of it, free of charge."""
    return ElementKind(name, force_n, 0.0, 1, 5, frozen(footprints_mm))


def reference_space(mass_g: float) -> OptionSpace:
    """Return an option space with the active places of figure 33, unrounded, and no others."""
    cups = [(180 - 360 * i / 35, 110 - 220 * j / 21, 100) for i, j in ((23, 2), (16, 19), (31, 19))]
    magnet = [(180 - 360 * 2 / 35, 110 - 220 * 10 / 21, 100)]
    corners = frozen([(-180, 110, 0), (180, 110, 0), (180, -110, 0), (-180, -110, 0)])
    kinds = (kind("suction", cups, 24.0), kind("magnets", magnet, MAGNET_N))
    return OptionSpace(Part(mass_g, CENTROID), kinds, corners, 0.65)


def test_p1_benchmark_moment_is_that_of_an_unevaluated_card() -> None:
    offset = criteria.eccentricity(np.zeros(3), CENTROID, "3d")
    assert offset == pytest.approx(45.06831, abs=1e-5)
    assert criteria.residual_moment(offset, CARD_WEIGHT_N) == pytest.approx(6099.575, abs=2e-3)
    assert f"45.06831 mm x 135.3407 N = {45.06831 * CARD_WEIGHT_N:.2f} N-mm" in WHOLE_TEXT


def test_p1_moments_against_the_floor_are_as_quoted() -> None:
    arm = 100.0 - float(CENTROID[2])
    floor = criteria.residual_moment(arm, CARD_WEIGHT_N)
    assert f"100 - 45.06829 = {arm:.5f} mm" in WHOLE_TEXT
    assert f"{arm:.5f} mm x 135.3407 N = {floor:.1f} N-mm" in WHOLE_TEXT
    assert floor > BENCHMARK_MOMENT
    for grasp, terms in FINAL_GRASPS.items():
        above = [100 * (terms.moment / base - 1) for base in (BENCHMARK_MOMENT, floor)]
        row = f"| {grasp} elements | {terms.moment} | {above[0]:.1f} % more | {above[1]:.1f} % more"
        assert row in ALGORITHM
    quoted = [
        " and ".join(f"{Goals(goals).divergence(terms):.2f}" for terms in FINAL_GRASPS.values())
        for goals in (TABLE_4_GOALS, TABLE_4_GOALS._replace(moment=floor))
    ]
    assert f"divergences {quoted[0]} become {quoted[1]}" in WHOLE_TEXT


def test_unit_prices_that_the_thesis_needs_are_as_quoted() -> None:
    compared = list(rows(ALGORITHM, "Printed cost"))
    for row in compared:
        counts = np.array([int(word) for word in row["Counts (cups + magnets)"].split("+")])
        for column in ("12 / 20", "5 / 30", "10 / 30"):
            prices = np.array([float(word) for word in column.split("/")])
            assert criteria.cost(counts, prices) == float(row[f"With {column}"])
        fitting = "5 / 30" if "figure" in row["Source"] else "10 / 30"
        assert row["Printed cost"] == row[f"With {fitting}"]
    assert len(compared) == 5


def test_mass_of_p2_follows_from_its_factors_of_safety() -> None:
    counts = {3.08: (2, 1), 3.88: (3, 1), 4.58: (2, 2), 6.78: (1, 4), 7.57: (2, 4)}
    masses = []
    for fos, (cups, magnets) in counts.items():
        lifted = (cups * CUP_N + magnets * MAGNET_N) / GRAVITY_M_S2
        masses.append((lifted / (fos + 0.005), lifted / (fos - 0.005)))
    least, most = max(low for low, _ in masses), min(high for _, high in masses)
    assert f"from {least:.3f} to {most:.3f} kg" in WHOLE_TEXT
    first = (2 * CUP_N + MAGNET_N) / GRAVITY_M_S2
    assert f"With 8.4 kg the first would be {first / 8.4:.2f}" in WHOLE_TEXT
    assert f"with 8.85 kg {first / 8.85:.2f}" in WHOLE_TEXT


def test_reference_card_numbers_are_as_quoted() -> None:
    rules = Rules(Goals(Terms(105.0, 7933.465, 24.53555, 1130.17)), Requirements())
    moments = {}
    for mass in (13796.19, 13796.195):
        space = reference_space(mass)
        genes = given_grasp(space, ((1, 2, 3), (1,)))
        assert genes
        grasp = evaluate(space, rules, genes)
        moments[mass] = f"{grasp.terms.moment:.2f}"
        assert f"this gives {grasp.terms.deviation:.5f} mm" in WHOLE_TEXT
        assert f"have FoS {grasp.fos:.2f} under" in WHOLE_TEXT
    assert f"as printed, {moments[13796.195]}; with 13796.19 g it is {moments[13796.19]}" in (
        WHOLE_TEXT
    )
    lightest, heaviest = (
        f"{(CARD_WEIGHT_N + slack) / GRAVITY_M_S2 * 1000:.4f}" for slack in (-5e-5, 5e-5)
    )
    assert f"from {lightest} to" in WHOLE_TEXT
    assert float(heaviest) > 13796.195
    assert f"which weighs {Part(13796.19, CENTROID).weight_n:.4f} N" in WHOLE_TEXT


def test_ideal_polygon_heights_are_as_quoted() -> None:
    space = reference_space(13796.19)
    polygon = scaled_polygon(space.approximation_polygon_mm, CENTROID, 0.65)
    assert f"45.06829 x (1 - 0.65) = {polygon[0, 2]:.4f}" in WHOLE_TEXT
    points = np.vstack([footprints.footprints_mm for footprints in space.kinds])
    apart = [
        math.hypot(criteria.distance_to_boundary(point, polygon), point[2] - polygon[0, 2])
        for point in points
    ]
    assert f"distances in space would give {np.mean(apart):.2f} mm" in WHOLE_TEXT


def test_pitch_of_figure_25_is_as_quoted() -> None:
    spacings = [length / (math.floor(length / 10) - 1) for length in (360, 220)]
    assert f"{spacings[0]:.4f} mm apart in x and {spacings[1]:.4f} mm in y" in WHOLE_TEXT


def test_size_of_the_search_is_that_of_figure_12() -> None:
    kinds = (kind("suction", np.zeros((141, 3)), 1.0), kind("magnets", np.zeros((84, 3)), 1.0))
    space = OptionSpace(Part(1.0, CENTROID), kinds, frozen(np.eye(3)), 1.0)
    assert f"it is {search_space(space):.4e}".replace("e+", "e") in WHOLE_TEXT


def test_bracket_sits_on_its_moment_floor_as_the_page_says() -> None:
    path = ROOT / "workbooks" / "bracket.xlsx"
    floor = check_file(path, Parameters()).floors.moment
    task = prepare(read_book(path), Parameters())
    assert task.benchmark.terms.moment == pytest.approx(floor, rel=1e-12)
    assert f"z = {task.space.part.centroid_mm[2]:.1f} mm" in WHOLE_TEXT
    assert f"below {floor:,.1f} N-mm" in WHOLE_TEXT
    plan = prepare(read_book(path), Parameters(moment_arm="plan"))
    assert plan.rules.goals.dropped == {"moment"}
    result = read_book(path.with_name("bracket-result.xlsx")).saved_run()
    designs = [
        evaluate(task.space, task.rules, Chromosome(genes)) for genes in result.state.designs.genes
    ]
    assert designs
    assert all(design.terms.moment > floor * (1 + 1e-6) for design in designs)
