"""Outlines of random bodies: sides and arcs, from which the nodes of the boundary follow."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from studies.random_bodies.draws import Draws

Floats = NDArray[np.float64]
Point = tuple[float, float]
FINE = 16
"""Edges of an arc before the outline has nodes."""


@dataclass(frozen=True)
class Piece:
    """A side, or an arc that turns about a centre by an angle (rad)."""

    start: Point
    end: Point
    centre: Point | None = None
    angle: float = 0.0

    @property
    def length(self) -> float:
        """Its length (m)."""
        if self.centre is None:
            return math.dist(self.start, self.end)
        return math.dist(self.start, self.centre) * abs(self.angle)

    def at(self, part: Floats) -> Floats:
        """Give points at these parts of its length, from 0 at the start to 1; ends are exact."""
        start, end = np.array(self.start), np.array(self.end)
        points: Floats
        if self.centre is None:
            points = start + part[:, None] * (end - start)
        else:
            (x, y), turned = start - np.array(self.centre), part * self.angle
            points = np.asarray(self.centre) + np.stack([x * np.cos(turned) - y * np.sin(turned), x * np.sin(turned) + y * np.cos(turned)], axis=1)
        points[part == 0.0], points[part == 1.0] = start, end
        return points

    @property
    def parts(self) -> Floats:
        """Parts of its length at which its place is known well enough."""
        return np.linspace(0.0, 1.0, 2 if self.centre is None else FINE + 1)


Loop = tuple[Piece, ...]


@dataclass(frozen=True)
class Shape:
    """A body that is bounded by an outline and by holes."""

    name: str
    loops: tuple[Loop, ...]
    """The outline, then the holes."""
    narrowest: float
    """Width of its narrowest part (m)."""
    grid: tuple[int, int] | None = None
    """Into how many equal cells the rectangle around it is cut, so that the body consists of cells."""

    def outlines(self, parts: Callable[[Piece], Floats] = lambda piece: piece.parts) -> list[Floats]:
        """Give the polygon of each loop, with points at the given parts of each piece."""
        return [np.concatenate([piece.at(parts(piece)[:-1]) for piece in loop]) for loop in self.loops]

    @property
    def area(self) -> float:
        """Its area (m²)."""
        first, *holes = (abs(_area(outline)) for outline in self.outlines())
        return first - sum(holes)

    @property
    def perimeter(self) -> float:
        """Length of all loops (m)."""
        return sum(piece.length for loop in self.loops for piece in loop)

    @property
    def diagonal(self) -> float:
        """Diagonal of the rectangle around it (m)."""
        return float(np.linalg.norm(np.ptp(self.outlines()[0], axis=0)))

    def inside(self, points: Floats) -> NDArray[np.bool_]:
        """Say which points are inside, by the number of crossings to the right."""
        crossings = np.zeros(len(points), dtype=int)
        x, y = points.T[:, :, None]
        for outline in self.outlines():
            (x0, y0), (x1, y1) = outline.T, np.roll(outline, -1, axis=0).T
            # Level sides are never between.
            rise = np.where(y0 == y1, 1.0, y1 - y0)
            crossings += (((y < y0) != (y < y1)) & (x < x0 + (y - y0) * ((x1 - x0) / rise))).sum(axis=1)
        odd: NDArray[np.bool_] = crossings % 2 == 1
        return odd

    def lowest(self, tilt: float) -> Floats:
        """Give the ends of the lowest part of the body after a turn by an angle (rad): the same point twice if it is one."""
        outline = self.outlines()[0]
        height = outline @ np.array([math.sin(tilt), math.cos(tilt)])
        low = outline[height < height.min() + 1e-9 * self.diagonal]
        along = low @ np.array([math.cos(tilt), -math.sin(tilt)])
        ends: Floats = low[[int(along.argmin()), int(along.argmax())]]
        return ends


def _area(outline: Floats) -> float:
    """Give the area of a polygon, positive if it is counterclockwise."""
    x, y = outline.T
    return 0.5 * float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)))


def _polygon(points: Sequence[Point]) -> Loop:
    return tuple(Piece(a, b) for a, b in zip(points, [*points[1:], points[0]], strict=True))


def _box(width: float, height: float, x: float = 0.0, y: float = 0.0) -> Loop:
    return _polygon([(x, y), (x + width, y), (x + width, y + height), (x, y + height)])


def _circle(centre: Point, radius: float) -> Loop:
    """Make a circle that begins at its lowest point."""
    x, y = centre
    ends = [(x, y - radius), (x + radius, y), (x, y + radius), (x - radius, y)]
    return tuple(Piece(a, b, centre, math.pi / 2) for a, b in zip(ends, [*ends[1:], ends[0]], strict=True))


def _rounded(width: float, height: float, radius: float) -> Loop:
    """Make a rectangle with round corners; where sides have no length, they are left out."""
    w, h, r, quarter = width, height, radius, math.pi / 2
    pieces = (
        Piece((r, 0.0), (w - r, 0.0)),
        Piece((w - r, 0.0), (w, r), (w - r, r), quarter),
        Piece((w, r), (w, h - r)),
        Piece((w, h - r), (w - r, h), (w - r, h - r), quarter),
        Piece((w - r, h), (r, h)),
        Piece((r, h), (0.0, h - r), (r, h - r), quarter),
        Piece((0.0, h - r), (0.0, r)),
        Piece((0.0, r), (r, 0.0), (r, r), quarter),
    )
    return tuple(piece for piece in pieces if piece.length > 1e-6 * w)


def rectangle(draws: Draws, size: float) -> Shape:
    """Make a rectangle up to 2.5 times as wide as high, or as high as wide."""
    rows, columns = draws.whole(2, 5), draws.whole(2, 5)
    unit = size / max(rows, columns)
    width, height = columns * unit, rows * unit
    return Shape("rectangle", (_box(width, height),), min(width, height), (columns, rows))


def beam(draws: Draws, size: float) -> Shape:
    """Make a beam of 3:1 to 8:1."""
    ratio = draws.whole(3, 8)
    return Shape("beam", (_box(size, size / ratio),), size / ratio, (2 * ratio, 2))


def angle(draws: Draws, size: float) -> Shape:
    """Make an L with legs of different lengths."""
    width, height, leg = draws.whole(4, 8), draws.whole(4, 8), draws.whole(1, 3)
    unit = size / max(width, height)
    w, h, t = width * unit, height * unit, leg * unit
    points = [(0.0, 0.0), (w, 0.0), (w, t), (t, t), (t, h), (0.0, h)]
    return Shape("L", (_polygon(points),), t, (width, height))


def bracket(draws: Draws, size: float) -> Shape:
    """Make a U."""
    width, height, leg = draws.whole(5, 8), draws.whole(4, 8), draws.whole(1, 2)
    unit = size / max(width, height)
    w, h, t = width * unit, height * unit, leg * unit
    points = [(0.0, 0.0), (w, 0.0), (w, h), (w - t, h), (w - t, t), (t, t), (t, h), (0.0, h)]
    return Shape("bracket", (_polygon(points),), t, (width, height))


def frame(draws: Draws, size: float) -> Shape:
    """Make a closed frame."""
    width, height, leg = draws.whole(5, 8), draws.whole(5, 8), draws.whole(1, 2)
    unit = size / max(width, height)
    w, h, t = width * unit, height * unit, leg * unit
    return Shape("frame", (_box(w, h), _box(w - 2 * t, h - 2 * t, t, t)), t, (width, height))


def disc(draws: Draws, size: float) -> Shape:
    """Make a disc."""
    return Shape("disc", (_circle((0.0, 0.0), 0.5 * size),), 0.5 * size)


def ring(draws: Draws, size: float) -> Shape:
    """Make a ring."""
    radius, inner = 0.5 * size, draws.uniform(0.3, 0.75)
    return Shape("ring", (_circle((0.0, 0.0), radius), _circle((0.0, 0.0), inner * radius)), (1.0 - inner) * radius)


def pierced(draws: Draws, size: float) -> Shape:
    """Make a plate with a hole somewhere."""
    height = draws.uniform(0.5, 1.0) * size
    radius = draws.uniform(0.1, 0.28) * height
    wall = draws.uniform(0.12, 0.3) * height
    centre = draws.uniform(radius + wall, size - radius - wall), draws.uniform(radius + wall, height - radius - wall)
    return Shape("pierced plate", (_box(size, height), _circle(centre, radius)), wall)


def half_disc(draws: Draws, size: float) -> Shape:
    """Make a half disc that is round below."""
    radius = 0.5 * size
    ends = [(-radius, 0.0), (0.0, -radius), (radius, 0.0)]
    arcs = [Piece(a, b, (0.0, 0.0), math.pi / 2) for a, b in zip(ends, ends[1:], strict=False)]
    return Shape("half disc", ((*arcs, Piece(ends[2], ends[0])),), 0.5 * size)


def rounded(draws: Draws, size: float) -> Shape:
    """Make a block with round corners; it may be a capsule."""
    height = draws.uniform(0.4, 1.0) * size
    radius = 0.5 * height if draws.chance(0.25) else draws.uniform(0.08, 0.45) * height
    return Shape("rounded block", (_rounded(size, height, radius),), height)


def polygon(draws: Draws, size: float) -> Shape:
    """Make a convex polygon of 3 to 8 corners on an ellipse, none of them sharper than 30°."""
    count, flat = draws.whole(3, 8), draws.uniform(0.6, 1.0)
    places = (np.arange(count) + 0.6 * draws.array(count)) * 2.0 * math.pi / count
    points = 0.5 * size * np.stack([np.cos(places), flat * np.sin(places)], axis=1)
    before, after = (np.roll(points, shift, axis=0) - points for shift in (1, -1))
    cosines = (before * after).sum(axis=1) / np.linalg.norm(before, axis=1) / np.linalg.norm(after, axis=1)
    if cosines.max() > math.cos(math.radians(30.0)):
        return polygon(draws, size)
    corners = [(float(x), float(y)) for x, y in points]
    return Shape("polygon", (_polygon(corners),), 0.4 * float(np.ptp(points, axis=0).min()))


def trapezoid(draws: Draws, size: float) -> Shape:
    """Make a trapezoid on its short side, or on its long one."""
    short, height = draws.uniform(0.15, 0.8) * size, draws.uniform(0.3, 0.9) * size
    skew = draws.uniform(0.0, 1.0) * (size - short)
    low, high = (0.0, size), (skew, skew + short)
    if draws.chance(0.6):
        low, high = high, low
    points = [(low[0], 0.0), (low[1], 0.0), (high[1], height), (high[0], height)]
    return Shape("trapezoid", (_polygon(points),), min(short, height))


SHAPES: dict[str, Callable[[Draws, float], Shape]] = {
    "rectangle": rectangle,
    "beam": beam,
    "L": angle,
    "bracket": bracket,
    "frame": frame,
    "disc": disc,
    "ring": ring,
    "pierced plate": pierced,
    "half disc": half_disc,
    "rounded block": rounded,
    "polygon": polygon,
    "trapezoid": trapezoid,
}
"""Makers of shapes of a size (m), by name."""
