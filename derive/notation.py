"""Formulas as text and LaTeX, always rendered from expressions and never typed by hand."""

import re
from functools import cache

from sympy import Add, Basic, Expr, Mul, Pow, Rel, S, Symbol, latex, sstr

from derive.symbols import QUANTITIES

_OWN = {
    "K_N_left": r"K_{N,\mathrm{left}}",
    "K_N_right": r"K_{N,\mathrm{right}}",
    "L_N_left": r"L_{N,\mathrm{left}}",
    "L_N_right": r"L_{N,\mathrm{right}}",
    "K_T_left": r"K_{T,\mathrm{left}}",
    "K_T_right": r"K_{T,\mathrm{right}}",
    "dq": r"\Delta q",
    "a_prime": "a'",
    "P_prime": "P'",
    "k_left": r"k_{\mathrm{left}}",
    "k_right": r"k_{\mathrm{right}}",
}

_AT_EDGE = re.compile(r"q_(left|right)_(\d+)")
"""Name of the root of a quadratic at an edge."""

_OF_HALF = re.compile(r"(sin|cos|tan|cot)_(\w+)")
"""Name of the sine, cosine, tangent or cotangent of half the angle of a point."""


def text_of(expr: Basic) -> str:
    """`expr` as one line of text."""
    return str(sstr(gathered(expr)))


def latex_of(expr: Basic) -> str:
    """`expr` in LaTeX, in the notation of the theory."""
    symbols = {s: _names()[s.name] for s in expr.atoms(Symbol) if s.name in _names()}
    for s in expr.atoms(Symbol):
        if found := _AT_EDGE.fullmatch(s.name):
            symbols[s] = rf"q_{{\mathrm{{{found[1]}}},{found[2]}}}"
        elif found := _OF_HALF.fullmatch(s.name):
            symbols[s] = rf"\{found[1]}_{{{found[2]}}}"
    return str(latex(gathered(expr), symbol_names=symbols, ln_notation=True))


@cache
def _names() -> dict[str, str]:
    return _OWN | {q.name: q.latex for q in QUANTITIES.values() if q.latex}


def gathered(expr: Basic) -> Basic:
    """`expr` with the half powers of every product under one root, e.g. sqrt(P R/E*)."""
    if not expr.args:
        return expr
    args = [gathered(arg) for arg in expr.args]
    if isinstance(expr, Mul):
        return gathered_product(args)
    if isinstance(expr, Add | Pow | Rel):  # otherwise P > 0 becomes True for a positive P
        return expr.func(*args, evaluate=False)
    return expr.func(*args)


def gathered_product(factors: list[Expr]) -> Expr:
    """A product with its half powers under one root."""
    halves = [f for f in factors if is_half_power(f)]
    if len(halves) < 2:
        return Mul(*factors, evaluate=False)
    rest = [f for f in factors if not is_half_power(f)]
    inside = Mul(*(f.base ** (2 * f.exp) for f in halves))
    return Mul(*rest, Pow(inside, S.Half, evaluate=False), evaluate=False)


def is_half_power(factor: Expr) -> bool:
    """Whether a factor is a root or one over a root."""
    return bool(factor.is_Pow and factor.exp.is_Rational and abs(factor.exp) == S.Half)
