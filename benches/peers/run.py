"""The same block in other programs and in percute, interleaved: `python benches/peers/run.py`.

Makes an environment of its own in the target folder, builds percute's probe, checks that all programs compute the same, and prints
nanoseconds per element and step, with ratios to a product K·u and to percute in the same round. docs/speed.md describes it.
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
KEPT = {"MALLOC_MMAP_MAX_": "0", "MALLOC_TRIM_THRESHOLD_": str(10**12)}
"""The allocator keeps freed memory: arrays of each batch would otherwise cost page faults, as buffers that are reused do not."""
THREADS = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")

PRODUCT = "product K·u in Rust, sparse rows"
"""The measure of all ratios."""

Measure = Callable[[], float]
"""Nanoseconds per element and step."""


def environment() -> None:
    """Go on in an environment that has the other programs, with one thread for each."""
    complete = all(importlib.util.find_spec(name) for name in ("numba", "scipy", "akantu"))
    if complete and os.environ.items() >= KEPT.items():
        return
    os.environ.update(dict.fromkeys(THREADS, "1") | KEPT)
    if complete:
        os.execv(sys.executable, [sys.executable, __file__, *sys.argv[1:]])
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
    parser.add_argument("--wall", action="store_true", help="times on the wall, not processor times")
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
    found[PRODUCT] = lambda: percute.product(products) * 1e9 / (products * size)
    found[akantu.name] = difference(akantu.run, size, LENGTHS[size], max(1, REPEATS[size] // 10))
    return found


def orders(probe: Path, size: int, names: list[str]) -> dict[str, Measure]:
    """Other meshes, for percute alone."""
    from percute_run import Percute

    meshes = [Percute(probe, CELLS[size], "--order", name) for name in names]
    return {mesh.name: difference(mesh.run, mesh.elements, LENGTHS[size], REPEATS[size]) for mesh in meshes}


def estimates(probe: Path, size: int, names: list[str], integrator: Measure) -> dict[str, Measure]:
    """Estimates at every step less the integrator, and the batched one beside them."""
    from block import clock
    from numpy_equilibration import LEVELS, Equilibration, steps_of
    from percute_run import Percute

    found: dict[str, Measure] = {}
    # Of a thousand steps only the first and the last are sampled, in both lengths of run.
    for name, every in [(name, every) for every in ((), ("--every", "1000")) for name in names]:
        run = Percute(probe, CELLS[size], "--estimate", name, *every)
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
            start = clock()
            batch.parts(steps)
            return (clock() - start) * 1e9 / (LEVELS * size)

        found[batch.name] = measure
    return found


def ratios(times: list[float], reference: list[float]) -> list[float]:
    """Ratios of times to those of another program in the same rounds."""
    return [time / other for time, other in zip(times, reference, strict=True)]


def table(size: int, times: dict[str, list[float]], markdown: bool) -> None:
    """Print all programs at one size: times, and ratios to the product K·u and to percute's integrator."""
    head = [f"{size} elements", "ns", "range", "over K·u", "range", "over percute"]
    rows = []
    for name, values in times.items():
        to_product, to_percute = ratios(values, times[PRODUCT]), ratios(values, times["percute"])
        rows.append(
            [
                name,
                f"{median(values):.1f}",
                f"{min(values):.1f}–{max(values):.1f}",
                f"{median(to_product):.2f}",
                f"{min(to_product):.2f}–{max(to_product):.2f}",
                f"{median(to_percute):.2f}",
            ]
        )
    if markdown:
        rows = [head, ["---"] * len(head), *rows]
        print("\n" + "\n".join(f"| {' | '.join(cells)} |" for cells in rows))
        return
    print()
    for name, *cells in [head, *rows]:
        print(f"{name:<48}" + "".join(f"{cell:>15}" for cell in cells))


def main() -> None:
    """Measure all sizes."""
    wanted = arguments()
    environment()
    sys.path.insert(0, str(HERE))
    import block
    from percute_run import build

    block.WALL = wanted.wall
    probe, results = build(), {}
    for size in wanted.sizes:
        print(f"{size} elements", file=sys.stderr)
        integrators = programs(probe, size)
        measures = integrators | orders(probe, size, wanted.order)
        measures |= estimates(probe, size, wanted.estimate, integrators["percute"])
        times: dict[str, list[float]] = {name: [] for name in measures}
        for _ in range(wanted.rounds):
            for name, measure in measures.items():
                times[name].append(measure())
        results[size] = times
        table(size, times, wanted.markdown)
        sys.stdout.flush()
    if wanted.json:
        wanted.json.write_text(json.dumps(results, indent=1, ensure_ascii=False))


if __name__ == "__main__":
    main()
