"""From words to an exit code: every known error becomes one sentence."""

from __future__ import annotations

import gc
import os
import sys
from collections.abc import Sequence
from contextlib import suppress
from typing import Annotated

import typer

from grasp_xl import __version__
from grasp_xl.cli.check import check
from grasp_xl.cli.elements import elements
from grasp_xl.cli.evaluate import evaluate
from grasp_xl.cli.excel import excel
from grasp_xl.cli.fit import fit
from grasp_xl.cli.front import front
from grasp_xl.cli.new import new
from grasp_xl.cli.run import run
from grasp_xl.cli.solve import solve
from grasp_xl.cli.study import study
from grasp_xl.cli.view import view
from grasp_xl.errors import GraspError, InputError, OutputError, UsageError

CYCLES_AFTER = 5_000_000
"""New objects after which Python looks for garbage; with its own 700, runs take a fifth longer."""


class CtrlCError(GraspError):
    """Ctrl-C before there was anything to write."""

    exit_code = 130


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
        try:
            _tell(known, as_json="--json" in words)
        except OSError:  # nobody reads it
            _forget_output()
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
        from grasp_xl.cli.reporting import error_json, print_json

        print_json(error_json(error))
        return
    from rich.console import Console

    console = Console(stderr=True, soft_wrap=True, highlight=False)
    for note in getattr(error, "__notes__", ()):
        console.print(f"Warning: {note}", style="yellow", markup=False)
    if isinstance(error, InputError):
        for problem in error.problems:
            console.print(str(problem), style="red", markup=False)
    elif error.message:
        console.print(error.message, style="red", markup=False)
        if error.hint:
            console.print(f"{error.hint}.", markup=False)


@app.callback(invoke_without_command=True)
def _about(
    version: Annotated[bool, typer.Option("--version", help="Print the version.")] = False,
    debug: Annotated[bool, typer.Option("--debug", help="Show tracebacks.")] = False,  # noqa: ARG001 (main() acts on it)
) -> None:
    if version:
        print(f"grasp-xl {__version__}")  # noqa: T201
        raise typer.Exit


for _command in (check, new, evaluate, run, solve, front, study, fit, elements, view, excel):
    app.command()(_command)
