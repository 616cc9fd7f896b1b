"""The limit of a rigid body: a block that tumbles, and its impact on a corner."""

from __future__ import annotations

import math

import numpy as np
import percute as pc
from studies.benchmarks.trial import Floats, Outcome, Quantity, filled
from studies.parallel import Stop

STIFFNESS = (1e7, 4e7, 16e7)
"""Young's moduli (Pa): the wave speed doubles from one to the next."""
DENSITY = 1100.0
SIDES = 0.05, 0.04
"""Of the block (m)."""
SPIN, TURNS = 200.0, 1.0
"""Angular velocity (rad/s) and turns of the flight."""
THROW = 3.0, 2.0
"""Velocity of the flight (m/s)."""
TILT, FALL, ALONG = 30.0, 2.0, 1.0
"""Of the block that strikes (°), and its velocity across and along the plane (m/s)."""
CROSSINGS = 8.0
"""Times of a wave along the diagonal, from the first touch to the end."""
ROUNDING = "sums of internal forces are zero: rounding of some thousand steps"
STRETCH = "the centrifugal force stretches the block, and its moment of inertia, by the square of ωa/c: order 2 in 1/c"
LONG = "contact lasts some passages of a wave, in which the block turns and slides: order 1 in 1/c"


def _problem(young: float, tilt: float, velocity: Floats, obstacles: list[pc.Plane]) -> pc.Problem:
    """Throw a block of neo-Hookean material; ``velocity`` belongs to the centre and the spin."""
    mesh = pc.Mesh.rectangle(*SIDES, nx=10, ny=8, diagonals="crossed").rotated(tilt)
    material = pc.Elastic(young=young, poisson=0.3, density=DENSITY, plane="strain", kinematics="finite")
    arm = mesh.points - mesh.points.mean(axis=0)
    field = velocity[:2] + velocity[2] * np.stack([-arm[:, 1], arm[:, 0]], axis=1)
    return pc.Problem(mesh, material=material, obstacles=obstacles, initial_velocity=field)


class Moments:
    """Momenta of a history, which a rigid body has, too."""

    def __init__(self, history: pc.History) -> None:
        """Add up the nodes, at each instant."""
        self.mass = history.problem.mass
        self.total = float(self.mass.sum())
        self.place = history.problem.mesh.points + history.displacement
        self.velocity = np.stack([history.velocity[n] for n in range(len(history))])
        self.centre = self._mean(self.place)
        self.momentum = self.total * self._mean(self.velocity)

    def _mean(self, field: Floats) -> Floats:
        return np.asarray(np.einsum("n,tnc->tc", self.mass, field) / self.total)

    def angular(self, about: Floats) -> Floats:
        """Angular momentum about a place at rest (N m s)."""
        arm = self.place - about
        return np.asarray((arm[..., 0] * self.velocity[..., 1] - arm[..., 1] * self.velocity[..., 0]) @ self.mass)

    @property
    def spin(self) -> Floats:
        """Angular momentum about the centre over the moment of inertia there, in the present place (rad/s)."""
        arm, velocity = self.place - self.centre[:, None], self.velocity - (self.momentum / self.total)[:, None]
        turning = (arm[..., 0] * velocity[..., 1] - arm[..., 1] * velocity[..., 0]) @ self.mass
        return np.asarray(turning / (np.sum(arm**2, axis=2) @ self.mass))

    @property
    def angle(self) -> Floats:
        """Angle of the rotation that is nearest to the motion (rad)."""
        arm = (self.place - self.centre[:, None]) @ np.array([1.0, 1j])
        return np.unwrap(np.angle((arm * arm[0].conj()) @ self.mass))


def _flight(young: float, stop: Stop | None) -> list[float]:
    """Turn once; give the deviation of the path and of the angular momentum, both relative, and the angle at the end."""
    history = pc.simulate(_problem(young, 0.0, np.array([*THROW, SPIN]), []), end=2.0 * math.pi * TURNS / SPIN, courant=0.9, progress=stop)
    found = Moments(history)
    path = found.centre - found.centre[0] - history.time[:, None] * np.array(THROW)
    moment = found.angular(np.zeros(2))
    return [float(np.abs(path).max()) / SIDES[0], float(np.ptp(moment) / abs(moment[0])), float(found.angle[-1])]


def tumbling_block(stop: Stop | None = None) -> Outcome:
    """Throw a block that spins: its centre moves on a straight line, and its angle is ωt."""
    quantities = [
        Quantity("largest distance of the centre from its line, over the width", "", 0.0, ROUNDING, bound=1e-11),
        Quantity("change of the angular momentum, relative", "", 0.0, ROUNDING, bound=1e-11),
        Quantity("angle after a turn", "rad", 2.0 * math.pi * TURNS, STRETCH, order=2.0),
    ]
    return Outcome(filled(quantities, [_flight(young, stop) for young in STIFFNESS]))


def _strike(young: float, stop: Stop | None) -> list[float]:
    """Strike with a corner; give the changes of tangential and angular momentum, and that of the spin over that of the rigid impact."""
    gap = 1e-3 * SIDES[0]
    corner = np.zeros(2)
    plane = pc.Plane(point=(0.0, -gap), normal=(0.0, 1.0), friction=0.0)
    problem = _problem(young, TILT, np.array([ALONG, -FALL, 0.0]), [plane])
    touch = gap / FALL
    history = pc.simulate(problem, end=touch + CROSSINGS * problem.mesh.size / problem.wave_speed, courant=0.9, progress=stop)
    found = Moments(history)
    contact = corner + touch * np.array([ALONG, -FALL])
    before, after = found.angular(contact)[[0, -1]]
    impulse = float(found.momentum[-1, 1] - found.momentum[0, 1])
    arm = found.centre[0] + touch * np.array([ALONG, -FALL]) - contact
    inertia = found.mass @ np.sum((found.place[0] - found.centre[0]) ** 2, axis=1)
    along = float(np.ptp(found.momentum[:, 0])) / (found.total * FALL)
    return [along, float(after - before) / abs(float(before)), float(found.spin[-1]) * float(inertia) / (-float(arm[0]) * impulse)]


def struck_corner(stop: Stop | None = None) -> Outcome:
    """Let a block fall on a corner without friction."""
    quantities = [
        Quantity("change of the momentum along the plane, over that across it", "", 0.0, ROUNDING, bound=1e-11),
        Quantity("change of the angular momentum about the corner, relative", "", 0.0, LONG, order=1.0),
        Quantity("spin over that of a rigid block with the same impulse", "", 1.0, LONG, order=1.0),
    ]
    return Outcome(filled(quantities, [_strike(young, stop) for young in STIFFNESS]))
