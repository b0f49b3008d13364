"""Nodes and weights on a slip zone.

A slip zone extends from the end of the stick zone to the edge of the larger contact.  A point in it
is given by its distance y from the stick zone: x = side (start + y), with side -1 on the left and
+1 on the right, and start = m or n.  The zone is cut at the edge of the smaller contact, and at the
points where the traction left by slip changes its formula.  Each part takes one of these rules:

* Gauss's rule in an angle, y = low + (high - low) sin(angle)**2, which makes square roots at both
  ends smooth;
* the same with angle = (pi/2) sin(t)**2, next to a break: the pressure has a logarithm there, with
  t**7 at a kink and t**3 at a corner;
* the double exponential rule, q = 1/(1 + exp(-pi sinh t)), whose nodes crowd towards both ends: for
  corners, and for singularities close beyond an end.

Level 0 takes 16 nodes of the first rule, or 24 of the second on parts that end in a break; level 1
takes twice as many.  Levels 2 and 3 take the third rule on all parts, with steps 2**-5 and 2**-6.
"""

import math
from typing import Any

import numpy as np

from ..kernels import kernel

FINEST = 3
"""The finest level."""

REACH = 4
"""Largest t of the double exponential rule, where a node is 1e-37 of a part from its end."""


def _gauss(count: int, times: int) -> Any:
    """Nodes and weights on (0, 1), with q = sin(angle)**2 substituted `times` times."""
    node, weight = np.polynomial.legendre.leggauss(count)
    q, weight = (node + 1) / 2, weight / 2
    for _ in range(times):
        weight = weight * math.pi / 2 * np.sin(math.pi * q)
        q = np.sin(math.pi / 2 * q) ** 2
    return q, weight


def double_exponential(step: float) -> Any:
    """Nodes and weights of the double exponential rule on (0, 1)."""
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
"""Numbers of the rules for each level."""


@kernel
def _next_cut(cuts: Any, side: float, start: float, slip: float, length: float, y: float) -> Any:
    """The first cut beyond y, or `length` if there is none."""
    cut = length
    if y < slip < cut:
        cut = slip
    for place in cuts:
        if y < side * place - start < cut:
            cut = side * place - start
    return cut


@kernel
def _rule_on(cuts: Any, side: float, start: float, low: float, high: float, level: int) -> Any:
    """Number of the rule for a part."""
    for place in cuts:
        y = side * place - start
        if y in (low, high):
            return _BROKEN[level]
    return _SMOOTH[level]


@kernel
def slip_nodes(cuts: Any, side: float, start: float, slip: float, length: float, level: int) -> Any:
    """Nodes, as distances y from the stick zone, and their weights: two rows.

    cuts    points where the traction left by slip changes its formula
    side    -1 on the left, +1 on the right
    start   m or n
    slip    y at the edge of the smaller contact
    length  y at the edge of the larger contact
    """
    count, low = 0, 0.0
    while low < length:
        high = _next_cut(cuts, side, start, slip, length, low)
        rule = _rule_on(cuts, side, start, low, high, level)
        count += _FIRST[rule + 1] - _FIRST[rule]
        low = high
    nodes = np.empty((2, count))
    count, low = 0, 0.0
    while low < length:
        high = _next_cut(cuts, side, start, slip, length, low)
        rule = _rule_on(cuts, side, start, low, high, level)
        for i in range(_FIRST[rule], _FIRST[rule + 1]):
            nodes[0, count] = low + (high - low) * _NODES[i]
            nodes[1, count] = (high - low) * _WEIGHTS[i]
            count += 1
        low = high
    return nodes
