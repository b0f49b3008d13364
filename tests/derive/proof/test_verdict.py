"""Verdicts: how many digits two numbers share, and what may be concluded from how many points."""

from itertools import product

import pytest
from mpmath import inf, mpf, nan, workdps

from derive.proof.verdict import (
    DIGITS,
    POINTS,
    WORKING,
    Comparison,
    Proof,
    Verdict,
    combined,
    numerical_proof,
)

ONE = mpf(1)


def comparison(first: mpf, second: mpf, point: str = "x = 1") -> Comparison:
    return Comparison(first, second, point)


def agreeing(count: int) -> list[Comparison]:
    return [comparison(ONE, ONE, f"x = {i}") for i in range(count)]


@pytest.mark.parametrize(
    ("first", "second", "digits"),
    [
        *((ONE, ONE, WORKING), (ONE, -ONE, 0), (mpf(0), mpf("1e-40"), 0)),
        *((ONE, nan, 0), (inf, inf, 0)),
    ],
    ids=str,
)
def test_digits_that_two_numbers_share(first: mpf, second: mpf, digits: int) -> None:
    assert comparison(first, second).digits == digits
    assert comparison(second, first).digits == digits


@pytest.mark.parametrize("power", [5, 30, 45])
@pytest.mark.parametrize("scale", [mpf("1e-30"), ONE, mpf("-1e20")], ids=str)
def test_digits_are_relative_and_never_overstated(power: int, scale: mpf) -> None:
    with workdps(WORKING + 20):
        gap = mpf(3) * mpf(10) ** -(power + 1)  # 3e-(p+1): more than p digits, less than p + 1
        assert comparison(scale, scale * (1 + gap)).digits == power


def test_agreement_at_every_point_is_numerical_and_the_worst_point_is_reported() -> None:
    some = agreeing(POINTS)
    assert numerical_proof("a route", some) == Proof(Verdict.NUMERICAL, "a route", POINTS, WORKING)
    with workdps(WORKING):
        some[7] = comparison(ONE, ONE + mpf(10) ** -(DIGITS + 3) / 2, some[7].point)
    assert numerical_proof("a route", some).digits == DIGITS + 3


@pytest.mark.parametrize("count", [0, POINTS - 1])
def test_too_few_points_prove_nothing(count: int) -> None:
    proof = numerical_proof("a route", agreeing(count))
    assert proof.verdict == Verdict.UNKNOWN
    assert not proof.holds
    assert f"only {count} of {POINTS}" in proof.route


@pytest.mark.parametrize("at", [0, POINTS - 1])
@pytest.mark.parametrize("wrong", [-ONE, 1 + mpf("1e-12"), nan], ids=str)
def test_one_point_refutes(at: int, wrong: mpf) -> None:
    some = agreeing(POINTS)
    some[at] = comparison(ONE, wrong, "x = 7, y = 8")
    proof = numerical_proof("a route", some)
    assert (proof.verdict, proof.holds, proof.points) == (Verdict.REFUTED, False, at + 1)
    assert "x = 7, y = 8" in proof.example and "against" in str(proof)


def test_many_comparisons_at_one_point_are_one_point() -> None:
    """A route may compare several numbers at a point; a proof needs POINTS points all the same."""
    proof = numerical_proof("a route", [comparison(ONE, ONE, "x = 1")] * POINTS)
    assert not proof.holds


SYMBOLIC = [None, Proof(Verdict.PROVEN, "by symbols")]
NUMERICAL = [None, *(Proof(v, "by numbers", 24, 40) for v in Verdict if v != Verdict.PROVEN)]


@pytest.mark.parametrize(
    ("symbolic", "numerical"),
    list(product(SYMBOLIC, NUMERICAL)),
    ids=lambda proof: "none" if proof is None else str(proof.verdict),
)
def test_both_routes_together(symbolic: Proof | None, numerical: Proof | None) -> None:
    """Refuted by either is refuted; an exact zero is a proof; 24 points are numerical."""
    verdicts = {proof.verdict for proof in (symbolic, numerical) if proof}
    order = (Verdict.REFUTED, Verdict.PROVEN, Verdict.NUMERICAL, Verdict.UNKNOWN)
    expected = next((v for v in order if v in verdicts), Verdict.UNKNOWN)
    proof = combined(symbolic, numerical)
    assert proof.verdict == expected
    assert proof.holds == (expected in (Verdict.PROVEN, Verdict.NUMERICAL))
