"""Corrections of likely misprints, what is said without one, and which variable of a limit moves.

By hand, for a cylinder of radius R: p(0) = E* a/(2 R), P = pi E* a**2/(4 R), hence p(0)**2 =
E* P/(pi R), dP/da = pi E* a/(2 R).
"""

from pathlib import Path

import pytest

from derive.check.claim import Verdict
from derive.check.report import corrected, evidence, remark
from derive.check.verdict import Finding
from tests.check import asking

HEAD = """
body = "hertz"
[variables]
a = { unit = "m" }
c = { unit = "m" }
t = { unit = "-", low = 0.1, high = 1.4 }
n = { unit = "-" }
k = { unit = "-", low = 0.05, high = 1 }
[symbols]
P = "load(a, a)"
p_0 = "pressure(0, a, a)"
l = "k*a"
q = "k*p_0"
"""


def judged(folder: Path, printed: str, end: str = "") -> Finding:
    more = f'as = "{end}"' if end else ""
    return asking.judged(folder, HEAD + asking.claim(printed, more))


# ------------------------------------------------------------------ corrections


@pytest.mark.parametrize(
    ("printed", "right"),
    [
        ("diff(P, a) = pi*E_star*c/(2*R)", "diff(P, a) = pi*E_star*a/(2*R)"),
        ("pressure(0, c, c) = (a/c)*p_0", "pressure(0, c, c) = c*p_0/a"),
        ("p_0 = (P*E_star/(pi*R))**2", "p_0 = sqrt(E_star*P/(pi*R))"),
        ("cos(t)/sin(t)*n = n*tan(t)", "n*sin(t)/cos(t) = n*tan(t)"),
        ("n*cos(t)**2 = n*(1 - cos(t)**2)", "n*cos(t)**2 = n*(1 - sin(t)**2)"),
        ("asin(t/2) + n = pi/2 - asin(t/2) + n", "n + asin(t/2) = n - acos(t/2) + pi/2"),
        (
            "(sqrt(pi*n) + t)**2 = pi*n + 2*sqrt(n)*t + t**2",
            "(t + sqrt(pi*n))**2 = pi*n + t**2 + 2*t*sqrt(pi*n)",
        ),
        ("gamma_function(n + 1) = n*gamma_function(n/2)", "gamma(n + 1) = n*gamma(n)"),
        ("(n + t)**2 = n**2 + 3*n*t + t**2", "(n + t)**2 = n**2 + 2*n*t + t**2"),
        ("(a + c)**2 = a**2 + 2*a*c + c", "(a + c)**2 = a**2 + 2*a*c + c**2"),
        # for x**2 > a**2, sqrt(1/w) and 1/sqrt(w) are imaginary and have opposite signs
        (
            "n*sqrt(1/(1 - x**2/a**2)) = n/(2*sqrt(1 - x**2/a**2))",
            "n*sqrt(1/(1 - x**2/a**2)) = n/sqrt(1 - x**2/a**2)",
        ),
        # a quotient of functions upside down
        (
            "2 + n = 2 + 2*gamma_function(n/2)/gamma_function(n/2 + 1)",
            "n + 2 = 2 + 2*gamma(n/2 + 1)/gamma(n/2)",
        ),
    ],
)
def test_a_misprint_is_corrected(tmp_path: Path, printed: str, right: str) -> None:
    finding = judged(tmp_path, printed)
    assert finding.verdict == Verdict.FAILS
    assert corrected(finding) == right


@pytest.mark.parametrize(
    "printed",
    [
        # R and c are lengths, E* and p_0 are pressures: no length is tried for a pressure
        "P = exp(n)*E_star*a**2/R",
        # without its root, with the constant 1/2, or with q for p_0, the right side is the left
        "sqrt(a*c) = a*c",
        "exp(a) = 2*exp(a)",
        "l = a",
    ],
)
def test_no_correction_is_found(tmp_path: Path, printed: str) -> None:
    finding = judged(tmp_path, printed)
    assert (finding.verdict, finding.repair) == (Verdict.FAILS, None)
    assert finding.tried


# ------------------------------------------------------------------ what is said besides


@pytest.mark.parametrize(
    ("printed", "where"),
    [
        ("sqrt((a - c)**2) = a - c", "wherever c < a"),
        ("abs(x) = x", "wherever x > 0"),
        ("Max(a, l*n) = a", ""),
        ("a = 2*c", None),
    ],
)
def test_it_is_told_where_a_false_claim_is_true(
    tmp_path: Path, printed: str, where: str | None
) -> None:
    finding = judged(tmp_path, printed)
    assert finding.verdict == Verdict.FAILS
    if where is None:
        assert not finding.partly
    else:
        assert finding.partly.startswith("true at ")
        assert where in finding.partly
        told = corrected(finding) or finding.diagnosis or "no correction was found"
        assert remark(finding) == f"{told}; {finding.partly}"
        assert finding.partly in evidence(finding)


def test_a_branch_that_is_zero(tmp_path: Path) -> None:
    right = "Piecewise((0, x <= a), (x - a, True))"
    assert judged(tmp_path, f"Max(0, x - a) = {right}").judged.good
    finding = judged(tmp_path, "Max(0, x - a) = Piecewise((0, x <= a), (x + a, True))")
    assert finding.verdict == Verdict.FAILS
    assert corrected(finding) == "Max(0, -a + x) = Piecewise((0, a >= x), (-a + x, True))"


# ------------------------------------------------------------------ which variable moves


@pytest.mark.parametrize("end", ["a - l -> 0", "l -> a", "l - a -> 0", "k -> 1"])
def test_a_limit_does_not_let_all_lengths_vanish(tmp_path: Path, end: str) -> None:
    """l = k a tends to a as k -> 1, and not as a -> 0."""
    printed = "a**2 - l**2 ~ {}*a*(a - l)"
    assert judged(tmp_path, printed.format(2), end).verdict == Verdict.NUMERICAL
    finding = judged(tmp_path, printed.format(3), end)
    assert finding.verdict == Verdict.FAILS
    assert corrected(finding) == "a**2 - l**2 ~ 2*a*(a - l)"


def test_a_limit_that_depends_on_what_moves_is_unchecked(tmp_path: Path) -> None:
    finding = judged(tmp_path, "n + t*n ~ n", "n*t -> 0")
    assert finding.verdict == Verdict.UNCHECKED
    assert "if n moves" in evidence(finding)
    assert "if t moves" in evidence(finding)
    assert judged(tmp_path, "n + t*n ~ n", "t -> 0").judged.good
    # a limit at an end of a range has one side: 1 - k is never negative, since k is at most 1
    assert judged(tmp_path, "abs(1 - k) ~ 1 - k", "k -> 1").judged.good
