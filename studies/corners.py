"""Effectivity indices of bodies that strike the corner of two planes: the table of ``docs/verdict.md``.

``python -m studies.corners`` prints it.
"""

from __future__ import annotations

import json
import math
import warnings
from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import product

import numpy as np
import percute as pc

OPENINGS = (20.0, 30.0, 45.0, 60.0, 75.0, 90.0, 105.0, 120.0, 135.0, 150.0)
"""Angles between the planes (°)."""
PRESSED = (45.0, 90.0, 120.0)
"""Angles between the planes into which bodies also slide, or are pressed by a force (°)."""
SPEED = 20.0
"""Speed towards the floor (m/s)."""
MESHES, FINER = (0, 1), 3
"""Refinements from the mesh of 10 × 8 cells to those of the runs and to the reference."""
COURANT = 0.9


@dataclass(frozen=True)
class Corner:
    """A parallelogram of aluminium that fits into the corner of a floor and a wall, 50 mm along one and 40 mm along the other."""

    opening: float
    """The angle between the planes (°)."""
    longer: bool = False
    """Whether cells are cut along their longer diagonal, so that triangles have their obtuse angle."""
    approach: tuple[float, float] = (SPEED, SPEED)
    """Speed towards each plane (m/s)."""
    gaps: tuple[float, float] = (2e-5, 4e-5)
    """Distance from each plane at the start (m)."""
    friction: tuple[float, float] = (0.1, 0.1)
    force: tuple[float, float] | None = None
    """A body force (N/m³)."""
    end: float = 20e-6
    """End of the run (s)."""

    @property
    def normals(self) -> np.ndarray[tuple[int, int], np.dtype[np.float64]]:
        """The normals of floor and wall."""
        angle = math.radians(self.opening)
        # Exactly orthogonal planes at a right angle.
        cosine = 0.0 if self.opening == 90.0 else math.cos(angle)
        return np.array([[0.0, 1.0], [math.sin(angle), -cosine]])

    def problem(self, refinements: int = 0) -> pc.Problem:
        """Give the problem on a mesh."""
        normals = self.normals
        grid = pc.Mesh.rectangle(0.05, 0.04, nx=10 << refinements, ny=8 << refinements)
        x, y = grid.points.T
        cells, left = grid.cells, "left"
        if self.longer == (self.opening > 90.0):
            # The mirror image has the other diagonals.
            x, cells, left = 0.05 - x, cells[:, ::-1], "right"
        points = np.column_stack([x - normals[1, 1] * y, normals[1, 0] * y])
        mesh = pc.Mesh(points, cells, edge_groups={"floor": grid.edge_groups["bottom"], "wall": grid.edge_groups[left]})
        planes = [
            pc.Plane(point=-gap * normal, normal=normal, friction=friction, group=group)
            for normal, gap, friction, group in zip(normals, self.gaps, self.friction, ("floor", "wall"), strict=True)
        ]
        forces = [] if self.force is None else [pc.BodyForce(value=self.force)]
        material = pc.Elastic(young=70e9, poisson=0.3, density=2700.0, plane="stress")
        velocity = -np.linalg.solve(normals, np.array(self.approach))
        return pc.Problem(mesh, material=material, obstacles=planes, initial_velocity=velocity, body_forces=forces)

    def indices(self) -> Iterator[tuple[float, float, list[float]]]:
        """Give index of sup and of mean, and range of the verdict, on each mesh."""
        histories = [pc.simulate(self.problem(refinements), end=self.end, courant=COURANT) for refinements in MESHES]
        errors = pc.true_errors(histories, self.problem(FINER), end=self.end, courant=COURANT)
        for history, error in zip(histories, errors, strict=True):
            estimate = pc.estimate(history, every=1)
            yield estimate.sup / error.sup, estimate.mean / error.mean, json.loads(estimate.to_json())["verdict"]["effectivity"]


def impacts() -> list[Corner]:
    """Give the impacts of the table: onto both planes with two ratios of speeds, fast, slow, and along the floor."""
    found = []
    for opening, longer in product(OPENINGS, (False, True)):
        struck = Corner(opening, longer)
        found += [struck, replace(struck, approach=(SPEED / 2, SPEED), friction=(0.0, 0.2))]
    for opening in PRESSED:
        fast, slow = (replace(Corner(opening), approach=(k * SPEED, k * SPEED), gaps=(2e-5 * k, 4e-5 * k)) for k in (10, 0.05))
        found += [fast, slow, replace(Corner(opening), approach=(0.0, SPEED), gaps=(0.0, 4e-5))]
    return found


def pressed(end: float) -> list[Corner]:
    """Give bodies that a force presses into the corner, from rest at both planes to an instant (s)."""
    resting = [Corner(opening, approach=(0.0, 0.0), gaps=(0.0, 0.0), end=end) for opening in PRESSED]
    forces, frictions = ((-5e7, -1e8), (-7e7, -7e7)), ((0.0, 0.0), (0.2, 0.2))
    return [replace(each, force=force, friction=friction) for each, force, friction in product(resting, forces, frictions)]


def measured(corners: list[Corner]) -> dict[tuple[float, bool], list[tuple[float, float, bool]]]:
    """Give lowest and highest index of each run, and whether its verdict holds, by the angle and the diagonals; print those that do not."""
    found: dict[tuple[float, bool], list[tuple[float, float, bool]]] = {}
    for corner in corners:
        for sup, mean, (low, high) in corner.indices():
            least, most = min(sup, mean), max(sup, mean)
            held = low <= least and most <= high
            if not held:
                print(f"{corner}: {sup:.2f}, {mean:.2f} outside {low:g} to {high:g}")
            found.setdefault((corner.opening, corner.longer), []).append((least, most, held))
    return found


def main() -> None:
    """Print the table: the lowest and highest index of sup and mean at each angle, and in how many runs the verdict holds."""
    warnings.simplefilter("ignore")
    print("| the planes open by | | cut along the shorter diagonal | along the longer one | verdicts that hold |\n|---|---|---|---|---|")
    for name, corners in (("impact", impacts()), *((f"pressed for {1e6 * end:.0f} µs", pressed(end)) for end in (60e-6, 200e-6))):
        found = measured(corners)
        for opening in dict.fromkeys(corner.opening for corner in corners):
            both = [found.get((opening, longer), []) for longer in (False, True)]
            ranges = [f"{min(row[0] for row in rows):.2f} to {max(row[1] for row in rows):.2f}" if rows else "–" for rows in both]
            held = [kept for rows in both for _, _, kept in rows]
            print(f"| {opening:g}° | {name} | {' | '.join(ranges)} | {sum(held)} of {len(held)} |", flush=True)


if __name__ == "__main__":
    main()
