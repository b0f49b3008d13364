"""Evaluate an expression at a point to the working precision, with integrals by quadrature."""

from collections.abc import Callable, Mapping
from enum import Enum
from functools import cache
from itertools import pairwise
from typing import Any

import mpmath
from mpmath import mpc, mpf
from sympy import (
    Dummy,
    Expr,
    Function,
    Integral,
    Pow,
    Symbol,
    lambdify,
    nan,
    oo,
    zoo,
)
from sympy.printing.codeprinter import PrintMethodNotImplementedError

from derive.check.kinks import Place, is_unbounded, places
from derive.check.quadrature import (
    GUARD,
    Along,
    NotComputed,
    Value,
    cuts,
    demand_no_pole,
    demand_second,
    integral,
)

_INSIDE = 3
"""The ends of an integral are evaluated with this many times the digits of the integral."""
_LARGEST = 4096
"""The largest binary exponent of a function's argument; exp(exp(exp(9))) exceeds it."""
_FARTHEST = 2**20
"""The largest magnitude of the binary exponent of a value."""
_LOOKED_AT = 257
"""Number of points at which the sign of a switch is sampled if its zeros are not known."""


class Undecided(Exception):
    """No reliable value was obtained, for example because too many digits were lost."""


class Undefined(Undecided):
    """There is no value at this point, for example after a division by zero."""


class Care(Enum):
    """How carefully an integral is computed.

    QUICK    once
    TWICE    once, and confirmed by a second rule
    ANEW     as TWICE, with additional cuts
    """

    QUICK = 0
    TWICE = 1
    ANEW = 2


def evaluated(expr: Expr, numbers: Mapping[Symbol, mpf], care: Care = Care.TWICE) -> Value:
    """Evaluate `expr` at the working precision; raises Undecided."""
    function, held, integrals = _compiled(expr)
    given = [numbers[symbol] for symbol in held]
    try:
        integral_values = [_quadrature(each, numbers, care) for each in integrals]
        # the unary plus turns constants such as pi into numbers
        value = +mpmath.mpmathify(function(*given, *integral_values))
    except NotComputed as error:
        raise Undecided(str(error)) from error
    except (ArithmeticError, ValueError) as error:
        raise Undefined(f"there is no value ({type(error).__name__}: {error})") from error
    except (MemoryError, TypeError) as error:
        raise Undecided(f"there is no value ({type(error).__name__}: {error})") from error
    if mpmath.isfinite(value) and value != 0 and abs(mpmath.mag(value)) > _FARTHEST:
        raise Undecided("a number is too large or too small for the computation")
    return value


@cache
def _compiled(expr: Expr) -> tuple[Callable[..., Value], list[Symbol], list[Integral]]:
    if expr.has(zoo, nan, oo):
        raise Undecided(f"{expr} is infinite or undefined")
    outer = [i for i in expr.atoms(Integral) if not _is_inner(i, expr)]
    integrals = sorted(outer, key=str)
    stand_ins = {each: Dummy("I") for each in integrals}
    plain = expr.xreplace(stand_ins)
    held = sorted(plain.free_symbols - set(stand_ins.values()), key=str)
    plain = plain.replace(
        lambda n: isinstance(n, Pow) and not n.exp.is_Rational and n.base.free_symbols,
        lambda n: _power(n.base, n.exp),
    )
    try:
        function = lambdify([*held, *stand_ins.values()], plain, modules=[_BOUNDED, "mpmath"])
    except PrintMethodNotImplementedError as error:
        raise Undecided(f"{expr} cannot be computed numerically") from error
    return function, held, integrals


def _is_inner(over: Integral, expr: Expr) -> bool:
    return any(over in other.function.atoms(Integral) for other in expr.atoms(Integral))


_power = Function("_power")


def _bounded(function: Callable[[Value], Value]) -> Callable[[Value], Value]:
    """Wrap a function so that it raises NotComputed if its argument is too large."""

    def of(value: Value) -> Value:
        value = mpmath.mpmathify(value)
        if mpmath.isfinite(value) and value != 0 and mpmath.mag(value) > _LARGEST:
            raise NotComputed("a number is too large for the computation")
        return function(value)

    return of


def _bounded_power(base: Value, exponent: Value) -> Value:
    base, exponent = mpmath.mpmathify(base), mpmath.mpmathify(exponent)
    if base == 0 or base == 1 or exponent == 0:
        return base**exponent
    if mpmath.mag(exponent) + mpmath.mag(mpmath.mag(base) or 1) > _LARGEST:
        raise NotComputed("a power is too large for the computation")
    return base**exponent


_BOUNDED: dict[str, Any] = {
    name: _bounded(getattr(mpmath, name)) for name in ("exp", "sin", "cos", "tan")
} | {name: _bounded(getattr(mpmath, name)) for name in ("sinh", "cosh", "tanh")}
_BOUNDED["_power"] = _bounded_power


# ------------------------------------------------------------------ integrals

_KNOWN: dict[tuple[Integral, tuple[mpf, ...], int, Care], Value | NotComputed] = {}


def _quadrature(over: Integral, numbers: Mapping[Symbol, mpf], care: Care) -> Value:
    """Compute an integral, with constant factors taken out, and cache it by its parameters."""
    factor, core = _separated(over)
    held = sorted(core.free_symbols, key=str)
    key = (core, tuple(numbers[symbol] for symbol in held), mpmath.mp.dps, care)
    if key not in _KNOWN:
        try:
            _KNOWN[key] = _computed(core, numbers, care)
        except NotComputed as error:
            _KNOWN[key] = error
    known = _KNOWN[key]
    if isinstance(known, NotComputed):
        raise NotComputed(str(known))
    return evaluated(factor, numbers) * known


@cache
def _separated(over: Integral) -> tuple[Expr, Integral]:
    variable = over.limits[-1][0]
    factor, core = integrand(over).as_independent(variable, as_Add=False)
    return factor, Integral(core, over.limits[-1])


def integrand(over: Integral) -> Expr:
    """Return the integrand of the outermost integral.

    SymPy writes nested integrals as one integral with several limits.
    """
    return Integral(over.function, *over.limits[:-1]) if len(over.limits) > 1 else over.function


def _computed(core: Integral, numbers: Mapping[Symbol, mpf], care: Care) -> Value:
    variable, low, high = core.limits[-1]
    inside = integrand(core)
    with mpmath.workdps(_INSIDE * mpmath.mp.dps):  # so that roots vanish at the ends
        start, end = evaluated(low, numbers), evaluated(high, numbers)
        if isinstance(start, mpc) or isinstance(end, mpc):
            raise NotComputed("an end of an integral is not a real number")
        if start == end:
            return mpf(0)
        sense, (start, end) = (1, (start, end)) if start < end else (-1, (end, start))
        zeros = _zeros(inside, variable, numbers, start, end)
        parts = cuts(start, end, zeros, care == Care.ANEW)
    along = _integrand(inside, variable, numbers)
    steep = is_unbounded(inside, variable)
    if steep:
        with mpmath.workdps(mpmath.mp.dps + GUARD + _INSIDE):
            demand_no_pole(along, parts, str(variable))
    value = integral(along, parts, steep)
    if care != Care.QUICK:
        demand_second(value, along, _at_once(inside, variable, numbers), parts)
    return sense * value


def _integrand(expr: Expr, variable: Symbol, numbers: Mapping[Symbol, mpf]) -> Along:
    function, held, inner = _compiled(expr)
    if inner:
        return lambda position: evaluated(expr, {**numbers, variable: position})
    given = [None if symbol == variable else numbers[symbol] for symbol in held]
    index = held.index(variable) if variable in held else None

    def at(position: mpf) -> Value:
        if index is not None:
            given[index] = position
        return +mpmath.mpmathify(function(*given))

    return at


def _at_once(
    expr: Expr, variable: Symbol, numbers: Mapping[Symbol, mpf]
) -> Callable[[Any], Any] | None:
    """Return the integrand as a function of an array of points, in double precision."""
    import numpy as np

    function, held = _for_arrays(expr)
    if function is None:
        return None
    given = [None if symbol == variable else numbers[symbol] for symbol in held]
    if any(isinstance(value, mpmath.mpc) for value in given):
        return None
    plain = [value if value is None else float(value) for value in given]

    def at(places_: Any) -> Any:
        try:
            values = function(*(places_ if value is None else value for value in plain))
        except NameError:  # a function that NumPy does not provide
            values = np.nan
        return np.broadcast_to(np.asarray(values), places_.shape)

    return at


@cache
def _for_arrays(expr: Expr) -> tuple[Callable[..., Any] | None, list[Symbol]]:
    held = sorted(expr.free_symbols, key=str)
    if expr.has(Integral):
        return None, held
    try:
        return lambdify(held, expr, modules="numpy", cse=True), held
    except PrintMethodNotImplementedError:
        return None, held


# ------------------------------------------------------------------ points where to cut


def _zeros(
    inside: Expr, variable: Symbol, numbers: Mapping[Symbol, mpf], start: mpf, end: mpf
) -> list[tuple[mpf, str]]:
    """Return the points between the ends where the integrand may not be smooth."""
    zeros = []
    for place in places(inside, variable):
        if place.coefficients:
            for coefficients in place.coefficients:
                values = [evaluated(each, numbers) for each in coefficients]
                zeros += [(root, place.kind) for root in _roots(values)]
        else:
            zeros += [(z, place.kind) for z in _looked_for(place, variable, numbers, start, end)]
    return zeros


def _roots(coefficients: list[Value]) -> list[mpf]:
    """Return the real roots of a polynomial, including both roots of a nearly real pair."""
    while coefficients and coefficients[0] == 0:
        coefficients = coefficients[1:]
    if any(isinstance(value, mpmath.mpc) for value in coefficients) or len(coefficients) < 2:
        return []
    if len(coefficients) == 2:
        return [-coefficients[1] / coefficients[0]]
    if len(coefficients) == 3:
        return _of_square(*coefficients)
    try:
        roots = mpmath.polyroots(coefficients, maxsteps=200, extraprec=2 * mpmath.mp.prec)
    except mpmath.libmp.NoConvergence:
        raise NotComputed("the points where an integrand is not smooth are not known") from None
    largest = max(abs(root) for root in roots)
    near = mpf(10) ** (-mpmath.mp.dps // 4) * largest
    return [mpmath.re(root) for root in roots if abs(mpmath.im(root)) <= near]


def _of_square(first: mpf, second: mpf, third: mpf) -> list[mpf]:
    under = second**2 - 4 * first * third
    if under < -(second**2) * mpf(10) ** (-mpmath.mp.dps // 2):
        return []
    root = mpmath.sqrt(max(under, mpf(0)))
    larger = -(second + root if second >= 0 else second - root) / 2
    return [larger / first, third / larger] if larger != 0 else [mpf(0)]


def _looked_for(
    place: Place, variable: Symbol, numbers: Mapping[Symbol, mpf], start: mpf, end: mpf
) -> list[mpf]:
    """Find the points where a switch changes its sign by sampling it."""
    along = _integrand(place.of, variable, numbers)
    at_once = _at_once(place.of, variable, numbers)

    def real(at: mpf) -> mpf | None:
        try:
            value = along(at)
        except (ArithmeticError, ValueError):
            return None
        return value if isinstance(value, mpf) and mpmath.isfinite(value) else None

    step = (end - start) / (_LOOKED_AT - 1)
    grid = [start + step * n for n in range(_LOOKED_AT)]
    signs = _signs(at_once, grid) or _slowly(real, grid)
    zeros = []
    for n, (one, other) in enumerate(pairwise(signs)):
        if one == 0:
            zeros.append(grid[n])
        elif one is not None and other is not None and one * other < 0:
            zeros.append(_bisected(real, grid[n], grid[n + 1]))
    return zeros


def _signs(at_once: Callable[[Any], Any] | None, grid: list[mpf]) -> list[float | None] | None:
    """Evaluate a switch at many points in double precision; None if its values are not real."""
    import numpy as np

    if at_once is None:
        return None
    with np.errstate(all="ignore"):
        values = at_once(np.array([float(at) for at in grid]))
    if np.iscomplexobj(values) or not np.any(np.isfinite(values)):
        return None
    return [float(value) if np.isfinite(value) else None for value in values]


def _slowly(real: Callable[[mpf], mpf | None], grid: list[mpf]) -> list[mpf | None]:
    with mpmath.workdps(15):
        return [real(at) for at in grid]


def _bisected(real: Callable[[mpf], mpf | None], low: mpf, high: mpf) -> mpf:
    try:
        return mpmath.findroot(real, (low, high), solver="anderson", verify=False)
    except (ArithmeticError, ValueError, TypeError):
        raise NotComputed("the points where an integrand is not smooth are not known") from None
