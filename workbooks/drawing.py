"""Draw the sample drawing: a tray's flat blank, with rounded corners, holes and two slots.

Run ``python workbooks/drawing.py`` to write ``tray.dxf`` anew beside this file, or name a folder.
"""

from __future__ import annotations

import sys
from pathlib import Path

import ezdxf
from ezdxf.enums import TextEntityAlignment

WIDTH_MM, HEIGHT_MM, CORNER_MM = 420.0, 300.0, 25.0
HOLES_MM = [(x, y, 6.0) for x in (-185.0, 185.0) for y in (-125.0, 125.0)]
SLOT_MM = 80.0
BULGE = 2**0.5 - 1
"""Of a quarter circle in a polyline."""


def draw() -> ezdxf.document.Drawing:
    """Return the drawing, in mm."""
    drawing = ezdxf.new("R2010", units=ezdxf.units.MM)
    space = drawing.modelspace()
    x, y, r = WIDTH_MM / 2, HEIGHT_MM / 2, CORNER_MM
    corners = [
        (x - r, -y),
        (x, r - y),
        (x, y - r),
        (x - r, y),
        (r - x, y),
        (-x, y - r),
        (-x, r - y),
    ]
    corners.append((r - x, -y))
    points = [(*corner, BULGE if number % 2 == 0 else 0) for number, corner in enumerate(corners)]
    space.add_lwpolyline(points, format="xyb", close=True)
    for x_hole, y_hole, radius in HOLES_MM:
        space.add_circle((x_hole, y_hole), radius)
    space.add_circle((0, 0), 40)
    for side in (-1, 1):
        ends = [(-SLOT_MM / 2, 90 * side - 8, 0), (SLOT_MM / 2, 90 * side - 8, 1)]
        ends += [(SLOT_MM / 2, 90 * side + 8, 0), (-SLOT_MM / 2, 90 * side + 8, 1)]
        space.add_lwpolyline(ends, format="xyb", close=True)
    text = space.add_text("TRAY, 2 mm", height=10)
    text.set_placement((-100, 0), align=TextEntityAlignment.MIDDLE_CENTER)
    return drawing


def main(folder: Path) -> None:
    """Write the drawing."""
    ezdxf.options.write_fixed_meta_data_for_testing = True  # no time stamps, the same names
    path = folder / "tray.dxf"
    draw().saveas(path)
    print(path.name)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parent)
