"""Largest stresses of elastic bodies on finer and finer meshes: the table of the margin to yielding in ``docs/verdict.md``.

``python -m studies.elastic_margin`` prints it. A corner has no largest stress: each mesh gives a larger one.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
import percute as pc

YIELD_STRESS = 300e6
"""Pa; the law is elastic at any stress."""
ALUMINIUM = pc.Elastic(young=70e9, poisson=0.3, density=2700.0, plane="strain", yield_stress=YIELD_STRESS)
WAVES = math.sqrt(70e9 * 0.7 / (1.3 * 0.4 * 2700.0))
"""Speed of pressure waves (m/s)."""
GAP, COURANT = 1e-5, 0.9
"""Distance from the plane at the start (m), and step over the critical one."""


@dataclass(frozen=True)
class Impact:
    """Impacts of a body on meshes of half the size each."""

    name: str
    mesh: Callable[[int], pc.Mesh]
    counts: tuple[int, ...]
    tilt: float = 0.0
    """Degrees."""
    speed: float = 10.0
    """m/s"""

    def estimate(self, count: int, passages: float) -> pc.Estimate:
        """Run a mesh until so many wave passages after the impact."""
        mesh, angle = self.mesh(count), math.radians(self.tilt)
        normal = np.array([math.sin(angle), math.cos(angle)])
        point = ((mesh.points @ normal).min() - GAP) * normal
        plane = pc.Plane(point=point, normal=normal, friction=0.2)
        problem = pc.Problem(mesh, material=ALUMINIUM, obstacles=[plane], initial_velocity=-self.speed * normal)
        return pc.estimate(pc.simulate(problem, end=GAP / self.speed + passages * mesh.size / WAVES, courant=COURANT))


def _block(count: int) -> pc.Mesh:
    return pc.Mesh.rectangle(0.05, 0.04, nx=count, ny=count * 4 // 5)


def _disc(count: int) -> pc.Mesh:
    return pc.Mesh.disc(0.02, rings=count)


def _angle(count: int) -> pc.Mesh:
    square = pc.Mesh.rectangle(0.04, 0.04, nx=count, ny=count)
    kept = square.cells[square.points[square.cells].mean(axis=1).min(axis=1) < 0.02]
    used, cells = np.unique(kept, return_inverse=True)
    return pc.Mesh(square.points[used], cells.reshape(kept.shape))


def impacts() -> Iterator[Impact]:
    """Give the rows of the table."""
    counts = (5, 10, 20, 40, 80)
    yield Impact("block, flat", _block, counts)
    yield Impact("disc, contact wider than an element", _disc, (16, 32), speed=20.0)
    yield Impact("disc, contact narrower than an element", _disc, (4, 8, 16, 32), speed=2.0)
    for tilt in (5.0, 20.0, 45.0):
        yield Impact(f"block, with a corner, {tilt:g}°", _block, counts, tilt)
    yield Impact("L, with its re-entrant corner", _angle, (8, 16, 32, 64))


def stresses(impact: Impact, passages: float) -> tuple[list[float], list[float]]:
    """Give the largest stress over the yield stress and the largest relative error on each mesh."""
    estimates = [impact.estimate(count, passages) for count in impact.counts]
    largest = [estimate.deformation.materials[0].von_mises.value for estimate in estimates if estimate.deformation is not None]
    return [value / YIELD_STRESS for value in largest], [estimate.relative_sup for estimate in estimates]


def main() -> None:
    """Print the table."""
    print("| impact | speed | passages | largest stress over σ_y | largest relative error |\n|---|---|---|---|---|")
    for impact in impacts():
        for passages in (1.0, 3.0):
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                ratios, errors = stresses(impact, passages)
            told = ", ".join(f"{ratio:.4g}" for ratio in ratios), ", ".join(f"{100 * error:.0f} %" for error in errors)
            print(f"| {impact.name} | {impact.speed:g} m/s | {passages:g} | {told[0]} | {told[1]} |", flush=True)


if __name__ == "__main__":
    main()
