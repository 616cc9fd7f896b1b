"""Estimates of histories that are sampled more coarsely than the steps of their solver: the table of ``docs/foreign.md``."""

from __future__ import annotations

import math
import warnings
from collections.abc import Iterator
from dataclasses import dataclass

import percute as pc

EVERY = (1, 2, 5, 10, 50)
"""Steps between samples."""
CASES = (("block", 0.3), ("block", 0.08), ("bar", 0.9), ("bar", 0.09))
"""Bodies, and steps over the critical one."""


@dataclass(frozen=True)
class Row:
    """Estimates from samples: the body, the step over the critical one, the steps between samples, and the relative errors."""

    body: str
    courant: float
    every: int
    sup: float
    mean: float

    @property
    def distance(self) -> float:
        """Distance of the samples over the critical step."""
        return self.courant * self.every


def problem(body: str) -> tuple[pc.Problem, float]:
    """Give the body of the paper on a coarse mesh, and the end (s)."""
    if body == "bar":
        material = pc.Elastic(young=70e9, density=2700.0, section=0.02)
        plane = pc.Plane(point=-2e-4, normal=1, friction=0.0)
        return pc.Problem(pc.Mesh.bar(0.1, elements=40), material=material, obstacles=[plane], initial_velocity=-400), 40e-6
    material = pc.Elastic(young=70e9, poisson=0.3, density=2700.0, plane="stress")
    plane = pc.Plane(point=(0, -2e-4), normal=(0, 1), friction=0.2)
    mesh = pc.Mesh.rectangle(0.05, 0.04, nx=8, ny=6)
    return pc.Problem(mesh, material=material, obstacles=[plane], initial_velocity=(400, -400)), 13e-6


def sampled(history: pc.History, every: int) -> pc.History:
    """Keep each so manyth instant, as another program would."""
    names = ("displacement", "reaction", "touching", "velocity", "acceleration")
    arrays = {name: getattr(history, name)[::every] for name in names}
    return pc.History.from_arrays(history.problem, history.time[::every], **arrays)


def table(cases: tuple[tuple[str, float], ...] = CASES, every: tuple[int, ...] = EVERY) -> Iterator[Row]:
    """Estimate each case from its samples."""
    for body, courant in cases:
        stated, end = problem(body)
        # A whole number of the longest distances.
        steps = 50 * math.ceil(end / (50 * courant * stated.critical_time_step))
        history = pc.simulate(stated, end=end, step=end / steps)
        for k in every:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", pc.InputWarning)
                estimate = pc.estimate(sampled(history, k), every=1, force=True)
            yield Row(body, end / steps / stated.critical_time_step, k, estimate.published_relative_sup, estimate.published_relative_mean)


def main() -> None:
    """Print the table."""
    for row in table():
        print(f"| {row.body} | {row.courant:.2f} | {row.every} | {row.distance:.2f} | {100 * row.sup:.1f} % | {100 * row.mean:.1f} % |")


if __name__ == "__main__":
    main()
