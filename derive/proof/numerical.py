"""Routes that end in agreement to 30 digits or more at 24 points.

In:  FormulaSheet, and the name of a formula.
Out: Proof with the verdict *numerical*, *refuted* or *unknown*; None if there is no such route.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property

import mpmath
from mpmath import mpf
from sympy import Expr, Symbol, cancel

from derive.proof.balls import Ball, Function, ball, digits, number, root
from derive.proof.points import Point, contacts, loads, named, numeric, numeric_along
from derive.proof.quadrature import Contact
from derive.proof.rule import remembered
from derive.proof.verdict import WORKING, Comparison, Proof, numerical_proof
from derive.sheet.formulas import Formula, FormulaSheet
from derive.symbols import E_star, M, P, a, alpha, c, dQ, dsigma, f, w, x

_QUADRATURE = "quadrature of the defining integral of g(x)"
_BOUNDED = "dq bounded at the ends of the stick zone, by quadrature of p"
_STICK = ("stick_m", "stick_n")
_FORWARD = {P: "load", M: "moment", alpha: "tilt"}

_SPARE = 20
"""Additional digits for a closed pressure, whose terms may cancel."""

_s = Symbol("s")
"""A second point in the contact besides x."""

Pairs = Iterator[tuple[mpf, mpf]]
Route = Callable[[Point, Contact], Pairs]
"""Returns, for one contact, pairs of numbers that must agree."""


@dataclass(frozen=True, eq=False)
class NumericalRoutes:
    """The numerical routes of one sheet, which share their random contacts."""

    sheet: FormulaSheet

    def proof(self, name: str) -> Proof | None:
        """The proof of one formula by its numerical route."""
        with mpmath.workdps(WORKING):
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
        if not self.sheet.geometry.slope.is_polynomial:
            return self._routes_of_integrals
        return {
            "tilt": (_QUADRATURE, self._tilt),
            "load": ("int p dx by quadrature", self._load),
            "moment": ("-int p x dx by quadrature", self._moment),
            "pressure": (_QUADRATURE, self._pressure),
            "L_N_left": ("p - K_N sqrt(s) close to the edge", self._second_left),
            "L_N_right": ("p - K_N sqrt(s) close to the edge", self._second_right),
            "full_stick_change": ("force and strain by quadrature", self._full_stick),
            **{name: (_BOUNDED, self._stuck_between(name)) for name in _STICK},
        }

    @cached_property
    def _routes_of_integrals(self) -> dict[str, tuple[str, Route]]:
        """Superposed wedges compared with the singular integral equation of the original g'."""
        routes: dict[str, tuple[str, Route]] = {
            "pressure": (_QUADRATURE, self._pressure),
            "full_stick_change": ("force and strain by quadrature", self._full_stick),
        }
        defining: list[tuple[str, str, Callable[[Contact], mpf]]] = [
            ("tilt", _QUADRATURE, lambda contact: contact.tilt),
            ("load", "(E*/2) I_1 of g(x) by quadrature", lambda contact: contact.load),
            (
                "moment",
                "-(E*/2) (I_2 - mid I_1) of g(x) by quadrature",
                lambda contact: contact.moment,
            ),
        ]
        for side in ("left", "right"):
            for order, name in enumerate((f"K_N_{side}", f"L_N_{side}")):
                words = f"{_QUADRATURE}, next to the {side} edge"
                defining.append((name, words, _of_series(side, order)))
        for name, words, value in defining:
            for asked in (name, f"{name}_closed"):
                routes[asked] = words, self._against(asked, value)
        return routes

    def _against(self, name: str, value: Callable[[Contact], mpf]) -> Route:
        """Compare a formula with the number that the defining integrals of a contact give."""

        def route(point: Point, contact: Contact) -> Pairs:
            yield self._at(name, point), value(contact)

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
        return numeric(self.sheet.flat(name))(point)

    def _tilt(self, point: Point, contact: Contact) -> Pairs:
        yield self._at("tilt", point), contact.tilt

    def _load(self, point: Point, contact: Contact) -> Pairs:
        p = self._p(point)
        yield self._at("load", point), contact.integral(p)

    def _moment(self, point: Point, contact: Contact) -> Pairs:
        p = self._p(point)
        yield self._at("moment", point), contact.integral(lambda s: -s * p(s))

    def _pressure(self, point: Point, contact: Contact) -> Pairs:
        yield self._at("pressure", point), contact.pressure(point[x])

    def _p(self, point: Point) -> Function:
        """p(x) at one contact, remembered, since load and moment need it at the same points."""
        if named(point) not in self._pressures:
            p = numeric_along(self.sheet.flat("pressure"), x)(point)
            self._pressures[named(point)] = remembered(p)
        return self._pressures[named(point)]

    @cached_property
    def _pressures(self) -> dict[str, Function]:
        return {}

    def _second_left(self, point: Point, contact: Contact) -> Pairs:
        yield self._at("L_N_left", point), self._second("left", point, contact)

    def _second_right(self, point: Point, contact: Contact) -> Pairs:
        yield self._at("L_N_right", point), self._second("right", point, contact)

    def _second(self, side: str, point: Point, contact: Contact) -> mpf:
        """(p/sqrt(s) - K_N)/s so close to the edge that the next term affects no digit."""
        with mpmath.workdps(3 * WORKING):
            s = contact.h * mpf(10) ** (2 - WORKING)
            place = s - point[a] if side == "left" else point[c] - s
            with digits(mpmath.mp.dps + _SPARE):
                pressure = number(self._p(point)(ball(place)))
            first = self._at(f"K_N_{side}", point)
            return (pressure / mpmath.sqrt(s) - first) / s

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


def _of_series(side: str, order: int) -> Callable[[Contact], mpf]:
    """A coefficient of p/sqrt(s), from three points so close to the edge that a parabola fits."""
    return lambda contact: contact.edge_series(side)[order]


def _names(asked: list[Symbol]) -> str:
    return ", ".join(f"{_FORWARD[symbol]}(a, c)" for symbol in asked)
