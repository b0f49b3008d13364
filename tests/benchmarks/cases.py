"""What is compared: five functions, each with its contenders on the same arrays.

Every contender gives the same numbers in the bulk; tests/benchmarks/test_speed.py holds them to it.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from importlib.util import find_spec
from typing import Any

import numpy as np
from sympy import Expr, lambdify, pi, sqrt, symbols

from generated import flat_rounded, hertz, wedge
from generated._types import Contact
from tests.benchmarks import by_hand
from tests.benchmarks.timing import Call
from tests.paper_forms import FORMS

GENERATED, PLAIN, CSE, NUMEXPR, NUMBA, FSOLVE, FLOOR = (
    *("generated", "lambdify", "lambdify, cse", "numexpr", "numba"),
    *("fsolve loop", "one np.log"),
)
CONTENDERS = (GENERATED, PLAIN, CSE, NUMEXPR, NUMBA, FSOLVE, FLOOR)

WEDGE = {"E_star": 75e9, "phi": 0.05}
"""A titanium-like blade root: SI units."""
PUNCH = {"E_star": 75e9, "R": 0.05, "b": 1e-3}
CYLINDER = {"E_star": 75e9, "R": 0.05}
EDGES = {"a": 1e-3, "c": 1.5e-3}
FRICTION = 0.5

Calls = dict[str, Call]


@dataclass(frozen=True)
class Case:
    """One function.

    calls    the contenders' calls at a size
    words    what the contenders are, for the page
    """

    name: str
    calls: Callable[[int], Calls]
    words: str
    limits: Mapping[str, int]

    def at(self, size: int) -> Calls:
        """The contenders that take part at a size; those whose package is missing do not."""
        there = {name: call for name, call in self.calls(size).items() if _is_there(name)}
        return {n: call for n, call in there.items() if size <= self.limits.get(n, size)}


def _is_there(name: str) -> bool:
    return name not in (NUMEXPR, NUMBA) or find_spec(name) is not None


def _random(size: int, **ranges: tuple[float, float]) -> dict[str, Any]:
    rng = np.random.default_rng(7)
    return {name: rng.uniform(*bounds, size) for name, bounds in ranges.items()}


def _floor(array: Any) -> Calls:
    positive = np.abs(array) + 1.0
    return {FLOOR: lambda: np.log(positive)}


def _printed(forms: Mapping[str, Expr], given: Mapping[str, Any]) -> Calls:
    """lambdify of the printed forms, with and without common subexpressions, and numexpr."""
    held = sorted(set().union(*(f.free_symbols for f in forms.values())), key=str)
    values = [given[str(s)] for s in held]
    several = list(forms.values()) if len(forms) > 1 else next(iter(forms.values()))
    plain, cse = (lambdify(held, several, modules="numpy", cse=flag) for flag in (False, True))
    return {
        PLAIN: lambda: plain(*values),
        CSE: lambda: cse(*values),
        NUMEXPR: _by_numexpr(list(forms.values()), {str(s): given[str(s)] for s in held}),
    }


def _by_numexpr(forms: list[Expr], given: Mapping[str, Any]) -> Call:
    """Each form compiled by numexpr, on one thread."""
    if find_spec("numexpr") is None:
        return lambda: None
    import numexpr

    numexpr.set_num_threads(1)
    names = {"asin": "arcsin", "Abs": "abs", "pi": repr(float(np.pi))}
    kinds = [(name, np.float64) for name in sorted(given)]
    texts = [str(form.evalf(17)) for form in forms]
    for mathematical, its in names.items():
        texts = [text.replace(mathematical, its) for text in texts]
    found = [numexpr.NumExpr(text, kinds) for text in texts]
    wanted = [[given[n] for n in of.input_names] for of in found]
    if len(found) == 1:
        return lambda: found[0](*wanted[0])
    return lambda: tuple(of(*inputs) for of, inputs in zip(found, wanted, strict=True))


# ------------------------------------------------------------------ the five


def _pressure(size: int) -> Calls:
    x = _random(size, x=(-0.9e-3, 1.4e-3))["x"]
    a, c, E_star, phi = EDGES["a"], EDGES["c"], *WEDGE.values()
    return {
        GENERATED: lambda: wedge.pressure(x, **EDGES, **WEDGE),
        **_printed(FORMS["wedge"]["pressure"], {"x": x, **EDGES, **WEDGE}),
        NUMBA: lambda: by_hand.compiled(by_hand.wedge_pressure)(x, a, c, E_star, phi),
        **_floor(x),
    }


def _state(size: int) -> Calls:
    given = _random(size, P=(1e5, 1e7), M=(-1e3, 1e3))
    P, M = given.values()
    return {
        GENERATED: lambda: wedge.contact(P, M, **WEDGE),
        **_printed(FORMS["wedge"]["contact"], {**given, **WEDGE}),
        NUMBA: lambda: by_hand.compiled(by_hand.wedge_contact)(P, M, *WEDGE.values()),
        **_floor(P),
    }


def _inverse(size: int) -> Calls:
    """Contacts two to five times as wide as the flat, off its middle by up to 0.3 b."""
    b = PUNCH["b"]
    contacts = _random(size, half=(2 * b, 5 * b), middle=(-0.3 * b, 0.3 * b))
    a = contacts["half"] - contacts["middle"]
    c = contacts["half"] + contacts["middle"]
    P, M = flat_rounded.load(a, c, **PUNCH), flat_rounded.moment(a, c, **PUNCH)
    start = np.log(np.full(size, 3 * b))
    off, law = by_hand.punch_off, tuple(PUNCH.values())
    return {
        GENERATED: lambda: flat_rounded.contact(P, M, **PUNCH),
        NUMBA: lambda: np.exp(by_hand.compiled_newton(off)(start, start, (P, M), *law)),
        FSOLVE: lambda: np.exp(by_hand.by_fsolve(off, start, start, (P, M), *law)),
        **_floor(P),
    }


HALF = 1e-3


def _large(size: int) -> Calls:
    """Shear of 0.1 to 0.5 f P; tension of 1.2 to 3 times that which closes a slip zone."""
    here = Contact(np.float64(HALF), np.float64(HALF), np.float64(0.0))
    full = FRICTION * hertz.load(HALF, HALF, **CYLINDER)
    given = _random(size, part=(0.1, 0.5), over=(1.2, 3.0))
    law = {"f": FRICTION, **CYLINDER}
    dQ = given["part"] * full
    dsigma = given["over"] * hertz.closing_tension(here, here, dQ, **law).upper
    zones = hertz.slip_zones(HALF, HALF, dQ, dsigma, order=2, **law)
    m, n = HALF - np.fmin(zones.left, 0.7 * HALF), HALF - np.fmin(zones.right, 0.7 * HALF)
    off, own = by_hand.hertz_off, (FRICTION, *CYLINDER.values())
    return {
        GENERATED: lambda: hertz.stick_zone(here, here, dQ, dsigma, **law),
        NUMBA: lambda: by_hand.compiled_newton(off)(m, n, (dQ, dsigma), HALF, *own),
        FSOLVE: lambda: by_hand.by_fsolve(off, m, n, (dQ, dsigma), HALF, *own),
        **_floor(dQ),
    }


_a, _c, _dQ, _dsigma, _f = symbols("a c dQ dsigma f")


def _slip(size: int) -> Calls:
    h = EDGES["a"] + EDGES["c"]
    full = FRICTION * wedge.load(**EDGES, **WEDGE)
    given = _random(size, dQ=(0.01 * full, 0.3 * full))
    dQ = given["dQ"]
    dsigma = 12 / np.pi * dQ / h
    of = {"f": FRICTION, **WEDGE}
    width, normal = _a + _c, FORMS["wedge"]["K_N"]
    forms = {
        side: abs(_dQ / pi + sign * _dsigma * width / 8) / sqrt(width) / (_f * normal[side])
        for side, sign in (("left", 1), ("right", -1))
    }
    values = {"dQ": dQ, "dsigma": dsigma, **EDGES, **of}
    a, c = EDGES.values()
    return {
        GENERATED: lambda: wedge.slip_zones(a, c, dQ, dsigma, **of),
        f"{GENERATED}, order 3": lambda: wedge.slip_zones(a, c, dQ, dsigma, order=3, **of),
        **_printed(forms, values),
        NUMBA: lambda: by_hand.compiled(by_hand.wedge_slip)(a, c, dQ, dsigma, *of.values()),
        **_floor(dQ),
    }


CASES = (
    Case(
        "wedge.pressure",
        _pressure,
        "x varies along the array.  Lambdify and numexpr have the printed formula, numba a loop "
        "over it.",
        {},
    ),
    Case(
        "wedge.contact",
        _state,
        "P and M vary; a, c and the tilt come out.  The others compute eqs. (alpha), (gamma) and "
        "(ca); numexpr has no common subexpressions.",
        {},
    ),
    Case(
        "flat_rounded.contact",
        _inverse,
        "P and M vary; two equations are solved.  numba: Newton's method in a loop, in the "
        "logarithms of both edges, derivatives by differences, started from a middling contact; "
        "fsolve: the same equations, load case by load case.  Lambdify and numexpr solve nothing.",
        {GENERATED: 1_000_000, NUMBA: 1_000_000, FSOLVE: 100},
    ),
    Case(
        "hertz.stick_zone, large tension",
        _large,
        "dQ and the tension vary; two equations of integrals are solved.  numba and fsolve: the "
        f"same, their integrals by {by_hand.NODES} Gauss points in each slip zone, started from "
        "the series; they test neither regime nor premise, which stick_zone does.",
        {GENERATED: 100_000, NUMBA: 1_000_000, FSOLVE: 100},
    ),
    Case(
        "wedge.slip_zones",
        _slip,
        "dQ and the tension vary; order 1, which the paper prints.  The others compute the two "
        "quotients and no more; slip_zones also tells sliding and slip zones that meet.",
        {f"{GENERATED}, order 3": 100_000},
    ),
)
