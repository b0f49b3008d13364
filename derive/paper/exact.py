"""The permanent stick zone of a tilted wedge, in numbers, from the two conditions that define it.

Lengths in sqrt(a c), shear in f P, tension in f E* phi; then p is in E* phi and a contact is known
by its skewness t = sqrt(c/a) alone.
"""

from functools import cache

import mpmath
from mpmath import mpf

_DIGITS = 20
_CLOSE = mpf(10) ** -14
"""How well a root found meets both conditions, in units of the larger load."""


class NoStickZone(Exception):
    """No stick zone inside the contact meets the conditions."""


def tilt(skew: mpf) -> mpf:
    """alpha/phi of the contact [-1/t, t]."""
    return 1 - 4 / mpmath.pi * mpmath.atan(skew)


def skewness(lean: mpf) -> mpf:
    """t of the contact at alpha/phi."""
    return mpmath.tan(mpmath.pi / 4 * (1 - lean))


def threshold(skew: mpf, shear: mpf) -> mpf:
    """The tension at which the right slip zone closes, n = c."""
    return 4 * (tilt(skew) - tilt(skew / (1 - shear / 2)))


def moderate(skew: mpf, shear: mpf, tension: mpf) -> tuple[mpf, mpf]:
    """m and n where slip has one sign at both edges: a contact at less load and another tilt."""
    size, lean = 1 - shear / 2, tilt(skew) - tension / 4
    return size / skewness(lean), size * skewness(lean)


def leading(skew: mpf, shear: mpf, tension: mpf) -> tuple[mpf, mpf]:
    """Slip zones by K_T/(f K_N), both of the contact [-1/t, t]."""
    return tuple(abs(k) for k in _leading(skew, shear, tension, None))


def leading_as_printed(skew: mpf, shear: mpf, tension: mpf) -> tuple[mpf, mpf]:
    """The same with K_T of a symmetric contact of half-width a at the left, c at the right."""
    return tuple(abs(k) for k in _leading(skew, shear, tension, "own"))


def _leading(skew: mpf, shear: mpf, tension: mpf, own: str | None) -> tuple[mpf, mpf]:
    found = []
    for edge, other, sign in ((1 / skew, skew, 1), (skew, 1 / skew, -1)):
        width = 2 * edge if own else edge + other
        stuck = (shear / mpmath.pi + sign * tension * width / 8) / mpmath.sqrt(width)
        pressed = 2 / mpmath.pi / (edge * mpmath.sqrt(edge + other))
        found.append(stuck / pressed)
    return found[0], found[1]


@cache
def large(skew: mpf, shear: mpf, tension: mpf) -> tuple[mpf, mpf]:
    """m and n where slip has opposite signs at the edges; raises NoStickZone.

    int r/w = -pi dsigma/4 and int r xi/w = dQ + pi dsigma (m - n)/8 with r = +/-2 p.
    """
    left, right = 1 / skew, skew
    with mpmath.workdps(_DIGITS):

        def gaps(m: mpf, n: mpf) -> list[mpf]:
            strain, force = (_over_slip(k, skew, m, n) for k in (0, 1))
            return [
                strain + mpmath.pi * tension / 4,
                force - shear - mpmath.pi * tension * (m - n) / 8,
            ]

        first, second = leading(skew, shear, tension)
        for part in (mpf("0.75"), mpf("0.5"), mpf("0.9"), mpf("0.3")):
            start = (left - min(part * first, 0.9 * left), right - min(part * second, 0.9 * right))
            try:
                m, n = mpmath.findroot(gaps, start)
            except (ValueError, ZeroDivisionError):
                continue
            real = mpmath.im(m) == 0 and mpmath.im(n) == 0
            if real and 0 < m < left and 0 < n < right and max(map(abs, gaps(m, n))) < _CLOSE:
                return m, n
    raise NoStickZone(f"t = {skew}, dQ = {shear}, dsigma = {tension}")


def _over_slip(power: int, skew: mpf, m: mpf, n: mpf) -> mpf:
    """int r xi**power/w over both slip zones, every end's root taken out by the angle."""

    def pressure(place: mpf) -> mpf:
        u = mpmath.sqrt(skew * (1 / skew + place))
        v = mpmath.sqrt((skew - place) / skew)
        return mpmath.log(abs((u + v) / (u - v))) / mpmath.pi

    def left(angle: mpf) -> mpf:
        length = 1 / skew - m
        place = -1 / skew + length * mpmath.sin(angle) ** 2
        root = mpmath.sqrt(n - place)
        return (
            -2 * pressure(place) * place**power / root * 2 * mpmath.sqrt(length) * mpmath.sin(angle)
        )

    def right(angle: mpf) -> mpf:
        length = skew - n
        place = n + length * mpmath.sin(angle) ** 2
        root = mpmath.sqrt(place + m)
        return (
            -2 * pressure(place) * place**power / root * 2 * mpmath.sqrt(length) * mpmath.cos(angle)
        )

    cuts = [0, mpmath.pi / 4, mpmath.pi / 2]
    return sum(mpmath.quad(part, cuts, method="gauss-legendre") for part in (left, right))
