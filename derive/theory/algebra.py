"""Bring formulas into a common form, and decide whether a formula is zero.

All closed forms are rational functions of a, c, x, the parameters and the symbols of the kinks.  If
every contact spans a kink, then w_j**2 = (a + x_j)(c - x_j).  If a contact can leave the kink, then
w_j can be zero, and only w_j**3 = (a + x_j)(c - x_j) w_j always holds.  In this ring it can be
decided exactly whether an expression is zero.
"""

from sympy import (
    Add,
    Expr,
    Poly,
    S,
    Symbol,
    cancel,
    collect,
    count_ops,
    expand,
    factor,
    fraction,
    together,
)

from derive.theory.frame import Frame, KinkFrame
from derive.theory.ring import Ring


def reduced(expr: Expr, frame: Frame) -> Expr:
    """`expr` as one quotient of polynomials of the lowest degree in every w_j."""
    numerator, denominator = fraction(together(expr))
    return cancel(_low_power(numerator, frame) / _low_power(denominator, frame))


def tidy(expr: Expr, frame: Frame) -> Expr:
    """`expr` in the form that is printed: factored, or collected by kink symbols if shorter."""
    if frame.is_long:
        linear = _collected_linear(expr, frame)
        if linear is not None:
            return linear
    quotient = reduced(expr, frame)
    forms = [factor(quotient), _collected(quotient, frame)]
    return min(forms, key=lambda form: (count_ops(form), str(form)))


def is_zero(expr: Expr, frame: Frame) -> bool:
    """Whether `expr` vanishes identically in the ring; the answer is exact.

    Every root is a generator whose square is known, and every denominator is multiplied out.  Only
    polynomials remain: one for each product of the kinks' symbols and the roots.  These products
    are independent, so `expr` is zero if all of these polynomials are.
    """
    squares = {k.w: k.left * k.right for k in frame.kinks}
    ring = Ring([expr, *squares.values()])
    symbols = [*(s for k in frame.kinks for s in (k.theta, k.w, k.L)), *ring.roots]
    first = [base for base in ring.inverses if base.has(*symbols)] if symbols else []
    polynomial = ring.cleared(ring.polynomial(expr), first)
    for root, (exponent, base) in ring.roots.items():
        polynomial = ring.lowered(polynomial, root, exponent, base)
    for k in frame.kinks:
        polynomial = ring.lowered(polynomial, k.w, 2, squares[k.w], least=int(k.clipped))
    parts = ring.apart(polynomial, symbols).values()
    return all(ring.cleared(part, ring.inverses).is_zero() for part in parts)


def _symbols(frame: Frame) -> list[Symbol]:
    return [symbol for k in frame.kinks for symbol in (k.theta, k.w)]


def _collected(quotient: Expr, frame: Frame) -> Expr:
    """Factor each coefficient of theta_j and w_j separately."""
    numerator, denominator = fraction(quotient)
    symbols = [s for s in _symbols(frame) if numerator.has(s)]
    if not symbols:
        return factor(quotient)
    content, primitive = Poly(numerator, *symbols).primitive()
    collected = sum(
        factor(coefficient) * Poly({powers: 1}, *symbols).as_expr()
        for powers, coefficient in primitive.terms()
    )
    return factor(content / denominator) * collected


def _collected_linear(expr: Expr, frame: Frame) -> Expr | None:
    """Factor each coefficient of theta_j and w_j separately; None if they do not occur linearly.

    A common denominator is avoided, because it would take much longer for a long body.
    """
    symbols = _symbols(frame)
    parts = collect(expand(expr), symbols, evaluate=False)
    if not {*parts} <= {S.One, *symbols} or any(part.has(*symbols) for part in parts.values()):
        return None
    return Add(*(factor(part) * s for s, part in parts.items()))


def _low_power(expr: Expr, frame: Frame) -> Expr:
    """A polynomial in w_j of degree one, or of degree two if a contact can leave the kink."""
    for k in frame.kinks:
        if expr.has(k.w):
            expr = sum(
                coefficient * _power_of_root(k, power)
                for (power,), coefficient in Poly(expr, k.w).terms()
            )
    return expr


def _power_of_root(kink: KinkFrame, power: int) -> Expr:
    lowest = (power - 1) % 2 + 1 if kink.clipped and power else power % 2
    return (kink.left * kink.right) ** ((power - lowest) // 2) * kink.w**lowest
