"""Render findings by templates: a Markdown or LaTeX document, or an HTML page.

The page is self-contained.  LaTeX is typeset as MathML, of which only plain MathML is used, because
the text of a paper could contain anything.
"""

import re
from collections.abc import Callable, Sequence
from functools import cache, partial
from xml.etree import ElementTree

import jinja2
import numpy as np
from markupsafe import Markup

from derive.check import report
from derive.check.claim import Claim, Paper, Verdict
from derive.check.correction import Repair
from derive.check.draw import along, has_integral, is_allowed
from derive.check.judge import Sides
from derive.check.verdict import Finding

_TAGS = re.compile(r"\{http://www\.w3\.org/1998/Math/MathML\}m[a-z]+")
_FOR_THE_EYE = re.compile(
    r"\\(?:label|tag\*?)\s*\{[^{}]*\}|\\(?:nonumber|notag|displaystyle)(?![A-Za-z])"
)
_SAMPLES = 40
"""Number of points of a curve."""


def _document(name: str, paper: Paper, findings: Sequence[Finding]) -> str:
    """Return all verdicts, the signs section by section, and the errata or every claim."""
    template = _templates().get_template(name)
    return template.render(paper=paper, findings=findings, report=report)


@cache
def _templates() -> jinja2.Environment:
    templates = jinja2.Environment(
        loader=jinja2.PackageLoader("derive.check"),
        autoescape=lambda name: bool(name and name.endswith(".html")),
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )
    templates.filters |= {
        "cell": lambda text: text.replace("|", r"\|"),
        "curves": _curves,
        "latex": _latex,
        "tex": report.in_latex,
        "typeset": _typeset,
    }
    return templates


as_html = partial(_document, "report.html")
"""Return the findings as a page: a summary, then every claim with its evidence."""

FORMS: dict[str, Callable[[Paper, Sequence[Finding]], str]] = {
    "json": report.as_json,
    "markdown": partial(_document, "report.md"),
    "latex": partial(_document, "report.tex"),
    "html": as_html,
}
"""The functions that write all findings as text."""


def _latex(equation: Claim | Repair) -> str:
    """Return an equation in LaTeX, or as it was given if it could not be read."""
    if isinstance(equation, Claim) and equation.unchecked:
        return " ".join(equation.printed.latex.split())
    meant = equation.meant if isinstance(equation, Claim) else equation
    return report.latex_of_equation(meant, meant.relation)


def _typeset(latex: str) -> Markup:
    """Return LaTeX as MathML, or as code if it cannot be typeset."""
    plain = " ".join(_FOR_THE_EYE.sub(" ", latex).split())
    prepared = plain.replace(r"\mbox", r"\text").replace(r"\nicefrac", r"\frac")
    if r"\begin" not in prepared:
        prepared = prepared.replace("&", " ").replace(r"\\", r"\qquad ")
    try:
        from derive.sheet.mathml import mathml

        formula = str(mathml(prepared))
        if all(_is_plain(each) for each in ElementTree.fromstring(formula).iter()):
            return Markup(formula)
    except Exception:  # there is no converter, or it fails on what a paper may contain
        pass
    return Markup("<code>{}</code>").format(plain)


def _is_plain(element: ElementTree.Element) -> bool:
    """Whether an element is MathML that neither runs scripts nor loads resources."""
    safe = all(not name.startswith("on") and "href" not in name for name in element.attrib)
    return safe and isinstance(element.tag, str) and _TAGS.fullmatch(element.tag) is not None


def _curves(finding: Finding) -> Markup | str:
    """Plot both sides along one variable if the claim fails and contains no integral.

    The variable runs over its range, or from half to twice its value at the last point.
    """
    from derive.sheet.picture import Line, svg

    claim, pairs = finding.claim, finding.judged.pairs
    if finding.verdict != Verdict.FAILS or not pairs or has_integral(claim):
        return ""
    sides = Sides(
        claim, *claim.meant.sides(claim.meant.left, claim.meant.right), claim.meant.meaning
    ).in_variables
    point = pairs[-1].point
    held = set().union(*(side.free_symbols for side in sides)) & set(point)
    for symbol in sorted(held, key=lambda s: (bool(s.is_positive), s.name)):
        span = claim.meant.ranges.get(symbol)
        near = (float(point[symbol]) / 2, float(point[symbol]) * 2)
        ends = near if span is None or span.powers else (span.low, span.high)
        across = np.linspace(*ends, _SAMPLES + 2)[1:-1]
        shown = np.array([is_allowed(claim, point | {symbol: value}) for value in across])
        curves = [along(side, symbol, point, across) for side in sides]
        kept = [shown & np.isfinite(curve) for curve in curves]
        if all(np.count_nonzero(each) > _SAMPLES // 2 for each in kept):
            lines = [Line("", across[k], c[k]) for k, c in zip(kept, curves, strict=True)]
            picture = Markup(svg("both sides", symbol.name, "", lines))
            return picture + Markup("<br>left side solid, right side dashed")
    return ""
