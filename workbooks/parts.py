"""Plain geometry of our four sample parts, and the option space that each of them gives.

Two are in the sizes of the thesis's test cases P1 and P2 (sections 6.4.1 and 6.5.1).  A part is a
few pieces of sheet metal: pressed fields, walls and bends, all of one thickness.  The centroid is
that of the pieces' middle surfaces, drawn for the nominal sheet (``..._SHEET_MM``); the thickness
that gives the stated mass is within 0.01 mm of it.  The footprints follow from the gripped faces.

Units: mm, g, N, $.  The grasp plane is X-Y, grippers come from above (+z).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from shapely import LineString, MultiPolygon, Point, Polygon, affinity, box

from grasp_xl.space import ElementKind, FloatArray, OptionSpace, Part, frozen

Place = tuple[float, float]
"""A plan-view point (mm)."""

STEEL_G_MM3 = 7.85e-3
"""Density of steel (g/mm^3)."""

CUP_DIAMETER_MM = 46.0
MAGNET_DIAMETER_MM = 30.0
MIN_COUNT, MAX_COUNT = 1, 5

ARC_SEGMENTS = 32
"""Chords a quarter circle: they stray less than 0.03 mm from any arc here."""

EDGE_TOLERANCE_MM = 1e-9
DECIMALS = 9
"""Coordinates are rounded to this many decimals, so that every machine writes the same ones."""


@dataclass(frozen=True)
class Face:
    """A flat face that is gripped: its outline with holes in plan view, and its height (mm)."""

    polygon: Polygon
    z_mm: float


@dataclass(frozen=True)
class SheetPiece:
    """A piece of sheet metal: area of its middle surface (mm^2), and centroid (mm)."""

    area_mm2: float
    centroid_mm: tuple[float, float, float]


@dataclass(frozen=True)
class SamplePart:
    """A sample part, its option space, and the grasp that a designer would choose.

    Parameters
    ----------
    name, title : str
        File stem, and one line that says what it is.
    space : OptionSpace
    designer_suction, designer_magnets : tuple of int
        1-based footprint indices of the designer's grasp.
    faces : tuple of Face
        The gripped faces, in the order in which their footprints are numbered.
    plan : Polygon
        The whole part in plan view, with its through holes; for pictures.
    pitch_mm, thickness_mm : float
        Pitch asked of the grid, and the sheet thickness that gives the part's mass.
    """

    name: str
    title: str
    space: OptionSpace
    designer_suction: tuple[int, ...]
    designer_magnets: tuple[int, ...]
    faces: tuple[Face, ...]
    plan: Polygon
    pitch_mm: float
    thickness_mm: float


def sample_parts() -> list[SamplePart]:
    """Return the four sample parts."""
    return [bracket(), door_frame(), panel(), tunnel_cover()]


# ---------------------------------------------------------------- the grid of footprints (5.1)


def grid_line(low: float, high: float, pitch_mm: float) -> FloatArray:
    """Grid coordinates (mm) from edge to edge of a face, descending.

    A side of length L has floor(L / pitch) points; one, in the middle, where that is less than 2.

    Examples
    --------
    >>> grid_line(-180.0, 180.0, 10.0)[:2]
    array([180.        , 169.71428571])
    >>> grid_line(0.0, 15.0, 10.0)
    array([7.5])
    """
    middle, half = (low + high) / 2.0, (high - low) / 2.0
    count = math.floor((high - low) / pitch_mm + 1e-9)
    if count < 2:
        return frozen([middle])
    steps = (count - 1 - 2 * np.arange(count)) / (count - 1)  # odd about 0: a mirrored face's
    return frozen(middle + half * steps)  # grid is the mirror image, to the last bit


def face_grid(polygon: Polygon, pitch_mm: float) -> FloatArray:
    """Grid over a face's bounding box, ``(n, 2)`` (mm), by descending x, then descending y."""
    x_low, y_low, x_high, y_high = np.round(polygon.bounds, DECIMALS)
    xs, ys = grid_line(x_low, x_high, pitch_mm), grid_line(y_low, y_high, pitch_mm)
    return frozen(np.column_stack([np.repeat(xs, len(ys)), np.tile(ys, len(xs))]))


def cup_places(polygon: Polygon, places_mm: FloatArray) -> FloatArray:
    """Keep the places where a whole cup lies inside the face."""
    reach = CUP_DIAMETER_MM / 2.0 - EDGE_TOLERANCE_MM
    return frozen(places_mm[inner_distance(polygon, places_mm) >= reach])


def magnet_places(polygon: Polygon, places_mm: FloatArray) -> FloatArray:
    """Keep the places strictly inside the face: a magnet may hang over its edge."""
    return frozen(places_mm[inner_distance(polygon, places_mm) > EDGE_TOLERANCE_MM])


def inner_distance(polygon: Polygon, places_mm: FloatArray) -> FloatArray:
    """Distance of each place to the nearest edge (mm); 0 for a place outside the polygon."""
    points = shapely.points(places_mm)
    shapely.prepare(polygon)
    inside = shapely.contains_properly(polygon, points)
    return frozen(np.where(inside, shapely.distance(polygon.boundary, points), 0.0))


def footprints(
    faces: Sequence[Face],
    pitch_mm: float,
    keep: Callable[[Polygon, FloatArray], FloatArray],
) -> FloatArray:
    """Footprints of one kind of element, ``(n, 3)`` (mm), face by face in the given order."""
    found = []
    for face in faces:
        places = keep(face.polygon, face_grid(face.polygon, pitch_mm))
        found.append(np.column_stack([places, np.full(len(places), face.z_mm)]))
    return clean(np.vstack(found))


def in_order(faces: Iterable[Face]) -> tuple[Face, ...]:
    """Faces by descending height, then descending x, then descending y of their middle."""

    def key(face: Face) -> tuple[float, float, float]:
        x_low, y_low, x_high, y_high = face.polygon.bounds
        return -face.z_mm, -round(x_low + x_high, DECIMALS), -round(y_low + y_high, DECIMALS)

    return tuple(sorted(faces, key=key))


def clean(values: object) -> FloatArray:
    """Round to 1e-9, without negative zeros."""
    return frozen(np.round(np.asarray(values, dtype=np.float64), DECIMALS) + 0.0)


# ---------------------------------------------------------------- plane figures


def rectangle(x: Place, y: Place, radius: float = 0.0) -> Polygon:
    """Rectangle over the ranges x and y (mm) with rounded corners."""
    return rounded(box(x[0], y[0], x[1], y[1]), radius)


def rounded(polygon: Polygon, radius: float) -> Polygon:
    """Round the convex corners of a polygon (mm)."""
    if radius == 0.0:
        return polygon
    eroded = polygon.buffer(-radius, quad_segs=ARC_SEGMENTS)
    return eroded.buffer(radius, quad_segs=ARC_SEGMENTS)


def disc(place: Place, diameter: float) -> Polygon:
    """Circle about a place (mm)."""
    return Point(place).buffer(diameter / 2.0, quad_segs=ARC_SEGMENTS)


def without(polygon: Polygon, cuts: Iterable[Polygon]) -> Polygon:
    """Cut figures out of a polygon; exactly one piece must be left."""
    rest = polygon.difference(shapely.union_all(list(cuts)))
    if not isinstance(rest, Polygon):
        raise ValueError(f"the cuts leave a {rest.geom_type}, not one polygon")  # noqa: TRY004 (wrong cuts, not a wrong type)
    return rest


def mirrored(polygon: Polygon) -> list[Polygon]:
    """Return a figure and its mirror image about x = 0."""
    return [polygon, affinity.scale(polygon, -1.0, 1.0, origin=(0.0, 0.0))]


def in_four_quadrants(polygon: Polygon) -> list[Polygon]:
    """Return a figure and its mirror images about both axes."""
    flipped = affinity.scale(polygon, 1.0, -1.0, origin=(0.0, 0.0))
    return [*mirrored(polygon), *mirrored(flipped)]


# ---------------------------------------------------------------- sheet metal


def flat(polygon: Polygon | MultiPolygon, z_mm: float) -> SheetPiece:
    """Level piece of sheet whose middle surface lies at z (mm)."""
    return SheetPiece(polygon.area, (polygon.centroid.x, polygon.centroid.y, z_mm))


def wall(line: LineString, z_low: float, z_high: float) -> SheetPiece:
    """Upright piece of sheet along a line in plan view, between two heights (mm)."""
    middle = line.centroid
    return SheetPiece(line.length * (z_high - z_low), (middle.x, middle.y, (z_low + z_high) / 2.0))


def mass_per_thickness(pieces: Sequence[SheetPiece]) -> float:
    """Mass of 1 mm thick sheet (g/mm)."""
    return STEEL_G_MM3 * math.fsum(piece.area_mm2 for piece in pieces)


def sheet_part(pieces: Sequence[SheetPiece], mass_g: float) -> Part:
    """Part of the given mass (g) whose centroid is that of its pieces."""
    areas = np.array([piece.area_mm2 for piece in pieces])
    centroids = np.array([piece.centroid_mm for piece in pieces])
    return Part(mass_g, clean(areas @ centroids / areas.sum()))


def raised_sheet(
    base: Polygon, faces: Sequence[Face], holes: Sequence[Polygon], sheet_mm: float
) -> list[SheetPiece]:
    """Sheet with its top at z = 0, with holes, and with fields pressed up to the faces (mm)."""
    fields = [Polygon(face.polygon.exterior) for face in faces]
    pierced = shapely.union_all(list(holes))
    low = -sheet_mm / 2.0
    pieces = [flat(base.difference(shapely.union_all([*fields, pierced])), low)]
    for field, face in zip(fields, faces, strict=True):
        pieces.append(flat(field.difference(pierced), low + face.z_mm))
        pieces.append(wall(field.exterior, low, low + face.z_mm))
    return pieces


# ---------------------------------------------------------------- the option space


def option_space(
    part: Part, faces: Sequence[Face], pitch_mm: float, corners: Sequence[Place], scale: float
) -> OptionSpace:
    """Option space of the faces; the polygon's corners lie in the plane z = 0, as figure 26's."""
    return OptionSpace(
        part=part,
        kinds=(
            suction_cups(footprints(faces, pitch_mm, cup_places)),
            magnets(footprints(faces, pitch_mm, magnet_places)),
        ),
        approximation_polygon_mm=frozen([(x, y, 0.0) for x, y in corners]),
        scale_factor=scale,
    )


def suction_cups(footprints_mm: FloatArray) -> ElementKind:
    """Return the thesis's suction cup (chapter 6) at the given footprints."""
    return ElementKind(
        name="suction",
        force_n=69.0,
        price=10.0,
        count_min=MIN_COUNT,
        count_max=MAX_COUNT,
        footprints_mm=footprints_mm,
        weight_g=15.0,
        diameter_mm=CUP_DIAMETER_MM,
        model="SAF 40 NBR-60 M10-AG",
    )


def magnets(footprints_mm: FloatArray) -> ElementKind:
    """Return the thesis's magnet (chapter 6) at the given footprints."""
    return ElementKind(
        name="magnets",
        force_n=130.0,
        price=30.0,
        count_min=MIN_COUNT,
        count_max=MAX_COUNT,
        footprints_mm=footprints_mm,
        weight_g=110.0,
        diameter_mm=MAGNET_DIAMETER_MM,
        model="SGM-HP 30 G1/8-IG",
    )


def nearest(kind: ElementKind, targets: Iterable[Place]) -> tuple[int, ...]:
    """1-based indices of the footprints nearest to each target in plan view (mm)."""
    chosen = []
    for target in targets:
        offsets = kind.footprints_mm[:, :2] - np.asarray(target)
        chosen.append(int(np.argmin(np.round(np.hypot(*offsets.T), DECIMALS))) + 1)
    return tuple(chosen)


# ---------------------------------------------------------------- 1: bracket

BRACKET_MASS_G = 13796.19
BRACKET_SHEET_MM = 10.0
BRACKET_WIDTH_MM = 220.0
BRACKET_BEND_MM = 15.0
"""Radius of the bends, to the middle of the plate; their centre lines are at x = +-180."""


def bracket() -> SamplePart:
    """C-shaped bracket, 400 x 220 mm, in the size of the thesis's P1 (section 6.4.1).

    A thick plate, bent down at both ends and in again at the feet.  Its top face (360 x 220 mm,
    z = 100) is what four pressed pockets and the protrusion in the middle leave of it.
    """
    plate = rectangle((-180.0, 180.0), (-110.0, 110.0))
    pockets = in_four_quadrants(bracket_pocket())
    protrusion = bracket_protrusion()
    holes = [disc((0.0, 0.0), 70.0), *in_four_quadrants(disc((145.0, 75.0), 30.0))]
    top = Face(without(plate, [protrusion, *pockets]), 100.0)
    pieces = [*bracket_top_pieces(top.polygon, pockets, protrusion, holes), *bracket_end_pieces()]
    part = sheet_part(pieces, BRACKET_MASS_G)
    corners = [(180.0, 110.0), (180.0, -110.0), (-180.0, -110.0), (-180.0, 110.0)]
    space = option_space(part, [top], 10.0, corners, scale=0.6)
    suction, magnet = space.kinds
    cup_targets = [(139.0, 27.0), (139.0, -27.0), (-139.0, 27.0), (-139.0, -27.0)]
    return SamplePart(
        name="bracket",
        title="C-shaped bracket, 400 x 220 mm, 13.8 kg, 10 mm plate",
        space=space,
        designer_suction=nearest(suction, cup_targets),
        designer_magnets=nearest(magnet, [(5.0, 100.0), (-5.0, -100.0)]),
        faces=(top,),
        plan=without(rectangle((-200.0, 200.0), (-110.0, 110.0)), holes),
        pitch_mm=10.0,
        thickness_mm=BRACKET_MASS_G / mass_per_thickness(pieces),
    )


def bracket_protrusion() -> Polygon:
    """Outline of the protrusion: two lands bite into it, in the middle of the long edges."""
    land = rectangle((-13.0, 13.0), (89.6, 120.0), radius=4.0)
    lands = [land, affinity.scale(land, 1.0, -1.0, origin=(0.0, 0.0))]
    return rounded(without(rectangle((-69.0, 69.0), (-102.5, 102.5)), lands), 8.0)


def bracket_pocket() -> Polygon:
    """Pocket around a quarter of the right-hand pad, up to the bend line x = 180.

    It leaves a pad for 14 cups.  The slanting sides are drawn between those cups and the next grid
    points, which are only 0.08 mm farther from the outermost cups than a cup's radius.
    """
    beside_pad = [(76.0, 3.5), (105.3, 3.5), (105.3, 20.9), (115.3, 40.3), (134.8, 50.0)]
    above_pad = [(142.9, 50.0), (162.4, 40.3), (174.4, 17.0), (190.0, 17.0)]
    along_rim = [(190.0, 101.5), (76.0, 101.5)]
    pocket = rounded(Polygon([*beside_pad, *above_pad, *along_rim]), 4.0)
    return pocket.intersection(rectangle((0.0, 180.0), (0.0, 110.0)))


def bracket_top_pieces(
    top: Polygon, pockets: Sequence[Polygon], protrusion: Polygon, holes: Sequence[Polygon]
) -> list[SheetPiece]:
    """Top face, pockets (6 mm down) and the protrusion (20 mm down into the C)."""
    level = 100.0 - BRACKET_SHEET_MM / 2.0
    pocket_floors = shapely.union_all(list(pockets)).difference(shapely.union_all(list(holes)))
    return [
        flat(top, level),
        flat(pocket_floors, level - 6.0),
        *(wall(pocket.exterior, level - 6.0, level) for pocket in pockets),
        flat(without(protrusion, holes), level - 20.0),
        wall(protrusion.exterior, level - 20.0, level),
    ]


def bracket_end_pieces() -> list[SheetPiece]:
    """Bends, legs (200 mm from the middle, 60 mm flat) and feet of both ends."""
    width, radius = BRACKET_WIDTH_MM, BRACKET_BEND_MM
    leg_x, foot_z = 180.0 + radius, 20.0 - radius
    out = 2.0 * radius / math.pi  # from a quarter circle's centre to its centroid, along each axis
    bend_area = width * math.pi / 2.0 * radius
    bolt_holes = [disc((140.0, y), 18.0) for y in (70.0, -70.0)]
    foot = without(rectangle((106.0, 180.0), (-110.0, 110.0)), bolt_holes)
    pieces = []
    for side in (1.0, -1.0):
        pieces += [
            SheetPiece(bend_area, (side * (180.0 + out), 0.0, 80.0 + out)),
            SheetPiece(width * 60.0, (side * leg_x, 0.0, 50.0)),
            SheetPiece(bend_area, (side * (180.0 + out), 0.0, 20.0 - out)),
            SheetPiece(foot.area, (side * foot.centroid.x, 0.0, foot_z)),
        ]
    return pieces


# ---------------------------------------------------------------- 2: door inner frame

DOOR_MASS_G = 8860.0
DOOR_SHEET_MM = 1.6
DOOR_FLANGE_MM = 30.0
"""Height of the flange that hangs from the frame's outline."""

DOOR_LOCK_HOLE = disc((432.0, 13.0), 36.0)


def door_frame() -> SamplePart:
    """Inner frame of a car's door, 1100 x 800 mm, in the size of the thesis's P2 (section 6.5.1).

    Rims, a belt bar, a lower bar, two ribs and a lock plate; nine pressed fields on them, at four
    heights, are gripped.
    """
    corners = [(550.0, 400.0), (550.0, -400.0), (-550.0, -400.0), (-550.0, 60.0), (-90.0, 400.0)]
    outline = rounded(Polygon(corners), 30.0)
    faces = in_order(door_faces())
    frame = without(outline, door_openings(outline))
    holes = [DOOR_LOCK_HOLE, *(disc((-512.0, y), 21.0) for y in (10.0, -60.0, -270.0, -340.0))]
    pieces = raised_sheet(frame, faces, holes, DOOR_SHEET_MM)
    pieces.append(wall(outline.exterior, -DOOR_FLANGE_MM, 0.0))
    part = sheet_part(pieces, DOOR_MASS_G)
    seven = [corners[0], (550.0, 0.0), *corners[1:3], (-550.0, -170.0), *corners[3:]]
    space = option_space(part, faces, 10.0, seven, scale=0.5)
    suction, magnet = space.kinds
    return SamplePart(
        name="door_frame",
        title="Door inner frame, 1100 x 800 mm, 8.86 kg, 1.6 mm sheet",
        space=space,
        designer_suction=nearest(suction, [(-202.0, 140.0), (283.0, -210.0)]),
        designer_magnets=nearest(magnet, [(283.0, 140.0), (-202.0, -210.0)]),
        faces=faces,
        plan=without(frame, holes),
        pitch_mm=10.0,
        thickness_mm=DOOR_MASS_G / mass_per_thickness(pieces),
    )


def door_openings(outline: Polygon) -> list[Polygon]:
    """Window above the belt bar, service openings below it, slots along the bottom."""
    within_rims = outline.buffer(-75.0)
    window = within_rims.intersection(rectangle((-550.0, 550.0), (195.0, 325.0)))
    hinge_side = within_rims.intersection(rectangle((-550.0, -275.0), (-155.0, 85.0)))
    middle = rectangle((-165.0, 210.0), (-155.0, 85.0))
    slots = [(-475.0, -275.0), (-165.0, 210.0), (320.0, 475.0)]
    bottom = [rectangle(x, (-335.0, -265.0)) for x in slots]
    return [rounded(opening, 25.0) for opening in (window, hinge_side, middle, *bottom)]


def door_faces() -> list[Face]:
    """Nine pressed fields: on the bars and ribs, where they cross, and on the lock plate."""
    belt, rib, lower, lock = 24.0, 12.0, 18.0, 8.0
    fields = [
        (-263.0, -177.0, 88.0, 192.0, belt),
        (-82.0, 128.0, 109.0, 171.0, belt),
        (222.0, 308.0, 88.0, 192.0, belt),
        (-251.0, -189.0, -99.0, 29.0, rib),
        (234.0, 296.0, -99.0, 29.0, rib),
        (-263.0, -177.0, -262.0, -158.0, lower),
        (-82.0, 128.0, -241.0, -179.0, lower),
        (222.0, 308.0, -262.0, -158.0, lower),
    ]
    faces = [
        Face(rectangle((x_low, x_high), (y_low, y_high), 12.0), z_mm)
        for x_low, x_high, y_low, y_high, z_mm in fields
    ]
    lock_plate = rectangle((348.0, 456.0), (-108.0, 48.0), 12.0)
    return [*faces, Face(without(lock_plate, [DOOR_LOCK_HOLE]), lock)]


# ---------------------------------------------------------------- 3: panel

PANEL_MASS_G = 27000.0
PANEL_SHEET_MM = 3.0
PANEL_FLANGE_MM = 25.0


def panel() -> SamplePart:
    """Heavy floor panel, 1400 x 900 mm: a rim, and a raised field with four windows."""
    outline = rectangle((-700.0, 700.0), (-450.0, 450.0), 80.0)
    windows = [
        *mirrored(rectangle((70.0, 440.0), (30.0, 225.0), 40.0)),
        *mirrored(rectangle((90.0, 440.0), (-225.0, -50.0), 40.0)),
    ]
    corner_holes = in_four_quadrants(disc((610.0, 370.0), 50.0))
    field_outline = rectangle((-524.0, 524.0), (-310.0, 310.0), 60.0)
    field = Face(without(field_outline, windows), 15.0)
    rim = Face(without(outline, [field_outline, *corner_holes]), 0.0)
    faces = in_order([field, rim])
    holes = [*windows, *corner_holes]
    pieces = raised_sheet(outline, [field], holes, PANEL_SHEET_MM)
    pieces.append(wall(outline.exterior, -PANEL_FLANGE_MM, 0.0))
    part = sheet_part(pieces, PANEL_MASS_G)
    corners = [(700.0, 450.0), (700.0, -450.0), (-700.0, -450.0), (-700.0, 450.0)]
    space = option_space(part, faces, 35.0, corners, scale=0.6)
    suction, magnet = space.kinds
    cup_targets = [(0.0, 265.0), (480.0, 110.0), (-480.0, 110.0)]
    magnet_targets = [(480.0, 265.0), (-480.0, 265.0), (480.0, -265.0), (-480.0, -265.0)]
    return SamplePart(
        name="panel",
        title="Floor panel, 1400 x 900 mm, 27 kg, 3 mm sheet",
        space=space,
        designer_suction=nearest(suction, cup_targets),
        designer_magnets=nearest(magnet, [*magnet_targets, (0.0, -265.0)]),
        faces=faces,
        plan=without(outline, holes),
        pitch_mm=35.0,
        thickness_mm=PANEL_MASS_G / mass_per_thickness(pieces),
    )


# ---------------------------------------------------------------- 4: tunnel cover

COVER_SHEET_MM = 2.5


def tunnel_cover() -> SamplePart:
    """U-shaped tunnel cover, 900 x 560 mm: its polygon is not star-shaped about its centroid."""
    u_shape = [(450.0, 280.0), (450.0, -280.0), (-450.0, -280.0), (-450.0, 280.0)]
    notch = [(-190.0, 280.0), (-190.0, 40.0), (190.0, 40.0), (190.0, 280.0)]
    corners = [*u_shape, *notch]
    outline = rounded(Polygon(corners), 30.0)
    tunnel_outline = rectangle((-130.0, 130.0), (-250.0, 10.0), 30.0)
    lever_hole = disc((0.0, -90.0), 110.0)
    bolt_holes = in_four_quadrants(disc((380.0, 215.0), 36.0))
    tunnel = Face(without(tunnel_outline, [lever_hole]), 60.0)
    faces = in_order([tunnel, Face(without(outline, [tunnel_outline, *bolt_holes]), 0.0)])
    holes = [lever_hole, *bolt_holes]
    pieces = raised_sheet(outline, [tunnel], holes, COVER_SHEET_MM)
    mass = round(COVER_SHEET_MM * mass_per_thickness(pieces), 2)
    part = sheet_part(pieces, mass)
    space = option_space(part, faces, 20.0, corners, scale=0.6)
    suction, magnet = space.kinds
    return SamplePart(
        name="tunnel_cover",
        title="U-shaped tunnel cover, 900 x 560 mm, 8.98 kg, 2.5 mm sheet",
        space=space,
        designer_suction=nearest(suction, [(300.0, 150.0), (-300.0, 150.0)]),
        designer_magnets=nearest(magnet, [(300.0, -150.0), (-300.0, -150.0)]),
        faces=faces,
        plan=without(outline, holes),
        pitch_mm=20.0,
        thickness_mm=COVER_SHEET_MM,
    )
