"""Effectivity indices where the end of a surface slides along the edges of the other one: a table of ``docs/bodies.md``.

``python -m studies.ends`` prints it, with the largest share of the energy that contact gave.
"""

from __future__ import annotations

import json
import warnings
from dataclasses import dataclass

import percute as pc
from studies import two_bodies
from studies.bodies import STEEL

MATERIALS = {**two_bodies.MATERIALS, "steel": STEEL}
STEPS = (0.9, 0.3)
"""Steps over the critical one."""
MESHES, FINER = (0, 1), 3
"""Refinements of the first mesh: those of the runs, and that of the reference, with steps of 0.9 Δt_c."""


@dataclass(frozen=True)
class Pair:
    """Two blocks, of which the upper one slides along the end of the lower one."""

    name: str
    lower: str
    upper: str
    velocity: tuple[float, float]
    """Of the upper block (m/s)."""
    end: float
    """End of the run (s)."""
    aside: float = 0.0
    """How far the upper one starts to the right of the lower one (m)."""
    small: bool = False
    """Whether the lower one is turned by 3.5°, and a small block strikes its end; else both are 40 × 25 mm large."""

    def problem(self, refinements: int = 0) -> pc.Problem:
        """Give the problem."""
        sizes = [(0.027, 0.0135, 9, 5), (0.016, 0.008, 5, 2)] if self.small else [(0.04, 0.025, 10, 8), (0.04, 0.025, 7, 6)]
        meshes = [pc.Mesh.rectangle(width, height, nx=nx, ny=ny).refine(refinements) for width, height, nx, ny in sizes]
        laws = [pc.Elastic(**MATERIALS[material], plane="stress") for material in (self.lower, self.upper)]
        origin = (-0.0097, 0.0142) if self.small else (self.aside, 0.02505)
        lower = pc.Body(name="lower", mesh=meshes[0], material=laws[0], rotation=3.5 if self.small else 0.0)
        upper = pc.Body(name="upper", mesh=meshes[1], material=laws[1], origin=origin, velocity=self.velocity)
        return pc.Problem(bodies=[lower, upper], contacts=[pc.Interface(friction=0.2)])

    def run(self, courant: float, meshes: tuple[int, ...] = MESHES) -> tuple[list[float], float]:
        """Give the indices of sup and mean on all meshes, and the largest share of the energy that contact gave."""
        histories = [pc.simulate(self.problem(mesh), end=self.end, courant=courant) for mesh in meshes]
        errors = pc.true_errors(histories, self.problem(FINER), end=self.end, courant=0.9)
        estimates = [estimated(history) for history in histories]
        indices = [index for found, true in zip(estimates, errors, strict=True) for index in (found.sup / true.sup, found.mean / true.mean)]
        return indices, max(given(estimate) for estimate in estimates)


def estimated(history: pc.History) -> pc.Estimate:
    """Estimate without a word of what is meant to be so."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", pc.SimulationWarning)
        return pc.estimate(history, every=1)


def given(estimate: pc.Estimate) -> float:
    """Give the largest rise of the work of contact, friction apart, over the energy at the start."""
    document = json.loads(estimate.to_json())
    over_time = document["balance_over_time"]
    least = rise = 0.0
    for work, friction in zip(over_time["work_of_contact"], over_time["friction"], strict=True):
        least, rise = min(least, work + friction), max(rise, work + friction - least)
    return rise / float(document["balance"]["initial"])


PAIRS = (
    Pair("aluminium over aluminium, 100 m/s", "aluminium", "aluminium", (100.0, -20.0), 60e-6),
    Pair("aluminium over aluminium, 400 m/s", "aluminium", "aluminium", (400.0, -20.0), 20e-6),
    Pair("plastic over steel, 100 m/s", "steel", "plastic", (100.0, -20.0), 60e-6),
    Pair("steel over plastic, 100 m/s", "plastic", "steel", (100.0, -20.0), 60e-6),
    Pair("steel over plastic, 400 m/s", "plastic", "steel", (400.0, -20.0), 20e-6),
    Pair("plastic onto steel, 100 m/s", "steel", "plastic", (-100.0, -20.0), 60e-6, aside=0.034),
    Pair("a small plastic block on the end of a steel one", "steel", "plastic", (11.0, -36.0), 77e-6, small=True),
)
"""The rows of the table."""


def main() -> None:
    """Print the table."""
    print(f"| the bodies | {' | '.join(f'{courant:g} Δt_c' for courant in STEPS)} | energy from contact |\n|{'---|' * (len(STEPS) + 2)}")
    for pair in PAIRS:
        runs = [pair.run(courant) for courant in STEPS]
        ranges = [f"{min(indices):.2f} to {max(indices):.2f}" for indices, _ in runs]
        print(f"| {pair.name} | {' | '.join(ranges)} | {100 * max(share for _, share in runs):.1f} % |", flush=True)


if __name__ == "__main__":
    main()
