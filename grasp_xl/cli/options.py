"""What an option may be: its words, its bounds and its help, once for all commands."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, TypeVar

import typer

from grasp_xl.errors import UsageError
from grasp_xl.fitment.catalogue import DIAMETER_TOLERANCE_MM, Diameters
from grasp_xl.fitment.element import Kind
from grasp_xl.rules import TERMS, Criterion, MomentArm
from grasp_xl.rules import moment_arm as parse_arm

if TYPE_CHECKING:
    from grasp_xl.task import Parameters

T = TypeVar("T")

LEAST_ABOVE_0 = 1e-9
MOST = 1e9
MOST_CHILDREN = 50
MOST_SEED = 2**53
"""The bounds of the workbook's cells; a test holds them equal."""

MOST_GRID = 20
"""Most divisions of the weights of ``front``: 1,771 sums."""

MOST_DESIGNS = 1000
"""Most designs that ``solve`` lists."""

KIND_WORDS: dict[str, Kind] = {"cup": "suction", "magnet": "magnets"}
"""What ``--kind`` may say."""

STARTS = ("user", "random")


def refused(option: str, found: str, expected: str, hint: str = "") -> UsageError:
    """Make the error for a value that an option does not take."""
    message = f"{option}: found {found!r}, expected {expected}."
    return UsageError(message, where=option, hint=hint or f"Without {option} the default holds")


def a_number(
    option: str, expected: str, *, least: float = -MOST, most: float = MOST
) -> Callable[[str], float]:
    """Make a parser of numbers within bounds."""

    def parse(text: str) -> float:
        number = math.nan
        with suppress(ValueError):
            number = float(text)
        if least <= number <= most:
            return number
        raise refused(option, text, expected)

    return parse


def a_whole_number(option: str, least: int, most: int = int(MOST)) -> Callable[[str], int]:
    """Make a parser of whole numbers within bounds; ``5e4`` is one, too."""
    expected = f"a whole number from {least} to {most:,}"

    def parse(text: str) -> int:
        number: float = math.nan
        for read in (float, int):  # int() keeps all digits
            with suppress(ValueError):
                number = read(text)
        if least <= number <= most and number == int(number):
            return int(number)
        raise refused(option, text, expected)

    return parse


def _indices(option: str) -> Callable[[str], tuple[int, ...]]:
    """Make a parser of indices; an empty text names none."""

    def parse(text: str) -> tuple[int, ...]:
        try:
            return tuple(int(word) for word in text.split(",")) if text.strip() else ()
        except ValueError:
            hint = f"For example {option} 87,64,140"
            raise refused(option, text, "whole numbers separated by commas", hint) from None

    return parse


def _goals(text: str) -> tuple[float, ...]:
    expected = "four numbers above 0 separated by commas"
    goal = a_number("--goals", expected, least=LEAST_ABOVE_0)
    words = text.split(",")
    if len(words) != len(TERMS):
        hint = f"Give {', '.join(TERMS)}, for example --goals 105,7933,24.5,1130"
        raise refused("--goals", text, expected, hint)
    return tuple(goal(word) for word in words)


def _word(option: str, parse: Callable[[str], T]) -> Callable[[str], T]:
    """Name the option where a word is refused."""

    def parse_word(text: str) -> T:
        try:
            return parse(text)
        except UsageError as error:
            raise UsageError(f"{option}: {error.message}", where=option, hint=error.hint) from None

    return parse_word


def _kind(text: str) -> Kind:
    if text in KIND_WORDS:
        return KIND_WORDS[text]
    raise refused("--kind", text, " or ".join(KIND_WORDS), "Without --kind both are listed")


def _diameters(text: str) -> Diameters:
    """Read a diameter, or the least and the most one joined by a hyphen."""
    expected, hint = "a diameter in mm, or two as 30-50", "For example --diameter 46"
    ends = [math.nan]
    with suppress(ValueError):
        ends = [float(end) for end in text.split("-")]
    if not all(LEAST_ABOVE_0 <= end <= MOST for end in ends):
        raise refused("--diameter", text, expected, hint)
    if len(ends) > 2 or ends != sorted(ends):
        raise refused("--diameter", text, expected, "Give the smaller one first")
    if len(ends) == 2:
        return Diameters(*ends)
    return Diameters(ends[0] - DIAMETER_TOLERANCE_MM, ends[0] + DIAMETER_TOLERANCE_MM)


def a_start(text: str) -> str:
    """Read which chromosome a run starts from."""
    if text in STARTS:
        return text
    raise refused("--start", text, " or ".join(STARTS))


def a_file(option: str) -> Callable[[str], Path]:
    """Make a parser of file names; an empty one would mean the folder."""

    def parse(text: str) -> Path:
        if text.strip():
            return Path(text)
        raise refused(option, text, "the name of a file")

    return parse


def a_number_above_0(option: str) -> Callable[[str], float]:
    """Make a parser of numbers above 0."""
    return a_number(option, f"a number above 0, to {MOST:g}", least=LEAST_ABOVE_0)


def with_value(name: str, parser: Callable[[str], Any], metavar: str, told: str) -> Any:  # noqa: ANN401
    """Make an option that takes a value."""
    return typer.Option(name, parser=parser, metavar=metavar, help=told)


File = Annotated[
    Path,
    typer.Argument(
        help="Workbook: an exported option-space sheet, or a full workbook.",
        readable=False,  # looked at when it is read, with the other things that may be wrong
    ),
]
Book = Annotated[
    Path,
    typer.Option("-o", "--output", parser=a_file("-o"), metavar="FILE", help="Workbook to write."),
]
MaybeBook = Annotated[
    Path | None,
    typer.Option(
        "-o",
        "--output",
        parser=a_file("-o"),
        metavar="FILE",
        help="Workbook to write (default NAME-result.xlsx).",
    ),
]
BookIfAny = Annotated[
    Path | None,
    typer.Option(
        "-o",
        "--output",
        parser=a_file("-o"),
        metavar="FILE",
        help="Workbook to write (default: none).",
    ),
]
Cups = Annotated[
    Sequence[int] | None,
    with_value("--cups", _indices("--cups"), "I,J,..", "Suction cup indices, from 1: 87,64,140."),
]
Magnets = Annotated[
    Sequence[int] | None,
    with_value("--magnets", _indices("--magnets"), "I,J,..", "Magnet indices, from 1: 3,8."),
]
GoalList = Annotated[
    Sequence[float] | None,
    with_value(
        "--goals", _goals, "C,M,D,S", "Cost, moment, deviation, structure in $, N-mm, mm, mm."
    ),
]
Fos = Annotated[
    float | None,
    with_value("--fos", a_number_above_0("--fos"), "NUMBER", "Least factor of safety (default 3)."),
]
Clearance = Annotated[
    float | None,
    with_value(
        "--clearance",
        a_number_above_0("--clearance"),
        "MM",
        "Least distance of two elements (default: the largest diameter, else 46).",
    ),
]
Density = Annotated[
    float | None,
    with_value(
        "--density-ratio",
        a_number("--density-ratio", f"a number from 0 to {MOST:g}", least=0),
        "NUMBER",
        "Main truss over branch density (default 2.5).",
    ),
]
CriterionName = Annotated[
    Criterion | None,
    with_value(
        "--criterion",
        _word("--criterion", Criterion.parse),
        "WORD",
        "divergence, cost, moment, deviation, structure, or some joined by + (default divergence).",
    ),
]
Arm = Annotated[
    MomentArm | None,
    with_value(
        "--moment-arm",
        _word("--moment-arm", parse_arm),
        "3d|plan",
        "Moment in space or in plan (default 3d).",
    ),
]
Seed = Annotated[
    int | None,
    with_value(
        "--seed",
        a_whole_number("--seed", 0, MOST_SEED),
        "N",
        "Seed of the random stream (default 1).",
    ),
]
GenerationCount = Annotated[
    int | None,
    with_value(
        "--generations", a_whole_number("--generations", 0), "N", "Generations (default 50000)."
    ),
]
Children = Annotated[
    int | None,
    with_value(
        "--children",
        a_whole_number("--children", 2, MOST_CHILDREN),
        "N",
        "Children each (default 5).",
    ),
]
OneIn = Annotated[
    float | None,
    with_value(
        "--one-in",
        a_number("--one-in", f"a number from 1 to {MOST:g}", least=1),
        "N",
        "n of the 1-in-n mutation probability (default 4).",
    ),
]
NoElitism = Annotated[bool, typer.Option("--no-elitism", help="Mutate child 1 too.")]
Start = Annotated[
    str | None,
    with_value("--start", a_start, "user|random", "The initial chromosome (default user)."),
]
StallCount = Annotated[
    int | None,
    with_value(
        "--stall", a_whole_number("--stall", 1), "N", "Stop after so many generations without gain."
    ),
]
TargetValue = Annotated[
    float | None,
    with_value(
        "--target",
        a_number("--target", f"a number of at most {MOST:g}"),
        "VALUE",
        "Stop when the best value is at or below this.",
    ),
]
MaybeSolved = Annotated[
    Path | None,
    typer.Option(
        "-o",
        "--output",
        parser=a_file("-o"),
        metavar="FILE",
        help="Workbook to write (default none).",
    ),
]
Prove = Annotated[
    bool,
    typer.Option("--prove/--no-prove", help="Find and prove the best grasp of all afterwards."),
]
ProveSeconds = Annotated[
    float,
    with_value(
        "--prove-limit",
        a_number("--prove-limit", f"a number from 0 to {MOST:g}", least=0),
        "SECONDS",
        "Longest search for that proof.",
    ),
]
Seconds = Annotated[
    float | None,
    with_value(
        "--time-limit",
        a_number("--time-limit", f"a number from 0 to {MOST:g}", least=0),
        "SECONDS",
        "Stop after so many seconds of search.",
    ),
]
FrontSeconds = Annotated[
    float,
    with_value(
        "--time-limit",
        a_number("--time-limit", f"a number from 0 to {MOST:g}", least=0),
        "SECONDS",
        "Stop after so many seconds of search (default 30).",
    ),
]
Grid = Annotated[
    int,
    with_value(
        "--grid",
        a_whole_number("--grid", 1, MOST_GRID),
        "N",
        "Steps of the weights from 0 to 1 (default 4: 35 weighted sums).",
    ),
]
DesignCount = Annotated[
    int,
    with_value("--top", a_whole_number("--top", 1, MOST_DESIGNS), "K", "List the K best grasps."),
]
Gap = Annotated[
    float,
    with_value(
        "--gap",
        a_number("--gap", f"a number from 0 to {MOST:g}", least=0),
        "NUMBER",
        "Stop within this fraction of the best value; 0 proves it.",
    ),
]
MeetGoals = Annotated[bool, typer.Option("--meet-goals", help="Only grasps that meet all goals.")]
LeastElements = Annotated[
    int,
    with_value(
        "--min-elements",
        a_whole_number("--min-elements", 1),
        "N",
        "Only grasps of N or more elements.",
    ),
]
GoOn = Annotated[
    bool, typer.Option("--continue", help="Go on from the run that the workbook holds.")
]
History = Annotated[
    Path | None,
    with_value(
        "--history",
        a_file("--history"),
        "FILE",
        "Write every change of the fittest to this CSV file.",
    ),
]
Picture = Annotated[
    bool, typer.Option("--picture", help="Draw the best grasp in 3-D, on the sheet Grasp.")
]
InPlace = Annotated[bool, typer.Option("--in-place", help="Replace the input workbook.")]
Force = Annotated[
    bool, typer.Option("--force", help="Overwrite what was edited; lose what cannot be kept.")
]
ElementKindName = Annotated[
    Kind | None,
    with_value("--kind", _kind, "cup|magnet", "Only suction cups, or only magnets."),
]
MinForce = Annotated[
    float | None,
    with_value(
        "--min-force", a_number_above_0("--min-force"), "N", "Only elements of this force or more."
    ),
]
DiameterRange = Annotated[
    Diameters | None,
    with_value(
        "--diameter",
        _diameters,
        "MM|MM-MM",
        f"Only this diameter, within {DIAMETER_TOLERANCE_MM:g} mm, or a range: 30-50.",
    ),
]
CatalogueFile = Annotated[
    Path | None,
    with_value(
        "--catalogue",
        a_file("--catalogue"),
        "FILE",
        "CSV file of elements to add to the catalogue.",
    ),
]
AsJson = Annotated[bool, typer.Option("--json", help="One JSON object on standard output.")]
Quiet = Annotated[bool, typer.Option("--quiet", help="Print nothing but errors.")]


def parameters(
    goals: Sequence[float] | None,
    fos: float | None,
    clearance: float | None,
    density_ratio: float | None,
    criterion: Criterion | None,
    moment_arm: MomentArm | None,
    seed: int | None,
    **of_run: Any,  # noqa: ANN401 (other fields of Parameters)
) -> Parameters:
    """Return what the options say; a name of ``Parameters`` each, None where none was given."""
    from grasp_xl.task import NO_GOALS, Parameters

    return Parameters(
        goals=tuple(goals) if goals else NO_GOALS,
        fos=fos,
        clearance_mm=clearance,
        density_ratio=density_ratio,
        criterion=criterion,
        moment_arm=moment_arm,
        seed=seed,
        **of_run,
    )
