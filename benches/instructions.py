"""Instructions per element of each stage against the committed baseline: `python benches/instructions.py`.

Counts, unlike seconds, are the same on a busy machine: two counts of one build differ by 1e-5. The stages run on 640 elements, on one
thread, in the portable instruction set, under valgrind. A count is the difference of two lengths of run, so that start-up does not count.

A stage that takes 10 % more than the baseline fails. If the increase is intended, or after an improvement, or with a new compiler, renew
the baseline with `--renew` and commit it with the reason.
"""

from __future__ import annotations

import argparse
import json
import re
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
BASELINE = ROOT / "benches" / "instructions.toml"
ELEMENTS = 640
MARGIN = 0.1
STAGES = {
    "integrator": (16, 48, "step"),
    "consistent": (16, 48, "sampled step, with the integrator"),
    "corrected": (16, 48, "sampled step, with the integrator"),
    "between": (16, 48, "step of `corrected` between samples, with the integrator"),
    "critical-step": (1, 3, "critical step"),
    "setup": (1, 3, "mesh, problem and estimator `corrected`"),
}
"""Two lengths of run, and their unit."""
HEAD = """# Instructions per element of each stage, on 640 elements in the portable instruction set.
# Written by `python benches/instructions.py --renew` with {compiler}.
"""


def build() -> Path:
    """Build the counted program."""
    command = ["cargo", "build", "--release", "--locked", "-p", "percute-benches", "--bin", "instructions"]
    command += ["--features", "portable", "--message-format", "json-render-diagnostics"]
    lines = subprocess.run(command, cwd=ROOT, check=True, stdout=subprocess.PIPE, text=True).stdout.splitlines()
    found = [message["executable"] for message in map(json.loads, lines) if message.get("executable")]
    return Path(found[-1])


def executed(program: Path, stage: str, count: int) -> int:
    """Instructions of one run."""
    command = ["valgrind", "--tool=cachegrind", "--cache-sim=no", "--cachegrind-out-file=/dev/null"]
    done = subprocess.run([*command, program, stage, str(count)], capture_output=True, text=True, check=False)
    total = re.search(r"I\s+refs:\s+([\d,]+)", done.stderr)
    if done.returncode or not total:
        sys.exit(f"{stage}: {done.stderr}")
    return int(total[1].replace(",", ""))


def counts() -> dict[str, float]:
    """Instructions per element of all stages."""
    program, found = build(), {}
    for stage, (short, long, _) in STAGES.items():
        difference = executed(program, stage, long) - executed(program, stage, short)
        found[stage] = difference / ((long - short) * ELEMENTS)
    return found


def compare(found: dict[str, float], baseline: dict[str, float]) -> bool:
    """Print all stages; give whether none takes more than the margin."""
    good = set(found) == set(baseline)
    if not good:
        print(f"the baseline has other stages: {', '.join(sorted(set(found) ^ set(baseline)))}")
        return False
    for stage, count in found.items():
        change = count / baseline[stage] - 1.0
        remark = ""
        if change > MARGIN:
            good, remark = False, f"  more than {MARGIN:+.0%}"
        elif change < -MARGIN:
            remark = "  renew the baseline"
        print(f"{stage:<14}{count:10.0f} per element and {STAGES[stage][2]}: {change:+.1%}{remark}")
    return good


def main() -> None:
    """Compare with the baseline or renew it."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--renew", action="store_true", help="write the baseline")
    renew = parser.parse_args().renew
    if not shutil.which("valgrind"):
        sys.exit("valgrind is not installed")
    found = counts()
    if renew:
        compiler = subprocess.run(["rustc", "--version"], capture_output=True, text=True, check=True).stdout.strip()
        lines = [f"{stage} = {count:.0f}\n" for stage, count in found.items()]
        BASELINE.write_text(HEAD.format(compiler=compiler) + "".join(lines))
    if not compare(found, tomllib.loads(BASELINE.read_text())):
        sys.exit("the stages above became slower; if that is intended: python benches/instructions.py --renew")


if __name__ == "__main__":
    main()
