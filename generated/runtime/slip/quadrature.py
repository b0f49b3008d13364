r"""Slip zones and the shear traction in them, at the nodes of a quadrature.

A slip zone extends from the end of the stick zone to the edge of the larger contact.  A point in it
is given by its distance y from the stick zone: x = side (start + y), with side -1 on the left and
+1 on the right, and start = m or n.  Where the surfaces slip in both half-cycles, the shear
traction changes by r = f (p_1 + p_2), in the direction of slip.

The zone is cut at the edge of the smaller contact and at the breaks of the body.  Each part takes
the double exponential rule, y = low + (high - low)/(1 + exp(-pi sinh t)), whose nodes crowd towards
both ends: for square roots there, for corners, and for kinks close beyond an end.  Rule number k
has the step 0.3 2**-k.
"""

import math
from typing import Any, NamedTuple, cast

import numpy as np

from ..elementary import EPS
from ..kernels import kernel, shared
from .cycles import is_steady

RULES = 5
"""Number of rules, the last one being the finest."""

ROUGH, FINEST = (cast(int, np.int64(rule)) for rule in (1, RULES - 1))
"""Rules for shear to about 1e-7 and, however close a kink is to the stick zone, to 1e-12; typed as
loop counters are, so that each kernel is compiled once."""

REACH = 4.0
"""Largest t of a rule, where a node is 1e-37 of a part from its end."""


class SlipZone(NamedTuple):
    """A slip zone: its nodes y, their weights, r at the nodes, its length, and r at its start."""

    y: Any
    weight: Any
    r: Any
    length: float
    at_start: float


def double_exponential(step: float) -> Any:
    """Nodes and weights of the double exponential rule on (0, 1)."""
    count = round(REACH / step)
    t = step * np.arange(-count, count + 1)
    q, rest = (1 / (1 + np.exp(sign * math.pi * np.sinh(t))) for sign in (-1, 1))
    return q, step * math.pi * np.cosh(t) * q * rest


def _rules() -> Any:
    """The nodes and weights of all rules, and the number of the first node of each rule.

    Nodes that rounding puts at the far end are left out if their weights are below rounding, too.
    """
    found, first = [], [0]
    for k in range(RULES):
        nodes, weights = double_exponential(0.3 * 2.0**-k)
        counts = (nodes < 1) | (weights > EPS)
        found.append(np.stack([nodes[counts], weights[counts]]))
        first.append(first[-1] + int(np.sum(counts)))
    return np.concatenate(found, axis=1), np.array(first)


_RULES, _FIRST = _rules()


@kernel
def pressures(law: Any, own: Any, cycle: Any, x: float) -> float:
    """p_1 + p_2; infinite at a corner."""
    p = law.pressure(x, cycle.a_1, cycle.c_1, own)
    if is_steady(cycle):
        return 2 * p
    return p + law.pressure(x, cycle.a_2, cycle.c_2, own)


@kernel
def limit(law: Any, own: Any, cycle: Any, x: float) -> float:
    """f (p_1 + p_2); the infinite pressure of a corner counts as zero."""
    p = pressures(law, own, cycle, x)
    return cycle.f * p if p < math.inf else 0.0


@shared
def cut_rule(length: float, cuts: Any, rule: int) -> Any:
    """Nodes and weights of a rule on (0, length), cut at those of the given points inside it."""
    first, last = _FIRST[rule], _FIRST[rule + 1]
    nodes = np.empty((2, (cuts.size + 1) * (last - first)))
    count, low = 0, 0.0
    while low < length:
        high = length
        for cut in cuts:
            if low < cut < high:
                high = cut
        for i in range(first, last):
            nodes[0, count] = low + (high - low) * _RULES[0, i]
            nodes[1, count] = (high - low) * _RULES[1, i]
            count += 1
        low = high
    return nodes[0, :count], nodes[1, :count]


@kernel
def slip_zone(
    law: Any, own: Any, cycle: Any, side: float, inner: float, cut: float, rule: int
) -> SlipZone:
    """The slip zone on one side of the stick zone.

    inner: its length in the smaller contact, from which a very short zone keeps its digits
    cut: one more point x to cut it at
    """
    edge_1, edge_2 = (cycle.c_1, cycle.c_2) if side > 0 else (cycle.a_1, cycle.a_2)
    start, length = min(edge_1, edge_2) - inner, inner + abs(edge_1 - edge_2)
    breaks = law.breaks(own)
    cuts = np.empty(breaks.size + 2)
    cuts[0], cuts[1] = inner, side * cut - start
    for i in range(breaks.size):
        cuts[i + 2] = side * breaks[i] - start
    y, weight = cut_rule(length, cuts, rule)
    r = np.empty(y.size)
    for i in range(y.size):
        r[i] = limit(law, own, cycle, side * (start + y[i]))
    return SlipZone(y, weight, r, length, limit(law, own, cycle, side * start))
