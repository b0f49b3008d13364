"""Named tuples of arrays that the generated functions return, with fields in a fixed order."""

from enum import IntEnum
from typing import Any, NamedTuple, TypeAlias

Array: TypeAlias = Any
"""A scalar or an array of any type that broadcasts; results are float64."""


class Contact(NamedTuple):
    """The contact [-a, c] and the tilt alpha of the body."""

    a: Array
    c: Array
    alpha: Array


class Edges(NamedTuple):
    """One value at the left edge x = -a and one at the right edge x = c."""

    left: Array
    right: Array


class Regime(IntEnum):
    """How a cycle slips.

    NONE        there is no such cycle, or one of its numbers is invalid: `why` gives the reason
    MODERATE    both edges slip in the same direction: m and n are exact
    LARGE       the edges slip in opposite directions: m and n are exact
    MIXED       slip reverses within a half-cycle, or one edge sticks: m and n are NaN, except
                under constant normal loads if forward slip finally overtakes the reversed slip, or
                if `mixed=True` makes stick_zone solve the cycle
    SLIDING     nothing sticks: m and n are NaN
    FULL_STICK  nothing slips: m and n are the smallest a and c of all contacts on the way
    UNSOLVED    the iteration did not converge, the tilts do not determine the edges, the phases of
                a mixed cycle were not found, or a contact rolled in from far away, so that its
                shear is not known: m and n are NaN
    OUT_OF_PHASE  the loads of a march are not in proportion at every instant, or turn within a
                half-cycle: NaN at all instants
    NOT_CLOSED  the instants of a march are those of a first loading: NaN at all instants
    COMPUTED    solved on elements, with an estimate of the error
    NO_STICK    every point slips at some time, although the contact never slides, because no stick
                zone can hold the mean shear load: m and n are NaN
    """

    NONE = 0
    MODERATE = 1
    LARGE = 2
    MIXED = 3
    SLIDING = 4
    FULL_STICK = 5
    UNSOLVED = 6
    OUT_OF_PHASE = 7
    NOT_CLOSED = 8
    COMPUTED = 9
    NO_STICK = 10


class StickZone(NamedTuple):
    """The zone [-m, n] that sticks throughout the cycle, and a code of Regime."""

    m: Array
    n: Array
    regime: Array


class Threshold(NamedTuple):
    """Lower and upper limits of the change in bulk tension between which tension is moderate."""

    lower: Array
    upper: Array


class March(NamedTuple):
    """A cycle instant by instant.

    a, c         the contact [-a, c]
    m, n         the zone [-m, n] that has not slipped since the last reversal of the loads
    left, right  direction of slip at each edge: +1 forward, -1 reverse, 0 none or not known
    regime       a code of Regime; where a series gives m and n, it follows from the signs of K_T
    """

    a: Array
    c: Array
    m: Array
    n: Array
    left: Array
    right: Array
    regime: Array


class History(NamedTuple):
    """A load history instant by instant.

    a, c       the contact [-a, c]
    m, n       [-m, n] spans all points that stick during the last change in the loads up to this
               instant, also while the loads rest; NaN where nothing sticks
    intervals  the number of stick intervals
    regime     a code of Regime: COMPUTED, or MODERATE where all results are exact; FULL_STICK,
               SLIDING, NONE, UNSOLVED
    q, slip    shear traction and accumulated forward slip at x, with one more axis than the other
               fields; None without x
    work       work dissipated by friction up to this instant
    error      the larger of the estimated errors of m and n, relative to the contact width, and
               of the shear traction, on average and relative to f P/(a + c); 0 where all results
               are exact
    work_error estimated error of work; its difference between two instants is the estimated error
               of the work done between them
    slip_error estimated error of slip, the largest wherever the bodies have been in contact, next
               to moving edges as a rule
    """

    a: Array
    c: Array
    m: Array
    n: Array
    intervals: Array
    regime: Array
    q: Array
    slip: Array
    work: Array
    error: Array
    work_error: Array
    slip_error: Array


class SteadyCycle(NamedTuple):
    """The steady cycle that a repeated load history settles to.

    m, n        the permanent stick zone [-m, n]
    regime      a code of Regime: that of stick_zone where m and n are exact, otherwise COMPUTED,
                NO_STICK, SLIDING, ...
    slip_range  the slip range in a cycle at x; None without x
    q           shear traction at x at the first instant; None without x
    work        work dissipated by friction in one cycle
    rounds      how many times the cycle was repeated
    drift       change in slip between the last two rounds, relative to the largest slip
    error       estimated error of m and n alone, relative to the contact width; 0 if they are
                exact, inf if slip does not repeat to 1e-6 within 100 rounds
    work_error  estimated error of work, which is always computed numerically
    slip_error  estimated error of the slip range, the largest in the smallest contact
    shear_error estimated error of q, on average over the contact, 2e-3 of f P/(a + c) as a rule
    """

    m: Array
    n: Array
    regime: Array
    slip_range: Array
    q: Array
    work: Array
    rounds: Array
    drift: Array
    error: Array
    work_error: Array
    slip_error: Array
    shear_error: Array


FEATURES, ZONE = len(History._fields) - 2, len(SteadyCycle._fields) - 2
"""Numbers of results besides those at the points, which are q and slip.  Kernels return them in the
order of the fields, those at the points last."""
