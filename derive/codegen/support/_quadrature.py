"""What a contact carries, by quadrature of the body's curvature.

Each element ds of the contact adds the pressure (1/pi) g''(s) L(x, s) ds for E* = 1, with

    L(x, s) = asinh sqrt(min(u, v)/(h |x - s|)),   u = (c - s)(a + x),   v = (a + s)(c - x),

and a corner adds the jump of g' there in place of g'' ds.  Load and edge coefficients follow,

    P = (1/2) int g'' w ds,   K_left = (1/(pi sqrt(h))) int g'' w/(a + s) ds,   K_right alike,
    alpha = -(1/pi) int g'/w ds.

On a convex body nothing in the first three is ever subtracted: no digit is lost, wherever the
contact lies.

The contact is cut at the body's breaks.  A break is a corner, a change of formula, or the real part
of a singularity beside the real axis.  On each part the nodes of the double exponential rule crowd
towards both ends, and every distance to an end is a product, not a difference.  The step is halved
until two sums agree; elements that agree take no part in the next halving.
"""

from collections.abc import Callable, Iterator, Sequence
from contextvars import ContextVar
from functools import cache, wraps
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from ._arrays import Array, at_rows, flattened, minimum, some
from ._state import State

COARSEST, FINEST = 1, 9
"""Steps of the rule are 2**-COARSEST at first and 2**-FINEST at last."""

AGREED = 1e-11
"""Two sums that agree to this are followed by one that is exact to rounding."""

CLOSE = 0.1
"""Breaks closer than this, compared with the width, are left to quadrature."""

NEARER = 1e-2
"""For integrands only those closer than this, and only where terms cancel."""

FAR = 100.0
"""So are breaks in the contact that lie so many widths from the origin,"""

CANCELLED = 100.0
"""and terms so many times larger than what the slope rises by in the contact."""

EXACT = 1e-13
"""A tilt whose sums agree to this is exact to rounding; close to a kink sums get better slowly."""

TOGETHER = 8_192
"""Nodes and elements that are evaluated in one piece."""

_TINY, _HUGE, _NOTHING = 5e-324, 1e300, 1e-300

_integrated = ContextVar("integrated", default=False)
"""Whether pressures are asked for as integrands."""


class Curve(NamedTuple):
    """g' and g'' at one place, and g''' for what asks for it."""

    slope: Array
    curvature: Array
    change: Callable[[], Array]


Branch = Callable[..., Curve]
"""The curve at a distance t from a break, from t and the body's parameters."""


class Piece(NamedTuple):
    """The curve between two neighbouring breaks.

    from_left: at t right of the left break; None where the piece has no left end.
    from_right: at t left of the right break; None where it has no right end.
    straight: whether g'' is zero all over it.
    """

    from_left: Branch | None
    from_right: Branch | None
    straight: bool = False


class Profile(NamedTuple):
    """A body by its curve.

    breaks: places of the breaks from left to right, from the parameters.
    corners: jumps of g' at the breaks, from the parameters; zero where there is none.
    pieces: one more than breaks.
    reach: how far the rule goes; farther where g'' is infinite at a break.
    terms: how large the terms of g' are that closed formulas add up in the contact [-a, c], from a,
        c and the parameters; None where no powers cancel in them, or where there are none.
    plain: numbers of the breaks that are there for quadrature alone: closed formulas have none.
    """

    breaks: Callable[..., tuple[Array, ...]]
    corners: Callable[..., tuple[Array, ...]]
    pieces: tuple[Piece, ...]
    reach: int
    terms: Callable[..., Array] | None = None
    plain: tuple[int, ...] = ()

    def places(self, **constants: Array) -> list[Array]:
        """The breaks that closed formulas have."""
        found = enumerate(self.breaks(**constants))
        return [place for i, place in found if i not in self.plain]


def state_of(body: Profile, a: Array, c: Array, /, **constants: Array) -> State:
    """Load, moment, tilt and edge coefficients of the contact [-a, c] for E* = 1.

    NaN where [-a, c] is no contact; a load without limit where it leaves the curve.
    """
    given = _Flat(a, c, constants)
    a, c, constants = given.a, given.c, given.constants
    h, mid = a + c, (c - a) / 2

    def integrand(near: "_Nodes", _: Any) -> tuple[Array, ...]:
        A, B = near.from_low, near.from_high
        root = np.sqrt(A * B)
        force = near.curve.curvature * root
        return force, force / A, force / B, near.curve.slope / root, force * (A - B)

    shared = _Contact(body, constants, -a, c, h, ())
    steepest = np.maximum(*(np.abs(slope_of(body, x, **constants)[0]) for x in (-a, c)))
    force, left, right, lean, arm = _integrals(shared, integrand, 5, 3, np.pi * steepest)
    for part in shared.pieces():
        slope = part.at_high().slope if part.piece.straight else 0.0
        if np.any(slope):
            lean = lean + np.where(part.length > 0, slope * part.angle(), 0.0)
    for _, jump, A, B in _corners(body, a, c, constants):
        root = np.where((A > 0) & (B > 0), np.sqrt(A * B), 0.0)
        inside = root > 0
        force, arm = force + jump * root, arm + jump * root * (A - B)
        left = left + np.where(inside, jump * root / np.where(inside, A, 1.0), 0.0)
        right = right + np.where(inside, jump * root / np.where(inside, B, 1.0), 0.0)
    load = np.where(np.isnan(force) & (h > 0), np.inf, force / 2)
    load = np.where((h > 0) & (load > 0), load, np.nan)
    root = np.pi * np.sqrt(h)
    found = (load, -mid * load - arm / 8, -lean / np.pi, left / root, right / root)
    return State(*(given.shaped(v) for v in found))


def pressure_at(body: Profile, x: Array, a: Array, c: Array, /, **constants: Array) -> Array:
    """The pressure at x for E* = 1; zero outside the contact."""
    given = _Flat(a, c, constants, x)
    a, c, constants, x = given.a, given.c, given.constants, *given.also
    h = a + c
    inside = (x > -a) & (x < c)
    x = np.where(inside, x, (c - a) / 2)
    left, right = a + x, c - x

    def on_the_left(near: "_Nodes", of: Any) -> tuple[Array, ...]:
        u_or_v = near.from_low * of(right)
        return (near.curve.curvature * _asinh_root(u_or_v, of(h) * near.from_high),)

    def on_the_right(near: "_Nodes", of: Any) -> tuple[Array, ...]:
        u_or_v = near.from_high * of(left)
        return (near.curve.curvature * _asinh_root(u_or_v, of(h) * near.from_low),)

    total = 0 * h
    for low, high, width, kernel in ((-a, x, left, on_the_left), (x, c, right, on_the_right)):
        shared = _Contact(body, constants, low, high, width, ())
        (part,) = _integrals(shared, kernel, 1, 1)
        total = total + part
    for place, jump, A, B in _corners(body, a, c, constants):
        peak = _beside_corner(np.minimum(B * left, A * right), h, np.abs(x - place))
        total = total + np.where((A > 0) & (B > 0), jump * peak, 0.0)
    return given.shaped(np.where(inside, total / np.pi, 0.0 * total))


def _asinh_root(over: Array, under: Array) -> Array:
    """asinh sqrt(over/under), finite even where `under` has underflown."""
    return np.arcsinh(np.sqrt(over / np.maximum(under, over / _HUGE + _TINY)))


def _beside_corner(over: Array, h: Array, distance: Array) -> Array:
    """asinh sqrt(over/(h distance)), infinite at the corner alone."""
    ratio = over / h / distance  # a product with the smallest distances would lose their digits
    found = np.arcsinh(np.sqrt(ratio))
    beyond = (ratio == np.inf) & (distance > 0)
    if np.any(beyond):
        found = np.where(beyond, (np.log(4 * over) - np.log(h) - np.log(distance)) / 2, found)
    return found


def second_of(body: Profile, a: Array, c: Array, /, **constants: Array) -> tuple[Array, Array]:
    """The coefficients of s**(3/2) in the pressure at the left and the right edge for E* = 1."""
    given, body = _Flat(a, c, constants), _uncut(body)
    a, c, constants = given.a, given.c, given.constants
    left = _second_right(mirrored(body), c, a, constants)
    return given.shaped(left), given.shaped(_second_right(body, a, c, constants))


def _uncut(body: Profile) -> Profile:
    """The body without the cuts that are there for quadrature of g' alone."""
    if not body.plain:
        return body
    kept: list[Piece] = []
    for i, piece in enumerate(body.pieces):
        if i - 1 in body.plain:
            piece = Piece(kept.pop().from_left, piece.from_right)
        kept.append(piece)

    def corners(**constants: Array) -> tuple[Array, ...]:
        found = enumerate(body.corners(**constants))
        return tuple(jump for i, jump in found if i not in body.plain)

    def breaks(**constants: Array) -> tuple[Array, ...]:
        return tuple(body.places(**constants))

    return body._replace(breaks=breaks, corners=corners, pieces=tuple(kept), plain=())


def _second_right(body: Profile, a: Array, c: Array, constants: dict[str, Array]) -> Array:
    r"""(1/pi) times the finite part of int g'' k ds, k = r (3 + 2 r**2)/(6 h**(3/2)).

    r = sqrt((a + s)/(c - s)).  On the part that ends at the edge g'' is integrated by parts, with

        int k ds = psi(r)/(3 sqrt(h)),   psi(r) = 2 r - (3/2) atan r - r/(2 (1 + r**2)),

    whose finite part at the edge is -3 pi/4.
    """
    h = a + c
    scale = 6 * h * np.sqrt(h)

    def integrand(near: "_Nodes", of: Any) -> tuple[Array, ...]:
        A, B, width = near.from_low, near.from_high, of(h)
        ends, start = near.ends_high, near.start_low
        beyond = B + near.from_start  # from the part's start to the edge, which may be close
        r, r_0 = np.sqrt(A / B), np.sqrt(start / beyond)
        step = width * near.from_start / (B * beyond) / (r + r_0)
        twist = (1 - r * r_0) / ((1 + r**2) * (1 + r_0**2))
        rise = 2 * step - 1.5 * np.arctan2(step, 1 + r * r_0) - step * twist / 2
        change = np.clip(near.curve.change(), -_HUGE, _HUGE)  # infinite beside some breaks
        by_parts = -change * rise * (2 * width)
        plain = near.curve.curvature * r * (3 + 2 * r**2)
        value = np.where(ends, by_parts, plain)
        return np.abs(value), value

    shared = _Contact(body, constants, -a, c, h, ())
    _, total = _integrals(shared, integrand, 2, 0)
    for piece in shared.pieces():
        r_0 = np.sqrt(piece.start_low / np.maximum(piece.length + piece.end_high, _TINY))
        psi = 2 * r_0 - 1.5 * np.arctan(r_0) - r_0 / (2 * (1 + r_0**2))
        edge = piece.at_high().curvature * (-0.75 * np.pi - psi) * (2 * h)
        total = total + np.where(piece.ends_high & (piece.length > 0), edge, 0.0)
    for _, jump, A, B in _corners(body, a, c, constants):
        r = np.sqrt(A / np.where(B > 0, B, 1.0))
        total = total + np.where(B > 0, jump * r * (3 + 2 * r**2), 0.0)
    return total / (np.pi * scale)


def mended(
    values: Sequence[Array],
    exists: Array,
    fields: Sequence[str],
    scale: Array,
    body: Profile,
    a: Array,
    c: Array,
    /,
    x: Array = 0.0,
    **constants: Array,
) -> list[Array]:
    """Values of closed formulas, by quadrature instead where the formulas would lose digits.

    exists: where there is a contact.
    fields: of a State; or "p", or "second_left" and "second_right".
    scale: what the quadrature is multiplied by.
    """
    rough = exists & is_delicate(body, a, c, **constants)
    if not some(rough):
        return [*values]
    given = _Flat(a, c, constants, x, scale, rough, *values)
    x, scale, rough, *values = given.also
    rows = np.flatnonzero(rough)
    held = at_rows(rows, given.constants)
    a, c = given.a[rows], given.c[rows]
    if "p" in fields:
        found: Any = (pressure_at(body, x[rows], a, c, **held),)
    elif "second_left" in fields:
        found = second_of(body, a, c, **held)
    else:
        now = state_of(body, a, c, **held)
        found = [getattr(now, name) for name in fields]
    mended_values = []
    for value, fresh in zip(values, found, strict=True):
        whole = value.copy()
        whole[rows] = scale[rows] * fresh
        mended_values.append(given.shaped(whole))
    return mended_values


def as_integrand(function: Callable[..., Array]) -> Callable[..., Array]:
    """The same function, to be integrated: many times as fast, and exact to 14 digits of its mean.

    Close to an edge, where digits are lost because a break is near, there is little to integrate.
    """

    @wraps(function)
    def nearly(*args: Array, **constants: Array) -> Array:
        before = _integrated.set(True)
        try:
            return function(*args, **constants)
        finally:
            _integrated.reset(before)

    return nearly


def is_delicate(body: Profile, a: Array, c: Array, /, **constants: Array) -> Array:
    """Whether closed formulas lose digits, because what the pieces carry is a small difference.

    A break lies close to an edge, or to the next one, compared with the width; or powers cancel, or
    the moment about a break is small beside that about the origin.
    """
    h, places, integrated = a + c, body.places(**constants), _integrated.get()
    least = (NEARER if integrated else CLOSE) * h
    rough = h < 0
    for place in places:
        near = minimum(a + place, c - place)
        close, far = least, abs(place) > FAR * h
        if some(far):
            close = np.where(far, np.inf, close)
        rough = rough | ((near >= 0) & (near < close))
    for left, right in pairwise(places):
        rough = rough | ((right - left < least) & (left > -a) & (right < c))
    if integrated and some(rough):
        rough = _is_lost(body, rough, a, c, constants)
    if body.terms is not None:
        rise = slope_of(body, c, **constants)[0] - slope_of(body, -a, **constants)[0]
        rough = rough | ~(body.terms(a, c, **constants) < CANCELLED * rise)
    return rough


def _is_lost(body: Profile, rough: Array, a: Array, c: Array, constants: dict[str, Array]) -> Array:
    """Which of the `rough` elements lose too much for an integrand, too.

    Terms are as large as the width times the largest curvature; they add up to no less than what
    the slope rises by in the contact.
    """
    given = _Flat(a, c, constants, rough)
    rows = np.flatnonzero(given.also[0])
    a, c, held = given.a[rows], given.c[rows], at_rows(rows, given.constants)
    left, right = (slope_of(body, x, **held) for x in (-a, c))
    bend = np.maximum(left[1], right[1])
    for place in body.breaks(**held):
        for x in (np.nextafter(place, -np.inf), np.nextafter(place, np.inf)):
            curvature = slope_of(body, x + 0 * a, **held)[1]
            bend = np.where((x > -a) & (x < c), np.maximum(bend, curvature), bend)
    lost = np.full(given.a.shape, False)
    lost[rows] = ~((a + c) * bend < CANCELLED * (right[0] - left[0]))
    return given.shaped(lost)


def mirrored(body: Profile) -> Profile:
    """The body seen from behind the plane, x to the left."""

    def turned(branch: Branch | None) -> Branch | None:
        if branch is None:
            return None

        def of(t: Array, **constants: Array) -> Curve:
            slope, curvature, change = branch(t, **constants)
            return Curve(-slope, curvature, lambda: -change())

        return of

    def breaks(**constants: Array) -> tuple[Array, ...]:
        return tuple(-place for place in reversed(body.breaks(**constants)))

    def corners(**constants: Array) -> tuple[Array, ...]:
        return tuple(reversed(body.corners(**constants)))

    pieces = tuple(
        Piece(turned(p.from_right), turned(p.from_left), p.straight) for p in reversed(body.pieces)
    )
    return Profile(breaks, corners, pieces, body.reach)


def slope_of(body: Profile, x: Array, /, **constants: Array) -> tuple[Array, Array]:
    """g'(x) and g''(x); at a break, of the piece on its right."""
    places = body.breaks(**constants)
    found: tuple[Array, Array] = (np.nan, np.nan)
    for i, piece in enumerate(body.pieces):
        beyond = x >= places[i - 1] if i else True
        if piece.from_left is not None:
            curve = piece.from_left(np.maximum(x - places[i - 1], _TINY), **constants)
            found = np.where(beyond, curve[0], found[0]), np.where(beyond, curve[1], found[1])
        if piece.from_right is not None:
            near = x - places[i - 1] >= places[i] - x if i else True
            curve = piece.from_right(np.maximum(places[i] - x, _TINY), **constants)
            here = beyond & near
            found = np.where(here, curve[0], found[0]), np.where(here, curve[1], found[1])
    return found


def _corners(
    body: Profile, a: Array, c: Array, constants: dict[str, Array]
) -> Iterator[tuple[Array, Array, Array, Array]]:
    """Places and jumps of g', and how far each corner lies inside the left and the right edge."""
    places, jumps = body.breaks(**constants), body.corners(**constants)
    for place, jump in zip(places, jumps, strict=True):
        if np.ndim(jump) or jump != 0:
            yield place, jump, np.maximum(a + place, 0.0), np.maximum(c - place, 0.0)


# ---------------------------------------------------------------------- the rule


class _Nodes(NamedTuple):
    """Places of one part of the contact, and the curve there.

    from_low, from_high: distances from the ends of the whole window.
    from_start: distance from the part's own left end.
    start_low: of that end from the window's low end.
    ends_high: whether the part ends at the window's high end.
    """

    curve: Curve
    from_low: Array
    from_high: Array
    from_start: Array
    start_low: Array
    ends_high: Array


class _Part(NamedTuple):
    """One piece inside the window [low, high], for some elements.

    length: its length in the window; 0 where it is outside.
    start_low, end_high: distances of its ends from the window's.
    beyond_left, beyond_right: distances from the piece's breaks to its ends in the window.
    """

    piece: Piece
    length: Array
    start_low: Array
    end_high: Array
    beyond_left: Array
    beyond_right: Array
    constants: dict[str, Array]

    @property
    def ends_high(self) -> Array:
        """Whether it ends at the window's high end."""
        return self.end_high == 0

    def at_high(self) -> Curve:
        """The curve at its right end."""
        return self._curve(False, self.length, 0.0)

    def _curve(self, near_left: bool, along: Array, back: Array) -> Curve:
        """The curve at distances from its left and its right end, of its left or its right half.

        Of two breaks the nearer one is asked, where one is farther off than three times the other.
        """
        of_left, of_right, _ = self.piece
        past, ahead, length = self.beyond_left, self.beyond_right, self.length
        if of_left is None:
            return of_right(np.maximum(ahead + back, _TINY), **self.constants)  # type: ignore[misc]
        if of_right is None:
            return of_left(np.maximum(past + along, _TINY), **self.constants)
        ours = past <= ahead + length if near_left else past + length < ahead
        if np.all(ours):
            return of_left(np.maximum(past + along, _TINY), **self.constants)
        right = of_right(np.maximum(ahead + back, _TINY), **self.constants)
        if not np.any(ours):
            return right
        left = of_left(np.maximum(past + along, _TINY), **self.constants)
        return Curve(
            np.where(ours, left.slope, right.slope),
            np.where(ours, left.curvature, right.curvature),
            lambda: np.where(ours, left.change(), right.change()),
        )

    def angle(self) -> Array:
        """int ds/w over it."""
        start, end = self.start_low, self.end_high
        beyond, before = start + self.length, end + self.length
        both = np.sqrt(before * beyond) + np.sqrt(end * start)
        sine = (start + before) * self.length / both
        return 2 * np.arctan2(sine, np.sqrt(before * end) + np.sqrt(beyond * start))

    def at(self, near_left: bool, q: Array, rest: Array) -> _Nodes:
        """Nodes at the fractions q from the left end, 1 - q = rest from the right."""
        along, back = self.length * q, self.length * rest
        curve = self._curve(near_left, along, back)
        low, high = self.start_low + along, self.end_high + back
        return _Nodes(curve, low, high, along, self.start_low, self.ends_high)


class _Contact(NamedTuple):
    """A body and the windows [low, high] of its contact; `rows` are left to do."""

    body: Profile
    constants: dict[str, Array]
    low: Array
    high: Array
    width: Array
    rows: Any

    def on(self, rows: Any) -> "_Contact":
        """The same for some elements."""
        constants = at_rows(rows, self.constants)
        return _Contact(
            self.body, constants, self.low[rows], self.high[rows], self.width[rows], rows
        )

    def pieces(self) -> Iterator[_Part]:
        """The pieces as they lie in the windows."""
        places: Sequence[Any] = self.body.breaks(**self.constants)
        everywhere = np.full_like(self.width, np.inf)
        for i, piece in enumerate(self.body.pieces):
            left = places[i - 1] if i else None
            right = places[i] if i < len(places) else None
            span = right - left if left is not None and right is not None else everywhere
            from_low = everywhere if left is None else self.high - left
            from_high = everywhere if right is None else right - self.low
            start = 0 * self.width if left is None else np.clip(left - self.low, 0, self.width)
            end = 0 * self.width if right is None else np.clip(self.high - right, 0, self.width)
            length = np.minimum(np.minimum(from_low, from_high), np.minimum(span, self.width))
            length = np.maximum(length, 0.0)
            past_left = 0 if left is None else np.clip(self.low - left, 0, span)
            past_right = 0 if right is None else np.clip(right - self.high, 0, span)
            yield _Part(piece, length, start, end, past_left, past_right, self.constants)


def _integrals(
    contact: _Contact,
    integrand: Callable[..., tuple[Array, ...]],
    count: int,
    positive: int,
    size: Array | None = None,
) -> list[Array]:
    """Integrals over the windows, NaN where the sums do not agree; straight pieces add nothing.

    The first few are positive, and each of these has to agree for itself.  The next one, if its
    `size` is given, has to agree against that, for its own sake alone.  Where none is positive, the
    last one has to, against the first one, which is its size and need not be smooth.
    """
    sums = np.full((count, contact.width.size), np.nan)
    rows = np.flatnonzero(contact.width > 0)
    sums[:, contact.width == 0] = 0.0
    if all(piece.straight for piece in contact.body.pieces):
        sums[:, rows] = 0.0
        return [*sums]
    before = np.zeros((count, rows.size))
    judged, sizes = (slice(positive),) * 2 if positive else (slice(-1, None), slice(1))
    for level in range(COARSEST, FINEST + 1):
        if not rows.size:
            break
        here = contact.on(rows)
        fresh = _level_sums(here, integrand, count, level)
        now = before + fresh if level == COARSEST else before / 2 + fresh
        off = np.abs(now[judged] - before[judged]) - AGREED * np.abs(now[sizes])
        agreed = np.all(off <= _NOTHING, axis=0) & (level > COARSEST)
        agreed |= np.any(np.isnan(off), axis=0)
        told, ended = now.copy(), agreed
        if size is not None:
            rest = np.abs(now[positive] - before[positive])
            ended = agreed & ~(rest > EXACT * size[rows])
            told[positive] = np.where(ended, told[positive], np.nan)
        sums[:, rows[agreed]] = told[:, agreed]
        rows, before = rows[~ended], now[:, ~ended]
    return [*sums]


def _level_sums(
    contact: _Contact, integrand: Callable[..., tuple[Array, ...]], count: int, level: int
) -> Array:
    """Sums over the nodes that this level adds."""
    total = np.zeros((count, contact.width.size))
    many = max(1, TOGETHER // contact.width.size)

    def of(value: Array) -> Array:
        return value[contact.rows]

    for part in contact.pieces():
        if part.piece.straight or not np.any(part.length):
            continue
        nodes = _nodes(level, contact.body.reach)
        share = np.zeros_like(total)
        for near_left in (True, False):
            mine = nodes[:, (nodes[0] < 0.5) == near_left, None]
            for start in range(0, mine.shape[1], many):
                q, rest, weight = mine[:, start : start + many]
                values = integrand(part.at(near_left, q, rest), of)
                for i, value in enumerate(values):
                    share[i] += _weighted(weight[:, 0], value)
        total += np.where(part.length > 0, share * part.length, 0.0)
    return total


def _weighted(weight: Array, value: Array) -> Array:
    """Sums down the columns, each to the same bits wherever it stands, as by `@` they are not."""
    return weight[0] * value[0] if weight.size == 1 else np.einsum("k,kn->n", weight, value)


@cache
def _nodes(level: int, reach: int) -> Array:
    """q, 1 - q and weights that `level` adds to the rule on (0, 1): q = 1/(1 + exp(-pi sinh t))."""
    step = 2.0**-level
    count = int(reach / step)
    t = step * np.arange(-count, count + 1)
    if level > COARSEST:
        t = t[np.arange(-count, count + 1) % 2 == 1]
    q, rest = (1 / (1 + np.exp(sign * np.pi * np.sinh(t))) for sign in (-1, 1))
    return np.array([q, rest, step * np.pi * np.cosh(t) * q * rest])


class _Flat:
    """Arguments along one dimension, and the way back."""

    def __init__(self, a: Array, c: Array, constants: dict[str, Array], *also: Array) -> None:
        flat, self.constants, self.shape = flattened((a, c, *also), constants)
        self.a, self.c, *self.also = flat

    def shaped(self, value: Array) -> Array:
        """A result in the shape of the arguments."""
        return value.reshape(self.shape)[()]
