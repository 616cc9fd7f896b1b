"""Asks all other sites that the repository names whether their pages are there: `python tools/links.py`, nightly in CI.

`docs/links.txt` lists them; the tests compare the list with the pages, without a network.
"""

import http.client
import re
import sys
import urllib.error
import urllib.request
from collections.abc import Iterable
from pathlib import Path

ROOT = Path(__file__).parents[1]
LIST = ROOT / "docs" / "links.txt"
# Pages and texts that users read; names of XML dialects are no links.
READ = ("*.md", "*.toml", "*.cff", "docs/**/*.md", "docs/**/*.html", "examples/**/*.md", "examples/**/*.geo", "crates/*/src/**/*.rs", "crates/*/src/**/*.json")
LINK = re.compile(r"https?://[^\s<>\"'`\\\])}]+")
DIALECTS = "http://www.w3.org/"


def named() -> set[str]:
    """Give the links to other sites in the texts of the repository."""
    files = (file for pattern in READ for file in ROOT.glob(pattern))
    found = {link.rstrip(".,;:") for file in files for link in LINK.findall(file.read_text(encoding="utf-8"))}
    return {link for link in found if not link.startswith(DIALECTS)}


def listed() -> list[str]:
    """Give the links of the list, in its order."""
    return LIST.read_text(encoding="utf-8").split()


def missing(links: Iterable[str], seconds: float = 20.0) -> dict[str, str]:
    """Ask each link and give the reasons of those that do not answer with a page."""
    reasons = {}
    for link in links:
        # Some sites refuse programs that do not say who they are.
        request = urllib.request.Request(link, headers={"User-Agent": "percute-links"})
        try:
            with urllib.request.urlopen(request, timeout=seconds) as answer:
                answer.read(1)
        except (urllib.error.URLError, http.client.HTTPException, OSError) as error:
            reasons[link] = str(error)
    return reasons


if __name__ == "__main__":
    reasons = missing(listed())
    sys.exit("\n".join(f"{link}: {reason}" for link, reason in reasons.items()) or None)
