"""A picture of a part's faces with their numbers, as SVG: any browser shows it."""

from __future__ import annotations

import math
from xml.sax.saxutils import escape

import shapely
from shapely import MultiPolygon, Polygon

from grasp_xl.fitment.part import CadPart, rings_of

MARGIN = 0.04
"""Around the part, as a part of its larger side; so is the size of the numbers."""

LINES = 10
"""Lines of the grid along the larger side, about."""

FONT = 'font-family="Arial, sans-serif" text-anchor="middle" dominant-baseline="central"'

MARK = "Faces of a part, drawn by grasp_xl"
"""By which it is known that a picture is ours."""

COLOURS = ("#56B4E9", "#E69F00", "#009E73", "#F0E442", "#CC79A7", "#D55E00", "#0072B2")
"""Of faces, one after another, told apart by the colour-blind (Okabe and Ito)."""


def face_picture(part: CadPart) -> str:
    """Draw a part in plan view, x to the right and y up, each face with its number."""
    x_low, y_low, x_high, y_high = part.plan.bounds
    width, height = x_high - x_low, y_high - y_low
    margin = MARGIN * max(width, height)
    view = (x_low - 3 * margin, -y_high - margin, width + 4 * margin, height + 3 * margin)
    seen = " ".join(f"{number:.3f}" for number in view)
    lines = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="{seen}">',
        f"<title>{escape(part.name)}</title>",
        f"<desc>{MARK}</desc>",
        '<rect x="-100%" y="-100%" width="300%" height="300%" fill="white"/>',
        f'<g stroke="#202020" stroke-width="{margin / 30:.4f}" fill-rule="evenodd">',
        f'<path fill="#EDEDED" d="{_path(part.plan)}"/>',
    ]
    for number, face in enumerate(part.faces):
        colour = COLOURS[number % len(COLOURS)]
        lines.append(f'<path fill="{colour}" d="{_path(face.outline)}"/>')
    lines.append("</g>")
    lines += _axes(part.plan.bounds, margin)
    lines.append(f"<g {FONT}>")
    for number, face in enumerate(part.faces, 1):
        widest = shapely.maximum_inscribed_circle(face.outline, tolerance=margin / 10)
        (x, y), _ = widest.coords
        size = min(margin, max(margin / 4, widest.length))
        lines.append(f'<text x="{x:.3f}" y="{-y:.3f}" font-size="{size:.3f}">{number}</text>')
    return "\n".join([*lines, "</g></svg>", ""])


def _axes(bounds: tuple[float, float, float, float], margin: float) -> list[str]:
    """Return lines and numbers (mm) below and left of a part, to read the corners of a box off."""
    x_low, y_low, x_high, y_high = bounds
    step = _step(max(x_high - x_low, y_high - y_low) / LINES)
    width, size = margin / 60, margin / 2
    lines = [f'<g font-size="{size:.3f}" fill="#505050" {FONT}>']
    grid = f'stroke="#505050" stroke-opacity="0.35" stroke-width="{width:.4f}"'
    for x in _between(x_low, x_high, step):
        lines.append(f'<path {grid} d="M{x:g},{-y_high:.3f} V{-y_low + size:.3f}"/>')
        lines.append(f'<text x="{x:g}" y="{-y_low + 1.6 * size:.3f}">{x:g}</text>')
    for y in _between(y_low, y_high, step):
        lines.append(f'<path {grid} d="M{x_high:.3f},{-y:g} H{x_low - size / 2:.3f}"/>')
        place = f'x="{x_low - size:.3f}" y="{-y:g}" style="text-anchor:end"'
        lines.append(f"<text {place}>{y:g}</text>")
    return [*lines, "</g>"]


def _step(least: float) -> float:
    """Return the least of 1, 2, 5, 10, 20, ... that is not below a number.

    Examples
    --------
    >>> [_step(least) for least in (0.03, 1, 3, 60)]
    [0.05, 1.0, 5.0, 100.0]
    """
    power = 10.0 ** math.floor(math.log10(least))
    return next(power * factor for factor in (1, 2, 5, 10) if power * factor >= least * 0.999999)


def _between(low: float, high: float, step: float) -> list[float]:
    return [step * number for number in range(math.ceil(low / step), math.floor(high / step) + 1)]


def _path(area: Polygon | MultiPolygon) -> str:
    """Return the rings of polygons as SVG draws them: its y-axis looks down."""
    return " ".join(
        "M" + " L".join(f"{x:.3f},{-y:.3f}" for x, y in ring.tolist()) + " Z"
        for ring in rings_of(area)
    )
