r"""The stick zone between slip zones of opposite signs.

Slip leaves r = kappa f (p1 + p2), kappa of opposite signs on the left and on the right.  The change
of shear is bounded at both ends of the stick zone [-m, n], h_s = m + n, if

    right = int r sqrt((xi + m)/(xi - n)) dxi - dQ + pi dsigma h_s/8 = 0,
    left  = int r sqrt((xi - n)/(xi + m)) dxi - dQ - pi dsigma h_s/8 = 0,

over both slip zones.  With w = sqrt((xi + m)(xi - n)), negative on the left, C_n and C_m the finite
parts of int r/(w (xi - n)) dxi and int r/(w (xi + m)) dxi, and F = (right - left)/h_s,

    d right/dn =  F/2 + h_s C_n/2,    d right/dm =  F/2,
    d left/dn  = -F/2,                d left/dm  = -F/2 + h_s C_m/2.

Next to the solution F vanishes and each end is sought by itself.  The unknowns of Newton's method
are the logarithms of both slip zones over the stick zone, so that all three stay positive.

Inside, dq is an integral of r over the slip zones, `bounded_change`, or `solved_change`.

Each slip zone is cut where a contact ends and at the body's kinks; on each part the nodes of the
double exponential rule crowd towards both ends.  The step is halved until the solution stays.
"""

from collections.abc import Callable, Iterator
from functools import cache
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from ._arrays import Array
from ._roots import increasing_root

COARSEST, FINEST = 2, 6
"""Steps of the rule are 2**-COARSEST at first and 2**-FINEST at last."""

REACH = 4
"""How far the rule goes: to 1e-37 of a part."""

AGREED = 1e-12
"""Slip zones of two rules that agree to this are exact to rounding by the finer one."""

SMALL = 1e-10
"""After a step below this, compared with the slip zone, the next one is below rounding."""

STEPS = 40
"""Newton's steps at most for one rule; a solution takes two to eight."""

LONGEST = 2.0
"""Longest of Newton's steps in the logarithm of a slip zone over the stick zone."""

SHORTEST = 1e-3
"""A step that leads away even if it is cut down to this part is given up."""

TURNS = 40
"""How often each slip zone is solved for by itself, where Newton's method for both fails."""

SMALLEST = 1e-12
"""Both zones rest when a turn changes them by less, in parts of their own."""

MET = 1e-7
"""Both conditions are met if they are off by less, in parts of what they ask for."""

TOGETHER = 2_000
"""Elements that are solved in one piece."""

LEAST_SLIP = 1e-14
"""Smallest slip zone to start from, in parts of the width."""

_NEAREST = 1e-9
"""Closer to the stick zone, in parts of a slip zone, finite parts are left to their limit."""

_EPS = 2.0**-52

Pressure = Callable[[Array, int, Array], Array]
"""The pressure at x in the first or second contact (0 or 1) of some elements."""

Pair = tuple[Array, Array]

Kinks = Callable[[Array], tuple[Array, ...]]
"""Places of the kinks of some elements."""


class Task(NamedTuple):
    """Cycles whose stick zones are sought.

    a, c         edges of both contacts, two rows
    dQ, dsigma   changes of shear and tension
    rows         numbers of the cycles, by which pressure and kinks know them
    """

    a: Array
    c: Array
    dQ: Array
    dsigma: Array
    f: Array
    rows: Array
    pressure: Pressure
    kinks: Kinks

    def on(self, rows: Array) -> "Task":
        """Some of them."""
        arrays = ("a", "c", "dQ", "dsigma", "f", "rows")
        return self._replace(**{name: getattr(self, name)[..., rows] for name in arrays})

    @property
    def smaller_a(self) -> Array:
        """a of the contact that reaches less far to the left."""
        return np.min(self.a, axis=0)

    @property
    def smaller_c(self) -> Array:
        """c of the contact that reaches less far to the right."""
        return np.min(self.c, axis=0)

    @property
    def width(self) -> Array:
        """Of what is in contact all the time."""
        return self.smaller_a + self.smaller_c

    @property
    def sense(self) -> Array:
        """kappa on the left; that on the right is its opposite."""
        return np.where(self.dsigma < 0, -1.0, 1.0)

    @property
    def least_stuck(self) -> Array:
        """Far below the width at which slip would reverse: no narrower zone is sought."""
        return 1e-3 * 8 * self.dQ / (np.pi * np.abs(self.dsigma))

    def slip_zone(self, side: int, slip: Array) -> tuple[Array, Array]:
        """Where a slip zone starts, and how long it is in the larger contact."""
        edges = self.c if side > 0 else self.a
        smaller, larger = np.min(edges, axis=0), np.max(edges, axis=0)
        return smaller - slip, slip + (larger - smaller)

    def cuts(self, side: int, slip: Array) -> list[Array]:
        """Where the smaller contact ends, and the kinks, as distances from the stick zone."""
        start, _ = self.slip_zone(side, slip)
        return [slip, *(side * place - start for place in self.kinks(self.rows))]

    @property
    def by_kinks(self) -> Array:
        """An order in which those whose kinks lie alike, and cost alike, are neighbours."""
        nearest = np.full(self.dQ.shape, np.inf)
        for place in self.kinks(self.rows):
            inside = np.minimum(self.smaller_a + place, self.smaller_c - place)
            nearest = np.where(inside > 0, np.minimum(nearest, inside / self.width), nearest)
        return np.argsort(nearest, kind="stable")

    @property
    def alike(self) -> Array:
        """Whether the contact is the same at both ends of the cycle."""
        return (self.a[0] == self.a[1]) & (self.c[0] == self.c[1])

    def sum_of_pressures(self, x: Array) -> Array:
        """p1 + p2; at a kink, where it may be infinite, nothing."""
        total = self.pressure(x, 0, self.rows)
        total = 2 * total if np.all(self.alike) else total + self.pressure(x, 1, self.rows)
        return np.where(total == np.inf, 0.0, total)


def turning_place(dQ: Array, dsigma: Array, m: Array, n: Array) -> Array:
    """Where the rate at which shear comes in changes its sign, while [-m, n] sticks."""
    return (n - m) / 2 + 4 * dQ / (np.pi * dsigma)


def pulls(dQ: Array, dsigma: Array, stuck: Array) -> Pair:
    """By how much shear and tension drive slip at both ends of what is stuck, its width given."""
    by_tension = np.pi * stuck * dsigma / 8
    return dQ + by_tension, dQ - by_tension


def stick_between(task: Task, K_left: Array, K_right: Array) -> Pair:
    """m and n, NaN where the iteration does not end, infinite where there are none.

    K_left, K_right: means of both contacts' edge coefficients, to start from.
    """
    left, right = _first_guess(task, K_left, K_right)
    found_left, found_right = np.full(left.shape, np.nan), np.full(left.shape, np.nan)
    rows = task.rows
    for level in range(COARSEST, FINEST + 1):
        here, last_left, last_right = task.on(rows), left, right
        left, right = _by_onerule(here, left, right, level)
        rounding = 16 * _EPS * here.width
        agreed = np.abs(left - last_left) <= AGREED * left + rounding
        agreed &= np.abs(right - last_right) <= AGREED * right + rounding
        agreed &= level > COARSEST
        agreed |= here.width - left - right < here.least_stuck  # or infinite slip zones
        found_left[rows[agreed]], found_right[rows[agreed]] = left[agreed], right[agreed]
        on = ~agreed & np.isfinite(left) & np.isfinite(right)
        rows, left, right = rows[on], left[on], right[on]
        if not rows.size:
            break
    return task.smaller_a - found_left, task.smaller_c - found_right


def _first_guess(task: Task, K_left: Array, K_right: Array) -> tuple[Array, Array]:
    """Slip zones K_T/(f K_N), drawn in so that they leave some stick between them."""
    h = np.mean(task.a + task.c, axis=0)
    left, right = (
        np.maximum(np.abs(pull) / (np.pi * np.sqrt(h) * task.f * K), LEAST_SLIP * task.width)
        for pull, K in zip(pulls(task.dQ, task.dsigma, h), (K_left, K_right), strict=True)
    )
    return drawn_in(task.width, left, right)


def drawn_in(width: Array, left: Array, right: Array) -> Pair:
    """Slip zones cut down in proportion, so that they leave some stick between them."""
    shrink = width / (width + left + right)
    return left * shrink, right * shrink


def _by_onerule(task: Task, left: Array, right: Array, level: int) -> Pair:
    """The slip zones by one rule: by Newton's method, else in turns; NaN if by neither."""
    left, right, order = left.copy(), right.copy(), task.by_kinks
    for start in range(0, left.size, TOGETHER):
        rows = order[start : start + TOGETHER]
        left[rows], right[rows] = by_newton(task.on(rows), left[rows], right[rows], level)
    lost = np.flatnonzero(~np.isfinite(left))
    for start in range(0, lost.size, TOGETHER):
        rows = lost[start : start + TOGETHER]
        left[rows], right[rows] = _by_turns(task.on(rows), level)
    return left, right


def by_newton(task: Task, left: Array, right: Array, level: int) -> Pair:
    """The slip zones by Newton's method; NaN where the iteration does not end.

    A step is taken from `left` and `right` along `to_left` and `to_right`, rates of the logarithms
    of both over the stick zone.  If it leads away from the solution, a quarter of it is tried.
    """
    found_left, found_right = np.full(left.shape, np.nan), np.full(left.shape, np.nan)
    rows = np.arange(left.size)
    to_left = to_right = np.zeros(rows.size)
    part, best = np.ones(rows.size), np.full(rows.size, np.inf)
    for _ in range(STEPS):
        here = task.on(rows)
        tried = moved(here.width, left, right, part * to_left, part * to_right)
        now = _conditions(here, *tried, level)
        miss, (by_left, by_right) = now.miss, now.step(*tried)
        shrink = np.minimum(1, LONGEST / np.maximum(np.abs(by_left), np.abs(by_right)))

        better = miss < best
        left, right = np.where(better, tried[0], left), np.where(better, tried[1], right)
        to_left = np.where(better, by_left * shrink, to_left)
        to_right = np.where(better, by_right * shrink, to_right)
        part = np.where(better, 1.0, part / 4)
        best = np.where(better, miss, best)

        stuck = here.width - left - right
        rounding = 16 * _EPS * here.width / np.minimum(np.minimum(left, right), stuck)
        length = np.maximum(np.abs(to_left), np.abs(to_right))
        done = better & (length < np.maximum(SMALL, rounding))
        lost = stuck < here.least_stuck
        done, ahead = done | lost, np.where(lost, 0.0, 1.0)
        last = moved(here.width, left, right, ahead * to_left, ahead * to_right)
        found_left[rows[done]], found_right[rows[done]] = last[0][done], last[1][done]
        on = ~done & (best < np.inf) & (part > SHORTEST)
        rows, left, right, to_left, to_right, part, best = (
            v[on] for v in (rows, left, right, to_left, to_right, part, best)
        )
        if not rows.size:
            break
    return found_left, found_right


def moved(width: Array, left: Array, right: Array, by_left: Array, by_right: Array) -> Pair:
    """Slip zones whose logarithms over the stick zone have grown."""
    stuck = width - left - right
    over_left, over_right = left / stuck * np.exp(by_left), right / stuck * np.exp(by_right)
    whole = 1 + over_left + over_right
    return width * over_left / whole, width * over_right / whole


def _by_turns(task: Task, level: int) -> Pair:
    """Each slip zone from its own condition while the other one rests, turn by turn.

    Infinite where both conditions are met nowhere inside both contacts.
    """
    width = task.width
    found_left, found_right = np.full(width.shape, np.nan), np.full(width.shape, np.nan)
    rows, left, right = np.arange(width.size), width / 4, width / 4
    for _ in range(TURNS):
        here = task.on(rows)
        last_left, last_right = left, right

        def off_left(slip: Array, some: Array) -> Pair:
            now = _conditions(here.on(some), slip, right[some], level)  # noqa: B023
            return now.sense * now.off_left, -now.sense * now.left_m

        def off_right(slip: Array, some: Array) -> Pair:
            now = _conditions(here.on(some), left[some], slip, level)  # noqa: B023
            return -now.sense * now.off_right, now.sense * now.right_n

        least = LEAST_SLIP * here.width
        left = increasing_root(off_left, least, here.width - right - least)
        right = increasing_root(off_right, least, here.width - left - least)
        stuck = here.width - left - right
        rounding = 16 * _EPS * here.width
        done = np.abs(left - last_left) < SMALLEST * np.minimum(left, stuck) + rounding
        done &= np.abs(right - last_right) < SMALLEST * np.minimum(right, stuck) + rounding
        done |= stuck < here.least_stuck
        found_left[rows[done]], found_right[rows[done]] = left[done], right[done]
        on = ~done & np.isfinite(stuck)
        rows, left, right = rows[on], left[on], right[on]
        if not rows.size:
            break
    now = _conditions(task, found_left, found_right, level)
    scale = task.dQ + np.pi * now.stuck * np.abs(task.dsigma) / 8
    met = (now.miss <= (MET * scale) ** 2) | (now.stuck < task.least_stuck)
    nowhere = np.where(np.isnan(now.miss), np.nan, np.inf)
    return np.where(met, found_left, nowhere), np.where(met, found_right, nowhere)


class _Conditions(NamedTuple):
    """What is left over of both conditions, and its rates.

    skew     half of the difference over the width of the stick zone
    right_n  rate of the right condition with n; that with m is `skew`
    left_m   rate of the left condition with m; that with n is -`skew`
    """

    sense: Array
    stuck: Array
    off_left: Array
    off_right: Array
    skew: Array
    right_n: Array
    left_m: Array

    @property
    def miss(self) -> Array:
        """How far off both are."""
        return self.off_left**2 + self.off_right**2

    def step(self, left: Array, right: Array) -> Pair:
        """Newton's step of both slip zones, in the logarithms of each over the stick zone."""
        determinant = self.right_n * self.left_m + self.skew**2
        right_grows = (self.off_right * self.left_m - self.skew * self.off_left) / determinant
        left_grows = (self.off_left * self.right_n + self.skew * self.off_right) / determinant
        rate = (left_grows + right_grows) / self.stuck
        return left_grows / left + rate, right_grows / right + rate


def _conditions(task: Task, left: Array, right: Array, level: int) -> _Conditions:
    """Both conditions at slip zones of these lengths."""
    stuck = task.width - left - right
    at_left = integrals(task, -1, left, stuck, level)
    at_right = integrals(task, 1, right, stuck, level)
    kappa = task.sense * task.f
    pull_left, pull_right = pulls(task.dQ, task.dsigma, stuck)
    off_left = kappa * (at_left.near - at_right.far) - pull_left
    off_right = kappa * (at_left.far - at_right.near) - pull_right
    skew = (off_right - off_left) / (2 * stuck)
    right_n = skew + stuck * kappa * (at_left.across - at_right.along) / 2
    left_m = -skew + stuck * kappa * (at_left.along - at_right.across) / 2
    return _Conditions(task.sense, stuck, off_left, off_right, skew, right_n, left_m)


class Zone(NamedTuple):
    """Integrals of p1 + p2 over one slip zone, y its distance from the stick zone.

    near    int p sqrt((h_s + y)/y) dy
    far     int p sqrt(y/(h_s + y)) dy
    along   finite part of int p/(y**(3/2) (h_s + y)**(1/2)) dy
    across  int p/(y**(1/2) (h_s + y)**(3/2)) dy
    """

    near: Array
    far: Array
    along: Array
    across: Array


def integrals(task: Task, side: int, slip: Array, stuck: Array, level: int) -> Zone:
    """The integrals over the slip zone on the left (side -1) or on the right (+1)."""
    start, end = task.slip_zone(side, slip)
    at_start = task.sum_of_pressures(side * start) / np.sqrt(stuck)
    near, far, across = np.zeros((3, *stuck.shape))
    along = -2 * at_start / np.sqrt(end)
    for low, high in _spans(end, task.cuts(side, slip)):
        rows = np.flatnonzero(high > low)
        if not rows.size:
            continue
        y, weight = _nodes(low[rows], high[rows], level)
        part = weight * task.on(rows).sum_of_pressures(side * (start[rows] + y))
        beyond = stuck[rows] + y
        near[rows] += np.sum(part * np.sqrt(beyond / y), axis=0)
        far[rows] += np.sum(part * np.sqrt(y / beyond), axis=0)
        across[rows] += np.sum(part / (beyond * np.sqrt(beyond * y)), axis=0)
        change = part / np.sqrt(beyond) - weight * at_start[rows]
        far_off = y > _NEAREST * end[rows]
        along[rows] += np.sum(np.where(far_off, change / (y * np.sqrt(y)), 0.0), axis=0)
    return Zone(near, far, along, across)


def bounded_change(task: Task, m: Array, n: Array, x: Array, level: int) -> Array:
    """dq at x in the stick zone [-m, n]:  sqrt((x + m)(n - x))/pi int r/(w (xi - x)) dxi.

    x: a place of each element, or a column of them.
    """
    total = 0.0
    for side, away in ((-1, m + x), (1, n - x)):
        for y, force in _forces(task, side, m, n, level):
            total = total - side * np.sum(force / (y + away[..., None, :]), axis=-2)
    return task.sense * task.f * np.sqrt((x + m) * (n - x)) / np.pi * total


def solved_change(task: Task, m: Array, n: Array, x: Array, level: int) -> Array:
    """The same where m and n meet both conditions, to the last digits however short a slip zone is.

    The place of a short one is all rounding, and so are its integrals.  Seen from afar it counts
    by int p/|w| dy alone, which the conditions tell from the changes of shear and tension.
    """
    left, right = (_drawn(task, side, m, n, x, level) for side in (-1, 1))
    kappa, stuck, skew = task.sense * task.f, m + n, left.far - right.far
    found, pulled = [], pulls(task.dQ, task.dsigma, stuck)
    for side, zone, pull in zip((-1, 1), (left, right), pulled, strict=True):
        driven = -side * pull / kappa
        force = (driven + side * skew) / stuck
        short = (left.far + right.far < driven / 2) & (zone.beyond < force / 2)
        found.append(np.where(short, (force - zone.beyond) / zone.away, zone.whole))
    return kappa * np.sqrt((x + m) * (n - x)) / np.pi * (found[0] - found[1])


class _Drawn(NamedTuple):
    """Integrals of p1 + p2 over one slip zone, as x in the stick zone feels it.

    away    distance of x from the slip zone
    whole   int p/(|w| (y + away)) dy
    beyond  int p y/(|w| (y + away)) dy
    far     int p y/|w| dy
    """

    away: Array
    whole: Array
    beyond: Array
    far: Array


def _drawn(task: Task, side: int, m: Array, n: Array, x: Array, level: int) -> _Drawn:
    """The integrals over the slip zone on the left (side -1) or on the right (+1)."""
    away = n - x if side > 0 else m + x
    whole = beyond = far = 0.0
    for y, force in _forces(task, side, m, n, level):
        felt = force / (y + away[..., None, :])
        whole, beyond = whole + np.sum(felt, axis=-2), beyond + np.sum(felt * y, axis=-2)
        far = far + np.sum(force * y, axis=-2)
    return _Drawn(away, whole, beyond, far)


def _forces(task: Task, side: int, m: Array, n: Array, level: int) -> Iterator[tuple[Array, Array]]:
    """Distances y from the stick zone, as columns, and (p1 + p2)/|w| dy there, part by part."""
    slip = task.smaller_c - n if side > 0 else task.smaller_a - m
    start, length = task.slip_zone(side, slip)
    for y, weight in parts_of(length, task.cuts(side, slip), level):
        p = task.sum_of_pressures(side * (start + y))
        yield y, weight * p / np.sqrt(y * (y + m + n))


def force_rates(slip: Array, stuck: Array, h: Array, own: Array, other: Array) -> Pair:
    """int dp sqrt((stuck + y)/y) dy and int dp sqrt(y/(stuck + y)) dy over one slip zone.

    dp = (own (h - s) + other s)/(pi h sqrt(s (h - s))) as the loads go on, s the distance from the
    zone's edge; `own` and `other` say how fast this edge and the other one are driven.
    """
    q, weight = rule(FINEST - 1)
    y, s = slip * q, slip * q[::-1]
    dp = (own * (h - s) + other * s) / (np.pi * h * np.sqrt(s * (h - s)))
    force = weight * slip * dp
    near = np.sum(force * np.sqrt((stuck + y) / y), axis=0)
    return near, np.sum(force * np.sqrt(y / (stuck + y)), axis=0)


def parts_of(end: Array, cuts: list[Array], level: int) -> Iterator[tuple[Array, Array]]:
    """Nodes, as columns, and weights of the rule on (0, end), part by part between the cuts.

    Where a part is empty, its nodes lie at the end and weigh nothing.
    """
    for low, high in _spans(end, cuts):
        if np.any(high > low):
            y, weight = _nodes(low, high, level)
            yield np.where(high > low, y, end), weight


def _spans(end: Array, cuts: list[Array]) -> Iterator[tuple[Array, Array]]:
    """The parts of (0, end) between the cuts, one after the other; some may be empty."""
    inside = [np.clip(cut, 0, end) for cut in cuts]
    yield from pairwise(np.sort(np.stack([0 * end, *inside, end]), axis=0))


def _nodes(low: Array, high: Array, level: int) -> tuple[Array, Array]:
    """Nodes, as columns, and weights of the rule between two places."""
    q, weight = rule(level)
    return low + (high - low) * q, weight * (high - low)


@cache
def rule(level: int) -> tuple[Array, Array]:
    """Nodes q and weights on (0, 1) as columns: q = 1/(1 + exp(-pi sinh t))."""
    step = 2.0**-level
    count = int(REACH / step)
    t = step * np.arange(-count, count + 1)[:, None]
    q, rest = (1 / (1 + np.exp(sign * np.pi * np.sinh(t))) for sign in (-1, 1))
    return q, step * np.pi * np.cosh(t) * q * rest
