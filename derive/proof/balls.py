"""Numbers of the integrands: python-flint's ball arithmetic, ten times as fast as mpmath's.

In:  mpmath's numbers, and SymPy's expressions.
Out: balls (a number and how far rounding may have moved it), and functions of balls.

Between integrals numbers are mpmath's; inside an integrand they are balls of so many digits as
`digits` sets.  A ball that rounding has widened without limit is no number: nothing is hidden.
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

from derive.compiled import compiled

Ball = arb

_BITS = 3.3219280948873626
"""In a digit."""


def digits(count: int) -> AbstractContextManager[None]:
    """Balls of so many digits, for the length of a `with`."""
    return bits(int(count * _BITS) + 5)


def bits(count: int) -> AbstractContextManager[None]:
    """Balls of so many bits, for the length of a `with`."""
    return ctx.workprec(count)


def ball(value: mpf) -> Ball:
    """An mpf, to its last bit."""
    return arb(value)


def number(value: Ball | int) -> mpf:
    """The middle of a ball, to its last bit; not a number where the ball has none."""
    value = arb(value)
    if not value.is_finite():
        return mpf("nan")
    mantissa, exponent = value.mid().man_exp()
    return mpmath.mp.make_mpf(from_man_exp(int(mantissa), int(exponent)))


def function_of(symbols: Sequence[Symbol], expr: Expr, shared: bool = False) -> Callable[..., Ball]:
    """An expression as a function of balls.

    shared: compute once what it repeats, if there are no branches: one that is not taken may have
    no value.
    """
    return _compiled(symbols, expr, shared and not expr.has(Piecewise))


def functions_of(symbols: Sequence[Symbol], exprs: Sequence[Expr]) -> Callable[..., Sequence[Ball]]:
    """Several expressions as one function of balls; what they repeat is computed once."""
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
    """base**power, of a ball that holds zero, too, where flint goes by the logarithm.

    A whole power is a product there.  Any other has no value below zero: what the ball reaches
    below it is rounding.
    """
    base = arb(base)
    value = base**power
    if value.is_finite() or not power > 0 or not base.contains(0):
        return value
    if isinstance(power, int):
        return reduce(mul, [base] * power)
    return arb(0).union(base.upper() ** power)


def _root(base: Ball | int) -> Ball:
    """The square root as `_raised` has it."""
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
    """Constants to the digits that balls have when they are asked for."""

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
