"""What mechanics demands of any body: mirrors, scales, round trips, growth, and p carrying P and M.

Of bodies that are closed both ways, and so exact to a rounding or two; test_library has the others.
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
SYMMETRIC = pytest.mark.parametrize("body", ["hertz", "wedge"])

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


def close(got: Any, wanted: Any) -> bool:
    """Whether all fields agree, up to rounding."""
    return bool(np.allclose(got, wanted, rtol=1e-13, atol=0))


# ------------------------------------------------------------------ mirrors


@SYMMETRIC
@MANY
@given(data=st.data())
def test_the_mirror_image_of_a_contact(body: str, data: st.DataObject) -> None:
    here = data.draw(states(body))
    there = State(body, here.c, here.a, here.own, here.E_star)
    assert close(there.of("tilt"), -here.of("tilt"))
    assert close(there.of("load"), here.of("load"))
    assert close(there.of("moment"), -here.of("moment"))
    for name in ("K_N", "L_N"):
        assert close(there.of(name)[::-1], here.of(name))
    place = here.h * data.draw(between(0.001, 0.999)) - here.a
    assert close(there.pressure(-place), here.pressure(place))
    for name, lean in (("contact", "moment"), ("contact_at_tilt", "tilt")):
        solve, load, by = getattr(module(body), name), here.of("load"), here.of(lean)
        turned = solve(load, -by, **here.material)
        assert close([turned.c, turned.a, -turned.alpha], solve(load, by, **here.material))


# ------------------------------------------------------------------ scales


@EVERY_BODY
@MANY
@given(data=st.data(), power=st.integers(-80, 80))
def test_all_lengths_by_a_power_of_four(body: str, data: st.DataObject, power: int) -> None:
    """P goes with a length, M with its square, p and tilt with none; K_N = p/sqrt(s) and so on."""
    state = data.draw(states(body))
    k = 4.0**power
    own = {name: value * k ** LENGTHS[body][name] for name, value in state.own.items()}
    larger = State(body, state.a * k, state.c * k, own, state.E_star)
    place = state.h * 0.3 - state.a
    assert close(larger.of("tilt"), state.of("tilt"))
    assert close(larger.of("load"), k * state.of("load"))
    assert close(larger.of("moment"), k**2 * state.of("moment"))
    assert close(larger.pressure(place * k), state.pressure(place))
    assert close(larger.of("K_N"), np.array(state.of("K_N")) / k**0.5)
    assert close(larger.of("L_N"), np.array(state.of("L_N")) / k**1.5)
    K_T = module(body).K_T
    shear, tension = 0.7, -0.3
    here = np.array(K_T(state.a, state.c, shear, tension))
    assert close(K_T(larger.a, larger.c, shear * k, tension), here * k**0.5)


# ------------------------------------------------------------------ there and back


def agrees(state: State, contact: Any) -> bool:
    """Whether a contact is that of the state, to 1e-13 of its width and of a large tilt."""
    large = abs(State(state.body, 0.9 * state.h, 0.1 * state.h, state.own, 1.0).of("tilt"))
    tilt = state.of("tilt")
    reach = max(abs(state.a), abs(state.c), state.h)
    return bool(
        abs(contact.a - state.a) <= 1e-13 * reach
        and abs(contact.c - state.c) <= 1e-13 * reach
        and abs(contact.alpha - tilt) <= 1e-13 * max(large, abs(tilt))
    )


@EVERY_BODY
@MANY
@given(data=st.data(), stiffer=between(0.01, 100), growth=between(1.001, 1000))
def test_the_contact_under_a_contact_s_loads(
    body: str, data: st.DataObject, stiffer: float, growth: float
) -> None:
    """By its moment and by its tilt; loads and modulus by one factor change no contact, which grows
    with the load at a fixed tilt."""
    state, of = data.draw(states(body)), module(body)
    load, material = stiffer * state.of("load"), dict(state.material)
    material["E_star"] *= stiffer
    assert agrees(state, of.contact(load, stiffer * state.of("moment"), **material))
    tilted = of.contact_at_tilt(load, state.of("tilt"), **material)
    assert agrees(state, tilted) and tilted.alpha == state.of("tilt")
    wider = of.contact_at_tilt(load * growth, state.of("tilt"), **material)
    assert wider.a > tilted.a and wider.c > tilted.c


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
