r"""Slip zones by series in their length over the width of the stick zone.

At a distance s from an edge p = K s**(1/2) + L s**(3/2) + N s**(5/2) + ...  A slip zone of length d
beside a stick zone of width h_s adds to the conditions for a bounded change of shear

    near = int_0^d p sqrt((h_s + d - s)/(d - s)) ds  at its own end of the stick zone,
    far  = int_0^d p sqrt((d - s)/(h_s + d - s)) ds  at the other end,

sums of C_i h_s**(1/2 - j) d**(i + j + 1) and of C_i h_s**(-1/2 - j) d**(i + j + 2).  An order keeps
powers of d up to itself; both conditions are then solved as they stand.  Each contact of the cycle
has its own edges, so that varying loads need nothing more.  Where no formula gives N, it follows
from how L changes as the edge alone moves: N = -(2/5) (dL/dedge + K/(16 h**2)).

What the next order adds to the slip zones would lose its digits as a difference of two orders.  It
is solved for: at the zones of an order, the conditions of the next one are off by the terms that
they have gained.
"""

from collections.abc import Iterator, Sequence
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np

from ._arrays import Array, Flat
from ._changes import NODES, edges_along, rule_of_way
from ._law import Law
from ._types import Edges
from ._zones import Pair, drawn_in, moved, pulls

ORDERS = (1, 2, 3)

NEAR = ((1 / 2, 1 / 16, -1 / 128), (3 / 8, 1 / 32), (5 / 16,))
"""binomial(1/2, j) B(i + 3/2, j + 1/2)/pi, i the row."""

FAR = ((1 / 8, -1 / 32), (1 / 16,))
"""binomial(-1/2, j) B(i + 3/2, j + 3/2)/pi, i the row."""

STEPS = 40
"""Newton's steps at most; four to six are common."""

LONGEST = 1.0
"""Longest of them in the logarithm of a slip zone over the stick zone."""

APART = (1e-3, 6e-5, 4e-6)
"""How far an edge is moved to see L change, in parts of the distance to the next kink: the formula
of five points is off by 1e-13 at the first, for truncation as for rounding, unless the curve bends
within a shorter distance."""

FINEST = 1e-10
"""The least step, in parts of the edge's place: it is rounded by a millionth there."""

LEAST_SLIP = 1e-14
"""Shortest slip zone to start from, in parts of the other one and of what the contact gains."""

SMALL = 1e-9
"""A step after which nothing is left to do: the next would be its square."""

ROUNDING = 16 * 2.0**-52
"""So long steps may stay, for rounding, times the longer slip zone over the shorter one,"""

IDLE = 3
"""if so many do not get shorter."""

CLOSE = 1.0
"""What two orders differ by is solved for if it is less, in parts of slip zones and stick zone."""

TURNS = 8
"""How often, at most: each time its error shrinks as the zones do from one order to the next."""

SETTLED = 1e-12
"""It is known to rounding if the last time it changed by less, in parts of it."""


@np.errstate(all="ignore")
def slip_zones_of(law: Law, /, *args: Array, order: int, **given: Array) -> Edges:
    """Slip zones to an order, as seen from the contact [-a, c]."""
    demand_order(order, ORDERS)
    series = _Series(law, *args, **given)
    return Edges(*map(series.given.shaped, series.zones(order)))


@np.errstate(all="ignore")
def slip_error_of(law: Law, /, *args: Array, order: int, **given: Array) -> Edges:
    """By how much the next order changes the slip zones."""
    demand_order(order, ORDERS[:-1])
    series = _Series(law, *args, **given)
    return Edges(*(series.given.shaped(np.abs(gain)) for gain in series.gains(order)))


def demand_order(order: Any, allowed: tuple[int, ...]) -> None:
    """Raises ValueError for an order that there is not."""
    whole = isinstance(order, int | np.integer) and not isinstance(order, bool)
    if not whole or order not in allowed:
        words = f"{', '.join(map(str, allowed[:-1]))} or {allowed[-1]}"
        raise ValueError(f"order must be {words}; got {order!r:.60}")


Sums = tuple[Array, Array, Array]
"""A sum; its rates with the length of a slip zone and with `stuck`."""


class _Series:
    """One call: the contact as it is now, and as it is at the other end of the half-cycle."""

    def __init__(
        self,
        law: Law,
        a: Array,
        c: Array,
        dQ: Array,
        dsigma: Array,
        /,
        *,
        f: Array,
        E_star: Array,
        da: Array,
        dc: Array,
        **own: Array,
    ) -> None:
        values = {"a": a, "c": c, "dQ": dQ, "dsigma": dsigma, "da": da, "dc": dc}
        self.law = law
        self.given = Flat(values, {"E_star": E_star, **own}, {"f": f})
        self.a, self.c, self.dQ, self.dsigma, da, dc, self.f = self.given.values
        self.constants = self.given.constants
        self.da, self.dc, self.h = da, dc, self.a + self.c
        self.least_left, self.least_right = np.maximum(da, 0), np.maximum(dc, 0)
        self.varies = bool(np.any(da) or np.any(dc))
        loads = [law.load(*edges, **self.constants) for edges in self.contacts]
        limit = self.f * (loads[0] + loads[-1])
        self.exists = (self.dQ >= 0) & (self.dQ < limit) & np.isfinite(self.dsigma)

    @property
    def contacts(self) -> list[tuple[Array, Array]]:
        """Edges of both contacts; once if they are the same."""
        now = self.a, self.c
        return [now, (self.a - self.da, self.c - self.dc)] if self.varies else [now]

    @property
    def pulls(self) -> Pair:
        """pi sqrt(h) K_T at the left and the right edge."""
        return pulls(self.dQ, self.dsigma, self.h)

    @cached_property
    def _kappa(self) -> Pair:
        """Sense of slip at the left and the right edge, times f."""
        left, right = (np.where(v < 0, -1.0, 1.0) * self.f for v in self.pulls)
        return left, right

    def zones(self, order: int) -> Pair:
        """To an order; NaN where slip does not reach in at both edges, or leaves no stick."""
        left, right = self._first_order if order == 1 else self._solved(order)
        sound = self.exists & (left >= self.least_left) & (right >= self.least_right)
        sound &= left + right < self.h
        return np.where(sound, left, np.nan), np.where(sound, right, np.nan)

    def gains(self, order: int) -> Pair:
        """What the next order adds to the zones of an order."""
        now, following = self.zones(order), self.zones(order + 1)
        gain = following[0] - now[0], following[1] - now[1]
        length = np.maximum(*(np.abs(v) / w for v, w in zip(gain, now, strict=True)))
        length = np.maximum(length, (gain[0] + gain[1]) / (self.h - now[0] - now[1]))
        if not np.any(length < CLOSE):
            return gain
        coefficients = self._coefficients(order + 1)
        off, best, done = self._gained(order, coefficients, *now), gain, ~(length < CLOSE)
        for _ in range(TURNS):
            found = _step(off, self._mean_rates(coefficients, now, best))
            rests = [np.abs(v - w) <= SETTLED * np.abs(w) for v, w in zip(best, found, strict=True)]
            best = np.where(done, best[0], found[0]), np.where(done, best[1], found[1])
            done |= rests[0] & rests[1]
            if np.all(done):
                break
        return np.where(done, best[0], gain[0]), np.where(done, best[1], gain[1])

    def _gained(self, order: int, coefficients: Any, left: Array, right: Array) -> Sequence[Array]:
        """What the conditions of the next order are off by at the zones of an order."""
        stuck = self.h - left - right
        own = self._left_over() if order == 1 else (0.0, 0.0)
        off = [v + 0.0 * stuck for v in own]
        zones = self._beyond_gain(left, right)
        for _, j, kappa, (value, _, _) in self._terms(coefficients, *zones, stuck, last=True):
            off[j] = off[j] + kappa * value
        return off

    def _left_over(self) -> Iterator[Array]:
        """What both conditions with K alone are off by at the first order, which takes the whole
        width for that of the stick zone."""
        zones = self._first_order
        risen, lost = self._risen, zones[0] + zones[1]
        root = np.sqrt(self.h - lost)
        by_tension = np.pi * self.dsigma / 8 * lost
        for i, (d, gap) in enumerate(zip(zones, (self.da, self.dc), strict=True)):
            by_width = self._K[0][i] * (d - gap / 2) * -lost / (root + np.sqrt(self.h))
            by_gain = risen[i] * (d - gap) / 2 * root
            tension = by_tension if i == 0 else -by_tension
            yield np.pi * self._kappa[i] * (by_width + by_gain) + tension

    @property
    def _risen(self) -> Sequence[Array]:
        """By how much K_N differs at the other end of the half-cycle."""
        if not self.varies:
            return 0.0, 0.0
        motion = -self.da, -self.dc
        risen, settled = edges_along(self.law, self.contacts[0], motion, self.constants)
        told = [w - v for v, w in zip(*self._K, strict=True)]
        return [np.where(settled, v, w) for v, w in zip(risen, told, strict=True)]

    def _mean_rates(self, coefficients: Any, zones: Pair, gain: Pair) -> list[list[Array]]:
        """Rates of the conditions, their means on the way from one order to the next."""
        mean: Any = 0.0
        for part, weight in zip(*rule_of_way(NODES), strict=True):
            left, right = (v + part * w for v, w in zip(zones, gain, strict=True))
            _, rates = self._conditions(coefficients, *self._beyond_gain(left, right))
            mean = mean + weight * np.array(rates)
        return mean

    def _beyond_gain(self, left: Array, right: Array) -> Pair:
        """Slip zones without what the contact has gained."""
        return left - self.least_left, right - self.least_right

    @cached_property
    def _K(self) -> list[Edges]:
        return [self.law.K_N(*edges, **self.constants) for edges in self.contacts]

    @cached_property
    def _L(self) -> list[Edges]:
        return [self.law.L_N(*edges, **self.constants) for edges in self.contacts]

    @cached_property
    def _first_order(self) -> Pair:
        """K_T/(f K_N), and half of what the contact has gained."""
        scale = np.pi * np.sqrt(self.h) * self.f
        left, right = (np.abs(v) / (scale * k) for v, k in zip(self.pulls, self._K[0], strict=True))
        return left + self.da / 2, right + self.dc / 2

    def _coefficients(self, order: int) -> list[tuple[list[Array], list[Array]]]:
        """K, L, ... at the left and the right edge, contact by contact."""
        found = []
        known = (self._K, self._L, self._third) if order > 2 else (self._K, self._L)
        for edges in zip(*known, strict=True):
            found.append(([edge.left for edge in edges], [edge.right for edge in edges]))
        return found

    @cached_property
    def _third(self) -> list[Edges]:
        if self.law.third is not None:
            return [Edges(*self.law.third(*edges, **self.constants)) for edges in self.contacts]
        return [
            Edges(*(self._by_differences(*edges, K[side], side) for side in (0, 1)))
            for edges, K in zip(self.contacts, self._K, strict=True)
        ]

    def _by_differences(self, a: Array, c: Array, K: Array, side: int) -> Array:
        h, place = a + c, (-a, c)[side]
        reach = h
        for bend in self.law.bends(self.constants):
            reach = np.minimum(reach, np.abs(place - bend))

        def rate(step: Array) -> Array:
            def rise(steps: int) -> Array:
                more, less = (
                    self.law.L_N(a + by * (side == 0), c + by * side, **self.constants)[side]
                    for by in (steps * step, -steps * step)
                )
                return more - less

            found = (8 * rise(1) - rise(2)) / (12 * step)
            return np.where(step > FINEST * np.abs(place), found, np.nan)

        rates = [rate(part * reach) for part in APART]
        apart = [np.abs(one - other) for one, other in pairwise(rates)]
        settled = ~(apart[1] < apart[0])  # a finer step shows rounding alone
        best = np.where(settled, rates[0], rates[2])
        return -0.4 * (best + K / (16 * h**2))

    def _solved(self, order: int) -> Pair:
        """Both conditions cut behind an order, by Newton's method from the first order."""
        coefficients, (left, right) = self._coefficients(order), self._first_order
        width = self.h - self.least_left - self.least_right
        gained = np.maximum(np.abs(self.da), np.abs(self.dc))
        left, right = self._beyond_gain(left, right)
        least = LEAST_SLIP * np.maximum(np.maximum(left, right), gained)
        left, right = drawn_in(width, np.maximum(left, least), np.maximum(right, least))
        shortest, idle = np.full(left.shape, np.inf), np.full(left.shape, 0)
        done = (left == 0) & (right == 0)  # nothing drives slip
        for _ in range(STEPS):
            to_left, to_right = _step(*self._conditions(coefficients, left, right))
            more = (to_left + to_right) / (width - left - right)
            by_left, by_right = to_left / left + more, to_right / right + more
            length = np.maximum(np.abs(by_left), np.abs(by_right))
            shrink = np.minimum(1, LONGEST / length)
            following = moved(width, left, right, shrink * by_left, shrink * by_right)
            left, right = (
                np.where(done, v, w) for v, w in zip((left, right), following, strict=True)
            )
            longest = np.maximum(np.maximum(left, right), gained)
            rounded = length < ROUNDING * longest / np.minimum(left, right)
            idle = np.where(length < shortest / 2, 0, idle + 1)
            shortest = np.fmin(length, shortest)
            done |= (length < SMALL) | (rounded & (idle >= IDLE))
            if np.all(done | ~np.isfinite(length)):
                break
        left, right = left + self.least_left, right + self.least_right
        return np.where(done, left, np.nan), np.where(done, right, np.nan)

    def _conditions(
        self, coefficients: Any, left: Array, right: Array
    ) -> tuple[list[Array], list[list[Array]]]:
        """What is left over at both ends of the stick zone; its rates with both slip zones.

        These are told without what the contact has gained.
        """
        stuck = self.h - self.least_left - self.least_right - left - right
        tension = np.pi * self.dsigma / 8
        off = [-pull for pull in pulls(self.dQ, self.dsigma, stuck)]
        rates = [[tension, tension], [-tension, -tension]]
        for i, j, kappa, sums in self._terms(coefficients, left, right, stuck):
            value, by_d, by_stuck = sums
            off[j] = off[j] + kappa * value
            rates[j][i] = rates[j][i] + kappa * (by_d - by_stuck)
            rates[j][1 - i] = rates[j][1 - i] - kappa * by_stuck
        return off, rates

    def _terms(
        self, coefficients: Any, left: Array, right: Array, stuck: Array, last: bool = False
    ) -> Iterator[tuple[int, int, Array, Sums]]:
        """What each slip zone i of each contact adds to the condition at either end j, over kappa.

        last: of the terms of the last order alone.
        """
        moves = [(self.least_left, self.least_right)]
        moves.append((self.least_left - self.da, self.least_right - self.dc))
        for pressures, gaps in zip(coefficients, moves, strict=False):
            zones = left + gaps[0], right + gaps[1]
            for i, (pressure, d) in enumerate(zip(pressures, zones, strict=True)):
                kappa = 2 / len(coefficients) * self._kappa[i]
                for j, rule in ((i, _near), (1 - i, _far)):
                    yield i, j, kappa, rule(pressure, d, stuck, last)


def _step(off: Sequence[Array], rates: Any) -> Pair:
    """By how much both slip zones have to change."""
    (left_l, left_r), (right_l, right_r) = rates
    determinant = left_l * right_r - left_r * right_l
    to_left = (left_r * off[1] - right_r * off[0]) / determinant
    return to_left, (right_l * off[0] - left_l * off[1]) / determinant


def _near(pressure: list[Array], d: Array, stuck: Array, last: bool = False) -> Sums:
    """At a slip zone's own end of the stick zone; all terms, or those of the last order."""
    return _summed(NEAR, pressure, d, stuck, len(pressure), 1, 0.5, last)


def _far(pressure: list[Array], d: Array, stuck: Array, last: bool = False) -> Sums:
    """At the other end."""
    return _summed(FAR, pressure, d, stuck, len(pressure) - 1, 2, -0.5, last)


def _summed(
    table: Any,
    pressure: list[Array],
    d: Array,
    stuck: Array,
    order: int,
    least: int,
    power: float,
    last: bool,
) -> Sums:
    value = by_d = by_stuck = 0.0 * d
    for i in range(order):
        for j in range(order - i - 1 if last else 0, order - i):
            exponent, falling = i + j + least, power - j
            term = np.pi * table[i][j] * pressure[i] * stuck**falling * d ** (exponent - 1)
            value = value + term * d
            by_d = by_d + exponent * term
            by_stuck = by_stuck + falling * term * d / stuck
    return value, by_d, by_stuck
