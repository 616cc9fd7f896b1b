"""The block of the paper's §7.2 against a plane: aluminium, 50 × 40 mm, v = (400, −400) m/s."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import percute as pc
from studies.parallel import Stop

ALUMINIUM: dict[str, Any] = {"young": 70e9, "poisson": 0.3, "density": 2700.0}
"""The material of §7.2.1."""
SPEED = 400.0
"""Speed along and across the plane (m/s)."""


@dataclass(frozen=True)
class Impact:
    """A problem with its instants."""

    problem: pc.Problem
    step: float
    """Δt (s)."""
    count: int
    """Number of steps."""
    arrival: float
    """The instant at which a rigid block would arrive at the plane (s)."""

    def simulate(self, stop: Stop | None = None) -> pc.History:
        """Simulate it."""
        return pc.simulate(self.problem, end=self.step * self.count, step=self.step, progress=stop)


@dataclass(frozen=True)
class Block:
    """An impact as the paper states it, with the choices that the paper leaves open."""

    cells: tuple[int, int]
    """Squares along x and y, each cut in two."""
    friction: float = 0.2
    courant: float = 0.9
    plane: Any = "stress"
    flight: float = 1.3
    """Steps until the impact."""
    gap: float | None = None
    """A length (m) that the gap is nearest to, for ``flight`` of whole steps and a fraction: then the impact falls on the same
    place inside a step, for all steps. ``flight`` is the fraction alone."""
    past: float = 12e-6
    """The run ends with the first step past this instant (s)."""

    @property
    def mesh(self) -> str:
        """The mesh in words."""
        return f"{self.cells[0]}×{self.cells[1]}"

    def impact(self) -> Impact:
        """Give the problem and its steps."""
        # Contact does not enter the critical step: any gap will do.
        step = self.courant * self._problem(1.0).critical_time_step
        travel = step * SPEED
        steps = self.flight if self.gap is None else max(round(self.gap / travel - self.flight), 1) + self.flight
        count = math.floor(self.past / step) + 1
        return Impact(self._problem(steps * travel), step, count, steps * step)

    def _problem(self, gap: float) -> pc.Problem:
        return pc.Problem(
            pc.Mesh.rectangle(0.05, 0.04, nx=self.cells[0], ny=self.cells[1]),
            material=pc.Elastic(**ALUMINIUM, plane=self.plane),
            initial_velocity=(SPEED, -SPEED),
            obstacles=[pc.Plane(point=(0.0, -gap), normal=(0.0, 1.0), friction=self.friction)],
        )
