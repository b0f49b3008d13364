"""Functions of contacts against quadrature, at 40 digits, of slopes that are typed here by hand.

Two profiles that are in no library, and two bodies whose pressure is an integral.
"""

import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from itertools import product
from typing import Any, NamedTuple

import mpmath
import numpy as np
import pytest
from mpmath import mpf
from sympy import Abs, Max

from derive import parameter
from derive.symbols import x
from generated import hyperbola, power
from generated.runtime.types import Contact
from tests.codegen.made import module_of, text_of_body
from tests.derive import integrals

pytestmark = pytest.mark.slow

DIGITS = 40
E_STAR = 1.75
OWN = {"R": 1.25, "b": 0.5, "L": 1.5, "phi": 0.125, "h_0": 0.75}
"""All exact in binary."""
R, b, L, h_0 = (parameter(name, "made up", unit="m") for name in ("R", "b", "L", "h_0"))
phi = parameter("phi", "made up", unit="rad")


class Told(NamedTuple):
    """A body, its parameters, g'(s), and where that has kinks or bends sharply."""

    module: Any
    own: dict[str, float]
    slope: Callable[[mpf], mpf]
    kinks: tuple[float, ...]

    @property
    def law(self) -> dict[str, float]:
        """The parameters and E*."""
        return {"E_star": E_STAR, **self.own}


# ------------------------------------------------------------------ bodies


def cubic_slope(s: mpf) -> mpf:
    beyond = max(-s - OWN["h_0"], mpf(0))
    return s / OWN["R"] + OWN["phi"] * (s > OWN["b"]) - 3 * beyond**2 / mpf(OWN["L"]) ** 2


def quartic_slope(s: mpf) -> mpf:
    return OWN["phi"] * mpmath.sign(s) + 4 * max(mpf(0), s - OWN["b"]) ** 3 / mpf(OWN["L"]) ** 3


MADE = {
    "one_side_cubic": (
        x**2 / (2 * R) + phi * Max(0, x - b) + Max(0, -x - h_0) ** 3 / L**2,
        *(cubic_slope, (OWN["b"], -OWN["h_0"])),
    ),
    "corner_and_quartic": (
        phi * Abs(x) + Max(0, x - b) ** 4 / L**3,
        *(quartic_slope, (0.0, OWN["b"])),
    ),
}
"""g(x), g'(x) and its kinks; the second body is straight on either side of its corner."""


@contextmanager
def made(name: str) -> Iterator[Told]:
    """A body of MADE, generated; its kernels run as plain Python."""
    g, slope, kinks = MADE[name]
    with module_of(text_of_body(g)) as module:
        yield Told(module, {str(s): OWN[str(s)] for s in g.free_symbols - {x}}, slope, kinks)


OTHERS = {
    "power": Told(
        power,
        {"k": 1.5, "L": 1.0},
        lambda s: mpmath.sign(s) * mpmath.sqrt(abs(s)),
        (0.0,),
    ),
    "hyperbola": Told(
        hyperbola, {"phi": 0.25, "b": 0.5}, lambda s: s / (4 * mpmath.sqrt(0.25 + s * s)), (0.0,)
    ),
}

CENTRAL = [
    *((0.875, 1.25), (1.5, 1.0), (0.6875, 0.6875)),
    *((2.5, 3.25), (-0.625, 1.5), (1.75, -0.8125)),
    *((0.0009765625, 1.375), (1.5, 0.5009765625)),
]
"""Edges a and c: central, lopsided, wide, off the origin on either side, close to a kink."""


def close(found: float, wanted: mpf, size: mpf) -> bool:
    return bool(abs(mpf(float(found)) - wanted) <= 1e-12 * size)


def demand(of: Told, left: float, right: float, digits: int = DIGITS) -> bool:
    """That the functions give what quadrature finds; whether the contact carries a load at all."""
    x, reach = (3 * right - 5 * left) / 8, max(abs(left), abs(right))
    with mpmath.workdps(digits):  # loads are differences of slopes
        contact, rest = (mpf(left), mpf(right), of.kinks), (mpf(E_STAR), "tanh-sinh")
        load = integrals.load(of.slope, *contact, *rest)
        if load < mpf(10) ** (20 - digits):
            assert np.isnan(of.module.load(left, right, **of.law))
            return False
        moment = integrals.moment(of.slope, *contact, *rest)
        tilt = integrals.tilt(of.slope, *contact, "tanh-sinh")
        pressure = integrals.pressure(of.slope, mpf(x), *contact, *rest)
        steepest = max(abs(of.slope(-mpf(left))), abs(of.slope(mpf(right))))
    assert close(of.module.load(left, right, **of.law), load, load)
    assert close(of.module.moment(left, right, **of.law), moment, load * reach)
    assert close(of.module.tilt(left, right, **of.own), tilt, steepest)
    assert close(of.module.pressure(x, left, right, **of.law), pressure, pressure)
    return True


def demand_series(of: Told, left: float, right: float) -> None:
    """p/sqrt(s) at s = h 1e-16 is K_N + L_N s; with s twice as large, L_N from the difference."""
    K_N, L_N = of.module.K_N(left, right, **of.law), of.module.L_N(left, right, **of.law)
    for side, K, L in (("left", K_N.left, L_N.left), ("right", K_N.right, L_N.right)):
        with mpmath.workdps(60):
            a, c = mpf(left), mpf(right)
            s = min(mpf(1), a + c) * mpf(10) ** -16
            at = [n * s - a if side == "left" else c - n * s for n in (1, 2)]
            first, second = (
                integrals.pressure(
                    of.slope, place, a, c, of.kinks, mpf(E_STAR), "tanh-sinh", cut=False
                )
                / mpmath.sqrt(n * s)
                for n, place in enumerate(at, start=1)
            )
            rate = (second - first) / s
            value = first - rate * s
        assert close(K, value, value)
        assert close(L, rate, value / min(mpf(1), a + c) * 100)


def test_a_profile_in_no_library() -> None:
    """Also in narrow contacts around a kink, by half widths and shifts in half widths: nothing is
    lost to the distance from the origin."""
    with made("one_side_cubic") as body:
        assert sum(demand(body, *edges) for edges in CENTRAL) >= 6
        for edges in CENTRAL[:3]:
            demand_series(body, *edges)
        half = 2.0**-21
        for kink, shift in product(body.kinks, (0.375, 1.75)):
            mid = kink + shift * half
            demand(body, half - mid, half + mid, digits=80)


def test_a_corner_between_straight_flanks() -> None:
    with made("corner_and_quartic") as body:
        for edges in ((1.0, 1.0), (0.5, OWN["b"] + 1e-9)):
            assert demand(body, *edges)
        demand_series(body, 1.0, 1.0)
        assert math.isnan(body.module.load(-0.05, 0.2, **body.law))
        assert body.module.pressure(0.0, 1.0, 1.0, **body.law) == math.inf
        assert 0 < body.module.pressure(1e-300, 1.0, 1.0, **body.law) < 100


def test_what_is_no_contact_carries_nothing() -> None:
    law = OTHERS["hyperbola"].law
    assert np.all(np.isnan([hyperbola.load(1.0, c, **law) for c in (-1.0, math.nan)]))
    assert math.isnan(hyperbola.pressure(0.0, 0.0, 0.0, **law))
    assert hyperbola.pressure(2.0, 1.0, 1.0, **law) == 0
    law = OTHERS["power"].law  # its curvature is infinite at 0
    on, beside = (power.load(a, 1.0, **law) for a in (0.0, 1e-40))
    assert on == pytest.approx(beside, rel=1e-14)
    at = power.K_N(0.0, 1.0, **law)
    assert math.isnan(at.left) and at.right > 0


@pytest.mark.parametrize("beyond", [2.0**-30, 2.0**-40, -(2.0**-30), -(2.0**-40)])
def test_edges_close_to_an_infinite_curvature_are_found(beyond: float) -> None:
    """They are within 2e-15 of the edges whose load, moment and tilt are found at 40 digits.

    So is the zone that sticks in a wider contact, whose load is larger by dQ/(2 f) and whose tilt
    by dsigma/(4 f E*).
    """
    own = {"k": 1.5625, "L": 1.0}
    law = {"E_star": E_STAR, **own}
    with mpmath.workdps(DIGITS):

        def slope(s: mpf) -> mpf:
            return mpmath.sign(s) * abs(s) ** 0.5625

        given = slope, mpf(1), mpf(beyond), (0.0,)
        rest = mpf(E_STAR), "tanh-sinh"
        load, moment = (float(of(*given, *rest)) for of in (integrals.load, integrals.moment))
        tilt = float(integrals.tilt(*given, "tanh-sinh"))
    wide = Contact(1.125, 0.5, 0.0)
    drop = power.load(wide.a, wide.c, **law) - load
    turn = power.tilt(wide.a, wide.c, **own) - tilt
    f = 0.5
    dQ, dsigma = 2 * f * drop, 4 * f * E_STAR * turn
    for found in (
        power.contact(load, moment, **law),
        power.contact_at_tilt(load, tilt, **law),
        power.stick_zone(wide, wide, dQ, dsigma, f=f, **law),
    ):
        assert np.allclose(found[:2], (1.0, beyond), rtol=0, atol=2e-15)
