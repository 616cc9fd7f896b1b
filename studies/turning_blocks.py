"""Effectivity indices of blocks, discs and angles of finite kinematics that strike a plane: the table of docs/finite.md.

Run as ``python -m studies.turning_blocks [--jobs J]``. Each mesh has a reference with four times as many edges along a side, and the
coarsest one a second reference, with eight times as many, which tells how far the first one is from the exact solution.
"""

from __future__ import annotations

import argparse
import multiprocessing
import warnings
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass

import numpy as np
import percute as pc
from studies.impacts import holds

ALUMINIUM = {"young": 70e9, "poisson": 0.3, "density": 2700.0}
RUBBER = {"young": 10e6, "poisson": 0.4, "density": 1100.0}
SIDE = 0.04
"""The height of the block (m)."""
PASSAGES = {"flat": 2.0, "oblique": 2.0, "corner": 4.0, "disc": 4.0, "angle": 4.0}
"""Wave passages over the height until the end, by situation."""
MESHES = 3


@dataclass(frozen=True)
class Case:
    """A body that strikes a plane."""

    name: str
    law: str
    situation: str
    speed: float
    """Towards the plane (m/s)."""

    def problem(self, mesh: int, refinements: int) -> tuple[pc.Problem, float]:
        """Give the problem on a mesh, and its end (s)."""
        material = pc.Elastic(**(RUBBER if self.name == "rubber" else ALUMINIUM), plane="strain", kinematics="finite", law=self.law)  # type: ignore[arg-type]
        body = shape(self.situation, 1 << mesh)
        for _ in range(refinements):
            body = body.refine()
        height = body.points[:, 1].min()
        wave = float(pc.Problem(body, material=material).wave_speed)
        gap = 0.18 * SIDE * self.speed / wave
        away = body.points - body.points.mean(axis=0)
        spin = 0.3 * self.speed / SIDE if self.situation == "corner" else 0.0
        along = self.speed if self.situation == "oblique" else 0.0
        velocity = np.column_stack([along - spin * away[:, 1], -self.speed + spin * away[:, 0]])
        plane = pc.Plane(point=(0.0, height - gap), normal=(0, 1), friction=0.2)
        return pc.Problem(body, material=material, obstacles=[plane], initial_velocity=velocity), gap / self.speed + PASSAGES[self.situation] * SIDE / wave

    def index(self, mesh: int, refinements: int) -> tuple[float, float, bool]:
        """Give the indices of the largest error and of the mean against a reference, and whether the verdict holds."""
        problem, end = self.problem(mesh, 0)
        history = pc.simulate(problem, end=end, courant=0.9, progress=None)
        reference, _ = self.problem(mesh, refinements)
        (error,) = pc.true_errors([history], reference, end=end, courant=0.9, progress=None)
        estimate = pc.estimate(history, every=1, threads=1, progress=None)
        found = estimate.effectivity(error)
        return found.sup, found.mean, holds(estimate, (found.sup, found.mean))


def shape(situation: str, n: int) -> pc.Mesh:
    """Make a body of one of the meshes, 4 n cells over its height."""
    if situation == "disc":
        return pc.Mesh.disc(0.5 * SIDE, rings=2 * n)
    if situation == "angle":
        mesh = pc.Mesh.rectangle(SIDE, SIDE, nx=4 * n, ny=4 * n)
        centres = mesh.points[mesh.cells].mean(axis=1)
        cells = mesh.cells[(centres.max(axis=1) < 0.5 * SIDE) | (centres.min(axis=1) < 0.5 * SIDE)]
        used = np.unique(cells)
        return pc.Mesh(mesh.points[used], np.searchsorted(used, cells)).rotated(30)
    mesh = pc.Mesh.rectangle(1.25 * SIDE, SIDE, nx=5 * n, ny=4 * n)
    return mesh.rotated(20) if situation == "corner" else mesh


def cases() -> list[Case]:
    """Give the rows of the table."""
    speeds = {"aluminium": (1.0, 20.0, 200.0, 400.0), "rubber": (1.0, 10.0, 20.0)}
    made = [Case(name, "neo_hookean", "flat", speed) for name, all_speeds in speeds.items() for speed in all_speeds]
    made += [Case("aluminium", law, "flat", 200.0) for law in ("svk", "hencky")]
    made += [Case(name, "neo_hookean", "oblique", speed) for name, speed in (("aluminium", 20.0), ("rubber", 10.0))]
    others = [(name, speed) for name, all_speeds in (("aluminium", (2.0, 20.0, 200.0)), ("rubber", (2.0, 8.0))) for speed in all_speeds]
    made += [Case(name, "neo_hookean", situation, speed) for situation in ("corner", "disc", "angle") for name, speed in others]
    return made


def _row(case: Case) -> str:
    wave = float(case.problem(0, 0)[0].wave_speed)
    cells = [_cell(case, mesh, 2) for mesh in range(MESHES)] + [_cell(case, 0, 3)]
    return f"| {case.situation} | {case.name}, `{case.law}` | {case.speed:g} | {case.speed / wave:.2g} | " + " | ".join(cells) + " |"


def _cell(case: Case, mesh: int, refinements: int) -> str:
    """Give the indices of a run, with a star if the verdict does not hold."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            sup, mean, held = case.index(mesh, refinements)
        except pc.PercuteError:
            return "refused"
    return f"{sup:.2f}, {mean:.2f}" + "*" * (not held)


def main() -> None:
    """Print the table, row by row."""
    parser = argparse.ArgumentParser("python -m studies.turning_blocks", description=__doc__, allow_abbrev=False)
    parser.add_argument("--jobs", type=int, default=1, metavar="J", help="processes side by side [default: 1]; no number depends on it")
    jobs = max(parser.parse_args().jobs, 1)
    print("| | material, law | m/s | over waves | " + " | ".join(f"mesh {k + 1}" for k in range(MESHES)) + " | mesh 1, finer reference |")
    with ProcessPoolExecutor(jobs, mp_context=multiprocessing.get_context("spawn")) as pool:
        for row in pool.map(_row, cases()):
            print(row, flush=True)


if __name__ == "__main__":
    main()
