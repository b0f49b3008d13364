"""One integral in numbers, computed twice by rules that share no node; or no number at all.

The interval is cut where the integrand may not be smooth.  Each part is computed to the working
precision by a rule that tells its error, and the whole once more in double precision, by Gauss's
rule on many panels: a feature that the few nodes of the first rule pass by shows in the second.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache
from itertools import pairwise
from typing import Any, TypeAlias

import mpmath
import numpy as np
from mpmath import mpc, mpf

from derive.proof.rule import gauss_legendre

Value: TypeAlias = mpf | mpc
Along: TypeAlias = Callable[[mpf], Value]

GUARD = 10
"""Digits that an integrand has beyond its integral, where nothing cancels."""
_SPARE = 5
"""Digits of the working precision that an integral may lack."""
_TRUSTED = 0.6
"""The part of the working digits that a rule must claim for the last word it has."""
_SECOND = 1e-6
"""What both rules may differ by, as a part of the integral of the modulus."""
_NEAR = (mpf(10) ** -9, mpf(10) ** -13)
"""Distances from a place, as parts of an interval, at which the growth towards it is measured."""
_STEEPEST = 0.97
"""The power of one over the distance from which on an integral is taken to diverge."""


class NotComputed(Exception):
    """No number that can be trusted comes out of a quadrature."""


@dataclass(frozen=True)
class Cut:
    """A place inside or at an end of the interval, and what happens there.

    kinds: those of derive.paper.kinks; several may coincide.
    """

    place: mpf
    kinds: frozenset[str]


def cuts(start: mpf, end: mpf, found: Sequence[tuple[mpf, str]], more: bool) -> list[Cut]:
    """Both ends and all places between, in their order; a further place in each part if asked.

    Places that agree to two thirds of the working digits are one.
    """
    apart = (end - start) * mpf(10) ** (-2 * mpmath.mp.dps // 3)
    made = [Cut(start, frozenset()), Cut(end, frozenset())]
    for place, kind in sorted(found):
        if not start - apart <= place <= end + apart:
            continue
        for n, cut in enumerate(made):
            if abs(cut.place - place) <= apart:
                made[n] = Cut(cut.place, cut.kinds | {kind})
                break
        else:
            made.append(Cut(place, frozenset({kind})))
    made.sort(key=lambda cut: cut.place)
    if more:
        share = mpf(4427) / 10000
        made += [
            Cut(one.place + share * (other.place - one.place), frozenset({"peak"}))
            for one, other in pairwise(made)
        ]
        made.sort(key=lambda cut: cut.place)
    return made


def demand_no_pole(along: Along, parts: Sequence[Cut], variable: str) -> None:
    """Nothing, or NotComputed where the integrand grows like one over the distance, or faster."""
    for one, other in pairwise(parts):
        length = other.place - one.place
        for cut, sense in ((one, 1), (other, -1)):
            if cut.kinds <= {"kink", "peak"}:
                continue
            sizes = []
            for share in _NEAR:
                try:
                    sizes.append(abs(along(cut.place + sense * share * length)))
                except (ArithmeticError, ValueError):
                    sizes.append(mpmath.inf)
            near, nearer = sizes
            if near == 0 or nearer == 0:
                continue
            grown = mpmath.log10(nearer / near) / mpmath.log10(_NEAR[0] / _NEAR[1])
            if not mpmath.isfinite(grown) or grown > _STEEPEST:
                where = mpmath.nstr(cut.place, 6)
                raise NotComputed(
                    f"the integral diverges: its integrand has a pole at {variable} = {where} "
                    "(no principal value is taken)"
                )


def integral(along: Along, parts: Sequence[Cut], steep: bool) -> Value:
    """The integral to the working precision; raises NotComputed."""
    found = [_part(along, *ends, steep) for ends in pairwise(parts)]
    size = sum(abs(value) for value, _, _ in found) + sum(size for _, _, size in found)
    error = sum(error for _, error, _ in found)
    if error > size * mpf(10) ** (-_TRUSTED * mpmath.mp.dps):
        raise NotComputed("a quadrature does not converge")
    return sum(value for value, _, _ in found)


def _part(along: Along, one: Cut, other: Cut, steep: bool) -> tuple[Value, mpf, mpf]:
    """Value, error and size from end to end, with s = start + (end - start) sin(t)**2.

    Where roots vanish or are infinite at both ends, the integrand is then even and periodic, and
    plain midpoints converge geometrically; else Gauss's nodes, or those that crowd at the ends.
    """
    start, end = one.place, other.place
    size = _size(along, start, end)
    kinds = one.kinds | other.kinds
    if one.kinds == other.kinds == {"root"}:
        value = _midpoints(along, start, end)
        if value is not None:
            return value, mpf(0), size
    if not kinds & {"log", "pole"}:
        value, error = _gauss(along, start, end)
        if error <= (abs(value) + size) * mpf(10) ** (_SPARE - mpmath.mp.dps):
            return value, error, size
    value, error = _crowded(along, start, end, size, steep)
    return value, error, size


def _size(along: Along, start: mpf, end: mpf) -> mpf:
    """About the integral of the modulus."""
    shares = (mpf("0.137"), mpf("0.391"), mpf("0.618"), mpf("0.853"))
    return (end - start) * sum(_modulus(along, start + (end - start) * s) for s in shares) / 4


def _modulus(along: Along, place: mpf) -> mpf:
    try:
        value = abs(along(place))
    except (ZeroDivisionError, ValueError):
        return mpf(0)
    return value if mpmath.isfinite(value) else mpf(0)


def _midpoints(along: Along, start: mpf, end: mpf) -> Value | None:
    digits, previous = mpmath.mp.dps, None
    for count in (16, 32, 64, 128, 256):
        with mpmath.workdps(digits + GUARD):
            value = sum(
                along(start + (end - start) * square) * weight
                for square, weight in _nodes(count, digits)
            ) * (end - start)
        if previous is not None and _agree(previous, value, 0.55 * digits):
            return value
        previous = value
    return None


def _agree(first: Value, second: Value, digits: float) -> bool:
    gap = abs(first - second)
    return bool(gap <= max(abs(first), abs(second)) * mpf(10) ** -digits)


@cache
def _nodes(count: int, digits: int) -> list[tuple[mpf, mpf]]:
    """sin(t)**2 and 2 sin(t) cos(t) dt at midpoints of [0, pi/2]."""
    with mpmath.workdps(digits + GUARD):
        step = mpmath.pi / (2 * count)
        angles = [(k + mpf(1) / 2) * step for k in range(count)]
        return [(mpmath.sin(t) ** 2, mpmath.sin(2 * t) * step) for t in angles]


def _gauss(along: Along, start: mpf, end: mpf) -> tuple[Value, mpf]:
    found: tuple[Value, mpf] = mpmath.quad(
        _by_angle(along, start, end, mpmath.mp.dps + GUARD),
        [mpf(0), mpmath.pi / 2],
        method=gauss_legendre,
        error=True,
    )
    return found


def _crowded(along: Along, start: mpf, end: mpf, size: mpf, steep: bool) -> tuple[Value, mpf]:
    """Nodes that crowd at both ends; twice the digits where the integrand is infinite there."""
    digits = mpmath.mp.dps * (2 if steep else 1) + GUARD
    unit = size or mpf(1)
    around = _by_angle(lambda place: along(place) / unit, start, end, digits)
    value, error = mpmath.quad(around, [mpf(0), mpmath.pi / 2], method="tanh-sinh", error=True)
    return value * unit, error * unit


def _by_angle(along: Along, start: mpf, end: mpf, digits: int) -> Along:
    def around(t: mpf) -> Value:
        with mpmath.workdps(digits):
            sine, cosine = mpmath.sin(t), mpmath.cos(t)
            try:
                value = along(start + (end - start) * sine**2)
            except (ZeroDivisionError, ValueError):
                value = mpmath.inf
            if not mpmath.isfinite(value):
                return mpf(0)  # the very end, where the node has no weight
            return 2 * (end - start) * sine * cosine * value

    return around


# ------------------------------------------------------------------ the second value

Array: TypeAlias = Any
"""Of floats or of complex numbers."""

_PANELS, _ORDER = 256, 8
_FEW_PANELS = 24
_DIGITS = 30
"""Working digits of those few."""


def demand_second(
    value: Value, along: Along, at_once: Callable[[Array], Array] | None, parts: Sequence[Cut]
) -> None:
    """Nothing, or NotComputed where the integral by other nodes is another number.

    at_once: the integrand in double precision, of an array; none if there is no such function.
    Where double precision does not do, fewer nodes are taken at more digits.
    """
    if at_once is not None and _is_confirmed(value, _in_double(at_once, parts)):
        return
    second = _in_digits(along, parts)
    if second is None:
        raise NotComputed("a quadrature has no second value to be held against")
    if not _is_confirmed(value, second):
        raise NotComputed("two quadratures of one integral differ")


def _is_confirmed(value: Value, second: tuple[Value, mpf] | None) -> bool:
    """Whether a second value is near enough, by the integral of the modulus."""
    return second is not None and bool(abs(value - second[0]) <= _SECOND * second[1])


def _in_double(at_once: Callable[[Array], Array], parts: Sequence[Cut]) -> tuple[Value, mpf] | None:
    """The integral, and that of the modulus, in double precision."""
    squares, weights = _panels(_PANELS)
    total, modulus = 0j, 0.0
    for one, other in pairwise(parts):
        start, length = float(one.place), float(other.place - one.place)
        with np.errstate(all="ignore"):
            values = at_once(start + length * squares) * (weights * length)
        if not np.all(np.isfinite(values)):
            return None
        total += complex(np.sum(values))
        modulus += float(np.sum(np.abs(values)))
    return mpmath.mpmathify(total), mpf(modulus)


def _in_digits(along: Along, parts: Sequence[Cut]) -> tuple[Value, mpf] | None:
    """The same with fewer nodes and a few more digits."""
    squares, weights = _panels(_FEW_PANELS)
    total, modulus = mpf(0), mpf(0)
    with mpmath.workdps(_DIGITS):
        for one, other in pairwise(parts):
            length = other.place - one.place
            for square, weight in zip(squares, weights, strict=True):
                try:
                    part = along(one.place + length * mpf(square)) * mpf(weight) * length
                except (ArithmeticError, ValueError):
                    return None
                total += part
                modulus += abs(part)
    return (total, modulus) if mpmath.isfinite(total) else None


@cache
def _panels(count: int) -> tuple[Array, Array]:
    """sin(t)**2 and its differential at Gauss's nodes of equal panels of [0, pi/2]."""
    nodes, weights = np.polynomial.legendre.leggauss(_ORDER)
    half = np.pi / (4 * count)
    middles = half * (2 * np.arange(count) + 1)
    angles = (middles[:, None] + half * nodes).ravel()
    return np.sin(angles) ** 2, np.tile(weights * half, count) * np.sin(2 * angles)
