"""Effectivity indices of soft and of skewed bodies that strike another one: a table of ``docs/bodies.md``.

``python -m studies.two_bodies`` prints it.
"""

from __future__ import annotations

import json
import warnings
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import percute as pc
from studies.block import ALUMINIUM

MATERIALS: dict[str, dict[str, Any]] = {"aluminium": ALUMINIUM, "plastic": {"young": 3e9, "poisson": 0.35, "density": 1200.0}}
WIDTH, HEIGHT, GAP = 0.04, 0.025, 50e-6
"""Of each body (m), and the gap between them (m)."""
SPEED, FRICTION, COURANT = 40.0, 0.2, 0.9
"""Speed of the upper body (m/s), coefficient of friction, step over the critical one."""
ENDS = (7e-6, 14e-6, 28e-6, 56e-6)
"""Ends of the runs (s): one to eight passages of a wave through the height of a body of aluminium."""
MESHES, FINER = (0, 1), 3
"""Refinements from the mesh of 10 × 8 cells to those of the runs and to the reference."""


@dataclass(frozen=True)
class Pair:
    """Two bodies of 40 × 25 mm, the upper one of which falls on the lower one."""

    upper: str = "aluminium"
    """Its material."""
    lower: str = "aluminium"
    """Its material."""
    skew: float = 0.0
    """The angle by which the sides of both bodies lean to the right (°); triangles are then cut along the longer diagonal."""
    facing: bool = True
    """Whether their nodes face each other; if not, the upper one has 7 × 6 cells."""

    @property
    def name(self) -> str:
        """Say what strikes what."""
        diagonal = f", inclined by {abs(self.skew):g}°, cut along the {'longer' if self.skew > 0 else 'shorter'} diagonal" if self.skew else ""
        return f"{self.upper} on {self.lower}{diagonal}{'' if self.facing else ', non-matching interface'}"

    def problem(self, refinements: int = 0) -> pc.Problem:
        """Give the problem."""
        lower, upper = (self._mesh(nx, ny).refine(refinements) for nx, ny in [(10, 8), (10, 8) if self.facing else (7, 6)])
        laws = [pc.Elastic(**MATERIALS[material], plane="stress") for material in (self.lower, self.upper)]
        # The upper one begins where the lower one, which leans, ends.
        above = (float(np.tan(np.radians(self.skew))) * HEIGHT, HEIGHT + GAP)
        bodies = [pc.Body(name="lower", mesh=lower, material=laws[0]), pc.Body(name="upper", mesh=upper, material=laws[1], origin=above, velocity=(0.0, -SPEED))]
        return pc.Problem(bodies=bodies, contacts=[pc.Interface(groups=("upper.bottom", "lower.top"), friction=FRICTION, matching=self.facing)])

    def _mesh(self, nx: int, ny: int) -> pc.Mesh:
        flat = pc.Mesh.rectangle(WIDTH, HEIGHT, nx=nx, ny=ny)
        points = flat.points.copy()
        points[:, 0] += np.tan(np.radians(self.skew)) * points[:, 1]
        return pc.Mesh(points, flat.cells, edge_groups=dict(flat.edge_groups))

    def run(self, end: float) -> list[tuple[float, float, bool]]:
        """Give for each mesh the effectivity indices of sup and mean, and whether the range of the verdict has both."""
        histories = [pc.simulate(self.problem(mesh), end=end, courant=COURANT) for mesh in MESHES]
        errors = pc.true_errors(histories, self.problem(FINER), end=end, courant=COURANT)
        found = []
        for history, error in zip(histories, errors, strict=True):
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", pc.SimulationWarning)
                estimate = pc.estimate(history, every=1)
            low, high = json.loads(estimate.to_json())["verdict"]["effectivity"]
            indices = estimate.sup / error.sup, estimate.mean / error.mean
            found.append((*indices, bool(low <= min(indices) and max(indices) <= high)))
        return found


def pairs() -> list[Pair]:
    """Give the cases of the table."""
    soft = [Pair(), Pair(upper="plastic"), Pair(upper="plastic", lower="plastic")]
    skewed = [Pair(skew=angle) for angle in (15.0, -15.0, 30.0, -30.0, 45.0, -45.0)]
    return [*soft, *skewed, *(replace(pair, facing=False) for pair in (*soft, skewed[2], skewed[3]))]


def row(pair: Pair) -> tuple[list[str], int, int]:
    """Give the range of the indices at each end, and how many verdicts hold of how many."""
    runs = [pair.run(end) for end in ENDS]
    indices = [[index for sup, mean, _ in run for index in (sup, mean)] for run in runs]
    held = [held for run in runs for *_, held in run]
    return [f"{min(each):.2f} to {max(each):.2f}" for each in indices], sum(held), len(held)


def main() -> None:
    """Print the table."""
    print(f"| the bodies | {' | '.join(f'{1e6 * end:g} µs' for end in ENDS)} | verdicts that hold |\n|{'---|' * (len(ENDS) + 2)}")
    for pair in pairs():
        ranges, held, count = row(pair)
        print(f"| {pair.name} | {' | '.join(ranges)} | {held} of {count} |", flush=True)


if __name__ == "__main__":
    main()
