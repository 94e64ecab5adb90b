"""Which triangle of many is seen at each pixel of a picture, and how its surface lies there."""

from __future__ import annotations

import math

import numpy as np

from grasp_xl.compiled import compiled
from grasp_xl.space import FloatArray, IntArray

NOTHING = -1
"""Number of the triangle where there is none."""


@compiled
def fill(
    corners: FloatArray,
    normals: FloatArray,
    depth: FloatArray,
    seen: IntArray,
    normal_at: FloatArray,
) -> None:
    """Draw triangles into a picture: of several at a pixel the nearest is seen.

    Parameters
    ----------
    corners, normals : FloatArray
        ``(n, 3, 3)``: x, y (pixels, from the top left) and nearness of the corners; normals there.
    depth : FloatArray
        ``(height, width)``: nearness of what is seen, ``-inf`` where nothing is; changed.
    seen : IntArray
        ``(height, width)``: its number; changed.
    normal_at : FloatArray
        ``(height, width, 3)``: its normal, not of unit length; changed.
    """
    height, width = depth.shape
    for number in range(len(corners)):
        (ax, ay, az), (bx, by, bz), (cx, cy, cz) = corners[number]
        area = (bx - ax) * (cy - ay) - (cx - ax) * (by - ay)
        if area == 0.0:
            continue
        left = max(0, math.ceil(min(ax, bx, cx)))
        right = min(width - 1, math.floor(max(ax, bx, cx)))
        top = max(0, math.ceil(min(ay, by, cy)))
        bottom = min(height - 1, math.floor(max(ay, by, cy)))
        for y in range(top, bottom + 1):
            for x in range(left, right + 1):
                b = ((x - ax) * (cy - ay) - (cx - ax) * (y - ay)) / area
                c = ((bx - ax) * (y - ay) - (x - ax) * (by - ay)) / area
                a = 1.0 - b - c
                if a < 0.0 or b < 0.0 or c < 0.0:
                    continue
                near = a * az + b * bz + c * cz
                if near > depth[y, x]:
                    depth[y, x] = near
                    seen[y, x] = number
                    for axis in range(3):
                        normal_at[y, x, axis] = (
                            a * normals[number, 0, axis]
                            + b * normals[number, 1, axis]
                            + c * normals[number, 2, axis]
                        )


def empty(height: int, width: int) -> tuple[FloatArray, IntArray, FloatArray]:
    """Return the depth, the numbers and the normals of a picture of nothing."""
    return (
        np.full((height, width), -np.inf),
        np.full((height, width), NOTHING, dtype=np.int64),
        np.zeros((height, width, 3)),
    )
