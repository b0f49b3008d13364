"""Slip zones by series in their length, cut behind an order: the terms of derive/theory/slip.py.

The contact [-a, c] reaches further by `da` and `dc` than that at the other end of the half-cycle.
"""

from collections.abc import Callable, Sequence
from functools import cache, lru_cache

import mpmath
from mpmath import mpf
from sympy import Symbol, symbols

from derive.theory import slip
from tests.accuracy.definitions import Formula, formula
from tests.accuracy.reference import Conditions, Given, Problem, function_of

SIDES = (("left", "a", 1), ("right", "c", -1))
"""Name, edge, and the sign with which the tension pulls there."""


def other_end(given: Given) -> dict[str, mpf]:
    """The contact at the other end."""
    return {**given, "a": given["a"] - given["da"], "c": given["c"] - given["dc"]}


def first_order(body: str) -> Conditions:
    """d = |K_T|/(f K_N) and half of what the contact has gained."""
    K_N = [formula(body, f"K_N_{side}") for side, _, _ in SIDES]

    def off(zones: Sequence[mpf], given: Given) -> list[mpf]:
        width = given["a"] + given["c"]
        scale = mpmath.pi * mpmath.sqrt(width) * given["f"]
        pulls = _pulls(given, width)
        gained = given.get("da", mpf(0)) / 2, given.get("dc", mpf(0)) / 2
        return [
            scale * K(**given) * (d - more) - abs(pull)
            for K, d, more, pull in zip(K_N, zones, gained, pulls, strict=True)
        ]

    return off


def series(order: int) -> Callable[[str], Problem]:
    """The slip zones to an order."""
    return lambda body: Problem(_conditions(body, order))


def error(order: int) -> Callable[[str], Problem]:
    """By how much the next order changes them."""

    def problem(body: str) -> Problem:
        now, following = _conditions(body, order), _conditions(body, order + 1)
        return Problem(
            lambda zones, given: [*now(zones[:2], given), *following(zones[2:], given)],
            lambda zones, _: [abs(zones[0] - zones[2]), abs(zones[1] - zones[3])],
        )

    return problem


def _conditions(body: str, order: int) -> Conditions:
    return first_order(body) if order == 1 else _cut(body, order)


def _pulls(given: Given, width: mpf) -> list[mpf]:
    """By how much shear and tension drive slip at both edges."""
    return [given["dQ"] + sign * mpmath.pi * width * given["dsigma"] / 8 for _, _, sign in SIDES]


def _cut(body: str, order: int) -> Conditions:
    """Both conditions for a bounded change of shear."""
    K, L = ([formula(body, f"{name}_N_{side}") for side, _, _ in SIDES] for name in "KL")
    near, far = _terms(order)

    @lru_cache(maxsize=64)
    def known(point: tuple[tuple[str, mpf], ...], digits: int) -> list[list[list[mpf]]]:
        given = dict(point)
        ends = [given, other_end(given)] if "da" in given else [given]
        return [[_coefficients(end, i, K, L, order, digits) for i in (0, 1)] for end in ends]

    def off(zones: Sequence[mpf], given: Given) -> list[mpf]:
        width = given["a"] + given["c"]
        stuck = width - zones[0] - zones[1]
        senses = [1 if pull >= 0 else -1 for pull in _pulls(given, width)]
        total = [-pull for pull in _pulls(given, stuck)]
        contacts = known(tuple(given.items()), mpmath.mp.dps)
        for number, pressures in enumerate(contacts):
            for i, terms in enumerate(pressures):
                gained = given.get(f"d{SIDES[i][1]}", mpf(0)) if number else mpf(0)
                slipping = senses[i] * 2 * given["f"] / len(contacts)
                here = zones[i] - gained, stuck
                total[i] += slipping * near(*terms, *here)
                total[1 - i] += slipping * far(*terms, *here)
        return total

    return off


@cache
def _terms(order: int) -> tuple[Callable[..., mpf], Callable[..., mpf]]:
    """near and far of the theory, of the pressure's coefficients, d and the stick zone's width."""
    C = symbols(f"C_0:{order}")
    taken = [*map(str, C), "d", "stuck"]
    found = []
    for of in (slip.near, slip.far):
        names, function = function_of(of(C, Symbol("d"), Symbol("stuck"), order))
        picked = [taken.index(name) for name in names]
        found.append(lambda *v, function=function, picked=picked: function(*(v[i] for i in picked)))
    return found[0], found[1]


def _coefficients(
    given: Given, i: int, K: list[Formula], L: list[Formula], order: int, digits: int
) -> list[mpf]:
    """K_N, L_N and what follows: -(2/5) (dL/dedge + K/(16 h**2)) as the edge alone moves."""
    found = [K[i](**given), L[i](**given)]
    if order > 2:
        edge, width = SIDES[i][1], given["a"] + given["c"]
        with mpmath.workdps(3 * digits):
            step = width * mpf(10) ** -digits
            more, less = (L[i](**{**given, edge: given[edge] + by}) for by in (step, -step))
            rate = (more - less) / (2 * step)
        found.append(-mpf(2) / 5 * (rate + found[0] / (16 * width**2)))
    return found
