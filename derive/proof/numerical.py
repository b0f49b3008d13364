"""Routes that end in agreement to 30 digits or more at 24 points.

In:  FormulaSheet, and the name of a formula.
Out: Proof with the verdict *numerical*, *refuted* or *unknown*; None if there is no such route.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from functools import cached_property

import mpmath
from mpmath import mpf
from sympy import Expr, Symbol, cancel

from derive.proof.balls import Ball, Function, ball, root
from derive.proof.points import Point, contacts, loads, named, numeric, numeric_along
from derive.proof.quadrature import Contact
from derive.proof.rule import remembered, unchecked
from derive.proof.values import Undecided
from derive.proof.verdict import WORKING, Comparison, Proof, numerical_proof
from derive.sheet.formulas import Formula, FormulaSheet
from derive.symbols import E_star, M, P, a, alpha, c, dQ, dsigma, f, w, x

_QUADRATURE = "quadrature of the defining integral of g(x)"
_BOUNDED = "dq bounded at the ends of the stick zone, by quadrature of p"
_STICK = ("stick_m", "stick_n")
_FORWARD = {P: "load", M: "moment", alpha: "tilt"}

_s = Symbol("s")
"""A second point in the contact besides x."""

Pairs = Iterator[tuple[mpf, mpf]]
Route = Callable[[Point, Contact], Pairs]
"""Returns, for one contact, pairs of numbers that must agree."""
Value = Callable[[Point, Contact], mpf]
"""Returns, for one contact, the number that a formula must agree with."""


@dataclass(frozen=True, eq=False)
class NumericalRoutes:
    """The numerical routes of one sheet, which share their random contacts."""

    sheet: FormulaSheet
    _pressures: dict[str, Function] = field(default_factory=dict)

    def proof(self, name: str) -> Proof | None:
        """The proof of one formula by its numerical route."""
        with mpmath.workdps(WORKING), unchecked():
            if self.sheet[name].arguments[0] == P and name not in _STICK:
                return self._substituted(self.sheet[name])
            if name not in self._routes:
                return None
            words, route = self._routes[name]
            return numerical_proof(
                words,
                (
                    Comparison(here, there, named(point))
                    for point, contact in self._contacts
                    for here, there in route(point, contact)
                ),
            )

    @cached_property
    def _routes(self) -> dict[str, tuple[str, Route]]:
        """Polynomials are integrated once more; superposed wedges meet the equation of g itself."""
        is_polynomial = self.sheet.geometry.slope.is_polynomial
        values = _OF_G | (self._of_pressure if is_polynomial else _OF_G_ALONE)
        routes = {
            asked: (words, self._against(asked, value))
            for name, (words, value) in values.items()
            for asked in (name, f"{name}_closed")
        }
        routes["full_stick_change"] = "force and strain by quadrature", self._full_stick
        if is_polynomial:
            routes |= {name: (_BOUNDED, self._stuck_between(name)) for name in _STICK}
        return routes

    @cached_property
    def _of_pressure(self) -> dict[str, tuple[str, Value]]:
        """Numbers that follow from the formula of p."""
        next_to = "p - K_N sqrt(s) close to the edge"
        return {
            "load": ("int p dx by quadrature", lambda at, on: on.integral(self._p(at))),
            "moment": ("-int p x dx by quadrature", self._moment),
            **{f"L_N_{side}": (next_to, self._second(side)) for side in ("left", "right")},
        }

    def _against(self, name: str, value: Value) -> Route:
        """Compare a formula with another number for the same contact."""

        def route(point: Point, contact: Contact) -> Pairs:
            yield self._at(name, point), value(point, contact)

        return route

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

    def _moment(self, point: Point, contact: Contact) -> mpf:
        p = self._p(point)
        return contact.integral(lambda s: -s * p(s))

    def _p(self, point: Point) -> Function:
        """p(x) at one contact, remembered, since load and moment need it at the same points."""
        key = named(point)
        if key not in self._pressures:
            p = numeric_along(self.sheet.flat("pressure"), x)(point)
            self._pressures[key] = remembered(p)
        return self._pressures[key]

    def _second(self, side: str) -> Value:
        """(p/sqrt(s) - K_N)/s so close to the edge that the next term affects no digit."""

        def value(point: Point, contact: Contact) -> mpf:
            with mpmath.workdps(3 * WORKING):
                s = contact.h * mpf(10) ** (2 - WORKING)
                place = s - point[a] if side == "left" else point[c] - s
                pressure = self._at("pressure", {**point, x: place})
                return (pressure / mpmath.sqrt(s) - self._at(f"K_N_{side}", point)) / s

        return value

    @cached_property
    def _stuck(self) -> tuple[Expr, Expr]:
        """dq w at s, and the polynomial (its value at s minus that at x)/(x - s)."""
        above = self.sheet["full_stick_change"].expr * w
        at_s = above.subs(x, _s)
        return at_s, cancel((at_s - above) / (x - _s))

    def _full_stick(self, point: Point, contact: Contact) -> Pairs:
        """int dq = dQ and (1/pi) PV int dq(s)/(x - s) ds = dsigma/4.

        PV int ds/(w(s) (x - s)) is zero inside the contact, so the value at x can be subtracted.
        The difference is divided by x - s as a polynomial.  A division of numbers would lose digits
        near x.
        """
        at_s, with_x = self._stuck
        force = numeric_along(at_s, _s)(point)
        strain = numeric_along(with_x, _s)(point)
        yield contact.over_root(force), point[dQ]
        yield contact.over_root(strain) / mpmath.pi, point[dsigma] / 4

    def _stuck_between(self, name: str) -> Route:
        """Compare int 2 f p sqrt(..) over both slip zones with its value from dQ and dsigma."""

        def route(point: Point, contact: Contact) -> Pairs:
            cycle = {**point, P: self._at("load", point), alpha: self._at("tilt", point)}
            cycle[f] = (1 + abs(point[dsigma])) / 4
            cycle[dQ] = cycle[f] * cycle[P] * point[dQ] / 2
            cycle[dsigma] = 4 * cycle[dQ] / (mpmath.pi * contact.h) * point[dsigma]
            left, right = (self._at(end, cycle) for end in _STICK)
            stuck, sense = left + right, -1 if name == _STICK[0] else 1
            by_tension = mpmath.pi * cycle[dsigma] * stuck / 8

            p, low, high = self._p(point), ball(left), ball(right)

            def weighted(place: Ball) -> Ball:
                ratio = (place + low) / (place - high)
                return p(place) * root(ratio if sense > 0 else 1 / ratio)

            driving = 2 * cycle[f] * contact.outside(left, right, weighted)
            yield driving, cycle[dQ] - sense * by_tension

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


def _of_series(side: str, order: int) -> Value:
    """A coefficient of p/sqrt(s), from three points so close to the edge that a parabola fits."""
    return lambda _, contact: contact.edge_series(side)[order]


_OF_G: dict[str, tuple[str, Value]] = {
    "tilt": (_QUADRATURE, lambda _, contact: contact.tilt),
    "pressure": (_QUADRATURE, lambda point, contact: contact.pressure(point[x])),
}
_OF_G_ALONE: dict[str, tuple[str, Value]] = {
    "load": ("(E*/2) I_1 of g(x) by quadrature", lambda _, contact: contact.load),
    "moment": ("-(E*/2) (I_2 - mid I_1) of g(x) by quadrature", lambda _, contact: contact.moment),
    **{
        f"{name}_N_{side}": (
            f"{_QUADRATURE}, next to the {side} edge",
            _of_series(side, order),
        )
        for order, name in enumerate("KL")
        for side in ("left", "right")
    },
}


def _names(asked: list[Symbol]) -> str:
    return ", ".join(f"{_FORWARD[symbol]}(a, c)" for symbol in asked)
