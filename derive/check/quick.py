"""Evaluate an expression quickly to a few digits, to reject candidates that are clearly wrong."""

import cmath
from collections.abc import Callable, Mapping
from functools import cache
from math import prod

from sympy import Abs, Add, Expr, Mul, Pow, Symbol, acos, asin, atan, cos, exp, log, sign, sin, tan


class Unknown(Exception):
    """There is no rule for a function, or no value at this point."""


def approximately(expr: Expr, numbers: Mapping[Symbol, complex]) -> complex:
    """Evaluate `expr` in double precision; raises Unknown."""
    try:
        return _value(expr, numbers)
    except (ZeroDivisionError, OverflowError, ValueError, KeyError) as error:
        raise Unknown(str(expr)) from error


def _value(expr: Expr, numbers: Mapping[Symbol, complex]) -> complex:
    if isinstance(expr, Symbol):
        return numbers[expr]
    if expr.is_number:
        return _constant(expr)
    rule = _RULES.get(expr.func)
    if rule is None:
        raise Unknown(str(expr.func))
    return rule([_value(arg, numbers) for arg in expr.args])


@cache
def _constant(expr: Expr) -> complex:
    try:
        return complex(expr)
    except TypeError as error:  # SymPy could not reduce the expression to a number
        raise Unknown(str(expr)) from error


def _of_one(function: Callable[[complex], complex]) -> Callable[[list[complex]], complex]:
    return lambda values: function(values[0])


_RULES: dict[type, Callable[[list[complex]], complex]] = {
    Add: sum,
    Mul: prod,
    Pow: lambda values: values[0] ** values[1],
    Abs: _of_one(lambda value: complex(abs(value))),
    sign: _of_one(lambda value: value / abs(value)),
    **{f: _of_one(getattr(cmath, f.__name__)) for f in (sin, cos, tan, asin, acos, atan, exp, log)},
}
