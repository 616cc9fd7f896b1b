"""Effectivity indices of corners and curves that strike the surface of another body: tables of ``docs/bodies.md``.

``python -m studies.struck`` prints them.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from functools import partial
from typing import Protocol

import numpy as np
import percute as pc
from studies.block import ALUMINIUM
from studies.bodies import STEEL, graded

FRICTION, COURANT = 0.2, 0.9
"""Coefficient of friction, step over the critical one."""
SPEEDS = (0.2, 2.0, 20.0, 200.0)
"""Speeds of the upper body (m/s)."""
WAY = 1e-6
"""The gap is the way in so long a time (s)."""
MESHES, FINER = (0, 1), 3
"""Refinements of the runs and of the reference."""
SIZE = 16e-6
"""Size of the elements of the reference where the bodies touch (m). A coarser one does not resolve a slow contact: its error is too small."""


class Problem(Protocol):
    """A problem of a speed (m/s), a number of refinements and, if it is not 0, a size of the elements where the bodies touch (m)."""

    def __call__(self, speed: float, refinements: int, size: float = 0.0) -> pc.Problem: ...


def refined(mesh: pc.Mesh, refinements: int, size: float, places: Sequence[tuple[float, float]]) -> pc.Mesh:
    """Refine a mesh so often and, if the size is not 0, to elements of it (m) at some places."""
    mesh = mesh.refine(refinements)
    return graded(mesh, np.array(places), size) if size else mesh


def tilted(angle: float, width: float = 0.06) -> Problem:
    """Give a block of 40 × 25 mm, tilted (°), whose corner strikes a plate of this width (m) and 25 mm."""

    def problem(speed: float, refinements: int, size: float = 0.0) -> pc.Problem:
        block = refined(pc.Mesh.rectangle(0.04, 0.025, nx=7, ny=6), refinements, size, [(0.0, 0.0)])
        plate = refined(pc.Mesh.rectangle(width, 0.025, nx=round(width / 0.005), ny=6), refinements, size, [(0.0123, 0.025)])
        law = pc.Elastic(**ALUMINIUM, plane="stress")
        above = pc.Body(name="block", mesh=block, material=law, rotation=angle, origin=(0.0123, 0.025 + WAY * speed), velocity=(0.0, -speed))
        return _struck(above, pc.Body(name="plate", mesh=plate, material=law))

    return problem


def beside_end(angle: float) -> Problem:
    """Give a block of 40 × 25 mm, tilted (°), whose corner strikes 1.5 mm beside the end of a plate of 24 × 25 mm: 0.3 of its edge on the first mesh."""

    def problem(speed: float, refinements: int, size: float = 0.0) -> pc.Problem:
        block = refined(pc.Mesh.rectangle(0.04, 0.025, nx=8, ny=5), refinements, size, [(0.0, 0.0), (0.0015, 0.0)])
        plate = refined(pc.Mesh.rectangle(0.024, 0.025, nx=5, ny=5), refinements, size, [(0.0225, 0.025), (0.024, 0.025)])
        law = pc.Elastic(**ALUMINIUM, plane="stress")
        above = pc.Body(name="block", mesh=block, material=law, rotation=angle, origin=(0.0225, 0.025 + WAY * speed), velocity=(0.0, -speed))
        return _struck(above, pc.Body(name="plate", mesh=plate, material=law))

    return problem


def leaving(angle: float) -> Problem:
    """Give the block of `beside_end`, 1 mm beside the end, that goes down with 20 m/s and leaves the plate at this speed along it."""

    def problem(speed: float, refinements: int, size: float = 0.0) -> pc.Problem:
        block = refined(pc.Mesh.rectangle(0.04, 0.025, nx=8, ny=5), refinements, size, [(0.0, 0.0)])
        plate = refined(pc.Mesh.rectangle(0.024, 0.025, nx=5, ny=5), refinements, size, [(0.023, 0.025), (0.024, 0.025)])
        law = pc.Elastic(**ALUMINIUM, plane="stress")
        above = pc.Body(name="block", mesh=block, material=law, rotation=angle, origin=(0.023, 0.02502), velocity=(speed, -20.0))
        return _struck(above, pc.Body(name="plate", mesh=plate, material=law))

    return problem


def disc(speed: float, refinements: int, size: float = 0.0) -> pc.Problem:
    """Give a disc of steel, of 10 mm radius, that strikes a plate of 40 × 10 mm of aluminium."""
    mesh = refined(pc.Mesh.disc(0.01, rings=3), refinements, size, [(0.0, -0.01)])
    plate = refined(pc.Mesh.rectangle(0.04, 0.01, nx=12, ny=3), refinements, size, [(0.0207, 0.01)])
    above = pc.Body(name="disc", mesh=mesh, material=pc.Elastic(**STEEL, plane="stress"), origin=(0.0207, 0.02 + WAY * speed), velocity=(0.0, -speed))
    return _struck(above, pc.Body(name="plate", mesh=plate, material=pc.Elastic(**ALUMINIUM, plane="stress")))


def overlapping(overlap: float) -> Problem:
    """Give a block of 20 × 20 mm that strikes the end of a plate of 40 × 20 mm with so long a part (m) of its lower side."""

    def problem(speed: float, refinements: int, size: float = 0.0) -> pc.Problem:
        plate = refined(pc.Mesh.rectangle(0.04, 0.02, nx=8, ny=6), refinements, size, [(0.0, 0.02), (overlap, 0.02)])
        block = refined(pc.Mesh.rectangle(0.02, 0.02, nx=7, ny=6), refinements, size, [(0.02 - overlap, 0.0), (0.02, 0.0)])
        law = pc.Elastic(**ALUMINIUM, plane="stress")
        above = pc.Body(name="block", mesh=block, material=law, origin=(overlap - 0.02, 0.02 + WAY * speed), velocity=(0.0, -speed))
        return _struck(above, pc.Body(name="plate", mesh=plate, material=law))

    return problem


def _struck(above: pc.Body, plate: pc.Body) -> pc.Problem:
    return pc.Problem(bodies=[plate, above], contacts=[pc.Interface(bodies=(above.name, "plate"), friction=FRICTION)])


CASES: tuple[tuple[str, Problem, float], ...] = (
    *((f"block tilted by {angle:g}°", tilted(angle), 14e-6) for angle in (3.0, 10.0, 29.0)),
    ("block tilted by 10° that sticks out of a plate of 30 mm", tilted(10.0, width=0.03), 14e-6),
    *((f"block tilted by {angle:g}°, 1.5 mm beside the end of a plate", beside_end(angle), 14e-6) for angle in (3.0, 28.0)),
    ("disc", disc, 12e-6),
    *((f"block that overlaps a plate by {1e3 * overlap:g} mm", overlapping(overlap), 10e-6) for overlap in (0.0003, 0.001, 0.003)),
)
"""Names, problems, and ends of the runs (s)."""


def indices(problem: Callable[[int], pc.Problem], fine: pc.Problem, end: float) -> list[float]:
    """Give the effectivity indices of sup and mean on each mesh of a problem, by its refinements, against a fine one."""
    histories = [pc.simulate(problem(mesh), end=end, courant=COURANT) for mesh in MESHES]
    errors = pc.true_errors(histories, fine, end=end, courant=COURANT)
    found: list[float] = []
    for history, error in zip(histories, errors, strict=True):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", pc.SimulationWarning)
            estimate = pc.estimate(history, every=1)
        found += [estimate.sup / error.sup, estimate.mean / error.mean]
    return found


LEAVING: tuple[tuple[str, Problem, float], ...] = tuple((f"block tilted by {angle:g}°", leaving(angle), 2e-5) for angle in (10.0, 28.0, 45.0))
"""The same of corners that slide off the end, at `ALONG`."""
ALONG = (100.0, 200.0, 400.0)
"""Their speeds along the plate (m/s)."""


def _print(title: str, cases: tuple[tuple[str, Problem, float], ...], speeds: tuple[float, ...]) -> None:
    print(f"| {title} | {' | '.join(f'{speed:g} m/s' for speed in speeds)} |\n|{'---|' * (len(speeds) + 1)}")
    for name, problem, end in cases:
        found = [indices(partial(problem, speed), problem(speed, FINER, SIZE), end) for speed in speeds]
        print(f"| {name} | {' | '.join(f'{min(each):.2f} to {max(each):.2f}' for each in found)} |", flush=True)


def main() -> None:
    """Print both tables."""
    _print("the body above", CASES, SPEEDS)
    print()
    _print("the corner that slides off", LEAVING, ALONG)


if __name__ == "__main__":
    main()
