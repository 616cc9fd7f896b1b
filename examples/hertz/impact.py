"""A simulated impact of a disc: its contact forces over time, and their difference from Hertz's relations."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import percute as pc
from theory import Cylinder, Floats

FLIGHT = 3e-8
"""Duration from the start to the plane (s): a few steps."""
PEAK = 8e-6
"""Time from then on (s): at 30 m/s the largest force is before this instant."""


@dataclass(frozen=True)
class Run:
    """Results of an impact; forces are per metre of thickness. Some runs end soon after the peak."""

    disc: Cylinder
    speed: float
    triangles: int
    contact: pc.Contact
    mass: float
    """Mass of the triangles (kg)."""
    rebound: float
    """Velocity of the centre of mass in the last step, over that at the start."""

    @property
    def time(self) -> Floats:
        """From the instant at which the undeformed disc is at the plane (s)."""
        return self.contact.time - FLIGHT

    @property
    def force(self) -> Floats:
        """Resultant (N) over time."""
        return self.contact.resultants.normal_force

    @property
    def place(self) -> Floats:
        """x of the contact nodes (m), in the undeformed state as in Hertz's theory."""
        return self.contact.points[:, 0]

    @cached_property
    def hertz_half_width(self) -> Floats:
        """b (m) of the force of each instant."""
        return self.disc.half_width(self.force)

    @cached_property
    def hertz_pressure(self) -> Floats:
        """p₀ (Pa) of the force of each instant."""
        return self.disc.peak_pressure(self.force)

    @property
    def pressure_in_the_middle(self) -> Floats:
        """Density R/ℓ [45] at the first node in contact (Pa)."""
        return self.contact.pressure[:, np.argmin(np.abs(self.place))]

    @property
    def touching_half_width(self) -> Floats:
        """Half the length of contact of the nodes (m)."""
        return self.contact.resultants.area / 2.0

    @cached_property
    def half_width(self) -> Floats:
        """Twice the standard deviation of the position of the pressure (m): b, if the pressure is an ellipse."""
        force = np.where(self.force > 0.0, self.force, np.inf)
        forces = self.contact.normal_force
        centre = forces @ self.place / force
        width: Floats = 2.0 * np.sqrt(np.sum(forces * (self.place - centre[:, None]) ** 2, axis=1) / force)
        return width

    @property
    def edge(self) -> float:
        """Length of the edges where contact begins (m)."""
        return float(np.median(self.contact.area[np.abs(self.place) < 0.1 * self.disc.radius]))

    @property
    def peak(self) -> int:
        """Step of the largest force."""
        return int(self.force.argmax())

    @property
    def contact_time(self) -> float:
        """From the first to the last contact force (s)."""
        times = self.time[self.force > 0.0]
        return float(times[-1] - times[0])

    @property
    def impulse(self) -> float:
        """Impulse of the contact force over the momentum at the start."""
        return float(self.contact.resultants.impulse[-1, 1] / (self.mass * self.speed))


def simulate(disc: Cylinder, mesh: pc.Mesh, speed: float, end: float, courant: float = 0.9) -> tuple[Run, pc.History]:
    """Simulate the impact of the disc at a speed (m/s), until `end` (s) after the first touch."""
    material = pc.Elastic(young=disc.young, poisson=disc.poisson, density=disc.density, plane=disc.plane)
    plane = pc.Plane(point=(0.0, -disc.radius - FLIGHT * speed), normal=(0.0, 1.0), friction=0.0, group="lower")
    problem = pc.Problem(mesh, material=material, obstacles=[plane], initial_velocity=(0.0, -speed))
    history = pc.simulate(problem, end=end + FLIGHT, courant=courant)
    last = (history.displacement[-1] - history.displacement[-2]) / (history.time[-1] - history.time[-2])
    run = Run(
        disc=disc,
        speed=speed,
        triangles=len(mesh.cells),
        contact=history.contact,
        mass=float(np.sum(problem.mass)),
        rebound=float(problem.mass @ last[:, 1] / np.sum(problem.mass) / speed),
    )
    return run, history


def refined(mesh: pc.Mesh, radius: float) -> pc.Mesh:
    """Cut each triangle into four, with the new boundary nodes on the circle."""
    cells = np.asarray(mesh.cells, dtype=np.int64)
    sides = np.sort(cells[:, [[0, 1], [1, 2], [2, 0]]], axis=2).reshape(-1, 2)
    edges, which, count = np.unique(sides, axis=0, return_inverse=True, return_counts=True)
    middles = mesh.points[edges].mean(axis=1)
    outside = count == 1
    middles[outside] *= radius / np.linalg.norm(middles[outside], axis=1)[:, None]
    (a, b, c), (ab, bc, ca) = cells.T, (len(mesh.points) + which.reshape(-1, 3)).T
    parts = np.hstack([(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]).T
    number = {tuple(edge): len(mesh.points) + i for i, edge in enumerate(edges.tolist())}
    lower = [(*edge, number[min(edge), max(edge)]) for edge in np.asarray(mesh.edge_groups["lower"]).tolist()]
    halves = np.array([half for i, j, middle in lower for half in ((i, middle), (middle, j))])
    return pc.Mesh(np.vstack([mesh.points, middles]), parts, edge_groups={"lower": halves})


@dataclass(frozen=True)
class Differences:
    """Differences of a run from Hertz's relations between force, width and pressure of the same instant, up to `PEAK`."""

    width_mean: float
    """Half-width from the pressure, relative: mean while b is over 0.9 of its peak."""
    pressure_mean: float
    """Pressure in the middle, relative: mean likewise."""
    width: float
    """Half-width from the pressure, relative: root mean square while b is over half of its peak."""
    pressure: float
    """Pressure in the middle, relative: root mean square likewise."""
    touching: float
    """Half-width of the touching nodes, in edges: largest value likewise."""
    ripple: float
    """Force from its mean over 0.2 µs, over the peak force: root mean square likewise."""


def differences(run: Run) -> Differences:
    """Compare a run with Hertz."""
    b = run.hertz_half_width
    late, most = ((b > share * b.max()) & (run.time < PEAK) for share in (0.9, 0.5))
    with np.errstate(divide="ignore", invalid="ignore"):
        width, pressure = run.half_width / b - 1.0, run.pressure_in_the_middle / run.hertz_pressure - 1.0
    half = max(1, round(1e-7 / (run.time[1] - run.time[0])))
    smooth = np.convolve(run.force, np.full(2 * half + 1, 1.0 / (2 * half + 1)), "same")
    return Differences(
        width_mean=float(width[late].mean()),
        pressure_mean=float(pressure[late].mean()),
        width=rms(width[most]),
        pressure=rms(pressure[most]),
        touching=float(np.abs(run.touching_half_width - b)[most].max() / run.edge),
        ripple=rms((run.force - smooth)[most] / run.force.max()),
    )


def profile(run: Run) -> tuple[Floats, Floats, Floats]:
    """Pressure at the peak: x/b, p/p₀, and the ellipse at the same nodes."""
    order = np.argsort(run.place)
    place = run.place[order] / run.hertz_half_width[run.peak]
    ellipse = np.sqrt(np.maximum(0.0, 1.0 - place**2))
    return place, run.contact.pressure[run.peak][order] / run.hertz_pressure[run.peak], ellipse


def rms(values: Floats) -> float:
    """Root mean square."""
    return float(np.sqrt(np.mean(values**2)))
