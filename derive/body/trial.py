"""Test with numbers whether a body is convex for all parameters that meet its conditions.

In:  the pieces of g(x), the interval in which they are real, and conditions on the parameters.
Out: None, or the error for a body that is not convex; typical parameters.

Parameters are drawn at random: sets of similar size, and, for pieces whose sign was not found
symbolically, sets whose ratios span twelve decades.  For each set, double precision finds the
places at which a curvature may be negative or undefined (lows.py), and many digits decide.
"""

import random
from collections.abc import Callable, Iterator
from itertools import islice, pairwise, product

import mpmath
from mpmath import mpf
from sympy import Expr, Integer, Pow, Rational, Symbol, lambdify
from sympy.logic.boolalg import Boolean

from derive.body.lows import Lows
from derive.body.piece import Piece, step
from derive.command.errors import BadProfile
from derive.symbols import x

_SIMILAR = 8
"""Number of parameter sets of similar size for which a body is tested."""
_WIDE = 48
"""Number of widely differing parameter sets used if no proof is found."""
_LEAST, _GREATEST = Rational(1, 1000), Integer(1000)
"""Smallest and largest value of those parameters."""
_DIGITS = 30
"""Digits to which a curvature is computed; three times as many where it seems to be negative."""
_ENOUGH = 10
"""If this many of 40 sets around typical parameters meet the conditions, no more are needed."""

REAL_AND_FINITE = (
    "g(x) must be real and finite on both sides of x = 0, and wherever else contact can occur; "
    "write it without this singularity, for example with Abs(x) instead of x, or shift it along x, "
    "for example with x + b instead of x, so that the singularity lies outside the contact"
)
"""Remedy for a profile that is not real and finite."""

Values = dict[Symbol, Rational]


# ------------------------------------------------------------------ parameters


def typical(demands: tuple[Boolean, ...]) -> Values:
    """Typical parameters that meet the conditions; empty if all parameters can equal one.

    The search covers powers of two farther and farther from one.
    """
    least = {d.gts: d.lts for d in demands if d.lts.is_number and d.gts.is_Symbol}
    symbols = sorted(set().union(*(d.free_symbols for d in demands)) - {*least}, key=str)
    rng = random.Random(3)

    def drawn(around: Values, spread: int) -> Values:
        return {p: v * Rational(2) ** rng.randint(-spread, spread) for p, v in around.items()}

    def met(values: Values) -> bool:
        given = {p: 1 + value for p, value in least.items()} | values
        return _meets(given, demands)

    def near(values: Values) -> int:
        """How many of 40 similar sets meet the conditions, up to a limit."""
        return min(sum(met(drawn(values, 1)) for _ in range(40)), _ENOUGH)

    ones = dict.fromkeys(symbols, Integer(1))
    if not symbols or near(ones) == _ENOUGH:
        return {}
    found = (drawn(ones, spread) for spread in (2, 4, 8, 12) for _ in range(50))
    return max(filter(met, found), key=near, default={})


def _meets(values: Values, demands: tuple[Boolean, ...]) -> bool:
    return all(bool(demand.subs(values)) for demand in demands)


def _similar(symbols: list[Symbol]) -> Iterator[Values]:
    rng = random.Random(1)
    while True:
        yield {p: Rational(rng.randint(10, 99), 10) ** rng.choice((1, -1)) for p in symbols}


def _far_apart(symbols: list[Symbol], exponents: set[Symbol]) -> Iterator[Values]:
    """Random corners of the parameter space, then points between; exponents stay moderate."""
    rng, ends = random.Random(2), (_LEAST, Integer(1), _GREATEST)
    corners = [*islice(product(*(ends if p not in exponents else [2] for p in symbols)), 3**6)]
    rng.shuffle(corners)
    for corner in corners[: _WIDE // 2]:
        yield dict(zip(symbols, map(Rational, corner), strict=True))
    while True:
        yield {
            p: Rational(rng.randint(10, 99), 10)
            * (1 if p in exponents else Integer(10) ** rng.randint(-3, 2))
            for p in symbols
        }


# ------------------------------------------------------------------ refusals


class _Fault(Exception):
    """A point where a body is not convex, or not real, for certain parameters."""

    def __init__(self, how: str, values: Values, real: bool = True) -> None:
        super().__init__(how)
        self.how, self.real = how, real
        self.given = ", ".join(f"{symbol} = {value}" for symbol, value in values.items())

    def always(self, name: str) -> BadProfile:
        """The error for a body that was not found to be convex for any parameters."""
        if not self.real:
            return BadProfile(name, self.how, REAL_AND_FINITE)
        remedy = "make g(x) convex, since the contact could otherwise split into several patches"
        return BadProfile(name, f"is not convex, because {self.how} for {self.given}", remedy)

    def sometimes(self, name: str) -> BadProfile:
        """The error for a body that was found to be convex for other parameters."""
        how = self.how if self.real else f"it {self.how}"
        why = f"is convex only for some values of its parameters, because {how} for {self.given}"
        remedy = (
            "no checkable condition on the parameters was found; make g(x) convex for all "
            "parameters, for example by replacing some with numbers or multiples of one length"
        )
        return BadProfile(name, why, remedy)


# ------------------------------------------------------------------ the test


class Trial:
    """The test of a body with many sets of parameters.

    doubtful: pieces that are also tested with widely differing parameters.
    """

    def __init__(
        self, name: str, pieces: list[Piece], domain: tuple[Expr, Expr], doubtful: list[Piece]
    ) -> None:
        self.name, self.pieces, self.doubtful = name, pieces, doubtful
        held = set().union(*(piece.profile.free_symbols for piece in pieces)) - {x}
        self.symbols = sorted(held, key=str)
        self._curves = {piece: _Curve(piece, domain, self.symbols) for piece in pieces}

    def failure(self, demands: tuple[Boolean, ...]) -> BadProfile | None:
        """The error for a body that is not convex for all parameters that meet the conditions."""
        fault, passed = None, False
        for values, pieces in self._sets(demands):
            try:
                if pieces is self.pieces:
                    _demand_steps(pieces, values)
                for piece in pieces:
                    self._curves[piece].demand(values)
                passed = True
            except _Fault as found:
                fault = fault or found
            if fault and passed:
                return fault.sometimes(self.name)
        if fault:
            return fault.always(self.name)
        if passed:
            return None
        needed = " and ".join(map(str, demands))
        return BadProfile(
            self.name,
            f"is convex only if {needed}, and no parameters were found that meet this condition",
            "make it convex for all parameter values, or for all values above a given number",
        )

    def _sets(self, demands: tuple[Boolean, ...]) -> Iterator[tuple[Values, list[Piece]]]:
        """Parameters that meet the conditions, and the pieces to be tested with them."""

        def meeting(sets: Iterator[Values], count: int) -> Iterator[Values]:
            return islice((v for v in islice(sets, 40 * count) if _meets(v, demands)), count)

        powers = {p for piece in self.pieces for p in piece.profile.atoms(Pow)}
        exponents = set().union(*(power.exp.free_symbols for power in powers))
        similar = [*meeting(_similar(self.symbols), _SIMILAR)]
        far = meeting(_far_apart(self.symbols, exponents), _WIDE)
        yield from ((values, self.pieces) for values in similar or islice(far, _SIMILAR))
        if self.doubtful and len(self.symbols) > 1:  # a single parameter is only a scale
            yield from ((values, self.doubtful) for values in far)


def _demand_steps(pieces: list[Piece], values: Values) -> None:
    given = [
        Piece(*(expr.subs(values) for expr in (piece.lower, piece.upper, piece.profile)))
        for piece in pieces
    ]
    for left, right in pairwise(given):
        rise = right.slope - left.slope
        rise = rise.subs(x, right.lower) if rise.is_polynomial(x) else step(left, right)
        if not rise.is_extended_real or rise < 0:
            raise _Fault(f"its slope decreases at x = {right.lower}", values)


class _Curve:
    """The curvature of a piece and its profile, compiled once for all parameters."""

    def __init__(self, piece: Piece, domain: tuple[Expr, Expr], symbols: list[Symbol]) -> None:
        self._curvature, self._profile = (
            lambdify([x, *symbols], expr, modules="mpmath", dummify=True)
            for expr in (piece.curvature, piece.profile)
        )
        self._ends = lambdify(
            symbols, [piece.lower, piece.upper, *domain], modules="mpmath", dummify=True
        )
        self._lows = Lows(piece, symbols)

    def demand(self, values: Values) -> None:
        """Refuse a curvature that is negative, or not real, at any place that was found.

        The profile must be real too: log(x) is not real for x < 0, but its curvature is.
        """
        with mpmath.workdps(_DIGITS):
            given = [mpf(value.p) / value.q for value in values.values()]
            lower, upper, first, last = map(mpf, self._ends(*given))
            lower, upper = max(lower, first), min(upper, last)
            found = self._lows.places([*map(float, given)], float(lower), float(upper))
            for place in (p for p in map(mpf, found) if lower < p < upper):
                value = _value(self._curvature, place, given)
                if any(map(mpmath.im, (value, _value(self._profile, place, given)))):
                    raise _Fault(f"is not real near x = {float(place):.3g}", values, real=False)
                if mpmath.re(value) < 0 and self._is_sure(place, value, given):
                    how = f"its curvature is negative near x = {float(place):.3g}"
                    raise _Fault(how, values)

    def _is_sure(self, place: mpf, value: mpf, given: list[mpf]) -> bool:
        """Whether the sign of a value is certain and not the result of cancellation."""
        with mpmath.workdps(3 * _DIGITS):
            again = _value(self._curvature, place, given)
            return bool(abs(again - value) < abs(again) / 1000)


def _value(function: Callable[..., mpf], place: mpf, given: list[mpf]) -> mpf:
    """The curvature or the profile; zero where it is undefined."""
    try:
        return function(place, *given)
    except (ZeroDivisionError, OverflowError):
        return mpf(0)
