"""Findings as one page of HTML, to be sent to a colleague or a journal, or printed.

The page holds all that it needs.  LaTeX is typeset as MathML where latex2mathml is installed; what
comes of it is taken only if it is plain MathML, as a paper's text could hold anything.
"""

import re
from collections.abc import Sequence
from html import escape
from importlib.util import find_spec
from xml.etree import ElementTree

import mpmath
from sympy import Expr, Symbol

from derive.paper.claim import Paper, Point, Verdict
from derive.paper.draw import has_integral, is_allowed
from derive.paper.report import (
    as_displayed,
    corrected,
    evidence,
    printed,
    signs,
    summary,
)
from derive.paper.values import Undecided, evaluated
from derive.paper.verdict import Finding

_STYLE = """
body { font: 16px/1.45 Georgia, serif; max-width: 60rem; margin: 2rem auto; padding: 0 1rem; }
table { border-collapse: collapse; width: 100%; } td, th { text-align: left; padding: .2rem .6rem; }
tr + tr td { border-top: 1px solid #ddd; } code { font-size: .85rem; overflow-wrap: anywhere; }
section { border-top: 2px solid #999; margin-top: 1.5rem; break-inside: avoid; }
dt { color: #666; } dd { margin: 0 0 .5rem 1.5rem; } math { font-size: 1.1rem; }
.fails, .convention { color: #b00020; } .holds, .numerical, .by { color: #1b6e2d; }
.unchecked { color: #8a6100; } svg { max-width: 26rem; }
"""
_TAGS = re.compile(r"\{http://www\.w3\.org/1998/Math/MathML\}m[a-z]+")
_FOR_THE_EYE = re.compile(
    r"\\(?:label|tag\*?)\s*\{[^{}]*\}|\\(?:nonumber|notag|displaystyle)(?![A-Za-z])"
)
_SAMPLES = 41
"""Points of a curve."""


def as_html(paper: Paper, findings: Sequence[Finding]) -> str:
    """The page: a summary, then every claim with its reasons."""
    title = escape(paper.title)
    rows = "".join(
        f'<tr><td><a href="#c{n}">{escape(each.claim.label)}</a></td>'
        f"<td>{escape(each.claim.place)}</td>{_verdict(each, 'td')}</tr>\n"
        for n, each in enumerate(findings)
    )
    told = "".join(f"<li>{escape(line)}</li>" for line in signs(paper, findings))
    return (
        f'<!doctype html>\n<html lang="en"><head><meta charset="utf-8"><title>{title}</title>'
        f"<style>{_STYLE}</style></head><body>\n<h1>{title}</h1>\n"
        f"<p>{escape(summary(findings))}.</p>\n"
        f"<table><tr><th>claim</th><th>place</th><th>verdict</th></tr>\n{rows}</table>\n"
        + (f"<h2>Signs, section by section</h2><ul>{told}</ul>\n" if told else "")
        + "".join(_section(n, each) for n, each in enumerate(findings))
        + "</body></html>\n"
    )


def _verdict(finding: Finding, tag: str) -> str:
    seen = "" if finding.as_expected else ", not as expected"
    kind = str(finding.verdict).split()[0]
    return f'<{tag} class="{kind}">{escape(str(finding.verdict))}{seen}</{tag}>'


def _section(number: int, finding: Finding) -> str:
    claim, repair = finding.claim, finding.repair
    told = corrected(finding)
    entries = [
        ("printed", _typeset(claim.latex) if claim.latex else ""),
        ("understood" if claim.latex else "printed", _code(printed(claim))),
        ("units", escape(claim.units)),
        ("corrected", _typeset(as_displayed(repair)) + _code(told) if repair and told else ""),
        ("differs by", escape(finding.diagnosis)),
        ("evidence", escape(evidence(finding))),
        ("consequence", escape(finding.claim.consequence)),
        ("both sides", _curves(finding)),
    ]
    listed = "".join(f"<dt>{head}</dt><dd>{text}</dd>\n" for head, text in entries if text)
    return (
        f'<section id="c{number}"><h3>{escape(claim.label)} '
        f"<small>{escape(claim.place)}</small></h3>\n<p>{escape(claim.says)}: "
        f"{_verdict(finding, 'b')}</p>\n<dl>{listed}</dl></section>\n"
    )


def _code(text: str) -> str:
    return f"<code>{escape(text)}</code>" if text else ""


def _typeset(latex: str) -> str:
    """LaTeX as MathML, or as it stands where that is not to be had."""
    plain = " ".join(_FOR_THE_EYE.sub(" ", latex).split())
    if find_spec("latex2mathml") is not None:
        from latex2mathml.converter import convert

        ready = plain.replace(r"\mbox", r"\text").replace(r"\nicefrac", r"\frac")
        if r"\begin" not in ready:
            ready = ready.replace("&", " ").replace(r"\\", r"\qquad ")
        try:
            made = str(convert(ready, display="block"))
            tree = ElementTree.fromstring(made)
        except Exception:  # whatever a paper holds, its text is shown
            return _code(plain)
        if all(_is_plain(each) for each in tree.iter()):
            return made
    return _code(plain)


def _is_plain(element: ElementTree.Element) -> bool:
    """Whether an element is MathML that neither runs nor fetches anything."""
    safe = all(not name.startswith("on") and "href" not in name for name in element.attrib)
    return safe and isinstance(element.tag, str) and _TAGS.fullmatch(element.tag) is not None


# ------------------------------------------------------------------ both sides as curves


def _curves(finding: Finding) -> str:
    """Both sides along one variable, where the claim fails and they are quick to compute."""
    claim, pairs = finding.claim, finding.judged.pairs
    if finding.verdict != Verdict.FAILS or not pairs or has_integral(claim):
        return ""
    sides = [side.xreplace(dict(claim.meaning)) for side in claim.sides(claim.left, claim.right)]
    point = pairs[-1].point
    held = set().union(*(side.free_symbols for side in sides)) & set(point)
    for symbol in sorted(held, key=lambda s: (bool(s.is_positive), s.name)):
        lines = [_line(finding, side, symbol, point) for side in sides]
        if all(len(line) > _SAMPLES // 2 for line in lines):
            return _picture(symbol.name, lines)
    return ""


def _line(finding: Finding, side: Expr, symbol: Symbol, point: Point) -> list[tuple[float, float]]:
    """Real values of a side along a variable, from half of where it was looked at to twice."""
    span = finding.claim.ranges.get(symbol)
    low, high = (float(point[symbol]) * part for part in (0.5, 2))
    if span is not None and not span.powers:
        low, high = span.low, span.high
    found = []
    for n in range(1, _SAMPLES):
        place = {**point, symbol: mpmath.mpf(low + (high - low) * n / _SAMPLES)}
        try:
            value = evaluated(side, place)
        except Undecided:
            continue
        if mpmath.im(value) == 0 and mpmath.isfinite(value) and is_allowed(finding.claim, place):
            found.append((float(place[symbol]), float(mpmath.re(value))))
    return found


def _picture(name: str, lines: list[list[tuple[float, float]]]) -> str:
    """Two curves in a frame, the left side full and the right one dashed."""
    every = [place for line in lines for place in line]
    (left, right), (low, high) = ((min(v), max(v)) for v in zip(*every, strict=True))
    wide, tall = (right - left) or 1.0, (high - low) or 1.0
    drawn = ""
    for line, dash in zip(lines, ("", ' stroke-dasharray="6 4"'), strict=True):
        places = " ".join(
            f"{20 + 360 * (x - left) / wide:.1f},{190 - 170 * (y - low) / tall:.1f}"
            for x, y in line
        )
        drawn += f'<polyline fill="none" stroke="#333" points="{places}"{dash}/>'
    words = f"{escape(name)} from {left:.3g} to {right:.3g}; values from {low:.3g} to {high:.3g}"
    return (
        f'<svg viewBox="0 0 400 220"><rect x="20" y="20" width="360" height="170" fill="none" '
        f'stroke="#bbb"/>{drawn}<text x="20" y="212" font-size="12">{words}; left side full, '
        f"right side dashed</text></svg>"
    )
