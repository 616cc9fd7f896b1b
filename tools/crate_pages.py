"""Writes the method with typeset equations into the pages of the crates: `python tools/crate_pages.py` after a change of docs/method.md.

rustdoc knows no equations, but takes HTML: the pages have MathML, and need nothing from elsewhere.
"""

import re
from pathlib import Path

from equations import typeset

ROOT = Path(__file__).parents[1]
# The sections of docs/method.md on the page of each crate.
PAGES = {
    "core": ["The reference problem", "The simulation"],
    "estimator": ["Admissible fields", "The error", "The true error"],
}
# Equations are higher than their lines: rustdoc would give each paragraph a scroll bar.
STYLE = "<style>.docblock math, .docblock :has(math) { overflow: visible !important }</style>\n\n"


def page(crate: str) -> str:
    """Give the page of a crate."""
    source = (ROOT / "docs" / "method.md").read_text(encoding="utf-8")
    sections = dict(re.findall(r"^## (.*?)\n(.*?)(?=^## |\Z)", source, re.DOTALL | re.MULTILINE))
    chosen = "".join(f"## {title}\n{sections[title]}" for title in PAGES[crate])
    # Pages of the repository are not beside those of the crates.
    text = re.sub(r"\[(`?[^\]]+`?)\]\([\w.#/-]+\)", r"\1", chosen)
    pieces = re.split(r"(\$\$.*?\$\$|\$.*?\$)", text, flags=re.DOTALL)
    return STYLE + "".join(equation(piece) if piece.startswith("$") else escaped(piece) for piece in pieces).rstrip() + "\n"


def equation(text: str) -> str:
    """Typeset an equation; its number stands behind it."""
    block = text.startswith("$$")
    written, tag = typeset(re.sub(r"\s+", " ", text.strip("$")), block)
    number = f"<mspace width=\"2em\"></mspace><mtext>&#91;{tag}&#93;</mtext>" if tag else ""
    # The pages have no style sheet of their own.
    written = written.replace('<mi class="capital-greek">', '<mi mathvariant="normal">')
    written = re.sub(r"\s*\n\s*", "", written).replace("</math>", f"{number}</math>")
    # Signs of Markdown.
    return re.sub(r"[*_~`^|]", lambda sign: f"&#{ord(sign[0])};", written)


def escaped(text: str) -> str:
    """Keep numbers of equations from being read as links."""
    return re.sub(r"\[([^\]]*)\]", r"\\[\1\\]", text)


if __name__ == "__main__":
    for crate in PAGES:
        (ROOT / "crates" / crate / "src" / "method.md").write_text(page(crate), encoding="utf-8")
