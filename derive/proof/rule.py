"""Quadrature with a check of convergence: intervals are halved until the estimated error is small.

In:  an integrand of balls, and the points at which to split the interval.
Out: the integral to nearly all working digits of mpmath.

Levels, error estimates and the stopping rule are those of mpmath; nodes and sums are balls.
"""

from collections.abc import Callable, Sequence
from functools import lru_cache
from itertools import pairwise
from typing import TypeVar

import mpmath
from flint import arb, ctx
from mpmath import mpf
from mpmath.calculus.quadrature import GaussLegendre, QuadratureRule

from derive.proof.balls import Ball, ball, bits, digits, number

Function = Callable[[Ball], Ball]
Value = TypeVar("Value")
Nodes = Sequence[tuple[Ball, Ball]]
"""Points in (-1, 1), and their weights."""

SMOOTH, CROWDED = "gauss-legendre", "tanh-sinh"
"""Rules by their names in mpmath: for integrands that are smooth up to the ends, and for others."""

_SPARE = 8
"""Number of digits of the working precision that the integral may lack."""

_CUTS = 6
"""Largest number of times that every interval is halved."""

_BESIDES = 12
"""Additional digits of the integrand; mpmath's sums use six more than the working precision."""


def remembered(function: Callable[[Ball], Value]) -> Callable[[Ball], Value]:
    """Remember values of `function` at every node and precision, since integrals share nodes."""
    known: dict[tuple[int, int], tuple[Ball, Value]] = {}

    def at(place: Ball) -> Value:
        asked = (id(place), ctx.prec)
        if asked not in known:
            known[asked] = place, function(place)  # kept, so that its id stays unique
        return known[asked][1]

    return at


def integral(
    integrand: Function, cuts: Sequence[mpf], method: str = CROWDED, inside: int = 0
) -> mpf:
    """int integrand over [cuts[0], cuts[-1]]; NaN if the integrand has no value on a part of it.

    A node so close to an end that the integrand divides by zero is left out.

    inside: initial number of digits of the integrand; doubled if its balls become too wide.
    """
    allowed = mpf(10) ** (_SPARE - mpmath.mp.dps)
    count = max(inside, mpmath.mp.dps + _BESIDES)
    for working in (count, 2 * count, 4 * count):
        rule = _InBalls(method)
        with digits(working):
            value, size = _converged(integrand, cuts, rule, allowed)
        if rule.width <= allowed * max(abs(value), size):
            break
    return value


def _converged(
    integrand: Function, cuts: Sequence[mpf], rule: "_InBalls", allowed: mpf
) -> tuple[mpf, mpf]:
    """The integral, and the approximate size of the integral of the modulus."""
    for _ in range(_CUTS):
        value, error = mpmath.quad(integrand, cuts, method=lambda _: rule, error=True)
        size = max(_size(integrand, low, high) for low, high in pairwise(cuts))
        if error <= allowed * max(abs(value), size):
            break
        cuts = [*(end for p, q in pairwise(cuts) for end in (p, (p + q) / 2)), cuts[-1]]
    return value, size


def _size(integrand: Function, low: mpf, high: mpf) -> mpf:
    """Approximate size of an integral between two points."""
    middle = number(integrand((ball(low) + ball(high)) / 2))
    return mpf(0) if mpmath.isnan(middle) else abs(middle * (high - low))


_AT_AN_END = arb(2) ** -50
"""Largest share of the total weight that nodes without a value may have.  Such nodes are so close
to an end that the integrand divides by zero at the given precision."""


class _InBalls(QuadratureRule):
    """Gauss-Legendre or tanh-sinh quadrature with nodes and sums that are balls.

    width: the largest error radius of a sum.
    """

    def __init__(self, method: str) -> None:
        super().__init__(mpmath.mp)
        self.method, self.width = method, mpf(0)

    def get_nodes(
        self, low: mpf, high: mpf, degree: int, prec: int, verbose: bool = False
    ) -> Nodes:
        """Nodes of this level between two points."""
        return _between(self.method, low, high, degree, prec, ctx.prec)

    def sum_next(
        self,
        integrand: Function,
        nodes: Nodes,
        degree: int,
        prec: int,
        previous: Sequence[mpf],
        verbose: bool = False,
    ) -> mpf:
        """The sum of this level; `previous` are the sums of the earlier levels.

        New nodes of the tanh-sinh rule lie between the previous ones; half the previous sum is
        added.
        """
        terms = [(weight, weight * integrand(place)) for place, weight in nodes]
        total = sum((term for _, term in terms if term.is_finite()), arb(0))
        lost = sum((weight for weight, term in terms if not term.is_finite()), arb(0))
        if lost > _AT_AN_END * sum(weight for weight, _ in terms):
            total = arb("nan")
        self.width = max(self.width, number(total.rad()))
        if self.method != CROWDED:
            return number(total)
        fresh = number(total) * mpf(2) ** -degree
        return fresh + previous[-1] / 2 if previous else fresh


@lru_cache(maxsize=256)
def _between(method: str, low: mpf, high: mpf, degree: int, prec: int, bits: int) -> Nodes:
    """Nodes between two points: always the same balls, so that values are remembered for them."""
    half, middle = (ball(high) - ball(low)) / 2, (ball(low) + ball(high)) / 2
    standard = _standard(method, degree, prec, bits)
    return [(middle + half * place, half * weight) for place, weight in standard]


@lru_cache(maxsize=256)
def _standard(method: str, degree: int, prec: int, bits: int) -> Nodes:
    """Nodes in (-1, 1), to a given number of bits."""
    return _crowded(degree, prec) if method == CROWDED else _of_legendre(degree)


def _of_legendre(degree: int) -> Nodes:
    """Roots of the Legendre polynomial of degree 3 2**(degree - 1)."""
    count = 3 * 2 ** (degree - 1)
    return [arb.legendre_p_root(count, k, weight=True) for k in range(count)]


def _crowded(degree: int, prec: int) -> Nodes:
    """tanh((pi/2) sinh t) at the t that this level adds, until it equals 1 to the last digit."""
    quarter = arb.pi() / 2
    t, every = arb(2) ** -degree, arb(2) ** (-1 if degree == 1 else 1 - degree)
    nodes = [(arb(0), quarter)] if degree == 1 else []
    while True:
        steep = quarter * t.sinh()
        short = 2 / (1 + (2 * steep).exp())
        if short < arb(2) ** (-prec - 10):
            return nodes
        weight = quarter * t.cosh() / steep.cosh() ** 2
        nodes += [(1 - short, weight), (short - 1, weight)]
        t = t + every


class _QuickNodes(GaussLegendre):
    """mpmath's own Gauss-Legendre rule, with nodes that are found in a hundredth of the time."""

    def calc_nodes(self, degree: int, prec: int, verbose: bool = False) -> list[tuple[mpf, mpf]]:
        """Nodes and weights, as mpmath's numbers."""
        with bits(prec + _GUARD_BITS):
            return [(number(place), number(weight)) for place, weight in _of_legendre(degree)]


_GUARD_BITS = 20

_QUICK = _QuickNodes(mpmath.mp)


def gauss_legendre(_: object) -> QuadratureRule:
    """A `method` for mpmath.quad."""
    return _QUICK
