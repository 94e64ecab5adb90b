"""A picture of a part's faces with their numbers, as SVG: any browser shows it."""

from __future__ import annotations

from xml.sax.saxutils import escape

import shapely
from shapely import MultiPolygon, Polygon

from grasp_xl.fitment.part import CadPart, rings_of

MARGIN = 0.04
"""Around the part, as a part of its larger side; so is the size of the numbers."""

COLOURS = ("#56B4E9", "#E69F00", "#009E73", "#F0E442", "#CC79A7", "#D55E00", "#0072B2")
"""Of faces, one after another, told apart by the colour-blind (Okabe and Ito)."""


def face_picture(part: CadPart) -> str:
    """Draw a part in plan view, x to the right and y up, each face with its number."""
    x_low, y_low, x_high, y_high = part.plan.bounds
    width, height = x_high - x_low, y_high - y_low
    margin = MARGIN * max(width, height)
    view = (x_low - margin, -y_high - margin, width + 2 * margin, height + 2 * margin)
    seen = " ".join(f"{number:.3f}" for number in view)
    lines = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="{seen}">',
        f"<title>{escape(part.name)}</title>",
        '<rect x="-100%" y="-100%" width="300%" height="300%" fill="white"/>',
        f'<g stroke="#202020" stroke-width="{margin / 30:.4f}" fill-rule="evenodd">',
        f'<path fill="#EDEDED" d="{_path(part.plan)}"/>',
    ]
    for number, face in enumerate(part.faces):
        colour = COLOURS[number % len(COLOURS)]
        lines.append(f'<path fill="{colour}" d="{_path(face.outline)}"/>')
    style = 'font-family="Arial, sans-serif" text-anchor="middle" dominant-baseline="central"'
    lines.append(f'</g><g font-size="{margin:.3f}" {style}>')
    for number, face in enumerate(part.faces, 1):
        middle = shapely.maximum_inscribed_circle(face.outline, tolerance=margin / 10).coords[0]
        lines.append(f'<text x="{middle[0]:.3f}" y="{-middle[1]:.3f}">{number}</text>')
    return "\n".join([*lines, "</g></svg>", ""])


def _path(area: Polygon | MultiPolygon) -> str:
    """Return the rings of polygons as SVG draws them: its y-axis looks down."""
    return " ".join(
        "M" + " L".join(f"{x:.3f},{-y:.3f}" for x, y in ring.tolist()) + " Z"
        for ring in rings_of(area)
    )
