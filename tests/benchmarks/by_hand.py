"""What an able user would write by hand, to compare with; nothing of the program is imported.

Loops for numba's compiler, and functions of one load case for scipy.optimize.fsolve.  They compute
the state in the bulk and test nothing: no edge, no kink, no state that does not exist.
"""

import math
from collections.abc import Callable
from functools import cache
from importlib import import_module
from typing import Any

import numpy as np
from scipy.optimize import fsolve

Function = Callable[..., Any]

NODES = 16
"""Of the Gauss-Legendre rule on each slip zone."""

_AT, _WEIGHT = np.polynomial.legendre.leggauss(NODES)
_ANGLE = (_AT + 1) * math.pi / 4
_WEIGHT = _WEIGHT * math.pi / 4
_SIN, _COS = np.sin(_ANGLE), np.cos(_ANGLE)

STEPS = 50
EXACT = 1e-12
NUDGE = 1e-7
"""Of the unknowns, for differences in the place of derivatives."""


# ------------------------------------------------------------------ explicit formulas


def wedge_pressure(x: Any, a: float, c: float, E_star: float, phi: float) -> Any:
    """Eq. (pressure_distribution_wedge), number by number."""
    p = np.empty_like(x)
    gamma = c / a
    first = math.sqrt(gamma)
    for i in range(x.size):
        second = math.sqrt((gamma * a - x[i]) / (x[i] + a))
        p[i] = E_star * phi / math.pi * math.log(abs((first + second) / (first - second)))
    return p


def wedge_pressure_at_edges(x: Any, a: float, c: float, E_star: float, phi: float) -> Any:
    """The same pressure in the form that is generated, copied by hand, number by number."""
    p = np.empty_like(x)
    left, right = 2 * c / (a + c), 2 * a / (a + c)
    for i in range(x.size):
        u, v = (a + x[i]) * left, (c - x[i]) * right
        quotient = (math.sqrt(u * v) + min(u, v)) / abs(x[i])
        p[i] = E_star * phi / math.pi * math.log1p(quotient)
    return p


def wedge_contact(P: Any, M: Any, E_star: float, phi: float) -> Any:
    """Eqs. (alpha), (gamma) and (ca)."""
    a, c, alpha = np.empty_like(P), np.empty_like(P), np.empty_like(P)
    for i in range(P.size):
        turn = 2 * E_star * phi * M[i]
        lean = turn / math.sqrt(turn**2 + P[i] ** 4)
        alpha[i] = 2 * phi / math.pi * math.asin(lean)
        root = math.sqrt((1 - lean) / (1 + lean))
        a[i] = P[i] / (E_star * phi) / root
        c[i] = P[i] / (E_star * phi) * root
    return a, c, alpha


def wedge_slip(
    a: float, c: float, dQ: Any, dsigma: Any, f: float, E_star: float, phi: float
) -> Any:
    """d = K_T/(f K_N) at both edges."""
    left, right = np.empty_like(dQ), np.empty_like(dQ)
    h = a + c
    K_left = 2 * E_star * phi / math.pi * math.sqrt(c / (a * h))
    K_right = K_left * a / c
    for i in range(dQ.size):
        strain = dsigma[i] * h / 8
        left[i] = abs(dQ[i] / math.pi + strain) / (math.sqrt(h) * f * K_left)
        right[i] = abs(dQ[i] / math.pi - strain) / (math.sqrt(h) * f * K_right)
    return left, right


# ------------------------------------------------------------------ two unknowns


def punch_off(
    y: float, z: float, P: float, M: float, E_star: float, R: float, b: float
) -> tuple[float, float]:
    """What a rounded punch on [-exp y, exp z] lacks of its load and its moment, in their parts."""
    a, c = math.exp(y), math.exp(z)
    h, mid = a + c, (c - a) / 2
    first = math.acos(min(1.0, max(-1.0, (b + mid) / (h / 2))))  # angle of the left shoulder
    second = math.acos(min(1.0, max(-1.0, (b - mid) / (h / 2))))
    w_1 = math.sqrt(max(0.0, (a - b) * (c + b)))
    w_2 = math.sqrt(max(0.0, (a + b) * (c - b)))
    load = h**2 * (first + second) + 2 * w_1 * (a - c - 2 * b) - 2 * w_2 * (a - c + 2 * b)
    turn = 3 * a**2 - 2 * a * c + 3 * c**2 - 4 * b**2
    moment = (
        3 * h**2 * (a - c) * (first + second)
        + 2 * w_1 * (turn - 2 * b * (a - c))
        - 2 * w_2 * (turn + 2 * b * (a - c))
    )
    lacking = E_star * load / (16 * R) - P
    return lacking / P, (E_star * moment / (96 * R) - M) / (P * b)


def hertz_off(
    m: float, n: float, dQ: float, dsigma: float, half: float, f: float, E_star: float, R: float
) -> tuple[float, float]:
    """What is left of both conditions of large tension: constant loads, a level cylinder.

    int r/w dxi = -pi dsigma/4 and int r xi/w dxi = dQ + pi dsigma (m - n)/8 over the slip zones of
    [-half, half], by a Gauss-Legendre rule in t, d sin(t)**2 the distance from the stick zone.
    """
    strain, force = 0.0, 0.0
    for side in (-1, 1):
        start = n if side > 0 else m
        d = half - start
        for i in range(NODES):
            distance = start + d * _SIN[i] ** 2
            p = E_star / (2 * R) * math.sqrt(d * (half + distance)) * _COS[i]
            # r/w is negative on both sides: r = 2 f p and w < 0 on the left, -2 f p on the right
            part = -4 * f * p * _WEIGHT[i] * _COS[i] * math.sqrt(d / (m + n + d * _SIN[i] ** 2))
            strain += part
            force += part * side * distance
    scale = f * E_star * half / R
    strain += math.pi * dsigma / 4
    force -= dQ + math.pi * dsigma * (m - n) / 8
    return strain / scale, force / (scale * half)


def newton(off: Function, compiled: Function) -> Function:
    """Newton's method of two unknowns in a loop over load cases, derivatives by differences."""

    @compiled
    def solved(first: Any, second: Any, of: Any, *law: float) -> Any:
        out = np.empty((2, of[0].size))
        for i in range(of[0].size):
            y, z = first[i], second[i]
            for _ in range(STEPS):
                f_1, f_2 = off(y, z, of[0][i], of[1][i], *law)
                step = NUDGE * (abs(y) + NUDGE)
                g_1, g_2 = off(y + step, z, of[0][i], of[1][i], *law)
                a_11, a_21 = (g_1 - f_1) / step, (g_2 - f_2) / step
                step = NUDGE * (abs(z) + NUDGE)
                g_1, g_2 = off(y, z + step, of[0][i], of[1][i], *law)
                a_12, a_22 = (g_1 - f_1) / step, (g_2 - f_2) / step
                by = a_11 * a_22 - a_12 * a_21
                dy = (f_2 * a_12 - f_1 * a_22) / by
                dz = (f_1 * a_21 - f_2 * a_11) / by
                y, z = y + dy, z + dz
                if abs(dy) + abs(dz) <= EXACT * (abs(y) + abs(z)):
                    break
            out[0, i], out[1, i] = y, z
        return out

    return solved


def by_fsolve(off: Function, first: Any, second: Any, of: Any, *law: float) -> Any:
    """scipy.optimize.fsolve, load case by load case."""
    out = np.empty((2, of[0].size))
    for i in range(of[0].size):
        out[:, i] = fsolve(
            lambda u, i=i: off(u[0], u[1], of[0][i], of[1][i], *law),
            (first[i], second[i]),
            xtol=1e-12,
        )
    return out


# ------------------------------------------------------------------ compiled


@cache
def compiler() -> Function:
    """numba.njit: one thread, IEEE arithmetic, division by zero as NumPy has it."""
    return import_module("numba").njit(error_model="numpy")


@cache
def compiled(function: Function) -> Function:
    """One of the loops above, compiled."""
    return compiler()(function)


@cache
def compiled_newton(off: Function) -> Function:
    """Newton's method of one of the pairs above, compiled."""
    return newton(compiled(off), compiler())
