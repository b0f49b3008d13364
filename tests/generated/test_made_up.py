"""Profiles that are in no library, from g(x) in a file to a module, without a line of help.

Each is built as a user would, by file name alone, and its functions are held against quadrature at
30 digits of a slope that is typed here by hand, at contacts central and not, and at contacts that
have left kinks or the origin.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import product
from types import ModuleType
from typing import NamedTuple

import mpmath
import numpy as np
import pytest
from mpmath import mpf

from derive.codegen.trial import imported
from derive.pipeline import build
from derive.proof import points, verdict
from tests.derive import integrals

pytestmark = pytest.mark.slow

PROVEN_AT = 6
"""Points of each proof, a quarter of what a user gets: the library's bodies are proven at all of
them, and here the functions are what is asked about."""

DIGITS = 40
E_STAR = 1.75
PARAMETERS = {"R": 1.25, "b": 0.5, "h_0": 0.75, "phi": 0.125, "L": 1.5, "k": 2.75}
UNITS = {"phi": "rad", "k": "-"}

Slope = Callable[[mpf], mpf]


@dataclass(frozen=True)
class Profile:
    """g(x) as a user writes it, its slope by hand, and its kinks."""

    g: str
    parameters: str
    slope: Callable[[dict[str, mpf]], Slope]
    kinks: Callable[[dict[str, mpf]], list[mpf]] = lambda _: []


def up(s: mpf) -> mpf:
    """Max(0, s)."""
    return s if s > 0 else mpf(0)


def sign(s: mpf) -> int:
    return 1 if s > 0 else -1


PROFILES = {
    "one_side_cubic": Profile(
        "x**2/(2*R) + phi*Max(0, x - b) + Max(0, -x - h_0)**3/L**2",
        "R b L phi h_0",
        lambda v: (
            lambda s: (
                s / v["R"] + v["phi"] * (s > v["b"]) - 3 * up(-s - v["h_0"]) ** 2 / v["L"] ** 2
            )
        ),
        lambda v: [v["b"], -v["h_0"]],
    ),
    "four_kinks": Profile(
        "phi*Abs(x) + Max(0, x - b)**3/L**2 + phi*Max(0, x - b - h_0) + Max(0, -x - b)**2/(2*R)",
        "R b L phi h_0",
        lambda v: (
            lambda s: (
                v["phi"] * sign(s)
                + 3 * up(s - v["b"]) ** 2 / v["L"] ** 2
                + v["phi"] * (s > v["b"] + v["h_0"])
                - up(-s - v["b"]) / v["R"]
            )
        ),
        lambda v: [mpf(0), v["b"], v["b"] + v["h_0"], -v["b"]],
    ),
    "lopsided": Profile(
        "phi*b*exp(x/b) + x**2/(2*R)",
        "phi b R",
        lambda v: lambda s: v["phi"] * mpmath.exp(s / v["b"]) + s / v["R"],
    ),
    "powers_beyond_a_flat": Profile(
        "L*(Max(0, Abs(x) - b)/L)**k",
        "L b k",
        lambda v: lambda s: v["k"] * sign(s) * (up(abs(s) - v["b"]) / v["L"]) ** (v["k"] - 1),
        lambda v: [-v["b"], v["b"]],
    ),
}

CONTACTS = [
    *((0.875, 1.25), (1.5, 1.0), (0.6875, 0.6875)),
    *((2.5, 3.25), (-0.625, 1.5), (1.75, -0.8125)),
    *((0.0009765625, 1.375), (1.5, 0.5009765625)),
]
"""Edges a and c: central, lopsided, wide, off the origin on either side, close to a kink."""

HALVES, SHIFTS = (2.0**-4, 2.0**-12, 2.0**-21), (0.0, 0.375, 1.75)
"""Half widths of contacts around a kink, and how far they lie off it, in half widths."""


def text(name: str, profile: Profile) -> str:
    """The file that a user would write."""
    made = "\n".join(
        f'{p} = parameter("{p}", "made up", unit="{UNITS.get(p, "m")}")'
        for p in profile.parameters.split()
    )
    return f"""from sympy import Abs, Max, exp
from derive import Geometry, parameter, x
{made}
geometry = Geometry("{name}", g={profile.g})
"""


def values(profile: Profile) -> dict[str, float]:
    return {p: PARAMETERS[p] for p in profile.parameters.split()}


@pytest.fixture(scope="module", params=PROFILES)
def made(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[tuple[Profile, ModuleType]]:
    """The profile and its module."""
    name, folder = request.param, tmp_path_factory.mktemp("made_up")
    file = folder / f"{name}.py"
    file.write_text(text(name, PROFILES[name]))
    with pytest.MonkeyPatch.context() as fewer:
        fewer.setattr(verdict, "POINTS", PROVEN_AT)
        fewer.setattr(points.draws, "__defaults__", (PROVEN_AT,))
        body = build(str(file))
    with imported(name, body.text, body.stuck) as module:
        yield PROFILES[name], module


class Wanted(NamedTuple):
    """Of one contact; steepest is the size of its tilt."""

    load: mpf
    moment: mpf
    tilt: mpf
    pressure: mpf
    steepest: mpf


def demanded(
    profile: Profile, module: ModuleType, left: float, right: float, x: float, digits: int = DIGITS
) -> Wanted | None:
    """What quadrature finds, x a place in the contact, after a check that the functions give it;
    nothing where the contact carries no load."""
    own = values(profile)
    given, reach = {"E_star": E_STAR, **own}, max(abs(left), abs(right))
    with mpmath.workdps(digits):  # loads are differences of slopes
        exact = {name: mpf(value) for name, value in own.items()}
        slope, kinks = profile.slope(exact), profile.kinks(exact)
        contact, rest = (mpf(left), mpf(right), kinks), (mpf(E_STAR), "tanh-sinh")
        load = integrals.load(slope, *contact, *rest)
        if load < mpf(10) ** (20 - digits):
            return None
        moment = integrals.moment(slope, *contact, *rest)
        tilt = integrals.tilt(slope, *contact, "tanh-sinh")
        pressure = integrals.pressure(slope, mpf(x), *contact, *rest)
        steepest = max(abs(slope(-mpf(left))), abs(slope(mpf(right))))
    assert close(module.load(left, right, **given), load, load)
    assert close(module.moment(left, right, **given), moment, load * reach)
    assert close(module.tilt(left, right, **own), tilt, steepest)
    assert close(module.pressure(x, left, right, **given), pressure, pressure)
    return Wanted(load, moment, tilt, pressure, steepest)


def close(found: float, wanted: mpf, size: mpf) -> bool:
    return bool(abs(mpf(float(found)) - wanted) <= 1e-12 * size)


@pytest.mark.enough("one_side_cubic")
def test_every_function_against_quadrature_of_the_slope(made: tuple[Profile, ModuleType]) -> None:
    profile, module = made
    given = {"E_star": E_STAR, **values(profile)}
    carried = 0
    for left, right in CONTACTS:
        wanted = demanded(profile, module, left, right, (3 * right - 5 * left) / 8)
        if wanted is None:
            assert np.isnan(module.load(left, right, **given))
            continue
        carried += 1
        found = module.contact(float(wanted.load), float(wanted.moment), **given)
        assert close(found.a, mpf(left), mpf(left + right))
        assert close(found.c, mpf(right), mpf(left + right))
        assert close(found.alpha, wanted.tilt, 4 * wanted.steepest)
    assert carried >= 6


@pytest.mark.enough("one_side_cubic")
def test_narrow_contacts_around_a_kink_keep_their_digits(made: tuple[Profile, ModuleType]) -> None:
    """Wherever the kink lies: nothing is lost to powers of its distance from the origin."""
    profile, module = made
    kinks = profile.kinks({name: mpf(value) for name, value in values(profile).items()})
    for kink, half, shift in product(kinks, HALVES, SHIFTS):
        mid = float(kink) + shift * half
        demanded(profile, module, half - mid, half + mid, mid + half / 4, digits=80)


@pytest.mark.enough("one_side_cubic")
def test_the_edge_coefficients_against_the_pressure_next_to_the_edges(
    made: tuple[Profile, ModuleType],
) -> None:
    """p/sqrt(s) at s = h 1e-12 is K_N + L_N s; with s twice as large, L_N from the difference."""
    profile, module = made
    own = values(profile)
    exact = {name: mpf(value) for name, value in own.items()}
    slope, kinks = profile.slope(exact), profile.kinks(exact)
    for left, right in CONTACTS[:3]:
        given = {"E_star": E_STAR, **own}
        K_N, L_N = module.K_N(left, right, **given), module.L_N(left, right, **given)
        for side, K, L in (("left", K_N.left, L_N.left), ("right", K_N.right, L_N.right)):
            with mpmath.workdps(60):
                a, c = mpf(left), mpf(right)
                s = (a + c) * mpf(10) ** -16
                at = [n * s - a if side == "left" else c - n * s for n in (1, 2)]
                first, second = (
                    integrals.pressure(
                        slope, place, a, c, kinks, mpf(E_STAR), "tanh-sinh", cut=False
                    )
                    / mpmath.sqrt(n * s)
                    for n, place in enumerate(at, start=1)
                )
                rate = (second - first) / s
                value = first - rate * s
            assert close(K, value, value)
            assert close(L, rate, value / (a + c) * 100)
