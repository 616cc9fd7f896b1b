"""Compare the sup and the mean of `every = "auto"` with those of all steps, on impacts of the evidence.

    python -m benches.sampling [--list] [--only TEXT ...] [--all] [--markdown]

The installed package percute is measured. Meshes of less than 2800 elements are left out: all steps are samples there, and both have the
same bits. A line for each run has the seconds of both estimates.
"""

from __future__ import annotations

import argparse
import time
import warnings
from collections.abc import Iterator
from dataclasses import replace
from typing import NamedTuple

import percute as pc
from studies import impacts, speeds
from studies.choices import RECONSTRUCTIONS

SPEEDS = (400.0, 4.0)
"""Speeds of corners and curves across the plane (m/s)."""
EACH = 4
"""Of their cases every fourth is run, unless all are asked for."""
LEAST = 2800
"""On smaller meshes all steps are samples."""
FINE = (6, 36e-6)
"""Mesh and end (s) of the runs with some 1000 steps."""
CORNERS = "corners, curves and inclined sides"


class Run(NamedTuple):
    """A case on a mesh, counted from 1."""

    group: str
    case: impacts.Case
    mesh: int
    reconstructions: tuple[str, ...]

    def __str__(self) -> str:
        """Its name, of which `--only` takes a part."""
        return f"{self.group}: {self.case.name}, {-self.case.velocity[1]:g} m/s, mesh {self.mesh}"


class Found(NamedTuple):
    """The results of a run with one reconstruction."""

    elements: int
    steps: int
    part: float
    """Of the steps, the part that is sampled."""
    sup: float
    mean: float
    """Differences, relative to those of all steps."""
    seconds: tuple[float, float]
    """With `auto`, and with all steps."""

    def __str__(self) -> str:
        """One line."""
        sampled = f"{self.elements} elements, {self.steps} steps, {self.part:.3f} of them"
        return f"{sampled}, sup {self.sup:+.2e}, mean {self.mean:+.2e}, {self.seconds[0]:.1f} s instead of {self.seconds[1]:.1f} s"


def runs(every: int) -> Iterator[Run]:
    """Give all runs; of the corners and curves one in so many."""
    for mesh in (4, 5):
        for case in impacts.cases():
            yield Run(case.kind, case, mesh, RECONSTRUCTIONS)
    mesh, end = FINE
    for tilt in (0.0, 3.0):
        case = replace(impacts.Case(end=end), tilt=tilt)
        yield Run(f"{case.kind}, 1000 steps", case, mesh, RECONSTRUCTIONS[:1])
    # The meshes of the evidence, through contact and release.
    for place, speed in speeds.GROWTH:
        yield Run(f"{CORNERS}, finest mesh", speeds.cases()[place].scaled(speed / speeds.FULL), speeds.MESHES + 1, RECONSTRUCTIONS[:1])
    for speed in SPEEDS:
        for case in speeds.cases()[::every]:
            yield Run(f"{CORNERS}, {speed:g} m/s", case.scaled(speed / speeds.FULL).at(end=60e-6), 5, RECONSTRUCTIONS[:1])


def chosen(arguments: argparse.Namespace) -> Iterator[tuple[Run, pc.Problem]]:
    """Give the runs that are asked for and whose meshes are not too small."""
    for run in runs(1 if arguments.all else EACH):
        if not arguments.only or any(text in str(run) for text in arguments.only):
            problem = run.case.problem(run.mesh - 1)
            if len(problem.mesh.cells) >= LEAST:
                yield run, problem


def compared(history: pc.History, reconstruction: str) -> Found:
    """Compare both samplings."""
    start = time.perf_counter()
    sparse = pc.estimate(history, reconstruction=reconstruction, every="auto")
    middle = time.perf_counter()
    dense = pc.estimate(history, reconstruction=reconstruction, every=1)
    seconds = (middle - start, time.perf_counter() - middle)
    part = len(set(history.time) & set(sparse.over_time.time)) / len(history)
    elements = len(history.problem.mesh.cells)
    return Found(elements, len(history) - 1, part, sparse.sup / dense.sup - 1, sparse.mean / dense.mean - 1, seconds)


def main() -> None:
    """Print one row for each group and reconstruction."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--list", action="store_true", help="print the names of the runs")
    parser.add_argument("--only", nargs="+", metavar="TEXT", help="runs whose name has one of these parts")
    parser.add_argument("--all", action="store_true", help="all corners and curves, not every fourth")
    parser.add_argument("--markdown", action="store_true", help="print a table for docs/speed.md and nothing else")
    arguments = parser.parse_args()
    warnings.simplefilter("ignore", pc.InputWarning)
    rows: dict[tuple[str, str], list[Found]] = {}
    for run, problem in chosen(arguments):
        if arguments.list:
            print(f"{run}, {len(problem.mesh.cells)} elements")
            continue
        try:
            history = pc.simulate(problem, **impacts.steps_past(run.case.end, run.case.ratio, problem))
        except pc.InputError:
            # The body starts too near to its plane.
            continue
        for name in run.reconstructions:
            found = compared(history, name)
            rows.setdefault((run.group, name), []).append(found)
            if not arguments.markdown:
                print(f"{run}, {name}: {found}", flush=True)
    if not arguments.list:
        show(rows)


def show(rows: dict[tuple[str, str], list[Found]]) -> None:
    """Print the table."""
    print("| cases | reconstruction | runs | elements | steps | of them sampled (%) | largest difference of sup (%) | of mean (%) |")
    print("|---|---|---|---|---|---|---|---|")
    for (group, name), found in rows.items():
        elements, steps, part, sup, mean, _ = zip(*found, strict=True)
        ranges = " | ".join(between([f"{x:.0f}" for x in sorted(values)]) for values in (elements, steps, [100 * x for x in part]))
        worst = [100 * max(map(abs, values)) for values in (sup, mean)]
        print(f"| {group} | `{name}` | {len(found)} | {ranges} | {worst[0]:.2f} | {worst[1]:.2f} |")


def between(texts: list[str]) -> str:
    """Give the first and the last, or one if they are the same."""
    return texts[0] if texts[0] == texts[-1] else f"{texts[0]}–{texts[-1]}"


if __name__ == "__main__":
    main()
