"""Effectivity indices of corners whose mesh is graded towards the contact.

``python -m studies.graded`` prints a table: structured meshes, refined around the corner, and meshes of Gmsh. It needs
the package ``gmsh``. ``--gradings`` and ``--courants`` choose rows and columns.
"""

from __future__ import annotations

import argparse
import json
import math
import tempfile
import warnings
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import percute as pc

WIDTH, HEIGHT, COARSE = 0.06, 0.024, 0.003
"""Sides of the block, and its elements far from the corner (m)."""
TILT, GAP, SPEED = math.radians(12.0), 1e-5, 4.0
"""Angle between the lower side and the plane, distance (m) and speed (m/s)."""
END = 2e-5
"""End of the run (s)."""
GRADINGS = (4, 16, 64, 256)
"""Elements far from the corner over those at it."""
COURANTS = (0.95, 0.9, 0.7, 0.5, 0.3)
"""Steps over the critical one."""
FINER = 1
"""Refinements from a mesh to its reference, whose steps are half as long as those at 0.95 Δt_c."""


@dataclass(frozen=True)
class Corner:
    """A block of aluminium that strikes a plane with a corner."""

    mesh: str
    """``structured`` or ``Gmsh``."""
    grading: int
    friction: float = 0.0

    def coarse(self) -> pc.Mesh:
        """Give the mesh of the run; the corner is its origin."""
        return structured(self.grading) if self.mesh == "structured" else unstructured(self.grading)

    def problem(self, mesh: pc.Mesh) -> pc.Problem:
        """Give the problem on a mesh."""
        normal = np.array([math.sin(TILT), math.cos(TILT)])
        plane = pc.Plane(point=-GAP * normal, normal=normal, friction=self.friction)
        material = pc.Elastic(young=70e9, poisson=0.33, density=2700.0, plane="strain")
        return pc.Problem(mesh, material=material, initial_velocity=-SPEED * normal, obstacles=[plane])

    def row(self, courants: tuple[float, ...]) -> list[tuple[float, float, float, str]]:
        """Give indices of sup and mean, the energy that contact gives the auxiliary solution, and trust, by step."""
        mesh = self.coarse()
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", pc.SimulationWarning)
            histories = [pc.simulate(self.problem(mesh), end=END, courant=courant) for courant in courants]
            errors = pc.true_errors(histories, self.problem(mesh.refine(FINER)), end=END, courant=0.95)
            estimates = [pc.estimate(history) for history in histories]
        given = [json.loads(estimate.to_json())["auxiliary_contact_energy"] for estimate in estimates]
        each = zip(estimates, errors, given, strict=True)
        return [(found.sup / error.sup, found.mean / error.mean, energy, str(found.trust)) for found, error, energy in each]


def structured(grading: int) -> pc.Mesh:
    """Halve the elements at the corner of a uniform mesh until they are so many times smaller."""
    mesh = pc.Mesh.rectangle(WIDTH, HEIGHT, nx=round(WIDTH / COARSE), ny=round(HEIGHT / COARSE))
    for _ in range(round(math.log2(grading))):
        corner = int(np.flatnonzero((mesh.points == 0.0).all(1))[0])
        mesh = mesh.refine(where=(mesh.cells == corner).any(1))
    return mesh


def unstructured(grading: int) -> pc.Mesh:
    """Make a mesh with Gmsh whose elements grow from the corner on."""
    import gmsh

    gmsh.initialize(["gmsh", "-noenv"], interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        places = [(0.0, 0.0), (WIDTH, 0.0), (WIDTH, HEIGHT), (0.0, HEIGHT)]
        sizes = [COARSE / grading, COARSE, COARSE, COARSE]
        points = [gmsh.model.geo.addPoint(x, y, 0.0, size) for (x, y), size in zip(places, sizes, strict=True)]
        sides = [gmsh.model.geo.addLine(points[i], points[(i + 1) % 4]) for i in range(4)]
        surface = gmsh.model.geo.addPlaneSurface([gmsh.model.geo.addCurveLoop(sides)])
        gmsh.model.geo.synchronize()
        gmsh.model.addPhysicalGroup(2, [surface], name="block")
        gmsh.model.mesh.generate(2)
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "block.msh"
            gmsh.write(str(file))
            return pc.Mesh.read(file)
    finally:
        gmsh.finalize()


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=main.__doc__)
    parser.add_argument("--gradings", type=int, nargs="+", default=GRADINGS)
    parser.add_argument("--courants", type=float, nargs="+", default=COURANTS)
    options = parser.parse_args()
    print(f"| mesh | grading | {' | '.join(f'{courant:g} Δt_c' for courant in options.courants)} |\n|{'---|' * (2 + len(options.courants))}")
    for mesh in ("structured", "Gmsh"):
        for grading in options.gradings:
            row = Corner(mesh, grading).row(tuple(options.courants))
            cells = [f"{sup:.2f}, {mean:.2f} ({trust}, {100 * energy:.1f} %)" for sup, mean, energy, trust in row]
            print(f"| {mesh} | {grading} | {' | '.join(cells)} |", flush=True)


if __name__ == "__main__":
    main()
