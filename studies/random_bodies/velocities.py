"""Smooth initial velocities of bodies that vibrate."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import percute as pc
from studies.random_bodies.draws import Draws
from studies.random_bodies.shapes import Floats

Velocity = Callable[[Floats], Floats]
"""Velocities (m/s) at places (m)."""


def smooth(draws: Draws, mesh: pc.Mesh, speed: float) -> Velocity:
    """Draw a field of velocity: a polynomial, or waves, without the motion of a rigid body; of this speed at most on the mesh (m/s)."""
    middle, half = mesh.points.mean(axis=0), 0.5 * mesh.size
    if draws.chance(0.5):
        powers = [(i, j) for i in range(4) for j in range(4 - i) if i + j > 0]
        highest = draws.whole(1, 3)
        factors = 2.0 * draws.array(len(powers), 2) - 1.0

        def shape_of(x: Floats) -> Floats:
            return sum((f * (x[:, :1] ** i * x[:, 1:] ** j) for f, (i, j) in zip(factors, powers, strict=True) if i + j <= highest), np.zeros_like(x))
    else:
        waves = (2.0 * draws.array(2, 2) - 1.0) * draws.uniform(1.0, 5.0)
        phases, factors = 2.0 * math.pi * draws.array(2), 2.0 * draws.array(2, 2) - 1.0

        def shape_of(x: Floats) -> Floats:
            found: Floats = np.sin(x @ waves.T + phases) @ factors
            return found

    def raw(points: Floats) -> Floats:
        return shape_of((points - middle) / half)

    apart = mesh.points - middle
    found = raw(mesh.points)
    shift = found.mean(axis=0)
    spin = float(np.sum(apart[:, 0] * found[:, 1] - apart[:, 1] * found[:, 0]) / np.sum(apart**2))

    def free(points: Floats) -> Floats:
        x, y = (points - middle).T
        rest: Floats = raw(points) - shift - spin * np.stack([-y, x], axis=1)
        return rest

    factor = speed / float(np.linalg.norm(free(mesh.points), axis=1).max())
    return lambda points: factor * free(points)
