"""Setup time and memory per element, beside the memory that percute predicts: `python benches/scale.py`.

Linux only. Each figure has a process of its own. Setup is the processor time of all that precedes the first step. Memory is
resident memory: of the problem, less that of the program; then the most during a run, beyond the problem; then the most with an
estimate of every step, beyond the problem and the run alone.

The command `percute` of the installed package runs the same block from a case file, on one thread for each core. Its peak, less that of
the program, is compared with the sum that `percute info` predicts.

With `--flight`, a block of 8000 elements with 401 contact nodes strikes its plane and flies off, for 5000 and for 20 000 steps. A block with
the same number of elements and 11 contact nodes beside it gives the memory of a contact node.
"""

from __future__ import annotations

import argparse
import json
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

from child import CELLS, Percute, build, table

Figure = dict[str, Any]
"""Numbers by name."""
RECONSTRUCTIONS = ("consistent", "corrected")
STEPS = 20
"""Of a run: two windows of eight levels are full, and the third has been prepared."""
FLIGHT = (400, 10)
"""Cells of the block in flight."""
KEPT = {"MALLOC_MMAP_THRESHOLD_": str(1 << 17)}
"""Freed arrays leave the process at once: what stays of one would otherwise serve the next, and be missing from its figure."""
CASE = """
[mesh]
rectangle = {{ width = 0.05, height = 0.04, nx = {nx}, ny = {ny} }}
[material]
young = 70e9
poisson = 0.3
density = 2700.0
plane = "stress"
[initial]
velocity = [400.0, -400.0]
[[obstacle]]
point = [0.0, -{gap!r}]
normal = [0.0, 1.0]
friction = 0.2
[time]
end = {end!r}
step = {step!r}
[estimate]
reconstruction = "{name}"
every = 1
"""


def arguments() -> argparse.Namespace:
    """Read the command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--sizes", type=int, nargs="+", choices=CELLS, default=list(CELLS)[1:], metavar="N", help="elements")
    parser.add_argument("--flight", type=int, nargs="*", metavar="STEPS", help="the block in flight (5000 20000)")
    parser.add_argument("--command", type=Path, default=Path(sys.executable).with_name("percute"), help="percute")
    parser.add_argument("--markdown", action="store_true", help="print tables of docs/speed.md")
    parser.add_argument("--json", type=Path, metavar="FILE", help="all figures")
    return parser.parse_args()


def memory(process: int, kind: str) -> int:
    """Bytes of a process: now (`VmRSS`) or at most (`VmHWM`)."""
    found = re.search(kind + r":\s+(\d+) kB", Path(f"/proc/{process}/status").read_text())
    assert found
    return 1024 * int(found[1])


def resident(probe: Path, cells: tuple[int, int], steps: int, *options: str) -> tuple[int, int, int]:
    """Bytes of a process with the block, the most that it takes beyond them in a run, and the prediction for an estimate."""
    run = Percute(probe, cells, *options)
    before = memory(run.process.pid, "VmRSS")
    # The peak of what precedes the run is forgotten.
    Path(f"/proc/{run.process.pid}/clear_refs").write_text("5")
    run.run(steps)
    most = memory(run.process.pid, "VmHWM")
    predicted = int(run.ask(f"memory {steps}")) if options else 0
    run.close()
    return before, most - before, predicted


def setup(probe: Path, size: int, *options: str) -> float:
    """Microseconds per element before the first step; the better of two."""
    run = Percute(probe, CELLS[size], *options)
    seconds = min(float(run.ask("setup")) for _ in range(2))
    run.close()
    return seconds * 1e6 / size


def per_element(probe: Path, size: int) -> list[Figure]:
    """Setup and memory of problem, simulation and estimates."""
    cells = CELLS[size]
    # The program itself.
    program = resident(probe, (2, 1), 1)[0]
    problem, simulation, _ = resident(probe, cells, STEPS)
    figures: list[Figure] = [
        {"stage": "problem", "bytes": (problem - program) / size},
        {"stage": "simulation", "setup": setup(probe, size), "bytes": simulation / size},
    ]
    for name in RECONSTRUCTIONS:
        options = ("--estimate", name)
        _, both, predicted = resident(probe, cells, STEPS, *options)
        own = {"setup": setup(probe, size, *options), "bytes": (both - simulation) / size, "predicted": predicted / size}
        figures.append({"stage": name, **own})
    return [{"elements": size, **figure} for figure in figures]


def peak(command: list[str | Path]) -> int:
    """The most bytes that a program takes, with the allocator as it is."""
    environment = {name: value for name, value in os.environ.items() if name not in KEPT}
    with subprocess.Popen(command, stdout=subprocess.DEVNULL, env=environment) as process:
        _, status, used = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        sys.exit(f"{' '.join(map(str, command))} ended with code {process.returncode}")
    return 1024 * used.ru_maxrss


def commands(probe: Path, percute: Path, size: int) -> list[Figure]:
    """Peaks of runs by the command, and the bytes that it predicts."""
    block = Percute(probe, CELLS[size])
    block.close()
    nx, ny = CELLS[size]
    idle, figures = peak([percute, "--version"]), []
    with tempfile.TemporaryDirectory() as folder:
        for name in RECONSTRUCTIONS:
            case = Path(folder) / "case.toml"
            case.write_text(CASE.format(nx=nx, ny=ny, gap=block.gap, step=block.step, end=STEPS * block.step, name=name))
            told = json.loads(subprocess.run([percute, "info", "--json", case], check=True, capture_output=True).stdout)
            predicted = told["run_memory"] + told["estimate_memory"]
            most = peak([percute, "run", "--quiet", case])
            figures.append({"elements": size, "estimate": name, "peak": most, "idle": idle, "predicted": predicted})
    return figures


def flights(probe: Path, lengths: list[int]) -> list[Figure]:
    """Memory of estimates of a long flight after an impact, and of the same number of elements with few contact nodes."""
    figures = []
    for name in RECONSTRUCTIONS:
        for steps in lengths:
            options = ("--estimate", name)
            _, wide, predicted = resident(probe, FLIGHT, steps, *options)
            narrow = resident(probe, FLIGHT[::-1], steps, *options)[1]
            node = (wide - narrow) / (FLIGHT[0] - FLIGHT[1])
            figures.append({"estimate": name, "steps": steps, "bytes": wide, "predicted": predicted, "contact node": node})
    return figures


def show_elements(figures: list[Figure], markdown: bool) -> None:
    """Print setup and memory per element."""
    rows = []
    for found in figures:
        expected = found.get("predicted")
        ratio = f"{found['bytes'] / expected:.2f}" if expected else ""
        setup_time = f"{found['setup']:.2f}" if "setup" in found else ""
        predicted = f"{expected:.0f}" if expected else ""
        rows.append([f"{found['elements']} elements, {found['stage']}", setup_time, f"{found['bytes']:.0f}", predicted, ratio])
    table(["", "setup, µs per element", "bytes per element", "predicted", "found over predicted"], rows, markdown)


def show_commands(figures: list[Figure], markdown: bool) -> None:
    """Print peaks of the command."""
    rows = []
    for found in figures:
        ratio = (found["peak"] - found["idle"]) / found["predicted"]
        sizes = [f"{found[key] / 1e9:.3f}" for key in ("peak", "idle", "predicted")]
        rows.append([f"{found['elements']} elements, {found['estimate']}", *sizes, f"{ratio:.2f}"])
    table(["`percute run`", "peak, GB", "of it the program", "predicted, GB", "found over predicted"], rows, markdown)


def show_flights(figures: list[Figure], markdown: bool) -> None:
    """Print memory by length of flight, with the ratio to the shortest of the same estimate."""
    rows = []
    for found in figures:
        shortest = next(other["bytes"] for other in figures if other["estimate"] == found["estimate"])
        numbers = [
            f"{found['bytes'] / 1e6:.1f}",
            f"{found['bytes'] / shortest:.2f}",
            f"{found['predicted'] / 1e6:.1f}",
            f"{found['contact node'] / 1e3:.1f}",
        ]
        rows.append([f"{found['estimate']}, {found['steps']} steps", *numbers])
    table(["8000 elements, 401 contact nodes", "MB", "over the shortest", "predicted, MB", "kB per contact node"], rows, markdown)


def main() -> None:
    """Measure what is asked for."""
    wanted = arguments()
    os.environ.update(KEPT)
    probe = build()
    results: dict[str, list[Figure]] = {"elements": [], "commands": [], "flights": []}
    if wanted.flight is not None:
        results["flights"] = flights(probe, wanted.flight or [5000, 20000])
        show_flights(results["flights"], wanted.markdown)
    else:
        for size in wanted.sizes:
            results["elements"] += per_element(probe, size)
            results["commands"] += commands(probe, wanted.command, size)
        show_elements(results["elements"], wanted.markdown)
        show_commands(results["commands"], wanted.markdown)
    if wanted.json:
        wanted.json.write_text(json.dumps(results, indent=1))


if __name__ == "__main__":
    main()
