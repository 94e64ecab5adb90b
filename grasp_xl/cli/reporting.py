"""Results as JSON objects with fixed keys, for scripts."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from grasp_xl.errors import GraspError, InfeasibleError, InputError, Problem
from grasp_xl.rules import TERMS, Rules

if TYPE_CHECKING:
    from grasp_xl.commands.check import Checked
    from grasp_xl.commands.elements import Listed
    from grasp_xl.commands.excel import Buttons
    from grasp_xl.commands.front import FoundFront
    from grasp_xl.commands.run import Ran
    from grasp_xl.commands.solve import Solved
    from grasp_xl.commands.view import Viewed
    from grasp_xl.grasp import Grasp
    from grasp_xl.search.proven_floors import ProvenFloors
    from grasp_xl.task import Task

Json = dict[str, Any]


def print_json(told: Json) -> None:
    """Print the one JSON object of a command."""
    print(json.dumps(told, indent=2, allow_nan=False), flush=True)  # noqa: T201 (the product)


def grasp_json(grasp: Grasp, rules: Rules) -> Json:
    """Return all numbers of a grasp."""
    normalised = dict(zip(TERMS, grasp.normalised, strict=True))
    suction, magnets = grasp.chromosome.active
    return {
        "suction": list(suction),
        "magnets": list(magnets),
        "genes": grasp.chromosome.rows(),
        "force_n": grasp.force_n,
        "weight_n": grasp.weight_n,
        "fos": grasp.fos,
        **grasp.terms._asdict(),
        "divergence": grasp.divergence,
        "clearance": grasp.clearance_mm,
        "centre_of_force": grasp.centre_of_force_mm.tolist(),
        "normalised": {"fos": grasp.normalised_fos, **normalised},
        "feasible": grasp.feasible,
        "meets_all_goals": grasp.meets_all_goals,
        "criterion": rules.criterion.name,
        "value": grasp.value,
    }


def view_json(viewed: Viewed, output: str) -> Json:
    """Return what is shown of a workbook: its designs, and the shown one with its bill."""
    scene = viewed.scene
    return {
        "design": scene.shown.key,
        "grasp": grasp_json(scene.grasp(scene.shown), scene.task.rules),
        "designs": [
            {"design": each.key, "group": each.group, "name": each.name} for each in scene.designs
        ],
        "bill": [{**asdict(line), "price": line.price} for line in viewed.bill],
        "output": output,
    }


def goals_json(rules: Rules) -> Json:
    """Return the goals; a dropped one is None."""
    base = rules.goals.base._asdict()
    shown = {term: None if term in rules.goals.dropped else goal for term, goal in base.items()}
    return {"fos": rules.requirements.fos, **shown}


def run_json(ran: Ran, output: str) -> Json:
    """Return the outcome of a genetic run, and of the proof after it."""
    result = ran.result
    rules = result.rules
    return {
        "best": grasp_json(result.best, rules) if result.best else None,
        "proved": solve_json(ran.solved) if ran.solved else None,
        "benchmark": grasp_json(result.benchmark, rules),
        "goals": goals_json(rules),
        "seconds": ran.seconds,
        "generations": result.state.generation,
        "evaluations": result.state.evaluations,
        "seed": result.settings.seed,
        "stop_reason": result.stop_reason,
        "output": output,
    }


def solve_json(solved: Solved) -> Json:
    """Return the outcome of an exact search, and why there is no grasp where there is none."""
    proof, rules = solved.proof, solved.task.rules
    return {
        "status": proof.status,
        "bound": proof.bound if math.isfinite(proof.bound) else None,
        "gap": proof.gap,
        "designs": [grasp_json(grasp, rules) for grasp in proof.designs],
        **_floors_json(solved.floors),
        "goals": goals_json(rules),
        "seconds": solved.seconds,
        "output": str(solved.output) if solved.output else None,
        **(error_json(solved.obstacle) if solved.obstacle else {}),
    }


def _floors_json(floors: ProvenFloors | None) -> Json:
    if floors is None:
        return {"floors": None, "floors_attained": None}
    attained = {term: term in floors.attained for term in TERMS}
    return {"floors": floors.least._asdict(), "floors_attained": attained}


def front_json(found: FoundFront, output: str | None) -> Json:
    """Return the trade-off front: its designs, and how much of it is proved."""
    front, rules = found.front, found.task.rules
    return {
        "complete": front.complete,
        "interrupted": found.interrupted,
        "weighted_sums": front.sums,
        "proved_sums": front.proved_sums,
        "designs": [
            {
                **grasp_json(design.grasp, rules),
                "proved": design.proved,
                "weights": design.weights._asdict() if design.weights else None,
            }
            for design in front.designs
        ],
        "goals": goals_json(rules),
        "seconds": found.seconds,
        "output": output,
    }


def failed_solve_json(error: InfeasibleError) -> Json:
    """Return what ``solve`` says where no grasp can serve as the benchmark."""
    return {
        "status": "infeasible" if error.proved else "unknown",
        "designs": [],
        **dict.fromkeys(("bound", "gap", "goals", "seconds", "output")),
        **_floors_json(None),
        **error_json(error),
    }


def new_json(task: Task, output: str) -> Json:
    """Return what ``new`` made."""
    return {
        "benchmark": grasp_json(task.benchmark, task.rules),
        "goals": goals_json(task.rules),
        "warnings": problems_json(task.warnings),
        "output": output,
    }


def excel_json(found: Buttons) -> Json:
    """Return how the buttons of a workbook find Python."""
    return {"settings": found.settings, "setting": found.name, "works": found.works}


def elements_json(listed: Listed) -> Json:
    """Return the elements that were asked for; null where a value is not known."""
    return {
        "elements": [asdict(element) for element in listed.elements],
        "catalogue_size": len(listed.catalogue.elements),
        "replaced": list(listed.catalogue.replaced),
        "warnings": problems_json(listed.catalogue.warnings),
    }


def check_json(checked: Checked) -> Json:
    """Return what ``check`` found in a readable file."""
    cups, magnets = checked.space.kinds
    error = checked.obstacle
    return {
        "ok": error is None,
        **(error_json(error) if error else {}),
        "problems": problems_json([_as_problem(error)] if error else []),
        "warnings": problems_json(checked.warnings),
        "cups": cups.total,
        "magnets": magnets.total,
        "search_space": checked.search_space,
        "weight_n": checked.space.part.weight_n,
        "max_fos": checked.max_fos,
        "floors": checked.floors._asdict() if checked.floors else None,
    }


def _as_problem(error: InfeasibleError) -> Problem:
    return Problem(error.where, error.message, "a grasp that meets all constraints", error.hint)


def failed_check_json(error: InputError) -> Json:
    """Return what ``check`` found in a file that cannot be used."""
    unknown = ("cups", "magnets", "search_space", "weight_n", "max_fos", "floors")
    return {
        "ok": False,
        **error_json(error),
        "problems": problems_json(error.problems),
        "warnings": [],
        **dict.fromkeys(unknown),
    }


def problems_json(problems: Sequence[Problem]) -> list[Json]:
    """Return problems or warnings."""
    return [
        {"where": p.where, "found": p.found, "expected": p.expected, "hint": p.hint}
        for p in problems
    ]


def error_json(error: GraspError) -> Json:
    """Return an error."""
    return {"error": error.message, "where": error.where, "hint": error.hint}
