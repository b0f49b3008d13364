"""What is compared: five functions, each with its contenders on the same arrays.

Every contender gives the same numbers in the bulk; tests/benchmarks/test_speed.py holds them to it.
Each imports what it needs when it is built, so that a process with one of them holds no other; the
data are made in another one.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from importlib import import_module
from importlib.util import find_spec
from typing import Any

import numpy as np
from sympy import Expr, lambdify, pi, sqrt, symbols

from tests.benchmarks import by_hand
from tests.benchmarks.timing import Call
from tests.paper_forms import FORMS

GENERATED, PLAIN, CSE, NUMEXPR, NUMBA, OURS, FSOLVE, FLOOR = (
    *("generated", "lambdify", "lambdify, cse", "numexpr", "numba", "numba, our form"),
    *("fsolve loop", "one np.log"),
)
CONTENDERS = (GENERATED, PLAIN, CSE, NUMEXPR, NUMBA, OURS, FSOLVE, FLOOR)

WEDGE = {"E_star": 75e9, "phi": 0.05}
"""A titanium-like blade root: SI units."""
PUNCH = {"E_star": 75e9, "R": 0.05, "b": 1e-3}
CYLINDER = {"E_star": 75e9, "R": 0.05}
EDGES = {"a": 1e-3, "c": 1.5e-3}
POSITIONS = {"x": (-0.9e-3, 1.4e-3)}
LOADS = {"P": (1e5, 1e7), "M": (-1e3, 1e3)}
FRICTION = 0.5

Data = Mapping[str, Any]
"""Arrays of float64 and numbers by name."""

Builder = Callable[[Data], Call]
"""A contender: of the data, the call that is timed."""


@dataclass(frozen=True)
class Case:
    """One function.

    data        its arguments at a size; the program may have been used to make them
    contenders  by name
    words       what they are, for the page
    limits      the largest size of those that would take too long
    """

    name: str
    data: Callable[[int], Data]
    contenders: Mapping[str, Builder]
    words: str
    limits: Mapping[str, int] = field(default_factory=dict)

    def names(self, size: int = 1) -> list[str]:
        """The contenders that take part at a size; those whose package is missing do not."""
        return [n for n in self.contenders if _is_there(n) and size <= self.limits.get(n, size)]


def _is_there(name: str) -> bool:
    package = name.partition(",")[0]
    return package not in (NUMEXPR, NUMBA) or find_spec(package) is not None


def _random(size: int, **ranges: tuple[float, float]) -> dict[str, Any]:
    rng = np.random.default_rng(7)
    return {name: rng.uniform(*bounds, size) for name, bounds in ranges.items()}


# ------------------------------------------------------------------ contenders


def _generated(body: str, function: str, **options: Any) -> Builder:
    """The generated function, of the data by name."""

    def built(data: Data) -> Call:
        found = getattr(import_module(f"generated.{body}"), function)
        return lambda: found(**data, **options)

    return built


def _floor(name: str) -> Builder:
    """One logarithm of the magnitudes of an array."""

    def built(data: Data) -> Call:
        positive = np.abs(data[name])
        return lambda: np.log(positive)

    return built


def _compiled(loop: Callable[..., Any], *names: str) -> Builder:
    """A loop of by_hand.py, compiled by numba."""

    def built(data: Data) -> Call:
        found, given = by_hand.compiled(loop), [data[name] for name in names]
        return lambda: found(*given)

    return built


def _printed(forms: Mapping[str, Expr]) -> dict[str, Builder]:
    """lambdify of the printed forms, with and without common subexpressions, and numexpr."""
    held = sorted(map(str, set().union(*(f.free_symbols for f in forms.values()))))
    several = list(forms.values()) if len(forms) > 1 else next(iter(forms.values()))

    def lambdified(data: Data, cse: bool) -> Call:
        found = lambdify(symbols(held), several, modules="numpy", cse=cse)
        given = [data[name] for name in held]
        return lambda: found(*given)

    return {
        PLAIN: lambda data: lambdified(data, False),
        CSE: lambda data: lambdified(data, True),
        NUMEXPR: lambda data: _by_numexpr(list(forms.values()), {n: data[n] for n in held}),
    }


def _by_numexpr(forms: list[Expr], given: Data) -> Call:
    """Each form compiled by numexpr, on one thread."""
    numexpr = import_module("numexpr")
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


def positions(size: int) -> Data:
    """Within a contact of the wedge."""
    return {**_random(size, **POSITIONS), **EDGES, **WEDGE}


def loads(size: int) -> Data:
    """Of the wedge."""
    return {**_random(size, **LOADS), **WEDGE}


def _punched(size: int) -> Data:
    """Contacts two to five times as wide as the flat, off its middle by up to 0.3 b."""
    b, punch = PUNCH["b"], import_module("generated.flat_rounded")
    contacts = _random(size, half=(2 * b, 5 * b), middle=(-0.3 * b, 0.3 * b))
    a = contacts["half"] - contacts["middle"]
    c = contacts["half"] + contacts["middle"]
    return {"P": punch.load(a, c, **PUNCH), "M": punch.moment(a, c, **PUNCH), **PUNCH}


def _punch_by_hand(data: Data) -> tuple[Any, ...]:
    """Starts in the logarithms of both edges, a middling contact; loads; the law."""
    start = np.log(np.full(data["P"].size, 3 * PUNCH["b"]))
    return start, start, (data["P"], data["M"]), *PUNCH.values()


def _punch_by_numba(data: Data) -> Call:
    found, given = by_hand.compiled_newton(by_hand.punch_off), _punch_by_hand(data)
    return lambda: np.exp(found(*given))


def _punch_by_fsolve(data: Data) -> Call:
    given = _punch_by_hand(data)
    return lambda: np.exp(by_hand.by_fsolve(by_hand.punch_off, *given))


HALF = 1e-3
LAW = {"f": FRICTION, **CYLINDER}


def _cylinder(half: float) -> Any:
    """The level contact of the cylinder."""
    return import_module("generated.hertz").Contact(
        np.float64(half), np.float64(half), np.float64(0.0)
    )


def _large(size: int) -> Data:
    """Shear of 0.1 to 0.5 f P; tension of 1.2 to 3 times that which closes a slip zone."""
    hertz, here = import_module("generated.hertz"), _cylinder(HALF)
    given = _random(size, part=(0.1, 0.5), over=(1.2, 3.0))
    dQ = given["part"] * (FRICTION * hertz.load(HALF, HALF, **CYLINDER))
    dsigma = given["over"] * hertz.closing_tension(here, here, dQ, **LAW).upper
    zones = hertz.slip_zones(HALF, HALF, dQ, dsigma, order=2, **LAW)
    m, n = HALF - np.fmin(zones.left, 0.7 * HALF), HALF - np.fmin(zones.right, 0.7 * HALF)
    return {"m": m, "n": n, "dQ": dQ, "dsigma": dsigma}


def _large_generated(data: Data) -> Call:
    found, here = import_module("generated.hertz").stick_zone, _cylinder(HALF)
    dQ, dsigma = data["dQ"], data["dsigma"]
    return lambda: found(here, here, dQ, dsigma, **LAW)


def _large_by_hand(data: Data) -> tuple[Any, ...]:
    return data["m"], data["n"], (data["dQ"], data["dsigma"]), HALF, *LAW.values()


def _large_by_numba(data: Data) -> Call:
    found, given = by_hand.compiled_newton(by_hand.hertz_off), _large_by_hand(data)
    return lambda: found(*given)


def _large_by_fsolve(data: Data) -> Call:
    given = _large_by_hand(data)
    return lambda: by_hand.by_fsolve(by_hand.hertz_off, *given)


_a, _c, _dQ, _dsigma, _f = symbols("a c dQ dsigma f")


def _slipping(size: int) -> Data:
    a, c, E_star, phi = *EDGES.values(), *WEDGE.values()
    full = FRICTION * E_star * phi * np.sqrt(a * c)
    dQ = _random(size, dQ=(0.01 * full, 0.3 * full))["dQ"]
    dsigma = 12 / np.pi * dQ / (a + c)
    return {**EDGES, "dQ": dQ, "dsigma": dsigma, "f": FRICTION, **WEDGE}


def _slip_forms() -> dict[str, Expr]:
    width, normal = _a + _c, FORMS["wedge"]["K_N"]
    return {
        side: abs(_dQ / pi + sign * _dsigma * width / 8) / sqrt(width) / (_f * normal[side])
        for side, sign in (("left", 1), ("right", -1))
    }


CASES = (
    Case(
        "wedge.pressure",
        positions,
        {
            GENERATED: _generated("wedge", "pressure"),
            **_printed(FORMS["wedge"]["pressure"]),
            NUMBA: _compiled(by_hand.wedge_pressure, "x", "a", "c", "E_star", "phi"),
            OURS: _compiled(by_hand.wedge_pressure_at_edges, "x", "a", "c", "E_star", "phi"),
            FLOOR: _floor("x"),
        },
        "x varies along the array.  Lambdify and numexpr have the printed formula, numba a loop "
        "over it; and a loop over what is generated, which keeps its digits at edges and apex.",
    ),
    Case(
        "wedge.contact",
        loads,
        {
            GENERATED: _generated("wedge", "contact"),
            **_printed(FORMS["wedge"]["contact"]),
            NUMBA: _compiled(by_hand.wedge_contact, "P", "M", "E_star", "phi"),
            FLOOR: _floor("P"),
        },
        "P and M vary; a, c and the tilt come out.  The others compute eqs. (alpha), (gamma) and "
        "(ca); numexpr has no common subexpressions.",
    ),
    Case(
        "flat_rounded.contact",
        _punched,
        {
            GENERATED: _generated("flat_rounded", "contact"),
            NUMBA: _punch_by_numba,
            FSOLVE: _punch_by_fsolve,
            FLOOR: _floor("P"),
        },
        "P and M vary; two equations are solved.  numba: Newton's method in a loop, in the "
        "logarithms of both edges, derivatives by differences, started from a middling contact; "
        "fsolve: the same equations, load case by load case.  Lambdify and numexpr solve nothing.",
        {GENERATED: 1_000_000, NUMBA: 1_000_000, FSOLVE: 100},
    ),
    Case(
        "hertz.stick_zone, large tension",
        _large,
        {
            GENERATED: _large_generated,
            NUMBA: _large_by_numba,
            FSOLVE: _large_by_fsolve,
            FLOOR: _floor("dQ"),
        },
        "dQ and the tension vary; two equations of integrals are solved.  numba and fsolve: the "
        f"same, their integrals by {by_hand.NODES} Gauss points in each slip zone, started from "
        "the series; they test neither regime nor premise, which stick_zone does.",
        {GENERATED: 100_000, NUMBA: 1_000_000, FSOLVE: 100},
    ),
    Case(
        "wedge.slip_zones",
        _slipping,
        {
            GENERATED: _generated("wedge", "slip_zones"),
            f"{GENERATED}, order 3": _generated("wedge", "slip_zones", order=3),
            **_printed(_slip_forms()),
            NUMBA: _compiled(by_hand.wedge_slip, "a", "c", "dQ", "dsigma", "f", "E_star", "phi"),
            FLOOR: _floor("dQ"),
        },
        "dQ and the tension vary; order 1, which the paper prints.  The others compute the two "
        "quotients and no more; slip_zones also tells sliding and slip zones that meet.",
        {f"{GENERATED}, order 3": 100_000},
    ),
)
