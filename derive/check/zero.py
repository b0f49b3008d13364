"""Decide by exact steps alone whether an expression vanishes identically.

No step changes the value.  A result of zero is therefore a proof, and any other number is a
disproof; every other result is inconclusive.  An expression whose derivative is zero vanishes
everywhere if it vanishes at one point, provided that it is shown to be continuous over its whole
range.  Expressions that are too long are not examined.
"""

from collections.abc import Callable, Mapping

from sympy import (
    Abs,
    Expr,
    Integral,
    Pow,
    Rational,
    Symbol,
    cancel,
    count_ops,
    diff,
    expand,
    expand_trig,
    factor,
    log,
    powdenest,
    radsimp,
    simplify,
    together,
    trigsimp,
)

from derive.check.claim import Range
from derive.check.domain import is_continuous
from derive.reading.limits import terms

_LONGEST = 400
"""The largest number of operations in an expression that is examined."""
_MOST_TERMS = 50_000
"""The largest number of terms after expansion, by a bound computed before the expansion."""
_SHORT = 90
"""The largest number of operations for which `simplify` and `trigsimp` are tried."""


def vanishes(expr: Expr, ranges: Mapping[Symbol, Range]) -> str:
    """Return how `expr` was shown to vanish, or an empty string if it was not.

    ranges: the range of every variable.
    """
    if _is_too_long(expr):
        return ""
    if _is_zero(expr):
        return "the difference of the two sides is zero"
    if not is_continuous(expr, ranges):
        return ""
    for variable, span in ranges.items():
        value = span.place
        if expr.has(variable) and _is_zero(diff(_plain(expr), variable)):
            held_at = expr.subs(variable, value)
            if _is_zero(held_at):
                return f"the difference does not depend on {variable} and is zero at {value}"
            expr = held_at
    return ""


def vanishes_at(expr: Expr, point: Mapping[Symbol, Rational]) -> bool:
    """Whether `expr` is shown to be zero at one exact point."""
    placed = expr.xreplace(dict(point))
    return not _is_too_long(placed) and _is_zero(placed)


def constant(expr: Expr) -> Expr | None:
    """Return the nonzero number that `expr` is shown to equal, or None."""
    if _is_too_long(expr):
        return None
    left = _reduced(expr)
    return left if left.is_number and left.is_nonzero else None


def _is_too_long(expr: Expr) -> bool:
    return expr.has(Integral) or count_ops(expr) > _LONGEST or terms(expr) > _MOST_TERMS


def _plain(expr: Expr) -> Expr:
    """Replace log|f| by log f; both have the derivative f'/f where f is not zero."""
    return expr.replace(
        lambda n: isinstance(n, log) and isinstance(n.args[0], Abs),
        lambda n: log(n.args[0].args[0]),
    )


def _is_zero(expr: Expr) -> bool:
    return bool(_reduced(expr) == 0)


def _reduced(expr: Expr) -> Expr:
    """Apply all steps to `expr`, and stop early if it becomes a rational number."""
    for step in _STEPS:
        if expr.is_Rational:
            return expr
        expr = step(expr)
        if count_ops(expr) > 4 * _LONGEST:
            return expr
    return expr


def _angles(expr: Expr) -> Expr:
    """Expand the arguments of functions, then the functions of sums of angles."""
    return expand_trig(
        expr.replace(
            lambda n: n.is_Function and not n.is_Piecewise, lambda n: n.func(*map(expand, n.args))
        )
    )


def _roots(expr: Expr) -> Expr:
    """Write every radicand as one factored quotient."""
    return expr.replace(
        lambda n: isinstance(n, Pow) and n.exp.is_Rational and n.exp.q == 2,
        lambda n: powdenest(factor(cancel(together(n.base))) ** n.exp, force=False),
    )


def _functions(expr: Expr) -> Expr:
    """Write every function argument as one quotient, so that equal arguments look equal."""
    return expr.replace(
        lambda n: n.is_Function and not n.is_Piecewise,
        lambda n: n.func(*(factor(cancel(together(radsimp(_roots(arg))))) for arg in n.args)),
    )


def _quotient(expr: Expr) -> Expr:
    return cancel(together(expr))


def _rationalised(expr: Expr) -> Expr:
    return expand(radsimp(expr))


def _searched(expr: Expr) -> Expr:
    return simplify(expr) if count_ops(expr) <= _SHORT else expr


_STEPS: tuple[Callable[[Expr], Expr], ...] = (
    _roots,
    expand,
    _angles,
    _roots,
    _quotient,
    _roots,
    _functions,
    expand,
    _rationalised,
    _quotient,
    lambda e: trigsimp(e) if count_ops(e) <= _SHORT else e,
    _searched,
)
