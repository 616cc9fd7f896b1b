"""Loads and prescribed motions with exact answers, against the results of percute.

``python examples/loads.py`` takes a second. Each line has a computed value, the exact value and their relative difference.
"""

import numpy as np
import percute as pc

YOUNG, DENSITY, LENGTH = 70e9, 2700.0, 0.1
SPEED = float(np.sqrt(YOUNG / DENSITY))  # wave speed in a bar (m/s)
BAR = pc.Elastic(young=YOUNG, density=DENSITY, section=1e-4)
BLOCK = pc.Elastic(young=YOUNG, poisson=0.3, density=DENSITY, plane="strain")


def free_fall() -> tuple[float, float]:
    """Weight alone: ½ g t². Central differences are exact here, and the estimate is zero."""
    gravity, end = 9.81, 1e-4
    mesh = pc.Mesh.disc(0.05, rings=4)
    problem = pc.Problem(mesh, material=BLOCK, body_forces=[pc.BodyForce(value=(0, -gravity * DENSITY))])
    history = pc.simulate(problem, end=end, courant=0.9)
    # Relative to the energy norm of the fields.
    assert pc.estimate(history).relative_sup < 1e-9
    return history.displacement[-1, 0, 1], -gravity * end**2 / 2


def pulled_bar() -> tuple[float, float]:
    """A bar is clamped at its start. A stress that grows linearly in time pulls its end.

    A stress s moves the end at the velocity s/(ρc). Each echo from the clamp, every 2L/c, changes the velocity by twice this value.
    """
    end, stress = 5 * LENGTH / SPEED, 1e8
    problem = pc.Problem(
        pc.Mesh.bar(LENGTH, elements=200),
        material=BAR,
        supports=[pc.Support(group="start", components="x")],
        tractions=[pc.Traction(group="end", value=(0.0, stress), time=(0.0, end))],
    )
    echoes = [end - 2 * k * LENGTH / SPEED for k in range(3)]
    factors = [1, -2, 2]
    travelled = sum(f * stress / end * t**2 / 2 for f, t in zip(factors, echoes, strict=True) if t > 0)
    return pc.simulate(problem, end=end, courant=0.9).displacement[-1, -1, 0], travelled / (DENSITY * SPEED)


def pushed_bar() -> tuple[float, float]:
    """A support moves the start of a bar at a velocity that grows linearly. The middle follows after L/2c."""
    end, velocity = 0.9 * LENGTH / SPEED, 2.0
    problem = pc.Problem(
        pc.Mesh.bar(LENGTH, elements=200),
        material=BAR,
        supports=[pc.Support(group="start", components="x", velocity=(0.0, velocity), time=(0.0, end))],
    )
    middle = pc.simulate(problem, end=end, courant=0.9).displacement[-1, 100, 0]
    return middle, velocity / end * (end - LENGTH / 2 / SPEED) ** 2 / 2


def pressed_block(cells: int = 100) -> tuple[float, float]:
    """A pressure acts on the right side of a block between rollers: a plane wave of the speed √((λ + 2μ)/ρ)."""
    lame = YOUNG * 0.3 / (1.3 * 0.4) + YOUNG / 1.3
    speed, pressure, width = float(np.sqrt(lame / DENSITY)), 1e8, 0.05
    end = 1.5 * width / speed
    problem = pc.Problem(
        pc.Mesh.rectangle(width, 0.01, nx=cells, ny=cells // 5),
        material=BLOCK,
        supports=[pc.Support(group=side, components="y") for side in ("bottom", "top")],
        tractions=[pc.Traction(group="right", value=((0, 0), (-pressure, 0)), time=(0.0, end))],
    )
    # Corners have half the mass and half the load of other nodes, so the whole side moves uniformly.
    side = problem.mesh.points[:, 0] == width
    moved = pc.simulate(problem, end=end, courant=0.9).displacement[-1, side, 0]
    return moved.mean(), -pressure * end / 2 / (DENSITY * speed)


def uneven_push() -> tuple[float, float]:
    """A traction varies along an edge: the momentum of a free block is the resultant times the time."""
    end, pressure, width, height = 1e-5, 1e6, 0.05, 0.04
    traction = pc.Traction(group="bottom", value=(0, pressure), profile=(1.0, (40.0, 0.0)))
    problem = pc.Problem(pc.Mesh.rectangle(width, height, nx=10, ny=8), material=BLOCK, tractions=[traction])
    history = pc.simulate(problem, end=end, courant=0.9)
    momentum = float(problem.mass @ history.velocity[-1, :, 1])
    return momentum, pressure * (width + 40.0 * width**2 / 2) * end


def main() -> None:
    """Print the values."""
    largest = 0.0
    for case in (free_fall, pulled_bar, pushed_bar, pressed_block, uneven_push):
        computed, exact = case()
        difference = abs(computed / exact - 1.0)
        largest = max(largest, difference)
        print(f"{case.__name__:<14} computed {computed:13.6e}   exact {exact:13.6e}   difference {difference:.1e}")
    print(f"largest difference {largest:.1e}")


if __name__ == "__main__":
    main()
