r"""The permanent stick zone [-m, n] of a cycle, and how the cycle slips.

bounded.py solves for the stick zone between slip in the directions of the drives.  If both are
forward the tension is moderate, if they are opposite it is large.  Either solution is exact only
while both slip zones grow throughout, which growth.py tests.
"""

import math
from typing import Any

from ..kernels import kernel, loop, opened
from ..types import Regime
from .bounded import RULE_RTOL, moderate_zone, slipping, slipping_in, zone_of
from .cycles import cycle_of, drives, ends_of, exists, is_steady, narrowest, resolved, slides
from .growth import begins, grown, holds_at_first, sticks_all_over


@kernel
def _as_driven(cycle: Any) -> Any:
    """The half-cycle with slip in the directions of the drives."""
    drive_left, drive_right = drives(cycle, cycle.a_1 + cycle.c_1)
    return slipping(cycle, math.copysign(1.0, drive_left), math.copysign(1.0, drive_right))


@kernel
def _zone(law: Any, own: Any, of: Any, ends: Any) -> Any:
    """m, n and the regime: MIXED if slip in opposite directions is not driven until [-m, n], or
    does not hold where it begins."""
    m, n, regime = zone_of(law, own, of, ends, RULE_RTOL)
    if regime == Regime.LARGE:
        drive_left, drive_right = drives(of.cycle, m + n)
        driven = of.kappa * drive_left >= 0 and of.lamda * drive_right >= 0
        if not (driven and holds_at_first(of, ends, m, n)):
            regime = Regime.MIXED
    return m, n, regime


@kernel
def _overtaken(law: Any, own: Any, cycle: Any, ends: Any) -> Any:
    """m and n where slip reverses temporarily at constant loads without a lasting effect.

    Tension a little beyond its threshold reverses slip at one edge, say the right one.  The shear
    there has been at the friction limit since the last half-cycle.  The reversed slip, dq = 0,
    extends at once to the point where the drive vanishes, a + n0 = 8 dQ/(pi dsigma), and sticks
    again as soon as the left zone grows.  Forward slip as under moderate tension then comes in
    beyond n0 and overtakes the reversed slip.
    """
    m, n, _ = moderate_zone(law, own, cycle, ends)
    widest = cycle.c_1 + m if cycle.dsigma < 0 else cycle.a_1 + n
    if m <= cycle.a_1 and n <= cycle.c_1 and min(drives(cycle, widest)) >= 0:
        return m, n
    return math.nan, math.nan


@kernel
def _constant_zone(law: Any, own: Any, cycle: Any, ends: Any) -> Any:
    """m, n and the regime at constant normal loads; for mixed cycles only where forward slip
    overtakes the reversed slip."""
    if cycle.dQ == 0 and cycle.dsigma == 0:
        return cycle.a_1, cycle.c_1, Regime.FULL_STICK
    m, n, regime = _zone(law, own, _as_driven(cycle), ends)
    if regime == Regime.MIXED:
        m, n = _overtaken(law, own, cycle, ends)
    return m, n, regime


@kernel
def _varying_zone(law: Any, own: Any, cycle: Any, ends: Any) -> Any:
    """m, n and the regime as the contact changes; NaN where slip does not grow throughout."""
    if sticks_all_over(law, own, cycle, ends):
        m, n = narrowest(law, own, cycle, ends)
        if m + n > 0:
            return m, n, Regime.FULL_STICK
    of = _as_driven(cycle)
    if not begins(of, ends):
        return math.nan, math.nan, Regime.MIXED
    m, n, regime = _zone(law, own, of, ends)
    if regime == Regime.LARGE or regime == Regime.MODERATE:
        regime = grown(law, own, of, ends, m, n, regime)
    if regime == Regime.LARGE or regime == Regime.MODERATE:
        return m, n, regime
    return math.nan, math.nan, regime


@kernel
def _refusal(cycle: Any, ends: Any) -> Any:
    """NONE, SLIDING or UNSOLVED if a half-cycle is not solved; otherwise MIXED."""
    if not exists(cycle, ends):
        return Regime.NONE
    if slides(cycle, ends):
        return Regime.SLIDING
    if not resolved(cycle, ends):
        return Regime.UNSOLVED
    return Regime.MIXED


@loop
def each_constant_zone(law: Any, given: Any, own: Any, out: Any) -> None:
    """a_1, c_1, a_2, c_2, dQ, dsigma, f, E* -> m, n, regime, at constant normal loads."""
    law = opened(law)
    for i in range(given.shape[0]):
        cycle = cycle_of(given[i])
        ends = ends_of(law, own[i], cycle)
        m, n, regime = math.nan, math.nan, _refusal(cycle, ends)
        if regime == Regime.MIXED:
            m, n, regime = _constant_zone(law, own[i], cycle, ends)
        out[i, 0], out[i, 1], out[i, 2] = m, n, regime.value


@loop
def each_zone(law: Any, given: Any, own: Any, out: Any) -> None:
    """a_1, c_1, a_2, c_2, dQ, dsigma, f, E* -> m, n, regime."""
    law = opened(law)
    for i in range(given.shape[0]):
        cycle = cycle_of(given[i])
        ends = ends_of(law, own[i], cycle)
        m, n, regime = math.nan, math.nan, _refusal(cycle, ends)
        if regime == Regime.MIXED and is_steady(cycle):
            m, n, regime = _constant_zone(law, own[i], cycle, ends)
        elif regime == Regime.MIXED:
            m, n, regime = _varying_zone(law, own[i], cycle, ends)
        out[i, 0], out[i, 1], out[i, 2] = m, n, regime.value


@loop
def each_zone_of_regime(law: Any, given: Any, own: Any, out: Any) -> None:
    """a_1, c_1, a_2, c_2, dQ, dsigma, regime, f, E* -> m, n; NaN unless the regime is MODERATE,
    LARGE or FULL_STICK and the stick zone is inside both contacts.

    The half-cycle is part of one of a known regime, so that slip is known to grow.
    """
    law = opened(law)
    for i in range(given.shape[0]):
        cycle, regime = cycle_of(given[i]), given[i, 6]
        ends = ends_of(law, own[i], cycle)
        m = n = math.nan
        if regime == Regime.FULL_STICK.value:
            m, n = narrowest(law, own[i], cycle, ends)
        elif regime == Regime.MODERATE.value or regime == Regime.LARGE.value:
            m, n, _ = zone_of(law, own[i], slipping_in(cycle, regime), ends, RULE_RTOL)
        out[i, 0], out[i, 1] = m, n
