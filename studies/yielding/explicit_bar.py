"""A bar of linear elements that strikes a plane, by central differences and radial return."""

from __future__ import annotations

import math

import numpy as np

from studies.yielding.bar import Bar, Floats, positive
from studies.yielding.distance import BarHistory


def simulated(
    bar: Bar, speed: float, elements: int, courant: float, flight: float, after: float
) -> tuple[BarHistory, float]:
    """Simulate an impact on equal elements with lumped mass; give the history and its gap (m).

    The bar flies at ``speed`` (m/s) for ``flight`` steps of ``courant`` h/c, and the run goes on ``after`` L/c from the
    impact, to a whole step. The reaction keeps the struck node on the plane at the end of a step. Velocities at the
    instants are means of those before and after. Raise ValueError for other than positive numbers and Courant numbers
    above 1.
    """
    numbers = {"speed": (speed, "m/s"), "elements": (elements, ""), "flight": (flight, "steps"), "after": (after, "")}
    for name, (value, unit) in numbers.items():
        positive(name, value, unit, "the run needs an impact on a mesh")
    if not 0.0 < courant <= 1.0:
        raise ValueError(f"`courant` is {courant:g}; it must be above 0 and at most 1: larger steps are not stable")
    h = bar.length / elements
    step = courant * h / bar.wave_speed
    gap = flight * speed * step
    mass = bar.density * bar.section * h * np.concatenate([[0.5], np.ones(elements - 1), [0.5]])
    u, half = np.zeros(elements + 1), np.full(elements + 1, -speed)
    plastic_strain, p = np.zeros(elements), np.zeros(elements)
    rows: list[tuple[Floats, Floats, Floats, Floats]] = []
    # Where a whole number of steps is due, rounding must not add one.
    last = math.ceil(flight + after * bar.length / bar.wave_speed / step - 1e-6)
    for n in range(last + 1):
        strain = np.diff(u) / h
        plastic_strain, p = bar.returned(strain, plastic_strain, p)
        force = bar.section * bar.young * (strain - plastic_strain)
        before = half
        # The first step is a half one, but without a force.
        half = before + step * np.diff(force, prepend=0.0, append=0.0) / mass
        half[0] = max(half[0], (-gap - u[0]) / step)
        rows.append((u, 0.5 * (before + half) if n else before, plastic_strain, p))
        u = u + step * half
    time, nodes = step * np.arange(last + 1.0), np.linspace(0.0, bar.length, elements + 1)
    return BarHistory(time, nodes, *(np.array(column, dtype=np.float64) for column in zip(*rows, strict=True))), gap
