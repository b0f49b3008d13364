"""Say in words what was found: verdicts, evidence, corrections, signs; explain one claim.

Printed and corrected equations are always rendered from their expressions.
"""

import json
import re
from collections import Counter
from collections.abc import Iterable, Sequence

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
    Verdict.CONVENTION: "the opposite sign",
    Verdict.FAILS: "neither",
}
_SHOWN = 6
"""The number of points that an explanation shows."""


# ------------------------------------------------------------------ equations


def printed(claim: Claim) -> str:
    """Return the printed equation as text, or an empty string if the claim has none."""
    return claim.printed.text or ("" if claim.unchecked else _text(claim.meant))


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


def evidence(finding: Finding) -> str:
    """Return the evidence for the verdict, in one paragraph."""
    claim = finding.claim
    parts = [f"its units do not fit: {claim.units}"] if claim.units else []
    if claim.unchecked:
        return "; ".join([*parts, finding.judged.why])
    parts += [
        f"compared with {claim.expected.against}: {finding.judged.why}",
        *_convention(finding),
    ]
    return "; ".join(filter(None, [*parts, finding.partly, *_search(finding)]))


def _convention(finding: Finding) -> list[str]:
    if finding.convention is None or finding.under is None:
        return []
    return [
        f"with {finding.convention.what}: {finding.under.why}",
        f"this contradicts {finding.convention.contradicts}",
    ]


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


def description(claim: Claim) -> str:
    """Return what the claim says, and its place if its name does not tell it."""
    return (
        claim.printed.says
        if claim.name == claim.printed.place
        else f"{claim.printed.says} ({claim.printed.place})"
    )


def explanation(finding: Finding) -> list[tuple[str, list[str]]]:
    """Return headings with their lines: what was compared, how, and with which result."""
    claim = finding.claim
    sides = (
        *claim.meant.sides(claim.meant.left, claim.meant.right),
        claim.meant.left,
        claim.meant.right,
    )
    held = set().union(*(side.free_symbols for side in sides))
    searched = [line for part in _search(finding) for line in lines_of(part)]
    if finding.tried and finding.repair is None:
        searched.append("none of them is true")
    entries = [
        ("description", [claim.printed.says]),
        ("place", [claim.printed.place] if claim.printed.place != claim.name else []),
        ("printed", [printed(claim) or "no equation"]),
        ("compared with", [claim.expected.against]),
        ("steps", claim.expected.steps),
        (
            "symbols",
            [f"{s} = {text_of(expr)}" for s, expr in claim.meant.meaning.items() if s in held],
        ),
        ("verdict", [str(finding.verdict), *lines_of(finding.judged.why), finding.partly]),
        ("convention", _convention(finding)),
        ("corrected", [corrected(finding) or "", *searched]),
        ("consequence", claim.consequences),
    ]
    return [(heading, list(filter(None, lines))) for heading, lines in entries if any(lines)]


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


def unexpected(findings: Iterable[Finding]) -> list[Finding]:
    """Return the findings whose verdicts differ from the expected ones.

    Without an expected verdict, a finding is unexpected if the claim does not hold.
    """
    return [finding for finding in findings if not finding.as_expected]


def errata(findings: Iterable[Finding]) -> list[Finding]:
    """Return the findings for claims that are not true as printed."""
    wrong = (Verdict.CONVENTION, Verdict.FAILS)
    return [finding for finding in findings if finding.verdict in wrong]


def remarks(findings: Iterable[Finding]) -> list[tuple[Finding, str]]:
    """Return one line for each claim that is not true as printed, is unchecked, or mixes units."""
    lines = []
    for finding in findings:
        parts = [f"its units do not fit, {finding.claim.units}"] if finding.claim.units else []
        if finding.verdict == Verdict.UNCHECKED:
            parts.append(finding.judged.why)
        elif finding.convention is not None:
            parts.append(f"true with {finding.convention.what}")
        elif finding.verdict == Verdict.FAILS:
            stopped = finding.stopped and f"the search for a correction: {finding.stopped}"
            found = corrected(finding)
            told = f"correct is {found}" if found else finding.diagnosis
            told = told or ("" if stopped else "no correction was found")
            parts += [told, stopped, finding.partly]
        if parts:
            lines.append((finding, "; ".join(filter(None, parts))))
    return lines


def signs(paper: Paper, findings: Iterable[Finding]) -> list[str]:
    """List the places in the paper that give a quantity one sign, the opposite one or neither."""
    by_label = {finding.claim.printed.label: finding for finding in findings}
    lines = []
    for quantity, labels in paper.signs.items():
        senses: dict[str, list[str]] = {}
        for finding in (by_label[label] for label in labels if label in by_label):
            sense = _SENSES.get(finding.verdict, "unchecked")
            senses.setdefault(sense, []).append(finding.claim.printed.place)
        if senses:
            by_sense = "; ".join(f"{sense} in {', '.join(p)}" for sense, p in senses.items())
            lines.append(f"{quantity}: {by_sense}")
    return lines


def as_json(paper: Paper, findings: Iterable[Finding]) -> str:
    """Return the findings as a JSON list with one object for each claim."""
    objects = [
        {
            "label": finding.claim.printed.label,
            "place": finding.claim.printed.place,
            "equation": finding.claim.printed.equation or None,
            "says": finding.claim.printed.says,
            "verdict": str(finding.verdict),
            "expected": finding.as_expected,
            "printed": printed(finding.claim),
            "corrected": corrected(finding),
            "diagnosis": finding.diagnosis or None,
            "units": finding.claim.units or None,
            "evidence": evidence(finding),
            "reason": finding.judged.why,
            "consequence": finding.claim.expected.consequence or None,
        }
        for finding in findings
    ]
    return json.dumps(objects, indent=2, ensure_ascii=False)
