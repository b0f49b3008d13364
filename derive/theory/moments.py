r"""I_k(a, c) = int_{-a}^{c} s^k g'(s)/w(s) ds, the integrals from which equilibrium follows.

The integrals of the powers obey a single recursion.  From d/ds (s^(k-1) w) =
(-k s^k + (2k-1) mid s^(k-1) + (k-1) a c s^(k-2))/w, for any part of the contact,

    k J_k = (2k-1) mid J_{k-1} + (k-1) a c J_{k-2} - [s^(k-1) w],     J_0 = angle of the part.

Since w vanishes at both edges, only a kink contributes to the bracket.
"""

from functools import lru_cache

from sympy import Expr, Integer, Poly, S, expand, pi

from derive.symbols import a, c, mid, x
from derive.theory.frame import Frame, KinkFrame


def full_moment(k: int) -> Expr:
    """int_{-a}^{c} s^k / w ds."""
    return _recursion(k, pi, at=S.Zero, bracket=S.Zero)


def kink_moment(k: int, kink: KinkFrame) -> Expr:
    """int s^k / w ds over the part of the contact in which the kink's jump acts."""
    return _recursion(k, kink.theta, at=kink.kink.position, bracket=-kink.kink.side * kink.w)


@lru_cache(maxsize=256)
def _recursion(k: int, angle: Expr, at: Expr, bracket: Expr) -> Expr:
    """J_k of a part with [s^n w] = at**n * bracket."""
    if k < 1:
        return angle if k == 0 else S.Zero
    current, before = (_recursion(n, angle, at, bracket) for n in (k - 1, k - 2))
    boundary = bracket * (Integer(1) if k == 1 else at ** (k - 1))
    return expand(((2 * k - 1) * mid * current + (k - 1) * a * c * before - boundary) / k)


def weighted(polynomial: Expr, kink: KinkFrame | None = None) -> Expr:
    """int polynomial(s)/w ds over the contact, or over the part in which `kink` acts."""
    total = S.Zero
    for (power,), coefficient in Poly(polynomial, x).terms():
        part = full_moment(power) if kink is None else kink_moment(power, kink)
        total += coefficient * part
    return total


@lru_cache(maxsize=64)
def slope_moment(k: int, frame: Frame) -> Expr:
    """I_k of g' alone, without the tilt."""
    total = weighted(x**k * frame.slope.base)
    for kink in frame.kinks:
        total += weighted(x**k * kink.kink.jump, kink)
    return total
