"""The page of a study: the same as its workbook, in one file without script and network."""

from __future__ import annotations

import base64
import hashlib
import math
from collections.abc import Iterable, Sequence
from html import escape
from pathlib import Path

import numpy as np

from grasp_xl.space import FloatArray, IntArray
from grasp_xl.study.outcome import FEW_RUNS, CaseOutcome, Ending, Outcome, evenly
from grasp_xl.study.plan import SCENARIOS
from grasp_xl.study.plot import Curve, plot
from grasp_xl.study.summary import WORDS, Look, Study, Value, answers, columns, rows
from grasp_xl.workbook.fitness_sheet import COLUMNS, generation_label
from grasp_xl.workbook.styles import SEQUENCE
from grasp_xl.workbook.table import CRITERIA, DASH

MARK = "grasp_xl study"
"""By which we know a page that we wrote."""

LEFT = ' class="text"'
"""Of cells that hold no numbers."""

STYLE = Path(__file__).parent / "study.css"
MOST_ENDINGS = 30
MOST_LABELS = 8
DIGITS = (4, 2, 2, 4, 2, 3)
"""Decimals of FoS, cost, moment, deviation, structure and divergence, as in tables 4 and 5."""


def study_page(study: Study) -> str:
    """Return the page; it has no times in it, so that the same study gives the same page."""
    style = STYLE.read_text(encoding="utf-8")
    digest = base64.b64encode(hashlib.sha256(style.encode()).digest()).decode()
    policy = f"default-src 'none'; style-src 'sha256-{digest}'; base-uri 'none'"
    body = "".join([_summary(study), *(_case(case) for case in study.cases)])
    return (
        '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        f'<meta http-equiv="Content-Security-Policy" content="{escape(policy)}">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        '<meta name="color-scheme" content="light dark">\n'
        f'<meta name="generator" content="{MARK}">\n<link rel="icon" href="data:,">\n'
        f"<title>Study</title>\n<style>{style}</style>\n</head>\n<body>\n{body}</body>\n</html>\n"
    )


# --- what was run, and what comes of it ---


def _summary(study: Study) -> str:
    plan = study.plan
    starts = " and ".join(
        f"S{1 + SCENARIOS.index(scenario)} {WORDS[scenario]}" for scenario in plan.scenarios
    )
    generations = sorted({case.task.generations for case in plan.cases})
    told = (
        f"{len(plan.cases):,} case{'s' * (len(plan.cases) > 1)}, {plan.runs:,} "
        f"run{'s' * (plan.runs > 1)} each from {starts}, "
        f"{', '.join(f'{each:,}' for each in generations)} generations, seed {plan.seed}."
    )
    if not study.complete:
        told += f" {len(plan) - study.done:,} of {len(plan):,} runs are not done."
    shown = columns(study)
    table = _table(
        [column.title for column in shown],
        (
            [(_shown(value, column.look), column.look == "text") for value, column in zipped]
            for zipped in (zip(values, shown, strict=True) for values in rows(study))
        ),
    )
    questions = "".join(
        f"<h3>{escape(answer.question)}</h3>"
        + "".join(f"<p>{escape(line)}</p>" for line in answer.answer.splitlines())
        for answer in answers(study)
    )
    return f"<h1>Study</h1><p>{escape(told)}</p><section>{table}{questions}</section>"


def _shown(value: Value, look: Look) -> str:
    if value is None:
        return DASH
    if isinstance(value, str):
        return value
    if look == "percent":
        return f"{100 * value:.4g} %"
    return f"{value:,.0f}" if look == "count" else f"{value:,.4f}"


def _table(
    titles: Sequence[str], body: Iterable[Sequence[tuple[str, bool]]], caption: str = ""
) -> str:
    """Return a table; a cell is its text, and whether that is no number."""
    held = list(body)
    texts = [is_text for _, is_text in held[0]] if held else [False] * len(titles)
    head = "".join(
        f'<th scope="col"{LEFT if is_text else ""}>{escape(title)}</th>'
        for title, is_text in zip(titles, texts, strict=True)
    )
    lines = "".join(f"<tr>{''.join(_cell(*cell) for cell in cells)}</tr>" for cells in held)
    named = f"<caption>{escape(caption)}</caption>" if caption else ""
    return (
        f'<div class="box"><table>{named}<thead><tr>{head}</tr></thead>'
        f"<tbody>{lines}</tbody></table></div>"
    )


def _cell(text: str, is_text: bool) -> str:  # noqa: FBT001 (of one pair)
    return f"<td{LEFT if is_text else ''}>{escape(text)}</td>"


# --- a case ---


def _case(case: CaseOutcome) -> str:
    legend, curves = _curves(case)
    plots = "".join(
        plot(
            title,
            unit,
            [Curve(look, generations, values[:, number]) for look, generations, values in curves],
        )
        for number, (_, title, unit, _) in enumerate(CRITERIA)
    )
    return (
        f"<section><h2>{escape(case.case.title)}</h2>{legend}"
        f'<div class="plots">{plots}</div>{_convergence(case)}{_fitness(case)}</section>'
    )


Drawn = tuple[str, IntArray, FloatArray]
"""CSS classes, generations ``(n,)`` and values ``(n, 6)`` of a line of each plot."""


def _curves(case: CaseOutcome) -> tuple[str, list[Drawn]]:
    """Return the legend and the lines: one a run, of many runs thin ones and their medians."""
    entries: list[tuple[str, str]] = []
    curves: list[Drawn] = []
    note = ""
    if len(case.outcomes) <= FEW_RUNS:
        for number, outcome in enumerate(case.outcomes):
            look = f"s{number % len(SEQUENCE)}"
            curves.append((look, *_course(case, outcome)))
            entries.append((outcome.trial.label, look))
    else:
        medians: list[Drawn] = []
        for number, scenario in enumerate(SCENARIOS):
            mine = [each for each in case.outcomes if each.trial.scenario == scenario]
            if not mine:
                continue
            some = evenly(mine)
            curves += [(f"many s{number}", *_course(case, each)) for each in some]
            medians.append((f"median s{number}", case.generations, _median(mine)))
            entries.append(
                (f"{WORDS[scenario].capitalize()}: runs, and their median", f"s{number}")
            )
            if len(some) < len(mine):
                told = f"{len(some):,} of {len(mine):,} runs of a start are drawn"
                note = f'<p class="soft">{told}; the medians are of all.</p>'
        curves += medians
    for level in case.levels:
        look = "proved" if level.proved else "benchmark"
        ends = np.array([1, max(10, case.case.task.generations)])
        curves.append((look, ends, np.tile(level.values, (2, 1))))
        entries.append((level.name, look))
    return _legend(entries) + note, curves


def _course(case: CaseOutcome, outcome: Outcome) -> tuple[IntArray, FloatArray]:
    done = case.generations <= max(1, outcome.done)
    return case.generations[done], outcome.course[done]


def _median(outcomes: Sequence[Outcome]) -> FloatArray:
    """Return the median course, where more than half of the runs have a value."""
    courses = np.array([outcome.course for outcome in outcomes])
    middle = np.median(np.where(np.isnan(courses), np.inf, courses), axis=0)
    return np.where(np.isfinite(middle), middle, np.nan)


def _legend(entries: Iterable[tuple[str, str]]) -> str:
    lines = []
    for name, look in entries:
        line = f'<path class="course {look}" d="M0 4L28 4"/>'
        picture = f'<svg viewBox="0 0 28 8" aria-hidden="true">{line}</svg>'
        lines.append(f"<li>{picture}{escape(name)}</li>")
    return f'<ul class="legend">{"".join(lines)}</ul>'


def _convergence(case: CaseOutcome) -> str:
    endings = case.endings[:MOST_ENDINGS]
    table = _table(
        ["Grasp", "Image", "Runs", "Divergence", "Optimum", "Cups", "Magnets", "Which runs"],
        (_ending(case, each) for each in endings),
    )
    left = len(case.endings) - len(endings)
    more = f'<p class="soft">{left:,} more grasps are not listed here.</p>' if left else ""
    return f"<h3>Convergence: {case.convergence}</h3>{table}{more}"


def _ending(case: CaseOutcome, ending: Ending) -> list[tuple[str, bool]]:
    optimal = ("yes" if ending.optimal else "no") if case.optimum is not None else DASH
    indices = (" ".join(map(str, each)) or DASH for each in ending.grasp.chromosome.active)
    return [
        (str(ending.number), False),
        (ending.relation or DASH, True),
        (f"{len(ending.outcomes):,}", False),
        (f"{ending.grasp.divergence:,.3f}", False),
        (optimal, True),
        *((each, True) for each in indices),
        (ending.told(MOST_LABELS), True),
    ]


def _fitness(case: CaseOutcome) -> str:
    shown, note = list(case.outcomes), ""
    if len(shown) > FEW_RUNS:
        shown = [each for scenario in SCENARIOS for each in _typical(case, scenario)]
        note = (
            '<p class="soft">The best, the median and the worst run of each start; the workbook '
            "has all.</p>"
        )
    blocks = "".join(_block(case, outcome) for outcome in shown)
    return f'<h3>Fitness tables</h3>{note}<div class="blocks">{blocks}</div>'


def _typical(case: CaseOutcome, scenario: str) -> list[Outcome]:
    mine = [each for each in case.outcomes if each.trial.scenario == scenario]
    mine.sort(key=lambda outcome: outcome.value)
    rows_ = sorted({0, (len(mine) - 1) // 2, len(mine) - 1}) if mine else []
    return [mine[row] for row in rows_]


def _block(case: CaseOutcome, outcome: Outcome) -> str:
    trial = outcome.trial
    lines: list[tuple[str, Sequence[float]]] = [(case.benchmark.name, case.benchmark.values)]
    lines += [
        (generation_label(generation), values)
        for generation, values in zip(
            case.reported.tolist(), outcome.reported.tolist(), strict=True
        )
    ]
    body = (
        [
            (label, True),
            *(
                (DASH if math.isnan(value) else f"{value:,.{digits}f}", False)
                for value, digits in zip(values, DIGITS, strict=True)
            ),
        ]
        for label, values in lines
    )
    title = f"{trial.label}: {WORDS[trial.scenario]}, run {trial.number}, seed {trial.seed}"
    return _table(COLUMNS, body, title)
