"""Report findings as table rows, JSON, Markdown or LaTeX, list the errata, and explain one claim.

Printed and corrected equations are always rendered from their expressions.
"""

import json
import re
from collections import Counter
from collections.abc import Iterable, Sequence

import mpmath
from sympy import Expr, Symbol

from derive.check.claim import AsMeant, Claim, Paper, Verdict
from derive.check.repair import in_words
from derive.check.verdict import Finding, Repair
from derive.reading.relation import Relation
from derive.sheet.notation import latex_of, text_of

_SIGNS = {"<=": r"\le", ">=": r"\ge", "~": r"\sim"}


def printed(claim: Claim) -> str:
    """Return the printed equation as text, or an empty string if the claim has none."""
    return (
        claim.printed.text
        if claim.unchecked
        else claim.printed.text or _text(claim.meant, claim.meant.relation)
    )


def _text(equation: AsMeant | Repair, relation: Relation) -> str:
    return f"{text_of(equation.left)} {relation} {text_of(equation.right)}"


def latex_of_equation(equation: AsMeant | Repair, relation: Relation) -> str:
    """Return a printed or a corrected equation with the given relation, in LaTeX."""
    sign = _SIGNS.get(relation, relation)
    return rf"{_of(equation.left)} {sign} {_of(equation.right)}"


def _of(expr: Expr) -> str:
    """Return `expr` in LaTeX; a call of a formula, which has been given a symbol, stays a call."""
    calls = {s: Symbol(rf"\mathtt{{{_plain(s.name)}}}") for s in expr.free_symbols if "(" in s.name}
    return latex_of(expr.xreplace(calls))


def as_displayed(equation: AsMeant | Repair) -> str:
    """Return a printed or a corrected equation with its own relation, in LaTeX."""
    return latex_of_equation(equation, equation.relation)


def corrected(finding: Finding) -> str | None:
    """Return the corrected equation as text, or None if none was found."""
    repair = finding.repair
    return _text(repair, repair.relation) if repair else None


def evidence(finding: Finding) -> str:
    """Return the evidence for the verdict, in one paragraph."""
    claim = finding.claim
    units = [f"its units do not fit: {claim.units}"] if claim.units else []
    if claim.unchecked:
        return "; ".join([*units, finding.judged.why])
    parts = [*units, f"compared with {claim.expected.against}: {finding.judged.why}"]
    if finding.convention and finding.under:
        parts.append(
            f"with {finding.convention.what}: {finding.under.why}; "
            f"this contradicts {finding.convention.contradicts}"
        )
    if finding.partly:
        parts.append(finding.partly)
    if finding.repair:
        parts.append(f"corrected ({_changes(finding.repair)}): {finding.repair.judged.why}")
    if finding.diagnosis:
        parts.append(finding.diagnosis)
    if finding.tried:
        parts.append(_tried(finding.tried))
    if finding.stopped:
        parts.append(f"the search for a correction: {finding.stopped}")
    return "; ".join(parts)


def lines_of(text: str) -> list[str]:
    """Return the statements of a text, which semicolons outside parentheses separate."""
    return re.split(r"; (?![^(]*\))", text)


def _changes(repair: Repair) -> str:
    also = f", as would {' or '.join(repair.also)}" if repair.also else ""
    return in_words(repair.kind, repair.what) + also


def _tried(tried: Counter[str]) -> str:
    return f"{tried.total()} corrections tried"


def summary(findings: Sequence[Finding]) -> str:
    """Return the number of claims for each verdict, in words."""
    totals = Counter(finding.verdict for finding in findings)
    counts = ", ".join(_counted(totals[verdict], verdict) for verdict in Verdict if totals[verdict])
    return f"{len(findings)} {'claim' if len(findings) == 1 else 'claims'}: {counts}"


def _counted(number: int, verdict: Verdict) -> str:
    """Return "1 holds" and "2 hold"."""
    is_verb = verdict in (Verdict.HOLDS, Verdict.FAILS)
    return f"{number} {verdict.removesuffix('s') if is_verb and number > 1 else verdict}"


def unexpected(findings: Iterable[Finding]) -> list[Finding]:
    """Return the findings whose verdicts differ from the expected ones.

    Without an expected verdict, a finding is unexpected if the claim does not hold.
    """
    return [finding for finding in findings if not finding.as_expected]


def description(claim: Claim) -> str:
    """Return what the claim says, and its place if its name does not tell it."""
    return (
        claim.printed.says
        if claim.name == claim.printed.place
        else f"{claim.printed.says} ({claim.printed.place})"
    )


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
            parts += _remarks_on_failure(finding)
        if parts:
            lines.append((finding, "; ".join(parts)))
    return lines


def _remarks_on_failure(finding: Finding) -> list[str]:
    """Return the corrected equation or how the two sides differ, and where the claim is true."""
    stopped = f"the search for a correction: {finding.stopped}" if finding.stopped else ""
    found = corrected(finding)
    told = f"correct is {found}" if found else finding.diagnosis
    told = told or ("" if stopped else "no correction was found")
    return list(filter(None, (told, stopped, finding.partly)))


_SENSES = {
    Verdict.HOLDS: "one sign",
    Verdict.NUMERICAL: "one sign",
    Verdict.CONVENTION: "the opposite sign",
    Verdict.FAILS: "neither",
}


def signs(paper: Paper, findings: Iterable[Finding]) -> list[str]:
    """List the places in the paper that give a quantity one sign, the opposite one or neither."""
    by_label = {finding.claim.printed.label: finding for finding in findings}
    lines = []
    for quantity, labels in paper.signs.items():
        senses: dict[str, list[str]] = {}
        for label in labels:
            if label in by_label:
                sense = _SENSES.get(by_label[label].verdict, "unchecked")
                senses.setdefault(sense, []).append(by_label[label].claim.printed.place)
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


# ------------------------------------------------------------------ documents


def as_markdown(paper: Paper, findings: Sequence[Finding]) -> str:
    """Return a table of all verdicts, the signs section by section, and the errata, in Markdown."""
    lines = [f"# {paper.title}", "", summary(findings) + ".", ""]
    lines += ["| claim | description | verdict |", "| --- | --- | --- |"]
    for finding in findings:
        claim = finding.claim
        cells = (claim.name, description(claim), str(finding.verdict))
        lines.append("| " + " | ".join(cell.replace("|", r"\|") for cell in cells) + " |")
    if sign_lines := signs(paper, findings):
        lines += ["", "## Signs, section by section", ""]
        lines += [f"- {line}" for line in sign_lines]
    unchecked = [finding for finding in findings if finding.verdict == Verdict.UNCHECKED]
    if open_claims := [f"{each.claim.name}: {each.judged.why}" for each in unchecked]:
        lines += ["", "## Not checked", "", *(f"- {line}" for line in open_claims)]
    lines += ["", "## Errata", ""]
    for finding in errata(findings):
        lines += [
            f"### {finding.claim.printed.place}: {finding.claim.printed.says}",
            "",
            f"{finding.verdict}",
            "",
        ]
        lines += [f"- printed: {_in_markdown(finding.claim)}"]
        if finding.repair:
            lines.append(
                f"- corrected: ${latex_of_equation(finding.repair, finding.repair.relation)}$"
            )
        lines.append(f"- evidence: {evidence(finding)}")
        if consequences := finding.claim.consequences:
            lines += ["- consequence:", *(f"  - {line}" for line in consequences)]
        lines.append("")
    return "\n".join(lines)


def _in_markdown(claim: Claim) -> str:
    if claim.unchecked and not claim.printed.text:
        return "`" + " ".join(claim.printed.latex.split()) + "`"
    return (
        f"`{claim.printed.text}`"
        if claim.printed.text
        else f"${latex_of_equation(claim.meant, claim.meant.relation)}$"
    )


_ESCAPED = {
    "_": r"\_",
    "&": r"\&",
    "%": r"\%",
    "#": r"\#",
    "$": r"\$",
    "^": r"\^{}",
    "~": r"\~{}",
    "{": r"\{",
    "}": r"\}",
}


def _plain(text: str) -> str:
    """Escape text for LaTeX."""
    without = text.replace("\\", r"\textbackslash ")
    return "".join(_ESCAPED.get(character, character) for character in without)


def as_latex(paper: Paper, findings: Sequence[Finding]) -> str:
    """Return a LaTeX document with all verdicts, the signs section by section, and the errata."""
    lines = [
        r"\documentclass{article}",
        r"\usepackage{amsmath,longtable}",
        r"\begin{document}",
        rf"\section*{{{_plain(paper.title)}}}",
        f"{_plain(summary(findings))}.",
        r"\begin{longtable}{p{0.3\linewidth}p{0.45\linewidth}l}",
        r"place & description & verdict \\ \hline",
    ]
    for finding in findings:
        claim = finding.claim
        lines.append(
            rf"{_plain(claim.printed.place)} & {_plain(claim.printed.says)} & {finding.verdict} \\"
        )
    lines.append(r"\end{longtable}")
    if sign_lines := signs(paper, findings):
        lines.append(r"\section*{Signs, section by section}")
        lines += [rf"\noindent {_plain(line)}\par" for line in sign_lines]
    lines.append(r"\section*{Errata}")
    for finding in errata(findings):
        where = finding.claim.printed
        lines += [rf"\subsection*{{{_plain(where.place)}: {_plain(where.says)}}}"]
        lines += [f"{finding.verdict}. Printed:", *_printed_in_latex(finding.claim)]
        if finding.repair:
            lines += ["Corrected:", *_display(finding.repair, finding.repair.relation)]
        lines.append(rf"Evidence: {_plain(evidence(finding))}.")
        if consequences := finding.claim.consequences:
            lines.append(r"\par Consequence:")
            lines += [rf"\par {_plain(line)}" for line in consequences]
    return "\n".join([*lines, r"\end{document}", ""])


def _printed_in_latex(claim: Claim) -> list[str]:
    if claim.printed.text:
        return [rf"\texttt{{{_plain(claim.printed.text)}}}."]
    return _display(claim.meant, claim.meant.relation)


def _display(equation: AsMeant | Repair, relation: Relation) -> list[str]:
    return [r"\begin{equation*}", latex_of_equation(equation, relation), r"\end{equation*}"]


FORMS = {"json": as_json, "markdown": as_markdown, "latex": as_latex}
"""The functions that write all findings as text."""


# ------------------------------------------------------------------ explanation of one claim

_SHOWN = 6
"""The number of points that an explanation shows."""


def explanation(finding: Finding) -> list[tuple[str, list[str]]]:
    """Return headings with their lines: what was compared, how, and with which result."""
    claim = finding.claim
    entries = [
        ("description", [claim.printed.says]),
        ("place", [claim.printed.place] if claim.printed.place != claim.name else []),
        ("printed", [printed(claim) or "no equation"]),
        ("compared with", [claim.expected.against] if claim.expected.against else []),
        ("steps", list(claim.expected.steps)),
        ("symbols", [f"{s} = {text_of(claim.meant.meaning[s])}" for s in _held(claim)]),
        ("verdict", [str(finding.verdict), *lines_of(finding.judged.why), finding.partly]),
        ("convention", _convention(finding)),
        ("corrected", _correction(finding)),
        ("consequence", claim.consequences),
    ]
    return [(heading, list(filter(None, lines))) for heading, lines in entries if any(lines)]


def _held(claim: Claim) -> list[Symbol]:
    """Return the symbols of a claim's equation that the claims file gives a meaning."""
    sides = (
        *claim.meant.sides(claim.meant.left, claim.meant.right),
        claim.meant.left,
        claim.meant.right,
    )
    held = set().union(*(side.free_symbols for side in sides))
    return [symbol for symbol in claim.meant.meaning if symbol in held]


def numbers(finding: Finding) -> list[tuple[str, str, str]]:
    """Return the first points and the values of both sides there."""
    return [
        (
            ", ".join(f"{s} = {mpmath.nstr(v, 6)}" for s, v in pair.point.items()),
            *(mpmath.nstr(side, 16) for side in (pair.left, pair.right)),
        )
        for pair in finding.judged.pairs[:_SHOWN]
    ]


def _convention(finding: Finding) -> list[str]:
    if finding.convention is None or finding.under is None:
        return []
    return [
        f"with {finding.convention.what}: {finding.under.verdict}, {finding.under.why}",
        f"contradicts {finding.convention.contradicts}",
    ]


def _correction(finding: Finding) -> list[str]:
    tried = [_tried(finding.tried)] if finding.tried else []
    diagnosis = [finding.diagnosis] if finding.diagnosis else []
    if finding.stopped:
        return [*diagnosis, f"the search for a correction: {finding.stopped}"]
    if finding.repair is None:
        return [*diagnosis, *tried, "none of them is true"] if tried else diagnosis
    repair = finding.repair
    equation = _text(repair, repair.relation)
    verdict = lines_of(f"{repair.judged.verdict}: {repair.judged.why}")
    return [equation, _changes(repair), *verdict, *tried]
