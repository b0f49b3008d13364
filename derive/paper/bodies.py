"""Formulas of proven sheets, in variables of which every root comes out.

A wedge's contact is written by its size r = sqrt(a c) and its skewness t = sqrt(c/a):
a = r/t, c = r t.  Every size and every tilt of the body has one such pair, and the tilt is
alpha = phi (1 - (4/pi) atan t).
"""

from functools import cache

from sympy import Abs, Expr, Symbol, atan, atan2, powsimp

from derive.derivation import derive_sheet
from derive.errors import NotProven
from derive.geometry import Geometry
from derive.library import load_geometry
from derive.proof.numerical import NumericalRoutes
from derive.proof.symbolic import symbolic_proof
from derive.sheet import FormulaSheet
from derive.symbols import a, c

r = Symbol("r", positive=True)
t = Symbol("t", positive=True)
y = Symbol("y", positive=True)
"""sqrt((c - x)/(a + x)): zero at the right edge, infinite at the left."""


class Body:
    """A geometry with its sheet, whose formulas are proven before they are handed out."""

    def __init__(self, geometry: Geometry) -> None:
        self.sheet: FormulaSheet = derive_sheet(geometry)
        self._routes = NumericalRoutes(self.sheet)
        self._known: dict[str, Expr] = {}

    def formula(self, name: str) -> Expr:
        """A formula, proven symbolically, else to 30 digits; raises NotProven."""
        if name not in self._known:
            proof = symbolic_proof(self.sheet, name) or self._routes.proof(name)
            if proof is None or not proof.holds:
                raise NotProven(f"{name} of {self.sheet.geometry.name!r}: {proof}")
            self._known[name] = self.sheet.flat(name)
        return self._known[name]


@cache
def of_library(name: str) -> Body:
    """A body of the library."""
    return Body(load_geometry(name))


def formula(body: str, name: str) -> Expr:
    """A formula of a body of the library; both routes of each are gone through in generating."""
    return of_library(body).formula(name)


def parameter_of(body: str, name: str) -> Symbol:
    """The symbol of a body's parameter."""
    return load_geometry(body).quantities[name].symbol


def at(expr: Expr, left: Expr, right: Expr) -> Expr:
    """`expr` of the contact [-left, right], its angles as plain arcs where they are acute."""
    placed = expr.subs({a: left, c: right}, simultaneous=True)
    return placed.replace(atan2, _arc)


def _arc(over: Expr, under: Expr) -> Expr:
    return atan(powsimp(over / under)) if under.is_positive else atan2(over, under)


def wedge(name: str, size: Expr = r, skew: Expr = t) -> Expr:
    """A formula of the wedge on the contact [-size/skew, size skew]."""
    return at(formula("wedge", name), size / skew, size * skew)


def hertz(name: str, left: Expr, right: Expr) -> Expr:
    """A formula of the cylinder on the contact [-left, right]."""
    return at(formula("hertz", name), left, right)


def between(left: Expr, right: Expr) -> Expr:
    """The x at which sqrt((right - x)/(left + x)) is y."""
    return (right - left * y**2) / (1 + y**2)


def without_modulus(expr: Expr) -> Expr:
    """log f for log|f|, for derivatives and limits, which do not mind the sign of f."""
    return expr.replace(Abs, lambda argument: argument)
