"""Say in words what was found: verdicts, evidence, corrections, signs; explain one claim.

Corrected equations are always rendered from their expressions.  The terminal and all documents
show the same sections, failures first, and count the same equations.
"""

import json
import re
from collections import Counter
from collections.abc import Iterable, Sequence
from typing import NamedTuple

import mpmath
from sympy import Expr, Symbol

from derive.check.claim import AsMeant, Basis, Claim, Paper, Verdict
from derive.check.correction import Repair
from derive.check.verdict import Finding
from derive.reading.improper import typed
from derive.sheet.notation import latex_of, text_of

_SIGNS = {"<=": r"\le", ">=": r"\ge", "~": r"\sim"}
_SENSES = {
    Verdict.CONVENTION: "the opposite sign",
    Verdict.FAILS: "neither",
    Verdict.UNCHECKED: "unchecked",
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
    left, right = (text_of(typed(side)) for side in (equation.left, equation.right))
    return f"{left} {equation.relation} {right}"


def latex_of_equation(equation: AsMeant | Repair) -> str:
    """Return a printed or a corrected equation in LaTeX."""
    sign = _SIGNS.get(equation.relation, equation.relation)
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
    latex = "" if meant == AsMeant() else latex_of_equation(meant)
    text = printed(claim) or ("not read" if entry.latex else "no equation")
    in_vain = "none of them is true" if finding.tried and repair is None else ""
    search = [line for part in _search(finding) for line in lines_of(part)]
    told = [
        Told("description", [entry.says] if entry.says not in (entry.label, claim.name) else []),
        Told("place", [entry.place] if entry.place != claim.name else []),
        Told("source", [" ".join(entry.latex.split())], entry.latex),
        Told("read as" if entry.latex else "printed", [text], latex),
        Told("corrected", [corrected(finding) or ""], latex_of_equation(repair) if repair else ""),
        *(Told(key, [text]) for key, text in entry.beside.items()),
        Told("to accept", [f"{claim.at}: {claim.to_accept}"] if claim.to_accept else []),
        Told("compared with", [claim.against]),
        Told("steps", entry.steps),
        Told("symbols", _meanings(claim)),
        Told("verdict", [verdict(finding), *lines_of(finding.judged.why), finding.partly]),
        Told("rests on", [finding.rests_on]),
        Told("step", lines_of(finding.step)),
        Told("units", [claim.units]),
        Told("convention", [_convention(finding)]),
        Told("search", [*search, in_vain]),
        Told("consequence", entry.consequence.split("; ")),
    ]
    return [each._replace(lines=lines) for each in told if (lines := [*filter(None, each.lines)])]


def _meanings(claim: Claim) -> list[str]:
    """Return the symbols of a claim with their definitions, and these in terms of variables."""
    meant = claim.meant
    sides = (*meant.compared, meant.left, meant.right)
    held = set().union(*(side.free_symbols for side in sides))
    found = {s.name: text_of(typed(expr)) for s, expr in meant.meaning.items() if s in held}
    told = list[str]()
    for name in dict.fromkeys([*found, *claim.symbols, *claim.words]):
        both = dict.fromkeys(filter(None, (claim.symbols.get(name), found.get(name))))
        is_open = name in claim.symbols and not both
        line = f"{name} has no meaning yet" if is_open else " = ".join((name, *both))
        told.append(", ".join(filter(None, (line, claim.words.get(name)))))
    return told


def evidence(finding: Finding) -> str:
    """Return the evidence for the verdict, in one paragraph."""
    claim = finding.claim
    compared = "" if claim.unchecked else f"compared with {claim.against}: "
    parts = [
        f"its units do not fit: {claim.units}" if claim.units else "",
        f"{compared}{finding.judged.why}",
        _convention(finding),
        finding.partly,
        *_search(finding),
    ]
    rests_on = f"rests on {finding.rests_on}" if finding.rests_on else ""
    return "; ".join(filter(None, [*parts, rests_on, finding.step]))


def verdict(finding: Finding) -> str:
    """Return the verdict, with what is unexpected about it."""
    is_unexpected = finding.claim.entry.expected and not finding.as_expected
    notes = ("units do not fit",) * bool(finding.claim.units)
    notes += ("not as expected",) * bool(is_unexpected)
    return f"{finding.verdict} ({', '.join(notes)})" if notes else str(finding.verdict)


def _convention(finding: Finding) -> str:
    if finding.convention is None or finding.under is None:
        return ""
    return f"with {finding.convention.what}: {finding.under.why}"


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


_NOT_HELD = (
    *("failed", "true with another convention", "held from claims that are not shown to be true"),
    *("not read", "unchecked", "to be accepted"),
)
_HELD = {basis: f"held from {basis}" for basis in Basis} | {Basis.GIVEN: "held from given claims"}
"""How far a claim may be covered, in the order of the reports: the worst first."""


def covered(finding: Finding) -> str:
    """Return how far one claim is covered.

    A claim of a draft is not read if the draft says why it, or a part of it, could not be read.
    """
    claim = finding.claim
    failed, convention, unsound, unread, unchecked, to_accept = _NOT_HELD
    if finding.verdict == Verdict.FAILS:
        return failed
    if finding.verdict == Verdict.CONVENTION:
        return convention
    if finding.unsound:
        return unsound
    if finding.verdict != Verdict.UNCHECKED:
        return _HELD[finding.basis or claim.meant.basis]
    if claim.to_accept:
        return to_accept
    return unread if claim.is_unread else unchecked


def is_held(finding: Finding) -> bool:
    """Whether a claim is shown to be true."""
    return covered(finding) in _HELD.values()


def in_order(findings: Iterable[Finding]) -> list[Finding]:
    """Return the findings in the order of the reports: failures first."""
    order = *_NOT_HELD, *_HELD.values()
    return sorted(findings, key=lambda finding: order.index(covered(finding)))


def coverage(findings: Iterable[Finding]) -> str:
    """Return how many equations are covered, and how far; the worst of its claims counts.

    Claims of one equation have the same number or the same LaTeX.
    """
    worst = dict[str, str]()
    for finding in in_order(findings):
        entry = finding.claim.entry
        worst.setdefault(entry.equation or entry.latex or entry.label, covered(finding))
    counted = Counter(worst.values())
    order = *_HELD.values(), *_NOT_HELD
    counts = ", ".join(f"{counted[far]} {far}" for far in order if far in counted)
    return f"{len(worst)} {'equation' if len(worst) == 1 else 'equations'}: {counts}"


def lists(paper: Paper, findings: Sequence[Finding]) -> dict[str, list[str]]:
    """Return the lists of a document that are not empty, by their headings.

    The first describes the symbols that are used, and the variables that the file says something
    of, each with the number of claims that use this definition.
    """
    used = Counter(
        (name, claim.symbols.get(name, "a variable"), claim.words.get(name, ""))
        for claim in (finding.claim for finding in findings)
        for name in {**claim.symbols, **claim.words}
    )
    meanings = [
        f"{name}: {', '.join(filter(None, (text or 'no meaning yet', words)))} ({count})"
        for (name, text, words), count in sorted(used.items())
    ]
    told = {
        "The meanings used, and the number of claims that use them": meanings,
        "Signs, section by section": signs(paper, findings),
    }
    return {heading: lines for heading, lines in told.items() if lines}


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
    parts.append(finding.step)
    return "; ".join(filter(None, parts))


def signs(paper: Paper, findings: Iterable[Finding]) -> list[str]:
    """List the places in the paper that give a quantity one sign, the opposite one or neither."""
    by_label = {finding.claim.entry.label: finding for finding in findings}
    lines = []
    for quantity, labels in paper.signs.items():
        senses: dict[str, list[str]] = {}
        for finding in (by_label[label] for label in labels if label in by_label):
            sense = _SENSES.get(finding.verdict, "one sign")
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
            "rests_on": finding.basis.parts if finding.basis else [],
            "coverage": covered(finding),
            "symbols": finding.claim.symbols,
            "meanings": finding.claim.words,
            "given": {each.claim.entry.label: str(each.verdict) for each in finding.given},
            "error_enters_at": [claim.entry.label for claim in finding.error_enters_at],
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
