"""Pictures of a criterion against the generation, as SVG with a logarithmic axis."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from html import escape

import numpy as np

from grasp_xl.space import FloatArray, IntArray

WIDTH, HEIGHT = 460, 260
LEFT, RIGHT, TOP, BOTTOM = 64, 28, 28, 40
"""Margins of the plot's field (pixels); right, half of the label 1,000,000 has room."""
TICKS = 5
"""About how many values the vertical axis names."""
ROOM = 0.05
"""Share of the values' range that stays free above and below them."""


Corner = tuple[bool, float, float]
"""Whether a line begins there, generation, value."""


@dataclass(frozen=True, eq=False, slots=True)
class Curve:
    """A line of a plot.

    Parameters
    ----------
    look : str
        CSS classes.
    generations, values : IntArray, FloatArray
        ``(n,)`` each; NaN where there is no value.
    """

    look: str
    generations: IntArray
    values: FloatArray


def plot(title: str, unit: str, curves: Sequence[Curve]) -> str:
    """Return a picture of courses that stay level until the next value."""
    held = np.concatenate([curve.values[np.isfinite(curve.values)] for curve in curves])
    last = max(10.0, max((float(c.generations[-1]) for c in curves), default=10.0))
    low, high = (float(held.min()), float(held.max())) if len(held) else (0.0, 1.0)
    spare = (high - low) * ROOM or abs(high) * ROOM or 1.0
    low, high = low - spare, high + spare
    decades = math.log10(last)

    def x(generation: float) -> float:
        return LEFT + (WIDTH - LEFT - RIGHT) * math.log10(generation) / decades

    def y(value: float) -> float:
        return HEIGHT - BOTTOM - (HEIGHT - TOP - BOTTOM) * (value - low) / (high - low)

    told = f"{escape(title)} of the fittest against the generation number"
    parts = [
        f'<svg viewBox="0 0 {WIDTH} {HEIGHT}" role="img"><title>{told}</title>',
        f'<text class="title" x="{LEFT}" y="16">{escape(title)} vs Generation Number</text>',
    ]
    for power in range(math.floor(decades) + 1):
        at = x(10.0**power)
        parts.append(_line("grid", at, TOP, at, HEIGHT - BOTTOM))
        parts.append(_text(at, HEIGHT - BOTTOM + 14, "middle", f"{10**power:,}"))
    for value in ticks(low, high):
        at = y(value)
        parts.append(_line("grid", LEFT, at, WIDTH - RIGHT, at))
        parts.append(_text(LEFT - 6, at + 4, "end", f"{value:,.10g}"))
    middle = LEFT + (WIDTH - LEFT - RIGHT) / 2
    parts.append(_text(middle, HEIGHT - 8, "middle", "Generation"))
    field = TOP + (HEIGHT - TOP - BOTTOM) / 2
    parts.append(
        f'<text x="12" y="{field:g}" text-anchor="middle" '
        f'transform="rotate(-90 12 {field:g})">{escape(unit)}</text>'
    )
    for curve in curves:
        steps = _steps(curve)
        path = "".join(
            f"{'M' if begins else 'L'}{x(generation):.1f} {y(value):.1f}"
            for begins, generation, value in steps
        )
        parts.append(f'<path class="course {curve.look}" d="{path}"/>')
    return "".join(parts) + "</svg>"


def _steps(curve: Curve) -> list[Corner]:
    """Return the corners of a course."""
    corners: list[Corner] = []
    before = math.nan
    for generation, value in zip(curve.generations.tolist(), curve.values.tolist(), strict=True):
        if not math.isfinite(value):
            before = math.nan
            continue
        if math.isnan(before):
            corners.append((True, generation, value))
        else:
            if value != before:
                corners.append((False, generation, before))
            corners.append((False, generation, value))
        before = value
    return _without_middles(corners)


def _without_middles(
    corners: Sequence[tuple[bool, float, float]],
) -> list[tuple[bool, float, float]]:
    """Leave out points in the middle of a level line."""
    kept: list[Corner] = []
    for number, corner in enumerate(corners):
        behind = corners[number + 1] if number + 1 < len(corners) else None
        level = (
            kept
            and behind
            and not corner[0]
            and not behind[0]
            and kept[-1][2] == corner[2] == behind[2]
        )
        if not level:
            kept.append(corner)
    return kept


def ticks(low: float, high: float) -> list[float]:
    """Return round numbers from low to high.

    Examples
    --------
    >>> ticks(1.3, 4.2), ticks(0.0, 1000.0)
    ([2.0, 3.0, 4.0], [0.0, 200.0, 400.0, 600.0, 800.0, 1000.0])
    """
    rough = (high - low) / TICKS
    power = 10.0 ** math.floor(math.log10(rough))
    step = next(power * each for each in (1, 2, 5, 10) if power * each >= rough)
    first, last = math.ceil(low / step), math.floor(high / step)
    return [float(f"{number * step:.10g}") for number in range(first, last + 1)]


def _line(look: str, x0: float, y0: float, x1: float, y1: float) -> str:
    return f'<line class="{look}" x1="{x0:.1f}" y1="{y0:.1f}" x2="{x1:.1f}" y2="{y1:.1f}"/>'


def _text(x: float, y: float, anchor: str, text: str) -> str:
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}">{escape(text)}</text>'
