"""The documentation site: `python -m sphinx -W --keep-going -c docs . target/site` from the root of the repository.

The source folder is the root: the site has the same pages, in the same places, as a code host, and their links hold in both.
Nothing is fetched at build or at view time: equations are MathML, fonts are those of the reader's system.
"""

import re
import shlex
import subprocess
import sys
from importlib.metadata import version as version_of
from pathlib import Path
from typing import Any

from docutils import nodes
from docutils.utils.math import MathError
from sphinx.application import Sphinx
from sphinx.util import logging
from sphinx.util.docutils import SphinxDirective

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT / "tools"))

from equations import typeset  # noqa: E402

project = "percute"
author = "the authors of percute"
release = version = version_of("percute")
root_doc = "docs/index"

extensions = ["myst_parser", "sphinx.ext.autodoc", "numpydoc"]
include_patterns = ["*.md", "docs/**.md", "examples/README.md", "studies/README.md"]
# Folders without pages, which need not be searched.
exclude_patterns = ["target", "venv", ".venv", ".git", "benches", "crates", "python", "tests", "tools"]

myst_enable_extensions = ["dollarmath"]
myst_heading_anchors = 4
nitpicky = True
default_role = "py:obj"

autodoc_member_order = "bysource"
autodoc_typehints = "none"
numpydoc_show_class_members = False
autodoc_default_options = {"members": True, "inherited-members": "object,BaseException,IntEnum"}

html_theme = "furo"
html_title = "percute"
html_static_path = ["site/percute.css"]
html_css_files = ["percute.css"]
# The start page is docs/index.html, as docs/index.md is in the repository: index.html leads there.
html_additional_pages = {"index": "redirect.html"}
templates_path = ["site"]
html_math_renderer = "mathml"
html_copy_source = False
html_show_copyright = False
html_show_sourcelink = False

PROGRAMS = {"percute": [sys.executable, "-m", "percute"], "python": [sys.executable]}

logger = logging.getLogger(__name__)


class Command(SphinxDirective):
    """What a command prints at the root of the repository, without the time that it took."""

    required_arguments = 1
    final_argument_whitespace = True

    def run(self) -> list[nodes.Node]:
        """Run it."""
        program, *arguments = shlex.split(self.arguments[0])
        done = subprocess.run([*PROGRAMS[program], *arguments], cwd=ROOT, capture_output=True, text=True)
        if done.returncode != 0:
            raise self.error(f"{self.arguments[0]}: {done.stderr}")
        printed = re.sub(r"(?m)^(case .*), \S+ s\)$", r"\1)", done.stdout).rstrip()
        return [nodes.literal_block(printed, printed, language="text")]


def mathml(translator: Any, node: nodes.math | nodes.math_block) -> None:
    """Write an equation as MathML; the number in its \\tag stands at its right."""
    block = isinstance(node, nodes.math_block)
    try:
        written, tag = typeset(node.astext(), block)
    except MathError as error:
        logger.warning("no equation: %s", error, location=node)
        written, tag = translator.encode(node.astext()), ""
    if block:
        number = f'<span class="number">[{tag}]</span>' if tag else ""
        written = f'<div class="equation"><div class="formula">{written}</div>{number}</div>'
    translator.body.append(written)
    raise nodes.SkipNode


def signature(
    _app: Sphinx, what: str, _name: str, _of: object, _options: object, shown: str | None, result: str | None
) -> tuple[str, str | None] | None:
    """Leave out private arguments, and the constructors of classes whose objects functions make."""
    if not shown:
        return None
    return ("" if what == "class" and shown == "()" else re.sub(r", _\w+='\w+'", "", shown)), result


def unsearched(app: Sphinx, _page: nodes.document) -> None:
    """Keep old changes out of the results of a search: other pages say what holds."""
    if app.env.docname == "CHANGELOG":
        app.env.metadata["CHANGELOG"]["nosearch"] = ""


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the equations, the directive and the signatures."""
    app.add_html_math_renderer("mathml", (mathml, None), (mathml, None))
    app.add_directive("command", Command)
    app.connect("doctree-read", unsearched)
    app.connect("autodoc-process-signature", signature)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
