"""The living workbook: what LibreOffice calculates is what the engine says, also after typing."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
import sys
import zipfile
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import openpyxl
import pytest
from live_cases import CRITERIA, PLACES, Case, random_case
from office import CellValue, Office, Place, need_arial
from shapely import LineString, Point, Polygon
from spaces import kind as element_kind
from spaces import rectangle

from grasp_xl.chromosome import Chromosome
from grasp_xl.commands.evaluate import evaluate_grasp
from grasp_xl.commands.output import Output
from grasp_xl.commands.preparing import prepare
from grasp_xl.commands.run import run_file
from grasp_xl.commands.solve import prove_run
from grasp_xl.grasp import Grasp, evaluate
from grasp_xl.search.stop import Generations
from grasp_xl.space import OptionSpace, Part
from grasp_xl.task import Parameters, Task, settle
from grasp_xl.workbook import grasp_sheet, layout
from grasp_xl.workbook.book import read_book
from grasp_xl.workbook.calc_block import CalcBlock
from grasp_xl.workbook.cells import MAX_NUMBER
from grasp_xl.workbook.grasp_sheet import Picture
from grasp_xl.workbook.layout import (
    APPROXIMATION_COLUMN,
    FIRST_LOCATION_ROW,
    FITNESS_TABLE,
    GA,
    GOAL_NAMES,
    GRASP,
    HISTORY,
    KINDS,
    OPTION_SPACE,
    POLYGON_HEADER_ROW,
    TABLE_ROW,
    VALID_DESIGNS,
    Area,
    Card,
    Layout,
)
from grasp_xl.workbook.picker import DESIGN_PICK, GENE_COLUMN, PICK_ROW

SAMPLES = Path(__file__).parents[1] / "workbooks"
NAMES = ("bracket", "door_frame", "panel", "tunnel_cover")
CASES = 200
ACCURACY = 1e-9
"""Relative; absolute below 1 mm, N, N-mm, $ or mm², where the rounding of larger numbers remains."""

PLAN = Layout(gene_slots=5, children=5)
CARDS = {
    **{f"Child{number + 1}": PLAN.card(number) for number in range(PLAN.children)},
    "WhatIf": PLAN.what_if,
    "Proved": PLAN.proved,
}
USER = PLAN.block_genes(layout.USER_BLOCK)
WHAT_IF_GENES = PLAN.what_if.genes
CARD_ROWS, CARD_COLUMNS = 43, 7
GA_CELLS = Area(GA, 0, 0, PLAN.card_row + CARD_ROWS, PLAN.proved.column + CARD_COLUMNS)
STATUS, DIFFERENCE = (35, 0), (42, 5)
NOT_AVAILABLE = "#N/A"
GOAL_LABELS = dict(
    zip(
        GOAL_NAMES,
        ("Cost ($)", "Residual Moment (N-mm)", "Deviation (mm)", "Structure (mm)"),
        strict=True,
    )
)
UP_TO = "at most 1,000,000,000"
NO_BENCHMARK = "no user-defined grasp to take it from; mend that chromosome, or type a goal."

FUNCTIONS = {
    *("ABS", "AND", "COLUMN", "COUNT", "IF", "INDEX", "INT", "ISNUMBER", "LEFT", "MAX"),
    *("COUNTA", "COUNTIF", "ISERROR", "ISLOGICAL", "LOWER", "MATCH", "MOD", "SUBSTITUTE"),
    *(
        "MIN",
        "N",
        "NA",
        "NOT",
        "OR",
        "ROUND",
        "ROW",
        "ROWS",
        "SEARCH",
        "SQRT",
        "SUM",
        "SUMPRODUCT",
        "SUMSQ",
    ),
    "TRIM",
}
"""All that formulas may use: each is in Excel 2016 and LibreOffice 7.4, and none is volatile."""
MAX_FORMULA = 8192
"""Characters of a formula that Excel takes."""


# --- what a file stores, and what LibreOffice makes of it ---


def agrees(stored: CellValue, shown: CellValue) -> bool:
    """Tell whether two values are the same; numbers to the accuracy."""
    if isinstance(stored, str) or isinstance(shown, str):
        return stored == shown
    return abs(stored - shown) <= ACCURACY * max(1.0, abs(stored))


def stored_values(path: Path, cells: list[Area]) -> list[CellValue]:
    """Return what a file stores in cells, as openpyxl reads it."""
    book = openpyxl.load_workbook(path, data_only=True, read_only=True)
    sheets = {sheet.title: list(sheet.iter_rows(values_only=True)) for sheet in book}
    book.close()
    values = [sheets[cell.sheet][cell.row][cell.column] for cell in cells]
    return ["" if value is None else value for value in values]


def formula_texts(path: Path) -> list[str]:
    """Return the text of every formula in a file: cells, names, formats, validations, tables."""
    texts = []
    with zipfile.ZipFile(path) as parts:
        for name in parts.namelist():
            if name.startswith(("xl/worksheets/sheet", "xl/workbook.xml", "xl/tables/")):
                tags = "f|formula[12]?|definedName|calculatedColumnFormula|totalsRowFormula"
                found = re.findall(rf"<({tags})(?: [^>]*)?>([^<]*)<", parts.read(name).decode())
                texts += [text for _, text in found]
    return texts


def formula_count(path: Path) -> int:
    """Count the cells of a file that hold a formula."""
    with zipfile.ZipFile(path) as parts:
        sheets = [name for name in parts.namelist() if name.startswith("xl/worksheets/sheet")]
        return sum(parts.read(name).count(b"</f>") for name in sheets)


def differences(office: Office, path: Path, stored_in: Path | None = None) -> list[str]:
    """Recalculate a file from scratch, and name each formula whose stored value was another."""
    office.open(path)
    office.recalculate()
    shown = office.formulas()
    assert len(shown) == formula_count(path), "LibreOffice has other formulas than the file"
    stored = stored_values(stored_in or path, list(shown))
    return [
        f"{cell.where}: stored {value!r}, calculated {shown[cell]!r}"
        for cell, value in zip(shown, stored, strict=True)
        if not agrees(value, shown[cell])
    ]


def rewritten(path: Path, to: Path, pattern: str, replacement: str, sheet: str = "") -> Path:
    """Copy a workbook, changing the text of one sheet or of all."""
    with zipfile.ZipFile(path) as parts, zipfile.ZipFile(to, "w", zipfile.ZIP_DEFLATED) as copy:
        sheets = re.findall(r'<sheet name="([^"]*)"', parts.read("xl/workbook.xml").decode())
        number = sheets.index(sheet) + 1 if sheet else ""
        for name in parts.namelist():
            content = parts.read(name)
            if name.startswith(f"xl/worksheets/sheet{number}"):
                content = re.sub(pattern, replacement, content.decode()).encode()
            copy.writestr(name, content)
    return to


def sample_result(name: str, folder: Path) -> Path:
    """Run a sample's workbook for a few generations, with the proof after it."""
    path = folder / f"{name}-result.xlsx"
    run_file(
        SAMPLES / f"{name}.xlsx",
        Parameters(),
        Output(path),
        stop=lambda _: [Generations(500)],
        prove=lambda task, result: prove_run(task, result, path, 10.0),
    )
    return path


@pytest.fixture(scope="session")
def bracket(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Make a result of the bracket."""
    return sample_result("bracket", tmp_path_factory.mktemp("bracket"))


@pytest.mark.parametrize("name", NAMES)
def test_every_formula_of_a_sample_gives_the_engines_value(name, office, tmp_path):
    """Recalculated from scratch, a sample's result shows in every formula what the engine stored."""
    assert differences(office, sample_result(name, tmp_path)) == []


@pytest.mark.parametrize("seed", range(CASES))
def test_every_formula_of_a_random_case_gives_the_engines_value(seed, office, tmp_path):
    """So it is for any option space, chromosome and parameters."""
    path = tmp_path / "case.xlsx"
    path.write_bytes(random_case(seed).workbook())
    assert differences(office, path) == []


def test_a_goal_from_the_benchmark_may_be_any_number(office, tmp_path):
    """Held far from its centroid, 900 t have a moment above what may be typed; the cards count it."""
    case = random_case(1)
    far = case.space.part.centroid_mm + 10_000.0
    heavy = replace(case.space, part=Part(9e8, far))
    task = settle(heavy, Parameters(children=2, fos=0.1), case.task.benchmark.chromosome)
    assert task.rules.goals.base.moment > MAX_NUMBER
    path = tmp_path / "heavy.xlsx"
    path.write_bytes(replace(case, task=task).workbook())
    assert differences(office, path) == []


def traits(case: Case) -> set[str]:
    """Name what is special about a case."""
    space, rules = case.space, case.task.rules
    found = {case.places, rules.criterion.name, rules.requirements.moment_arm}
    found.add(f"{len(space.approximation_polygon_mm)} corners")
    for kind in space.kinds:
        found.add(f"Min. {kind.count_min}")
        found.add("wide" if kind.count_max > PLAN.gene_slots else "")
        found.add("two heights" if len(set(kind.footprints_mm[:, 2])) == 2 else "")
        found.add("no weight" if kind.weight_g is None else "")
        found.add("no diameter" if kind.diameter_mm is None else "")
    for chromosome in case.shown:
        grasp = evaluate(space, rules, chromosome)
        found.add("feasible" if grasp.feasible else "not feasible")
        found.add("one element" if grasp.clearance_mm is None else "")
        found.add("twins" if (grasp.clearance_mm or 1.0) < ACCURACY else "")
        found.add("tie" if tied(grasp) else "")
    return found | {f"{term} dropped" for term in rules.goals.dropped}


def tied(grasp: Grasp) -> bool:
    """Tell whether several pairs are the farthest apart."""
    plan = grasp.points_mm[:, :2]
    lengths = np.linalg.norm(plan[:, None] - plan, axis=2)[np.triu_indices(len(plan), 1)]
    return int((lengths >= grasp.longest_mm * (1 - ACCURACY)).sum()) > 1


def test_random_cases_are_of_every_sort():
    """The random cases have all that the cards must stand: see the list."""
    wanted = {*PLACES, *(criterion.name for criterion in CRITERIA), "3d", "plan"}
    wanted |= {f"{corners} corners" for corners in range(3, 13)}
    wanted |= {"Min. 0", "Min. 1", "Min. 2", "wide", "two heights", "no weight", "no diameter"}
    wanted |= {"one element", "twins", "tie", "feasible", "not feasible"}
    wanted |= {"structure dropped", "cost dropped"}
    assert wanted - set().union(*(traits(random_case(seed)) for seed in range(CASES))) == set()


def test_no_stored_value_is_needed(bracket, office, tmp_path):
    """With all stored values overwritten LibreOffice finds them again: it calculates, not copies."""
    wiped = rewritten(bracket, tmp_path / "wiped.xlsx", r"</f><v>[^<]*</v>", "</f><v>7</v>")
    assert differences(office, wiped, stored_in=bracket) == []
    assert len(differences(office, wiped)) > 4000


@pytest.mark.parametrize(
    ("cell", "wrong"),
    [
        (PLAN.card(1).at(33, 5), "4.0001"),
        (PLAN.what_if.at(*STATUS), "Meets nothing."),
        (CalcBlock(0, PLAN.gene_slots, USER).element("to polygon", 0), "0"),
        (Area(GRASP, FIRST_LOCATION_ROW, layout.GRASP_DATA_COLUMN + 4), "1.5"),
    ],
)
def test_a_wrong_stored_value_is_caught(cell, wrong, bracket, office, tmp_path):
    """Of a file that stores one value wrongly, the comparison names that cell alone."""
    pattern = rf'(<c r="{cell.local}"[^>]*><f>[^<]*</f><v>)[^<]*'
    changed = rewritten(
        bracket, tmp_path / "changed.xlsx", pattern, rf"\g<1>{wrong}", sheet=cell.sheet
    )
    assert [text.split(":")[0] for text in differences(office, changed)] == [cell.where]


# --- what a designer types ---

CUPS, MAGNETS = (2, 5, 9), (3, 60)
TYPED_GENES: dict[Place, float | str | None] = {
    PLAN.what_if.genes.cell(row, column): gene
    for row, active in enumerate((CUPS, MAGNETS))
    for column, gene in enumerate((len(active), *active))
}
"""A grasp for the What-if card."""
CORNER = Area(OPTION_SPACE, POLYGON_HEADER_ROW + 1, APPROXIMATION_COLUMN + 1)
FOOTPRINT = Area(OPTION_SPACE, FIRST_LOCATION_ROW + CUPS[0] - 1, KINDS[0].column)
EDITS: dict[str, dict[Place, float | str | None]] = {
    "genes": {},
    "goals": dict(zip(GOAL_NAMES, (55.0, 4321.0, 12.5, 777.0), strict=True)),
    "FoS goal and clearance": {"FoSGoal": 5.5, "MinClearance": 150.0},
    "forces and mass": {"SuctionForce": 24.0, "MagnetForce": 60.5, "PartMass": 20_000.0},
    "prices": {"SuctionPrice": 12.5, "MagnetPrice": 0.0},
    "centroid": {"CentroidX": 11.5, "CentroidY": -4.25, "CentroidZ": 60.0},
    "scale factor": {"ScaleFactor": 0.4},
    "density ratio": {"DensityRatio": 1.25},
    "moment arm": {"MomentArm": "plan"},
    "a sum of criteria": {"FitnessCriterion": "cost+moment"},
    "one criterion": {"FitnessCriterion": "deviation"},
    "polygon corner": {CORNER: 260.0},
    "footprint": {FOOTPRINT: -33.3},
    "user-defined grasp": {USER.cell(0, 1): 7, USER.cell(1, 0): 1, USER.cell(1, 1): 12},
}
EDITS["everything"] = {place: value for edit in EDITS.values() for place, value in edit.items()}


def card_values(task: Task, grasp: Grasp) -> dict[tuple[int, int], CellValue]:
    """Return what the engine says of a grasp, by row and column of the specification's card."""
    goals = (task.rules.requirements.fos, *task.rules.goals.base)
    values: dict[tuple[int, int], CellValue] = {
        (21, 1): grasp.force_n,
        (21, 2): grasp.terms.cost,
        (22, 1): grasp.weight_n,
        (23, 1): grasp.fos,
        (24, 4): grasp.terms.deviation,
        (24, 5): grasp.terms.structure,
        (29, 5): grasp.eccentricity_mm,
        (30, 5): grasp.terms.moment,
        (33, 5): grasp.divergence,
        STATUS: status(grasp),
        (40, 5): "-" if grasp.clearance_mm is None else grasp.clearance_mm,
        (41, 5): grasp.value,
    }
    for axis, row in enumerate((26, 27, 28)):
        values[row, 1] = float(task.space.part.centroid_mm[axis])
        values[row, 3] = float(grasp.centre_of_force_mm[axis])
        values[row, 5] = float(grasp.offset_mm[axis])
    for column, ratio in enumerate((grasp.normalised_fos, *grasp.normalised)):
        values[33, column] = "-" if ratio is None else ratio
        values[34, column] = goals[column]
    first_rows, kinds = (6, 14), task.space.kinds
    for first, kind, indices in zip(first_rows, kinds, grasp.chromosome.active, strict=True):
        for row, index in enumerate(indices, first):
            for axis, place in enumerate(kind.footprints_mm[index - 1].tolist()):
                values[row, 1 + axis] = place
                values[row, 4 + axis] = kind.force_n * place
    return values


def status(grasp: Grasp) -> str:
    """Say in words what constraints and goals a grasp meets."""
    if grasp.meets_all_goals:
        return "Meets FoS, distance and every goal."
    if grasp.feasible:
        return "Meets FoS and distance, not every goal."
    weak = [] if grasp.meets_fos else ["FoS is below its goal."]
    close = [] if grasp.is_clear else ["Two elements are closer than the minimum distance."]
    return " ".join(weak + close)


def genes_of(rows: list[list[CellValue]]) -> Chromosome:
    """Make a chromosome of the gene cells as shown."""
    return Chromosome(np.array(rows, dtype=float).astype(int))


def missed(
    shown: list[list[CellValue]], card: Card, values: dict[tuple[int, int], CellValue]
) -> list[str]:
    """Name the cells of a card that show something else; ``shown`` are all of the sheet."""
    places = {card.at(*place): wanted for place, wanted in values.items()}
    return [
        f"{cell.where}: {shown[cell.row][cell.column]!r} where the engine says {wanted!r}"
        for cell, wanted in places.items()
        if not agrees(wanted, shown[cell.row][cell.column])
    ]


def errors(rows: list[list[CellValue]]) -> list[CellValue]:
    """Return the error values among cells: ``#REF!``, ``#VALUE!``, LibreOffice's ``Err:502``."""
    return [cell for row in rows for cell in row if str(cell).startswith(("#", "Err:"))]


def task_of(path: Path) -> Task:
    """Read a saved workbook as a command does."""
    return prepare(read_book(path), Parameters())


@pytest.fixture
def opened(bracket: Path, office: Office) -> Iterator[Office]:
    """Open the bracket's result with the stored values, as a designer does; undo what is typed."""
    if office.path != bracket:
        office.open(bracket)
    yield office
    office.undo()


@pytest.mark.parametrize("edit", EDITS)
def test_cards_follow_what_is_typed(edit, opened, tmp_path):
    """After typing, every card and the user-defined block show what the engine makes of the saved file."""
    opened.enter({**TYPED_GENES, **EDITS[edit]})
    task = task_of(opened.save(tmp_path / "edited.xlsx"))
    shown = opened.read(GA_CELLS)
    for name, card in CARDS.items():
        grasp = evaluate(task.space, task.rules, genes_of(opened.read(name)))
        assert missed(shown, card, card_values(task, grasp)) == []
    user = task.benchmark
    assert user.chromosome == genes_of(opened.read("UserChromosome"))
    fitness = shown[USER.row + 3][USER.column - 1 :]
    assert all(map(agrees, (user.fos, *user.terms, user.divergence), fitness))


@pytest.mark.parametrize("place", ["PartMass", "CostGoal", PLAN.proved.genes.cell(1, 1)])
def test_no_card_calls_proved_what_was_edited_since(place, opened):
    """A typed input, goal or gene takes the word from the title, and undoing it brings it back."""
    title, before = PLAN.proved.at(0, 0), opened.value(place)
    assert opened.value(title) == "Proved optimum"
    opened.enter({place: 17.0})
    assert opened.value(title) == "Edited since the search for the optimum"
    opened.enter({place: before})
    assert opened.value(title) == "Proved optimum"


@pytest.mark.parametrize("sheet", [VALID_DESIGNS, FITNESS_TABLE, HISTORY])
@pytest.mark.parametrize("place", ["PartMass", "MomentGoal"])
def test_results_say_that_inputs_were_edited_since(place, sheet, opened):
    """A typed input or goal puts a warning into the title of the numbers that no formula gives."""
    title, before = Area(sheet, 0, 0), opened.value(place)
    called = opened.value(title)
    assert "edited" not in called
    opened.enter({place: 17.0})
    assert opened.value(title) == f"{called} (of the inputs before they were edited; run again)"
    opened.enter({place: before})
    assert opened.value(title) == called


def test_command_line_says_what_the_card_shows(opened, tmp_path):
    """``grasp_xl evaluate --json`` on the saved file and the What-if card give the same numbers."""
    opened.enter({**TYPED_GENES, **EDITS["everything"]})
    saved = opened.save(tmp_path / "edited.xlsx")
    cups, magnets = (",".join(map(str, active)) for active in (CUPS, MAGNETS))
    command = [sys.executable, "-m", "grasp_xl", "evaluate", str(saved), "--json"]
    command += ["--cups", cups, "--magnets", magnets]
    done = subprocess.run(command, check=True, capture_output=True, text=True)  # noqa: S603
    said = json.loads(done.stdout)
    places = {"fos": (23, 1), "cost": (21, 2), "moment": (30, 5), "deviation": (24, 4)}
    places |= {"structure": (24, 5), "divergence": (33, 5), "clearance": (40, 5), "value": (41, 5)}
    values = {place: said[name] for name, place in places.items()}
    assert missed(opened.read(GA_CELLS), PLAN.what_if, values) == []


def test_goals_follow_the_user_defined_grasp_until_typed_over(opened, tmp_path):
    """A goal cell shows the user-defined grasp's own value; a typed goal stays."""
    before = [opened.value(name) for name in GOAL_NAMES]
    opened.enter({USER.cell(0, 1): 7})
    user = task_of(opened.save(tmp_path / "user.xlsx")).benchmark
    assert all(map(agrees, user.terms, (opened.value(name) for name in GOAL_NAMES)))
    assert [opened.value(name) for name in GOAL_NAMES] != before
    opened.enter({"MomentGoal": 2500.0, USER.cell(0, 1): 1})
    assert opened.value("MomentGoal") == 2500.0
    opened.enter({"MomentGoal": None})
    assert agrees(opened.value(PLAN.user_term(1)), opened.value(PLAN.what_if.at(34, 2)))


WRONG = {
    "cup index": (0, 1, (0, -1, 9999, 2.5, "abc", None, "=NA()"), "Suction Index 1: type {}."),
    "magnet index": (1, 2, (0, -1, 9999, 2.5, "abc", None, "=1/0"), "Magnets Index 2: type {}."),
    "cup count": (0, 0, (0, -1, 6, 2.5, "abc", None, "=NA()"), "Suction Total #: type {}."),
    "magnet count": (1, 0, (0, -1, 6, 2.5, "abc", None, "=1/0"), "Magnets Total #: type {}."),
}
BLOCKS = {
    **{name: (card.genes, card.status) for name, card in CARDS.items()},
    "UserChromosome": (USER, PLAN.user_status),
}
"""Genes and status of every live block."""


@pytest.mark.parametrize("name", ["WhatIf", "Child2", "UserChromosome"])
@pytest.mark.parametrize("gene", WRONG)
def test_a_wrong_gene_is_named_with_what_to_type(name, gene, opened):
    """Its block says which it is and what to type, and shows no error value; other cards stay as they are."""
    row, column, values, message = WRONG[gene]
    genes, status = BLOCKS[name]
    opened.enter({genes.cell(0, 0): 2, genes.cell(1, 0): 2})
    least, most = opened.value(KINDS[row].field("Min")), opened.value(KINDS[row].field("Max"))
    total = opened.value(KINDS[row].field("Total"))
    span = f"{least:g} to {min(most, total):g}" if column == 0 else f"1 to {total:g}"
    before = opened.read(GA_CELLS)
    for value in values:
        opened.enter({genes.cell(row, column): value})
        after = opened.read(GA_CELLS)
        assert after[status.row][status.column] == message.format(f"a whole number from {span}")
        typed = after[genes.row + row][genes.column + column]
        assert errors(after) == errors([[typed]])
        if name != "UserChromosome":
            card = CARDS[name]
            assert [opened.value(card.at(33, 5)), opened.value(card.at(41, 5))] == ["-", "-"]
            assert without(card, before) == without(card, after)


def test_an_active_index_twice_is_called_that(opened):
    """Not "closer than the minimum distance": the second of them is named, on cards and on the user's block."""
    for name, (genes, status) in BLOCKS.items():
        opened.enter({genes.cell(1, 0): 3, genes.cell(1, 1): 5, genes.cell(1, 2): 7})
        opened.enter({genes.cell(1, 3): 5})
        told = "Magnets Index 3: this index a second time"
        assert str(opened.value(status)).startswith(told), name


def test_the_user_defined_block_says_what_its_grasp_meets(opened):
    """It has the card's line: FoS or distance missed, a goal missed, or all met."""
    opened.enter({"FoSGoal": 400})
    assert opened.value(PLAN.user_status) == "FoS is below its goal."
    opened.enter({"FoSGoal": 0.1, "MinClearance": 5000})
    assert opened.value(PLAN.user_status) == "Two elements are closer than the minimum distance."
    opened.enter({"MinClearance": 0.1})
    assert opened.value(PLAN.user_status) == "Meets FoS, distance and every goal."
    opened.enter({"MomentGoal": 0.001})
    assert opened.value(PLAN.user_status) == "Meets FoS and distance, not every goal."


def test_an_empty_block_says_who_fills_it(opened):
    """Emptied user-defined genes are assigned by the next run: block and cards say so, in their words."""
    opened.enter({USER.cell(row, column): None for row in range(2) for column in range(6)})
    told = "There are no genes: type a grasp, or run grasp-xl on this workbook to fill them in."
    assert opened.value(PLAN.user_status) == told
    assert opened.value(PLAN.what_if.status) == f"GA, Cost ($): {NO_BENCHMARK}"


def without(card: Card, rows: list[list[CellValue]]) -> list[list[CellValue]]:
    """Return the cells of the sheet outside a card."""
    inside = range(card.column, card.column + CARD_COLUMNS)
    return [
        [cell for column, cell in enumerate(cells) if row < card.row or column not in inside]
        for row, cells in enumerate(rows)
    ]


def test_a_wrong_gene_leaves_no_error_on_any_sheet(opened):
    """Behind the card and in the picture nothing breaks either; only missing points are #N/A."""
    opened.enter({PLAN.what_if.genes.cell(0, 1): 9999, PLAN.what_if.genes.cell(1, 0): "abc"})
    assert errors_of(opened) == {(GRASP, NOT_AVAILABLE)}


@pytest.mark.parametrize("value", [0, 9999, "abc", None])
def test_a_wrong_user_defined_gene_leaves_no_goals(value, opened):
    """Without a user-defined grasp there are no goals: each card says so, until they are typed."""
    opened.enter({USER.cell(0, 1): value})
    assert opened.value(PLAN.what_if.status) == f"GA, Cost ($): {NO_BENCHMARK}"
    for card in CARDS.values():
        assert not str(opened.value(card.at(*STATUS))).startswith("Meets")
        assert opened.value(card.at(33, 5)) == "-"
    assert errors(opened.read(GA_CELLS)) == []
    opened.enter(dict.fromkeys(GOAL_NAMES, 1000.0))
    assert str(opened.value(PLAN.what_if.status)).startswith("Meets")


NA = "=NA()"
BAD_INPUTS: dict[str, tuple[Place, tuple[float | str | None, ...], str]] = {
    "mass": (
        "PartMass",
        ("abc", None, 0, 2e9, NA),
        f"Part data, Part mass (g)|a number above 0, {UP_TO}",
    ),
    "centroid": (
        "CentroidZ",
        ("abc", None, -2e9, NA),
        f"Part data, Centroid Z (mm)|a number, {UP_TO} in size",
    ),
    "force": (
        "SuctionForce",
        ("abc", -1, NA),
        f"Suction cup data, Normal force capacity (N)|a number above 0, {UP_TO}",
    ),
    "price": (
        "MagnetPrice",
        ("abc", None, -1, NA),
        f"Magnet data, Unit price ($)|a number of 0 or more, {UP_TO}",
    ),
    "weight": (
        "MagnetWeight",
        ("abc", -1, NA),
        f"Magnet data, Weight (g)|a number of 0 or more, {UP_TO}, or nothing",
    ),
    "least count": (
        "SuctionMin",
        ("abc", 2.5, 9999, NA),
        (
            "Suction cup data, # Suction Cups (Min.)"
            "|a whole number from 0 to Max. and to the number of places"
        ),
    ),
    "count": (
        "SuctionMax",
        ("abc", 2.5, 26, NA),
        "Suction cup data, # Suction Cups (Max.)|a whole number from 0 to 25",
    ),
    "diameter": (
        "MagnetDiameter",
        ("abc", 0, NA),
        f"Option Space, Magnet diameter (mm)|a number above 0, {UP_TO}, or nothing",
    ),
    "scale": (
        "ScaleFactor",
        ("abc", 0, 1.5, NA),
        "Option Space, Scale Factor|a number above 0, at most 1",
    ),
    "place": (
        FOOTPRINT,
        ("abc", None, NA),
        "Option Space, Suction cup locations|three numbers at index 2",
    ),
    "elitism": ("Elitism", ("abc", 2, NA), "GA, Elitism|1 or 0, or nothing"),
    "generations": (
        "Generations",
        ("abc", 2.5, NA),
        "GA, Number of Generations|a whole number from 0 to 1,000,000,000, or nothing",
    ),
    "clearance": (
        "MinClearance",
        ("abc", 0, NA),
        f"GA, Minimum Gripper Element Distance (mm)|a number above 0, {UP_TO}, or nothing",
    ),
    "ratio": (
        "DensityRatio",
        ("abc", -1, NA),
        f"GA, Structure Linear Density Ratio|a number of 0 or more, {UP_TO}, or nothing",
    ),
    "FoS": ("FoSGoal", ("abc", 0, -3, NA), f"GA, FoS|a number above 0, {UP_TO}, or nothing"),
    "arm": ("MomentArm", ("abc", 3, NA), "GA, Moment Arm|3d or plan, or nothing"),
    "criterion": (
        "FitnessCriterion",
        ("abc", "cost+", "cost moment", "cost+divergence", "co+costst", 7, "cos t", NA),
        "GA, Fitness Criterion|divergence, one criterion, or some joined by +, or nothing",
    ),
    "corner": (
        CORNER,
        ("abc", None, NA),
        "The polygon|numbers, around an area, no corner twice in a row, no edge across another",
    ),
}


@pytest.mark.parametrize("wrong", BAD_INPUTS)
def test_an_input_that_cannot_be_used_is_named(wrong, opened):
    """Every card, and the user's block, names it and what to type; no card shows an error value."""
    place, values, told = BAD_INPUTS[wrong]
    label, words = told.split("|")
    message = f"{label} cannot be used: type {words}."
    for value in values:
        opened.enter({place: value})
        shown = opened.values([status for _, status in BLOCKS.values()])
        assert shown == [message] * len(BLOCKS)
        assert opened.value(PLAN.what_if.at(33, 5)) == opened.value(PLAN.what_if.at(23, 1)) == "-"
        own = errors(opened.read(place)) if value == NA else []
        assert errors(opened.read(GA_CELLS)) in ([], own)  # the cell itself shows what was typed
        if not own:
            assert {sheet for sheet, _ in errors_of(opened)} <= {GRASP}


def test_a_corner_twice_in_a_row_is_named(opened):
    """A polygon edge without length divides nothing by 0."""
    corners = opened.read("ApproximationPolygon")
    twice = dict(zip((CORNER.cell(0, axis) for axis in range(3)), corners[1], strict=True))
    opened.enter(twice)
    message = str(opened.value(PLAN.what_if.at(*STATUS)))
    assert message.startswith("The polygon cannot be used: type numbers, around an area, no corner")
    assert {sheet for sheet, _ in errors_of(opened)} <= {GRASP}


@pytest.mark.parametrize("name", GOAL_NAMES)
@pytest.mark.parametrize("value", [0, -5, 2e9, "abc", NA])
def test_a_goal_that_is_no_number_above_0_is_told(name, value, opened):
    """Every card names it and shows no divergence; what needs no goal is still there."""
    before = opened.value(PLAN.what_if.at(21, 2))
    opened.enter({name: value})
    told = f"GA, {GOAL_LABELS[name]} cannot be used: type a number above 0, {UP_TO}."
    assert opened.values([card.at(*STATUS) for card in CARDS.values()]) == [told] * len(CARDS)
    assert opened.values([card.at(33, 5) for card in CARDS.values()]) == ["-"] * len(CARDS)
    assert opened.value(PLAN.what_if.at(21, 2)) == before
    assert len(errors(opened.read(GA_CELLS))) == (value == NA)  # the goal's own cell


@pytest.mark.parametrize(
    "text",
    [
        "cost+moment",
        " Moment +  COST",
        "STRUCTURE",
        "Divergence ",
        "deviation + cost+moment",
        "cost+cost",
        None,
    ],
)
def test_a_criterion_may_be_typed_in_any_way_that_the_reader_takes(text, opened, tmp_path):
    """Order, case and spaces do not matter: the card's value is that of the saved file's engine."""
    opened.enter({"FitnessCriterion": text})
    task = task_of(opened.save(tmp_path / "criterion.xlsx"))
    grasp = evaluate(task.space, task.rules, genes_of(opened.read("WhatIf")))
    assert missed(opened.read(GA_CELLS), PLAN.what_if, card_values(task, grasp)) == []


def errors_of(office: Office) -> set[tuple[str, CellValue]]:
    """Return sheet and text of every error value of the workbook."""
    return {(cell.sheet, v) for cell, v in office.formulas().items() if errors([[v]])}


def test_a_count_beyond_the_columns_is_told(opened):
    """With a larger Max. typed, a total above the card's index columns is still refused, for that reason."""
    opened.enter({"SuctionMax": 9, PLAN.what_if.genes.cell(0, 0): 6})
    told = "Suction Total #: the card has 5 columns; for more run grasp-xl on this workbook."
    assert opened.value(PLAN.what_if.at(*STATUS)) == told


BLANKS = ("FoSGoal", "MinClearance", "DensityRatio", "MomentArm", "FitnessCriterion", *GOAL_NAMES)


@pytest.mark.parametrize("diameter", [None, 52.0])
@pytest.mark.parametrize("name", BLANKS)
def test_a_blank_parameter_counts_as_its_default(name, diameter, opened, tmp_path):
    """On cards as in commands: a cleared cell takes the default, also one that depends on other inputs."""
    odd = {"FoSGoal": 5.5, "MinClearance": 150.0, "DensityRatio": 1.0, "MomentArm": "plan"}
    odd |= {"FitnessCriterion": "cost+moment", **dict.fromkeys(GOAL_NAMES, 999.0)}
    opened.enter({**odd, "MagnetDiameter": diameter, "SuctionDiameter": diameter, name: None})
    task = task_of(opened.save(tmp_path / "blank.xlsx"))
    grasp = evaluate(task.space, task.rules, genes_of(opened.read("WhatIf")))
    assert missed(opened.read(GA_CELLS), PLAN.what_if, card_values(task, grasp)) == []


def test_a_polygon_that_crosses_itself_is_told(opened):
    """Two corners swapped make edges cross: the cards say so, as the reader does."""
    corners = opened.read("ApproximationPolygon")
    first = CORNER.cell(0, 0)
    swapped = {first.cell(0, axis): corners[1][axis] for axis in range(3)}
    swapped |= {first.cell(1, axis): corners[0][axis] for axis in range(3)}
    opened.enter(swapped)
    assert "no edge across another" in str(opened.value(PLAN.what_if.status))


def test_a_list_that_grew_asks_for_a_run(opened):
    """The cards' formulas know the places as written: with a new total they say what to do."""
    total = opened.value("SuctionTotal")
    opened.enter({"SuctionTotal": float(total) + 1})
    told = f"type {total:g}, the places that the cards know; for a longer list run grasp-xl"
    assert told in str(opened.value(PLAN.what_if.status))


def test_a_polygon_that_grew_asks_for_a_run(opened):
    """A corner in the row below the last is the reader's, and none of the cards': they say so."""
    below = CORNER.cell(len(opened.read("ApproximationPolygon")), 0)
    opened.enter({below.cell(0, axis): value for axis, value in enumerate((-200.0, 10.0, 0.0))})
    told = "type the corners that the cards know; for more run grasp-xl on this workbook."
    assert told in str(opened.value(PLAN.what_if.status))


def test_an_inactive_wrong_index_does_no_harm(opened):
    """Only active genes enter a sum: others may be anything."""
    opened.enter(TYPED_GENES)
    before = opened.value(PLAN.what_if.at(33, 5))
    opened.enter({PLAN.what_if.genes.cell(0, 5): 9999, PLAN.what_if.genes.cell(1, 4): "abc"})
    assert opened.value(PLAN.what_if.at(33, 5)) == before
    assert errors(opened.read(GA_CELLS)) == []


def test_a_picked_design_is_loaded(opened, bracket):
    """Row k of the valid designs fills the two rows to copy and the What-if card; no row, the best."""
    task = task_of(bracket)
    rows = Area(VALID_DESIGNS, PICK_ROW + 2, 1, 2, 6)
    best = opened.read("WhatIf")
    assert opened.read(rows) == best
    designs = int(opened.value("ValidDesignsFound"))
    for number in (1, designs // 2, designs):
        opened.enter({DESIGN_PICK.name: number})
        (listed,) = opened.read(Area(VALID_DESIGNS, TABLE_ROW + number, GENE_COLUMN, 1, 12))
        assert opened.read(rows) == opened.read("WhatIf") == [listed[:6], listed[6:]]
        grasp = evaluate(task.space, task.rules, genes_of(opened.read("WhatIf")))
        assert missed(opened.read(GA_CELLS), PLAN.what_if, card_values(task, grasp)) == []
    for nonsense in (0, designs + 1, "abc", None):
        opened.enter({DESIGN_PICK.name: nonsense})
        assert opened.read(rows) == opened.read("WhatIf") == best


def test_the_pick_says_where_the_card_shows_typed_genes(opened):
    """Beside each cell: as soon as a gene differs from the two rows; an error in the cell is told."""
    hint = Area(VALID_DESIGNS, PICK_ROW, 2)
    opened.enter({DESIGN_PICK.name: 1})
    assert str(opened.value(hint)).startswith("Type a No. of the list")
    opened.enter({WHAT_IF_GENES.cell(0, 1): 27})
    assert str(opened.value(hint)).startswith("The What-if card shows genes that were typed there")
    opened.undo()
    opened.enter({DESIGN_PICK.name: "=1/0"})
    assert str(opened.value(hint)).startswith("No such number: type a whole number from 1 to")


def listed_genes(office: Office, number: int) -> list[list[CellValue]]:
    """Return the two gene rows of a design, from the list."""
    (row,) = office.read(Area(VALID_DESIGNS, TABLE_ROW + number, GENE_COLUMN, 1, 12))
    return [row[:6], row[6:]]


def judged_user_grasp(path: Path) -> Chromosome:
    """Return the grasp that ``evaluate`` judges where no option names one."""
    return evaluate_grasp(path, Parameters(), (None, None))[1].chromosome


@pytest.mark.parametrize("what", ["the picked rows", "the rows below the list"])
def test_two_gene_rows_are_pasted_as_they_are(what, bracket, office, tmp_path):
    """Pasted on the user-defined rows they show the design there, and are read as that; rows from below the list stay."""
    book = Path(shutil.copy(bracket, tmp_path))
    office.open(book)
    number = int(office.value("ValidDesignsFound")) // 2
    below = TABLE_ROW + 4 + int(office.value("ValidDesignsFound")) + 2 * number - 1
    rows = {"the picked rows": (PICK_ROW + 2, 1), "the rows below the list": (below, GENE_COLUMN)}
    wanted, first = listed_genes(office, number), listed_genes(office, 1)
    assert wanted != first
    office.enter({DESIGN_PICK.name: number})
    office.paste(Area(VALID_DESIGNS, *rows[what], 2, 6), USER)
    assert office.read(USER) == wanted
    saved = office.save(tmp_path / "pasted.xlsx")
    assert judged_user_grasp(saved) == genes_of(wanted)
    office.enter({DESIGN_PICK.name: 1})
    assert office.read(USER) == (first if what == "the picked rows" else wanted)


@pytest.mark.parametrize("edit", EDITS)
def test_difference_is_0_until_something_is_typed(edit, opened):
    """Beside the engine a card shows 0; after an edit that matters to it, that it was edited."""
    shown = [card.at(*DIFFERENCE) for card in CARDS.values()]
    opened.recalculate()
    assert opened.values(shown) == [0] * len(CARDS)
    opened.enter(EDITS[edit] or TYPED_GENES)
    *children, what_if, proved = opened.values(shown)
    assert [*children, proved] == [0 if edit == "genes" else "edited"] * (PLAN.children + 1)
    assert what_if == "edited"


# --- the pictures of the grasp ---


def pictured(name: str) -> tuple[OptionSpace, Picture]:
    """Return a sample's option space, and the picture of its user-defined grasp."""
    task = task_of(SAMPLES / f"{name}.xlsx")
    return task.space, Picture("", task.benchmark, CalcBlock(0, task.space.gene_slots, USER))


@pytest.mark.parametrize("name", NAMES)
def test_a_grasp_picture_fills_every_element_to_its_true_diameter(name):
    """The lines inside an outline leave no gap, touch it all around, and stay inside its edge."""
    space, picture = pictured(name)
    frame = grasp_sheet.frame_of(space)
    point = 1 / 0.75 / frame.pixels_per_mm
    shown = 0
    for row in range(picture.block.size):
        stroke = grasp_sheet._fill(space, picture, row, frame)
        width, _ = grasp_sheet._filling(space, row // picture.block.slots, frame)
        outline = grasp_sheet._outline(space, picture, row)
        if "#N/A" in outline.points[0]:
            assert {value for at in stroke.points for value in at} == {"#N/A"}
            continue
        shown += 1
        radius = grasp_sheet._diameter_mm(space, row // picture.block.slots) / 2
        circle = Polygon(outline.points)
        centre = circle.centroid
        assert [centre.distance(Point(at)) for at in outline.points] == pytest.approx([radius] * 37)
        inked = LineString(stroke.points).buffer(width / 2 * point)
        assert centre.buffer(0.98 * (radius - point)).within(inked)
        assert inked.within(centre.buffer(1.001 * radius))
    assert shown == len(picture.grasp.points_mm)


@pytest.mark.parametrize("shape", [*NAMES, "tall", "wide", "tiny"])
def test_a_grasp_picture_is_to_scale_and_wastes_little(shape):
    """Both axes have one scale, show each element whole, and at most a tick distance beyond."""
    if shape in NAMES:
        space, _ = pictured(shape)
    else:
        size = {"tall": (90.0, 4000.0), "wide": (4000.0, 90.0), "tiny": (3.0, 2.0)}[shape]
        part = Part(1000.0, np.array([size[0] / 2, 0.0, 0.0]))
        kinds = (
            element_kind("suction", [[0, 0, 0], [size[0], 0, 0]]),
            element_kind("magnets", []),
        )
        space = OptionSpace(part, kinds, rectangle(*size), 0.65)
    frame = grasp_sheet.frame_of(space)
    low, high = np.array(frame.low_mm), np.array(frame.high_mm)
    assert frame.pixels[0] * (high - low)[1] == pytest.approx(
        frame.pixels[1] * (high - low)[0], rel=1e-12
    )
    assert max(frame.pixels[0] / 600, frame.pixels[1] / 500) == 1
    corners = [space.approximation_polygon_mm[:, :2], space.ideal_polygon_mm[:, :2]]
    for element, assumed in zip(space.kinds, layout.DEFAULT_DIAMETERS_MM, strict=True):
        radius = (element.diameter_mm or assumed) / 2
        corners += [element.footprints_mm[:, :2] + side for side in (-radius, radius)]
    first, last = np.vstack(corners).min(axis=0), np.vstack(corners).max(axis=0)
    spare = 0.02 * (last - first).max()
    assert (low <= first).all()
    assert (low >= first - frame.step_mm - spare).all()
    assert (high >= last).all()
    assert (high <= last + spare + 1 / frame.pixels_per_mm).all()
    steps = low / frame.step_mm
    assert steps == pytest.approx(np.round(steps), abs=1e-9)


def test_a_grasp_chart_has_the_scale_of_its_frame(bracket):
    """The file's plot areas are as wide to high as their axes are long, in both pictures."""
    frame = grasp_sheet.frame_of(task_of(bracket).space)
    found = 0
    with zipfile.ZipFile(bracket) as parts:
        for name in parts.namelist():
            chart = parts.read(name).decode() if name.startswith("xl/charts/chart") else ""
            if " grasp</a:t>" not in chart:
                continue
            found += 1
            inner = chart[chart.index('<c:layoutTarget val="inner"') :]
            width, height = (
                float(re.search(rf'<c:{side} val="([^"]*)"', inner)[1]) * pixels
                for side, pixels in zip("wh", frame.size, strict=True)
            )
            ends = {
                end: [float(at) for at in re.findall(rf'<c:{end} val="([^"]*)"', chart)]
                for end in ("min", "max")
            }
            x, y = np.subtract(ends["max"], ends["min"])
            assert width / height == pytest.approx(x / y, rel=1e-9)
    assert found == 2
    assert bracket.stat().st_size < 400_000


FIRST_STROKE = layout.GRASP_DATA_COLUMN + 4
STROKES = 10 + 1 + 10 + 10
"""Fillings, main truss, branches and outlines of five of each kind; then come the two centres."""
DRAWN = Area(GRASP, grasp_sheet.FIRST_POINT, FIRST_STROKE, len(grasp_sheet.OUTLINE), 2 * STROKES)
CENTRE = Area(GRASP, grasp_sheet.FIRST_POINT, FIRST_STROKE + 2 * (STROKES + 1), 1, 2)
"""Centre of force."""


def numbers_in(office: Office, *areas: Area) -> int:
    """Count the cells that a chart draws."""
    cells = [value for area in areas for row in office.read(area) for value in row]
    return sum(isinstance(value, int | float) for value in cells)


@pytest.mark.parametrize("gene", WRONG)
def test_no_grasp_is_drawn_that_does_not_exist(gene, opened):
    """Neither element nor truss nor centre of force; above the picture stands what to type."""
    row, column, values, message = WRONG[gene]
    opened.enter({WHAT_IF_GENES.cell(0, 0): 2, WHAT_IF_GENES.cell(1, 0): 2})
    said = Area(GRASP, grasp_sheet.MESSAGE_ROW, 0)
    assert numbers_in(opened, DRAWN, CENTRE) > 4 * len(grasp_sheet.OUTLINE)
    assert opened.value(said) == ""
    for value in values:
        opened.enter({WHAT_IF_GENES.cell(row, column): value})
        assert numbers_in(opened, DRAWN, CENTRE) == 0, value
        told = str(opened.value(said))
        assert told.startswith(f"The grasp is not drawn: {message.split(':')[0]}: type")


def test_no_grasp_is_drawn_with_an_index_twice(opened):
    """Two elements cannot stand at one place: neither they nor the others are drawn."""
    opened.enter({WHAT_IF_GENES.cell(1, 0): 2, WHAT_IF_GENES.cell(1, 1): 5})
    opened.enter({WHAT_IF_GENES.cell(1, 2): 5})
    assert numbers_in(opened, DRAWN, CENTRE) == 0
    told = str(opened.value(Area(GRASP, grasp_sheet.MESSAGE_ROW, 0)))
    assert told.startswith("The grasp is not drawn: Magnets Index 2: this index a second time")


def test_a_picture_says_where_something_lies_outside(opened):
    """A place, a corner or the centroid beyond the axes; within them it says nothing."""
    said = Area(GRASP, grasp_sheet.MESSAGE_ROW, 0)
    corner = Area(OPTION_SPACE, FIRST_LOCATION_ROW, KINDS[0].column)
    for place in (corner, "CentroidX", Area(OPTION_SPACE, FIRST_LOCATION_ROW, KINDS[1].column + 1)):
        assert opened.value(said) == ""
        for value in (5000.0, -5000.0):
            opened.enter({place: value})
            assert str(opened.value(said)).startswith("Places, corners or the centroid lie outside")
        opened.undo()


def test_grasp_pictures_follow_a_typed_diameter(opened):
    """The outline has the diameter as typed, and the fill stays inside it."""
    left = layout.GRASP_DATA_COLUMN + 4
    fill, outline = (
        Area(GRASP, grasp_sheet.FIRST_POINT, left + 2 * column, rows, 2)
        for column, rows in ((0, len(grasp_sheet.FILL)), (10 + 1 + 10, len(grasp_sheet.OUTLINE)))
    )
    for diameter in (46.0, 20.0, 90.0):
        opened.enter({"SuctionDiameter": diameter})
        edge = np.array(opened.read(outline), dtype=float)
        centre = edge[:-1].mean(axis=0)
        assert np.hypot(*(edge - centre).T) == pytest.approx(diameter / 2)
        rings = np.array(opened.read(fill), dtype=float)
        assert np.hypot(*(rings - centre).T).max() < diameter / 2


def test_places_that_change_places_are_an_edit(opened):
    """Two rows swapped, or x and y of one place, change no sum of coordinates: "edited" all the same."""
    first, second = opened.read("SuctionLocations")[:2]
    places = Area(OPTION_SPACE, FIRST_LOCATION_ROW, KINDS[0].column, 2, 3)
    swapped_axes = {places.cell(0, 0): first[1], places.cell(0, 1): first[0]}
    swapped_rows = {
        places.cell(row, axis): value
        for row, point in enumerate((second, first))
        for axis, value in enumerate(point)
    }
    for edit in (swapped_axes, swapped_rows):
        opened.enter(edit)
        assert opened.value(PLAN.what_if.at(*DIFFERENCE)) == "edited"
        opened.undo()
    assert opened.value(PLAN.what_if.at(*DIFFERENCE)) == 0


# --- what a printer makes of it ---

MORE_PAGES = 2 + 9 + 1
"""Of the list of 104 magnets, which takes three pages, and of the part's 466 corners: eleven."""


@pytest.mark.parametrize("paper_mm", [(297.0, 210.0), (279.4, 215.9)], ids=["A4", "Letter"])
def test_no_page_is_cut(paper_mm, bracket, office):
    """Each print area takes one page, in either paper; only two lists take more."""
    need_arial()
    office.open(bracket)
    with zipfile.ZipFile(bracket) as parts:
        book = parts.read("xl/workbook.xml").decode()
    areas = re.findall(r"_xlnm.Print_Area[^>]*>([^<]*)<", book)
    assert len(areas) == len(layout.SHEETS) + 1  # and the sheet Part
    assert office.pages(*paper_mm) == sum(area.count("!") for area in areas) + MORE_PAGES


@pytest.fixture(scope="module", params=[8, 10])
def wide_book(request, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Make a result of the bracket with a Max. above 5."""
    folder = tmp_path_factory.mktemp("wide")
    book = openpyxl.load_workbook(SAMPLES / "bracket.xlsx")
    for sheet in set(layout.SHEETS) - {OPTION_SPACE}:
        del book[sheet]
    for cell in ("B12", "B20"):
        book[OPTION_SPACE][cell] = request.param
    book.save(folder / "export.xlsx")
    path = folder / "result.xlsx"
    output = Output(path)
    run_file(folder / "export.xlsx", Parameters(), output, stop=lambda _: [Generations(300)])
    return path


@pytest.mark.parametrize("paper_mm", [(297.0, 210.0), (279.4, 215.9)], ids=["A4", "Letter"])
def test_no_wide_page_is_cut(paper_mm, wide_book, office):
    """With up to ten place genes, too, each print area takes one page, and only two lists more."""
    need_arial()
    office.open(wide_book)
    with zipfile.ZipFile(wide_book) as parts:
        book = parts.read("xl/workbook.xml").decode()
    areas = re.findall(r"_xlnm.Print_Area[^>]*>([^<]*)<", book)
    assert office.pages(*paper_mm) == sum(area.count("!") for area in areas) + MORE_PAGES


# --- formulas that every program has ---


@pytest.mark.parametrize("case", ["sample", 0, 3, 5])
def test_formulas_are_plain(case, bracket, tmp_path):
    """No formula has a function beyond the list, an array's braces, or more text than Excel takes."""
    path = bracket
    if case != "sample":
        path = tmp_path / "case.xlsx"
        path.write_bytes(random_case(case).workbook())
    for text in formula_texts(path):
        plain = re.sub(r'"[^"]*"|&quot;.*?&quot;', '""', text)
        assert set(re.findall(r"[A-Za-z_.]+[A-Za-z0-9_.]*(?=\()", plain)) <= FUNCTIONS
        assert not set("{}@#") & set(plain)
        assert len(text) <= MAX_FORMULA
