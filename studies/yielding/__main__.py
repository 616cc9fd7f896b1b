"""The command: prints the effectivity indices of bars against the exact solution, and of plane bodies against finer meshes."""

from __future__ import annotations

import argparse
import itertools
import math
import multiprocessing
import warnings
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor

import numpy as np

import percute as pc
from studies.yielding import plane
from studies.yielding.bar import Bar
from studies.yielding.distance import BarHistory, distance
from studies.yielding.front_tracking import strike

SPEEDS, TANGENTS, COURANTS = (1.2, 2.0, 5.0, 15.0), (0.02, 0.1, 0.3), (0.1, 0.3, 0.9)
"""Speeds over the yield speed, E_t/E, and steps over the critical one: with two meshes the 72 bars of the table."""
YOUNG, DENSITY, YIELD_STRESS = 70e9, 2700.0, 300e6


def bar_index(over: float, tangent: float, elements: int, courant: float, kinematic: float = 0.0) -> tuple[float, float]:
    """Give the indices, sup and mean, of a bar that strikes at a speed over its yield speed, against the exact solution."""
    bar = Bar(length=1.0, young=YOUNG, density=DENSITY, yield_stress=YIELD_STRESS, tangent=tangent * YOUNG, kinematic=kinematic)
    speed = over * bar.yield_velocity
    step = courant * bar.length / elements / bar.wave_speed
    gap, end = 1.3 * speed * step, 2.2 * bar.length / bar.wave_speed
    law = pc.Elastic(young=YOUNG, density=DENSITY, section=1.0, yield_stress=YIELD_STRESS, tangent=bar.tangent, kinematic=kinematic)
    wall = pc.Plane(point=-gap, normal=1.0)
    problem = pc.Problem(pc.Mesh.bar(bar.length, elements=elements), material=law, initial_velocity=-speed, obstacles=[wall])
    history = pc.simulate(problem, end=end, step=step)
    estimate = pc.estimate(history, every=1, threads=1)
    computed = BarHistory(
        history.time,
        problem.mesh.points[:, 0],
        history.displacement[:, :, 0],
        history.velocity[:, :, 0],
        history.plastic_strain(slice(None))[:, :, 0, 0],
        history.equivalent_plastic_strain(slice(None)),
    )
    true = distance(strike(bar, speed, gap, history.time[-1]), computed)
    return estimate.sup / true.sup, estimate.mean / true.mean


def bars() -> Iterator[tuple[float, float, float, int, tuple[float, float]]]:
    """Give α, E_t/E, speed over yield speed and number of elements of each bar, with its indices."""
    for courant, tangent, over, elements in itertools.product(COURANTS, TANGENTS, SPEEDS, (20, 80)):
        yield courant, tangent, over, elements, bar_index(over, tangent, elements, courant)


def main() -> None:
    """Print a line for each bar, and the ranges."""
    parser = argparse.ArgumentParser("python -m studies.yielding", description=main.__doc__, allow_abbrev=False)
    parser.add_argument("--plane", action="store_true", help="plane bodies instead of bars")
    parser.add_argument("--jobs", type=int, default=1, metavar="J", help="processes side by side, of plane bodies [default: %(default)s]")
    arguments = parser.parse_args()
    warnings.simplefilter("ignore", pc.SimulationWarning)
    if arguments.plane:
        print("body     plane   v/v_y E_t/E  coarse     fine       coarse, finer reference   (sup and mean; ! outside the verdict)")
        with ProcessPoolExecutor(arguments.jobs, multiprocessing.get_context("spawn")) as pool:
            for row in pool.map(plane.line, plane.cases()):
                print(row, flush=True)
        return
    found = []
    print("Δt/Δt_c  E_t/E  v/v_y  elements    sup   mean")
    for courant, tangent, over, elements, index in bars():
        found.append(index)
        print(f"{courant:7g} {tangent:6g} {over:6g} {elements:9d} {index[0]:6.2f} {index[1]:6.2f}", flush=True)
    low, high = np.min(found, axis=0), np.max(found, axis=0)
    print(f"{len(found)} bars: sup {low[0]:.2f} to {high[0]:.2f}, mean {low[1]:.2f} to {high[1]:.2f}")
    assert math.isfinite(high.max())


if __name__ == "__main__":
    main()
