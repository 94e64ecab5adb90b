"""Plane figures with rounded corners: outlines, holes and profiles of the sample parts (mm)."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple, TypeVar

T = TypeVar("T")

Place = tuple[float, float]
"""A point of the plane (mm)."""


class Corner(NamedTuple):
    """A corner of a figure, and the radius with which it is rounded (mm)."""

    x: float
    y: float
    radius: float = 0.0


Figure = tuple[Corner, ...]
"""Corners of a closed outline, counter-clockwise."""


class Arc(NamedTuple):
    """Where the arc of a corner begins, its middle, and where it ends (mm)."""

    begin: Place
    middle: Place
    end: Place


def rounded(places: Iterable[Place], radius: float) -> Figure:
    """Return a figure whose convex corners are rounded; the places go counter-clockwise (mm)."""
    figure = []
    for (x0, y0), (x, y), (x1, y1) in _neighbours(list(places)):
        turn = (x - x0) * (y1 - y) - (y - y0) * (x1 - x)
        figure.append(Corner(x, y, radius if turn > 0 else 0.0))
    return tuple(figure)


def rectangle(x: Place, y: Place, radius: float = 0.0) -> Figure:
    """Return the rectangle over the ranges x and y, with rounded corners (mm)."""
    return rounded([(x[0], y[0]), (x[1], y[0]), (x[1], y[1]), (x[0], y[1])], radius)


def disc(place: Place, diameter: float) -> Figure:
    """Return the circle about a place, a square of quarter circles (mm)."""
    (x, y), radius = place, diameter / 2
    return rectangle((x - radius, x + radius), (y - radius, y + radius), radius)


def mirrored(figure: Figure, x: int = -1, y: int = 1) -> Figure:
    """Return the mirror image about x = 0, or about the axes whose factor is -1."""
    image = tuple(Corner(x * corner.x, y * corner.y, corner.radius) for corner in figure)
    return image if x * y > 0 else image[::-1]


def in_four_quadrants(figure: Figure) -> list[Figure]:
    """Return a figure and its mirror images about both axes."""
    return [mirrored(figure, x, y) for x in (1, -1) for y in (1, -1)]


def arcs(figure: Figure) -> list[Arc]:
    """Return the arcs that touch both sides of each corner; a point where its radius is 0.

    Examples
    --------
    >>> arcs((Corner(0, 0, 2), Corner(9, 0), Corner(0, 9)))[0]
    Arc(begin=(0.0, 2.0), middle=(0.5857864376269051, 0.5857864376269051), end=(2.0, 0.0))
    """
    return [_arc(*corners) for corners in _neighbours(figure)]


def _arc(before: Corner, corner: Corner, after: Corner) -> Arc:
    (ax, ay), (bx, by) = _direction(corner, before), _direction(corner, after)
    cosine = ax * bx + ay * by
    along = corner.radius * math.sqrt((1 + cosine) / (1 - cosine))  # radius / tan(half the angle)
    to_centre = corner.radius * math.sqrt(2 / (1 - cosine))  # radius / sin(half the angle)
    to_middle = (to_centre - corner.radius) / math.hypot(ax + bx, ay + by)
    return Arc(
        (corner.x + along * ax, corner.y + along * ay),
        (corner.x + to_middle * (ax + bx), corner.y + to_middle * (ay + by)),
        (corner.x + along * bx, corner.y + along * by),
    )


def _direction(start: Corner, end: Corner) -> Place:
    length = math.hypot(end.x - start.x, end.y - start.y)
    return (end.x - start.x) / length, (end.y - start.y) / length


def _neighbours(corners: Sequence[T]) -> Iterator[tuple[T, T, T]]:
    """Yield each corner between the one before and the one after it."""
    return zip([corners[-1], *corners[:-1]], corners, [*corners[1:], corners[0]], strict=True)
