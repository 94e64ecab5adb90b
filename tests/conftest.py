"""Settings of all tests."""

from __future__ import annotations

import os
from collections.abc import Iterator

import pytest
from hypothesis import settings
from office import Office, run_office

# A landing is judged by the same examples each time; new ones are tried on every other machine.
settings.register_profile("landing", derandomize=True)
if os.environ.get("GRASP_XL_REQUIRE_ALL"):
    settings.load_profile("landing")


@pytest.fixture(scope="session")
def office(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Office]:
    """Keep one LibreOffice for all tests of a process."""
    yield from run_office(tmp_path_factory.mktemp("office"))
