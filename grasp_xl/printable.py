"""Text of somebody's file, made fit for a terminal."""

from __future__ import annotations


def printable(text: str) -> str:
    r"""Show control characters, and others that print nothing, by their escapes.

    Examples
    --------
    >>> print(printable("SAF\t40\x1b[31m"), printable("Größe 46"))
    SAF\t40\x1b[31m Größe 46
    >>> printable("")
    ''
    """
    return "".join(
        letter if letter.isprintable() else letter.encode("unicode_escape").decode("ascii")
        for letter in text
    )


def quoted(text: str, most: int = 40) -> str:
    r"""Quote a text in a message, cut where it is long.

    Examples
    --------
    >>> print(quoted("it's\n"), quoted("long " * 20, most=12))
    'it's\n' 'long long lo...'
    """
    cut = f"{text[:most]}..." if len(text) > most else text
    return f"'{printable(cut)}'"
