"""Impacts with small and with finite strains: the table of ``docs/verdict.md`` behind its limits of strain and rotation.

``python -m studies.finite`` prints it. A solver in NumPy simulates a block of aluminium that strikes a plane without friction, once
with linear kinematics and once with Green's strain and the same moduli (St. Venant and Kirchhoff).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import percute as pc
from numpy.typing import NDArray

Floats = NDArray[np.float64]
YOUNG, POISSON, DENSITY = 70e9, 0.3, 2700.0
WAVES = float(np.sqrt(YOUNG / (1 - POISSON**2) / DENSITY))
"""Speed of waves (m/s)."""
WIDTH, HEIGHT = 0.05, 0.04
STRAINS = (0.005, 0.01, 0.02, 0.04, 0.08)
"""Speeds of flat impacts over that of waves."""
ANGLES = (0.01, 0.02, 0.05, 0.1, 0.15)
"""Rotations at the first touch (rad), of a block that spins at 300 rad/s and falls at 5 m/s."""
SPIN, SPEED = 300.0, 5.0
MEAN = 10
"""Steps over which the contact force is averaged: nodes bounce."""


class Impact(NamedTuple):
    """What a block does."""

    strain: float
    """The largest principal strain."""
    peak: float
    """The largest contact force, a mean over some steps (N)."""
    impulse: float
    """The impulse of contact (N s)."""


class Block:
    """A block of aluminium, plane stress, at a gap over a plane."""

    def __init__(self, cells: tuple[int, int], gap: float) -> None:
        """Make its mesh."""
        mesh = pc.Mesh.rectangle(WIDTH, HEIGHT, nx=cells[0], ny=cells[1])
        self.points, self.cells = mesh.points + [0.0, gap], mesh.cells
        corners = self.points[self.cells]
        sides = np.stack([corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]], axis=2)
        self.areas = 0.5 * np.linalg.det(sides)
        self.gradients = np.einsum("ka,eab->ekb", np.array([[-1.0, -1.0], [1.0, 0.0], [0.0, 1.0]]), np.linalg.inv(sides))
        self.mass = np.zeros(len(self.points))
        np.add.at(self.mass, self.cells.ravel(), np.repeat(DENSITY * self.areas / 3, 3))
        self.step = 0.35 * HEIGHT / cells[1] / WAVES

    def forces(self, displacement: Floats, finite: bool) -> tuple[Floats, float]:
        """Give the forces on the nodes (N) and the largest principal strain."""
        gradient = np.einsum("eka,ekb->eab", displacement[self.cells], self.gradients)
        strain = 0.5 * (gradient + gradient.transpose(0, 2, 1))
        if finite:
            strain = strain + 0.5 * np.einsum("eca,ecb->eab", gradient, gradient)
        trace = np.trace(strain, axis1=1, axis2=2)[:, None, None] * np.eye(2)
        stress = YOUNG / (1 - POISSON**2) * (POISSON * trace + (1 - POISSON) * strain)
        if finite:
            stress = (np.eye(2) + gradient) @ stress
        forces = np.zeros_like(displacement)
        each = -self.areas[:, None, None] * np.einsum("eab,ekb->eka", stress, self.gradients)
        np.add.at(forces, self.cells.ravel(), each.reshape(-1, 2))
        return forces, float(np.abs(np.linalg.eigvalsh(strain)).max())

    def strike(self, speed: float, spin: float, end: float, finite: bool) -> Impact:
        """Simulate until ``end`` (s), from a speed towards the plane (m/s) and a spin (rad/s)."""
        centre = self.points.mean(axis=0)
        velocity = spin * (self.points - centre)[:, ::-1] * [-1.0, 1.0] - [0.0, speed]
        displacement, largest, reactions = np.zeros_like(self.points), 0.0, []
        for _ in range(int(end / self.step)):
            forces, strain = self.forces(displacement, finite)
            largest = max(largest, strain)
            velocity += self.step * forces / self.mass[:, None]
            below = np.minimum(self.points[:, 1] + displacement[:, 1] + self.step * velocity[:, 1], 0.0)
            velocity[:, 1] -= below / self.step
            reactions.append(-(below * self.mass).sum() / self.step**2)
            displacement = displacement + self.step * velocity
        means = np.convolve(reactions, np.ones(MEAN) / MEAN)
        return Impact(largest, float(means.max()), float(np.sum(reactions)) * self.step)


def flat(part: float) -> tuple[Impact, Impact]:
    """Give a flat impact at a part of the speed of waves, with linear kinematics and with finite strains."""
    linear, finite = (Block((20, 16), 1e-9 * part).strike(part * WAVES, 0.0, 3.5 * HEIGHT / WAVES, each) for each in (False, True))
    return linear, finite


def turning(angle: float) -> tuple[Impact, Impact]:
    """Give the impact of a block that turns by an angle (rad) until its corner touches."""
    touch = angle / SPIN
    gap = SPEED * touch + 0.5 * WIDTH * np.sin(angle)
    linear, finite = (Block((8, 6), gap).strike(SPEED, SPIN, 1.15 * touch + 3e-5, each) for each in (False, True))
    return linear, finite


def table() -> list[str]:
    """Give the lines of the table."""
    lines = ["| impact | θ²/2 over the largest strain | largest strain | peak force, linear over finite | impulse |", "|---|---|---|---|---|"]
    cases = [(f"flat, {100 * part:.3g} % of the wave speed", 0.0, flat(part)) for part in STRAINS]
    cases += [(f"turned by {angle:.3g} rad", angle, turning(angle)) for angle in ANGLES]
    for name, angle, (linear, finite) in cases:
        ratio = f"{0.5 * angle**2 / finite.strain:.2g}" if angle else "–"
        peak, impulse = linear.peak / finite.peak, linear.impulse / finite.impulse
        lines.append(f"| {name} | {ratio} | {100 * finite.strain:.2g} % | {peak:.3f} | {impulse:.3f} |")
    return lines


if __name__ == "__main__":
    print("\n".join(table()))
