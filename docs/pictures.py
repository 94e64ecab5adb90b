"""Make the pictures of the documentation from a sample's result, as programs show it.

Run ``python docs/pictures.py``; it needs LibreOffice (soffice), poppler (pdftoppm), and Chromium.
"""

from __future__ import annotations

import subprocess
import tempfile
from pathlib import Path

from PIL import Image, ImageChops

from grasp_xl.cli.program import main as main_program

DOCS = Path(__file__).parent
RESULT = DOCS.parent / "workbooks" / "bracket-result.xlsx"
DPI = 400

CARD_WIDTH, GAP = 19 + 6 * 9, 2
"""Widths on the sheet GA, in characters: a card, and what is between the two on a page."""


def rendered(folder: Path, title: str) -> Image.Image:
    """Return the page that has a title, without its margins, header and footer."""
    command = ["soffice", "--headless", "--convert-to", "pdf", "--outdir", str(folder), str(RESULT)]
    subprocess.run(command, check=True, capture_output=True)
    pdf = folder / f"{RESULT.stem}.pdf"
    told = subprocess.run(["pdftotext", pdf, "-"], check=True, capture_output=True, text=True)
    number = next(n for n, page in enumerate(told.stdout.split("\f"), 1) if title in page)
    pages = ["-f", str(number), "-l", str(number), "-r", str(DPI), "-png", "-singlefile"]
    subprocess.run(["pdftoppm", *pages, pdf, folder / "page"], check=True)
    page = Image.open(folder / "page.png").convert("RGB")
    page = page.crop((0, int(page.height * 0.052), page.width, int(page.height * 0.93)))
    return trimmed(page)


def page_picture(folder: Path) -> Image.Image:
    """Return what a browser shows of the page of ``grasp-xl view``."""
    page, picture = folder / "page.html", folder / "view.png"
    if main_program(["view", str(RESULT), "-o", str(page), "--quiet"]):
        raise SystemExit(1)
    command = ["chromium", "--headless=new", "--no-sandbox", "--use-angle=swiftshader"]
    command += ["--enable-unsafe-swiftshader", "--window-size=1400,900", "--hide-scrollbars"]
    command += ["--virtual-time-budget=20000", f"--screenshot={picture}", page.as_uri()]
    subprocess.run(command, check=True, capture_output=True)
    return Image.open(picture).convert("RGB")


def trimmed(picture: Image.Image) -> Image.Image:
    """Return a picture without its white frame."""
    white = Image.new("RGB", picture.size, "white")
    return picture.crop(ImageChops.difference(picture, white).getbbox())


def main() -> None:
    """Write the pictures beside this file."""
    with tempfile.TemporaryDirectory() as folder:
        cards = rendered(Path(folder), "Child 1 (Elite)")
        right = cards.width * (CARD_WIDTH + GAP / 2) / (2 * CARD_WIDTH + GAP)
        card = trimmed(cards.crop((0, 0, int(right), cards.height)))
        card.save(DOCS / "card.png", optimize=True)
        grasp = rendered(Path(folder), "GRASP: ")
        grasp.thumbnail((1800, 1800))
        grasp.save(DOCS / "grasp.png", optimize=True)
        page_picture(Path(folder)).save(DOCS / "view.png", optimize=True)


if __name__ == "__main__":
    main()
