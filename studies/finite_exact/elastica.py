"""A clamped beam that a force bends by half of its length: Euler's elastica."""

from __future__ import annotations

import math
import tempfile
from pathlib import Path

import numpy as np
import percute as pc
from studies.benchmarks.trial import Floats, Outcome, Quantity, filled
from studies.finite_exact.numerics import integrated, root
from studies.parallel import Stop

YOUNG, DENSITY = 10e6, 1100.0
"""Of rubber (Pa, kg/m³); ν = 0, so that the bending stiffness is EI."""
LENGTH, HEIGHT = 0.1, 0.005
"""Of the beam (m)."""
LOAD = 2.0
"""PL²/EI."""
ACROSS = (1, 2, 4)
"""Cells across the beam, each cut in four."""
PERIODS, SAMPLES = 2.0, 400
"""Duration of a run in periods of the lowest mode, and the instants of its mean."""
SETTLED = 0.003
"""Amplitude over the length at which the mean is the equilibrium: that of the next run differs by 1e-4 of the length."""
LOCKING = "linear triangles are too stiff in bending by the square of their size over the height: order 2"
EXTRAPOLATED = "the elastica has no shear, no stretch, and a linear law: (height/length)², 0.25 %"


def elastica(load: float, along: Floats) -> Floats:
    """Give places and angle of a beam of length 1 at arc lengths: θ'' = −PL²/EI cos θ, θ = 0 at the clamp, θ' = 0 at the end."""

    def slope(_: float, state: Floats) -> Floats:
        angle, curvature = state[2:]
        return np.array([math.cos(angle), math.sin(angle), curvature, -load * math.cos(angle)])

    def at(curvature: float, places: Floats) -> Floats:
        return integrated(slope, np.array([0.0, 0.0, 0.0, curvature]), places)

    curvature = root(lambda guess: float(at(guess, np.linspace(0.0, 1.0, 11))[-1, 3]), 0.8 * load, 0.7 * load)
    return at(curvature, along)


def _problem(across: int, start: Floats | None) -> pc.Problem:
    """Clamp a beam and load its end with a force of constant direction, from a displacement; that of the elastica by default."""
    mesh = pc.Mesh.rectangle(LENGTH, HEIGHT, nx=round(across * LENGTH / HEIGHT), ny=across, diagonals="crossed")
    if start is None:
        along, row = np.unique((mesh.points[:, 0] / LENGTH).round(12), return_inverse=True)
        x, y, angle = elastica(LOAD, along)[row, :3].T
        off = mesh.points[:, 1] - 0.5 * HEIGHT
        place = np.stack([LENGTH * x - off * np.sin(angle), LENGTH * y + 0.5 * HEIGHT + off * np.cos(angle)], axis=1)
        start = place - mesh.points
    force = LOAD * YOUNG * HEIGHT**3 / 12.0 / LENGTH**2
    return pc.Problem(
        mesh,
        material=pc.Elastic(young=YOUNG, poisson=0.0, density=DENSITY, plane="strain", kinematics="finite"),
        supports=[pc.Support(group="left", components=("x", "y"))],
        tractions=[pc.Traction(group="right", value=(0.0, force / HEIGHT))],
        initial_displacement=start,
    )


def settled(across: int, stop: Stop | None = None) -> tuple[float, float]:
    """Give deflection and shortening of the end in equilibrium, over the length.

    There is no damping: each run starts at rest from the mean of the one before, with the weights 1 − cos, until it hardly vibrates.
    """
    lowest = 2.0 * math.pi / 3.516 * math.sqrt(12.0 * DENSITY / YOUNG) * LENGTH**2 / HEIGHT
    times = np.linspace(0.0, PERIODS * lowest, SAMPLES + 1)
    weights = (1.0 - np.cos(2.0 * math.pi * np.arange(SAMPLES + 1) / SAMPLES)) / SAMPLES
    start: Floats | None = None
    amplitude = math.inf
    while amplitude > SETTLED:
        problem = _problem(across, start)
        end = int(np.argmin(np.linalg.norm(problem.mesh.points - (LENGTH, 0.5 * HEIGHT), axis=1)))
        with tempfile.TemporaryDirectory() as folder:
            store = Path(folder) / "beam.vtkhdf"
            history = pc.simulate(problem, end=times[-1], courant=0.9, store=store, times=times, fields=["displacement"], progress=stop)
            start = np.einsum("t,tnc->nc", weights, history.displacement[: SAMPLES + 1])
            amplitude = float(np.abs(history.displacement[:, end, 1] - start[end, 1]).max()) / LENGTH
            del history
    assert start is not None
    return float(start[end, 1]) / LENGTH, -float(start[end, 0]) / LENGTH


def bent_beam(stop: Stop | None = None) -> Outcome:
    """Bend a beam of rubber, 20 times as long as high, with PL²/EI = 2."""
    x, y, *_ = elastica(LOAD, np.linspace(0.0, 1.0, 11))[-1]
    runs: list[list[float]] = []
    for across in ACROSS:
        found = settled(across, stop)
        # Without the term of the second order, by the run before.
        better = (4.0 * found[0] - runs[-1][0]) / 3.0 if runs else math.nan
        runs.append([*found, better])
    quantities = [
        Quantity("deflection of the end over the length", "", float(y), LOCKING, order=2.0),
        Quantity("shortening over the length", "", 1.0 - float(x), LOCKING, order=2.0),
        Quantity("deflection, extrapolated from two runs", "", float(y), EXTRAPOLATED, bound=2.5e-3 * float(y)),
    ]
    return Outcome(filled(quantities, runs))
