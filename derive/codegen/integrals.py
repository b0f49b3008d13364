"""Prints the functions of a body without closed formulas, and the integrals that they evaluate.

In:  a FormulaSheet and a Function of the contract.
Out: the text of the function; for its docstring, the integrals of theory/superposition.py over g'',
     which generated/runtime/pieces.py evaluates, and the definitions of g' and g''.
"""

from collections.abc import Iterator, Sequence

from sympy import Expr, Function, Piecewise, count_ops, factor, simplify

from derive.body.piece import Piece
from derive.codegen.function import FunctionText
from derive.codegen.program import Common, Program
from derive.sheet.formulas import FormulaSheet
from derive.sheet.notation import text_of
from derive.symbols import x
from derive.theory import superposition
from derive.theory.superposition import curvature, slope, xi


class IntegratedText(FunctionText):
    """The text of one function that is evaluated by quadrature."""

    note = "  Evaluated by quadrature, in equal forms that keep their digits (runtime/pieces.py)."

    def _made(self) -> Program:
        """No program: no formula is rewritten, and the trial of the module tests the rest."""
        return Program({})

    def text(self, common: Common) -> str:
        """The whole function, which passes its arguments on to the law of the body."""
        own = ", ".join(q.name for q in self.sheet.geometry.parameters)
        passed = ", ".join(map(str, (*self.function.arguments, *self.function.constants)))
        return f"{self._head(common)}\n    return cycle.{self.function.name}(*_of({own}), {passed})"

    def _equations(self, common: Common) -> Iterator[str]:
        """The integrals that are evaluated; a closed formula, if there is one, is on the sheet."""
        yield from lines_of(self.sheet, self.function.formulas)


def lines_of(sheet: FormulaSheet, names: tuple[str, ...]) -> Iterator[str]:
    """Formulas of the sheet as integrals over g'', and the definitions of what they contain.

    >>> from derive.sheet.derivation import derive_law
    >>> from derive.body.library import load_geometry
    >>> for line in lines_of(derive_law(load_geometry("quartic")), ("load",)):
    ...     print(line)
    P = E_star*Integral(sqrt((a + xi)*(c - xi))*g''(xi), (xi, -a, c))/2
    g''(xi) = 3*xi**2/L**3
    """
    integrals = superposition.formulas(sheet.frame.kinks)
    formulas = {sheet[name].symbol: integrals[name] for name in names}
    used = {node.func for expr in formulas.values() for node in expr.atoms(Function)}
    pieces = sheet.geometry.slope.pieces
    defined = {
        slope(xi): by_piece([piece.slope for piece in pieces], pieces).subs(x, xi),
        curvature(xi): by_piece([piece.curvature for piece in pieces], pieces).subs(x, xi),
    }
    held = {call: definition for call, definition in defined.items() if call.func in used}
    for left, right in (formulas | held | sheet.frame.defined_in(*formulas.values())).items():
        yield f"{left} = {text_of(right)}"


def by_piece(values: Sequence[Expr], pieces: Sequence[Piece]) -> Expr:
    """Functions of x on the pieces, as one; each is factored unless that makes it longer."""
    short = [min(factor(simple), simple, key=count_ops) for simple in map(simplify, values)]
    branches = [(value, x < piece.upper) for value, piece in zip(short, pieces, strict=True)]
    return Piecewise(*branches[:-1], (short[-1], True))
