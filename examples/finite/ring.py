"""A rubber ring that spins in free flight. It starts undeformed, widens under the centrifugal force, and breathes.

    python examples/finite/ring.py

A case has one initial velocity, or one for each node. In Python, those of a spin follow from the places of the nodes.
"""

from __future__ import annotations

import math

import numpy as np
import percute as pc

INNER, OUTER = 0.04, 0.05
"""Radii (m)."""
AROUND, ACROSS = 64, 4
"""Cells along and across the ring."""
SPIN, TURN = 600.0, 2.0
"""Initial angular velocity (rad/s), and the angle of a spin at this velocity until the end (turns)."""
RUBBER = pc.Elastic(young=10e6, poisson=0.4, density=1100.0, plane="strain", kinematics="finite")


def mesh() -> pc.Mesh:
    """Put nodes on circles; cells are cut by diagonals in turn."""
    angle = np.linspace(0.0, 2.0 * math.pi, AROUND, endpoint=False)
    circle = np.column_stack([np.cos(angle), np.sin(angle)])
    points = np.concatenate([radius * circle for radius in np.linspace(INNER, OUTER, ACROSS + 1)])
    cells = []
    for row in range(ACROSS):
        for k in range(AROUND):
            a, d = row * AROUND + np.array([k, (k + 1) % AROUND])
            b, c = a + AROUND, d + AROUND
            cells += [(a, b, c), (a, c, d)] if (row + k) % 2 else [(a, b, d), (b, c, d)]
    return pc.Mesh(points, np.array(cells))


def simulated() -> pc.History:
    """Throw the ring."""
    ring = mesh()
    velocity = SPIN * np.column_stack([-ring.points[:, 1], ring.points[:, 0]])
    return pc.simulate(pc.Problem(ring, material=RUBBER, initial_velocity=velocity), end=2.0 * math.pi * TURN / SPIN, courant=0.9)


def main() -> None:
    """Print how the ring moves, and the error."""
    history = simulated()
    mass, place = history.problem.mass, history.problem.mesh.points + history.displacement
    moment = (place[..., 0] * history.velocity[..., 1] - place[..., 1] * history.velocity[..., 0]) @ mass
    radius = np.linalg.norm(place, axis=2) @ mass / mass.sum()
    first, turned = place[0] @ (1.0, 1j), place @ (1.0, 1j)
    angle = np.unwrap(np.angle((turned * first.conj()) @ mass))
    estimate = pc.estimate(history)
    print(f"mean radius        {1e3 * radius[0]:.2f} mm at rest, {1e3 * radius.min():.2f} to {1e3 * radius.max():.2f} mm")
    print(f"turns              {angle[-1] / (2.0 * math.pi):.3f}; {TURN:g} at the initial angular velocity")
    print(f"angular momentum   changes by {np.ptp(moment) / moment[0]:.0e} of itself")
    print(f"energy             changes by {np.abs(history.balance.energy_drift).max():.0e} of itself")
    print(f"error              sup {100.0 * estimate.relative_sup:.1f} %, mean {100.0 * estimate.relative_mean:.1f} %")


if __name__ == "__main__":
    main()
