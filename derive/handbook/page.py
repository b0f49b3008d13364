"""One page of the handbook for one body, and the index of several."""

from collections.abc import Sequence
from functools import cache

import jinja2
from markupsafe import Markup
from pygments import highlight
from pygments.formatters import HtmlFormatter
from pygments.lexers import PythonLexer

from derive.handbook.curves import pictures, profile
from derive.sheet.built import BuiltBody
from derive.sheet.formulas import FormulaSheet
from derive.sheet.mathml import mathml
from derive.sheet.notation import latex_of
from derive.sheet.page import templates
from derive.sheet.prose import unit


def page(sheet: FormulaSheet, body: BuiltBody, index: bool = False) -> str:
    """The page of one body, from its proven sheet.

    index: whether the page belongs to a set with an index, to which it links

    Raises NotProven for a formula without a proof.
    """
    return (
        _templates()
        .get_template("page.html")
        .render(
            sheet=sheet.demand_proven(),
            figures=figures(sheet, body),
            code=_code(body.text),
            lines=body.text.count("\n"),
            style=_style(),
            index=index,
        )
    )


def figures(sheet: FormulaSheet, body: BuiltBody) -> Markup:
    """The profile and the pressure of one body, with captions; figures.css contains the style."""
    template = _templates().get_template("figures.html")
    return Markup(template.render(pictures(sheet, body)))


def card(sheet: FormulaSheet, body: BuiltBody) -> Markup:
    """The entry of a body in the index."""
    template = _templates().get_template("card.html")
    return Markup(template.render(sheet=sheet, body=body, sketch=profile(sheet)))


def index_of(cards: Sequence[Markup]) -> str:
    """The page with links to all others; the page of a body `name` is name.html."""
    return _templates().get_template("index.html").render(cards=cards, style=_style())


def _code(text: str) -> Markup:
    """Python code as HTML, with the classes that the style colours."""
    return Markup(highlight(text, PythonLexer(), HtmlFormatter(nowrap=True)))  # escapes the text


def _style() -> Markup:
    """The style sheet of all pages, with the colours of code on light and dark pages."""
    own = _templates().get_template("style.css").render()
    light, dark = (
        HtmlFormatter(style=name).get_style_defs(".code") for name in ("default", "github-dark")
    )
    return Markup(f"{own}\n{light}\n@media (prefers-color-scheme: dark) {{\n{dark}\n}}\n")


@cache
def _templates() -> jinja2.Environment:
    made = templates("derive.handbook", "show")
    made.filters |= {
        "latex": latex_of,
        "mathml": mathml,
        "unit": lambda text: Markup(unit(text)),
    }
    return made
