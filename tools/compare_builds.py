"""Compare the results of two builds of the command on all cases in examples/.

    python tools/compare_builds.py OLD NEW [--tolerance 1e-12] [--only block,bar] [--old-examples FOLDER]

OLD and NEW are binaries. FOLDER holds the same cases in the case language of OLD, where that differs. Each case is simulated once by each build; its history is then estimated with every reconstruction. All numbers
of the JSON reports and all arrays of the history and estimate files are compared. The scale of a difference is the largest magnitude of
the array, or of the number. Numbers that depend on the clock are left out. Needs numpy and h5py.
"""

import argparse
import json
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

import h5py
import numpy as np

ROOT = Path(__file__).resolve().parent.parent
CASES = ("examples", "studies/benchmarks/cases")
# Option and values by the names that a build knows.
NAMES = {
    "--reconstruction": ("corrected", "consistent", "published"),
    "--contact-force": ("whole", "sharp", "paper"),
}
# Keys of reports that have another name in a later build.
RENAMED = {
    "mended_elements": "reoriented_elements",
    "rendezvous": "onset",
    "penetration_at_knots": "penetration_at_instants",
    "penetration_between_knots": "penetration_between_instants",
}
# Clock, versions, number of the layout, texts in the case language and paths: no results.
SKIPPED = {"version", "format", "seconds", "elapsed", "wall", "file", "path", "duration", "case"}


def command(binary: Path, *arguments: str) -> str:
    """Run a build; return its standard output."""
    done = subprocess.run([str(binary), *arguments], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise SystemExit(f"{binary} {' '.join(arguments)}\n{done.stderr}")
    return done.stdout


def option(binary: Path) -> tuple[str, tuple[str, ...]]:
    """Return the option that chooses the reconstruction, and its values."""
    text = command(binary, "estimate", "--help")
    return next((name, values) for name, values in NAMES.items() if name in text)


def numbers(value: object, place: str = "") -> Iterator[tuple[str, float]]:
    """Walk a JSON document; give its numbers with their places."""
    if isinstance(value, bool) or value is None or isinstance(value, str):
        return
    if isinstance(value, int | float):
        yield place, float(value)
    elif isinstance(value, list):
        for at, item in enumerate(value):
            yield from numbers(item, f"{place}[{at}]")
    elif isinstance(value, dict):
        for key, item in value.items():
            if key not in SKIPPED:
                yield from numbers(item, f"{place}.{RENAMED.get(key, key)}")


def arrays(file: Path) -> dict[str, np.ndarray]:
    """Return all arrays of numbers of an HDF5 file."""
    found: dict[str, np.ndarray] = {}

    def visit(name: str, item: object) -> None:
        if isinstance(item, h5py.Dataset) and item.dtype.kind in "fiu":
            folder, _, last = name.rpartition("/")
            found[f"{folder}/{RENAMED.get(last, last)}"] = np.asarray(item[()], dtype=float)

    with h5py.File(file) as opened:
        opened.visititems(visit)
    return found


class Difference:
    """The largest difference so far, and its place."""

    def __init__(self) -> None:
        self.largest, self.place, self.failures = 0.0, "nowhere", 0

    def add(self, place: str, old: np.ndarray, new: np.ndarray, tolerance: float) -> None:
        """Take in a pair of arrays."""
        if old.shape != new.shape:
            print(f"  {place}: shapes {old.shape} and {new.shape}")
            self.failures += 1
            return
        if old.size == 0:
            return
        if not np.array_equal(np.isnan(old), np.isnan(new)):
            print(f"  {place}: not a number in one build only")
            self.failures += 1
            return
        scale = np.nanmax(np.abs(old), initial=0.0)
        apart = np.nanmax(np.abs(old - new), initial=0.0)
        relative = apart / scale if scale > 0 else apart
        # Residuals and drifts are rounding themselves.
        if scale < 1e-9 and any(word in place for word in ("residual", "drift")):
            return
        if relative > self.largest:
            self.largest, self.place = relative, place
        if relative > tolerance:
            print(f"  {place}: {relative:.2e}")
            self.failures += 1


def compare(cases: tuple[Path, Path], builds: tuple[Path, Path], folder: Path, tolerance: float) -> Difference:
    """Run a case by both builds; compare."""
    case = cases[1]
    difference = Difference()
    files: list[Path] = []
    for at, binary in enumerate(builds):
        file = folder / f"{case.stem}-{at}.vtkhdf"
        subprocess.run([str(binary), "simulate", cases[at].name, "--history", str(file), "--quiet"], cwd=cases[at].parent, check=True,
                       capture_output=True)
        files.append(file)
    old, new = map(arrays, files)
    for name in old.keys() | new.keys():
        if name not in old or name not in new:
            print(f"  {case.stem}, history: {name} is in one build only")
            difference.failures += 1
            continue
        difference.add(f"{case.stem}, history, {name}", old[name], new[name], tolerance)
    options = [option(binary) for binary in builds]
    for choice in range(3):
        outputs, estimates = [], []
        for at, binary in enumerate(builds):
            name, values = options[at]
            file = folder / f"{case.stem}-{at}-{choice}.vtkhdf"
            text = command(binary, "estimate", str(files[at]), name, values[choice], "--json", "--quiet", "--fields", "--output", str(file))
            outputs.append(dict(numbers(json.loads(text))))
            estimates.append(arrays(file))
        where = f"{case.stem}, {options[1][1][choice]}"
        for place in outputs[0].keys() | outputs[1].keys():
            if place not in outputs[0] or place not in outputs[1]:
                print(f"  {where}: the report of one build lacks {place}")
                difference.failures += 1
                continue
            a, b = (np.array(output[place]) for output in outputs)
            difference.add(f"{where}, report {place}", a, b, tolerance)
        for name in estimates[0].keys() | estimates[1].keys():
            if name not in estimates[0] or name not in estimates[1]:
                print(f"  {where}, estimate: {name} is in one build only")
                difference.failures += 1
                continue
            difference.add(f"{where}, estimate, {name}", estimates[0][name], estimates[1][name], tolerance)
    return difference


def main() -> int:
    """Compare all cases; return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("old", type=Path)
    parser.add_argument("new", type=Path)
    parser.add_argument("--tolerance", type=float, default=1e-12)
    parser.add_argument("--only", default="")
    parser.add_argument("--old-examples", type=Path)
    options = parser.parse_args()
    wanted = set(filter(None, options.only.split(",")))
    failures = 0
    with tempfile.TemporaryDirectory() as folder:
        for case in sorted(path for folder in CASES for path in (ROOT / folder).glob("*.toml")):
            if wanted and case.stem not in wanted:
                continue
            old_case = next(options.old_examples.resolve().rglob(case.name)) if options.old_examples else case
            builds = (options.old.resolve(), options.new.resolve())
            difference = compare((old_case, case), builds, Path(folder), options.tolerance)
            failures += difference.failures
            print(f"{case.stem:<20} largest {difference.largest:.1e}   {difference.place}", flush=True)
    print("agree" if failures == 0 else f"{failures} differences")
    return min(failures, 1)


if __name__ == "__main__":
    sys.exit(main())
