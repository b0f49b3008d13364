"""The third coefficient of the pressure next to the edges, derive/codegen/law.py."""

import importlib
import math

import mpmath
import numpy as np
import pytest
from mpmath import mpf
from numpy.testing import assert_allclose

from derive.codegen import law
from derive.codegen.law import third_program
from derive.codegen.plan import Route, carried_by
from derive.errors import NotProven
from derive.library import library
from derive.proof.points import contacts, numeric
from derive.symbols import E_star, a, c, x
from tests.accuracy.reference import sheet_of

pytestmark = pytest.mark.slow

EXPANDED = ("hertz", "wedge", "unequal_wedge", "quartic", "parabola_quartic")
SUMMED = ("flat_rounded", "flat_sloped", "rounded_wedge", "two_radii", "wedge_parabola")


def third_of(body: str, left: float, right: float, *own: float) -> list[float]:
    """What the kernels find, run as Python; E* = 1."""
    module = importlib.import_module(f"generated.{body}")
    with np.errstate(all="ignore"):
        return [*module._series(np.float64(left), np.float64(right), np.array(own))[2:]]


def test_which_bodies_have_one() -> None:
    routes = {body: carried_by(sheet_of(body)) for body in library()}
    assert {body for body, route in routes.items() if route is Route.FORMULA} == {*EXPANDED}
    assert {body for body, route in routes.items() if route is Route.PARTS} == {*SUMMED}


@pytest.mark.parametrize("body", [*EXPANDED, *SUMMED])
def test_it_is_what_the_pressure_leaves_over(body: str) -> None:
    """(p - K s**(1/2) - L s**(3/2))/s**(5/2) at s = 1e-12 of the width, with 80 digits."""
    sheet = sheet_of(body)
    pressure = numeric(sheet.flat("pressure"))
    for point in contacts(sheet)[:4]:
        kinks = [numeric(kink.position)(point) for kink in sheet.geometry.slope.kinks]
        if any(min(abs(point[a] + k), abs(point[c] - k)) < point[a] / 50 for k in kinks):
            continue
        at = {s: mpf(float(v)) for s, v in point.items()} | {E_star: mpf(1)}
        own = [float(at[q.symbol]) for q in sheet.geometry.parameters]
        found = third_of(body, float(at[a]), float(at[c]), *own)
        for i, (side, edge, inward) in enumerate((("left", -at[a], 1), ("right", at[c], -1))):
            with mpmath.workdps(80):
                distance = (at[a] + at[c]) * mpf(10) ** -12
                root = mpmath.sqrt(distance)
                p = pressure({**at, x: edge + inward * distance}) / root
                K, L = (numeric(sheet.flat(f"{n}_{side}"))(at) for n in ("K_N", "L_N"))
                wanted = float(((p - K) / distance - L) / distance)
            assert_allclose(found[i], wanted, rtol=1e-6)


def test_hertz_and_the_wedge_by_hand() -> None:
    """p = (E*/(2 R)) sqrt(s (h - s)), and sqrt(1 - s/h) = 1 - s/(2 h) - s**2/(8 h**2): at h = 4,
    E* = R = 1 it is -(1/2) 2/(8 16) = -1/128.

    p = (2 phi E*/pi) artanh(r t), t = sqrt(s/(h - s)), r = sqrt(a/c) at the right edge: by
    powers of s r (15 + 20 r**2 + 8 r**4)/(40 h**(5/2)) of artanh.  At a = 4/5, c = 1/5, phi = 1/2:
    h = 1, r = 2 to the right, 1/2 to the left: 2 (15 + 80 + 128)/40 = 11.15 and
    (15 + 5 + 1/2)/80 = 0.25625, over pi.
    """
    assert_allclose(third_of("hertz", 2.5, 1.5, 1.0), -1 / 128, rtol=1e-15)
    by_hand = [0.25625 / math.pi, 11.15 / math.pi]
    assert_allclose(third_of("wedge", 0.8, 0.2, 0.5), by_hand, rtol=1e-15)


def test_a_series_that_contradicts_the_motion_of_the_edge(monkeypatch: pytest.MonkeyPatch) -> None:
    def wrong(*args: object) -> list[object]:
        found = right(*args)  # type: ignore[arg-type]
        return [*found[:2], 2 * found[2]]

    right = law.pressure_series
    monkeypatch.setattr(law, "pressure_series", wrong)
    with pytest.raises(NotProven, match="third coefficient of 'wedge'"):
        third_program(sheet_of("wedge"))
