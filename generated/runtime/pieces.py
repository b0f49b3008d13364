"""State, pressure and series of a contact: one quadrature rule for every convex body.

Each element ds of the contact [-a, c] adds the pressure (1/pi) g''(s) L(x, s) ds for E* = 1, with

    L(x, s) = asinh sqrt(min(u, v)/(h |x - s|)),   u = (c - s)(a + x),   v = (a + s)(c - x),

and a corner adds the jump of g' there in place of g'' ds.  Load and edge coefficients follow,

    P = (1/2) int g'' w ds,   K_left = (1/(pi sqrt(h))) int g'' w/(a + s) ds,   K_right alike,
    alpha = -(1/pi) int g'/w ds.

For a convex body P, K_left and K_right have no negative terms, so that no digits are lost, wherever
the contact lies.  The contact is cut at the body's breaks, and for the pressure also at x.  On each
part the nodes of the double exponential rule crowd towards both ends, and every distance from an
end is a product, not a difference.  The step is halved until two successive sums agree.

Formulas that have the same form on both sides of a contact are written once: for the other side the
body is mirrored.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from .elementary import EPS, NOTHING
from .kernels import kernel, real, results, shared, value_of, vector, whole

FARTHEST = 6
"""Largest t of the rule; a node there lies 1e-275 of the part's length from its end.  The rule
stops earlier once its terms are negligible."""

MAX_LEVEL = 8
"""The step of the rule is 1 initially and is halved down to 2**-MAX_LEVEL."""

QUADRATURE_RTOL = 1e-12
"""If two sums agree to within this, the later one is exact to rounding."""


class Curve(NamedTuple):
    """A body given by its curve, which is cut into pieces at its breaks (at least one).

    beside   (piece, side, t, own) -> g', g'' and t g''' on a piece, numbered from the left, at the
             distance t > 0 from its left break (side = 1) or its right one (side = -1)
    breaks   (own) -> positions of the breaks, from left to right
    corners  (own) -> jumps of g' at the breaks
    """

    beside: Any
    breaks: Any
    corners: Any


class Part(NamedTuple):
    """The part of one piece inside a window of the contact, as it is or mirrored.

    piece, sense   the piece's number; 1, or -1 if it is mirrored
    length         [m]
    past, ahead    distances from the piece's breaks to the part's ends [m]
    extent         length relative to the contact width
    start, end     distances from the window's ends to the part's ends, relative to the width
    """

    piece: Any
    sense: Any
    length: Any
    past: Any
    ahead: Any
    extent: Any
    start: Any
    end: Any


_beside_value = value_of(results(3)(whole, real, real, vector))
_breaks_value = value_of(vector(vector))
_integrand = value_of(results(5)(results(7), results(3)))


@shared
def curve_of(beside: Any, breaks: Any, corners: Any) -> Curve:
    """A curve from its three kernels."""
    return Curve(_beside_value(beside), _breaks_value(breaks), _breaks_value(corners))


# ---------------------------------------------------------------- the contact's parts


@kernel
def _part(breaks: Any, piece: int, low: float, high: float, h: float, sense: float) -> Part:
    """The part of a piece inside the window [low, high]."""
    width = high - low
    length, start, end, past, ahead = width, 0.0, 0.0, math.inf, math.inf
    if 0 < piece < breaks.size:
        length = min(length, breaks[piece] - breaks[piece - 1])
    if piece > 0:
        left = breaks[piece - 1]
        start, past = max(left - low, 0.0), max(low - left, 0.0)
        length = min(length, high - left)
    if piece < breaks.size:
        right = breaks[piece]
        end, ahead = max(high - right, 0.0), max(right - high, 0.0)
        length = min(length, right - low)
    if sense < 0:
        start, end, past, ahead = end, start, ahead, past
    length = max(length, 0.0)
    return Part(piece, sense, length, past, ahead, length / h, start / h, end / h)


@kernel
def _at(curve: Any, part: Any, q: float, rest: float, own: Any) -> tuple[float, ...]:
    """A node: the curve at the fractions q and rest = 1 - q of a part, seen from the nearer break.

    The values are g', g'', t g''' and t, the distance from the nearer break [m].  Three distances
    relative to the contact width follow: from the window's start, from its end, and from the
    part's start.
    """
    before, behind = part.past + part.length * q, part.ahead + part.length * rest
    side = part.sense if before <= behind else -part.sense
    t = max(min(before, behind), NOTHING)
    slope, curvature, change = curve.beside(part.piece, side, t, own)
    along = part.extent * q
    start, end = max(part.start + along, NOTHING), max(part.end + part.extent * rest, NOTHING)
    return part.sense * slope, curvature, part.sense * change, t, start, end, along


@kernel
def slope(curve: Any, x: float, own: Any) -> tuple[float, float]:
    """g'(x) and g''(x); at a break those of the piece on its right."""
    breaks = curve.breaks(own)
    piece = 0
    while piece < breaks.size and x >= breaks[piece]:
        piece += 1
    node = _at(curve, _part(breaks, piece, x, x, 1.0, 1.0), 0.5, 0.5, own)
    return node[0], node[1]


# ---------------------------------------------------------------- the rule


def _rule() -> Any:
    """q, 1 - q, weights and t of the rule on (0, 1) with q = 1/(1 + exp(pi sinh t)), t >= 0.

    The first nodes are those of step 1, t = 0, 1, ..., FARTHEST.  Each further level halves the
    step and adds the nodes that lie between the existing ones.  For t < 0, q and 1 - q change
    places; t = 0 is therefore used twice, with half its weight.
    """
    levels = [np.arange(FARTHEST + 1.0)]
    levels += [np.arange(0.5**n, FARTHEST, 2 * 0.5**n) for n in range(1, MAX_LEVEL + 1)]
    t = np.concatenate(levels)
    q, rest = (1 / (1 + np.exp(sign * np.pi * np.sinh(t))) for sign in (1, -1))
    weight = np.pi * np.cosh(t) * q * rest
    weight[0] /= 2
    return np.column_stack((q, rest, weight, t))


RULE = _rule()


@kernel
def _coarsest(part: Any) -> int:
    """The first level at which the agreement of two sums is trusted.

    A singularity close beyond an end, where the neighbouring part is short, shows only on fine
    levels.  On coarser levels sums may agree by chance.
    """
    h = part.length / part.extent
    for gap in (part.start + part.past / h, part.end + part.ahead / h):
        if 0 < gap < 0.03 * part.extent:  # the neighbouring part is short
            return 4
    return 2


@kernel
def _integrate(integrand: Any, given: Any, curve: Any, part: Any, own: Any, total: Any) -> None:
    """Add the integrals over a part to `total`; NaN where the sums do not agree or do not converge.

    If the first integral is infinite or NaN, the part extends beyond the body's curve, and all
    integrals are infinite.  From the third level on, the rule stops at the largest t whose terms
    have changed the sums so far.

    integrand: returns its values, as many as `total` holds, from a node and three given numbers.
    """
    if not part.length > 0:
        return
    sums, sizes, before = np.zeros(total.size), np.zeros(total.size), np.zeros(total.size)
    coarsest, reach, done = _coarsest(part), 0.0, 0
    for level in range(MAX_LEVEL + 1):
        nodes = 1 + (FARTHEST << level)
        for j in range(done, nodes):
            weight, t = RULE[j, 2], RULE[j, 3]
            if level > 1 and t >= reach + 0.5:
                break
            for side in range(2):
                node = _at(curve, part, RULE[j, side], RULE[j, 1 - side], own)
                values = integrand(node, given)
                for i in range(total.size):
                    size = sizes[i]
                    sums[i] += weight * values[i]
                    sizes[i] += abs(weight * values[i])
                    if sizes[i] != size:
                        reach = max(reach, t)
                        if t == FARTHEST:  # the sum has not converged
                            sums[i] = math.nan
        done = nodes
        if not sizes[0] < math.inf:
            total[:] = math.inf
            return
        agree = level >= coarsest
        for i in range(total.size):
            difference = abs(sums[i] - 2 * before[i])
            allowed = QUADRATURE_RTOL * sizes[i] + EPS * sizes[0]
            if level == MAX_LEVEL and not difference <= allowed:
                sums[i] = math.nan
            agree = agree and (difference <= allowed or math.isnan(sums[i]))
            before[i] = sums[i]
        if agree:
            total += 0.5**level * part.length * sums
            return


# ---------------------------------------------------------------- load, moment, tilt, K_N


@kernel
def _of_state(node: Any, _: Any) -> tuple[float, ...]:
    """g'' w, g'' w/(a + s), g'' w/(c - s), g'/w and g'' w (2 s + a - c), relative to the width."""
    slope, curvature, _, _, start, end, _ = node
    root = math.sqrt(start / end)
    w = root * end
    force = curvature * w
    return force, curvature / root, curvature * root, slope / w, force * (start - end)


@kernel
def state(curve: Any, a: float, c: float, own: Any) -> tuple[float, ...]:
    """Load, moment, tilt, K_N at the left and the right edge, for E* = 1.

    NaN where [-a, c] is not a contact, and for quantities that are infinite, such as K_N where g''
    is infinite at an edge.  The load is infinite where the contact extends beyond the body's curve.
    """
    h, total = a + c, np.zeros(5)
    if not 0 < h < math.inf:
        return math.nan, math.nan, math.nan, math.nan, math.nan
    breaks, corners = curve.breaks(own), curve.corners(own)
    for piece in range(breaks.size + 1):
        part = _part(breaks, piece, -a, c, h, 1.0)
        _integrate(_integrand(_of_state), (0.0, 0.0, 0.0), curve, part, own, total)
    for i in range(breaks.size):
        A, B = (a + breaks[i]) / h, (c - breaks[i]) / h
        if corners[i] > 0 and A > 0 and B > 0:
            root = math.sqrt(A) * math.sqrt(B)
            total[0] += corners[i] * root
            total[1] += corners[i] * root / A
            total[2] += corners[i] * root / B
            total[4] += corners[i] * root * (A - B)
    load, root = h * total[0] / 2, math.pi * math.sqrt(h)
    if not 0 < load < math.inf:
        load = math.inf if load == math.inf else math.nan
        return load, math.nan, math.nan, math.nan, math.nan
    moment = (a - c) / 2 * load - h * h * total[4] / 8
    return load, moment, -total[3] / (math.pi * h), total[1] / root, total[2] / root


# ---------------------------------------------------------------- pressure


@kernel
def _of_pressure(node: Any, given: Any) -> tuple[float, ...]:
    """g''(s) L(x, s), x being the window's end; its distance from the edge behind it is given."""
    _, curvature, _, _, start, end, _ = node
    return curvature * math.asinh(math.sqrt(start * given[0] / end)), 0.0, 0.0, 0.0, 0.0


@kernel
def pressure(curve: Any, x: float, a: float, c: float, own: Any) -> float:
    """The pressure at x for E* = 1; zero outside the contact, infinite only at a corner."""
    h, left, right, total = a + c, a + x, c - x, np.zeros(1)
    if not 0 < h < math.inf or math.isnan(x):
        return math.nan
    if left <= 0 or right <= 0:
        return 0.0
    breaks, corners = curve.breaks(own), curve.corners(own)
    for piece in range(breaks.size + 1):
        before, behind = _part(breaks, piece, -a, x, h, 1.0), _part(breaks, piece, x, c, h, -1.0)
        for part, to_edge in ((before, right / h), (behind, left / h)):
            given = to_edge, 0.0, 0.0
            _integrate(_integrand(_of_pressure), given, curve, part, own, total)
    if not total[0] < math.inf:
        return math.nan
    for i in range(breaks.size):
        A, B, away = a + breaks[i], c - breaks[i], abs(x - breaks[i])
        if corners[i] > 0 and A > 0 and B > 0:
            if away == 0:
                return math.inf
            ratio = min(B * left, A * right) / h / away
            total[0] += corners[i] * math.asinh(math.sqrt(ratio))
    return total[0] / math.pi


# ---------------------------------------------------------------- L_N


@shared
def _psi(r: float) -> float:
    """3 sqrt(h) times the antiderivative of k that vanishes at the far edge."""
    return 2 * r - 1.5 * math.atan(r) - r / (2 * (1 + r * r))


@kernel
def _of_second(node: Any, _: Any) -> tuple[float, ...]:
    """g'' r (3 + 2 r**2)."""
    _, curvature, _, _, start, end, _ = node
    square = start / end
    return curvature * math.sqrt(square) * (3 + 2 * square), 0.0, 0.0, 0.0, 0.0


@kernel
def _of_second_by_parts(node: Any, given: Any) -> tuple[float, ...]:
    """-2 t g''' (psi(r) - psi(r_0))/t.

    Three numbers are given: r_0; the distance from the point at which r = r_0 to the edge; and the
    distance from that point to the start of the part.
    """
    r_0, to_edge, offset = given
    _, _, change, t, start, end, along = node
    r = math.sqrt(start / end)
    step = (offset + along) / (end * to_edge) / (r + r_0)
    twist = (1 - r * r_0) / ((1 + r * r) * (1 + r_0 * r_0))
    rise = 2 * step - 1.5 * math.atan2(step, 1 + r * r_0) - step * twist / 2
    if abs(rise) > 1e300 * t:  # next to an edge that lies at a break
        return -2 * (change / t) * rise, 0.0, 0.0, 0.0, 0.0
    return -2 * change * (rise / t), 0.0, 0.0, 0.0, 0.0


@kernel
def _is_smooth(curve: Any, i: int, own: Any) -> bool:
    """Whether g'' is continuous at a break, and neither zero nor infinite there."""
    _, left, of_left = curve.beside(i, -1.0, NOTHING, own)
    _, right, of_right = curve.beside(i + 1, 1.0, NOTHING, own)
    return abs(left - right) + abs(of_left) + abs(of_right) < 1e-12 * (left + right)


@kernel
def _second(curve: Any, a: float, c: float, own: Any, sense: float) -> float:
    """The coefficient of s**(3/2) at the right edge, or at the left edge if the body is mirrored.

    It is (1/pi) times the finite part of int g'' k ds, k = r (3 + 2 r**2)/(6 h**(3/2)), with
    r = sqrt((a + s)/(c - s)).  Close to the edge g'' is integrated by parts, with

        int k ds = psi(r)/(3 sqrt(h)),   psi(r) = 2 r - (3/2) atan r - r/(2 (1 + r**2)),

    whose finite part at the edge is -3 pi/4.  Integration by parts covers the region between the
    last break and the edge.  Smooth breaks close to the edge do not count as the last break,
    because large terms would cancel.
    """
    h, total = a + c, np.zeros(1)
    if not 0 < h < math.inf:
        return math.nan
    breaks, corners = curve.breaks(own), curve.corners(own)
    origin, to_edge = 0.0, 1.0
    for i in range(breaks.size):
        A, B = (a + breaks[i]) / h, (c - breaks[i]) / h
        if sense < 0:
            A, B = B, A
        if A <= 0 or B <= 0:
            continue
        if corners[i] > 0:
            square = A / B
            total[0] += corners[i] * math.sqrt(square) * (3 + 2 * square)
        if origin < A and (B > 0.1 or not _is_smooth(curve, i, own)):
            origin, to_edge = A, B
    r_0 = math.sqrt(origin / to_edge)
    for piece in range(breaks.size + 1):
        part = _part(breaks, piece, -a, c, h, sense)
        if part.start < origin:
            _integrate(_integrand(_of_second), (0.0, 0.0, 0.0), curve, part, own, total)
        else:
            given = r_0, to_edge, part.start - origin
            scaled = np.zeros(1)
            _integrate(_integrand(_of_second_by_parts), given, curve, part, own, scaled)
            total += h * scaled
            if part.length > 0 and part.end == 0:
                edge = _at(curve, part, 1.0, 0.0, own)[1]
                total[0] -= 2 * h * edge * (0.75 * math.pi + _psi(r_0))
    if not math.isfinite(total[0]):
        return math.nan
    return total[0] / (6 * math.pi * h * math.sqrt(h))


@kernel
def series(curve: Any, a: float, c: float, own: Any) -> tuple[float, ...]:
    """Coefficients of s**(3/2) at both edges for E* = 1."""
    return _second(curve, a, c, own, -1.0), _second(curve, a, c, own, 1.0)
