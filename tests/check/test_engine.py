"""Parts of the checker that a file of claims reaches with difficulty, on claims judged by eye."""

import pytest
from sympy import Abs, Expr, Integral, S, asin, atan, cos, log, pi, sin, sqrt, symbols

from derive.check.claim import SCALE, SIGNED, AsMeant, Claim, Range, Verdict
from derive.check.schema import Entry
from derive.check.verdict import check
from derive.check.zero import vanishes
from derive.command.limit import LimitReached

a, b, c = symbols("a b c")
u, v = symbols("u v", positive=True)
w = symbols("w", real=True)
s = symbols("s", real=True)


def claim(left: object, right: object, **more: object) -> Claim:
    seconds = more.pop("seconds", None)
    meant = AsMeant(left=left, right=right, **more)  # type: ignore[arg-type]
    return Claim(Entry("it", "here", "so"), meant, seconds=seconds)  # type: ignore[arg-type]


def test_a_definition_is_judged_where_it_stands() -> None:
    finding = check(claim(a, b**3, meaning={b: u, c: 3 * u**2}, through=(c, 3 * a)))
    assert finding.verdict == Verdict.FAILS
    assert finding.repair is not None
    assert finding.repair.right == b**2


def test_a_modulus_is_put_in_and_taken_out() -> None:
    for right, meaning in ((b, {a: Abs(w), b: w}), (Abs(b), {a: w, b: w})):
        finding = check(claim(a, right, meaning=meaning, ranges={w: SIGNED}))
        assert finding.repair is not None
        assert finding.repair.kind == "modulus"


def test_a_proof_that_takes_too_long_leaves_the_numbers(monkeypatch: pytest.MonkeyPatch) -> None:
    def slow(*_: object) -> str:
        raise LimitReached

    monkeypatch.setattr("derive.check.judge.vanishes", slow)
    finding = check(claim(a, b, meaning={a: u, b: u}, seconds=3.0))
    assert finding.verdict == Verdict.NUMERICAL
    assert "no proof was found within 3 s" in finding.judged.why


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
