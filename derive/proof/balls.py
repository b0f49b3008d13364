"""Numbers for the integrands: python-flint's ball arithmetic, ten times as fast as mpmath's.

In:  mpmath's numbers, and SymPy's expressions.
Out: balls (a number with a bound on its rounding error), and functions of balls.

Outside integrals, numbers are those of mpmath.  Inside an integrand, they are balls with the number
of digits that `digits` sets.  A ball whose error is unbounded counts as not a number, so that no
loss of digits is hidden.
"""

from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager
from functools import reduce
from operator import mul
from typing import Any

import mpmath
from flint import arb, ctx
from mpmath import mpf
from mpmath.libmp import from_man_exp
from sympy import Expr, Float, Piecewise, Pow, Rational, S, Symbol
from sympy.printing.pycode import MpmathPrinter

from derive.body.compiled import compiled

Ball = arb

_BITS = 3.3219280948873626
"""Bits per digit."""


def digits(count: int) -> AbstractContextManager[None]:
    """Use balls with this many digits in a `with` block."""
    return bits(int(count * _BITS) + 5)


def bits(count: int) -> AbstractContextManager[None]:
    """Use balls with this many bits in a `with` block."""
    return ctx.workprec(count)


def ball(value: mpf) -> Ball:
    """The exact ball of an mpf."""
    return arb(value)


def number(value: Ball | int) -> mpf:
    """The exact midpoint of a ball; NaN if the ball has none."""
    value = arb(value)
    if not value.is_finite():
        return mpf("nan")
    mantissa, exponent = value.mid().man_exp()
    return mpmath.mp.make_mpf(from_man_exp(int(mantissa), int(exponent)))


def function_of(symbols: Sequence[Symbol], expr: Expr, shared: bool = False) -> Callable[..., Ball]:
    """An expression as a function of balls.

    shared: compute repeated subexpressions once.  This is not done for an expression with branches,
    because a branch that is not taken may have no value.
    """
    return _compiled(symbols, expr, shared and not expr.has(Piecewise))


def functions_of(symbols: Sequence[Symbol], exprs: Sequence[Expr]) -> Callable[..., Sequence[Ball]]:
    """Several expressions as one function of balls; repeated subexpressions are computed once."""
    return _compiled(symbols, exprs, True)


def _compiled(
    symbols: Sequence[Symbol], expr: Expr | Sequence[Expr], shared: bool
) -> Callable[..., Any]:
    names = [_FUNCTIONS, "math"]
    return compiled(symbols, expr, modules=names, printer=_BallPrinter(), shared=shared)


def _method(name: str) -> Callable[[Ball], Ball]:
    of = getattr(arb, name)
    return lambda value: of(value if type(value) is arb else arb(value))


def _raised(base: Ball | int, power: Ball | int) -> Ball:
    """base**power, also for a ball that contains zero, for which flint would use the logarithm.

    An integer power is then a product.  Any other power has no value below zero; the part of the
    ball below zero is due to rounding.
    """
    base = arb(base)
    value = base**power
    if value.is_finite() or not power > 0 or not base.contains(0):
        return value
    if isinstance(power, int):
        return reduce(mul, [base] * power)
    return arb(0).union(base.upper() ** power)


def _root(base: Ball | int) -> Ball:
    """The square root, in the same way as in `_raised`."""
    base = arb(base)
    value = base.sqrt()
    return arb(0).union(base.upper().sqrt()) if value.is_nan() and base.contains(0) else value


_FUNCTIONS = {
    **{
        name: _method(name)
        for name in (
            *("exp", "log", "sin", "cos", "tan", "asin", "acos", "atan"),
            *("sinh", "cosh", "tanh", "asinh", "acosh", "atanh"),
        )
    },
    "atan2": lambda y, along: arb.atan2(arb(y), arb(along)),
    "sign": _method("sgn"),
    "sqrt": _root,
    "_raised": _raised,
    "_quotient": lambda above, below: arb(above) / below,
    "_exactly": lambda mantissa, exponent: arb((mantissa, exponent)),
    "pi": arb.pi,
    "e": arb.const_e,
}


class _BallPrinter(MpmathPrinter):
    """Prints constants with the precision that balls have when the function is called."""

    def __init__(self) -> None:
        super().__init__({"fully_qualified_modules": False, "inline": True})

    def _print_Pi(self, expr: Expr) -> str:
        return "pi()"

    def _print_Exp1(self, expr: Expr) -> str:
        return "e()"

    def _print_Rational(self, expr: Rational) -> str:
        return f"_quotient({expr.p}, {expr.q})"

    _print_Half = _print_Rational

    def _print_Pow(self, expr: Pow, rational: bool = False) -> str:
        if abs(expr.exp) == S.Half or expr.exp == -1:
            return super()._print_Pow(expr)
        return f"_raised({self._print(expr.base)}, {self._print(expr.exp)})"

    def _print_Float(self, expr: Float) -> str:
        sign, mantissa, exponent, _ = expr._mpf_
        return f"_exactly({-int(mantissa) if sign else int(mantissa)}, {exponent})"
