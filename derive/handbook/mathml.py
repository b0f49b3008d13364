"""Converts the LaTeX of a sheet to MathML, which browsers can display."""

from functools import cache

from latex2mathml.converter import convert
from markupsafe import Markup

_ASTERISK, _OPERATOR = "<mo>&#x0002A;</mo>", "<mo>&#x02217;</mo>"
"""The star of the keyboard, which fonts raise, and the star that TeX sets in a formula."""


@cache
def mathml(latex: str, display: str = "block") -> Markup:
    """One formula as MathML; `display` is "inline" for a formula within a line of text."""
    formula = convert(latex, display=display)  # the LaTeX is never the input of a user
    return Markup(formula.replace(_ASTERISK, _OPERATOR))
