"""Every body of the library: there and back over 24 decades, mirrors, scales, and any input."""

import importlib
from types import ModuleType
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from derive.library import library, load_geometry
from derive.units import parse_unit
from tests.benchmarks.inverse import PARAMETERS, SYMMETRIC, states

OWN: dict[str, dict[str, float]] = PARAMETERS | {
    "hertz": {"R": 1.5},
    "wedge": {"phi": 0.25},
    "unequal_wedge": {"phi_1": 0.25, "phi_2": 0.125},
}
EVERY = pytest.mark.parametrize("name", sorted(OWN))
COUNT = 2000
E_STAR = 1.75

A, C = np.array([1.25, 1.5, 1.125]), np.array([1.5, 1.25, 1.0625])
"""Contacts of every body; they reach over all its kinks."""


def module(name: str) -> ModuleType:
    return importlib.import_module(f"generated.{name}")


def shrunk(name: str) -> tuple[dict[str, float], Any, Any]:
    """Parameters and contacts, small for the arc, which ends at its radius."""
    by = 0.25 if name == "circular_arc" else 1.0
    return OWN[name], by * A, by * C


def test_the_tests_know_every_body() -> None:
    assert sorted(OWN) == sorted(library())


@pytest.mark.slow
@pytest.mark.parametrize("name", sorted(PARAMETERS))
def test_contact_inverts_load_and_moment_over_24_decades(name: str) -> None:
    """None lost; what is off is what the rounding of the edges moves."""
    body, own, a, c = states(name, COUNT)
    given = {"E_star": E_STAR, **own}
    load, moment = body.load(a, c, **given), body.moment(a, c, **given)
    found = body.contact(load, moment, **given)
    assert not np.any(np.isnan(found.a))
    h, K = a + c, body.K_N(a, c, **given)
    rounding = np.sqrt(h) * (K.left * np.abs(a) + K.right * np.abs(c)) * 2.0**-52 / load
    allowed = 1e-13 + 4 * rounding
    assert np.all(np.abs(body.load(found.a, found.c, **given) / load - 1) < allowed)
    off = body.moment(found.a, found.c, **given) - moment
    assert np.all(np.abs(off) / (load * h) < allowed)


@EVERY
def test_contact_at_tilt_inverts_load_and_tilt(name: str) -> None:
    own, a, c = shrunk(name)
    body, given = module(name), {"E_star": E_STAR, **own}
    found = body.contact_at_tilt(body.load(a, c, **given), body.tilt(a, c, **own), **given)
    assert_allclose(found.a, a, rtol=1e-13)
    assert_allclose(found.c, c, rtol=1e-13)


@pytest.mark.parametrize("name", sorted(SYMMETRIC))
def test_the_mirror_image_of_a_contact(name: str) -> None:
    own, a, c = shrunk(name)
    body, given = module(name), {"E_star": E_STAR, **own}
    x = -a + 0.3 * (a + c)
    for function, odd in (("load", 1), ("moment", -1)):
        there, here = (getattr(body, function)(*e, **given) for e in ((c, a), (a, c)))
        assert_allclose(there, odd * here, rtol=1e-13, atol=1e-15)
    for function in ("K_N", "L_N"):
        there, here = (getattr(body, function)(*e, **given) for e in ((c, a), (a, c)))
        assert_allclose(there.left, here.right, rtol=1e-12)
    assert_allclose(body.tilt(c, a, **own), -body.tilt(a, c, **own), rtol=1e-12, atol=1e-15)
    there, here = body.pressure(-x, c, a, **given), body.pressure(x, a, c, **given)
    assert_allclose(there, here, rtol=1e-12)


@EVERY
def test_all_lengths_larger_by_one_factor(name: str) -> None:
    """P goes with it, M with its square, tilt and pressure not at all."""
    own, a, c = shrunk(name)
    by = 2.0**11
    units = {q.name: parse_unit(q.unit).length for q in load_geometry(name).parameters}
    larger = {key: value * by ** float(units[key]) for key, value in own.items()}
    body = module(name)
    small, large = {"E_star": E_STAR, **own}, {"E_star": E_STAR, **larger}
    assert_allclose(body.load(by * a, by * c, **large), by * body.load(a, c, **small), rtol=1e-13)
    x = -a + 0.4 * (a + c)
    there = body.pressure(by * x, by * a, by * c, **large)
    assert_allclose(there, body.pressure(x, a, c, **small), rtol=1e-13)
    assert_allclose(body.tilt(by * a, by * c, **larger), body.tilt(a, c, **own), rtol=1e-12)


@EVERY
def test_numbers_arrays_and_what_does_not_exist(name: str) -> None:
    own, a, c = shrunk(name)
    body, given = module(name), {"E_star": E_STAR, **own}
    load = body.load(a, c, **given)
    alone = [body.load(float(p), float(q), **given) for p, q in zip(a, c, strict=True)]
    assert_allclose(alone, load, rtol=1e-14)
    assert type(alone[0]) is np.float64
    assert body.load(a[:, None], c, **given).shape == (3, 3)
    assert body.load(np.empty(0), c[:1], **given).shape == (0,)
    stiffness = np.array([[1.0], [2.0]])
    assert body.contact(load, E_star=stiffness, **own).a.shape == (2, 3)
    mixed = body.contact(np.array([load[0], -1.0, np.nan, load[1]]), **given)
    assert list(np.isnan(mixed.a)) == [False, True, True, False]
    assert_allclose(mixed.a[[0, 3]], body.contact(load[:2], **given).a, rtol=1e-14)
    assert np.isnan(body.load(-2.0, 1.0, **given))
    outside = body.pressure(np.array([-1e160, 1e160, -np.inf, np.inf, 3.0]), a[0], c[0], **given)
    assert list(outside) == [0.0] * 5
    assert np.isnan(body.pressure(np.nan, a[0], c[0], **given))
    many = np.linspace(0.9, 1.0, 30_000)
    whole = body.load(many * a[0], c[0], **given)
    assert_allclose(whole[::7000], body.load(many[::7000] * a[0], c[0], **given), rtol=1e-13)


@EVERY
def test_the_pressure_carries_the_load(name: str) -> None:
    """int p dx by Gauss and Chebyshev on x = mid + (h/2) cos(t); corners are only logarithms."""
    own, a, c = shrunk(name)
    body, given = module(name), {"E_star": E_STAR, **own}
    t = (np.arange(4000) + 0.5) * np.pi / 4000
    for left, right in zip(a, c, strict=True):
        h, mid = left + right, (right - left) / 2
        p = body.pressure(mid + h / 2 * np.cos(t), left, right, **given)
        found = np.sum(p * np.sin(t)) * h / 2 * np.pi / 4000
        assert_allclose(found, body.load(left, right, **given), rtol=1e-3)
