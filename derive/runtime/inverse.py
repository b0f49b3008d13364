"""From loads to the contact.

Every contact of every convex body grows by flat punches.  For E* = 1, with mid = (c - a)/2,

    dP = (pi sqrt(h)/4) (K_left da + K_right dc),
    dM = -(pi sqrt(h)/4) (K_left (mid - h/4) da + K_right (mid + h/4) dc),
    d alpha = (K_left da - K_right dc)/sqrt(h).

So Newton's method needs no other derivatives than K_N, and three facts hold: the load grows with
both edges; its centre, -M/P, moves right with c and left with a; the tilt grows with a and falls
with c.

A point that lies in the contact is its `place`: the centre of the load where the moment is given,
else where the tilted body is level.  Newton's steps are taken in the logarithms of the edges'
distances from the last kink before them, or from the place.  Where they lead astray, one root
inside the other is bracketed: to every left edge belongs one right edge that meets the second
condition, and on the contacts so found the load grows with the left edge.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from .elementary import LEAST, MOST
from .kernels import LAW, LOOP, kernel, opened, real, record, results, truth, vector

STEPS = 100
"""Most steps of Newton's method, and of a search."""

NEAR = 1.0
"""A load whose logarithm is off by less is met by Newton's steps, any other by scaling;"""

NARROWED = 0.1
"""or where the logarithm of the width is known to this: a kink is passed there."""

LONGEST = 4.0
"""Longest of Newton's steps in the logarithm of a distance."""

SMALLEST = 1e-9
"""A step below this part of the distance is the last: its square is below rounding."""

FINEST = 2.0**-10
"""Where a smaller part of a step leads no nearer, Newton's method has lost its way."""

CLOSEST = 1e-9
"""Closer than this part of the distance to a body's end, no edge is sought."""

EXACT = 1e-13
"""A contact that is off by less, but for the rounding of its edges, is found;"""

ACCEPTED = 1e-9
"""one that is off by more, when every way to it has been tried, is none."""

ROUGHEST = 1e-4
"""Where the rounding of the edges moves the load by more, no contact is given."""

UNSURE = 1e-2
"""Nor is one where the rounding of a tilt moves an edge by more, in parts of the width."""

EPS = 2.0**-52


class Goal(NamedTuple):
    """What is asked of a contact, for E* = 1.

    load     to be carried
    place    in the contact; the load's centre unless the tilt is held
    tilt     of the body if it is held
    held     whether the tilt is held
    """

    load: float
    place: float
    tilt: float
    held: bool


class Search(NamedTuple):
    """For the root of an increasing function of y, the logarithm of a distance.

    low, high  between which it lies
    top        the function at `high`; infinite where it has not been found, or the body ends
    y, step    where to look next, and how far that is from the last place; 0 at the root
    """

    low: float
    high: float
    top: float
    y: float
    step: float


GOAL: Any = record(Goal, real, real, real, truth)
SEARCH: Any = record(Search, real, real, real, real, real)


# ---------------------------------------------------------------- a root


@kernel(SEARCH(real, real, real, real))
def _begun(start: float, far: float, top: float, guess: float) -> Search:
    """A search among the distances from a start, up to `far` where the function is `top`."""
    low = math.log(max(EPS * abs(start), LEAST))
    high = max(math.log(min(far, MOST)), low)
    return Search(low, high, top, min(max(math.log(max(guess, LEAST)), low), high), 1.0)


@kernel(SEARCH(SEARCH, real, real))
def _next(search: Any, value: float, rate: float) -> Search:
    """The search when the function's value at y, and its rate with y if known, are found.

    Newton's step is taken where it stays between and at most halves the last one; else a step
    twice as long as that, or half of what is left.
    """
    low, high, top, y, step = search
    if value < 0:
        low, room = y, (high - y) / 2
    else:
        high, top, room = y, value, (low - y) / 2
    rounding = 2 * EPS * max(abs(y), 1.0)
    by = -value / rate if rate > 0 else math.inf
    if abs(by) <= rounding:
        return Search(low, high, 0.0, y, 0.0)
    if not (low < y + by < high and abs(by) <= step / 2):
        by = math.copysign(min(2 * step, abs(room)), room)
    done = abs(by) <= rounding or (top == math.inf and high - low < CLOSEST)
    return Search(low, high, top, y + by, 0.0 if done else abs(by))


# ---------------------------------------------------------------- one contact against the goal


@kernel(truth(results(5)))
def _carries(now: Any) -> bool:
    """Whether a state is that of a contact within the body's ends."""
    load, _, _, left, right = now
    return 0 < load < math.inf and 0 < left < math.inf and 0 < right < math.inf


@kernel(results(2)(GOAL, real, real, results(5)))
def _short(goal: Any, a: float, c: float, now: Any) -> Any:
    """How far a contact is from the goal.

    The logarithm by which its load is short; and how far the second condition is from being met,
    in parts of h/4 or comparable with a change of the load's logarithm.
    """
    load, moment, tilt, _, _ = now
    h = a + c
    arm = goal.place + moment / load
    off = (goal.tilt - tilt) * h / load if goal.held else 4 * arm / h
    return math.log(goal.load / load), off


@kernel(results(2)(GOAL, real, real, results(5)))
def _step(goal: Any, a: float, c: float, now: Any) -> Any:
    """Newton's step of a and c."""
    load, moment, _, left, right = now
    h, mid = a + c, (c - a) / 2
    short, off = _short(goal, a, c, now)
    force = 4 * load / (math.pi * math.sqrt(h))
    both = force * short  # K_left da + K_right dc
    if goal.held:
        odd = -force * math.pi / 4 * off  # K_right dc - K_left da
    else:
        odd = force * off - 4 * both * (mid + moment / load) / h
    return (both - odd) / 2 / left, (both + odd) / 2 / right


@kernel(real(GOAL, real, real, results(5)))
def _miss(goal: Any, a: float, c: float, now: Any) -> float:
    """How far a contact is from the goal, in one number."""
    if not _carries(now):
        return math.inf
    short, off = _short(goal, a, c, now)
    return math.hypot(short, off)


@kernel(results(2)(LAW, vector, GOAL, real, real))
def _loaded(law: Any, own: Any, goal: Any, a: float, c: float) -> Any:
    """The logarithm of the load over what is asked; its rate with a while c meets the condition."""
    if c == math.inf:
        return -1.0, 0.0
    now = law.state(a, c, own)
    load, _, _, left, _ = now
    if c != c or load == math.inf:
        return math.inf, 0.0
    if not _carries(now):
        return -1.0, 0.0
    h = a + c
    rate = math.pi * math.sqrt(h) / 2 * left / load
    if not goal.held:
        arm = (c - a) / 2 + h / 4 - goal.place
        rate *= h / 4 / arm if arm > 0 else 0.0
    return math.log(load / goal.load), rate


# ---------------------------------------------------------------- Newton's method


@kernel(real(LAW, vector, vector, GOAL))
def _width(law: Any, own: Any, breaks: Any, goal: Any) -> float:
    """Width of a contact with its middle at the place and nearly the load; NaN where none has it.

    It starts from the curvature at the place, or beyond the nearest break where there is none, and
    goes on as the load of a parabola would.
    """
    curvature = law.slope(goal.place, own)[1]
    h = goal.load
    if 0 < curvature < math.inf:
        h = 4 * math.sqrt(goal.load / (math.pi * curvature))
    elif breaks.size:
        nearest = math.inf
        for at in breaks:
            nearest = min(nearest, abs(at - goal.place))
        h = max(h, 4 * nearest)
    search = _begun(0.0, math.inf, math.inf, h)
    for _ in range(STEPS):
        h = math.exp(search.y)
        over, _ = _loaded(law, own, goal, h / 2 - goal.place, h / 2 + goal.place)
        if abs(over) < NEAR:
            return h
        search = _next(search, over, 2.0)
        if search.high - search.low < NARROWED:
            return math.exp(search.low if search.top == math.inf else search.high)
    return math.nan


@kernel(real(real, real, vector, real))
def _behind(edge: float, inner: float, breaks: Any, side: float) -> float:
    """The last break before an edge, or the point inside where none lies between.

    Counted outward: c with side 1, a with side -1.
    """
    last = inner
    for at in breaks:
        if last < side * at < edge:
            last = side * at
    return last


@kernel(real(real, real, real))
def _moved(edge: float, start: float, by: float) -> float:
    """The edge after a step, taken in the logarithm of its distance from `start`."""
    distance = edge - start
    return edge + distance * math.expm1(min(max(by / distance, -LONGEST), LONGEST))


@kernel(results(2)(LAW, vector, vector, GOAL, real, real))
def _newton(law: Any, own: Any, breaks: Any, goal: Any, a: float, c: float) -> Any:
    """The contact by Newton's method; the nearest that it came to it."""
    now = law.state(a, c, own)
    miss = _miss(goal, a, c, now)
    for _ in range(STEPS):
        if miss == math.inf:
            break
        by_a, by_c = _step(goal, a, c, now)
        from_a = _behind(a, -goal.place, breaks, -1.0)
        from_c = _behind(c, goal.place, breaks, 1.0)
        if not (a > from_a and c > from_c):
            break
        length = max(abs(by_a) / (a - from_a), abs(by_c) / (c - from_c))
        rounding = 4 * EPS * max(abs(a) / (a - from_a), abs(c) / (c - from_c))
        if length < SMALLEST + rounding:
            return a + by_a, c + by_c
        part, missed = 1.0, math.inf
        while part > FINEST and not missed < miss:
            next_a, next_c = _moved(a, from_a, part * by_a), _moved(c, from_c, part * by_c)
            after = law.state(next_a, next_c, own)
            missed = _miss(goal, next_a, next_c, after)
            part /= 4
        if not missed < miss:
            break
        a, c, now, miss = next_a, next_c, after, missed
    return a, c


# ---------------------------------------------------------------- one root inside the other


@kernel(results(2)(LAW, vector, GOAL, real, real))
def _turned(law: Any, own: Any, goal: Any, a: float, c: float) -> Any:
    """What grows with c and is zero where the second condition is met; and its rate with c."""
    now = law.state(a, c, own)
    load, moment, tilt, _, right = now
    if load == math.inf:
        return math.inf, 0.0
    if not _carries(now):
        return -1.0, 0.0
    h = a + c
    if goal.held:
        return goal.tilt - tilt, right / math.sqrt(h)
    centre = -moment / load
    arm = (c - a) / 2 + h / 4 - centre
    return centre - goal.place, math.pi * math.sqrt(h) / 4 * right * arm / load


@kernel(real(LAW, vector, vector, GOAL, real, real))
def _right_edge(law: Any, own: Any, breaks: Any, goal: Any, a: float, guess: float) -> float:
    """The right edge that meets the second condition with a left one; sought from a guess.

    Infinity where no contact with this left edge carries anything, NaN where none meets it.
    """
    start, end, top = goal.place, math.inf, math.inf
    for at in breaks:
        if start < at < end:
            value, _ = _turned(law, own, goal, a, at)
            if value < 0:
                start = at
            else:
                end, top = at, value
    guess = guess if start < guess < end else min(start + a + goal.place, (start + end) / 2)
    search = _begun(start, end - start, top, guess - start)
    for _ in range(STEPS):
        far = math.exp(search.y)
        value, rate = _turned(law, own, goal, a, start + far)
        search = _next(search, value, rate * far)
        if search.step == 0:
            break
    if search.top < math.inf:
        return start + math.exp(search.y)
    now = law.state(a, start + math.exp(search.high), own)
    return math.nan if now[0] == math.inf or _carries(now) else math.inf


@kernel(results(2)(LAW, vector, vector, GOAL, real))
def _nested(law: Any, own: Any, breaks: Any, goal: Any, size: float) -> Any:
    """The contact by one root inside the other; NaN where there is none."""
    start, end, top, c = -goal.place, math.inf, math.inf, math.nan
    for i in range(breaks.size):
        at = -breaks[breaks.size - 1 - i]
        if start < at < end:
            c = _right_edge(law, own, breaks, goal, at, c)
            value, _ = _loaded(law, own, goal, at, c)
            if value < 0:
                start = at
            else:
                end, top = at, value
    search = _begun(start, end - start, top, min(size, (end - start) / 2))
    for _ in range(STEPS):
        far = math.exp(search.y)
        c = _right_edge(law, own, breaks, goal, start + far, c)
        value, rate = _loaded(law, own, goal, start + far, c)
        search = _next(search, value, rate * far)
        if search.step == 0:
            break
    return (start + far, c) if search.top < math.inf else (math.nan, math.nan)


# ---------------------------------------------------------------- where the tilted body is level


@kernel(real(LAW, vector, real))
def level(law: Any, own: Any, alpha: float) -> float:
    """Where the tilted body is level, g'(x) + alpha = 0; NaN where it is nowhere so.

    At a corner if the tilt lies between its slopes; in the middle of a flat.
    """
    if not abs(alpha) < math.inf:
        return math.nan
    before, beyond = -math.inf, math.inf  # slopes downward left of the one, upward from the other
    for at in law.breaks(own):
        if law.slope(np.nextafter(at, -math.inf), own)[0] + alpha <= 0:
            before = at
        if beyond == math.inf and law.slope(at, own)[0] + alpha >= 0:
            beyond = at
    if before >= beyond:
        return (before + beyond) / 2
    if before < 0 < beyond:
        excess = law.slope(0.0, own)[0] + alpha
        if excess == 0:
            return 0.0
        if excess < 0:
            before = 0.0
        else:
            beyond = 0.0
    # the distance from one end of the interval is sought, to the right or to the left
    side, start, end = (1.0, before, beyond) if before > -math.inf else (-1.0, beyond, before)
    far = side * (end - start)
    guess = min(far / 2, abs(start) if start != 0 else 1.0)
    search = _begun(start, far, math.inf if far == math.inf else 0.0, guess)
    for _ in range(STEPS):
        away = math.exp(search.y)
        slope, curvature = law.slope(start + side * away, own)
        search = _next(search, side * (slope + alpha), curvature * away)
        if search.step == 0:
            break
    return start + side * math.exp(search.y) if search.top < math.inf else math.nan


# ---------------------------------------------------------------- together


@kernel(results(2)(LAW, vector, GOAL, real, real))
def _judged(law: Any, own: Any, goal: Any, a: float, c: float) -> Any:
    """How far a contact is from the goal, rounding left out; and its tilt, NaN where it is unsure.

    Rounding of the edges moves the load, that of the place or the tilt asked moves the edges.
    """
    now = law.state(a, c, own)
    h = a + c
    if not (LEAST < h < MOST and _carries(now)):
        return math.inf, math.nan
    load, _, tilt, left, right = now
    short, off = _short(goal, a, c, now)
    if not (abs(short) < math.inf and abs(off) < math.inf):
        return math.inf, math.nan
    edges = math.pi / 4 * EPS * math.sqrt(h) * (left * abs(a) + right * abs(c)) / load
    given = EPS * (abs(goal.tilt) * h / load if goal.held else abs(goal.place) / h)
    rest = max(abs(short) - 16 * edges, (abs(off) - 16 * (edges + given)) / 16, 0.0)
    if edges > ROUGHEST or given > UNSURE:
        tilt = math.nan
    return rest, tilt


@kernel(results(3)(LAW, vector, GOAL))
def _solved(law: Any, own: Any, goal: Any) -> Any:
    """The contact and its tilt; NaN where there is none."""
    if not (0 < goal.load < math.inf and abs(goal.place) < MOST):
        return math.nan, math.nan, math.nan
    breaks = law.breaks(own)
    h = _width(law, own, breaks, goal)
    a = c = tilt = math.nan
    rest = math.inf
    if h == h:
        a, c = _newton(law, own, breaks, goal, h / 2 - goal.place, h / 2 + goal.place)
        rest, tilt = _judged(law, own, goal, a, c)
    if rest > EXACT:
        size = h if h == h else goal.load
        other_a, other_c = _nested(law, own, breaks, goal, size)
        other_a, other_c = _newton(law, own, breaks, goal, other_a, other_c)
        less, turned = _judged(law, own, goal, other_a, other_c)
        if less < rest:
            a, c, rest, tilt = other_a, other_c, less, turned
    if not rest < ACCEPTED or tilt != tilt:
        return math.nan, math.nan, math.nan
    return a, c, tilt


@kernel(results(3)(LAW, vector, real, real))
def contact(law: Any, own: Any, P: float, M: float) -> Any:
    """The edges a, c and the tilt under a load and a moment; NaN where there is no contact."""
    if not 0 < P < math.inf:
        return math.nan, math.nan, math.nan
    return _solved(law, own, Goal(P, -M / P, 0.0, False))


@kernel(results(2)(LAW, vector, real, real))
def contact_at_tilt(law: Any, own: Any, P: float, alpha: float) -> Any:
    """The edges a, c under a load at a tilt; NaN where there is no contact."""
    a, c, _ = _solved(law, own, Goal(P, level(law, own, alpha), alpha, True))
    return a, c


@kernel(LOOP)
def each_contact(law: Any, given: Any, own: Any, out: Any) -> None:
    """Edges a, c and the tilt under loads P and moments M."""
    law = opened(law)
    for i in range(given.shape[0]):
        out[i, 0], out[i, 1], out[i, 2] = contact(law, own[i], given[i, 0], given[i, 1])


@kernel(LOOP)
def each_contact_at_tilt(law: Any, given: Any, own: Any, out: Any) -> None:
    """Edges a, c under loads P at tilts, and the tilts of those that there are."""
    law = opened(law)
    for i in range(given.shape[0]):
        alpha = given[i, 1]
        a, c = contact_at_tilt(law, own[i], given[i, 0], alpha)
        out[i, 0], out[i, 1], out[i, 2] = a, c, alpha if a == a else math.nan
