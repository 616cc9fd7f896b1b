"""Akantu's explicit solver with lumped mass, without the plane.

Its contact with a rigid plane is a penalty on a mesh of the plane: another problem. The block vibrates in free flight instead.
"""

from __future__ import annotations

import tempfile
from pathlib import Path

import akantu as aka
import numpy as np
from block import DENSITY, POISSON, YOUNG, Block, clock

MATERIAL = f"""material elastic [
    name = aluminium
    rho = {DENSITY}
    E = {YOUNG}
    nu = {POISSON}
    Plane_Stress = true
]
"""
COUNT = iter(range(10**9))


class Akantu:
    """The block without the plane."""

    name = "Akantu, explicit with lumped mass, no plane"

    def __init__(self, block: Block) -> None:
        assert not block.contact
        self.block = block
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "material.dat"
            file.write_text(MATERIAL)
            aka.parseInput(str(file))
        name = f"block{next(COUNT)}"
        self.mesh = aka.Mesh(2, name)
        accessor = aka.MeshAccessor(self.mesh)
        accessor.resizeNodes(len(block.points))
        self.mesh.getNodes()[:, :] = block.points
        self.mesh.addConnectivityType(aka._triangle_3)
        accessor.resizeConnectivity(len(block.cells), aka._triangle_3)
        self.mesh.getConnectivity(aka._triangle_3)[:, :] = block.cells
        accessor.makeReady()
        self.model = aka.SolidMechanicsModel(self.mesh, id=name)
        self.model.initFull(aka._explicit_lumped_mass)
        self.model.setTimeStep(block.step)

    def run(self, steps: int) -> tuple[float, np.ndarray]:
        """Seconds of so many steps, and the displacement after them (m)."""
        self.model.getDisplacement()[:, :] = 0.0
        self.model.getVelocity()[:, :] = self.block.velocity()
        self.model.getAcceleration()[:, :] = 0.0
        start = clock()
        for _ in range(steps):
            self.model.solveStep()
        return clock() - start, self.model.getDisplacement().copy()
