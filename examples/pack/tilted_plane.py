"""A stiff block on a plane tilted by 30 degrees slides, or sticks (case tilted_plane.toml).

A rigid block slides with g sin(30°) - mu g cos(30°) if mu < tan(30°) = 0.577, else it sticks. The block is elastic: it begins to slide when
the shear wave of its weight has come to the ground. So the exact motion is reached as the block gets stiffer: each line is with four
times Young's modulus of the one before, twice the speed of waves.
"""

import numpy as np

from pack import compare, mean, numbers, run

GRAVITY, DENSITY, HEIGHT, ANGLE = 9.81, 1000.0, 0.2, np.pi / 6


def pressed(young: float) -> str:
    """Give the displacements of a block that its weight presses, so that it does not begin with a bounce."""
    y = np.repeat([0.0, 0.1, 0.2], 5)
    down = -DENSITY * GRAVITY * np.cos(ANGLE) / young * y * (HEIGHT - y / 2)
    return numbers(np.stack([0 * y, down], axis=1))


def main() -> None:
    """Compare four stiffnesses."""
    distance, dissipated, slip = [], [], []
    acceleration = GRAVITY * (np.sin(ANGLE) - 0.3 * np.cos(ANGLE))
    for young in (3.2e6, 1.28e7, 5.12e7, 2.048e8):
        history = run("tilted_plane", young=young, displacement=pressed(young))
        distance.append(float(mean(history, history.displacement)[-1, 0]))
        dissipated.append(float(history.contact.resultants.friction_energy[-1]))
        still = run("tilted_plane", young=young, displacement=pressed(young), friction=0.7)
        slip.append(float(still.displacement[-1, still.contact.nodes, 0].mean()))
    way = acceleration * history.time[-1] ** 2 / 2
    weight = history.problem.mass.sum() * GRAVITY
    compare("distance, (g sin - mu g cos) t^2/2", way, distance, "m")
    compare("energy dissipated by friction", 0.3 * weight * np.cos(ANGLE) * way, dissipated, "J")
    compare("slip with mu = 0.7", 0.0, slip, "m")


if __name__ == "__main__":
    main()
