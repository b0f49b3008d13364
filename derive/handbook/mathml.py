"""Formulas as browsers draw them, from the LaTeX that the sheet renders."""

from functools import cache

from latex2mathml.converter import convert
from markupsafe import Markup


@cache
def mathml(latex: str, display: str = "block") -> Markup:
    """One formula; display "inline" for one in a line of text."""
    return Markup(convert(latex, display=display))  # its input is the notation's, never a user's
