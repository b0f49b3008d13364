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
Q = "f*(load(a, a) - load(l, l))"
K_N = "K_N_left(a, a)"
p_at_x = "pressure(x, a, a)"
p_at_s = "p_0*sqrt(1 - s**2/a**2)"
q_at_x = "f*pressure(x, a, a) - f*pressure(x, l, l)"
phi_0 = "asin(l/a)"
"""
WEDGE = """
body = "wedge"
[variables]
a = { unit = "m" }
c = { unit = "m" }
[symbols]
P = "load(a, c)"
M = "moment(a, c)"
K_N = "K_N_left(a, c)"
alpha = "tilt(a, c)"
theta = "pi*tilt(a, c)/(2*phi)"
"""
FLAT = """
body = "flat_rounded"
[variables]
phi_0 = { unit = "rad", low = 0.1, high = 1.4 }
[symbols]
a = "b/sin(phi_0)"
P = "load(a, a)"
K_N = "K_N_left(a, a)"
"""
PUNCH = """
[variables]
a = { unit = "m" }
P = { unit = "N/m" }
dQ = { unit = "N/m" }
dsigma = { unit = "Pa" }
k = { unit = "-", low = 0.05, high = 0.95 }
[symbols]
c = "k*a"
K_T = "dQ/(pi*sqrt(2*a)) + dsigma*sqrt(2*a)/8"
p_at_s = "P/(pi*sqrt(a**2 - s**2))"
"""


def judged(folder: Path, printed: str, end: str = "", head: str = HEAD) -> Finding:
    more = f'as = "{end}"' if end else ""
    return asking.judged(folder, head + asking.claim(printed, more))


# ------------------------------------------------------------------ corrections


MISPRINTS = {
    HEAD: [
        ("diff(P, a) = pi*E_star*c/(2*R)", "diff(P, a) = pi*E_star*a/(2*R)"),
        ("p_0 = (P*E_star/(pi*R))**2", "p_0 = sqrt(E_star*P/(pi*R))"),
        ("cos(t)/sin(t)*n = n*tan(t)", "n*sin(t)/cos(t) = n*tan(t)"),
        ("n*cos(t)**2 = n*(1 - cos(t)**2)", "n*cos(t)**2 = n*(1 - sin(t)**2)"),
        ("asin(t/2) + n = pi/2 - asin(t/2) + n", "n + asin(t/2) = n - acos(t/2) + pi/2"),
        (
            "(sqrt(pi*n) + t)**2 = pi*n + 2*sqrt(n)*t + t**2",
            "(t + sqrt(pi*n))**2 = pi*n + t**2 + 2*t*sqrt(pi*n)",
        ),
        ("gamma_function(n + 1) = n*gamma_function(n/2)", "gamma(n + 1) = n*gamma(n)"),
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
        ("2*a < a", "2*a > a"),
        ("p_0 = 2*P/a", "p_0 = 2*P/(pi*a)"),
        ("K_N = p_0/sqrt(a)", "K_N = p_0*sqrt(2/a)"),
        ("Q/(f*P) = 1 - l/a", "Q/(P*f) = 1 - l**2/a**2"),
        ("Q = f*P*(1 - l/a)**2", "Q = P*f*(1 - l**2/a**2)"),
        ("l/a = sqrt(1 + Q/(f*P))", "l/a = sqrt(1 - Q/(P*f))"),
        ("l = sqrt(1 - Q/(f*P))", "l = a*sqrt(1 - Q/(P*f))"),
        ("a = 4*P*R/(pi*E_star)", "a = 2*sqrt(P*R/(pi*E_star))"),
        ("p_0 = sqrt(P*E_star/pi)", "p_0 = sqrt(E_star*P/(pi*R))"),
        ("p_at_x = p_0*sqrt(1 - x/a)", "p_at_x = p_0*sqrt(1 - x**2/a**2)"),
        ("p_at_x = p_0*sqrt(a**2 - x**2)", "p_at_x = p_0*sqrt(a**2 - x**2)/a"),
        (
            "q_at_x = f*p_0*(sqrt(1 - x**2/a**2) - sqrt(1 - x**2/l**2))",
            "q_at_x = f*p_0*(sqrt(1 - x**2/a**2) - l*sqrt(1 - x**2/l**2)/a)",
        ),
        ("Q/(f*P) = cos(phi_0)", "Q/(P*f) = cos(phi_0)**2"),
        ("K_N = p_0*sqrt(2*a)", "K_N = p_0*sqrt(2/a)"),
        ("P = 2*integral(p_at_s, s, 0, l)", "P = 2*integral(p_at_s, s, 0, a)"),
        # an end of an integral comes before a factor
        ("P = 2*integral(p_at_s, s, -a, a)", "P = 2*integral(p_at_s, s, 0, a)"),
        ("P = integral(p_at_s, s, 0, a)", "P = integral(p_at_s, s, -a, a)"),
        ("integral(p_at_s, s, 0, a) = P", "integral(p_at_s, s, -a, a) = P"),
    ],
    WEDGE: [
        ("tan(theta) = 2*sqrt(a*c)/(a - c)", "cot(theta) = 2*sqrt(a*c)/(a - c)"),
        ("cos(theta) = (a - c)/(a + c)", "sin(theta) = (a - c)/(a + c)"),
        ("sin(pi*alpha/phi) = (a - c)/(a + c)", "sin(pi*alpha/(2*phi)) = (a - c)/(a + c)"),
        ("alpha = 2*phi/pi*acos((a - c)/(a + c))", "alpha = 2*phi*asin((a - c)/(a + c))/pi"),
        ("c/a = tan(theta/2)**2", "c/a = cot(theta/2 + pi/4)**2"),
        ("P = E_star*phi*a*c", "P = E_star*phi*sqrt(a*c)"),
        ("K_N = 2*E_star*phi/pi*sqrt(c/(a + c))", "K_N = 2*E_star*phi*sqrt(c/(a*(a + c)))/pi"),
    ],
    FLAT: [
        (
            "K_N = E_star*sqrt(2*a)/(pi*R)*phi_0",
            "K_N = E_star*sqrt(2*a)*(-phi_0 + pi/2)/(pi*R)",
        ),
    ],
    PUNCH: [
        (
            "K_T = dQ/(pi*sqrt(2*a)) + sqrt(2*a)/8",
            "K_T = dQ*sqrt(2/a)/(2*pi) + dsigma*sqrt(2*a)/8",
        ),
        (
            "integral(p_at_s, s, 0, a) = P/pi*acos(c/a)",
            "integral(p_at_s, s, c, a) = P*acos(c/a)/pi",
        ),
    ],
}
"""The right equation for each misprint, by the head of the file."""


@pytest.mark.parametrize(
    ("head", "printed", "right"),
    [(head, *each) for head, rows in MISPRINTS.items() for each in rows],
)
def test_a_misprint_is_corrected(tmp_path: Path, head: str, printed: str, right: str) -> None:
    finding = judged(tmp_path, printed, head=head)
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
        # 1 = 1 and x = x say nothing
        "sign(a - 1/100000) = 1",
        "x = sqrt(abs(x))**2",
    ],
)
def test_no_correction_is_found(tmp_path: Path, printed: str) -> None:
    finding = judged(tmp_path, printed)
    assert (finding.verdict, finding.repair) == (Verdict.FAILS, None)
    assert finding.tried


@pytest.mark.parametrize(
    ("printed", "end", "order", "right"),
    [
        # l/a = sqrt(1 - w) = 1 - w/2 + O(w**2), where w is Q/(f P)
        ("1 - l/a ~ Q/(f*P)", "k -> 1", "", "1 - l/a ~ Q/(2*P*f)"),
        ("l/a = 1 - Q/(f*P)", "k -> 1", "2", "l/a = 1 - Q/(2*P*f)"),
        # near an edge, the pressure is K_N sqrt(a - x); with l near to a, Q is 2 f P (1 - l/a)
        ("p_at_x ~ K_N*(a - x)", "x -> a", "", "p_at_x ~ K_N*sqrt(a - x)"),
        ("Q ~ 2*P*(1 - l/a)", "l -> a", "", "Q ~ 2*P*f*(1 - l/a)"),
        # a term that does not matter may be anything
        ("sin(t) = t - t**2/2", "t -> 0", "3", None),
    ],
)
def test_a_correction_near_a_limit_stands_out(
    tmp_path: Path, printed: str, end: str, order: str, right: str | None
) -> None:
    more = f'as = "{end}"\n' + (f"order = {order}" if order else "")
    finding = asking.judged(tmp_path, HEAD + asking.claim(printed, more))
    assert finding.verdict == Verdict.FAILS
    assert corrected(finding) == right


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


@pytest.mark.parametrize("end", ["l - a -> 0", "k -> 1"])
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
