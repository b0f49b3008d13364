"""Growth along fixed tilt, and the inverses: against quadrature, and by putting back."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mpmath import mpf
from sympy import Symbol, atan2, pi, simplify, sqrt, tan

from derive.symbols import E_star, P, alpha, e
from derive.theory.contact_law import contact_from_moment, contact_from_tilt
from tests.derive import integrals
from tests.derive.bodies import BODIES, CASES, VALUES, close, sheet, value
from tests.derive.integrals import Function

ALL = pytest.mark.parametrize(("name", "left", "right"), CASES)
CLOSED = ("hertz", "wedge", "unequal_wedge", "shifted_wedge", "wedge_on_the_left")
OPEN = ("quartic", "two_radii", "flat_rounded")

R, phi, psi, b = (Symbol(name, positive=True) for name in ("R", "phi", "psi", "b"))


def by_edge(f: Function, left: float, right: float) -> tuple[mpf, mpf]:
    """df/da and df/dc by the central difference of a quadrature."""
    step = mpf("1e-8")
    left, right = mpf(left), mpf(right)
    by_a = (f(left + step, right) - f(left - step, right)) / (2 * step)
    by_c = (f(left, right + step) - f(left, right - step)) / (2 * step)
    return by_a, by_c


@ALL
def test_edges_and_load_grow_along_fixed_tilt(name: str, left: float, right: float) -> None:
    """alpha_a a'(c) + alpha_c = 0 and P'(c) = P_c + P_a a'(c), alpha and P by quadrature."""
    slope, kinks = BODIES[name].slope, BODIES[name].kinks
    tilts = by_edge(lambda i, j: integrals.tilt(slope, i, j, kinks), left, right)
    loads = by_edge(lambda i, j: integrals.load(slope, i, j, kinks, VALUES["E_star"]), left, right)
    ratio = -tilts[1] / tilts[0]
    assert close(value(name, "edge_ratio", a=left, c=right), ratio, digits=12)
    rate = loads[1] + loads[0] * ratio
    assert close(value(name, "load_rate", a=left, c=right), rate, digits=12)


_positive = st.floats(0.0625, 16)
_arm = st.floats(-4, 4)
_share = st.floats(-0.9375, 0.9375)


@pytest.mark.parametrize("name", CLOSED)
@settings(max_examples=20)
@given(_positive, _arm)
def test_the_contact_of_load_and_moment_carries_them(name: str, load: float, arm: float) -> None:
    given_loads = {"P": mpf(load), "M": mpf(load) * arm}
    edges = {key: value(name, f"contact_{key}", **given_loads) for key in ("a", "c")}
    assert edges["a"] + edges["c"] > 0
    # a and c are differences of much larger numbers when the arm is long
    assert close(value(name, "load", **edges), mpf(load), digits=18)
    assert close(value(name, "moment", **edges), given_loads["M"], digits=18, scale=load)
    expected = value(name, "tilt", **edges)
    assert close(value(name, "contact_alpha", **given_loads), expected, digits=18, scale=1)


@pytest.mark.parametrize("name", CLOSED)
@settings(max_examples=20)
@given(_positive, _share)
def test_the_contact_of_load_and_tilt_carries_them(name: str, load: float, share: float) -> None:
    low, high = (-0.375 if name == "unequal_wedge" else -0.25), 0.25  # -g' at both ends
    tilt = (mpf(low) + high) / 2 + mpf(share) * (mpf(high) - low) / 2
    given_loads = {"P": mpf(load), "alpha": tilt}
    edges = {key: value(name, f"contact_at_tilt_{key}", **given_loads) for key in ("a", "c")}
    assert edges["a"] + edges["c"] > 0
    assert close(value(name, "load", **edges), mpf(load), digits=18)
    assert close(value(name, "tilt", **edges), tilt, digits=18, scale=1)
    expected = value(name, "moment", **edges)
    found = value(name, "contact_at_tilt_M", **given_loads)
    assert close(found, expected, digits=18, scale=load)


# Hertz: P = pi E* h^2/(16 R), so h/2 = 2 sqrt(P R/(pi E*)); e = M/P = -mid; alpha = -mid/R = e/R.
# Wedge: e = -mid/2, so c - a = -4 e; ac = (P/(E* phi))^2, so (a + c)^2 = 16 e^2 + 4 (P/(E* phi))^2.
#   At fixed tilt theta_1 = (pi/2)(1 - alpha/phi) and c/a = tan^2(theta_1/2).
_base, _root = P / (E_star * phi), 2 * sqrt(P * R / (pi * E_star))
_BY_HAND = {
    **{("hertz", "contact_a"): _root + e, ("hertz", "contact_c"): _root - e},
    **{("hertz", "contact_alpha"): e / R, ("hertz", "contact_at_tilt_M"): P * R * alpha},
    ("hertz", "contact_at_tilt_a"): _root + R * alpha,
    ("hertz", "contact_at_tilt_c"): _root - R * alpha,
    ("wedge", "contact_a"): 2 * e + sqrt(4 * e**2 + _base**2),
    ("wedge", "contact_c"): -2 * e + sqrt(4 * e**2 + _base**2),
    ("wedge", "contact_alpha"): phi * (1 - 2 * atan2(_base, 2 * e) / pi),
    ("wedge", "contact_at_tilt_a"): _base / tan(pi / 4 * (1 - alpha / phi)),
    ("wedge", "contact_at_tilt_c"): _base * tan(pi / 4 * (1 - alpha / phi)),
    ("wedge", "contact_at_tilt_M"): P * _base / 2 / tan(pi / 2 * (1 - alpha / phi)),
}


@pytest.mark.parametrize(("name", "formula"), _BY_HAND, ids="-".join)
def test_the_classic_inverses(name: str, formula: str) -> None:
    assert simplify(sheet(name).flat(formula) - _BY_HAND[name, formula]) == 0


@pytest.mark.parametrize("name", OPEN)
def test_where_no_closed_inverse_is_known_none_is_given(name: str) -> None:
    body = sheet(name)
    forward = (body.frame, body["tilt"].expr, body["load"].expr, body["moment"].expr)
    assert contact_from_moment(*forward) is None
    assert contact_from_tilt(*forward) is None
    assert not any(key.startswith("contact") for key in body)
