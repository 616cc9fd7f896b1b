"""Effectivity indices on meshes with nearly flat elements: the table of ``docs/verdict.md``.

``python -m studies.flat_elements`` prints it.
"""

from __future__ import annotations

import warnings

import numpy as np
import percute as pc
from numpy.typing import NDArray

FLAT = 150.0
"""Elements with a larger angle (°) are nearly flat."""
END, SPEED, GAP, COURANT = 8e-6, 100.0, 2e-4, 0.9
"""End of the run (s), speed (m/s), gap at the start (m), step over the critical one."""
REFINEMENTS = 2
"""The references have elements of a quarter of the size."""


def mapped(n: int, axes: tuple[float, float]) -> pc.Mesh:
    """Map a square grid to an ellipse (half axes in m): its four corners become nearly flat."""
    mesh = pc.Mesh.rectangle(2, 2, nx=n, ny=n)
    x, y = (mesh.points - 1).T
    return pc.Mesh(np.column_stack([x * np.sqrt(1 - y * y / 2), y * np.sqrt(1 - x * x / 2)]) * axes + [0, axes[1]], mesh.cells)


def moved(part: float, n: int = 8) -> pc.Mesh:
    """Move a node of a block to a part of its distance from the opposite edge of a triangle."""
    mesh = pc.Mesh.rectangle(0.05, 0.04, nx=n, ny=n)
    points, node = mesh.points.copy(), n // 2 * (n + 1) + n // 2
    middle = (points[node - 1] + points[node + n + 1]) / 2
    points[node] = middle + part * (points[node] - middle)
    return pc.Mesh(points, mesh.cells)


def meshes() -> dict[str, pc.Mesh]:
    """Give the meshes of the table."""
    circle, ellipse = (0.025, 0.025), (0.03, 0.02)
    return {
        "disc in rings": pc.Mesh.disc(0.025, rings=6),
        **{f"block, node moved to {part:g}": moved(part) for part in (1.0, 0.3, 0.1, 0.05, 0.02, 0.01, 0.004)},
        "finer block, node moved to 0.1": moved(0.1, 16),
        **{f"circle mapped from {n} × {n}": mapped(n, circle) for n in (8, 12, 16)},
        **{f"ellipse mapped from {n} × {n}": mapped(n, ellipse) for n in (10, 14)},
    }


def problem(mesh: pc.Mesh) -> pc.Problem:
    """Give a body of aluminium that falls on a plane."""
    material = pc.Elastic(young=70e9, poisson=0.3, density=2700.0, plane="stress")
    plane = pc.Plane(point=(0, mesh.points[:, 1].min() - GAP), normal=(0, 1), friction=0.2)
    return pc.Problem(mesh, material=material, obstacles=[plane], initial_velocity=(0, -SPEED))


def angles(mesh: pc.Mesh) -> NDArray[np.float64]:
    """Give the largest angle of each element (°)."""
    corners = mesh.points[mesh.cells]
    edges = np.roll(corners, -1, axis=1) - corners
    unit = edges / np.linalg.norm(edges, axis=2, keepdims=True)
    return np.asarray(np.degrees(np.arccos(-np.einsum("eic,eic->ei", unit, np.roll(unit, 1, axis=1)))).max(axis=1))


def share(estimate: pc.Estimate) -> float:
    """Give the part of the squared mean error in nearly flat elements and in those around them."""
    cells = estimate.mesh.cells
    near = np.isin(cells, cells[angles(estimate.mesh) > FLAT]).any(axis=1)
    return float(np.sum(estimate.by_element[near] ** 2) / np.sum(estimate.by_element**2))


def row(mesh: pc.Mesh, refinements: int = REFINEMENTS) -> tuple[float, float, float, float]:
    """Give the largest angle (°), the share, and the effectivity indices of sup and mean."""
    history = pc.simulate(problem(mesh), end=END, courant=COURANT)
    (error,) = pc.true_errors([history], problem(mesh.refine(refinements)), end=END, courant=COURANT)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", pc.SimulationWarning)
        estimate = pc.estimate(history, every=1)
    return float(angles(mesh).max()), share(estimate), estimate.sup / error.sup, estimate.mean / error.mean


def main() -> None:
    """Print the table."""
    print("| mesh | largest angle | share | index of sup | of mean |\n|---|---|---|---|---|")
    for name, mesh in meshes().items():
        angle, part, sup, mean = row(mesh)
        print(f"| {name} | {angle:.0f}° | {100 * part:.0f} % | {sup:.2f} | {mean:.2f} |", flush=True)


if __name__ == "__main__":
    main()
