"""Time to the proved optimum, by footprints: the panel at several pitches.

``python -m benchmarks.exact_scaling 40 30`` measures these pitches (mm); without words, all.
"""

from __future__ import annotations

import sys

from benchmarks.spaces import PANEL_PITCHES_MM, panel, settled
from grasp_xl.search.exact import ExactSettings, solve
from grasp_xl.search.warm import load_exact_search

TIME_LIMIT_S = 120.0


def main() -> None:
    """Print a row a pitch; the search knows no grasp when it begins."""
    pitches = [float(word) for word in sys.argv[1:]] or PANEL_PITCHES_MM
    load_exact_search()
    print("| pitch mm | cups | magnets | status | seconds | nodes | optimum | gap |")
    print("|---:|---:|---:|---|---:|---:|---:|---:|")
    for pitch in pitches:
        task = settled(panel(pitch))
        proof = solve(task.space, task.rules, ExactSettings(time_limit_s=TIME_LIMIT_S))
        cups, magnets = (kind.total for kind in task.space.kinds)
        best = f"{proof.designs[0].value:.6f}" if proof.designs else "-"
        print(
            f"| {pitch:g} | {cups} | {magnets} | {proof.status} | {proof.seconds:.2f} "
            f"| {proof.nodes:,} | {best} | {proof.gap or 0.0:.2%} |",
            flush=True,
        )


if __name__ == "__main__":
    main()
