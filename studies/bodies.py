"""The bodies of the impacts: mesh 1 of each. Finer meshes are of the same polygon."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any
import numpy as np
import percute as pc
from numpy.typing import NDArray
from studies.block import ALUMINIUM

STEEL: dict[str, Any] = {"young": 210e9, "poisson": 0.3, "density": 7800.0}
NEARLY_INCOMPRESSIBLE = ALUMINIUM | {"poisson": 0.45}
LAYERS = "steel under aluminium"
MATERIALS: dict[str, dict[str, Any]] = {"aluminium": ALUMINIUM, "steel": STEEL, "ν = 0.45": NEARLY_INCOMPRESSIBLE}
CROWN = 0.5
"""Radius of a crowned bottom (m)."""
HOLE = ((0.01, 0.05), (0.01, 0.04))
"""Where the frame is open (m)."""


def elastic(material: str, plane: Any) -> pc.Elastic | Mapping[str, pc.Elastic]:
    """Give the material of a body by its name."""
    if material == LAYERS:
        return {"lower": pc.Elastic(**STEEL, plane=plane), "upper": pc.Elastic(**ALUMINIUM, plane=plane)}
    return pc.Elastic(**MATERIALS[material], plane=plane)


def _cells(x: Sequence[float] | NDArray[Any], y: Sequence[float] | NDArray[Any], mirrored: bool = False) -> tuple[NDArray[Any], NDArray[Any]]:
    """Cut rectangles in two, upwards to the right, or in the right half to the left; give nodes and triangles."""
    wide = len(x)
    points = np.array([(a, b) for b in y for a in x])
    cells = []
    for row in range(len(y) - 1):
        for column in range(wide - 1):
            a = row * wide + column
            b, c, d = a + 1, a + wide + 1, a + wide
            left = mirrored and 2 * column + 1 >= wide - 1
            cells += [(a, b, d), (b, c, d)] if left else [(a, b, c), (a, c, d)]
    return points, np.array(cells)


def without(points: NDArray[Any], cells: NDArray[Any], gone: NDArray[np.bool_]) -> pc.Mesh:
    """Leave elements out, and nodes without elements."""
    used, numbers = np.unique(cells[~gone], return_inverse=True)
    return pc.Mesh(points[used], numbers.reshape(-1, 3))


def _trapezoid(slope: float, height: float, columns: int, mirrored: bool = True) -> pc.Mesh:
    """Make a trapezoid that stands on its short side of 40 mm; the slope is that of its sides."""
    points, cells = _cells(np.linspace(-1.0, 1.0, columns + 1), np.linspace(0.0, height, round(height / 0.01) + 1), mirrored)
    points[:, 0] *= 0.02 + points[:, 1] / slope
    return pc.Mesh(points, cells)


def _crowned() -> pc.Mesh:
    """Make a block whose bottom nodes lie on a circle."""
    points, cells = _cells(np.linspace(-0.025, 0.025, 7), np.linspace(0.0, 0.04, 6))
    sagitta = points[:, 0] ** 2 / (2.0 * CROWN)
    points[:, 1] = sagitta + points[:, 1] * (1.0 - sagitta / 0.04)
    return pc.Mesh(points, cells)


def _bent() -> pc.Mesh:
    """Make an L of 50 × 50 mm with legs of 20 mm."""
    points, cells = _cells(np.linspace(0.0, 0.05, 6), np.linspace(0.0, 0.05, 6))
    x, y = points[cells].mean(axis=1).T
    return without(points, cells, (x > 0.02) & (y > 0.02))


def _frame() -> pc.Mesh:
    """Make a frame of 60 × 50 mm with beams of 10 mm."""
    points, cells = _cells(np.linspace(0.0, 0.06, 7), np.linspace(0.0, 0.05, 6))
    x, y = points[cells].mean(axis=1).T
    (left, right), (low, high) = HOLE
    return without(points, cells, (x > left) & (x < right) & (y > low) & (y < high))


def _layers() -> pc.Mesh:
    """Make the block of two layers of 20 mm."""
    points, cells = _cells(np.linspace(0.0, 0.05, 6), np.linspace(0.0, 0.04, 5))
    lower = points[cells].mean(axis=1)[:, 1] < 0.02
    return pc.Mesh(points, cells, element_groups={"lower": np.flatnonzero(lower), "upper": np.flatnonzero(~lower)})


def _stored(name: str) -> pc.Mesh:
    return pc.Mesh.read(Path(__file__).with_name(f"{name}.msh"))


BODIES: Mapping[str, Callable[[], pc.Mesh]] = {
    "block": lambda: pc.Mesh.rectangle(0.05, 0.04, nx=5, ny=4),
    "unstructured block": lambda: _stored("unstructured"),
    "rounded block": lambda: _stored("rounded"),
    "disc": lambda: pc.Mesh.disc(0.025, rings=4),
    "trapezoid 63°": lambda: _trapezoid(2.0, 0.04, 4),
    "trapezoid 45°": lambda: _trapezoid(1.0, 0.03, 6),
    "trapezoid 45° with a corner of one element": lambda: _trapezoid(1.0, 0.03, 6, mirrored=False),
    "crowned block": _crowned,
    "L": _bent,
    "frame": _frame,
    "layered block": _layers,
}
"""The bodies by name: a block of 50 × 40 mm in 5×4 cells, also unstructured, with lower corners of 15 mm radius, with a crowned bottom
or of two layers; a disc of 25 mm radius with 24 edges; trapezoids whose sides rise by 63° and 45°; an L and a frame."""


def corners(mesh: pc.Mesh) -> NDArray[np.int64]:
    """Give the nodes at which the outline bends."""
    sides = mesh.cells.astype(np.int64)[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
    _, first, count = np.unique(np.sort(sides), axis=0, return_index=True, return_counts=True)
    outline = sides[first[count == 1]]
    along = mesh.points[outline[:, 1]] - mesh.points[outline[:, 0]]
    along /= np.linalg.norm(along, axis=1)[:, None]
    turn = np.zeros((len(mesh.points), 2))
    # Elements are counterclockwise: each node has one side before it and one behind.
    np.add.at(turn, outline[:, 0], along)
    np.subtract.at(turn, outline[:, 1], along)
    return np.flatnonzero(np.linalg.norm(turn, axis=1) > 1e-6)


def graded(mesh: pc.Mesh, places: NDArray[np.float64], size: float, slope: float = 0.25) -> pc.Mesh:
    """Refine a mesh to elements of a size (m) at some places; the size grows with the distance by a slope."""
    while True:
        nodes = mesh.points[mesh.cells]
        longest = np.linalg.norm(nodes - np.roll(nodes, 1, axis=1), axis=2).max(axis=1)
        # The size of half a square is that of its sides. Rounding must not decide.
        wanted = np.full(len(nodes), np.inf)
        for place in places:
            wanted = np.minimum(wanted, np.maximum(size, slope * np.linalg.norm(nodes - place, axis=2).min(axis=1)))
        coarse = longest / np.sqrt(2.0) > 1.0001 * wanted
        if not coarse.any():
            return mesh
        mesh = mesh.refine(where=coarse)
