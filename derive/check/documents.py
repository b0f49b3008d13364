"""Render findings by templates: a Markdown or LaTeX document, or an HTML page.

All text is escaped in the way of the document, because a paper could contain anything.  The page is
self-contained.
"""

import html
import re
from collections.abc import Callable, Sequence
from functools import cache, partial

import jinja2
import numpy as np
from markupsafe import Markup, escape

from derive.check import report
from derive.check.claim import Paper, Verdict
from derive.check.draw import along, has_integral, is_allowed
from derive.check.sides import Sides
from derive.check.verdict import Finding
from derive.sheet.page import templates

_HIDDEN = re.compile(r"\\(?:label|tag\*?)\s*\{[^{}]*\}|\\(?:nonumber|notag)(?![A-Za-z])")
"""Parts of a display that are not part of the formula."""
_INNER = re.compile(r"\\begin\b.*\\end\s*\{\w+\*?\}", re.DOTALL)
"""An environment inside a display."""
_SAMPLES = 40
"""Number of points of a curve."""


def in_markdown(text: str) -> str:
    """Escape text for Markdown.

    >>> print(in_markdown("a_1 < b|c"))
    a\\_1 &lt; b\\|c
    """
    return re.sub(r"([\\`*_\[\]|#~$])", r"\\\1", html.escape(text, quote=False))


def _in_one_line(text: object, escaped: Callable[[str], str]) -> Markup:
    return text if isinstance(text, Markup) else Markup(escaped(" ".join(str(text).split())))


def _as_code(text: str) -> Markup:
    return Markup("`" + text.replace("`", "'") + "`")


_ESCAPES: dict[str, Callable[[str], str]] = {
    "report.md": in_markdown,
    "report.tex": report.in_latex,
    "report.html": escape,
}


@cache
def _template(name: str) -> jinja2.Template:
    escaped = partial(_in_one_line, escaped=_ESCAPES[name])
    made = templates("derive.check", "check", finalize=escaped, keep_trailing_newline=True)
    made.filters |= {
        "code": _as_code,
        "curves": _curves,
        "typeset": _typeset,
        "verbatim": Markup,
    }
    return made.get_template(name)


def _document(name: str, paper: Paper, findings: Sequence[Finding]) -> str:
    """Return the coverage, the meanings used, all verdicts, and the claims, failures first."""
    return _template(name).render(paper=paper, findings=report.in_order(findings), report=report)


FORMS: dict[str, Callable[[Paper, Sequence[Finding]], str]] = {
    "json": report.as_json,
    "markdown": partial(_document, "report.md"),
    "latex": partial(_document, "report.tex"),
    "html": partial(_document, "report.html"),
}
"""The functions that write all findings as text."""


def _typeset(latex: str, display: str = "block") -> Markup:
    """Return LaTeX as MathML, or nothing if it cannot be typeset; its text is shown beside it."""
    if not latex:
        return Markup()
    bare = _HIDDEN.sub("", latex)
    if re.search(r"&|\\\\", _INNER.sub("", bare)):
        bare = rf"\begin{{aligned}}{bare}\end{{aligned}}"
    try:
        from derive.sheet.mathml import mathml

        return mathml(bare, display)
    except Exception:  # there is no converter, or it fails
        return Markup()


def _curves(finding: Finding) -> Markup | str:
    """Plot both sides along one variable if the claim fails and contains no integral.

    The variable runs over its range, or from half to twice its value at the last point.
    """
    from derive.sheet.picture import Line, svg

    claim, pairs = finding.claim, finding.judged.pairs
    if finding.verdict != Verdict.FAILS or not pairs or has_integral(claim):
        return ""
    sides = Sides.printed(claim).in_variables
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
            return Markup(svg("both sides", symbol.name, "", lines))
    return ""
