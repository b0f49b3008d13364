"""Converts the LaTeX of a sheet to MathML, which browsers can display."""

import re
from functools import cache

from latex2mathml.converter import convert
from markupsafe import Markup

_ASTERISK, _OPERATOR = "<mo>&#x0002A;</mo>", "<mo>&#x02217;</mo>"
"""The ASCII asterisk, which fonts raise, and the asterisk operator, which TeX uses in a formula."""

_SIGN = re.compile(r"((?:\[|&#x000(?:28|2C|3D|3C|3E);)</mo>)<mo>&#x02212;</mo>")
_PREFIX = r'\1<mo form="prefix">&#x02212;</mo>'
"""The sign of a number after a bracket, a comma or a relation; a difference has more space."""

_PRIME = re.compile(r"<msup>(<mi>\w+</mi>)<mi>(&#x0203[2-4];)</mi></msup>")
_RAISED = r'<mrow>\1<mo lspace="0" rspace="0">\2</mo></mrow>'
"""A prime is raised in every font, and would be too small to read as a superscript."""


_LEFT = re.compile(r"<m\w>(&(?!#|\w+;)|\\|\$)")
"""LaTeX that the converter has left as it is."""


@cache
def mathml(latex: str, display: str = "block") -> Markup:
    """One formula as MathML; `display` is "inline" for a formula within a line of text.

    Raises ValueError if part of the LaTeX would appear as it is.
    """
    # the LaTeX is never the input of a user; the converter does not know `aligned`
    formula = convert(latex.replace("{aligned}", "{split}"), display=display)
    if _LEFT.search(formula):
        raise ValueError(f"the formula is not typeset completely: {latex}")
    return Markup(_PRIME.sub(_RAISED, _SIGN.sub(_PREFIX, formula.replace(_ASTERISK, _OPERATOR))))
