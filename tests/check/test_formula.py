"""What the functions mean that act along a variable, and others that only claims may use."""

import pytest
from sympy import Expr, Integral, Rational, Symbol, exp, log, pi, solve, sqrt

from derive.proof.kinks import switches
from derive.reading.formula import Names, formula
from derive.reading.improper import proper
from derive.reading.words import FUNCTIONS

x, y, a = Symbol("x", real=True), Symbol("y"), Symbol("a", positive=True)
NAMES = Names("here", {"x": x, "a": a, "d": 2 * a}, {})
POINT = {x: Rational(3, 10), a: Rational(7, 10)}

MEANINGS = {
    "integral(exp(s), s, -oo, a)": exp(a),
    "integral(exp(-s), s, a, oo)": exp(-a),
    "integral(exp(-s**2), s, -oo, oo)": sqrt(pi),
    "integral(x*t, t, 0, a)": x * a**2 / 2,
    "pv(1/(s - x), s, x - 1, x + 3)": log(3),
    "sum(d, d, 1, 3) + d": 6 + 2 * a,  # d is another one inside
    "sum(1/j**2, j, 1, oo)": pi**2 / 6,
    "diff(x**3, x, 2)": 6 * x,
    "limit(abs(t)/t, t, 0)": 1,  # from above, because t is known only here
    "limit(sin(x)/x, x, 0)": 1,
    "limit((a*t + 1)/t, t, oo)": a,
    "elliptic_k(0) + elliptic_e(1)": pi / 2 + 1,
    "elliptic_pi(3/4, 0)": pi,  # pi/(2 sqrt(1 - n))
    "gamma_function(3/2)": sqrt(pi) / 2,
    "cot(pi/6) + sec(pi/3) + csc(pi/6)": sqrt(3) + 4,
    "asec(2) + acsc(2)": pi / 2,
    "coth(log(2)) - sech(log(2)) + csch(log(2))": Rational(5, 3) - Rational(4, 5) + Rational(4, 3),
    "acoth(5/3) + asech(4/5)": 2 * log(2),
    "acsch(4/3)": log(2),
}


@pytest.mark.parametrize("text", MEANINGS)
def test_a_formula_means_what_it_says(text: str) -> None:
    read = proper(formula(text, NAMES))
    value: Expr = (read if read.has(Integral) else read.doit()).subs(POINT)
    meant = Rational(1) * MEANINGS[text]
    assert abs(value.evalf() - meant.subs(POINT).evalf()) < 1e-9


NOT_SMOOTH = {
    **dict.fromkeys(("Abs", "abs", "sign", "Heaviside", "log", "sqrt"), (0,)),
    **dict.fromkeys(("asin", "acos", "atanh"), (-1, 1)),
    **dict.fromkeys(("acosh", "elliptic_k", "elliptic_e"), (1,)),
    "tan": (pi / 2, 3 * pi / 2),  # in one turn
}
"""Where a function of one argument kinks, jumps or is infinite, or its derivative is; by hand."""


OF_ONE = [name for name, each in FUNCTIONS.items() if each.most == 1]


@pytest.mark.parametrize("name", [n for n in OF_ONE if "reciprocal" not in FUNCTIONS[n].like])
def test_it_is_known_where_a_function_is_not_smooth(name: str) -> None:
    read = formula(f"{name}(y)", Names("here", {"y": y}, {}))
    zeros = {zero for each in switches(read) for zero in solve(each.of, y)}
    assert zeros == {*NOT_SMOOTH.get(name, ())}


def test_functions_of_several_arguments_are_not_smooth_where_two_agree_or_one_is_one() -> None:
    found = switches(formula("max(x, 1, a) + elliptic_pi(a, x)", NAMES))
    distances = {(each.kind, abs(each.of.subs(POINT))) for each in found}
    kinks = {("kink", Rational(tenths, 10)) for tenths in (7, 4, 3)}
    assert distances == kinks | {("branch", Rational(3, 10)), ("branch", Rational(7, 10))}
