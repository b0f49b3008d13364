r"""Elements on the interface: mesh, influence matrix, mean pressure and mean full-stick shear.

The shear traction is constant on each element, and all conditions hold for means over the elements.
With w_i the width of element i and L the length of the mesh,

    A_ij = -(1/pi) int_i int_j ln(|x - xi|/(2 L)) dxi dx

is E*/2 times the integral over element i of the displacement due to a unit traction on element j.
A is symmetric and positive definite.  While Q and sigma change under full stick, the shear traction
changes at the rate

    dq/dt = [Q'/pi - (sigma'/4) (x - mid)]/sqrt((a + x)(c - x)),

whose integral over x has a closed form.  The rate is also integrated along the motion of the edges,
so that points that come into contact stick from then on, and the advance of an edge causes no slip.
"""

import math
from typing import Any

import numpy as np

from ..kernels import LAW, kernel, matrix, real, results, vector, whole

COSINE, EVEN, CENTRED = 0.0, 1.0, 2.0
"""Kinds of a part of the mesh: refined towards both ends, uniform, refined towards its centre."""

GRADING = 4.0
"""Distance from the centre of a refined part, divided by the width of an element there."""
DEEPEST = 8.0
"""Largest logarithm of the ratio of that distance at the ends of the part to that of its smallest
elements.  Much smaller elements would leave no digits in the influence matrix."""

NARROWEST = 0.1
"""Smallest width of an element next to a break relative to the width without the break."""

_TIMES, _WEIGHTS = np.polynomial.legendre.leggauss(5)
_TIMES, _WEIGHTS = (1 + _TIMES) / 2, _WEIGHTS / 2

_INNER = 0.5 - 0.5 / math.sqrt(3.0)
"""The first node of Gauss's rule with two nodes on (0, 1)."""

TERMS, AGREED = 20, 1e-7
"""Largest number of terms of the series of a pressure, of which half are tried first, and the size
of the last terms, relative to the largest, below which the series has converged."""

_COSINES = np.cos(np.pi * np.arange(4 * TERMS) / (2 * TERMS))


# ---------------------------------------------------------------- mesh


@kernel(real(matrix, real))
def _elements_before(parts: Any, x: float) -> float:
    """Number of elements left of x.  A part is a row: kind, start, end, number of elements."""
    total = 0.0
    for k in range(parts.shape[0]):
        kind, start, end, count = parts[k]
        if not end > start:
            continue
        u = min(max((x - start) / (end - start), 0.0), 1.0)
        if kind == COSINE:
            u = math.acos(1 - 2 * u) / math.pi
        elif kind == CENTRED:
            offset, side = 2 * u - 1, min(count / (2 * GRADING), DEEPEST)
            u = (1 + math.copysign(math.log1p(abs(offset) * math.expm1(side)) / side, offset)) / 2
        total += count * u
    return total


@kernel(vector(matrix, real, real, vector, whole))
def mesh(parts: Any, start: float, end: float, breaks: Any, count: int) -> Any:
    """Ends of `count` elements, distributed as the parts prescribe, with an end at every break.

    A break between two ends that are at breaks already, or very close to one of them, is left out.
    """
    first = _elements_before(parts, start)
    step = (_elements_before(parts, end) - first) / count
    ends, fixed = np.empty(count + 1), np.zeros(count + 1, np.bool_)
    ends[0], ends[count] = start, end
    fixed[0] = fixed[count] = True
    for i in range(1, count):
        low, high = ends[i - 1], end
        for _ in range(40):
            middle = (low + high) / 2
            if _elements_before(parts, middle) < first + i * step:
                low = middle
            else:
                high = middle
        ends[i] = (low + high) / 2
    for x in breaks:
        if start < x < end:
            right: Any = np.searchsorted(ends, x)
            left = right - 1
            size = ends[right] - ends[left]
            to_left = fixed[right] or (x - ends[left] < ends[right] - x and not fixed[left])
            moved = left if to_left else right
            other = right if to_left else left
            if not fixed[moved] and abs(x - ends[other]) > NARROWEST * size:
                ends[moved], fixed[moved] = x, True
    return ends


# ---------------------------------------------------------------- influence


@kernel(real(real))
def _second_integral(v: float) -> float:
    """The second integral of ln|v|."""
    return v * v * (math.log(abs(v)) / 2 - 0.75) if v != 0 else 0.0


@kernel(matrix(vector))
def influence(ends: Any) -> Any:
    """The influence matrix A."""
    count = ends.size - 1
    unit = 2 * (ends[count] - ends[0])
    A = np.empty((count, count))
    for i in range(count):
        for j in range(i + 1):
            r, s, t, u = ends[i], ends[i + 1], ends[j], ends[j + 1]
            if min(abs(r - u), abs(t - s)) > 20 * max(s - r, u - t):
                # distant elements: the logarithm at four pairs of Gauss nodes
                total = 0.0
                for k in range(4):
                    x = r + (s - r) * (_INNER if k < 2 else 1 - _INNER)
                    y = t + (u - t) * (_INNER if k % 2 == 0 else 1 - _INNER)
                    total += math.log(abs(x - y) / unit)
                total *= (s - r) * (u - t) / 4
            else:
                total = (
                    _second_integral((s - t) / unit)
                    + _second_integral((r - u) / unit)
                    - _second_integral((r - t) / unit)
                    - _second_integral((s - u) / unit)
                ) * unit**2
            A[i, j] = A[j, i] = -total / math.pi
    return A


@kernel(whole(matrix, whole))
def factored(A: Any, count: int) -> int:
    """Replace the leading block of A by its Cholesky factor, A = U^T U; return 0 if there is none.

    Four rows of U at a time are subtracted from the rows below them, which halves the time.
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
    """Replace b by the solution of U^T U x = b."""
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
    """The inverse of A; all zeros if A has no Cholesky factor."""
    count = A.shape[0]
    U, B = A.copy(), np.zeros((count, count))
    if factored(U, count):
        for i in range(count):
            B[i, i] = 1.0
            resolved(U, count, B[i])
    return B


# ---------------------------------------------------------------- pressure and full-stick shear


@kernel(results(2)(LAW, vector, real, real, whole, vector))
def _expanded(law: Any, own: Any, a: float, c: float, count: int, series: Any) -> Any:
    """Compute `count` terms of the Chebyshev series of pressure over sqrt((a + x)(c - x)).

    Returns the largest magnitude among the last three coefficients, and among all.
    """
    tail, largest = 0.0, 0.0
    values = np.empty(count)
    for j in range(count):
        angle = math.pi * (j + 0.5) / count
        s = (a + c) * math.cos(angle / 2) ** 2
        root = (a + c) / 2 * math.sin(angle)
        values[j] = law.pressure(s - a, a, c, own) / root
    series[:] = 0.0
    for k in range(count):
        for j in range(count):
            index = TERMS // count * k * (2 * j + 1) % (4 * TERMS)
            series[k] += values[j] * _COSINES[index] * (2.0 / count)
        largest = max(largest, abs(series[k]))
        if k >= count - 3:
            tail = max(tail, abs(series[k]))
    return tail, largest


@kernel(whole(LAW, vector, real, real, vector))
def expand(law: Any, own: Any, a: float, c: float, series: Any) -> int:
    """Compute the series of the pressure; its first term is NaN if it does not converge.

    It does not converge if the profile has a corner or kink in the contact.  The series saves many
    evaluations of pressures that are computed as integrals.
    """
    for count in (TERMS // 2, TERMS):
        tail, largest = _expanded(law, own, a, c, count, series)
        if tail < AGREED * largest:
            return 1
    series[0] = math.nan
    return 0


@kernel(real(LAW, vector, vector, real, real, real))
def pressure_at(law: Any, own: Any, series: Any, x: float, a: float, c: float) -> float:
    """The pressure, from its series by Clenshaw's rule if the series converges."""
    if math.isnan(series[0]) or not -a < x < c:
        return law.pressure(x, a, c, own)
    t = (2 * x + a - c) / (a + c)
    u = v = 0.0
    for k in range(series.size - 1, 0, -1):
        u, v = 2 * t * u - v + series[k], u
    return (t * u - v + series[0] / 2) * math.sqrt((a + x) * (c - x))


@kernel(whole(LAW, vector, vector, vector, real, real, real, vector))
def mean_pressures(
    law: Any, own: Any, series: Any, ends: Any, a: float, c: float, load: float, p: Any
) -> int:
    """Write mean pressures of the elements into p, scaled so that they carry the load."""
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
                # next to an edge p = sqrt(s) (k + l s): nodes of the Gauss rule for sqrt(s)
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
def _full_stick_force(x: float, a: float, c: float, dQ: float, dsigma: float) -> float:
    """Integral of the full-stick change in shear from the middle of the contact to x."""
    half, offset = (a + c) / 2, x - (c - a) / 2
    offset = min(max(offset, -half), half)
    angle = math.asin(min(max(offset / half, -1.0), 1.0))
    return dQ / math.pi * angle + dsigma / 4 * math.sqrt(max(half**2 - offset**2, 0.0))


@kernel(real(real, vector, vector, real, real))
def _mean_full_stick_force(x: float, before: Any, now: Any, dQ: float, dsigma: float) -> float:
    """Mean of `_full_stick_force` over a step in which the edges a, c move uniformly.

    Near the time at which an edge passes x, it varies like the square root of the time difference.
    """
    a, c, da, dc = before[0], before[1], now[0] - before[0], now[1] - before[1]
    enters, leaves = not -a < x < c, not -now[0] < x < now[1]
    passed, total = 0.0, 0.0
    if enters != leaves:
        left = x <= -a if enters else x <= -now[0]
        passed = (-a - x) / da if left else (x - c) / dc
        rest = passed if enters else 1 - passed
        outside = before if enters else now
        total = rest * _full_stick_force(x, outside[0], outside[1], dQ, dsigma)
    for k in range(_TIMES.size):
        t, weight = _TIMES[k], _WEIGHTS[k]
        if enters and not leaves:
            t, weight = passed + (1 - passed) * t * t, weight * 2 * t * (1 - passed)
        elif leaves and not enters:
            t, weight = passed * (1 - t * t), weight * 2 * t * passed
        total += weight * _full_stick_force(x, a + t * da, c + t * dc, dQ, dsigma)
    return total


@kernel(whole(vector, vector, vector, real, real, vector))
def add_full_stick(ends: Any, before: Any, now: Any, dQ: float, dsigma: float, q: Any) -> int:
    """Add to q the change in shear under full stick while the edges a, c move uniformly."""
    constant = before[0] == now[0] and before[1] == now[1]
    last = 0.0
    for i in range(ends.size):
        if constant:
            force = _full_stick_force(ends[i], now[0], now[1], dQ, dsigma)
        else:
            force = _mean_full_stick_force(ends[i], before, now, dQ, dsigma)
        if i > 0:
            q[i - 1] += (force - last) / (ends[i] - ends[i - 1])
        last = force
    return 1
