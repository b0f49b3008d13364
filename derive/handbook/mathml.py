"""Converts the LaTeX of a sheet to MathML, which browsers can display."""

from functools import cache

from latex2mathml.converter import convert
from markupsafe import Markup


@cache
def mathml(latex: str, display: str = "block") -> Markup:
    """One formula as MathML; `display` is "inline" for a formula within a line of text."""
    return Markup(convert(latex, display=display))  # the LaTeX is never the input of a user
