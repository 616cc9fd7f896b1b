"""Compare the sup and the mean of `every = "auto"` with those of all steps, on impacts of the evidence.

    python benches/sampling.py [--markdown]

The installed package percute is measured. Meshes of less than 2800 elements are left out: all steps are samples there, and both have the same bits.
"""

from __future__ import annotations

import argparse
import warnings
from collections.abc import Iterator
from dataclasses import replace

import percute as pc
from percute.verification import impacts, speeds
from percute.verification.choices import RECONSTRUCTIONS

SPEEDS = (400.0, 4.0)
"""Speeds of corners and curves across the plane (m/s)."""
EACH = 4
"""Of their cases every fourth is run."""
LEAST = 2800
"""On smaller meshes all steps are samples."""
FINE = (6, 36e-6)
"""Mesh and end (s) of the runs with some 1000 steps."""

Run = tuple[str, impacts.Case, int, tuple[str, ...]]


def runs() -> Iterator[Run]:
    """Give the cases by groups, each with a mesh, counted from 1, and the reconstructions."""
    for mesh in (4, 5):
        for case in impacts.cases():
            yield case.kind, case, mesh, RECONSTRUCTIONS
    for speed in SPEEDS:
        for case in speeds.cases()[::EACH]:
            yield f"corners, curves and inclined sides at {speed:g} m/s", case.scaled(speed / speeds.FULL).at(end=60e-6), 5, RECONSTRUCTIONS[:1]
    mesh, end = FINE
    block = impacts.Case(end=end)
    for name, case in (("flat", block), ("tilted by 3°", replace(block, tilt=3.0))):
        yield f"block, {name}", case, mesh, RECONSTRUCTIONS[:1]


def main() -> None:
    """Print one row for each group and reconstruction."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--markdown", action="store_true", help="print a table for docs/speed.md")
    arguments = parser.parse_args()
    warnings.simplefilter("ignore", pc.InputWarning)
    rows: dict[tuple[str, str], list[tuple[int, int, float, float, float]]] = {}
    for group, case, mesh, reconstructions in runs():
        problem = case.problem(mesh - 1)
        if len(problem.mesh.cells) < LEAST:
            continue
        try:
            history = pc.simulate(problem, **impacts.steps_past(case.end, case.ratio, problem))
        except pc.InputError:
            # The body starts too near to its plane.
            continue
        for name in reconstructions:
            sparse, dense = (pc.estimate(history, reconstruction=name, every=every) for every in ("auto", 1))
            levels = set(history.time) & set(sparse.over_time.time)
            found = (len(problem.mesh.cells), len(history) - 1, len(levels) / len(history), sparse.sup / dense.sup - 1, sparse.mean / dense.mean - 1)
            rows.setdefault((group, name), []).append(found)
            if not arguments.markdown:
                print(f"{group}, {case.name}, {name}:", "%d elements, %d steps, %.3f of them, sup %+.2e, mean %+.2e" % found, flush=True)
    print("| cases | reconstruction | runs | elements | steps | of them sampled (%) | largest difference of sup (%) | of mean (%) |")
    print("|---|---|---|---|---|---|---|---|")
    for (group, name), found in rows.items():
        elements, steps, part, sup, mean = zip(*found, strict=True)
        ranges = " | ".join(between([f"{x:.0f}" for x in sorted(values)]) for values in (elements, steps, [100 * x for x in part]))
        worst = [100 * max(map(abs, values)) for values in (sup, mean)]
        print(f"| {group} | `{name}` | {len(found)} | {ranges} | {worst[0]:.2f} | {worst[1]:.2f} |")


def between(texts: list[str]) -> str:
    """Give the first and the last, or one if they are the same."""
    return texts[0] if texts[0] == texts[-1] else f"{texts[0]}–{texts[-1]}"


if __name__ == "__main__":
    main()
