"""Random meshes of a shape: cells cut in two, Delaunay triangles of jittered points, or those of Gmsh; graded towards a place."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import percute as pc
from numpy.typing import NDArray
from studies.random_bodies.draws import Draws
from studies.random_bodies.shapes import Floats, Piece, Shape

Integers = NDArray[np.int64]
MOST = 1500
"""Most elements of a mesh."""
PER_AREA = 4.0 / math.sqrt(3.0)
"""Elements on the area of the square of their size."""
ACROSS = 2.0
"""Fewest elements across the narrowest part."""
SMOOTHED = 3
"""How often the inner nodes of Delaunay meshes move to the mean of their neighbours."""
LEAST_ANGLE = 12.0
"""The smallest angle (°) of a mesh that is accepted."""


class NoMesh(Exception):
    """A mesh that cannot be made, or is not good enough: the body is drawn again."""


@dataclass(frozen=True, eq=False)
class Sizes:
    """Sizes of elements (m) that grow with the distance from a place."""

    place: Floats
    """Both ends of the place, shape (2, 2)."""
    smallest: float
    largest: float
    slope: float

    def at(self, points: Floats) -> Floats:
        """Give the size at points."""
        a, b = self.place
        length = float((b - a) @ (b - a))
        part = np.clip((points - a) @ (b - a) / length, 0.0, 1.0) if length > 0.0 else np.zeros(len(points))
        distance = np.linalg.norm(points - a - part[:, None] * (b - a), axis=1)
        sizes: Floats = np.minimum(self.largest, self.smallest + self.slope * distance)
        return sizes

    def leaves(self, shape: Shape) -> tuple[Floats, Floats]:
        """Cut the square around a shape into squares of these sizes at most; give centres inside it, and sides."""
        outline = shape.outlines()[0]
        # Shifted, so that no line of squares lies on a side.
        centres = outline.mean(axis=0)[None] + 0.0137 * self.largest
        sides = np.array([2.2 * shape.diagonal])
        while True:
            coarse = sides > self.at(centres)
            if not coarse.any():
                keep = shape.inside(centres)
                return centres[keep], sides[keep]
            quarters = np.array([[-0.25, -0.25], [0.25, -0.25], [-0.25, 0.25], [0.25, 0.25]])
            cut = (centres[coarse][:, None] + sides[coarse][:, None, None] * quarters).reshape(-1, 2)
            centres = np.concatenate([centres[~coarse], cut])
            sides = np.concatenate([sides[~coarse], np.repeat(0.5 * sides[coarse], 4)])

    def count(self, shape: Shape) -> float:
        """Give the number of elements of such sizes, to some per cent."""
        centres, sides = self.leaves(shape)
        return PER_AREA * float(np.sum((sides / self.at(centres)) ** 2))

    def parts(self, piece: Piece) -> Floats:
        """Give the places of nodes on a piece of the outline, an arc in two edges at least."""
        fine = np.linspace(0.0, 1.0, 4001)
        density = piece.length / self.at(piece.at(fine))
        total = np.concatenate([[0.0], np.cumsum(0.5 * (density[1:] + density[:-1]) * np.diff(fine))])
        count = max(1 if piece.centre is None else 2, round(float(total[-1])))
        parts: Floats = np.interp(np.linspace(0.0, total[-1], count + 1), total, fine)
        parts[0], parts[-1] = 0.0, 1.0
        return parts


def sized(shape: Shape, place: Floats, elements: int, grading: float, slope: float) -> Sizes:
    """Choose sizes for about so many elements; of less grading where the mesh would have too many."""
    while grading >= 1.0:
        low, high = math.log(1e-3 * shape.diagonal), math.log(shape.narrowest / ACROSS)
        # 10 halvings: to less than a hundredth of the size.
        for _ in range(10):
            middle = 0.5 * (low + high)
            largest = math.exp(middle)
            many = Sizes(place, largest / grading, largest, slope).count(shape) > elements
            low, high = (middle, high) if many else (low, middle)
        found = Sizes(place, math.exp(high) / grading, math.exp(high), slope)
        # The estimate of the number may be too low.
        if found.count(shape) < 0.8 * MOST:
            return found
        grading *= 0.7
    raise NoMesh("too many elements")


def of_cells(shape: Shape, elements: int, place: Floats, grading: float, slope: float, mirrored: bool) -> pc.Mesh:
    """Make a mesh of equal cells, cut along either diagonal, or of a disc in rings, and refine it towards a place."""
    if shape.grid is None:
        radius = 0.5 * float(np.ptp(shape.outlines()[0][:, 0]))
        mesh = pc.Mesh.disc(radius, rings=max(4, round(math.sqrt(elements / 6.0))))
    else:
        nx, ny = shape.grid
        (left, low), (right, top) = shape.outlines()[0].min(axis=0), shape.outlines()[0].max(axis=0)
        inside = shape.area / ((right - left) * (top - low))
        times = max(1, round(math.sqrt(elements / (2 * nx * ny * inside))))
        mesh = _kept(shape, pc.Mesh.rectangle(right - left, top - low, nx=times * nx, ny=times * ny), right - left if mirrored else 0.0)
    sides = longest(mesh) / math.sqrt(2.0)
    return refined(mesh, Sizes(place, float(sides.max()) / grading, float(sides.max()), slope), MOST)


def _kept(shape: Shape, mesh: pc.Mesh, mirror: float) -> pc.Mesh:
    """Leave out cells that are outside the shape, mirrored at first if a width is given."""
    points = np.stack([mirror - mesh.points[:, 0], mesh.points[:, 1]], axis=1) if mirror else mesh.points
    used, cells = np.unique(mesh.cells[shape.inside(points[mesh.cells].mean(axis=1))], return_inverse=True)
    return pc.Mesh(points[used], cells.reshape(-1, 3))


def edges(mesh: pc.Mesh) -> Floats:
    """Give the lengths of the edges of each element (m)."""
    nodes = mesh.points[mesh.cells]
    found: Floats = np.linalg.norm(nodes - np.roll(nodes, 1, axis=1), axis=2)
    return found


def longest(mesh: pc.Mesh) -> Floats:
    """Give the longest edge of each element (m)."""
    found: Floats = edges(mesh).max(axis=1)
    return found


def refined(mesh: pc.Mesh, sizes: Sizes, most: int) -> pc.Mesh:
    """Refine a mesh to the sizes at its nodes, with so many elements at most."""
    while True:
        wanted = sizes.at(mesh.points)[mesh.cells].min(axis=1)
        # Half a square has the size of its sides. Rounding must not decide.
        coarse = longest(mesh) / math.sqrt(2.0) > 1.0001 * wanted
        if not coarse.any():
            return mesh
        mesh = mesh.refine(where=coarse)
        if len(mesh.cells) > most:
            raise NoMesh("too many elements")


def delaunay(shape: Shape, sizes: Sizes, draws: Draws) -> pc.Mesh:
    """Triangulate the nodes of the outline, and jittered points inside it."""
    outlines = shape.outlines(sizes.parts)
    pieces, start = [], 0
    for outline in outlines:
        numbers = start + np.arange(len(outline))
        pieces.append(np.stack([numbers, np.roll(numbers, -1)], axis=1))
        start += len(outline)
    ring, boundary = np.concatenate(pieces), np.concatenate(outlines)
    points = np.concatenate([boundary, _jittered(shape, sizes, boundary, ring, draws)])
    for _ in range(SMOOTHED):
        sums, counts = np.zeros_like(points), np.zeros(len(points))
        sides = _triangles(shape, points, ring)[:, [[0, 1], [1, 2], [2, 0], [1, 0], [2, 1], [0, 2]]].reshape(-1, 2)
        np.add.at(sums, sides[:, 0], points[sides[:, 1]])
        np.add.at(counts, sides[:, 0], 1.0)
        inner = np.arange(len(boundary), len(points))
        points[inner] = sums[inner] / counts[inner, None]
    return pc.Mesh(points, _triangles(shape, points, ring))


def _jittered(shape: Shape, sizes: Sizes, boundary: Floats, ring: Integers, draws: Draws) -> Floats:
    """Give points inside the shape, none of them near the outline or near another one."""
    centres, sides = sizes.leaves(shape)
    points = centres + 0.5 * sides[:, None] * (draws.array(len(centres), 2) - 0.5)
    a, along = boundary[ring[:, 0]], boundary[ring[:, 1]] - boundary[ring[:, 0]]
    length = np.linalg.norm(along, axis=1)
    part = np.clip(((points[:, None] - a) * along).sum(axis=2) / length**2, 0.0, 1.0)
    distance = np.linalg.norm(points[:, None] - a - part[..., None] * along, axis=2)
    # Outside the circles about edges as diameters, edges are in the triangulation; by a margin, triangles are not flat.
    free = (distance > 0.6 * np.maximum(length, sides[:, None])).all(axis=1) & shape.inside(points)
    points, sides = points[free], sides[free]
    kept: list[int] = []
    for i in np.argsort(sides, kind="stable").tolist():
        if not kept or np.linalg.norm(points[kept] - points[i], axis=1).min() > 0.6 * sides[i]:
            kept.append(i)
    chosen: Floats = points[kept]
    return chosen


def _triangles(shape: Shape, points: Floats, ring: Integers) -> Integers:
    """Give the Delaunay triangles inside the shape, of which the outline must consist of the given edges."""
    try:
        from matplotlib.tri import Triangulation
    except ImportError as error:
        raise pc.InputError(f"random bodies need matplotlib: pip install 'percute[plot]' ({error})") from None
    scale = float(np.ptp(points, axis=0).max())
    cells: Integers = Triangulation(*(points / scale).T).triangles.astype(np.int64)
    a, b, c = (points[cells[:, k]] for k in range(3))
    doubled = np.abs((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0])
    longest = np.max([np.linalg.norm(p - q, axis=1) for p, q in ((a, b), (b, c), (c, a))], axis=0)
    # Nodes along a side make triangles without area.
    cells = cells[(doubled > 1e-6 * longest**2) & shape.inside((a + b + c) / 3.0)]
    sides, counts = np.unique(np.sort(cells[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)), axis=0, return_counts=True)
    if len(np.unique(cells)) < len(points) or not np.array_equal(sides[counts == 1], np.unique(np.sort(ring), axis=0)):
        raise NoMesh("the triangulation has another outline")
    return cells


def by_gmsh(shape: Shape, sizes: Sizes, algorithm: int) -> pc.Mesh:
    """Let Gmsh mesh the polygon of the nodes of the outline."""
    try:
        import gmsh
    except (ImportError, OSError) as error:
        raise pc.InputError(f"random bodies need Gmsh and the libraries of the system that it uses: pip install 'gmsh>=4.12' ({error})") from None
    # Without its own handler of Ctrl-C.
    gmsh.initialize(readConfigFiles=False, interruptible=False)
    try:
        for name, value in (("General.Terminal", 0), ("General.NumThreads", 1), ("Mesh.Algorithm", algorithm)):
            gmsh.option.setNumber(name, value)
        loops = []
        for outline in shape.outlines(sizes.parts):
            corners = [gmsh.model.geo.addPoint(x, y, 0.0) for x, y in outline.tolist()]
            lines = [gmsh.model.geo.addLine(p, q) for p, q in zip(corners, [*corners[1:], corners[0]], strict=True)]
            for line in lines:
                gmsh.model.geo.mesh.setTransfiniteCurve(line, 2)
            loops.append(gmsh.model.geo.addCurveLoop(lines))
        gmsh.model.geo.addPlaneSurface(loops)
        gmsh.model.geo.synchronize()
        gmsh.model.mesh.setSizeCallback(lambda _dim, _tag, x, y, _z, size: min(size, float(sizes.at(np.array([[x, y]]))[0])))
        gmsh.model.mesh.generate(2)
        tags, places, _ = gmsh.model.mesh.getNodes()
        _, nodes = gmsh.model.mesh.getElementsByType(2)
    except Exception as error:  # Gmsh raises nothing more special.
        raise NoMesh(f"Gmsh: {error}") from error
    finally:
        gmsh.finalize()
    order = np.argsort(tags)
    cells = np.searchsorted(tags, nodes, sorter=order).reshape(-1, 3)
    return pc.Mesh(places.reshape(-1, 3)[order, :2], cells)


def checked(mesh: pc.Mesh) -> pc.Mesh:
    """Give a mesh if it has not too many elements and no small angles."""
    if len(mesh.cells) > MOST:
        raise NoMesh("too many elements")
    sides = edges(mesh)
    cosines = [(sides[:, i] ** 2 + sides[:, j] ** 2 - sides[:, k] ** 2) / (2.0 * sides[:, i] * sides[:, j]) for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1))]
    if np.max(cosines) > math.cos(math.radians(LEAST_ANGLE)):
        raise NoMesh("an angle is too small")
    return mesh
