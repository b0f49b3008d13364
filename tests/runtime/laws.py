"""Bodies for the tests of the runtime, written out by hand: no line of a generated module.

In:  nothing.
Out: `hertz`, `wedge`, `flat_rounded`, each a `Case` with a compiled law and the law's parameters.

Formulas are theory's, in their plain form: digits are lost beside kinks, so edges keep away.
"""

import math
from typing import NamedTuple

import numpy as np

from generated.runtime.kernels import BREAKS, PRESSURE, SERIES, SLOPE, STATE, Law, handed, kernel


class Case(NamedTuple):
    """A body: its law as kernels take it, the law's functions, its parameters."""

    law: object
    functions: Law
    own: np.ndarray


# ---------------------------------------------------------------- a cylinder, g = x**2/(2 R)


@kernel(PRESSURE)
def _hertz_pressure(x, a, c, own):
    if x <= -a or x >= c:
        return 0.0
    return math.sqrt((a + x) * (c - x)) / (2 * own[0])


@kernel(STATE)
def _hertz_state(a, c, own):
    h = a + c
    if not h > 0:
        return math.nan, math.nan, math.nan, math.nan, math.nan
    load, K = math.pi * h * h / (16 * own[0]), math.sqrt(h) / (2 * own[0])
    return load, load * (a - c) / 2, (a - c) / (2 * own[0]), K, K


@kernel(SLOPE)
def _hertz_slope(x, own):
    return x / own[0], 1 / own[0]


@kernel(SERIES)
def _hertz_series(a, c, own):
    h = a + c
    L, T = -1 / (4 * own[0] * math.sqrt(h)), -1 / (16 * own[0] * h * math.sqrt(h))
    return L, L, T, T


@kernel(BREAKS)
def _hertz_breaks(own):
    return np.empty(0)


# ---------------------------------------------------------------- a wedge, g = phi |x|


@kernel(PRESSURE)
def _wedge_pressure(x, a, c, own):
    if x <= -a or x >= c:
        return 0.0
    if x == 0:
        return math.inf
    h = a + c
    u, v = (a + x) * (2 * c / h), (c - x) * (2 * a / h)
    return own[0] / math.pi * math.log1p((math.sqrt(u * v) + min(u, v)) / abs(x))


@kernel(STATE)
def _wedge_state(a, c, own):
    if not (a > 0 and c > 0):
        return math.nan, math.nan, math.nan, math.nan, math.nan
    h, phi = a + c, own[0]
    load = phi * math.sqrt(a * c)
    tilt = phi * (1 - 4 / math.pi * math.atan2(math.sqrt(c), math.sqrt(a)))
    K_left = 2 * phi / math.pi * math.sqrt(c / (a * h))
    K_right = 2 * phi / math.pi * math.sqrt(a / (c * h))
    return load, load * (a - c) / 4, tilt, K_left, K_right


@kernel(SLOPE)
def _wedge_slope(x, own):
    return (own[0] if x >= 0 else -own[0]), 0.0


@kernel(SERIES)
def _wedge_series(a, c, own):
    h = a + c
    scale = own[0] / (3 * math.pi * h * math.sqrt(h))
    left, right = math.sqrt(c / a), math.sqrt(a / c)
    fifth = own[0] / (20 * math.pi * h * h * math.sqrt(h))
    return (
        scale * left * (3 + 2 * left * left),
        scale * right * (3 + 2 * right * right),
        fifth * left * (15 + 20 * left**2 + 8 * left**4),
        fifth * right * (15 + 20 * right**2 + 8 * right**4),
    )


@kernel(BREAKS)
def _wedge_breaks(own):
    return np.zeros(1)


# ---------------------------------------------------------------- flat with rounded edges


@kernel(PRESSURE)
def _flat_pressure(x, a, c, own):
    if x <= -a or x >= c:
        return 0.0
    R, b, h = own[0], own[1], a + c
    w, total = math.sqrt((a + x) * (c - x)), 0.0
    for sense in (-1, 1):
        place = sense * b
        near, far = (c - place, a + place) if sense > 0 else (a + place, c - place)
        if near <= 0:
            continue
        if far <= 0:
            near, far = h, 0.0
        theta = 2 * math.atan2(math.sqrt(near), math.sqrt(far))
        u, v = max(c - place, 0.0) * (a + x), max(a + place, 0.0) * (c - x)
        distance = max(abs(x - place), 1e-300)
        logarithm = math.asinh(math.sqrt(min(u, v) / (distance * h)))
        total += w * theta / (2 * math.pi) + sense * (x - place) * logarithm / math.pi
    return total / R


@kernel(STATE)
def _flat_state(a, c, own):
    R, b, h = own[0], own[1], a + c
    if not (h > 0 and (a > b or c > b)):
        return math.nan, math.nan, math.nan, math.nan, math.nan
    mid = (c - a) / 2
    I0 = I1 = I2 = K_left = K_right = 0.0
    half = h / 2
    for sense in (-1, 1):
        # seen so that the rounded part lies right of the kink, at `place`
        centre = sense * mid
        place = b - centre
        if place >= half:
            continue
        theta = math.pi if place <= -half else math.acos(place / half)
        S, C = math.sin(theta), math.cos(theta)
        # int (s - place) s**k/w ds over the part, s from the middle
        m0, m1 = theta, half * S
        m2 = half * half * (theta + S * C) / 2
        m3 = half**3 * (S - S**3 / 3)
        j0, j1, j2 = m1 - place * m0, m2 - place * m1, m3 - place * m2
        I0 += sense * j0
        I1 += j1  # odd in s, odd in sense: even
        I2 += sense * j2
        near = math.sqrt(h) * (theta + S) / 2  # int sqrt((half + s)/(half - s)) ds/sqrt(h)
        far = math.sqrt(h) * (theta - S) / 2
        K_right += near if sense > 0 else far
        K_left += far if sense > 0 else near
    alpha = -I0 / (math.pi * R)
    load = I1 / (2 * R)
    second = I2 / (2 * R) + alpha * math.pi * half * half / 4
    return load, -mid * load - second, alpha, K_left / (math.pi * R), K_right / (math.pi * R)


@kernel(SLOPE)
def _flat_slope(x, own):
    R, b = own[0], own[1]
    if x < -b:
        return (x + b) / R, 1 / R
    return ((x - b) / R, 1 / R) if x >= b else (0.0, 0.0)


@kernel(SERIES)
def _flat_series(a, c, own):
    return math.nan, math.nan, math.nan, math.nan


@kernel(BREAKS)
def _flat_breaks(own):
    return np.array([-own[1], own[1]])


def _case(functions: Law, *own: float) -> Case:
    return Case(handed(functions), functions, np.array(own))


hertz = _case(Law(_hertz_pressure, _hertz_state, _hertz_slope, _hertz_series, _hertz_breaks), 1.0)
wedge = _case(Law(_wedge_pressure, _wedge_state, _wedge_slope, _wedge_series, _wedge_breaks), 1.0)
flat_rounded = _case(
    Law(_flat_pressure, _flat_state, _flat_slope, _flat_series, _flat_breaks), 1.0, 1.0
)
