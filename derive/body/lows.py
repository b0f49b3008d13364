"""Search, in double precision, for places where a curvature may be negative or undefined.

In:  a piece of a profile; numbers for its parameters, and the ends of an interval.
Out: places where the curvature seems to be negative, or the profile or the curvature undefined, few
     enough to be checked with many digits, because double precision alone does not decide.

The curvature is evaluated at thousands of points.  They lie at distances of all magnitudes from the
origin, from the ends and from marks, since narrow features are found there: places where the
arguments of functions are zero or one, or where a polynomial is zero or turns.  The search is
refined around the lowest of them.
"""

from collections.abc import Iterator, Sequence
from itertools import islice

import numpy as np
from numpy.typing import NDArray
from sympy import (
    Expr,
    Function,
    Poly,
    Pow,
    Symbol,
    Tuple,
    exp,
    fraction,
    lambdify,
    powsimp,
    together,
)

from derive.body.piece import Piece
from derive.symbols import x

Array = NDArray[np.float64]

_PER_DECADE = 200
"""Distances per decade from the origin and the ends; from other marks a quarter as many."""
_BEYOND = 1000
"""Factor by which the search extends beyond the largest length and below the smallest."""
_DECADES = 16
"""Largest number of decades that the distances span."""
_EVENLY = 4000
"""Number of evenly spaced points across the marks."""
_MARKS = 40
"""Largest number of marks."""
_VALLEYS, _STEPS, _ROUNDS = 64, 17, 4
"""Number of valleys searched further, of points in each, and of refinements."""
_NEGATIVE, _WITHOUT = 24, 4
"""Number of runs of points that are used: of negative values, and of undefined ones."""


class Lows:
    """The search for one piece, compiled once for all parameters."""

    def __init__(self, piece: Piece, symbols: Sequence[Symbol]) -> None:
        both = [_joined(expr) for expr in (piece.curvature, piece.profile)]
        self._polynomials = lambdify(symbols, [*_marking(both[0])], modules="numpy", dummify=True)
        self._at = lambdify([x, *symbols], both, cse=True, modules="numpy", dummify=True)

    def places(self, given: Sequence[float], lower: float, upper: float) -> list[float]:
        """Points between two ends where the curvature may be negative, the likeliest first."""
        numbers = [np.float64(value) for value in given]
        with np.errstate(all="ignore"):
            places = self._grid(numbers, lower, upper)
            if not places.size:
                return []
            values = self._values(places, numbers)
            found = self._further(places, values, numbers)
            places, first = np.unique(np.concatenate((places, found)), return_index=True)
            values = np.concatenate((values, self._values(found, numbers)))[first]
        return [*_suspects(places, values)]

    def _values(self, places: Array, numbers: list[np.float64]) -> Array:
        """The curvature; NaN where it or the profile is undefined."""
        try:
            curvature, profile = self._at(places, *numbers)
        except (OverflowError, ZeroDivisionError, TypeError):  # whole numbers beyond 1e308
            return np.full(places.shape, np.nan)
        curvature = np.where(np.isnan(profile), np.nan, np.real(curvature))
        return np.broadcast_to(curvature, places.shape)

    def _grid(self, numbers: list[np.float64], lower: float, upper: float) -> Array:
        roots = self._roots(numbers)
        ends = np.array([0.0, *(end for end in (lower, upper) if np.isfinite(end))])
        lengths = np.abs(np.concatenate((roots.real, roots.imag, ends, np.array(numbers))))
        lengths = lengths[(lengths > 0) & np.isfinite(lengths)]
        most = float(np.max(lengths, initial=1.0)) * _BEYOND
        least = max(float(np.min(lengths, initial=1.0)) / _BEYOND, most / 10.0**_DECADES)
        marks = np.unique(roots.real)[:_MARKS]
        spread = (float(f(np.concatenate((marks, ends)))) for f in (np.min, np.max))
        low, high = np.clip(np.array([*spread]) + most / _BEYOND * np.array([-1, 1]), lower, upper)
        found = [np.linspace(low, high, _EVENLY)]
        for middles, count in ((ends, _PER_DECADE), (marks, _PER_DECADE // 4)):
            steps = int(np.log10(most / least) * count) + 1
            distances = np.geomspace(least, most, steps)
            found += [(middles[:, None] + sense * distances).ravel() for sense in (-1, 0, 1)]
        places = np.unique(np.concatenate(found))
        return places[(places > lower) & (places < upper)]

    def _roots(self, numbers: list[np.float64]) -> NDArray[np.complex128]:
        """Points where arguments are zero or one, including complex points."""
        polynomials = [np.array(each, dtype=float) for each in self._polynomials(*numbers)]
        found = [np.roots(each) for each in polynomials if np.all(np.isfinite(each))]
        return np.concatenate([np.zeros(0, dtype=complex), *found])

    def _further(self, places: Array, values: Array, numbers: list[np.float64]) -> Array:
        """Points within the deepest valleys of the grid, refined around the lowest."""
        inner = values[1:-1]
        beside = np.fmax(values[:-2], values[2:])
        valleys = np.flatnonzero((inner <= values[:-2]) & (inner <= values[2:]) & (inner < beside))
        deepest = valleys[np.argsort(inner[valleys] / beside[valleys])[:_VALLEYS]]
        low, high = places[deepest], places[deepest + 2]
        found = [np.zeros(0)]
        for _ in range(_ROUNDS if deepest.size else 0):
            tried = np.linspace(low, high, _STEPS, axis=1)
            found.append(tried.ravel())
            heights = self._values(found[-1], numbers).reshape(tried.shape)
            least = np.argmin(np.where(np.isnan(heights), np.inf, heights), axis=1)
            rows = np.arange(deepest.size)
            low = tried[rows, np.maximum(least - 1, 0)]
            high = tried[rows, np.minimum(least + 1, _STEPS - 1)]
        return np.concatenate(found)


def _joined(expr: Expr) -> Expr:
    """The expression without products such as exp(1e5) * exp(-1e5), which overflow."""
    return powsimp(expr, combine="exp") if expr.has(exp) else expr


def _marking(expr: Expr) -> Iterator[Tuple]:
    """Coefficients of polynomials at whose roots the expression may turn or change its nature."""
    if expr.is_polynomial(x):
        whole = Poly(expr, x)
        yield from (Tuple(*each.all_coeffs()) for each in (whole, whole.diff(x)))
        return
    arguments = {arg for f in expr.atoms(Function) for arg in f.args}
    arguments |= {p.exp for p in expr.atoms(Pow)}
    bases = {p.base for p in expr.atoms(Pow)}
    wanted = [arg + shift for arg in sorted(arguments, key=str) for shift in (0, -1, 1)]
    for each in dict.fromkeys([*wanted, *sorted(bases, key=str)]):
        numerator = fraction(together(each))[0] if each.is_rational_function(x) else each
        if numerator.has(x) and numerator.is_polynomial(x):
            yield Tuple(*Poly(numerator, x).all_coeffs())


def _runs(flags: NDArray[np.bool_]) -> NDArray[np.int_]:
    """Start and (exclusive) end of each run of true values, the longest run first."""
    ends = np.flatnonzero(np.diff(np.concatenate(([0], flags.astype(int), [0])))).reshape(-1, 2)
    return ends[np.argsort(ends[:, 0] - ends[:, 1], kind="stable")]


def _suspects(places: Array, values: Array) -> Iterator[float]:
    """The lowest point of each long run of negative values, and the middle of undefined ones."""
    for first, last in islice(_runs(values < 0), _NEGATIVE):
        yield float(places[first + np.argmin(values[first:last])])
    for first, last in islice(_runs(np.isnan(values)), _WITHOUT):
        yield float(places[(first + last) // 2])
