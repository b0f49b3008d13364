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

A cycle is a vector that begins with a1, c1, a2, c2, dQ, dsigma, f; for E* = 1.
"""

import math
from typing import Any

from ..kernels import LAW, kernel, real, results, truth, vector, whole
from .quadrature import FINEST, both_pressures, reaches, slip_zone

EXACT = 1e-12
"""Slip zones by two rules that agree to this are exact to rounding by the finer one."""

LAST = 100.0
"""The finest rule is far better than what it changes: it is taken if it changes so much more."""

SMALL = 1e-9
"""After a step below this, compared with the slip zone, the next one is below rounding,"""

ROUGH = 1e-7
"""or, by the coarsest rule, below what that is good for."""

STEPS = 40
"""Newton's steps at most for one rule; a solution takes two to eight."""

LONGEST = 2.0
"""Longest of Newton's steps in the logarithm of a slip zone over the stick zone."""

SHORTEST = 1e-3
"""A step that leads away even if it is cut down to this part is given up."""

NEGATIVE = -1e3
"""A step that asks for so negative a slip zone, in parts of its own, shows that there is none,"""

NARROW = 1e-3
"""if the zone is that much smaller than the square of the other one over the width."""

TURNS = 40
"""How often each slip zone is solved for by itself, where Newton's method for both fails."""

SMALLEST = 1e-12
"""Both zones rest when a turn changes them by less, in parts of their own."""

MET = 1e-7
"""Both conditions are met if they are off by less, in parts of what they ask for."""

LEAST_SLIP = 1e-14
"""Smallest slip zone to start from, in parts of the width."""

LEAST_STUCK = 1e-3
"""No narrower stick zone is sought, in parts of the width at which slip would reverse."""

NEAREST = 1e-9
"""Closer to the stick zone, in parts of a slip zone, finite parts are left to their limit."""

HALVINGS = 100
"""Steps at most to find one slip zone by itself."""

EPS = 2.0**-52


@kernel(results(2)(real, real, real))
def pulls(dQ: float, dsigma: float, stuck: float) -> Any:
    """By how much shear and tension drive slip at both ends of what is stuck, its width given."""
    by_tension = math.pi * stuck * dsigma / 8
    return dQ + by_tension, dQ - by_tension


@kernel(real(vector))
def common_width(cycle: Any) -> Any:
    """Of what is in contact all the time."""
    return min(cycle[0], cycle[2]) + min(cycle[1], cycle[3])


@kernel(results(4)(LAW, vector, vector, real, real, real, whole))
def integrals(
    law: Any, own: Any, cycle: Any, side: float, slip: float, stuck: float, level: int
) -> Any:
    """Integrals of p1 + p2 over one slip zone, y its distance from the stick zone.

    near    int p sqrt((h_s + y)/y) dy
    far     int p sqrt(y/(h_s + y)) dy
    along   finite part of int p/(y**(3/2) (h_s + y)**(1/2)) dy
    across  int p/(y**(1/2) (h_s + y)**(3/2)) dy
    """
    smaller, larger = reaches(cycle, side)
    length = slip + (larger - smaller)
    at_start = both_pressures(law, own, cycle, side * (smaller - slip)) / math.sqrt(stuck)
    near, far, across, along = 0.0, 0.0, 0.0, -2 * at_start / math.sqrt(length)
    zone = slip_zone(law, own, cycle, side, slip, level)
    for i in range(zone.shape[1]):
        y, weight, p = zone[0, i], zone[1, i], zone[2, i]
        beyond = stuck + y
        force = weight * p / math.sqrt(y * beyond)
        near += force * beyond
        far += force * y
        across += force / beyond
        if y > NEAREST * length:
            along += (force - weight * at_start / math.sqrt(y)) / y
    return near, far, along, across


@kernel(results(5)(LAW, vector, vector, real, real, whole))
def _conditions(law: Any, own: Any, cycle: Any, left: float, right: float, level: int) -> Any:
    """What is left over of both conditions at slip zones of these lengths, and its rates.

    The left and the right condition; half their difference over the width of the stick zone, the
    rate of the right one with m; the rate of the right one with n; that of the left one with m.
    """
    stuck = common_width(cycle) - left - right
    kappa = -cycle[6] if cycle[5] < 0 else cycle[6]
    near_l, far_l, along_l, across_l = integrals(law, own, cycle, -1.0, left, stuck, level)
    near_r, far_r, along_r, across_r = integrals(law, own, cycle, 1.0, right, stuck, level)
    pull_left, pull_right = pulls(cycle[4], cycle[5], stuck)
    off_left = kappa * (near_l - far_r) - pull_left
    off_right = kappa * (far_l - near_r) - pull_right
    skew = (off_right - off_left) / (2 * stuck)
    right_n = skew + stuck * kappa * (across_l - along_r) / 2
    left_m = -skew + stuck * kappa * (along_l - across_r) / 2
    return off_left, off_right, skew, right_n, left_m


@kernel(results(3)(LAW, vector, vector, real, real, whole))
def _step(law: Any, own: Any, cycle: Any, left: float, right: float, level: int) -> Any:
    """Newton's step in the logarithms of both slip zones over the stick zone, and the miss."""
    off_left, off_right, skew, right_n, left_m = _conditions(law, own, cycle, left, right, level)
    miss = off_left * off_left + off_right * off_right
    determinant = right_n * left_m + skew * skew
    if determinant == 0:
        return math.nan, math.nan, miss
    left_grows = (off_left * right_n + skew * off_right) / determinant
    right_grows = (off_right * left_m - skew * off_left) / determinant
    rate = (left_grows + right_grows) / (common_width(cycle) - left - right)
    return left_grows / left + rate, right_grows / right + rate, miss


@kernel(results(2)(real, real, real, real, real))
def _moved(width: float, left: float, right: float, by_left: float, by_right: float) -> Any:
    """Slip zones whose logarithms over the stick zone have grown."""
    stuck = width - left - right
    left, right = left * math.exp(by_left), right * math.exp(by_right)
    shrink = width / (stuck + left + right)
    return left * shrink, right * shrink


@kernel(real(vector, real, real))
def _reverses(cycle: Any, left: float, right: float) -> Any:
    """Whether the stick zone is so narrow that slip has long reversed."""
    stuck = common_width(cycle) - left - right
    return math.pi * stuck * abs(cycle[5]) / 8 < LEAST_STUCK * cycle[4]


@kernel(truth(real, real, real, real, real))
def _vanishes(left: float, right: float, by_left: float, by_right: float, width: float) -> Any:
    """Whether one slip zone would be negative: slip has reversed there.

    Where it has not, pull <= 0 on the right, say, far of the left zone is less than near of the
    right one, and d_right > d_left**2/(4 h), about.
    """
    if by_right < by_left:
        left, right, by_left, by_right = right, left, by_right, by_left
    return by_left < NEGATIVE and by_right < LONGEST and left * width < NARROW * right * right


@kernel(results(2)(LAW, vector, vector, real, real, whole))
def _by_newton(law: Any, own: Any, cycle: Any, left: float, right: float, level: int) -> Any:
    """The slip zones by Newton's method; infinite where none stick, NaN where it does not end.

    If a step leads away from the solution, a quarter of it is tried.
    """
    width, small = common_width(cycle), ROUGH if level == 0 else SMALL
    part, best, to_left, to_right = 1.0, math.inf, 0.0, 0.0
    for _ in range(STEPS):
        tried_left, tried_right = _moved(width, left, right, part * to_left, part * to_right)
        stuck = width - tried_left - tried_right
        if not min(tried_left, tried_right, stuck) > 0:
            return math.nan, math.nan
        if _reverses(cycle, tried_left, tried_right):
            return math.inf, math.inf
        by_left, by_right, miss = _step(law, own, cycle, tried_left, tried_right, level)
        if _vanishes(tried_left, tried_right, by_left, by_right, width):
            return math.inf, math.inf
        if miss < best:
            left, right, best, part = tried_left, tried_right, miss, 1.0
            length = max(abs(by_left), abs(by_right))
            if not length < math.inf:
                return math.nan, math.nan
            shrink = min(1.0, LONGEST / length) if length > 0 else 1.0
            to_left, to_right = by_left * shrink, by_right * shrink
            if length < max(small, 16 * EPS * width / min(left, right, stuck)):
                return _moved(width, left, right, to_left, to_right)
        else:
            part /= 4
            if part < SHORTEST or best == math.inf:
                break
    return math.nan, math.nan


@kernel(real(LAW, vector, vector, real, real, whole))
def _by_itself(law: Any, own: Any, cycle: Any, side: float, other: float, level: int) -> Any:
    """One slip zone from its own condition while the other one rests.

    What is left over grows with the zone.  Newton's step is taken where it stays inside the
    bracket and at most halves the step before, else the middle.
    """
    width = common_width(cycle)
    low, high = LEAST_SLIP * width, width * (1 - LEAST_SLIP) - other
    if not low < high:
        return math.nan
    sense = -1.0 if cycle[5] < 0 else 1.0
    slip, before = (low + high) / 2, high - low
    for _ in range(HALVINGS):
        if side < 0:
            found = _conditions(law, own, cycle, slip, other, level)
            value, rate = sense * found[0], -sense * found[4]
        else:
            found = _conditions(law, own, cycle, other, slip, level)
            value, rate = -sense * found[1], sense * found[3]
        if value < 0:
            low = slip
        else:
            high = slip
        step = -value / rate if rate > 0 else math.inf
        if not (low < slip + step < high and abs(step) < before / 2):
            step = (low + high) / 2 - slip
        slip, before = slip + step, abs(step)
        if before <= 2 * EPS * slip:
            break
    return slip


@kernel(results(2)(LAW, vector, vector, whole))
def _by_turns(law: Any, own: Any, cycle: Any, level: int) -> Any:
    """Each slip zone from its own condition while the other one rests, turn by turn.

    Infinite where both conditions are met nowhere inside both contacts.
    """
    width, rests = common_width(cycle), False
    left = right = width / 4
    for _ in range(TURNS):
        last_left, last_right = left, right
        left = _by_itself(law, own, cycle, -1.0, right, level)
        right = _by_itself(law, own, cycle, 1.0, left, level)
        stuck = width - left - right
        if not stuck > 0:
            return math.nan, math.nan
        if _reverses(cycle, left, right):
            return math.inf, math.inf
        least = SMALLEST * min(left, right, stuck) + 16 * EPS * width
        rests = abs(left - last_left) < least and abs(right - last_right) < least
        if rests:
            break
    _, _, miss = _step(law, own, cycle, left, right, level)
    scale = cycle[4] + math.pi * (width - left - right) * abs(cycle[5]) / 8
    if miss <= (MET * scale) ** 2:
        return left, right
    return (math.inf, math.inf) if rests and miss >= 0 else (math.nan, math.nan)


@kernel(results(2)(LAW, vector, vector))
def first_guess(law: Any, own: Any, cycle: Any) -> Any:
    """Slip zones K_T/(f K_N), drawn in so that they leave some stick between them."""
    h = (cycle[0] + cycle[1] + cycle[2] + cycle[3]) / 2
    _, _, _, left_1, right_1 = law.state(cycle[0], cycle[1], own)
    _, _, _, left_2, right_2 = law.state(cycle[2], cycle[3], own)
    width, friction = common_width(cycle), math.pi * math.sqrt(h) * cycle[6] / 2
    left, right = pulls(cycle[4], cycle[5], h)
    left = max(abs(left) / (friction * (left_1 + left_2)), LEAST_SLIP * width)
    right = max(abs(right) / (friction * (right_1 + right_2)), LEAST_SLIP * width)
    shrink = width / (width + left + right)
    return left * shrink, right * shrink


@kernel(results(2)(LAW, vector, vector, real))
def large_slip(law: Any, own: Any, cycle: Any, agreed: float) -> Any:
    """Lengths of both slip zones inside both contacts.

    Infinite where nothing sticks between such slip zones; NaN where they are not found.
    agreed: zones by two rules that agree to this, in parts of their own, are taken: EXACT or more.
    """
    guess_left, guess_right = first_guess(law, own, cycle)
    if not (guess_left > 0 and guess_right > 0):
        return math.nan, math.nan
    left, right = guess_left, guess_right
    last_left = last_right = math.nan
    rounding = 16 * EPS * common_width(cycle)
    for level in range(FINEST + 1):
        left, right = _by_newton(law, own, cycle, left, right, level)
        if math.isnan(left):
            left, right = _by_turns(law, own, cycle, level)
        if left == math.inf and last_left == math.inf:
            return left, right
        off_left, off_right = abs(left - last_left), abs(right - last_right)
        known = left < math.inf
        nearly = agreed if level < FINEST else LAST * agreed
        if (
            known
            and off_left <= nearly * left + rounding
            and off_right <= nearly * right + rounding
        ):
            return left, right
        last_left, last_right = left, right
        if not known:
            left, right = guess_left, guess_right
    return math.nan, math.nan
