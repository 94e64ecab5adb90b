"""Option spaces with few of their footprints, for solvers that cannot take them all."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from grasp_xl.space import OptionSpace, frozen


def thinned(space: OptionSpace, most: int) -> OptionSpace:
    """Keep at most so many footprints of each kind, evenly over its list."""
    kinds = []
    for kind in space.kinds:
        kept = np.linspace(0, kind.total - 1, min(most, kind.total)).round().astype(np.int64)
        kinds.append(replace(kind, footprints_mm=frozen(kind.footprints_mm[kept]), overlap=None))
    return replace(space, kinds=tuple(kinds))
