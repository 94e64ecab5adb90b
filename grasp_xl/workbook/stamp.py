"""The mark by which we know a workbook that nobody touched since we wrote it."""

from __future__ import annotations

import hashlib
import io
import zipfile
import zlib
from pathlib import Path
from typing import BinaryIO

STAMP_PROPERTY = "grasp_xl content"
PLACEHOLDER = "0" * 64
STAMPED_PART = "docProps/custom.xml"
MAX_STAMPED_BYTES = 100_000
"""Ours has 500; as much is read of a stranger's."""


def content_digest(archive: zipfile.ZipFile) -> str:
    """Return a hash of all parts of a workbook but the one that holds the mark."""
    digest = hashlib.sha256()
    for part in sorted(archive.infolist(), key=lambda part: part.filename):
        if part.filename != STAMPED_PART:
            digest.update(f"{part.filename} {part.CRC:08x} {part.file_size}\n".encode())
    return digest.hexdigest()


def stamped(content: bytes, placeholder: str = PLACEHOLDER) -> bytes:
    """Return a workbook with the placeholder of its mark replaced by the mark."""
    written = io.BytesIO()
    with (
        zipfile.ZipFile(io.BytesIO(content)) as plain,
        zipfile.ZipFile(written, "w", zipfile.ZIP_DEFLATED) as marked,
    ):
        mark = content_digest(plain).encode()
        for part in plain.infolist():
            data = plain.read(part)
            if part.filename == STAMPED_PART:
                data = data.replace(placeholder.encode(), mark)
            marked.writestr(part, data)
    return written.getvalue()


def stamped_anew(content: bytes, before: bytes) -> bytes:
    """Return a workbook that we changed with the mark that it has now.

    ``before`` is the workbook with the mark that it had.
    """
    with zipfile.ZipFile(io.BytesIO(before)) as archive:
        return stamped(content, content_digest(archive))


def is_untouched(file: Path | BinaryIO) -> bool:
    """Tell whether a file is a workbook of ours, just as we wrote it."""
    try:
        with zipfile.ZipFile(file) as archive, archive.open(STAMPED_PART) as part:
            return content_digest(archive).encode() in part.read(MAX_STAMPED_BYTES)
    except (zipfile.BadZipFile, zlib.error, KeyError, EOFError, RuntimeError, OSError):
        return False  # no such workbook; RuntimeError is about passwords
