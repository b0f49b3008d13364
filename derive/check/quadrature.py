"""Compute one integral numerically by two rules that share no node, or give no value at all.

The interval is cut at points where the integrand may not be smooth.  Each part is computed to the
working precision by a rule that estimates its error.  The whole integral is then computed again in
double precision by Gauss's rule on many panels, which reveals features that fall between the few
nodes of the first rule.
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
"""Extra digits for the integrand, sufficient if nothing cancels."""
_SPARE = 5
"""Digits of the working precision by which an integral may fall short."""
_TRUSTED = 0.6
"""The fraction of the working digits that the error estimate must guarantee in the end."""
_SECOND = 1e-6
"""The largest difference between the two rules, relative to the integral of the modulus."""
_NEAR = (mpf(10) ** -9, mpf(10) ** -13)
"""Distances from a point, relative to the interval, at which the growth towards it is measured."""
_STEEPEST = 0.97
"""An integral is taken to diverge if the integrand grows by a higher power of 1/distance."""


class NotComputed(Exception):
    """A quadrature gives no reliable value."""


@dataclass(frozen=True)
class Cut:
    """A point of the interval at which it is cut, and the behaviour of the integrand there.

    kinds: as in derive.check.kinks; several may coincide.
    """

    position: mpf
    kinds: frozenset[str]


def cuts(start: mpf, end: mpf, known: Sequence[tuple[mpf, str]], more: bool) -> list[Cut]:
    """Return both ends and all points between them in order.

    Points that agree to two thirds of the working digits are merged.  If `more` is true, a further
    cut is added inside each part.
    """
    apart = (end - start) * mpf(10) ** (-2 * mpmath.mp.dps // 3)
    collected = [Cut(start, frozenset()), Cut(end, frozenset())]
    for position, kind in sorted(known):
        if not start - apart <= position <= end + apart:
            continue
        for n, cut in enumerate(collected):
            if abs(cut.position - position) <= apart:
                collected[n] = Cut(cut.position, cut.kinds | {kind})
                break
        else:
            collected.append(Cut(position, frozenset({kind})))
    collected.sort(key=lambda cut: cut.position)
    if more:
        fraction = mpf(4427) / 10000
        collected += [
            Cut(one.position + fraction * (other.position - one.position), frozenset({"peak"}))
            for one, other in pairwise(collected)
        ]
        collected.sort(key=lambda cut: cut.position)
    return collected


def demand_no_pole(along: Along, parts: Sequence[Cut], variable: str) -> None:
    """Raise NotComputed if the integrand grows like 1/distance, or faster, towards a cut."""
    for one, other in pairwise(parts):
        length = other.position - one.position
        for cut, sense in ((one, 1), (other, -1)):
            if cut.kinds <= {"kink", "peak"}:
                continue
            sizes = []
            for fraction in _NEAR:
                try:
                    sizes.append(abs(along(cut.position + sense * fraction * length)))
                except (ArithmeticError, ValueError):
                    sizes.append(mpmath.inf)
            far, near = sizes
            if far == 0 or near == 0:
                continue
            grown = mpmath.log10(near / far) / mpmath.log10(_NEAR[0] / _NEAR[1])
            if not mpmath.isfinite(grown) or grown > _STEEPEST:
                where = mpmath.nstr(cut.position, 6)
                raise NotComputed(
                    f"the integral diverges: its integrand has a pole at {variable} = {where} "
                    "(write pv, or \\fint in LaTeX, if a principal value is meant)"
                )


def integral(along: Along, parts: Sequence[Cut], steep: bool) -> Value:
    """Return the integral to the working precision; raises NotComputed."""
    pieces = [_part(along, *ends, steep) for ends in pairwise(parts)]
    size = sum(abs(value) for value, _, _ in pieces) + sum(size for _, _, size in pieces)
    error = sum(error for _, error, _ in pieces)
    if error > size * mpf(10) ** (-_TRUSTED * mpmath.mp.dps):
        raise NotComputed("the numerical integration does not converge")
    return sum(value for value, _, _ in pieces)


def _part(along: Along, one: Cut, other: Cut, steep: bool) -> tuple[Value, mpf, mpf]:
    """Return value, error and size of one part, with s = start + (end - start) sin(t)**2.

    If square roots vanish or are infinite at both ends, the integrand is even and periodic in t,
    and the midpoint rule converges geometrically.  Otherwise Gauss's nodes are used, or nodes that
    are clustered at the ends.
    """
    start, end = one.position, other.position
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
    """Estimate the integral of the modulus."""
    shares = (mpf("0.137"), mpf("0.391"), mpf("0.618"), mpf("0.853"))
    return (end - start) * sum(_modulus(along, start + (end - start) * s) for s in shares) / 4


def _modulus(along: Along, position: mpf) -> mpf:
    try:
        value = abs(along(position))
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
    """Return sin(t)**2 and 2 sin(t) cos(t) dt at the midpoints of [0, pi/2]."""
    with mpmath.workdps(digits + GUARD):
        step = mpmath.pi / (2 * count)
        angles = [(k + mpf(1) / 2) * step for k in range(count)]
        return [(mpmath.sin(t) ** 2, mpmath.sin(2 * t) * step) for t in angles]


def _gauss(along: Along, start: mpf, end: mpf) -> tuple[Value, mpf]:
    value_and_error: tuple[Value, mpf] = mpmath.quad(
        _by_angle(along, start, end, mpmath.mp.dps + GUARD),
        [mpf(0), mpmath.pi / 2],
        method=gauss_legendre,
        error=True,
    )
    return value_and_error


def _crowded(along: Along, start: mpf, end: mpf, size: mpf, steep: bool) -> tuple[Value, mpf]:
    """Use nodes clustered at both ends, with twice the digits if the integrand may be infinite."""
    digits = mpmath.mp.dps * (2 if steep else 1) + GUARD
    unit = size or mpf(1)
    around = _by_angle(lambda position: along(position) / unit, start, end, digits)
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
                return mpf(0)  # at the end point itself, where the weight is zero
            return 2 * (end - start) * sine * cosine * value

    return around


# ------------------------------------------------------------------ the second value

Array: TypeAlias = Any
"""An array of floats or of complex numbers."""

_PANELS, _ORDER = 256, 8
_FEW_PANELS = 24
_DIGITS = 30
"""Working digits of the rule with few panels."""


def demand_second(
    value: Value, along: Along, at_once: Callable[[Array], Array] | None, parts: Sequence[Cut]
) -> None:
    """Raise NotComputed unless a rule with other nodes confirms the value.

    at_once: the integrand as a function of arrays in double precision, or None if there is none.
    If double precision is not sufficient, fewer nodes are used with more digits.
    """
    if at_once is not None and _is_confirmed(value, _in_double(at_once, parts)):
        return
    second = _in_digits(along, parts)
    if second is None:
        raise NotComputed("an integral could not be confirmed by a second rule")
    if not _is_confirmed(value, second):
        raise NotComputed("two integration rules give different values of one integral")


def _is_confirmed(value: Value, second: tuple[Value, mpf] | None) -> bool:
    """Whether a second value is close enough, relative to the integral of the modulus."""
    return second is not None and bool(abs(value - second[0]) <= _SECOND * second[1])


def _in_double(at_once: Callable[[Array], Array], parts: Sequence[Cut]) -> tuple[Value, mpf] | None:
    """Return the integral and the integral of the modulus, in double precision."""
    squares, weights = _panels(_PANELS)
    total, modulus = 0j, 0.0
    for one, other in pairwise(parts):
        start, length = float(one.position), float(other.position - one.position)
        with np.errstate(all="ignore"):
            values = at_once(start + length * squares) * (weights * length)
        if not np.all(np.isfinite(values)):
            return None
        total += complex(np.sum(values))
        modulus += float(np.sum(np.abs(values)))
    return mpmath.mpmathify(total), mpf(modulus)


def _in_digits(along: Along, parts: Sequence[Cut]) -> tuple[Value, mpf] | None:
    """Return the same two integrals with fewer nodes and slightly higher precision."""
    squares, weights = _panels(_FEW_PANELS)
    total, modulus = mpf(0), mpf(0)
    with mpmath.workdps(_DIGITS):
        for one, other in pairwise(parts):
            length = other.position - one.position
            for square, weight in zip(squares, weights, strict=True):
                try:
                    part = along(one.position + length * mpf(square)) * mpf(weight) * length
                except (ArithmeticError, ValueError):
                    return None
                total += part
                modulus += abs(part)
    return (total, modulus) if mpmath.isfinite(total) else None


@cache
def _panels(count: int) -> tuple[Array, Array]:
    """Return sin(t)**2 and its differential at Gauss's nodes on equal panels of [0, pi/2]."""
    nodes, weights = np.polynomial.legendre.leggauss(_ORDER)
    half = np.pi / (4 * count)
    middles = half * (2 * np.arange(count) + 1)
    angles = (middles[:, None] + half * nodes).ravel()
    return np.sin(angles) ** 2, np.tile(weights * half, count) * np.sin(2 * angles)
