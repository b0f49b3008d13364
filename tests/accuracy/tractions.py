"""The change of shear, the shear and the slip, told from stick zones that are unknowns.

Constant normal loads: q slips at f p, dq at 2 f p, with the sign kappa of the side.
"""

from collections.abc import Callable, Sequence
from functools import lru_cache

import mpmath
from flint import ctx
from mpmath import mpf

from derive.proof.balls import Ball, ball
from tests.accuracy.definitions import formula, pressure_along
from tests.accuracy.quadrature import Integrand, integrals
from tests.accuracy.reference import Conditions, Given, Problem, sheet_of
from tests.accuracy.tensions import AT_ENDS, between, cuts_of, patch, slip_zone

Zone = Sequence[mpf]
"""m and n."""

LARGE_DIGITS, FEWER_DIGITS = 28, 22
"""Of large tension, whose conditions are integrals; of pressures that are integrals themselves."""

SLIP_DIGITS = 32
"""Of slip under moderate tension, which is an integral."""


def change(body: str, large: bool = False) -> Problem:
    """dq at x over the half-cycle."""
    of = _large_change(body) if large else _moderate_change(body)
    zone = between(body) if large else patch(body)
    digits = large_digits(body) if large else 50
    return Problem(zone, lambda edges, given: [of(edges, given)], digits=digits)


def shear(body: str, large: bool = False) -> Problem:
    """q at x: half of what twice the loads of the first rise would change, less the fall since."""
    of = _large_change(body) if large else _moderate_change(body)
    zone = between(body) if large else patch(body)

    def off(edges: Sequence[mpf], given: Given) -> list[mpf]:
        return [*zone(edges[:2], _risen(given)), *zone(edges[2:], given)]

    def told(edges: Sequence[mpf], given: Given) -> list[mpf]:
        return [of(edges[:2], _risen(given)) / 2 - of(edges[2:], given)]

    return Problem(off, told, digits=large_digits(body) if large else 50)


def large_digits(body: str) -> int:
    """Digits of a body's problems under large tension."""
    return LARGE_DIGITS if sheet_of(body).geometry.slope.is_polynomial else FEWER_DIGITS


def _risen(given: Given) -> dict[str, mpf]:
    return {**given, "dQ": 2 * given["Q"], "dsigma": 2 * given["sigma"]}


def _moderate_change(body: str) -> Callable[[Zone, Given], mpf]:
    """Superposition: 2 f p less 2 f p of the patch."""
    pressure = formula(body, "pressure")

    def of(zone: Zone, given: Given) -> mpf:
        m, n = zone
        whole = 2 * given["f"] * pressure(**given)
        if not -m < given["x"] < n:
            return whole
        return whole - 2 * given["f"] * pressure(**{**given, "a": m, "c": n})

    return of


def _large_change(body: str) -> Callable[[Zone, Given], mpf]:
    """dq = sqrt((x + m)(n - x))/pi int_slip r/(w (xi - x)) dxi where it sticks."""
    pressure = formula(body, "pressure")

    def of(zone: Zone, given: Given) -> mpf:
        m, n = zone
        x, sense = given["x"], 1 if given["dsigma"] > 0 else -1
        if not -m < x < n:
            return (-sense if x >= n else sense) * 2 * given["f"] * pressure(**given)
        total = mpf(0)
        for side in (-1, 1):
            start, length = slip_zone(given, m, n, side)
            integrand = _pulling(pressure_along(body, given), start, m + n, start - side * x, side)
            cuts = cuts_of(body, given, start, length, side)
            near = float(min(mpf(1), (start - side * x) / length))
            total -= side * sense * integrals(integrand, cuts, mpmath.mp.dps, AT_ENDS, near)[0]
        return 2 * given["f"] * mpmath.sqrt((x + m) * (n - x)) / mpmath.pi * total

    return of


def _pulling(p: Callable[[Ball], Ball], start: mpf, stuck: mpf, away: mpf, side: int) -> Integrand:
    """p/(|w| |xi - x|), x `away` from where the slip zone begins."""
    at, wide, off = ball(start), ball(stuck), ball(away)
    return lambda y, _, __: [p(side * (at + y)) / ((y * (wide + y)).sqrt() * (off + y))]


# ------------------------------------------------------------------ slip


def slip(body: str, large: bool = False) -> Problem:
    """|slip| at x: the mismatch of strain, integrated from the stick zone.

    (E*/2) d slip/dx = -(w/pi) PV int_slip r/(w (xi - x)) dxi in the slip zones, r = 2 kappa f p;
    the integral over x is taken first, for each xi.
    """

    def told(edges: Sequence[mpf], given: Given) -> list[mpf]:
        return [abs(_slip(body, edges, given, large))]

    zone: Conditions = between(body) if large else patch(body)
    return Problem(zone, told, digits=large_digits(body) if large else SLIP_DIGITS)


def _slip(body: str, edges: Zone, given: Given, large: bool) -> mpf:
    m, n = edges
    x, stuck = given["x"], m + n
    here = 1 if x > (n - m) / 2 else -1
    sense = 1 if given["dsigma"] > 0 else -1
    reach = here * x - (n if here > 0 else m)
    if reach <= 0:
        return mpf(0)
    total, p = mpf(0), pressure_along(body, given)
    for side in (-1, 1):
        kappa = -side * sense if large else 1
        start, length = slip_zone(given, m, n, side)
        cuts = cuts_of(body, given, start, length, side)
        if side == here:
            cuts = sorted({*cuts, reach})
        integrand = _moved(p, start, stuck, reach, side, side == here)
        near = float(min(mpf(1), reach / length))
        total += kappa * integrals(integrand, cuts, mpmath.mp.dps, AT_ENDS, near)[0]
    return 4 * given["f"] / (mpmath.pi * given["E_star"]) * total


def _moved(
    p: Callable[[Ball], Ball], start: mpf, stuck: mpf, reach: mpf, side: int, own: bool
) -> Integrand:
    """p/|w| times int_0^reach w/(xi - x) dx, its principal value, by x = stuck sinh(u)**2:

    PV int_0^l sqrt(t (t + h))/(Y - t) dt = -sqrt(l (l + h)) - (2 Y + h) asinh sqrt(l/h)
        +/- sqrt(Y (Y + h)) log |(r + s)/(r - s)|,  r**2 = |Y| (l + h),  s**2 = l |Y + h|,

    Y the distance of xi from the stick zone; negative, and so is the sign, where xi lies in the
    slip zone across.
    """
    sign = 1 if own else -1

    def integrand(y: Ball, _: Ball, __: Ball) -> list[Ball]:
        at, to, wide, flat, slope = _known(start, stuck, reach, ctx.prec)
        other = y if own else -wide - y
        beyond = y * (wide + y)
        r, s = (abs(other) * (to + wide)).sqrt(), (to * abs(other + wide)).sqrt()
        kernel = flat - (2 * other + wide) * slope
        kernel += sign * beyond.sqrt() * abs((r + s) / (r - s)).log()
        return [sign * p(side * (at + y)) / beyond.sqrt() * kernel]

    return integrand


@lru_cache(maxsize=16)
def _known(start: mpf, stuck: mpf, reach: mpf, bits: int) -> tuple[Ball, ...]:
    to, wide = ball(reach), ball(stuck)
    return ball(start), to, wide, -(to * (to + wide)).sqrt(), (to / wide).sqrt().asinh()
