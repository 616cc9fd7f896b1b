"""Central differences with K in SciPy's compressed sparse rows."""

from __future__ import annotations

import numpy as np
from block import ELASTICITY, FRICTION, Block, clock
from scipy.sparse import csr_matrix


class Scipy:
    """The block, assembled."""

    name = "SciPy, K·u in sparse rows"

    def __init__(self, block: Block) -> None:
        self.block = block
        areas, _ = block.geometry()
        strain = block.strain()
        matrices = np.einsum("eki,kl,elj,e->eij", strain, ELASTICITY, strain, areas, optimize=True)
        places = (2 * block.cells[:, :, None] + [0, 1]).reshape(-1, 6)
        rows, columns = np.repeat(places, 6, axis=1).ravel(), np.tile(places, 6).ravel()
        size = 2 * len(block.points)
        self.stiffness = csr_matrix((matrices.ravel(), (rows, columns)), shape=(size, size))
        self.stiffness.sum_duplicates()
        self.mass = block.mass()
        self.surface = block.surface()

    def run(self, steps: int) -> tuple[float, np.ndarray]:
        """Seconds of so many steps, and the displacement after them (m)."""
        dt = self.block.step
        velocity = self.block.velocity().ravel()
        displacement = np.zeros_like(velocity)
        inverse_mass = np.repeat(1.0 / self.mass, 2)
        x, y = 2 * self.surface, 2 * self.surface + 1
        start = clock()
        for n in range(steps):
            h = 0.5 * dt if n == 0 else dt
            velocity -= h * (inverse_mass * (self.stiffness @ displacement))
            gap = self.block.gap + displacement[y] + dt * velocity[y]
            touching = gap < 0.0
            if touching.any():
                push(velocity, x[touching], y[touching], gap[touching] / dt)
            displacement += dt * velocity
        return clock() - start, displacement.reshape(-1, 2)


def push(velocity: np.ndarray, x: np.ndarray, y: np.ndarray, depth: np.ndarray) -> None:
    """End exactly on the plane, and brake sliding as far as Coulomb's law allows (all in m/s)."""
    velocity[y] -= depth
    limit = -FRICTION * depth
    velocity[x] -= np.clip(velocity[x], -limit, limit)
