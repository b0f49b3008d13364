"""Find out what a verdict rests on: the body, the user's definitions, other claims or none of them.

A claim rests on the body only if the body's formulas matter.  They do not if the claim stays true
when arbitrary functions take their places: then it is true by the definitions of the file alone.
"""

import hashlib
import random
from collections.abc import Iterator
from itertools import islice

from sympy import Derivative, Dummy, Expr, Limit, Rational
from sympy.core.function import AppliedUndef

from derive.check.claim import Basis, Claim
from derive.check.context import calls_in, integrals
from derive.check.draw import has_integral, points, ranges_of
from derive.check.intervals import gap_of, unsettled
from derive.check.judge import Judged, Judging
from derive.check.sides import Sides
from derive.command.errors import UserError
from derive.command.limit import LookAtClock
from derive.proof.values import Undecided
from derive.reading.improper import proper

_SIGNS = (1, -1)
"""The signs of the functions, of which each stands for one trial."""
_POINTS, _FEW = 6, 3
"""Number of points in each trial, and the same for claims with integrals."""
_PARTS = 97
"""Coefficients are multiples of one over this number."""


def basis(claim: Claim, judged: Judged, look: LookAtClock) -> Basis:
    """Return what the verdict on a claim rests on."""
    meant = claim.meant
    takes_part = meant.basis in (Basis.BODY, Basis.BOTH)
    if not takes_part or meant.reached is not None or not judged.good:
        return meant.basis
    if meant.is_inequality:
        return Basis.DEFINITIONS if _is_settled(claim) else meant.basis
    found = None
    for sides in _arbitrary(*meant.called):
        is_true = _is_true(Sides(claim, *sides, {}), look)
        if is_true is False:
            return meant.basis
        found = found or is_true
    return Basis.DEFINITIONS if found else meant.basis


def _is_settled(claim: Claim) -> bool:
    """Whether an inequality is true whatever real numbers the body's formulas give."""
    left, right = claim.meant.called
    calls = {*integrals(left, right), *calls_in(left, right)}
    table = {call: Dummy(real=True) for call in calls}
    gap = gap_of(left.xreplace(table), claim.meant.relation, right.xreplace(table))
    strict, ranges = claim.meant.relation.is_strict, ranges_of(claim)
    return unsettled(gap, strict, ranges, claim.meant.conditions) == 1


def is_empty(claim: Claim, look: LookAtClock) -> bool:
    """Whether the equation by which a definition is judged is true for any other value, too."""
    if claim.meant.through is None:
        return False
    sides = Sides.printed(claim).put(claim.meant.left, 2 * claim.meant.right + 1)
    return _is_true(sides, look) is not False


def _is_true(sides: Sides, look: LookAtClock) -> bool | None:
    """Whether a claim is true with other sides; None if this is not known."""
    judging, claim = Judging(sides, look), sides.claim
    try:
        if (tending := judging.limit()) is not None:
            return tending.good
        found = None
        for point in islice(points(claim), _FEW if has_integral(claim) else _POINTS):
            is_true = sides.may_agree(point) and judging.is_true(point)
            if is_true is False:
                return False
            found = found or is_true
    except Undecided:
        return None
    return found


def _arbitrary(*sides: Expr) -> Iterator[tuple[Expr, Expr]]:
    """Yield both sides with arbitrary functions in place of the body's formulas."""
    for sign in _SIGNS:
        try:
            left, right = (_with_functions(side, sign) for side in sides)
        except (UserError, ArithmeticError, TypeError, ValueError):  # no value, or no closed form
            continue
        yield left, right


def _with_functions(side: Expr, sign: int) -> Expr:
    while calls := side.atoms(AppliedUndef):  # a call may be an argument of another one
        inner = [n for n in calls if not any(arg.has(AppliedUndef) for arg in n.args)]
        side = side.xreplace({n: _function(n.func.__name__, n.args, sign) for n in inner})
    found = proper(side)
    return found.xreplace({node: node.doit() for node in found.atoms(Derivative, Limit)})


def _function(name: str, args: tuple[Expr, ...], sign: int) -> Expr:
    """Return the value of a function without any special property, the same in every run."""
    rng = random.Random(int.from_bytes(hashlib.sha256(f"{name}{sign}".encode()).digest()[:8]))

    def mixed() -> Expr:
        shares = [Rational(rng.randint(1, _PARTS), _PARTS) for _ in args]
        return sum(
            (share * arg for share, arg in zip(shares, args, strict=True)), start=Rational(0)
        )

    return sign * (1 + mixed() + mixed() ** 2 + 1 / (1 + mixed() ** 2))
