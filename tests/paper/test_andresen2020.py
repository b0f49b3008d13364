"""The paper is complete, its verdicts are computed, and what holds holds for a reason."""

import re
from collections import Counter, defaultdict
from dataclasses import replace

import pytest

from derive.paper.claim import Verdict
from derive.paper.draw import LEAST, variables
from derive.paper.numbers import DIGITS
from derive.paper.report import as_latex, as_markdown, corrected, errata, evidence, printed, signs
from derive.paper.userfile import built_in as paper
from derive.paper.verdict import Finding, check
from tests.paper.displayed import DISPLAYED
from tests.paper.mutants import FEWEST, mutants, survives

pytestmark = pytest.mark.slow

# What a person found with pencil and paper; the checker knows nothing of this list.
WRONG = {
    "eqn:consistencyab": "sqrt((a + s)*(c - s))",
    "eqn:FIE": "E_star*g_prime/2",
    "section 2/h": "x_1 = c",
    "section 3/K_T/right": "K_T = Q",
    "eq:CJshear": "dp_dP/dP_dQ",
    "eq:CJshear2": "dp_dP/dP_dQ",
    "eq:CJshear/sense": "Delta_Q",
    "eq:asymTan1": "sqrt(a_1 - d_1 + x)",
    "eq:DeltaQApprox": "Delta_q",
    "eq:slipAsymptotes/1": "Delta_K_T/(K_N*f) - Delta_a/2",
    "section 3.2/Delta_a": "-a_1 + a_2",
    "alpha": "2*phi*asin",
    "section 4.1/M/integral": "-Integral",
    "section 4.1/M/sides": "-E_star",
    "section 3.2/instant/from 1 to 2": "-Q_1 + Q_i",
    "section 5/one end at a time": "Abs(Delta_K_T",
    "K_T/tilted/left": "a + c",
    "K_T/tilted/right": "a + c",
    "inequalitywedge": "4 + 4/gamma",
    "eq18": "-Delta_Q/2",
    "eq26": "-Delta_Q/2",
    "Hertz_shift_stick_zone": "e = Delta_sigma*R",
    "eq. (46)/parameter": "elliptic_k(chi**2)",
}
"""label: a part of the corrected equation."""

SAME = {
    (
        "eq17",
        "m and n exchanged",
    ): "the condition of strain is symmetric in m and n where p is even",
    (
        "appendix/definitions/chi",
        "of the whole expression",
    ): "only the square of the modulus enters",
}
"""Changes that change nothing."""

PARTS = 10
"""In so many parts the claims are broken."""


def test_no_displayed_equation_is_missing() -> None:
    parts = Counter(claim.equation for claim in paper().claims if claim.equation)
    expected = {number: count for number, _, _, count in DISPLAYED}
    extra = {"(5)": 1, "(3)": 1, "(4)": 1}  # a second body, or the other side of the apex
    extra["(27)"] = 1  # its two sides beside M
    assert {n: c - extra.get(n, 0) for n, c in parts.items()} == expected
    assert len(DISPLAYED) == 49
    assert all(claim.seconds for claim in paper().claims)  # none without a limit in time


def test_labels_and_places_are_those_of_the_source() -> None:
    by_number = defaultdict(list)
    for claim in paper().claims:
        by_number[claim.equation].append(claim)
    for number, label, section, _ in DISPLAYED:
        for claim in by_number[number]:
            assert claim.label.startswith(label), claim.label
            assert number.strip("()") in claim.place or number == "(47a)"
            assert section in claim.place


AS_PRINTED = {
    "section 3/K_T/left": "K_T = Q/(pi*sqrt(2*a)) + (sigma/4)*sqrt(a/2)",
    "section 3/K_T/right": "K_T = -Q/(pi*sqrt(2*a)) + (sigma/4)*sqrt(a/2)",
    "K_T/left": "Delta_K_T = Delta_Q/(pi*sqrt(2*a)) + (Delta_sigma/4)*sqrt(a/2)",
    "K_T/right": "Delta_K_T = Delta_Q/(pi*sqrt(2*a)) - (Delta_sigma/4)*sqrt(a/2)",
    "appendix/K_N": "K_N = E_star/(2*R)*sqrt(2*a)",
}


def test_an_equation_is_printed_as_its_source_has_it() -> None:
    """SymPy would gather roots and multiply brackets out."""
    for label, text in AS_PRINTED.items():
        assert printed(paper()[label]) == text
    assert "- (K_Q2*sqrt(x + a_2 - d_2) - " in printed(paper()["section 3.2/difference"])
    assert "f*K_N*(2*(d_2/(2*sqrt(x + a_1))) + Delta_a/" in printed(paper()["eq:DeltaQApprox"])
    assert "(1 + gamma)*4*f**2*P**2" in printed(paper()["inequalitywedge"])
    assert printed(paper()["section 3.2/limit"]).count("sqrt(x + a_2 - d_2)") == 2
    assert "c - x" in printed(paper()["eqn:FlatPunchCP"])


@pytest.mark.thorough
def test_every_verdict_is_the_expected_one_and_has_evidence(findings: dict[str, Finding]) -> None:
    for label, finding in findings.items():
        assert finding.claim.expected is not None, label
        assert finding.as_expected, f"{label}: {finding.verdict}"
        assert evidence(finding), label
        if finding.judged.good and variables(finding.claim) and not finding.claim.cases:
            assert len(finding.judged.pairs) >= LEAST
        if finding.verdict in (Verdict.HOLDS, Verdict.NUMERICAL):
            strict = finding.claim.is_inequality
            assert finding.judged.pairs
            assert strict or min(p.digits for p in finding.judged.pairs) >= DIGITS


@pytest.mark.thorough
def test_what_is_wrong_is_what_a_person_found(findings: dict[str, Finding]) -> None:
    for label, part in WRONG.items():
        finding = findings[label]
        assert finding.verdict in (Verdict.FAILS, Verdict.CONVENTION), label
        told = corrected(finding)
        assert told is not None
        assert part in told, f"{label}: {told}"
    # the larger shear is that of the traction called first
    assert corrected(findings["eq:CJshear/sense"]) == "q_1 - q_2 = Delta_Q"


@pytest.mark.thorough
def test_the_error_falls_only_relatively_and_where_a_zone_has_just_opened(
    findings: dict[str, Finding],
) -> None:
    said = {label: found for label, found in findings.items() if "/accuracy/" in label}
    assert len(said) == 4
    wrong = [label for label, found in said.items() if found.verdict == Verdict.FAILS]
    assert wrong == ["section 5.3/accuracy/right/relative"]
    for label, found in findings.items():  # a computed number is counted once
        if label in said or "5.3/overestimated" in label:
            assert len(found.judged.pairs) == 1


@pytest.mark.parametrize(
    "label",
    (
        *("fullstickinequality/left", "fullstickinequality/right"),
        *("inequalitywedge/direction", "inequality"),
    ),
)
def test_the_direction_of_a_bound_is_judged(label: str) -> None:
    claim = paper()[label]
    assert check(claim).verdict == Verdict.HOLDS
    assert check(replace(claim, relation=claim.relation.turned)).verdict == Verdict.FAILS


@pytest.mark.thorough
def test_every_corrected_equation_is_proven_and_its_consequence_told(
    findings: dict[str, Finding],
) -> None:
    wrong = errata(findings.values())
    assert all(finding.repair.judged.good for finding in wrong if finding.repair)
    without = {finding.claim.label for finding in wrong if finding.repair is None}
    assert without == {"section 4.1/alpha_0(M_0, P_0)", "section 5.3/validity"}
    assert {found.claim.label for found in wrong if not found.claim.consequence} <= {
        "eqn:FIE/cylinder"
    }


@pytest.mark.thorough
def test_a_convention_holds_under_its_map_and_names_the_place(findings: dict[str, Finding]) -> None:
    for finding in findings.values():
        if finding.verdict == Verdict.CONVENTION:
            assert finding.under is not None and finding.under.good
            assert finding.convention is not None
            assert re.search("eq|section", finding.convention.contradicts)


@pytest.mark.thorough
def test_documents_hold_every_error(findings: dict[str, Finding]) -> None:
    found = list(findings.values())
    for text in (as_markdown(paper(), found), as_latex(paper(), found)):
        assert text.count("orrected: $") + text.count("Corrected:\n") == sum(
            f.repair is not None for f in errata(found)
        )
    assert r"\begin{document}" in as_latex(paper(), found)


@pytest.mark.thorough
def test_the_signs_of_the_sections_are_compared(findings: dict[str, Finding]) -> None:
    told = {line.partition(":")[0]: line for line in signs(paper(), findings.values())}
    assert told.keys() == {"moment", "tilt", "tension", "shear"}
    assert "opposite" not in told["tilt"]
    for number in ("(39)", "(44)", "(47)"):
        assert number in told["tension"].partition("opposite sign in")[2]
    for number in ("(23)", "(27), section 4.1, first part"):
        assert number in told["moment"].partition("opposite sign in")[2]


@pytest.mark.enough("3")
@pytest.mark.parametrize("part", range(PARTS))
def test_broken_claims_are_found(part: int) -> None:
    """At least five ways a claim; survivors are named with the reason, and are no errors."""
    tried, surviving, few = 0, {}, {}
    claims = paper().claims[part::PARTS]
    for claim in claims:
        true = claim.expected in (Verdict.HOLDS, Verdict.NUMERICAL)
        if not true or claim.is_inequality:
            continue  # an inequality that stays true is no error
        broken = list(mutants(claim))
        tried += len(broken)
        if len(broken) < FEWEST:
            few[claim.label] = len(broken)
        for mutant in broken:
            if survives(mutant):
                surviving[claim.label, mutant.what] = mutant
    assert set(surviving) <= SAME.keys(), surviving.keys() - SAME.keys()
    known = {"section 4.1/no moment/alpha", "section 4.1/no moment/gamma"}  # 0 and 1
    assert set(few) == known & {claim.label for claim in claims}
    assert tried > 500 / PARTS
