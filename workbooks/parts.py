"""The sample parts: the solid of each, what is asked of ``fit``, and where a designer would grip.

Two are in the sizes of the thesis's test cases P1 and P2 (sections 6.4.1 and 6.5.1).  Lengths are
in mm, masses in g; ``models.py`` has the geometry.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from figures import Place
from models import bracket, door_frame, panel, tunnel_cover
from shapes import Shape

from grasp_xl.commands.fit import USUAL_COUNT, Mass, Request, Wanted
from grasp_xl.fitment.part_file import Reading
from grasp_xl.space import ElementKind, OptionSpace

CUP, CUP_PRICE = "SAF 40 NBR-60 M10-AG", 10.0
MAGNET, MAGNET_PRICE = "SGM-HP 30 G1/8-IG", 30.0
"""The thesis's elements (section 6.2), and the price of one ($)."""

DECIMALS = 9
"""Places are equally near to a target if their distances agree to so many decimals of a mm."""


@dataclass(frozen=True)
class SamplePart:
    """A sample part.

    Parameters
    ----------
    name, title : str
        File stem, and one line that says what it is.
    model : callable
        Returns the solid.
    mass_g : float
    faces : str
        Those that are gripped, as ``--cup-faces`` and ``--magnet-faces`` say it.
    pitch_mm : float
    polygon : tuple of Place
        Corners of what stands for the part in the deviation (mm).
    scale_factor : float
    cup_targets, magnet_targets : tuple of Place
        Where a designer would grip; the nearest footprints are taken (mm).
    """

    name: str
    title: str
    model: Callable[[], Shape]
    mass_g: float
    faces: str
    pitch_mm: float
    polygon: tuple[Place, ...]
    scale_factor: float
    cup_targets: tuple[Place, ...]
    magnet_targets: tuple[Place, ...]

    def request(self, step: Path) -> Request:
        """Return what is asked of ``fit``."""
        return Request(
            path=step,
            reading=Reading(),
            mass=Mass(None, mass_g=self.mass_g),
            cup=Wanted(CUP, CUP_PRICE, self.faces, USUAL_COUNT, 0.0),
            magnet=Wanted(MAGNET, MAGNET_PRICE, self.faces, USUAL_COUNT, 0.0),
            catalogue=None,
            pitch_mm=self.pitch_mm,
            polygon=np.array(self.polygon),
            scale_factor=self.scale_factor,
            min_overlap=0.0,
        )

    def designer_grasp(self, space: OptionSpace) -> tuple[tuple[int, ...], tuple[int, ...]]:
        """Return the 1-based indices of the cups and magnets that a designer would choose."""
        cups, magnets = space.kinds
        return nearest(cups, self.cup_targets), nearest(magnets, self.magnet_targets)


def nearest(kind: ElementKind, targets: Sequence[Place]) -> tuple[int, ...]:
    """Return the 1-based indices of the footprints nearest to each target in plan view (mm)."""
    offsets = kind.footprints_mm[:, None, :2] - np.array(targets)
    nearest = np.argmin(np.round(np.linalg.norm(offsets, axis=2), DECIMALS), axis=0)
    return tuple((nearest + 1).tolist())


SAMPLE_PARTS = (
    SamplePart(
        name="bracket",
        title="C-shaped bracket, 400 x 220 mm, 13.8 kg, 10 mm plate",
        model=bracket,
        mass_g=13796.19,
        faces="top",
        pitch_mm=10.0,
        polygon=((180, 110), (180, -110), (-180, -110), (-180, 110)),
        scale_factor=0.6,
        cup_targets=((139, 27), (139, -27), (-139, 27), (-139, -27)),
        magnet_targets=((5, 100), (-5, -100)),
    ),
    SamplePart(
        name="door_frame",
        title="Door inner frame, 1100 x 800 mm, 8.86 kg, 1.6 mm sheet",
        model=door_frame,
        mass_g=8860.0,
        faces="1,2,3,4,5,6,7,8,9",
        pitch_mm=10.0,
        polygon=(
            (550, 400),
            (550, 0),
            (550, -400),
            (-550, -400),
            (-550, -170),
            (-550, 60),
            (-90, 400),
        ),
        scale_factor=0.5,
        cup_targets=((-202, 140), (283, -210)),
        magnet_targets=((283, 140), (-202, -210)),
    ),
    SamplePart(
        name="panel",
        title="Floor panel, 1400 x 900 mm, 27 kg, 3 mm sheet",
        model=panel,
        mass_g=27000.0,
        faces="all-up",
        pitch_mm=35.0,
        polygon=((700, 450), (700, -450), (-700, -450), (-700, 450)),
        scale_factor=0.6,
        cup_targets=((0, 265), (480, 110), (-480, 110)),
        magnet_targets=((480, 265), (-480, 265), (480, -265), (-480, -265), (0, -265)),
    ),
    SamplePart(
        name="tunnel_cover",
        title="U-shaped tunnel cover, 900 x 560 mm, 8.98 kg, 2.5 mm sheet",
        model=tunnel_cover,
        mass_g=8976.06,
        faces="1,2",
        pitch_mm=20.0,
        polygon=(
            (450, 280),
            (450, -280),
            (-450, -280),
            (-450, 280),
            (-190, 280),
            (-190, 40),
            (190, 40),
            (190, 280),
        ),
        scale_factor=0.6,
        cup_targets=((300, 150), (-300, 150)),
        magnet_targets=((300, -150), (-300, -150)),
    ),
)
