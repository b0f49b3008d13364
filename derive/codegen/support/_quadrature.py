"""What a contact carries, by quadrature of the body's curvature.

Each element ds of the contact adds the pressure (1/pi) g''(s) L(x, s) ds for E* = 1, with

    L(x, s) = asinh sqrt(min(u, v)/(h |x - s|)),   u = (c - s)(a + x),   v = (a + s)(c - x),

and a corner adds the jump of g' there in place of g'' ds.  Load and edge coefficients follow,

    P = (1/2) int g'' w ds,   K_left = (1/(pi sqrt(h))) int g'' w/(a + s) ds,   K_right alike,
    alpha = -(1/pi) int g'/w ds.

On a convex body nothing in the first three is ever subtracted: no digit is lost, wherever the
contact lies.

The contact is cut at the body's breaks.  Where g' is polynomials, the pieces are left to Gauss's
rule, `_angles`.  On others the nodes of the double exponential rule crowd towards both ends, and
every distance to an end is a product, not a difference.  The step is halved until two sums agree;
elements that agree take no part in the next halving.
"""

from collections.abc import Callable, Collection
from functools import cache
from typing import Any

import numpy as np

from ._angles import carried, pressed
from ._arrays import Array, weighted
from ._profile import (
    TINY,
    TOGETHER,
    Elements,
    Nodes,
    Profile,
    Window,
    corners_of,
    mirrored,
    slope_of,
    uncut,
)
from ._state import State

NEAR, FAR = 4, 6
"""How far the rule goes: to 1e-37 of a piece, to 1e-275 of it where g'' is infinite."""

COARSEST, FINEST = 1, 9
"""Steps of the rule are 2**-COARSEST at first and 2**-FINEST at last."""

AGREED = 1e-11
"""Two sums that agree to this, the later one is exact to rounding."""

EXACT = 1e-13
"""Tilt and L_N whose sums agree to this are, and pressures beside a break: there sums get better
slowly."""

CUT_OFF = 1e-14
"""Where g'' is infinite at a break, a sum whose outermost terms are a larger part of it has not
come to its end: what is left out is some hundredth of them.
"""

BESIDE = 0.1
"""Smooth breaks closer to an edge than this, in parts of the width, divide nothing for L_N; a place
closer to a break is beside it.
"""

_SUMS = {
    "load": ("force",),
    "moment": ("force", "arm"),
    "tilt": ("lean",),
    "left": ("left",),
    "right": ("right",),
}
"""What is integrated for each field of a State."""

_HUGE, _NOTHING = 1e300, 1e-300


def state_of(
    body: Profile,
    a: Array,
    c: Array,
    wanted: Collection[str] = State._fields,
    /,
    **constants: Array,
) -> State:
    """Load, moment, tilt and edge coefficients of the contact [-a, c] for E* = 1.

    wanted: fields that are asked for; the others may be anything.

    NaN where [-a, c] is no contact; a load without limit where it leaves the curve.
    """
    given = Elements(a, c, constants)
    a, c, constants = given.a, given.c, given.constants
    h, mid = a + c, (c - a) / 2

    def integrand(near: "Nodes", _: Any) -> tuple[Array, ...]:
        A, B = near.from_low, near.from_high
        root = np.sqrt(A * B)
        force = near.curve.curvature * root
        return force, force / A, force / B, near.curve.slope / root, force * (A - B)

    shared = Window(body, constants, -a, c, h, ())
    if body.degree is None:
        steepest = np.maximum(*(np.abs(slope_of(body, x, **constants)[0]) for x in (-a, c)))
        sums = _integrals(shared, integrand, 5, 3, np.pi * steepest)
    else:
        sums = carried(shared, body.degree, {name for field in wanted for name in _SUMS[field]})
    force, left, right, lean, arm = sums
    if "tilt" in wanted and any(piece.straight for piece in body.pieces):
        for part in shared.pieces():
            slope = part.at_high().slope if part.piece.straight else 0.0
            if np.any(slope):
                lean = lean + np.where(part.length > 0, slope * part.angle(), 0.0)
    for _, jump, A, B in corners_of(body, a, c, constants):
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
    given = Elements(a, c, constants, x)
    a, c, constants, x = given.a, given.c, given.constants, *given.also
    h = a + c
    inside = (x > -a) & (x < c)
    x = np.where(inside, x, (c - a) / 2)
    left, right = a + x, c - x

    if body.degree is None:
        total = _pressed(body, x, a, c, constants)
    else:
        total = pressed(Window(body, constants, -a, c, h, ()), x, body.degree)
    for place, jump, A, B in corners_of(body, a, c, constants):
        peak = _beside_corner(np.minimum(B * left, A * right), h, np.abs(x - place))
        total = total + np.where((A > 0) & (B > 0), jump * peak, 0.0)
    return given.shaped(np.where(inside, total / np.pi, 0.0 * total))


def _pressed(body: Profile, x: Array, a: Array, c: Array, constants: dict[str, Array]) -> Array:
    """The integral of g''(s) L(x, s) over the curved pieces."""
    h, left, right = a + c, a + x, c - x

    def on_the_left(near: Nodes, of: Any) -> tuple[Array, ...]:
        u_or_v = near.from_low * of(right)
        return (near.curve.curvature * _asinh_root(u_or_v, of(h) * near.from_high),)

    def on_the_right(near: Nodes, of: Any) -> tuple[Array, ...]:
        u_or_v = near.from_high * of(left)
        return (near.curve.curvature * _asinh_root(u_or_v, of(h) * near.from_low),)

    total, beside = 0 * h, np.full(h.shape, False)
    for place in body.breaks(**constants):
        beside |= np.abs(x - place) < BESIDE * h
    for low, high, width, kernel in ((-a, x, left, on_the_left), (x, c, right, on_the_right)):
        window = Window(body, constants, low, high, width, ())
        (part,) = _integrals(window, kernel, 1, 1, slow=beside)
        total = total + part
    return total


def _asinh_root(over: Array, under: Array) -> Array:
    """asinh sqrt(over/under), finite even where `under` has underflown."""
    return np.arcsinh(np.sqrt(over / np.maximum(under, over / _HUGE + TINY)))


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
    given, body = Elements(a, c, constants), uncut(body)
    a, c, constants = given.a, given.c, given.constants
    left = _second_right(mirrored(body), c, a, constants)
    return given.shaped(left), given.shaped(_second_right(body, a, c, constants))


def _second_right(body: Profile, a: Array, c: Array, constants: dict[str, Array]) -> Array:
    r"""(1/pi) times the finite part of int g'' k ds, k = r (3 + 2 r**2)/(6 h**(3/2)).

    r = sqrt((a + s)/(c - s)).  Towards the edge g'' is integrated by parts, with

        int k ds = psi(r)/(3 sqrt(h)),   psi(r) = 2 r - (3/2) atan r - r/(2 (1 + r**2)),

    whose finite part at the edge is -3 pi/4: on the part that ends there, and on those before it
    from which smooth breaks close to the edge alone divide it.
    """
    h = a + c
    scale = 6 * h * np.sqrt(h)
    shared = Window(body, constants, -a, c, h, ())
    origin = _start_of_last(body, a, c, constants)

    def integrand(near: "Nodes", of: Any) -> tuple[Array, ...]:
        A, B, width, start = near.from_low, near.from_high, of(h), of(origin)
        from_start = near.start_low - start + near.from_start
        beyond = B + from_start  # from where it starts to the edge, which may be close
        r, r_0 = np.sqrt(A / B), np.sqrt(start / beyond)
        step = width * from_start / (B * beyond) / (r + r_0)
        twist = (1 - r * r_0) / ((1 + r**2) * (1 + r_0**2))
        rise = 2 * step - 1.5 * np.arctan2(step, 1 + r * r_0) - step * twist / 2
        by_parts = -near.curve.change() * (rise / near.curve.distance) * (2 * width)
        plain = near.curve.curvature * r * (3 + 2 * r**2)
        value = np.where(near.start_low >= start, by_parts, plain)
        return np.abs(value), value

    _, total = _integrals(shared, integrand, 2, 0)
    for piece in shared.pieces():
        start, beyond = piece.start_low, piece.length + piece.end_high
        r_0 = np.sqrt(origin / np.maximum(np.where(start > origin, h - origin, beyond), TINY))
        psi = 2 * r_0 - 1.5 * np.arctan(r_0) - r_0 / (2 * (1 + r_0**2))
        edge = piece.at_high().curvature * (-0.75 * np.pi - psi) * (2 * h)
        total = total + np.where(piece.ends_high & (piece.length > 0), edge, 0.0)
    return (total + _of_corners(body, a, c, constants)) / (np.pi * scale)


def _of_corners(body: Profile, a: Array, c: Array, constants: dict[str, Array]) -> Array:
    """What the corners add to the integral of g'' r (3 + 2 r**2)."""
    total = 0.0 * a
    for _, jump, A, B in corners_of(body, a, c, constants):
        r = np.sqrt(A / np.where(B > 0, B, 1.0))
        total = total + np.where(B > 0, jump * r * (3 + 2 * r**2), 0.0)
    return total


def _start_of_last(body: Profile, a: Array, c: Array, constants: dict[str, Array]) -> Array:
    """How far from the left edge integration by parts starts that goes up to the right one."""
    h, start = a + c, 0 * a
    for i, place in enumerate(body.breaks(**constants)):
        close = (i in body.smooth) & (c - place < BESIDE * h)
        start = np.where((a + place > 0) & (c - place > 0) & ~close, a + place, start)
    return start


def _integrals(
    contact: Window,
    integrand: Callable[..., tuple[Array, ...]],
    count: int,
    positive: int,
    size: Array | None = None,
    slow: Array | None = None,
) -> list[Array]:
    """Integrals over the windows, NaN where the sums do not agree; straight pieces add nothing.

    The first few are positive, and each of these has to agree for itself.  The next one, if its
    `size` is given, has to agree against that, for its own sake alone.  Where none is positive, the
    last one has to, against the first one, which is its size and need not be smooth.

    slow: whether sums get better slowly.
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
        allowed: Array = AGREED if positive or level == FINEST else EXACT
        if slow is not None and level < FINEST:
            allowed = np.where(slow[rows], EXACT, AGREED)
        alike = np.abs(now[judged] - before[judged]) <= allowed * np.abs(now[sizes]) + _NOTHING
        alike |= now[judged] == before[judged]  # both infinite
        none = np.isnan(now[judged])
        agreed = np.all(alike | none, axis=0) & ((level > COARSEST) | np.all(none, axis=0))
        told, ended = now.copy(), agreed
        if level == FINEST:  # what does not agree for itself is not told
            told[judged] = np.where(alike, told[judged], np.nan)
            agreed = np.any(alike, axis=0)
        if size is not None:
            rest = np.abs(now[positive] - before[positive])
            ended = agreed & ~(rest > EXACT * size[rows])
            told[positive] = np.where(ended, told[positive], np.nan)
        sums[:, rows[agreed]] = told[:, agreed]
        rows, before = rows[~ended], now[:, ~ended]
    if contact.body.sharp:
        outermost = _outermost(contact, integrand, count)[judged]
        sums[judged] = np.where(outermost > CUT_OFF * np.abs(sums[sizes]), np.nan, sums[judged])
    return [*sums]


def _outermost(contact: Window, integrand: Callable[..., tuple[Array, ...]], count: int) -> Array:
    """The largest of the terms at both ends of the rule, over all pieces."""
    largest = np.zeros((count, contact.width.size))
    for part in contact.pieces():
        if part.piece.straight:
            continue
        nodes = _nodes(COARSEST, FAR)
        for near_left, last in ((True, 0), (False, -1)):
            q, rest, weight = nodes[:, last, None, None]
            values = integrand(part.at(near_left, q, rest), lambda value: value)
            terms = [np.where(part.length > 0, part.length * weight * v, 0.0)[0] for v in values]
            largest = np.fmax(largest, np.abs(terms))
    return largest


def _level_sums(
    contact: Window, integrand: Callable[..., tuple[Array, ...]], count: int, level: int
) -> Array:
    """Sums over the nodes that this level adds."""
    total = np.zeros((count, contact.width.size))
    many = max(1, TOGETHER // contact.width.size)

    def of(value: Array) -> Array:
        return value[contact.rows]

    for part in contact.pieces():
        if part.piece.straight or not np.any(part.length):
            continue
        nodes = _nodes(level, FAR if contact.body.sharp else NEAR)
        share = np.zeros_like(total)
        for near_left in (True, False):
            mine = nodes[:, (nodes[0] < 0.5) == near_left, None]
            for start in range(0, mine.shape[1], many):
                q, rest, weight = mine[:, start : start + many]
                values = integrand(part.at(near_left, q, rest), of)
                for i, value in enumerate(values):
                    share[i] = weighted(weight[:, 0], value, share[i])
        total += np.where(part.length > 0, share * part.length, 0.0)
    return total


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
