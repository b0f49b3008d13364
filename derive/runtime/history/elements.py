r"""Elements on the interface: mesh, influence, and element means of what acts on them.

Shear is constant on each element; all conditions hold for means over elements, w_i wide.  With L
the length of the mesh,

    A_ij = -(1/pi) int_i int_j ln(|x - xi|/(2 L)) dxi dx

is E*/2 times the displacement of element i, integrated over it, by unit shear on element j:
symmetric and positive definite.  Of a change of Q and sigma under which all sticks, the rate is

    dq/dt = [Q'/pi - (sigma'/4) (x - mid)]/sqrt((a + x)(c - x)),

whose integral over x is closed.  It is integrated along the way of the edges, too, so that what
comes into contact sticks from then on, and a growing edge makes no slip of its own.
"""

import math
from typing import Any

import numpy as np

from ..kernels import LAW, kernel, matrix, real, results, vector, whole

COSINE, EVEN, PLACE = 0.0, 1.0, 2.0
"""Kinds of a part of the mesh: crowded at both its ends, even, crowded at its middle."""

GRADING = 4.0
"""Distance from a place that is crowded towards, over the width of an element there."""

_TIMES, _SHARES = np.polynomial.legendre.leggauss(5)
_TIMES, _SHARES = (1 + _TIMES) / 2, _SHARES / 2

_INNER = 0.5 - 0.5 / math.sqrt(3.0)
"""Gauss's rule of two nodes on (0, 1)."""

TERMS, AGREED = 20, 1e-7
"""Terms of the series of a smooth pressure, half as many at first, and when they are enough."""

_COSINES = np.cos(np.pi * np.arange(4 * TERMS) / (2 * TERMS))


# ---------------------------------------------------------------- mesh


@kernel(real(matrix, real))
def _elements_before(parts: Any, x: float) -> float:
    """The sum over all parts of the elements before x; a part is kind, start, end, elements."""
    total = 0.0
    for k in range(parts.shape[0]):
        kind, start, end, count = parts[k]
        if not end > start:
            continue
        u = min(max((x - start) / (end - start), 0.0), 1.0)
        if kind == COSINE:
            u = math.acos(1 - 2 * u) / math.pi
        elif kind == PLACE:
            away, side = 2 * u - 1, count / (2 * GRADING)
            u = (1 + math.copysign(math.log1p(abs(away) * math.expm1(side)) / side, away)) / 2
        total += count * u
    return total


@kernel(vector(matrix, real, real, vector, whole))
def mesh(parts: Any, start: float, end: float, breaks: Any, count: int) -> Any:
    """Ends of so many elements, shared out as the parts ask for, one of them at every break."""
    first = _elements_before(parts, start)
    each = (_elements_before(parts, end) - first) / count
    ends = np.empty(count + 1)
    ends[0], ends[count] = start, end
    for i in range(1, count):
        low, high = ends[i - 1], end
        for _ in range(40):
            middle = (low + high) / 2
            if _elements_before(parts, middle) < first + i * each:
                low = middle
            else:
                high = middle
        ends[i] = (low + high) / 2
    for place in breaks:
        if start < place < end:
            nearest: Any = min(max(np.argmin(np.abs(ends - place)), 1), count - 1)
            ends[nearest] = place
    return ends


# ---------------------------------------------------------------- influence


@kernel(real(real))
def _twice(v: float) -> float:
    """The second integral of ln|v|."""
    return v * v * (math.log(abs(v)) / 2 - 0.75) if v != 0 else 0.0


@kernel(matrix(vector))
def influence(ends: Any) -> Any:
    """A."""
    count = ends.size - 1
    unit = 2 * (ends[count] - ends[0])
    A = np.empty((count, count))
    for i in range(count):
        for j in range(i + 1):
            r, s, t, u = ends[i], ends[i + 1], ends[j], ends[j + 1]
            if min(abs(r - u), abs(t - s)) > 20 * max(s - r, u - t):
                # far away: the logarithm at four pairs of Gauss's nodes
                total = 0.0
                for k in range(4):
                    x = r + (s - r) * (_INNER if k < 2 else 1 - _INNER)
                    y = t + (u - t) * (_INNER if k % 2 == 0 else 1 - _INNER)
                    total += math.log(abs(x - y) / unit)
                total *= (s - r) * (u - t) / 4
            else:
                total = (
                    _twice((s - t) / unit)
                    + _twice((r - u) / unit)
                    - _twice((r - t) / unit)
                    - _twice((s - u) / unit)
                ) * unit**2
            A[i, j] = A[j, i] = -total / math.pi
    return A


@kernel(whole(matrix, whole))
def factored(A: Any, count: int) -> int:
    """Cholesky's factor of the leading block, in place: A = U^T U; 0 where there is none.

    Four rows of U at a time are taken off what is below them, which halves the time.
    """
    for first in range(0, count, 4):
        last = min(first + 4, count)
        for k in range(first, last):
            if not A[k, k] > 0:
                return 0
            root = math.sqrt(A[k, k])
            for j in range(k, count):
                A[k, j] /= root
            for i in range(k + 1, last):
                by = A[k, i]
                for j in range(i, count):
                    A[i, j] -= by * A[k, j]
        if last < first + 4:
            break
        p, q, r, s = A[first], A[first + 1], A[first + 2], A[first + 3]
        for i in range(last, count):
            row, by_p, by_q, by_r, by_s = A[i], p[i], q[i], r[i], s[i]
            for j in range(i, count):
                row[j] -= by_p * p[j] + by_q * q[j] + by_r * r[j] + by_s * s[j]
    return 1


@kernel(whole(matrix, whole, vector))
def resolved(U: Any, count: int, b: Any) -> int:
    """The solution of U^T U x = b, in place of b."""
    for k in range(count):
        b[k] /= U[k, k]
        for j in range(k + 1, count):
            b[j] -= U[k, j] * b[k]
    for k in range(count - 1, -1, -1):
        total = b[k]
        for j in range(k + 1, count):
            total -= U[k, j] * b[j]
        b[k] = total / U[k, k]
    return 1


@kernel(matrix(matrix))
def inverse_of(A: Any) -> Any:
    """The inverse of A; all zero where there is none."""
    count = A.shape[0]
    U, B = A.copy(), np.zeros((count, count))
    if factored(U, count):
        for i in range(count):
            B[i, i] = 1.0
            resolved(U, count, B[i])
    return B


# ---------------------------------------------------------------- what acts on elements


@kernel(results(2)(LAW, vector, real, real, whole, vector))
def _expanded(law: Any, own: Any, a: float, c: float, count: int, series: Any) -> Any:
    """Chebyshev's series of the pressure over sqrt((a + x)(c - x)), in so many terms: the largest
    of the last three and of all."""
    tail, most = 0.0, 0.0
    values = np.empty(count)
    for j in range(count):
        angle = math.pi * (j + 0.5) / count
        s = (a + c) * math.cos(angle / 2) ** 2
        root = (a + c) / 2 * math.sin(angle)
        values[j] = law.pressure(s - a, a, c, own) / root
    series[:] = 0.0
    for k in range(count):
        for j in range(count):
            turn = TERMS // count * k * (2 * j + 1) % (4 * TERMS)
            series[k] += values[j] * _COSINES[turn] * (2.0 / count)
        most = max(most, abs(series[k]))
        if k >= count - 3:
            tail = max(tail, abs(series[k]))
    return tail, most


@kernel(whole(LAW, vector, real, real, vector))
def expand(law: Any, own: Any, a: float, c: float, series: Any) -> int:
    """Find the series of the pressure; its first term is NaN where it does not converge, as at a
    corner or kink.  It spares many pressures that are integrals."""
    for count in (TERMS // 2, TERMS):
        tail, most = _expanded(law, own, a, c, count, series)
        if tail < AGREED * most:
            return 1
    series[0] = math.nan
    return 0


@kernel(real(LAW, vector, vector, real, real, real))
def pressure_at(law: Any, own: Any, series: Any, x: float, a: float, c: float) -> float:
    """The pressure: of the series, by Clenshaw's rule, where there is one."""
    if math.isnan(series[0]) or not -a < x < c:
        return law.pressure(x, a, c, own)  # type: ignore[no-any-return]
    t = (2 * x + a - c) / (a + c)
    u = v = 0.0
    for k in range(series.size - 1, 0, -1):
        u, v = 2 * t * u - v + series[k], u
    return (t * u - v + series[0] / 2) * math.sqrt((a + x) * (c - x))


@kernel(whole(LAW, vector, vector, vector, real, real, real, vector))
def mean_pressures(
    law: Any, own: Any, series: Any, ends: Any, a: float, c: float, load: float, p: Any
) -> int:
    """Means of the pressure over the elements into p, made to carry the load."""
    total = 0.0
    for i in range(p.size):
        low, high = max(ends[i], -a), min(ends[i + 1], c)
        p[i] = 0.0
        if not high > low:
            continue
        size = high - low
        left, right = low + a <= 1e-9 * size, c - high <= 1e-9 * size
        for k in range(2):
            if left or right:
                # p = sqrt(s) (k + l s) from an edge, at the nodes of the rule for sqrt(s)
                s = size * (0.28994919792569 if k == 0 else 0.82116191318542)
                weight = 0.27755599823067 if k == 0 else 0.38911066843600
                weight *= math.sqrt(size / s)
                x = low + s if left else high - s
            else:
                x, weight = low + size * (_INNER if k == 0 else 1 - _INNER), 0.5
            p[i] += weight * pressure_at(law, own, series, x, a, c) * size
        total += p[i]
    for i in range(p.size):
        p[i] *= load / (total * (ends[i + 1] - ends[i])) if total > 0 else 0.0
    return 1


@kernel(real(real, real, real, real, real))
def _stuck_force(x: float, a: float, c: float, dQ: float, dsigma: float) -> float:
    """int of the full-stick change from the middle of the contact to x."""
    half, away = (a + c) / 2, x - (c - a) / 2
    away = min(max(away, -half), half)
    angle = math.asin(min(max(away / half, -1.0), 1.0))
    return dQ / math.pi * angle + dsigma / 4 * math.sqrt(max(half**2 - away**2, 0.0))


@kernel(real(real, vector, vector, real, real))
def _stuck_on_the_way(x: float, before: Any, now: Any, dQ: float, dsigma: float) -> float:
    """The mean of the same while the edges a, c move evenly; from where an edge passes x on it
    changes like a root."""
    a, c, da, dc = before[0], before[1], now[0] - before[0], now[1] - before[1]
    comes, goes = not -a < x < c, not -now[0] < x < now[1]
    passed, total = 0.0, 0.0
    if comes != goes:
        left = x <= -a if comes else x <= -now[0]
        passed = (-a - x) / da if left else (x - c) / dc
        rest = passed if comes else 1 - passed
        still = before if comes else now
        total = rest * _stuck_force(x, still[0], still[1], dQ, dsigma)
    for k in range(_TIMES.size):
        t, share = _TIMES[k], _SHARES[k]
        if comes and not goes:
            t, share = passed + (1 - passed) * t * t, share * 2 * t * (1 - passed)
        elif goes and not comes:
            t, share = passed * (1 - t * t), share * 2 * t * passed
        total += share * _stuck_force(x, a + t * da, c + t * dc, dQ, dsigma)
    return total


@kernel(whole(vector, vector, vector, real, real, vector))
def add_full_stick(ends: Any, before: Any, now: Any, dQ: float, dsigma: float, q: Any) -> int:
    """Add to q the change under which all sticks, while the edges a, c move evenly."""
    still = before[0] == now[0] and before[1] == now[1]
    last = 0.0
    for i in range(ends.size):
        if still:
            following = _stuck_force(ends[i], now[0], now[1], dQ, dsigma)
        else:
            following = _stuck_on_the_way(ends[i], before, now, dQ, dsigma)
        if i > 0:
            q[i - 1] += (following - last) / (ends[i] - ends[i - 1])
        last = following
    return 1
