"""Areas that touch are one: seams and cracks between them are no edges."""

from __future__ import annotations

from typing import Any

import shapely
from shapely import MultiPolygon, Polygon

SEAM_MM = 1e-3
"""Half the width of a crack that is closed."""

MITRE = 10.0
"""How far a sharp corner may be drawn out, in half widths of a crack, before it is cut off."""


def joined(areas: Any) -> Polygon | MultiPolygon:  # noqa: ANN401 (any sequence of areas)
    """Join areas, and close the cracks between them."""
    whole = shapely.union_all(areas)
    wider = whole.buffer(SEAM_MM, join_style="mitre", mitre_limit=MITRE)
    return wider.buffer(-SEAM_MM, join_style="mitre", mitre_limit=MITRE)
