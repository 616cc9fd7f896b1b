"""The bar of the paper's §7.1 against a wall, for any mesh, step and instant of impact."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import percute as pc
from percute.estimating import ablated
from studies.impacts import holds
from studies.parallel import Stop

BAR = {"length": 0.1, "young": 70e9, "density": 2700.0, "section": 0.02, "speed": 400.0}
"""The bar of the paper's §7.1.4, but for the gap, which the paper does not state."""
WHOLE = 1.0
"""Whole steps of flight before the step of the impact: nearer starts with an early impact are refused."""


@dataclass(frozen=True)
class Outcome:
    """The results of a run."""

    exact: tuple[float, float]
    """Largest and mean true error (J^½), eq. [60]."""
    estimates: list[tuple[float, ...]]
    """Largest and mean estimated error (J^½) of each choice, and both relative to their denominators, eq. [22]."""
    indices: list[pc.Effectivity]
    """e_RdC/e_Ex of each choice."""
    held: list[bool]
    """Whether the range of the verdict contains both, of each choice."""

    def effectivity(self, choice: int) -> tuple[float, float]:
        """Give e_RdC/e_Ex of a choice, of the largest and the mean error."""
        return self.indices[choice].sup, self.indices[choice].mean


@dataclass(frozen=True)
class Setting:
    """One run."""

    elements: int
    """Number of elements N_s."""
    ratio: float
    """α = Δt/Δt_c."""
    fraction: float
    """The fraction of a step at which the impact falls: the gap is 1 + this times v₀Δt."""
    after_impact: float
    """(T − t_c)/(L/c), rounded up to whole steps. Contact lasts 2."""

    @property
    def step(self) -> float:
        """Δt (s); on the uniform bar Δt_c is h/c exactly, eq. [33]."""
        return self.ratio * BAR["length"] / self.elements / math.sqrt(BAR["young"] / BAR["density"])

    def run(self, choices: Sequence[Mapping[str, Any]], stop: Stop | None = None) -> Outcome:
        """Simulate, estimate with each choice of arguments of `ablated`, and compare with the exact solution."""
        exact = pc.exact.BarImpact(gap=(WHOLE + self.fraction) * self.step * BAR["speed"], **BAR)
        problem = pc.Problem(
            pc.Mesh.bar(BAR["length"], elements=self.elements),
            material=pc.Elastic(young=BAR["young"], density=BAR["density"], section=BAR["section"]),
            initial_velocity=-BAR["speed"],
            obstacles=[pc.Plane(point=-exact.gap, normal=1.0)],
        )
        # Where a whole number of steps is due, rounding must not add one.
        count = math.ceil(WHOLE + self.fraction + self.after_impact * self.elements / self.ratio - 1e-6)
        history = pc.simulate(problem, end=count * self.step, step=self.step, progress=stop)
        estimates = [ablated(history, every=1, threads=1, progress=stop, **choice) for choice in choices]
        true = exact.error(history)
        errors: list[tuple[float, ...]] = [(each.sup, each.mean, each.published_relative_sup, each.published_relative_mean) for each in estimates]
        indices = [each.effectivity(true) for each in estimates]
        held = [holds(each, (index.sup, index.mean)) for each, index in zip(estimates, indices, strict=True)]
        return Outcome((true.sup, true.mean), errors, indices, held)
