"""The defining integrals of a contact, by quadrature of g(x) as the user wrote it.

In:  g(x), and the name of a formula.
Out: its value by the integrals of theory.equilibrium and theory.pressure, before anything was done
     with them.
"""

from sympy import (
    ITE,
    Expr,
    Integral,
    Max,
    Min,
    Piecewise,
    Symbol,
    diff,
    pi,
    piecewise_fold,
    sqrt,
)

from derive.symbols import E_star, a, c, h, mid, w, x

_s = Symbol("xi", real=True)
"""The variable of integration."""


def value_by_quadrature(g: Expr, name: str) -> Expr:
    """A value of the contact [-a, c] by its defining integrals: tilt, load, moment, pressure at x,
    or K_N and L_N, such as K_N_left.

    PV int g'(s)/(w(s) (s - x)) ds is taken with its singularity subtracted: F(x).  The pressure is
    (E*/2 pi) w F, so that K_N is its value over sqrt(s) at the edge, and L_N that of the next power
    of s: p = (E*/2 pi) sqrt(s) sqrt(h - s) F.
    """
    slope = slope_as_given(g)
    at = slope.subs(x, _s)
    tilt = -_over_w(at) / pi
    match name.split("_"):
        case ["tilt"]:
            return tilt
        case ["load"]:
            return E_star / 2 * (_over_w(_s * at) + tilt * _over_w(_s))
        case ["moment"]:
            lever = _s * (_s - mid)
            return -E_star / 2 * (_over_w(lever * at) + tilt * _over_w(lever))
        case ["pressure"]:
            return E_star / (2 * pi) * sqrt((a + x) * (c - x)) * _over_w((at - slope) / (_s - x))
        case [letter, _, side]:
            edge, inward = (-a, 1) if side == "left" else (c, -1)
            rise, distance = at - slope.subs(x, edge), _s - edge
            principal = sqrt(h) * _over_w(rise / distance)
            if letter == "K":
                return E_star / (2 * pi) * principal
            bent = rise - diff(slope, x).subs(x, edge) * distance
            rate = inward * sqrt(h) * _over_w(bent / distance**2)
            return E_star / (2 * pi) * (rate - principal / (2 * h))
    raise KeyError(name)


def _over_w(density: Expr) -> Expr:
    return Integral(density / w.subs(x, _s), (_s, -a, c))


def slope_as_given(g: Expr) -> Expr:
    """g'(x) by branches; a power has branches of its own, because its rate may be 0/0 at zero."""
    branched = g.replace(Max, _larger).replace(Min, _smaller).rewrite(Piecewise)
    branched = branched.replace(ITE, lambda holds, one, other: (holds & one) | (~holds & other))
    return diff(branched.replace(_is_branched_power, piecewise_fold), x)


def _is_branched_power(node: Expr) -> bool:
    return bool(node.is_Pow and node.has(Piecewise) and not node.exp.is_Integer)


def _larger(first: Expr, *others: Expr) -> Expr:
    """Max by branches; SymPy may never finish comparing with values other than zero."""
    if not others:
        return first
    second = _larger(*others)
    return Piecewise((first, first - second >= 0), (second, True))


def _smaller(*args: Expr) -> Expr:
    return -_larger(*(-arg for arg in args))
