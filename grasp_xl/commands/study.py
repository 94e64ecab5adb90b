"""How ``study`` settles what is run, runs what is not done yet, and writes what came of it."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import groupby, product
from pathlib import Path
from typing import Any

from grasp_xl.commands import fit as fitting
from grasp_xl.commands.keeping import replaced
from grasp_xl.commands.output import Output, now, written_book
from grasp_xl.commands.preparing import prepare, refuse_infeasible
from grasp_xl.errors import OutputError, Problem, UsageError
from grasp_xl.fitment.material import MATERIALS
from grasp_xl.fitment.part_file import Reading
from grasp_xl.printable import printable
from grasp_xl.search.exact import ExactSettings, Proof, solve
from grasp_xl.search.stop import Interrupt
from grasp_xl.search.warm import load_exact_search
from grasp_xl.study.book import study_workbook
from grasp_xl.study.data_file import SUFFIXES, check_format, write_data
from grasp_xl.study.description import PARAMETERS, PITCH, Description, Value
from grasp_xl.study.execution import Execute
from grasp_xl.study.outcome import Measuring
from grasp_xl.study.page import MARK, study_page
from grasp_xl.study.plan import SCENARIOS, Case, Plan, Trial
from grasp_xl.study.records import Records, records_path, run_key
from grasp_xl.study.summary import Study
from grasp_xl.study.trial import Record, Work, run_search
from grasp_xl.task import Parameters, Task, settle
from grasp_xl.workbook.book import Book, read_book
from grasp_xl.workbook.run_log import Origin
from grasp_xl.workbook.saving import check_place, check_target, refuse_theirs, save
from grasp_xl.workbook.writing import full_workbook

RUNS, SEED = 2, 1
"""Of a study that says nothing else: two runs of each start, as in chapter 6."""

PROVE_SECONDS = 10.0

OnRun = Callable[[int, int], None]
"""Given the runs that are done and all of them."""


@dataclass(frozen=True, slots=True)
class StudyOutput:
    """Where a study's results go.

    Parameters
    ----------
    path : Path
        Workbook; the runs are kept beside it.
    page, data, workbooks : Path, optional
        Page, long-format table, and folder of the runs' own workbooks.
    force : bool
        Replace what was edited, begin anew.
    resume : bool
        Go on with the runs that are kept.
    """

    path: Path
    page: Path | None = None
    data: Path | None = None
    workbooks: Path | None = None
    force: bool = False
    resume: bool = False


@dataclass(frozen=True, eq=False, slots=True)
class Studied:
    """What ``study`` did.

    Parameters
    ----------
    study : Study
    known : int
        Runs that were done before.
    warnings : tuple of Problem
    seconds : float
    interrupted : bool
    """

    study: Study
    known: int
    warnings: tuple[Problem, ...]
    seconds: float
    interrupted: bool


def study_files(
    description: Description,
    options: Parameters,
    output: StudyOutput,
    execute: Execute,
    interrupt: Interrupt,
    on_run: OnRun | None = None,
) -> Studied:
    """Run a study and write its workbook; what is done is kept whatever happens.

    Parameters
    ----------
    description : Description
        Its workbooks and fits are the parts, P1 first.
    options : Parameters
        Beat what the description and the workbooks say.
    output : StudyOutput
    execute : callable
        Runs the trials.
    interrupt : Interrupt
        Once asked, what is done by then is written.
    on_run : callable, optional

    Raises
    ------
    UsageError
        If there is no part, or runs are kept and nobody said what shall become of them.
    InputError, InfeasibleError
        If a part cannot be read, or no grasp of it meets FoS and clearance.
    OutputError
        If something cannot be written.
    """
    clock = time.perf_counter()
    lost = _check_places(description, output)
    plan, books, warnings = _settle(description, options, interrupt)
    works = [Work.of(case.task) for case in plan.cases]
    prints = [work.fingerprint() for work in works]
    keys = {
        trial.label: run_key(prints[trial.case], trial.seed, trial.scenario)
        for trial in plan.trials()
    }
    with _kept_runs(output) as records:
        pending = [trial for trial in plan.trials() if not records.has(keys[trial.label])]
        known = done = len(plan) - len(pending)

        def take(trial: Trial, record: Record) -> None:
            nonlocal done
            records.put(keys[trial.label], record)
            done += 1
            if on_run:
                on_run(done, len(plan))

        if pending:
            execute(works, pending, take, interrupt)

        def runs() -> Iterator[tuple[Trial, Record]]:
            for trial in plan.trials():
                record = records.get(keys[trial.label])
                if record:
                    yield trial, record

        study = _measured(plan, runs(), description, interrupt)
        links = _write_workbooks(plan, books, works, runs(), output, interrupt)
        save(study_workbook(study, links), output.path)
        if output.page:
            save(study_page(study).encode(), output.page)
        if output.data:
            write_data(output.data, plan, runs())
    seconds = time.perf_counter() - clock
    return Studied(study, known, (*lost, *warnings), seconds, interrupt.asked)


def _check_places(description: Description, output: StudyOutput) -> list[Problem]:
    """Refuse what could not be written in the end, before any work is done."""
    sources = [*description.workbooks, *(each["file"] for each in description.fits)]
    if not sources:
        raise UsageError(
            "No part was named.", hint="Name workbooks, or a TOML file that describes a study"
        )
    for source in sources:
        check_target(output.path, source, in_place=False, force=output.force, suffixes=[".xlsx"])
    if output.workbooks and output.workbooks.exists() and not output.workbooks.is_dir():
        raise OutputError(
            f"{output.workbooks} is no folder, so nothing was written.",
            where="--workbooks",
            hint="Name a folder, or one that is yet to be made",
        )
    if output.page:
        check_place(output.page, [".html"], force=output.force, option="--html")
        refuse_theirs(output.page, [MARK], "study", force=output.force, option="--html")
    if output.data:
        check_place(output.data, SUFFIXES, force=output.force, option="--data")
        check_format(output.data)
    return replaced(Output(output.path, force=output.force))


def _kept_runs(output: StudyOutput) -> Records:
    """Open the file with the runs; one that holds some is kept or begun anew as was asked."""
    path = records_path(output.path)
    check_place(path, [path.suffix], force=output.force)
    records = Records(path)
    if len(records) and not output.resume:
        if not output.force:
            count = len(records)
            records.close()
            raise UsageError(
                f"{path} holds {count:,} runs of a study.",
                where=str(path),
                hint="Add --resume to go on with them, or --force to begin anew",
            )
        records.clear()
    return records


# --- what is run ---


def _settle(
    description: Description, options: Parameters, interrupt: Interrupt
) -> tuple[Plan, list[Book | None], list[Problem]]:
    """Settle every case of a study; with the workbook of each, and what is odd about it."""
    varied = {name: values for name, values in (description.varied or {}).items() if values}
    axes = [name for name, values in varied.items() if len(values) > 1]
    if PITCH in varied and not description.fits:
        raise UsageError(
            "pitch: found in a study of workbooks, expected in one of parts that are fitted.",
            where=PITCH,
            hint="Name the parts in tables [[fit]], with their STEP or DXF files",
        )
    cases: list[Case] = []
    books: list[Book | None] = []
    warnings: list[Problem] = []
    sources: list[tuple[str, Book | Mapping[str, Any]]] = [
        (printable(path.stem), read_book(path)) for path in description.workbooks
    ]
    sources += [(printable(each["file"].stem), each) for each in description.fits]
    for part, (name, source) in enumerate(sources, 1):
        combined = list(_combinations(varied, fitted=not isinstance(source, Book)))
        for variant, values in enumerate(combined, 1):
            task, book = _task(source, options, values, interrupt)
            if task.generations < 1:
                raise UsageError(
                    f"{name}: found {task.generations} generations, expected 1 or more.",
                    where="--generations",
                    hint="A run without generations has nothing to compare",
                )
            told = tuple((axis, values[axis].told) for axis in axes if axis in values)
            case = Case(part, variant if len(combined) > 1 else 0, name, told, task)
            cases.append(case)
            books.append(book)
            warnings += [
                replace(each, where=f"{case.label} {name}: {each.where}") for each in task.warnings
            ]
    runs, seed = description.runs or RUNS, description.seed
    plan = Plan(
        tuple(cases), description.scenarios or SCENARIOS, runs, SEED if seed is None else seed
    )
    return plan, books, warnings


def _combinations(
    varied: Mapping[str, Sequence[Value]], *, fitted: bool
) -> Iterator[dict[str, Value]]:
    """Give every combination of the values; the pitch is one of parts that are fitted alone."""
    names = [name for name in varied if fitted or name != PITCH]
    for values in product(*(varied[name] for name in names)):
        yield dict(zip(names, values, strict=True))


def _task(
    source: Book | Mapping[str, Any],
    options: Parameters,
    values: Mapping[str, Value],
    interrupt: Interrupt,
) -> tuple[Task, Book | None]:
    """Settle the task of one case: options beat the description, and that the workbook."""
    said = {PARAMETERS[name].field: value.value for name, value in values.items() if name != PITCH}
    parameters = options.over(Parameters(**said))
    if isinstance(source, Book):
        task = prepare(source, parameters, stop=interrupt.is_asked)
        refuse_infeasible(task, interrupt.is_asked)
        return task, source
    pitch = values[PITCH].value if PITCH in values else fitting.USUAL_PITCH_MM
    _, fitted = fitting.fit_part(_request(source, pitch))
    task = settle(fitted.space, parameters, None, stop=interrupt.is_asked)
    task = task.warned(fitted.notes)
    refuse_infeasible(task, interrupt.is_asked)
    return task, None


def _request(said: Mapping[str, Any], pitch_mm: float) -> fitting.Request:
    """Return what a table ``[[fit]]`` asks for."""

    def wanted(kind: str) -> fitting.Wanted | None:
        if kind not in said:
            return None
        price, faces = said.get(f"{kind}_price"), said.get(f"{kind}_faces", "all-up")
        return fitting.Wanted(said[kind], price, faces, fitting.USUAL_COUNT, 0.0)

    material = MATERIALS[said["material"]] if "material" in said else None
    return fitting.Request(
        said["file"],
        Reading(said.get("up"), None, said.get("units"), said.get("thickness")),
        fitting.Mass(material, mass_g=said.get("mass")),
        wanted(fitting.CUP),
        wanted(fitting.MAGNET),
        None,
        pitch_mm,
        said.get("polygon", "auto"),
        said.get("scale", 0.6),
        0.0,
    )


# --- what came of it ---


def _measured(
    plan: Plan,
    runs: Iterator[tuple[Trial, Record]],
    description: Description,
    interrupt: Interrupt,
) -> Study:
    """Measure the runs case by case, and prove the best grasp of each case."""
    prove = True if description.prove is None else description.prove
    limit = PROVE_SECONDS if description.prove_limit_s is None else description.prove_limit_s
    by_case = {row: list(group) for row, group in groupby(runs, key=lambda run: run[0].case)}
    if prove:
        load_exact_search()
    outcomes = []
    for row, case in enumerate(plan.cases):
        mine = by_case.pop(row, [])
        proof = _proof(case.task, mine, limit, interrupt) if prove else None
        outcomes.append(Measuring(plan, case).case_outcome(mine, proof))
    return Study(plan, tuple(outcomes))


def _proof(
    task: Task, runs: Sequence[tuple[Trial, Record]], limit_s: float, interrupt: Interrupt
) -> Proof:
    """Prove the best grasp of all; the runs' own best are known to begin with."""
    bests = {
        best.genes.tobytes(): best
        for _, record in runs
        if (best := record.best_chromosome) is not None
    }
    known = [*bests.values()]
    if task.benchmark.feasible:
        known.append(task.benchmark.chromosome)
    settings = ExactSettings(time_limit_s=limit_s)
    return solve(task.space, task.rules, settings, known=known, stop=interrupt.is_asked)


def _write_workbooks(
    plan: Plan,
    books: Sequence[Book | None],
    works: Sequence[Work],
    runs: Iterator[tuple[Trial, Record]],
    output: StudyOutput,
    interrupt: Interrupt,
) -> dict[str, str]:
    """Write each run's own workbook where that is wanted; return their names by label.

    A run is repeated for it: its seed gives the same again.
    """
    links: dict[str, str] = {}
    folder = output.workbooks
    if folder is None:
        return links
    folder.mkdir(parents=True, exist_ok=True)
    for trial, _ in runs:
        if interrupt.asked:
            break
        book, case = books[trial.case], plan.cases[trial.case]
        target = folder / f"{trial.label}.xlsx"
        lost = replaced(Output(target, force=output.force))
        began = now()
        user_start = trial.scenario == "user"
        result = run_search(works[trial.case], trial.seed, user_start=user_start)
        settings = replace(case.task.settings, seed=trial.seed, user_start=user_start)
        said = replace(case.task.parameters, seed=trial.seed, user_start=user_start)
        task = replace(case.task, settings=settings, parameters=said).warned(lost)
        if book:
            written = written_book(task, result, book, began)
        else:  # a part that was fitted for the study
            written = full_workbook(task, result, Origin(case.name, "", began, now()))
        save(written.content, target)
        links[trial.label] = _seen_from(output.path.parent, target)
    return links


def _seen_from(folder: Path, target: Path) -> str:
    """Return a link to a file that holds as long as both stay together."""
    try:
        return target.resolve().relative_to(folder.resolve()).as_posix()
    except ValueError:
        return target.resolve().as_posix()
