"""Which gripper elements of the catalogue have what a designer asks for."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from grasp_xl.fitment.catalogue import Catalogue, Wanted, read_catalogue
from grasp_xl.fitment.element import Element


@dataclass(frozen=True, slots=True)
class Listed:
    """A catalogue, and the elements of it that were asked for."""

    catalogue: Catalogue
    elements: tuple[Element, ...]


def list_elements(own: Path | None, wanted: Wanted) -> Listed:
    """List the elements of the catalogue, and of a user's file, that are wanted.

    Raises
    ------
    InputError
        With every problem found in the file.
    """
    catalogue = read_catalogue(own)
    return Listed(catalogue, tuple(filter(wanted.fits, catalogue.elements)))
