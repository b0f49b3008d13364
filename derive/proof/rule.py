"""One rule of quadrature, and one check of it.

In:  an integrand of balls, and the points at which to cut the interval.
Out: a ball with the integral, to the working digits of mpmath.

On a part, s = low + (high - low) sin(u)**2: integrands that contain roots of the distances from the
ends are smooth in u.  The number of Gauss's nodes in u is doubled until two sums agree.  If they
approach each other too slowly, nodes that are clustered at the ends are taken instead (tanh-sinh).

If nodes so close to an end leave too few digits of the integrand, it is computed with more.

The check: the integral is computed a second time with every part cut in two at a place that means
nothing, so that no node is shared.  Ten times the difference is the radius of the result.  A proof
compares each integral with another route, and goes without.
"""

from collections.abc import Iterator, Sequence
from functools import lru_cache
from itertools import pairwise

import mpmath
from flint import arb, ctx
from mpmath import mpf

from derive.proof.balls import Ball, Function, digits, known_digits, widened

_INSIDE = (3, 6)
"""Digits of an integrand for each digit of the integral, tried in this order: nodes come so close
to the ends that distances from these need twice as many, and differences of neighbours more."""
_SPARE = 20
"""Further digits of an integrand."""
_CONVERGED = 0.6
"""A next sum would double the number of certain digits: two that share this fraction suffice."""
_SLOW = 1.4
"""Gauss's sums converge if the relative gap decreases at least to this power of the one before."""
_GAUSS = (18, 36, 72, 144, 288)
"""Numbers of Gauss's nodes."""
_HALVINGS = 9
"""Number of times that the distance between clustered nodes is halved."""
_NOWHERE = mpf(4427) / 10000
"""Where the second computation cuts a part."""
_FINER = 5
"""Largest number of times that a part is cut because neither kind of nodes converges."""
_AT_AN_END = arb(2) ** -50
"""Largest share of the weights that nodes without a value may have: they are so close to an end
that the integrand divides by zero in the working digits."""

Nodes = Sequence[tuple[arb, bool, arb]]
"""For each node its distance from an end, whether that is the upper end, and its weight."""


def integral(integrand: Function, cuts: Sequence[mpf]) -> Ball:
    """int integrand over [cuts[0], cuts[-1]]; NaN if the integrand has no value on a part of it."""
    for times in _INSIDE:
        with digits(times * mpmath.mp.dps + _SPARE):
            total = sum((_part(integrand, *ends) for ends in pairwise(cuts)), arb(0))
        if known_digits(total) >= mpmath.mp.dps:
            break
    return total


def checked(integrand: Function, cuts: Sequence[mpf]) -> Ball:
    """The same integral with a radius from a second computation that shares no node with it."""
    finer = []
    for low, high in pairwise(cuts):
        with mpmath.workdps(3 * mpmath.mp.dps):
            finer += [low, low + _NOWHERE * (high - low)]
    first, second = integral(integrand, cuts), integral(integrand, [*finer, cuts[-1]])
    return widened(first, 10 * abs(first - second).upper())


def _part(integrand: Function, low: mpf, high: mpf, finer: int = _FINER) -> Ball:
    """One part; cut in halves if it does not converge."""
    enough = arb(10) ** int(-_CONVERGED * mpmath.mp.dps)
    for sums, slow in ((_gauss, _SLOW), (_clustered, 0.0)):
        gaps: list[arb] = []
        previous: Ball | None = None
        for total, size in sums(integrand, low, high):
            if not total.is_finite():
                return total
            if previous is not None:
                gaps.append(abs(total - previous).mid())
                if gaps[-1] <= size * enough + 4 * total.rad():
                    return total
                if gaps[1:] and slow and gaps[-1] / size > (gaps[-2] / size) ** slow:
                    break
            previous = total
    if not finer:
        return widened(total, gaps[-1])
    middle = (low + high) / 2
    return sum((_part(integrand, *e, finer - 1) for e in ((low, middle), (middle, high))), arb(0))


def _gauss(integrand: Function, low: mpf, high: mpf) -> Iterator[tuple[Ball, arb]]:
    """Sums with more and more of Gauss's nodes, and the same of the modulus."""
    for count in _GAUSS:
        yield _summed(integrand, low, high, _of_gauss(count, ctx.prec))


def _clustered(integrand: Function, low: mpf, high: mpf) -> Iterator[tuple[Ball, arb]]:
    """Sums with clustered nodes; the nodes of a level lie between those of the levels before."""
    total: Ball = arb(0)
    size = arb(0)
    for level in range(_HALVINGS):
        nodes = _of_level(level, mpmath.mp.dps, ctx.prec)
        more, moduli = _summed(integrand, low, high, nodes)
        total, size = total / 2 + more, size / 2 + moduli
        if level > 1:
            yield total, size


def _summed(integrand: Function, low: mpf, high: mpf, nodes: Nodes) -> tuple[Ball, arb]:
    start, end = arb(low), arb(high)
    length = end - start
    total: Ball = arb(0)
    size, lost, whole = arb(0), arb(0), arb(0)
    for distance, from_above, weight in nodes:
        place = end - length * distance if from_above else start + length * distance
        term = length * weight * integrand(place)
        whole += weight
        if term.is_finite():
            total += term
            size += abs(term).mid()
        else:
            lost += weight
    return total if lost <= _AT_AN_END * whole else arb("nan"), size


@lru_cache(maxsize=256)
def _of_gauss(count: int, bits: int) -> Nodes:
    """Nodes on [0, 1] with the roots of a Legendre polynomial in u, to so many bits."""
    pairs = [arb.legendre_p_root(count, k, weight=True) for k in range(count)]
    return [_node(1 - abs(place), place > 0, weight) for place, weight in pairs]


@lru_cache(maxsize=256)
def _of_level(level: int, working: int, bits: int) -> Nodes:
    """Those with tanh((pi/2) sinh t) in u at the t that a level adds, down to 10**-working."""
    quarter, step = arb.pi() / 2, arb(2) ** -level
    t = step if level else arb(0)
    found: list[tuple[arb, bool, arb]] = []
    while True:
        short = 2 / (1 + (2 * quarter * t.sinh()).exp())
        if short < arb(10) ** (-working - 3):
            return found
        weight = step * quarter * t.cosh() / (quarter * t.sinh()).cosh() ** 2
        found += [_node(short, above, weight) for above in ((True, False) if t != 0 else (True,))]
        t += 2 * step if level else step


def _node(short: arb, from_above: bool, weight: arb) -> tuple[arb, bool, arb]:
    """A node at the distance `short` from an end of [-1, 1], under s = sin(u)**2."""
    angle = arb.pi() / 4 * short
    return angle.sin() ** 2, from_above, weight * arb.pi() / 4 * (2 * angle).sin()
