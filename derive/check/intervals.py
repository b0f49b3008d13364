"""Decide an inequality over the whole ranges of one or two variables by intervals.

Balls enclose all values of the difference of its sides over a box of the variables.  A box whose
enclosure contains zero is divided, until all boxes are decided or there are too many of them.
"""

from collections.abc import Mapping
from math import inf, nextafter

import sympy as sp
from flint import arb
from sympy import Expr, Symbol

from derive.check.claim import Range
from derive.command.limit import LookAtClock
from derive.proof.balls import FUNCTIONS, digits
from derive.proof.values import program

_MOST_BOXES = 2000
_DIGITS = 20
_CONDITIONS = (sp.logic.boolalg.Boolean, sp.Piecewise, sp.ITE)
_ENCLOSED = {each for each in FUNCTIONS if not issubclass(each, _CONDITIONS)}
"""Functions whose values over a whole ball are enclosed; conditions are decided at its middle."""


def is_positive(expr: Expr, ranges: Mapping[Symbol, Range], look: LookAtClock) -> bool:
    """Whether an expression is shown to be positive wherever it is real in the ranges."""
    if not 1 <= len(ranges) <= 2 or not _is_enclosed(expr):
        return False
    if any(span.powers for span in ranges.values()):
        return False
    of = program(expr)
    boxes = [{s: _whole(span) for s, span in ranges.items()}]
    for _ in range(_MOST_BOXES):
        look()
        box = boxes.pop()
        with digits(_DIGITS):
            value = of({s: arb(low).union(arb(high)) for s, (low, high) in box.items()})
            is_decided = isinstance(value, arb) and value > 0
        if not is_decided:
            symbol = max(box, key=lambda s: _share(box[s], ranges[s]))
            low, high = box[symbol]
            middle = (low + high) / 2
            boxes += [{**box, symbol: part} for part in ((low, middle), (middle, high))]
        if not boxes:
            return True
    return False


def _is_enclosed(expr: Expr) -> bool:
    return all(
        isinstance(node, Symbol | sp.Rational | sp.Pow)
        or node in (sp.pi, sp.E)
        or node.func in _ENCLOSED
        for node in sp.preorder_traversal(expr)
    )


def _whole(span: Range) -> tuple[float, float]:
    """The ends of a range, rounded outwards because decimal numbers are not exact."""
    low, high = (
        end and nextafter(end, sign * inf) for end, sign in ((span.low, -1), (span.high, 1))
    )
    return low, high


def _share(ends: tuple[float, float], span: Range) -> float:
    """The part of a range that a side of a box covers."""
    return (ends[1] - ends[0]) / (span.high - span.low)
