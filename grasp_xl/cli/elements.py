"""The command ``elements``."""

from __future__ import annotations

from grasp_xl.cli.options import (
    AsJson,
    CatalogueFile,
    DiameterRange,
    ElementKindName,
    MinForce,
    Quiet,
)


def elements(
    kind: ElementKindName = None,
    min_force: MinForce = None,
    diameter: DiameterRange = None,
    catalogue: CatalogueFile = None,
    as_json: AsJson = False,
    quiet: Quiet = False,
) -> None:
    """List the gripper elements of the catalogue, and of a file of your own.

    Example: grasp-xl elements --kind magnet --diameter 20-40
    """
    from grasp_xl.cli import element_table, reporting, terminal
    from grasp_xl.commands.elements import list_elements
    from grasp_xl.fitment.catalogue import Wanted

    listed = list_elements(catalogue, Wanted(kind, min_force, diameter))
    if not quiet:
        terminal.warnings(listed.catalogue.warnings)
    if as_json:
        reporting.print_json(reporting.elements_json(listed))
    elif not quiet:
        element_table.show(listed)
