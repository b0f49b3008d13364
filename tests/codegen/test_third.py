"""The third coefficient of the pressure next to the edges, derive/codegen/third.py."""

import importlib
import math

import mpmath
import numpy as np
import pytest
from mpmath import mpf
from numpy.testing import assert_allclose

from derive.codegen import third
from derive.codegen.plan import Route, carried_by
from derive.codegen.third import third_text
from derive.errors import NotProven
from derive.library import library
from derive.proof.points import contacts, numeric
from derive.symbols import a, c, x
from generated import hertz, wedge
from tests.accuracy.reference import sheet_of

pytestmark = pytest.mark.slow

EXPANDED = ("hertz", "wedge", "unequal_wedge", "quartic", "parabola_quartic")
SUMMED = ("flat_rounded", "flat_sloped", "rounded_wedge", "two_radii", "wedge_parabola")


def test_which_bodies_have_one() -> None:
    routes = {body: carried_by(sheet_of(body)) for body in library()}
    assert {body for body, route in routes.items() if route is Route.FORMULA} == {*EXPANDED}
    assert {body for body, route in routes.items() if route is Route.PARTS} == {*SUMMED}
    assert third_text(sheet_of("catenary"), Route.QUADRATURE, "g.py") == ""


@pytest.mark.parametrize("body", [*EXPANDED, *SUMMED])
def test_it_is_what_the_pressure_leaves_over(body: str) -> None:
    """(p - K s**(1/2) - L s**(3/2))/s**(5/2) at s = 1e-12 of the width, with 80 digits."""
    sheet, module = sheet_of(body), importlib.import_module(f"generated.{body}")
    pressure = numeric(sheet.flat("pressure"))
    for point in contacts(sheet)[:4]:
        kinks = [numeric(kink.position)(point) for kink in sheet.geometry.slope.kinks]
        if any(min(abs(point[a] + k), abs(point[c] - k)) < point[a] / 50 for k in kinks):
            continue
        given = {str(s): float(v) for s, v in point.items()}
        names = ("a", "c", "E_star", *(q.name for q in sheet.geometry.parameters))
        with np.errstate(all="ignore"):
            found = module._third(**{name: np.float64(given[name]) for name in names})
        at = {s: mpf(float(v)) for s, v in point.items()}
        for side, edge, inward in (("left", -at[a], 1), ("right", at[c], -1)):
            with mpmath.workdps(80):
                distance = (at[a] + at[c]) * mpf(10) ** -12
                root = mpmath.sqrt(distance)
                p = pressure({**at, x: edge + inward * distance}) / root
                K, L = (numeric(sheet.flat(f"{n}_{side}"))(at) for n in ("K_N", "L_N"))
                wanted = float(((p - K) / distance - L) / distance)
            assert_allclose(getattr(found, side), wanted, rtol=1e-6)


def test_hertz_by_hand() -> None:
    """p = (E*/(2 R)) sqrt(s (h - s)), and sqrt(1 - s/h) = 1 - s/(2 h) - s**2/(8 h**2): at h = 4,
    E* = R = 1 it is -(1/2) 2/(8 16) = -1/128.
    """
    found = hertz._third(*map(np.float64, (2.5, 1.5)), E_star=np.float64(1), R=np.float64(1))
    assert_allclose([*found], -1 / 128, rtol=1e-15)


def test_the_wedge_by_hand() -> None:
    """p = (2 phi E*/pi) artanh(r t), t = sqrt(s/(h - s)), r = sqrt(a/c) at the right edge: by
    powers of s r (15 + 20 r**2 + 8 r**4)/(40 h**(5/2)) of artanh.  At a = 4/5, c = 1/5, phi = 1/2:
    h = 1, r = 2 to the right, 1/2 to the left: 2 (15 + 80 + 128)/40 = 11.15 and
    (15 + 5 + 1/2)/80 = 0.25625, over pi.
    """
    found = wedge._third(*map(np.float64, (0.8, 0.2)), E_star=np.float64(1), phi=np.float64(0.5))
    assert_allclose([*found], [0.25625 / math.pi, 11.15 / math.pi], rtol=1e-15)


def test_a_series_that_contradicts_the_motion_of_the_edge(monkeypatch: pytest.MonkeyPatch) -> None:
    def wrong(*args: object) -> list[object]:
        found = right(*args)  # type: ignore[arg-type]
        return [*found[:2], 2 * found[2]]

    right = third.pressure_series
    monkeypatch.setattr(third, "pressure_series", wrong)
    with pytest.raises(NotProven, match="_third of 'wedge'"):
        third_text(sheet_of("wedge"), Route.FORMULA, "g.py")
