"""Quadrature that knows when it has not converged: cut finer until the estimate of error is small.

In:  an integrand and where to cut.
Out: its integral to nearly all working digits.
"""

from collections.abc import Callable, Sequence
from itertools import pairwise

import mpmath
from mpmath import mpf

Function = Callable[[mpf], mpf]

_SPARE = 8
"""Digits of the working precision that the integral may lack."""

_CUTS = 6
"""How often every part is halved at most."""


def remembered(function: Function) -> Function:
    """`function`, computed once at every place and precision: integrals share their nodes."""
    known: dict[tuple[mpf, int], mpf] = {}

    def at(place: mpf) -> mpf:
        asked = (place, mpmath.mp.prec)
        if asked not in known:
            known[asked] = function(place)
        return known[asked]

    return at


def integral(integrand: Function, cuts: Sequence[mpf], method: str = "tanh-sinh") -> mpf:
    """int integrand over [cuts[0], cuts[-1]]; a node where it divides by zero has no weight."""

    def guarded(place: mpf) -> mpf:
        try:
            return integrand(place)
        except ZeroDivisionError:
            return mpf(0)

    allowed = mpf(10) ** (_SPARE - mpmath.mp.dps)
    for _ in range(_CUTS):
        value, error = mpmath.quad(guarded, cuts, method=method, error=True)
        size = max(abs(guarded((p + q) / 2) * (q - p)) for p, q in pairwise(cuts))
        if error <= allowed * max(abs(value), size):
            break
        cuts = [*(end for p, q in pairwise(cuts) for end in (p, (p + q) / 2)), cuts[-1]]
    return value
