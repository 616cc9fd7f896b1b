"""A shock in a neo-Hookean body: the jump conditions of Rankine and Hugoniot.

The scheme does not dissipate. In place of a jump it has a train of waves, and the state behind it is that of a simple wave, which keeps the energy,
too. Both states differ by the third power of the strain.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
import percute as pc
from studies.benchmarks.trial import Outcome, Quantity, filled
from studies.finite_exact.numerics import root
from studies.parallel import Stop

YOUNG, DENSITY = 10e6, 1100.0
"""Of rubber (Pa, kg/m³)."""
LENGTH, SPEED = 0.1, 10.0
"""Of the body along its flight (m), and towards the plane (m/s)."""
ELEMENTS = (100, 200, 400)
GAP = 1e-3 * LENGTH
TRAVEL = 0.7
"""Part of the body that the shock has crossed at the end."""
Kind = Literal["bar", "block"]

CUBE = "no dissipation: the state behind is that of a simple wave, off by the third power of the strain"
SIMPLE = "the mean has some ripples: a few periods of the shortest waves"
AHEAD = "the first wave of the train runs ahead of the jump, by a part of its speed that does not fall with the element size"


@dataclass(frozen=True)
class Law:
    """The neo-Hookean law along one axis, the others held: P = μ(F − 1/F) + λ ln F/F. A bar has the law for ν = 0."""

    poisson: float

    @property
    def shear(self) -> float:
        """Give μ (Pa)."""
        return YOUNG / (2.0 * (1.0 + self.poisson))

    @property
    def lame(self) -> float:
        """Give λ (Pa)."""
        return YOUNG * self.poisson / ((1.0 + self.poisson) * (1.0 - 2.0 * self.poisson))

    @property
    def wave_speed(self) -> float:
        """Speed of small waves (m/s)."""
        return math.sqrt((2.0 * self.shear + self.lame) / DENSITY)

    def stress(self, stretch: float) -> float:
        """Give the first Piola–Kirchhoff stress (Pa)."""
        return self.shear * (stretch - 1.0 / stretch) + self.lame * math.log(stretch) / stretch

    def stiffness(self, stretch: float) -> float:
        """Give ∂P/∂F (Pa)."""
        return self.shear * (1.0 + 1.0 / stretch**2) + self.lame * (1.0 - math.log(stretch)) / stretch**2

    def behind_shock(self, speed: float) -> float:
        """Give the stretch behind a shock that stops a body of this speed (m/s): ρV² = P(F)(F − 1)."""
        return root(lambda f: self.stress(f) * (f - 1.0) - DENSITY * speed**2, 1.0 - speed / self.wave_speed, 1.0 - 0.9 * speed / self.wave_speed)

    def behind_wave(self, speed: float) -> float:
        """Give the stretch behind a simple wave that stops it: V = ∫c dF, from F to 1."""

        def stopped(stretch: float) -> float:
            places = np.linspace(stretch, 1.0, 201)
            # Simpson's rule.
            weights = np.array([1.0, *[4.0, 2.0] * 99, 4.0, 1.0]) * (1.0 - stretch) / 600.0
            return float(weights @ np.sqrt([self.stiffness(f) / DENSITY for f in places])) - speed

        return root(stopped, 1.0 - speed / self.wave_speed, 1.0 - 0.9 * speed / self.wave_speed)


def _problem(kind: Kind, elements: int, law: Law) -> pc.Problem:
    """Throw a bar, or a block whose sides are held across its flight."""
    if kind == "bar":
        rod = pc.Elastic(young=YOUNG, density=DENSITY, section=1.0, kinematics="finite")
        return pc.Problem(pc.Mesh.bar(LENGTH, elements=elements), material=rod, obstacles=[pc.Plane(point=-GAP, normal=1.0)], initial_velocity=-SPEED)
    mesh = pc.Mesh.rectangle(LENGTH / elements, LENGTH, nx=1, ny=elements)
    material = pc.Elastic(young=YOUNG, poisson=law.poisson, density=DENSITY, plane="strain", kinematics="finite")
    held = [pc.Support(group=side, components="x") for side in ("left", "right")]
    plane = pc.Plane(point=(0.0, -GAP), normal=(0.0, 1.0), friction=0.0)
    return pc.Problem(mesh, material=material, obstacles=[plane], supports=held, initial_velocity=(0.0, -SPEED))


def _measured(kind: Kind, elements: int, law: Law, stop: Stop | None) -> list[float]:
    """Give the speed of the shock by the force on the plane and by its place, and the stretch behind it."""
    stretch = law.behind_shock(SPEED)
    shock = SPEED / (1.0 - stretch)
    touch = GAP / SPEED
    problem = _problem(kind, elements, law)
    history = pc.simulate(problem, end=touch + TRAVEL * LENGTH / shock, courant=0.9, progress=stop)
    axis = problem.mesh.dimension - 1
    place, row = np.unique(problem.mesh.points[:, axis], return_inverse=True)
    # Both nodes of a row of the block move alike, to the differences of their masses.
    displacement, velocity = (
        np.stack([np.bincount(row, level[:, axis]) / np.bincount(row) for level in field]) for field in (history.displacement, history.velocity)
    )
    section = float(problem.mass.sum()) / (DENSITY * LENGTH)
    later = history.time > touch + 0.3 * (history.time[-1] - touch)
    force = float(history.contact.resultants.normal_force[later].mean())
    # The last node that has lost half of its speed, and the place between it and the next one.
    fronts = []
    for level in velocity[later]:
        k = int(np.flatnonzero(level > -0.5 * SPEED)[-1])
        fronts.append(np.interp(-0.5 * SPEED, [level[k + 1], level[k]], [place[k + 1], place[k]]))
    front = float(np.polyfit(history.time[later], fronts, 1)[0])
    ends = np.searchsorted(place, [0.05 * LENGTH, 0.2 * LENGTH])
    behind = 1.0 + float(np.diff(displacement[-1, ends])[0] / np.diff(place[ends])[0])
    return [force / (section * DENSITY * SPEED), behind, front]


def shock(kind: Kind, stop: Stop | None = None) -> Outcome:
    """Stop a bar or a block of rubber at a plane: ρ S V = −P(F), S(1 − F) = V."""
    law = Law(0.0 if kind == "bar" else 0.4)
    stretch = law.behind_shock(SPEED)
    speed = SPEED / (1.0 - stretch)
    simple = law.behind_wave(SPEED)
    quantities = [
        Quantity("speed of the shock, by the force on the plane", "m/s", speed, CUBE, bound=5e-4 * speed),
        Quantity("this speed, after a simple wave", "m/s", -law.stress(simple) / DENSITY / SPEED, SIMPLE, bound=1e-4 * speed),
        Quantity("stretch behind the shock", "", stretch, CUBE, bound=5e-4 * (1.0 - stretch)),
        Quantity("this stretch, after a simple wave", "", simple, SIMPLE, bound=1e-4 * (1.0 - stretch)),
        Quantity("speed of the front", "m/s", speed, AHEAD, bound=0.02 * speed),
    ]
    runs = [_measured(kind, elements, law, stop) for elements in ELEMENTS]
    return Outcome(filled(quantities, [[force, force, behind, behind, front] for force, behind, front in runs]))
