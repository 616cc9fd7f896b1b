"""The block that all programs run, and the contact law in closed form, as NumPy arrays."""

from __future__ import annotations

import time
from dataclasses import dataclass

import numpy as np

WALL = False
"""Whether times are those on the wall, not processor times."""

YOUNG, POISSON, DENSITY = 70e9, 0.3, 2700.0
FRICTION, SPEED = 0.2, 400.0
ELASTICITY = YOUNG / (1 - POISSON**2) * np.array([[1, POISSON, 0], [POISSON, 1, 0], [0, 0, (1 - POISSON) / 2]])
"""Plane stress (Pa): σx, σy, τ from εx, εy, γ."""


def clock() -> float:
    """The clock of all programs (s)."""
    return time.perf_counter() if WALL else time.process_time()


@dataclass(frozen=True)
class Block:
    """A mesh of percute with its time step; everything else is computed here."""

    points: np.ndarray
    cells: np.ndarray
    step: float
    gap: float
    contact: bool

    def velocity(self) -> np.ndarray:
        """Initial velocity (m/s): towards the plane, or without it a uniform rate of strain."""
        if self.contact:
            return np.tile([SPEED, -SPEED], (len(self.points), 1))
        return SPEED * (self.points / [0.025, 0.02] - 1.0) * [1.0, -1.0]

    def geometry(self) -> tuple[np.ndarray, np.ndarray]:
        """Areas (m²), and gradients (elements, 3, 2) of the shape functions (1/m)."""
        corners = self.points[self.cells]
        edges = np.roll(corners, -2, axis=1) - np.roll(corners, -1, axis=1)
        double = edges[:, 0, 0] * edges[:, 1, 1] - edges[:, 0, 1] * edges[:, 1, 0]
        gradients = np.stack([-edges[:, :, 1], edges[:, :, 0]], axis=2) / double[:, None, None]
        return 0.5 * double, gradients

    def strain(self) -> np.ndarray:
        """B (elements, 3, 6): εx, εy, γ from the displacements of an element."""
        _, gradients = self.geometry()
        operator = np.zeros((len(self.cells), 3, 3, 2))
        operator[:, 0, :, 0] = operator[:, 2, :, 1] = gradients[:, :, 0]
        operator[:, 1, :, 1] = operator[:, 2, :, 0] = gradients[:, :, 1]
        return operator.reshape(-1, 3, 6)

    def mass(self) -> np.ndarray:
        """Lumped mass of each node (kg)."""
        shares = np.repeat(self.geometry()[0] * DENSITY / 3, 3)
        return np.bincount(self.cells.ravel(), shares, len(self.points))

    def surface(self) -> np.ndarray:
        """Nodes that may touch the plane: those of the bottom."""
        return np.flatnonzero(self.points[:, 1] == 0.0) if self.contact else np.zeros(0, dtype=np.int64)
