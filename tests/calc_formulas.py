"""Formulas in Excel's words and in LibreOffice's, which separate arguments by ``;``."""

from __future__ import annotations

import re

_TEXT = r'"(?:[^"]|"")*"|#[A-Z]+(?:/[A0])?[!?]?'  # and errors: they stay as they are
_SHEET = r"'(?:[^']|'')+'"
_OF_CALC = re.compile(
    rf"{_TEXT}|\$?({_SHEET}|[^\W\d]\w*)\.(?=\$?[A-Z]{{1,3}}(?:\$?\d|:)|\$?\d+:|#REF!)|\b(?:TRUE|FALSE)\(\)|[{{}};|~!]"
)
_OF_EXCEL = re.compile(
    rf"{_TEXT}|({_SHEET}|[^\W\d][\w.]*)!|_xlfn\.|\b(?i:TRUE|FALSE)\b(?!\()|[{{}};,]"
)
_PLAIN_SHEET = re.compile(r"(?![A-Z]{1,3}\d+$|R\d*C?\d*$|C\d*$)[^\W\d][\w.]*", re.IGNORECASE)


def to_excel(formula: str) -> str:
    """Turn LibreOffice's way to write a formula into Excel's.

    Examples
    --------
    >>> print(to_excel("=SUM($'A B'.$C$1;$Calc.D2;{1;2|3;4})"))
    =SUM('A B'!$C$1,Calc!D2,{1,2;3,4})
    """
    formula = formula[1:-1] if formula.startswith("{=") else formula  # of a whole block of cells
    signs = {";": ",", "|": ";", "~": ",", "!": " ", "TRUE()": "TRUE", "FALSE()": "FALSE"}

    def change(part: re.Match[str]) -> str:
        return f"{sheet_in_excel(part[1])}!" if part[1] else signs.get(part[0], part[0])

    return _OF_CALC.sub(change, formula)


def to_calc(formula: str) -> str:
    """Turn Excel's way to write a formula into LibreOffice's.

    Examples
    --------
    >>> print(to_calc("=SUM('A B'!$C$1,Calc!D2,{1,2;3,4})"))
    =SUM($'A B'.$C$1;$'Calc'.D2;{1;2|3;4})
    """
    inside = False  # of a constant array

    def change(part: re.Match[str]) -> str:
        nonlocal inside
        if part[1]:
            name = part[1] if part[1].startswith("'") else f"'{part[1]}'"
            return f"${name}."
        if part[0] in "{}":
            inside = part[0] == "{"
        if part[0].upper() in ("TRUE", "FALSE"):  # else LibreOffice makes a number of it
            return f"{part[0]}()"
        signs = {",": ";", ";": "|" if inside else ";", "_xlfn.": ""}
        return signs.get(part[0], part[0])

    return _OF_EXCEL.sub(change, formula)


def sheet_in_excel(name: str) -> str:
    """Write a sheet's name as Excel does: in quotes only where they are needed."""
    plain = name.strip("'")
    return plain if _PLAIN_SHEET.fullmatch(plain) else f"'{plain}'"
