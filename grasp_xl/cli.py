"""The command line: options in, one sentence or one JSON object out, and an exit code."""

from __future__ import annotations

import gc
import json
import math
import os
import sys
from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, TypeVar

import typer

from grasp_xl import __version__
from grasp_xl.errors import GraspError, InfeasibleError, InputError, OutputError, UsageError
from grasp_xl.rules import TERMS, Criterion, MomentArm
from grasp_xl.rules import moment_arm as parse_arm

if TYPE_CHECKING:
    from grasp_xl.search.stop import StopRule
    from grasp_xl.task import Parameters, Task

T = TypeVar("T")

LEAST_ABOVE_0 = 1e-9
MOST = 1e9
MOST_CHILDREN = 50
MOST_SEED = 2**53
"""The bounds of the workbook's cells; a test holds them equal."""

MOST_DESIGNS = 1000
"""Most designs that ``solve`` lists."""

STARTS = ("user", "random")

CYCLES_AFTER = 100_000
"""New objects after which Python looks for garbage; with its own 700, runs take a sixth longer."""


class CtrlCError(GraspError):
    """Ctrl-C before there was anything to write."""

    exit_code = 130


# --- what an option may be ---


def _refused(option: str, found: str, expected: str, hint: str = "") -> UsageError:
    message = f"{option}: found {found!r}, expected {expected}."
    return UsageError(message, where=option, hint=hint or f"Without {option} the default holds")


def _number(
    option: str, expected: str, *, least: float = -MOST, most: float = MOST
) -> Callable[[str], float]:
    """Make a parser of numbers within bounds."""

    def parse(text: str) -> float:
        number = math.nan
        with suppress(ValueError):
            number = float(text)
        if least <= number <= most:
            return number
        raise _refused(option, text, expected)

    return parse


def _whole(option: str, least: int, most: int = int(MOST)) -> Callable[[str], int]:
    """Make a parser of whole numbers within bounds; ``5e4`` is one, too."""
    expected = f"a whole number from {least} to {most:,}"

    def parse(text: str) -> int:
        number: float = math.nan
        for read in (float, int):  # int() keeps all digits
            with suppress(ValueError):
                number = read(text)
        if least <= number <= most and number == int(number):
            return int(number)
        raise _refused(option, text, expected)

    return parse


def _indices(option: str) -> Callable[[str], tuple[int, ...]]:
    """Make a parser of indices; an empty text names none."""

    def parse(text: str) -> tuple[int, ...]:
        try:
            return tuple(int(word) for word in text.split(",")) if text.strip() else ()
        except ValueError:
            hint = f"For example {option} 87,64,140"
            raise _refused(option, text, "whole numbers separated by commas", hint) from None

    return parse


def _goals(text: str) -> tuple[float, ...]:
    expected = "four numbers above 0 separated by commas"
    goal = _number("--goals", expected, least=LEAST_ABOVE_0)
    words = text.split(",")
    if len(words) != len(TERMS):
        hint = f"Give {', '.join(TERMS)}, for example --goals 105,7933,24.5,1130"
        raise _refused("--goals", text, expected, hint)
    return tuple(goal(word) for word in words)


def _word(option: str, parse: Callable[[str], T]) -> Callable[[str], T]:
    """Name the option where a word is refused."""

    def parse_word(text: str) -> T:
        try:
            return parse(text)
        except UsageError as error:
            raise UsageError(f"{option}: {error.message}", where=option, hint=error.hint) from None

    return parse_word


def _start(text: str) -> str:
    if text in STARTS:
        return text
    raise _refused("--start", text, " or ".join(STARTS))


def _file(option: str) -> Callable[[str], Path]:
    """Make a parser of file names; an empty one would mean the folder."""

    def parse(text: str) -> Path:
        if text.strip():
            return Path(text)
        raise _refused(option, text, "the name of a file")

    return parse


def _above_0(option: str) -> Callable[[str], float]:
    return _number(option, f"a number above 0, to {MOST:g}", least=LEAST_ABOVE_0)


def _option(name: str, parser: Callable[[str], Any], metavar: str, told: str) -> Any:  # noqa: ANN401
    return typer.Option(name, parser=parser, metavar=metavar, help=told)


File = Annotated[
    Path, typer.Argument(help="Workbook: an exported option-space sheet, or a full workbook.")
]
Book = Annotated[
    Path,
    typer.Option("-o", "--output", parser=_file("-o"), metavar="FILE", help="Workbook to write."),
]
MaybeBook = Annotated[
    Path | None,
    typer.Option(
        "-o",
        "--output",
        parser=_file("-o"),
        metavar="FILE",
        help="Workbook to write (default NAME-result.xlsx).",
    ),
]
Cups = Annotated[
    Sequence[int] | None,
    _option("--cups", _indices("--cups"), "I,J,..", "Suction cup indices, from 1: 87,64,140."),
]
Magnets = Annotated[
    Sequence[int] | None,
    _option("--magnets", _indices("--magnets"), "I,J,..", "Magnet indices, from 1: 3,8."),
]
GoalList = Annotated[
    Sequence[float] | None,
    _option("--goals", _goals, "C,M,D,S", "Cost, moment, deviation, structure in $, N-mm, mm, mm."),
]
Fos = Annotated[
    float | None,
    _option("--fos", _above_0("--fos"), "NUMBER", "Least factor of safety (default 3)."),
]
Clearance = Annotated[
    float | None,
    _option(
        "--clearance",
        _above_0("--clearance"),
        "MM",
        "Least distance of two elements (default: the largest diameter, else 46).",
    ),
]
Density = Annotated[
    float | None,
    _option(
        "--density-ratio",
        _number("--density-ratio", f"a number from 0 to {MOST:g}", least=0),
        "NUMBER",
        "Main truss over branch density (default 2.5).",
    ),
]
CriterionName = Annotated[
    Criterion | None,
    _option(
        "--criterion",
        _word("--criterion", Criterion.parse),
        "WORD",
        "divergence, cost, moment, deviation, structure, or some joined by + (default divergence).",
    ),
]
Arm = Annotated[
    MomentArm | None,
    _option(
        "--moment-arm",
        _word("--moment-arm", parse_arm),
        "3d|plan",
        "Moment in space or in plan (default 3d).",
    ),
]
Seed = Annotated[
    int | None,
    _option(
        "--seed", _whole("--seed", 0, MOST_SEED), "N", "Seed of the random stream (default 1)."
    ),
]
GenerationCount = Annotated[
    int | None,
    _option("--generations", _whole("--generations", 0), "N", "Generations (default 50000)."),
]
Children = Annotated[
    int | None,
    _option(
        "--children", _whole("--children", 2, MOST_CHILDREN), "N", "Children each (default 5)."
    ),
]
OneIn = Annotated[
    float | None,
    _option(
        "--one-in",
        _number("--one-in", f"a number from 1 to {MOST:g}", least=1),
        "N",
        "n of the 1-in-n mutation probability (default 4).",
    ),
]
NoElitism = Annotated[bool, typer.Option("--no-elitism", help="Mutate child 1 too.")]
Start = Annotated[
    str | None,
    _option("--start", _start, "user|random", "The initial chromosome (default user)."),
]
StallCount = Annotated[
    int | None,
    _option("--stall", _whole("--stall", 1), "N", "Stop after so many generations without gain."),
]
TargetValue = Annotated[
    float | None,
    _option(
        "--target",
        _number("--target", f"a number of at most {MOST:g}"),
        "VALUE",
        "Stop when the best value is at or below this.",
    ),
]
Seconds = Annotated[
    float | None,
    _option(
        "--time-limit",
        _number("--time-limit", f"a number from 0 to {MOST:g}", least=0),
        "SECONDS",
        "Stop after so many seconds of search.",
    ),
]
DesignCount = Annotated[
    int,
    _option("--top", _whole("--top", 1, MOST_DESIGNS), "K", "List the K best grasps."),
]
Gap = Annotated[
    float,
    _option(
        "--gap",
        _number("--gap", f"a number from 0 to {MOST:g}", least=0),
        "NUMBER",
        "Stop within this fraction of the best value; 0 proves it.",
    ),
]
MeetGoals = Annotated[bool, typer.Option("--meet-goals", help="Only grasps that meet all goals.")]
LeastElements = Annotated[
    int,
    _option(
        "--min-elements",
        _whole("--min-elements", 1),
        "N",
        "Only grasps of N or more elements.",
    ),
]
GoOn = Annotated[
    bool, typer.Option("--continue", help="Go on from the run that the workbook holds.")
]
History = Annotated[
    Path | None,
    _option(
        "--history",
        _file("--history"),
        "FILE",
        "Write every change of the fittest to this CSV file.",
    ),
]
InPlace = Annotated[bool, typer.Option("--in-place", help="Replace the input workbook.")]
Force = Annotated[
    bool, typer.Option("--force", help="Overwrite what was edited; lose what cannot be kept.")
]
AsJson = Annotated[bool, typer.Option("--json", help="One JSON object on standard output.")]
Quiet = Annotated[bool, typer.Option("--quiet", help="Print nothing but errors.")]


# --- from words to an exit code ---

app = typer.Typer(
    name="grasp-xl",
    help="Find good grasps for sheet-metal parts, in the designer's workbook.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command and return its exit code; every known error becomes one sentence."""
    words = list(sys.argv[1:] if arguments is None else arguments)
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="backslashreplace")
    try:
        return _run([word for word in words if word != "--debug"])
    except BrokenPipeError:
        _forget_output()
        return 0
    except (GraspError, typer.TyperException, OSError, KeyboardInterrupt) as error:
        if "--debug" in words:
            raise
        known = _known(error)
        _tell(known, as_json="--json" in words)
        return known.exit_code


def entry() -> None:
    """Start from the ``grasp-xl`` command."""
    gc.set_threshold(CYCLES_AFTER)
    sys.exit(main())


def _run(words: list[str]) -> int:
    command = typer.main.get_command(app)
    try:
        with command.make_context("grasp-xl", words) as context:
            command.invoke(context)
    except typer.Exit as done:
        return done.exit_code
    return 0


def _known(error: BaseException) -> GraspError:
    """Return what can be told of an error in a sentence."""
    if isinstance(error, GraspError):
        return error
    if isinstance(error, typer.TyperException):
        context, parameter = getattr(error, "ctx", None), getattr(error, "param", None)
        where = getattr(error, "option_name", None) or (parameter.opts[-1] if parameter else "")
        program = context.command_path if context else "grasp-xl"
        return UsageError(error.format_message(), where=where, hint=f"See {program} --help")
    if isinstance(error, OSError):
        if error.filename is None:  # standard output
            _forget_output()
        name = str(error.filename or "standard output")
        return OutputError(f"{name}: {error.strerror or error}.", where=name)
    return CtrlCError("Interrupted; nothing was written.")


def _forget_output() -> None:
    """Leave nothing for Python to write when it ends."""
    with suppress(OSError):  # where it is no file, nothing waits there
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _tell(error: GraspError, *, as_json: bool) -> None:
    if as_json:
        from grasp_xl.reporting import error_json

        _print_json(error_json(error))
        return
    from rich.console import Console

    console = Console(stderr=True, soft_wrap=True, highlight=False)
    if isinstance(error, InputError):
        for problem in error.problems:
            console.print(str(problem), style="red", markup=False)
    elif error.message:
        console.print(error.message, style="red", markup=False)
        if error.hint:
            console.print(f"{error.hint}.", markup=False)


def _print_json(told: dict[str, Any]) -> None:
    print(json.dumps(told, indent=2, allow_nan=False), flush=True)  # noqa: T201 (the product)


# --- commands ---


@app.callback(invoke_without_command=True)
def _about(
    version: Annotated[bool, typer.Option("--version", help="Print the version.")] = False,
    debug: Annotated[bool, typer.Option("--debug", help="Show tracebacks.")] = False,  # noqa: ARG001 (main() acts on it)
) -> None:
    if version:
        print(f"grasp-xl {__version__}")  # noqa: T201
        raise typer.Exit


@app.command()
def check(
    file: File,
    goals: GoalList = None,
    fos: Fos = None,
    clearance: Clearance = None,
    density_ratio: Density = None,
    criterion: CriterionName = None,
    moment_arm: Arm = None,
    seed: Seed = None,
    as_json: AsJson = False,
    quiet: Quiet = False,
) -> None:
    """Read and validate a file; list every problem, and say what any grasp of it can reach.

    Example: grasp-xl check workbooks/bracket.xlsx
    """
    from grasp_xl import commands, reporting, show

    options = _parameters(goals, fos, clearance, density_ratio, criterion, moment_arm, seed)
    show.compile_notice(quiet=quiet)
    try:
        checked = commands.check(file, options)
    except InputError as error:
        if not as_json:
            raise
        _print_json(reporting.failed_check_json(error))
        raise typer.Exit(error.exit_code) from error
    if not quiet:
        show.warnings(checked.warnings)
    if as_json:
        _print_json(reporting.check_json(checked))
    elif not quiet:
        show.check(checked)
    if checked.obstacle and as_json:
        raise typer.Exit(checked.obstacle.exit_code)
    if checked.obstacle:
        raise checked.obstacle


@app.command()
def new(
    file: File,
    output: Book,
    cups: Cups = None,
    magnets: Magnets = None,
    goals: GoalList = None,
    fos: Fos = None,
    clearance: Clearance = None,
    density_ratio: Density = None,
    criterion: CriterionName = None,
    moment_arm: Arm = None,
    seed: Seed = None,
    force: Force = False,
    as_json: AsJson = False,
    quiet: Quiet = False,
) -> None:
    """Make the full workbook from an exported sheet, ready for a designer; no run.

    Into a workbook that exists, it keeps the designer's parameters and names stale indices.

    Example: grasp-xl new export.xlsx -o bracket.xlsx
    """
    from grasp_xl import commands, reporting, show

    options = _parameters(goals, fos, clearance, density_ratio, criterion, moment_arm, seed)
    show.compile_notice(quiet=quiet)
    place = commands.Output(output, force=force)
    task = commands.new(file, options, place, (cups, magnets))
    if not quiet:
        show.warnings(task.warnings)
    if as_json:
        _print_json(reporting.new_json(task, str(output)))
    elif not quiet:
        show.line(f"Wrote {output}.")


@app.command()
def evaluate(
    file: File,
    cups: Cups = None,
    magnets: Magnets = None,
    goals: GoalList = None,
    fos: Fos = None,
    clearance: Clearance = None,
    density_ratio: Density = None,
    criterion: CriterionName = None,
    moment_arm: Arm = None,
    seed: Seed = None,
    as_json: AsJson = False,
    quiet: Quiet = False,
) -> None:
    """Judge one grasp: its card, against the goals.  The user-defined grasp where none is named.

    Example: grasp-xl evaluate workbooks/bracket.xlsx --cups 1,9,20 --magnets 3
    """
    from grasp_xl import commands, reporting, show

    options = _parameters(goals, fos, clearance, density_ratio, criterion, moment_arm, seed)
    show.compile_notice(quiet=quiet)
    task, grasp = commands.evaluate_grasp(file, options, (cups, magnets))
    if not quiet:
        show.warnings(task.warnings)
    if as_json:
        _print_json(reporting.grasp_json(grasp, task.rules))
    elif not quiet:
        show.grasps([("Grasp", grasp), ("Benchmark", task.benchmark)], task.rules)


@app.command()
def run(
    file: File,
    output: MaybeBook = None,
    generations: GenerationCount = None,
    children: Children = None,
    one_in: OneIn = None,
    no_elitism: NoElitism = False,
    start: Start = None,
    cups: Cups = None,
    magnets: Magnets = None,
    goals: GoalList = None,
    fos: Fos = None,
    clearance: Clearance = None,
    density_ratio: Density = None,
    criterion: CriterionName = None,
    moment_arm: Arm = None,
    seed: Seed = None,
    stall: StallCount = None,
    target: TargetValue = None,
    time_limit: Seconds = None,
    go_on: GoOn = False,
    history: History = None,
    in_place: InPlace = False,
    force: Force = False,
    as_json: AsJson = False,
    quiet: Quiet = False,
) -> None:
    """Find good grasps with the thesis's genetic algorithm, and write the workbook.

    Example: grasp-xl run workbooks/bracket.xlsx -o result.xlsx --seed 1
    """
    from grasp_xl import commands, reporting, show
    from grasp_xl.search.stop import stop_on_ctrl_c

    if in_place and output:
        raise UsageError("Both --in-place and -o were given.", where="-o", hint="Give one of them")
    path = file if in_place else output or file.with_name(f"{file.stem}-result.xlsx")
    options = _parameters(
        goals,
        fos,
        clearance,
        density_ratio,
        criterion,
        moment_arm,
        seed,
        generations=generations,
        children=children,
        one_in=one_in,
        elitism=False if no_elitism else None,
        user_start=None if start is None else start == "user",
    )
    show.compile_notice(quiet=quiet, module="evolution")
    with stop_on_ctrl_c() as interrupt, show.progress(quiet=quiet) as bar:

        def stop(task: Task) -> list[StopRule]:
            bar.begin(task.generations, time_limit)
            return [interrupt, *_stop_rules(task, stall, target, time_limit)]

        task, result, seconds = commands.run(
            file,
            options,
            commands.Output(path, in_place, force, history),
            grasp=(cups, magnets),
            stop=stop,
            go_on=go_on,
            on_progress=bar,
        )
    if not quiet:
        show.warnings(task.warnings)
    if as_json:
        _print_json(reporting.run_json(result, seconds, str(path)))
    elif not quiet:
        show.run(task, result, seconds, path)
    if result.stop_reason == "interrupted":
        raise typer.Exit(130)


@app.command()
def solve(
    file: File,
    time_limit: Seconds = None,
    top: DesignCount = 1,
    gap: Gap = 0.0,
    meet_goals: MeetGoals = False,
    min_elements: LeastElements = 1,
    goals: GoalList = None,
    fos: Fos = None,
    clearance: Clearance = None,
    density_ratio: Density = None,
    criterion: CriterionName = None,
    moment_arm: Arm = None,
    seed: Seed = None,
    as_json: AsJson = False,
    quiet: Quiet = False,
) -> None:
    """Find the best grasp of all, and prove that there is no better one; writes no file.

    Example: grasp-xl solve workbooks/door_frame.xlsx --top 3
    """
    from grasp_xl import commands, reporting, show
    from grasp_xl.search.exact import ExactSettings
    from grasp_xl.search.stop import stop_on_ctrl_c

    options = _parameters(goals, fos, clearance, density_ratio, criterion, moment_arm, seed)
    limit = math.inf if time_limit is None else time_limit
    settings = ExactSettings(limit, gap, top, meet_goals, min_elements)
    show.compile_notice(quiet=quiet, module="exact", seconds=20)
    try:
        with stop_on_ctrl_c() as interrupt, show.proof_progress(quiet=quiet) as shown:
            solved = commands.solve(file, options, settings, interrupt=interrupt, on_progress=shown)
    except InfeasibleError as error:
        if not as_json:
            raise
        _print_json(reporting.failed_solve_json(error))
        raise typer.Exit(error.exit_code) from error
    if not quiet:
        show.warnings(solved.task.warnings)
    if as_json:
        _print_json(reporting.solve_json(solved))
    elif solved.obstacle:
        raise solved.obstacle
    elif not quiet:
        show.solve(solved)
    if solved.obstacle:
        raise typer.Exit(solved.obstacle.exit_code)
    if solved.interrupted:
        raise typer.Exit(130)


def _parameters(
    goals: Sequence[float] | None,
    fos: float | None,
    clearance: float | None,
    density_ratio: float | None,
    criterion: Criterion | None,
    moment_arm: MomentArm | None,
    seed: int | None,
    **of_run: Any,  # noqa: ANN401 (other fields of Parameters)
) -> Parameters:
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


def _stop_rules(
    task: Task, stall: int | None, target: float | None, time_limit: float | None
) -> list[StopRule]:
    from grasp_xl.search.stop import Generations, Stall, Target, TimeLimit

    rules: list[StopRule] = []
    if target is not None:
        rules.append(Target(target))
    if stall is not None:
        rules.append(Stall(stall))
    if time_limit is not None:
        rules.append(TimeLimit(time_limit))
    return [*rules, Generations(task.generations)]
