"""The solids of the four sample parts.

A part is sheet metal of one thickness: a plate with pressed fields, flanges and bends.  x and y lie
in the grasp plane, grippers come from above (+z); lengths are in mm.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import shapely
from figures import Corner, Figure, Place, disc, in_four_quadrants, mirrored, rectangle, rounded
from shapely import Polygon, box
from shapes import Shape, common, cut, fuse, one_solid, prism

FAR = 1000.0
"""Holes are drilled from here on one side of a part to here on the other (mm)."""

DOOR_SHEET_MM = 1.6
PANEL_SHEET_MM = 3.0
COVER_SHEET_MM = 2.5


def bracket() -> Shape:
    """C-shaped bracket, 400 x 220 mm, in the size of the thesis's P1 (section 6.4.1).

    A thick plate, bent down at both ends and in again at the feet, with ribs below its long edges.
    Its top face (360 x 220 mm, z = 100) is what four pockets, pressed 6 mm down, and the protrusion
    in the middle, 20 mm down into the C, leave of it.
    """
    plate = prism(rectangle((-180, 180), (-110, 110)), "z", 60, 100)
    ribs = [prism(rectangle((-180, 180), y), "z", 70, 95) for y in ((-110, -96), (96, 110))]
    pressed = [(pocket, 94.0) for pocket in in_four_quadrants(bracket_pocket())]
    pressed.append((bracket_protrusion(), 80.0))
    bumps = [prism(figure, "z", z - 10, 95, wider=10) for figure, z in pressed]
    bumps = [common(bump, plate) for bump in bumps]
    whole = fuse([prism(bracket_profile(), "y", -110, 110), *ribs, *bumps])
    holes = [disc((0, 0), 70), *in_four_quadrants(disc((145, 75), 30))]
    bolts = in_four_quadrants(disc((140, 70), 18))
    cuts = [prism(figure, "z", z, FAR) for figure, z in pressed]
    cuts += [prism(hole, "z", 50, FAR) for hole in holes]
    cuts += [prism(hole, "z", -FAR, 50) for hole in bolts]
    return one_solid(cut(whole, cuts))


def bracket_profile() -> Figure:
    """C of the plate in x-z: top, bends, legs and feet of 10 mm."""
    inside = (Corner(190, 90, 10), Corner(190, 10, 10), Corner(111.5, 10))
    outside = (Corner(111.5, 0), Corner(200, 0, 20), Corner(200, 100, 20))
    right = (*inside, *outside)
    return (*right, *mirrored(right))


def bracket_protrusion() -> Figure:
    """Outline of the protrusion: two lands bite into it, in the middle of the long edges."""
    quarter = (Corner(13, -89.6, 4), Corner(13, -102.5, 8), Corner(69, -102.5, 8))
    right = (*quarter, *mirrored(quarter, 1, -1))
    return (*right, *mirrored(right))


def bracket_pocket() -> Figure:
    """Pocket around a quarter of the right-hand pad, up to the bend line x = 180.

    It leaves a pad for 14 cups.  The slanting sides are drawn between those cups and the next grid
    points, which are only 0.08 mm farther from the outermost cups than a cup's radius.
    """
    beside_pad = [(105.3, 20.9), (115.3, 40.3), (134.8, 50), (142.9, 50), (162.4, 40.3)]
    return (
        Corner(76, 101.5, 4),
        Corner(76, 3.5, 4),
        Corner(105.3, 3.5, 4),
        *(Corner(x, y) for x, y in beside_pad),
        Corner(174.4, 17, 4),
        Corner(180, 17),
        Corner(180, 101.5),
    )


def door_frame() -> Shape:
    """Inner frame of a car's door, 1100 x 800 mm, in the size of the thesis's P2 (section 6.5.1).

    Rims, a belt bar, a lower bar, two ribs and a lock plate; nine pressed fields on them, at four
    heights, are gripped.  A flange of 30 mm hangs from the outline.
    """
    corners = [(550.0, 400.0), (-90.0, 400.0), (-550.0, 60.0), (-550.0, -400.0), (550.0, -400.0)]
    holes = [disc((432, 13), 36), *(disc((-512, y), 21) for y in (10, -60, -270, -340))]
    return pressed_sheet(
        rounded(corners, 30),
        DOOR_SHEET_MM,
        fields=door_fields(),
        holes=[*holes, *door_openings(Polygon(corners))],
        flange=30,
    )


def door_openings(outline: Polygon) -> list[Figure]:
    """Window above the belt bar, service openings below it, slots along the bottom."""
    within_rims = outline.buffer(-75, join_style="mitre")
    areas = [
        within_rims.intersection(box(-550, 195, 550, 325)),
        within_rims.intersection(box(-550, -155, -275, 85)),
        box(-165, -155, 210, 85),
        *(box(x, -335, x + width, -265) for x, width in ((-475, 200), (-165, 375), (320, 155))),
    ]
    return [rounded(corners_of(area), 25) for area in areas]


def corners_of(area: Polygon) -> list[Place]:
    """Return the corners of an area without holes, counter-clockwise (mm)."""
    ring = shapely.orient_polygons(area.simplify(1e-6)).exterior
    return [(x, y) for x, y in ring.coords[:-1]]


def door_fields() -> list[tuple[Figure, float]]:
    """Nine pressed fields: on the bars and ribs, where they cross, and on the lock plate."""
    belt, rib, lower, lock = 24.0, 12.0, 18.0, 8.0
    fields = [
        (-263, -177, 88, 192, belt),
        (-82, 128, 109, 171, belt),
        (222, 308, 88, 192, belt),
        (-251, -189, -99, 29, rib),
        (234, 296, -99, 29, rib),
        (-263, -177, -262, -158, lower),
        (-82, 128, -241, -179, lower),
        (222, 308, -262, -158, lower),
        (348, 456, -108, 48, lock),
    ]
    return [(rectangle((x0, x1), (y0, y1), 12), z) for x0, x1, y0, y1, z in fields]


def panel() -> Shape:
    """Heavy floor panel, 1400 x 900 mm: a rim with a flange, a raised field with four windows."""
    windows = [rectangle((70, 440), (30, 225), 40), rectangle((90, 440), (-225, -50), 40)]
    holes = [*windows, *map(mirrored, windows), *in_four_quadrants(disc((610, 370), 50))]
    field = rectangle((-524, 524), (-310, 310), 60)
    outline = rectangle((-700, 700), (-450, 450), 80)
    return pressed_sheet(outline, PANEL_SHEET_MM, fields=[(field, 15)], holes=holes, flange=25)


def tunnel_cover() -> Shape:
    """U-shaped tunnel cover, 900 x 560 mm: its polygon is not star-shaped about its centroid.

    Two bent lugs in the notch are bolted down; cables go into the tunnel between them.
    """
    right = [(450.0, -280.0), (450.0, 280.0), (190.0, 280.0), (190.0, 40.0)]
    outline = rounded([*right, *((-x, y) for x, y in right[::-1])], 30)
    tunnel = rectangle((-130, 130), (-250, 10), 30)
    holes = [disc((0, -90), 110), *in_four_quadrants(disc((380, 215), 36))]
    sheet = pressed_sheet(outline, COVER_SHEET_MM, fields=[(tunnel, 60)], holes=holes)
    lugs = [prism(cover_lug(), "x", x - 15, x + 15) for x in (-130, 130)]
    cables = [prism(disc((x, 24), 36), "y", 0, 20) for x in (-75, -25, 25, 75)]
    return one_solid(cut(fuse([sheet, *lugs]), cables))


def cover_lug() -> Figure:
    """Lug in y-z: from the rim at the notch down, and out again to a foot at z = -40."""
    edge, foot, end, sheet, bend = 40.0, -40.0, 75.0, COVER_SHEET_MM, 3.0
    inner, outer = edge + bend, edge + bend + sheet
    below = [Corner(edge - 1, -sheet), Corner(inner, -sheet, bend)]
    below += [Corner(inner, foot - sheet, bend + sheet), Corner(end, foot - sheet)]
    above = [Corner(end, foot), Corner(outer, foot, bend), Corner(outer, 0, bend + sheet)]
    return (*below, *above, Corner(edge - 1, 0))


def pressed_sheet(
    outline: Figure,
    sheet: float,
    *,
    fields: Sequence[tuple[Figure, float]],
    holes: Iterable[Figure],
    flange: float = 0.0,
) -> Shape:
    """Sheet with its top at z = 0, with holes, fields pressed up, and a flange all around (mm).

    Parameters
    ----------
    outline : Figure
    sheet : float
        Thickness.
    fields : sequence of (Figure, float)
        Outside of each field, and the height of its top.
    holes : iterable of Figure
    flange : float
        How far it hangs below the sheet.
    """
    whole = fuse(
        [
            prism(outline, "z", -sheet - flange, 0),
            *(prism(field, "z", -sheet, z) for field, z in fields),
        ]
    )
    cuts = [prism(field, "z", -FAR, z - sheet, wider=-sheet) for field, z in fields]
    cuts += [prism(hole, "z", -FAR, FAR) for hole in holes]
    if flange:
        cuts.append(prism(outline, "z", -FAR, -sheet, wider=-sheet))
    return one_solid(cut(whole, cuts))
