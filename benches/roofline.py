"""The bound that memory and arithmetic set to each stage, and the time that it takes: `python benches/roofline.py`.

The bound is the longer of two times on one thread. Memory: the bytes that the stage moves (`traffic.py`), at the rate of a triad
a + s b in the same run over arrays as large as those of the stage. Arithmetic: the operations of the stage (`flop.py`), at the
highest rate of products and sums that are not fused. Times are on the wall, medians of interleaved rounds; estimates are less the
integrator.
"""

from __future__ import annotations

import argparse
import json
import subprocess
from pathlib import Path
from statistics import median

import flop
import traffic
from child import CELLS, ESTIMATED, LENGTHS, Percute, build, program, step, table

ENTRIES = 14
"""Of a row of K; there is a row for each element."""
HELD = {"product K·u": 192, "integrator": 72, "between": 450}
"""Bytes per element of the arrays of a stage; those of an estimate are predicted by percute."""
OPTIONS: dict[str, tuple[str, ...]] = {
    "integrator": (),
    "consistent": ("--estimate", "consistent"),
    "corrected": ("--estimate", "corrected"),
    "between": ("--estimate", "corrected", "--every", "1000"),
}
NAMES = {"consistent": "`consistent`, sampled", "corrected": "`corrected`, sampled", "between": "`corrected`, between samples"}
PRODUCTS = 20


class Machine:
    """What one core can do."""

    def __init__(self) -> None:
        self.process = subprocess.Popen([program("machine")], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)

    def ask(self, line: str) -> list[float]:
        """The numbers of an answer."""
        assert self.process.stdin and self.process.stdout
        self.process.stdin.write(line + "\n")
        self.process.stdin.flush()
        return [float(number) for number in self.process.stdout.readline().split()]


def arguments() -> argparse.Namespace:
    """Read the command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--sizes", type=int, nargs="+", choices=CELLS, default=[40960, 655360], metavar="N", help="elements")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--markdown", action="store_true", help="print tables of docs/speed.md")
    parser.add_argument("--json", type=Path, metavar="FILE", help="all figures")
    return parser.parse_args()


def operations() -> dict[str, float]:
    """Operations per element of each stage, those of an estimate without the integrator."""
    counted = flop.counts(list(OPTIONS))
    own = {stage: count - (0 if stage == "integrator" else counted["integrator"]) for stage, count in counted.items()}
    return {"product K·u": 2 * ENTRIES} | own


def measured(probe: Path, machine: Machine, size: int, rounds: int) -> tuple[dict[str, list[float]], dict[str, float]]:
    """Nanoseconds per element of all stages in all rounds, and the nanoseconds per byte that suit each stage."""
    runs = {stage: Percute(probe, CELLS[size], "--wall", *options) for stage, options in OPTIONS.items()}
    held = HELD | {stage: int(runs[stage].ask("memory 16")) / size for stage in ("consistent", "corrected")}
    times: dict[str, list[float]] = {stage: [] for stage in held}
    rates: dict[str, list[float]] = {stage: [] for stage in held}
    for _ in range(rounds):
        for stage, bytes_held in held.items():
            rates[stage] += machine.ask(f"triad {round(bytes_held * size)}")
        times["product K·u"].append(runs["integrator"].product(PRODUCTS) * 1e9 / (PRODUCTS * size))
        alone = step(runs["integrator"], LENGTHS[size])
        times["integrator"].append(alone)
        for stage in ("consistent", "corrected", "between"):
            times[stage].append(step(runs[stage], ESTIMATED[size]) - alone)
    for run in runs.values():
        run.close()
    return times, {stage: median(found) for stage, found in rates.items()}


def main() -> None:
    """Measure all sizes."""
    wanted = arguments()
    counted = operations()
    # After the count, whose build has other features.
    probe, machine = build(), Machine()
    plain, widest = machine.ask("peak")
    results, rows = {}, []
    for size in wanted.sizes:
        times, rates = measured(probe, machine, size, wanted.rounds)
        results[size] = {"times": times, "ns per byte": rates}
        for stage, found in times.items():
            moved = traffic.of_stage(stage)
            memory, arithmetic = moved * rates[stage], counted[stage] / widest
            bound, reached = max(memory, arithmetic), median(found)
            numbers = [f"{moved:.0f}", f"{1 / rates[stage]:.0f}", f"{memory:.1f}", f"{counted[stage]:.0f}", f"{arithmetic:.1f}"]
            rows.append([f"{size} elements, {NAMES.get(stage, stage)}", *numbers, f"{bound:.1f}", f"{reached:.1f}", f"{reached / bound:.1f}"])
    table(
        ["per element and step", "bytes", "GB/s", "memory, ns", "flop", "arithmetic, ns", "bound, ns", "reached, ns", "over bound"],
        rows,
        wanted.markdown,
    )
    print(f"\nPeak of products and sums: {widest:.0f} flop/ns, with the instruction set of the build {plain:.0f} flop/ns.")
    if wanted.json:
        wanted.json.write_text(json.dumps({"flop": counted, "peak": [plain, widest], "sizes": results}, indent=1))


if __name__ == "__main__":
    main()
