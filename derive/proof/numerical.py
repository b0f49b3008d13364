"""Routes that end in agreement to 30 digits or more at 24 points.

In:  FormulaSheet, and the name of a formula.
Out: Proof with the verdict *numerical*, *refuted* or *unknown*; None if there is no such route.
"""

from collections.abc import Callable, Iterator

import mpmath
from mpmath import mpf
from sympy import Integral, Symbol, sqrt

from derive.proof.points import Point, contacts, loads, named, numeric
from derive.proof.quadrature import value_by_quadrature
from derive.proof.verdict import WORKING, Comparison, Proof, numerical_proof
from derive.sheet.formulas import Formula, FormulaSheet
from derive.symbols import M, P, a, alpha, c, dQ, dsigma, f, m, n, x

_QUADRATURE = "quadrature of the defining integral of g(x)"
_BOUNDED = "dq bounded at the ends of the stick zone, by quadrature of p"
_STICK = ("stick_m", "stick_n")
_FORWARD = {P: "load", M: "moment", alpha: "tilt"}

Route = Callable[[Point], tuple[mpf, mpf]]
"""Returns, for one contact, two numbers that must agree."""


def numeric_proof(sheet: FormulaSheet, name: str) -> Proof | None:
    """The proof of one formula by its numerical route."""
    stem = name.removesuffix("_closed")
    if name in _STICK and sheet.geometry.slope.is_polynomial:
        return compared(sheet, _BOUNDED, _stuck_between(sheet, name))
    if sheet[name].arguments[0] == P and name not in _STICK:
        with mpmath.workdps(WORKING):
            return _substituted(sheet, sheet[name])
    if stem in _OF_G:
        value = numeric(value_by_quadrature(sheet.geometry.g, stem))
        return compared(sheet, _OF_G[stem], lambda p: (_at(sheet, name, p), value(p)))
    return None


def compared(sheet: FormulaSheet, words: str, route: Route) -> Proof:
    """The proof by the pairs of numbers of a route at all contacts."""
    with mpmath.workdps(WORKING):
        return numerical_proof(
            words, (Comparison(*route(point), named(point)) for point in contacts(sheet))
        )


def _stuck_between(sheet: FormulaSheet, name: str) -> Route:
    """Compare int 2 f p sqrt(..) over both slip zones with its value from dQ and dsigma."""
    sense = -1 if name == _STICK[0] else 1
    weight = sqrt(((x + m) / (x - n)) ** sense)
    driven = 2 * f * sheet.flat("pressure") * weight
    driving = numeric(Integral(driven, (x, -a, -m)) + Integral(driven, (x, n, c)))

    def route(point: Point) -> tuple[mpf, mpf]:
        width = point[a] + point[c]
        cycle = {**point, P: _at(sheet, "load", point), alpha: _at(sheet, "tilt", point)}
        cycle[f] = (1 + abs(point[dsigma])) / 4
        cycle[dQ] = cycle[f] * cycle[P] * point[dQ] / 2
        cycle[dsigma] = 4 * cycle[dQ] / (mpmath.pi * width) * point[dsigma]
        cycle[m], cycle[n] = (_at(sheet, end, cycle) for end in _STICK)
        by_tension = mpmath.pi * cycle[dsigma] * (cycle[m] + cycle[n]) / 8
        return driving(cycle), cycle[dQ] - sense * by_tension

    return route


def _substituted(sheet: FormulaSheet, formula: Formula) -> Proof:
    """Substitute an inverse into the formulas from which it was solved."""
    stem = formula.name.removesuffix(f"_{formula.symbol}")
    given = formula.arguments
    asked = [*given, *([formula.symbol] if formula.symbol in _FORWARD else [])]

    def comparisons() -> Iterator[Comparison]:
        for point in loads(sheet, formula):
            edges = {edge: _at(sheet, f"{stem}_{edge}", point) for edge in (a, c)}
            for symbol in asked:
                wanted = point[symbol] if symbol in given else _at(sheet, formula.name, point)
                found = _at(sheet, _FORWARD[symbol], {**point, **edges})
                yield Comparison(wanted, found, named(point))

    return numerical_proof(f"substituted into {_names(asked)}", comparisons())


_OF_G = {
    "tilt": _QUADRATURE,
    "load": "(E*/2) I_1 of g(x) by quadrature",
    "moment": "-(E*/2) (I_2 - mid I_1) of g(x) by quadrature",
    "pressure": _QUADRATURE,
    **dict.fromkeys(
        ("K_N_left", "K_N_right", "L_N_left", "L_N_right"), f"{_QUADRATURE}, at that edge"
    ),
}
"""Each formula that is a defining integral, with the words for its route."""


def _at(sheet: FormulaSheet, name: str, point: Point) -> mpf:
    """A formula at a point."""
    return numeric(sheet.flat(name))(point)


def _names(asked: list[Symbol]) -> str:
    return ", ".join(f"{_FORWARD[symbol]}(a, c)" for symbol in asked)
