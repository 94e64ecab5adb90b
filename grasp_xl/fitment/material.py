"""What parts are made of."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Material:
    """A material of sheet metal.

    Parameters
    ----------
    name : str
    density_g_cm3 : float
    is_magnetic : bool
        Whether magnets hold it.
    """

    name: str
    density_g_cm3: float
    is_magnetic: bool


MATERIALS = {
    material.name: material
    for material in (
        Material("steel", 7.85, is_magnetic=True),
        Material("stainless", 7.9, is_magnetic=False),  # austenitic, 1.4301
        Material("aluminium", 2.7, is_magnetic=False),
        Material("magnesium", 1.77, is_magnetic=False),
        Material("titanium", 4.43, is_magnetic=False),
        Material("copper", 8.93, is_magnetic=False),
        Material("brass", 8.5, is_magnetic=False),
    )
}
"""Materials by name, with the densities that tables give for usual alloys."""

USUAL = "steel"
"""Where nobody says what a part is made of."""
