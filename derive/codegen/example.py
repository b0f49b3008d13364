"""Simple numbers that meet the assumptions of a function, for the example in its docstring."""

from collections.abc import Iterable
from itertools import product

import mpmath
from mpmath import mpf
from sympy.logic.boolalg import Boolean

from derive.command.errors import NotProven
from derive.proof.points import Point, holds, numeric
from derive.sheet.formulas import FormulaSheet
from derive.symbols import E_star, M, P, a, alpha, c, dM, dP, dQ, dsigma, f, x

_SIZES = [mpf(2) ** power for power in (0, 1, 2, 3, -1, -2, -3)]
"""Values of c that are tried for an example."""

_PLACES = [mpf(sixteenths) / 16 for sixteenths in (8, 6, -4, 12, 3)]
"""Values of x that are tried for an example."""

_LONGER = mpf("1.5")
"""The ratio a/c of an example."""


def example_of(sheet: FormulaSheet, conditions: Iterable[Boolean], geometric: bool = True) -> Point:
    """Simple numbers that meet the assumptions of a function, for its docstring.

    geometric  whether the function depends on the body, so that kinks matter
    """
    needed = tuple(conditions)
    given = [_plain_parameters(sheet, lengths) for lengths in (1, 2)]
    sized = [(plain, size) for plain in given for size in _SIZES]
    sized += [(plain, size) for plain in given for size in _within(sheet, plain)]
    for (plain, size), place, lean in product(sized, _PLACES, (1, -1, 0)):
        point: Point = {
            **plain,
            E_star: mpf(1),
            x: place,
            a: _LONGER * size,
            c: size,
            P: size,
            M: mpf("0.25") * size * lean,
            alpha: mpf("0.03125") * lean or _middle_tilt(sheet, plain),
            dQ: mpf("0.25"),
            dsigma: mpf("0.125"),
            dP: mpf("0.5"),
            dM: mpf("0.25"),
            f: mpf("0.5"),
        }
        if holds(needed, point) and (not geometric or _off_all_kinks(sheet, point)):
            return point
    raise NotProven(
        f"{sheet.geometry.name!r}: none of the numbers that were tried for an example meets the "
        "conditions of the body"
    )


def _off_all_kinks(sheet: FormulaSheet, point: Point) -> bool:
    """Whether no kink is at x or at an edge, where some formulas have no value."""
    kinks = [numeric(kink.position)(point) for kink in sheet.geometry.slope.kinks]
    return not {*kinks} & {point[x], -point[a], point[c]}


def _within(sheet: FormulaSheet, plain: Point) -> list[mpf]:
    """Sizes at which the left edge lies between the outermost kink and the end of the body."""
    ends = [abs(numeric(end)(plain)) for end in sheet.geometry.slope.domain]
    kinks = [abs(numeric(kink.position)(plain)) for kink in sheet.geometry.slope.kinks]
    start, end = max(kinks, default=mpf(0)), min(ends)
    if not start < end < mpmath.inf:
        return []
    step = mpf(2) ** mpmath.floor(mpmath.log((end - start) / 16, 2))
    shares = map(mpf, ("0.75", "0.5", "0.25"))
    return [step * mpmath.floor((start + s * (end - start)) / _LONGER / step) for s in shares]


def _middle_tilt(sheet: FormulaSheet, plain: Point) -> mpf:
    """The middle of the range of tilts at which the body can touch; zero if it is unbounded."""
    low, high = (numeric(limit)(plain) for limit in sheet.geometry.slope.limits)
    return -(low + high) / 2 if mpmath.isfinite(high - low) else mpf(0)


def _plain_parameters(sheet: FormulaSheet, lengths: int) -> Point:
    """Values of the parameters: 1/8 for slopes, powers of `lengths` for others.

    A typical value of the body takes precedence, and the lower bound of a parameter is added.
    """
    slope, values = sheet.geometry.slope, {}
    for number, q in enumerate(sheet.geometry.parameters):
        plain = mpf("0.125") if q.unit == "rad" else mpf(lengths) ** number
        value = slope.typical.get(q.symbol)
        values[q.symbol] = (mpf(value.p) / value.q if value else plain) + mpf(
            slope.least.get(q.symbol, 0)
        )
    return values
