"""Equations as MathML, for the site and for the pages of the crates."""

import html
import re
from xml.etree import ElementTree

from docutils.utils.math.latex2mathml import tex2mathml


def typeset(formula: str, block: bool) -> tuple[str, str]:
    """Give the MathML of a formula, and the number in its \\tag, empty without one.

    Raises
    ------
    docutils.utils.math.MathError
        The formula has a part without a translation.
    """
    tag = re.search(r"\\tag\{([^}]*)\}", formula)
    formula = formula.replace(tag[0], "") if tag else formula
    return subscripts_of_accents(tex2mathml(formula, as_block=block)), tag[1] if tag else ""


def subscripts_of_accents(mathml: str) -> str:
    """Put the subscript of a letter with an accent beside it; docutils puts it below."""
    # HTML needs no name space, and XML knows none of its entities.
    mathml = mathml.replace(' xmlns="http://www.w3.org/1998/Math/MathML"', "")
    root = ElementTree.fromstring(re.sub(r"&(?!lt|gt|amp)\w+;", lambda entity: html.unescape(entity[0]), mathml))
    for node in list(root.iter("munderover")):
        letter, below, accent = node
        if accent.tag == "mo" and accent.text in ("˙", "¨", "~", "^", "¯"):
            node.tag = "msub"
            node[:] = [ElementTree.Element("mover", accent="true"), below]
            node[0].extend([letter, accent])
    return ElementTree.tostring(root, encoding="unicode")
