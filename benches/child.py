"""What the scripts beside it share: the probe in a process of its own, sizes of the block, and tables."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent / "peers"))

from percute_run import Percute, build, program

__all__ = ["CELLS", "ESTIMATED", "LENGTHS", "Percute", "build", "program", "step", "table"]

CELLS = {640: (20, 16), 40960: (160, 128), 655360: (640, 512), 5000000: (2000, 1250)}
"""Cells along x and y by number of elements."""
LENGTHS = {640: (400, 4400), 40960: (50, 550), 655360: (8, 40), 5000000: (4, 12)}
"""Steps of the two runs of the integrator whose difference counts."""
ESTIMATED = {640: (32, 288), 40960: (16, 48), 655360: (8, 24), 5000000: (8, 16)}
"""The same of runs with an estimate: full windows of eight levels."""


def step(run: Percute, lengths: tuple[int, int]) -> float:
    """Nanoseconds per element and step."""
    short, long = lengths
    return (run.run(long)[0] - run.run(short)[0]) * 1e9 / ((long - short) * run.elements)


def table(head: Sequence[str], rows: Sequence[Sequence[str]], markdown: bool) -> None:
    """Print rows, for docs/speed.md or in columns."""
    if markdown:
        rows = [head, ["---"] * len(head), *rows]
        print("\n" + "\n".join(f"| {' | '.join(cells)} |" for cells in rows), flush=True)
        return
    widths = [max(map(len, column)) + 2 for column in zip(head, *rows, strict=True)]
    print()
    for first, *cells in [head, *rows]:
        print(f"{first:<{widths[0]}}" + "".join(f"{cell:>{width}}" for cell, width in zip(cells, widths[1:], strict=True)), flush=True)
