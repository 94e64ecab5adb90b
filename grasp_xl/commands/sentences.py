"""What a command found, in sentences, for the terminal and for Excel alike."""

from __future__ import annotations

from decimal import Decimal

from grasp_xl.commands.check import Checked
from grasp_xl.commands.run import Ran
from grasp_xl.commands.solve import Solved
from grasp_xl.rounding import TOLD_DIGITS, percent, rounded_down
from grasp_xl.rules import SLACK, UNITS
from grasp_xl.search.result import Result


def check(checked: Checked) -> list[str]:
    """Say what an option space has, and what any grasp of it can reach."""
    space, number = checked.space, checked.search_space
    told = [
        f"{kind.name}: {kind.total} places, {kind.count_min} to {kind.most} a grasp, "
        f"{kind.force_n:g} N, ${kind.price:g} each"
        for kind in space.kinds
    ]
    told += [
        f"part: {space.part.mass_g:,.6g} g, {space.part.weight_n:,.6g} N",
        f"different grasps: {Decimal(number):.4e}" if number else "different grasps: 0",
        f"FoS of the most elements: {rounded_down(checked.max_fos, TOLD_DIGITS):g}",
    ]
    floors = checked.floors._asdict() if checked.floors else {}
    told += [f"no {term} below {floor:,.6g} {UNITS[term]}" for term, floor in floors.items()]
    return told if checked.obstacle else [*told, "No problem found."]


def run(ran: Ran) -> list[str]:
    """Say what a genetic run found, what was proved after it, and how long it took."""
    result, state, told = ran.result, ran.result.state, []
    if result.best:
        told.append(
            f"Best {ran.task.rules.criterion.name} {result.best.value:.6g}, "
            f"found at generation {state.improved_at:,}."
        )
    elif state.generation:
        told.append("No grasp met FoS and clearance yet: run more generations, or another seed.")
    if ran.solved:
        told.append(f"{proof(ran.solved)} {_compared(result, ran.solved)}".strip())
    told.append(
        f"{state.generation:,} generations in {result.seconds:.2f} s "
        f"({ran.seconds:.2f} s in all), stopped by {result.stop_reason}."
    )
    return told


def proof(solved: Solved) -> str:
    """Say in a sentence what an exact search proved, and why it stopped if it did."""
    proof, settings = solved.proof, solved.settings
    criterion = solved.task.rules.criterion
    unit = f" {UNITS[criterion.single]}" if criterion.single else ""
    whose = f" of {settings.min_elements} or more elements" if settings.min_elements > 1 else ""
    whose += " that meets all goals" if settings.meet_goals else ""
    none = f"no grasp{whose} has a {criterion.name} below {proof.bound:,.6g}{unit}"
    if proof.status == "optimal":
        these = len(proof.designs)
        ranked = f"these are the {these} best grasps, and " if these > 1 else ""
        if these < settings.top:
            ranked = f"there are only {these} different grasps, and "
        return f"Proved: {ranked}{none} ({proof.seconds:.2f} s)."
    ended = f"{solved.ended} ({proof.seconds:.2f} s)"
    if proof.gap is None:
        return f"No grasp found yet; {none}; {ended}."
    best = proof.designs[0].value
    if proof.is_best_proved:
        return f"Proved: {none}, so the first is the best of all; the others are not: {ended}."
    return f"Best found {best:,.6g}{unit}; {none} (gap {percent(proof.gap)}); {ended}."


def _compared(result: Result, solved: Solved) -> str:
    """Say how far the best of a genetic run is from the best grasp that is known."""
    best, known = result.best, solved.shown.grasp
    if best is None or known is None:
        return "The genetic run found none." if known else ""
    if best.value <= known.value + SLACK * abs(known.value):
        return "The genetic run found a grasp as good."
    above = f", {percent(best.value / known.value - 1)}" if known.value > 0 else ""
    return f"The best of the genetic run lies {best.value - known.value:,.6g}{above} above it."
