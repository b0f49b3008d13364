"""Provide the formulas of a body, each of them proven before use.

In:   a geometry.
Out:  ProvenBody: its parameters, its formula sheet, and its formulas.
"""

from functools import cache

from sympy import Expr, Symbol, atan, atan2, powsimp

from derive.body.geometry import Geometry
from derive.body.library import load_geometry
from derive.command.errors import NotProven
from derive.proof.numerical import NumericalRoutes
from derive.proof.symbolic import symbolic_proof
from derive.sheet.derivation import derive_sheet
from derive.sheet.formulas import FormulaSheet


class ProvenBody:
    """A geometry with its formula sheet, whose formulas are proven before they are returned."""

    def __init__(self, geometry: Geometry) -> None:
        self.sheet: FormulaSheet = derive_sheet(geometry)
        self._routes = NumericalRoutes(self.sheet)
        self._known: dict[str, Expr] = {}

    @property
    def parameters(self) -> dict[str, Expr]:
        """The parameters of the geometry by name."""
        return {each.name: each.symbol for each in self.sheet.geometry.parameters}

    def formula(self, name: str) -> Expr:
        """Return a formula that is proven symbolically or else to 30 digits; raises NotProven."""
        if name not in self._known:
            proof = symbolic_proof(self.sheet, name) or self._routes.proof(name)
            if proof is None or not proof.holds:
                raise NotProven(f"{name} of {self.sheet.geometry.name!r}: {proof}")
            self._known[name] = self.sheet.flat(name)
        return self._known[name]


@cache
def of_library(name: str) -> ProvenBody:
    """Return a body of the library."""
    return ProvenBody(load_geometry(name))


def placed(expr: Expr, table: dict[Symbol, Expr]) -> Expr:
    """Substitute the arguments of a formula, and write acute angles with atan."""
    return expr.subs(table, simultaneous=True).replace(atan2, _arc)


def _arc(over: Expr, under: Expr) -> Expr:
    return atan(powsimp(over / under)) if under.is_positive else atan2(over, under)
