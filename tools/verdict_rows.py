"""Writes the table of examples in docs/verdict.md again: `python tools/verdict_rows.py` after a change of the estimate, some minutes."""

import json
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[1]
PAGE = ROOT / "docs" / "verdict.md"
ROW = re.compile(r"^\| (\w+) \| (\d) \| .* % \|$", re.MULTILINE)


def page() -> str:
    """Give the page with rows from the installed program."""
    return ROW.sub(lambda found: row(found[1], found[2]), PAGE.read_text(encoding="utf-8"))


def row(name: str, levels: str) -> str:
    """Give the row of an example. What the page says of all rows must hold."""
    command = [sys.executable, "-m", "percute", "verify", f"examples/{name}.toml", "--levels", levels, "--json", "--quiet"]
    document = json.loads(subprocess.run(command, cwd=ROOT, check=True, capture_output=True, encoding="utf-8").stdout)
    first, settled = document["levels"][0], document["settled"]
    (sup, mean), (low, high) = (first["effectivity"][key] for key in ("sup", "mean")), first["expected"]
    assert settled["fine_enough"] and low <= min(sup, mean) and max(sup, mean) <= high, (name, document)
    return f"| {name} | {levels} | {sup:.2f} | {mean:.2f} | {low:g} to {high:g} | {100 * settled['moved']:.1f} % |"


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
