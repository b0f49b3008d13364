"""Conditions for the stick zone and for the tensions that bound its regimes.

`a` and `c` are the edges at one end of the half-cycle, `a_2` and `c_2` those at the other, where
the normal loads vary.
"""

from collections.abc import Sequence

import mpmath
from mpmath import mpf

from derive.proof.balls import Ball, ball
from tests.accuracy.definitions import formula, kinks_of, pressure_along
from tests.accuracy.quadrature import integrals
from tests.accuracy.reference import Conditions, Given, Problem

AT_ENDS = (-0.5, 0.5)
"""How p/w grows where slip begins, and how it falls at the edge."""


def ends_of(given: Given) -> list[dict[str, mpf]]:
    """What is given, at each of both contacts."""
    second = {name: given.get(f"{name}_2", given[name]) for name in "ac"}
    return [dict(given), {**given, **second}]


def patch(body: str) -> Conditions:
    """Moderate tension: the contact at a reduced load and a shifted tilt."""
    load, tilt = formula(body, "load"), formula(body, "tilt")

    def off(edges: Sequence[mpf], given: Given) -> list[mpf]:
        there, ends = {**given, "a": edges[0], "c": edges[1]}, ends_of(given)
        lean = given["dsigma"] / (4 * given["f"] * given["E_star"])
        return [
            load(**there) - sum(load(**end) for end in ends) / 2 + given["dQ"] / (2 * given["f"]),
            tilt(**there) - sum(tilt(**end) for end in ends) / 2 + lean,
        ]

    return off


def between(body: str) -> Conditions:
    """Large tension and constant normal loads, both conditions of the singular integral equation:

    int_slip r/w dxi = -pi dsigma/4,  int_slip r (xi - mid)/w dxi = dQ,  r = 2 kappa f p,

    mid the middle of the stick zone; w = sqrt((xi + m)(xi - n)), negative on the left.
    """

    def off(edges: Sequence[mpf], given: Given) -> list[mpf]:
        m, n = edges
        strain, force = mpmath.pi * given["dsigma"] / 4, -given["dQ"]
        for side in (-1, 1):
            kappa = -side if given["dsigma"] > 0 else side
            by_strain, by_force = _over_slip(body, given, m, n, side)
            strain += kappa * 2 * given["f"] * side * by_strain
            force += kappa * 2 * given["f"] * by_force
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


def _over_slip(body: str, given: Given, m: mpf, n: mpf, side: int) -> list[mpf]:
    """int p/|w| and int p |xi - mid|/|w| over one slip zone."""
    start, length = slip_zone(given, m, n, side)
    p, stuck, at = pressure_along(body, given), ball(m + n), ball(start)

    def integrand(y: Ball, _: Ball, __: Ball) -> list[Ball]:
        value = p(side * (at + y)) / (y * (stuck + y)).sqrt()
        return [value, value * (stuck / 2 + y)]

    cuts = cuts_of(body, given, start, length, side)
    return integrals(integrand, cuts, mpmath.mp.dps, grows=AT_ENDS)


def threshold(body: str) -> Conditions:
    """Both K_T vanish in turn."""

    def off(tensions: Sequence[mpf], given: Given) -> list[mpf]:
        width = given["a"] + given["c"]
        return [
            mpmath.pi * width * t / 8 - s * given["dQ"]
            for t, s in zip(tensions, (-1, 1), strict=True)
        ]

    return off


def closing(body: str) -> Problem:
    """The tension that leaves no slip at one edge of the patch; its other edge is the unknown."""
    load, tilt = formula(body, "load"), formula(body, "tilt")

    def patches(edges: Sequence[mpf], given: Given) -> list[dict[str, mpf]]:
        ends = ends_of(given)
        least = {name: min(end[name] for end in ends) for name in "ac"}
        return [{**given, **least, "c": edges[0]}, {**given, **least, "a": edges[1]}]

    def off(edges: Sequence[mpf], given: Given) -> list[mpf]:
        mean = sum(load(**end) for end in ends_of(given)) / 2
        under = mean - given["dQ"] / (2 * given["f"])
        return [load(**there) - under for there in patches(edges, given)]

    def told(edges: Sequence[mpf], given: Given) -> list[mpf]:
        mean = sum(tilt(**end) for end in ends_of(given)) / 2
        scale = 4 * given["f"] * given["E_star"]
        return [scale * (mean - tilt(**there)) for there in patches(edges, given)]

    return Problem(off, told)
