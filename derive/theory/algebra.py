"""Bring formulas into a common form, and prove that a formula is zero.

All closed forms are rational functions of a, c, x, the parameters and the symbols of the kinks.  If
every contact spans a kink, then w_j**2 = (a + x_j)(c - x_j).  If a contact can leave the kink, then
w_j can be zero, and only w_j**3 = (a + x_j)(c - x_j) w_j always holds.
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
    """Whether `expr` is found to vanish identically in the ring; True is a proof.

    Over one denominator and with the lowest powers of every w_j, the products of the kinks' symbols
    are independent, so that `expr` is zero if the numerator expands to zero.
    """
    numerator = expand(fraction(together(expr))[0])
    return bool(expand(_low_power(numerator, frame)) == 0)


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
