"""A profile that is in no library, from g(x) in a file to a module, without a line of help.

It is built as a user would, by file name alone, and its functions are held against quadrature at 30
digits of a slope that is typed here by hand, at contacts central and not, and at contacts that have
left kinks or the origin.
"""

from collections.abc import Iterator
from itertools import product
from types import ModuleType
from typing import NamedTuple

import mpmath
import numpy as np
import pytest
from mpmath import mpf

from derive.codegen.trial import imported
from derive.pipeline import build
from tests.derive import integrals

pytestmark = pytest.mark.slow

DIGITS = 40
E_STAR = 1.75
OWN = {"R": 1.25, "b": 0.5, "L": 1.5, "phi": 0.125, "h_0": 0.75}
"""All exact in binary."""
GIVEN = {"E_star": E_STAR, **OWN}
KINKS = [mpf(OWN["b"]), mpf(-OWN["h_0"])]
TEXT = """from sympy import Max
from derive import Geometry, parameter, x
R, b, L, h_0 = (parameter(name, "made up", unit="m") for name in ("R", "b", "L", "h_0"))
phi = parameter("phi", "made up", unit="rad")
g = x**2/(2*R) + phi*Max(0, x - b) + Max(0, -x - h_0)**3/L**2
geometry = Geometry("one_side_cubic", g=g)
"""
"""The file that a user would write."""

CONTACTS = [
    *((0.875, 1.25), (1.5, 1.0), (0.6875, 0.6875)),
    *((2.5, 3.25), (-0.625, 1.5), (1.75, -0.8125)),
    *((0.0009765625, 1.375), (1.5, 0.5009765625)),
]
"""Edges a and c: central, lopsided, wide, off the origin on either side, close to a kink."""

HALVES, SHIFTS = (2.0**-4, 2.0**-12, 2.0**-21), (0.0, 0.375, 1.75)
"""Half widths of contacts around a kink, and how far they lie off it, in half widths."""


def slope(s: mpf) -> mpf:
    """g'(s) by hand."""
    beyond = max(-s - OWN["h_0"], mpf(0))
    return s / OWN["R"] + OWN["phi"] * (s > OWN["b"]) - 3 * beyond**2 / mpf(OWN["L"]) ** 2


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Iterator[ModuleType]:
    """Its module."""
    file = tmp_path_factory.mktemp("made_up") / "one_side_cubic.py"
    file.write_text(TEXT)
    body = build(str(file))
    with imported("one_side_cubic", body.text, body.stuck) as module:
        yield module


class Wanted(NamedTuple):
    """Of one contact; steepest is the size of its tilt."""

    load: mpf
    moment: mpf
    tilt: mpf
    pressure: mpf
    steepest: mpf


def demanded(
    module: ModuleType, left: float, right: float, x: float, digits: int = DIGITS
) -> Wanted | None:
    """What quadrature finds, x a place in the contact, after a check that the functions give it;
    nothing where the contact carries no load."""
    reach = max(abs(left), abs(right))
    with mpmath.workdps(digits):  # loads are differences of slopes
        contact, rest = (mpf(left), mpf(right), KINKS), (mpf(E_STAR), "tanh-sinh")
        load = integrals.load(slope, *contact, *rest)
        if load < mpf(10) ** (20 - digits):
            return None
        moment = integrals.moment(slope, *contact, *rest)
        tilt = integrals.tilt(slope, *contact, "tanh-sinh")
        pressure = integrals.pressure(slope, mpf(x), *contact, *rest)
        steepest = max(abs(slope(-mpf(left))), abs(slope(mpf(right))))
    assert close(module.load(left, right, **GIVEN), load, load)
    assert close(module.moment(left, right, **GIVEN), moment, load * reach)
    assert close(module.tilt(left, right, **OWN), tilt, steepest)
    assert close(module.pressure(x, left, right, **GIVEN), pressure, pressure)
    return Wanted(load, moment, tilt, pressure, steepest)


def close(found: float, wanted: mpf, size: mpf) -> bool:
    return bool(abs(mpf(float(found)) - wanted) <= 1e-12 * size)


def test_every_function_against_quadrature_of_the_slope(made: ModuleType) -> None:
    carried = 0
    for left, right in CONTACTS:
        wanted = demanded(made, left, right, (3 * right - 5 * left) / 8)
        if wanted is None:
            assert np.isnan(made.load(left, right, **GIVEN))
            continue
        carried += 1
        found = made.contact(float(wanted.load), float(wanted.moment), **GIVEN)
        assert close(found.a, mpf(left), mpf(left + right))
        assert close(found.c, mpf(right), mpf(left + right))
        assert close(found.alpha, wanted.tilt, 4 * wanted.steepest)
    assert carried >= 6


def test_narrow_contacts_around_a_kink_keep_their_digits(made: ModuleType) -> None:
    """Wherever the kink lies: nothing is lost to powers of its distance from the origin."""
    for kink, half, shift in product(KINKS, HALVES, SHIFTS):
        mid = float(kink) + shift * half
        demanded(made, half - mid, half + mid, mid + half / 4, digits=80)


def test_the_edge_coefficients_against_the_pressure_next_to_the_edges(
    made: ModuleType,
) -> None:
    """p/sqrt(s) at s = h 1e-12 is K_N + L_N s; with s twice as large, L_N from the difference."""
    for left, right in CONTACTS[:3]:
        K_N, L_N = made.K_N(left, right, **GIVEN), made.L_N(left, right, **GIVEN)
        for side, K, L in (("left", K_N.left, L_N.left), ("right", K_N.right, L_N.right)):
            with mpmath.workdps(60):
                a, c = mpf(left), mpf(right)
                s = (a + c) * mpf(10) ** -16
                at = [n * s - a if side == "left" else c - n * s for n in (1, 2)]
                first, second = (
                    integrals.pressure(
                        slope, place, a, c, KINKS, mpf(E_STAR), "tanh-sinh", cut=False
                    )
                    / mpmath.sqrt(n * s)
                    for n, place in enumerate(at, start=1)
                )
                rate = (second - first) / s
                value = first - rate * s
            assert close(K, value, value)
            assert close(L, rate, value / (a + c) * 100)
