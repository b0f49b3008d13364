"""Converts LaTeX to MathML, which browsers can display.

The converter leaves out the space that TeX puts beside the name of a function.
"""

import re
from functools import cache
from html import unescape
from xml.etree.ElementTree import Element, tostring

from latex2mathml.converter import convert_to_element
from markupsafe import Markup

_ASTERISK, _OPERATOR = "<mo>&#x0002A;</mo>", "<mo>&#x02217;</mo>"
"""The ASCII asterisk, which fonts raise, and the asterisk operator, which TeX uses in a formula."""

_SIGN = re.compile(r"((?:\[|&#x000(?:28|2C|3D|3C|3E);)</mo>)<mo>&#x02212;</mo>")
_PREFIX = r'\1<mo form="prefix">&#x02212;</mo>'
"""The sign of a number after a bracket, a comma or a relation; a difference has more space."""

_PRIME = re.compile(r"<msup>(<mi>\w+</mi>)<mi>(&#x0203[2-4];)</mi></msup>")
_RAISED = r'<mrow>\1<mo lspace="0" rspace="0">\2</mo></mrow>'
"""A prime is raised in every font, and would be too small to read as a superscript."""


_LEFT = re.compile(r"<m\w>(&amp;<|\\|\$)")
"""LaTeX that the converter has left as it is."""

_CHARACTER = re.compile(r"&amp;(#x?[0-9A-Fa-f]+;)")
"""A character as the converter writes it, after the tree was written as text."""

_ALIKE = {"{aligned}": "{split}", r"\nicefrac": r"\frac", r"\dashint": r"\fint"}
"""LaTeX that the converter does not know, and what it knows of the same meaning."""

_ACTIVE = ("href", "style", "class", "id")
"""Attributes that LaTeX could set, as by \\href, and that no formula needs."""


_WORD = re.compile(r"[A-Za-z_]{2,}")
"""The name of a function, or of a symbol that is a word."""

_LETTER = re.compile(r"&#x000[4-7][0-9A-F];")
r"""A letter in \mathrm, as the converter writes it."""

_SCRIPTS = ("msub", "msup", "msubsup")


@cache
def mathml(latex: str, display: str = "block") -> Markup:
    """One formula as MathML; `display` is "inline" for a formula within a line of text.

    The LaTeX may come from anybody: its text is escaped, and links and styles are dropped.

    Raises ValueError if part of the LaTeX would appear as it is.
    """
    for other, known in _ALIKE.items():
        latex = latex.replace(other, known)
    tree = convert_to_element(latex, display=display)
    for element in tree.iter():
        for name in _ACTIVE:
            element.attrib.pop(name, None)
    _join_words(tree)
    _put_spaces(tree)
    _align(tree)
    formula = _CHARACTER.sub(r"&\1", tostring(tree, encoding="unicode"))
    if _LEFT.search(formula):
        raise ValueError(f"the formula is not typeset completely: {latex}")
    return Markup(_PRIME.sub(_RAISED, _SIGN.sub(_PREFIX, formula.replace(_ASTERISK, _OPERATOR))))


def _join_words(tree: Element) -> None:
    """Make one identifier of a word or the name of a function, and keep a single letter upright."""
    for element in list(tree.iter()):
        letters = [each.text or "" for each in element if each.get("mathvariant") == "normal"]
        if element.tag == "mrow" and len(letters) == len(element) > 1:
            element.clear()
            element.tag, element.text = "mi", "".join(letters)
        elif element.tag == "mi" and _LETTER.fullmatch(element.text or ""):
            element.text = unescape(element.text or "")
            element.set("mathvariant", "normal")
        elif element.tag == "mo" and _WORD.fullmatch(element.text or ""):
            element.tag = "mi"  # browsers put much space around an unknown operator


def _put_spaces(tree: Element) -> None:
    """Put a thin space between a factor and a function or word, before it and after it."""
    for row in list(tree.iter()):
        if row.tag not in ("mrow", "mtd", "mstyle"):
            continue
        for place in range(len(row) - 1, 0, -1):
            before, after = row[place - 1], row[place]
            if (_is_word(after) and before.tag not in ("mo", "mspace")) or (
                _is_word(before) and after.tag not in ("mo", "mspace", "mrow")
            ):
                row.insert(place, Element("mspace", width="0.1667em"))


def _is_word(element: Element) -> bool:
    """Whether an element is the name of a function or a word, with or without indices."""
    base = element[0] if element.tag in _SCRIPTS else element
    return base.tag == "mi" and _WORD.fullmatch(base.text or "") is not None


def _align(tree: Element) -> None:
    """Align the cells of a table by a style, because browsers ignore `columnalign`."""
    for table in tree.iter("mtable"):
        padding = "; padding-left: 0; padding-right: 0" * (table.get("columnspacing") == "0em")
        for cell in table.iter("mtd"):
            if align := cell.get("columnalign"):
                cell.set("style", f"text-align: {align}{padding}")
