"""Named tuples of arrays that the generated functions return, with fields in a fixed order."""

from collections.abc import Sequence
from enum import IntEnum
from typing import Any, NamedTuple, Protocol, TypeAlias


class ArrayOfNumbers(Protocol):
    """An array of NumPy or Dask, or anything that NumPy can turn into one."""

    def __array__(self) -> Any:
        """The array of NumPy."""


Values: TypeAlias = float | Sequence[Any] | ArrayOfNumbers
"""What arguments accept: a real number, or a list or array of them."""

Array: TypeAlias = Any
"""What results are: a float64 number or array, or a Dask array if an argument was one."""


class Contact(NamedTuple):
    """The contact [-a, c] and the tilt alpha of the body.

    Attributes
    ----------
    a, c : ndarray
        Edges of the contact at x = -a and x = c [m].
    alpha : ndarray
        Tilt, positive anticlockwise [rad].
    """

    a: Array
    c: Array
    alpha: Array


class Edges(NamedTuple):
    """One value at the left edge x = -a and one at the right edge x = c.

    Attributes
    ----------
    left, right : ndarray
        The values, in the unit that the function states.
    """

    left: Array
    right: Array


class Regime(IntEnum):
    """How a cycle slips.

    Attributes
    ----------
    NONE : 0
        There is no such cycle, or one of its numbers is invalid: `why` gives the reason.
    MODERATE : 1
        Both edges slip in the same direction: m and n are exact.
    LARGE : 2
        The edges slip in opposite directions: m and n are exact.
    MIXED : 3
        Slip reverses within a half-cycle, or one edge sticks: m and n are NaN, except under
        constant normal loads if forward slip eventually covers the zone of reversed slip, or if
        `mixed=True` makes stick_zone solve the cycle.
    SLIDING : 4
        Nothing sticks: m and n are NaN.
    FULL_STICK : 5
        Nothing slips: m and n are the smallest a and c during the half-cycle.
    UNSOLVED : 6
        The iteration did not converge, the tilts do not determine the edges, the phases of a mixed
        cycle were not found, or the contact approached from a great distance, so that its shear is
        not known: m and n are NaN.
    OUT_OF_PHASE : 7
        The loads of a march are not in proportion at every instant, or turn within a half-cycle:
        NaN at all instants.
    NOT_CLOSED : 8
        The instants of a march are those of a first loading: NaN at all instants.
    COMPUTED : 9
        Solved on elements, with an estimate of the error.
    NO_STICK : 10
        Every point slips at some time, although the contact never slides, because no stick zone can
        carry the mean shear load: m and n are NaN.
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
    """The zone [-m, n] that sticks throughout the cycle, and how the cycle slips.

    Attributes
    ----------
    m, n : ndarray
        Ends of the stick zone at x = -m and x = n [m].
    regime : ndarray of int
        A code of Regime.
    """

    m: Array
    n: Array
    regime: Array


class Threshold(NamedTuple):
    """Lower and upper limits of the change in bulk tension between which tension is moderate.

    Attributes
    ----------
    lower, upper : ndarray
        The limits [Pa].
    """

    lower: Array
    upper: Array


class March(NamedTuple):
    """A cycle instant by instant.

    Attributes
    ----------
    a, c : ndarray
        The contact [-a, c] [m].
    m, n : ndarray
        The zone [-m, n] that has not slipped since the last reversal of the loads [m].
    left, right : ndarray of int
        Direction of slip at each edge: +1 forward, -1 reverse, 0 none or not known.
    regime : ndarray of int
        A code of Regime.
    """

    a: Array
    c: Array
    m: Array
    n: Array
    left: Array
    right: Array
    regime: Array


class History(NamedTuple):
    """A load history instant by instant; time lies along the last axis.

    Attributes
    ----------
    a, c : ndarray
        The contact [-a, c] [m].
    m, n : ndarray
        [-m, n] spans all points that stick during the last change in the loads up to this instant,
        or during the last such change if the loads are held constant [m]; NaN where nothing sticks.
    intervals : ndarray of int
        The number of stick intervals.
    regime : ndarray of int
        A code of Regime: COMPUTED, or MODERATE where all results are exact; FULL_STICK, SLIDING,
        NONE, UNSOLVED.
    q, slip : ndarray or None
        Shear traction [Pa] and accumulated forward slip [m] at x; the axes of x follow that of
        time.  None if x is not given.
    work : ndarray
        Work dissipated by friction up to this instant [J/m].
    error : ndarray
        The larger of the estimated errors of m and n, relative to the contact width, and of the
        shear traction, averaged over the contact and relative to f P/(a + c); 0 where all results
        are exact.  At single points next to a stick-slip boundary the shear traction may be farther
        off.
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


class SteadyCycle(NamedTuple):
    """The steady cycle to which a repeated load history settles.

    Attributes
    ----------
    m, n : ndarray
        The stick zone [-m, n] [m].
    regime : ndarray of int
        A code of Regime: that of stick_zone where m and n are exact, otherwise COMPUTED, NO_STICK,
        SLIDING, ...
    slip_range : ndarray or None
        The slip range in a cycle at x [m], also where the contact opens; NaN where the bodies are
        never in contact.  None if x is not given.
    q : ndarray or None
        Shear traction at x at the first instant [Pa]; None if x is not given.
    work : ndarray
        Work dissipated by friction in one cycle [J/m].
    rounds : ndarray of int
        How many times the cycle was repeated.
    drift : ndarray
        Change in slip between the last two rounds, relative to the largest slip.
    error : ndarray
        Estimated error of m and n alone, relative to the contact width; 0 if they are exact, inf if
        slip does not repeat to 1e-6 within 100 rounds.
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
