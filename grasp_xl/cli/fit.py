"""The command ``fit``."""

from __future__ import annotations

from grasp_xl.cli.fit_options import (
    Approach,
    Cup,
    CupAngle,
    CupCounts,
    CupFaces,
    CupPrice,
    Export,
    IgnoredLayers,
    LargestGap,
    ListFaces,
    Magnet,
    MagnetAngle,
    MagnetCounts,
    MagnetFaces,
    MagnetPrice,
    MaterialDensity,
    MaterialName,
    MinOverlap,
    PartFile,
    PartMass,
    PartNumber,
    Picture,
    Pitch,
    Polygon,
    Scale,
    Thickness,
    Units,
    Up,
)
from grasp_xl.cli.options import AsJson, CatalogueFile, Force, Quiet
from grasp_xl.errors import UsageError


def fit(
    file: PartFile,
    output: Export = None,
    list_faces: ListFaces = False,
    picture: Picture = None,
    cup: Cup = None,
    magnet: Magnet = None,
    cup_price: CupPrice = None,
    magnet_price: MagnetPrice = None,
    cup_faces: CupFaces = "all-up",
    magnet_faces: MagnetFaces = "all-up",
    cup_count: CupCounts = None,
    magnet_count: MagnetCounts = None,
    cup_angle: CupAngle = 0.0,
    magnet_angle: MagnetAngle = 0.0,
    min_overlap: MinOverlap = 0.0,
    catalogue: CatalogueFile = None,
    pitch: Pitch = 10.0,
    up: Up = None,
    approach: Approach = None,
    units: Units = None,
    thickness: Thickness = None,
    ignore_layer: IgnoredLayers = None,
    gap: LargestGap = None,
    part: PartNumber = None,
    material: MaterialName = None,
    density: MaterialDensity = None,
    mass: PartMass = None,
    polygon: Polygon = "auto",
    scale: Scale = 0.6,
    force: Force = False,
    as_json: AsJson = False,
    quiet: Quiet = False,
) -> None:
    """Find every place where an element can stand on a part, and write the exported sheet.

    Example: grasp-xl fit part.step -o export.xlsx --cup "SAF 40 NBR-60 M10-AG" --cup-price 10
    """
    from grasp_xl.cli import fit_report
    from grasp_xl.commands import fit as command
    from grasp_xl.fitment.part_file import Reading

    reading = Reading(up, approach, units, thickness, tuple(ignore_layer or ()), gap, part)
    if list_faces:
        place = picture or file.with_name(f"{file.stem}-faces.svg")
        found = command.list_faces(file, reading, place, force=force)
        fit_report.faces(found, place, as_json=as_json, quiet=quiet)
        return
    if output is None:
        raise UsageError(
            "No file to write was named.", where="-o", hint="Name it with -o FILE.xlsx"
        )
    of_cups = (cup_price, cup_faces, cup_count or command.USUAL_COUNT, cup_angle)
    of_magnets = (magnet_price, magnet_faces, magnet_count or command.USUAL_COUNT, magnet_angle)
    request = command.Request(
        file,
        reading,
        command.Mass(material, density, mass),
        command.Wanted(cup, *of_cups) if cup else None,
        command.Wanted(magnet, *of_magnets) if magnet else None,
        catalogue,
        pitch,
        polygon,
        scale,
        min_overlap,
    )
    fitted = command.fit_file(request, output, force=force)
    fit_report.fitted(fitted, output, as_json=as_json, quiet=quiet)
