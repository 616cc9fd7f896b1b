"""Effectivity indices of simulations with contact by a penalty: the table of ``docs/verdict.md``.

``python -m studies.penalties`` prints it.
"""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
import percute as pc
from numpy.typing import NDArray
from studies.durations import FINER, GAP, MESHES, SPEED, Impact

Floats = NDArray[np.float64]
STIFFNESSES = (1e13, 3e13, 1e14, 3e14, 1e15)
"""Stiffness of the springs (Pa/m); that of an element of 5 mm is 1.4e13 Pa/m."""
COURANT, END = 0.8, 13e-6
"""Step over the critical one of body and springs, and end of the runs after the first touch (s)."""


def matrices(problem: pc.Problem, consistent: bool = False) -> tuple[Floats, Floats]:
    """Give stiffness (both components of each node) and mass (of each node, lumped unless stated)."""
    points, law = problem.mesh.points, problem.material
    assert isinstance(law, pc.Elastic) and law.poisson is not None
    young, poisson = law.young, law.poisson
    if law.plane == "strain":
        young, poisson = young / (1 - poisson**2), poisson / (1 - poisson)
    hooke = young / (1 - poisson**2) * np.array([[1, poisson, 0], [poisson, 1, 0], [0, 0, (1 - poisson) / 2]])
    matrix, mass = np.zeros((2 * len(points), 2 * len(points))), np.zeros((len(points), len(points)))
    for cell in problem.mesh.cells:
        corners = np.column_stack([np.ones(3), points[cell]])
        gradients, area = np.linalg.inv(corners)[1:], 0.5 * abs(np.linalg.det(corners))
        b = np.zeros((3, 6))
        b[0, 0::2], b[1, 1::2], b[2, 0::2], b[2, 1::2] = gradients[0], gradients[1], gradients[1], gradients[0]
        rows = np.column_stack([2 * cell, 2 * cell + 1]).ravel()
        matrix[np.ix_(rows, rows)] += area * b.T @ hooke @ b
        share = (1.0 + np.eye(3)) / 12 if consistent else np.eye(3) / 3
        mass[np.ix_(cell, cell)] += law.density * area * share
    return matrix, mass


class Springs:
    """Springs between the contact nodes of a problem and its plane, along its normal, and with friction along it."""

    def __init__(self, problem: pc.Problem, stiffness: float) -> None:
        """Give each node the springs of its length of the outline (stiffness in Pa/m)."""
        (plane,) = problem.obstacles
        normal = np.asarray(plane.normal, np.float64) / np.linalg.norm(np.asarray(plane.normal, np.float64))
        self.nodes = problem.contact_nodes
        self.frame = np.array([normal, [normal[1], -normal[0]]])
        self.friction = plane.friction or 0.0
        self.gap = (problem.mesh.points[self.nodes] - np.asarray(plane.point, np.float64)) @ normal
        self.stiffness = stiffness * lengths(problem)
        self.anchor = np.full(len(self.nodes), np.nan)

    def matrix(self) -> Floats:
        """Give the stiffness of springs that all are pressed and stick, for the step that is stable."""
        found: Floats = np.zeros((2 * (self.nodes.max() + 1),) * 2)
        directions = self.frame if self.friction else self.frame[:1]
        for node, stiffness in zip(self.nodes, self.stiffness, strict=True):
            rows = slice(2 * node, 2 * node + 2)
            found[rows, rows] += stiffness * directions.T @ directions
        return found

    def forces(self, displacement: Floats) -> Floats:
        """Give the force of each node, from its penetration; its springs along the plane slide with Coulomb's law."""
        found = np.zeros_like(displacement)
        across, along = self.frame @ displacement[self.nodes].T
        normal = self.stiffness * np.maximum(0.0, -self.gap - across)
        self.anchor = np.where(np.isnan(self.anchor), along, self.anchor)
        tangential = np.clip(self.stiffness * (self.anchor - along), -self.friction * normal, self.friction * normal)
        self.anchor = np.where(normal > 0, along + tangential / self.stiffness, np.nan)
        found[self.nodes] = np.column_stack([normal, tangential]) @ self.frame
        return found


def lengths(problem: pc.Problem) -> Floats:
    """Give the length of the outline that belongs to each contact node (m): half of its edges that may touch."""
    found = np.zeros(len(problem.mesh.points))
    sides = np.sort(np.concatenate([problem.mesh.cells[:, pair] for pair in ((0, 1), (1, 2), (2, 0))]), axis=1)
    edges, count = np.unique(sides, axis=0, return_counts=True)
    edges = edges[(count == 1) & np.isin(edges, problem.contact_nodes).all(axis=1)]
    np.add.at(found, edges, 0.5 * np.linalg.norm(np.diff(problem.mesh.points[edges], axis=1), axis=2))
    return np.asarray(found[problem.contact_nodes])


def simulated(
    problem: pc.Problem, stiffness: float, *, courant: float = COURANT, end: float = END, consistent: bool = False
) -> dict[str, Any]:
    """Simulate an impact on springs with central differences; give time, displacement and forces, which follow from the penetration at t_n."""
    matrix, mass = matrices(problem, consistent)
    springs, inverse = Springs(problem, stiffness), np.linalg.inv(mass)
    whole = matrix.copy()
    pressed = springs.matrix()
    whole[: len(pressed), : len(pressed)] += pressed
    critical = 2 / np.sqrt(np.linalg.eigvals(np.kron(inverse, np.eye(2)) @ whole).real.max())
    steps = int(np.ceil(end / (courant * critical)))
    dt = end / steps
    u, v = np.zeros_like(problem.mesh.points), np.array(problem.initial_velocity)
    displacement: list[Floats] = []
    reaction: list[Floats] = []
    for n in range(steps + 1):
        r = springs.forces(u)
        displacement.append(u)
        reaction.append(r)
        v = v + (dt / 2 if n == 0 else dt) * inverse @ (r - (matrix @ u.ravel()).reshape(-1, 2))
        u = u + dt * v
    return {"time": dt * np.arange(steps + 1), "displacement": np.array(displacement), "reaction": np.array(reaction)}


def row(impact: Impact, stiffness: float) -> tuple[float, float, float]:
    """Give the effectivity indices of sup and mean, and the largest penetration (elements)."""
    problem, fine = (impact.problem(MESHES[impact.body](refinements)) for refinements in (impact.refinements, FINER))
    history = pc.History.from_arrays(problem, **simulated(problem, stiffness, end=END + GAP / SPEED))
    estimate = pc.estimate(history, every=1, force=True)
    (error,) = pc.true_errors([history], fine, courant=0.9, end=float(history.time[-1]))
    found = estimate.effectivity(error)
    return found.sup, found.mean, (estimate.consistency or {})["penetration"] or 0.0


def impacts() -> dict[str, Impact]:
    """Give the impacts of the table."""
    return {
        "block, flat": Impact("block", 1, COURANT),
        "block, flat and oblique": Impact("block", 1, COURANT, oblique=True),
        "tall block, flat": Impact("tall block", 1, COURANT),
        "block, tilted by 10°": Impact("block", 1, COURANT, tilt=10.0),
        "disc": Impact("disc", 1, COURANT),
    }


def main() -> None:
    """Print the table: indices of sup and mean, and the largest penetration in thousandths of an element."""
    warnings.simplefilter("ignore")
    print("| impact | " + " | ".join(f"{stiffness:.0e} Pa/m" for stiffness in STIFFNESSES) + " |\n|---" + "|---" * len(STIFFNESSES) + "|")
    for name, impact in impacts().items():
        rows = (row(impact, stiffness) for stiffness in STIFFNESSES)
        print(f"| {name} | " + " | ".join(f"{sup:.2f}, {mean:.2f} ({1e3 * depth:.2g})" for sup, mean, depth in rows) + " |", flush=True)


if __name__ == "__main__":
    main()
