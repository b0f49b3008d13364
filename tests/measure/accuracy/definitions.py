"""The functions of one body in many digits: the formulas of its sheet, which are proven.

An integral in a formula is computed by the quadrature of the proofs.
"""

from collections.abc import Callable, Mapping
from functools import cache

import mpmath
from mpmath import mpf

from derive.proof.balls import Ball, ball, number
from derive.proof.points import numeric
from derive.proof.values import program
from derive.symbols import x
from tests.derive.bodies import of_library as sheet_of
from tests.measure.accuracy.reference import function_of as in_mpmath

Formula = Callable[..., mpf]
"""By keywords; what it does not hold is left aside."""

Given = Mapping[str, mpf]


@cache
def formula(body: str, name: str) -> Formula:
    """One formula of a body's sheet."""
    sheet = sheet_of(body)
    expr = sheet.flat(name)
    if sheet.geometry.slope.is_polynomial:
        names, function = in_mpmath(expr)
        return lambda **given: mpmath.re(function(*(given[n] for n in names)))
    value, held = numeric(expr), sorted(expr.free_symbols, key=str)
    return lambda **given: mpmath.re(value({s: given[str(s)] for s in held}))


@cache
def _pressure_along(body: str) -> Callable[..., Callable[[Ball], Ball]]:
    expr = sheet_of(body).flat("pressure")
    along, held = program(expr, x).function, expr.free_symbols - {x}
    return lambda given: along({s: given[str(s)] for s in held})


def pressure_along(body: str, given: Given) -> Callable[[Ball], Ball]:
    """The pressure of a body at a place, in balls."""
    if sheet_of(body).geometry.slope.is_polynomial:
        return _pressure_along(body)(given)
    pressure = formula(body, "pressure")
    return lambda s: ball(pressure(**{**given, "x": number(s)}))


def kinks_of(body: str, given: Given) -> list[mpf]:
    """Where a body's kinks are."""
    places = [in_mpmath(kink.position) for kink in sheet_of(body).geometry.slope.kinks]
    return [mpf(place(*(given[n] for n in names))) for names, place in places]
