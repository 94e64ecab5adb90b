"""The command line keeps its word: options, JSON, exit codes, and never a traceback."""

from __future__ import annotations

import contextlib
import csv
import io
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path
from typing import Any

import openpyxl
import pytest
import typer
from bad_workbooks import tiny_export
from contents import contents
from editing import files

from grasp_xl import __main__, __version__
from grasp_xl.cli import options, show
from grasp_xl.cli.program import app, main
from grasp_xl.cli.terminal import Terminal
from grasp_xl.commands import sentences
from grasp_xl.commands.solve import solve_file
from grasp_xl.search import stop
from grasp_xl.search.exact import ExactSettings
from grasp_xl.task import Parameters
from grasp_xl.workbook import cells, layout, reading_ga

SAMPLES = Path(__file__).parents[1] / "workbooks"
COMMANDS = ("check", "new", "evaluate", "run", "solve", "front")
GRASP_KEYS = {
    *("suction", "magnets", "genes", "force_n", "weight_n", "fos", "cost", "moment", "deviation"),
    *("structure", "divergence", "clearance", "centre_of_force", "normalised", "feasible"),
    *("meets_all_goals", "criterion", "value"),
}
RUN_KEYS = {
    *("best", "proved", "benchmark", "goals", "seconds", "generations", "evaluations", "seed"),
    *("stop_reason", "output"),
}
SOLVE_KEYS = {
    *("status", "bound", "gap", "designs", "floors", "floors_attained", "goals", "seconds"),
    "output",
}
CHECK_KEYS = {
    *("ok", "problems", "warnings", "cups", "magnets", "search_space", "weight_n", "max_fos"),
    "floors",
}
ERROR_KEYS = {"error", "where", "hint"}
FIVE = {"fos", "cost", "moment", "deviation", "structure"}
FOREVER = "1000000000"


@pytest.fixture
def bracket(tmp_path: Path) -> Path:
    """Copy the bracket's full workbook to a folder of its own."""
    return Path(shutil.copy(SAMPLES / "bracket.xlsx", tmp_path))


@pytest.fixture
def export(tmp_path: Path) -> Path:
    """Write the tiny export: 6 cups, 6 magnets."""
    path = tmp_path / "tiny.xlsx"
    tiny_export(path)
    return path


class Told:
    """What one command printed, and its exit code."""

    def __init__(self, capsys: pytest.CaptureFixture[str], *words: object) -> None:
        capsys.readouterr()
        self.code = main([str(word) for word in words])
        self.out, self.err = capsys.readouterr()

    @property
    def json(self) -> Any:
        """The object on standard output; nothing else may be there."""
        return json.loads(self.out)


@pytest.fixture
def gx(capsys: pytest.CaptureFixture[str]) -> Any:
    """Give the command line as a function that returns what it told."""
    return lambda *words: Told(capsys, *words)


def program(*words: object, **settings: Any) -> subprocess.CompletedProcess[str]:
    """Run the program in a process of its own."""
    command = [sys.executable, "-m", "grasp_xl", *map(str, words)]
    return subprocess.run(command, text=True, check=False, capture_output=True, **settings)  # noqa: S603


def named(book: Path, *names: str) -> list[Any]:
    """Read named cells."""
    opened = openpyxl.load_workbook(book, data_only=True)
    places = [opened.defined_names[name].attr_text.split("!") for name in names]
    return [opened[sheet.strip("'")][cell].value for sheet, cell in places]


# --- help ---


def test_help_lists_every_command(gx: Any) -> None:
    told = gx("--help")
    assert told.code == 0
    assert all(f" {command} " in told.out for command in COMMANDS)


@pytest.mark.parametrize("command", COMMANDS)
def test_help_of_a_command_has_an_example(gx: Any, command: str) -> None:
    told = gx(command, "--help")
    assert told.code == 0
    assert f"Example: grasp-xl {command} " in told.out


def test_help_of_run_states_the_defaults(gx: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "200")
    told = gx("run", "--help").out
    for default in ("50000", "5", "4", "user", "3", "2.5", "divergence", "3d", "1"):
        assert f"(default {default})" in told


def test_no_command_shows_the_help_and_is_wrong_usage(gx: Any) -> None:
    told = gx()
    assert (told.code, told.err) == (2, "")
    assert "Usage: grasp-xl" in told.out


def test_the_command_line_starts_without_heavy_modules() -> None:
    """Importing it loads neither numba nor pandas nor openpyxl, nor anything else that is slow."""
    heavy = ("numba", "pandas", "openpyxl", "numpy", "xlsxwriter", "shapely", "scipy")
    code = f"import sys, grasp_xl.cli.program; print([m for m in {heavy} if m in sys.modules])"
    found = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True)  # noqa: S603
    assert found.stdout.strip() == "[]"


def test_module_and_version() -> None:
    """``python -m grasp_xl`` is the program."""
    told = program("--version")
    assert (told.returncode, told.stdout, told.stderr) == (0, f"grasp-xl {__version__}\n", "")


# --- JSON ---


def test_json_of_run_has_the_keys_of_the_specification(gx: Any, export: Path) -> None:
    told = gx("run", export, "--generations", 300, "--json")
    assert told.code == 0
    assert set(told.json) == RUN_KEYS
    for name in ("best", "benchmark"):
        assert set(told.json[name]) == GRASP_KEYS
        assert set(told.json[name]["normalised"]) == FIVE
    assert set(told.json["goals"]) == FIVE
    assert told.json["output"] == str(export.with_name("tiny-result.xlsx"))
    assert Path(told.json["output"]).is_file()
    assert (told.json["generations"], told.json["stop_reason"]) == (300, "generations")


def test_json_of_evaluate_is_a_grasp(gx: Any, bracket: Path) -> None:
    told = gx("evaluate", bracket, "--cups", "1,9,20", "--magnets", "3", "--json").json
    assert set(told) == GRASP_KEYS
    assert (told["suction"], told["magnets"]) == ([1, 9, 20], [3])
    assert told["genes"] == [[3, 1, 9, 20, 1, 1], [1, 3, 1, 1, 1, 1]]
    assert told["fos"] == pytest.approx((3 * 69 + 130) / told["weight_n"])


def test_clearance_of_one_element_is_null(gx: Any, tmp_path: Path) -> None:
    export = tmp_path / "few.xlsx"
    tiny_export(export, {"B11": 0})
    told = gx("evaluate", export, "--cups", "", "--magnets", "1", "--fos", "1", "--json").json
    assert told["clearance"] is None
    assert told["structure"] == 0


def test_json_of_check_has_the_keys_of_the_specification(gx: Any, export: Path) -> None:
    told = gx("check", export, "--json")
    assert told.code == 0
    assert set(told.json) == CHECK_KEYS
    assert set(told.json["floors"]) == FIVE - {"fos"}
    assert (told.json["ok"], told.json["problems"]) == (True, [])
    assert (told.json["cups"], told.json["magnets"]) == (6, 6)


def test_json_of_solve_has_the_keys_of_the_specification(gx: Any, bracket: Path) -> None:
    told = gx("solve", bracket, "--top", 3, "--json")
    assert told.code == 0
    assert set(told.json) == SOLVE_KEYS
    assert (told.json["status"], told.json["gap"], told.json["output"]) == ("optimal", 0, None)
    values = [design["value"] for design in told.json["designs"]]
    assert len(values) == 3
    assert values == sorted(values)
    assert told.json["bound"] == values[0]
    assert all(set(design) == GRASP_KEYS for design in told.json["designs"])
    assert set(told.json["goals"]) == FIVE
    for term, floor in told.json["floors"].items():
        assert floor <= told.json["designs"][0][term] * (1 + 1e-9)
    assert files(bracket.parent) == [bracket.name]


@pytest.mark.parametrize(
    ("change", "floors"), [({"B5": 200_000}, False), ({}, True)], ids=["heavy", "close"]
)
def test_check_shows_what_is_known_of_a_space_without_a_grasp(
    gx: Any,
    tmp_path: Path,
    change: dict[str, Any],
    floors: bool,  # noqa: FBT001
) -> None:
    """Counts, weight and the reachable FoS stand beside the error, which keeps its exit code."""
    export = tmp_path / "none.xlsx"
    tiny_export(export, change)
    options = () if "B5" in change else ("--clearance", "500")
    told = gx("check", export, "--json", *options)
    assert told.code == 4
    assert set(told.json) == CHECK_KEYS | ERROR_KEYS
    assert not told.json["ok"]
    assert told.json["problems"][0]["found"] == told.json["error"]
    known = {"cups": 6, "magnets": 6, "search_space": 62 * 62}
    assert {key: told.json[key] for key in known} == known
    assert told.json["max_fos"] * told.json["weight_n"] == pytest.approx(5 * (69 + 130))
    assert bool(told.json["floors"]) == floors
    plain = gx("check", export, *options)
    assert plain.code == 4
    assert "suction: 6 places" in plain.out
    assert "No problem" not in plain.out
    assert plain.err.startswith("No grasp")


@pytest.mark.parametrize("command", ["check", "evaluate", "run", "solve", "front", "new"])
def test_no_element_at_all_is_told(gx: Any, tmp_path: Path, command: str) -> None:
    """Max. 0 of both kinds: one sentence, what would lift three times 86.9 N, exit code 4."""
    tiny_export(tmp_path / "none.xlsx", {"B11": 0, "B12": 0, "B19": 0, "B20": 0})
    told = gx(command, tmp_path / "none.xlsx", *(("-o", tmp_path / "b.xlsx") * (command == "new")))
    assert told.code == 4
    assert told.err.startswith("No grasp can have an element: # Max. or the places of each kind")
    assert "Raise # Max. of suction to 4 or raise # Max. of magnets to 3." in told.err


def test_problems_of_both_sheets_are_named_at_once(gx: Any, bracket: Path) -> None:
    """Parameters are judged also where the option space cannot be used."""
    opened = openpyxl.load_workbook(bracket)
    opened[layout.GA]["B7"] = "x"
    opened[layout.GA]["B12"] = 0
    opened[layout.OPTION_SPACE]["B5"] = -1
    opened.save(bracket)
    told = gx("check", bracket)
    assert told.code == 3
    assert [line.split(":")[0] for line in told.err.splitlines()] == [
        *("GA!B7", "GA!B12", "Option Space!B5")
    ]


def test_a_workbook_can_be_made_of_a_space_without_a_grasp(gx: Any, tmp_path: Path) -> None:
    """With a grasp of the designer's there is a benchmark, so that a Max. can be raised in it."""
    export = tmp_path / "heavy.xlsx"
    tiny_export(export, {"B5": 200_000})
    book = tmp_path / "book.xlsx"
    assert gx("new", export, "-o", book).code == 4
    assert gx("new", export, "-o", book, "--cups", "1,4", "--magnets", "3").code == 0
    assert gx("evaluate", book).code == 0


def test_check_lists_every_problem(gx: Any, tmp_path: Path) -> None:
    export = tmp_path / "wrong.xlsx"
    tiny_export(export, {"B5": -1, "D6": "here", "L1": 2})
    told = gx("check", export, "--json")
    assert told.code == 3
    assert set(told.json) == CHECK_KEYS | ERROR_KEYS
    problems = told.json["problems"]
    assert {p["where"] for p in problems} == {f"Option Space!{c}" for c in ("B5", "D6", "L1")}
    assert all(set(p) == {"where", "found", "expected", "hint"} for p in problems)
    plain = gx("check", export)
    assert (plain.code, plain.out) == (3, "")
    assert len(plain.err.splitlines()) == 3


def test_warnings_go_to_standard_error_and_leave_the_json_alone(gx: Any, tmp_path: Path) -> None:
    export = tmp_path / "free.xlsx"
    tiny_export(export, {"B14": 0, "B22": 0})  # free of charge: no cost to divide by
    told = gx("run", export, "--generations", 5, "--json")
    assert told.json["goals"]["cost"] is None
    assert "cost is left out" in told.err


# --- errors ---

WRONG = [
    "--nonsense",
    "frobnicate",
    "run",
    "run FILE --gnerations 5",
    "run FILE --generations",
    *(f"run FILE --generations {word}" for word in ("abc", "1.5", "-1", "nan", "1e10")),
    *(f"run FILE --seed {word}" for word in ("-1", "9007199254740993")),
    *(f"run FILE --children {word}" for word in ("1", "51")),
    *(f"run FILE --stall {word}" for word in ("0", "inf")),
    *(f"run FILE {option} nan" for option in ("--one-in", "--target", "--time-limit")),
    *(f"run FILE {option} inf" for option in ("--one-in", "--target", "--time-limit")),
    "run FILE --one-in 0.5",
    "run FILE --time-limit -1",
    "run FILE --start here",
    "run FILE --in-place -o OTHER",
    "run FILE -o FILE",
    "new FILE -o FILE",
    "new FILE",
    *(f"check FILE --fos {word}" for word in ("0", "-1", "nan", "inf", "1e308", "three")),
    *(f"check FILE --clearance {word}" for word in ("0", "nan", "1e308")),
    *(f"check FILE --density-ratio {word}" for word in ("-1", "inf", "1e308")),
    *(f"check FILE --criterion {word}" for word in ("beauty", "cost+")),
    "check FILE --moment-arm 4d",
    *(f"evaluate FILE --goals {word}" for word in ("1,2,3", "1,2,3,4,5", "0,1,1,1", "1,nan,1,1")),
    *(f"evaluate FILE --goals {word}" for word in ("1e-308,1,1,1", "1e308,1,1,1", "1,,1,1")),
    *(f"evaluate FILE --magnets 1 --cups {word}" for word in ("0", "7", "-1", "1,1", "1,2,")),
    *(f"evaluate FILE --magnets 1 --cups {word}" for word in ("a", "1.5", "1,2,3,4,5,6", "9" * 30)),
    "evaluate FILE --cups 1",
    *(f"solve FILE --top {word}" for word in ("0", "1001", "1.5")),
    *(f"solve FILE --gap {word}" for word in ("-1", "nan", "inf")),
    *(f"solve FILE --min-elements {word}" for word in ("0", "two")),
    "solve FILE --time-limit -1",
    "solve FILE -o FILE",
    "solve FILE -o other.ods",
    *(f"run FILE --prove-limit {word}" for word in ("-1", "nan", "soon")),
]


@pytest.mark.parametrize("words", WRONG)
def test_wrong_usage_is_one_sentence_and_exit_code_2(gx: Any, export: Path, words: str) -> None:
    names = {"FILE": str(export), "OTHER": str(export.with_name("other.xlsx"))}
    arguments = [names.get(word, word) for word in words.split()]
    before = export.read_bytes()
    told = gx(arguments[0], "--json", *arguments[1:])
    assert told.code == 2
    assert set(told.json) == ERROR_KEYS
    assert told.json["error"]
    assert told.json["hint"]
    plain = gx(*arguments)
    assert (plain.code, plain.out) == (2, "")
    assert told.json["error"] in plain.err
    assert files(export.parent) == [export.name]
    assert export.read_bytes() == before


@pytest.mark.parametrize("command", [("evaluate",), ("run",), ("new", "-o", "new.xlsx")])
def test_bad_input_is_exit_code_3_and_writes_nothing(
    gx: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, command: tuple[str, ...]
) -> None:
    monkeypatch.chdir(tmp_path)
    for content in (None, b"", b"no workbook"):
        file = tmp_path / "wrong.xlsx"
        if content is not None:
            file.write_bytes(content)
        told = gx(command[0], file, *command[1:], "--json")
        assert told.code == 3
        assert set(told.json) == ERROR_KEYS
        assert told.json["where"] == str(file)
        assert not (set(files(tmp_path)) - {"wrong.xlsx"})


def test_what_no_grasp_can_meet_is_exit_code_4_at_once(gx: Any, bracket: Path) -> None:
    """Also where a user-defined grasp is there to start from."""
    for command in ("check", "run", "solve"):
        for option, value in (("--fos", "8"), ("--clearance", "500")):
            told = gx(command, bracket, option, value, "--json")
            assert told.code == 4
            assert set(told.json) >= ERROR_KEYS
            assert "ower the" in told.json["hint"]
    assert files(bracket.parent) == [bracket.name]


def test_a_grasp_below_the_constraints_is_shown_nevertheless(gx: Any, bracket: Path) -> None:
    told = gx("evaluate", bracket, "--fos", "8", "--json")
    assert told.code == 0
    assert told.json["feasible"] is False


@pytest.mark.parametrize(
    ("words", "hint"),
    [
        (("-o", "folder.xlsx"), "Name another file with -o."),
        (("--history", "folder.csv"), "Name another file with --history."),
    ],
)
def test_a_folder_is_refused_with_the_option_that_names_it(
    gx: Any, bracket: Path, words: tuple[str, str], hint: str
) -> None:
    option, name = words
    folder = bracket.with_name(name)
    folder.mkdir()
    told = gx("run", bracket, option, folder)
    assert (told.code, told.err.splitlines()[1]) == (3, hint)


@pytest.mark.parametrize("option", ["-o", "--history"])
def test_an_empty_file_name_is_wrong_usage(gx: Any, bracket: Path, option: str) -> None:
    told = gx("run", bracket, option, "")
    assert (told.code, told.err.splitlines()[0]) == (
        2,
        f"{option}: found '', expected the name of a file.",
    )


def test_ctrl_c_while_the_program_loads_is_exit_code_130(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """The first moments are imports, which nobody wants to see."""

    class Loading:
        def __getattr__(self, name: str) -> None:
            raise KeyboardInterrupt

    monkeypatch.setitem(sys.modules, "grasp_xl.cli.program", Loading())
    with pytest.raises(SystemExit) as end:
        __main__.entry()
    assert end.value.code == 130
    assert capsys.readouterr().err == "Interrupted; nothing was written.\n"


def test_ctrl_c_before_a_search_is_exit_code_130(
    gx: Any, bracket: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def interrupted(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("grasp_xl.commands.check.check_file", interrupted)
    told = gx("check", bracket, "--json")
    assert told.code == 130
    assert told.json["error"] == "Interrupted; nothing was written."


def test_debug_shows_what_was_raised(gx: Any, tmp_path: Path) -> None:
    with pytest.raises(Exception, match="no such file"):
        gx("check", tmp_path / "none.xlsx", "--debug")


@pytest.mark.skipif(os.name == "nt", reason="Windows has no /dev/full")
def test_output_that_nobody_can_take_is_no_traceback(bracket: Path) -> None:
    """Neither a full disk behind standard output, nor a closed pipe, nor an alphabet too small."""
    with Path("/dev/full").open("w") as full:
        command = [sys.executable, "-m", "grasp_xl", "check", str(bracket)]
        told = subprocess.run(command, stdout=full, stderr=subprocess.PIPE, text=True, check=False)  # noqa: S603
        assert (told.returncode, "Traceback" in told.stderr) == (3, False)
        assert "No space left" in told.stderr
    reader, writer = os.pipe()
    os.close(reader)
    told = subprocess.run(command, stdout=writer, stderr=subprocess.PIPE, text=True, check=False)  # noqa: S603
    os.close(writer)
    assert (told.returncode, told.stderr) == (0, "")
    for failing, code in ((["run", str(bracket), "--fos", "99", "--json"], 4), (["no"], 2)):
        with Path("/dev/full").open("w") as full:
            command = [sys.executable, "-m", "grasp_xl", *failing]
            told = subprocess.run(command, stdout=full, stderr=full, check=False)  # noqa: S603
            assert told.returncode == code
        reader, writer = os.pipe()
        os.close(reader)
        told = subprocess.run(  # noqa: S603
            command, stdout=writer, stderr=subprocess.PIPE, text=True, check=False
        )
        os.close(writer)
        assert (told.returncode, "Traceback" in told.stderr) == (code, False)
    greek = bracket.rename(bracket.with_name("λαβή.xlsx"))
    told = program("check", greek, env={**os.environ, "PYTHONIOENCODING": "ascii"})
    assert (told.returncode, told.stderr) == (0, "")


# --- options ---


def test_options_beat_the_workbook_which_beats_the_defaults(
    gx: Any, export: Path, tmp_path: Path
) -> None:
    said = {"--fos": "2", "--seed": "5", "--criterion": "cost", "--goals": "90,8000,70,500"}
    words = [word for pair in said.items() for word in pair]
    full = tmp_path / "full.xlsx"
    assert gx("new", export, "-o", full, *words).code == 0

    def settled(file: Path, *options: str) -> tuple[object, ...]:
        told = gx("run", file, "--generations", "3", "--json", "--force", *options).json
        return (
            *(told["goals"]["fos"], told["seed"], told["benchmark"]["criterion"]),
            told["goals"]["deviation"],
        )

    default = settled(export)
    assert default[:3] == (3, 1, "divergence")
    assert settled(full) == (2, 5, "cost", 70)
    assert settled(full, "--fos", "2.5", "--seed", "6") == (2.5, 6, "cost", 70)
    assert settled(full, "--criterion", "moment", "--goals", "1,1,1,1") == (2, 5, "moment", 1)
    assert settled(export, *words) == (2, 5, "cost", 70)


def test_every_option_of_run_reaches_the_workbook(gx: Any, bracket: Path) -> None:
    words = "--generations 12 --children 3 --one-in 2.5 --no-elitism --start random --fos 2.5"
    words += " --clearance 50 --density-ratio 2 --criterion cost+moment --moment-arm plan --seed 9"
    result = bracket.with_name("result.xlsx")
    assert gx("run", bracket, "-o", result, *words.split(), "--goals", "1,2,3,4").code == 0
    expected = {"Generations": 12, "Children": 3, "MutationOneIn": 2.5, "Elitism": 0}
    expected |= {"UserStart": 0, "FoSGoal": 2.5, "MinClearance": 50, "DensityRatio": 2}
    expected |= {"FitnessCriterion": "cost+moment", "MomentArm": "plan", "Seed": 9}
    expected |= {"CostGoal": 1, "MomentGoal": 2, "DeviationGoal": 3, "StructureGoal": 4}
    assert named(result, *expected) == list(expected.values())


def test_the_grasp_of_the_options_is_the_user_defined_one(gx: Any, bracket: Path) -> None:
    words = ("--cups", "1,9,20", "--magnets", "3,80", "--generations", "2", "--json")
    benchmark = gx("run", bracket, *words).json["benchmark"]
    assert (benchmark["suction"], benchmark["magnets"]) == ([1, 9, 20], [3, 80])
    assert gx("evaluate", bracket.with_name("bracket-result.xlsx"), "--json").json == benchmark


def test_bounds_of_options_are_those_of_the_workbook() -> None:
    assert cells.MAX_NUMBER == reading_ga.MAX_GENERATIONS == options.MOST
    assert cells.MIN_DISTANCE == options.LEAST_ABOVE_0
    assert (reading_ga.MAX_CHILDREN, reading_ga.MAX_SEED) == (
        options.MOST_CHILDREN,
        options.MOST_SEED,
    )


def test_common_options_are_known_to_every_command() -> None:
    common = {"--goals", "--fos", "--clearance", "--density-ratio", "--criterion", "--moment-arm"}
    common |= {"--seed", "--json", "--quiet"}
    parsers: Any = typer.main.get_command(app)
    for name in COMMANDS:
        assert common <= {word for option in parsers.commands[name].params for word in option.opts}


@pytest.mark.parametrize("command", COMMANDS)
def test_quiet_prints_nothing(gx: Any, export: Path, command: str) -> None:
    output = ("-o", export.with_name("quiet.xlsx")) if command in ("new", "run") else ()
    told = gx(command, export, *output, "--quiet")
    assert (told.code, told.out, told.err) == (0, "", "")


# --- when a run stops ---


def history(gx: Any, book: Path, *words: object) -> list[dict[str, str]]:
    """Run and read every change of the fittest."""
    file = book.with_suffix(".csv")
    told = gx("run", book, "--force", "--history", file, "--json", *words)
    assert told.code == 0
    return list(csv.DictReader(file.read_text(encoding="utf-8").splitlines()))


def test_history_file_has_all_changes(gx: Any, bracket: Path) -> None:
    """One row a change and the last generation; nothing changes between; values are exact."""
    rows = history(gx, bracket, "--generations", 2000)
    generations = [int(row["generation"]) for row in rows]
    assert (generations[0], generations[-1]) == (1, 2000)
    assert generations == sorted(set(generations))
    book = openpyxl.load_workbook(bracket.with_name("bracket-result.xlsx"), data_only=True)
    table = [row[0] for row in book["History"].iter_rows(min_row=4, max_col=1, values_only=True)]
    assert [value for value in table if value is not None] == generations
    last = gx("evaluate", bracket, *_grasp(rows[-1]), "--json").json
    assert float(rows[-1]["divergence"]) == pytest.approx(last["divergence"], rel=1e-12)


def _grasp(row: dict[str, str]) -> list[str]:
    genes = {"--cups": ("suction", "S"), "--magnets": ("magnets", "M")}
    words = []
    for option, (count, slot) in genes.items():
        indices = [row[f"{slot}{number}"] for number in range(1, 1 + int(row[count]))]
        words += [option, ",".join(indices)]
    return words


@pytest.mark.parametrize("chunk", [stop.CHUNK, 7])
def test_target_stops_at_the_very_generation(
    gx: Any, bracket: Path, monkeypatch: pytest.MonkeyPatch, chunk: int
) -> None:
    """However many generations run between two looks at the rules."""
    rows = history(gx, bracket, "--generations", 1000)
    reached = rows[len(rows) // 2]
    monkeypatch.setattr(stop, "CHUNK", chunk)
    told = gx("run", bracket, "--target", reached["divergence"], "--json").json
    assert (told["stop_reason"], told["generations"]) == ("target", int(reached["generation"]))
    assert told["best"]["value"] <= float(reached["divergence"])


@pytest.mark.parametrize("chunk", [stop.CHUNK, 7])
def test_stall_stops_at_the_very_generation(
    gx: Any, bracket: Path, monkeypatch: pytest.MonkeyPatch, chunk: int
) -> None:
    monkeypatch.setattr(stop, "CHUNK", chunk)
    told = gx("run", bracket, "--stall", 120, "--json").json
    assert told["stop_reason"] == "stall"
    (found_at,) = named(Path(told["output"]), "BestFoundAt")
    assert told["generations"] == found_at + 120
    longer = [int(row["generation"]) for row in history(gx, bracket, "--generations", 1000)]
    gaps = zip([0, *longer], longer, strict=False)
    assert found_at == next(before for before, after in gaps if after - before > 120)


@pytest.mark.parametrize(
    ("limits", "reason"),
    [
        ("--stall 50 --target 1.1 --time-limit 60 --generations 40", "generations"),
        ("--stall 50 --target 1.1 --time-limit 60 --generations 90000", "stall"),
        ("--stall 90000 --target 3.9 --time-limit 60 --generations 90000", "target"),
        ("--stall 90000 --target 1.1 --time-limit 0 --generations 90000", "time"),
    ],
)
def test_of_several_rules_the_first_one_stops(
    gx: Any, bracket: Path, limits: str, reason: str
) -> None:
    assert gx("run", bracket, *limits.split(), "--json").json["stop_reason"] == reason


def test_a_time_limit_is_kept(gx: Any, bracket: Path) -> None:
    began = time.perf_counter()
    told = gx("run", bracket, "--generations", FOREVER, "--time-limit", "0.3", "--json").json
    assert told["stop_reason"] == "time"
    assert told["generations"] > 0
    assert time.perf_counter() - began < 10


@pytest.mark.skipif(os.name == "nt", reason="Windows has no terminals of this kind")
def test_ctrl_c_writes_the_best_so_far(bracket: Path) -> None:
    """SIGINT in mid-run: the workbook is written, marked, and the exit code is 130.

    A terminal shows generation, best value, rate and time left meanwhile.
    """
    import pty  # not on Windows

    terminal, screen = pty.openpty()
    command = [sys.executable, "-m", "grasp_xl", "run", str(bracket)]
    command += ["--generations", FOREVER, "--json"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=screen, text=True) as running:  # noqa: S603
        shown = ""
        while not ("s left" in shown and "best 3." in shown):
            shown += os.read(terminal, 4096).decode(errors="replace")
        running.send_signal(signal.SIGINT)
        out, _ = running.communicate(timeout=60)
    os.close(screen)
    os.close(terminal)
    for word in ("Generation", "best 3.", "/s", "s left"):
        assert word in shown
    told = json.loads(out)
    assert running.returncode == 130
    assert told["stop_reason"] == "interrupted"
    assert told["best"]["divergence"] < 4
    assert "interrupted" in named(Path(told["output"]), "StopReason")[0].lower()
    assert files(bracket.parent) == ["bracket-result.xlsx", "bracket.xlsx"]


def test_pressing_ctrl_c_twice_in_a_hurry_loses_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    """Only one that comes two seconds later acts as usual."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell may have it ignored
    try:
        with stop.stop_on_ctrl_c() as rule:
            for _ in range(2):
                signal.raise_signal(signal.SIGINT)
            assert rule.asked
            now = time.monotonic()
            monkeypatch.setattr(time, "monotonic", lambda: now + stop.SAME_PRESS_S)
            with pytest.raises(KeyboardInterrupt):
                signal.raise_signal(signal.SIGINT)
    finally:
        signal.signal(signal.SIGINT, before)


# --- solve ---


def test_solve_shows_designs_goals_floors_and_what_is_proved(gx: Any, bracket: Path) -> None:
    told = gx("solve", bracket, "--top", 2)
    assert told.code == 0
    first = [line.split()[:1] for line in told.out.splitlines()]
    assert [word for word in (["1"], ["2"], ["goal"], ["floor"]) if word in first] == [
        *(["1"], ["2"], ["goal"], ["floor"])
    ]
    assert "Proved: these are the 2 best grasps, and no grasp has a divergence below" in told.out


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        ("--criterion cost", "no grasp has a cost below 90 $"),
        ("--min-elements 5", "no grasp of 5 or more elements has a divergence below"),
        (
            "--min-elements 3 --goals 200,9000,90,2000 --meet-goals",
            "3 or more elements that meets all",
        ),
        ("--goals 200,9000,90,2000 --meet-goals", "no grasp that meets all goals has a divergence"),
        ("--time-limit 0", "stopped at the time limit"),
        ("--gap 100", "stopped at the gap asked for"),
    ],
)
def test_solve_says_in_a_sentence_what_is_proved(
    gx: Any, bracket: Path, words: str, sentence: str
) -> None:
    told = gx("solve", bracket, *words.split())
    assert told.code == 0
    assert sentence in told.out


def test_floors_that_are_bounds_only_are_marked(gx: Any, bracket: Path) -> None:
    """With all its time solve proves the four; without any they are shown as bounds."""
    told = gx("solve", bracket)
    (floors,) = [line for line in told.out.splitlines() if line.strip().startswith("floor")]
    assert ">=" not in floors
    assert all(gx("solve", bracket, "--json").json["floors_attained"].values())
    told = gx("solve", bracket, "--time-limit", 0)
    (floors,) = [line for line in told.out.splitlines() if line.strip().startswith("floor")]
    assert floors.count(">=") == 4
    told = gx("solve", bracket, "--time-limit", 0, "--json").json
    assert not any(told["floors_attained"].values())


def test_the_best_of_several_is_proved_before_the_others(bracket: Path) -> None:
    """Where the order of the others is open when time is up, the first is still said to be it."""
    solved = solve_file(bracket, Parameters(), ExactSettings(top=2))
    stopped = replace(solved, proof=replace(solved.proof, status="feasible"))
    told = sentences.proof(stopped)
    assert re.match(r"Proved: no grasp has a divergence below [\d.]+, so the first is the", told)
    assert stopped.shown.title == "Proved optimum"


def test_solve_never_finds_worse_than_run(gx: Any, export: Path) -> None:
    best = gx("run", export, "--generations", 3000, "--json").json["best"]["value"]
    told = gx("solve", export, "--json").json
    assert told["status"] == "optimal"
    assert told["designs"][0]["value"] <= best * (1 + 1e-9)


def test_solve_knows_what_goals_no_grasp_meets(gx: Any, bracket: Path) -> None:
    """It names the goal below its floor; raised as the hint says, there is a grasp."""
    told = gx("solve", bracket, "--goals", "110,5000,30,1000", "--meet-goals", "--json")
    assert told.code == 4
    assert told.json["status"] == "infeasible"
    assert "the moment goal of 5,000 N-mm is below its floor of 5,127.58 N-mm" in told.json["error"]
    assert "moment goal: found 5,000 N-mm" in told.err
    raised = told.json["hint"].split()[5].replace(",", "")
    told = gx("solve", bracket, "--goals", f"110,{raised},30,1000", "--meet-goals", "--json")
    assert (told.code, told.json["status"]) == (0, "optimal")
    assert told.json["designs"][0]["meets_all_goals"]


@pytest.mark.parametrize("command", ["check", "solve", "run"])
def test_a_goal_below_its_floor_is_named(gx: Any, bracket: Path, command: str) -> None:
    """With the plan arm the same goal is none too low."""
    words = (command, bracket, "--goals", "100,5000,30,1000", "--json")
    words += ("--generations", "5") if command == "run" else ()
    assert "have a moment below 5,127.58 N-mm with the 3d arm; raise the goal" in gx(*words).err
    assert "moment goal" not in gx(*words, "--moment-arm", "plan").err


def test_ctrl_c_leaves_a_true_bound(
    gx: Any, bracket: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Interrupted as soon as it begins, solve still shows the benchmark and a bound below all."""
    best = gx("solve", bracket, "--json").json["bound"]

    @contextlib.contextmanager
    def interrupted() -> Any:
        yield stop.Interrupt(asked=True)

    monkeypatch.setattr(stop, "stop_on_ctrl_c", interrupted)
    told = gx("solve", bracket, "--json")
    assert told.code == 130
    assert told.json["status"] == "feasible"
    assert told.json["bound"] <= best <= told.json["designs"][0]["value"]
    assert "interrupted" in gx("solve", bracket).out


def test_a_terminal_shows_how_far_the_proof_is(
    gx: Any, bracket: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    screen = io.StringIO()
    monkeypatch.setattr(show, "ERR", Terminal(file=screen, force_terminal=True))
    monkeypatch.setattr(show, "REFRESH_SECONDS", 0.0)
    assert gx("solve", bracket).code == 0
    for word in ("none below", "best", "gap", " s"):
        assert word in screen.getvalue()


# --- the same again ---


@pytest.mark.parametrize("options", [(), ("--no-elitism", "--start", "random")])
def test_same_seed_gives_the_same_workbook_bit_for_bit(
    gx: Any, export: Path, options: tuple[str, ...]
) -> None:
    """All cell values are equal, times aside; with another seed they are not."""
    books = [export.with_name(f"{name}.xlsx") for name in ("one", "two", "other")]
    for book, seed in zip(books, (7, 7, 8), strict=True):
        told = gx("run", export, "-o", book, "--seed", seed, "--generations", 200, *options)
        assert told.code == 0
    assert contents(books[0]) == contents(books[1])
    states = [named(book, "RandomState") for book in books]
    assert states[0] == states[1] != states[2]
