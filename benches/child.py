"""What the scripts beside it share: the probe in a process of its own, sizes of the block, and tables."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent / "peers"))

from percute_run import Percute, build

__all__ = ["CELLS", "Percute", "build", "table"]

CELLS = {640: (20, 16), 40960: (160, 128), 655360: (640, 512), 5000000: (2000, 1250)}
"""Cells along x and y by number of elements."""


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
