"""Chooses how each function of a body is evaluated; no other module decides this.

In:  a FormulaSheet.
Out: a Route for each function of the contract.

    FORMULA     The closed formula, rewritten for floating point.  Where a contact can move off a
                kink, the plain formula would lose digits; if the curve consists of straight lines
                and parabolas, it is evaluated as a sum over its parts, with terms of one sign.
    QUADRATURE  One quadrature over g'', with an integrand of one sign.  It is used where there is
                no closed formula, or one whose powers cancel.
    SOLVED      Newton's method on load and moment, or on load and tilt.
"""

from enum import Enum

from derive.codegen.contract import Function
from derive.codegen.cuts import cancels
from derive.sheet.formulas import FormulaSheet
from derive.symbols import P
from derive.theory.parts import has_parts


class Route(Enum):
    """A way to evaluate a function."""

    FORMULA = "formula"
    QUADRATURE = "quadrature"
    SOLVED = "solved"


def route_of(sheet: FormulaSheet, function: Function) -> Route:
    """How one function is evaluated."""
    if P in function.arguments:
        return Route.FORMULA if function.available(sheet) else Route.SOLVED
    if not function.geometric:
        return Route.FORMULA
    return carried_by(sheet)


def carried_by(sheet: FormulaSheet) -> Route:
    """How load, moment, tilt, pressure and the coefficients of the edges are evaluated."""
    slope = sheet.geometry.slope
    keeps_digits = has_parts(sheet.frame) or (slope.is_polynomial and not cancels(slope))
    return Route.FORMULA if keeps_digits else Route.QUADRATURE
