"""Effectivity indices in plane strain with Poisson's ratios up to 0.49: the table of ``docs/verdict.md``.

``python -m studies.incompressible`` prints it.
"""

from __future__ import annotations

import math
import warnings

import numpy as np
import percute as pc

RATIOS = (0.3, 0.4, 0.45, 0.47, 0.48, 0.49)
YOUNG, DENSITY = 70e9, 2700.0
SPEED, GAP, COURANT = 20.0, 1e-5, 0.9
"""Speed towards the plane (m/s), distance from it (m), and step over the critical one."""


def verification(poisson: float, tilt: float, passages: float, levels: int) -> pc.Verification:
    """Verify an impact of a block of 10 by 8 cells, turned by degrees, until so many passages of pressure waves."""
    mesh, angle = pc.Mesh.rectangle(0.05, 0.04, nx=10, ny=8), math.radians(tilt)
    waves = math.sqrt(YOUNG * (1 - poisson) / ((1 + poisson) * (1 - 2 * poisson) * DENSITY))
    normal = np.array([math.sin(angle), math.cos(angle)])
    law = pc.Elastic(young=YOUNG, poisson=poisson, density=DENSITY, plane="strain")
    plane = pc.Plane(point=-GAP * normal, normal=normal, friction=0.2)
    problem = pc.Problem(mesh, material=law, obstacles=[plane], initial_velocity=-SPEED * normal)
    end = GAP / SPEED + passages * mesh.size / waves
    return pc.verify(problem, levels=levels, end=end, courant=COURANT, every=1)


def main() -> None:
    """Print the table."""
    print("| ν | impact | passages | 10 × 8 cells | 20 × 16 cells |\n|---|---|---|---|---|")
    for poisson in RATIOS:
        for name, tilt in (("flat", 0.0), ("with a corner, 20°", 20.0)):
            for passages in (1.0, 4.0):
                with warnings.catch_warnings():
                    warnings.simplefilter("ignore")
                    found = verification(poisson, tilt, passages, 4)
                cells = [f"{found.effectivity_sup[k]:.2f}, {found.effectivity_mean[k]:.2f}" for k in (0, 1)]
                print(f"| {poisson:g} | {name} | {passages:g} | {cells[0]} | {cells[1]} |", flush=True)


if __name__ == "__main__":
    main()
