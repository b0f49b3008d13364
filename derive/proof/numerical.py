"""Routes that end in agreement to 30 digits or more at 24 points.

In:  FormulaSheet, and the name of a formula.
Out: Proof with the verdict *numerical*, *refuted* or *unknown*; None if there is no such route.
"""

from collections.abc import Callable, Iterator

import mpmath
from mpmath import mpf
from sympy import Expr, Integral, Symbol, sqrt

from derive.proof.points import Point, contacts, loads, named, numeric
from derive.proof.quadrature import Contact, slope_as_given
from derive.proof.values import Undecided
from derive.proof.verdict import WORKING, Comparison, Proof, numerical_proof
from derive.sheet.formulas import Formula, FormulaSheet
from derive.symbols import M, P, a, alpha, c, dQ, dsigma, f, m, n, x

_QUADRATURE = "quadrature of the defining integral of g(x)"
_BOUNDED = "dq bounded at the ends of the stick zone, by quadrature of p"
_STICK = ("stick_m", "stick_n")
_FORWARD = {P: "load", M: "moment", alpha: "tilt"}

Route = Callable[[Point], tuple[mpf, mpf]]
"""Returns, for one contact, two numbers that must agree."""


class NumericalRoutes:
    """The numerical routes of one sheet, at the same random contacts."""

    def __init__(self, sheet: FormulaSheet) -> None:
        self.sheet = sheet

    def proof(self, name: str) -> Proof | None:
        """The proof of one formula by its numerical route."""
        stem = name.removesuffix("_closed")
        with mpmath.workdps(WORKING):
            if name in _STICK and self.sheet.geometry.slope.is_polynomial:
                return self._compared(_BOUNDED, self._stuck_between(name))
            if self.sheet[name].arguments[0] == P and name not in _STICK:
                return self._substituted(self.sheet[name])
            if stem in _OF_G:
                words, value = _OF_G[stem]
                slope = slope_as_given(self.sheet.geometry.g)
                return self._compared(
                    words, lambda point: (self._at(name, point), value(Contact(slope, point)))
                )
        return None

    def _compared(self, words: str, route: Route) -> Proof:
        """The proof by the pairs of numbers of a route at all contacts."""
        return numerical_proof(
            words, (Comparison(*route(point), named(point)) for point in contacts(self.sheet))
        )

    def _at(self, name: str, point: Point) -> mpf:
        return _number(self.sheet.flat(name))(point)

    def _stuck_between(self, name: str) -> Route:
        """Compare int 2 f p sqrt(..) over both slip zones with its value from dQ and dsigma."""
        sense = -1 if name == _STICK[0] else 1
        weight = sqrt(((x + m) / (x - n)) ** sense)
        driven = 2 * f * self.sheet.flat("pressure") * weight
        driving = _number(Integral(driven, (x, -a, -m)) + Integral(driven, (x, n, c)))

        def route(point: Point) -> tuple[mpf, mpf]:
            width = point[a] + point[c]
            cycle = {**point, P: self._at("load", point), alpha: self._at("tilt", point)}
            cycle[f] = (1 + abs(point[dsigma])) / 4
            cycle[dQ] = cycle[f] * cycle[P] * point[dQ] / 2
            cycle[dsigma] = 4 * cycle[dQ] / (mpmath.pi * width) * point[dsigma]
            cycle[m], cycle[n] = (self._at(end, cycle) for end in _STICK)
            by_tension = mpmath.pi * cycle[dsigma] * (cycle[m] + cycle[n]) / 8
            return driving(cycle), cycle[dQ] - sense * by_tension

        return route

    def _substituted(self, formula: Formula) -> Proof:
        """Substitute an inverse into the formulas from which it was solved."""
        stem = formula.name.removesuffix(f"_{formula.symbol}")
        given = formula.arguments
        asked = [*given, *([formula.symbol] if formula.symbol in _FORWARD else [])]

        def comparisons() -> Iterator[Comparison]:
            for point in loads(self.sheet, formula):
                edges = {edge: self._at(f"{stem}_{edge}", point) for edge in (a, c)}
                for symbol in asked:
                    wanted = point[symbol] if symbol in given else self._at(formula.name, point)
                    found = self._at(_FORWARD[symbol], {**point, **edges})
                    yield Comparison(wanted, found, named(point))

        return numerical_proof(f"substituted into {_names(asked)}", comparisons())


def _at_edge(K: str, side: str) -> tuple[str, Callable[[Contact], mpf]]:
    """The route to a coefficient of p/sqrt(s) at an edge."""
    return f"{_QUADRATURE}, at the {side} edge", lambda on: getattr(on, K)(side)


_OF_G: dict[str, tuple[str, Callable[[Contact], mpf]]] = {
    "tilt": (_QUADRATURE, lambda on: on.tilt),
    "load": ("(E*/2) I_1 of g(x) by quadrature", lambda on: on.load),
    "moment": ("-(E*/2) (I_2 - mid I_1) of g(x) by quadrature", lambda on: on.moment),
    "pressure": (_QUADRATURE, lambda on: on.pressure),
    **{f"{K}_{side}": _at_edge(K, side) for K in ("K_N", "L_N") for side in ("left", "right")},
}
"""The route of each formula that is a defining integral."""


def _number(expr: Expr) -> Callable[[Point], mpf]:
    """An expression as a function of a point; NaN where no reliable value is obtained."""

    def at(point: Point) -> mpf:
        try:
            return numeric(expr)(point)
        except Undecided:
            return mpf("nan")

    return at


def _names(asked: list[Symbol]) -> str:
    return ", ".join(f"{_FORWARD[symbol]}(a, c)" for symbol in asked)
