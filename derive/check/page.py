"""Render findings as one HTML page that can be printed or sent to a colleague or a journal.

The page is self-contained.  If latex2mathml is installed, LaTeX is typeset as MathML.  Its output
is used only if it is plain MathML, because the text of a paper could contain anything.
"""

import re
from collections.abc import Sequence
from html import escape
from xml.etree import ElementTree

import mpmath
from sympy import Expr, Symbol

from derive.check.claim import Claim, Paper, Point, Verdict
from derive.check.draw import has_integral, is_allowed
from derive.check.report import (
    as_displayed,
    corrected,
    description,
    evidence,
    lines_of,
    printed,
    signs,
    summary,
)
from derive.check.verdict import Finding, Repair
from derive.proof.values import Undecided, evaluated

_STYLE = """
body { font: 16px/1.45 Georgia, serif; max-width: 60rem; margin: 2rem auto; padding: 0 1rem; }
table { border-collapse: collapse; width: 100%; } td, th { text-align: left; padding: .2rem .6rem; }
tr + tr td { border-top: 1px solid #ddd; } code { font-size: .85rem; overflow-wrap: anywhere; }
section { border-top: 2px solid #999; margin-top: 1.5rem; break-inside: avoid; }
dt { color: #666; } dd { margin: 0 0 .5rem 1.5rem; padding: .2rem 0; overflow: auto hidden; }
math { font-size: 1.1rem; font-family: "Latin Modern Math", "STIX Two Math", "Cambria Math", math; }
.fails, .convention { color: #b00020; } .holds, .numerical, .by { color: #1b6e2d; }
.unchecked { color: #8a6100; } svg { max-width: 26rem; width: 100%; }
"""
_TAGS = re.compile(r"\{http://www\.w3\.org/1998/Math/MathML\}m[a-z]+")
_FOR_THE_EYE = re.compile(
    r"\\(?:label|tag\*?)\s*\{[^{}]*\}|\\(?:nonumber|notag|displaystyle)(?![A-Za-z])"
)
_SAMPLES = 41
"""Number of intervals into which the range of a curve is divided."""


def as_html(paper: Paper, findings: Sequence[Finding]) -> str:
    """Return the page: a summary, then every claim with its evidence."""
    title = escape(paper.title)
    rows = "".join(
        f'<tr><td><a href="#c{n}">{escape(each.claim.name)}</a></td>'
        f"<td>{escape(description(each.claim))}</td>{_verdict(each, 'td')}</tr>\n"
        for n, each in enumerate(findings)
    )
    sign_items = "".join(f"<li>{escape(line)}</li>" for line in signs(paper, findings))
    return (
        f'<!doctype html>\n<html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        '<meta name="generator" content="derive check --html">'
        f"<title>{title}</title><style>{_STYLE}</style></head><body>\n<h1>{title}</h1>\n"
        f"<p>{escape(summary(findings))}.</p>\n"
        f"<table><tr><th>claim</th><th>description</th><th>verdict</th></tr>\n{rows}</table>\n"
        + (f"<h2>Signs, section by section</h2><ul>{sign_items}</ul>\n" if sign_items else "")
        + "".join(_section(n, each) for n, each in enumerate(findings))
        + "</body></html>\n"
    )


def _verdict(finding: Finding, tag: str) -> str:
    seen = "" if finding.as_expected else ", not as expected"
    kind = str(finding.verdict).split()[0]
    return f'<{tag} class="{kind}">{escape(str(finding.verdict))}{seen}</{tag}>'


def _section(number: int, finding: Finding) -> str:
    claim, repair = finding.claim, finding.repair
    entries = [
        (
            "printed",
            _typeset(claim.printed.latex)
            if claim.printed.latex
            else _equation(claim, printed(claim)),
        ),
        ("understood", _code(printed(claim)) if claim.printed.latex else ""),
        ("units", escape(claim.units)),
        ("corrected", _equation(repair, corrected(finding) or "") if repair else ""),
        ("ratio of sides", escape(finding.diagnosis)),
        ("evidence", _lines(lines_of(evidence(finding)))),
        ("consequence", _lines(finding.claim.consequences)),
        ("both sides", _curves(finding)),
    ]
    small = (
        f" <small>{escape(claim.printed.place)}</small>"
        if claim.printed.place != claim.name
        else ""
    )
    listed = "".join(f"<dt>{head}</dt><dd>{text}</dd>\n" for head, text in entries if text)
    return (
        f'<section id="c{number}"><h3>{escape(claim.name)}'
        f"{small}</h3>\n<p>{escape(claim.printed.says)}: "
        f"{_verdict(finding, 'b')}</p>\n<dl>{listed}</dl></section>\n"
    )


def _lines(lines: Sequence[str]) -> str:
    return "<br>".join(map(escape, lines))


def _equation(equation: Claim | Repair, text: str) -> str:
    """Return an equation as MathML, and below it as text, which keeps its form."""
    is_read = isinstance(equation, Repair) or not equation.unchecked
    return (
        _typeset(as_displayed(equation if isinstance(equation, Repair) else equation.meant))
        if text and is_read
        else ""
    ) + _code(text)


def _code(text: str) -> str:
    return f"<code>{escape(text)}</code>" if text else ""


def _typeset(latex: str) -> str:
    """Return LaTeX as MathML, or as code if it cannot be typeset."""
    plain = " ".join(_FOR_THE_EYE.sub(" ", latex).split())
    prepared = plain.replace(r"\mbox", r"\text").replace(r"\nicefrac", r"\frac")
    if r"\begin" not in prepared:
        prepared = prepared.replace("&", " ").replace(r"\\", r"\qquad ")
    try:
        from derive.sheet.mathml import mathml

        formula = str(mathml(prepared))
        tree = ElementTree.fromstring(formula)
    except Exception:  # fall back to the source text, whatever the paper contains
        return _code(plain)
    return formula if all(_is_plain(each) for each in tree.iter()) else _code(plain)


def _is_plain(element: ElementTree.Element) -> bool:
    """Whether an element is MathML that neither runs scripts nor loads resources."""
    safe = all(not name.startswith("on") and "href" not in name for name in element.attrib)
    return safe and isinstance(element.tag, str) and _TAGS.fullmatch(element.tag) is not None


# ------------------------------------------------------------------ both sides as curves


def _curves(finding: Finding) -> str:
    """Plot both sides along one variable if the claim fails and contains no integral."""
    claim, pairs = finding.claim, finding.judged.pairs
    if finding.verdict != Verdict.FAILS or not pairs or has_integral(claim):
        return ""
    sides = [
        side.xreplace(dict(claim.meant.meaning))
        for side in claim.meant.sides(claim.meant.left, claim.meant.right)
    ]
    point = pairs[-1].point
    held = set().union(*(side.free_symbols for side in sides)) & set(point)
    for symbol in sorted(held, key=lambda s: (bool(s.is_positive), s.name)):
        lines = [_line(finding, side, symbol, point) for side in sides]
        if all(len(line) > _SAMPLES // 2 for line in lines):
            return _picture(symbol.name, lines)
    return ""


def _line(finding: Finding, side: Expr, symbol: Symbol, point: Point) -> list[tuple[float, float]]:
    """Return the real values of one side along one variable.

    The variable runs over its range, or from half to twice its value at `point`.
    """
    span = finding.claim.meant.ranges.get(symbol)
    low, high = (float(point[symbol]) * part for part in (0.5, 2))
    if span is not None and not span.powers:
        low, high = span.low, span.high
    values = []
    for n in range(1, _SAMPLES):
        at = {**point, symbol: mpmath.mpf(low + (high - low) * n / _SAMPLES)}
        try:
            value = evaluated(side, at)
        except Undecided:
            continue
        if mpmath.im(value) == 0 and mpmath.isfinite(value) and is_allowed(finding.claim, at):
            values.append((float(at[symbol]), float(mpmath.re(value))))
    return values


def _picture(name: str, lines: list[list[tuple[float, float]]]) -> str:
    """Draw two curves in a frame, the left side solid and the right side dashed."""
    vertices = [vertex for line in lines for vertex in line]
    (left, right), (low, high) = ((min(v), max(v)) for v in zip(*vertices, strict=True))
    wide, tall = (right - left) or 1.0, (high - low) or 1.0
    drawn = ""
    for line, dash in zip(lines, ("", ' stroke-dasharray="6 4"'), strict=True):
        polyline = " ".join(
            f"{20 + 360 * (x - left) / wide:.1f},{190 - 170 * (y - low) / tall:.1f}"
            for x, y in line
        )
        drawn += f'<polyline fill="none" stroke="#333" points="{polyline}"{dash}/>'
    ticks = "".join(
        f'<text x="{x}" y="{y}" font-size="11" text-anchor="{anchor}">{words}</text>'
        for x, y, anchor, words in (
            *((20, 205, "start", f"{left:.3g}"), (380, 205, "end", f"{right:.3g}")),
            *((24, 34, "start", f"{high:.3g}"), (24, 184, "start", f"{low:.3g}")),
            (200, 205, "middle", escape(name)),
        )
    )
    return (
        f'<svg viewBox="0 0 400 215"><rect x="20" y="20" width="360" height="170" fill="none" '
        f'stroke="#bbb"/>{drawn}{ticks}</svg><br>left side solid, right side dashed'
    )
