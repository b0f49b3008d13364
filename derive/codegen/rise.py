"""How much a function has risen since a place, without a difference of nearly equal numbers.

In:  g' as an expression of the distance t from a break.
Out: the same, where its terms cancel at t = 0 in a form that keeps its digits for every small t.

    exp u - exp u_0 = exp(u_0) expm1(r),      log u - log u_0 = log1p(r/u_0),      r = u - u_0,
    u^k - u_0^k = u_0^k expm1(k log1p(r/u_0)),   sqrt u - sqrt u_0 = r/(sqrt u + sqrt u_0), ...
"""

from sympy import (
    Add,
    Expr,
    Function,
    Mul,
    Pow,
    S,
    Symbol,
    asinh,
    atan,
    cosh,
    exp,
    expand,
    log,
    oo,
    sinh,
    tanh,
    zoo,
)

from derive.codegen.program import expm1, log1p
from derive.piece import vanishes


class _NotKnown(Exception):
    """A function whose rise has no such form here."""


def from_zero(expr: Expr, t: Symbol) -> Expr:
    """`expr` without cancellation at t = 0, if it is zero there; else as it is.

    >>> t = Symbol("t", positive=True)
    >>> from_zero(exp(t) - 1, t), from_zero(t * exp(t), t), from_zero(log(1 + t), t)
    (expm1(t), t*exp(t), log1p(t))
    """
    try:
        if not _cancels(expr, t) or not vanishes(_at_zero(expr, t)):
            return expr
        return _rise(expand(expr), t)
    except _NotKnown:
        return expr


def _cancels(expr: Expr, t: Symbol) -> bool:
    """Whether terms that are not zero at t = 0 are added up, or the logarithm of one is taken."""
    terms = Add.make_args(expand(expr))
    return any(term.has(log) or _at_zero(term, t) != 0 for term in terms)


def _at_zero(expr: Expr, t: Symbol) -> Expr:
    """The value at t = 0.

    Raises _NotKnown where it is none, or hangs on the sign of an exponent.
    """
    if any(p.base.subs(t, 0) == 0 and not p.exp.is_positive for p in expr.atoms(Pow)):
        raise _NotKnown
    value = expr.subs(t, 0)
    if value.has(S.NaN, zoo, oo):
        raise _NotKnown
    return value


def _rise(expr: Expr, t: Symbol) -> Expr:
    """expr less its value at t = 0."""
    if not expr.has(t) or expr == t:
        return expr if expr == t else S.Zero
    match expr:
        case Add():
            return Add(*(_rise(term, t) for term in expr.args))
        case Mul():
            return _of_product(expr, t)
        case Pow():
            return _of_power(expr.base, expr.exp, t)
        case Function() if len(expr.args) == 1:
            return _of_function(expr, t)
    raise _NotKnown


def _of_product(expr: Expr, t: Symbol) -> Expr:
    """f g - f_0 g_0 = (f - f_0) g + f_0 (g - g_0)."""
    fixed, moving = expr.as_independent(t, as_Add=False)
    first, *rest = sorted(Mul.make_args(moving), key=lambda f: _at_zero(f, t) != 0)
    others = Mul(*rest)
    risen = _rise(first, t) * others
    return fixed * (risen + _at_zero(first, t) * _rise(others, t))


def _of_power(base: Expr, power: Expr, t: Symbol) -> Expr:
    start, risen = _at_zero(base, t), _rise(base, t)
    if start == 0:
        return risen**power
    if power.has(t) or not start.is_positive:
        raise _NotKnown
    if power == S.Half:
        return risen / (base**power + start**power)
    if power.is_Integer and power.is_positive:
        return risen * Add(*(base**i * start ** (power - 1 - i) for i in range(int(power))))
    if power.is_Rational and power.is_negative:
        return -_of_power(base, -power, t) * base**power * start**power
    return start**power * expm1(power * log1p(risen / start))


def _of_function(expr: Expr, t: Symbol) -> Expr:
    inner = expr.args[0]
    start, risen = _at_zero(inner, t), _rise(inner, t)
    match expr:
        case exp():
            return exp(start) * expm1(risen)
        case log():
            if not start.is_positive:
                raise _NotKnown
            return log1p(risen / start)
        case cosh():
            return 2 * sinh(start + risen / 2) * sinh(risen / 2)
        case sinh():
            return 2 * cosh(start + risen / 2) * sinh(risen / 2) if start != 0 else sinh(risen)
        case tanh() | atan() | asinh() if start == 0:
            return expr.func(risen)
    raise _NotKnown
