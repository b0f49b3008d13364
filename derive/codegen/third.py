"""The third coefficient of the pressure next to the edges, that of s**(5/2).

In:  a proven FormulaSheet.
Out: the Program for this coefficient with E* = 1, which the series of the slip zones need at
     order 3.
"""

from sympy import Expr, S

from derive.codegen.parts import THIRD, parts_program
from derive.codegen.plan import Route, carried_by
from derive.codegen.program import Program
from derive.codegen.rewrite import prove_equal, stable_program
from derive.errors import NotProven
from derive.proof.points import contacts
from derive.sheet import FormulaSheet
from derive.symbols import E_star, a, c
from derive.theory.edges import Edge, pressure_series
from derive.theory.slip import pressure_next


def third_program(sheet: FormulaSheet) -> Program:
    """The program for the coefficients at both edges, by expansion or as a sum over parts.

    Raises NotProven if the expanded pressure does not agree with L_N and K_N.
    """
    summed = carried_by(sheet) is Route.PARTS
    program = parts_program(sheet, THIRD) if summed else _expanded(sheet)
    return program.mapped(lambda expr: expr.xreplace({E_star: S.One}))


def _expanded(sheet: FormulaSheet) -> Program:
    """The program from the expanded pressure, compared with `_from_motion`."""
    series = {edge.name.lower(): pressure_series(sheet.frame, edge, 3)[2] for edge in Edge}
    program = stable_program(sheet, series, {})
    proof = prove_equal(program, _from_motion(sheet), contacts(sheet))
    if not proof.holds:
        raise NotProven(f"the third coefficient of {sheet.geometry.name!r}: {proof}")
    return program


def _from_motion(sheet: FormulaSheet) -> dict[str, Expr]:
    """The coefficients by an independent route: the change of L_N as one edge moves."""
    coefficients = {}
    for side, edge in (("left", a), ("right", c)):
        K, L = (sheet.frame.flat(sheet[f"{name}_{side}"].expr) for name in ("K_N", "L_N"))
        coefficients[side] = sheet.frame.flat(pressure_next(L.diff(edge), 1, K))
    return coefficients
