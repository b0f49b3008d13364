"""Which way each function of a body takes, decided here and nowhere else.

In:  a FormulaSheet.
Out: a Route for each function of the contract.

    FORMULA     the closed formula, rewritten for floating point
    PARTS       the closed formula as a sum over the parts of the curve, in terms of one sign: where
                a contact can leave a kink, its plain form would lose digits
    QUADRATURE  one quadrature of g'', in integrands of one sign: no closed formula, or one whose
                powers cancel; and L_N where g'' is no constant on some part
    SOLVED      Newton's method on load and moment, or on load and tilt
"""

from enum import Enum

from derive.codegen.contract import Function
from derive.codegen.cuts import cancels
from derive.sheet import FormulaSheet
from derive.symbols import P
from derive.theory.segments import Parts, has_parts


class Route(Enum):
    """A way to a function's values."""

    FORMULA = "formula"
    PARTS = "parts"
    QUADRATURE = "quadrature"
    SOLVED = "solved"


def route_of(sheet: FormulaSheet, function: Function) -> Route:
    """The way that one function takes."""
    if P in function.arguments:
        return Route.FORMULA if function.available(sheet) else Route.SOLVED
    if not function.geometric:
        return Route.FORMULA
    carried = carried_by(sheet)
    if carried is Route.PARTS and function.name == "L_N" and not Parts(sheet.frame).has_series:
        return Route.QUADRATURE
    return carried


def carried_by(sheet: FormulaSheet) -> Route:
    """The way to what a contact carries: load, moment, tilt, pressure and edge coefficients."""
    if has_parts(sheet.frame):
        return Route.PARTS
    slope = sheet.geometry.slope
    return Route.FORMULA if slope.is_polynomial and not cancels(slope) else Route.QUADRATURE
