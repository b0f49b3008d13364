"""What the curved pieces of a contact carry where g' is polynomials, by Gauss's rule in the angle.

A place s of the contact [-a, c], h wide, is told by its angle t,

    a + s = h sin(t)**2,   c - s = h cos(t)**2,   ds/w = 2 dt,

over which the integrands of load, moment, tilt and K_N are sums of a few sines.  A dozen nodes on
each piece are exact to rounding, wherever its ends lie, and every distance is a product.

For the pressure a piece's polynomial S counts beyond its ends, too, and by parts

    int S'(s) L(x, s) ds = [Q(s) (s - x) L(x, s)] + w(x) int Q dt,
    Q(s) = (S(s) - S(x))/(s - x) = int_0^1 S'(x + r (s - x)) dr.

Where x lies on the piece nothing is subtracted here, and little where it lies close to it.  From
farther away L is smooth over the piece, and the left side is integrated as it stands.
"""

from collections.abc import Callable, Collection, Iterator
from functools import cache, cached_property
from typing import NamedTuple

import numpy as np

from ._arrays import Array, weighted
from ._logarithm import log1p
from ._profile import TOGETHER, Curve, Part, Window

NODES = 12
"""Nodes on a piece; one more for each degree of g''."""

NODES_AFAR = 24
"""Nodes for the pressure of a piece seen from outside; so many more as well."""

AFAR = 0.25
"""The angle between x and a piece, in parts of the piece's own, from where it is seen so."""

SUMS = "force", "left", "right", "lean", "arm"
"""What is integrated for load, K_N at both edges, tilt and moment."""

_NOTHING = 1e-290
"""In parts of the width: so close to a part's end, what is taken by parts there is nothing."""


def carried(contact: Window, degree: int, wanted: Collection[str] = SUMS) -> list[Array]:
    """The integrals over the curved pieces of

        g'' w,   g'' w/(a + s),   g'' w/(c - s),   g'/w,   g'' w (2 s + a - c),

    zero for those that are not wanted.  `degree` is that of g''.
    """
    total = np.zeros((len(SUMS), contact.width.size))
    count = NODES + degree
    for rows, here in _in_turn(contact, count):
        h = here.width
        for part in here.pieces(curved=True):
            if not np.any(part.length):
                continue
            arc = _Arc(part, h, count)
            for i, name in enumerate(SUMS):
                if name in wanted:
                    share = 2 * arc.integral(_INTEGRANDS[name](arc))
                    total[i, rows] += np.where(part.length > 0, share, 0.0)
        total[:, rows] *= h**2, h, h, h**0, h**3
    return [*total]


def pressed(contact: Window, x: Array, degree: int) -> Array:
    """The integral of g''(s) L(x, s) over the curved pieces; `degree` is that of g''."""
    total = np.zeros(contact.width.size)
    for rows, here in _in_turn(contact, NODES_AFAR + degree):
        place = _Place.at(x[rows], here)
        share = np.zeros(here.width.size)
        for part in here.pieces(curved=True):
            if not np.any(part.length):
                continue
            inside, beyond = part.length > 0, place.beyond(part)
            afar = inside & (beyond > AFAR * _extent(part))
            for chosen, seen in ((inside & ~afar, _from_nearby), (afar, _from_afar)):
                some = np.flatnonzero(chosen)
                if some.size:
                    share[some] += seen(part.on(some), place.on(some), here.width[some], degree)
        total[rows] = share
    return total


class _Place(NamedTuple):
    """Where the pressure is wanted.

    x: the place.
    left, right: its distances from the edges.
    """

    x: Array
    left: Array
    right: Array

    @classmethod
    def at(cls, x: Array, contact: Window) -> "_Place":
        """The place x of a contact."""
        return cls(x, x - contact.low, contact.high - x)

    def on(self, rows: Array) -> "_Place":
        """The same for some elements."""
        return _Place(*(v[rows] for v in self))

    def from_ends(self, part: Part) -> tuple[Array, Array]:
        """How far x lies inside the left and the right end of a part; negative beyond it."""
        return (
            np.where(part.start_low > 0, self.x - part.left, self.left),
            np.where(part.end_high > 0, part.right - self.x, self.right),
        )

    def beyond(self, part: Part) -> Array:
        """The angle by which x lies beyond a part."""
        after_start, before_end = self.from_ends(part)
        own = np.arctan2(np.sqrt(self.left), np.sqrt(self.right))
        start = np.arctan2(np.sqrt(part.start_low), np.sqrt(part.end_high + part.length))
        end = np.arctan2(np.sqrt(part.start_low + part.length), np.sqrt(part.end_high))
        return np.where(after_start < 0, start - own, np.where(before_end < 0, own - end, 0.0))

    def logarithm(self, sine: Array, cosine: Array, distance: Array) -> Array:
        """L(x, s) for an s at this angle, so far from x."""
        least = np.minimum(cosine**2 * self.left, sine**2 * self.right)
        both = sine * cosine * self.root
        return log1p(2 * (both + least) / distance) / 2

    @property
    def root(self) -> Array:
        """w(x)."""
        return np.sqrt(self.left) * np.sqrt(self.right)


def _from_nearby(part: Part, place: _Place, h: Array, degree: int) -> Array:
    """int g'' L ds over a part that x lies on, or close to: by parts."""
    after_start, before_end = place.from_ends(part)
    fractions, weights = _on_the_unit(degree // 2 + 1)

    def quotient(along: Array, back: Array) -> Array:
        """Q at these distances from the part's ends."""
        found = 0.0 * along
        for r, weight in zip(fractions, weights, strict=True):
            between = (1 - r) * after_start + r * along, (1 - r) * before_end + r * back
            found = found + weight * part.beside(*between).curvature
        return found

    arc = _Arc(part, h, NODES + degree)
    whole = arc.integral(quotient(arc.along, arc.back))
    total = place.root * whole
    none = 0.0 * part.length
    for (sine, cosine), along, back, distance in (
        (arc.start, none, part.length, after_start),
        (arc.end, part.length, none, before_end),
    ):
        level = place.logarithm(sine, cosine, np.maximum(np.abs(distance), _NOTHING * h))
        reached = (distance != 0) & (sine > 0) & (cosine > 0)  # at the edges L is zero
        total = total + np.where(reached, quotient(along, back) * distance * level, 0.0)
    return total


def _from_afar(part: Part, place: _Place, h: Array, degree: int) -> Array:
    """int g'' L ds over a part that x lies away from."""
    after_start, before_end = place.from_ends(part)
    arc = _Arc(part, h, NODES_AFAR + degree)
    distance = np.where(after_start < 0, arc.along - after_start, arc.back - before_end)
    level = place.logarithm(arc.sine, arc.cosine, distance)
    return 2 * h * arc.integral(arc.curve.curvature * (arc.sine * arc.cosine * level))


class _Arc:
    """One part of the contact at the nodes of the rule, one row each.

    extent: the part's angle.
    start, end: sine and cosine of the angle at its ends.
    sine, cosine: of the angle at the nodes.
    """

    def __init__(self, part: Part, h: Array, count: int) -> None:
        self.part, self.h = part, h
        self.extent = _extent(part)
        fractions, self._weight = _nodes(count)
        away = np.sin(self.extent * fractions[:, None])  # from the part's middle
        beside = np.sqrt((1 - away) * (1 + away))
        half = np.sin(self.extent / 2), np.cos(self.extent / 2)
        start, end = part.start_low, part.end_high
        self.start = np.sqrt(start / h), np.sqrt((end + part.length) / h)
        self.end = np.sqrt((start + part.length) / h), np.sqrt(end / h)
        sine = self.start[0] * half[1] + self.start[1] * half[0]
        cosine = self.end[1] * half[1] + self.end[0] * half[0]
        self.sine: Array = _on_both_sides(sine * beside, cosine * away)
        self.cosine: Array = _on_both_sides(cosine * beside, -sine * away)
        self._of_half = half[0] * beside, half[1] * away

    @property
    def along(self) -> Array:
        """Distances from the part's left end: differences of squared sines, as products."""
        sine, cosine = self.start
        own = _on_both_sides(*self._of_half)
        return self.h * own * (self.sine * cosine + self.cosine * sine)

    @property
    def back(self) -> Array:
        """Distances from the part's right end."""
        sine, cosine = self.end
        beside, away = self._of_half
        own = _on_both_sides(beside, -away)
        return self.h * own * (self.cosine * sine + self.sine * cosine)

    @cached_property
    def curve(self) -> Curve:
        """The curve at the nodes."""
        return self.part.beside(self.along, self.back)

    def integral(self, value: Array) -> Array:
        """int value dt over the part."""
        return self.extent * weighted(self._weight, value)


def _in_turn(contact: Window, count: int) -> Iterator[tuple[slice, Window]]:
    """A few elements at a time, so many that all their nodes stay in the processor's cache."""
    most = max(1, TOGETHER // count)
    for start in range(0, contact.width.size, most):
        rows = slice(start, start + most)
        yield rows, contact.on(rows)


def _extent(part: Part) -> Array:
    """The angle of a part."""
    return np.where(part.length > 0, part.angle() / 2, 0.0)


def _on_both_sides(same: Array, other: Array) -> Array:
    """same - other at the nodes before a part's middle, same + other at those behind it."""
    return np.concatenate((same - other, same + other))


@cache
def _nodes(count: int) -> tuple[Array, Array]:
    """Nodes behind the middle of a part of length one, and the weights of all.

    `count` nodes at least, and an even number of them.
    """
    half = -(-count // 2)
    nodes, weights = np.polynomial.legendre.leggauss(2 * half)
    return nodes[half:] / 2, np.tile(weights[half:] / 2, 2)


@cache
def _on_the_unit(count: int) -> tuple[Array, Array]:
    """Nodes and weights of Gauss's rule on (0, 1)."""
    nodes, weights = np.polynomial.legendre.leggauss(count)
    return (1 + nodes) / 2, weights / 2


_INTEGRANDS: dict[str, Callable[[_Arc], Array]] = {
    "force": lambda arc: arc.curve.curvature * (arc.sine * arc.cosine) ** 2,
    "left": lambda arc: arc.curve.curvature * arc.cosine**2,
    "right": lambda arc: arc.curve.curvature * arc.sine**2,
    "lean": lambda arc: arc.curve.slope,
    "arm": lambda arc: (
        arc.curve.curvature
        * (arc.sine * arc.cosine) ** 2
        * (arc.sine - arc.cosine)
        * (arc.sine + arc.cosine)
    ),
}
"""In parts of the width: of ds, a + s, c - s and w."""
