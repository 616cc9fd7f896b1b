"""The same block in other programs and in percute, interleaved: `python benches/peers/run.py`.

Makes an environment of its own in the target folder, builds percute's probe, checks that all programs compute the same, and prints
nanoseconds per element and step, with ratios to percute in the same round. docs/speed.md describes it.
"""

from __future__ import annotations

import argparse
import importlib.util
import json
import os
import subprocess
import sys
import venv
from collections.abc import Callable
from pathlib import Path
from statistics import median

HERE = Path(__file__).resolve().parent
CELLS = {640: (20, 16), 40960: (160, 128), 655360: (640, 512)}
LENGTHS = {640: (5, 45), 40960: (10, 110), 655360: (4, 24)}
"""Steps of the two runs whose difference counts. In all of them the block is in contact."""
REPEATS = {640: 50, 40960: 2, 655360: 1}
ESTIMATED = (32, 96)
"""The same of runs with an estimate."""
LARGEST_BATCH = 40960
"""The batched operators take 5 kB for each element, and their fields 10 kB."""
TOLERANCE = 1e-10
"""Of displacements and of the parts of η, relative to the largest. Rounding of sums in another order reaches 1e-12 in a
hundred steps; a node that touches one step earlier or later changes them by more than 1e-6."""
THREADS = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")

Measure = Callable[[], float]
"""Nanoseconds per element and step."""


def environment() -> None:
    """Go on in an environment that has the other programs, with one thread for each."""
    os.environ.update(dict.fromkeys(THREADS, "1"))
    if all(importlib.util.find_spec(name) for name in ("numba", "scipy", "akantu")):
        return
    folder = Path(os.environ.get("CARGO_TARGET_DIR", HERE.parents[1] / "target")) / "peers"
    python = folder / "bin" / "python"
    if Path(sys.executable) == python:
        sys.exit(f"{folder} lacks programs of requirements.txt; remove it and try again")
    if not python.exists():
        venv.create(folder, with_pip=True)
        subprocess.run([python, "-m", "pip", "install", "--quiet", "-r", HERE / "requirements.txt"], check=True)
    os.execv(python, [python, __file__, *sys.argv[1:]])


def arguments() -> argparse.Namespace:
    """Read the command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument(
        "--sizes", type=int, nargs="+", choices=CELLS, default=list(CELLS), metavar="N", help="elements"
    )
    parser.add_argument("--rounds", type=int, default=7)
    parser.add_argument("--order", nargs="*", choices=("shuffled", "delaunay"), default=["shuffled", "delaunay"])
    parser.add_argument("--estimate", nargs="*", choices=("consistent", "corrected"), default=["consistent"])
    parser.add_argument("--json", type=Path, metavar="FILE", help="all rounds")
    parser.add_argument("--markdown", action="store_true", help="print tables of docs/speed.md")
    return parser.parse_args()


def difference(
    run: Callable[[int], tuple[float, object]], elements: int, lengths: tuple[int, int], repeats: int
) -> Measure:
    """Time per element and step from runs of two lengths: setup does not count."""
    short, long = lengths

    def measure() -> float:
        seconds = sum(run(long)[0] - run(short)[0] for _ in range(repeats))
        return seconds * 1e9 / (repeats * (long - short) * elements)

    return measure


def agree(name: str, found: object, expected: object) -> None:
    """Refuse a program that computes something else."""
    import numpy as np

    error = float(np.abs(np.asarray(found) - expected).max() / np.abs(expected).max())
    print(f"  {name}: differs by {error:.1e}", file=sys.stderr)
    if not error <= TOLERANCE:
        sys.exit(f"{name} differs by {error:.1e}, more than {TOLERANCE:g}")


def programs(probe: Path, size: int) -> dict[str, Measure]:
    """The integrators, checked against each other."""
    from akantu_run import Akantu
    from numba_loop import Numba
    from percute_run import Percute
    from scipy_product import Scipy

    percute, free = Percute(probe, CELLS[size]), Percute(probe, CELLS[size], "--free")
    block, free_block = percute.block(), free.block()
    scipy, numba, akantu = Scipy(block), Numba(block), Akantu(free_block)
    steps = LENGTHS[size][1]
    expected, expected_free = scipy.run(steps)[1], Scipy(free_block).run(steps)[1]
    agree("percute", percute.displacement(steps), expected)
    agree(numba.name, numba.run(steps)[1], expected)
    agree("percute, no plane", free.displacement(steps), expected_free)
    agree(akantu.name, akantu.run(steps)[1], expected_free)
    free.close()
    found = {peer.name: difference(peer.run, size, LENGTHS[size], REPEATS[size]) for peer in (percute, scipy, numba)}
    products = REPEATS[size] * 20
    found["product K·u in Rust"] = lambda: percute.product(products) * 1e9 / (products * size)
    found[akantu.name] = difference(akantu.run, size, LENGTHS[size], 1)
    return found


def orders(probe: Path, size: int, names: list[str]) -> dict[str, Measure]:
    """Other meshes, for percute alone."""
    from percute_run import Percute

    meshes = [Percute(probe, CELLS[size], "--order", name) for name in names]
    return {mesh.name: difference(mesh.run, mesh.elements, LENGTHS[size], REPEATS[size]) for mesh in meshes}


def estimates(probe: Path, size: int, names: list[str], integrator: Measure) -> dict[str, Measure]:
    """Estimates at every step less the integrator, and the batched one beside them."""
    from time import perf_counter

    from numpy_equilibration import LEVELS, Equilibration, steps_of
    from percute_run import Percute

    found: dict[str, Measure] = {}
    for name in names:
        run = Percute(probe, CELLS[size], "--estimate", name)
        both = difference(run.run, size, ESTIMATED, 1)
        found[f"{run.name}, less integrator"] = lambda both=both: both() - integrator()
    if "consistent" in names and size <= LARGEST_BATCH:
        free = Percute(probe, CELLS[size], "--free", "--estimate", "consistent")
        block = free.block()
        batch, steps = Equilibration(block), steps_of(block, LEVELS)
        # Half a step before the first level there is nothing.
        parts = batch.parts(steps).reshape(2, -1)[:, 1:]
        for name, found_part, expected in zip(("kinetic", "elastic"), parts, free.parts(LEVELS - 1), strict=True):
            agree(f"{batch.name}, {name} part", found_part, expected)
        free.close()

        def measure() -> float:
            start = perf_counter()
            batch.parts(steps)
            return (perf_counter() - start) * 1e9 / (LEVELS * size)

        found[batch.name] = measure
    return found


def row(name: str, times: list[float], reference: list[float], markdown: bool) -> str:
    """One line: time, its range, ratio to the reference in the same rounds, its range."""
    ratios = [time / other for time, other in zip(times, reference, strict=True)]
    numbers = [
        f"{median(times):.1f}", f"{min(times):.1f}–{max(times):.1f}",
        f"{median(ratios):.2f}", f"{min(ratios):.2f}–{max(ratios):.2f}",
    ]  # fmt: skip
    if markdown:
        return f"| {name} | {' | '.join(numbers)} |"
    return f"{name:<46}{numbers[0]:>9}{numbers[1]:>16}{numbers[2]:>9}{numbers[3]:>16}"


def table(title: str, times: dict[str, list[float]], reference: str, markdown: bool) -> None:
    """Print the rows of one comparison."""
    head = ["ns", "range", f"ratio to {reference}", "range"]
    if markdown:
        print(f"\n| {title} | {' | '.join(head)} |\n|---|---|---|---|---|")
    else:
        print(f"\n{title:<46}{head[0]:>9}{head[1]:>16}    {head[2]}")
    for name, values in times.items():
        print(row(name, values, times[reference], markdown))


def main() -> None:
    """Measure all sizes."""
    wanted = arguments()
    environment()
    sys.path.insert(0, str(HERE))
    from percute_run import build

    probe, results = build(), {}
    for size in wanted.sizes:
        print(f"{size} elements", file=sys.stderr)
        integrators = programs(probe, size)
        integrator = integrators["percute"]
        groups = {
            "integrator": integrators,
            "mesh": {"percute": integrator, **orders(probe, size, wanted.order)},
            "estimate": estimates(probe, size, wanted.estimate, integrator),
        }
        times = {group: {name: [] for name in measures} for group, measures in groups.items()}
        for _ in range(wanted.rounds):
            for group, measures in groups.items():
                for name, measure in measures.items():
                    times[group][name].append(measure())
        results[size] = times
        for group, values in times.items():
            if values:
                table(f"{group}, {size} elements", values, next(iter(values)), wanted.markdown)
        sys.stdout.flush()
    if wanted.json:
        wanted.json.write_text(json.dumps(results, indent=1, ensure_ascii=False))


if __name__ == "__main__":
    main()
