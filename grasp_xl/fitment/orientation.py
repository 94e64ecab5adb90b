"""How a part is turned so that the axis of its file that looks up becomes z."""

from __future__ import annotations

from grasp_xl.space import FloatArray, frozen

_ROWS = {
    "+z": ((1, 0, 0), (0, 1, 0), (0, 0, 1)),
    "-z": ((1, 0, 0), (0, -1, 0), (0, 0, -1)),
    "+y": ((1, 0, 0), (0, 0, -1), (0, 1, 0)),
    "-y": ((1, 0, 0), (0, 0, 1), (0, -1, 0)),
    "+x": ((0, 1, 0), (0, 0, 1), (1, 0, 0)),
    "-x": ((0, 1, 0), (0, 0, -1), (-1, 0, 0)),
}
"""New x, y and z in the file's coordinates: x stays x where it can, and none is a mirror image."""


def rotation(up: str) -> FloatArray:
    """Return the ``(3, 3)`` rotation after which an axis of the file is z.

    Examples
    --------
    >>> rotation("+y") @ [1, 2, 3]
    array([ 1., -3.,  2.])
    """
    return frozen(_ROWS[up])
