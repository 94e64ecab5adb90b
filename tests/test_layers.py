"""Data flows one way: file -> option space -> search -> result -> workbook -> door."""

from __future__ import annotations

import ast
from pathlib import Path

import grasp_xl

ROOT = Path(grasp_xl.__file__).parent

LAYERS = (
    ("adding", "errors", "compiled", "file_content", "printable", "rounding"),
    ("space",),
    ("chromosome", "rules", "polygon"),
    ("criteria",),
    ("grasp", "kernels"),
    ("bill",),
    ("stability",),
    ("search",),
    ("task",),
    ("fitment",),
    ("workbook", "macros"),
    ("study",),
    ("view",),
    ("commands",),
    ("cli", "live"),
)
"""Modules and packages, from the bottom up; each may import its own layer and those below."""


def module_names(path: Path) -> list[str]:
    """Names of our own modules that a file imports, at run time or for types."""
    found = []
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("grasp_xl"):
            inner = (node.module or "").split(".")[1:]
            found += [inner[0]] if inner else [alias.name for alias in node.names]
    return found


def layer_of(name: str) -> int:
    """Number of the layer that a module belongs to."""
    return next(number for number, names in enumerate(LAYERS) if name in names)


def test_imports_point_downwards_only():
    """No module imports one of a layer above its own; no module stands outside the layers."""
    for path in ROOT.rglob("*.py"):
        own = path.relative_to(ROOT).parts[0].removesuffix(".py")
        if own in ("__init__", "__main__"):
            continue
        for name in module_names(path):
            if name == "__version__":
                continue
            assert layer_of(name) <= layer_of(own), f"{path.name} imports {name} from above"


def test_searches_know_no_workbook_and_no_command_line():
    """Everything below the workbook runs without a file, a cell or a terminal."""
    for path in (ROOT / "search").glob("*.py"):
        text = path.read_text(encoding="utf-8")
        assert "openpyxl" not in text
        assert "xlsxwriter" not in text
        assert "typer" not in text
