"""The paper is complete, and what holds holds for a reason.

The verdicts, the corrections and the signs of the sections stand in notebook 08, with which
`make thorough` compares those of a fresh run.
"""

import tomllib
from collections import Counter
from functools import cache

import pytest

from derive.check.claim import Paper, Verdict
from derive.check.report import printed
from derive.check.userfile import BUILT_IN, read_claims
from derive.check.verdict import check
from tests.check.displayed import DISPLAYED
from tests.check.mutants import FEWEST, mutants, survives

pytestmark = pytest.mark.slow


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

CLAIMS = [c for path in BUILT_IN.glob("*.toml") for c in tomllib.loads(path.read_text())["claims"]]
"""As they are written: to read their formulas takes many times as long."""


@cache
def section(name: str) -> Paper:
    """The claims of one file, read."""
    return read_claims(BUILT_IN / f"{name}.toml")


def test_no_displayed_equation_is_missing() -> None:
    """Labels and places are those of the source, too."""
    parts = Counter(claim["equation"] for claim in CLAIMS if "equation" in claim)
    extra = {"(5)": 1, "(3)": 1, "(4)": 1}  # a second body, or the other side of the apex
    extra["(27)"] = 1  # its two sides beside M
    extra["(37)"] = 1  # its corrected form
    expected = {number: count for number, _, _, count in DISPLAYED}
    assert {n: c - extra.get(n, 0) for n, c in parts.items()} == expected
    assert len(DISPLAYED) == 49
    for number, label, where, _ in DISPLAYED:
        for claim in (claim for claim in CLAIMS if claim.get("equation") == number):
            assert claim["label"].startswith(label), claim["label"]
            assert number.strip("()") in claim["place"] or number == "(47a)"
            assert where in claim["place"]


TRUE = (Verdict.HOLDS, Verdict.NUMERICAL, Verdict.DEFINITION)
AS_PRINTED = {
    "section 3/K_T/left": "K_T = Q/(pi*sqrt(2*a)) + (sigma/4)*sqrt(a/2)",
    "section 3/K_T/right": "K_T = -Q/(pi*sqrt(2*a)) + (sigma/4)*sqrt(a/2)",
}


def test_an_equation_is_printed_as_its_source_has_it() -> None:
    """SymPy would gather roots and multiply brackets out."""
    claims = section("3_asymptotics")
    assert {label: printed(claims[label]) for label in AS_PRINTED} == AS_PRINTED
    assert "- (K_Q2*sqrt(x + a_2 - d_2) - " in printed(claims["section 3.2/difference"])
    assert "f*K_N*(2*(d_2/(2*sqrt(x + a_1))) + Delta_a/" in printed(claims["eq:DeltaQApprox"])
    assert printed(claims["section 3.2/limit"]).count("sqrt(x + a_2 - d_2)") == 2


@pytest.mark.parametrize("side", ["left", "right"])
def test_the_direction_of_a_bound_is_judged(side: str) -> None:
    claim = section("1_introduction")[f"fullstickinequality/{side}"]
    assert check(claim).verdict == Verdict.HOLDS
    assert check(claim.changed(relation=claim.meant.relation.turned)).verdict == Verdict.FAILS


@pytest.mark.enough("3_asymptotics")
@pytest.mark.parametrize("name", sorted(path.stem for path in BUILT_IN.glob("*.toml")))
def test_broken_claims_are_found(name: str) -> None:
    """At least five ways a claim; survivors are named with the reason, and are no errors."""
    claims, surviving, few = section(name).claims, {}, {}
    for claim in claims:
        true = claim.entry.expected in TRUE
        if not true or claim.meant.is_inequality:
            continue  # an inequality that stays true is no error
        broken = list(mutants(claim))
        if len(broken) < FEWEST:
            few[claim.entry.label] = len(broken)
        for mutant in broken:
            if survives(mutant):
                surviving[claim.entry.label, mutant.what] = mutant
    assert set(surviving) <= SAME.keys(), surviving.keys() - SAME.keys()
    known = {"section 4.1/no moment/alpha", "section 4.1/no moment/gamma"}  # 0 and 1
    assert set(few) == known & {claim.entry.label for claim in claims}
