"""The parts of the checker, on claims small enough to judge by eye."""

import mpmath
import pytest
from mpmath import mpf
from sympy import Abs, Expr, Integral, S, asin, atan, cos, log, pi, sin, sqrt, symbols

from derive.check.claim import (
    SCALE,
    SIGNED,
    AsMeant,
    Claim,
    Paper,
    Range,
    Verdict,
)
from derive.check.draw import points, variables
from derive.check.repair import edits, swappable
from derive.check.report import evidence
from derive.check.schema import Entry, Reinterpretation
from derive.check.sides import Sides
from derive.check.verdict import check
from derive.check.zero import vanishes
from derive.command.limit import LimitReached
from derive.proof.values import Undecided, evaluated
from derive.reading.relation import Relation

a, b, c = symbols("a b c")
u, v = symbols("u v", positive=True)
s, w = symbols("s w", real=True)


def claim(left: object, right: object, **more: object) -> Claim:
    seconds = more.pop("seconds", None)
    meant = AsMeant(left=left, right=right, **more)  # type: ignore[arg-type]
    return Claim(Entry("it", "here", "so"), meant, seconds=seconds)  # type: ignore[arg-type]


# ------------------------------------------------------------------ verdicts


@pytest.mark.parametrize(
    ("printed", "kind"),
    [
        (-(b**2), "sign"),
        (2 * b**2, "factor"),
        (b**2 / pi, "factor"),
        (sqrt(2) * b**2, "factor"),
        (c**2, "swap"),
        (b**4, "exponent"),
        (b**2 + c, "term"),
        (Abs(b) ** 2 * 3, "factor"),
    ],
)
def test_a_slip_is_found_and_mended(printed: object, kind: str) -> None:
    finding = check(claim(a, printed, meaning={a: u**2, b: u, c: v}, swaps=(b, c)))
    assert finding.verdict == Verdict.FAILS
    assert not finding.as_expected
    assert finding.repair is not None
    assert finding.repair.kind == kind
    assert finding.repair.judged.verdict == Verdict.HOLDS
    assert finding.tried


def test_two_slips_are_found_together() -> None:
    finding = check(claim(a, b - 2 * c, meaning={a: u + 2 / v, b: u, c: v}, swaps=(c,)))
    assert "corrected (sign of -2*c and swap 1/c for c): " in evidence(finding)


def test_a_map_of_signs_that_helps_makes_a_convention() -> None:
    turned = Reinterpretation("a downward", "eq. (0), where a is upward")
    finding = check(claim(a, -b, meaning={a: u, b: u}, conventions=((turned, {a: -u}),)))
    assert finding.verdict == Verdict.CONVENTION
    assert finding.convention is turned
    assert finding.repair is not None
    finding = check(claim(a, 3 * b, meaning={a: u, b: u}, conventions=((turned, {a: -u}),)))
    assert finding.verdict == Verdict.FAILS


# (1 + b/10**400) - 1 is b/10**400, of which no digit is left at 240 working digits
LOST = (sqrt((1 + b / 10**400) ** 2) - 1) * 10**400


@pytest.mark.parametrize("printed", [log(b - c), 1 / (b - c), S.ComplexInfinity * b, LOST])
def test_what_gives_no_number_is_unchecked(printed: Expr) -> None:
    assert check(claim(a, printed, meaning={a: u, b: u, c: u})).verdict == Verdict.UNCHECKED


def test_a_definition_is_judged_where_it_stands() -> None:
    finding = check(claim(a, b**3, meaning={b: u, c: 3 * u**2}, through=(c, 3 * a)))
    assert finding.verdict == Verdict.FAILS
    assert finding.repair is not None
    assert finding.repair.right == b**2


@pytest.mark.parametrize(
    ("relation", "right", "mended"),
    [
        (Relation.BELOW, 2 * u, None),
        (Relation.ABOVE, 2 * u, Relation.BELOW),
        (Relation.BELOW, u, Relation.EQUAL),
    ],
)
def test_inequalities(relation: Relation, right: Expr, mended: Relation | None) -> None:
    finding = check(claim(a, b, meaning={a: u, b: right}, relation=relation))
    assert finding.verdict == (Verdict.FAILS if mended else Verdict.HOLDS)
    assert (finding.repair.relation if finding.repair else None) == mended


def test_a_modulus_is_put_in_and_taken_out() -> None:
    for right, meaning in ((b, {a: Abs(w), b: w}), (Abs(b), {a: w, b: w})):
        finding = check(claim(a, right, meaning=meaning, ranges={w: SIGNED}))
        assert finding.repair is not None
        assert finding.repair.kind == "modulus"


def test_two_claims_of_one_label_are_refused() -> None:
    with pytest.raises(AssertionError):
        Paper("title", (claim(a, b), claim(a, c)))


@pytest.mark.parametrize(
    ("relation", "verdict"),
    [
        (Relation.AT_MOST, Verdict.HOLDS),
        (Relation.BELOW, Verdict.HOLDS),
        (Relation.AT_LEAST, Verdict.FAILS),
        (Relation.ABOVE, Verdict.FAILS),
    ],
)
def test_a_bound_is_judged_off_it(relation: Relation, verdict: Verdict) -> None:
    """a <= b for a = u b is right below u = 1 and wrong above; the turned one is neither."""
    made = {
        "meaning": {a: v, b: v},
        "reached": ({a: v * u}, {a: v / u}),
        "ranges": {u: Range(0.05, 0.95)},
    }
    assert check(claim(a, b, relation=relation, **made)).verdict == verdict


def test_a_proof_that_takes_too_long_leaves_the_numbers(monkeypatch: pytest.MonkeyPatch) -> None:
    def slow(*_: object) -> str:
        raise LimitReached

    monkeypatch.setattr("derive.check.judge.vanishes", slow)
    finding = check(claim(a, b, meaning={a: u, b: u}, seconds=3.0))
    assert finding.verdict == Verdict.NUMERICAL
    assert "no proof was found within 3 s" in finding.judged.why


# ------------------------------------------------------------------ points and numbers


def test_points_are_the_same_on_every_machine() -> None:
    one = claim(a, b, meaning={a: u, b: v}, ranges={v: Range(0.05, 0.95)})
    assert list(points(one)) == list(points(one))
    assert all(0.05 <= point[v] <= 0.95 for point in points(one))
    assert variables(claim(a, Integral(b * s, (s, 0, c)), meaning={a: u, b: s**2, c: v})) == [u, v]
    finding = check(claim(a, b, meaning={a: S(1), b: S(2)}, relation=Relation.BELOW))
    assert len(finding.judged.pairs) == 1
    finding = check(claim(a, b, meaning={a: u, b: u}, cases=({u: "1"}, {u: "2.5"})))
    assert len(finding.judged.pairs) == 2
    assert "in 2 prescribed cases alone" in finding.judged.why


@pytest.mark.parametrize(
    ("integrand", "low", "high", "value"),
    [
        (1 / sqrt((1 + s) * (2 - s)), -1, 2, pi),
        (sqrt(4 - s**2), -2, 2, 2 * pi),
        (log(Abs(s)), -1, 1, S(-2)),
        (1 / sqrt(3 - s), 0, 3, 2 * sqrt(3)),
        (s**5, 0, 2, S(32) / 3),
    ],
)
def test_integrals(integrand: Expr, low: int, high: int, value: Expr) -> None:
    with mpmath.workdps(36):
        found = evaluated(Integral(integrand, (s, low, high)), {})
        assert mpmath.almosteq(found, evaluated(value, {}), mpf(10) ** -31)


def test_what_is_not_finite_is_undecided() -> None:
    with pytest.raises(Undecided):
        Sides(claim(a, 1 / (b - b * a)), a, 1 / (b - b * a), {}).pair({a: mpf(1), b: mpf(3)})


# ------------------------------------------------------------------ exact zeros, and changes

JUMP = atan(w) + atan(1 / w) - pi / 2  # zero for w > 0, -pi for w < 0, and its derivative is zero
MODULUS = log(Abs(w + S(199) / 100)) - log(w + S(199) / 100)


@pytest.mark.parametrize(
    ("expr", "span", "shown"),
    [
        ((u + v) ** 2 - u**2 - 2 * u * v - v**2, SCALE, True),
        (cos(2 * atan(u)) - (1 - u**2) / (1 + u**2), SCALE, True),
        (asin((1 - u**2) / (1 + u**2)) - pi / 2 + 2 * atan(u), SCALE, True),
        (log(Abs((u + v) / (u - v))) - log(Abs((v + u) / (v - u))), SCALE, True),
        (sqrt(u**2 * v + v**3) - sqrt(v) * sqrt(u**2 + v**2), SCALE, True),
        (JUMP.subs(w, u), SCALE, True),
        (JUMP, Range(0.1, 2), True),
        (MODULUS, Range(-0.9, 0.9), True),
        (u - v, SCALE, False),
        (sin(u) - u, SCALE, False),
        (asin(u) - atan(u), SCALE, False),
        (Integral(s, (s, 0, u)) - u**2 / 2, SCALE, False),
        (u / 10**30, SCALE, False),
        (JUMP, SIGNED, False),
        (MODULUS, SIGNED, False),
    ],
)
def test_identities_vanish_and_nothing_else(expr: Expr, span: Range, shown: bool) -> None:
    assert bool(vanishes(expr, {symbol: span for symbol in expr.free_symbols})) == shown


def test_every_edit_changes_and_none_comes_twice() -> None:
    printed = a * sqrt(b + c) - 2 * Integral(s * a, (s, 0, b))
    made = [*edits(printed, swappable((a, b), {}))]
    found = [edit.expr for edit in made]
    assert printed not in found
    assert len(found) == len(set(found))
    assert {edit.kind for edit in made} >= {"sign", "factor", "swap", "exponent"}
    assert made == [*edits(printed, swappable((a, b), {}))]


def test_a_range_has_a_simple_place() -> None:
    assert (Range(0, 0.5).place, SIGNED.place) == (S(1) / 4, 1)
