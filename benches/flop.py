"""Floating-point operations per element of the stages of `instructions.py`, counted under valgrind: `python benches/flop.py`.

callgrind counts how often each instruction runs, and objdump tells which are sums, differences, products, quotients
or roots of how many numbers. Each instruction set does the same operations. The mesh has 640 elements, so that those around contact nodes
have a larger part in the counts than on finer meshes.
"""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
import tempfile
from collections import Counter
from pathlib import Path

from instructions import ELEMENTS, STAGES, build

OPERATION = re.compile(r"^v?(?:add|sub|mul|div|sqrt)(?:(s)[sd]|p([sd])) .*%([xyz])mm\d+$")
"""One number, or a register full of single or double numbers."""
REGISTER = {"x": 16, "y": 32, "z": 64}
"""Bytes of a register."""
OBJECT = re.compile(r"^(c?)ob=(\(\d+\)) ?(.*)$")
COST = re.compile(r"^(0x[0-9a-f]+|[+-]\d+|\*) \S+ (\d+)$")


def operations(program: Path) -> dict[int, int]:
    """Operations of each instruction that has any, by its address."""
    lines = subprocess.run(["objdump", "-d", "--no-show-raw-insn", program], check=True, capture_output=True, text=True).stdout.splitlines()
    found = {}
    for line in lines:
        place, _, code = line.partition(":\t")
        if operation := OPERATION.match(" ".join(code.split())):
            size = {"s": 4, "d": 8}.get(operation[2])
            found[int(place, 16)] = REGISTER[operation[3]] // size if size else 1
    return found


def executed(program: Path, stage: str, count: int) -> Counter[int]:
    """How often each instruction of the program runs, by its address."""
    with tempfile.NamedTemporaryFile("r") as file:
        command = ["valgrind", "--tool=callgrind", "--dump-instr=yes", f"--callgrind-out-file={file.name}"]
        subprocess.run([*command, program, stage, str(count)], check=True, capture_output=True)
        lines = file.read().splitlines()
    found: Counter[int] = Counter()
    names: dict[str, str] = {}
    own = called = False
    place = 0
    for line in lines:
        if named := OBJECT.match(line):
            # A name is given once, also with a call into the object.
            name = names.setdefault(named[2], named[3])
            own = own if named[1] else name == str(program)
        elif line.startswith("calls="):
            # The next line has the cost of the call.
            called = True
        elif cost := COST.match(line):
            text = cost[1]
            place = int(text, 16) if text.startswith("0x") else place + (0 if text == "*" else int(text))
            if own and not called:
                found[place] += int(cost[2])
            called = False
    return found


def counts(stages: list[str]) -> dict[str, float]:
    """Operations per element of some stages, each the difference of two lengths of run."""
    if not (shutil.which("valgrind") and shutil.which("objdump")):
        sys.exit("valgrind and objdump are needed")
    program = build()
    weights, found = operations(program), {}
    for stage in stages:
        short, long, _ = STAGES[stage]
        both = [executed(program, stage, count) for count in (short, long)]
        totals = [sum(times * weights.get(place, 0) for place, times in each.items()) for each in both]
        found[stage] = (totals[1] - totals[0]) / ((long - short) * ELEMENTS)
    return found


def main() -> None:
    """Print all stages."""
    for stage, count in counts(list(STAGES)).items():
        print(f"{stage:<14}{count:10.0f} per element and {STAGES[stage][2]}")


if __name__ == "__main__":
    main()
