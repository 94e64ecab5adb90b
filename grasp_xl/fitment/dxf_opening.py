"""Opening a DXF drawing: what is none told, small faults mended, as far as the library can."""

from __future__ import annotations

import io
from pathlib import Path
from typing import TYPE_CHECKING

from grasp_xl.errors import InputError, Problem
from grasp_xl.file_content import FileKind
from grasp_xl.printable import printable

if TYPE_CHECKING:
    from ezdxf.audit import Auditor
    from ezdxf.document import Drawing

MAX_FILE_BYTES = 128_000_000
DXF = FileKind("drawing", "a DXF drawing", MAX_FILE_BYTES, "export the part's outlines alone")

BINARY = b"AutoCAD Binary DXF"
"""How the binary form begins."""


def opened(content: bytes, path: Path) -> tuple[Drawing, list[Problem]]:
    """Open a drawing, and tell which faults were mended.

    Raises
    ------
    InputError
        If it is none, or is damaged beyond that.
    """
    name, hint = str(path), "export it again as DXF (R2000 or later)"
    _refuse_other_files(content, name)
    try:
        drawing, auditor = _read(content, path)
    except _faults() as error:
        reason = (str(error) or type(error).__name__).splitlines()[0]
        found = f"a file that is no DXF drawing ({printable(reason[:100])})"
        raise InputError([Problem(name, found, DXF.expected, hint)]) from None
    if auditor.has_errors:
        found = f"a damaged drawing ({printable(auditor.errors[0].message[:100])})"
        raise InputError([Problem(name, found, DXF.expected, hint)])
    mended = [printable(fix.message[:100]) for fix in auditor.fixes]
    if not mended:
        return drawing, []
    found = f"{len(mended)} faults of the file (the first: {mended[0]})"
    return drawing, [Problem(name, found, "none", f"they were mended; if not as meant, {hint}")]


def _refuse_other_files(content: bytes, name: str) -> None:
    """Refuse what the library would take for a drawing, and find nothing in."""
    hint = "export it as DXF (R2000 or later)"
    if not content.strip():
        raise InputError([Problem(name, "an empty file", DXF.expected, hint)])
    if content.startswith(b"AC10"):
        raise InputError([Problem(name, "a DWG drawing", DXF.expected, hint)])
    if not content.startswith(BINARY) and b"SECTION" not in content:
        raise InputError([Problem(name, "a file that is no DXF drawing", DXF.expected, hint)])
    if not content.rstrip(b"\0 \r\n\t\x1a").endswith(b"EOF"):
        raise InputError([Problem(name, "a drawing that breaks off", DXF.expected, hint)])


def _read(content: bytes, path: Path) -> tuple[Drawing, Auditor]:
    """Read a drawing as it is; where that fails, by repair, which takes three times so long."""
    import ezdxf
    from ezdxf import recover
    from ezdxf.filemanagement import dxf_stream_info

    try:
        if content.startswith(BINARY):
            drawing = ezdxf.readfile(path)  # type: ignore[attr-defined]
        else:
            encoding = dxf_stream_info(_text(content, "latin-1")).encoding
            drawing = ezdxf.read(_text(content, encoding))  # type: ignore[attr-defined]
    except _faults():
        return recover.read(io.BytesIO(content))
    return drawing, drawing.audit()


def _text(content: bytes, encoding: str) -> io.TextIOWrapper:
    return io.TextIOWrapper(io.BytesIO(content), encoding=encoding, errors="surrogateescape")


def _faults() -> tuple[type[Exception], ...]:
    """Return what the library raises for a file at fault."""
    from ezdxf.lldxf.const import DXFError

    return DXFError, OSError, ValueError, LookupError, AttributeError, TypeError
