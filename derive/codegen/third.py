"""The third coefficient of the pressure next to the edges, of s**(5/2).

In:  a proven FormulaSheet.
Out: the text of `_third`, for series of the slip zones to order 3; none for a body that is
     integrated.
"""

from sympy import Expr

from derive.codegen.contract import Function
from derive.codegen.function import BareText
from derive.codegen.parts import parts_program
from derive.codegen.plan import Route
from derive.codegen.program import Program
from derive.codegen.rewrite import prove_equal
from derive.errors import NotProven
from derive.sheet import FormulaSheet
from derive.symbols import a, c
from derive.theory.edges import Edge, pressure_series
from derive.theory.slip import pressure_next

NAME = "_third"

_THIRD = Function(
    NAME,
    (a, c),
    (("left", "L_N_left"), ("right", "L_N_right")),
    "Coefficients of s**(5/2) in the pressure next to the edges.",
    kind="Edges",
)
"""Its conditions are those of L_N."""


def third_text(sheet: FormulaSheet, route: Route, source: str) -> str:
    """`_third` of one body; nothing for one that is integrated.

    Raises NotProven if the expanded pressure is not what L_N and K_N say.
    """
    if route is Route.QUADRATURE:
        return ""
    made = _Summed if route is Route.PARTS else _Expanded
    return made(sheet, _THIRD, source).text


class _Expanded(BareText):
    """The pressure expanded once more."""

    def _expressions(self) -> dict[str, Expr]:
        return {edge.name.lower(): pressure_series(self.sheet.frame, edge, 3)[2] for edge in Edge}

    def _demand_equal(self) -> None:
        """The code against the other route: how L_N changes as the edge alone moves."""
        super()._demand_equal()
        proof = prove_equal(self.program, _from_motion(self.sheet), self._points())
        if not proof.holds:
            raise NotProven(f"{NAME} of {self.sheet.geometry.name!r}: {proof}")


class _Summed(BareText):
    """The same as a sum over the parts of a contact, compared when it was made."""

    def _made(self) -> Program:
        return parts_program(self.sheet, {"left": "third_left", "right": "third_right"})

    def _demand_equal(self) -> None:
        """Compared when it was made."""


def _from_motion(sheet: FormulaSheet) -> dict[str, Expr]:
    found = {}
    for side, edge in (("left", a), ("right", c)):
        K, L = (sheet.frame.flat(sheet[f"{name}_{side}"].expr) for name in ("K_N", "L_N"))
        found[side] = sheet.frame.flat(pressure_next(L.diff(edge), 1, K))
    return found
