"""Two threads beside one, on a quiet machine and with a core taken by another process: `python benches/threads.py`.

Linux only, on two cores. A time is that on the wall for a step, the difference of two lengths of run, so that setup does not count.
With an estimate every step is sampled, and the integrator is part of the time. The busy process keeps to one of the two cores. Rounds
are interleaved; figures are medians, and ratios are those of one round.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from statistics import median

from child import CELLS, ESTIMATED, LENGTHS, Percute, build, step, table

STAGES: dict[str, tuple[str, ...]] = {
    "integrator": (),
    "consistent": ("--estimate", "consistent"),
    "published": ("--estimate", "published"),
    "corrected": ("--estimate", "corrected"),
}
SPIN = "print(flush=True)\nwhile True: pass"


def arguments() -> argparse.Namespace:
    """Read the command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--sizes", type=int, nargs="+", choices=CELLS, default=[40960, 655360], metavar="N", help="elements")
    parser.add_argument("--stages", nargs="+", choices=STAGES, default=list(STAGES))
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--markdown", action="store_true", help="print a table of docs/speed.md")
    parser.add_argument("--json", type=Path, metavar="FILE", help="all rounds")
    return parser.parse_args()


@contextmanager
def busy(core: int) -> Iterator[None]:
    """A process that takes a core, on which it stays."""
    process = subprocess.Popen([sys.executable, "-c", SPIN], stdout=subprocess.PIPE)
    try:
        os.sched_setaffinity(process.pid, {core})
        assert process.stdout
        process.stdout.readline()
        yield
    finally:
        process.kill()
        process.communicate()


def rounds(probe: Path, size: int, stage: str, count: int, core: int) -> list[tuple[float, float, float]]:
    """Times with one thread, with two, and with two beside a busy process, round by round."""
    lengths = LENGTHS[size] if stage == "integrator" else ESTIMATED[size]
    one, two = (Percute(probe, CELLS[size], "--wall", "--threads", threads, *STAGES[stage]) for threads in "12")
    found = []
    for _ in range(count):
        alone = step(one, lengths), step(two, lengths)
        with busy(core):
            found.append((*alone, step(two, lengths)))
    one.close()
    two.close()
    return found


def row(size: int, stage: str, found: list[tuple[float, float, float]]) -> list[str]:
    """A stage in figures."""
    faster = [one / two for one, two, _ in found]
    slower = [beside / one for one, _, beside in found]
    times = [f"{median(values):.1f}" for values in zip(*found, strict=True)]
    ratios = [cell for values in (faster, slower) for cell in (f"{median(values):.2f}", f"{min(values):.2f}–{max(values):.2f}")]
    return [f"{size} elements, {stage}", *times, *ratios]


def main() -> None:
    """Measure all stages at all sizes."""
    wanted = arguments()
    cores = sorted(os.sched_getaffinity(0))[:2]
    if len(cores) < 2:
        sys.exit("two cores are needed")
    # Children inherit them.
    probe = build()
    os.sched_setaffinity(0, set(cores))
    results = {}
    for size in wanted.sizes:
        for stage in wanted.stages:
            results[size, stage] = rounds(probe, size, stage, wanted.rounds, cores[-1])
            print(f"{size}, {stage}: measured", file=sys.stderr)
    head = ["ns per element and step", "one thread", "two", "two, a core busy", "one over two", "range", "two, a core busy, over one", "range"]
    table(head, [row(*key, found) for key, found in results.items()], wanted.markdown)
    if wanted.json:
        wanted.json.write_text(json.dumps([{"elements": size, "stage": stage, "ns": ns} for (size, stage), ns in results.items()], indent=1))


if __name__ == "__main__":
    main()
