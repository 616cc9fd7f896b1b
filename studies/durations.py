"""Effectivity indices of impacts that end sooner or later after the first touch: the table of ``docs/verdict.md``.

``python -m studies.durations`` prints it. Durations are in passages: the time in which a wave goes along the diagonal of the body.
"""

from __future__ import annotations

import json
import math
import warnings
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np
import percute as pc
from studies.bodies import BODIES

PASSAGES = (0.1, 0.25, 0.5, 1.0, 1.5, 2.0, 3.0, 5.0, 10.0)
"""Ends of the runs after the first touch."""
SPEED, GAP = 10.0, 5e-6
"""Speed across the plane (m/s) and gap at the start (m)."""
FINER = 4
"""Refinements from the coarsest mesh to the reference."""


def rectangle(width: float, height: float, nx: int, ny: int) -> Callable[[int], pc.Mesh]:
    """Give the meshes of a rectangle (m), by refinements."""
    return lambda refinements: pc.Mesh.rectangle(width, height, nx=nx << refinements, ny=ny << refinements)


MESHES: dict[str, Callable[[int], pc.Mesh]] = {
    "block": rectangle(0.05, 0.04, 5, 4),
    "tall block": rectangle(0.02, 0.08, 3, 12),
    "flat block": rectangle(0.08, 0.02, 12, 3),
    "disc": lambda refinements: BODIES["disc"]().refine(refinements),
}


@dataclass(frozen=True)
class Impact:
    """One run."""

    body: str
    refinements: int
    courant: float
    oblique: bool = False
    friction: float = 0.2
    tilt: float = 0.0
    """By how much the plane is turned clockwise under the body (°)."""
    last: float = PASSAGES[-1]
    """The longest duration (passages)."""

    def problem(self, mesh: pc.Mesh) -> pc.Problem:
        """Give the problem on a mesh."""
        angle = math.radians(self.tilt)
        normal, tangent = np.array([math.sin(angle), math.cos(angle)]), np.array([math.cos(angle), -math.sin(angle)])
        point = ((mesh.points @ normal).min() - GAP) * normal
        material = pc.Elastic(young=70e9, poisson=0.3, density=2700.0, plane="stress")
        plane = pc.Plane(point=point, normal=normal, friction=self.friction)
        velocity = SPEED * (tangent - normal if self.oblique else -normal)
        return pc.Problem(mesh, material=material, obstacles=[plane], initial_velocity=velocity)

    def indices(self) -> Iterator[tuple[float, float, float, list[float]]]:
        """Give duration, index of sup and of mean, and range of the verdict, of a run for each duration."""
        make = MESHES[self.body]
        problem, fine = self.problem(make(self.refinements)), self.problem(make(FINER))
        passage = float(np.linalg.norm(np.ptp(problem.mesh.points, axis=0))) / math.sqrt(70e9 / (1 - 0.3**2) / 2700.0)
        start, durations = GAP / SPEED, [each for each in PASSAGES if each <= self.last]
        history = self.run(problem, start + durations[-1] * passage)
        (error,) = pc.true_errors([history], fine, courant=0.9, end=float(history.time[-1]))
        for duration in durations:
            end = start + duration * passage
            part = self.run(problem, end)
            there = error.time <= part.time[-1] * (1 + 1e-9)
            sup = math.sqrt(error.total[there].max())
            mean = math.sqrt(np.trapezoid(error.total[there], error.time[there]) / error.time[there][-1])
            estimate = pc.estimate(part, every=1)
            verdict = json.loads(estimate.to_json())["verdict"]
            yield duration, estimate.sup / sup, estimate.mean / mean, verdict["effectivity"]

    def run(self, problem: pc.Problem, end: float) -> pc.History:
        """Run it with whole steps of the stated length, so that a shorter run is the beginning of a longer one."""
        step = self.courant * problem.critical_time_step
        return pc.simulate(problem, end=math.ceil(end / step) * step, step=step)


def impacts() -> list[Impact]:
    """Give the impacts of the table."""
    edges = [
        Impact(body, refinements, courant, oblique=refinements == 1)
        for body in ("block", "tall block", "flat block")
        for refinements in (0, 1)
        for courant in (0.9, 0.5, 0.1)
    ]
    rough = [Impact("tall block", 0, 0.9, oblique=True, friction=0.5), Impact("flat block", 0, 0.2, oblique=True, friction=0.5)]
    others = [Impact("disc", 1, 0.9), Impact("block", 1, 0.9, tilt=10.0), Impact("block", 1, 0.2, tilt=20.0)]
    return [*edges, *rough, *(replace(each, last=2.0) for each in others)]


def main() -> None:
    """Print the table: the lowest and highest index of sup and mean at each duration, and whether all verdicts hold."""
    found: dict[tuple[bool, float], list[tuple[float, bool]]] = {}
    for impact in impacts():
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            for duration, sup, mean, (low, high) in impact.indices():
                held = low <= min(sup, mean) and max(sup, mean) <= high
                if not held:
                    print(f"{impact} after {duration:g} passages: {sup:.2f}, {mean:.2f} outside {low:g} to {high:g}")
                edge = impact.tilt == 0.0 and impact.body != "disc"
                found.setdefault((edge, duration), []).extend([(sup, held), (mean, held)])
    print("| touches first | passages | index | verdicts that hold |\n|---|---|---|---|")
    for (edge, duration), values in found.items():
        low, high = min(value for value, _ in values), max(value for value, _ in values)
        count = f"{sum(held for _, held in values) // 2} of {len(values) // 2}"
        print(f"| {'an edge' if edge else 'a corner or a curve'} | {duration:g} | {low:.2f} to {high:.2f} | {count} |")


if __name__ == "__main__":
    main()
