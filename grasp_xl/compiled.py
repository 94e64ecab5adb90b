"""The one place that says how numeric kernels are compiled, and where the code is kept."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from pathlib import Path
from typing import Any, ParamSpec, TypeVar, cast

import numba
import platformdirs
from numba.core.types import unliteral

P = ParamSpec("P")
R = TypeVar("R")


MARKS = (b"@compiled", b"@allocation_free", b"@inner")
"""What a file with kernels has in it."""

CONSTANTS = ("chromosome.py", "mutation.py", "rules.py")
"""Files whose constants kernels use: they become part of the compiled code."""


def _cache_folder() -> str:
    # One folder for each state of the sources: numba looks at the kernel's own file only, and
    # would go on using code compiled from an older file that the kernel calls.
    digest = hashlib.sha256()
    for source in sorted(Path(__file__).parent.rglob("*.py")):
        text = source.read_bytes()
        if any(mark in text for mark in MARKS) or source.name in CONSTANTS:
            digest.update(text)
    return str(Path(platformdirs.user_cache_dir("grasp_xl")) / digest.hexdigest()[:16])


CACHE_FOLDER = _cache_folder()


def compiled(function: Callable[P, R]) -> Callable[P, R]:
    """Compile a kernel with numba when it is first called, once a machine.

    No fast-math: results are the same, bit for bit, on every machine.  The plain function stays
    reachable as ``.py_func``.
    """
    return _compiled(function)


def allocation_free(function: Callable[P, R]) -> Callable[P, R]:
    """Compile a kernel that makes no array, without counting references: twice as fast."""
    return _compiled(function, _nrt=False)


def inner(function: Callable[P, R]) -> Callable[P, R]:
    """Compile a kernel that only kernels call, as :func:`allocation_free`.

    It has no entry for Python, which would take a third of the time to compile.
    """
    return _compiled(function, _nrt=False, no_cpython_wrapper=True, no_cfunc_wrapper=True)


def _compiled(function: Callable[P, R], **options: bool) -> Callable[P, R]:
    settings: Any = numba.config
    usual = settings.CACHE_DIR
    settings.CACHE_DIR = CACHE_FOLDER
    settled: dict[str, Any] = {**options, "error_model": "numpy", "nogil": True}
    try:
        kernel = numba.njit(cache=True, **settled)(function)
    except RuntimeError:  # no folder that can be written: compile in every process
        kernel = numba.njit(**settled)(function)
    finally:
        settings.CACHE_DIR = usual
    if not settings.DISABLE_JIT:
        # A constant is a number like any other: numba would compile the kernel anew for each.
        find = kernel.get_call_template
        kernel.get_call_template = lambda args, kws: find(tuple(map(unliteral, args)), kws)
    return cast("Callable[P, R]", kernel)


def is_compiled(module: str = "") -> bool:
    """Tell whether compiled code of modules whose names begin so is kept on this machine."""
    return any(Path(CACHE_FOLDER).rglob(f"{module}*.nbc"))
