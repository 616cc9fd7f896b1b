"""percute itself, through `benches/src/bin/probe.rs`: one process for each case, which runs on demand.

The Python API keeps all steps of a simulation, and `percute simulate` writes them to a file. The other programs do neither.
"""

from __future__ import annotations

import json
import subprocess
import tempfile
from pathlib import Path

import block as common
import numpy as np
from block import Block

ROOT = Path(__file__).resolve().parents[2]


def build() -> Path:
    """Build the probe; give its path."""
    return program("probe")


def program(name: str) -> Path:
    """Build one of the programs of `benches/src/bin`; give its path."""
    command = ["cargo", "build", "--release", "--locked", "-p", "percute-benches", "--bin", name]
    subprocess.run(command, cwd=ROOT, check=True)
    command = ["cargo", "metadata", "--format-version=1", "--no-deps"]
    metadata = json.loads(subprocess.run(command, cwd=ROOT, check=True, capture_output=True).stdout)
    return Path(metadata["target_directory"]) / "release" / name


class Percute:
    """The block in a process of its own."""

    def __init__(self, probe: Path, cells: tuple[int, int], *options: str) -> None:
        self.name = " ".join(["percute", *options])
        self.contact = "--free" not in options
        command = [str(probe), *map(str, cells), *options, *(["--wall"] if common.WALL else [])]
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        elements, step, gap = self._answer().split()
        self.elements, self.step, self.gap = int(elements), float(step), float(gap)

    def _answer(self) -> str:
        assert self.process.stdout
        line = self.process.stdout.readline()
        if not line:
            raise RuntimeError(f"{self.name} ended with code {self.process.wait()}")
        return line.strip()

    def ask(self, line: str) -> str:
        """The answer of the probe to a line."""
        assert self.process.stdin
        self.process.stdin.write(line + "\n")
        self.process.stdin.flush()
        return self._answer()

    def block(self) -> Block:
        """The mesh and the time step, for the other programs."""
        with tempfile.NamedTemporaryFile() as file:
            nodes = int(self.ask(f"mesh {file.name}"))
            numbers = np.fromfile(file.name)
        points, cells = np.split(numbers, [2 * nodes])
        return Block(points.reshape(-1, 2), cells.astype(np.int64).reshape(-1, 3), self.step, self.gap, self.contact)

    def displacement(self, steps: int) -> np.ndarray:
        """The displacement after so many steps (m)."""
        with tempfile.NamedTemporaryFile() as file:
            self.ask(f"displacement {steps} {file.name}")
            return np.fromfile(file.name).reshape(-1, 2)

    def parts(self, steps: int) -> np.ndarray:
        """Kinetic and elastic part of η at each sample (2, samples) (J)."""
        with tempfile.NamedTemporaryFile() as file:
            self.ask(f"parts {steps} {file.name}")
            return np.fromfile(file.name).reshape(-1, 2).T

    def run(self, steps: int) -> tuple[float, None]:
        """Seconds of so many steps."""
        return float(self.ask(f"run {steps}")), None

    def product(self, count: int) -> float:
        """Seconds of so many products K·u in compressed sparse rows."""
        return float(self.ask(f"product {count}"))

    def close(self) -> None:
        """End the process."""
        self.process.communicate()
