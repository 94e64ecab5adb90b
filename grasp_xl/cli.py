"""The command line: options in, one sentence or one JSON object out, and an exit code."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from grasp_xl import __version__
from grasp_xl.errors import GraspError, InfeasibleError, InputError, UsageError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from grasp_xl.commands import Active
    from grasp_xl.search.stop import StopRule
    from grasp_xl.task import Parameters, Task

app = typer.Typer(
    name="grasp-xl",
    help="Find good grasps for sheet-metal parts, in the designer's workbook.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
)

File = Annotated[
    Path, typer.Argument(help="Workbook: an exported option-space sheet, or a full workbook.")
]
Book = Annotated[Path, typer.Option("-o", "--output", help="Workbook to write.")]
MaybeBook = Annotated[
    Path | None,
    typer.Option("-o", "--output", help="Workbook to write [default: NAME-result.xlsx]."),
]
Cups = Annotated[
    str | None, typer.Option(help="Suction cup indices, from 1: 87,64,140. The user-defined grasp.")
]
Magnets = Annotated[str | None, typer.Option(help="Magnet indices, from 1: 3,8.")]
GoalList = Annotated[
    str | None,
    typer.Option("--goals", help="COST,MOMENT,DEVIATION,STRUCTURE in $, N-mm, mm, mm."),
]
Fos = Annotated[float | None, typer.Option(help="Least factor of safety [default: 3].")]
Clearance = Annotated[
    float | None,
    typer.Option(help="Least distance of two elements, mm [default: largest diameter, else 46]."),
]
Density = Annotated[
    float | None, typer.Option(help="Main truss over branch density [default: 2.5].")
]
CriterionName = Annotated[
    str | None,
    typer.Option(
        "--criterion",
        help="divergence, cost, moment, deviation, structure, or some joined by + "
        "[default: divergence].",
    ),
]
Arm = Annotated[str | None, typer.Option(help="3d or plan [default: 3d].")]
Seed = Annotated[
    int | None, typer.Option(min=0, help="Seed of the run's random stream [default: 1].")
]
AsJson = Annotated[bool, typer.Option("--json", help="One JSON object on standard output.")]
Quiet = Annotated[bool, typer.Option("--quiet", help="Print nothing but errors.")]
Force = Annotated[bool, typer.Option("--force", help="Overwrite what grasp_xl did not write.")]


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command and return its exit code; every known error becomes one sentence."""
    words = list(sys.argv[1:] if arguments is None else arguments)
    as_json = "--json" in words
    if "--debug" in words:
        words.remove("--debug")
        return _run(words)
    try:
        return _run(words)
    except GraspError as error:
        _tell(error, as_json=as_json)
        return error.exit_code
    except typer.TyperException as error:
        _tell(UsageError(error.format_message(), hint="See --help"), as_json=as_json)
        return error.exit_code
    except KeyboardInterrupt:
        _tell(GraspError("Interrupted; nothing was written."), as_json=as_json)
        return 130
    except BrokenPipeError:
        sys.stderr.close()
        return 0


def entry() -> None:
    """Start from the ``grasp-xl`` command."""
    sys.exit(main())


def _run(words: list[str]) -> int:
    code = app(words, prog_name="grasp-xl", standalone_mode=False)
    return code if isinstance(code, int) else 0


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
        return
    console.print(error.message, style="red", markup=False)
    if error.hint:
        console.print(f"{error.hint}.", markup=False)


def _print_json(told: dict[str, Any]) -> None:
    print(json.dumps(told, indent=2, allow_nan=False))  # noqa: T201 (standard output is the product)


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
    fos: Fos = None,
    clearance: Clearance = None,
    moment_arm: Arm = None,
    as_json: AsJson = False,
    quiet: Quiet = False,
) -> None:
    """Read and validate a file; list every problem, and say what any grasp of it can reach.

    Example: grasp-xl check workbooks/bracket.xlsx
    """
    from grasp_xl import commands, reporting, show

    options = _parameters(fos=fos, clearance=clearance, moment_arm=moment_arm)
    try:
        checked = commands.check(file, options)
    except (InputError, InfeasibleError) as error:
        if not as_json:
            raise
        _print_json(reporting.failed_check_json(error))
        raise typer.Exit(error.exit_code) from error
    if as_json:
        _print_json(reporting.check_json(checked))
    elif not quiet:
        show.check(checked)


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

    options = _parameters(
        goals=goals,
        fos=fos,
        clearance=clearance,
        density_ratio=density_ratio,
        criterion=criterion,
        moment_arm=moment_arm,
        seed=seed,
    )
    show.compile_notice(quiet=quiet)
    task = commands.new(file, options, commands.Output(output, force=force), _active(cups, magnets))
    if as_json:
        _print_json(reporting.new_json(task, str(output)))
    elif not quiet:
        show.warnings(task.warnings)
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
    as_json: AsJson = False,
    quiet: Quiet = False,
) -> None:
    """Judge one grasp: its card, against the goals.  The user-defined grasp where none is named.

    Example: grasp-xl evaluate workbooks/bracket.xlsx --cups 1,9,20 --magnets 3
    """
    from grasp_xl import commands, reporting, show

    options = _parameters(
        goals=goals,
        fos=fos,
        clearance=clearance,
        density_ratio=density_ratio,
        criterion=criterion,
        moment_arm=moment_arm,
    )
    show.compile_notice(quiet=quiet)
    task, grasp = commands.evaluate_grasp(file, options, _active(cups, magnets))
    if as_json:
        _print_json(reporting.grasp_json(grasp, task.rules))
    elif not quiet:
        show.warnings(task.warnings)
        show.grasps([("Grasp", grasp), ("Benchmark", task.benchmark)], task.rules)


@app.command()
def run(
    file: File,
    output: MaybeBook = None,
    generations: Annotated[
        int | None, typer.Option(min=0, help="Generations [default: 50000].")
    ] = None,
    children: Annotated[
        int | None, typer.Option(min=2, max=50, help="Children a generation [default: 5].")
    ] = None,
    one_in: Annotated[
        float | None, typer.Option(min=1, help="n of the 1-in-n mutation probability [default: 4].")
    ] = None,
    no_elitism: Annotated[bool, typer.Option("--no-elitism", help="Mutate child 1 too.")] = False,
    start: Annotated[
        str | None, typer.Option(help="user or random: the initial chromosome [default: user].")
    ] = None,
    cups: Cups = None,
    magnets: Magnets = None,
    goals: GoalList = None,
    fos: Fos = None,
    clearance: Clearance = None,
    density_ratio: Density = None,
    criterion: CriterionName = None,
    moment_arm: Arm = None,
    seed: Seed = None,
    stall: Annotated[
        int | None, typer.Option(min=1, help="Stop after so many generations without a better one.")
    ] = None,
    target: Annotated[
        float | None, typer.Option(help="Stop when the best value is at or below this.")
    ] = None,
    time_limit: Annotated[
        float | None, typer.Option(min=0, help="Stop after so many seconds.")
    ] = None,
    go_on: Annotated[
        bool, typer.Option("--continue", help="Go on from the run that the workbook holds.")
    ] = False,
    history: Annotated[
        Path | None, typer.Option(help="Write every change of the fittest to this CSV file.")
    ] = None,
    in_place: Annotated[
        bool, typer.Option("--in-place", help="Replace the input workbook.")
    ] = False,
    force: Force = False,
    as_json: AsJson = False,
    quiet: Quiet = False,
) -> None:
    """Find good grasps with the thesis's genetic algorithm, and write the workbook.

    Example: grasp-xl run workbooks/bracket.xlsx -o result.xlsx --seed 1
    """
    from grasp_xl import commands, reporting, show
    from grasp_xl.search.stop import stop_on_ctrl_c

    options = _parameters(
        goals=goals,
        fos=fos,
        clearance=clearance,
        density_ratio=density_ratio,
        criterion=criterion,
        moment_arm=moment_arm,
        seed=seed,
        generations=generations,
        children=children,
        one_in=one_in,
        elitism=False if no_elitism else None,
        user_start=_user_start(start),
    )
    place = _run_output(file, output, in_place=in_place, force=force)
    show.compile_notice(quiet=quiet)
    with stop_on_ctrl_c() as interrupt:

        def stop(task: Task) -> list[StopRule]:
            limits = _stop_rules(task, stall=stall, target=target, time_limit=time_limit)
            return [interrupt, *limits]

        with show.progress(quiet=quiet or as_json) as report:
            task, result, seconds = commands.run(
                file,
                options,
                place,
                grasp=_active(cups, magnets),
                stop=stop,
                go_on=go_on,
                on_progress=report,
            )
    if history:
        commands.write_history(result, history)
    if as_json:
        _print_json(reporting.run_json(result, seconds, str(place.path)))
    elif not quiet:
        show.run(task, result, seconds, place.path)
    if result.stop_reason == "interrupted":
        raise typer.Exit(130)


def _run_output(file: Path, output: Path | None, *, in_place: bool, force: bool) -> Any:  # noqa: ANN401
    from grasp_xl.commands import Output

    if in_place and output:
        raise UsageError("Both --in-place and -o were given.", where="-o", hint="Give one of them")
    path = file if in_place else output or file.with_name(f"{file.stem}-result.xlsx")
    return Output(path, in_place=in_place, force=force)


def _stop_rules(
    task: Task, *, stall: int | None, target: float | None, time_limit: float | None
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


def _user_start(word: str | None) -> bool | None:
    if word in (None, "user", "random"):
        return None if word is None else word == "user"
    raise UsageError(
        f"--start: found {word!r}, expected user or random.", where="--start", hint="Use user"
    )


def _numbers(option: str, text: str | None, kind: type[Any], count: int | None = None) -> Any:  # noqa: ANN401
    if text is None:
        return None
    try:
        numbers = tuple(kind(word) for word in text.split(",") if word.strip())
    except ValueError:
        numbers = ()
    if (not numbers and text.strip()) or (count is not None and len(numbers) != count):
        what = "whole numbers" if kind is int else f"{count} numbers"
        raise UsageError(
            f"{option}: found {text!r}, expected {what} separated by commas.",
            where=option,
            hint=f"For example {option} " + ("87,64,140" if kind is int else "105,7933,24.5,1130"),
        )
    return numbers


def _active(cups: str | None, magnets: str | None) -> Active:
    return (_numbers("--cups", cups, int), _numbers("--magnets", magnets, int))


def _above_zero(option: str, value: float | None, *, zero_too: bool = False) -> float | None:
    import math

    if value is None or (math.isfinite(value) and (value > 0 or (zero_too and value == 0))):
        return value
    least = "a number of 0 or more" if zero_too else "a number above 0"
    raise UsageError(
        f"{option}: found {value:g}, expected {least}.", where=option, hint="See --help"
    )


def _parameters(
    *,
    goals: str | None = None,
    fos: float | None = None,
    clearance: float | None = None,
    density_ratio: float | None = None,
    criterion: str | None = None,
    moment_arm: str | None = None,
    **others: Any,  # noqa: ANN401 (fields of Parameters that need no check)
) -> Parameters:
    from grasp_xl.rules import Criterion
    from grasp_xl.rules import moment_arm as parse_arm
    from grasp_xl.task import NO_GOALS, Parameters

    numbers = _numbers("--goals", goals, float, 4)
    for number in numbers or ():
        _above_zero("--goals", number)
    return Parameters(
        goals=numbers or NO_GOALS,
        fos=_above_zero("--fos", fos),
        clearance_mm=_above_zero("--clearance", clearance),
        density_ratio=_above_zero("--density-ratio", density_ratio, zero_too=True),
        criterion=Criterion.parse(criterion) if criterion else None,
        moment_arm=parse_arm(moment_arm) if moment_arm else None,
        **others,
    )
