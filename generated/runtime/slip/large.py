r"""The stick zone between slip zones of opposite signs, for a cycle with dsigma >= 0.

Newton's method starts from the leading order of both slip zones.  If it fails, the width of the
stick zone is sought in a bracket: a wider stick zone corresponds to a smaller part of the loads.
No zone of this kind is narrower than the width H = 8 dQ/(pi dsigma) at which slip reverses on the
right.  If a zone of that width takes more than the given loads, slip has not reversed; if it takes
less, slip has reversed.
"""

import math
from typing import Any

from ..elementary import EPS
from ..kernels import kernel
from ..search import between, narrowed
from .bounded import (
    STEPS,
    drives,
    friction,
    placed,
    share,
    solved,
    turning_width,
    unknown,
)
from .quadrature import FINEST

EXACT = 1e-12
"""If slip zones by two rules agree to within this, those by the finer rule are exact to
rounding."""

LAST = 100.0
"""The finest rule is accepted at a change larger by this factor, since its own error is far
smaller."""

LEAST_SLIP = 1e-14
"""Smallest initial slip zone, relative to the width."""

NARROWEST = 1e-6
"""The narrowest stick zone that is sought in a bracket, relative to the width."""


@kernel
def _first_guess(law: Any, own: Any, of: Any) -> Any:
    """Slip zones K_T/(f K_N), reduced so that they leave a stick zone between them."""
    K_left = K_right = 0.0
    for end in (0, 2):
        a, c = of.cycle[end], of.cycle[end + 1]
        _, _, _, one, other = law.state(a, c, own) if of.sense > 0 else law.state(c, a, own)
        K_left, K_right = K_left + one, K_right + other
    if of.sense < 0:
        K_left, K_right = K_right, K_left
    width = of.a + of.c
    h = width + (of.da + of.dc) / 2
    left, right = drives(of.cycle[4], of.cycle[5], h)
    scale = math.pi * math.sqrt(h) * of.cycle[6] / 2
    left = max(abs(left) / (scale * K_left), LEAST_SLIP * width)
    right = max(abs(right) / (scale * K_right), LEAST_SLIP * width)
    shrink = width / (width + left + right)
    return left * shrink, right * shrink


@kernel
def _bracketed(of: Any, level: int) -> Any:
    """Slip zones by the width of the stick zone; m = -inf if slip reverses on the right."""
    width = of.a + of.c
    stuck = max(turning_width(of.cycle), NARROWEST * width)
    if not stuck < width:
        return unknown(-math.inf)
    slip = placed(of, stuck, math.nan, level)
    last, excess = stuck, 1 - share(of, slip)
    if excess > 0:
        return unknown(-math.inf)
    search = between(stuck, width, math.nan, 2 * width)
    for _ in range(2 * STEPS):
        before, stuck = excess, search.y
        slip = placed(of, stuck, slip.n, level)
        excess = 1 - share(of, slip)
        search = narrowed(search, excess, (excess - before) / (stuck - last))
        if search.step == 0 or math.isnan(excess):
            return slip
        last = stuck
    return unknown(math.nan)


@kernel
def large_slip(law: Any, own: Any, cycle: Any, sense: float, agreed: float) -> Any:
    """The stick zone with its slip zones.

    m and n are -inf if slip reverses, NaN if they are not found.
    agreed: zones by two rules are accepted if they agree to within this, relative to their own
    lengths; EXACT or more.
    """
    of = friction(law, own, cycle, sense, -1.0, math.nan)
    left, right = _first_guess(law, own, of)
    if not (left > 0 and right > 0):
        return unknown(math.nan)
    last_left = last_right = math.nan
    rounding = 16 * EPS * (of.a + of.c)
    for level in range(FINEST + 1):
        slip = unknown(math.nan)
        if last_left != math.inf:
            slip = solved(of, left, right, level)
        if math.isnan(slip.m):
            slip = _bracketed(of, level)
        if slip.m == -math.inf and last_left == math.inf:
            return slip
        allowed = agreed if level < FINEST else LAST * agreed
        if (
            abs(slip.d_left - last_left) <= allowed * slip.d_left + rounding
            and abs(slip.d_right - last_right) <= allowed * slip.d_right + rounding
        ):
            return slip
        last_left, last_right = slip.d_left, slip.d_right
        if 0 < last_left < math.inf:
            left, right = last_left, last_right
    return unknown(math.nan)
