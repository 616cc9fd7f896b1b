"""Time to a true error: meshes of `percute.adapt`, all runs counted, beside uniform refinement.

``python -m studies.adapt_times`` prints it. ``--cases`` chooses rows. Times are processor times on one thread.
"""

from __future__ import annotations

import argparse
import math
import time
import warnings
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import percute as pc
from numpy.typing import NDArray
from studies.block import ALUMINIUM
from studies.bodies import BODIES, HOLE, graded

COURANT, FRICTION = 0.9, 0.2
"""Step over the critical one, coefficient of friction."""
LARGEST = 0.49
"""The largest target."""
MOST_RUNS = 8
FINER = 2
"""Refinements from the best mesh to its reference, before that is refined where errors are large."""


@dataclass(frozen=True)
class Case:
    """A body of aluminium that strikes a tilted plane."""

    name: str
    body: str
    speed: float
    """Speed across the plane (m/s)."""
    tilt: float
    """Angle of the plane (°)."""
    end: float
    """End of the run (s)."""
    levels: int
    """Refinements to the finest uniform mesh."""
    size: float
    """Size of the elements of its reference where errors are large (m)."""
    places: tuple[tuple[float, float], ...]
    """Where that is."""

    def problem(self, mesh: pc.Mesh) -> pc.Problem:
        """Give the problem on a mesh."""
        angle = math.radians(self.tilt)
        normal = np.array([math.sin(angle), math.cos(angle)])
        plane = pc.Plane(point=(float((mesh.points @ normal).min()) - 4e-7 * self.speed) * normal, normal=normal, friction=FRICTION)
        return pc.Problem(mesh, material=pc.Elastic(**ALUMINIUM, plane="stress"), obstacles=[plane], initial_velocity=-self.speed * normal)


_BOTTOM = ((0.0, 0.0), (0.05, 0.0))
_HOLE = tuple((x, y) for x in HOLE[0] for y in HOLE[1])
_VERTICES = tuple((0.025 * math.sin(a), -0.025 * math.cos(a)) for a in np.radians([-15.0, 0.0, 15.0]))
CASES = (
    Case("corner of a block, 0.4 m/s", "block", 0.4, 10.0, 40e-6, 4, 16e-6, _BOTTOM),
    Case("corner of a block, 4 m/s", "block", 4.0, 10.0, 40e-6, 4, 31e-6, _BOTTOM),
    Case("disc, 4 m/s", "disc", 4.0, 0.0, 60e-6, 3, 62e-6, _VERTICES),
    Case("frame on its corner, 10 m/s", "frame", 10.0, 10.0, 60e-6, 3, 62e-6, ((0.0, 0.0), (0.06, 0.0), *_HOLE)),
    Case("L on its side, 20 m/s", "L", 20.0, 0.0, 30e-6, 3, 0.1e-3, ((0.02, 0.02), (0.0, 0.0), (0.05, 0.0))),
)


@dataclass(frozen=True)
class Uniform:
    """Runs on uniform meshes: arrays over the refinements."""

    estimate: NDArray[np.float64]
    """Estimated relative mean error."""
    true: NDArray[np.float64]
    """True mean error (J^½)."""
    work: NDArray[np.float64]
    """Elements times steps."""
    seconds: NDArray[np.float64]
    """Time of simulation and estimate (s)."""

    def until(self, true: float, values: NDArray[np.float64]) -> float:
        """Give the work or time at which a true error is reached: by a power law between two meshes, or beyond the last two."""
        k = int(np.clip(np.searchsorted(-self.true, -true), 1, len(values) - 1))
        part = math.log(true / self.true[k - 1]) / math.log(self.true[k] / self.true[k - 1])
        return float(values[k - 1] * (values[k] / values[k - 1]) ** part)

    def so_far(self, values: NDArray[np.float64], last: float) -> float:
        """Give the sum over coarser meshes and the last one."""
        return last + float(values[values < last].sum())


def uniform_runs(case: Case) -> Uniform:
    """Run a case on uniform meshes."""
    mesh, histories, rows = BODIES[case.body](), [], []
    for level in range(case.levels + 1):
        started = time.process_time()
        history = pc.simulate(case.problem(mesh.refine(level)), end=case.end, courant=COURANT)
        estimate = pc.estimate(history, threads=1)
        elements = len(history.problem.mesh.cells)
        rows.append((estimate.relative_mean, elements * (len(history.time) - 1.0), time.process_time() - started))
        histories.append(history)
    fine = case.problem(graded(mesh.refine(case.levels + 1), np.array(case.places), case.size))
    errors = pc.true_errors(histories, fine, end=case.end, courant=COURANT)
    estimates, work, seconds = np.array(rows).T
    return Uniform(estimates, np.array([error.mean for error in errors]), work, seconds)


@dataclass(frozen=True)
class Adapted:
    """The runs of an adaptation."""

    runs: int
    elements: int
    """Of the best mesh."""
    true: float
    """True mean error on it (J^½)."""
    relative: float
    """The same, relative as the estimate."""
    work: float
    """Elements times steps of all runs."""
    seconds: float
    """Time of all runs (s)."""


def adapted(case: Case, target: float, most: int) -> Adapted:
    """Adapt the mesh of a case in so many runs at most."""
    first = case.problem(BODIES[case.body]())
    started = time.process_time()
    found = pc.adapt(first, target=target, end=case.end, courant=COURANT, runs=most, threads=1)
    seconds = time.process_time() - started
    best, history, estimate = found.problem, found.history, found.estimate
    assert best is not None and history is not None and estimate is not None
    fine = best.on(graded(best.mesh.refine(FINER), np.array(case.places), case.size))
    (error,) = pc.true_errors([history], fine, end=case.end, courant=COURANT)
    relative = estimate.relative_mean * error.mean / estimate.mean
    work = float(found.iterations.element_steps.sum())
    return Adapted(len(found.iterations), len(best.mesh.cells), error.mean, relative, work, seconds)


def row(case: Case) -> list[str]:
    """Adapt the mesh of a case to the true error of the finest uniform mesh, and compare."""
    uniform = uniform_runs(case)
    target = min(0.9 * float(uniform.estimate[-1]), LARGEST)
    # Targets are about estimates: the runs end with the first one whose true error is not above that of the finest uniform mesh.
    for most in range(1, MOST_RUNS + 1):
        found = adapted(case, target, most)
        if found.true <= uniform.true[-1] or found.runs < most:
            break
    work, seconds = uniform.until(found.true, uniform.work), uniform.until(found.true, uniform.seconds)
    return [
        case.name,
        f"{100.0 * found.relative:.3g} %, {found.true / uniform.true[-1]:.2f}",
        f"{found.runs}, {found.elements}",
        f"{found.work:.1e}, {found.seconds:.2f} s",
        f"{uniform.work[-1]:.1e}, {uniform.seconds[-1]:.2f} s",
        f"{uniform.work[-1] / found.work:.3g}, {uniform.seconds[-1] / found.seconds:.3g}",
        f"{work / found.work:.3g}, {seconds / found.seconds:.3g}",
        f"{uniform.so_far(uniform.work, work) / found.work:.3g}, {uniform.so_far(uniform.seconds, seconds) / found.seconds:.3g}",
    ]


def main(arguments: Sequence[str] | None = None) -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=main.__doc__)
    parser.add_argument("--cases", type=int, nargs="+", default=range(len(CASES)), help="numbers of the rows, from 0")
    chosen = parser.parse_args(arguments).cases
    warnings.simplefilter("ignore")
    heads = ["case", "true error, over that of the finest uniform mesh", "runs, elements of the last", "element-steps, time of all runs"]
    heads += ["of the finest uniform mesh", "over those of all runs", "at the same true error", "with all coarser uniform meshes"]
    print(f"| {' | '.join(heads)} |\n|{'---|' * len(heads)}")
    for k in chosen:
        print(f"| {' | '.join(row(CASES[k]))} |", flush=True)


if __name__ == "__main__":
    main()
