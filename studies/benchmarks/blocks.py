"""Blocks on the ground: sliding, stick and slip, momentum and uniform stress."""

from __future__ import annotations

import numpy as np

import percute as pc
from percute.exact import RigidSlide
from studies.benchmarks.trial import Curve, Outcome, Quantity, Trial, filled, rectangle, values
from studies.choices import PLANE_CHOICES
from studies.parallel import Stop

STIFFNESS = (3.2e6, 1.28e7, 5.12e7, 2.048e8)
"""Young's moduli (Pa): the wave speed doubles from one to the next."""
BLOCKS = (10, 20, 40, 80)
"""Cells along the width of the block that strikes."""
DENSITY, GRAVITY, TILT = 1000.0, 9.81, np.pi / 6
PUSH = ((0.0, 0.0), (0.1, 5886.0), (0.3, -5886.0), (0.5, 5886.0), (0.7, -5886.0), (0.9, 5886.0))
"""Instants (s) and values (N/m³) of the push: at its peaks twice the friction."""
PRESSURE, SHEAR = 5e7, -1e7
"""Of the patch test on the ground (Pa)."""

LATE = "sliding begins when the shear wave of the push has loaded the ground: late by O(H/c); order in 1/c"
LATE_TWICE = "a start late by τ changes the second difference of the distances by ½aτ²: order 2 in 1/c"
OVERSHOOT = "the weight pulls suddenly, its shear overshoots for 2H/c: a slip of up to ½g(2H/c)², order 2 in 1/c"
RETURN = "the blow ends when the smeared front is back: order 2/3"
CONE = "each node slides all the time, and its force is on the cone: rounding"
HALF_MASS = "the ground also takes the energy of the layer of mass that is stopped at impact: order 1"
STEP = "forces and paths of the same steps, and of steps beside each other: order 1"
ROUNDING = "linear displacements are in the finite-element space: rounding of u, 1e-16 of it, over the strains"
COMPLEMENTARITY = "as before; of the contact law, rounding of velocities remains, and its root: 1e-8"


def _pressed(width: float, height: float, nx: int, ny: int, young: float, weight: float) -> str:
    """Give displacements of a block that its weight presses, so that it does not begin with a bounce."""
    y = np.repeat(height * np.arange(ny + 1) / ny, nx + 1)
    return values(np.stack([0 * y, -weight / young * y * (height - 0.5 * y)], axis=1))


def tilted_plane(stop: Stop | None = None) -> Outcome:
    """Slide with g sin θ − μg cos θ if μ < tan θ, else stick: an elastic block does so as it gets stiffer."""
    runs = []
    for young in STIFFNESS:
        start = _pressed(0.4, 0.2, 4, 2, young, DENSITY * GRAVITY * np.cos(TILT))
        trial = Trial("tilted_plane", stop, young=young, displacement=start)
        still = Trial("tilted_plane", stop, young=young, displacement=start, friction=0.7)
        path, end = trial.path[:, 0], trial.time[-1]
        # The late start drops out of the second difference.
        second = path[-1] - 2 * np.interp(0.5 * end, trial.time, path)
        slip = still.history.displacement[-1, still.history.contact_nodes, 0].mean()
        runs.append([path[-1], 4 * second / end**2, trial.resultants.friction_energy[-1], slip])
    weight = trial.mass * GRAVITY
    exact = RigidSlide(mass=trial.mass, limit=0.3 * weight * np.cos(TILT), push=[(0.0, weight * np.sin(TILT))])
    quantities = [
        Quantity("distance, ½(g sin θ − μg cos θ)t²", "m", float(exact.position(end)), LATE, order=1.0),
        Quantity("acceleration, g sin θ − μg cos θ", "m/s²", float(exact.velocity(end) / end), LATE_TWICE, order=2.0),
        Quantity("energy dissipated by friction", "J", float(exact.dissipated(end)), LATE, order=1.0),
        Quantity("slip with μ = 0.7 > tan θ", "m", 0.0, OVERSHOOT, order=2.0),
    ]
    return Outcome(filled(quantities, runs))


def stick_slip(stop: Stop | None = None) -> Outcome:
    """Push to and fro: stick until the push is the friction, slide with ma = P − F, and stop when the velocity is zero."""
    runs, curve = [], None
    for young in STIFFNESS:
        start = _pressed(0.4, 0.05, 1, 1, young, DENSITY * GRAVITY)
        trial = Trial("stick_slip", stop, young=young, displacement=start)
        push = [(t, force * trial.mass / DENSITY) for t, force in PUSH]
        exact = RigidSlide(mass=trial.mass, limit=0.3 * trial.mass * GRAVITY, push=push)
        path, position = trial.path[:, 0], exact.position(trial.time)
        runs.append([abs(path - position).max() / abs(position).max(), trial.resultants.friction_energy[-1]])
        curve = curve or Curve("distance", "m", trial.time, "s", position, path)
    quantities = [
        Quantity("largest error of the position over the largest distance", "", 0.0, LATE, order=1.0),
        Quantity("energy dissipated by friction", "J", float(exact.dissipated(trial.time[-1])), LATE, order=1.0),
    ]
    return Outcome(filled(quantities, runs), curve)


def oblique(stop: Stop | None = None) -> Outcome:
    """Strike the ground: without Poisson's effect the normal motion is that of a bar, and friction takes μ times its impulse."""
    speed, friction, height, gap = 10.0, 0.2, 0.04, 2.3e-6
    runs, curve = [], None
    for nx in BLOCKS:
        mesh = rectangle(0.05, height, nx, nx * 4 // 5)
        straight = Trial("oblique", stop, rectangle=mesh, velocity=[0.0, -speed], friction=0.0)
        trial = Trial("oblique", stop, rectangle=mesh)
        along, across = trial.resultants.impulse[-1]
        dissipated, flight = trial.resultants.friction_energy[-1], 0.5 * trial.mass * speed**2
        lost = (trial.energy[0] - trial.energy[-1] - dissipated) / flight
        steps = np.full(len(trial.time), trial.step)
        steps[0] /= 2
        contact = trial.history.contact
        work = friction * np.sum(contact.force[:, :, 1] * abs(contact.sliding_velocity[:, :, 0]) * steps[:, None])
        runs.append([straight.resultants.impulse[-1, 1], along / across, lost, work / dissipated])
        if curve is None:
            # The force is constant while the wave runs through the block and back.
            blow = 2 * height / trial.history.problem.wave_speed
            impulse = -friction * 2 * trial.mass * speed * np.clip((trial.time - gap / speed) / blow, 0.0, 1.0)
            curve = Curve("tangential impulse", "N s", 1e6 * trial.time, "µs", impulse, trial.resultants.impulse[:, 0])
    quantities = [
        Quantity("normal impulse of a straight blow, 2mv", "N s", 2 * trial.mass * speed, RETURN, order=2 / 3),
        Quantity("tangential over normal impulse, −μ", "", -friction, CONE, bound=1e-12),
        Quantity("energy lost but for friction over that of the normal motion", "", 0.0, HALF_MASS, order=1.0),
        Quantity("work of the sliding forces μ∫F_n|v_t|dt over the energy dissipated", "", 1.0, STEP, order=1.0),
    ]
    return Outcome(filled(quantities, runs), curve)


def patch(stop: Stop | None = None) -> Outcome:
    """Fly under a uniform stress: with the tractions of its stress nothing swings, and the estimate is zero for all choices."""
    history = Trial("patch", stop).history
    quantities, run = [], []
    for choice in PLANE_CHOICES:
        run.append(pc.estimate(history, every=1, **choice, threads=1, progress=stop).published_relative_sup)
        name = f"relative error, `{choice['reconstruction']}`, `{choice['acceleration']}`"
        quantities.append(Quantity(name, "", 0.0, ROUNDING, bound=1e-10))
    return Outcome(filled(quantities, [run]))


def patch_contact(stop: Stop | None = None) -> Outcome:
    """Press and shear the same body against the ground: the reactions are those of the uniform stress."""
    trial = Trial("patch_contact", stop)
    estimate, density = trial.estimate, trial.history.contact.density
    elastic = (estimate.over_time.elastic.max() / estimate.reference_sup**2) ** 0.5
    furthest = [max(density[:, :, axis].ravel(), key=lambda v: abs(v - exact)) for axis, exact in ((1, PRESSURE), (0, SHEAR))]
    bound = 1e-9 * PRESSURE
    quantities = [
        Quantity("pressure on the ground, at the node and instant where it is furthest off", "Pa", PRESSURE, ROUNDING, bound=bound),
        Quantity("shear on the ground, likewise", "Pa", SHEAR, ROUNDING, bound=bound),
        Quantity("relative elastic error, `corrected`", "", 0.0, ROUNDING, bound=1e-10),
        Quantity("relative error, `corrected`", "", 0.0, COMPLEMENTARITY, bound=1e-7),
    ]
    return Outcome(filled(quantities, [[*furthest, elastic, estimate.published_relative_sup]]))
