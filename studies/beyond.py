"""Effectivity indices of runs that the evidence does not have: the table of ``docs/verdict.md``.

``python -m studies.beyond`` prints it.
"""

from __future__ import annotations

import json
import warnings
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
import percute as pc
from numpy.typing import NDArray

Floats = NDArray[np.float64]
ALUMINIUM: dict[str, Any] = {"young": 70e9, "density": 2700.0}
LENGTH, ELEMENTS, STRESS = 0.1, 50, 1e8
"""Length of a bar (m), its elements, and the traction at its end (Pa)."""
WIDTH, HEIGHT = 0.05, 0.04
"""Sides of a block (m)."""
COURANT, SPEED, GAP = 0.9, 10.0, 1e-5
"""Step over the critical one; speed towards the plane (m/s) and distance from it (m)."""
REFINEMENTS = {1: 4, 2: 3}
"""From a mesh to its reference, by the dimension."""
CROSSING = LENGTH / ELEMENTS * (ALUMINIUM["density"] / ALUMINIUM["young"]) ** 0.5
"""The time in which a wave crosses an element of the bar (s)."""


@dataclass(frozen=True)
class Run:
    """One run."""

    group: str
    name: str
    mesh: pc.Mesh
    problem: Callable[[pc.Mesh], pc.Problem]
    """The problem on this mesh or on a refined one."""
    end: float
    """s"""

    def row(self) -> tuple[float, float, str]:
        """Give the indices of sup and mean, and what the verdict names as not tested."""
        times: dict[str, Any] = {"end": self.end, "courant": COURANT}
        history = pc.simulate(self.problem(self.mesh), **times)
        finer = self.problem(self.mesh.refine(REFINEMENTS[self.mesh.points.shape[1]]))
        (error,) = pc.true_errors([history], finer, **times)
        estimate = pc.estimate(history, every=1)
        named = json.loads(estimate.to_json())["verdict"]["outside_tested_range"]
        return estimate.sup / error.sup, estimate.mean / error.mean, ", ".join(named)


def _law(**changes: float) -> pc.Elastic:
    """Give aluminium for a block."""
    return pc.Elastic(**{**ALUMINIUM, "poisson": 0.3, **changes}, plane="stress")


def _bar(young: float = ALUMINIUM["young"]) -> pc.Elastic:
    return pc.Elastic(young=young, density=ALUMINIUM["density"], section=1e-4)


def _block(nx: int = 10, ny: int = 8, width: float = WIDTH, height: float = HEIGHT) -> pc.Mesh:
    return pc.Mesh.rectangle(width, height, nx=nx, ny=ny)


def _ramp(group: str, value: Any, rise: float) -> pc.Traction:
    """Give a traction that rises within a time (s); at once if it is 0."""
    zero = np.zeros_like(np.asarray(value, dtype=float)).tolist()
    return pc.Traction(group=group, value=[zero, value], time=(0.0, rise)) if rise else pc.Traction(group=group, value=value)


def _falls(mesh: pc.Mesh, **changes: Any) -> pc.Problem:
    """Give a body that falls flat."""
    plane = pc.Plane(point=(0.0, -GAP), normal=(0.0, 1.0), friction=0.2)
    return pc.Problem(mesh, **{"material": _law(), "obstacles": [plane], "initial_velocity": (0.0, -SPEED), **changes})


def loads() -> Iterator[Run]:
    """Give bodies at rest that are loaded, at once or little by little."""
    bar = pc.Mesh.bar(LENGTH, elements=ELEMENTS)
    for crossings in (0, 1, 4, 16, 24, 32):
        traction = _ramp("end", STRESS, crossings * CROSSING)
        within = f"within {crossings} crossings of an element" if crossings else "at once"
        yield Run("load", f"bar, {within}", bar, lambda mesh, t=traction: pc.Problem(mesh, material=_bar(), tractions=[t]), 50e-6)  # type: ignore[misc]
    for rise in (0.0, 2e-6, 5e-6, 10e-6):
        traction = _ramp("top", [0.0, STRESS], rise)
        within = f"within {1e6 * rise:g} µs" if rise else "at once"
        yield Run("load", f"block, {within}", _block(), lambda mesh, t=traction: pc.Problem(mesh, material=_law(), tractions=[t]), 20e-6)  # type: ignore[misc]
    for rise, end in ((0.0, 20e-6), (20e-6, 40e-6)):
        traction, plane = _ramp("top", [0.0, -STRESS], rise), pc.Plane(point=(0.0, 0.0), normal=(0.0, 1.0), friction=0.3)
        within = f"within {1e6 * rise:g} µs" if rise else "at once"

        def pressed(mesh: pc.Mesh, traction: pc.Traction = traction, plane: pc.Plane = plane) -> pc.Problem:
            return pc.Problem(mesh, material=_law(), obstacles=[plane], tractions=[traction])

        yield Run("load", f"block on its plane, {within}", _block(), pressed, end)


def starts() -> Iterator[Run]:
    """Give bodies that are released from a stress, and one half of which moves."""
    bar, block = pc.Mesh.bar(LENGTH, elements=ELEMENTS), _block()
    yield Run("start", "bar, stretched", bar, lambda mesh: pc.Problem(mesh, material=_bar(), initial_displacement=1e-3 * mesh.points), 50e-6)
    stretch = np.array([1e-3, 0.0])
    yield Run("start", "block, stretched", block, lambda mesh: pc.Problem(mesh, material=_law(), initial_displacement=mesh.points * stretch), 20e-6)

    def half(mesh: pc.Mesh) -> pc.Problem:
        x = bar.points[:, 0]
        velocity = np.interp(mesh.points[:, 0], x, np.where(x < 0.5 * LENGTH, SPEED, 0.0))
        return pc.Problem(mesh, material=_bar(), initial_velocity=velocity[:, None])

    yield Run("start", "bar, one half moves", bar, half, 50e-6)


def elements() -> Iterator[Run]:
    """Give blocks with long cells, and thin bodies."""
    for nx, ny in ((10, 16), (7, 16), (5, 16), (20, 4), (8, 32), (8, 64), (4, 40)):
        a, b = 1e3 * WIDTH / nx, 1e3 * HEIGHT / ny
        yield Run("elements", f"cells of {a:.3g} × {b:.3g} mm", _block(nx, ny), _falls, 14e-6)
    for name, mesh, end in (
        ("plate, 2 elements thick", _block(40, 2, 0.1, 0.005), 30e-6),
        ("plate, 4 elements thick", _block(80, 4, 0.1, 0.005), 30e-6),
        ("column, 4 elements thick", _block(4, 40, 0.01, 0.1), 50e-6),
    ):
        yield Run("thin", name, mesh, _falls, end)


def layers() -> Iterator[Run]:
    """Give blocks of two layers that differ much."""
    steel, aluminium = _law(young=210e9, density=7850.0), _law(thickness=0.01)
    mesh = _block()
    lower = mesh.points[mesh.cells].mean(axis=1)[:, 1] < 0.5 * HEIGHT
    halves = {"lower": np.flatnonzero(lower), "upper": np.flatnonzero(~lower)}
    mesh = pc.Mesh(mesh.points, mesh.cells, edge_groups=dict(mesh.edge_groups), element_groups=halves)
    rubber = {f"rubber of {1e-6 * young:g} MPa on steel": (steel, _law(young=young, density=1100.0, poisson=0.45)) for young in (1e9, 1e8, 5e6)}
    thicker = {f"{times:g} times as thick above": (aluminium, _law(thickness=0.01 * times)) for times in (10.0, 30.0, 100.0)}
    for name, (below, above) in (rubber | thicker).items():
        laws = {"lower": below, "upper": above}
        yield Run("layers", name, mesh, lambda mesh, laws=laws: _falls(mesh, material=laws), 14e-6)  # type: ignore[misc]


def bars() -> Iterator[Run]:
    """Give bars of two parts with different elements, and of elements that grow."""
    plane = pc.Plane(point=-1e-6, normal=1.0)

    def falls(mesh: pc.Mesh) -> pc.Problem:
        return pc.Problem(mesh, material=_bar(), obstacles=[plane], initial_velocity=-1.0)

    def made(x: Floats) -> pc.Mesh:
        return pc.Mesh(x, np.array(list(pairwise(range(len(x))))))

    for fine in (30, 45, 75, 100, 200):
        coarse = 10 if fine >= 100 else 15
        x = np.concatenate([np.linspace(0.0, 0.5, fine + 1), np.linspace(0.5, 1.0, coarse + 1)[1:]])
        yield Run("bar", f"{fine} elements before {coarse} long ones", made(LENGTH * x), falls, 50e-6)
    for count in (80, 100, 200):
        x = np.concatenate([[0.0], np.cumsum(1.02 ** np.arange(count))])
        yield Run("bar", f"{count} elements, each 2 % longer than the last", made(LENGTH * x / x[-1]), falls, 50e-6)


def runs() -> Iterator[Run]:
    """Give the rows of the table."""
    for group in (loads, starts, elements, layers, bars):
        yield from group()


def main() -> None:
    """Print the table."""
    print("| | run | index of sup | of mean | outside the tested range |\n|---|---|---|---|---|")
    for run in runs():
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            sup, mean, named = run.row()
        print(f"| {run.group} | {run.name} | {sup:.2f} | {mean:.2f} | {named or '–'} |", flush=True)


if __name__ == "__main__":
    main()
