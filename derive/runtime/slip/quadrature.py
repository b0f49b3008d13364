"""Nodes and weights on a slip zone.

A slip zone begins where the stick zone ends and goes as far as the larger contact.  A place in it
is told by its distance y from the stick zone: x = side (start + y), side -1 on the left and +1 on
the right, start = m or n.  It is cut where the smaller contact ends, and where what slip leaves
changes its formula.  On each part one of these rules is taken:

* Gauss's in an angle, y = low + (high - low) sin(angle)**2: roots at both ends are smooth there;
* the same with angle = (pi/2) sin(t)**2: next to a break, where pressure has a logarithm, with t**7
  at a kink, and t**3 at a corner;
* the double exponential one, q = 1/(1 + exp(-pi sinh t)), whose nodes crowd towards both ends: for
  corners, and for whatever is singular close beyond an end.

`level` 0 takes 16 nodes of the first rule, 24 of the second on parts that end in a break; level 1
twice as many.  Levels 2 and 3 take the third rule on all parts, its steps 2**-5 and 2**-6.
"""

import math
from typing import Any

import numpy as np

from ..kernels import kernel, matrix, real, vector, whole

FINEST = 3
"""The finest level."""

REACH = 4
"""How far the double exponential rule goes in t: to 1e-37 of a part."""


def _gauss(count: int, times: int) -> Any:
    """Nodes and weights on (0, 1), over sin(angle)**2, so many times."""
    place, weight = np.polynomial.legendre.leggauss(count)
    q, weight = (place + 1) / 2, weight / 2
    for _ in range(times):
        weight = weight * math.pi / 2 * np.sin(math.pi * q)
        q = np.sin(math.pi / 2 * q) ** 2
    return q, weight


def double_exponential(step: float) -> Any:
    """Nodes and weights on (0, 1)."""
    count = round(REACH / step)
    t = step * np.arange(-count, count + 1)
    q, rest = (1 / (1 + np.exp(sign * math.pi * np.sinh(t))) for sign in (-1, 1))
    return q, step * math.pi * np.cosh(t) * q * rest


_RULES = [
    *(_gauss(count, times) for count, times in ((16, 1), (32, 1), (24, 2), (48, 2))),
    *(double_exponential(step) for step in (2.0**-5, 2.0**-6)),
]
_NODES, _WEIGHTS = np.concatenate(_RULES, axis=1)
_FIRST = np.cumsum([0, *(len(rule[0]) for rule in _RULES)])
_SMOOTH, _BROKEN = np.array([0, 1, 4, 5]), np.array([2, 3, 4, 5])
"""Numbers of the rules of each level."""


@kernel(real(vector, real, real, real, real, real))
def _next_cut(cuts: Any, side: float, start: float, slip: float, length: float, y: float) -> Any:
    """The first cut behind y, at `length` at last."""
    cut = length
    if y < slip < cut:
        cut = slip
    for place in cuts:
        if y < side * place - start < cut:
            cut = side * place - start
    return cut


@kernel(whole(vector, real, real, real, real, whole))
def _rule_on(cuts: Any, side: float, start: float, low: float, high: float, level: int) -> Any:
    """Number of the rule for a part."""
    for place in cuts:
        y = side * place - start
        if y in (low, high):
            return _BROKEN[level]
    return _SMOOTH[level]


@kernel(matrix(vector, real, real, real, real, whole))
def slip_nodes(cuts: Any, side: float, start: float, slip: float, length: float, level: int) -> Any:
    """Nodes, as distances y from the stick zone, and their weights: two rows.

    cuts    places where what slip leaves changes its formula
    side    -1 on the left, +1 on the right
    start   m or n
    slip    y where the smaller contact ends
    length  y where the larger contact ends
    """
    count, low = 0, 0.0
    while low < length:
        high = _next_cut(cuts, side, start, slip, length, low)
        rule = _rule_on(cuts, side, start, low, high, level)
        count += _FIRST[rule + 1] - _FIRST[rule]
        low = high
    found = np.empty((2, count))
    count, low = 0, 0.0
    while low < length:
        high = _next_cut(cuts, side, start, slip, length, low)
        rule = _rule_on(cuts, side, start, low, high, level)
        for i in range(_FIRST[rule], _FIRST[rule + 1]):
            found[0, count] = low + (high - low) * _NODES[i]
            found[1, count] = (high - low) * _WEIGHTS[i]
            count += 1
        low = high
    return found
