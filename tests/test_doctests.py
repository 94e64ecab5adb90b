"""Examples in docstrings are executed."""

from __future__ import annotations

import doctest
import importlib
import pkgutil

import pytest

import grasp_xl

MODULES = [
    module.name
    for module in pkgutil.walk_packages(grasp_xl.__path__, "grasp_xl.")
    if not module.name.endswith("__main__")
]


@pytest.mark.parametrize("name", MODULES)
def test_examples_hold(name):
    """Every example in a module's docstrings gives what it says."""
    assert doctest.testmod(importlib.import_module(name)).failed == 0
