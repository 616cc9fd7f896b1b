"""How fine must a mesh be? Four impacts, for each of which `percute.adapt` finds the mesh for a wanted accuracy.

    python examples/how_fine.py
    python examples/how_fine.py --pictures FOLDER

The script takes some seconds and prints the runs of each case. docs/gallery/how_fine.md has the results.
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import percute as pc

ALUMINIUM = pc.Elastic(young=70e9, poisson=0.3, density=2700.0, plane="stress")
COURANT = 0.9


def thrown(mesh: pc.Mesh, speed: float, tilt: float = 0.0) -> pc.Problem:
    """Throw a body against a plane that is tilted (°) under it."""
    angle = math.radians(tilt)
    normal = np.array([math.sin(angle), math.cos(angle)])
    plane = pc.Plane(point=(float((mesh.points @ normal).min()) - 5e-7 * speed) * normal, normal=normal, friction=0.2)
    return pc.Problem(mesh, material=ALUMINIUM, obstacles=[plane], initial_velocity=-speed * normal)


def bracket() -> pc.Problem:
    """An L of 50 × 50 mm that hangs at its upper end; a force grows at the right one."""
    square = pc.Mesh.rectangle(0.05, 0.05, nx=10, ny=10)
    x, y = square.points[square.cells].mean(axis=1).T
    kept, cells = np.unique(square.cells[(x < 0.02) | (y < 0.02)], return_inverse=True)
    x, y = square.points[kept].T
    # The edges of both ends, along the outline.
    ends = {"hung": np.flatnonzero(y == y.max()), "pulled": np.flatnonzero(x == x.max())}
    mesh = pc.Mesh(square.points[kept], cells.reshape(-1, 3), edge_groups={name: np.column_stack([nodes[:-1], nodes[1:]]) for name, nodes in ends.items()})
    time = np.linspace(0.0, 60e-6, 25)
    force = [(0.0, -1e7 * math.sin(math.pi * t / 120e-6) ** 2) for t in time]
    return pc.Problem(
        mesh,
        material=ALUMINIUM,
        supports=[pc.Support(group="hung", components=("x", "y"))],
        tractions=[pc.Traction(group="pulled", value=force, time=time)],
    )


def cases() -> Iterator[tuple[str, str, pc.Problem, float, float]]:
    """Give key, name, problem, end (s) and target of each case."""
    block = pc.Mesh.rectangle(0.05, 0.04, nx=10, ny=8)
    yield "front", "a block that lands flat at 100 m/s", thrown(block, 100.0), 13e-6, 0.18
    yield "corner", "a block that lands on a corner at 10 m/s", thrown(block, 10.0, tilt=10.0), 25e-6, 0.4
    yield "bracket", "a bracket under a slow load", bracket(), 100e-6, 0.1
    yield "disc", "a disc that lands at 40 m/s", thrown(pc.Mesh.disc(0.025, rings=4), 40.0), 25e-6, 0.3


def main() -> None:
    """Print the runs of all cases."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])  # type: ignore[union-attr]
    parser.add_argument("--pictures", type=Path, metavar="FOLDER", help="draw the best mesh of each case, and error over cost")
    given = parser.parse_args()
    for key, name, problem, end, target in cases():
        found = pc.adapt(problem, target=target, end=end, courant=COURANT)
        print(f"{name}\n{found}\n")
        if given.pictures:
            found.plot(save=given.pictures / f"how_fine_{key}.png", overwrite=True)
    _, name, problem, end, _ = next(cases())
    print(f"{name}, asked for too much\n{pc.adapt(problem, target=0.01, end=end, courant=COURANT)}")


if __name__ == "__main__":
    main()
