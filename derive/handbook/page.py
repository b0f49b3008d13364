"""One page of the handbook for one body, and the index of several."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cache
from typing import NamedTuple

import jinja2
from markupsafe import Markup
from pygments import highlight
from pygments.formatters import HtmlFormatter
from pygments.lexers import PythonLexer

from derive.body import Body
from derive.errors import NotProven
from derive.handbook.curves import pictures, profile
from derive.handbook.mathml import mathml
from derive.handbook.prose import prose
from derive.notation import latex_of
from derive.proof.verdict import Verdict
from derive.sheet import FormulaSheet

SHOWN = 40
"""Lines of a module from which on its code is folded away."""


class Row(NamedTuple):
    """One formula as a page shows it."""

    name: str
    meaning: str
    unit: str
    formula: Markup
    latex: str
    holds_if: tuple[Markup, ...]
    source: str
    verdict: Verdict
    proof: str


class Entry(NamedTuple):
    """One body as the index shows it."""

    name: str
    title: str
    profile: Markup
    sketch: Markup
    closed: tuple[str, ...]
    numerical: tuple[str, ...]
    formulas: int


def proven(sheet: FormulaSheet, body: Body) -> FormulaSheet:
    """The sheet without the closed forms whose proofs its body does not hold.

    The search for them has a limit: it may find now what it did not find as the body was built.
    All other formulas stay; `page` demands their proofs.
    """
    known = dict(body.proofs)
    lost = [name for name, formula in sheet.items() if formula.closes and name not in known]
    if not lost:
        return sheet
    kept = {name: formula for name, formula in sheet.items() if name not in lost}
    remark = f"{sheet.remark}  Not proven, and so not shown: {', '.join(lost)}."
    return replace(sheet, formulas=kept, remark=body.struck or remark)


def page(sheet: FormulaSheet, body: Body, index: bool = False) -> str:
    """The page of one body; `index`: whether the index of a set lies beside it.

    Raises NotProven for a formula of the sheet whose proof the body does not hold.
    """
    geometry = sheet.geometry
    symbols = [q for q in sheet.quantities if q not in geometry.parameters]
    defined = [
        (mathml(f"{latex_of(s)} = {latex_of(expr)}"), str(s))
        for s, expr in sheet.definitions.items()
    ]
    return (
        _templates()
        .get_template("page.html")
        .render(
            entry=entry(sheet, body),
            parameters=[(mathml(latex_of(p.symbol), "inline"), p) for p in geometry.parameters],
            symbols=[(mathml(latex_of(q.symbol), "inline"), q) for q in symbols],
            rows=list(_rows(sheet, dict(body.proofs))),
            defined=defined,
            pictures=pictures(sheet, body),
            remark=sheet.remark,
            code=_code(body.text),
            lines=body.text.count("\n"),
            style=_style(),
            index=index,
        )
    )


def index(entries: Sequence[Entry]) -> str:
    """The page that leads to all others; the page of `name` is name.html."""
    return _templates().get_template("index.html").render(entries=entries, style=_style())


def entry(sheet: FormulaSheet, body: Body) -> Entry:
    """What the index says of a body."""
    geometry = sheet.geometry
    return Entry(
        geometry.name,
        geometry.title,
        mathml(rf"g(x) = {latex_of(geometry.g)}"),
        profile(sheet),
        body.closed,
        body.numerical,
        len(sheet),
    )


def _rows(sheet: FormulaSheet, proofs: Mapping[str, str]) -> Iterator[Row]:
    for name, formula in sheet.items():
        if name not in proofs:
            raise NotProven(f"{name} of {sheet.geometry.name!r}: no proof came with its body")
        latex = f"{formula.left} = {latex_of(sheet.shown(name))}"
        conditions = tuple(mathml(latex_of(c), "inline") for c in formula.conditions)
        proof = proofs[name]
        verdict = Verdict(proof.partition(":")[0])
        yield Row(
            name,
            formula.meaning,
            formula.unit,
            mathml(latex),
            latex,
            conditions,
            formula.source,
            verdict,
            proof.partition(": ")[2],
        )


def _code(text: str) -> Markup:
    """Python with its words in colours; the classes are those of the style."""
    return Markup(highlight(text, PythonLexer(), HtmlFormatter(nowrap=True)))  # it escapes


def _style() -> Markup:
    """All that pages look like; the code's colours for a light and a dark page."""
    own = _templates().get_template("style.css").render()
    light, dark = (
        HtmlFormatter(style=name).get_style_defs(".code") for name in ("default", "github-dark")
    )
    return Markup(f"{own}\n{light}\n@media (prefers-color-scheme: dark) {{\n{dark}\n}}\n")


@cache
def _templates() -> jinja2.Environment:
    templates = jinja2.Environment(
        loader=jinja2.PackageLoader("derive.handbook"),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    templates.filters["prose"] = prose
    return templates
