"""Render findings by templates: a Markdown or LaTeX document, or an HTML page.

All text is escaped in the way of the document, because a paper could contain anything.  The page is
self-contained.
"""

import html
import re
from collections.abc import Callable, Sequence
from functools import cache, partial

import jinja2
from markupsafe import Markup, escape

from derive.check import report
from derive.check.claim import Paper
from derive.check.verdict import Finding
from derive.sheet.page import templates

_HIDDEN = re.compile(r"\\(?:label|tag\*?)\s*\{[^{}]*\}|\\(?:nonumber|notag)(?![A-Za-z])")
"""Parts of a display that are not part of the formula."""
_INNER = re.compile(r"\\begin\b.*\\end\s*\{\w+\*?\}", re.DOTALL)
"""An environment inside a display."""


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
    made.filters |= {"code": _as_code, "typeset": _typeset, "verbatim": Markup}
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
