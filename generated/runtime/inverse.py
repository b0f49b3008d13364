"""The contact under given loads.

When an edge of the contact of any convex body moves, the pressure changes by that of a flat punch.
For E* = 1, with mid = (c - a)/2,

    dP = (pi sqrt(h)/4) (K_left da + K_right dc),
    dM = -(pi sqrt(h)/4) (K_left (mid - h/4) da + K_right (mid + h/4) dc),
    d alpha = (K_left da - K_right dc)/sqrt(h).

Newton's method therefore needs no derivatives other than K_N.  Three facts follow: the load grows
with both edges; its centre, -M/P, moves to the right with c and to the left with a; the tilt grows
with a and falls with c.

`place` is a point that is known to lie in the contact: the centre of the load if the moment is
given, otherwise the point where the tilted body is level.  Newton's steps are taken in the
logarithms of the distances of the edges from the last kink inside them, or from the place.  Where
they do not converge, one root search is nested in another: each left edge has one right edge that
meets the second condition, and along these contacts the load grows with the left edge.
"""

import math
from typing import Any, NamedTuple

from .elementary import EPS, LEAST, MOST
from .kernels import kernel
from .search import MAX_STEPS, by_distance, level, narrowed

SHORTEST_PART = 2.0**-10
"""Newton's method has failed if even this fraction of a step does not reduce the error."""

CONTACT_RTOL = 1e-13
"""The nested search is tried if the error of a contact, apart from rounding, is above this."""

WORST_RTOL = 1e-9
"""A contact is rejected if its error is above this after both methods."""

MAX_LOAD_ROUNDING = 1e-4
"""No contact is returned if rounding of its edges changes the load by more than this fraction."""

MAX_EDGE_ROUNDING = 1e-2
"""No contact is returned if rounding of its place or tilt moves an edge by more than this fraction
of the width."""


class Curve(NamedTuple):
    """The part of a body's `Law` that determines its contacts."""

    state: Any
    slope: Any
    breaks: Any


class Target(NamedTuple):
    """The target of the search for a contact, for E* = 1.

    load     load to be carried
    place    a point in the contact: the centre of the load unless the tilt is prescribed
    tilt     tilt of the body if it is prescribed
    held     whether the tilt is prescribed
    """

    load: float
    place: float
    tilt: float
    held: bool


# ---------------------------------------------------------------- one contact and its target


@kernel
def _is_contact(now: Any) -> bool:
    """Whether a state is that of a contact within the ends of the body."""
    load, _, _, left, right = now
    return 0 < load < math.inf and 0 < left < math.inf and 0 < right < math.inf


@kernel
def _residuals(target: Any, a: float, c: float, now: Any) -> Any:
    """How far a contact is from its target.

    The first value is the logarithm of the target load over the load.  The second value is the
    residual of the second condition: a distance relative to h/4, or a tilt in a unit that makes it
    comparable with a change in the logarithm of the load.
    """
    load, moment, tilt, _, _ = now
    h = a + c
    arm = target.place + moment / load
    residual = (target.tilt - tilt) * h / load if target.held else 4 * arm / h
    return math.log(target.load / load), residual


@kernel
def _step(target: Any, a: float, c: float, now: Any) -> Any:
    """Newton's step for a and c."""
    load, moment, _, left, right = now
    h, mid = a + c, (c - a) / 2
    shortfall, residual = _residuals(target, a, c, now)
    force = 4 * load / (math.pi * math.sqrt(h))
    both = force * shortfall  # K_left da + K_right dc
    if target.held:
        odd = -force * math.pi / 4 * residual  # K_right dc - K_left da
    else:
        odd = force * residual - 4 * both * (mid + moment / load) / h
    return (both - odd) / 2 / left, (both + odd) / 2 / right


@kernel
def _error(target: Any, a: float, c: float, now: Any) -> float:
    """The distance of a contact from its target as one number."""
    if not _is_contact(now):
        return math.inf
    shortfall, residual = _residuals(target, a, c, now)
    return math.hypot(shortfall, residual)


# ---------------------------------------------------------------- Newton's method


@kernel
def _width(law: Any, own: Any, breaks: Any, target: Any) -> float:
    """Width of a contact centred at the place with nearly the target load; NaN if there is none.

    The first guess follows from the curvature at the place, but does not reach far beyond the
    nearest break.
    """
    curvature = law.slope(target.place, own)[1]
    h = nearest = math.inf
    if 0 < curvature < math.inf:
        h = 4 * math.sqrt(target.load / (math.pi * curvature))
    for at in breaks:
        nearest = min(nearest, abs(at - target.place))
    h = min(h, max(4 * nearest, target.load))
    search = by_distance(0.0, math.inf, math.inf, h)
    for _ in range(MAX_STEPS):
        h = math.exp(search.y)
        now = law.state(h / 2 - target.place, h / 2 + target.place, own)
        load, _, _, left, right = now
        over, rate = (math.inf if load == math.inf else -1.0), 0.0
        if _is_contact(now):
            over = math.log(load / target.load)
            rate = math.pi * math.sqrt(h) / 8 * h * (left + right) / load
            if abs(over) < 1:  # Newton's method converges from here
                return h
        search = narrowed(search, over, rate)
        if search.high - search.low < 0.1:  # the load jumps at a kink
            return math.exp(search.low if search.top == math.inf else search.high)
    return math.nan


@kernel
def _last_break(edge: float, inner: float, breaks: Any, side: float) -> float:
    """The last break inside an edge, or the point `inner` if no break lies between them.

    Positions are counted outward: c with side 1, a with side -1.
    """
    last = inner
    for at in breaks:
        if last < side * at < edge:
            last = side * at
    return last


@kernel
def _moved(edge: float, start: float, by: float) -> float:
    """The edge after a step that is taken in the logarithm of its distance from `start`."""
    distance = edge - start
    return edge + distance * math.expm1(min(max(by / distance, -4.0), 4.0))


@kernel
def _newton(law: Any, own: Any, breaks: Any, target: Any, a: float, c: float) -> Any:
    """The contact by Newton's method, or the closest one that the method reached."""
    now = law.state(a, c, own)
    miss = _error(target, a, c, now)
    for _ in range(MAX_STEPS):
        if miss == math.inf:
            break
        by_a, by_c = _step(target, a, c, now)
        from_a = _last_break(a, -target.place, breaks, -1.0)
        from_c = _last_break(c, target.place, breaks, 1.0)
        if not (a > from_a and c > from_c):
            break
        length = max(abs(by_a) / (a - from_a), abs(by_c) / (c - from_c))
        rounding = 4 * EPS * max(abs(a) / (a - from_a), abs(c) / (c - from_c))
        if length < math.sqrt(EPS) + rounding:  # the square of a step is the error after it
            return a + by_a, c + by_c
        part, better = 1.0, False
        while part > SHORTEST_PART and not better:
            # measure the step first from the nearest breaks inside the edges, then from the
            # reference point, so that an edge can cross a break
            for starts in ((from_a, from_c), (-target.place, target.place)):
                next_a = _moved(a, starts[0], part * by_a)
                next_c = _moved(c, starts[1], part * by_c)
                after = law.state(next_a, next_c, own)
                missed = _error(target, next_a, next_c, after)
                if missed < miss:
                    a, c, now, miss, better = next_a, next_c, after, missed, True
                    break
            part /= 4
        if not better:
            break
    return a, c


# ---------------------------------------------------------------- one root inside the other


@kernel
def _second_condition(law: Any, own: Any, target: Any, a: float, c: float) -> Any:
    """An increasing function of c, zero where the second condition is met; its derivative."""
    now = law.state(a, c, own)
    load, moment, tilt, _, right = now
    if load == math.inf:
        return math.inf, 0.0
    if not _is_contact(now):
        return -1.0, 0.0
    h = a + c
    if target.held:
        return target.tilt - tilt, right / math.sqrt(h)
    centre = -moment / load
    arm = (c - a) / 2 + h / 4 - centre
    return centre - target.place, math.pi * math.sqrt(h) / 4 * right * arm / load


@kernel
def _load_condition(law: Any, own: Any, target: Any, a: float, c: float) -> Any:
    """log(load/target load), and its derivative with respect to a if the second condition holds."""
    if c == math.inf:
        return -1.0, 0.0
    now = law.state(a, c, own)
    load, _, _, left, _ = now
    if c != c or load == math.inf:
        return math.inf, 0.0
    if not _is_contact(now):
        return -1.0, 0.0
    h = a + c
    rate = math.pi * math.sqrt(h) / 2 * left / load
    if not target.held:
        arm = (c - a) / 2 + h / 4 - target.place
        rate *= h / 4 / arm if arm > 0 else 0.0
    return math.log(load / target.load), rate


@kernel
def _right_edge(law: Any, own: Any, breaks: Any, target: Any, a: float, guess: float) -> float:
    """The right edge that meets the second condition for a given left edge, starting from a guess.

    Infinite if no contact with this left edge carries any load, NaN if none meets the condition.
    """
    start, end, top = target.place, math.inf, math.inf
    for at in breaks:
        if start < at < end:
            value, _ = _second_condition(law, own, target, a, at)
            if value < 0:
                start = at
            else:
                end, top = at, value
    guess = guess if start < guess < end else min(start + a + target.place, (start + end) / 2)
    search = by_distance(start, end - start, top, guess - start)
    for _ in range(MAX_STEPS):
        far = math.exp(search.y)
        value, rate = _second_condition(law, own, target, a, start + far)
        search = narrowed(search, value, rate * far)
        if search.step == 0:
            break
    if search.top < math.inf:
        return start + math.exp(search.y)
    now = law.state(a, start + math.exp(search.high), own)
    return math.nan if now[0] == math.inf or _is_contact(now) else math.inf


@kernel
def _nested(law: Any, own: Any, breaks: Any, target: Any, size: float) -> Any:
    """The contact by two nested root searches; NaN if there is none."""
    start, end, top, c = -target.place, math.inf, math.inf, math.nan
    for i in range(breaks.size):
        at = -breaks[breaks.size - 1 - i]
        if start < at < end:
            c = _right_edge(law, own, breaks, target, at, c)
            value, _ = _load_condition(law, own, target, at, c)
            if value < 0:
                start = at
            else:
                end, top = at, value
    search = by_distance(start, end - start, top, min(size, (end - start) / 2))
    for _ in range(MAX_STEPS):
        far = math.exp(search.y)
        c = _right_edge(law, own, breaks, target, start + far, c)
        value, rate = _load_condition(law, own, target, start + far, c)
        search = narrowed(search, value, rate * far)
        if search.step == 0:
            break
    return (start + far, c) if search.top < math.inf else (math.nan, math.nan)


# ---------------------------------------------------------------- the whole solution


@kernel
def _checked(law: Any, own: Any, target: Any, a: float, c: float) -> Any:
    """The error of a contact apart from rounding, and its tilt, which is NaN if not determined.

    Rounding of the edges changes the load; rounding of the given place or tilt moves the edges.
    """
    now = law.state(a, c, own)
    h = a + c
    if not (LEAST < h < MOST and _is_contact(now)):
        return math.inf, math.nan
    load, _, tilt, left, right = now
    shortfall, residual = _residuals(target, a, c, now)
    if not (abs(shortfall) < math.inf and abs(residual) < math.inf):
        return math.inf, math.nan
    edges = math.pi / 4 * EPS * math.sqrt(h) * (left * abs(a) + right * abs(c)) / load
    given = EPS * (abs(target.tilt) * h / load if target.held else abs(target.place) / h)
    error = max(abs(shortfall) - 16 * edges, (abs(residual) - 16 * (edges + given)) / 16, 0.0)
    if edges > MAX_LOAD_ROUNDING or given > MAX_EDGE_ROUNDING:
        tilt = math.nan
    return error, tilt


@kernel
def _solved(law: Any, own: Any, target: Any) -> Any:
    """The contact and its tilt; NaN if there is none."""
    if not (0 < target.load < math.inf and abs(target.place) < MOST):
        return math.nan, math.nan, math.nan
    breaks = law.breaks(own)
    h = _width(law, own, breaks, target)
    a, c = _newton(law, own, breaks, target, h / 2 - target.place, h / 2 + target.place)
    error, tilt = _checked(law, own, target, a, c)
    if error > CONTACT_RTOL:
        other_a, other_c = _nested(law, own, breaks, target, target.load)
        other_a, other_c = _newton(law, own, breaks, target, other_a, other_c)
        other_error, other_tilt = _checked(law, own, target, other_a, other_c)
        if other_error < error:
            a, c, error, tilt = other_a, other_c, other_error, other_tilt
    if not error < WORST_RTOL or tilt != tilt:
        return math.nan, math.nan, math.nan
    return a, c, tilt


def solve(
    state: Any, slope: Any, breaks: Any, own: Any, load: float, given: float, held: bool
) -> Any:
    """The edges a, c and the tilt under a load; NaN if there is no contact.

    Part of every `Law`, so that numba compiles it once and not again in each kernel that calls it.

    state, slope, breaks  those of the law
    given                 the centre of the load; the tilt if `held`
    """
    curve = Curve(state, slope, breaks)
    if held:
        return _solved(curve, own, Target(load, level(curve, own, given), given, True))
    return _solved(curve, own, Target(load, given, 0.0, False))


@kernel
def contact(law: Any, own: Any, P: float, M: float) -> Any:
    """The edges a, c and the tilt under a load and a moment; NaN if there is no contact."""
    if not 0 < P < math.inf:
        return math.nan, math.nan, math.nan
    return law.solve(law.state, law.slope, law.breaks, own, P, -M / P, False)


@kernel
def contact_at_tilt(law: Any, own: Any, P: float, alpha: float) -> Any:
    """The edges a, c under a load at a given tilt; NaN if there is no contact."""
    a, c, _ = law.solve(law.state, law.slope, law.breaks, own, P, alpha, True)
    return a, c
