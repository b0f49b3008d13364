"""Chooses how each function of a body is evaluated; no other module decides this.

In:  a FormulaSheet.
Out: whether a function is solved, and whether the functions of a contact are integrated.

    formula     The closed formula, rewritten for floating point.  Where a contact can move off a
                kink, the plain formula would lose digits; if the curve consists of straight lines
                and parabolas, it is evaluated as a sum over its parts, with terms of one sign.
    integrated  One quadrature over g'', with an integrand of one sign.  It is used where there is
                no closed formula, or one whose powers cancel.
    solved      Newton's method on load and moment, or on load and tilt.
"""

from derive.codegen.contract import Function
from derive.codegen.cuts import cancels
from derive.sheet.formulas import FormulaSheet
from derive.symbols import P
from derive.theory.parts import has_parts


def is_solved(sheet: FormulaSheet, function: Function) -> bool:
    """Whether a function is solved numerically."""
    return P in function.arguments and not function.available(sheet)


def is_integrated(sheet: FormulaSheet) -> bool:
    """Whether load, moment, tilt, pressure and the coefficients of the edges are integrated."""
    slope = sheet.geometry.slope
    return not (has_parts(sheet.frame) or (slope.is_polynomial and not cancels(slope)))
