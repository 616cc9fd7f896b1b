"""Write NOTICES.txt: the licences of all crates that are linked into the extension module, on the systems of the wheels.

``python tools/notices.py`` after a change of Cargo.lock; it goes into each wheel.
"""

import json
import re
import subprocess
from collections import defaultdict
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[1]
FILE = ROOT / "NOTICES.txt"

SYSTEMS = ["x86_64-unknown-linux-gnu", "aarch64-unknown-linux-gnu", "x86_64-apple-darwin", "aarch64-apple-darwin", "x86_64-pc-windows-msvc"]
"""The systems of the wheels."""

NAMES = re.compile(r"(licen[cs]e|copying|copyright|notice|unlicense|ofl|ufl)", re.IGNORECASE)
"""How names of files with licences begin."""

INSIDE = {
    "hdf5-metno-src": ["ext/hdf5/LICENSE"],
    "libz-sys": ["src/zlib/LICENSE"],
    "epaint_default_fonts": ["fonts/UFL.txt"],
}
"""Licences of what crates bring along: HDF5, zlib, and the font of the pictures."""


def metadata() -> dict[str, Any]:
    """Give what cargo knows of the packages in Cargo.lock."""
    command = ["cargo", "metadata", "--format-version", "1", "--locked", *(f"--filter-platform={system}" for system in SYSTEMS)]
    found: dict[str, Any] = json.loads(subprocess.run(command, cwd=ROOT, check=True, capture_output=True).stdout)
    return found


def linked() -> list[dict[str, Any]]:
    """Give the packages of others that are linked into the extension module, in the order of their names."""
    known = metadata()
    packages = {package["id"]: package for package in known["packages"]}
    nodes = {node["id"]: node for node in known["resolve"]["nodes"]}
    ahead = [each for each in packages if packages[each]["name"] == "percute-py"]
    seen: set[str] = set()
    while ahead:
        here = ahead.pop()
        # A macro runs in the compiler.
        if here in seen or any("proc-macro" in target["kind"] for target in packages[here]["targets"]):
            continue
        seen.add(here)
        for dependency in nodes[here]["deps"]:
            if any(kind["kind"] is None for kind in dependency["dep_kinds"]):
                ahead.append(dependency["pkg"])
    foreign = (packages[each] for each in seen if packages[each]["source"] is not None)
    return sorted(foreign, key=lambda package: (package["name"], package["version"]))


def texts(package: dict[str, Any]) -> list[str]:
    """Give the licences in the folder of a package; of MIT and others to choose from, MIT."""
    folder = Path(package["manifest_path"]).parent
    files = [file for file in sorted(folder.iterdir()) if file.is_file() and NAMES.match(file.name)]
    if re.search(r"MIT( OR |/)|( OR |/)MIT", package["license"] or "") and any("mit" in file.name.lower() for file in files):
        files = [file for file in files if not re.search("apache|unlicense|zlib|0bsd|boost", file.name, re.IGNORECASE)]
    files += [folder / name for name in INSIDE.get(package["name"], [])]
    found = [file.read_text(encoding="utf-8", errors="replace") for file in files] or [mit(package)]
    return ["\n".join(line.rstrip() for line in text.strip().splitlines()) for text in found]


def mit(package: dict[str, Any]) -> str:
    """Give the MIT licence of a package that comes without its text."""
    assert "MIT" in package["license"] and package["authors"], f"{package['name']} has no licence that is known here"
    title, _, terms = (ROOT / "LICENSE-MIT").read_text(encoding="utf-8").split("\n\n", 2)
    authors = ", ".join(re.sub(r" <.*>", "", author) for author in package["authors"])
    return f"{title}\n\nCopyright (c) {authors}\n\n{terms}"


def notices() -> str:
    """Give the text of the file: each licence once, below the packages that have it."""
    packages, of_text = linked(), defaultdict(list)
    listed = []
    for package in packages:
        name = f"{package['name']} {package['version']}"
        listed.append(f"{name}  ({package['license'] or 'see below'})")
        for text in texts(package):
            of_text[text].append(name)
    parts = ["percute is linked with these packages, and with the standard library of Rust (MIT OR Apache-2.0).", "\n".join(listed)]
    for text, names in of_text.items():
        parts.append("=" * 80 + "\n" + ", ".join(names) + "\n" + "=" * 80 + "\n\n" + text)
    return "\n\n".join(parts) + "\n"


if __name__ == "__main__":
    FILE.write_text(notices(), encoding="utf-8")
