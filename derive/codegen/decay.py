"""Quotients of exponentials that grow, by exponentials that decay.

In:  an expression of the distance t from a break.
Out: the same; where exponentials grow with t below a line, above and below are divided by the
     fastest, so that no quotient of two infinities is left: exp t/(1 + exp t) = 1/(1 + exp(-t)).
"""

from sympy import Add, Dummy, Expr, Mul, Poly, Symbol, exp, fraction, ilcm, powsimp, together


def decaying(expr: Expr, t: Symbol) -> Expr:
    """`expr` with no exponential that grows with t in a denominator, as far as that can be seen.

    >>> t = Symbol("t", positive=True)
    >>> decaying(exp(t) / (1 + exp(t)), t), decaying(exp(t) + t, t)
    (1/(1 + exp(-t)), t + exp(t))
    """
    _, below = fraction(together(expr))
    if not any(_rate(power, t).is_positive for power in below.atoms(exp)):
        return expr
    rates = {power: _rate(power, t) for power in sorted(expr.atoms(exp), key=str)}
    one = next(abs(rate) for rate in rates.values() if rate != 0)
    times = {power: rate / one for power, rate in rates.items()}
    if not all(many.is_Rational for many in times.values()):
        return expr
    parts = ilcm(1, *(many.q for many in times.values()))
    unit, decay = one / parts, Dummy("decay", positive=True)
    table = {
        power: exp(power.args[0] - rates[power] * t) * decay ** -(many * parts)
        for power, many in times.items()
    }
    over, under = (_in_powers(part, decay) for part in fraction(together(expr.xreplace(table))))
    least = min(min(over), min(under))
    over, under = ({n - least: v for n, v in part.items()} for part in (over, under))
    above, below = (
        Add(*(powsimp(v) * exp(-n * unit * t) for n, v in part.items())) for part in (over, under)
    )
    return Mul(above, 1 / below)


def _rate(power: Expr, t: Symbol) -> Expr:
    """How fast the exponent grows with t; zero where it is not linear."""
    exponent = power.args[0]
    rate = exponent.diff(t)
    return rate * 0 if rate.has(t) else rate.expand()


def _in_powers(expr: Expr, decay: Symbol) -> dict[int, Expr]:
    """Coefficients of the powers of `decay`."""
    return {n: value for (n,), value in Poly(expr.expand(), decay).terms()}
