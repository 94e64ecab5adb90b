"""The exact search made ready, so that no time limit pays for its compilation."""

from __future__ import annotations

from functools import cache

import numpy as np

from grasp_xl.rules import Goals, Rules, Terms
from grasp_xl.search.exact import solve
from grasp_xl.space import ElementKind, OptionSpace, Part, frozen


@cache
def load_exact_search() -> None:
    """Compile the kernels of the exact search, or load their code: solve a tiny task, once."""
    corners = frozen([[0, 0, 0], [300, 0, 0], [300, 300, 0], [0, 300, 0]])
    kinds = tuple(ElementKind(name, 50.0, 10.0, 0, 2, corners) for name in ("suction", "magnets"))
    space = OptionSpace(Part(1000.0, frozen(np.zeros(3))), kinds, corners, 0.5)
    solve(space, Rules(Goals(Terms(1.0, 1.0, 1.0, 1.0))))
