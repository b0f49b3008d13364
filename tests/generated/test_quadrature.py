"""Functions of contacts against quadrature, at 40 digits, of slopes that are typed here by hand.

A profile that is in no library, built as a user would, from a file; two bodies whose pressure is an
integral; and a curve with a corner, a flat and a quartic that the runtime integrates.
"""

import math
from collections.abc import Callable, Iterator
from itertools import product
from types import SimpleNamespace
from typing import Any, NamedTuple

import mpmath
import numpy as np
import pytest
from mpmath import mpf

from derive.codegen.trial import imported
from derive.pipeline import sheet_and_body
from generated import hyperbola, power
from generated.runtime import pieces
from generated.runtime.body import Body
from generated.runtime.forward import each_pressure, each_series, each_state
from generated.runtime.kernels import kernel
from generated.runtime.types import Contact, Edges
from tests.derive import integrals

pytestmark = pytest.mark.slow

DIGITS = 40
E_STAR = 1.75
OWN = {"R": 1.25, "b": 0.5, "L": 1.5, "phi": 0.125, "h_0": 0.75}
"""All exact in binary."""
TEXT = """from sympy import Max
from derive import Geometry, parameter, x
R, b, L, h_0 = (parameter(name, "made up", unit="m") for name in ("R", "b", "L", "h_0"))
phi = parameter("phi", "made up", unit="rad")
g = x**2/(2*R) + phi*Max(0, x - b) + Max(0, -x - h_0)**3/L**2
geometry = Geometry("one_side_cubic", g=g)
"""
"""The file that a user would write."""


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


# ------------------------------------------------------------------ a curve of one's own


@kernel
def _kinked(piece: int, side: float, t: float, own: Any) -> Any:
    """phi |x| + max(0, x - b)**4/(4 R**3)."""
    phi, R = own[0], own[2]
    if piece < 2:
        return (phi if piece == 1 else -phi), 0.0, 0.0
    return phi + t**3 / R**3, 3 * t**2 / R**3, 6 * t**2 / R**3


@kernel
def _breaks(own: Any) -> Any:
    return np.array([0.0, own[1]])


@kernel
def _corners(own: Any) -> Any:
    return np.array([2 * own[0], 0.0])


def _pressure(x: float, a: float, c: float, own: Any) -> float:
    return pieces.pressure(pieces.curve_of(_kinked, _breaks, _corners), x, a, c, own)


def _state(a: float, c: float, own: Any) -> Any:
    return pieces.state(pieces.curve_of(_kinked, _breaks, _corners), a, c, own)


def _slope(x: float, own: Any) -> Any:
    return pieces.slope(pieces.curve_of(_kinked, _breaks, _corners), x, own)


def _series(a: float, c: float, own: Any) -> Any:
    return pieces.series(pieces.curve_of(_kinked, _breaks, _corners), a, c, own)


def _cuts(own: Any) -> Any:
    return _breaks(own)


BODY = Body(__name__, _pressure, _state, _slope, _series, _cuts)
PARAMETERS = np.array([[0.125, 0.25, 1.0]])
"""phi = 1/8, b = 1/4, R = 1."""


def solved(loop: Any, count: int, *row: float) -> Any:
    """What a loop finds of the curve."""
    out = np.empty((1, count))
    loop(BODY.law, np.array([row], dtype=float), PARAMETERS, out)
    return out[0]


def _of_state(*fields: int) -> Callable[..., Any]:
    def function(a: float, c: float, E_star: float = 1.0) -> Any:
        found = solved(each_state, 5, a, c, E_star)[list(fields)]
        return Edges(*found) if len(fields) == 2 else found[0]

    return function


CURVE = SimpleNamespace(
    load=_of_state(0),
    moment=_of_state(1),
    tilt=_of_state(2),
    K_N=_of_state(3, 4),
    L_N=lambda a, c, E_star: Edges(*solved(each_series, 2, a, c, E_star)),
    pressure=lambda x, a, c, E_star: solved(each_pressure, 1, x, a, c, E_star)[0],
)


# ------------------------------------------------------------------ bodies


def made_slope(s: mpf) -> mpf:
    beyond = max(-s - OWN["h_0"], mpf(0))
    return s / OWN["R"] + OWN["phi"] * (s > OWN["b"]) - 3 * beyond**2 / mpf(OWN["L"]) ** 2


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Told]:
    file = tmp_path_factory.mktemp("made_up") / "one_side_cubic.py"
    file.write_text(TEXT)
    _, body = sheet_and_body(str(file))
    with imported("one_side_cubic", body.text, body.stuck) as module:
        yield Told(module, OWN, made_slope, (OWN["b"], -OWN["h_0"]))


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
    "curve": Told(
        CURVE, {}, lambda s: mpmath.sign(s) / 8 + max(mpf(0), s - 0.25) ** 3, (0.0, 0.25)
    ),
}

CENTRAL = [
    *((0.875, 1.25), (1.5, 1.0), (0.6875, 0.6875)),
    *((2.5, 3.25), (-0.625, 1.5), (1.75, -0.8125)),
    *((0.0009765625, 1.375), (1.5, 0.5009765625)),
]
"""Edges a and c: central, lopsided, wide, off the origin on either side, close to a kink."""

CONTACTS = {
    "power": [(1.0, 0.5), (1.0, -1e-9)],
    "hyperbola": [(-0.25, 1.0), (20.0, 30.0)],
    "curve": [(1.0, 0.5), (0.5, 0.25 + 1e-9)],
}


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


def test_a_profile_in_no_library(made: Told) -> None:
    assert sum(demand(made, *edges) for edges in CENTRAL) >= 6
    for edges in CENTRAL[:3]:
        demand_series(made, *edges)


def test_narrow_contacts_around_a_kink_keep_their_digits(made: Told) -> None:
    """Half widths and shifts in half widths; nothing is lost to the distance from the origin."""
    for kink, half, shift in product(made.kinks, (2.0**-4, 2.0**-12, 2.0**-21), (0.0, 0.375, 1.75)):
        mid = kink + shift * half
        demand(made, half - mid, half + mid, digits=80)


@pytest.mark.parametrize("name", OTHERS)
def test_what_is_integrated(name: str) -> None:
    for edges in CONTACTS[name]:
        assert demand(OTHERS[name], *edges)
    demand_series(OTHERS[name], *CONTACTS[name][0])


def test_what_is_no_contact_carries_nothing() -> None:
    law = OTHERS["hyperbola"].law
    assert np.all(np.isnan([hyperbola.load(1.0, c, **law) for c in (-1.0, math.nan)]))
    assert math.isnan(hyperbola.pressure(0.0, 0.0, 0.0, **law))
    assert hyperbola.pressure(2.0, 1.0, 1.0, **law) == 0
    assert math.isnan(CURVE.load(-0.05, 0.2, E_STAR))
    assert CURVE.pressure(0.0, 1.0, 1.0, E_STAR) == math.inf
    assert 0 < CURVE.pressure(1e-300, 1.0, 1.0, E_STAR) < 100
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
