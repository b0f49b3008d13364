"""What the generated functions return: named tuples of arrays, fields in a fixed order."""

from enum import IntEnum
from typing import Any, NamedTuple, TypeAlias

Array: TypeAlias = Any
"""A scalar or an array of any kind that broadcasts; float64 comes out."""


class Contact(NamedTuple):
    """The contact [-a, c] and its tilt."""

    a: Array
    c: Array
    alpha: Array


class Edges(NamedTuple):
    """One value at the left edge x = -a and one at the right edge x = c."""

    left: Array
    right: Array


class Regime(IntEnum):
    """How a cycle slips.

    NONE        there is no such cycle, or one of its numbers is none: `why` says which
    MODERATE    forward slip at both edges: m and n are exact
    LARGE       slip of opposite signs at the edges: m and n are exact
    MIXED       slip reverses within a half-cycle, or one edge sticks: m and n are NaN, but exact
                for constant loads where forward slip overtakes it in the end, or where
                stick_zone is asked to solve these cycles, too
    SLIDING     nothing sticks: m and n are NaN
    FULL_STICK  nothing slips: m and n are those of the smaller contact
    UNSOLVED    the iteration did not end, or the phases of a mixed cycle were not found: NaN
    OUT_OF_PHASE  loads of a march that are not in proportion at every instant: NaN at all of them
    NOT_CLOSED  instants of a march that are no cycle: NaN at all of them
    COMPUTED    solved on elements, with an estimate of the error
    NO_STICK    every place slips some time in a cycle, which does not slide: m and n are NaN
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
    """What sticks all the time, [-m, n], and a code of Regime."""

    m: Array
    n: Array
    regime: Array


class Threshold(NamedTuple):
    """Changes of bulk tension between which tension is moderate."""

    lower: Array
    upper: Array


class March(NamedTuple):
    """A cycle instant by instant.

    a, c         the contact [-a, c]
    m, n         what has not slipped since the loads last turned, [-m, n]
    left, right  sense of slip at either edge: +1 forward, -1 in reverse, 0 none, or none known
    regime       a code of Regime; by the signs of K_T where m and n are those of a series
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
    m, n       the ends of all that sticks, [-m, n], in the motion that led here, at a rest, too;
               NaN where nothing does
    intervals  how many stick intervals there are
    regime     a code of Regime: COMPUTED, or MODERATE where all is exact; FULL_STICK, SLIDING,
               NONE, UNSOLVED
    q, slip    shear and forward slip so far at x, an axis more; None without x
    work       friction's, so far
    error      estimated: of the ends in parts of the width, of shear in its mean over f P/(a + c);
               0 where all is exact
    work_error estimated, of work; its difference between two instants is that of the work between
               them
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


class SteadyCycle(NamedTuple):
    """What a cycle settles to.

    m, n        the permanent stick zone [-m, n]
    regime      a code of Regime: an exact one of stick_zone's, COMPUTED, NO_STICK, SLIDING, ...
    slip_range  how far slip goes to and fro in a cycle at x; None without x
    q           shear at x at the first instant; None without x
    work        friction's in a cycle
    rounds      how often the cycle was repeated
    drift       change of slip from the last round but one to the last, over the most slip
    error       estimated, of m and n alone, in parts of the width; 0 where they are exact
    work_error  estimated, of work, which is computed always
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
