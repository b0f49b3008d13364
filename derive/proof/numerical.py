"""Routes that end in agreement to 30 digits or more at 24 points.

In:  FormulaSheet, and the name of a formula.
Out: Proof with the verdict *numerical*, *refuted* or *unknown*; None if there is no such route.
"""

from collections.abc import Callable, Iterator
from functools import cached_property

import mpmath
from mpmath import mpf
from sympy import Symbol

from derive.proof.balls import Ball, ball, root
from derive.proof.points import Point, contacts, loads, named, numeric, numeric_along
from derive.proof.quadrature import Contact
from derive.proof.values import Undecided
from derive.proof.verdict import WORKING, Comparison, Proof, numerical_proof
from derive.sheet.formulas import Formula, FormulaSheet
from derive.symbols import E_star, M, P, a, alpha, c, dQ, dsigma, f, x

_QUADRATURE = "quadrature of the defining integral of g(x)"
_BOUNDED = "dq bounded at the ends of the stick zone, by quadrature of p"
_STICK = ("stick_m", "stick_n")
_FORWARD = {P: "load", M: "moment", alpha: "tilt"}

Route = Callable[[Point, Contact], tuple[mpf, mpf]]
"""Returns, for one contact, two numbers that must agree."""
Value = Callable[[Point, Contact], mpf]
"""Returns, for one contact, the number that a formula must agree with."""


class NumericalRoutes:
    """The numerical routes of one sheet, which share their random contacts."""

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
                return self._compared(words, lambda at, on: (self._at(name, at), value(at, on)))
        return None

    def _compared(self, words: str, route: Route) -> Proof:
        """The proof by the pairs of numbers of a route at all contacts."""
        return numerical_proof(
            words,
            (Comparison(*route(point, contact), named(point)) for point, contact in self._contacts),
        )

    @cached_property
    def _contacts(self) -> list[tuple[Point, Contact]]:
        body = self.sheet.geometry
        found = []
        for point in contacts(self.sheet):
            values = {q.symbol: point[q.symbol] for q in body.parameters}
            found.append((point, Contact(body, values, point[a], point[c], point[E_star])))
        return found

    def _at(self, name: str, point: Point) -> mpf:
        try:
            return numeric(self.sheet.flat(name))(point)
        except Undecided:
            return mpf("nan")

    def _stuck_between(self, name: str) -> Route:
        """Compare int 2 f p sqrt(..) over both slip zones with its value from dQ and dsigma."""

        def route(point: Point, contact: Contact) -> tuple[mpf, mpf]:
            cycle = {**point, P: self._at("load", point), alpha: self._at("tilt", point)}
            cycle[f] = (1 + abs(point[dsigma])) / 4
            cycle[dQ] = cycle[f] * cycle[P] * point[dQ] / 2
            cycle[dsigma] = 4 * cycle[dQ] / (mpmath.pi * contact.h) * point[dsigma]
            left, right = (self._at(end, cycle) for end in _STICK)
            stuck, sense = left + right, -1 if name == _STICK[0] else 1
            by_tension = mpmath.pi * cycle[dsigma] * stuck / 8

            p = numeric_along(self.sheet.flat("pressure"), x)(point)
            low, high = ball(left), ball(right)

            def weighted(place: Ball) -> Ball:
                ratio = (place + low) / (place - high)
                return p(place) * root(ratio if sense > 0 else 1 / ratio)

            zones = (-contact.a, -left), (right, contact.c)
            driving = 2 * cycle[f] * sum(contact.integral(weighted, *zone) for zone in zones)
            return driving, cycle[dQ] - sense * by_tension

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


def _at_edge(K: str, side: str) -> tuple[str, Value]:
    """The route to a coefficient of p/sqrt(s) at an edge."""
    return f"{_QUADRATURE}, at the {side} edge", lambda _, on: getattr(on, K)(side)


_OF_G: dict[str, tuple[str, Value]] = {
    "tilt": (_QUADRATURE, lambda _, on: on.tilt),
    "load": ("(E*/2) I_1 of g(x) by quadrature", lambda _, on: on.load),
    "moment": ("-(E*/2) (I_2 - mid I_1) of g(x) by quadrature", lambda _, on: on.moment),
    "pressure": (_QUADRATURE, lambda point, on: on.pressure(point[x])),
    **{f"{K}_{side}": _at_edge(K, side) for K in ("K_N", "L_N") for side in ("left", "right")},
}


def _names(asked: list[Symbol]) -> str:
    return ", ".join(f"{_FORWARD[symbol]}(a, c)" for symbol in asked)
