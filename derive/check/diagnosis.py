"""Describe how the two sides of a false equation differ, and where it is true nevertheless.

If the ratio of the two sides is a constant times powers of the variables, it is reported.  If the
equation is true at some points and false at others, a comparison of two names with the same unit,
or the sign of one name, may tell these points apart.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from itertools import islice, permutations, product

import mpmath
from mpmath import mpf
from sympy import Expr, Rational, Symbol, pi, root

from derive.check.claim import Claim, Point
from derive.check.draw import further, has_integral, is_allowed, points, variables
from derive.proof.balls import Value
from derive.proof.values import Undecided, evaluated

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
_SIMPLE = 20
"""The largest integer in a constant that may be a misprint."""
_FALSE, _EACH = 6, 3
"""If a claim is false at this many points at first, it is taken to be false everywhere; the number
of points at which a claim must be true, and false, to be called true in part."""
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
    def simple_factor(self) -> Expr | None:
        """The ratio as an exact number, or None if it is not a simple constant."""
        return None if self.powers else simple(self.constant)

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
    """Describe the ratio of the two sides in words; empty if there is nothing to report."""
    if claim.meant.relation.is_ordered or claim.meant.cases or claim.meant.toward is not None:
        return ""
    ratio = quotient(claim)
    return f"the ratio left/right is {ratio.as_text} at {ratio.count} points" if ratio else ""


def quotient(claim: Claim) -> Quotient | None:
    """Return the ratio of the two sides if it is a constant times powers of the variables."""
    with mpmath.workdps(_DIGITS):
        try:
            return _Quotients(claim).measured()
        except Undecided:
            return None


class _Quotients:
    """Measures the ratio of the two sides of one claim at points where it is a real number."""

    def __init__(self, claim: Claim) -> None:
        self.claim = claim
        table = dict(claim.meant.meaning)
        self.sides = [
            side.xreplace(table) for side in claim.meant.sides(claim.meant.left, claim.meant.right)
        ]

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
        span = self.claim.meant.ranges.get(symbol)
        return span is None or span.powers or span.low < point[symbol] < span.high


def _reduced(value: Value, point: Point, powers: Mapping[Symbol, Fraction]) -> Value:
    for symbol, power in powers.items():
        value /= point[symbol] ** (mpf(power.numerator) / power.denominator)
    return value


def _agree(one: Value, other: Value) -> bool:
    return bool(abs(one - other) <= mpf(10) ** -_SHARED * abs(one))


def named(constant: Value) -> str:
    """Write a constant as a rational number times a power of pi, or as a root of it; or return "".

    >>> with mpmath.workdps(_DIGITS):
    ...     named(mpmath.mpf(4) / mpmath.pi)
    '4/pi'
    """
    form = _form(constant, _LARGEST)
    if form is None:
        return ""
    over, under = map(str, form.near.as_integer_ratio())
    power = form.power
    pis = "pi" if abs(power) == 1 else "pi**2"
    over = (f"{over}*{pis}" if over != "1" else pis) if power > 0 else over
    under = (f"{under}*{pis}" if under != "1" else pis) if power < 0 else under
    inner = over if under == "1" else f"{over}/({under})" if "*" in under else f"{over}/{under}"
    outer = inner if form.root == 1 else f"{_ROOTS[form.root]}({inner})"
    return ("-" if constant < 0 else "") + outer


@dataclass(frozen=True)
class _Form:
    """The modulus of a constant as a root of a rational number times a power of pi."""

    root: int
    near: Fraction
    power: int


def simple(constant: Value, digits: int = _NAMED) -> Expr | None:
    """Return the simple exact number with which a constant agrees to `digits` digits, or None."""
    form = _form(constant, _SIMPLE, digits)
    if form is None:
        return None
    size = Rational(*form.near.as_integer_ratio()) * pi**form.power
    return root(size, form.root) * (-1 if constant < 0 else 1)


def _form(constant: Value, largest: int, digits: int = _NAMED) -> _Form | None:
    """Return the exact form of a real constant with integers up to `largest`, or None."""
    if mpmath.im(constant) != 0:
        return None
    with mpmath.workdps(_DIGITS):
        for degree, power in product((1, 2, 3), (0, 1, -1, 2, -2)):
            rest = abs(constant) ** degree / mpmath.pi**power
            near = Fraction(int(mpmath.nint(rest * 2**80)), 2**80).limit_denominator(largest)
            gap = abs(rest - mpf(near.numerator) / near.denominator)
            if near != 0 and near.numerator <= largest and gap <= mpf(10) ** -digits:
                return _Form(degree, near, power)
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
    where = _comparison(claim, true, false)
    return f"{share}: wherever {where} (if this is meant, put it in `require`)" if where else share


def _comparison(claim: Claim, true: list[Point], false: list[Point]) -> str:
    """Return a comparison that is true at all true points and at none of the others."""
    names = list(dict.fromkeys((*claim.meant.swaps, *variables(claim))))
    units = claim.meant.unit_of
    values = {name: [_value(claim, name, point) for point in (*true, *false)] for name in names}
    signed = [(f"{one} {sign} 0", values[one], sign) for one in names for sign in "<>"]
    compared = [
        (
            f"{one} < {other}",
            [_minus(*pair) for pair in zip(values[one], values[other], strict=True)],
            "<",
        )
        for one, other in permutations(names, 2)
        if units.get(one, "") == units.get(other, "")
    ]
    for told, differences, sign in (*signed, *compared):
        met = [d is not None and (d < 0 if sign == "<" else d > 0) for d in differences]
        if all(met[: len(true)]) and not any(met[len(true) :]):
            return told
    return ""


def _value(claim: Claim, name: Symbol, point: Point) -> mpf | None:
    """Return the value of a name if it is a real number."""
    try:
        value = evaluated(claim.meant.meaning.get(name, name), point)
    except (Undecided, KeyError):
        return None
    return None if mpmath.im(value) != 0 else mpmath.re(value)


def _minus(one: mpf | None, other: mpf | None) -> mpf | None:
    return None if one is None or other is None else one - other
