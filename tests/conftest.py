"""Settings of all tests."""

from __future__ import annotations

import os

from hypothesis import settings

# A landing is judged by the same examples each time; new ones are tried on every other machine.
settings.register_profile("landing", derandomize=True)
if os.environ.get("GRASP_XL_REQUIRE_ALL"):
    settings.load_profile("landing")
