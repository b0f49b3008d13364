"""Large tension on a wedge as a user might write it for numba, without using the package.

It solves one case after the other.  Both conditions are integrated by Gauss's rule in each slip
zone, and solved by Newton's method with derivatives by finite differences.  Nothing is checked:
neither the regime, nor the premise of the conditions, nor that a contact exists.
"""

import math
from typing import Any

import numba
import numpy as np

_NODE, _WEIGHT = np.polynomial.legendre.leggauss(24)
_ANGLE, _WEIGHT = (_NODE + 1) * math.pi / 4, _WEIGHT * math.pi / 4
_SIN, _COS = np.sin(_ANGLE), np.cos(_ANGLE)

compiled = numba.njit(error_model="numpy", nogil=True)


@compiled
def pressure(x: float, a: float, c: float, E: float, phi: float) -> float:
    """The pressure of a wedge."""
    h = a + c
    u, v = (a + x) * (2 * c / h), (c - x) * (2 * a / h)
    return E * phi / math.pi * math.log1p((math.sqrt(u * v) + min(u, v)) / abs(x))


@compiled
def residuals(m: float, n: float, case: Any, law: Any) -> Any:
    """Residuals of both conditions."""
    a, c, dQ, dsigma = case[0], case[1], case[2], case[3]
    f, E, phi = law
    strain, force = math.pi * dsigma / 4, -dQ - math.pi * dsigma * (m - n) / 8
    for side in (-1, 1):
        start, edge = (n, c) if side > 0 else (m, a)
        d = edge - start
        for i in range(_SIN.size):
            s = d * _SIN[i] ** 2
            p = pressure(side * (start + s), a, c, E, phi)
            part = -4 * f * p * _WEIGHT[i] * _COS[i] * math.sqrt(d / (m + n + s))
            strain += part
            force += part * side * (start + s)
    return strain, force


@compiled
def solved(case: Any, law: Any) -> Any:
    """The stick zone of one case."""
    a, c = case[0], case[1]
    m, n = 0.75 * a, 0.75 * c
    for _ in range(40):
        f_1, f_2 = residuals(m, n, case, law)
        e = 1e-7 * (m + n)
        g_1, g_2 = residuals(m + e, n, case, law)
        h_1, h_2 = residuals(m, n + e, case, law)
        a_11, a_21, a_12, a_22 = (g_1 - f_1) / e, (g_2 - f_2) / e, (h_1 - f_1) / e, (h_2 - f_2) / e
        by = a_11 * a_22 - a_12 * a_21
        dm, dn = (f_2 * a_12 - f_1 * a_22) / by, (f_1 * a_21 - f_2 * a_11) / by
        part = 1.0
        while m + part * dm >= a or n + part * dn >= c or m + n + part * (dm + dn) <= 0:
            part /= 2
        m, n = m + part * dm, n + part * dn
        if abs(dm) + abs(dn) < 1e-12 * (m + n):
            break
    return m, n


@compiled
def each(cases: Any, law: Any, out: Any) -> None:
    """The stick zone of each case: rows of a, c, dQ, dsigma."""
    for i in range(len(cases)):
        out[i, 0], out[i, 1] = solved(cases[i], law)
