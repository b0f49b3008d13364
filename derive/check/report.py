"""Say in words what was found: verdicts, evidence, corrections, signs; explain one claim.

Corrected equations are always rendered from their expressions.
"""

import json
import re
from collections import Counter
from collections.abc import Iterable, Sequence
from typing import NamedTuple

import mpmath
from sympy import Expr, Symbol

from derive.check.claim import AsMeant, Claim, Paper, Verdict
from derive.check.correction import Repair
from derive.check.verdict import Finding
from derive.reading.relation import Relation
from derive.sheet.notation import latex_of, text_of

_SIGNS = {"<=": r"\le", ">=": r"\ge", "~": r"\sim"}
_SENSES = {
    Verdict.HOLDS: "one sign",
    Verdict.NUMERICAL: "one sign",
    Verdict.DEFINITION: "one sign",
    Verdict.CONVENTION: "the opposite sign",
    Verdict.FAILS: "neither",
}
_SHOWN = 6
"""The number of points that an explanation shows."""


# ------------------------------------------------------------------ equations


def printed(claim: Claim) -> str:
    """Return the printed equation as text, or an empty string if the claim has none."""
    return claim.text or ("" if claim.unchecked else _text(claim.meant))


def corrected(finding: Finding) -> str | None:
    """Return the corrected equation as text, or None if none was found."""
    return _text(finding.repair) if finding.repair else None


def _text(equation: AsMeant | Repair) -> str:
    return f"{text_of(equation.left)} {equation.relation} {text_of(equation.right)}"


def latex_of_equation(equation: AsMeant | Repair, relation: Relation) -> str:
    """Return a printed or a corrected equation with the given relation, in LaTeX."""
    sign = _SIGNS.get(relation, relation)
    return rf"{_of(equation.left)} {sign} {_of(equation.right)}"


def _of(expr: Expr) -> str:
    """Return `expr` in LaTeX; a call of a formula, which has been given a symbol, stays a call."""
    calls = [symbol for symbol in expr.free_symbols if "(" in symbol.name]
    return latex_of(expr.xreplace({s: Symbol(rf"\mathtt{{{in_latex(s.name)}}}") for s in calls}))


def in_latex(text: str) -> str:
    """Escape text for LaTeX.

    >>> print(in_latex("a_1 & 5 %"), in_latex("x^2"))
    a\\_1 \\& 5 \\% x\\^{}2
    """
    escaped = re.sub(r"([_&%#${}])", r"\\\1", text.replace("\\", "\0"))
    return re.sub(r"([~^])", r"\\\1{}", escaped).replace("\0", r"\textbackslash ")


# ------------------------------------------------------------------ one claim


class Told(NamedTuple):
    """What is told of a claim under one heading; `latex` is the equation, if it is one."""

    name: str
    lines: list[str]
    latex: str = ""


def explanation(finding: Finding) -> list[Told]:
    """Return headings with their lines: what was compared, how, and with which result."""
    claim, repair = finding.claim, finding.repair
    entry, meant = claim.entry, claim.meant
    latex = "" if claim.unchecked else latex_of_equation(meant, meant.relation)
    sides = (*meant.compared, meant.left, meant.right)
    held = set().union(*(side.free_symbols for side in sides))
    symbols = [f"{s} = {text_of(expr)}" for s, expr in meant.meaning.items() if s in held]
    in_vain = "none of them is true" if finding.tried and repair is None else ""
    search = [line for part in _search(finding) for line in lines_of(part)]
    told = [
        Told("description", [entry.says]),
        Told("place", [entry.place] if entry.place != claim.name else []),
        Told("LaTeX", [" ".join(entry.latex.split())]),
        Told("printed", [printed(claim) or "no equation"], latex),
        Told("compared with", [claim.against]),
        Told("steps", entry.steps),
        Told("symbols", symbols),
        Told("verdict", [str(finding.verdict), *lines_of(finding.judged.why), finding.partly]),
        Told("rests on", [finding.rests_on]),
        Told("units", [claim.units]),
        Told("convention", _convention(finding)),
        Told("search", [*search, in_vain]),
        Told("consequence", claim.consequences),
    ]
    if repair is not None:
        latex = latex_of_equation(repair, repair.relation)
        told.insert(-2, Told("corrected", [_text(repair)], latex))
    return [each._replace(lines=lines) for each in told if (lines := [*filter(None, each.lines)])]


def evidence(finding: Finding) -> str:
    """Return the evidence for the verdict, in one paragraph."""
    claim = finding.claim
    compared = "" if claim.unchecked else f"compared with {claim.against}: "
    parts = [
        f"its units do not fit: {claim.units}" if claim.units else "",
        f"{compared}{finding.judged.why}",
        *_convention(finding),
        finding.partly,
        *_search(finding),
    ]
    rests_on = f"rests on {finding.rests_on}" if finding.rests_on else ""
    return "; ".join(filter(None, [*parts, rests_on]))


def _convention(finding: Finding) -> list[str]:
    if finding.convention is None or finding.under is None:
        return []
    return [f"with {finding.convention.what}: {finding.under.why}"]


def _search(finding: Finding) -> list[str]:
    """Return the result of the search for a correction."""
    parts, repair = [], finding.repair
    if repair:
        also = f", as would {' or '.join(repair.also)}" if repair.also else ""
        parts.append(f"corrected ({repair.change}{also}): {repair.judged.why}")
    if finding.diagnosis:
        parts.append(finding.diagnosis)
    if finding.tried:
        parts.append(f"{finding.tried} corrections tried")
    if finding.stopped:
        parts.append(f"the search for a correction: {finding.stopped}")
    return parts


def lines_of(text: str) -> list[str]:
    """Return the statements of a text, which semicolons outside parentheses separate."""
    return re.split(r"; (?![^(]*\))", text)


def numbers(finding: Finding) -> list[tuple[str, str, str]]:
    """Return the first points and the values of both sides there."""
    return [
        (
            ", ".join(f"{s} = {mpmath.nstr(v, 6)}" for s, v in pair.point.items()),
            *(mpmath.nstr(side, 16) for side in (pair.left, pair.right)),
        )
        for pair in finding.judged.pairs[:_SHOWN]
    ]


# ------------------------------------------------------------------ all claims


def summary(findings: Sequence[Finding]) -> str:
    """Return the number of claims for each verdict, in words: "3 claims: 1 holds, 2 fail"."""
    totals = Counter(finding.verdict for finding in findings)
    several = {Verdict.HOLDS: "hold", Verdict.FAILS: "fail"}
    counts = ", ".join(
        f"{totals[verdict]} {several.get(verdict, verdict) if totals[verdict] > 1 else verdict}"
        for verdict in Verdict
        if totals[verdict]
    )
    return f"{len(findings)} {'claim' if len(findings) == 1 else 'claims'}: {counts}"


def remark(finding: Finding) -> str:
    """Return what is to be done about a claim that is not true, is unchecked, or mixes units."""
    parts = [f"its units do not fit, {finding.claim.units}"] if finding.claim.units else []
    if finding.verdict == Verdict.UNCHECKED:
        parts.append(finding.judged.why)
    elif finding.convention is not None:
        parts.append(f"true with {finding.convention.what}")
    elif finding.verdict == Verdict.FAILS:
        stopped = finding.stopped and f"the search for a correction: {finding.stopped}"
        found = finding.diagnosis or ("" if stopped else "no correction was found")
        if finding.repair is not None:
            found = f"correct is {_text(finding.repair)}"
        parts += [found, stopped, finding.partly]
    return "; ".join(filter(None, parts))


def signs(paper: Paper, findings: Iterable[Finding]) -> list[str]:
    """List the places in the paper that give a quantity one sign, the opposite one or neither."""
    by_label = {finding.claim.entry.label: finding for finding in findings}
    lines = []
    for quantity, labels in paper.signs.items():
        senses: dict[str, list[str]] = {}
        for finding in (by_label[label] for label in labels if label in by_label):
            sense = _SENSES.get(finding.verdict, "unchecked")
            senses.setdefault(sense, []).append(finding.claim.entry.place)
        if senses:
            by_sense = "; ".join(f"{sense} in {', '.join(p)}" for sense, p in senses.items())
            lines.append(f"{quantity}: {by_sense}")
    return lines


def as_json(paper: Paper, findings: Iterable[Finding]) -> str:
    """Return the findings as a JSON list with one object for each claim."""
    objects = [
        {
            "label": finding.claim.entry.label,
            "place": finding.claim.entry.place,
            "equation": finding.claim.entry.equation or None,
            "says": finding.claim.entry.says,
            "verdict": str(finding.verdict),
            "expected": finding.as_expected,
            "rests_on": finding.basis,
            "given": {each.claim.entry.label: str(each.verdict) for each in finding.given},
            "printed": printed(finding.claim),
            "corrected": corrected(finding),
            "diagnosis": finding.diagnosis or None,
            "units": finding.claim.units or None,
            "evidence": evidence(finding),
            "reason": finding.judged.why,
            "consequence": finding.claim.entry.consequence or None,
        }
        for finding in findings
    ]
    return json.dumps(objects, indent=2, ensure_ascii=False)
