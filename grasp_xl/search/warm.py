"""The exact search made ready, so that no time limit pays for its compilation."""

from __future__ import annotations

import time
from functools import cache

import numpy as np

from grasp_xl.rules import Goals, Rules, Terms
from grasp_xl.search.exact import solve
from grasp_xl.space import ElementKind, OptionSpace, Part, frozen


@cache
def load_exact_search() -> float:
    """Compile the kernels of the exact search, or load their code: solve a tiny task, once.

    Returns
    -------
    float
        Seconds that it took.
    """
    began = time.perf_counter()
    corners = frozen([[0, 0, 0], [300, 0, 0], [300, 300, 0], [0, 300, 0]])
    kinds = tuple(ElementKind(name, 50.0, 10.0, 0, 2, corners) for name in ("suction", "magnets"))
    space = OptionSpace(Part(1000.0, frozen(np.zeros(3))), kinds, corners, 0.5)
    solve(space, Rules(Goals(Terms(1.0, 1.0, 1.0, 1.0))))
    return time.perf_counter() - began


def seconds_loading() -> float:
    """Return the seconds that loading took, 0 as long as nothing is loaded."""
    return load_exact_search() if load_exact_search.cache_info().currsize else 0.0
