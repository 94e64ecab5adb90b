"""The command ``run``."""

from __future__ import annotations

from contextlib import suppress
from typing import TYPE_CHECKING

import typer

from grasp_xl.cli.options import (
    Arm,
    AsJson,
    Children,
    Clearance,
    CriterionName,
    Cups,
    Density,
    File,
    Force,
    Fos,
    GenerationCount,
    GoalList,
    GoOn,
    History,
    InPlace,
    Magnets,
    MaybeBook,
    NoElitism,
    OneIn,
    Picture,
    Prove,
    ProveSeconds,
    Quiet,
    Seconds,
    Seed,
    StallCount,
    Start,
    TargetValue,
    parameters,
)
from grasp_xl.errors import UsageError

if TYPE_CHECKING:
    from grasp_xl.commands.solve import Solved
    from grasp_xl.search.result import Result
    from grasp_xl.search.stop import StopRule
    from grasp_xl.task import Task


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
    prove: Prove = True,
    prove_limit: ProveSeconds = 10.0,
    go_on: GoOn = False,
    history: History = None,
    picture: Picture = False,
    in_place: InPlace = False,
    force: Force = False,
    as_json: AsJson = False,
    quiet: Quiet = False,
) -> None:
    """Find good grasps with the thesis's genetic algorithm, and write the workbook.

    Then the best grasp of all is proved, and shown beside them.

    Example: grasp-xl run workbooks/bracket.xlsx -o result.xlsx --seed 1
    """
    from grasp_xl.cli import reporting, show, terminal
    from grasp_xl.commands.output import Output
    from grasp_xl.commands.run import run_file
    from grasp_xl.commands.solve import prove_run
    from grasp_xl.search.stop import stop_on_ctrl_c

    if in_place and output:
        raise UsageError("Both --in-place and -o were given.", where="-o", hint="Give one of them")
    path = file if in_place else output or file.with_name(f"{file.stem}-result{file.suffix}")
    options = parameters(
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
            return _stop_rules(task, stall, target, time_limit)

        def proved(task: Task, result: Result) -> Solved | None:
            bar.end()
            if not prove or interrupt.asked:
                return None
            show.compile_notice(quiet=quiet, module="exact", what="exact search", seconds=15)
            with suppress(KeyboardInterrupt), show.proof_progress(quiet=quiet) as line:
                return prove_run(
                    task, result, path, prove_limit, interrupt=interrupt, on_progress=line
                )
            return None

        ran = run_file(
            file,
            options,
            Output(path, in_place, force, history),
            grasp=(cups, magnets),
            stop=stop,
            interrupt=interrupt,
            go_on=go_on,
            on_progress=bar,
            prove=proved,
            picture=picture,
        )
    if not quiet:
        terminal.warnings(ran.task.warnings)
    if as_json:
        reporting.print_json(reporting.run_json(ran, str(path)))
    elif not quiet:
        show.run(ran, path)
    if interrupt.asked:
        raise typer.Exit(130)


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
