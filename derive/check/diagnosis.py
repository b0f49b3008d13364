"""Describe how the two sides of a false equation differ, and where it is true nevertheless.

If the ratio of the two sides is a constant times powers of the variables, it is reported.  If the
equation is true at some points and false at others, a comparison of two names with the same unit,
or the sign of one name, may tell these points apart.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import islice, permutations, product

import mpmath
from mpmath import mpf
from sympy import Expr, Gt, Lt, Mul, Rational, S, Symbol, pi, root
from sympy.logic.boolalg import Boolean

from derive.check.claim import Claim, Point
from derive.check.draw import further, has_integral, is_met, points, variables
from derive.check.sides import Pair, Sides
from derive.proof.balls import Value
from derive.proof.values import Undecided, evaluated
from derive.sheet.notation import text_of

_DIGITS = 40
_SHARED = 25
"""Digits in which the reduced ratio must be the same at all points."""
_LEAST = 3
"""The least number of points at which the ratio is compared with those that gave its powers."""
_NAMED = 18
"""Digits to which a constant must agree with its exact form."""
_LARGEST, _SIMPLE = 1000, 20
"""The largest integer in the exact form of a constant, and in one that may be a misprint."""
_STEEPEST = 6
"""The largest power of a variable, and the largest denominator of a power."""
_FALSE, _EACH = 6, 3
"""If a claim is false at this many points at first, it is taken to be false everywhere; the number
of points at which a claim must be true, and false, to be called true in part."""


@dataclass(frozen=True)
class Quotient:
    """The ratio of left to right side: a constant times a product of powers of variables.

    count: the number of points that were examined
    """

    constant: Value
    powers: Expr
    count: int


def diagnosis(sides: Sides) -> str:
    """Describe the ratio of the two sides in words; empty if there is nothing to report."""
    meant = sides.claim.meant
    if meant.relation.is_ordered or meant.cases or meant.toward is not None:
        return ""
    ratio = quotient(sides)
    if ratio is None:
        return ""
    constant = simple(ratio.constant, _LARGEST) or Symbol(mpmath.nstr(ratio.constant, 12))
    formula = text_of(constant * ratio.powers)
    return f"the ratio left/right is {formula} at {ratio.count} points"


def quotient(sides: Sides) -> Quotient | None:
    """Return the ratio of the two sides if it is a constant times powers of the variables."""
    claim, names = sides.claim, variables(sides.claim)
    most = len(names) + 1 + _LEAST if has_integral(claim) else None
    found, powers = list[Pair](), None
    with mpmath.workdps(_DIGITS):
        for where in (points(claim), further(claim, sides.in_variables)):
            found += [p for p in sides.pairs(islice(where, most)) if p.right != 0]
            try:
                powers = powers or _powers(found, names)
                reduced = [each.ratio / evaluated(powers, each.point) for each in found]
            except (Undecided, ArithmeticError, ValueError):
                return None
            tolerance = mpf(10) ** -_SHARED * abs(reduced[0])
            if any(abs(each - reduced[0]) > tolerance for each in reduced):
                return None
        return Quotient(reduced[0], powers, len(reduced))


def _powers(found: list[Pair], names: list[Symbol]) -> Expr:
    """Return the product of powers that fits the first values; raises ValueError."""
    is_constant = len({mpmath.nstr(each.ratio, _SHARED) for each in found}) == 1
    count = 1 if is_constant else len(names) + 1
    if len(found) < count + (_LEAST if names else 0):
        raise ValueError("too few points")
    if is_constant:
        return S.One
    rows = [[1, *(mpmath.log(abs(each.point[n])) for n in names)] for each in found[:count]]
    logs = [mpmath.log(abs(each.ratio)) for each in found[:count]]
    fitted = [Fraction(float(n)) for n in mpmath.lu_solve(mpmath.matrix(rows), logs)[1:]]
    near = [n.limit_denominator(_STEEPEST) for n in fitted]
    if any(abs(n) > _STEEPEST for n in near):
        raise ValueError("a power is too large")
    return Mul(*(name ** Rational(n) for name, n in zip(names, near, strict=True)))


def simple(constant: Value, largest: int = _SIMPLE) -> Expr | None:
    """Return the exact number with which a constant agrees, or None.

    Its modulus is a rational number with integers up to `largest`, times a power of pi, or a
    square or cube root of such a number.

    >>> with mpmath.workdps(_DIGITS):
    ...     simple(mpmath.mpf(4) / mpmath.pi)
    4/pi
    """
    if mpmath.im(constant) != 0:
        return None
    with mpmath.workdps(_DIGITS):
        for degree, power in product((1, 2, 3), (0, 1, -1, 2, -2)):
            rest = abs(constant) ** degree / mpmath.pi**power
            near = Fraction(int(mpmath.nint(rest * 2**80)), 2**80).limit_denominator(largest)
            gap = abs(rest - mpf(near.numerator) / near.denominator)
            if 0 < near.numerator <= largest and gap <= mpf(10) ** -_NAMED:
                return Mul(-1 if constant < 0 else 1, root(Rational(near) * pi**power, degree))
    return None


# ------------------------------------------------------------------ true at some points


def where_true(claim: Claim, is_true: Callable[[Point], bool | None]) -> str:
    """Describe where a false claim is true; empty if it is true at too few points.

    is_true: whether the claim is true at a point, or None if this is not known.
    """
    true, false = list[Point](), list[Point]()
    for point in points(claim, seed="part"):
        found = is_true(point)
        if found is not None:
            (true if found else false).append(point)
        if len(false) >= _FALSE and not true:
            return ""
    if min(len(true), len(false)) < _EACH:
        return ""
    share = f"true at {len(true)} of {len(true) + len(false)} points"
    told = telling(claim, true, false)
    return f"{share}: wherever {told} (if this is meant, put it in `require`)" if told else share


def telling(claim: Claim, some: Sequence[Point], others: Sequence[Point]) -> str:
    """Return a condition that some points meet and others do not; empty if none is found."""
    if min(len(some), len(others)) < _EACH:
        return ""
    table = dict(claim.meant.meaning)
    for condition in _comparisons(claim):
        in_variables = condition.xreplace(table)
        met = [is_met(in_variables, point) for point in (*some, *others)]
        if all(met[: len(some)]) and not any(met[len(some) :]):
            return str(condition)
    return ""


def _comparisons(claim: Claim) -> Iterator[Boolean]:
    """Yield simple conditions: the sign of a name, and which of two names is smaller."""
    names, unit_of = [*dict.fromkeys((*claim.meant.swaps, *variables(claim)))], claim.meant.unit_of
    yield from (sign(name, 0) for name in names for sign in (Lt, Gt))
    for one, other in permutations(names, 2):
        if unit_of.get(one, "") == unit_of.get(other, ""):
            yield Lt(one, other)
