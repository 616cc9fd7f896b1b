"""Figures of consistency of correct histories: the table of ``docs/foreign.md``.

``python -m studies.consistency`` prints it from some histories, with ``--whole`` from all. A refused history is
an error, and so is one whose contact forces are named as those of another step.
"""

from __future__ import annotations

import sys
import warnings
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product
from typing import Any

import numpy as np
import percute as pc

FIGURES = ("balance", "initial_velocity", "cone", "slip", "gap_under_force", "penetration", "interface_balance", "plane", "touching")
KINDS = ("float64", "float32")
ARRAYS = tuple(product(KINDS, ("with forces", "forces derived")))
SLIDING = tuple(product(KINDS, ("non-matching interfaces",)))
END, GAP, FASTEST = 13e-6, 2e-4, 400.0
"""Time (s) and gap (m) at the largest speed (m/s); slower bodies start nearer."""


@dataclass(frozen=True)
class Cases:
    """Speeds (m/s), coefficients of friction, steps over the critical one."""

    speeds: tuple[float, ...]
    friction: tuple[float, ...]
    courant: tuple[float, ...]


SMALL = Cases((0.4, 400.0), (0.0, 0.5), (0.1, 1.0))
WHOLE = Cases((0.4, 4.0, 40.0, 400.0), (0.0, 0.2, 0.5), (0.02, 0.1, 0.3, 0.6, 0.9, 1.0))


def bodies() -> dict[str, pc.Mesh]:
    """Give a flat block, a tilted one and a disc; the bar is a mesh of its own."""
    flat = pc.Mesh.rectangle(0.05, 0.04, nx=8, ny=6)
    sin, cos = np.sin(np.radians(10.0)), np.cos(np.radians(10.0))
    tilted = pc.Mesh(flat.points @ np.array([[cos, sin], [-sin, cos]]), flat.cells)
    return {"bar": pc.Mesh.bar(0.1, elements=40), "block": flat, "tilted": tilted, "disc": pc.Mesh.disc(0.025, rings=4)}


def problem(mesh: pc.Mesh, speed: float, friction: float) -> pc.Problem:
    """Give a body of aluminium that flies to a plane below it, and along it if it is plane."""
    gap = GAP * speed / FASTEST
    if mesh.dimension == 1:
        material = pc.Elastic(young=70e9, density=2700.0, section=0.02)
        return pc.Problem(mesh, material=material, obstacles=[pc.Plane(point=-gap, normal=1)], initial_velocity=-speed)
    material = pc.Elastic(young=70e9, poisson=0.3, density=2700.0, plane="stress")
    plane = pc.Plane(point=(0, mesh.points[:, 1].min() - gap), normal=(0, 1), friction=friction)
    return pc.Problem(mesh, material=material, obstacles=[plane], initial_velocity=(speed, -speed))


def blocks(speed: float, friction: float) -> pc.Problem:
    """Give a block that slides onto another one, and closes at a tenth of the speed: their nodes do not face each other."""
    law = pc.Elastic(young=70e9, poisson=0.3, density=2700.0, plane="stress")
    lower = pc.Body(name="lower", mesh=pc.Mesh.rectangle(0.04, 0.025, nx=7, ny=5), material=law)
    mesh, closing = pc.Mesh.rectangle(0.04, 0.025, nx=9, ny=5), 0.1 * speed
    place = (0.012, 0.025 + GAP * closing / FASTEST)
    upper = pc.Body(name="upper", mesh=mesh, material=law, origin=place, velocity=(-speed, -closing))
    return pc.Problem(bodies=[lower, upper], contacts=[pc.Interface(friction=friction)])


def simulated(stated: pc.Problem, courant: float) -> pc.History:
    """Simulate with equal steps."""
    steps = max(2, round(END / (courant * stated.critical_time_step)))
    return pc.simulate(stated, steps=[courant * stated.critical_time_step] * steps)


def histories(cases: Cases) -> Iterator[pc.History]:
    """Simulate each case on planes."""
    for mesh in bodies().values():
        friction = cases.friction if mesh.dimension == 2 else (0.0,)
        for speed, coefficient, courant in product(cases.speeds, friction, cases.courant):
            yield simulated(problem(mesh, speed, coefficient), courant)


def of_blocks(cases: Cases) -> Iterator[pc.History]:
    """Simulate each case of two blocks."""
    for speed, coefficient, courant in product(cases.speeds, cases.friction, cases.courant):
        yield simulated(blocks(speed, coefficient), courant)


def figures(history: pc.History, kind: str, forces: str) -> dict[str, float]:
    """Give the figures of a history as another program would have stored it; it must not be refused."""
    arrays: dict[str, Any] = {"displacement": history.displacement.astype(kind)}
    if forces != "forces derived":
        arrays["reaction"] = history.reaction.astype(kind)
    given = pc.History.from_arrays(history.problem, history.time.astype(kind), **arrays)
    estimate = pc.estimate(given, every=len(history))
    if "contact forces of another step" in str(estimate.verdict):
        raise AssertionError(f"contact forces of a correct history are named as shifted: {estimate.verdict}")
    consistency = estimate.consistency or {}
    return {name: float(consistency[name] or 0.0) for name in FIGURES}


def table(cases: Cases) -> tuple[dict[tuple[str, str], dict[str, float]], int]:
    """Give the largest figures of all histories for each kind of arrays, and the number of histories."""
    largest = {key: dict.fromkeys(FIGURES, 0.0) for key in (*ARRAYS, *SLIDING)}
    count = 0
    for all_of, keys in ((histories(cases), ARRAYS), (of_blocks(cases), SLIDING)):
        for history in all_of:
            for key in keys:
                with warnings.catch_warnings():
                    warnings.simplefilter("ignore", pc.InputWarning)
                    found = figures(history, *key)
                largest[key] = {name: max(value, found[name]) for name, value in largest[key].items()}
                count += 1
    return largest, count


def main() -> None:
    """Print the table."""
    found, count = table(WHOLE if "--whole" in sys.argv[1:] else SMALL)
    print(f"{count} histories, none refused\n")
    print("| arrays |" + "|".join(f" `{name}` " for name in FIGURES) + "|")
    print("|---|" + "---|" * len(FIGURES))
    for (kind, forces), row in found.items():
        print(f"| `{kind}`, {forces} |" + "|".join(f" {row[name]:.0e} " if row[name] else " 0 " for name in FIGURES) + "|")


if __name__ == "__main__":
    main()
