"""Looks of cells, each said once.

Colours are told apart by the colour-blind; the two gene rows are orange and green as in the
thesis's figure 34, cups cyan and magnets magenta as in its option-space pictures.
"""

from __future__ import annotations

from enum import Enum
from functools import cache
from typing import Any

from xlsxwriter import Workbook
from xlsxwriter.format import Format

FONT = "Arial"
FONT_SIZE, BOOK_FONT_SIZE = 9, 10
"""Of styles, and of cells without one (points)."""
FIXED_FONT = {"font_name": FONT, "font_scheme": "none"}
"""The font of every cell; with a scheme, Excel would show the theme's instead."""

CYAN = "#00A0B0"
MAGENTA = "#C2187A"
DARK_CYAN = "#005F6B"
DARK_MAGENTA = "#7A0B4A"
GREEN = "#2E8B57"
BLUE = "#1F5FBF"
RED = "#C8102E"
GREY = "#8A8A8A"
BLACK = "#202020"
SEQUENCE = ("#0072B2", "#E69F00", "#009E73", "#CC79A7", "#56B4E9", "#D55E00", "#F0E442", "#000000")
"""Colours of series, told apart by the colour-blind (Okabe and Ito)."""

BRIGHT = 140
"""Luma (0 to 255) from which black is easier to read on a colour than white."""

_LINE = {"border": 1, "border_color": "#BFBFBF"}
_BAND = {"top": 1, "bottom": 1, "top_color": "#BFBFBF", "bottom_color": "#BFBFBF"}
"""A heading's line over several cells: no upright lines through its text."""
_PALE = "#F3F5F7"
_COMPUTED = {**_LINE, "bg_color": _PALE, "shrink": True}
_TYPED = {"font_color": "#1F3FBF", "bold": True}
"""Genes that may be typed: their rows keep the thesis's colours."""
_INPUT = {**_LINE, "bg_color": "#FFF8D6", "font_color": "#1F3FBF", "shrink": True}
"""A number too long for its cell is written smaller, not as ###."""
_NUMBER = {**_COMPUTED, "align": "right"}
"""Right as well where a dash or a word stands for the number."""


class Style(Enum):
    """What a cell is: a name of its own, and its look."""

    @property
    def look(self) -> dict[str, Any]:
        """Format properties."""
        properties: dict[str, Any] = self.value[1]
        return properties

    TITLE = "title", {"bold": True, "font_size": 12}
    HEADING = "heading", {"bold": True, "bg_color": "#DCE6F1", **_BAND}
    CARD_TITLE = (
        "card_title",
        {"bold": True, "bg_color": "#24456B", "font_color": "#FFFFFF", **_BAND},
    )
    HEADER = "header", {"bold": True, "align": "center", "bg_color": "#EDEDED", **_LINE}
    STACKED_HEADER = (
        "stacked_header",
        {
            "bold": True,
            "align": "center",
            "valign": "vcenter",
            "text_wrap": True,
            "bg_color": "#EDEDED",
            **_LINE,
        },
    )
    LABEL = "label", {**_LINE, "indent": 1}
    UNIT = "unit", {"align": "center", "font_color": "#6A6A6A", "italic": True, **_LINE}
    NOTE = "note", {"font_color": "#5A5A5A", "italic": True}
    WARNING = "warning", {"font_color": "#B00020", "bold": True}
    INPUT = "input", {**_INPUT}
    INPUT_TEXT = "input_text", {**_INPUT, "align": "right"}
    INPUT_COORDINATE = "input_coordinate", {**_INPUT, "num_format": "0.0000"}
    INPUT_MEASURE = (
        "input_measure",
        {**_INPUT, "align": "right", "num_format": "#,##0.00####"},  # no round-off as 5E-14
    )
    SUCTION_GENE = "suction_gene", {"bg_color": "#FCD5B4", "align": "center", **_LINE}
    MAGNETS_GENE = "magnets_gene", {"bg_color": "#D8E4BC", "align": "center", **_LINE}
    TYPED_SUCTION_GENE = (
        "typed_suction_gene",
        {"bg_color": "#FCD5B4", "align": "center", **_LINE, **_TYPED},
    )
    TYPED_MAGNETS_GENE = (
        "typed_magnets_gene",
        {"bg_color": "#D8E4BC", "align": "center", **_LINE, **_TYPED},
    )
    MARK = "mark", {**_COMPUTED, "align": "center", "num_format": "0"}
    COUNT = "count", {**_NUMBER, "num_format": "#,##0"}
    COORDINATE = "coordinate", {**_NUMBER, "num_format": "0.0000"}
    TORQUE = "torque", {**_NUMBER, "num_format": "#,##0.00"}
    FORCE = "force", {**_NUMBER, "num_format": "#,##0.0000"}
    MONEY = "money", {**_NUMBER, "num_format": "#,##0.00"}
    DOLLARS = "dollars", {**_NUMBER, "num_format": '"$"#,##0.00'}
    NEWTON_MM = "newton_mm", {**_NUMBER, "num_format": '#,##0.00" N-mm"'}
    MM = "mm", {**_NUMBER, "num_format": '#,##0.00" mm"'}
    FINE_MM = "fine_mm", {**_NUMBER, "num_format": '0.0000" mm"'}
    RATIO = "ratio", {**_NUMBER, "num_format": "0.0000"}
    DRAWN = "drawn", {**_NUMBER, "num_format": "0.0000"}
    PERCENT = "percent", {**_NUMBER, "num_format": "0.00##%"}
    SHARE = "share", {**_NUMBER, "num_format": "0.00"}
    RESULT = "result", {**_NUMBER, "bold": True, "num_format": "#,##0.000"}
    DIVERGENCE = "divergence", {**_NUMBER, "bold": True, "num_format": "0.000"}
    TEXT = "text", {**_COMPUTED}
    LOGGED = (
        "logged",
        {**_COMPUTED, "shrink": False, "align": "left", "valign": "vcenter", "text_wrap": True},
    )
    ABOVE = "above", {"bg_color": "#FFE08A", "font_color": "#7A4B00", "bold": True}
    FAILS = "fails", {"bg_color": "#F8C9C4", "font_color": "#9C0006", "bold": True}
    PASSES = "passes", {"bg_color": "#C9EBD2", "font_color": "#00612E"}
    HIDDEN = "hidden", {"font_color": _PALE}
    STATUS = "status", {"bold": True, "text_wrap": True, "valign": "top"}
    DIFFERENCE = "difference", {**_NUMBER, "num_format": "0.0E+00;-0.0E+00;0"}
    CENTRED = "centred", {**_COMPUTED, "align": "center"}
    LEGEND = "legend", {"bold": True, "align": "center", "valign": "vcenter", "text_wrap": True}
    DATE = "date", {**_COMPUTED, "num_format": "yyyy-mm-dd hh:mm:ss", "align": "left"}


UNFORMATTED: dict[str, Any] = {
    "num_format": "General",
    "bg_color": None,
    "bold": False,
    "italic": False,
    "font_size": BOOK_FONT_SIZE,
    "font_color": "#000000",
    "align": "general",
    "valign": "bottom",
    "text_wrap": False,
    "border_color": None,
    "top_color": None,
    "bottom_color": None,
}
"""Format properties of a cell without a style: all that the look of one can change."""


@cache
def formats_of(style: Style) -> dict[str, Any]:
    """Return all format properties of a style; a border with a colour is a thin line."""
    look = {**UNFORMATTED, "font_size": FONT_SIZE, **style.look}
    if "indent" in look:  # which Excel does from the left
        look["align"] = "left"
    return {name: look[name] for name in UNFORMATTED}


def text_colour(fill: str) -> str:
    """Return black or white, whichever is easier to read on a colour.

    Examples
    --------
    >>> text_colour("#F0E442"), text_colour("#0072B2")
    ('#000000', '#FFFFFF')
    """
    red, green, blue = bytes.fromhex(fill.removeprefix("#"))
    return "#000000" if 0.299 * red + 0.587 * green + 0.114 * blue > BRIGHT else "#FFFFFF"


class Formats:
    """The styles as formats of one workbook, made when first used."""

    def __init__(self, book: Workbook) -> None:
        self._book = book
        self._made: dict[str, Format] = {}

    def over(self, style: Style) -> Format:
        """Return a style without a font, to lie over a cell's own."""
        return self._book.add_format(style.look)

    def filled(self, colour: str) -> Format:
        """Return a fill with a text that can be read on it, to lie over a cell's own."""
        return self._book.add_format({"bg_color": colour, "font_color": text_colour(colour)})

    def __getitem__(self, style: Style) -> Format:
        if style.name not in self._made:
            look = {**FIXED_FONT, "font_size": FONT_SIZE, **style.look}
            self._made[style.name] = self._book.add_format(look)
        return self._made[style.name]
