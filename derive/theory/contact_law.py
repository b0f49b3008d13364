r"""From loads to the contact: (P, M) -> (a, c, alpha) and (P, alpha) -> (a, c, M) in closed form.

The natural unknowns are the width h and the midpoint mid, because M/P contains mid only to the
first power wherever a closed inverse is known.  For a body with straight flanks that meet in one
corner, the angle of the corner is the better unknown: mid = x_1 -/+ (h/2) cos(theta_1) and
w_1 = (h/2) sin(theta_1).

If no closed inverse is found, the result is None.  Only equations of first or second degree are
tried, without guesses or time limits, so that the result is the same on every machine.
"""

from dataclasses import dataclass

from sympy import (
    Expr,
    Poly,
    Rational,
    S,
    Symbol,
    atan2,
    cos,
    expand,
    factor,
    simplify,
    sin,
    sqrt,
    tan,
)

from derive.symbols import P, a, alpha, c, e
from derive.theory.algebra import reduced
from derive.theory.frame import Frame, KinkFrame

_h = Symbol("h", positive=True)
_mid = Symbol("mid", real=True)
_kappa = Symbol("kappa", positive=True)


@dataclass(frozen=True)
class Inverse:
    """A contact, its tilt and its moment, as functions of the loads."""

    a: Expr
    c: Expr
    alpha: Expr
    M: Expr


def contact_from_moment(frame: Frame, tilt: Expr, load: Expr, moment: Expr) -> Inverse | None:
    """(P, M) -> (a, c, alpha), in terms of P and the lever arm e = M/P."""
    if any(k.clipped for k in frame.kinks):
        return None
    found = _middle_and_half_width(reduced(moment / load, frame), e, load, frame)
    if found is None:
        return None
    middle, half = found
    edges = {_mid: middle, _h: 2 * half}
    angle = tilt.subs(_angles(frame)).subs(_in_middle_and_width(frame)).subs(edges)
    return Inverse(half - middle, half + middle, _opened_roots(angle), M=P * e)


def contact_from_tilt(frame: Frame, tilt: Expr, load: Expr, moment: Expr) -> Inverse | None:
    """(P, alpha) -> (a, c, M)."""
    if len(frame.kinks) > 1 or any(k.clipped for k in frame.kinks):
        return None
    arm = reduced(moment / load, frame)
    if not frame.kinks:
        return _smooth_at_tilt(frame, tilt, load, arm)
    return _corner_at_tilt(frame.kinks[0], tilt, load, arm)


def _smooth_at_tilt(frame: Frame, tilt: Expr, load: Expr, arm: Expr) -> Inverse | None:
    found = _middle_and_half_width(tilt, alpha, load, frame)
    if found is None:
        return None
    middle, half = found
    edges = {a: half - middle, c: half + middle}
    return Inverse(edges[a], edges[c], alpha, M=P * simplify(arm.subs(edges)))


def _middle_and_half_width(
    of_edges: Expr, value: Expr, load: Expr, frame: Frame
) -> tuple[Expr, Expr] | None:
    """Midpoint and half-width of the contact under P for which `of_edges` equals `value`."""
    to_middle = _in_middle_and_width(frame)
    middle = _root_of_first_degree(of_edges.subs(to_middle) - value, _mid)
    if middle is None:
        return None
    half = _half_width(simplify(load.subs(to_middle).subs(_mid, middle)))
    return None if half is None else (middle, half)


def _corner_at_tilt(corner: KinkFrame, tilt: Expr, load: Expr, arm: Expr) -> Inverse | None:
    """Contact of one corner between straight flanks, from half the angle of the corner.

    Since (1 - cos u)/sin u = tan(u/2), the edge on the side of the jump lies at the distance
    (h/2) sin(theta_1) tan(theta_1/2) from the corner, and the other edge at the distance
    (h/2) sin(theta_1)/tan(theta_1/2).
    """
    angle = _root_of_first_degree(tilt - alpha, corner.theta)
    if angle is None:
        return None
    place, side = corner.kink.position, corner.kink.side
    middle = place - side * _h / 2 * cos(_kappa)
    at_angle = {corner.w: _h / 2 * sin(_kappa), corner.theta: _kappa}
    edges = {a: _h / 2 - middle, c: _h / 2 + middle}
    half = _half_width(simplify(load.subs(at_angle).subs(edges)))
    if half is None:
        return None
    arm_of_angle = simplify(arm.subs(at_angle).subs(edges).subs(_h, 2 * half))
    base = simplify(half * sin(_kappa))
    if base.has(_kappa):
        return None
    tangent = tan(factor(angle) / 2)
    near, far = base * tangent, base / tangent
    right, left = (near, far) if side > 0 else (far, near)
    return Inverse(
        left - place, right + place, alpha, M=P * arm_of_angle.subs(_kappa, factor(angle))
    )


def _in_middle_and_width(frame: Frame) -> dict[Expr, Expr]:
    """a, c and the roots of the kinks in terms of mid and h."""
    table: dict[Expr, Expr] = {a: _h / 2 - _mid, c: _h / 2 + _mid}
    for k in frame.kinks:
        table[k.w] = sqrt(_h**2 / 4 - (k.kink.position - _mid) ** 2)
    return table


def _angles(frame: Frame) -> dict[Expr, Expr]:
    """theta_j from its sine 2 w_j/h and its cosine; both follow directly from the loads."""
    return {k.theta: atan2(k.w, k.kink.side * (k.kink.position - _mid)) for k in frame.kinks}


def _root_of_first_degree(expr: Expr, unknown: Symbol) -> Expr | None:
    """The root of `expr` = 0 if `expr` is linear in `unknown` and the root is free of the width."""
    expr = expand(simplify(expr))
    if not expr.is_polynomial(unknown):
        return None
    poly = Poly(expr, unknown)
    root = -poly.nth(0) / poly.nth(1) if poly.degree() == 1 else S.NaN
    return None if root.has(_h, S.NaN) else simplify(root)


def _half_width(load: Expr) -> Expr | None:
    """The h/2 > 0 with load(h) = P, if the load is C h, C h**2 or C sqrt(h**2 + D)."""
    if load.is_polynomial(_h):
        terms = Poly(load, _h).terms()
        if len(terms) == 1 and terms[0][0][0] in (1, 2):
            (power,), coefficient = terms[0]
            return (P / (2**power * coefficient)) ** Rational(1, power)
        return None
    square = expand(load**2)
    if not square.is_polynomial(_h):
        return None
    poly = Poly(square, _h)
    if not {power for (power,), _ in poly.terms()} <= {2, 0}:
        return None
    return sqrt(factor(-poly.nth(0) / poly.nth(2) / 4) + P**2 * factor(1 / poly.nth(2) / 4))


def _opened_roots(expr: Expr) -> Expr:
    """`expr` with every square root replaced by its simplified form."""
    return expr.replace(lambda n: n.is_Pow and n.exp == S.Half, lambda n: sqrt(simplify(n.base)))
