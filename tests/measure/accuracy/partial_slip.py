"""What the functions of partial slip solve, with a body's formulas in many digits.

`a` and `c` are the edges at one end of the half-cycle, `a_2` and `c_2` those at the other, where
the normal loads vary.
"""

from collections.abc import Callable, Sequence
from functools import cache, lru_cache

import mpmath
from flint import ctx
from mpmath import mpf
from sympy import Symbol, symbols

from derive.proof.balls import Ball, ball
from derive.theory import slip as theory
from tests.derive.bodies import of_library as sheet_of
from tests.measure.accuracy.definitions import formula, kinks_of, pressure_along
from tests.measure.accuracy.quadrature import Integrand, integrals
from tests.measure.accuracy.reference import Conditions, Given, Problem, function_of

AT_ENDS = (-0.5, 0.5)
"""How p/w grows where slip begins, and how it falls at the edge."""

Zone = Sequence[mpf]
"""m and n."""


def digits_of(body: str) -> int:
    """Digits of problems whose conditions are integrals; fewer where pressures are, too."""
    return 28 if sheet_of(body).geometry.slope.is_polynomial else 22


def ends_of(given: Given) -> list[dict[str, mpf]]:
    """What is given, at each of both contacts."""
    second = {name: given.get(f"{name}_2", given[name]) for name in "ac"}
    return [dict(given), {**given, **second}]


# ------------------------------------------------------------------ stick zones


def patch(body: str) -> Conditions:
    """Moderate tension: the contact at a reduced load and a shifted tilt."""
    load, tilt = formula(body, "load"), formula(body, "tilt")

    def off(edges: Zone, given: Given) -> list[mpf]:
        there, ends = {**given, "a": edges[0], "c": edges[1]}, ends_of(given)
        lean = given["dsigma"] / (4 * given["f"] * given["E_star"])
        return [
            load(**there) - sum(load(**end) for end in ends) / 2 + given["dQ"] / (2 * given["f"]),
            tilt(**there) - sum(tilt(**end) for end in ends) / 2 + lean,
        ]

    return off


def between(body: str, large: bool = True) -> Conditions:
    """Both conditions of the singular integral equation, of large tension or of moderate:

    int_slip r/w dxi = -pi dsigma/4,  int_slip r (xi - mid)/w dxi = dQ,  r = kappa f (p1 + p2),

    mid the middle of the stick zone; w = sqrt((xi + m)(xi - n)), negative on the left.
    """

    def off(edges: Zone, given: Given) -> list[mpf]:
        m, n = edges
        strain, force = mpmath.pi * given["dsigma"] / 4, -given["dQ"]
        for end in ends_of(given):
            for side in (-1, 1):
                kappa = (-side if given["dsigma"] > 0 else side) if large else 1
                by_strain, by_force = _over_slip(body, end, m, n, side)
                strain += kappa * given["f"] * side * by_strain
                force += kappa * given["f"] * by_force
        return [strain, force]

    return off


def slip_zone(given: Given, m: mpf, n: mpf, side: int) -> tuple[mpf, mpf]:
    """Where the slip zone on one side begins, outward, and its length."""
    start, edge = (n, given["c"]) if side > 0 else (m, given["a"])
    return start, edge - start


def cuts_of(body: str, given: Given, start: mpf, length: mpf, side: int) -> list[mpf]:
    """Its beginning, the kinks in it and its end, as distances from the stick zone."""
    kinks = (side * kink - start for kink in kinks_of(body, given))
    return sorted({mpf(0), length, *(k for k in kinks if 0 < k < length)})


@lru_cache(maxsize=64)
def _over(
    body: str, given: tuple[tuple[str, mpf], ...], m: mpf, n: mpf, side: int, digits: int
) -> list[mpf]:
    point = dict(given)
    start, length = slip_zone(point, m, n, side)
    p, stuck, at = pressure_along(body, point), ball(m + n), ball(start)

    def integrand(y: Ball, _: Ball, __: Ball) -> list[Ball]:
        value = p(side * (at + y)) / (y * (stuck + y)).sqrt()
        return [value, value * (stuck / 2 + y)]

    return integrals(integrand, cuts_of(body, point, start, length, side), digits, AT_ENDS)


def _over_slip(body: str, given: Given, m: mpf, n: mpf, side: int) -> list[mpf]:
    """int p/|w| and int p |xi - mid|/|w| over one slip zone."""
    own = {q.name for q in sheet_of(body).geometry.parameters} | {"a", "c", "E_star"}
    point = tuple((k, v) for k, v in given.items() if k in own)
    return _over(body, point, m, n, side, mpmath.mp.dps)


# ------------------------------------------------------------------ tensions


def threshold(given: Given) -> list[mpf]:
    """Both K_T vanish in turn; constant normal loads."""
    return [s * 8 * given["dQ"] / (mpmath.pi * (given["a"] + given["c"])) for s in (-1, 1)]


# ------------------------------------------------------------------ series


def series(body: str, order: int) -> Conditions:
    """Slip zones cut behind an order, constant normal loads: the terms of derive/theory/slip.py."""
    K, L = ([formula(body, f"{name}_N_{side}") for side in ("left", "right")] for name in "KL")
    near, far = _terms(order)

    def off(zones: Zone, given: Given) -> list[mpf]:
        width = given["a"] + given["c"]
        stuck = width - zones[0] - zones[1]
        senses = [1 if pull >= 0 else -1 for pull in _pulls(given, width)]
        coefficients = [[of(**given) for of in (K[i], L[i])][:order] for i in range(2)]
        if order == 1:
            scale = mpmath.pi * mpmath.sqrt(width) * given["f"]
            pulls = zip(coefficients, zones, _pulls(given, width), strict=True)
            return [scale * C[0] * d - abs(pull) for C, d, pull in pulls]
        total = [-pull for pull in _pulls(given, stuck)]
        for i, terms in enumerate(coefficients):
            slipping = senses[i] * 2 * given["f"]
            total[i] += slipping * near(*terms, zones[i], stuck)
            total[1 - i] += slipping * far(*terms, zones[i], stuck)
        return total

    return off


def _pulls(given: Given, width: mpf) -> list[mpf]:
    """By how much shear and tension drive slip at both edges."""
    return [given["dQ"] + sign * mpmath.pi * width * given["dsigma"] / 8 for sign in (1, -1)]


@cache
def _terms(order: int) -> tuple[Callable[..., mpf], Callable[..., mpf]]:
    """near and far of the theory, of the pressure's coefficients, d and the stick zone's width."""
    C = symbols(f"C_0:{order}")
    taken = [*map(str, C), "d", "stuck"]
    found = []
    for of in (theory.near, theory.far):
        names, function = function_of(of(C, Symbol("d"), Symbol("stuck"), order))
        picked = [taken.index(name) for name in names]
        found.append(lambda *v, function=function, picked=picked: function(*(v[i] for i in picked)))
    return found[0], found[1]


# ------------------------------------------------------------------ shear and slip, constant loads


def change(body: str, large: bool = False) -> Problem:
    """dq at x over the half-cycle."""
    of = _large_change(body) if large else _moderate_change(body)
    zone = between(body) if large else patch(body)
    digits = digits_of(body) if large else 50
    return Problem(zone, lambda edges, given: [of(edges, given)], digits)


def shear(body: str) -> Problem:
    """q at x: half of what twice the loads of the first rise would change, less the fall since."""
    of, zone = _moderate_change(body), patch(body)

    def risen(given: Given) -> Given:
        return {**given, "dQ": 2 * given["Q"], "dsigma": 2 * given["sigma"]}

    return Problem(
        lambda edges, given: [*zone(edges[:2], risen(given)), *zone(edges[2:], given)],
        lambda edges, given: [of(edges[:2], risen(given)) / 2 - of(edges[2:], given)],
    )


def _moderate_change(body: str) -> Callable[[Zone, Given], mpf]:
    """Superposition: 2 f p less 2 f p of the patch."""
    pressure = formula(body, "pressure")

    def of(zone: Zone, given: Given) -> mpf:
        whole = 2 * given["f"] * pressure(**given)
        if not -zone[0] < given["x"] < zone[1]:
            return whole
        return whole - 2 * given["f"] * pressure(**{**given, "a": zone[0], "c": zone[1]})

    return of


def _large_change(body: str) -> Callable[[Zone, Given], mpf]:
    """dq = sqrt((x + m)(n - x))/pi int_slip r/(w (xi - x)) dxi where it sticks."""
    pressure = formula(body, "pressure")

    def of(zone: Zone, given: Given) -> mpf:
        m, n = zone
        x, sense = given["x"], 1 if given["dsigma"] > 0 else -1
        if not -m < x < n:
            return (-sense if x >= n else sense) * 2 * given["f"] * pressure(**given)
        total, p = mpf(0), pressure_along(body, given)
        for side in (-1, 1):
            start, length = slip_zone(given, m, n, side)
            at, wide, off = ball(start), ball(m + n), ball(start - side * x)

            def pulling(y: Ball, _: Ball, __: Ball) -> list[Ball]:
                return [p(side * (at + y)) / ((y * (wide + y)).sqrt() * (off + y))]  # noqa: B023

            cuts = cuts_of(body, given, start, length, side)
            near = float(min(mpf(1), (start - side * x) / length))
            total -= side * sense * integrals(pulling, cuts, mpmath.mp.dps, AT_ENDS, near)[0]
        return 2 * given["f"] * mpmath.sqrt((x + m) * (n - x)) / mpmath.pi * total

    return of


def slip(body: str, large: bool = False) -> Problem:
    """|slip| at x: the mismatch of strain, integrated from the stick zone.

    (E*/2) d slip/dx = -(w/pi) PV int_slip r/(w (xi - x)) dxi in the slip zones, r = 2 kappa f p;
    the integral over x is taken first, for each xi.
    """
    zone = between(body) if large else patch(body)
    told = lambda edges, given: [abs(_slip(body, edges, given, large))]  # noqa: E731
    return Problem(zone, told, digits_of(body) if large else 32)


def _slip(body: str, edges: Zone, given: Given, large: bool) -> mpf:
    m, n = edges
    x, stuck = given["x"], m + n
    here = 1 if x > (n - m) / 2 else -1
    sense = 1 if given["dsigma"] > 0 else -1
    reach = here * x - (n if here > 0 else m)
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
