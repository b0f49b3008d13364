"""One rule for every integral: part by part between the places where an integrand is not smooth.

On a part (p, q) the variable is v, s = p + (q - p)/(1 + exp(-v)), and the rule is the trapezoidal
one.  A singularity on the real axis outside the part, however close to one of its ends, lies at
Im v = pi, so that the steps need not know of it; they need to know how the integrand grows at the
ends alone.
"""

from collections.abc import Callable, Sequence
from functools import cache
from itertools import pairwise
from math import log, pi

from flint import arb, ctx
from mpmath import mpf

from derive.proof.balls import Ball, ball, digits, number

Integrand = Callable[[Ball, Ball, Ball], Sequence[Ball]]
"""Several integrands at once: of a place, and of its distances from both ends of its part."""

SUMS, DIFFERENCES, SECOND_DIFFERENCES = 1.5, 2.5, 4.0
"""Working digits, in parts of those asked for: what is divided by a distance from an end, or by its
square, keeps its own."""

_NEGLIGIBLE = arb(2) ** -60
"""Share of all weights at which an integrand may have no value: so close to an end that it is none
in the working digits."""

_STRIP = 0.9 * pi
"""Half the width of the strip in which integrands are smooth; pi itself is its border."""

_BEND = 0.9 * pi / 2
"""The same where they are singular beside the end of a part, square to the axis."""


def integrals(
    integrand: Integrand,
    cuts: Sequence[mpf],
    count: int,
    grows: tuple[float, float] = (-0.5, -0.5),
    near: float = 1.0,
    bends: bool = False,
    working: float = DIFFERENCES,
) -> list[mpf]:
    """Integrals over [cuts[0], cuts[-1]] to so many digits.

    grows  the powers with which the integrand grows at the first and the last cut; at the others it
           is bounded, but for logarithms
    near   the shortest length over which it changes there, in parts of the part
    bends  whether it is singular square to the axis at a cut
    working  digits, in parts of those asked for
    """
    whole = count * log(10)
    ends = [grows[0], *(0.0 for _ in cuts[1:-1]), grows[1]]
    reaches = [whole / (1 + power) - min(0.0, log(near)) for power in ends]
    steps = whole / (2 * pi * (_BEND if bends else _STRIP))
    with digits(int(working * count)):
        total, lost = [], arb(0)
        for (low, high), reach in zip(pairwise(map(ball, cuts)), pairwise(reaches), strict=True):
            width = high - low
            for share, rest, weight in _nodes(
                *(int(v * steps) + 1 for v in reach), steps, ctx.prec
            ):
                y, z = width * share, width * rest
                values = integrand(low + y if share < rest else high - z, y, z)
                if all(value.is_finite() for value in values):
                    total.append([width * weight * value for value in values])
                else:
                    lost += weight
        if lost > _NEGLIGIBLE:
            raise ArithmeticError(f"an integrand has no value between {cuts[0]} and {cuts[-1]}")
        return [number(sum(column, arb(0))) for column in zip(*total, strict=True)]


@cache
def _nodes(left: int, right: int, steps: float, bits: int) -> list[tuple[Ball, Ball, Ball]]:
    """Shares of a part on the left and the right of each node, and its weight."""
    step, found = 1 / arb(steps), []
    for k in range(-left, right + 1):
        grown = (k * step).exp()
        share = grown / (1 + grown)
        found.append((share, 1 / (1 + grown), step * share / (1 + grown)))
    return found


@cache
def _chebyshev(count: int, bits: int) -> list[Ball]:
    return [((2 * k + 1) * arb.pi() / (2 * count)).cos() for k in range(count)]


LEAST, MOST = 16, 512
"""Nodes on the half-circle, to begin with and at most."""

Values = Callable[[Ball, Ball], Sequence[Ball]]
"""Several functions at once, of a place s in the contact and of s - x."""


def over_contact(
    values: Values,
    a: mpf,
    c: mpf,
    kinks: Sequence[mpf],
    count: int,
    x: mpf | None = None,
    working: float = SUMS,
) -> list[mpf]:
    """int values/sqrt((a + s)(c - s)) ds over the contact, to so many digits.

    Without kinks by Gauss's rule for this weight, as long as few nodes are enough.
    """
    found = None if kinks else _along_the_circle(values, a, c, count, x)
    return found or _part_by_part(values, a, c, kinks, count, x, working)


def _along_the_circle(
    values: Values, a: mpf, c: mpf, count: int, x: mpf | None
) -> list[mpf] | None:
    before: list[Ball] | None = None
    nodes = LEAST
    with digits(2 * count):
        half, middle = (ball(a) + ball(c)) / 2, (ball(c) - ball(a)) / 2
        here = ball(x) if x is not None else arb(0)
        while nodes <= MOST:
            places = [middle + half * cosine for cosine in _chebyshev(nodes, ctx.prec)]
            rows = [values(s, s - here) for s in places]
            columns = [*zip(*rows, strict=True)]
            now, sizes = ([sum(map(of, v), arb(0)) / nodes for v in columns] for of in (arb, abs))
            if not all(value.is_finite() for value in now):
                return None
            if before is not None and all(
                abs(p - q) <= arb(10) ** -count * size
                for p, q, size in zip(before, now, sizes, strict=True)
            ):
                return [number(arb.pi() * value) for value in now]
            before, nodes = now, 2 * nodes
    return None


def _part_by_part(
    values: Values,
    a: mpf,
    c: mpf,
    kinks: Sequence[mpf],
    count: int,
    x: mpf | None,
    working: float,
) -> list[mpf]:
    middle = [] if kinks else [mpf(0)]  # beside it smooth bodies bend
    inside = {place for place in (*kinks, *middle, *([] if x is None else [x])) if -a < place < c}
    cuts = sorted({-a, c, *inside})
    nearest = float(min(q - p for p, q in pairwise(cuts)) / (a + c))
    total: list[mpf] = []
    for low, high in pairwise(cuts):
        part = integrals(
            _weighted(values, low, high, (a, c), mpf(0) if x is None else x),
            (low, high),
            count,
            (-0.5 if low == -a else 0.0, -0.5 if high == c else 0.0),
            nearest,
            bends=not kinks,
            working=working,
        )
        total = [p + q for p, q in zip(total, part, strict=True)] if total else part
    return total


def _weighted(values: Values, low: mpf, high: mpf, edges: tuple[mpf, mpf], x: mpf) -> Integrand:
    """Over w, on a part that does not hold x but may end there."""
    start, end, left, right, here = map(ball, (low, high, *edges, x))
    beyond = low >= x

    def integrand(s: Ball, y: Ball, z: Ball) -> list[Ball]:
        away = (start - here) + y if beyond else (end - here) - z
        root = ((start + left + y) * (right - end + z)).sqrt()
        return [value / root for value in values(s, away)]

    return integrand
