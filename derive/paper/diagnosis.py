"""Describe how the two sides of a false equation differ if no correction was found.

If the ratio of the two sides is a constant times powers of the variables, it is reported.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from itertools import islice, product

import mpmath
from mpmath import mpf
from sympy import Symbol

from derive.paper.claim import Claim, Point
from derive.paper.draw import further, has_integral, is_allowed, points, variables
from derive.paper.quadrature import Value
from derive.paper.values import Undecided, evaluated

_DIGITS = 40
_SHARED = 25
"""Digits in which the reduced ratio must be the same at all points."""
_FEW = 6
"""Number of points at which powers are measured; also the limit for claims with integrals."""
_LEAST = 4
_STEPS = (mpf(2), mpf("1.125"), mpf("0.875"))
"""Factors by which a variable is changed; the first one that the conditions allow is used."""
_NAMED = 18
"""Digits to which a constant must agree with its exact form."""
_ROOTS = {2: "sqrt", 3: "cbrt"}
_STEEPEST, _LARGEST = 6, 1000
"""The largest power of a variable, and the largest integer in the exact form of a constant."""


@dataclass(frozen=True)
class Quotient:
    """The ratio of left to right side: a constant times powers of variables.

    named  the exact form of the constant; empty if none was found
    count  the number of points that were examined
    """

    constant: Value
    powers: Mapping[Symbol, Fraction]
    named: str
    count: int

    @property
    def as_text(self) -> str:
        """The ratio as a formula."""
        factors = [self.named or str(mpmath.nstr(self.constant, 12))]
        if self.named == "1" and self.powers:
            factors = []
        for symbol, power in self.powers.items():
            exponent = str(power) if power.denominator == 1 and power > 0 else f"({power})"
            factors.append(str(symbol) if power == 1 else f"{symbol}**{exponent}")
        return "*".join(factors)


def diagnosis(claim: Claim) -> str:
    """Describe the ratio of both sides in words; empty if there is nothing to report."""
    if claim.relation.is_ordered or claim.cases or claim.toward is not None:
        return ""
    ratio = quotient(claim)
    return f"the ratio left/right is {ratio.as_text} at {ratio.count} points" if ratio else ""


def quotient(claim: Claim) -> Quotient | None:
    """Return the ratio of both sides if it is a constant times powers of the variables."""
    with mpmath.workdps(_DIGITS):
        try:
            return _Quotients(claim).measured()
        except Undecided:
            return None


class _Quotients:
    """Measures the ratio of both sides of one claim at points where it is a real number."""

    def __init__(self, claim: Claim) -> None:
        self.claim = claim
        table = dict(claim.meaning)
        self.sides = [side.xreplace(table) for side in claim.sides(claim.left, claim.right)]

    def measured(self) -> Quotient | None:
        """Return the ratio, or None if it is not of the required form."""
        bases = [(p, v) for p, v in self._at(islice(points(self.claim), _FEW)) if v != 0]
        if (len(bases) < _LEAST and variables(self.claim)) or not bases:
            return None
        powers = dict[Symbol, Fraction]()
        for symbol in variables(self.claim):
            power = self._power(symbol, bases)
            if power is None:
                return None
            if power:
                powers[symbol] = power
        every = islice(points(self.claim), _FEW if has_integral(self.claim) else None)
        more = islice(further(self.claim, self.sides), _FEW if has_integral(self.claim) else None)
        constants = [_reduced(v, p, powers) for ps in (every, more) for p, v in self._at(ps)]
        if not constants or any(not _agree(constants[0], each) for each in constants):
            return None
        return Quotient(constants[0], powers, named(constants[0]), len(constants))

    def _at(self, where: Iterator[Point]) -> Iterator[tuple[Point, Value]]:
        for point in where:
            try:
                left, right = (evaluated(side, point) for side in self.sides)
            except Undecided:
                continue
            real = mpmath.im(left) == 0 and mpmath.im(right) == 0
            if real and right != 0 and mpmath.isfinite(left / right):
                yield point, left / right

    def _power(self, symbol: Symbol, bases: list[tuple[Point, Value]]) -> Fraction | None:
        """Return the power of a variable in the ratio, or None if there is no single power."""
        powers = set[Fraction]()
        for point, value in bases:
            for step in _STEPS:
                moved = {**point, symbol: point[symbol] * step}
                if not is_allowed(self.claim, moved) or not self._is_in_range(symbol, moved):
                    continue
                after = next(self._at(iter([moved])), None)
                if after is None or after[1] / value <= 0:
                    continue
                power = mpmath.log(after[1] / value) / mpmath.log(step)
                near = Fraction(float(power)).limit_denominator(_STEEPEST)
                gap = abs(power - mpf(near.numerator) / near.denominator)
                if gap > mpf(10) ** -_SHARED or abs(near) > _STEEPEST:
                    return None
                powers.add(near)
                break
        return powers.pop() if len(powers) == 1 else None

    def _is_in_range(self, symbol: Symbol, point: Point) -> bool:
        span = self.claim.ranges.get(symbol)
        return span is None or span.powers or span.low < point[symbol] < span.high


def _reduced(value: Value, point: Point, powers: Mapping[Symbol, Fraction]) -> Value:
    for symbol, power in powers.items():
        value /= point[symbol] ** (mpf(power.numerator) / power.denominator)
    return value


def _agree(one: Value, other: Value) -> bool:
    return bool(abs(one - other) <= mpf(10) ** -_SHARED * abs(one))


def named(constant: Value) -> str:
    """Write a constant as a rational number times a power of pi or a root of this, or return "".

    >>> named(mpmath.mpf(4) / mpmath.pi)
    '4/pi'
    """
    for root, power in product((1, 2, 3), (0, 1, -1, 2, -2)):
        rest = abs(constant) ** root / mpmath.pi**power
        near = Fraction(int(mpmath.nint(rest * 2**80)), 2**80).limit_denominator(_LARGEST)
        gap = abs(rest - mpf(near.numerator) / near.denominator)
        if near == 0 or near.numerator > _LARGEST or gap > mpf(10) ** -_NAMED:
            continue
        over, under = str(near.numerator), str(near.denominator)
        pis = "pi" if abs(power) == 1 else "pi**2"
        over = (f"{over}*{pis}" if over != "1" else pis) if power > 0 else over
        under = (f"{under}*{pis}" if under != "1" else pis) if power < 0 else under
        inner = over if under == "1" else f"{over}/({under})" if "*" in under else f"{over}/{under}"
        return ("-" if constant < 0 else "") + (inner if root == 1 else f"{_ROOTS[root]}({inner})")
    return ""
