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

WORKING = 2.5
"""Working digits, in parts of those asked for: what is divided by a distance from an end keeps its
own."""

_NEGLIGIBLE = arb(2) ** -60
"""Share of all weights at which an integrand may have no value: so close to an end that it is none
in the working digits."""

_STRIP = 0.9 * pi
"""Half the width of the strip in which integrands are smooth; pi itself is its border."""


def integrals(
    integrand: Integrand,
    cuts: Sequence[mpf],
    count: int,
    grows: tuple[float, float] = (-0.5, -0.5),
    near: float = 1.0,
) -> list[mpf]:
    """Integrals over [cuts[0], cuts[-1]] to so many digits.

    grows  the powers with which the integrand grows at the first and the last cut; at the others it
           is bounded, but for logarithms
    near   the shortest length over which it changes there, in parts of the part
    """
    whole = count * log(10)
    ends = [grows[0], *(0.0 for _ in cuts[1:-1]), grows[1]]
    reaches = [whole / (1 + power) - min(0.0, log(near)) for power in ends]
    steps = whole / (2 * pi * _STRIP)
    with digits(int(WORKING * count)):
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
