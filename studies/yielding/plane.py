"""Effectivity indices of plane bodies that yield where they strike a plane, against finer meshes."""

from __future__ import annotations

import itertools
import warnings
from dataclasses import dataclass

import percute as pc
from studies.impacts import holds
from studies.turning_blocks import PASSAGES, SIDE, shape

ALUMINIUM = {"young": 70e9, "poisson": 0.3, "density": 2700.0, "yield_stress": 300e6}
SPEEDS, TANGENTS, MESHES = (0.5, 2.0, 6.0), (0.02, 0.1, 0.3), (1, 2)
"""Speeds over that from which a flat impact yields, E_t/E, and meshes of 4 · 2ⁿ cells over the height."""
HYPOTHESES = ("strain", "stress")


@dataclass(frozen=True)
class Case:
    """A body of aluminium that strikes a plane."""

    situation: str
    over: float
    """Speed over the yield speed of a flat impact."""
    tangent: float
    """E_t/E."""
    plane: str = "strain"

    def problem(self, mesh: int, refinements: int) -> tuple[pc.Problem, float]:
        """Give the problem on a mesh, and its end (s)."""
        law = pc.Elastic(**ALUMINIUM, plane=self.plane, tangent=self.tangent * ALUMINIUM["young"])  # type: ignore[arg-type]
        body = shape(self.situation, 1 << mesh)
        for _ in range(refinements):
            body = body.refine()
        height, wave = body.points[:, 1].min(), float(pc.Problem(body, material=law).wave_speed)
        # σ_y (1 − ν)/(1 − 2ν) in plane strain, σ_y in plane stress.
        first = ALUMINIUM["yield_stress"] * (0.7 / 0.4 if self.plane == "strain" else 1.0)
        speed = self.over * first / (ALUMINIUM["density"] * wave)
        gap = 0.18 * SIDE * speed / wave
        along = 0.5 * speed if self.situation == "oblique" else 0.0
        plane = pc.Plane(point=(0.0, height - gap), normal=(0, 1), friction=0.2)
        problem = pc.Problem(body, material=law, obstacles=[plane], initial_velocity=(along, -speed))
        return problem, gap / speed + PASSAGES[self.situation] * SIDE / wave

    def index(self, mesh: int, refinements: int) -> tuple[float, float, bool]:
        """Give the indices of the largest error and of the mean against a reference, and whether the verdict holds."""
        problem, end = self.problem(mesh, 0)
        history = pc.simulate(problem, end=end, courant=0.9, progress=None)
        reference, _ = self.problem(mesh, refinements)
        (error,) = pc.true_errors([history], reference, end=end, courant=0.9, progress=None)
        estimate = pc.estimate(history, threads=1, progress=None)
        found = estimate.effectivity(error)
        return found.sup, found.mean, holds(estimate, (found.sup, found.mean))


def cases() -> list[Case]:
    """Give the rows of the table."""
    return [Case(*row) for row in itertools.product(PASSAGES, SPEEDS, TANGENTS)] + [
        Case("flat", over, tangent, "stress") for over, tangent in itertools.product(SPEEDS, TANGENTS)
    ]


def line(case: Case) -> str:
    """Give a row of the table: both meshes against references with four times as many edges, the coarser one with eight times, too."""
    warnings.simplefilter("ignore")
    found = [case.index(mesh, 2) for mesh in MESHES] + [case.index(MESHES[0], 3)]
    cells = "  ".join(f"{sup:.2f} {mean:.2f}{'' if inside else '!'}" for sup, mean, inside in found)
    return f"{case.situation:8} {case.plane:7} {case.over:4g} {case.tangent:5g}  {cells}"
