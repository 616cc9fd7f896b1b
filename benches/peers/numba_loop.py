"""Central differences with a compiled loop over the elements."""

from __future__ import annotations

import numpy as np
from block import ELASTICITY, FRICTION, Block, clock
from numba import njit


@njit(fastmath=True)
def advance(
    displacement, velocity, force, cells, gradients, areas, inverse_mass, elasticity, surface, step, gap, steps
):
    """Run so many steps: forces of the elements, then the nodes, then contact."""
    c11, c12, c33 = elasticity
    for n in range(steps):
        h = 0.5 * step if n == 0 else step
        force[:] = 0.0
        for e in range(cells.shape[0]):
            i, j, k = cells[e, 0], cells[e, 1], cells[e, 2]
            xj, yj, xk, yk = gradients[e, 0, 0], gradients[e, 0, 1], gradients[e, 1, 0], gradients[e, 1, 1]
            ux, uy = displacement[i, 0], displacement[i, 1]
            jx, jy = displacement[j, 0] - ux, displacement[j, 1] - uy
            kx, ky = displacement[k, 0] - ux, displacement[k, 1] - uy
            ex = xj * jx + xk * kx
            ey = yj * jy + yk * ky
            shear = yj * jx + xj * jy + yk * kx + xk * ky
            area = areas[e]
            sx, sy, txy = area * (c11 * ex + c12 * ey), area * (c12 * ex + c11 * ey), area * c33 * shear
            fjx, fjy = sx * xj + txy * yj, txy * xj + sy * yj
            fkx, fky = sx * xk + txy * yk, txy * xk + sy * yk
            force[j, 0] -= fjx
            force[j, 1] -= fjy
            force[k, 0] -= fkx
            force[k, 1] -= fky
            force[i, 0] += fjx + fkx
            force[i, 1] += fjy + fky
        for i in range(displacement.shape[0]):
            velocity[i, 0] += h * inverse_mass[i] * force[i, 0]
            velocity[i, 1] += h * inverse_mass[i] * force[i, 1]
            displacement[i, 0] += step * velocity[i, 0]
            displacement[i, 1] += step * velocity[i, 1]
        for i in surface:
            depth = gap + displacement[i, 1]
            if depth < 0.0:
                # Back onto the plane; friction brakes as far as Coulomb's law allows.
                velocity[i, 1] -= depth / step
                limit = -FRICTION * depth / step
                brake = min(max(velocity[i, 0], -limit), limit)
                velocity[i, 0] -= brake
                displacement[i, 0] -= step * brake
                displacement[i, 1] = -gap


class Numba:
    """The block, its loop compiled."""

    name = "Numba, loop over elements"

    def __init__(self, block: Block) -> None:
        self.block = block
        areas, gradients = block.geometry()
        self.cells = np.ascontiguousarray(block.cells.astype(np.int32))
        self.gradients = np.ascontiguousarray(gradients[:, 1:, :])
        self.areas = areas
        self.inverse_mass = 1.0 / block.mass()
        self.surface = block.surface()
        self.run(1)

    def run(self, steps: int) -> tuple[float, np.ndarray]:
        """Seconds of so many steps, and the displacement after them (m)."""
        velocity = self.block.velocity()
        displacement, force = np.zeros_like(velocity), np.zeros_like(velocity)
        elasticity = (ELASTICITY[0, 0], ELASTICITY[0, 1], ELASTICITY[2, 2])
        block = self.block
        start = clock()
        advance(
            displacement, velocity, force, self.cells, self.gradients, self.areas, self.inverse_mass,
            elasticity, self.surface, block.step, block.gap, steps,
        )  # fmt: skip
        return clock() - start, displacement
