"""Cost of the estimate with the default sampling, beside the run alone: `python benches/cost.py`.

A run of 1000 steps, in processor time on one thread, interleaved. Setup is all that precedes the first step: mesh, problem, critical step and
operators. The ratios are those of one round: run and estimate together over the run alone, without and with setup.
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from statistics import median
from typing import Any

from child import CELLS, Percute, build, table

STEPS = 1000
RECONSTRUCTIONS = ("corrected", "consistent", "published")


def arguments() -> argparse.Namespace:
    """Read the command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--sizes", type=int, nargs="+", choices=CELLS, default=[40960], metavar="N", help="elements")
    parser.add_argument("--every", default="auto", help="the sampling: auto or a number of steps")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--markdown", action="store_true", help="print a table of docs/speed.md")
    parser.add_argument("--json", type=Path, metavar="FILE", help="all rounds")
    return parser.parse_args()


def seconds(run: Percute) -> tuple[float, float]:
    """Processor time of the setup and of the steps."""
    return float(run.ask("setup")), run.run(STEPS)[0]


def measured(probe: Path, size: int, every: str, count: int) -> dict[str, dict[str, Any]]:
    """Times of all rounds, and the number of samples, of the run alone and of all reconstructions."""
    options = {name: ("--estimate", name, "--every", every) for name in RECONSTRUCTIONS}
    runs = {"alone": Percute(probe, CELLS[size])} | {name: Percute(probe, CELLS[size], *own) for name, own in options.items()}
    times: dict[str, list[tuple[float, float]]] = {name: [] for name in runs}
    for _ in range(count):
        for name, run in runs.items():
            times[name].append(seconds(run))
    samples = {name: int(runs[name].ask(f"samples {STEPS}")) for name in options}
    for run in runs.values():
        run.close()
    return {name: {"seconds": found, "samples": samples.get(name)} for name, found in times.items()}


def rows(size: int, found: dict[str, dict[str, Any]]) -> list[list[str]]:
    """Times and ratios of one size."""
    lines = []
    alone = found["alone"]["seconds"]
    for name, figures in found.items():
        own = figures["seconds"]
        setup, steps = (f"{median(values):.3f}" for values in zip(*own, strict=True))
        cells = [setup, steps]
        for part in (lambda time: time[1], sum):
            ratios = [part(time) / part(other) for time, other in zip(own, alone, strict=True)]
            cells += [f"{median(ratios):.2f}", f"{min(ratios):.2f}–{max(ratios):.2f}"]
        lines.append([f"{size} elements, {name}", "" if figures["samples"] is None else str(figures["samples"]), *cells])
    return lines


def main() -> None:
    """Measure all sizes."""
    wanted = arguments()
    probe = build()
    results = {size: measured(probe, size, wanted.every, wanted.rounds) for size in wanted.sizes}
    head = ["1000 steps", "sampled steps", "setup, s", "steps, s", "over alone", "range", "with setup", "range"]
    table(head, [row for size, found in results.items() for row in rows(size, found)], wanted.markdown)
    if wanted.json:
        wanted.json.write_text(json.dumps(results, indent=1))


if __name__ == "__main__":
    main()
