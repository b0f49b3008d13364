"""Bringing formulas into one form, and deciding whether one is zero.

All closed forms are rational functions of a, c, x, the parameters and the symbols of the kinks.  A
kink that every contact spans has w_j**2 = (a + x_j)(c - x_j).  One that a contact can leave has
w_j = 0 then, so that only w_j**3 = (a + x_j)(c - x_j) w_j holds throughout.  In that ring "is it
zero" has an exact answer.
"""

from sympy import (
    Add,
    Dummy,
    Expr,
    Poly,
    Pow,
    Rational,
    S,
    Symbol,
    cancel,
    count_ops,
    expand,
    factor,
    fraction,
    together,
)

from derive.theory.frame import Frame, KinkFrame


def reduced(expr: Expr, frame: Frame) -> Expr:
    """`expr` as one quotient of polynomials of lowest degree in every w_j."""
    numerator, denominator = fraction(together(expr))
    return cancel(_low_power(numerator, frame) / _low_power(denominator, frame))


def tidy(expr: Expr, frame: Frame) -> Expr:
    """`expr` in the form that is shown: factored, or collected by the kinks' symbols if shorter."""
    if len(frame.kinks) > 1:
        linear = _collected_linear(expr, frame)
        if linear is not None:
            return linear
    quotient = reduced(expr, frame)
    forms = [factor(quotient), _collected(quotient, frame)]
    return min(forms, key=lambda form: (count_ops(form), str(form)))


def is_zero(expr: Expr, frame: Frame) -> bool:
    """Whether `expr` vanishes identically in the ring; exact, never a guess.

    Every root becomes a symbol whose square is known and every denominator is multiplied up, so
    that a polynomial remains; it is expanded, even powers of roots are replaced, and it is zero or
    not.  What is linear in the symbols of many kinks is zero if every coefficient is.
    """
    parts = _coefficients(expr, [s for k in frame.kinks for s in (k.theta, k.w, k.L)])
    if len(frame.kinks) > 1 and parts is not None:
        return all(_is_zero_polynomial(part, frame) for part in parts)
    return _is_zero_polynomial(expr, frame)


def _is_zero_polynomial(expr: Expr, frame: Frame) -> bool:
    expr, roots = _without_roots(expr)
    polynomial = _low_power(_numerator(expr), frame)
    return bool(_even_powers_replaced(expand(polynomial), roots) == 0)


def _numerator(expr: Expr) -> Expr:
    """`expr` times every denominator that it holds, to the highest power at which it occurs."""
    inverses = {p for p in expr.atoms(Pow) if p.exp.is_Integer and p.exp < 0}
    symbols = {base: Dummy("v") for base in sorted({p.base for p in inverses}, key=str)}
    table = {p: symbols[p.base] ** -p.exp for p in inverses}
    terms = Add.make_args(expand(expr.xreplace(table)))
    powers = [term.as_powers_dict() for term in terms]
    total = S.Zero
    highest = {v: max(p.get(v, 0) for p in powers) for v in symbols.values()}
    for term, held in zip(terms, powers, strict=True):
        for base, v in symbols.items():
            term *= base ** highest[v] * (v * base) ** -held.get(v, 0)
        total += term
    return total


def _even_powers_replaced(expanded: Expr, squares: dict[Symbol, Expr]) -> Expr:
    total = []
    for term in Add.make_args(expanded):
        powers = term.as_powers_dict()
        for root, square in squares.items():
            even = powers.get(root, 0) // 2
            term *= (square / root**2) ** even
        total.append(term)
    return expand(Add(*total))


def _without_roots(expr: Expr) -> tuple[Expr, dict[Symbol, Expr]]:
    """Each sqrt(base) as a symbol r, an odd power base**(n/2) as r base**((n-1)/2)."""
    halves = {p for p in expr.atoms(Pow) if p.exp.is_Rational and p.exp.q == 2}
    symbols = {base: Dummy("r") for base in sorted({p.base for p in halves}, key=str)}
    table = {p: symbols[p.base] * p.base ** (p.exp - Rational(1, 2)) for p in halves}
    return expr.xreplace(table), {symbol: base for base, symbol in symbols.items()}


def _symbols(frame: Frame) -> list[Symbol]:
    return [symbol for k in frame.kinks for symbol in (k.theta, k.w)]


def _collected(quotient: Expr, frame: Frame) -> Expr:
    """Each coefficient of theta_j and w_j factored by itself."""
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
    """Each coefficient of theta_j and w_j factored by itself; None where they are not linear.

    Without a common denominator of all: with many kinks that would be by far the longest way.
    """
    symbols = _symbols(frame)
    stand_ins = {root: Dummy("r", positive=True) for root in _roots_in(expr)}
    parts = _coefficients(expr.xreplace(stand_ins), symbols)
    if parts is None:
        return None
    back = {stand_in: root for root, stand_in in stand_ins.items()}
    terms = (factor(part) * s for part, s in zip(parts, [S.One, *symbols], strict=True))
    return Add(*(term.xreplace(back) for term in terms))


def _coefficients(expr: Expr, symbols: list[Symbol]) -> list[Expr] | None:
    """What is free of the symbols, and the factor of each; None where they are not linear."""
    parts = [expr.xreplace(dict.fromkeys(symbols, S.Zero)), *(expr.diff(s) for s in symbols)]
    return None if any(part.has(*symbols) for part in parts if symbols) else parts


def _roots_in(expr: Expr) -> list[Expr]:
    """The roots and odd powers of roots that an expression holds."""
    return sorted((p for p in expr.atoms(Pow) if p.exp.is_Rational and p.exp.q == 2), key=str)


def _low_power(expr: Expr, frame: Frame) -> Expr:
    """A polynomial in w_j of degree one, of degree two where a contact can leave the kink."""
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
