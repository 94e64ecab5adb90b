"""Words that a designer may say to ``fit``: quick to import, as the command line needs them."""

from __future__ import annotations

ALL_UP, TOP, LARGEST = "all-up", "top", "largest"
FACES = f"{ALL_UP}, {TOP}, {LARGEST}, numbers of faces as 1,3, or a box X0,Y0,X1,Y1 in mm"
"""Which faces carry elements."""

AUTO, HULL, RECTANGLE = "auto", "hull", "rectangle"
POLYGONS = (AUTO, HULL, RECTANGLE)
"""How the polygon is made that stands for the part."""

AXES = ("+x", "-x", "+y", "-y", "+z", "-z")
USUAL_UP = "+z"
"""Which axis of a file looks up, and which unless one is named."""

UNITS = {"mm": 1.0, "cm": 10.0, "m": 1000.0, "in": 25.4, "ft": 304.8}
"""Units of length that a drawing can have, in mm."""
