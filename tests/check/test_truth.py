"""What is false never holds, what is true never fails, and each verdict says what it rests on."""

from pathlib import Path

import pytest

from tests.check import asking

FREE = """
body = "none"
[variables]
w = { low = 0.5, high = 2 }
a = { unit = "m" }
d = { unit = "m" }
n = { unit = "-" }
k = { low = 0.1, high = 0.9 }
m = { low = 0, high = 1 }
[symbols]
psi = "w**2"
F = "1 + w"
G = "n**2"
c = "k*a"
"""
HERTZ = """
body = "hertz"
[variables]
a = { unit = "m" }
k = { unit = "-" }
[symbols]
c = "k*a"
P = "load(a, a)"
p_0 = "2*P/(pi*a)"
Q = "f*(load(a, a) - load(c, c))"
"""
WEDGE = """
body = "wedge"
[variables]
a = { unit = "m" }
c = { unit = "m" }
[symbols]
P = "load(a, c)"
alpha = "tilt(a, c)"
"""
SIGNED = """
[variables]
v = { low = -3, high = 3 }
y = { low = -3, high = 3 }
t = { low = 0, high = 100 }
"""
STEEL = """
body = "hertz"
[variables]
a = { low = 0.001, high = 0.002 }
R = { low = 0.1, high = 0.2 }
E_star = { low = 1e5, high = 2e5 }
x = { low = -0.001, high = 0.001 }
[symbols]
P = "load(a, a)"
p = "pressure(x, a, a)"
"""
CIRCULAR = HERTZ.replace('"2*P/(pi*a)"', '"3*load(a, a)/(2*pi*a)"')
AS_Q = 'as = "Q -> 0"\norder = 1'
TILT = 'as = "alpha -> 0"'
N_0 = 'as = "n -> 0"'

# By hand: Q = f P (1 - k**2), so that k -> 1 as Q -> 0, and (a - c)/a = 1 - k ~ Q/(2 f P); p_0 is
# E* a/(2 R).  The load of a wedge is E* phi sqrt(a c), and a -> c as its tilt vanishes.
CASES = [
    # what an integral, a sum, a limit or a derivative runs over
    (FREE, "limit(F, psi, 0) = 1 + w", "", "unchecked"),
    (FREE, "limit(F, psi, 0) = 1", "", "unchecked"),
    (FREE, "sum(F, psi, 1, 2) = 2*F", "", "unchecked"),
    (FREE, "integral(F, psi, 0, 1) = F", "", "unchecked"),
    (FREE, "diff(F, psi) = 0", "", "unchecked"),
    (FREE, "sum(G, n, 1, 2) = 2*G", "", "unchecked"),  # G is n**2
    (FREE, "limit(F, w, 0) = 1", "", "by definition"),
    (FREE, "sum(n**2, n, 1, 2) = 5", "", "holds"),
    (HERTZ, "limit(Q, c, a) = Q", "", "unchecked"),
    (HERTZ, "limit(Q, c, a) = 0", "", "unchecked"),
    (HERTZ, "limit(Q, k, 1) = 0", "", "by definition"),
    (FREE, "limit(Piecewise((1, x < 0), (2, True)), x, 0) = 2", "", "unchecked"),  # 1 from below
    # which variable moves
    (HERTZ, "(a - c)/a ~ Q/(2*f*P)", 'as = "Q -> 0"', "numerical"),
    (HERTZ, "(a - c)/a ~ Q/(f*P)", 'as = "Q -> 0"', "fails"),
    (HERTZ, "f*p_0 = f*E_star*a/R", AS_Q, "fails"),
    (HERTZ, "f*p_0 = f*E_star*a/(2*R)", AS_Q, "numerical"),
    (HERTZ, "Q ~ f*P", 'as = "c -> 0"', "unchecked"),  # k or a may vanish
    (WEDGE, "P ~ E_star*phi*a", TILT, "numerical"),
    (WEDGE, "P ~ 2*E_star*phi*a", TILT, "fails"),
    (FREE, "log(a/d) ~ log(1/d)", 'as = "d -> 0"', "unchecked"),  # true, but very slowly
    (FREE, "1/log(d) ~ 2/log(d)", 'as = "d -> 0"', "fails"),
    (FREE, "d + d*log(d) = d", 'as = "d -> 0"\norder = 1', "fails"),
    (FREE, "d + d**2*log(d) = d", 'as = "d -> 0"\norder = 1', "numerical"),
    (FREE, "sin(1/d) + 2 ~ 2", 'as = "d -> 0"', "unchecked"),
    (FREE, "d*(2 + sin(1/d)) = 0", 'as = "d -> 0"\norder = 1', "unchecked"),
    (FREE, "abs(x) = x", 'as = "x -> 0"\norder = 2', "fails"),  # from below
    # how near to the limit, and how precisely, the sides are compared
    (FREE, "n ~ n/sqrt(2)", N_0, "fails"),
    (FREE, "n ~ 0.7071067811865475*n", N_0, "fails"),
    (FREE, "n ~ n*(1 + 10**(-30))", N_0, "fails"),
    (HERTZ, "(a - c)/a ~ Q/(sqrt(2)*f*P)", 'as = "Q -> 0"', "fails"),
    (FREE, "n/(n + 10**(-20)) ~ 1", N_0, "fails"),
    (FREE, "n/(n + 10**(-20)) = 0", f"{N_0}\norder = 1", "numerical"),
    (FREE, "2*n + 10**(-25)*sqrt(n) = 0", f"{N_0}\norder = 1", "fails"),
    (FREE, "2*n + 10**(-30)*sqrt(n) = 0", f"{N_0}\norder = 1", "unchecked"),
    (FREE, "n + n**0.999/1000 = 0", f"{N_0}\norder = 1", "fails"),
    (FREE, "n + n**1.001/1000 = 0", f"{N_0}\norder = 1", "numerical"),
    (FREE, "n*(1 - 1/log(n)) = 0", f"{N_0}\norder = 1", "numerical"),
    (FREE, "sin(n) = n - n**3/6", f"{N_0}\norder = 5", "numerical"),
    (FREE, "sin(n) = n - n**3/6", f"{N_0}\norder = 5.001", "fails"),
    (FREE, "elliptic_k(1 - n) = log(4) - log(n)/2", f"{N_0}\norder = 0.9", "numerical"),
    (FREE, "elliptic_k(1 - n) = log(4) - log(n)/2", f"{N_0}\norder = 1", "fails"),
    (FREE, "integral(sin(s), s, 0, n) = n**2/2", f"{N_0}\norder = 4", "numerical"),
    (FREE, "integral(sin(s), s, 0, n) = n**2/2", f"{N_0}\norder = 5", "fails"),
    (FREE, "k*(0.9 - k) ~ 0.9*(0.9 - k)", 'as = "k -> 0.9"', "numerical"),
    # values at an edge, and at the end of a stick zone
    (HERTZ, "pressure(-a, a, a) = 0", "", "holds"),
    (HERTZ, "pressure(a, a, a) = p_0", "", "fails"),
    (HERTZ, "pressure(c, a, a) - pressure(c, c, c) = E_star*sqrt(a**2 - c**2)/(2*R)", "", "holds"),
    (HERTZ, "pressure(c, a, a) - pressure(c, c, c) = E_star*(a - c)/(2*R)", "", "fails"),
    # what is true by the definitions alone
    (CIRCULAR, "p_0 = 3*P/(2*pi*a)", "", "by definition"),
    (CIRCULAR, "P = 2*pi*a*p_0/3", "", "by definition"),
    (CIRCULAR, "p_0**2 = 9*P**2/(4*pi**2*a**2)", "", "by definition"),
    (CIRCULAR, "(p_0 + 1)**2 - 1 = 3*P/(pi*a) + 9*P**2/(4*pi**2*a**2)", "", "by definition"),
    (CIRCULAR, "diff(p_0*a, a) = 3/(2*pi)*diff(P, a)", "", "by definition"),
    (HERTZ, "p_0 = 2*P/(pi*a)", 'symbols = { P = "p_0*pi*a/2", p_0 = "E_star" }', "by definition"),
    (CIRCULAR, "p_0 = 2*P/(pi*a)", "", "fails"),
    (FREE, "c = 5*a", 'through = "c + 1 = 1 + c"', "unchecked"),
    # inequalities, and what lies beyond the points
    (FREE, "k**2 < k", "", "holds"),
    (FREE, "k*m < 1", "", "holds"),
    (FREE, "k*m <= 0.9", "", "holds"),  # equal in a corner
    (FREE, "k*m < 0.9", "", "unchecked"),
    (FREE, "w > 0.5", "", "unchecked"),
    (FREE, "m > 0", "", "unchecked"),
    (FREE, "m >= 0", "", "holds"),
    (FREE, "1/(k - 0.4321) > -10**9", "", "fails"),
    (FREE, "1/(k - 0.4321) < 10**30", "", "fails"),
    (FREE, "1/(k - m) < 10**9", "", "fails"),
    (FREE, "1/(k - 0.4321)**2 > 1", "", "holds"),
    (FREE, "log(abs(k - 0.3)) > -40", "", "fails"),
    (FREE, "(k - 0.54321)**2 > 10**(-20)", "", "fails"),
    (FREE, "(k - 0.54321)**2 > -10**(-20)", "", "holds"),
    (FREE, "(k - 0.54321)**2 > 0", "", "unchecked"),
    (FREE, "(a - d)**2 + (a - w)**2 > 0", "", "unchecked"),
    (FREE, "a**2 + d**2 >= 2*a*d", "", "holds"),
    (FREE, "d**2 < a**2", 'require = "d < a"', "holds"),
    (FREE, "k/(1 + k) < 0.4736842105", "", "fails"),  # 9/19 = 0.47368421052... at the end
    (FREE, "k/(1 + k) < 0.4736842106", "", "holds"),
    (FREE, "n*exp(-n) < 0.37", "ranges = { n = [0, 20] }", "holds"),  # 1/e = 0.3679
    (FREE, "abs(1 - sqrt(1 - k**2)) < 1", "", "holds"),
    (FREE, "elliptic_k(k) > elliptic_e(k)", "", "holds"),
    (FREE, "integral(s**k, s, 0, 1) > 0.5", "", "unchecked"),
    (FREE, "Piecewise((5, abs(k - 0.32123) < 10**(-12)), (2, True)) < 3", "", "fails"),
    (FREE, "Max(0, sin(10**6*k) - 0.9999999) <= 0", "", "fails"),
    (SIGNED, "Min(v, y) < Max(v, y)", "", "unchecked"),
    (SIGNED, "abs(v + y) < abs(v) + abs(y)", "", "fails"),
    (FREE, "1/(k - 0.3) > 0", 'require = "k > 0.3"', "holds"),
    (FREE, "1/(k - 0.3) > 0", 'require = "k > 0.29"', "fails"),
    (FREE, "a < 10**7", "", "unchecked"),
    (HERTZ, "P < 10**20*E_star*a", "", "unchecked"),  # false if a is large enough
    (HERTZ, "P < 10**20*E_star*(R + a)*a/R", "", "numerical"),
    (STEEL, "p < E_star*a/(2*R)", "", "unchecked"),  # equal at x = 0
    # roots, inverse functions, kinks and periods
    (SIGNED, "sqrt(v**2) = v", "", "fails"),
    (SIGNED, "sqrt((v - 3)*(y - 3)) = sqrt(v - 3)*sqrt(y - 3)", "", "fails"),
    (SIGNED, "atan(v) + atan(y) = atan((v + y)/(1 - v*y))", "", "fails"),
    (SIGNED, "acos(cos(v)) = abs(v)", "", "numerical"),
    (SIGNED, "Max(v, y) = (v + y + abs(v - y))/2", "", "numerical"),
    (SIGNED, "Max(v, -2.99999999) = v", "", "fails"),
    (SIGNED, "cos(2*pi*10**6*t) = 1", "", "fails"),
    (FREE, "integral(sin(1000*pi*s)**2, s, 0, 1) = 0", "", "fails"),
    (FREE, "diff(integral(k*s**2, s, 0, k), k) = k**3", "", "fails"),
    (STEEL, "P = pi*E_star*a**2/(4*R) + 10**(-25)", "", "fails"),
    (STEEL, "P = pi*E_star*a**2/(4*R) + exp(-200)", "", "fails"),
    # prescribed cases
    (FREE, "pi*a**2 = 12.57", "cases = [{ a = 2 }]", "numerical"),  # 12.566
    (FREE, "pi*a**2 = 12.58", "cases = [{ a = 2 }]", "fails"),
    (FREE, "pi*a**2 = 12.57", "cases = [{ a = 2 }, { a = 3 }]", "fails"),
    (FREE, "a**2 = a", "cases = [{ a = 1 }]", "unchecked"),
    (FREE, "a**2 > k", "cases = [{ a = 1, k = 0.5 }]", "unchecked"),
    (FREE, "a*(a + 1) = a**2 + a", "cases = [{ a = 1 }]", "holds"),
    (FREE, "Piecewise((1, k < 0.2), (2, True)) < 3", "", "holds"),
    (FREE, "Max(0, a - 10**7) = 0", "", "unchecked"),
    (FREE, "Max(0, k - 10**7) = 0", "", "numerical"),
    (FREE, "tanh(10**9*a) = 1", "", "unchecked"),
    (FREE, "a = a*(1 + 10**(-90))", "", "fails"),
    (FREE, "a*(sqrt(2) + sqrt(3)) = a*sqrt(5 + 2*sqrt(6))", "", "holds"),
    (FREE, "a = 2*a/sqrt(4 + 10**(-90))", "", "fails"),
]


@pytest.mark.usefixtures("unmended")
@pytest.mark.parametrize(("head", "printed", "more", "verdict"), CASES)
def test_a_verdict_is_right(
    tmp_path: Path, head: str, printed: str, more: str, verdict: str
) -> None:
    (it,) = asking.told(tmp_path, head + asking.claim(printed, more))
    assert it["verdict"] == verdict, it["reason"]


def test_the_verdict_on_a_limit_says_what_moves(tmp_path: Path) -> None:
    claim = asking.claim("(a - c)/a ~ Q/(2*f*P)", 'as = "Q -> 0"')
    (it,) = asking.told(tmp_path, HERTZ + claim)
    assert "if k moves to 1.0 and E_star, R, a, f stay" in it["reason"]


@pytest.mark.parametrize(
    ("printed", "rests_on"),
    [
        ("P = pi*E_star*a**2/(4*R)", "the body"),
        ("P = integral(pressure(s, a, a), s, -a, a)", "the body"),
        ("load(c, c) = k**2*P", "the body"),
        ("P > 0", "the body"),
        ("sqrt(P**2) = P", "the body"),
        ("P < 10**20*E_star*(R + a)*a/R", "the body"),
        ("P**2 >= 0", "your definitions"),
        ("P = load(2*a/2, a)", "your definitions"),
        ("c**2 = a**2*k**2", "your definitions"),
        ("p_0 = 3*P/(2*pi*a)", "the body"),  # false
        ("E_star*(R + a) = E_star*R + E_star*a", "mathematics"),
        ("P = Z", None),
    ],
)
def test_a_verdict_says_what_it_rests_on(tmp_path: Path, printed: str, rests_on: str) -> None:
    (it,) = asking.told(tmp_path, HERTZ + asking.claim(printed))
    assert it["rests_on"] == rests_on


@pytest.mark.parametrize(
    ("printed", "verdict", "rests_on"),
    [
        ("P = pi*E_star*a**2/(2*R)", "holds", "the body and your definitions"),
        ("P = pi*E_star*a**2/(4*R)", "fails", "the body and your definitions"),
        ("c**2*P = a**2*load(c, c)", "holds", "the body"),  # R is not used
    ],
)
def test_a_parameter_may_be_defined_by_itself(
    tmp_path: Path, printed: str, verdict: str, rests_on: str
) -> None:
    claim = asking.claim(printed, 'symbols = { R = "2*R" }')  # R is the diameter
    (it,) = asking.told(tmp_path, HERTZ + claim)
    assert (it["verdict"], it["rests_on"]) == (verdict, rests_on)


GIVEN = """
[[claims]]
label = "(1)"
printed = "p_0 = 4*P/(pi*a)"
[[claims]]
label = "(2)"
printed = "t = 2*a"
[[claims]]
label = "(3)"
printed = "P = p_0*pi*a/4"
given = ["(1)"]
[[claims]]
label = "(4)"
printed = "P < p_0*a"
[[claims]]
label = "(5)"
printed = "p_0 = E_star*a/R"
symbols = { p_0 = "E_star*a/R" }
"""


@pytest.mark.usefixtures("unmended")
@pytest.mark.parametrize(
    ("printed", "given", "verdict", "told"),
    [
        ("P = p_0*pi*a/4", "(1)", "holds", "rests on given (1) (fails)"),
        ("u = 4*a**2", "(2)", "holds", "rests on given (2) (unchecked)"),  # u is t**2
        ("p_0 = 4*P/(pi*a)", "(3)", "holds", "given (3) (holds, rests on given (1) (fails))"),
        ("P = p_0*a", "(4)", "unchecked", "of the form symbol = ..."),
        ("p_0*R = E_star*a", "(5)", "unchecked", "no symbols, body or cases of its own"),
    ],
)
def test_a_claim_says_what_became_of_those_given(
    tmp_path: Path, printed: str, given: str, verdict: str, told: str
) -> None:
    claim = asking.claim(printed, f'given = ["{given}"]')
    text = HERTZ + 't = ""\nu = "t**2"\n' + GIVEN + claim
    it = asking.told(tmp_path, text)[-1]
    assert it["verdict"] == verdict, it["reason"]
    assert told in it["evidence"]
