"""What mechanics demands of pressure and full stick, at random contacts of bodies in closed form.

Mirrors, scales, round trips and growth of every body are in test_library.py.
"""

import importlib
from dataclasses import dataclass
from types import ModuleType
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy.integrate import quad

LENGTHS = {"hertz": {"R": 1}, "wedge": {"phi": 0}, "unequal_wedge": {"phi_1": 0, "phi_2": 0}}
"""Bodies, and the powers of length that their parameters are."""

EVERY_BODY = pytest.mark.parametrize("body", LENGTHS)

MANY = settings(max_examples=50, deadline=None)
FEW = settings(max_examples=15, deadline=None)


def module(body: str) -> ModuleType:
    return importlib.import_module(f"generated.{body}")


@dataclass(frozen=True)
class State:
    """A contact [-a, c] of a body, and its material."""

    body: str
    a: float
    c: float
    own: dict[str, float]
    E_star: float

    h = property(lambda self: self.a + self.c)
    material = property(lambda self: {"E_star": self.E_star, **self.own})

    def of(self, function: str, *before: float) -> Any:
        """A function of (a, c), or of (x, a, c)."""
        constants = self.own if function == "tilt" else self.material
        return getattr(module(self.body), function)(*before, self.a, self.c, **constants)

    def pressure(self, place: Any) -> Any:
        return self.of("pressure", place)


def between(low: float, high: float) -> st.SearchStrategy[float]:
    return st.floats(low, high, allow_subnormal=False)


@st.composite
def states(draw: st.DrawFn, body: str) -> State:
    """Contacts of all sizes; a wedge's hold its apex."""
    size = 10 ** draw(between(-6, 3))
    reach = 3.0 if body == "hertz" else 0.45
    offset = draw(between(-reach, reach))
    a, c = size * (0.5 + offset), size * (0.5 - offset)
    shortest = min(abs(a), abs(c)) or size
    own = {
        name: draw(between(0.05, 0.5)) * shortest**power for name, power in LENGTHS[body].items()
    }
    state = State(body, a, c, own, 10 ** draw(between(-2, 12)))
    assume(np.isfinite(state.of("load")))
    return state


# ------------------------------------------------------------------ pressure


@EVERY_BODY
@MANY
@given(data=st.data())
def test_pressure_is_positive_inside_and_zero_outside(body: str, data: st.DataObject) -> None:
    state = data.draw(states(body))
    shares = np.array(data.draw(st.lists(between(1e-9, 1 - 1e-9), min_size=1, max_size=20)))
    places = state.h * shares - state.a
    places = places[(places > -state.a) & (places < state.c)]
    assert np.all(state.pressure(places) > 0)
    outside = np.array([-state.a - state.h * 1e-9, -state.a, state.c, state.c + state.h * 1e-9])
    assert np.array_equal(state.pressure(outside), np.zeros(4))


def integral(state: State, weight: Any) -> float:
    """int p weight ds, by s = mid + (h/2) cos(t), cut at the origin."""
    middle, half = (state.c - state.a) / 2, state.h / 2

    def integrand(t: float) -> float:
        place = middle + half * np.cos(t)
        return float(state.pressure(place) * weight(place) * half * np.sin(t))

    scale = state.E_star * state.h * max(abs(weight(-state.a)), abs(weight(state.c)), half)
    accuracy = {"epsabs": 1e-13 * scale, "epsrel": 1e-11}
    turn = np.arccos(np.clip(-middle / half, -1, 1))
    return sum(quad(integrand, *part, **accuracy)[0] for part in ((0, turn), (turn, np.pi)))


@EVERY_BODY
@FEW
@given(data=st.data())
def test_pressure_carries_load_and_moment(body: str, data: st.DataObject) -> None:
    state = data.draw(states(body))
    load, arm = state.of("load"), max(abs(state.a), abs(state.c))
    assert abs(integral(state, lambda place: 1.0) - load) <= 1e-9 * load
    found = -integral(state, lambda place: place)
    assert abs(found - state.of("moment")) <= 1e-9 * load * arm


@EVERY_BODY
@MANY
@given(data=st.data())
def test_pressure_next_to_an_edge_is_its_series(body: str, data: st.DataObject) -> None:
    """p = K_N sqrt(s) + L_N s**(3/2) + ..., the rest of the order of (s/h)**2 of the first."""
    state = data.draw(states(body))
    places = -state.a + state.h * 2.0**-17, state.c - state.h * 2.0**-17
    distances = places[0] + state.a, state.c - places[1]
    for place, s, K, L in zip(places, distances, state.of("K_N"), state.of("L_N"), strict=True):
        assert abs(state.pressure(place) - np.sqrt(s) * (K + L * s)) <= 1e-7 * np.sqrt(s) * K
        assert abs(L * s) <= 1e-3 * K


@EVERY_BODY
@MANY
@given(data=st.data(), shear=between(0.1, 10), tension=between(-10, 10))
def test_full_stick_next_to_an_edge_is_singular(
    body: str, data: st.DataObject, shear: float, tension: float
) -> None:
    """dq = [dQ/pi - (dsigma/4)(x - mid)]/sqrt((a + x)(c - x)) ~ K_T/sqrt(s)."""
    state = data.draw(states(body))
    shear *= state.h
    K_T = module(body).K_T(state.a, state.c, shear, tension)
    s = state.h * 2.0**-40
    largest = max(map(abs, K_T))
    for from_middle, K in ((-state.h / 2 + s, K_T.left), (state.h / 2 - s, K_T.right)):
        change = (shear / np.pi - tension / 4 * from_middle) / np.sqrt(s * (state.h - s))
        assert abs(change * np.sqrt(s) - K) <= 1e-10 * largest
