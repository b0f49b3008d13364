"""Decide by exact steps alone whether an expression vanishes identically.

No step changes the value.  A result of zero is therefore a proof, and any other number is a
disproof; every other result is inconclusive.  An expression whose derivative is zero vanishes
everywhere if it vanishes at one point, provided that it is shown to be continuous over its whole
range: that none of its switches (see kinks) has a zero there.  Expressions that are too long are
not examined.
"""

from collections.abc import Callable, Iterator, Mapping

import sympy as sp
from sympy import Expr, Rational, Symbol
from sympy.functions.elementary.hyperbolic import HyperbolicFunction
from sympy.functions.elementary.trigonometric import TrigonometricFunction

from derive.check.claim import SCALE, Range
from derive.proof.kinks import switches
from derive.reading.limits import terms

_LONGEST = 400
"""The largest number of operations in an expression that is examined."""
_MOST_TERMS = 50_000
"""The largest number of terms after expansion, by a bound computed before the expansion."""
_MOST_SIGNS = 500
"""The same for an expression whose sign is examined term by term."""
_LARGEST = 100
"""The largest integer in an angle."""
_OF_ANGLES = (TrigonometricFunction, HyperbolicFunction)
_SHORT = 90
"""The largest number of operations for which `simplify` and `trigsimp` are tried."""


def vanishes(expr: Expr, ranges: Mapping[Symbol, Range]) -> str:
    """Return how `expr` was shown to vanish, or an empty string if it was not.

    ranges: the range of every variable.
    """
    if is_too_long(expr):
        return ""
    if _is_zero(expr):
        return "the difference of the two sides is zero"
    if not _is_continuous(expr, ranges):
        return ""
    for variable, span in ranges.items():
        if expr.has(variable) and _is_zero(sp.diff(_without_moduli(expr), variable)):
            expr = expr.subs(variable, span.place)
            if _is_zero(expr):
                return f"the difference does not depend on {variable} and is zero at {span.place}"
    return ""


def vanishes_at(expr: Expr, point: Mapping[Symbol, Rational]) -> bool:
    """Whether `expr` is shown to be zero at one exact point."""
    placed = expr.xreplace(dict(point))
    return not is_too_long(placed) and _is_zero(placed)


def constant(expr: Expr) -> Expr | None:
    """Return the nonzero number that `expr` is shown to equal, or None."""
    number = None if is_too_long(expr) else _reduced(expr)
    return number if number is not None and number.is_number and number.is_nonzero else None


def is_too_long(expr: Expr) -> bool:
    """Whether an expression is too long for exact steps, or contains an integral."""
    if expr.has(sp.Integral) or sp.count_ops(expr) > _LONGEST or terms(expr) > _MOST_TERMS:
        return True
    angles = [call.args[0] for call in expr.atoms(*_OF_ANGLES)]  # sin(n*x) has n terms
    return any(abs(number) > _LARGEST for angle in angles for number in angle.atoms(sp.Integer))


# ------------------------------------------------------------------ exact steps


def _is_zero(expr: Expr) -> bool:
    return bool(_reduced(expr) == 0)


def _reduced(expr: Expr) -> Expr:
    """Apply all steps to `expr`, and stop early if it becomes a rational number."""
    for step in _STEPS:
        if expr.is_Rational or sp.count_ops(expr) > 4 * _LONGEST:
            return expr
        expr = step(expr)
    return expr


def _in_arguments(change: Callable[[Expr], Expr]) -> Callable[[Expr], Expr]:
    """Return the step that changes the arguments of all functions."""
    return lambda expr: expr.replace(
        lambda n: n.is_Function and not n.is_Piecewise, lambda n: n.func(*map(change, n.args))
    )


def _if_short(step: Callable[[Expr], Expr]) -> Callable[[Expr], Expr]:
    return lambda expr: step(expr) if sp.count_ops(expr) <= _SHORT else expr


def _quotient(expr: Expr) -> Expr:
    return sp.cancel(sp.together(expr))


def _roots(expr: Expr) -> Expr:
    """Write every radicand as one factored quotient."""
    return expr.replace(
        lambda n: n.is_Pow and n.exp.is_Rational and n.exp.q == 2,
        lambda n: sp.powdenest(sp.factor(_quotient(n.base)) ** n.exp, force=False),
    )


_STEPS: tuple[Callable[[Expr], Expr], ...] = (
    _roots,
    sp.expand,
    lambda expr: sp.expand_trig(_in_arguments(sp.expand)(expr)),
    _roots,
    _quotient,
    _roots,
    # equal arguments of functions look equal as factored quotients
    _in_arguments(lambda arg: sp.factor(_quotient(sp.radsimp(_roots(arg))))),
    sp.expand,
    lambda expr: sp.expand(sp.radsimp(expr)),
    _quotient,
    _if_short(sp.trigsimp),
    _if_short(sp.simplify),
)


# ------------------------------------------------------------------ continuity


def _without_moduli(expr: Expr) -> Expr:
    """Replace log|f| by log f; both have the derivative f'/f where f is not zero."""
    inner = sp.Wild("f")
    return expr.replace(sp.log(sp.Abs(inner)), sp.log(inner))


def _is_continuous(expr: Expr, ranges: Mapping[Symbol, Range]) -> bool:
    """Whether every switch is shown to have no zero: it is a quotient of terms of one sign."""
    return all(
        _has_one_sign(switch.of) or all(map(_has_one_sign, _over_positive(switch.of, ranges)))
        for switch in switches(expr)
    )


def _over_positive(expr: Expr, ranges: Mapping[Symbol, Range]) -> Iterator[Expr]:
    """Yield numerator and denominator in variables that take all positive values, if possible."""
    table = {}
    for symbol in expr.free_symbols:
        free, span = sp.Dummy(symbol.name, positive=True), ranges.get(symbol, SCALE)
        if not span.powers:
            low, high = (Rational(str(end)) for end in (span.low, span.high))
            table[symbol] = (low + high * free) / (1 + free)
        elif symbol.is_positive:
            table[symbol] = free
    for part in sp.fraction(sp.together(expr.xreplace(table))):
        yield sp.expand(part) if terms(part) <= _MOST_SIGNS else part


def _has_one_sign(expr: Expr) -> bool:
    return bool(expr.is_positive or expr.is_negative)
