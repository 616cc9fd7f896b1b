"""Bodies that spin steadily under their own centrifugal force, stretched by a fifth."""

from __future__ import annotations

import math

import numpy as np
import percute as pc
from studies.benchmarks.trial import Floats, Outcome, Quantity, filled
from studies.finite_exact.numerics import integrated, root
from studies.parallel import Stop

YOUNG, DENSITY = 10e6, 1100.0
"""Of rubber (Pa, kg/m³)."""
HALVES = 0.05, 0.01
"""Half of length and height of the bar (m)."""
RADII = 0.03, 0.05
"""Of the ring (m)."""
CELLS = (1, 2, 4)
"""Refinements of the first mesh."""
SQUARE = "linear elements and central differences: order 2"


def stretched(places: Floats, half: float, spin: float) -> Floats:
    """Give the places in a spinning bar with ν = 0 along one of its axes: P' = −ρω²x, P = μ(x' − 1/x') and P = 0 at the ends.

    With ν = 0 both axes have this solution, and do not depend on each other.
    """
    shear = 0.5 * YOUNG

    def slope(_: float, state: Floats) -> Floats:
        x, stress = state
        return np.array([0.5 * (stress / shear + math.hypot(stress / shear, 2.0)), -DENSITY * spin**2 * x])

    to_end = np.array([0.0, half])
    first = 0.5 * DENSITY * (spin * half) ** 2
    middle = root(lambda stress: float(integrated(slope, np.array([0.0, stress]), to_end, 400)[-1, 1]), first, 1.1 * first)
    sides, column = np.unique(np.abs(places).round(12), return_inverse=True)
    from_middle = np.concatenate([[0.0], sides]) if sides[0] > 0.0 else sides
    found = integrated(slope, np.array([0.0, middle]), from_middle)[-len(sides) :, 0]
    return np.asarray(np.sign(places) * found[column])


def widened(places: Floats, radii: tuple[float, float], spin: float, poisson: float) -> Floats:
    """Give the radii in a spinning neo-Hookean ring in plane strain, from its radial balance; inner and outer side are free."""
    shear = YOUNG / (2.0 * (1.0 + poisson))
    lame = YOUNG * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson))

    def stress(along: float, across: float) -> float:
        return shear * (along - 1.0 / along) + lame * math.log(along * across) / along

    def slope(radius: float, state: Floats) -> Floats:
        r, f = state
        g = r / radius
        by_g = lame / (f * g)
        by_f = shear * (1.0 + 1.0 / f**2) + lame * (1.0 - math.log(f * g)) / f**2
        balance = (stress(g, f) - stress(f, g)) / radius - DENSITY * spin**2 * r
        return np.array([f, (balance - by_g * (f - g) / radius) / by_f])

    def start(hoop: float) -> Floats:
        return np.array([hoop * radii[0], root(lambda f: stress(f, hoop), 1.0, 0.99)])

    def end(hoop: float) -> float:
        r, f = integrated(slope, start(hoop), np.array(radii), 400)[-1]
        return stress(float(f), float(r) / radii[1])

    hoop = root(end, 1.05, 1.1)
    sides, row = np.unique(places.round(12), return_inverse=True)
    return np.asarray(integrated(slope, start(hoop), sides)[row, 0])


def ring(around: int, across: int) -> pc.Mesh:
    """Mesh a ring: rows of nodes on circles, cells cut by diagonals in turn."""
    angle = 2.0 * math.pi * np.arange(around) / around
    rows = np.linspace(*RADII, across + 1)
    points = np.concatenate([radius * np.stack([np.cos(angle), np.sin(angle)], axis=1) for radius in rows])
    cells = []
    for i in range(across):
        for k in range(around):
            inner, outer = (i * around + np.array([k, (k + 1) % around]) + layer * around for layer in (0, 1))
            a, b, c, d = inner[0], outer[0], outer[1], inner[1]
            cells += [(a, b, c), (a, c, d)] if (i + k) % 2 == 0 else [(a, b, d), (b, c, d)]
    return pc.Mesh(points, np.array(cells))


def _turned(mesh: pc.Mesh, poisson: float, exact: Floats, spin: float, stop: Stop | None) -> tuple[float, Floats]:
    """Turn a body once from its exact state; give the largest distance from it in the frame that turns, and its mean places there."""
    material = pc.Elastic(young=YOUNG, poisson=poisson, density=DENSITY, plane="strain", kinematics="finite")
    velocity = spin * np.stack([-exact[:, 1], exact[:, 0]], axis=1)
    problem = pc.Problem(mesh, material=material, initial_displacement=exact - mesh.points, initial_velocity=velocity)
    history = pc.simulate(problem, end=2.0 * math.pi / spin, courant=0.9, progress=stop)
    turned = np.exp(-1j * spin * history.time)[:, None] * ((mesh.points + history.displacement) @ np.array([1.0, 1j]))
    distance = np.abs(turned - exact @ np.array([1.0, 1j]))
    return float(distance.max()), np.asarray(turned.mean(axis=0))


def spinning_bar(stop: Stop | None = None) -> Outcome:
    """Spin a rectangle of rubber with ν = 0 once."""
    spin = 0.6 * math.sqrt(YOUNG / DENSITY) / HALVES[0]
    runs: list[list[float]] = []
    for times in CELLS:
        mesh = pc.Mesh.rectangle(2.0 * HALVES[0], 2.0 * HALVES[1], nx=10 * times, ny=2 * times, diagonals="crossed").moved((-HALVES[0], -HALVES[1]))
        exact = np.stack([stretched(mesh.points[:, axis], half, spin) for axis, half in enumerate(HALVES)], axis=1)
        distance, mean = _turned(mesh, 0.0, exact, spin, stop)
        end = int(np.argmin(np.linalg.norm(mesh.points - (HALVES[0], 0.0), axis=1)))
        runs.append([abs(mean[end]) / HALVES[0], distance / HALVES[0]])
    end_stretch = float(stretched(np.array([HALVES[0]]), HALVES[0], spin)[0]) / HALVES[0]
    quantities = [
        Quantity("length over that at rest", "", end_stretch, SQUARE, order=2.0),
        Quantity("largest distance from the exact place, over half of the length", "", 0.0, SQUARE, order=2.0),
    ]
    return Outcome(filled(quantities, runs))


def spinning_ring(stop: Stop | None = None) -> Outcome:
    """Spin a ring of rubber with ν = 0.4 once."""
    spin = 0.4 * math.sqrt(YOUNG / DENSITY) / RADII[1]
    runs: list[list[float]] = []
    for times in CELLS:
        mesh = ring(48 * times, 2 * times)
        at_rest: Floats = np.linalg.norm(mesh.points, axis=1)
        exact = mesh.points * (widened(at_rest, RADII, spin, 0.4) / at_rest)[:, None]
        distance, mean = _turned(mesh, 0.4, exact, spin, stop)
        outer = at_rest > RADII[1] - 1e-9
        runs.append([float(np.abs(mean[outer]).mean()) / RADII[1], distance / RADII[1]])
    wider = float(widened(np.array(RADII), RADII, spin, 0.4)[1]) / RADII[1]
    quantities = [
        Quantity("outer radius over that at rest", "", wider, SQUARE, order=2.0),
        Quantity("largest distance from the exact place, over the outer radius", "", 0.0, SQUARE, order=2.0),
    ]
    return Outcome(filled(quantities, runs))
